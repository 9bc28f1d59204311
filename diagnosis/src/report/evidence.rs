//! The gates that an effect has to pass, and what they say in words.

use super::words::{number, percent};
use crate::report::findings::Evidence;

const HELD_OUT: &str = "Held-out data";
const TRAINING: &str = "Training data";
const CHANCE: &str = "Chance";
const SIZE: &str = "Size";
const RELEVANCE: &str = "Relevance";

/// One gate.
pub struct Gate {
    /// What is looked at.
    pub name: &'static str,
    /// What it says.
    pub meaning: &'static str,
    /// What was found.
    pub found: String,
    /// What is required.
    pub required: String,
    /// Whether that is exceeded.
    pub passed: bool,
    /// Why it need not be, if so.
    pub waived: Option<&'static str>,
}

/// All gates.
pub fn gates(evidence: &Evidence) -> [Gate; 6] {
    let limits = evidence.required();
    let waived = |name: &str| match name {
        HELD_OUT if evidence.is_no_chance() => Some("so much of the error goes that it is no chance"),
        TRAINING | CHANCE if evidence.is_steady_enough() => {
            Some("most of the error goes, so that its gain is as uneven")
        }
        SIZE | RELEVANCE if evidence.grave => {
            Some("a signal that is so late matters, however little the errors show it")
        }
        _ => None,
    };
    let gate = |name, meaning, found: f64, required: f64, print: fn(f64) -> String| Gate {
        name,
        meaning,
        found: print(found),
        required: format!("> {}", print(required)),
        passed: found > required,
        waived: waived(name),
    };
    [
        gate(
            HELD_OUT,
            "t of the gain over blocks of another excitation",
            evidence.held_out_t,
            limits.held_out_t,
            number,
        ),
        gate(
            TRAINING,
            "t of the gain over blocks of what was learnt from",
            evidence.block_t,
            limits.block_t,
            number,
        ),
        Gate {
            name: CHANCE,
            meaning: "that the best of all causes gains as steadily there where there is none",
            found: percent(evidence.chance),
            required: format!("< {}", percent(limits.chance)),
            passed: evidence.chance < limits.chance,
            waived: waived(CHANCE),
        },
        gate(
            "Parsimony",
            "fall of the Bayesian information criterion",
            evidence.delta_bic,
            limits.delta_bic,
            number,
        ),
        gate(
            SIZE,
            "share of the starting model’s error power it explains",
            evidence.explained,
            limits.explained,
            percent,
        ),
        if evidence.phi_gain <= limits.phi_gain && evidence.taken > limits.taken {
            let what = "share that it takes away of the error that was left";
            gate(RELEVANCE, what, evidence.taken, limits.taken, percent)
        } else {
            let what = "largest rise of Φ among the signals, on either data";
            gate(RELEVANCE, what, evidence.phi_gain, limits.phi_gain, number)
        },
    ]
}

/// Why the effect is believed, in sentences.
pub fn sentences(evidence: &Evidence) -> Vec<String> {
    let strength = |t: f64| match t {
        t if t.is_nan() => "which could not be determined",
        t if t > 5.0 => "far beyond chance",
        t if t > 3.0 => "clearly beyond chance",
        t if t > Evidence::REQUIRED.held_out_t => "beyond chance",
        _ => "which chance can do as well",
    };
    let t = |t: f64| format!("t\u{a0}=\u{a0}{}, {}", number(t), strength(t));
    vec![
        format!(
            "With it, the model fits data that it was not fitted to better, block by block: {}.",
            t(evidence.held_out_t)
        ),
        format!("It explains {} of the power of the error there.", percent(evidence.explained)),
        format!(
            "On the data that it was learnt from, the gain over blocks has {}; where there is none, the best of all causes \
             has as much with a chance of {}.",
            t(evidence.block_t),
            percent(evidence.chance)
        ),
        format!(
            "The gain outweighs its additional parameters: the Bayesian information criterion falls by {}.",
            number(evidence.delta_bic)
        ),
    ]
}
