//! Tables of variables and of parameter sets.

use maud::{Markup, html};
use strut_model::{Causality, Given, Value, Variability, Variable, VariableKind};

use super::Page;

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
                    thead { tr { th { "Name" } th.number { "Value" } th { "Unit" } th { "Source" } th {} } }
                    tbody {
                        // In the order of the model's variables, which groups what belongs together.
                        @for variable in &page.interface.variables {
                            @if let Some(given) = set.values.get(&variable.name) { (row(variable, given)) }
                        }
                    }
                }
            }
        }
    }
}

fn row(variable: &Variable, given: &Given) -> Markup {
    html! {
        tr {
            td.name { code { (variable.name) } }
            td.number { (value(&given.value)) }
            td.unit { (given.unit.as_deref().map(printed).unwrap_or_default()) }
            td.from { (given.source) }
            td { @if given.assumed { (mark()) } }
        }
    }
}

fn mark() -> Markup {
    html! { span.assumed { "assumed" } }
}

/// Every variable, by role.
pub fn variables(page: &Page) -> Markup {
    let all = &page.interface.variables;
    let is_rate =
        |variable: &Variable| matches!(variable.kind, VariableKind::Real { derivative_of: Some(_), .. });
    let of = |causality: Causality| {
        all.iter().filter(move |variable| variable.causality == causality).collect::<Vec<_>>()
    };
    let states: Vec<_> =
        all.iter().filter(|variable| variable.causality == Causality::Local && !is_rate(variable)).collect();
    html! {
        section {
            h2 { "Variables" }
            (list("Inputs", &of(Causality::Input)))
            (list("Outputs", &of(Causality::Output)))
            (list("Further states", &states))
            (list("Parameters", &of(Causality::Parameter)))
            (list("Calculated parameters", &of(Causality::CalculatedParameter)))
            @if all.iter().any(is_rate) {
                p.facts { span { "The rate of change of each state is a variable too: " code { "der(name)" } "." } }
            }
        }
    }
}

fn list(title: &str, variables: &[&Variable]) -> Markup {
    let starts = variables.iter().any(|variable| start(variable).is_some());
    let bounds = variables.iter().any(|variable| !range(variable).is_empty());
    html! {
        @if !variables.is_empty() {
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
                    @for variable in variables {
                        tr {
                            td.name { code { (variable.name) } }
                            @if starts { td.number { (start(variable).unwrap_or_default()) } }
                            td.unit { (unit(variable)) }
                            @if bounds { td.unit { (range(variable)) } }
                            td { (variable.doc) @if is_fixed(variable) { " (fixed at initialisation)" } (items(variable)) }
                        }
                    }
                }
            }
        }
    }
}

/// Most parameters are tunable: those that are not are told.
pub fn is_fixed(variable: &Variable) -> bool {
    variable.causality == Causality::Parameter && variable.variability == Variability::Fixed
}

/// What each item of an enumeration means.
fn items(variable: &Variable) -> Markup {
    html! {
        @if let VariableKind::Choice { enumeration, .. } = &variable.kind {
            @for (name, doc) in enumeration.items { br; code { (name) } @if doc != name { ": " (doc) } }
        }
    }
}

/// The unit as one reads it; empty for settings.
pub fn unit(variable: &Variable) -> String {
    match &variable.kind {
        VariableKind::Real { unit, .. } => printed(&unit.symbol),
        _ => String::new(),
    }
}

/// The start value as one reads it.
pub fn start(variable: &Variable) -> Option<String> {
    match &variable.kind {
        VariableKind::Real { start, .. } => start.map(number),
        VariableKind::Integer { start } => Some(start.to_string()),
        VariableKind::Boolean { start } => Some(start.to_string()),
        VariableKind::Text { start } => Some(start.clone()),
        VariableKind::Choice { enumeration, start } => {
            let index = usize::try_from(start - 1).ok()?;
            enumeration.items.get(index).map(|(name, _)| (*name).to_owned())
        }
    }
}

/// The bounds as one reads them; empty if there are none.
pub fn range(variable: &Variable) -> String {
    match variable.kind {
        VariableKind::Real { min: Some(min), max: Some(max), .. } => {
            format!("{} … {}", number(min), number(max))
        }
        VariableKind::Real { min: Some(min), .. } => format!("≥ {}", number(min)),
        VariableKind::Real { max: Some(max), .. } => format!("≤ {}", number(max)),
        _ => String::new(),
    }
}

/// A value as one reads it.
pub fn value(value: &Value) -> String {
    match value {
        Value::Real(value) => number(*value),
        Value::Integer(value) => value.to_string(),
        Value::Boolean(value) => value.to_string(),
        Value::Text(value) => value.clone(),
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
