//! The list. Each entry stands here once, with what to write instead.

use crate::Scope::{self, Code, Everywhere, Guides, Report};

/// Phrases that are not used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The phrase; alternatives are separated by `|`.
    pub phrase: &'static str,
    /// What to write instead.
    pub instead: &'static str,
    /// Where it is not used.
    pub scope: Scope,
}

const fn entry(phrase: &'static str, instead: &'static str, scope: Scope) -> Entry {
    Entry { phrase, instead, scope }
}

/// All of them.
pub const LIST: &[Entry] = &[
    // Prose.
    entry("besides", "also, other than, apart from", Everywhere),
    entry("such that", "so that, or two sentences", Everywhere),
    entry("that which", "a noun", Everywhere),
    entry("of which none", "none of …", Everywhere),
    entry("as FMI has it|as the standard has it|as the paper has it", "by FMI, with the section", Everywhere),
    entry("of old", "old, earlier", Everywhere),
    entry("something else than", "other than", Everywhere),
    entry("is told|are told|was told|were told", "is reported, is printed, is distinguished", Guides),
    entry("so many", "a number or a noun", Guides),
    entry("what is left of", "the remaining …", Guides),
    // One concept, one word.
    entry("base parameter|base parameters|base fit|base model", "nominal parameters, fit, model", Everywhere),
    entry("learnt", "estimated, estimation data", Everywhere),
    entry("judged on", "compared on the validation data", Everywhere),
    entry("held-out|held out", "validation data", Everywhere),
    entry("training data|training record|training records|training set", "estimation data", Everywhere),
    entry("kinematic ratio", "motion ratio", Everywhere),
    entry("frame mode", "test-rig resonance", Everywhere),
    entry("soft damper mount", "top-mount compliance", Everywhere),
    entry("behind play|with play|play in a|play of a|without play", "backlash", Everywhere),
    entry("overlap of the valve", "spool overlap (dead band)", Everywhere),
    entry("catalogue of diagnosis", "docs/effects.md, with the effect's number", Everywhere),
    // In what a diagnosis shows.
    entry("Φ", "fit", Report),
    entry("training", "estimation data", Report),
    entry("judge|judges|judged", "compare", Report),
    entry("cause|causes", "effect", Report),
    entry("what is left", "the remaining error", Report),
    // Old names of types, functions and crates.
    entry("strut_model::Nothing|NoSettings, Nothing|Bundle<R> for Nothing", "`NoVariables`", Code),
    entry("Now<", "`Instant`", Code),
    entry("work: Work|Work::default", "`SolverStats`", Code),
    entry("further_effects", "`active_effects`", Code),
    entry("remembering", "`force_with_states`", Code),
    entry("resettled|dwarfed|punctual", "null refitted, negligible, delays bounded", Code),
    entry(
        "phi_gain|phi_before|phi_fitted|phi_after|held_out_t|held_out_chance|base_parameters|not_done",
        "the names of docs/report.md",
        Code,
    ),
    entry("strut_fmi2|strut-fmi2", "`strut_fmi`", Code),
];
