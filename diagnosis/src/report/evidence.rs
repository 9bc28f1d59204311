//! The tests that an effect has to pass, and the evidence in words.

use super::words::{number, percent};
use crate::decision::evidence::{Evidence, Waiver};

const VALIDATION: &str = "Validation";
const ESTIMATION: &str = "Estimation";
const P_VALUE: &str = "p-value";
const EXPLAINED: &str = "Variance explained";
const IMPROVEMENT: &str = "Improvement";

/// One test.
pub struct Gate {
    /// Its name.
    pub name: &'static str,
    /// What it measures.
    pub meaning: &'static str,
    /// The result.
    pub found: String,
    /// The limit.
    pub required: String,
    /// Whether the result is beyond the limit.
    pub passed: bool,
    /// Why the limit does not apply, if so.
    pub waived: Option<&'static str>,
}

fn reason(waiver: Waiver) -> &'static str {
    match waiver {
        Waiver::Bulk => "the effect removes most of the error; its improvement varies as the error does",
        Waiver::Validated => "the validation data, which chose nothing, rule chance out",
        Waiver::Most => "the effect removes more than half of the error that was left",
        Waiver::ByFar => "the effect explains too much of the starting model's error for chance",
    }
}

/// All tests.
pub fn gates(evidence: &Evidence) -> [Gate; 6] {
    let limits = evidence.required();
    let waived = |name: &str| match name {
        VALIDATION => evidence.is_no_chance().map(reason),
        ESTIMATION | P_VALUE => evidence.is_steady_enough().map(reason),
        EXPLAINED if evidence.fit_improvement > limits.fit_improvement => {
            Some("the fit of a signal rises visibly, however far off the starting model is")
        }
        _ => None,
    };
    let gate = |name, meaning, found: f64, required: f64, print: fn(f64) -> String| Gate {
        name,
        meaning,
        found: print(found),
        required: format!("> {}", limit(required, print)),
        passed: found > required,
        waived: waived(name),
    };
    [
        gate(
            VALIDATION,
            "t of the improvement over blocks of the validation data",
            evidence.validation_t,
            limits.validation_t,
            number,
        ),
        gate(
            ESTIMATION,
            "t of the improvement over blocks of the estimation data",
            evidence.estimation_t,
            limits.estimation_t,
            number,
        ),
        Gate {
            name: P_VALUE,
            meaning: "probability that the best candidate improves the fit this consistently by chance",
            found: number(evidence.p_value),
            required: format!("< {}", limits.p_value),
            passed: evidence.p_value < limits.p_value,
            waived: waived(P_VALUE),
        },
        gate(
            "Parsimony",
            "fall of the Bayesian information criterion",
            evidence.delta_bic,
            limits.delta_bic,
            number,
        ),
        gate(
            EXPLAINED,
            "share of the starting model’s error power, validation data",
            evidence.variance_explained,
            limits.variance_explained,
            percent,
        ),
        if evidence.fit_improvement <= limits.fit_improvement
            && evidence.residual_reduction > limits.residual_reduction
        {
            let what = "residual reduction (partial R²); limit: smallest improvement of interest";
            gate(IMPROVEMENT, what, evidence.residual_reduction, limits.residual_reduction, percent)
        } else {
            let what = "largest rise of a signal’s fit; limit: smallest improvement of interest";
            gate(IMPROVEMENT, what, evidence.fit_improvement, limits.fit_improvement, number)
        },
    ]
}

/// A limit as it was set, without the digits of a result.
fn limit(value: f64, print: fn(f64) -> String) -> String {
    if print(value).ends_with('%') { print(value).replace(".0 %", " %") } else { value.to_string() }
}

/// Why the effect is believed, in sentences.
pub fn sentences(evidence: &Evidence) -> Vec<String> {
    let strength = |t: f64| match t {
        t if t.is_nan() => "not determined",
        t if t > 5.0 => "far beyond chance",
        t if t > 3.0 => "clearly beyond chance",
        t if t > Evidence::REQUIRED.validation_t => "beyond chance",
        _ => "within chance",
    };
    let t = |t: f64| format!("t\u{a0}=\u{a0}{}, {}", number(t), strength(t));
    vec![
        format!(
            "The effect improves the fit of the validation data block by block ({}).",
            t(evidence.validation_t)
        ),
        format!(
            "There it explains {} of the starting model’s error power.",
            percent(evidence.variance_explained)
        ),
        format!("It improves the fit of the estimation data, too ({}).", t(evidence.estimation_t)),
        format!(
            "The probability of such an improvement by chance is {} (p-value).",
            number(evidence.p_value)
        ),
        format!(
            "The improvement outweighs the additional parameters: the BIC falls by {}.",
            number(evidence.delta_bic)
        ),
    ]
}
