//! Which candidate explains the missing signal best: a name, features, or nothing.

use super::criteria::CRITERIA;

/// How well a candidate explains the missing signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Number of the candidate.
    pub candidate: usize,
    /// Share of the estimation records' sum of squares that it takes away, less what as many columns take away by chance.
    pub share: f64,
    /// Share of the validation records' sum of squares that the same amounts take away there.
    pub validated: f64,
}

impl Score {
    /// Whether the validation records show it, too.
    pub fn is_confirmed(&self) -> bool {
        self.validated > 0.0 && self.validated >= CRITERIA.confirmed * self.share
    }
}

/// The best explanation of a missing signal.
#[derive(Clone, Debug, PartialEq)]
pub enum Choice {
    /// None.
    Nothing,
    /// Effects with a name, the best first.
    Named(Vec<Score>),
    /// A group of features without a name.
    Unmodelled(Score),
}

/// Chooses by scores alone; `misses` is the innovations' mean square in units of the sensors' accuracy, `named` and `features`
/// are in any order. A rival of the best name needs no more than a sign of itself in the validation records, and where it explains as
/// much of the estimation records, in both together: its shape is a rough one, and its fit is judged there.
pub fn choose(misses: f64, named: &[Score], features: &[Score]) -> Choice {
    if misses < 1.0 {
        return Choice::Nothing;
    }
    let (name, feature) = (best_of(named), best_of(features));
    let largest = [name, feature].into_iter().flatten().map(|it| it.share).fold(0.0, f64::max);
    if largest < CRITERIA.background_share {
        // A rough shape of a law that explains most of the estimation data may fail on others. Its fit is judged there, too.
        let most = named.iter().filter(|it| it.share >= CRITERIA.rough).copied().collect::<Vec<_>>();
        return if most.is_empty() { Choice::Nothing } else { Choice::Named(by_share(most)) };
    }
    match (name, feature) {
        (Some(name), feature) if name.share >= CRITERIA.rough * feature.map_or(0.0, |it| it.share) => {
            let near = |it: &&Score| {
                it.share >= CRITERIA.rival * name.share && it.validated > 0.0
                    || it.share >= CRITERIA.fitted * name.share && it.share + it.validated > 0.0
            };
            Choice::Named(by_share(named.iter().filter(near).copied().collect()))
        }
        (_, Some(feature)) => Choice::Unmodelled(feature),
        _ => Choice::Nothing,
    }
}

/// Names that explain more of the estimation records than background effects do, the best first, whatever the validation records say;
/// `promised` is the share of a simulation's errors that one may take, which counts as well.
pub fn likeliest(named: &[Score], promised: impl Fn(&Score) -> f64) -> Vec<Score> {
    let larger = |it: &Score| Score { share: it.share.max(promised(it)), ..*it };
    by_share(named.iter().map(larger).filter(|it| it.share >= CRITERIA.background_share).collect())
}

/// The one that explains most, of those that the validation records show, too.
pub fn best_of(all: &[Score]) -> Option<Score> {
    let holds = all.iter().filter(|it| it.is_confirmed()).copied();
    holds.max_by(|a, b| a.share.total_cmp(&b.share))
}

/// Names worth a fit although free features explain more, the best first: each explains some of both data, or nearly as much of the
/// estimation data as the features. A rough shape may fail on validation data that excite it less. Its fit is judged there, too.
pub fn likely(named: &[Score], features: &Score) -> Vec<Score> {
    let enough = CRITERIA.rough * features.share;
    let is_likely = |it: &&Score| it.share > 0.0 && (it.validated > 0.0 || it.share >= enough);
    by_share(named.iter().filter(is_likely).copied().collect())
}

/// The one that explains most first.
pub fn by_share(mut scores: Vec<Score>) -> Vec<Score> {
    scores.sort_by(|a, b| b.share.total_cmp(&a.share));
    scores
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub fn score(candidate: usize, share: f64, validated: f64) -> Score {
        Score { candidate, share, validated }
    }

    #[test]
    fn a_name_that_explains_nearly_what_free_features_do_is_fitted_with_its_rivals() {
        let named = [score(0, 0.3, 0.2), score(1, 0.5, 0.4), score(2, 0.05, 0.01)];
        // Shapes that are too rough for the validation records, or that these deny: one explains as much of the others, one less.
        let named = [&named[..], &[score(4, 0.55, 0.02), score(5, 0.9, -0.1), score(6, 0.4, -0.1)]].concat();
        let features = [score(3, 0.6, 0.5)];
        let Choice::Named(tried) = choose(2.0, &named, &features) else { panic!("a name") };
        assert_eq!(tried.iter().map(|it| it.candidate).collect::<Vec<_>>(), [5, 4, 1, 0]);
    }

    #[test]
    fn what_no_name_explains_is_unmodelled() {
        let named = [score(0, 0.2, 0.2)];
        let features = [score(1, 0.6, 0.5), score(2, 0.7, -0.1)];
        assert_eq!(choose(2.0, &named, &features), Choice::Unmodelled(features[0]));
    }

    #[test]
    fn a_name_that_only_the_validation_data_deny_is_fitted_if_it_explains_nearly_all_else() {
        let features = score(0, 0.8, 0.7);
        let [gentle, small, denied, none] =
            [score(1, 0.66, -7.8), score(2, 0.1, 0.05), score(3, 0.3, -0.1), score(4, -0.1, 0.5)];
        assert_eq!(likely(&[small, denied, none, gentle], &features), [gentle, small]);
    }

    #[test]
    fn what_is_within_the_sensors_accuracy_is_nothing() {
        assert_eq!(choose(0.9, &[score(0, 0.9, 0.9)], &[]), Choice::Nothing);
    }

    #[test]
    fn the_likeliest_names_need_not_hold_on_other_data() {
        let named = [score(0, 0.05, -0.2), score(1, 0.03, 0.9), score(2, 0.3, -4.0)];
        assert_eq!(likeliest(&named, |_| 0.0), [named[2], named[0]]);
        // What a simulation promises counts where innovations show nothing.
        let promised = likeliest(&named, |it| if it.candidate == named[1].candidate { 0.9 } else { 0.0 });
        assert!(promised.len() == 3 && promised[0].candidate == named[1].candidate, "{promised:?}");
    }

    #[test]
    fn background_and_what_the_validation_records_deny_is_nothing() {
        assert_eq!(choose(2.0, &[score(0, 0.03, 0.03)], &[score(1, 0.02, 0.1)]), Choice::Nothing);
        assert_eq!(choose(2.0, &[score(0, 0.5, -0.2)], &[score(1, 0.8, -0.1)]), Choice::Nothing);
    }

    #[test]
    fn a_law_that_explains_most_is_fitted_though_its_rough_shape_fails_on_other_data() {
        let named = [score(0, 0.7, -3.0), score(1, 0.9, -60.0), score(2, 0.3, -0.1)];
        assert_eq!(choose(2.0, &named, &[score(3, 0.02, 0.02)]), Choice::Named(vec![named[1], named[0]]));
        // Where something holds on both data, that is chosen, with what explains both together.
        let holds = score(4, 0.2, 0.2);
        assert_eq!(choose(2.0, &[&named[..], &[holds]].concat(), &[]), Choice::Named(vec![named[2], holds]));
    }
}
