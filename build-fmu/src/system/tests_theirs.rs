//! Systems with FMUs of others: units, signs and roles that differ.

use std::io::Write;
use std::path::{Path, PathBuf};

use strut_model::ParameterSet;
use zip::{ZipWriter, write::SimpleFileOptions};

use super::*;

/// A quarter of a truck as others might export it: millimetres and kilonewtons, brackets in names, no unit, a local.
const TRUCK: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Truck" guid="{1}">
  <CoSimulation modelIdentifier="Truck"/>
  <UnitDefinitions>
    <Unit name="mm"><BaseUnit m="1" factor="0.001"/></Unit>
    <Unit name="kN"><BaseUnit kg="1" m="1" s="-2" factor="1000"/></Unit>
    <Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
    <Unit name="furlong"/>
  </UnitDefinitions>
  <TypeDefinitions>
    <SimpleType name="Load"><Real unit="kN" min="0"/></SimpleType>
    <SimpleType name="Mode"><Enumeration><Item name="empty" value="3"/><Item name="full" value="7"/></Enumeration></SimpleType>
  </TypeDefinitions>
  <ModelVariables>
    <ScalarVariable name="chassis.z[1]" valueReference="0" causality="output"><Real unit="mm"/></ScalarVariable>
    <ScalarVariable name="chassis.v[1]" valueReference="1" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="chassis.a[1]" valueReference="2"><Real/></ScalarVariable>
    <ScalarVariable name="far" valueReference="3" causality="output"><Real unit="furlong"/></ScalarVariable>
    <ScalarVariable name="loaded" valueReference="0" causality="output"><Boolean/></ScalarVariable>
    <ScalarVariable name="F_strut[1]" valueReference="4" causality="input"><Real unit="kN" start="0"/></ScalarVariable>
    <ScalarVariable name="payload" valueReference="5" causality="parameter" variability="fixed"><Real declaredType="Load" start="50"/></ScalarVariable>
    <ScalarVariable name="mode" valueReference="1" causality="parameter" variability="fixed"><Enumeration declaredType="Mode" start="3"/></ScalarVariable>
  </ModelVariables>
</fmiModelDescription>"#;

const SYSTEM: &str = r#"
name = "truck"
title = "A truck of others"
source = "here"
components = { truck = { fmu = "Truck.fmu" }, motor = "LinearMotor" }
connections = [
    { from = "truck.chassis.z[1]", to = "motor.suspension.deflection", factor = -1e-3 },
    { from = "truck.chassis.z[1]", to = "motor.suspension.velocity", factor = -1e-3, operation = "derivative", filter = 0.01 },
    { from = "motor.force", to = "truck.F_strut[1]", factor = 1e-3 },
]
outputs = ["truck.chassis.z[1]"]
[experiment]
stop = 1.0
step = 5e-4
[parameters]
"truck.payload" = { value = 60.0, unit = "kN" }
"truck.mode" = { value = "full" }
"motor.voltage" = { value = 0.0, unit = "V" }
"motor.force_reference" = { value = 100.0, unit = "N" }
"#;

fn fmu(folder: &Path, xml: &str, binary: bool) -> PathBuf {
    let path = folder.join("Truck.fmu");
    let mut zip = ZipWriter::new(std::fs::File::create(&path).unwrap());
    let mut add = |name: &str, text: &str| {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    };
    add("modelDescription.xml", xml);
    if binary {
        add("binaries/linux64/Truck.so", "");
    }
    zip.finish().unwrap();
    path
}

fn truck() -> Theirs {
    let folder = tempfile::tempdir().unwrap();
    Theirs::read(&fmu(folder.path(), TRUCK, true)).unwrap()
}

#[test]
fn platforms_are_those_with_a_library() {
    assert_eq!(truck().platforms, ["linux64"]);
}

fn faces() -> [Face; 2] {
    let motor = strut_physics::CATALOGUE.iter().find(|entry| entry.about.name == "LinearMotor").unwrap();
    [truck().face, Face::of(&motor.interface(None, None).unwrap())]
}

fn check(text: &str) -> Result<Vec<Adapter>> {
    System::parse("truck.toml", text)?.check(&faces())
}

#[test]
fn what_is_connected_with_a_factor_passes_through_an_adapter() {
    let adapters = check(SYSTEM).unwrap();
    let names: Vec<&str> = adapters.iter().map(|adapter| adapter.name.as_str()).collect();
    assert_eq!(
        names,
        ["to_motor_suspension_deflection", "to_motor_suspension_velocity", "to_truck_F_strut_1_"]
    );
    let model = strut_physics::CATALOGUE.iter().find(|entry| entry.about.name == Adapter::MODEL).unwrap();
    for (adapter, factor) in adapters.iter().zip([-1e-3, -1e-3, 1e-3]) {
        let set = ParameterSet::parse(&adapter.set).unwrap();
        assert_eq!(set.values["factor"].value, Value::Real(factor));
        assert_eq!(set.values["period"].value, Value::Real(5e-4));
        let interface = model.interface(Some(&set), None).unwrap();
        assert_eq!(interface.variable("filter").is_some(), set.values.contains_key("filter"));
    }
}

#[test]
fn mistakes_tell_what_to_write() {
    let wrong = |from: &str, to: &str| {
        assert!(SYSTEM.contains(from), "{from}");
        check(&SYSTEM.replace(from, to)).unwrap_err().to_string()
    };
    for (from, to, expected) in [
        (
            ", factor = 1e-3 }",
            " }",
            "leads from \"N\" to \"kN\" in the system truck\nhelp: write { from = \"motor.force\", to = \"truck.F_strut[1]\", factor = 0.001 }",
        ),
        (
            ", factor = -1e-3, operation = \"derivative\", filter = 0.01",
            "",
            "or take the rate of change: write",
        ),
        (
            "chassis.z[1]\", to = \"motor.suspension.deflection\", factor = -1e-3",
            "chassis.v[1]\", to = \"motor.suspension.velocity\"",
            "`truck.chassis.v[1]` does not tell its unit in the system truck\nhelp: look it up; if it is that of \"m/s\" with the same sign, write",
        ),
        (
            "chassis.z[1]\", to = \"motor.suspension.deflection\", factor = -1e-3",
            "far\", to = \"motor.suspension.deflection\"",
            "`truck.far` does not tell its unit",
        ),
        (
            "truck.chassis.z[1]\", to = \"motor.suspension.deflection",
            "truck.chassis.a[1]\", to = \"motor.suspension.deflection",
            "ask for an export with it as an output",
        ),
        (
            "truck.chassis.z[1]\", to = \"motor.suspension.deflection",
            "truck.loaded\", to = \"motor.suspension.deflection",
            "is of type Boolean and `motor.suspension.deflection` of type Real",
        ),
        (
            "truck.chassis.z[1]\", to = \"motor.suspension.deflection",
            "truck.chassis.z[2]\", to = \"motor.suspension.deflection",
            "component `truck` (Truck.fmu) has no variable `chassis.z[2]`",
        ),
        (
            "factor = -1e-3, operation = \"derivative\", filter",
            "operation = \"derivative\", filter",
            "help: write { from = \"truck.chassis.z[1]\", to = \"motor.suspension.velocity\", \
             operation = \"derivative\", factor = 0.001 }",
        ),
        ("factor = 1e-3 }", "factor = 0.0 }", "has the factor zero"),
        ("factor = 1e-3 }", "factor = 1e-3, filter = 0.1 }", "it is for operation = \"derivative\""),
        ("factor = 1e-3 }", "factor = 1e-3, operation = \"lag\" }", "a lag without a time constant"),
        ("factor = 1e-3 }", "factor = 1e-3, initial = 0.1 }", "it is for operation = \"integral\""),
        (
            "factor = 1e-3 }",
            "factor = 1e-3, gain = 2.0 }",
            "a connection is \"road.position -> rig.road.position\", or",
        ),
        ("operation = \"derivative\"", "operation = \"double\"", "a connection is"),
        (
            "{ fmu = \"Truck.fmu\" }",
            "{ file = \"Truck.fmu\" }",
            "or { fmu = \"path.fmu\" } for one of others",
        ),
        ("value = 60.0", "value = -60.0", "`truck.payload` = -60 kN is out of bounds"),
        ("\"full\"", "\"half\"", "must be one of empty, full"),
    ] {
        let error = wrong(from, to);
        assert!(error.contains(expected), "{to}: {error}");
    }
}

/// Who knows that a model without units is in SI units says so once.
#[test]
fn what_has_no_unit_may_be_in_si_units() {
    let silent = SYSTEM.replace(
        "{ from = \"truck.chassis.z[1]\", to = \"motor.suspension.velocity\", factor = -1e-3, operation = \"derivative\", filter = 0.01 }",
        "\"truck.chassis.v[1] -> motor.suspension.velocity\"",
    );
    let told = check(&silent).unwrap_err().to_string();
    assert!(told.contains("write { fmu = \"Truck.fmu\", units = \"SI\" }"), "{told}");
    let si = silent.replace("{ fmu = \"Truck.fmu\" }", "{ fmu = \"Truck.fmu\", units = \"SI\" }");
    assert_eq!(check(&si).unwrap().len(), 2);
    // What declares a unit is still in that, and what has no factor of one to the SI's is no coherent unit.
    let millimetres = si.replace(
        "{ from = \"truck.chassis.z[1]\", to = \"motor.suspension.deflection\", factor = -1e-3 }",
        "\"truck.chassis.z[1] -> motor.suspension.deflection\"",
    );
    assert!(check(&millimetres).unwrap_err().to_string().contains("leads from \"mm\" to \"m\""));
    let other = si.replace("units = \"SI\"", "units = \"cgs\"");
    assert!(System::parse("truck.toml", &other).unwrap_err().to_string().contains("units = \"SI\""));
}

#[test]
fn files_that_are_no_fmus_for_co_simulation_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let refused =
        |xml: &str, binary: bool| Theirs::read(&fmu(folder.path(), xml, binary)).unwrap_err().to_string();
    let exchange = TRUCK.replace("CoSimulation modelIdentifier", "ModelExchange modelIdentifier");
    assert!(refused(&exchange, true).contains("is for model exchange only"));
    assert!(refused(&TRUCK.replace("\"2.0\"", "\"3.0\""), true).contains("is an FMU of FMI 3.0"));
    assert!(refused(TRUCK, false).contains("has no binaries, only sources"));
    assert!(refused("<a>", true).contains("is no FMU"));
    std::fs::write(folder.path().join("text.fmu"), "text").unwrap();
    assert!(Theirs::read(&folder.path().join("text.fmu")).unwrap_err().to_string().contains("is no FMU"));
    let missing = Theirs::read(&folder.path().join("missing.fmu")).unwrap_err().to_string();
    assert!(missing.contains("cannot read") && missing.contains("relative to the file of the system"));
}

/// The SSD of the system with these lines in it.
fn structure(text: &str) -> String {
    let system = System::parse("truck.toml", text).unwrap();
    let count = 2 + system.check(&faces()).unwrap().len();
    let components: Vec<Packed> =
        (0..count).map(|index| Packed { title: "", file: format!("{index}.fmu"), bytes: b"" }).collect();
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(system.pack(&faces(), &components))).unwrap();
    std::io::read_to_string(zip.by_name("SystemStructure.ssd").unwrap()).unwrap()
}

#[test]
fn nobody_converts_what_has_a_factor() {
    let ssd = structure(SYSTEM);
    let document = roxmltree::Document::parse(&ssd).unwrap();
    let connections: Vec<_> = document
        .descendants()
        .filter(|node| node.tag_name().name() == "Connection")
        .map(|node| {
            ["startElement", "startConnector", "endElement", "endConnector", "suppressUnitConversion"]
                .map(|name| node.attribute(name).unwrap_or("-"))
        })
        .collect();
    assert_eq!(connections.len(), 6);
    assert_eq!(connections[4], ["motor", "force", "to_truck_F_strut_1_", "input", "true"]);
    assert_eq!(connections[5], ["to_truck_F_strut_1_", "output", "truck", "F_strut[1]", "true"]);
    // The adapter's ends bear the units of what they are joined to, and the units tell what they are.
    let adapter =
        document.descendants().find(|node| node.attribute("name") == Some("to_truck_F_strut_1_")).unwrap();
    let units: Vec<_> = adapter.descendants().filter_map(|node| node.attribute("unit")).collect();
    assert_eq!(units, ["N", "kN"]);
    let kilonewton = document.descendants().find(|node| node.attribute("name") == Some("kN")).unwrap();
    assert_eq!(kilonewton.first_element_child().unwrap().attribute("factor"), Some("1000.0"));
}

#[test]
fn a_second_connection_with_a_factor_is_added() {
    let more = "outputs = [";
    let text = SYSTEM.replace(
        &format!("]\n{more}"),
        &format!("    {{ from = \"motor.force\", to = \"truck.F_strut[1]\", factor = -2.0, offset = 1.0 }},\n]\n{more}"),
    );
    let ssd = structure(&text);
    let document = roxmltree::Document::parse(&ssd).unwrap();
    let ends: Vec<_> = document
        .descendants()
        .filter(|node| node.tag_name().name() == "Connection")
        .map(|node| ["startElement", "endElement", "endConnector"].map(|name| node.attribute(name).unwrap()))
        .collect();
    let first = "to_truck_F_strut_1_";
    let second = "to_truck_F_strut_1__2";
    assert!(ends.contains(&[first, second, "added"]), "{ends:?}");
    assert!(ends.contains(&["motor", second, "input"]) && ends.contains(&[second, "truck", "F_strut[1]"]));
    assert_eq!(ends.iter().filter(|end| end[1] == "truck").count(), 1);
    let plain =
        SYSTEM.replace(&format!("]\n{more}"), &format!("    \"motor.force -> motor.voltage\",\n]\n{more}"));
    assert!(check(&plain).unwrap_err().to_string().contains("leads from \"N\" to \"V\""));
}

#[test]
fn the_connection_itself_may_have_the_factor() {
    let ssd = structure(&SYSTEM.replace("[experiment]", "factors = \"connection\"\n[experiment]"));
    let document = roxmltree::Document::parse(&ssd).unwrap();
    let factors: Vec<_> = document
        .descendants()
        .filter(|node| node.tag_name().name() == "LinearTransformation")
        .map(|node| (node.parent().unwrap().attribute("suppressUnitConversion"), node.attribute("factor")))
        .collect();
    assert_eq!(factors, [(Some("true"), Some("-0.001")), (Some("true"), Some("0.001"))]);
    // A rate of change still needs a component.
    assert!(ssd.contains("to_motor_suspension_velocity"));
}

#[test]
fn a_component_may_have_a_parameter_set_of_its_own() {
    let text = SYSTEM.replace("motor = \"LinearMotor\"", "motor = { parameters = \"sets/motor.toml\" }");
    let system = System::parse("truck.toml", &text).unwrap();
    let Part::Set(set) = &system.components["motor"] else { panic!("{:?}", system.components) };
    assert_eq!(
        (set.parameters.as_path(), system.components["motor"].to_string()),
        (Path::new("sets/motor.toml"), "sets/motor.toml".into())
    );
    let text = SYSTEM.replace("motor = \"LinearMotor\"", "motor = { set = \"sets/motor.toml\" }");
    let error = System::parse("truck.toml", &text).unwrap_err().to_string();
    assert!(error.contains("{ parameters = \"my-set.toml\" }"), "{error}");
}
