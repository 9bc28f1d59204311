//! What may be the matter: a set of terms that are added to the starting model, and the fit with them.

use nalgebra::DVector;
use strut_model::Value;

use crate::catalogue::{Effect, Element, Table, Typical};
use crate::dataset::recorded::Dataset;
use crate::dataset::split::Split;
use crate::diagnosis::Options;
use crate::diagnosis::component::Component;
use crate::estimation::deadline::Deadline;
use crate::estimation::fit::{Fit, Residuals, Trace};
use crate::estimation::lsq::{self, Linear, Problem, Stop};
use crate::estimation::unknowns::{Estimate, FreeParameter, Unknown};
use crate::plant::Dynamics;
use crate::rig::Rig;

/// Time over which the velocity at a section's start is guessed from a measured position, in seconds.
const RATE: f64 = 0.02;

/// Something that is added to the starting model.
#[derive(Clone, Copy, Debug)]
pub enum Term {
    /// An effect with a name.
    Effect(&'static Effect),
    /// A force without a name.
    Table(&'static Table),
    /// What a sensor or an actuator makes of a signal.
    Fault(Unknown),
    /// A linear response of a sensor without a name, by its output's index.
    Response(usize),
}

impl PartialEq for Term {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Effect(a), Self::Effect(b)) => std::ptr::eq(*a, *b),
            (Self::Table(a), Self::Table(b)) => std::ptr::eq(*a, *b),
            (Self::Fault(a), Self::Fault(b)) => a == b,
            (Self::Response(a), Self::Response(b)) => a == b,
            _ => false,
        }
    }
}

/// What all hypotheses share: the rig, its records, and what is known before an effect is added.
#[derive(Clone)]
pub struct Baseline<'a> {
    /// The rig.
    pub rig: &'a Rig,
    /// The records of the estimation data.
    pub train: &'a [Dataset],
    /// The records that judge.
    pub test: &'a [Dataset],
    /// Both, estimation records first, without divisions.
    pub whole: &'a [Dataset],
    /// Typical magnitudes of each element.
    pub typical: Vec<(Element, Typical)>,
    /// Parameters before any simulation is fitted: the rig's, and where it states none those of a balance.
    pub sheet: Vec<f64>,
    /// What was known of parameters before: index, value, standard deviation.
    pub known: Vec<(usize, f64, f64)>,
    /// The parameter that keeps its value where the records do not tell the common scale, by its index; it is among those that are known.
    pub yardstick: Option<usize>,
    /// Numbers of the effects that are looked at; none: all.
    pub only: Vec<String>,
    /// A component of the method that is left out, for an ablation.
    pub without: Option<Component>,
    /// Number of independent looks at the errors that comparing every effect to them amounts to.
    pub looks: f64,
    /// Where fits of terms that come in several shapes may begin.
    pub shapes: Vec<(Term, Estimate)>,
    /// What each term promises to take from the errors of the starting model's simulation, as a share of the sum of squares.
    pub promised: Vec<(Term, f64)>,
    /// Standard deviation of each output's residuals.
    pub sigma: Vec<f64>,
    /// The least noise that is believed of each measured output, in the order of a record's.
    pub floor: Vec<f64>,
    /// What noise of the measured inputs makes of each of them by way of the fitted starting model, as a root mean square on the
    /// validation data.
    pub transmitted: Vec<f64>,
    /// Until when it may be looked further.
    pub deadline: Deadline,
}

/// A hypothesis with its parameters fitted.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// What was added to the starting model.
    pub terms: Vec<Term>,
    /// The coordinates of the fit.
    pub coordinates: Vec<FreeParameter>,
    /// Values, with the states at the start of the estimation sections.
    pub point: Estimate,
    /// The linearisation there.
    pub linear: Linear,
    /// What linearising left behind.
    pub trace: Trace,
    /// Half the weighted sum of squares on the estimation data.
    pub cost: f64,
    /// Errors on the estimation data.
    pub train: Residuals,
    /// Errors on the validation data.
    pub test: Residuals,
}

impl Fitted {
    /// Gradients of what was known before, each of which is off by its own standard deviation: all of it, or what somebody vouches
    /// for.
    pub fn priors(&self, vouched_for: bool) -> Vec<DVector<f64>> {
        let slope = |coordinate: &FreeParameter| {
            coordinate.prior.filter(|it| !vouched_for || it.is_vouched_for())?;
            Some(coordinate.distance(&self.point)?.1)
        };
        let count = self.coordinates.len();
        let slopes = self.coordinates.iter().map(slope).enumerate();
        let gradient = |(index, slope): (usize, Option<f64>)| {
            let mut gradient = DVector::zeros(count);
            gradient[index] = slope?;
            Some(gradient)
        };
        slopes.filter_map(gradient).collect()
    }
}

/// A point with each coordinate within its bounds.
fn within(point: &Estimate, coordinates: &[FreeParameter]) -> Estimate {
    let mut point = point.clone();
    for FreeParameter { handle, bounds: (low, high), .. } in coordinates {
        point.set(*handle, point.get(*handle).max(*low).min(*high));
    }
    point
}

impl<'a> Baseline<'a> {
    /// What hypotheses are about, before anything is known of it.
    pub fn new(rig: &'a Rig, records: &'a Split, options: Options) -> Self {
        Self {
            rig,
            train: &records.train,
            test: &records.test,
            whole: &records.whole,
            typical: Vec::new(),
            sheet: rig.parameters.clone(),
            known: options.known,
            yardstick: None,
            only: options.only,
            without: options.without,
            looks: 1.0,
            shapes: Vec::new(),
            promised: Vec::new(),
            sigma: vec![1.0; rig.plant.outputs.len()],
            floor: Vec::new(),
            transmitted: Vec::new(),
            deadline: options.deadline,
        }
    }
}

impl Baseline<'_> {
    /// Whether a component of the method is used.
    pub fn uses(&self, component: Component) -> bool {
        self.without != Some(component)
    }

    /// Typical magnitudes of an element.
    pub fn typical(&self, element: Element) -> Typical {
        let found = self.typical.iter().find(|(of, _)| *of == element);
        found.map_or(Typical { force: 1.0, deflection: 1.0, velocity: 1.0, pitch: 1.0 }, |(_, typical)| {
            *typical
        })
    }

    /// The point that everything starts from.
    pub fn origin(&self) -> Estimate {
        let point = Estimate::undistorted(&self.rig.plant, &self.rig.parameters);
        Estimate { starts: self.starts(self.train), ..point }
    }

    /// A first guess of the states at the start of each section: what was measured of them or follows from it,
    /// otherwise the rig's own.
    pub fn starts(&self, records: &[Dataset]) -> Vec<Vec<f64>> {
        let plant = &self.rig.plant;
        let of = |record: &Dataset, at: usize| {
            let mut start = self.rig.start.clone();
            for measured in &record.measured {
                let (output, value) = (&plant.outputs[measured.output].name, measured.values[at]);
                if let Some(state) = self.rig.shown(output).filter(|_| value.is_finite()) {
                    start[state] = value;
                }
                // A body that starts at rest may stick, and where nothing but its position is measured, nothing tells how
                // fast it was.
                let alone = (record.measured.len() == 1).then_some(output);
                let rate =
                    alone.and_then(|it| self.rig.shown(&format!("{}velocity", it.strip_suffix("position")?)));
                let span = ((RATE / record.step) as usize).max(3);
                if let (Some(state), Some(later)) = (rate, measured.values.get(at + span))
                    && later.is_finite()
                    && value.is_finite()
                {
                    start[state] = (later - value) / (span as f64 * record.step);
                }
            }
            start
        };
        let sections =
            records.iter().flat_map(|it| it.sections.iter().map(move |section| (it, section.start)));
        sections.map(|(record, at)| of(record, at)).collect()
    }

    /// The settings with the terms.
    pub fn choices(&self, terms: &[Term]) -> Vec<Value> {
        let mut choices = self.rig.choices.clone();
        for term in terms {
            if let Term::Effect(Effect { setting: Some(setting), .. }) = term
                && let Some(index) = self.rig.plant.setting(setting)
            {
                choices[index] = Value::Boolean(true);
            }
        }
        choices
    }

    /// The equations with the terms.
    ///
    /// # Errors
    /// The model's own words.
    pub fn dynamics(&self, terms: &[Term]) -> Result<Box<dyn Dynamics>, String> {
        self.rig.plant.prepare(&self.choices(terms))
    }

    /// The fit of some records with the terms.
    pub fn fit<'b>(
        &'b self,
        dynamics: &'b dyn Dynamics,
        records: &'b [Dataset],
        coordinates: Vec<FreeParameter>,
    ) -> Fit<'b> {
        Fit::new(&self.rig.plant, dynamics, records, coordinates, self.sigma.clone())
    }

    /// Fits a hypothesis from the best of several points.
    ///
    /// # Errors
    /// If the model refuses its settings, or diverges from every point.
    pub fn fitted(&self, terms: &[Term], starts: &[Estimate], stop: Stop) -> Result<Fitted, String> {
        let stop = Stop { until: self.deadline.instant(), ..stop };
        let dynamics = self.dynamics(terms)?;
        let coordinates = self.coordinates(terms);
        let fit = self.fit(&*dynamics, self.train, coordinates.clone());
        let starts = starts
            .iter()
            .map(|start| within(start, &coordinates))
            .filter(|start| fit.cost(start).is_finite())
            .map(|start| fit.settled(start));
        let mut best =
            lsq::minimise_from(&fit, starts, stop).ok_or("the simulation diverges from every start")?;
        if let Some(point) = self.out_of_reach(&fit, terms, (&best.point, best.cost)) {
            best.cost = fit.cost(&point);
            (best.linear, best.trace) = fit.linearise(&point);
            best.point = point;
        }
        let train = fit.residuals(&best.point);
        let test = self.held_out(&*dynamics, &best.point);
        Ok(Fitted {
            terms: terms.to_vec(),
            coordinates,
            linear: best.linear,
            trace: best.trace,
            cost: best.cost,
            point: best.point,
            train,
            test,
        })
    }

    /// A minimum with its unreached thresholds moved to their upper bounds, if it has any. The estimation records tell nothing of
    /// a stop that they do not reach, and other records may move further.
    fn out_of_reach(
        &self,
        fit: &Fit<'_>,
        terms: &[Term],
        (point, cost): (&Estimate, f64),
    ) -> Option<Estimate> {
        let samples: usize = self.train.iter().map(|it| it.len() * it.measured.len()).sum();
        // The Bayesian information criterion asks this of one parameter more.
        let most = cost + 0.5 * (samples as f64).ln();
        let mut farthest: Option<Estimate> = None;
        for threshold in terms.iter().flat_map(|term| self.thresholds(*term)) {
            let mut moved = farthest.as_ref().unwrap_or(point).clone();
            moved.set(threshold.handle, threshold.bounds.1);
            if moved.get(threshold.handle) != point.get(threshold.handle) && fit.cost(&moved) <= most {
                farthest = Some(moved);
            }
        }
        farthest
    }

    /// The point of the validation data: the same parameters, states at the start of their own.
    pub fn held_out_point(&self, dynamics: &dyn Dynamics, point: &Estimate) -> Estimate {
        let point = Estimate { starts: self.starts(self.test), ..point.clone() };
        self.fit(dynamics, self.test, Vec::new()).settled(point)
    }

    pub(crate) fn held_out(&self, dynamics: &dyn Dynamics, point: &Estimate) -> Residuals {
        let point = self.held_out_point(dynamics, point);
        self.fit(dynamics, self.test, Vec::new()).residuals(&point)
    }
}
