//! The integrator that a model's owner calls.

use crate::{
    array::Array,
    control::{Stepper, Trial, accepted_factor, rejected_factor},
    error::{IntegrationError, InvalidSettings},
    explicit::DormandPrince,
    memory::Memory,
    rosenbrock::Rodas5P,
    settings::Settings,
    system::System,
};

/// How a step is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Dormand–Prince 5(4): six evaluations of the rates a step. For systems that are not stiff.
    Explicit,
    /// Rodas5P 5(4): eight evaluations of the rates, a Jacobian and a matrix inversion a step,
    /// stable for any stiffness.
    Rosenbrock,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 2] = [Method::Explicit, Method::Rosenbrock];
}

/// What was computed since the integrator was made or reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SolverStats {
    /// Evaluations of the rates.
    pub rates: u64,
    /// Evaluations of the Jacobian.
    pub jacobians: u64,
    /// Steps whose error was within the tolerance.
    pub accepted: u64,
    /// Steps that were tried and repeated shorter.
    pub rejected: u64,
    /// Matrix inversions.
    pub inversions: u64,
}

/// A call may end this much later than a step that was planned, rather than in a further tiny one.
const STRETCH: f64 = 1.01;

/// Shortest step, in units of the spacing of numbers about t (the spacing is between 1/2 and 1 of
/// `f64::EPSILON` t).
const SHORTEST: f64 = 16.0;

/// Times this close, in the same unit, are the same: a caller may add up t0 in its own way.
const SAME: f64 = 4.0;

/// Takes a [`System`] from one time to another, within tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Integrator<A: Array> {
    method: Method,
    settings: Settings<A>,
    memory: Memory<A>,
    work: SolverStats,
}

impl<A: Array> Integrator<A> {
    /// A fresh integrator.
    ///
    /// # Errors
    /// The first setting that cannot be used.
    pub fn new(method: Method, settings: Settings<A>) -> Result<Self, InvalidSettings> {
        settings.check()?;
        Ok(Integrator { method, settings, memory: Memory::new(), work: SolverStats::default() })
    }

    /// How steps are made.
    #[must_use]
    pub fn method(&self) -> Method {
        self.method
    }

    /// How accurately, and with what limits.
    #[must_use]
    pub fn settings(&self) -> &Settings<A> {
        &self.settings
    }

    /// Changes the settings from the next call on; the step size adapts to them.
    ///
    /// # Errors
    /// The first setting that cannot be used; the former ones stay.
    pub fn set_settings(&mut self, settings: Settings<A>) -> Result<(), InvalidSettings> {
        settings.check()?;
        self.settings = settings;
        Ok(())
    }

    /// What was computed since the integrator was made or reset.
    #[must_use]
    pub fn work(&self) -> SolverStats {
        self.work
    }

    /// Forgets the derivative at the end of the last call: to be called whenever the state, an
    /// input or a parameter has been changed since. The step size is kept.
    #[inline]
    pub fn invalidate(&mut self) {
        self.memory.valid = false;
    }

    /// Forgets everything but method and settings.
    pub fn reset(&mut self) {
        self.memory = Memory::new();
        self.work = SolverStats::default();
    }

    /// All that the result of later calls depends on, but for method and settings, as 4 + `A::LEN`
    /// plain words. The counters of work are not among them.
    pub fn save(&self) -> impl Iterator<Item = u64> + '_ {
        self.memory.save()
    }

    /// Takes back what `save` gave. Later calls then give the same bits as they did after it, given
    /// the same method, settings, state and system.
    ///
    /// None, and nothing changed, if words are missing or meaningless.
    #[must_use = "nothing is changed if the words are meaningless"]
    pub fn load(&mut self, words: &mut impl Iterator<Item = u64>) -> Option<()> {
        self.memory = Memory::load(words)?;
        Some(())
    }

    /// Integrates the state `x` of `system` from `t0` to exactly `t1`, in the system's unit of time.
    ///
    /// Two promises let a system keep its outputs up to date on the side:
    ///
    /// * After success the system's last call of [`System::rates`] was with t1 (to within four
    ///   units in the last place) and the bits of `x` — maybe in an earlier call of `advance`, if
    ///   t1 = t0.
    /// * That derivative opens the next call. Whoever changes the state, an input or a parameter in
    ///   between must say so by [`Integrator::invalidate`].
    ///
    /// # Errors
    /// Whenever the integration cannot be carried through; `x` is then unchanged, and the
    /// integrator as if invalidated at t0. The system has been evaluated elsewhere meanwhile (but
    /// not for [`IntegrationError::InvalidInterval`], where nothing happens at all).
    #[inline]
    pub fn advance<S: System<A>>(
        &mut self,
        system: &mut S,
        t0: f64,
        t1: f64,
        x: &mut A,
    ) -> Result<(), IntegrationError> {
        match self.method {
            Method::Explicit => self.run(DormandPrince, system, t0, t1, x),
            Method::Rosenbrock => self.run(Rodas5P::new(), system, t0, t1, x),
        }
    }

    #[inline]
    fn run<M: Stepper<A>, S: System<A>>(
        &mut self,
        mut method: M,
        system: &mut S,
        t0: f64,
        t1: f64,
        x: &mut A,
    ) -> Result<(), IntegrationError> {
        let span = t1 - t0;
        // NaN and infinite times too; against the largest number, for that is one comparison.
        if !(0.0..=f64::MAX).contains(&span) {
            return Err(IntegrationError::InvalidInterval { t0, t1 });
        }
        let near = (self.memory.time - t0).abs() <= SAME * f64::EPSILON * t0.abs();
        if !(self.memory.valid && near && self.memory.step > 0.0) {
            self.open(system, t0, span, x)?;
        }
        if span == 0.0 {
            return Ok(());
        }
        if let Err(row) = method.begin(system, t0, x) {
            self.memory.valid = false;
            return Err(IntegrationError::NotFinite { t: t0, component: row });
        }
        self.work.jacobians += M::JACOBIANS;

        // One step to the end is what most calls are; nothing here needs the controller.
        if span <= STRETCH * self.memory.step && span <= STRETCH * self.settings.max_step {
            self.work.rates += M::RATES;
            self.work.inversions += M::JACOBIANS;
            let trial = method.step(system, t0, t1, span, x, &self.memory.rates);
            if let Some(trial) = &trial
                && self.settings.comfortable(x, trial)
            {
                self.work.accepted += 1;
                *x = trial.x;
                self.memory.rates = trial.rates;
                self.memory.time = t1;
                return Ok(());
            }
            return self.control(method, system, t0, t1, x, Some(trial));
        }
        self.control(method, system, t0, t1, x, None)
    }

    /// Evaluates the rates at the start of a call, and chooses a step if there is none yet.
    #[inline(never)]
    fn open<S: System<A>>(
        &mut self,
        system: &mut S,
        t0: f64,
        span: f64,
        x: &A,
    ) -> Result<(), IntegrationError> {
        self.memory.valid = false;
        let rates = system.rates(t0, x);
        self.work.rates += 1;
        let finite = |values: &A, i: usize| values.as_slice()[i].is_finite();
        if let Some(component) = (0..A::LEN).find(|&i| !(finite(x, i) && finite(&rates, i))) {
            return Err(IntegrationError::NotFinite { t: t0, component });
        }
        if self.memory.step == 0.0 && span > 0.0 {
            self.memory.step = self.settings.first_step(system, t0, x, &rates, span);
            self.work.rates += 1;
        }
        self.memory.rates = rates;
        self.memory.time = t0;
        self.memory.valid = true;
        Ok(())
    }

    /// Steps of the length that the error allows. `tried` is a step to the end that was made but
    /// not accepted yet; in it, None stands for a singular matrix.
    #[inline(never)]
    fn control<M: Stepper<A>, S: System<A>>(
        &mut self,
        mut method: M,
        system: &mut S,
        t0: f64,
        t1: f64,
        x: &mut A,
        mut tried: Option<Option<Trial<A>>>,
    ) -> Result<(), IntegrationError> {
        let before = self.memory;
        let shortest = SHORTEST * f64::EPSILON * t0.abs().max(t1.abs());
        let mut t = t0;
        let mut y = *x;
        let mut just_rejected = false;
        let mut attempts = 0;
        let failure = loop {
            if attempts == self.settings.max_steps {
                break IntegrationError::TooManySteps { t, limit: attempts };
            }
            attempts += 1;
            let remaining = t1 - t;
            let planned = self.memory.step.min(self.settings.max_step);
            let last = remaining <= STRETCH * planned;
            let h = if last {
                remaining
            } else if remaining < 2.0 * planned {
                0.5 * remaining
            } else {
                planned
            };
            let end = if last { t1 } else { t + h };
            let trial = tried.take().unwrap_or_else(|| {
                self.work.rates += M::RATES;
                self.work.inversions += M::JACOBIANS;
                method.step(system, t, end, h, &y, &self.memory.rates)
            });

            let measured = trial.as_ref().map(|trial| self.settings.measure(&y, trial));
            if let (Some(trial), Some(Ok(squared))) = (&trial, &measured)
                && *squared <= 1.0
            {
                self.work.accepted += 1;
                let factor = accepted_factor::<A, M>(*squared, self.memory.error);
                let suggested = h * if just_rejected { factor.min(1.0) } else { factor };
                // A step cut short by the end or by the caller's limit says nothing against the
                // longer one that was planned, unless its own error is near the tolerance.
                let cut = h < self.memory.step && factor >= 1.0;
                self.memory.step = if cut { suggested.max(self.memory.step) } else { suggested };
                self.memory.error = squared.sqrt().max(1e-4);
                self.memory.rates = trial.rates;
                self.memory.time = end;
                just_rejected = false;
                y = trial.x;
                t = end;
                if last {
                    *x = y;
                    return Ok(());
                }
                if let Err(component) = method.begin(system, t, &y) {
                    break IntegrationError::NotFinite { t, component };
                }
                self.work.jacobians += M::JACOBIANS;
                continue;
            }

            self.work.rejected += 1;
            just_rejected = true;
            if h <= shortest {
                break match measured {
                    Some(Err(component)) => IntegrationError::NotFinite { t, component },
                    _ => IntegrationError::StepUnderflow { t, h },
                };
            }
            let factor = match measured {
                Some(Ok(squared)) => rejected_factor(squared),
                _ => 0.1,
            };
            self.memory.step = (factor * h).max(shortest);
        };
        // Nothing half done: neither the state, nor the step size that led into the trouble.
        self.memory = before;
        self.memory.valid = false;
        Err(failure)
    }
}
