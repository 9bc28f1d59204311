//! What is checked: a small FMU in parts that can be spoilt; and what `build-fmu check` says.

use std::io::{Cursor, Write};
use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;

use serde_json::{Value, json};
use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

const XML: &str = include_str!("modelDescription.xml");

/// What an FMU is made of.
pub struct Parts {
    /// `modelDescription.xml`.
    pub xml: String,
    /// The library, for Linux on an Intel processor.
    pub library: Option<Vec<u8>>,
    /// What else there is.
    pub files: Vec<(String, Vec<u8>, CompressionMethod)>,
}

/// The small FMU of `check/faulty.c`, with a fault of its code.
pub fn parts(fault: &str) -> Parts {
    static FAULTLESS: OnceLock<Vec<u8>> = OnceLock::new();
    let library =
        if fault.is_empty() { FAULTLESS.get_or_init(|| compiled("")).clone() } else { compiled(fault) };
    let data = ("resources/data.txt".into(), b"data".to_vec(), CompressionMethod::Deflated);
    Parts { xml: XML.into(), library: Some(library), files: vec![data] }
}

fn compiled(fault: &str) -> Vec<u8> {
    library(fault, false)
}

/// The library with a fault; it may need another library, which is not there when it is loaded.
pub fn library(fault: &str, needs_another: bool) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("Faulty.so");
    let source = strut::root().join("tests/check/faulty.c");
    let mut cc = Command::new("cc");
    cc.args(["-shared", "-fPIC", "-O1", "-w", "-ffp-contract=off", "-o"]).arg(&out).arg(source).arg("-lm");
    if !fault.is_empty() {
        cc.arg(format!("-DFAULT_{fault}"));
    }
    if needs_another {
        let (empty, other) = (folder.path().join("other.c"), folder.path().join("libother.so"));
        std::fs::write(&empty, "int other;").unwrap();
        strut::run(Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(&other).arg(&empty));
        cc.arg("-Wl,--no-as-needed").arg(&other);
    }
    strut::run(&mut cc);
    std::fs::read(out).unwrap()
}

/// The same with another text in its description.
pub fn described(from: &str, to: &str) -> Parts {
    let mut parts = parts("");
    assert!(parts.xml.contains(from), "{from}");
    parts.xml = parts.xml.replace(from, to);
    parts
}

impl Parts {
    /// The same with another text in its description.
    pub fn with(mut self, from: &str, to: &str) -> Self {
        assert!(self.xml.contains(from), "{from}");
        self.xml = self.xml.replacen(from, to, 1);
        self
    }

    /// The FMU.
    pub fn bytes(&self) -> Vec<u8> {
        self.bytes_with(self.xml.as_bytes())
    }

    /// The FMU with a description that may be no text.
    pub fn bytes_with(&self, xml: &[u8]) -> Vec<u8> {
        let description = ("modelDescription.xml", xml, CompressionMethod::Deflated);
        let library = self.library.iter();
        let library =
            library.map(|it| ("binaries/linux64/Faulty.so", it.as_slice(), CompressionMethod::Deflated));
        let files =
            self.files.iter().map(|(name, contents, method)| (name.as_str(), contents.as_slice(), *method));
        archive([description].into_iter().chain(library).chain(files))
    }
}

/// A zip archive of files, with the way of compression of each.
pub fn archive<'a>(files: impl IntoIterator<Item = (&'a str, &'a [u8], CompressionMethod)>) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, contents, method) in files {
        zip.start_file(name, SimpleFileOptions::default().compression_method(method)).unwrap();
        zip.write_all(contents).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// Exit code and answer of `check --json`.
pub fn check(files: &[PathBuf], options: &[&str]) -> (i32, Value) {
    let mut command = strut::build_fmu();
    let output = command.arg("check").args(files).arg("--json").args(options).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let wrong = |error| panic!("{error}: {text}{}", String::from_utf8_lossy(&output.stderr));
    let lines = text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(wrong));
    (output.status.code().unwrap(), collected(lines))
}

/// The lines of each file together: `file` and either `unreadable`, or `problems` and `report` with all that was found.
fn collected(lines: impl Iterator<Item = Value>) -> Value {
    let (mut answers, mut findings) = (Vec::new(), Vec::new());
    for mut line in lines {
        if let Some(finding) = line.get_mut("finding") {
            findings.push(finding.take());
            continue;
        }
        let findings = std::mem::take(&mut findings);
        if line.get("problems").is_some() {
            let report = json!({
                "findings": findings, "about": line["about"], "done": line["done"], "skipped": line["skipped"], "signs": line["signs"],
            });
            line = json!({"file": line["file"], "problems": line["problems"], "report": report});
        }
        answers.push(line);
    }
    assert!(findings.is_empty(), "findings of a file that does not end: {findings:#?}");
    answers.into()
}

/// Findings above notes, as `rule: message`.
pub fn problems(answer: &Value) -> Vec<String> {
    let findings = answer["report"]["findings"].as_array().unwrap_or_else(|| panic!("{answer}"));
    let problems = findings.iter().filter(|finding| finding["level"] != "note");
    problems
        .map(|it| format!("{}: {}", it["rule"].as_str().unwrap(), it["message"].as_str().unwrap()))
        .collect()
}

/// Checks many files in one run of the program, by our own rules alone: each has problems of its rule, and no others.
pub fn each_has_its_problem(cases: &[(&str, Vec<u8>, &str, &str)], ending: &str, options: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<PathBuf> = (0..)
        .zip(cases)
        .map(|(index, (name, bytes, ..))| {
            let path = folder.path().join(format!("{index}-{name}.{ending}"));
            std::fs::write(&path, bytes).unwrap();
            path
        })
        .collect();
    let (code, answers) = check(&files, &[&["--no-fmpy"], options].concat());
    assert_eq!(code, 1);
    for ((name, _, rule, message), answer) in cases.iter().zip(answers.as_array().unwrap()) {
        let found = problems(answer);
        assert!(found.iter().any(|problem| problem.contains(message)), "{name}: {found:#?}");
        // Of its rule, or of a finer one.
        let is_of = |problem: &String| {
            let rest = problem.strip_prefix(*rule);
            rest.is_some_and(|rest| rest.starts_with(": ") || rest.starts_with('.'))
        };
        assert!(found.iter().all(is_of), "{name}: {found:#?}");
    }
}
