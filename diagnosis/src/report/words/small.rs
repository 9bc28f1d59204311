//! Effects that the data show and that are too small to matter.

use crate::decision::criteria::CRITERIA;
use crate::report::findings::{Candidate, Findings};

use super::{located, percent, value};

/// That no effect beyond something improves the fit, and which comes nearest to it.
pub fn none_beyond(findings: &Findings, what: &str) -> String {
    let small = |it: &&Candidate| {
        it.evidence.is_some_and(|it| it.is_small() && it.residual_reduction > CRITERIA.visible)
    };
    let gain = |it: &Candidate| it.evidence.map_or(0.0, |it| it.residual_reduction);
    let nearest = findings.candidates.iter().filter(small).max_by(|a, b| gain(a).total_cmp(&gain(b)));
    let Some(nearest) = nearest else { return format!("No effect beyond {what} improves the fit.") };
    let size = nearest
        .values
        .first()
        .map_or_else(String::new, |it| format!(" ({} = {})", it.name, value(it.value, &it.unit)));
    format!(
        "No effect beyond {what} improves the fit by as much as shows in a plot. Too small for that: {}{size} would explain {} of \
         the error that is left.",
        located(&nearest.name, &nearest.element),
        percent(gain(nearest)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decision::evidence::Evidence;

    #[test]
    fn what_is_there_but_small_is_told_with_its_size() {
        let mut findings = Findings::of_bad_data("rig", vec![], vec![], vec![]);
        assert_eq!(none_beyond(&findings, "the model"), "No effect beyond the model improves the fit.");
        let evidence = Evidence {
            delta_bic: 2000.0,
            estimation_t: 10.0,
            p_value: 0.0,
            validation_t: 10.0,
            validation_p_value: 0.0,
            variance_explained: 0.005,
            fit_improvement: 0.004,
            residual_reduction: 0.52,
            background: false,
            expected: false,
        };
        let candidate = |evidence| Candidate {
            id: "16".into(),
            element: "guide".into(),
            name: "guide friction".into(),
            share: 0.5,
            validation_share: 0.5,
            fitted: true,
            values: vec![],
            evidence: Some(evidence),
            outcome: String::new(),
        };
        findings.candidates = vec![candidate(evidence)];
        let text = none_beyond(&findings, "the model");
        assert!(text.ends_with("guide friction would explain 52 % of the error that is left."), "{text}");
        // What may be chance is not told as small.
        findings.candidates =
            vec![candidate(Evidence { validation_t: 0.0, validation_p_value: 0.5, ..evidence })];
        assert_eq!(none_beyond(&findings, "the model"), "No effect beyond the model improves the fit.");
    }
}
