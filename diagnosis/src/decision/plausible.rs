//! Whether measured columns can be what their names and units say, by comparison with the model's signals.
//!
//! A rig with an unknown effect still moves about as its model does. A wrong unit or a mistaken column does not.

/// Ratio of measured to simulated rms, either way, that no effect and no data sheet's error explains: parameters are looked for
/// within a factor of 20 of the data sheet.
pub const FACTOR: f64 = 30.0;
/// Ratio, either way, that is left once a unit is corrected.
const NEAR: f64 = 10.0;
/// Correlation with the model from which a signal that is too large is the model's in another unit …
const ALIKE: f64 = 0.5;
/// … and one that is too small, which friction or a weak actuator makes, too.
const CLEARLY_ALIKE: f64 = 0.8;
/// Share of the error that is left where another reading of the columns fits clearly better.
const BETTER: f64 = 0.5;
/// Rms of a length in m and of its rate in m/s that no test rig reaches.
pub const FARTHEST: (f64, f64) = (3.0, 10.0);
/// Doubt about a column whose unit is missing …
const MISSING: u32 = 2;
/// … whose header names a wrong unit …
const WRONG: u32 = 5;
/// … and one whose magnitude no unit explains.
const UNEXPLAINED: u32 = 6;

/// How a measured column compares with a simulated one, both without the straight line through each segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Likeness {
    /// Measured rms over simulated rms; not finite if that cannot be told.
    pub ratio: f64,
    /// Their correlation, from −1 to 1.
    pub correlation: f64,
    /// Rms of their difference over the measured rms.
    pub error: f64,
}

/// A unit in which a column's values may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Another unit of the same quantity.
    pub unit: &'static str,
    /// Whether the header has that unit and the values are SI; otherwise the header lacks it.
    pub in_header: bool,
    /// Values as they were read, over the true ones in SI.
    pub factor: f64,
}

impl Reading {
    /// How unusual the mistake is.
    fn doubt(&self) -> u32 {
        if self.in_header { WRONG } else { MISSING }
    }
}

/// What a measured output is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Plausible {
    /// It may be what it says.
    Fine,
    /// It looks like the model's signal in another unit.
    Scaled(Reading),
    /// It is far larger or smaller than the model's signal, and no unit explains it.
    Unexplained,
}

impl Plausible {
    fn doubt(&self) -> u32 {
        match self {
            Self::Fine => 0,
            Self::Scaled(reading) => reading.doubt(),
            Self::Unexplained => UNEXPLAINED,
        }
    }
}

/// Other units in which measured values of an SI unit are usual.
pub fn usual_units(si: &str) -> &'static [&'static str] {
    match si {
        "m" => &["mm", "cm"],
        "m/s" => &["mm/s"],
        "m/s2" => &["mm/s2"],
        "rad/s2" => &["deg/s2"],
        "N" => &["kN"],
        "N.m" => &["mN.m", "kN.m"],
        "Pa" => &["bar", "MPa", "kPa"],
        "V" => &["mV"],
        "A" => &["mA"],
        "rad" => &["deg"],
        "rad/s" => &["deg/s", "rpm"],
        _ => &[],
    }
}

/// What an output is, by its likeness to the model's; `alive` tells that another output is as large as the model's, and so are
/// the inputs.
pub fn plausible(likeness: Likeness, readings: &[Reading], alive: bool) -> Plausible {
    let Likeness { ratio, correlation, .. } = likeness;
    if !ratio.is_finite() || ratio <= 0.0 || distance(ratio) <= FACTOR {
        return Plausible::Fine;
    }
    let alike =
        if ratio > 1.0 { alive || correlation.abs() >= ALIKE } else { correlation.abs() >= CLEARLY_ALIKE };
    let left = |reading: &&Reading| distance(ratio / reading.factor);
    let nearest = readings.iter().min_by(|a, b| left(a).total_cmp(&left(b)));
    match nearest.filter(|it| alike && left(it) <= NEAR) {
        Some(reading) => Plausible::Scaled(*reading),
        None => Plausible::Unexplained,
    }
}

/// A way to read the columns: an input in another unit, or all as they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// The input's number and its unit.
    pub input: Option<(usize, Reading)>,
    /// What each output is then.
    pub outputs: Vec<(Likeness, Plausible)>,
}

impl Alternative {
    /// What each output is, by its likeness and the units that it may have.
    pub fn new(input: Option<(usize, Reading)>, outputs: &[(Likeness, Vec<Reading>)]) -> Self {
        let is_usual = |it: &Likeness| it.ratio.is_finite() && distance(it.ratio) <= FACTOR;
        let usual = outputs.iter().filter(|(likeness, _)| is_usual(likeness)).count();
        let outputs =
            outputs.iter().map(|(likeness, readings)| (*likeness, plausible(*likeness, readings, usual > 0)));
        Self { input, outputs: outputs.collect() }
    }

    /// How unusual the mistakes are that have to be made for it.
    fn doubt(&self) -> u32 {
        let input = self.input.map_or(0, |(_, reading)| reading.doubt());
        input + self.outputs.iter().map(|(_, it)| it.doubt()).sum::<u32>()
    }

    /// Whether it explains the columns better than they are as they are: it asks for fewer mistakes and looks like the model
    /// where it does, or every output fits clearly better.
    fn explains_more_than(&self, as_they_are: &Self) -> bool {
        let pairs = || self.outputs.iter().zip(&as_they_are.outputs);
        let gained = |((own, now), (_, before)): (&(Likeness, Plausible), &(Likeness, Plausible))| {
            *now != Plausible::Fine || *before == Plausible::Fine || own.correlation.abs() >= CLEARLY_ALIKE
        };
        let simpler = self.doubt() < as_they_are.doubt() && pairs().all(gained);
        let fits = |((own, now), (before, _)): (&(Likeness, Plausible), &(Likeness, Plausible))| {
            *now == Plausible::Fine && own.error < BETTER * before.error.min(1.0)
        };
        simpler || pairs().all(fits)
    }
}

/// The reading of the columns that asks for the least unusual mistakes. The columns as they are come first in a tie.
pub fn chosen<'a>(as_they_are: &'a Alternative, others: &'a [Alternative]) -> &'a Alternative {
    let better = others.iter().filter(|it| it.explains_more_than(as_they_are));
    let error = |it: &Alternative| it.outputs.iter().map(|(likeness, _)| likeness.error).sum::<f64>();
    let least = better.min_by(|a, b| a.doubt().cmp(&b.doubt()).then(error(a).total_cmp(&error(b))));
    least.unwrap_or(as_they_are)
}

/// Whether a length with this rms, in m, or with this rms of its rate, in m/s, is beyond any test rig.
pub fn is_beyond_any_rig(length: f64, rate: f64) -> bool {
    length > FARTHEST.0 || rate > FARTHEST.1
}

/// Which of a motion and its rate is in another unit, by the likeness of the motion's derivative to the rate: whether it is the
/// motion, and how it is to be read. None if they go together or nothing is alike.
pub fn mismatched_rate(alike: Likeness, motion: &[Reading], rate: &[Reading]) -> Option<(bool, Reading)> {
    if !alike.ratio.is_finite() || distance(alike.ratio) <= FACTOR || alike.correlation.abs() < ALIKE {
        return None;
    }
    let left = |(is_motion, reading): &(bool, Reading)| {
        distance(if *is_motion { alike.ratio / reading.factor } else { alike.ratio * reading.factor })
    };
    let all = motion.iter().map(|it| (true, *it)).chain(rate.iter().map(|it| (false, *it)));
    let possible = all.filter(|it| left(it) <= NEAR);
    possible.min_by(|a, b| a.1.doubt().cmp(&b.1.doubt()).then(left(a).total_cmp(&left(b))))
}

/// Whether two outputs look exchanged: each one fits the other's simulated signal better than its own, and both together do
/// clearly. The first of each pair is the likeness to its own signal, the second that to the other's. An effect that makes two
/// outputs alike, such as a strut that friction locks, does as much harm to one as good to the other.
pub fn is_exchanged(one: (Likeness, Likeness), two: (Likeness, Likeness)) -> bool {
    let gain = |(own, other): (Likeness, Likeness)| other.error / own.error;
    let better = [one, two].iter().all(|it| gain(*it) < 1.0 && it.1.correlation >= ALIKE);
    better && gain(one) * gain(two) <= BETTER.powi(2)
}

/// A ratio or its inverse, whichever is above one.
fn distance(ratio: f64) -> f64 {
    ratio.max(1.0 / ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MM: Reading = Reading { unit: "mm", in_header: false, factor: 1e3 };
    const M: Reading = Reading { unit: "mm", in_header: true, factor: 1e-3 };
    const KN: Reading = Reading { unit: "kN", in_header: false, factor: 1e-3 };

    fn like(ratio: f64, correlation: f64) -> Likeness {
        // The difference of signals with these magnitudes and this correlation.
        let error = (1.0 - 2.0 * correlation / ratio + ratio.powi(-2)).max(0.0).sqrt();
        Likeness { ratio, correlation, error }
    }

    fn columns(list: &[(f64, f64, &[Reading])]) -> Vec<(Likeness, Vec<Reading>)> {
        list.iter()
            .map(|(ratio, correlation, readings)| (like(*ratio, *correlation), readings.to_vec()))
            .collect()
    }

    proptest! {
        #[test]
        fn what_an_effect_can_do_is_never_a_unit(
            log in -1.47..1.47_f64, correlation in -1.0..1.0_f64, alive: bool,
        ) {
            let it = like(10_f64.powf(log), correlation);
            prop_assert_eq!(plausible(it, &[MM, M], alive), Plausible::Fine);
        }

        /// Friction that locks a strut leaves little of its deflection, which looks like nothing in the model.
        #[test]
        fn what_is_small_and_unlike_the_model_is_no_unit(
            log in -9.0..-1.48_f64, correlation in -0.79..0.79_f64, alive: bool,
        ) {
            let it = like(10_f64.powf(log), correlation);
            prop_assert_eq!(plausible(it, &[MM, M], alive), Plausible::Unexplained);
        }

        #[test]
        fn values_in_millimetres_are_found_whatever_the_sign(
            off in 0.3..3.0_f64, correlation in 0.6..1.0_f64, sign: bool,
        ) {
            let correlation = if sign { correlation } else { -correlation };
            let it = like(1e3 * off, correlation);
            prop_assert_eq!(plausible(it, &[M, MM], false), Plausible::Scaled(MM));
        }
    }

    #[test]
    fn what_cannot_be_told_is_not_doubted() {
        for ratio in [f64::NAN, f64::INFINITY, 0.0] {
            let it = Likeness { ratio, correlation: f64::NAN, error: f64::NAN };
            assert_eq!(plausible(it, &[MM], true), Plausible::Fine);
        }
        // Nothing but ambient vibration drove the rig: all signals are large, and none is the model's.
        assert_eq!(plausible(like(1e3, 0.1), &[MM], false), Plausible::Unexplained);
        assert_eq!(plausible(like(1e3, 0.1), &[MM], true), Plausible::Scaled(MM));
    }

    /// Road and deflection in millimetres: beside them the forces and accelerations seem to be a thousand times too small.
    #[test]
    fn the_fewest_mistakes_explain_the_columns() {
        let lengths: &[Reading] = &[MM, M];
        let forces: &[Reading] = &[KN];
        let now = columns(&[(1.0, 0.95, lengths), (1e-3, 0.95, &[]), (1e-3, 0.95, forces)]);
        let now = Alternative::new(None, &now);
        let then = columns(&[(1e3, 0.95, lengths), (1.0, 0.95, &[]), (1.0, 0.95, forces)]);
        let then = Alternative::new(Some((0, MM)), &then);
        let others = [then];
        let found = chosen(&now, &others);
        assert_eq!(found.input, Some((0, MM)));
        let outputs: Vec<Plausible> = found.outputs.iter().map(|(_, it)| *it).collect();
        assert_eq!(outputs, [Plausible::Scaled(MM), Plausible::Fine, Plausible::Fine]);
    }

    #[test]
    fn one_column_is_blamed_rather_than_the_input() {
        let now = Alternative::new(None, &columns(&[(1e3, 0.9, &[MM, M]), (1.0, 0.9, &[])]));
        let then = columns(&[(1.0, 0.9, &[MM, M]), (1e-3, 0.9, &[])]);
        let others = [Alternative::new(Some((0, M)), &then)];
        assert_eq!(chosen(&now, &others).input, None);
    }

    /// A locked strut moves a hundredth of what the model does; a road in millimetres would make up for it, and does not fit.
    #[test]
    fn an_input_is_not_blamed_for_what_does_not_look_like_the_model() {
        let now = Alternative::new(None, &columns(&[(1e-2, 0.1, &[MM])]));
        let others = [Alternative::new(Some((0, MM)), &columns(&[(10.0, 0.1, &[MM])]))];
        assert_eq!(chosen(&now, &others).input, None);
        assert_eq!(chosen(&now, &others).outputs[0].1, Plausible::Unexplained);
    }

    /// Beside a road that does half of everything, a force in kilonewtons shows in the fit only.
    #[test]
    fn an_input_that_does_nothing_is_read_in_another_unit_where_all_fits_then() {
        let now = Alternative::new(None, &columns(&[(1.4, 0.7, &[]), (1.4, 0.7, &[])]));
        let fits = Alternative::new(Some((1, KN)), &columns(&[(1.0, 0.99, &[]), (1.0, 0.98, &[])]));
        assert_eq!(chosen(&now, std::slice::from_ref(&fits)).input, Some((1, KN)));
        let half = Alternative::new(Some((1, KN)), &columns(&[(1.0, 0.99, &[]), (1.2, 0.8, &[])]));
        assert_eq!(chosen(&now, std::slice::from_ref(&half)).input, None);
    }

    #[test]
    fn a_rig_moves_neither_metres_nor_at_ten_metres_per_second() {
        // A long machine axis, a fast damper; a damper in millimetres, a slow axis in millimetres.
        assert!(!is_beyond_any_rig(1.5, 1.0) && !is_beyond_any_rig(0.05, 5.0));
        assert!(is_beyond_any_rig(1.0, 32.0) && is_beyond_any_rig(200.0, 5.0));
        assert!(!is_beyond_any_rig(f64::NAN, f64::NAN));
    }

    #[test]
    fn the_column_with_the_likelier_mistake_is_blamed() {
        let rate = [
            Reading { unit: "mm/s", in_header: false, factor: 1e3 },
            Reading { unit: "mm/s", in_header: true, factor: 1e-3 },
        ];
        assert_eq!(mismatched_rate(like(1e3, 0.9), &[MM, M], &rate), Some((true, MM)));
        assert_eq!(mismatched_rate(like(1e-3, -0.9), &[MM, M], &rate), Some((false, rate[0])));
        assert_eq!(mismatched_rate(like(1e3, 0.9), &[M], &rate[..1]), None);
        // Noise that a derivative makes large is not like the rate.
        assert_eq!(mismatched_rate(like(1e3, 0.3), &[MM, M], &rate), None);
        assert_eq!(mismatched_rate(like(20.0, 0.9), &[MM, M], &rate), None);
    }

    #[test]
    fn columns_are_exchanged_only_if_both_fit_better() {
        let (bad, good) = (like(0.3, 0.4), like(1.0, 0.98));
        assert!(is_exchanged((bad, good), (like(3.0, 0.4), good)));
        assert!(!is_exchanged((bad, good), (good, bad)));
        let (fair, poor) = (like(0.9, 0.7), like(1.1, 0.5));
        assert!(!is_exchanged((poor, fair), (poor, fair)) && is_exchanged((poor, good), (bad, fair)));
        assert!(!is_exchanged((bad, good), (like(1.0, 0.99), like(1.0, 0.98))));
        let nothing = Likeness { ratio: f64::NAN, correlation: f64::NAN, error: f64::NAN };
        assert!(!is_exchanged((nothing, nothing), (nothing, nothing)));
    }
}
