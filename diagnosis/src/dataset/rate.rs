//! A rate that a sensor of its own measures, beside the motion that it is the rate of: whether both say the same, and which of
//! them the force follows more closely.

use super::inverse::{LOWEST, Signals, below, motion};
use super::recorded::{Dataset, without_line};
use crate::data::check::DataProblem;
use crate::report::words::{digits, percent};
use crate::rig::{Inverse, Rig};
use crate::signal::integral;

/// Correlation below which a rate is not that of the motion at all.
const UNRELATED: f64 = 0.7;
/// Ratio to the motion's rate, less one, beyond which it is another quantity or in another unit.
const RATIO: f64 = 0.1;
/// Share of what the two have not in common that a delay has to take away before the rate is late.
const LATE: f64 = 0.5;

/// Sum of a rate times the steps of a motion: negative if it goes against it.
pub(crate) fn along(rate: &[f64], motion: &[f64]) -> f64 {
    let steps = motion.windows(2).map(|pair| pair[1] - pair[0]);
    rate.iter().zip(steps).map(|(rate, step)| rate * step).filter(|it| it.is_finite()).sum()
}

/// How a measured rate goes with that of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Agreement {
    /// By how much it is larger.
    pub ratio: f64,
    /// By how many seconds it comes later; zero if the motion shows no delay.
    delay: f64,
    /// Their correlation, without the delay.
    correlation: f64,
}

/// A measured rate beside that of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Compared {
    agreement: Agreement,
    /// Whether the force follows from it more closely than from the motion's rate.
    pub is_better: bool,
}

/// Records by the motion alone and by the measured rate, below a frequency in Hz; none if there is nothing to compare. The rates are
/// compared, or of a coarse position the position with the integral of the rate.
pub(super) fn compared(
    rig: &Rig,
    inverse: &Inverse,
    by_position: &[Dataset],
    by_rate: &[Dataset],
    (top, is_coarse): (f64, bool),
) -> Option<Compared> {
    let signals = Signals::of(rig, inverse)?;
    let left =
        |records: &[Dataset]| records.iter().map(|it| signals.left(&below(it, top))).sum::<Option<f64>>();
    let is_closer = left(by_rate)? < left(by_position)?;
    let mut all: [Vec<f64>; 3] = Default::default();
    for (plain, with_rate) in by_position.iter().zip(by_rate) {
        let (plain, with_rate) = (below(plain, LOWEST), below(with_rate, LOWEST));
        let parts = if is_coarse {
            summed(signals, &plain, &with_rate)?
        } else {
            rates(signals, &plain, &with_rate)?
        };
        all.iter_mut().zip(parts).for_each(|(all, part)| all.extend(part));
    }
    let [motion, change, measured] = &all;
    let agreement = Agreement::of([motion, change], measured, by_rate.first()?.step)?;
    Some(Compared { is_better: is_closer && agreement.agrees(), agreement })
}

/// The rate of a record's position, its change, and the measured rate.
fn rates(signals: Signals, by_position: &Dataset, by_rate: &Dataset) -> Option<[Vec<f64>; 3]> {
    let (mut known, mut measured) = (motion(by_position), motion(by_rate));
    let mut take = |input: usize| known.get_mut(input).map(std::mem::take);
    Some([
        take(signals.velocity)?,
        take(signals.derivative)?,
        measured.get_mut(signals.velocity).map(std::mem::take)?,
    ])
}

/// A record's position, the measured rate, and what that adds up to, each without the straight line through each section. The steps
/// of a coarse position are all of its rate, and little of the position itself.
fn summed(signals: Signals, by_position: &Dataset, by_rate: &Dataset) -> Option<[Vec<f64>; 3]> {
    let position = motion(by_position).into_iter().nth(signals.position)?;
    let rate = motion(by_rate).into_iter().nth(signals.velocity)?;
    let mut all: [Vec<f64>; 3] = Default::default();
    for section in &by_position.sections {
        let (position, rate) = (position.get(section.clone())?, rate.get(section.clone())?);
        let parts = [position.to_vec(), rate.to_vec(), integral(rate, by_rate.step)];
        all.iter_mut().zip(parts).for_each(|(all, part)| all.extend(without_line(&part)));
    }
    Some(all)
}

impl Agreement {
    /// How a measured rate goes with that of the motion, whose own rate is `change`; both were sampled every `step` seconds. Also for
    /// the integral of a measured rate beside the motion, whose rate it is.
    pub fn of([rate, change]: [&[f64]; 2], measured: &[f64], step: f64) -> Option<Self> {
        let product =
            |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(one, other)| one * other).sum::<f64>();
        let (rates, changes, both) = (product(rate, rate), product(change, change), product(rate, change));
        let (with_rate, with_change) = (product(measured, rate), product(measured, change));
        let power = product(measured, measured);
        // By least squares, the measured rate is so much of the motion's and of its change: what is late has less of it.
        let determinant = rates * changes - both * both;
        let amount = (with_rate * changes - with_change * both) / determinant;
        let changing = (with_change * rates - with_rate * both) / determinant;
        let in_time = with_rate.powi(2) / (rates * power);
        let late = (amount * with_rate + changing * with_change) / power;
        let delay = -changing / amount;
        let is_late = 1.0 - late < (1.0 - LATE) * (1.0 - in_time) && delay.abs() > step;
        let delay = if is_late { delay } else { 0.0 };
        let correlation = (if is_late { late } else { in_time }).sqrt() * amount.signum();
        let ratio = (power / rates).sqrt();
        correlation.is_finite().then_some(Self { ratio, delay, correlation })
    }

    /// Whether the two are of one motion.
    pub fn is_related(&self) -> bool {
        self.correlation > UNRELATED
    }

    fn agrees(&self) -> bool {
        self.is_related() && (self.ratio - 1.0).abs() < RATIO && self.delay == 0.0
    }

    /// By how much the measured one is late or early, in words; none if it is in time.
    pub fn late(&self) -> Option<String> {
        let word = if self.delay > 0.0 { "late" } else { "early" };
        (self.delay != 0.0).then(|| format!("{} ms {word}", digits(1e3 * self.delay.abs(), 2)))
    }
}

impl Compared {
    /// What is to be said of it; nothing of a rate that says the same and tells no more.
    pub fn note(&self, inverse: &Inverse) -> Option<DataProblem> {
        let (signal, position) = (inverse.rate.clone()?, &inverse.position);
        let agreement = self.agreement;
        let text = if self.is_better {
            format!(
                "drives the model together with {position}: {} follows from it more closely than from the position's rate",
                inverse.force
            )
        } else if agreement.agrees() {
            return None;
        } else if !agreement.is_related() {
            format!(
                "does not go with the rate of {position} (correlation {}): it is not used",
                digits(agreement.correlation, 2)
            )
        } else if (agreement.ratio - 1.0).abs() > RATIO {
            format!(
                "is {} of the rate of {position}: one of the two is wrong, and this one is not used. Check unit and gear ratio of \
                 both",
                percent(agreement.ratio)
            )
        } else {
            format!(
                "is {}, compared with the rate of {position}: it is not used. Check what filters or computes it",
                agreement.late().unwrap_or_default()
            )
        };
        Some(DataProblem { record: "all".into(), signal, text, fatal: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.005;

    fn wave(of: fn(f64) -> f64) -> Vec<f64> {
        (0..2000).map(|k| of(STEP * f64::from(k))).collect()
    }

    fn rate(t: f64) -> f64 {
        (5.0 * t).sin() + 0.4 * (31.0 * t + 1.0).cos()
    }

    fn seen(measured: &[f64]) -> Agreement {
        let change = wave(|t| 5.0 * (5.0 * t).cos() - 12.4 * (31.0 * t + 1.0).sin());
        Agreement::of([&wave(rate), &change], measured, STEP).unwrap()
    }

    fn told(agreement: Agreement) -> Option<String> {
        noted(Compared { agreement, is_better: false })
    }

    fn noted(compared: Compared) -> Option<String> {
        let inverse =
            Rig::published("linear-drive").unwrap().kind.drives.iter().find_map(|it| it.inverse.clone());
        compared.note(&inverse.unwrap()).map(|it| it.text)
    }

    /// Of 2 mm steps in a motion of 10 mm, the rate is lost; what the measured one adds up to is the motion.
    #[test]
    fn a_coarse_position_does_not_belie_its_rate() {
        let fine = wave(|t| 0.01 * (5.0 * t).sin());
        let coarse: Vec<f64> = fine.iter().map(|x| 2e-3 * (x / 2e-3).round()).collect();
        let rate = wave(|t| 0.05 * (5.0 * t).cos());
        let whole = |values: &[f64]| without_line(values);
        let summed = integral(&rate, STEP);
        let found = Agreement::of([&whole(&coarse), &rate], &whole(&summed), STEP).unwrap();
        assert!(found.agrees() && (found.ratio - 1.0).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn the_same_rate_agrees_and_needs_no_word_unless_it_is_better() {
        let same = seen(&wave(|t| 1.02 * rate(t)));
        assert!(same.agrees() && same.delay == 0.0 && told(same).is_none(), "{same:?}");
        assert!(
            noted(Compared { agreement: same, is_better: true }).unwrap().starts_with("drives the model")
        );
    }

    #[test]
    fn a_late_rate_half_of_one_and_another_quantity_are_told() {
        let late = seen(&wave(|t| rate(t - 0.01)));
        assert!((late.delay - 0.01).abs() < 5e-4 && !late.agrees(), "{late:?}");
        assert!(told(late).unwrap().contains(" ms late"), "{:?}", told(late));
        assert!(told(seen(&wave(|t| rate(t + 0.01)))).unwrap().contains(" ms early"));
        // What a difference to the sample before makes of it is no delay.
        assert!(seen(&wave(|t| rate(t - 0.0025))).agrees());
        let half = seen(&wave(|t| 0.5 * rate(t)));
        assert!(told(half).unwrap().contains("50 % of the rate"), "{:?}", told(half));
        let noise = crate::signal::random::white(3, 2000);
        assert!(told(seen(&noise)).unwrap().starts_with("does not go with"));
    }
}
