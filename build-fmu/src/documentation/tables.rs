//! Tables of variables and of parameter sets.

use maud::{Markup, html};

use super::{Page, rows};

/// What the parameter set says, value by value.
pub fn parameter_set(page: &Page) -> Markup {
    let Some(set) = page.fmu.set.as_ref().map(|set| &set.parsed) else {
        return html! {};
    };
    let assumed = set.values.values().any(|given| given.assumed);
    html! {
        section {
            h2 { "Parameter set" }
            p {
                (set.title) ". Source: " (set.source) "."
                @if assumed { " Values marked " (mark()) " are not in the source but chosen, for the reason given." }
                @if !set.files.is_empty() {
                    " Files: " @for (index, file) in set.files.iter().enumerate() {
                        @if index > 0 { ", " } code { (file) }
                    } "."
                }
            }
            @if !set.values.is_empty() {
                table {
                    thead { tr { th { "Name" } th.number { "Value" } th { "Unit" } th { "Source" } } }
                    tbody {
                        @for given in rows::given(page.interface, set) {
                            tr {
                                td.name { code { (given.name) } }
                                td.number { (given.value) }
                                td.unit { (given.unit) }
                                td.from { (given.source) @if given.assumed { " " (mark()) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn mark() -> Markup {
    html! { span.assumed { "assumed" } }
}

/// Every variable, by role.
pub fn variables(page: &Page) -> Markup {
    html! {
        section {
            h2 { "Variables" }
            @for (title, causality) in rows::TABLES {
                (list(title, &rows::of(page.interface, causality)))
            }
            @if page.interface.variables.iter().any(rows::is_rate) {
                p.facts { span { "The rate of change of each state is a variable too: " code { "der(name)" } "." } }
            }
        }
    }
}

fn list(title: &str, rows: &[rows::Row]) -> Markup {
    let starts = rows.iter().any(|row| !row.start.is_empty());
    let bounds = rows.iter().any(|row| !row.range.is_empty());
    html! {
        @if !rows.is_empty() {
            h3 { (title) }
            table {
                thead {
                    tr {
                        th { "Name" }
                        @if starts { th.number { "Start" } }
                        th { "Unit" }
                        @if bounds { th { "Range" } }
                        th { "Description" }
                    }
                }
                tbody {
                    @for row in rows {
                        tr {
                            td.name { code { (row.name) } }
                            @if starts { td.number { (row.start) } }
                            td.unit { (row.unit) }
                            @if bounds { td.unit { (row.range) } }
                            td {
                                (row.doc)
                                @for (name, doc) in &row.items { br; code { (name) } @if doc != name { ": " (doc) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A number as one reads it: at most eight digits (the description has them all), powers of ten only
/// where they are needed.
pub fn number(value: f64) -> String {
    let value: f64 = format!("{value:.7e}").parse().unwrap_or(value);
    let magnitude = value.abs();
    let text = if value == 0.0 || (1e-4..1e7).contains(&magnitude) {
        format!("{value}")
    } else {
        let text = format!("{value:e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let digits = superscript(exponent);
        if mantissa == "1" { format!("10{digits}") } else { format!("{mantissa} · 10{digits}") }
    };
    text.replacen('-', "−", 1)
}

/// A unit as one reads it: `N.s/m` is `N·s/m`, `m/s2` is `m/s²`, and `1` is nothing to read.
pub fn printed(symbol: &str) -> String {
    if symbol == "1" {
        return "–".into();
    }
    let mut text = String::new();
    let mut after_letter = false;
    for c in symbol.chars() {
        match c {
            '.' => text.push('·'),
            digit if digit.is_ascii_digit() && after_letter => {
                text.push_str(&superscript(&digit.to_string()));
            }
            other => text.push(other),
        }
        after_letter = c.is_alphabetic();
    }
    text
}

fn superscript(digits: &str) -> String {
    digits
        .chars()
        .map(|digit| match digit {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => digit.to_digit(10).and_then(|value| char::from_u32(0x2070 + value)).unwrap_or(digit),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_readable() {
        for (value, text) in [
            (0.0, "0"),
            (152_186.0, "152186"),
            (-0.47, "−0.47"),
            (0.312_211_221_122, "0.31221122"),
            (4.444_95e13, "4.44495 · 10¹³"),
            (1e-7, "10⁻⁷"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn units_are_printed_as_in_a_book() {
        for (symbol, text) in
            [("N.s/m", "N·s/m"), ("m/s2", "m/s²"), ("1/(V.s)", "1/(V·s)"), ("1", "–"), ("1/m2", "1/m²")]
        {
            assert_eq!(printed(symbol), text);
        }
    }
}
