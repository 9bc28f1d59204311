//! What can be said of a missing signal that no law explains: where, how much of it, on what it depends.

use crate::catalogue::Scale;
use crate::catalogue::naming::name;
use crate::decision::choice::Score;
use crate::estimation::hypothesis::{Baseline, Term};
use crate::missing::Missing;
use crate::missing::locate::Location;
use crate::missing::motion::{Mover, column, place};
use crate::missing::ports::{Entry, Port};
use crate::plant::{Plant, Signals};
use crate::report::words::digits;
use crate::signal::spectral::{below, line};

use super::features::{AGEING, Group, features};
use super::selection::Compared;
use super::signal::{over_training, signal};

/// Kurtosis beyond which a signal comes in bursts: ten percent of the time hold all of it.
const BURSTS: f64 = 8.0;
/// Share of a signal's power on either side of the band in its description.
const ASIDE: f64 = 0.1;
/// Share of a band's end below which its beginning is not worth a word.
const SLOW: f64 = 0.02;

/// Something missing that has no name.
#[derive(Clone, Debug)]
pub struct Unmodelled {
    /// Where: an element, or the name of a signal.
    pub place: String,
    /// Unit of the missing signal.
    pub unit: &'static str,
    /// The words before the place in a sentence.
    at: &'static str,
    /// What explains it: features at a port.
    features: Option<(usize, Mover, Group)>,
    /// What it depends on, in the words of the report.
    pub depends_on: Vec<String>,
    /// Share of the missing signal's power that it explains, estimation records.
    pub share: f64,
    /// The same of the validation records with the same amounts.
    pub validated: f64,
    /// By how much the fit of a signal would rise with it.
    pub improvement: f64,
    /// Amount of the only feature, where the group has one; the mass of an oscillator.
    pub amount: Option<f64>,
    /// Frequency in Hz where it has one.
    pub frequency: Option<f64>,
    /// From where to where in Hz it has most of its power, where that is all that can be said.
    pub band: Option<[f64; 2]>,
    /// The curve that the model has got in its place.
    pub curve: Option<Term>,
}

impl Unmodelled {
    /// From a comparison.
    pub fn of(
        missing: &Missing<'_>,
        compared: &Compared,
        score: Score,
        (improvement, plant): (f64, &Plant),
    ) -> Option<Self> {
        let (port, mover, group) = compared.feature(score.candidate)?;
        let own = &missing.setting.ports[port];
        let amounts = compared.amounts(score.candidate);
        let mut depends_on = words(group, mover, (missing, plant));
        if group == Group::Time {
            let (motion, _) = AGEING[compared.largest(score.candidate)];
            depends_on.splice(0..0, motion.map(str::to_owned));
        }
        Some(Self {
            place: own.place.clone(),
            unit: own.unit,
            at: at(own),
            features: Some((port, mover, group)),
            depends_on,
            share: score.share,
            validated: score.validated,
            improvement,
            amount: match group {
                // Its spring pulls with its mass times what drives it, against the motion.
                Group::Resonance(_) => Some(-amounts[0]),
                _ => (amounts.len() == 1).then(|| amounts[0]),
            },
            frequency: match group {
                Group::Resonance(oscillator) => Some(oscillator.hertz),
                _ => None,
            },
            band: None,
            curve: None,
        })
    }

    /// A curve that was fitted in the model.
    pub fn curve(term: Term, score: Score, improvement: f64, plant: &Plant) -> Self {
        let (unit, depends_on) = match term {
            Term::Table(table) => {
                let rate = (table.law.point == Scale::DAMPING).then(|| "velocity".to_owned());
                (table.unit(plant), std::iter::once(table.variable.to_owned()).chain(rate).collect())
            }
            Term::Response(output) => (plant.outputs[output].unit.symbol, vec!["memory".to_owned()]),
            Term::Effect(_) | Term::Fault(_) => ("", Vec::new()),
        };
        Self {
            place: name(term, plant).element,
            unit,
            at: if matches!(term, Term::Response(_)) { MEASURED } else { AT },
            features: None,
            depends_on,
            share: score.share,
            validated: score.validated,
            improvement,
            amount: None,
            frequency: None,
            band: None,
            curve: Some(term),
        }
    }

    /// What follows nothing that was recorded, at its likeliest place: a line, bursts, or a band.
    ///
    /// It is described and not explained: nothing predicts it, so that its shares are zero.
    pub fn remainder(missing: &Missing<'_>, location: &Location, port: usize) -> Self {
        let own = &missing.setting.ports[port];
        let signals = over_training(missing, |window| signal(missing, location, port, window).0);
        let frequency = line(&signals);
        let in_bursts = frequency.is_none() && kurtosis(&signals) > BURSTS;
        let depends_on = match frequency {
            Some(_) => vec!["time".to_owned()],
            None if in_bursts => vec!["bursts".to_owned()],
            None => Vec::new(),
        };
        Self {
            place: own.place.clone(),
            unit: own.unit,
            at: at(own),
            features: None,
            depends_on,
            share: 0.0,
            validated: 0.0,
            improvement: 0.0,
            amount: None,
            frequency,
            band: band(&signals).filter(|_| frequency.is_none() && !in_bursts),
            curve: None,
        }
    }

    /// What can be said of it in a sentence.
    pub fn description(&self) -> String {
        let words: Vec<&str> = self.depends_on.iter().map(String::as_str).collect();
        let (force, mass, unit) = match self.unit {
            "N.m" => ("torque", "moment of inertia", "kg·m²"),
            _ => ("force", "mass", "kg"),
        };
        let what = match (words.as_slice(), self.amount) {
            (["acceleration"], Some(amount)) => {
                let amount = digits(amount, 2);
                format!(
                    "a {force} that follows the acceleration, like an additional {mass} of {amount} {unit}"
                )
            }
            (["memory"], _) if self.frequency.is_some() => {
                let frequency = digits(self.frequency.unwrap_or_default(), 2);
                let like = self.amount.map_or(String::new(), |it| {
                    format!(", as of a {mass} of {} {unit} on a spring", digits(it, 2))
                });
                format!("a {force} that remembers the motion, with a resonance near {frequency} Hz{like}")
            }
            (["memory"], _) if self.at == MEASURED => {
                "a signal that depends on its own past, as behind a filter,".to_owned()
            }
            (["memory"], _) => "a signal that depends on the past motion".to_owned(),
            (["bursts"], _) => {
                "a signal that comes in bursts and that no recorded signal explains".to_owned()
            }
            (["time"], _) => match self.frequency {
                Some(frequency) => format!("a signal that is periodic in time, at {frequency:.2} Hz"),
                None => "a signal that changes with time".to_owned(),
            },
            ([motion, "work"], _) => {
                format!(
                    "a signal that follows the {motion} and changes with the work done before, as heat makes it,"
                )
            }
            ([motion, "time"], _) => format!("a signal that follows the {motion} and changes with time"),
            ([], _) => match self.band {
                Some([low, high]) if low > SLOW * high => {
                    let (low, high) = (digits(low, 2), digits(high, 2));
                    let band = match low == high {
                        true => format!("near {low} Hz"),
                        false => format!("between {low} and {high} Hz"),
                    };
                    format!("a signal {band} that no recorded signal explains")
                }
                Some([_, high]) => {
                    format!("a signal below {} Hz that no recorded signal explains", digits(high, 2))
                }
                None => "a signal that no recorded signal explains".to_owned(),
            },
            ([motion, "velocity"], _) if self.curve.is_some() => {
                format!("a damping that depends on the {motion}")
            }
            (words, _) => format!("a signal that follows the {}", words.join(" and the ")),
        };
        format!("{what} {} {}", self.at, self.place)
    }

    /// Takes it as explained.
    pub fn explain(&self, missing: &mut Missing<'_>, baseline: &Baseline<'_>, signals: &[Signals]) {
        let Some((number, mover, group)) = self.features else { return };
        let port = &missing.setting.ports[number];
        let Some(motions) = mover.motions(baseline.rig, (port, &missing.windows), signals) else { return };
        let own = features(group, &motions, (missing.records, &missing.windows));
        let place = place(&missing.setting, number);
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

/// The words before the name of a sensor's signal.
const MEASURED: &str = "in the measurement of";
/// The words before the name of an element.
const AT: &str = "at the";

/// The words before the name of a port's place.
fn at(port: &Port) -> &'static str {
    match port.entry {
        Entry::Sensor(_) => MEASURED,
        Entry::Input(_) => "at the input",
        Entry::Constant(_) => AT,
    }
}

/// What a group of features depends on, in the words of the report.
fn words(group: Group, mover: Mover, (missing, plant): (&Missing<'_>, &Plant)) -> Vec<String> {
    if let Mover::Output(output) = mover {
        let name = &plant.outputs[output].name;
        let (output, rate) = (format!("output {name}"), format!("rate of {name}"));
        match group {
            Group::Deflection => return vec![output],
            Group::Velocity => return vec![rate],
            Group::DeflectionAndVelocity => return vec![output, rate],
            Group::Acceleration => return vec![format!("second derivative of {name}")],
            _ => {}
        }
    }
    let words: &[&str] = match group {
        Group::Deflection => &["deflection"],
        Group::Velocity => &["velocity"],
        Group::Acceleration => &["acceleration"],
        Group::Memory | Group::Resonance(_) => &["memory"],
        Group::DeflectionAndVelocity => &["deflection", "velocity"],
        Group::Heat => &["velocity", "work"],
        Group::Time => &["time"],
        Group::Command(_) => &["command"],
        Group::Other(number) => return vec![format!("column {}", missing.records[0].others[number].name)],
    };
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Fourth moment over the squared second: three for noise, much more where a signal comes in bursts.
fn kurtosis(signals: &[(f64, Vec<f64>)]) -> f64 {
    let all = || signals.iter().flat_map(|(_, values)| values.iter());
    let count = all().count().max(1) as f64;
    let (two, four) = all().fold((0.0, 0.0), |(two, four), it| (two + it.powi(2), four + it.powi(4)));
    if two > 0.0 { four * count / (two * two) } else { 0.0 }
}

/// From where to where in Hz signals have four fifths of their power, a tenth on either side aside; none where they have none.
fn band(signals: &[(f64, Vec<f64>)]) -> Option<[f64; 2]> {
    Some([below(signals, ASIDE)?, below(signals, 1.0 - ASIDE)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::tables;
    use crate::rig::Rig;

    fn signal(of: impl Fn(f64) -> f64) -> Vec<(f64, Vec<f64>)> {
        vec![(0.01, (0..1000).map(|k| of(0.01 * f64::from(k))).collect())]
    }

    #[test]
    fn what_turns_has_a_moment_of_inertia() {
        let of =
            |unit: &'static str| Unmodelled { amount: Some(0.002), unit, ..at_the_strut(&["acceleration"]) };
        let told = "a torque that follows the acceleration, like an additional moment of inertia of 0.0020 kg·m² at the strut";
        assert_eq!(of("N.m").description(), told);
        assert!(
            of("N")
                .description()
                .starts_with("a force that follows the acceleration, like an additional mass of")
        );
    }

    #[test]
    fn an_oscillator_has_a_mass() {
        let it = Unmodelled { amount: Some(4.96), frequency: Some(26.3), ..at_the_strut(&["memory"]) };
        let told = "a force that remembers the motion, with a resonance near 26 Hz, as of a mass of 5.0 kg on a spring at the strut";
        assert_eq!(it.description(), told);
    }

    #[test]
    fn a_law_that_ages_is_described_with_its_motion() {
        let of = |depends_on: &[&str]| at_the_strut(depends_on).description();
        assert_eq!(of(&["time"]), "a signal that changes with time at the strut");
        let told = "a signal that follows the deflection and changes with time at the strut";
        assert_eq!(of(&["deflection", "time"]), told);
    }

    #[test]
    fn a_band_of_one_frequency_is_near_it() {
        let of = |band| Unmodelled { band: Some(band), ..at_the_strut(&[]) }.description();
        assert_eq!(of([0.331, 0.334]), "a signal near 0.33 Hz that no recorded signal explains at the strut");
        assert!(of([0.33, 0.9]).starts_with("a signal between 0.33 and 0.90 Hz"), "{}", of([0.33, 0.9]));
    }

    #[test]
    fn a_curve_of_a_damping_is_no_force_over_the_deflection() {
        let plant = Rig::published("quarter-car").unwrap().plant;
        let term = |points: &str| Term::Table(tables(&plant).find(|it| it.points == points).expect(points));
        let score = Score { candidate: 0, share: 0.9, validated: 0.9 };
        let of = |points: &str| Unmodelled::curve(term(points), score, 0.5, &plant);
        let damping = of("strut.curve.damping");
        assert_eq!(damping.depends_on, ["deflection", "velocity"]);
        assert_eq!(damping.description(), "a damping that depends on the deflection at the strut");
        let spring = of("strut.curve.over_deflection");
        assert_eq!(spring.description(), "a signal that follows the deflection at the strut");
    }

    fn at_the_strut(depends_on: &[&str]) -> Unmodelled {
        Unmodelled {
            place: "strut".into(),
            unit: "N",
            at: AT,
            features: None,
            depends_on: depends_on.iter().map(|it| (*it).to_owned()).collect(),
            share: 0.0,
            validated: 0.0,
            improvement: 0.0,
            amount: None,
            frequency: None,
            band: None,
            curve: None,
        }
    }

    #[test]
    fn a_band_holds_most_of_the_power() {
        let tau = 2.0 * std::f64::consts::PI;
        // As much power at 5, 6, … 14 Hz.
        let of = |t: f64| (5..15).map(|k| (tau * f64::from(k) * t + f64::from(k * k)).sin()).sum();
        let [low, high] = band(&signal(of)).unwrap();
        assert!((low - 5.5).abs() < 0.6 && (high - 13.5).abs() < 0.6, "{low} {high}");
        assert_eq!(band(&signal(|_| 0.0)), None);
    }

    #[test]
    fn bursts_have_a_larger_kurtosis_than_a_sine() {
        let sine = signal(|t| (2.0 * std::f64::consts::PI * 7.3 * t + 1.0).sin());
        assert!((kurtosis(&sine) - 1.5).abs() < 0.01);
        let bursts = signal(|t| if t.fract() < 0.05 { 1.0 } else { 0.0 });
        assert!(kurtosis(&bursts) > BURSTS);
    }
}
