//! The missing signal itself, at its likeliest place.

use crate::decision::choice::Score;
use crate::estimation::hypothesis::{Baseline, Term};
use crate::missing::Missing;
use crate::missing::locate::Location;
use crate::missing::motion::{Motion, Mover};
use crate::missing::trajectory::Window;
use crate::plant::Signals;
use crate::signal::spectral::line;

use super::features::Group;
use super::selection::Compared;

/// Samples of a missing signal that are shown.
const SHOWN: usize = 1500;
/// Relative difference of two frequencies that are the same.
const SAME_LINE: f64 = 0.02;

/// The missing signal at the likeliest place.
#[derive(Clone, Debug, Default)]
pub struct MissingSignal {
    /// Where.
    pub place: String,
    /// Its unit.
    pub unit: &'static str,
    /// Other places that the records cannot tell from it.
    pub ties: Vec<String>,
    /// Every place with the logarithm of its likelihood, less that of nothing missing.
    pub ranked: Vec<(String, f64)>,
    /// Time since the record's beginning in seconds.
    pub time: Vec<f64>,
    /// The signal.
    pub value: Vec<f64>,
    /// Its standard deviation.
    pub deviation: Vec<f64>,
    /// Deflection there; empty at a sensor.
    pub deflection: Vec<f64>,
    /// Velocity there; empty at a sensor.
    pub velocity: Vec<f64>,
}

impl MissingSignal {
    /// At the likeliest port, on the first estimation record.
    pub fn of(
        baseline: &Baseline<'_>,
        missing: &Missing<'_>,
        location: &Location,
        signals: &[Signals],
    ) -> Self {
        let ports = &missing.setting.ports;
        let Some(best) = location.ranked.first() else { return Self::default() };
        let Some(window) = missing.windows.first() else { return Self::default() };
        let (value, deviation) = signal(missing, location, best.port, window);
        let motion = Mover::Element.motions(baseline.rig, (&ports[best.port], &missing.windows), signals);
        let motion = motion.and_then(|all| all.into_iter().next());
        let Motion { deflection, velocity } =
            motion.unwrap_or(Motion { deflection: vec![], velocity: vec![] });
        let step = window.samples.len().div_ceil(SHOWN).max(1);
        let thin = |values: Vec<f64>| values.into_iter().step_by(step).collect::<Vec<_>>();
        let ties = (0..ports.len()).filter(|it| *it != best.port && missing.setting.ties[*it] == best.port);
        Self {
            place: ports[best.port].place.clone(),
            unit: ports[best.port].unit,
            ties: ties.map(|it| ports[it].place.clone()).collect(),
            ranked: location.ranked.iter().map(|it| (ports[it.port].place.clone(), it.gain)).collect(),
            time: thin(
                (0..window.samples.len()).map(|k| window.step * (window.samples.start + k) as f64).collect(),
            ),
            value: thin(value),
            deviation: thin(deviation),
            deflection: thin(deflection),
            velocity: thin(velocity),
        }
    }
}

/// Whether a missing signal that features with a memory explain is periodic by itself: a line at its likeliest place, and no multiple of
/// an input's line. A filter follows any line, by the motion that the line itself makes.
pub fn swings_by_itself(
    (missing, location, compared): (&Missing<'_>, &Location, &Compared),
    score: Score,
) -> bool {
    let memory = match compared.feature(score.candidate) {
        Some((_, _, group)) => matches!(group, Group::Memory | Group::Resonance(_)),
        None => matches!(compared.term(&score), Some(Term::Response(_))),
    };
    let Some(port) = location.ranked.first().filter(|_| memory).map(|it| it.port) else { return false };
    let own = over_training(missing, |window| signal(missing, location, port, window).0);
    let Some(frequency) = line(&own) else { return false };
    let inputs = missing.windows.first().map_or(0, |window| window.drive.inputs.len());
    let drives = |input: usize| {
        let values = |window: &Window| {
            window.drive.inputs[input].iter().step_by(window.drive.finer).copied().collect::<Vec<f64>>()
        };
        line(&over_training(missing, values)).is_some_and(|it| {
            let multiple = frequency / it;
            multiple.round() >= 1.0 && (multiple - multiple.round()).abs() < SAME_LINE * multiple
        })
    };
    !(0..inputs).any(drives)
}

/// A signal over the windows of the estimation records, each with its step in seconds.
pub(super) fn over_training(missing: &Missing<'_>, of: impl Fn(&Window) -> Vec<f64>) -> Vec<(f64, Vec<f64>)> {
    let train = missing.windows.iter().filter(|window| window.record < missing.train);
    train.map(|window| (window.step, of(window))).collect()
}

/// The missing signal at a port over a window, and its standard deviation.
pub(super) fn signal(
    missing: &Missing<'_>,
    location: &Location,
    port: usize,
    window: &Window,
) -> (Vec<f64>, Vec<f64>) {
    let mut noise = location.background.clone();
    let located = location.ranked.iter().find(|it| it.port == port);
    noise.ports[port] = noise.ports[port].max(located.map_or(0.0, |it| it.deviation));
    let before = noise.ports[..port].iter().filter(|it| **it > 0.0).count();
    let place = window.states + before;
    let moved = vec![0.0; missing.setting.parameters.len()];
    let smoothed = missing.setting.smoothed(window, &noise, &[], &moved);
    (
        smoothed.iter().map(|it| it.x[place]).collect(),
        smoothed.iter().map(|it| it.variance[place].sqrt()).collect(),
    )
}
