//! The account: where the power of each signal's error goes, as one stacked bar a signal.

use maud::{Markup, html};

use crate::report::findings::{Findings, SignalAccount};
use crate::report::words::{capitalised, effect_rank, open_signal, percent, quantity};

/// Share of a bar's width from which it has room for a number …
const NUMBER: f64 = 0.075;
/// … and for the rank of an effect before it.
const RANK: f64 = 0.12;
/// Effects with a pattern of their own; further ones share the last one.
const PATTERNS: usize = 4;

/// One part of an account.
struct Share {
    name: String,
    class: String,
    /// Place in the bar's order; the same for all effects.
    order: u8,
    /// The effect's number in the list of effects.
    rank: Option<usize>,
    share: f64,
}

/// Bars of all signals with one legend, and the numbers as a table.
pub fn section(findings: &Findings) -> Markup {
    if findings.account.is_empty() {
        return html! {};
    }
    html! {
        section {
            h2 { "Where the error goes" }
            p.note {
                "Each bar is the power of the starting model’s error on the validation data. \
                Its parts are the shares that noise, parameters and effects account for."
            }
            ul.keys {
                @for part in legend(findings) {
                    li { span class=(format!("key {}", part.class)) {} @if let Some(rank) = part.rank { (rank) " " } (part.name) }
                }
            }
            div.account { @for account in &findings.account { (bar(findings, account)) } }
            details { summary { "The numbers" } div.scroll { (table(findings)) } }
        }
    }
}

/// The parts of an account in the order of the bar.
fn parts(findings: &Findings, account: &SignalAccount) -> Vec<Share> {
    let fixed = |order, name: &str, class: &str, share| Share {
        name: name.into(),
        class: class.into(),
        order,
        rank: None,
        share,
    };
    let mut parts = vec![
        fixed(0, "sensor noise", "of-noise", account.noise),
        fixed(1, "nominal parameters", "of-parameters", account.parameters),
    ];
    parts.extend(account.effects.iter().map(|item| {
        let rank = effect_rank(findings, item);
        let class = rank.map_or("of-curve".into(), |rank| format!("of-effect-{}", rank.min(PATTERNS)));
        Share { name: capitalised(&item.name), class, order: 2, rank, share: item.share }
    }));
    parts.push(fixed(3, "unmodelled (described below)", "of-unmodelled", account.unmodelled));
    parts.push(fixed(4, "unexplained", "of-unexplained", account.unexplained));
    parts
}

/// The parts that any bar has, in the order of the bars.
fn legend(findings: &Findings) -> Vec<Share> {
    let all: Vec<Vec<Share>> = findings.account.iter().map(|account| parts(findings, account)).collect();
    let mut legend: Vec<Share> = Vec::new();
    for part in all.into_iter().flatten().filter(|part| part.share != 0.0) {
        if !legend.iter().any(|it| it.name == part.name) {
            legend.push(part);
        }
    }
    let order = |part: &Share| (part.order, part.rank);
    legend.sort_by_key(order);
    legend
}

/// Widths of a bar's parts as shares of it: in proportion to the positive shares, zero for all others.
fn widths(shares: &[f64]) -> Vec<f64> {
    let positive = |share: &f64| if share.is_finite() && *share > 0.0 { *share } else { 0.0 };
    let largest = shares.iter().map(positive).fold(0.0, f64::max);
    if largest == 0.0 {
        return vec![0.0; shares.len()];
    }
    let total: f64 = shares.iter().map(|share| positive(share) / largest).sum();
    shares.iter().map(|share| positive(share) / largest / total).collect()
}

fn bar(findings: &Findings, account: &SignalAccount) -> Markup {
    let parts = parts(findings, account);
    let widths = widths(&parts.iter().map(|part| part.share).collect::<Vec<_>>());
    let worse: Vec<&Share> = parts.iter().filter(|part| part.share < 0.0).collect();
    let unit = findings.signals.iter().find(|it| it.name == account.signal).map_or("", |it| it.unit.as_str());
    let read: Vec<String> =
        parts.iter().map(|part| format!("{} {}", part.name, percent(part.share))).collect();
    let alt = format!("Account of {}: {}", account.signal, read.join(", "));
    html! {
        figure {
            figcaption {
                code { (account.signal) }
                span.small { "rms error of the starting model " (quantity(account.error, unit)) }
                @if let Some(open) = open_signal(findings, account) { span.open { (capitalised(&open.note())) } }
            }
            @if widths.iter().any(|width| *width > 0.0) {
                div.stack role="img" aria-label=(alt) {
                    @for (part, width) in parts.iter().zip(&widths).filter(|(_, width)| **width > 0.0) {
                        span class=(part.class) style=(format!("width:{:.2}%", 100.0 * width))
                            title=(format!("{}: {}", part.name, percent(part.share))) {
                            @if *width >= NUMBER {
                                strong {
                                    @if let Some(rank) = part.rank.filter(|_| *width >= RANK) { span.nth { (rank) ": " } }
                                    (percent(part.share))
                                }
                            }
                        }
                    }
                }
            }
            @for part in &worse {
                p.small {
                    (capitalised(&part.name)) ": " (percent(part.share)) ". This part makes the signal worse. \
                    The bar shows the positive parts only."
                }
            }
        }
    }
}

/// The shares as numbers: a row a part, a column a signal.
fn table(findings: &Findings) -> Markup {
    let columns: Vec<Vec<Share>> = findings.account.iter().map(|account| parts(findings, account)).collect();
    let names = columns.first().into_iter().flatten().map(|part| &part.name);
    html! {
        table {
            thead { tr { th { "Share of the error power" } @for account in &findings.account { th.number { code { (account.signal) } } } } }
            tbody {
                @for (row, name) in names.enumerate() {
                    tr {
                        td { (capitalised(name)) }
                        @for column in &columns { td.number { @if let Some(part) = column.get(row) { (percent(part.share)) } } }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_is_as_wide_as_its_positive_parts() {
        assert_eq!(widths(&[0.25, 0.25, 0.5]), [0.25, 0.25, 0.5]);
        assert_eq!(widths(&[0.5, -0.5, 1.0, f64::NAN]), [1.0 / 3.0, 0.0, 2.0 / 3.0, 0.0]);
        assert_eq!(widths(&[0.0, -1.0]), [0.0, 0.0]);
        assert_eq!(widths(&[f64::MAX, f64::MAX, f64::INFINITY]), [0.5, 0.5, 0.0]);
    }
}
