//! The archive of a system, by SSP 1.0.
//!
//! Connections join components only. What is to be looked at (`outputs`) is a connector of its
//! component: a connector of the system, which would be joined to it, makes libcosim and Ecos refuse the
//! whole file. FMPy names the results alike either way. Enumerations are set by number for the same
//! reason.
//!
//! A master that converts units (OMSimulator does) must not do it again where a factor was given: such
//! connections suppress it.

use strut_check::unit::Unit;

use super::adapter::Adapter;
use super::check::Checked;
use super::face::{Kind, Variable};
use super::wire::{End, Sink, Source, Way};
use super::{Packed, System};
use crate::archive::Archive;
use strut_related::{Element, root, typed};

/// All parameter sets bear this name: Ecos applies one name at a time.
const SET: &str = "defaults";
/// The archive.
pub fn archive(system: &System, checked: &Checked, components: &[Packed]) -> Vec<u8> {
    let mut archive = Archive::default();
    archive.add("SystemStructure.ssd", structure(system, checked, components));
    let mut seen: Vec<&str> = Vec::new();
    for component in components {
        // Two components may be made of one FMU.
        if !seen.contains(&component.file.as_str()) {
            seen.push(&component.file);
            archive.add(format!("resources/{}", component.file), component.bytes);
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

fn structure(system: &System, checked: &Checked, components: &[Packed]) -> Vec<u8> {
    let own = system.components.keys().map(String::as_str);
    let names: Vec<&str> = own.chain(checked.adapters.iter().map(|adapter| adapter.name.as_str())).collect();
    let adapter = |index: usize| names[system.components.len() + index];
    let port = |end: End<'_>| (names[end.component], end.variable.name.clone());
    let elements = names.iter().enumerate().map(|(index, name)| {
        let bindings = has_values(checked, index).then(|| {
            Element::new("ssd:ParameterBinding")
                .with("type", "application/x-ssp-parameter-set")
                .with("source", format!("resources/{name}.ssv"))
        });
        let connectors = match index.checked_sub(system.components.len()) {
            None => connectors(checked, index),
            Some(adapter) => adapter_connectors(checked, adapter),
        };
        let left = 40 * index;
        Element::new("ssd:Component")
            .with("name", name)
            .with("description", components[index].title)
            .with("type", "application/x-fmu-sharedlibrary")
            .with("source", format!("resources/{}", components[index].file))
            .with("implementation", "CoSimulation")
            .list("ssd:Connectors", connectors)
            .of([Element::new("ssd:ElementGeometry")
                .with("x1", left)
                .with("y1", 0)
                .with("x2", left + 20)
                .with("y2", 20)])
            .list("ssd:ParameterBindings", bindings)
    });
    let connections = checked.wires.iter().map(|wire| {
        let from = match wire.from {
            Source::Output(end) => port(end),
            Source::Adapter(index) => (adapter(index), "output".to_owned()),
        };
        let to = match wire.to {
            Sink::Input(end) => port(end),
            Sink::Adapter(index) => (adapter(index), "input".to_owned()),
            Sink::Added(index) => (adapter(index), "added".to_owned()),
        };
        let connection = Element::new("ssd:Connection")
            .with("startElement", from.0)
            .with("startConnector", from.1)
            .with("endElement", to.0)
            .with("endConnector", to.1);
        match wire.way {
            Way::Straight => connection,
            Way::AsItIs => unconverted(connection),
            Way::Transformed { factor, offset } => {
                unconverted(connection).of([Element::new("ssc:LinearTransformation")
                    .with("factor", number(factor))
                    .with("offset", number(offset))])
            }
        }
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
    let connections: Vec<Element> = connections.collect();
    Element::new("ssd:SystemStructureDescription")
        .with("xmlns:ssc", "http://ssp-standard.org/SSP1/SystemStructureCommon")
        .with("xmlns:ssd", "http://ssp-standard.org/SSP1/SystemStructureDescription")
        .with("xmlns:oms", "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd")
        .with("xmlns:osp", "http://opensimulationplatform.com/SSP/OSPAnnotations")
        .with("version", "1.0")
        .with("name", system.identifier())
        .with("description", format!("{} ({})", system.title, system.source))
        .with("generationTool", concat!("Strut ", env!("CARGO_PKG_VERSION")))
        .of([Element::new("ssd:System")
            .with("name", system.identifier())
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

/// A connection in whose values nobody converts units.
fn unconverted(connection: Element) -> Element {
    connection.with("suppressUnitConversion", true)
}

/// The variables that wires begin and end at, inputs first.
fn wired<'a>(checked: &'a Checked) -> impl Iterator<Item = (&'static str, End<'a>)> {
    let inputs = checked.wires.iter().filter_map(|wire| match wire.to {
        Sink::Input(end) => Some(("input", end)),
        Sink::Adapter(_) | Sink::Added(_) => None,
    });
    let outputs = checked.wires.iter().filter_map(|wire| match wire.from {
        Source::Output(end) => Some(("output", end)),
        Source::Adapter(_) => None,
    });
    inputs.chain(outputs)
}

/// The connectors of a component: those that are connected or looked at, each once.
fn connectors(checked: &Checked, component: usize) -> Vec<Element> {
    let ends = wired(checked).chain(checked.outputs.iter().map(|end| ("output", *end)));
    let mut seen: Vec<&str> = Vec::new();
    let mut connectors = Vec::new();
    for (kind, end) in ends.filter(|(_, end)| end.component == component) {
        let name = end.variable.name.as_str();
        if !seen.contains(&name) {
            seen.push(name);
            connectors.push(connector(name, kind, end.variable));
        }
    }
    connectors
}

/// The connectors of an adapter have the units of its parameter set, which are those of the connected components.
fn adapter_connectors(checked: &Checked, index: usize) -> Vec<Element> {
    let Adapter { units: [from, to], .. } = &checked.adapters[index];
    let added = checked.wires.iter().any(|wire| matches!(wire.to, Sink::Added(adapter) if adapter == index));
    let mut list = vec![("input", "input", from), ("output", "output", to)];
    list.extend(added.then_some(("added", "input", to)));
    let connector = |(name, kind, unit): (&str, &str, &Option<Unit>)| {
        let symbol = unit.as_ref().map_or("", |unit| &unit.symbol);
        Element::new("ssd:Connector")
            .with("name", name)
            .with("kind", kind)
            .of([Element::with_unit("ssc:Real", symbol)])
    };
    list.into_iter().map(connector).collect()
}

fn connector(name: &str, kind: &str, variable: &Variable) -> Element {
    let of_type = match variable.kind {
        Kind::Real { .. } => Element::with_unit("ssc:Real", variable.symbol()),
        Kind::Integer => Element::new("ssc:Integer"),
        Kind::Boolean => Element::new("ssc:Boolean"),
        Kind::Text => Element::new("ssc:String"),
        // SSP's own enumerations would have to be declared; their values are whole numbers.
        Kind::Choice(_) => Element::new("ssc:Integer"),
    };
    Element::new("ssd:Connector").with("name", name).with("kind", kind).of([of_type])
}

/// The units of the connectors, sorted.
fn units(checked: &Checked) -> Vec<Element> {
    let ends = wired(checked).map(|(_, end)| end).chain(checked.outputs.iter().copied());
    elements_of(ends.filter_map(|end| end.variable.unit()).collect())
}

fn elements_of(mut units: Vec<&Unit>) -> Vec<Element> {
    units.sort_by(|a, b| a.symbol.cmp(&b.symbol));
    units.dedup_by(|a, b| a.symbol == b.symbol);
    units
        .into_iter()
        .map(|unit| {
            let exponents = unit.base.iter().flatten();
            let mut base = exponents
                .fold(Element::new("ssc:BaseUnit"), |base, (name, exponent)| base.with(name, exponent));
            if unit.factor != 1.0 {
                base = base.with("factor", number(unit.factor));
            }
            if unit.offset != 0.0 {
                base = base.with("offset", number(unit.offset));
            }
            Element::new("ssc:Unit").with("name", &unit.symbol).of([base])
        })
        .collect()
}

/// The start values of a component.
fn values(checked: &Checked, component: usize) -> Vec<u8> {
    let settings: Vec<_> = checked.settings.iter().filter(|(end, _)| end.component == component).collect();
    let parameters = settings.iter().map(|(end, value)| {
        let value = typed(value, end.variable.symbol());
        Element::new("ssv:Parameter").with("name", &end.variable.name).of([value])
    });
    root(SET)
        .list("ssv:Parameters", parameters)
        .list("ssv:Units", elements_of(settings.iter().filter_map(|(end, _)| end.variable.unit()).collect()))
        .document()
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    format!("{value:?}")
}
