//! A rate that a sensor of its own measures, beside the motion that it is the rate of: whether both say the same, and which of
//! them the force follows more closely.

use super::inverse::{LOWEST, Signals, below, motion};
use super::recorded::Dataset;
use crate::report::findings::DataProblem;
use crate::report::words::{digits, percent};
use crate::rig::{Inverse, Rig};
use crate::screening::rms;

/// Largest delay that is looked for, in seconds.
const LATEST: f64 = 0.05;
/// Correlation below which a rate is not that of the motion at all.
const UNRELATED: f64 = 0.7;
/// Ratio to the motion's rate, less one, beyond which it is another quantity or in another unit.
const RATIO: f64 = 0.1;
/// Share of the power that correlation at no delay misses of that at the best one, from which the rate is late.
const LATE: f64 = 0.02;

/// A measured rate beside that of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Compared {
    /// By how much it is larger.
    ratio: f64,
    /// By how many seconds it comes later; zero if the motion shows no delay.
    delay: f64,
    /// Their correlation without the delay.
    correlation: f64,
    /// Whether the force follows from it more closely than from the motion's rate.
    pub is_better: bool,
}

/// Records by the motion alone and by the measured rate, below a frequency in Hz; none if there is nothing to compare.
pub(super) fn compared(
    rig: &Rig,
    inverse: &Inverse,
    by_position: &[Dataset],
    by_rate: &[Dataset],
    top: f64,
) -> Option<Compared> {
    let signals = Signals::of(rig, inverse)?;
    let left =
        |records: &[Dataset]| records.iter().map(|it| signals.left(&below(it, top))).sum::<Option<f64>>();
    let is_closer = left(by_rate)? < left(by_position)?;
    // Where a position's rate has no noise yet.
    let slow = |records: &[Dataset]| records.iter().map(|it| below(it, LOWEST)).collect::<Vec<_>>();
    let (by_position, by_rate) = (slow(by_position), slow(by_rate));
    let rates = |records: &[Dataset]| -> Vec<Vec<f64>> {
        records.iter().map(|it| motion(it).swap_remove(signals.velocity)).collect()
    };
    let agreement = agreement(&rates(&by_position), &rates(&by_rate), by_rate.first()?.step)?;
    Some(Compared { is_better: is_closer && agreement.agrees(), ..agreement })
}

/// How measured rates go with those of the motion, record by record.
fn agreement(rates: &[Vec<f64>], measured: &[Vec<f64>], step: f64) -> Option<Compared> {
    let reach = ((LATEST / step) as usize).max(1);
    // Where the measured rate is late, it has earlier values of the motion's.
    let correlation = |late: isize| {
        let (mut products, mut ones, mut others) = (0.0, 0.0, 0.0);
        for (rate, measured) in rates.iter().zip(measured) {
            let last = rate.len().min(measured.len()).saturating_sub(reach);
            for at in reach..last {
                let (one, other) = (rate[at], measured[at.wrapping_add_signed(late)]);
                products += one * other;
                ones += one * one;
                others += other * other;
            }
        }
        products / (ones * others).sqrt()
    };
    let reach = reach as isize;
    let best = (-reach..=reach).max_by(|a, b| correlation(*a).total_cmp(&correlation(*b)))?;
    let [now, then] = [0, best].map(correlation);
    let size = |signals: &[Vec<f64>]| rms(&signals.concat());
    let is_late = now.powi(2) < (1.0 - LATE) * then.powi(2);
    then.is_finite().then(|| Compared {
        ratio: size(measured) / size(rates),
        delay: if is_late { best as f64 * step } else { 0.0 },
        correlation: then,
        is_better: false,
    })
}

impl Compared {
    fn agrees(&self) -> bool {
        self.correlation > UNRELATED && (self.ratio - 1.0).abs() < RATIO && self.delay == 0.0
    }

    /// What is to be said of it; nothing of a rate that says the same and tells no more.
    pub fn note(&self, inverse: &Inverse) -> Option<DataProblem> {
        let (signal, position) = (inverse.rate.clone()?, &inverse.position);
        let late = if self.delay > 0.0 { "late" } else { "early" };
        let text = if self.is_better {
            format!(
                "drives the model together with {position}: {} follows from it more closely than from the position's rate",
                inverse.force
            )
        } else if self.agrees() {
            return None;
        } else if self.correlation <= UNRELATED {
            format!(
                "does not go with the rate of {position} (correlation {}): it is not used",
                digits(self.correlation, 2)
            )
        } else if self.delay != 0.0 {
            format!(
                "is {} ms {late}, compared with the rate of {position}: it is not used. Check what filters or computes it",
                digits(1e3 * self.delay.abs(), 2)
            )
        } else {
            format!(
                "is {} of the rate of {position}: one of the two is wrong, and this one is not used. Check unit and gear ratio of \
                 both",
                percent(self.ratio)
            )
        };
        Some(DataProblem { record: "all".into(), signal, text, fatal: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(late: f64, size: f64) -> Vec<f64> {
        let wave = |t: f64| (5.0 * t).sin() + 0.4 * (31.0 * t + 1.0).cos();
        (0..2000).map(|k| size * wave(0.005 * f64::from(k) - late)).collect()
    }

    fn seen(measured: Vec<f64>) -> Compared {
        agreement(&[rate(0.0, 1.0)], &[measured], 0.005).unwrap()
    }

    fn told(compared: Compared) -> Option<String> {
        let inverse =
            Rig::published("linear-drive").unwrap().kind.drives.iter().find_map(|it| it.inverse.clone());
        compared.note(&inverse.unwrap()).map(|it| it.text)
    }

    #[test]
    fn the_same_rate_agrees_and_needs_no_word_unless_it_is_better() {
        let same = seen(rate(0.0, 1.02));
        assert!(same.agrees() && same.delay == 0.0 && told(same).is_none(), "{same:?}");
        assert!(told(Compared { is_better: true, ..same }).unwrap().starts_with("drives the model"));
    }

    #[test]
    fn a_late_rate_half_of_one_and_another_quantity_are_told() {
        let late = seen(rate(0.02, 1.0));
        assert!((late.delay - 0.02).abs() < 1e-9 && !late.agrees());
        assert!(told(late).unwrap().contains("20 ms late"), "{:?}", told(late));
        assert!(told(seen(rate(-0.02, 1.0))).unwrap().contains("20 ms early"));
        let half = seen(rate(0.0, 0.5));
        assert!(told(half).unwrap().contains("50 % of the rate"), "{:?}", told(half));
        let noise = crate::data::check::tests::noise(3, 2000);
        assert!(told(seen(noise)).unwrap().starts_with("does not go with"));
    }
}
