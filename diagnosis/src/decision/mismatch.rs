//! Which nominal parameters differ from those that the model started with.

use super::criteria::CRITERIA;

/// Relative change of a nominal parameter that matters, if it is significant.
pub const MISMATCH: f64 = 0.03;
/// Halves of an interval beyond which a change is significant: three standard deviations, as several parameters are looked at.
const SIGNIFICANT: f64 = 1.5;

/// How far a parameter has moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// By how much.
    pub change: f64,
    /// The scale of the change: the start value, or the records' forces for a force that started at zero.
    pub size: f64,
    /// Half its interval.
    pub half: f64,
    /// Half its interval if nothing that is not in the model could have moved it.
    pub half_of_noise: f64,
}

impl Moved {
    fn beyond_noise(&self) -> f64 {
        self.change / (SIGNIFICANT * self.half_of_noise)
    }
}

/// Whether each of some parameters differs, where the final model leaves a share of the starting model's error power on other data,
/// a signal's mean; `is_named` tells whether anything else is said to be wrong.
///
/// Parameters that take most of the error are not right. If none is sure by itself, since effects that are not in the model
/// could have moved it, the one that moved most beside its noise is named.
pub fn mismatched(all: &[Moved], left: f64, is_named: bool) -> Vec<bool> {
    let matters = |it: &Moved| left < 1.0 && it.change > MISMATCH * it.size;
    let mut mismatched: Vec<bool> =
        all.iter().map(|it| matters(it) && it.change > SIGNIFICANT * it.half).collect();
    let is_theirs = left < 1.0 - CRITERIA.majority && !is_named && !mismatched.contains(&true);
    let moved = all.iter().enumerate().filter(|(_, it)| is_theirs && matters(it) && it.beyond_noise() > 1.0);
    if let Some((most, _)) = moved.max_by(|(_, a), (_, b)| a.beyond_noise().total_cmp(&b.beyond_noise())) {
        mismatched[most] = true;
    }
    mismatched
}

/// The factor that each of some parameters may have in common with the others, from the ratio of each to its starting value and half the
/// interval of that; none for a parameter that has its own value. One without others shares nothing.
pub fn common_factors(ratios: &[Option<(f64, f64)>]) -> Vec<f64> {
    let of_others = |index: usize| {
        let others = ratios.iter().enumerate().filter(|(other, _)| *other != index);
        common_factor(others.filter_map(|(_, ratio)| *ratio))
    };
    ratios.iter().enumerate().map(|(index, it)| it.map_or(1.0, |_| of_others(index))).collect()
}

/// The mean of the logarithms, each by how well the records tell it.
fn common_factor(ratios: impl Iterator<Item = (f64, f64)>) -> f64 {
    let told = ratios.filter(|(ratio, half)| *ratio > 0.0 && *half > 0.0 && half.is_finite());
    let (sum, weights) = told.fold((0.0, 0.0), |(sum, weights), (ratio, half)| {
        let weight = (ratio / half).powi(2);
        (sum + weight * ratio.ln(), weights + weight)
    });
    if weights > 0.0 { (sum / weights).exp() } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_common_factor_is_that_of_the_others_that_are_told_best() {
        let [sure, vague] = [Some((1.05, 0.001)), Some((0.7, 0.5))];
        let absurd = [Some((f64::NAN, 0.1)), Some((1.2, f64::INFINITY))];
        let found = common_factors(&[sure, sure, vague, None, absurd[0], absurd[1]]);
        let wanted = [1.05, 1.05, 1.05, 1.0, 1.05, 1.05];
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-4), "{found:?}");
        // What one alone says is its own.
        assert_eq!(common_factors(&[Some((1.8, 0.1)), None]), [1.0, 1.0]);
        assert_eq!(common_factors(&[]), Vec::<f64>::new());
    }

    const SURE: Moved = Moved { change: 0.3, size: 1.0, half: 0.1, half_of_noise: 0.05 };
    const UNSURE: Moved = Moved { half: 0.25, ..SURE };

    #[test]
    fn a_change_has_to_matter_and_to_be_significant() {
        let little = Moved { change: 0.02, half: 0.001, half_of_noise: 0.001, ..SURE };
        assert_eq!(mismatched(&[SURE, UNSURE, little], 0.8, false), [true, false, false]);
        // What does not predict other data better says nothing of its parameters.
        assert_eq!(mismatched(&[SURE], 1.2, false), [false]);
    }

    #[test]
    fn where_parameters_take_most_of_the_error_one_of_them_is_named() {
        let further = Moved { half_of_noise: 0.01, ..UNSURE };
        assert_eq!(mismatched(&[UNSURE, further], 0.1, false), [false, true]);
        // Not if they take less, if another is sure, if an effect is named, or within the noise.
        assert_eq!(mismatched(&[UNSURE, further], 0.8, false), [false, false]);
        assert_eq!(mismatched(&[SURE, further], 0.1, false), [true, false]);
        assert_eq!(mismatched(&[UNSURE, further], 0.1, true), [false, false]);
        assert_eq!(mismatched(&[Moved { half_of_noise: 0.25, ..UNSURE }], 0.1, false), [false]);
    }
}
