//! FMUs that others have made, as components of a system.

use std::io::{Cursor, Read};
use std::path::Path;

use roxmltree::{Document, Node};
use strut_check::unit::Unit;
use strut_model::Causality;
use zip::ZipArchive;

use super::face::{Face, Kind, Variable};
use crate::failure::{Failure, Result};

/// An FMU that others have made.
#[derive(Clone, Debug)]
pub struct Theirs {
    /// Its name in the archive.
    pub file: String,
    /// What it is, in one sentence.
    pub title: String,
    /// Its variables.
    pub face: Face,
    /// Folders of the platforms that it has a binary for.
    pub platforms: Vec<String>,
    /// The archive, as it is.
    pub bytes: Vec<u8>,
}

impl Theirs {
    /// Reads the model description of an FMU.
    ///
    /// # Errors
    /// If the file is not an FMU 2.0 for co-simulation with a binary in it: what it is instead.
    pub fn read(path: &Path) -> Result<Self> {
        let shown = path.display();
        let bytes = std::fs::read(path).map_err(|error| {
            Failure::new(format!("cannot read `{shown}`: {error}"))
                .help("paths of FMUs are relative to the file of the system")
        })?;
        let no_fmu = |why: &dyn std::fmt::Display| Failure::new(format!("`{shown}` is no FMU: {why}"));
        let mut archive = ZipArchive::new(Cursor::new(&bytes)).map_err(|error| no_fmu(&error))?;
        let mut platforms: Vec<String> =
            archive.file_names().filter_map(|name| platform_of(&name.ok()?)).collect();
        platforms.sort();
        platforms.dedup();
        let mut xml = String::new();
        archive
            .by_name("modelDescription.xml")
            .map_err(|error| no_fmu(&format!("modelDescription.xml: {error}")))?
            .read_to_string(&mut xml)
            .map_err(|error| no_fmu(&format!("modelDescription.xml: {error}")))?;
        let document = Document::parse(&xml).map_err(|error| no_fmu(&error))?;
        let root = document.root_element();
        let version = root.attribute("fmiVersion").unwrap_or("unknown");
        if version != "2.0" {
            return Err(Failure::new(format!("`{shown}` is an FMU of FMI {version}"))
                .help("systems are made of FMUs of FMI 2.0; ask for an export for it"));
        }
        if child(root, "CoSimulation").is_none() {
            return Err(Failure::new(format!("`{shown}` is for model exchange only"))
                .help("ask for an export for co-simulation, which brings its own solver"));
        }
        if platforms.is_empty() {
            return Err(Failure::new(format!("`{shown}` has no binaries, only sources"))
                .help("compile it first: `fmpy compile FILE` does"));
        }
        let title = root.attribute("description").filter(|text| !text.trim().is_empty());
        let title = title.or_else(|| root.attribute("modelName")).unwrap_or_default().to_owned();
        let file = path.file_name().map(|name| plain(&name.to_string_lossy())).unwrap_or_default();
        let face = face(root).map_err(|why| no_fmu(&why))?;
        Ok(Self { file, title, face, platforms, bytes })
    }
}

/// A file's name without what has a meaning in a URI, by which a component's source is given: some masters decode
/// it and some do not.
fn plain(name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
    name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect()
}

/// The platform's folder of a library, `binaries/win64/Truck.dll`.
fn platform_of(name: &str) -> Option<String> {
    let (platform, file) = name.strip_prefix("binaries/")?.split_once('/')?;
    let library = [".so", ".dll", ".dylib"].iter().any(|ending| file.ends_with(ending));
    (library && !file.contains('/')).then(|| platform.to_owned())
}

fn child<'a, 'x>(node: Node<'a, 'x>, name: &str) -> Option<Node<'a, 'x>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn face(root: Node) -> std::result::Result<Face, String> {
    let list = |name, item: &'static str| {
        let list = child(root, name);
        list.into_iter().flat_map(move |list| list.children().filter(move |node| node.has_tag_name(item)))
    };
    let units: Vec<Unit> =
        list("UnitDefinitions", "Unit").map(Unit::parse).collect::<std::result::Result<_, _>>()?;
    let types: Vec<Node> = list("TypeDefinitions", "SimpleType").collect();
    let variables = list("ModelVariables", "ScalarVariable")
        .map(|node| variable(node, &units, &types))
        .collect::<std::result::Result<_, _>>()?;
    Ok(Face { variables })
}

fn number(node: Node, attribute: &str) -> std::result::Result<Option<f64>, String> {
    let read = |text: &str| text.trim().parse().map_err(|_| format!("{attribute}=\"{text}\" is no number"));
    node.attribute(attribute).map(read).transpose()
}

fn variable(node: Node, units: &[Unit], types: &[Node]) -> std::result::Result<Variable, String> {
    let name = node.attribute("name").ok_or("a variable has no name")?.to_owned();
    let of_type = node.children().find(Node::is_element).ok_or_else(|| format!("`{name}` has no type"))?;
    // What the variable does not say itself its declared type says.
    let declared = of_type.attribute("declaredType").and_then(|wanted| {
        let found = types.iter().find(|node| node.attribute("name") == Some(wanted))?;
        found.children().find(Node::is_element)
    });
    let causality = match node.attribute("causality").unwrap_or("local") {
        "input" => Causality::Input,
        "output" => Causality::Output,
        "parameter" => Causality::Parameter,
        "calculatedParameter" => Causality::CalculatedParameter,
        _ => Causality::Local,
    };
    let number_of = |attribute| match number(of_type, attribute)? {
        None => declared.map_or(Ok(None), |node| number(node, attribute)),
        some => Ok(some),
    };
    let kind = match of_type.tag_name().name() {
        "Real" => {
            let symbol =
                of_type.attribute("unit").or_else(|| declared.and_then(|node| node.attribute("unit")));
            let unit = symbol.filter(|symbol| !symbol.is_empty()).map(|symbol| {
                let known = units.iter().find(|unit| unit.symbol == symbol).cloned();
                known.unwrap_or_else(|| Unit::named(symbol))
            });
            Kind::Real { unit, min: number_of("min")?, max: number_of("max")? }
        }
        "Integer" => Kind::Integer,
        "Boolean" => Kind::Boolean,
        "String" => Kind::Text,
        "Enumeration" => {
            let items = declared.into_iter().flat_map(|node| node.children().filter(Node::is_element));
            let item = |node: Node| {
                let value =
                    number(node, "value")?.ok_or_else(|| format!("an item of `{name}` has no value"))?;
                Ok((node.attribute("name").unwrap_or_default().to_owned(), value as i32))
            };
            Kind::Choice(items.map(item).collect::<std::result::Result<_, String>>()?)
        }
        other => return Err(format!("`{name}` is of the unknown type {other}")),
    };
    let constant = node.attribute("variability") == Some("constant");
    let exact = match node.attribute("initial") {
        Some(initial) => initial == "exact",
        // As the standard fills it in (FMI 2.0.4, 2.2.7).
        None => causality == Causality::Parameter,
    };
    let settable = !constant && (causality == Causality::Input || exact);
    Ok(Variable { name, causality, settable, kind })
}
