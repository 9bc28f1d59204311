//! The variables of all FMUs as pages of the book: one for each model, with the parameter sets that make FMUs of it.

use std::fmt::Write;

use strut_model::{About, Interface};

use crate::documentation::{cited, count, rows};
use crate::failure::Result;
use crate::fmu::{Fmu, Set};
use crate::literature::Work;
use crate::plan::Plan;

/// What stands above every page.
const MARK: &str = "<!-- Written by `strut reference --variables docs/variables`. -->\n";

const INTRODUCTION: &str = "\
# Variables

Every FMU by model: inputs, outputs, states, parameters, equations and their sources. FMUs of one model differ in the values of
their parameter set alone. `strut describe NAME` shows the same in a terminal.

- **Start** is the value before anything is set, in the unit beside it.
- **Range** is what a value may be. Others are refused.
- A parameter is tunable, unless it says that it is fixed at initialisation.
- An array is one row: `profile[1 … 21]` stands for `profile[1]` to `profile[21]`.
- The rate of change of each state is a variable, too: `der(name)`.
- Units are written as in a book: N·s/m is `N.s/m` in an FMU.
";

/// The pages, each with its file's name.
pub fn pages(plan: &Plan, works: &[Work]) -> Result<Vec<(String, String)>> {
    let models: Vec<&Fmu> = plan.fmus.iter().filter(|fmu| fmu.set.is_none()).collect();
    let mut pages = Vec::new();
    let mut index = format!(
        "{MARK}{INTRODUCTION}\n| model | kind | in → out | FMUs | what it is |\n|---|---|---|---|---|\n"
    );
    let mut published =
        String::from("\n## FMUs with published parameters\n\n| FMU | model | source |\n|---|---|---|\n");
    let mut tree = String::from("\n```{toctree}\n:hidden:\n\n");
    for model in models {
        let interface = model.interface()?;
        let sets: Vec<(&Fmu, &Set)> = plan
            .fmus
            .iter()
            .filter(|fmu| fmu.entry.about.name == model.name)
            .filter_map(|fmu| Some((fmu, fmu.set.as_ref()?)))
            .collect();
        let (inputs, outputs) = Fmu::ports(&interface);
        let (name, about) = (&model.name, model.entry.about);
        let _ = writeln!(
            index,
            "| [{name}]({name}.md) | {} | {inputs} → {outputs} | {} | {} |",
            about.kind.name(),
            1 + sets.len(),
            cell(about.summary)
        );
        for (fmu, set) in &sets {
            let anchor = fmu.name.to_lowercase();
            let _ = writeln!(
                published,
                "| [{}]({name}.md#{anchor}) | {name} | {} |",
                fmu.name, set.parsed.source
            );
        }
        let _ = writeln!(tree, "{name}");
        pages.push((format!("{name}.md"), page(&about, &interface, &sets, works)));
    }
    pages.push(("index.md".into(), format!("{index}{published}{tree}```\n")));
    Ok(pages)
}

fn page(about: &About, interface: &Interface, sets: &[(&Fmu, &Set)], works: &[Work]) -> String {
    let (inputs, outputs) = Fmu::ports(interface);
    let ports = [count(inputs, "input"), count(outputs, "output"), count(interface.states, "state")];
    let mut text = format!("{MARK}# {}\n\n{}.\n", about.name, stop(about.summary));
    let _ = writeln!(text, "Kind: {}; {}.", about.kind.name(), ports.join(", "));
    if !sets.is_empty() {
        text += "\nFMUs with published parameters: ";
        let link = |(fmu, _): &(&Fmu, &Set)| format!("[{}](#{})", fmu.name, fmu.name.to_lowercase());
        let _ = writeln!(text, "{}.", sets.iter().map(link).collect::<Vec<_>>().join(", "));
    }
    for (title, causality) in rows::TABLES {
        variables(&mut text, title, &rows::of(interface, causality));
    }
    if !about.equations.is_empty() {
        text += "\n## Equations\n\n| equation | source |\n|---|---|\n";
        for equation in about.equations {
            let source = cell(equation.source).replace("docs/effects.md", "[effects](../effects.md)");
            let _ = writeln!(text, "| `{}` | {source} |", equation.text.replace('|', "\\|"));
        }
    }
    if !about.notes.is_empty() {
        text += "\n## Notes\n\n";
        about.notes.iter().for_each(|note| text += &format!("- {}\n", plain(note)));
    }
    for (fmu, set) in sets {
        let _ = writeln!(
            text,
            "\n## {}\n\n{}. Source: {}.",
            fmu.name,
            stop(&plain(&set.parsed.title)),
            set.parsed.source
        );
        values(&mut text, interface, set);
    }
    let mut named: Vec<&Work> = Vec::new();
    for set in sets.iter().map(|(_, set)| Some(&set.parsed)).chain([None]) {
        named.extend(
            cited(works, about, set).into_iter().filter(|work| !named.contains(work)).collect::<Vec<_>>(),
        );
    }
    if !named.is_empty() {
        text += "\n## Sources\n\n";
        named.iter().for_each(|work| text += &format!("- **{}**: {}\n", work.key, work.listed()));
    }
    text
}

fn variables(text: &mut String, title: &str, rows: &[rows::Row]) {
    if rows.is_empty() {
        return;
    }
    let starts = rows.iter().any(|row| !row.start.is_empty());
    let bounds = rows.iter().any(|row| !row.range.is_empty());
    let line = |cells: [&str; 5]| {
        let shown = [true, starts, true, bounds, true];
        let cells = cells.into_iter().zip(shown).filter(|(_, shown)| *shown).map(|(cell, _)| cell);
        format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
    };
    let _ = write!(text, "\n## {title}\n\n");
    *text += &line(["name", "start", "unit", "range", "description"]);
    *text += &line(["---", "---:", "---", "---", "---"]);
    for row in rows {
        let items = row.items.iter().map(|(name, doc)| match name == doc {
            true => format!("; `{name}`"),
            false => format!("; `{name}`: {}", cell(doc)),
        });
        let doc = cell(&row.doc) + &items.collect::<String>();
        *text += &line([&format!("`{}`", row.name), &row.start, &row.unit, &row.range, &doc]);
    }
}

/// The values of a set that are not those of its model.
fn values(text: &mut String, interface: &Interface, set: &Set) {
    let models: Vec<rows::Row> =
        rows::TABLES.iter().flat_map(|(_, causality)| rows::of(interface, *causality)).collect();
    let is_models =
        |given: &rows::GivenRow| models.iter().any(|row| row.name == given.name && row.start == given.value);
    let given: Vec<_> = rows::given(interface, &set.parsed).into_iter().filter(|it| !is_models(it)).collect();
    if given.is_empty() {
        *text += "Its values are the model's.\n";
        return;
    }
    *text += "\n| name | value | unit | source |\n|---|---:|---|---|\n";
    for it in given {
        let assumed = if it.assumed { "assumed: " } else { "" };
        let _ =
            writeln!(text, "| `{}` | {} | {} | {assumed}{} |", it.name, it.value, it.unit, cell(it.source));
    }
}

/// A sentence without its stop.
fn stop(sentence: &str) -> &str {
    sentence.trim_end_matches('.')
}

/// Text that Markdown leaves as it is.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    for c in text.chars() {
        if matches!(c, '*' | '_' | '<' | '[' | '$') {
            plain.push('\\');
        }
        plain.push(c);
    }
    plain
}

/// The same in a cell of a table.
fn cell(text: &str) -> String {
    plain(text).replace('|', "\\|")
}
