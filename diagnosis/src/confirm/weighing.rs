//! What speaks for one fit over another.

use crate::catalogue::naming::{name, prevalence};
use crate::catalogue::{Element, Prevalence};
use crate::dataset::recorded::{Dataset, noise_floor};
use crate::decision::account::{Account, account};
use crate::decision::criteria::CRITERIA;
use crate::decision::evidence::{Evidence, Left};
use crate::diagnosis::component::Component;
use crate::estimation::comparison::{Errors, Student, student};
use crate::estimation::coordinates::{IN_TIME, TIMING};
use crate::estimation::fit::Residuals;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::unknowns::{Unknown, strain};
use crate::screening::{bent_rms, rms};
use crate::signal::distortion::Fault;

use super::has_threshold;

/// Standard deviations of a channel's timing beyond which a signal is late.
pub(super) const LATE: f64 = 5.0;

/// Share of a limited signal's power about its mean that has to be another shape than the signal's, for it to be limited.
const LIMITED: f64 = 1e-4;

impl Baseline<'_> {
    fn block(&self) -> usize {
        self.train.first().map_or(1, Dataset::block)
    }

    pub(crate) fn errors<'b>(&'b self, residuals: &'b Residuals) -> Errors<'b> {
        Errors { residuals, floor: &self.floor }
    }

    /// Noise of a measured output on the validation records: of its sensor, and of the measured inputs.
    pub(crate) fn noise(&self, row: usize) -> f64 {
        // No error is believed to be smaller than the floor of the fits.
        noise_floor(self.test, row).max(self.floor[row]).hypot(self.transmitted[row])
    }

    /// Student's t of the gain over blocks, in units of what the better fit leaves. Gains that are as `uneven` as the errors or the events
    /// behind them tell little: there, it is enough if each block's own errors shrink steadily.
    fn steadiness(&self, uneven: bool, null: &Residuals, other: &Residuals) -> Student {
        let (null, other) = (self.errors(null), self.errors(other));
        let unit = other.mean_squares();
        let gain = student(&null.gains(&other, self.block(), &unit));
        let ratio = || student(&null.ratios(&other, self.block(), &unit));
        if uneven {
            [gain, ratio()].into_iter().max_by(|a, b| a.t.total_cmp(&b.t)).unwrap_or(gain)
        } else {
            gain
        }
    }

    /// What speaks for a term by which one fit extends another; how much it explains is counted in the errors
    /// of the starting model.
    pub fn evidence(&self, term: Term, base: &Fitted, null: &Fitted, fitted: &Fitted) -> Evidence {
        let more = fitted.coordinates.len().saturating_sub(null.coordinates.len());
        let errors = self.errors(&null.train);
        // Without an effect, errors hang together as the effect does.
        let counts = self.errors(&fitted.train).effective_counts();
        let gain = 2.0 * errors.log_ratio(&self.errors(&fitted.train), &counts);
        let total: f64 = counts.iter().sum();
        let shares = |unit: &Fitted, fitted: &Fitted| self.shares_of(term, unit, fitted);
        let (before, after) = (shares(base, null), shares(base, fitted));
        let [estimation, validation] = [before[0] - after[0], before[1] - after[1]];
        let residual_reduction = everywhere(term, shares(null, fitted).map(|share| 1.0 - share));
        // It acts beyond a threshold only, or where a resonance is excited; or nearly all of the error goes, wherever it was, as at the begin of
        // what swings freely.
        let uneven = has_threshold(term) || is_resonance(term) || residual_reduction > CRITERIA.bulk;
        let steadiness = self.steadiness(uneven, &null.train, &fitted.train);
        let validated = self.steadiness(uneven, &null.test, &fitted.test);
        let expected =
            self.uses(Component::Background) && prevalence(term, &self.rig.plant) == Prevalence::Expected;
        let looks = if expected { 1.0 } else { self.looks };
        Evidence {
            delta_bic: gain - more as f64 * total.max(1.0).ln(),
            estimation_t: steadiness.t,
            p_value: (looks * steadiness.chance_of_gain()).min(1.0),
            validation_t: validated.t,
            validation_p_value: (looks * validated.chance()).min(1.0),
            variance_explained: if is_resonance(term) { estimation.max(validation) } else { validation },
            fit_improvement: everywhere(term, self.phi_gains(null, fitted)),
            residual_reduction,
            background: self.is_usual(term, fitted) && !self.is_open(&null.test),
            expected,
        }
    }

    /// A parameter that a data sheet states and that cannot be zero, as a stiffness or a mass, which a fit has driven to its end
    /// where the one without the effect has not: what needs that is not the effect.
    pub(super) fn driven_off(&self, null: &Fitted, fitted: &Fitted) -> Option<&str> {
        let at_its_end = |of: &Fitted, handle: Unknown| {
            let own = of.coordinates.iter().find(|it| it.handle == handle);
            let value = of.point.get(handle);
            own.is_some_and(|it| value <= it.bounds.0 || value >= it.bounds.1)
        };
        let declared = &self.rig.plant.parameters;
        let cannot_be_zero = |index: &usize| declared[*index].min.is_some_and(|least| least > 0.0);
        let mut stated = self.rig.base().into_iter().filter(|index| self.rig.stated[*index]);
        let gone = stated.find(|index| {
            let handle = Unknown::Parameter(*index);
            cannot_be_zero(index) && at_its_end(fitted, handle) && !at_its_end(null, handle)
        });
        gone.map(|index| declared[index].name.as_str())
    }

    /// Whether a fit has driven an effect to where its law is another one, which has a name of its own.
    pub(super) fn is_another_law(&self, term: Term, fitted: &Fitted) -> bool {
        let effect = match term {
            Term::Effect(effect) => effect,
            Term::Fault(Unknown::Input(input, Fault::Limit)) => {
                let limit = fitted.point.inputs[input].get(Fault::Limit);
                let signals = self.train.iter().filter_map(|record| record.inputs[input].measured());
                let signals: Vec<f64> = signals.flatten().copied().collect();
                return is_scaled_by_limit(&signals, limit);
            }
            _ => return false,
        };
        effect.parts.iter().any(|part| {
            let handle = self.rig.plant.parameter(part.parameter).map(Unknown::Parameter);
            let coordinate = fitted.coordinates.iter().find(|it| Some(it.handle) == handle);
            coordinate.is_some_and(|it| {
                let (value, [least, largest]) = (fitted.point.get(it.handle), part.another_at);
                least && value <= it.bounds.0 || largest && value >= it.bounds.1
            })
        })
    }

    /// Whether a delay or lag is within the usual timing of a channel, so that it is not an effect.
    pub(crate) fn is_in_time(&self, term: Term, fitted: &Fitted) -> bool {
        let of_output = match term {
            Term::Fault(handle @ Unknown::Output(..)) => {
                self.usual(handle).map(|deviation| fitted.point.get(handle).abs() / deviation)
            }
            _ => None,
        };
        late_by(term, fitted).or(of_output).is_some_and(|it| it < IN_TIME)
    }

    /// Whether every rig has a little of it. Wrong timing of an input counts, too: any of a measured input, and of a command
    /// what signals usually have.
    fn is_usual(&self, term: Term, fitted: &Fitted) -> bool {
        let plant = &self.rig.plant;
        let timing = late_by(term, fitted).is_some_and(|it| it < LATE || name(term, plant).sensor);
        self.uses(Component::Background) && (prevalence(term, plant) == Prevalence::Background || timing)
    }

    /// Whether these errors on the validation records leave the account of some signal open. What every rig has a little of leaves
    /// it closed: where it is open, no more is asked of it than of any effect.
    pub(crate) fn is_open(&self, left: &Residuals) -> bool {
        self.is_any(left, Account::is_open)
    }

    /// Whether they leave an error that the report states, whether the account is open or closed.
    pub(crate) fn leaves_something(&self, left: &Residuals) -> bool {
        self.is_any(left, Account::shows)
    }

    fn is_any(&self, left: &Residuals, what: fn(&Account, f64) -> bool) -> bool {
        let is = |(row, power): (usize, f64)| {
            what(&account(power, power, &[], self.noise(row).powi(2), 0.0), self.signal(row))
        };
        self.uses(Component::Account) && self.errors(left).mean_squares().into_iter().enumerate().any(is)
    }

    /// Whether an effect could matter that takes a share of a fit's error power, but for the noise: on both kinds of records, in some
    /// signal.
    pub(crate) fn may_matter(&self, base: &Fitted, fitted: &Fitted, share: f64) -> bool {
        let kept = (1.0 - share).max(0.0).sqrt();
        let of = |records: &[Dataset], base: &Residuals, fitted: &Residuals| {
            let roots = |it: &Residuals| self.errors(it).roots().into_iter();
            roots(base).zip(roots(fitted)).enumerate().any(|(row, (before, error))| {
                let left = (kept * error).max(self.floor[row]);
                Left { error, before, left, signal: bent_rms(records, row) }.may_matter()
            })
        };
        of(self.train, &base.train, &fitted.train) && of(self.test, &base.test, &fitted.test)
    }

    /// Mean square of a measured output on the validation records.
    pub(crate) fn signal(&self, row: usize) -> f64 {
        let values = self.test.iter().flat_map(|record| record.measured[row].values.iter().copied());
        rms(&values.collect::<Vec<_>>()).powi(2)
    }

    /// The largest rise of Φ among the signals: on the estimation and on the validation data. It is of what the model has to tell:
    /// over a short stretch, a moving drive's position is mostly a straight line.
    fn phi_gains(&self, null: &Fitted, fitted: &Fitted) -> [f64; 2] {
        let of = |records: &[Dataset], null: &Residuals, fitted: &Residuals| {
            let roots = |it: &Residuals| self.errors(it).roots().into_iter();
            let rows = roots(null).zip(roots(fitted)).enumerate();
            let gains = rows.map(|(row, (before, after))| (before - after) / bent_rms(records, row));
            gains.fold(0.0, f64::max)
        };
        [of(self.train, &null.train, &fitted.train), of(self.test, &null.test, &fitted.test)]
    }

    /// Rank of a fit among those on top of the same: half its fall of the information criterion, over all data, and what it
    /// relieves of the strain on what was known before.
    pub(super) fn score(&self, null: &Fitted, fitted: &Fitted) -> f64 {
        let part = |null: &Residuals, fitted: &Residuals| -> (f64, f64) {
            let errors = self.errors(null);
            let counts = errors.effective_counts();
            (errors.log_ratio(&self.errors(fitted), &counts), counts.iter().sum())
        };
        let ((train, n), (test, m)) = (part(&null.train, &fitted.train), part(&null.test, &fitted.test));
        let relieved = strain(&null.coordinates, &null.point) - strain(&fitted.coordinates, &fitted.point);
        train + test + relieved - 0.5 * fitted.coordinates.len() as f64 * (n + m).max(1.0).ln()
    }

    /// Student's t of how much smaller one fit's errors are than another's, over all data.
    pub(crate) fn apart(&self, better: &Fitted, other: &Fitted) -> f64 {
        self.over_blocks(better, other, Errors::gains)
    }

    /// The same where a threshold makes the differences as uneven as the events beyond it: or of how much smaller each event's
    /// errors are, if that is larger.
    pub(super) fn apart_by_events(&self, better: &Fitted, other: &Fitted) -> f64 {
        let apart = self.apart(better, other);
        let uneven = better.terms.iter().chain(&other.terms).any(|it| has_threshold(*it));
        if uneven { apart.max(self.over_blocks(better, other, Errors::ratios)) } else { apart }
    }

    fn over_blocks<'b>(
        &'b self,
        better: &'b Fitted,
        other: &'b Fitted,
        compared: fn(&Errors<'b>, &Errors<'b>, usize, &[f64]) -> Vec<f64>,
    ) -> f64 {
        let unit = self.errors(&better.train).mean_squares();
        let of = |other: &'b Residuals, better: &'b Residuals| {
            compared(&self.errors(other), &self.errors(better), self.block(), &unit)
        };
        let mut all = of(&other.train, &better.train);
        all.extend(of(&other.test, &better.test));
        student(&all).t
    }

    /// Errors left on the estimation and on the validation data together, in those of another fit: two where nothing is
    /// gained.
    pub(super) fn left(&self, unit: &Fitted, fitted: &Fitted) -> f64 {
        self.shares(unit, fitted).iter().sum()
    }

    /// Share of another fit's error that is left, on the estimation and on the validation data: mean over the signals.
    fn shares(&self, unit: &Fitted, fitted: &Fitted) -> [f64; 2] {
        [(&unit.train, &fitted.train), (&unit.test, &fitted.test)].map(|(unit, fitted)| {
            let each = self.each(unit, fitted);
            each.iter().sum::<f64>() / each.len().max(1) as f64
        })
    }

    /// The same at a term's place: of a sensor's fault or response in its own signal. Other signals, however many, and small effects
    /// in them do not count there.
    fn shares_of(&self, term: Term, unit: &Fitted, fitted: &Fitted) -> [f64; 2] {
        match term {
            Term::Response(output) | Term::Fault(Unknown::Output(output, _)) => {
                self.shares_at(output, unit, fitted)
            }
            _ => self.shares(unit, fitted),
        }
    }

    /// The same of one output.
    fn shares_at(&self, output: usize, unit: &Fitted, fitted: &Fitted) -> [f64; 2] {
        let of = |record: &Dataset| record.measured.iter().position(|it| it.output == output);
        let row = self.train.first().and_then(of);
        [(&unit.train, &fitted.train), (&unit.test, &fitted.test)]
            .map(|(unit, fitted)| row.map_or(1.0, |row| self.each(unit, fitted)[row]))
    }

    /// Share that a term explains of the errors at its place, as features there do.
    pub(crate) fn explained_there(&self, term: Term, null: &Fitted, fitted: &Fitted) -> f64 {
        everywhere(term, self.shares_of(term, null, fitted).map(|share| 1.0 - share))
    }

    /// Share of each signal's error's power.
    fn each(&self, unit: &Residuals, residuals: &Residuals) -> Vec<f64> {
        let (unit, squares) = (self.errors(unit).mean_squares(), self.errors(residuals).mean_squares());
        unit.iter().zip(&squares).map(|(unit, square)| square / unit).collect()
    }
}

/// Delay or lag of an input in standard deviations of a channel's timing; none for other terms.
/// Whether a limit makes a signal smaller as a whole, as it does where a command has two levels: then it is a gain.
fn is_scaled_by_limit(signal: &[f64], limit: f64) -> bool {
    let known = || signal.iter().filter(|it| it.is_finite()).map(|it| [*it, it.clamp(-limit, limit)]);
    let count = known().count().max(1) as f64;
    let mean = [0, 1].map(|of: usize| known().map(|it| it[of]).sum::<f64>() / count);
    let product = |a: usize, b: usize| known().map(|it| (it[a] - mean[a]) * (it[b] - mean[b])).sum::<f64>();
    let (own, limited, common) = (product(0, 0), product(1, 1), product(0, 1));
    limit > 0.0 && own * limited - common * common <= LIMITED * own * limited
}

fn late_by(term: Term, fitted: &Fitted) -> Option<f64> {
    match term {
        Term::Fault(handle @ Unknown::Input(_, Fault::Lag | Fault::Delay)) => {
            Some(fitted.point.get(handle).abs() / TIMING)
        }
        _ => None,
    }
}

/// A gain on the estimation or the validation data, whichever is less; of a resonance, whichever is more.
fn everywhere(term: Term, [train, test]: [f64; 2]) -> f64 {
    if is_resonance(term) { train.max(test) } else { train.min(test) }
}

/// Whether records that do not excite it show nothing of a term: how large it is, those tell that do. Whether it is there at
/// all, the validation data have to tell as of any other.
fn is_resonance(term: Term) -> bool {
    matches!(term, Term::Effect(effect) if effect.element == Element::FRAME)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_of_a_command_with_two_levels_is_a_gain() {
        let levels: Vec<f64> = (0..400).map(|k| if k / 7 % 3 == 0 { 5.0 } else { 0.0 }).collect();
        assert!(is_scaled_by_limit(&levels, 1.8));
        let wave: Vec<f64> = (0..400).map(|k| 5.0 * (f64::from(k) * 0.1).sin()).collect();
        assert!(!is_scaled_by_limit(&wave, 3.5) && !is_scaled_by_limit(&wave, 4.5));
        // What is never reached limits nothing.
        assert!(is_scaled_by_limit(&wave, 5.0));
    }
}
