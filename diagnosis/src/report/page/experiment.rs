//! The next experiment: what to do, what it separates, what makes it.

use maud::{Markup, html};

use crate::report::findings::{DecidingExperiment, Findings};
use crate::report::words::{capitalised, digits, pair, percent, source, unit};

/// Digits of a distance and of a limit.
const DIGITS: usize = 3;

/// What would settle doubts.
pub fn section(findings: &Findings) -> Markup {
    let ambiguous = findings.effects.iter().any(|effect| !effect.ambiguous_with.is_empty());
    html! {
        @if let Some(experiment) = &findings.experiment {
            section.experiment {
                h2 { @if ambiguous { "Experiment to tell the alternatives apart" } @else { "Next experiment" } }
                p { (experiment) }
                @if let Some(deciding) = &findings.deciding_experiment { (computed(findings, deciding)) }
            }
        }
    }
}

fn computed(findings: &Findings, deciding: &DecidingExperiment) -> Markup {
    html! {
        @if deciding.decides {
            p {
                code { "experiment.csv" } " holds the signals. "
                @for source in deciding.drives.iter().filter_map(|it| it.source.as_ref()) {
                    "An FMU makes them, too: " code { (self::source(source)) } ". "
                }
            }
        }
        div.columns {
            div.scroll { table.tight {
                thead { tr {
                    th { "Alternatives" } th.number { "d′ expected" } th.number { "Right decision" } th.number { "d′ recorded" }
                } }
                tbody { @for it in &deciding.pairs { tr {
                    td { (capitalised(&pair(findings, it))) }
                    td.number { (digits(it.distance, DIGITS)) }
                    td.number { strong { (percent(it.probability)) } }
                    td.number { (digits(it.recorded, DIGITS)) }
                } } }
            } }
            div.scroll { table.tight {
                thead { tr { th { "Limit" } th.number { "Reached" } th.number { "Largest" } th { "Unit" } } }
                tbody { @for it in &deciding.limits { tr {
                    td { code { (it.signal) } }
                    td.number { (it.reached.map_or("–".to_owned(), |it| digits(it, DIGITS))) }
                    td.number { (digits(it.limit, DIGITS)) }
                    td.unit { (unit(&it.unit)) }
                } } }
            } }
        }
        p.small {
            "d′ is the distance of the predictions in standard deviations of the remaining error, with the wrong model’s \
             parameters fitted. The probability of a right decision is that of a normal error below d′/2."
        }
    }
}
