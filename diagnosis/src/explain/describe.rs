//! What can be said of a missing signal that no law explains: where, how much of it, on what it depends.

use crate::catalogue::naming::name;
use crate::estimation::hypothesis::{Term, World};
use crate::missing::Missing;
use crate::missing::innovations::Noise;
use crate::missing::locate::Location;
use crate::plant::{Plant, Signals};

use super::candidates::motions;
use super::features::{Group, Motion, column, features};
use super::selection::{Compared, Score};

/// Smallest rise of a signal's fit that is worth telling of where no law can be told: what background effects cost.
pub const SMALLEST: f64 = 0.03;
/// Samples of a missing signal that are shown.
const SHOWN: usize = 1500;

/// Something missing that has no name.
#[derive(Clone, Debug)]
pub struct Unmodelled {
    /// Where: an element, or the name of a signal.
    pub place: String,
    /// Unit of the missing signal.
    pub unit: &'static str,
    /// What explains it: features at a port.
    features: Option<(usize, Group)>,
    /// What it depends on, in the words of the report.
    pub depends_on: Vec<&'static str>,
    /// Share of the missing signal's power that it explains, estimation records.
    pub share: f64,
    /// The same of the validation records with the same amounts.
    pub validated: f64,
    /// By how much the fit of a signal would rise with it.
    pub improvement: f64,
    /// Amount of the only feature, where the group has one.
    pub amount: Option<f64>,
    /// Frequency in Hz where it has one.
    pub frequency: Option<f64>,
    /// The curve that the model has got in its place.
    pub curve: Option<Term>,
}

impl Unmodelled {
    /// From a comparison.
    pub fn of(missing: &Missing<'_>, compared: &Compared, score: Score, improvement: f64) -> Option<Self> {
        let (port, group) = compared.feature(score.candidate)?;
        let own = &missing.setting.ports[port];
        let amounts = compared.amounts(score.candidate);
        Some(Self {
            place: own.place.clone(),
            unit: own.unit,
            features: Some((port, group)),
            depends_on: words(group).to_vec(),
            share: score.share,
            validated: score.validated,
            improvement,
            amount: (amounts.len() == 1).then(|| amounts[0]),
            frequency: None,
            curve: None,
        })
    }

    /// A curve that was fitted in the model.
    pub fn curve(term: Term, score: Score, improvement: f64, plant: &Plant) -> Self {
        let (unit, depends_on) = match term {
            Term::Table(table) => ("N", vec![table.variable]),
            Term::Response(output) => (plant.outputs[output].unit.symbol, vec!["memory"]),
            Term::Cause(_) | Term::Fault(_) => ("", Vec::new()),
        };
        Self {
            place: name(term, plant).element,
            unit,
            features: None,
            depends_on,
            share: score.share,
            validated: score.validated,
            improvement,
            amount: None,
            frequency: None,
            curve: Some(term),
        }
    }

    /// What can be said of it in a sentence.
    pub fn description(&self) -> String {
        let what = match (self.depends_on.as_slice(), self.amount) {
            (["acceleration"], Some(amount)) => {
                format!("a force that follows the acceleration, like an additional mass of {amount:.3} kg")
            }
            (["bursts"], _) => {
                "a signal that comes in bursts and follows nothing that was recorded".to_owned()
            }
            (["time"], _) => match self.frequency {
                Some(frequency) => format!("a signal that is periodic in time, at {frequency:.2} Hz"),
                None => "a signal that changes with time".to_owned(),
            },
            ([], _) => "a signal that follows nothing that was recorded".to_owned(),
            (words, _) => format!("a signal that follows the {}", words.join(" and the ")),
        };
        let at = if self.place.contains('.') { "in the measurement of" } else { "at the" };
        let share = (100.0 * self.share).round();
        format!("{what} {at} {} ({share} % of what is missing there)", self.place)
    }

    /// Takes it as explained.
    pub fn explain(&self, missing: &mut Missing<'_>, world: &World<'_>, signals: &[Signals]) {
        let Some((number, group)) = self.features else { return };
        let Some((place, motions)) = motions(world, missing, signals, number) else { return };
        let own = features(group, &motions, &missing.windows);
        let port = &missing.setting.ports[number];
        let columns: Vec<_> = own
            .iter()
            .map(|feature| {
                missing
                    .windows
                    .iter()
                    .zip(feature)
                    .map(|(window, signal)| column(port, place, window, signal))
                    .collect()
            })
            .collect();
        missing.explain(columns.into_iter());
    }
}

/// What a group of features depends on, in the words of the report.
fn words(group: Group) -> &'static [&'static str] {
    match group {
        Group::Deflection => &["deflection"],
        Group::Velocity => &["velocity"],
        Group::Acceleration => &["acceleration"],
        Group::Memory => &["memory"],
        Group::DeflectionAndVelocity => &["deflection", "velocity"],
        Group::Time => &["time"],
        Group::Command(_) => &["command"],
    }
}

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
    pub fn of(world: &World<'_>, missing: &Missing<'_>, location: &Location, signals: &[Signals]) -> Self {
        let ports = &missing.setting.ports;
        let Some(best) = location.ranked.first() else { return Self::default() };
        let noise = location.noise();
        let Some(window) = missing.windows.first() else { return Self::default() };
        let smoothed =
            missing.setting.smoothed(window, &noise, &[], &vec![0.0; missing.setting.parameters.len()]);
        let place = window.states + entered(&noise, best.port);
        let motion = motions(world, missing, signals, best.port).and_then(|(_, all)| all.into_iter().next());
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
            value: thin(smoothed.iter().map(|it| it.x[place]).collect()),
            deviation: thin(smoothed.iter().map(|it| it.variance[place].sqrt()).collect()),
            deflection: thin(deflection),
            velocity: thin(velocity),
        }
    }
}

/// How many ports before one are in the filter.
fn entered(noise: &Noise, port: usize) -> usize {
    noise.ports[..port].iter().filter(|it| **it > 0.0).count()
}
