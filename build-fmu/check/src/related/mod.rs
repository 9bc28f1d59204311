//! Files that travel with an FMU (FMI-LS-REF): whether they are what the manifest says, and the experiments among them.

mod experiments;
mod replay;

use std::collections::HashSet;

use roxmltree::Document;
use strut_related::{FOLDER, MANIFEST, Manifest, Related, media, resolved};

pub use experiments::Prepared;
pub use replay::replay;

use crate::description::{Description, Variable};
use crate::finding::{Finding, Report, count, names};
use crate::lines::Lines;
use crate::package::Package;
use crate::rules::{Rule, related};
use crate::schema;
use crate::system::{Parameter, Values};
use crate::text::{self, Standard};

/// What the sentences of the manifest's schema are.
const RULES: schema::Rules = of_one(related::SCHEMA);

/// One rule for all sentences of a schema.
const fn of_one(rule: &'static Rule) -> schema::Rules {
    schema::Rules {
        element: rule,
        order: rule,
        missing: rule,
        attribute: rule,
        required: rule,
        value: rule,
        text: rule,
        finite: None,
    }
}

/// Checks the manifest and the files that it names; the experiments that can be run. What is wrong with the form of a draft is a
/// warning.
///
/// # Errors
/// If the archive is damaged.
pub fn check(
    package: &mut Package,
    description: &Description,
    report: &mut Report,
) -> Result<Vec<Prepared>, String> {
    let path = format!("{FOLDER}/{MANIFEST}");
    let Some(bytes) = package.read(&path)? else { return Ok(Vec::new()) };
    let (text, encoding) = text::decoded(&bytes, Standard::Ssp, &path);
    report.findings.extend(encoding.into_iter().map(|it| warning(Finding { rule: related::HEAD, ..it })));
    let (manifest, document) = match parsed(&text, Manifest::read) {
        Ok(read) => read,
        Err(error) => {
            let message = format!("the manifest of the related files cannot be read: {error}");
            report.findings.push(Finding::error(related::HEAD, message).at(&path));
            return Ok(Vec::new());
        }
    };
    for message in Manifest::head(&document) {
        report.findings.push(Finding::warning(related::HEAD, message).at(&path));
    }
    let lines = Lines::of(&text);
    for node in document.root_element().children().filter(roxmltree::Node::is_element) {
        match node.tag_name().name() {
            "Related" => {
                let found = schema::validate(node, &schema::related::RELATED, &RULES, &path, &lines);
                report.findings.extend(found.into_iter().map(warning));
            }
            "Annotations" => {}
            other => {
                let message =
                    format!("<fmiReferences> has <{other}> in it, which the schema does not know there");
                let place = format!("{path}:{}", lines.line(node));
                report.findings.push(Finding::warning(related::SCHEMA, message).at(place));
            }
        }
    }
    let mut prepared = Vec::new();
    for file in &manifest.related {
        prepared.extend(one(file, &path, package, description, report)?);
    }
    let files = count(manifest.related.len(), "related file");
    report.done.push(format!("{files}, {} among them", count(prepared.len(), "experiment")));
    Ok(prepared)
}

/// A document, and what is read from it.
fn parsed<T>(text: &str, read: fn(&Document) -> Result<T, String>) -> Result<(T, Document<'_>), String> {
    let document = Document::parse(text).map_err(|error| format!("it is no well-formed XML: {error}"))?;
    Ok((read(&document)?, document))
}

fn warning(finding: Finding) -> Finding {
    Finding { level: crate::Level::Warning, ..finding }
}

/// Checks a file that the manifest names.
fn one(
    file: &Related,
    manifest: &str,
    package: &mut Package,
    description: &Description,
    report: &mut Report,
) -> Result<Vec<Prepared>, String> {
    if !file.role.is_known() {
        let message = format!("`{}` has the role `{}`, which is none of the table", file.source, file.role.0);
        report.findings.push(Finding::warning(related::ROLE, message).at(manifest));
    }
    if file.source.contains("://") {
        report.skipped.push(format!("the related file {}: it is not in the archive", file.source));
        return Ok(Vec::new());
    }
    let path = resolved(manifest, &file.source);
    let bytes = path.as_ref().map(|path| package.read(path)).transpose()?.flatten();
    let (Some(path), Some(bytes)) = (path, bytes) else {
        let message = format!("the related file `{}` is not in the archive", file.source);
        report.findings.push(Finding::warning(related::FILE, message).at(manifest));
        return Ok(Vec::new());
    };
    // Which variables there are is not known of FMI 1.0.
    if description.runs_as().is_none() {
        return Ok(Vec::new());
    }
    match (file.role.main(), file.media.as_str()) {
        ("parameter", media::PARAMETERS) => {
            if let Err(message) = values(&bytes, &path, description) {
                report.findings.push(Finding::error(related::PARAMETERS, message).at(path));
            }
            Ok(Vec::new())
        }
        ("experiment", media::EXPERIMENTS | media::EARLIER_EXPERIMENTS) => {
            experiments::prepared(&bytes, &path, package, description, report)
        }
        ("result", media::TABLE) => {
            let result = Prepared::of_result(&path, &bytes, description);
            if result.is_none() {
                report.skipped.push(format!("the result {path}: it is no table of this FMU's Reals alone"));
            }
            Ok(result.into_iter().collect())
        }
        ("experiment", other) => {
            report.skipped.push(format!("the experiments of {path}: the type {other} is not known"));
            Ok(Vec::new())
        }
        _ => Ok(Vec::new()),
    }
}

/// The values of a parameter set, with the variables that they are for.
fn values<'a>(
    bytes: &[u8],
    path: &str,
    description: &'a Description,
) -> Result<Vec<(&'a Variable, Parameter)>, String> {
    let (Values { parameters, .. }, found) =
        Values::parse(bytes, path).map_err(|error| format!("the parameter set {error}"))?;
    if let Some(fault) = found.first() {
        return Err(fault.message.clone());
    }
    let (mut given, mut unknown, mut refused) = (Vec::new(), Vec::new(), Vec::new());
    let mut seen = HashSet::new();
    for parameter in parameters {
        if !seen.insert(parameter.name.clone()) {
            return Err(format!("`{}` has two values", parameter.name));
        }
        match description.named(&parameter.name) {
            None => unknown.push(parameter.name),
            Some(variable) if !takes(variable) || !is_of(variable, &parameter.kind) => {
                refused.push(parameter.name);
            }
            Some(variable) => given.push((variable, parameter)),
        }
    }
    if !unknown.is_empty() {
        return Err(format!("the FMU has no variable {}", names(&unknown)));
    }
    if !refused.is_empty() {
        let names = names(&refused);
        return Err(format!("no such value can be given before the initialisation to {names}"));
    }
    Ok(given)
}

/// Whether a variable can be set before the initialisation.
fn takes(variable: &Variable) -> bool {
    let initial = matches!(variable.effective_initial(), Some("exact" | "approx"));
    variable.variability != "constant" && (variable.causality == "input" || initial)
}

/// Whether a value of a kind is one for a variable: SSP 1.0 gives whole numbers to enumerations.
fn is_of(variable: &Variable, kind: &str) -> bool {
    variable.kind == kind || (variable.kind == "Enumeration" && kind == "Integer")
}
