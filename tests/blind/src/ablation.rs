//! What each component of a diagnosis contributes: the cases again, without one of them.

use std::fmt::Write;
use std::path::Path;

use crate::case::Case;
use crate::run::{Run, is_right};
use crate::score::{Outcome, Score};

/// Components by the names that the program's `--without` takes, and the diagnosis without each, as the page has it.
pub const COMPONENTS: [(Option<&str>, &str); 7] = [
    (None, "whole"),
    (
        Some("ports"),
        "without ports: every effect is fitted in each round, and nothing is reported without a name",
    ),
    (Some("features"), "without free features: only effects with a name are compared to the missing signal"),
    (Some("confirmation"), "without confirmation: the best fit is accepted, and nothing is taken back"),
    (Some("account"), "without the account: a background effect needs more evidence even where much is open"),
    (Some("tolerances"), "without tolerances of the parameter set as priors"),
    (Some("background"), "without the prior of background effects"),
];

/// The run of a component's cases, in a folder of its own.
fn run(program: &Path, out: &Path, component: Option<&str>) -> Run {
    Run {
        program: program.to_owned(),
        arguments: component.map_or_else(Vec::new, |it| vec!["--without".to_owned(), it.to_owned()]),
        out: out.join(component.unwrap_or("whole")),
    }
}

/// Every case with each component left out in turn, by the component's position; of the components, those that are asked for, or
/// all if none is.
///
/// # Errors
/// If there is no such component: which there are.
pub fn list<'a>(cases: &'a [Case], asked: &[String]) -> Result<Vec<(usize, &'a Case)>, String> {
    let known = |name: &String| COMPONENTS.iter().any(|(it, _)| *it == Some(name.as_str()));
    if let Some(wrong) = asked.iter().find(|it| !known(it)) {
        let names: Vec<&str> = COMPONENTS.iter().filter_map(|it| it.0).collect();
        return Err(format!("there is no component {wrong}: take {}", names.join(", ")));
    }
    let wanted = |component: &usize| {
        let name = COMPONENTS[*component].0;
        asked.is_empty() || name.is_none_or(|name| asked.iter().any(|it| it == name))
    };
    let components = (0..COMPONENTS.len()).filter(wanted);
    Ok(components.flat_map(|component| cases.iter().map(move |case| (component, case))).collect())
}

/// Runs one entry of the list.
///
/// # Errors
/// As [`Run::case`].
pub fn judged(program: &Path, out: &Path, (component, case): (usize, &Case)) -> Result<Score, String> {
    run(program, out, COMPONENTS[component].0).case(case)
}

/// The page: one row for each component that has scores.
pub fn page(command: &str, scores: &[(usize, Score)]) -> String {
    let mut text = format!(
        "# Contribution of each component\n\nThe cases of the benchmark, with one component of the method left out:\n\n```\n{command}\n```\n\n\
         Right: the hidden effects and nothing else, or one of two; without one, nothing; out of the catalogue, the right place \
         without a name.\n\n\
         | diagnosis | effects right | out of the catalogue right | false names | mean time in s |\n|---|---|---|---|---|\n"
    );
    for (number, (_, label)) in COMPONENTS.iter().enumerate() {
        let own: Vec<&Score> = scores.iter().filter(|(of, _)| *of == number).map(|(_, it)| it).collect();
        if own.is_empty() {
            continue;
        }
        let share = |of: &dyn Fn(&Score) -> bool| {
            let among = own.iter().filter(|it| of(it));
            format!("{} of {}", among.clone().filter(|it| is_right(it)).count(), among.count())
        };
        let false_names = own.iter().filter(|it| names_falsely(it.outcome)).count();
        let seconds = own.iter().map(|it| it.seconds).sum::<f64>() / own.len() as f64;
        writeln!(
            text,
            "| {label} | {} | {} | {false_names} of {} | {seconds:.0} |",
            share(&|it| !it.out_of_catalogue),
            share(&|it| it.out_of_catalogue),
            own.len()
        )
        .expect("a string takes everything");
    }
    text
}

/// Whether something is named that is not there.
fn names_falsely(outcome: Outcome) -> bool {
    matches!(outcome, Outcome::TooMany | Outcome::WrongName | Outcome::FalseAlarm)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_component_has_its_argument_and_its_folder() {
        let whole = run(Path::new("diagnose"), Path::new("out"), None);
        assert!(whole.arguments.is_empty() && whole.out.ends_with("whole"));
        let ports = run(Path::new("diagnose"), Path::new("out"), Some("ports"));
        assert_eq!(ports.arguments, ["--without", "ports"]);
        assert!(ports.out.ends_with("ports"));
    }

    #[test]
    fn those_components_are_left_out_that_are_asked_for() {
        let cases = [Case::standard("a", vec![], 1), Case::standard("b", vec![], 2)];
        let components = |asked: &[&str]| -> Result<Vec<usize>, String> {
            let asked: Vec<String> = asked.iter().map(|it| (*it).to_owned()).collect();
            Ok(list(&cases, &asked)?.into_iter().map(|it| it.0).collect())
        };
        assert_eq!(components(&[]).unwrap().len(), 2 * COMPONENTS.len());
        // Beside the whole diagnosis.
        assert_eq!(components(&["ports"]).unwrap(), [0, 0, 1, 1]);
        assert!(components(&["port"]).unwrap_err().contains("ports, features"));
    }

    #[test]
    fn a_page_has_a_row_for_each_component_with_scores() {
        let scores = [
            (0, Score { seconds: 2.0, ..Score::of("a", Outcome::Correct) }),
            (0, Score { seconds: 4.0, ..Score::of("b", Outcome::WrongName) }),
            (3, Score { out_of_catalogue: true, ..Score::of("a", Outcome::Unnamed) }),
        ];
        let page = page("blind ablation", &scores);
        assert!(page.contains("| whole | 1 of 2 | 0 of 0 | 1 of 2 | 3 |"), "{page}");
        assert!(page.contains("| without confirmation: the best fit is accepted, and nothing is taken back | 0 of 0 | 1 of 1 | 0 of 1 | 1 |"));
        assert!(!page.contains("without ports"));
    }
}
