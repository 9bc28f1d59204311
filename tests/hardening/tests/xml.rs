//! A user's model with everything in its texts that XML, C and JSON have a meaning for, read back by readers
//! that others have written.

use strut_model::{About, Instant, Interface, Model, NoVariables, Real, Settings, Variables, bundles};
use strut_model_description::{Header, write};

const SUMMARY: &str = "Größe \"in\" <b> & 'Ä' ]]> &amp; 100 % \\ €";

/// Numbers out.
#[derive(Variables, Clone, Copy)]
pub struct Output<R> {
    /// Weg des Rads: "größer" <&> 'kleiner' ]]> &lt;
    #[var(unit = strut_model::unit::M)]
    pub räder: R,
}

/// Texts.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Texts {
    /// Name of <file> & "path"
    #[set(name = "text.file", start = "<ä> & 'b' \"c\".csv")]
    pub file: String,
}

/// Does nothing.
pub struct Hostile;

impl Model for Hostile {
    const ABOUT: About = About { name: "Hostile", summary: SUMMARY, ..About::DEFAULT };
    bundles! { settings: Texts, output: Output }

    fn prepare(_: &Texts, _: Option<&std::path::Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, _: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        (NoVariables, Output { räder: R::from(0.0) })
    }
}

#[test]
fn hostile_texts_come_back_from_foreign_readers() {
    let interface = Interface::of::<Hostile>(None, None).expect("the model is right");
    let header = Header { name: "Hostile", description: SUMMARY, license: "M&T <\"'>", ..Header::default() };
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("modelDescription.xml"), write(&interface, &header))
        .expect("it is ours");
    let told = strut::python("tests/masters/description_read_back.py", [folder.path()]);
    let mut expected = vec![SUMMARY.to_owned(), header.license.to_owned()];
    for variable in &interface.variables {
        expected.extend([variable.name.clone(), variable.doc.clone()]);
    }
    expected.push("<ä> & 'b' \"c\".csv".to_owned());
    for reader in ["FMPy", "lxml"] {
        let lines = told.lines().filter_map(|line| line.strip_prefix(reader)?.strip_prefix(": "));
        assert_eq!(lines.collect::<Vec<_>>(), expected, "{reader}");
    }
}
