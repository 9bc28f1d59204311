//! The archive of a system, by SSP 1.0.
//!
//! Connections join components only. What is to be looked at (`outputs`) is a connector of its
//! component: a connector of the system, which would be joined to it, makes libcosim and Ecos refuse the
//! whole file. FMPy names the results alike either way. Enumerations are set by number for the same
//! reason.

use strut_model::{Value, unit::Unit};

use super::System;
use super::check::{Checked, End, symbol};
use super::xml::Element;
use crate::archive::Archive;
use crate::fmu::{Fmu, Packed};

/// All parameter sets bear this name: Ecos applies one name at a time.
const SET: &str = "defaults";

/// The archive.
pub fn archive(system: &System, checked: &Checked, components: &[(&Fmu, &Packed)]) -> Vec<u8> {
    let mut archive = Archive::default();
    archive.add("SystemStructure.ssd", structure(system, checked, components));
    let mut seen: Vec<&str> = Vec::new();
    for (fmu, packed) in components {
        // Two components may be made of one FMU.
        if !seen.contains(&fmu.name.as_str()) {
            seen.push(&fmu.name);
            archive.add(format!("resources/{}.fmu", fmu.name), packed.bytes.as_slice());
        }
    }
    for (index, component) in system.components.keys().enumerate() {
        if has_values(checked, index) {
            archive.add(format!("resources/{component}.ssv"), values(checked, index));
        }
    }
    archive.bytes()
}

fn has_values(checked: &Checked, component: usize) -> bool {
    checked.settings.iter().any(|(end, _)| end.component == component)
}

fn structure(system: &System, checked: &Checked, components: &[(&Fmu, &Packed)]) -> Vec<u8> {
    let elements = system.components.keys().enumerate().map(|(index, name)| {
        let bindings = has_values(checked, index).then(|| {
            Element::new("ssd:ParameterBinding")
                .with("type", "application/x-ssp-parameter-set")
                .with("source", format!("resources/{name}.ssv"))
        });
        let left = 40 * index;
        Element::new("ssd:Component")
            .with("name", name)
            .with("description", components[index].0.title())
            .with("type", "application/x-fmu-sharedlibrary")
            .with("source", format!("resources/{}.fmu", components[index].0.name))
            .with("implementation", "CoSimulation")
            .list("ssd:Connectors", connectors(checked, index))
            .of([Element::new("ssd:ElementGeometry")
                .with("x1", left)
                .with("y1", 0)
                .with("x2", left + 20)
                .with("y2", 20)])
            .list("ssd:ParameterBindings", bindings)
    });
    let name = |end: &End| system.components.get_index(end.component).map_or("", |(name, _)| name.as_str());
    let connections = checked.connections.iter().map(|(from, to)| {
        Element::new("ssd:Connection")
            .with("startElement", name(from))
            .with("startConnector", &from.variable.name)
            .with("endElement", name(to))
            .with("endConnector", &to.variable.name)
    });
    let step = system.experiment.step;
    // OMSimulator takes a system for co-simulation, and its step, from this annotation.
    let master =
        Element::new("ssc:Annotation").with("type", "org.openmodelica").of([Element::new("oms:Annotations")
            .of([Element::new("oms:SimulationInformation").of([Element::new("oms:FixedStepMaster")
                .with("description", "oms-ma")
                .with("stepSize", number(step))
                .with("absoluteTolerance", "1e-6")
                .with("relativeTolerance", "1e-6")])])]);
    // And libcosim its step from this one.
    let algorithm = Element::new("ssc:Annotation")
        .with("type", "com.opensimulationplatform")
        .of([Element::new("osp:Algorithm")
            .of([Element::new("osp:FixedStepAlgorithm").with("baseStepSize", number(step))])]);
    Element::new("ssd:SystemStructureDescription")
        .with("xmlns:ssc", "http://ssp-standard.org/SSP1/SystemStructureCommon")
        .with("xmlns:ssd", "http://ssp-standard.org/SSP1/SystemStructureDescription")
        .with("xmlns:oms", "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd")
        .with("xmlns:osp", "http://opensimulationplatform.com/SSP/OSPAnnotations")
        .with("version", "1.0")
        .with("name", &system.name)
        .with("description", format!("{} ({})", system.title, system.source))
        .with("generationTool", concat!("Strut ", env!("CARGO_PKG_VERSION")))
        .of([Element::new("ssd:System")
            .with("name", &system.name)
            .with("description", &system.title)
            .list("ssd:Elements", elements)
            .list("ssd:Connections", connections)
            .of([Element::new("ssd:Annotations").of([master])])])
        .list("ssd:Units", units(checked))
        .of([Element::new("ssd:DefaultExperiment")
            .with("startTime", "0")
            .with("stopTime", number(system.experiment.stop))
            .of([Element::new("ssd:Annotations").of([algorithm])])])
        .document()
}

/// The connectors of a component: those that are connected or looked at, each once.
fn connectors(checked: &Checked, component: usize) -> Vec<Element> {
    let outputs = checked.connections.iter().map(|(from, _)| from).chain(&checked.outputs);
    let ends =
        checked.connections.iter().map(|(_, to)| ("input", to)).chain(outputs.map(|end| ("output", end)));
    let mut seen: Vec<&str> = Vec::new();
    let mut connectors = Vec::new();
    for (kind, end) in ends.filter(|(_, end)| end.component == component) {
        let name = end.variable.name.as_str();
        if !seen.contains(&name) {
            seen.push(name);
            connectors.push(
                Element::new("ssd:Connector")
                    .with("name", name)
                    .with("kind", kind)
                    .of([real("ssc:Real", end)]),
            );
        }
    }
    connectors
}

fn real(name: &'static str, end: &End) -> Element {
    match symbol(end.variable) {
        "" => Element::new(name),
        unit => Element::new(name).with("unit", unit),
    }
}

fn unit_of(end: &End) -> Option<Unit> {
    match end.variable.kind {
        strut_model::VariableKind::Real { unit, .. } => Some(unit).filter(|unit| !unit.symbol.is_empty()),
        _ => None,
    }
}

/// The units of the connectors, sorted.
fn units(checked: &Checked) -> Vec<Element> {
    let ends = checked.connections.iter().flat_map(|(from, to)| [from, to]).chain(&checked.outputs);
    elements_of(ends.filter_map(unit_of).collect())
}

fn elements_of(mut units: Vec<Unit>) -> Vec<Element> {
    units.sort_by_key(|unit| unit.symbol);
    units.dedup_by_key(|unit| unit.symbol);
    units
        .into_iter()
        .map(|unit| {
            let base = unit
                .base
                .exponents()
                .fold(Element::new("ssc:BaseUnit"), |base, (name, exponent)| base.with(name, exponent));
            Element::new("ssc:Unit").with("name", unit.symbol).of([base])
        })
        .collect()
}

/// The start values of a component.
fn values(checked: &Checked, component: usize) -> Vec<u8> {
    let settings: Vec<_> = checked.settings.iter().filter(|(end, _)| end.component == component).collect();
    let parameters = settings.iter().map(|(end, value)| {
        let value = match value {
            Value::Real(value) => real("ssv:Real", end).with("value", number(*value)),
            Value::Integer(value) => Element::new("ssv:Integer").with("value", value),
            Value::Boolean(value) => Element::new("ssv:Boolean").with("value", value),
            Value::Text(value) => Element::new("ssv:String").with("value", value),
        };
        Element::new("ssv:Parameter").with("name", &end.variable.name).of([value])
    });
    Element::new("ssv:ParameterSet")
        .with("xmlns:ssc", "http://ssp-standard.org/SSP1/SystemStructureCommon")
        .with("xmlns:ssv", "http://ssp-standard.org/SSP1/SystemStructureParameterValues")
        .with("version", "1.0")
        .with("name", SET)
        .list("ssv:Parameters", parameters)
        .list("ssv:Units", elements_of(settings.iter().filter_map(|(end, _)| unit_of(end)).collect()))
        .document()
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    format!("{value:?}")
}
