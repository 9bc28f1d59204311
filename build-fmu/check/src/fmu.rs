//! The check of an FMU.

use std::path::Path;

use roxmltree::Document;

use crate::description::{Description, Kind};
use crate::finding::{Finding, Report, count};
use crate::lines::Lines;
use crate::package::Package;
use crate::rules::fmi;
use crate::text::{self, Standard};
use crate::{Options, behaviour, fmpy, head, libraries, probe, related, schema, structure, variables};

/// The file that an FMU must have.
pub const FILE: &str = "modelDescription.xml";

/// Checks an FMU.
///
/// # Errors
/// If it cannot be read, or there is nothing to check it by.
pub fn check(file: &Path, package: &mut Package, options: &Options) -> Result<Report, String> {
    let (description, found) = description(package)?;
    let mut report = Report::new(options.listener.as_ref());
    report.findings = package.findings(Standard::Fmi, file);
    report.about = about(&description);
    if description.is_of_another_version() {
        let version = &description.version;
        report.skipped.push(format!("the rules for FMI 2.0: this is FMI {version}"));
        let experiments = related::check(package, &description, &mut report)?;
        let asked = run(&description, package, &experiments, options, &mut report)?;
        return if fmpy::validate(file, fmpy::What::Fmu, &options.fmpy, &mut report)? || asked {
            Ok(report)
        } else {
            Err(format!(
                "this is FMI {version}; only FMPy could check it, and there is none (name a Python with --fmpy)"
            ))
        };
    }
    report.findings.extend(found);
    report.findings.extend(head::findings(&description));
    report.findings.extend(variables::findings(&description));
    report.findings.extend(structure::findings(&description));
    report.tell();
    report.done.push(format!(
        "description: schema, {}, model structure, units, start values",
        count(description.variables.len(), "variable")
    ));
    let (found, platforms) = libraries::findings(package, &description)?;
    report.findings.extend(found);
    report.tell();
    if !platforms.is_empty() {
        report.about.push(platforms.join(", "));
        report.done.push(format!("libraries: {}", platforms.join(", ")));
    }
    let experiments = related::check(package, &description, &mut report)?;
    report.tell();
    run(&description, package, &experiments, options, &mut report)?;
    fmpy::validate(file, fmpy::What::Fmu, &options.fmpy, &mut report)?;
    Ok(report)
}

/// Runs the library as the options want. Returns whether they want experiments or signs, beyond the rules.
fn run(
    description: &Description,
    package: &mut Package,
    experiments: &[related::Prepared],
    options: &Options,
    report: &mut Report,
) -> Result<bool, String> {
    if options.replay && experiments.is_empty() {
        report.skipped.push("replay: there is no experiment in it that can be run (FMI-LS-REF)".into());
    }
    let experiments = if options.replay { experiments } else { &[] };
    if !options.run {
        report.skipped.push("running it: not wanted".into());
        return Ok(false);
    }
    let failed = |error: std::io::Error| format!("there is no folder to unpack to: {error}");
    let folder = tempfile::tempdir().map_err(failed)?;
    let (plain, odd) = (folder.path().join("fmu"), folder.path().join("100 % Räder (Kopie)"));
    for path in [&plain, &odd] {
        std::fs::create_dir(path).map_err(failed)?;
        package.unpack(path)?;
    }
    let unpacked = behaviour::Unpacked { plain: &plain, odd: &odd };
    let probe = probe::Probe { program: options.program.clone(), timeout: options.timeout };
    let further = behaviour::Further { signs: options.signs, experiments };
    behaviour::run(description, &unpacked, &probe, &further, report)?;
    Ok(options.signs || !experiments.is_empty())
}

/// The description of an FMU, with findings on its encoding and schema.
///
/// # Errors
/// If it is missing or cannot be read.
pub fn description(package: &mut Package) -> Result<(Description, Vec<Finding>), String> {
    let bytes =
        package.read(FILE)?.ok_or_else(|| format!("there is no {FILE} at the root of the archive"))?;
    let (text, mut findings) = text::decoded(&bytes, Standard::Fmi, FILE);
    let document =
        Document::parse(&text).map_err(|error| format!("{FILE} is no well-formed XML: {error}"))?;
    let (root, lines) = (document.root_element(), Lines::of(&text));
    let description = Description::of(root, &lines)?;
    if !description.is_of_another_version() {
        findings.extend(schema::validate(root, &schema::fmi::ROOT, &RULES, FILE, &lines));
    }
    Ok((description, findings))
}

/// What the sentences of the schema are.
const RULES: schema::Rules = schema::Rules {
    element: fmi::SCHEMA_ELEMENT,
    order: fmi::SCHEMA_ORDER,
    missing: fmi::SCHEMA_MISSING,
    attribute: fmi::SCHEMA_ATTRIBUTE,
    required: fmi::SCHEMA_REQUIRED,
    value: fmi::SCHEMA_VALUE,
    text: fmi::SCHEMA_TEXT,
    finite: Some(fmi::FINITE),
};

fn about(description: &Description) -> Vec<String> {
    let kinds: Vec<&str> = description
        .interfaces
        .iter()
        .map(|interface| match interface.kind {
            Kind::CoSimulation => "co-simulation",
            Kind::ModelExchange => "model exchange",
        })
        .collect();
    let of = |causality: &str| description.variables.iter().filter(|it| it.causality == causality).count();
    let mut about =
        vec![format!("FMI {} {}", description.version, kinds.join(" and ")).trim_end().to_owned()];
    // FMI 1.0 declares its variables in another way.
    if description.runs_as().is_some() {
        about.push(format!("{}, {}", count(of("input"), "input"), count(of("output"), "output")));
    }
    about
}
