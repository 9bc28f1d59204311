//! Whether a system (SSP 1.0) fits together: its files, its components, what joins them, and the values for them.

mod connections;
mod connectors;
mod dictionaries;
mod documents;
mod files;
mod parameters;
mod signals;
mod structure;
mod values;

use std::collections::BTreeMap;
use std::path::Path;

use crate::description::{Description, Kind, Variable};
use crate::finding::{Finding, Report, count, repeated};
use crate::package::Package;
use crate::rules::{Rule, ssp};
use crate::text::Standard;
use crate::unit::Unit;
use crate::{Options, Response, fmpy, fmu};
use dictionaries::Dictionaries;
use structure::{Content, Element, Structure};

pub use structure::FILE;
pub use values::{Parameter, Values};

/// A system with what its components are made of.
struct System {
    structure: Structure,
    /// Files of the archive by the components' sources.
    files: BTreeMap<String, String>,
    /// Descriptions of the FMUs (FMI 2.0) by their files; none of what could not be read.
    fmus: BTreeMap<String, Option<Description>>,
    /// The signals that elements share.
    dictionaries: Dictionaries,
}

/// Checks a system, and each FMU in it.
///
/// # Errors
/// If its description cannot be read.
pub fn check(file: &Path, package: &mut Package, options: &Options) -> Result<Report, String> {
    let bytes = package.read(FILE)?.ok_or_else(|| format!("there is no {FILE}"))?;
    let (structure, found) = Structure::parse(&bytes)?;
    let mut report = Report::new(options.listener.as_ref());
    report.findings = package.findings(Standard::Ssp, file);
    report.findings.extend(found);
    let (files, fmus, mut dictionaries) = (BTreeMap::new(), BTreeMap::new(), Dictionaries::default());
    let mut system = System { structure, files, fmus, dictionaries: Dictionaries::default() };
    system.components(package, options, &mut report)?;
    system.read_dictionaries(&system.structure.root, &[], &mut dictionaries, package, &mut report);
    system.dictionaries = dictionaries;
    report.about = system.about();
    report.findings.extend(system.names());
    report.findings.extend(system.connectors());
    report.findings.extend(system.connections());
    report.tell();
    let values = system.parameters(package, &mut report);
    report.done.push(format!(
        "system: schema, {}, {}, {}, {}",
        count(system.structure.root.all().iter().map(|it| it.connectors.len()).sum(), "connector"),
        count(system.number_of_connections(), "connection"),
        count(values, "parameter value"),
        count(system.dictionaries.signals(), "dictionary signal")
    ));
    if system.structure.version.starts_with("1.") {
        fmpy::validate(file, fmpy::What::System, &options.fmpy, &mut report)?;
    } else {
        let version = &system.structure.version;
        report.skipped.push(format!("FMPy's validation: it is for SSP 1.0, this is {version}"));
    }
    Ok(report)
}

/// A place in the description of the system.
fn at(line: u32) -> String {
    format!("{FILE}:{line}")
}

/// The name of the file in the archive that a relative URI is for.
fn file_of(uri: &str, package: &Package) -> Option<String> {
    let path = uri.split('#').next().unwrap_or(uri).trim_start_matches("./");
    let decoded = decoded(path);
    // Many write a file's name as it is, and mean no URI.
    let candidates = [uri, path, &decoded];
    candidates.into_iter().find(|name| package.files().any(|file| file == *name)).map(str::to_owned)
}

/// A URI's path without percent encoding.
fn decoded(path: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = path.as_bytes();
    while let Some((first, tail)) = rest.split_first() {
        let code = (*first == b'%').then(|| tail.get(..2)).flatten();
        let code = code.and_then(|two| u8::from_str_radix(std::str::from_utf8(two).ok()?, 16).ok());
        bytes.push(code.unwrap_or(*first));
        rest = if code.is_some() { &tail[2..] } else { tail };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

impl System {
    fn about(&self) -> Vec<String> {
        let all = self.structure.root.all();
        let components = all.iter().filter(|it| matches!(it.content, Content::Component { .. })).count();
        let connections = self.number_of_connections();
        vec![
            format!("SSP {}", self.structure.version).trim_end().to_owned(),
            format!("{} of {}", count(components, "component"), count(self.fmus.len(), "FMU")),
            count(connections, "connection"),
        ]
    }

    fn number_of_connections(&self) -> usize {
        let of = |element: &&Element| match &element.content {
            Content::System { connections, .. } => connections.len(),
            _ => 0,
        };
        self.structure.root.all().iter().map(of).sum()
    }

    /// Finds each component's file, and checks it if it is an FMU.
    fn components(
        &mut self,
        package: &mut Package,
        options: &Options,
        report: &mut Report,
    ) -> Result<(), String> {
        let failed = |error: std::io::Error| format!("there is no folder to unpack to: {error}");
        let folder = tempfile::tempdir().map_err(failed)?;
        for element in self.structure.root.all() {
            let Content::Component { source, media, implementation } = &element.content else { continue };
            let Some(file) = file_of(source, package) else {
                let message =
                    format!("{} is made of `{source}`, which the archive does not have", element.shown());
                report.findings.push(Finding::error(ssp::SOURCE, message).at(at(element.line)).help(
                    "give a path from the description's folder on, like resources/Rig.fmu, and put the file there",
                ));
                continue;
            };
            if media != "application/x-fmu-sharedlibrary" {
                report.skipped.push(format!("{file}, which is of the type {media} and no FMU"));
                continue;
            }
            if !self.fmus.contains_key(&file) {
                let path = folder.path().join(format!("{}.fmu", self.fmus.len()));
                std::fs::write(&path, package.read(&file)?.unwrap_or_default()).map_err(failed)?;
                self.fmus.insert(file.clone(), component(&file, &path, options, report));
                report.tell();
            }
            if let Some(description) = &self.fmus[&file] {
                report.findings.extend(implemented(element, implementation, description));
            }
            self.files.insert(source.clone(), file);
        }
        Ok(())
    }

    /// Names that are missing or not alone.
    fn names(&self) -> Vec<Finding> {
        let mut findings = Vec::new();
        let mut wrong = |rule: &'static Rule, message: String, line: u32| {
            findings.push(Finding::error(rule, message).at(at(line)));
        };
        for element in self.structure.root.all() {
            let names = element.connectors.iter().map(|connector| connector.name.as_str());
            for (connector, again) in element.connectors.iter().zip(repeated(names)) {
                if again {
                    let message =
                        format!("{} has two connectors of the name `{}`", element.shown(), connector.name);
                    wrong(ssp::CONNECTOR_TWICE, message, connector.line);
                }
            }
            let Content::System { elements, .. } = &element.content else { continue };
            let names = elements.iter().map(|inner| inner.name.as_str());
            for (inner, again) in elements.iter().zip(repeated(names)) {
                if again {
                    let message = format!("there are two elements of the name `{}`", inner.path);
                    wrong(ssp::NAME_TWICE, message, inner.line);
                }
            }
        }
        findings
    }

    /// The description of what a component is made of, if that is known.
    fn description(&self, element: &Element) -> Option<&Description> {
        match &element.content {
            Content::Component { source, .. } => self.fmus.get(self.files.get(source)?)?.as_ref(),
            _ => None,
        }
    }

    /// The variable that a component's connector or parameter is for.
    fn variable(&self, element: &Element, name: &str) -> Option<&Variable> {
        self.description(element)?.named(name)
    }

    /// The unit of a component's variable.
    fn unit_of(&self, element: &Element, variable: &Variable) -> Option<Unit> {
        let declared = self.description(element).map_or(&[][..], |description| &description.units);
        variable.unit.as_deref().map(|symbol| found(declared, symbol))
    }
}

/// The unit of a symbol; only named if it is not declared.
fn found(declared: &[Unit], symbol: &str) -> Unit {
    declared.iter().find(|unit| unit.symbol == symbol).cloned().unwrap_or_else(|| Unit::named(symbol))
}

/// Checks an FMU of the archive; what is found is told with its name. Returns its description if it is FMI 2.0.
fn component(file: &str, path: &Path, options: &Options, report: &mut Report) -> Option<Description> {
    let within = |line: &String| format!("{file}: {line}");
    // The caller reports its findings, with the file's name.
    let options = &Options { listener: None, ..options.clone() };
    let opened = Package::open(path).and_then(|mut inner| Ok((fmu::description(&mut inner)?.0, inner)));
    let told = opened.and_then(|(description, mut inner)| match fmu::check(path, &mut inner, options) {
        // Without FMPy there is nothing to check other versions by, which is no fault of theirs.
        Err(why) if description.is_of_another_version() => {
            Ok((description, Report { skipped: vec![why], ..Report::default() }))
        }
        told => Ok((description, told?)),
    });
    match told {
        Ok((description, told)) => {
            report.findings.extend(told.findings.into_iter().map(|mut finding| {
                let place = finding.place.map_or_else(String::new, |place| format!("/{place}"));
                finding.place = Some(format!("{file}{place}"));
                finding
            }));
            report.done.extend(told.done.iter().map(within));
            report.skipped.extend(told.skipped.iter().map(within));
            report
                .signs
                .extend(told.signs.into_iter().map(|it| Response { component: Some(file.to_owned()), ..it }));
            (!description.is_of_another_version()).then_some(description)
        }
        Err(error) => {
            let message = format!("it cannot be checked: {error}");
            report.findings.push(Finding::error(ssp::SOURCE, message).at(file));
            None
        }
    }
}

/// The interface that a component wants is there.
fn implemented(element: &Element, wanted: &str, description: &Description) -> Option<Finding> {
    let kind = match wanted {
        "CoSimulation" => Kind::CoSimulation,
        "ModelExchange" => Kind::ModelExchange,
        _ => return None,
    };
    if description.interface(kind).is_some() {
        return None;
    }
    let message = format!("{} is to be used by {wanted}, which its FMU does not have", element.shown());
    Some(Finding::error(ssp::IMPLEMENTATION, message).at(at(element.line)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_encoding_is_undone() {
        for (encoded, plain) in [
            ("a%20b.fmu", "a b.fmu"),
            ("R%C3%A4der", "Räder"),
            ("100%", "100%"),
            ("%2", "%2"),
            ("%zz", "%zz"),
        ] {
            assert_eq!(decoded(encoded), plain);
        }
    }
}
