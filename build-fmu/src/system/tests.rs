//! Mistakes in systems, and the documents of one without.

use std::io::Read;

use strut_model::ParameterSet;

use super::*;
use crate::fmu::Fmu;

const GOOD: &str = r#"
name = "front-corner"
title = "A rig & its road"
source = "Quanser 3.1"
components = { road = "QuanserRoad", rig = "QuanserQuarterCar" }
connections = ["road.position -> rig.road.position", "road.velocity -> rig.road.velocity"]
outputs = ["rig.body.position", "road.position"]
[experiment]
stop = 10.0
step = 1e-3
[parameters]
"rig.actuator.force" = { value = 0, unit = "N" }
"rig.tire.lift_off" = { value = true }
"rig.solver.method" = { value = "Rosenbrock" }
"rig.sprung_mass" = { value = 2.5, unit = "kg", source = "weighed" }
"#;

fn fmu(name: &str) -> Fmu {
    let sets =
        strut_physics::PARAMETER_SETS.iter().map(|(_, text)| (ParameterSet::parse(text).unwrap(), *text));
    let (parsed, text) = sets.into_iter().find(|(set, _)| set.fmu == name).unwrap();
    let entry = *strut_physics::CATALOGUE.iter().find(|entry| entry.about.name == parsed.model).unwrap();
    Fmu {
        name: name.into(),
        entry,
        set: Some(crate::fmu::Set { parsed, text: text.into(), folder: "".into() }),
        related: None,
    }
}

fn fmus() -> [Fmu; 2] {
    [fmu("QuanserRoad"), fmu("QuanserQuarterCar")]
}

fn check(text: &str) -> Result<()> {
    let system = System::parse("corner.toml", text)?;
    system.check(&faces()).map(drop)
}

fn faces() -> [Face; 2] {
    fmus().map(|fmu| Face::of(&fmu.interface().unwrap()))
}

#[test]
fn a_good_system_passes() {
    check(GOOD).unwrap();
}

#[test]
fn all_mistakes_are_told_at_once() {
    let text = GOOD
        .replace("road.velocity -> rig.road.velocity", "raod.velocity -> rig.road.velocity")
        .replace("\"rig.body.position\", \"road.position\"", "\"rig.body.place\"")
        .replace("value = 2.5", "value = -2.5")
        .replace("\"rig.actuator.force\"", "\"rig.actuator.froce\"");
    let told = check(&text).unwrap_err().to_string();
    let errors: Vec<&str> = told.lines().filter(|line| line.starts_with("error:")).collect();
    // An input whose connection is wrong is not told as one that nothing drives; one whose value misses it is.
    for (error, part) in errors.iter().zip([
        "no component `raod`",
        "no variable `body.place`",
        "no variable `actuator.froce`",
        "`rig.sprung_mass` = -2.5 kg is out of bounds",
        "nothing drives the input `rig.actuator.force`",
    ]) {
        assert!(error.contains(part), "{told}");
    }
    assert_eq!(errors.len(), 5, "{told}");
}

#[test]
fn mistakes_are_named() {
    let wrong = |from: &str, to: &str| {
        assert!(GOOD.contains(from), "{from}");
        check(&GOOD.replace(from, to)).unwrap_err().to_string()
    };
    for (from, to, expected) in [
        ("name = \"front-corner\"", "", "missing field `name`"),
        ("name = \"front-corner\"", "name = \"a/b\"", "has the name `a/b` in it"),
        ("name = \"front-corner\"", "name = \"3-corner\"", "has the name `3_corner` in it"),
        (
            "{ road =",
            "{ the-road =",
            "has the name `the-road` in it\nhelp: a component's name is a letter, then",
        ),
        ("{ road =", "{ _road =", "has the name `_road` in it"),
        ("source =", "sauce =", "unknown field `sauce`"),
        ("step = 1e-3", "step = 0.0", "cannot stop at 10 s in steps of 0 s"),
        ("road.velocity -> rig", "road.velocity > rig", "has no arrow"),
        ("road.velocity ->", "velocity ->", "names no variable of a component"),
        (
            "road.velocity ->",
            "raod.velocity ->",
            "no component `raod` in the system front-corner\nhelp: did you mean `road`?",
        ),
        ("road.velocity ->", "road.velcity ->", "component `road` (QuanserRoad) has no variable `velcity`"),
        ("road.velocity ->", "rig.actuator.force ->", "`rig.actuator.force` is no output"),
        ("-> rig.road.velocity", "-> rig.body.position", "`rig.body.position` is no input"),
        ("-> rig.road.velocity", "-> rig.road.position", "leads from \"m/s\" to \"m\""),
        (
            "road.velocity -> rig.road.velocity",
            "road.position -> rig.road.position",
            "`rig.road.position` is connected twice in the system front-corner\nhelp: if it is to be the sum, write",
        ),
        (", \"road.velocity -> rig.road.velocity\"", "", "nothing drives the input `rig.road.velocity`"),
        ("\"rig.actuator.force\"", "\"rig.road.position\"", "is connected and has a value as well"),
        ("unit = \"kg\"", "unit = \"g\"", "`rig.sprung_mass` is given in \"g\" but declared in \"kg\""),
        (", unit = \"kg\"", "", "must be given with its unit, \"kg\""),
        ("value = 2.5", "value = -2.5", "`rig.sprung_mass` = -2.5 kg is out of bounds"),
        ("value = 2.5", "value = \"much\"", "`rig.sprung_mass` must be a number"),
        ("value = 2.5", "valeu = 2.5", "write \"component.variable\" = { value = 1.0, unit = \"m\" }"),
        ("value = true", "value = 1", "`rig.tire.lift_off` must be true or false"),
        ("\"Rosenbrock\"", "\"Euler\"", "`rig.solver.method` must be one of Explicit, Rosenbrock"),
        ("rig.sprung_mass", "rig.body.acceleration", "is calculated and cannot be given a value"),
    ] {
        let error = wrong(from, to);
        assert!(error.contains(expected), "{to}: {error}");
    }
}

fn packed() -> (Vec<String>, String, String) {
    let fmus = fmus();
    let packed = fmus
        .each_ref()
        .map(|fmu| fmu.pack(&[crate::version::Version::Two], &[], ("", "")).unwrap().remove(0));
    let components = fmus.iter().zip(&packed).map(|(fmu, packed)| Packed {
        title: fmu.title(),
        file: format!("{}.fmu", fmu.name),
        bytes: &packed.bytes,
    });
    let components: Vec<_> = components.collect();
    let bytes = System::parse("corner.toml", GOOD).unwrap().pack(&faces(), &components);
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    let names = zip.file_names().map(|name| name.unwrap().into_owned()).collect();
    let mut text = |name: &str| {
        let mut text = String::new();
        zip.by_name(name).unwrap().read_to_string(&mut text).unwrap();
        text
    };
    (names, text("SystemStructure.ssd"), text("resources/rig.ssv"))
}

#[test]
fn components_keep_the_order_of_the_file() {
    let (names, ssd, _) = packed();
    assert_eq!(
        names,
        [
            "SystemStructure.ssd",
            "resources/QuanserRoad.fmu",
            "resources/QuanserQuarterCar.fmu",
            "resources/rig.ssv",
        ]
    );
    let document = roxmltree::Document::parse(&ssd).unwrap();
    let attributes = |tag: &str, attribute: &str| -> Vec<String> {
        let nodes = document.descendants().filter(|node| node.tag_name().name() == tag);
        nodes.map(|node| node.attribute(attribute).unwrap_or("-").to_owned()).collect()
    };
    assert_eq!(attributes("Component", "name"), ["road", "rig"]);
    for tag in ["SystemStructureDescription", "System"] {
        assert_eq!(attributes(tag, "name"), ["front_corner"]);
    }
    assert_eq!(attributes("Connection", "endConnector"), ["road.position", "road.velocity"]);
    // Each connector once, also if it is connected and looked at.
    assert_eq!(
        attributes("Connector", "name"),
        ["position", "velocity", "road.position", "road.velocity", "body.position"]
    );
    assert_eq!(attributes("Unit", "name"), ["m", "m/s"]);
    assert_eq!(attributes("System", "description"), ["A rig & its road"]);
    assert_eq!(attributes("FixedStepMaster", "stepSize"), ["0.001"]);
}

#[test]
fn values_are_written_in_their_types() {
    let (_, _, ssv) = packed();
    let document = roxmltree::Document::parse(&ssv).unwrap();
    let values: Vec<_> = document
        .descendants()
        .filter(|node| node.tag_name().name() == "Parameter")
        .map(|node| {
            let value = node.first_element_child().unwrap();
            (node.attribute("name").unwrap(), value.tag_name().name(), value.attribute("value").unwrap())
        })
        .collect();
    assert_eq!(
        values,
        [
            ("actuator.force", "Real", "0.0"),
            ("tire.lift_off", "Boolean", "true"),
            ("solver.method", "Integer", "2"),
            ("sprung_mass", "Real", "2.5"),
        ]
    );
}
