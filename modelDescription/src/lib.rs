//! Writes the `modelDescription.xml` of FMI 2.0 or FMI 3.0 from what a model declares.
//!
//! ```
//! # use strut_model_description::Header;
//! # fn example(interface: &strut_model::Interface) {
//! let header = Header { name: "QuarterCar", ..Header::default() };
//! let xml = strut_model_description::write(interface, &header);
//! # }
//! ```
//!
//! The order of the variables, and so every index in the model structure, is that of
//! [`Interface::variables`]. The text is a function of its arguments alone: no clock, no random
//! number, so that the same sources give the same archive.

mod content;
mod fmi3;
mod schema;

use strut_model::Interface;

/// What stands in the head of a description and is not declared by the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header<'a> {
    /// Name of the FMU: the model's name and the name of the library in the archive.
    pub name: &'a str,
    /// What it is; the model's summary if empty.
    pub description: &'a str,
    /// Version of the model.
    pub version: &'a str,
    /// Where its equations and numbers come from; left out if empty.
    pub author: &'a str,
    /// License; left out if empty.
    pub license: &'a str,
    /// Copyright; left out if empty.
    pub copyright: &'a str,
    /// The tool that writes this.
    pub generation_tool: &'a str,
    /// Time of generation as `2026-01-31T12:00:00Z`; left out if none.
    pub generated: Option<&'a str>,
}

impl Default for Header<'_> {
    fn default() -> Self {
        Self {
            name: "",
            description: "",
            version: env!("CARGO_PKG_VERSION"),
            author: "",
            license: "",
            copyright: "",
            generation_tool: concat!("Strut ", env!("CARGO_PKG_VERSION")),
            generated: None,
        }
    }
}

/// The description of a model as an XML document of FMI 2.0.
pub fn write(interface: &Interface, header: &Header<'_>) -> String {
    xml("fmiModelDescription", &content::document(interface, header))
}

/// The description of a model as an XML document of FMI 3.0.
pub fn write_fmi3(interface: &Interface, header: &Header<'_>) -> String {
    xml("fmiModelDescription", &fmi3::document(interface, header))
}

/// The `terminalsAndIcons.xml` of FMI 3.0.
pub fn write_terminals(interface: &Interface) -> String {
    xml("fmiTerminalsAndIcons", &fmi3::terminals(interface))
}

fn xml(root: &str, document: &impl serde::Serialize) -> String {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let serializer = quick_xml::se::Serializer::with_root(&mut text, Some(root));
    // Strings, numbers and lists in named structs: there is nothing that the serializer refuses.
    let mut serializer = serializer.expect("a root's name is a name");
    serializer.indent(' ', 2);
    document.serialize(serializer).expect("the description is plain data");
    text.push('\n');
    text
}
