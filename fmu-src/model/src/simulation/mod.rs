//! One running model.

mod flow;
pub(crate) mod indicators;
mod input;
mod sensitivity;
mod snapshot;
mod variables;

pub use snapshot::Snapshot;
pub use variables::Access;

use std::path::{Path, PathBuf};

use strut_integrators::{Array, Integrator, InvalidSettings, SolverStats, System};

use crate::{
    Bundle, Error, Instant, Model, ParameterSet, Settings,
    bundle::from_slice,
    layout::{InputArray, Layout, OutputArray, Section, Solver, SolverSettings, StateArray},
    parameter_set::Starts,
};
use flow::Flow;
use input::InputPath;

/// Ticks that one step may have: a day of milliseconds.
const MAX_TICKS: f64 = 86_400e3;

/// A model with its parameters, inputs, states and integrator.
///
/// Nothing is shared between simulations, nothing is allocated while one runs. Outputs and rates are
/// evaluated when they are asked for.
pub struct Simulation<M: Model> {
    model: M,
    settings: M::Settings,
    solver_settings: SolverSettings,
    resources: Option<PathBuf>,
    parameters: M::Parameters<f64>,
    derived: M::Derived<f64>,
    solver: Solver<f64>,
    period: Option<f64>,
    time: f64,
    start: f64,
    ticks: u64,
    memory: M::Memory<f64>,
    state: StateArray<M>,
    input: InputPath<InputArray<M>>,
    rates: StateArray<M>,
    output: OutputArray<M>,
    integrator: Integrator<StateArray<M>>,
    /// The settings have changed since the model was made from them.
    unprepared: bool,
    /// Parameters have changed since others were derived from them.
    underived: bool,
    /// Rates and outputs do not belong to the present time, states, inputs and parameters.
    stale: bool,
    /// Until initialisation ends, parameters need not fit together yet.
    initializing: bool,
}

impl<M: Model> Simulation<M> {
    /// A model at its start values: the declared ones, or those of a parameter set.
    ///
    /// # Errors
    /// If the parameter set does not fit the declarations. Whether the model accepts its settings and
    /// parameters is told by [`initialize`](Self::initialize).
    pub fn new(set: Option<&ParameterSet>, resources: Option<&Path>) -> Result<Self, Error> {
        let declared = Layout::<M>::declared();
        let starts = Starts::of(&declared, set)?;
        let mut settings = M::Settings::starts();
        let mut solver_settings = SolverSettings::starts();
        for (index, value) in starts.settings.iter().enumerate() {
            let _checked = match index.checked_sub(declared.own_settings) {
                None => settings.set(index, value.clone()),
                Some(rest) => solver_settings.set(rest, value.clone()),
            };
        }
        let value = |section: Section, index: usize| starts.real(declared.first(section) + index);
        let parameters = Bundle::from_fn(|i| value(Section::Parameter, i));
        let solver = Bundle::from_fn(|i| value(Section::Solver, i));
        let memory = crate::Declarations::of::<M::Memory<f64>>();
        // A model that refuses its settings is made again, and refuses aloud, at initialisation.
        let model = M::prepare(&settings, resources)
            .or_else(|_| M::prepare(&M::Settings::starts(), resources))
            .map_err(Error::Refused)?;
        let derived = model.derive(&parameters);
        let integrator = new_integrator::<M>(&solver_settings, &solver)?;
        Ok(Self {
            model,
            settings,
            solver_settings,
            resources: resources.map(Path::to_owned),
            period: M::period(&parameters),
            parameters,
            derived,
            solver,
            time: 0.0,
            start: 0.0,
            ticks: 0,
            memory: Bundle::from_fn(|i| memory[i].start),
            state: Array::from_fn(|i| value(Section::State, i)),
            input: InputPath::resting_at(Array::from_fn(|i| value(Section::Input, i))),
            rates: Array::zeros(),
            output: Array::zeros(),
            integrator,
            unprepared: true,
            underived: true,
            stale: true,
            initializing: true,
        })
    }

    /// Sets the start time and, if the master has one, the tolerance.
    ///
    /// # Errors
    /// If the time is not finite or the tolerance out of its bounds.
    pub fn set_up(&mut self, start: f64, tolerance: Option<f64>) -> Result<(), Error> {
        if !start.is_finite() {
            return Err(Error::Time(format!(
                "the start time cannot be {start}: give a finite number of seconds"
            )));
        }
        if let Some(tolerance) = tolerance
            && Layout::<M>::SOLVER > 0
        {
            let bounds = &Layout::<M>::declarations(Section::Solver)[0];
            crate::layout::check_bounds(bounds, tolerance)?;
            self.solver.tolerance = tolerance;
        }
        self.start = start;
        self.time = start;
        self.input.begin_at(start);
        self.stale = true;
        Ok(())
    }

    /// Ends initialisation.
    ///
    /// # Errors
    /// If the model refuses its settings or parameters.
    pub fn initialize(&mut self) -> Result<(), Error> {
        self.refresh()?;
        self.model.check(&self.parameters, &self.derived).map_err(Error::Refused)?;
        self.integrator = new_integrator::<M>(&self.solver_settings, &self.solver)?;
        self.initializing = false;
        self.stale = true;
        Ok(())
    }

    /// The present time in seconds.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// What the integration has cost so far.
    pub fn work(&self) -> SolverStats {
        self.integrator.work()
    }

    /// Goes from `from`, which must be the present time, to `from + size`.
    ///
    /// Ticks at or after `from` and before the end are made on the way; one at the end belongs to the
    /// next step, which then sees the inputs that are set there.
    ///
    /// # Errors
    /// If the step does not start at the present time or is not positive and finite, or if the
    /// integration fails; the simulation is then as before the step.
    // In line in the step of each version of the C interface; long parts are behind a call.
    #[inline(always)]
    pub fn step(&mut self, from: f64, size: f64) -> Result<(), Error> {
        let end = from + size;
        // Relative to the step: masters accumulate their clock in different ways.
        if !((from - self.time).abs() <= 1e-6 * size + 4.0 * f64::EPSILON * from.abs()
            && size > 0.0
            && end.is_finite())
            || end <= self.time
        {
            return Err(self.wrong_step(from, size));
        }
        if self.unprepared || self.underived {
            self.refresh()?;
        }
        match self.period {
            None if Layout::<M>::STATES == 0 => self.flow_to(end)?,
            None => self.flow_apart_to(end)?,
            Some(period) => self.flow_and_tick_to(end, period)?,
        }
        self.time = end;
        if self.input.settle(end) {
            self.stale |= Layout::<M>::STATES == 0;
        }
        Ok(())
    }

    #[cold]
    fn wrong_step(&self, from: f64, size: f64) -> Error {
        Error::Time(if !size.is_finite() || size <= 0.0 {
            format!("a communication step cannot be {size} s long: it must be positive and finite")
        } else if !(from + size).is_finite() || from + size == from {
            format!("a step of {size} s from {from} s leads nowhere: give times that a number can hold")
        } else {
            format!(
                "the communication point {from} s is not where the last step ended, {} s; \
                 step from there, or restore a saved state first",
                self.time
            )
        })
    }

    /// Integrates to `end` with the memory held. In line, for it is nearly all of a step.
    #[inline(always)]
    fn flow_to(&mut self, end: f64) -> Result<(), Error> {
        if Layout::<M>::STATES == 0 {
            self.stale = true;
        } else {
            let mut flow = Flow {
                model: &self.model,
                parameters: &self.parameters,
                derived: &self.derived,
                memory: &self.memory,
                input: &self.input,
                tick: self.ticks,
                rates: &mut self.rates,
                output: &mut self.output,
            };
            let advanced = self.integrator.advance(&mut flow, self.time, end, &mut self.state);
            if let Err(error) = advanced {
                // The last evaluation was elsewhere.
                self.stale = true;
                return Err(error.into());
            }
            // The integrator's last evaluation is the one at the end.
            self.stale = false;
        }
        self.time = end;
        Ok(())
    }

    /// The same, once for all who step.
    #[inline(never)]
    fn flow_apart_to(&mut self, end: f64) -> Result<(), Error> {
        self.flow_to(end)
    }

    /// Integrates from tick to tick; all or nothing.
    #[inline(never)]
    fn flow_and_tick_to(&mut self, end: f64, period: f64) -> Result<(), Error> {
        // A step of astronomic length would tick for ever, as would a period of zero.
        let due = end - self.tick_time(period);
        if due.is_nan() || due > MAX_TICKS * period {
            return Err(Error::Time(format!(
                "a step from {} s to {end} s has more than {MAX_TICKS} ticks of {period} s: make shorter steps",
                self.time
            )));
        }
        let before = (self.time, self.ticks, self.memory, self.state);
        let result = loop {
            let next = self.tick_time(period);
            // A tick that rounding puts just before the end belongs to the next step all the same.
            if next >= end - 1e-6 * period {
                break if end > self.time { self.flow_to(end) } else { Ok(()) };
            }
            if next > self.time
                && let Err(error) = self.flow_to(next)
            {
                break Err(error);
            }
            self.tick();
        };
        if result.is_err() {
            (self.time, self.ticks, self.memory, self.state) = before;
            self.changed();
        }
        result
    }

    fn tick_time(&self, period: f64) -> f64 {
        self.start + self.ticks as f64 * period
    }

    /// Whether the first tick is still to come: it is tried out then, so that the outputs at the start are
    /// those of the inputs at the start.
    fn before_first_tick(&self) -> bool {
        self.ticks == 0 && self.period.is_some()
    }

    /// The memory that a tick at the present time would leave.
    fn ticked(&self) -> M::Memory<f64> {
        let (state, input) =
            (from_slice(self.state.as_slice()), from_slice(self.input.at(self.time).as_slice()));
        self.model.tick(Instant {
            time: self.time,
            state: &state,
            input: &input,
            parameters: &self.parameters,
            derived: &self.derived,
            memory: &self.memory,
            tick: self.ticks,
        })
    }

    fn tick(&mut self) {
        self.memory = self.ticked();
        self.ticks += 1;
        self.changed();
    }

    /// Marks rates, outputs and the integrator's derivative as not belonging to the present.
    #[inline]
    fn changed(&mut self) {
        self.stale = true;
        self.integrator.invalidate();
    }

    /// Makes what settings and parameters lead to, where they have changed.
    fn refresh(&mut self) -> Result<(), Error> {
        if self.unprepared {
            self.model = M::prepare(&self.settings, self.resources.as_deref()).map_err(Error::Refused)?;
            self.unprepared = false;
            self.underived = true;
        }
        if self.underived {
            self.derived = self.model.derive(&self.parameters);
            self.period = M::period(&self.parameters);
            if !self.initializing {
                self.model.check(&self.parameters, &self.derived).map_err(Error::Refused)?;
            }
            // Here and not before a step: reading an output in between has to leave the step as it is.
            self.integrator.set_settings(accuracy::<M>(&self.solver)).map_err(refused)?;
            self.underived = false;
            // Whoever changed something has told the integrator; a restored one knows its own rates.
            self.stale = true;
        }
        Ok(())
    }

    /// Typical magnitudes of the states.
    pub fn nominals() -> StateArray<M> {
        let declared = Layout::<M>::declarations(Section::State);
        Array::from_fn(|i| declared[i].nominal.unwrap_or(1.0))
    }

    /// Evaluates rates and outputs, if they do not belong to the present already.
    #[inline(always)]
    fn evaluate(&mut self) -> Result<(), Error> {
        if self.unprepared || self.underived {
            self.refresh()?;
        }
        // Without states the equations are short: in line in each reader. With states they are there once.
        if self.stale && Layout::<M>::STATES == 0 {
            self.evaluate_now();
        } else if self.stale {
            self.evaluate_apart();
        }
        Ok(())
    }

    #[inline(never)]
    fn evaluate_apart(&mut self) {
        self.evaluate_now();
    }

    #[inline(always)]
    fn evaluate_now(&mut self) {
        let memory = if self.before_first_tick() { self.ticked() } else { self.memory };
        // Through the integrator's way in: one place that calls the equations is one that the compiler
        // puts them into.
        let mut flow = Flow {
            model: &self.model,
            parameters: &self.parameters,
            derived: &self.derived,
            memory: &memory,
            input: &self.input,
            tick: self.ticks,
            rates: &mut self.rates,
            output: &mut self.output,
        };
        flow.rates(self.time, &self.state);
        self.stale = false;
    }

    /// Sets the time, for an outside integrator.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
        self.changed();
    }

    /// Makes the tick that is due now, if one is; tells when the next one is due.
    ///
    /// # Errors
    /// If a changed parameter is refused.
    pub fn event(&mut self) -> Result<Option<f64>, Error> {
        self.refresh()?;
        let Some(period) = self.period else { return Ok(None) };
        if self.is_due(period) {
            self.tick();
        }
        Ok(Some(self.tick_time(period)))
    }

    fn is_due(&self, period: f64) -> bool {
        self.tick_time(period) <= self.time + 1e-6 * period
    }

    /// Whether a tick is due now.
    pub fn is_tick_due(&self) -> bool {
        self.period.is_some_and(|period| self.is_due(period))
    }

    /// When the first tick after now is due, if a step to `end` would go past it.
    ///
    /// # Errors
    /// If a changed parameter is refused.
    pub fn tick_before(&mut self, end: f64) -> Result<Option<f64>, Error> {
        self.refresh()?;
        let Some(period) = self.period else { return Ok(None) };
        let next = self.tick_time(period) + if self.is_due(period) { period } else { 0.0 };
        Ok((next < end - 1e-6 * period).then_some(next))
    }
}

/// An integrator for what the user's parameters and the states' magnitudes say about accuracy.
fn new_integrator<M: Model>(
    settings: &SolverSettings,
    solver: &Solver<f64>,
) -> Result<Integrator<StateArray<M>>, Error> {
    Integrator::new(settings.method.into(), accuracy::<M>(solver)).map_err(refused)
}

fn accuracy<M: Model>(solver: &Solver<f64>) -> strut_integrators::Settings<StateArray<M>> {
    // A model without states has no solver parameters, and nothing to integrate.
    let tolerance = if Layout::<M>::SOLVER == 0 { M::ABOUT.experiment.tolerance } else { solver.tolerance };
    let mut settings = strut_integrators::Settings::new(tolerance, &Simulation::<M>::nominals());
    if Layout::<M>::SOLVER > 0 {
        settings.max_step = solver.max_step;
    }
    settings
}

fn refused(error: InvalidSettings) -> Error {
    Error::Refused(error.to_string())
}
