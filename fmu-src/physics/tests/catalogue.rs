//! Parameter sets fit their models; systems connect what exists, with equal units.

use std::collections::BTreeSet;
use std::path::Path;

use strut_model::{Causality, Entry, Interface, ParameterSet, Value, Variable, VariableKind};
use strut_physics::{CATALOGUE, PARAMETER_SETS, SYSTEMS};
use toml::Table;

const PARAMETERS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/parameters");

fn resources() -> std::path::PathBuf {
    Path::new(PARAMETERS).join("resources")
}

fn model(name: &str) -> &'static Entry {
    CATALOGUE.iter().find(|entry| entry.about.name == name).unwrap_or_else(|| panic!("no model {name}"))
}

fn sets() -> Vec<ParameterSet> {
    PARAMETER_SETS
        .iter()
        .map(|(file, text)| {
            let set = ParameterSet::parse(text).unwrap_or_else(|error| panic!("{file}: {error}"));
            assert_eq!(*file, format!("{}.toml", set.fmu));
            set
        })
        .collect()
}

/// The interface of an FMU: that of a set, or of a model as it is declared.
fn fmu(name: &str) -> Interface {
    let result = match sets().iter().find(|set| set.fmu == name) {
        Some(set) => model(&set.model).interface(Some(set), Some(&resources())),
        None => model(name).interface(None, None),
    };
    result.unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_set_fits_its_model_and_runs() {
    for set in sets() {
        let entry = model(&set.model);
        // Names, units and bounds are checked here, what must hold together by the run.
        let interface = entry
            .interface(Some(&set), Some(&resources()))
            .unwrap_or_else(|error| panic!("{}: {error}", set.fmu));
        for (name, given) in &set.values {
            let variable = interface.variable(name).unwrap();
            let is_real = matches!(variable.kind, VariableKind::Real { .. });
            assert_eq!(
                given.unit.is_some(),
                is_real,
                "{}: {name} needs a unit if it is a real number",
                set.fmu
            );
            assert!(!given.source.is_empty(), "{}: {name} needs a source", set.fmu);
        }
        let trajectory = entry
            .demonstrate(Some(&set), Some(&resources()))
            .unwrap_or_else(|error| panic!("{}: {error}", set.fmu));
        for (name, _, values) in &trajectory.signals {
            assert!(values.iter().all(|value| value.is_finite()), "{}: {name}", set.fmu);
        }
    }
}

#[test]
fn assumed_values_say_so_in_the_description() {
    let mut seen = 0;
    for set in sets() {
        let interface = fmu(&set.fmu);
        for (name, given) in &set.values {
            let says = interface.variable(name).unwrap().doc.ends_with("(value assumed)");
            assert_eq!(says, given.assumed, "{}: {name}", set.fmu);
            seen += usize::from(says);
        }
    }
    assert!(seen > 100);
}

#[test]
fn every_declared_model_runs_and_shows_something() {
    for entry in CATALOGUE {
        let trajectory =
            entry.demonstrate(None, None).unwrap_or_else(|error| panic!("{}: {error}", entry.about.name));
        for name in entry.about.experiment.plot {
            let (_, _, values) = trajectory.signals.iter().find(|(signal, _, _)| signal == name).unwrap();
            assert!(values.iter().any(|value| *value != values[0]), "{}: {name} rests", entry.about.name);
        }
        for (name, _) in entry.about.experiment.stimuli {
            assert!(
                trajectory.signals.iter().any(|(signal, _, _)| signal == name),
                "{}: no input {name}",
                entry.about.name
            );
        }
    }
}

#[test]
fn variables_have_names_of_their_own() {
    for entry in CATALOGUE {
        let mut names = BTreeSet::new();
        for variable in entry.interface(None, None).unwrap().variables {
            assert!(names.insert(variable.name.clone()), "{}: {} twice", entry.about.name, variable.name);
        }
    }
}

/// What the unit of each real number is, is declared or follows: only the signals of an adapter and of a record may be anything.
#[test]
fn every_real_number_has_a_unit() {
    let mut rates = 0;
    for name in
        CATALOGUE.iter().map(|entry| entry.about.name.to_owned()).chain(sets().into_iter().map(|set| set.fmu))
    {
        let interface = fmu(&name);
        for variable in &interface.variables {
            let VariableKind::Real { unit, derivative_of, .. } = &variable.kind else { continue };
            let any: &[&str] = match name.as_str() {
                "SignalAdapter" => &["input", "added", "output", "factor", "offset", "initial"],
                "RecordedSource" => &["signal"],
                _ => &[],
            };
            let open = any.contains(&variable.name.as_str());
            assert_eq!(unit.symbol.is_empty(), open, "{name}: {}", variable.name);
            let Some(state) = derivative_of else { continue };
            let VariableKind::Real { unit: of, .. } = &interface.variables[*state].kind else {
                panic!("{name}")
            };
            let (base, mut expected) = (unit.base.unwrap(), of.base.unwrap());
            expected.s -= 1;
            assert_eq!(base, expected, "{name}: {} in {}", variable.name, unit.symbol);
            rates += 1;
        }
    }
    assert!(rates > 300, "{rates}");
}

#[test]
fn names_are_unique_and_files_exist() {
    let mut names: BTreeSet<String> = CATALOGUE.iter().map(|entry| entry.about.name.to_owned()).collect();
    for set in sets() {
        assert!(names.insert(set.fmu.clone()), "{} twice", set.fmu);
        for file in &set.files {
            assert!(resources().join(file).is_file(), "{}: {file}", set.fmu);
        }
    }
}

#[test]
fn sources_are_in_the_bibliography() {
    let literature = std::fs::read_to_string(Path::new(PARAMETERS).join("literature.bib")).unwrap();
    for set in sets() {
        assert!(literature.contains(&format!("{{{},", set.source)), "{}: {}", set.fmu, set.source);
    }
}

fn variable<'a>(components: &'a [(String, Interface)], path: &str) -> &'a Variable {
    let (component, name) = path.split_once('.').unwrap_or_else(|| panic!("{path} has no component"));
    let (_, interface) = components
        .iter()
        .find(|(known, _)| known == component)
        .unwrap_or_else(|| panic!("no component {component}"));
    interface.variable(name).unwrap_or_else(|| panic!("no variable {path}"))
}

fn unit(variable: &Variable) -> &str {
    match &variable.kind {
        VariableKind::Real { unit, .. } => &unit.symbol,
        _ => panic!("{} is no real number", variable.name),
    }
}

#[test]
fn systems_connect_outputs_with_inputs_of_equal_unit() {
    for (file, text) in SYSTEMS {
        let system: Table = text.parse().unwrap_or_else(|error| panic!("{file}: {error}"));
        assert_eq!(*file, format!("{}.toml", system["name"].as_str().unwrap()));
        let components: Vec<(String, Interface)> = system["components"]
            .as_table()
            .unwrap()
            .iter()
            .map(|(name, component)| (name.clone(), fmu(component.as_str().unwrap())))
            .collect();
        let mut fed = BTreeSet::new();
        for connection in system["connections"].as_array().unwrap() {
            let (from, to) = connection.as_str().unwrap().split_once(" -> ").unwrap();
            let (source, sink) = (variable(&components, from), variable(&components, to));
            assert_eq!(
                (source.causality, sink.causality),
                (Causality::Output, Causality::Input),
                "{file}: {connection:?}"
            );
            assert_eq!(unit(source), unit(sink), "{file}: {connection:?}");
            assert!(fed.insert(to.to_owned()), "{file}: {to} is fed twice");
        }
        for output in system["outputs"].as_array().unwrap() {
            let path = output.as_str().unwrap();
            assert_eq!(variable(&components, path).causality, Causality::Output, "{file}: {path}");
        }
        for (path, given) in system["parameters"].as_table().unwrap() {
            let VariableKind::Real { unit, start, .. } = &variable(&components, path).kind else {
                panic!("{path}")
            };
            assert_eq!(given["unit"].as_str(), Some(&*unit.symbol), "{file}: {path}");
            assert_eq!(given["value"].as_float(), *start, "{file}: {path} must restate what is built in");
        }
    }
}

/// A passive configuration is a set of its own for masters that do not apply parameter sets; nothing else may differ.
#[test]
fn passive_actuators_are_the_active_ones_with_their_pumps_locked() {
    for valves in ["Soft", "Hard"] {
        let values = |kind: &str| {
            let name = format!("Ajala{kind}{valves}PumpHydraulicActuator");
            let set =
                sets().into_iter().find(|set| set.fmu == name).unwrap_or_else(|| panic!("no set {name}"));
            set.values.into_iter().map(|(name, given)| (name, given.value)).collect::<Vec<_>>()
        };
        let (active, mut passive) = (values(""), values("Passive"));
        passive.retain(|(name, value)| !(name == "pump.locked" && *value == Value::Boolean(true)));
        assert_eq!(passive.len() + 1, values("Passive").len(), "{valves}: the pump is not locked");
        assert_eq!(active, passive);
    }
}

#[test]
fn quansers_finding_stands_in_the_sets() {
    let tire = |name: &str| match sets().iter().find(|set| set.fmu == name).unwrap().values["tire.stiffness"]
        .value
    {
        Value::Real(value) => value,
        _ => f64::NAN,
    };
    assert_eq!((tire("QuanserQuarterCar"), tire("QuanserTable31QuarterCar")), (2500.0, 1250.0));
}
