//! `build-fmu check` of good FMUs and systems with one fault each: every rule that is checked finds its mutations, and nothing is
//! found without a mutation.

use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::mutations::{Case, archives, descriptions, documents, fmus, libraries, related, systems};
use crate::subject::{check, problems};

/// Rules whose findings are for a machine, or a program, that is not at hand in each run.
const ELSEWHERE: [&str; 1] = ["fmpy"];

/// Names of all that was found, notes too.
fn found(answer: &serde_json::Value) -> BTreeSet<String> {
    let findings = answer["report"]["findings"].as_array().unwrap_or_else(|| panic!("{answer}"));
    findings.iter().map(|finding| finding["rule"].as_str().unwrap().to_owned()).collect()
}

/// Writes all into a folder and checks them in one run of the program.
fn each_is_found(cases: &[Case], options: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<PathBuf> = (0..)
        .zip(cases)
        .map(|(index, case)| {
            let path = folder.path().join(format!("{index}.{}", case.ending));
            std::fs::write(&path, &case.bytes).unwrap();
            path
        })
        .collect();
    let (_, answers) = check(&files, &[&["--no-fmpy"], options].concat());
    let missed: Vec<String> = cases
        .iter()
        .zip(answers.as_array().unwrap())
        .filter(|(case, answer)| !found(answer).contains(case.rule))
        .map(|(case, answer)| format!("{}: {} is not among {:?}", case.what, case.rule, found(answer)))
        .collect();
    assert!(missed.is_empty(), "{} of {} are missed: {missed:#?}", missed.len(), cases.len());
}

#[test]
fn mutated_descriptions_and_archives_are_found() {
    let cases: Vec<Case> =
        [fmus::all(), descriptions::all(), archives::all()].into_iter().flatten().collect();
    assert!(cases.len() >= 150, "{}", cases.len());
    each_is_found(&cases, &["--no-run"]);
}

#[test]
fn mutated_systems_are_found() {
    each_is_found(&systems::all(), &["--no-run"]);
}

#[test]
fn mutated_libraries_are_found() {
    each_is_found(&libraries::all(), &["--timeout", "5"]);
}

#[test]
fn mutated_related_files_are_found() {
    each_is_found(&related::all(), &["--replay", "--timeout", "5"]);
}

#[test]
fn nothing_is_found_in_what_is_not_mutated() {
    let folder = tempfile::tempdir().unwrap();
    let good = [fmus::good(), descriptions::good(), systems::good(), related::good()];
    let files: Vec<PathBuf> = (0..)
        .zip(&good)
        .map(|(index, case)| {
            let path = folder.path().join(format!("{index}.{}", case.ending));
            std::fs::write(&path, &case.bytes).unwrap();
            path
        })
        .collect();
    let (code, answers) = check(&files, &["--no-fmpy", "--replay"]);
    for answer in answers.as_array().unwrap() {
        assert_eq!(problems(answer), Vec::<String>::new());
    }
    assert_eq!(code, 0);
    let done = answers[3]["report"]["done"].to_string();
    assert!(done.contains("replay of `rise` (10 steps of 0.1 s): the stated error comes out"), "{done}");
}

/// What is spoilt at random is found if, and only if, the standards' own schemas find it.
#[test]
fn the_schemas_are_those_of_the_standards() {
    let folder = tempfile::tempdir().unwrap();
    let [texts, files] = ["texts", "files"].map(|name| folder.path().join(name));
    std::fs::create_dir(&texts).unwrap();
    std::fs::create_dir(&files).unwrap();
    let documents = documents();
    let mut paths = Vec::new();
    for (index, (ending, text, bytes)) in documents.iter().enumerate() {
        std::fs::write(texts.join(format!("{index}.{ending}")), text).unwrap();
        paths.push(files.join(format!("{index}.{}", if *ending == "xml" { "fmu" } else { "ssp" })));
        std::fs::write(&paths[index], bytes).unwrap();
    }
    let said = strut::python("tests/check/schema.py", [&texts]);
    let valid: serde_json::Value = serde_json::from_str(&said).unwrap();
    let (_, answers) = check(&paths, &["--no-run", "--no-fmpy"]);
    let mut counts = [0, 0];
    for (index, ((ending, text, _), answer)) in documents.iter().zip(answers.as_array().unwrap()).enumerate()
    {
        let theirs = valid[format!("{index}.{ending}")].as_bool().unwrap();
        // That numbers are numbers, and that SSP is 1.0, is not for the schema.
        let ours = answer.get("unreadable").is_none()
            && !found(answer).iter().any(|rule| rule.contains("schema.") && rule != "schema.finite");
        assert_eq!(ours, theirs, "{:?}\n{text}", found_or_unreadable(answer));
        counts[usize::from(theirs)] += 1;
    }
    assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
}

fn found_or_unreadable(answer: &serde_json::Value) -> String {
    answer.get("unreadable").map_or_else(|| format!("{:?}", problems(answer)), ToString::to_string)
}

/// The list of rules is that of the program: one without a mutation would be a promise without a proof.
#[test]
fn each_rule_that_is_checked_has_a_mutation() {
    let page = std::fs::read_to_string(strut::root().join("docs/check-rules.md")).unwrap();
    let named = page.lines().filter_map(|line| line.strip_suffix("` |")?.rsplit_once("| `"));
    let checked: BTreeSet<&str> = named.map(|(_, name)| name).collect();
    let all: Vec<Case> =
        [fmus::all(), descriptions::all(), archives::all(), systems::all(), libraries::all(), related::all()]
            .into_iter()
            .flatten()
            .collect();
    let proven: BTreeSet<&str> = all.iter().map(|case| case.rule).chain(ELSEWHERE).collect();
    let without: Vec<&&str> = checked.difference(&proven).collect();
    let unknown: Vec<&&str> = proven.difference(&checked).collect();
    assert!(checked.len() > 100 && without.is_empty() && unknown.is_empty(), "{without:?} {unknown:?}");
}
