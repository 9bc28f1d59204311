//! `fmi-ls-manifest.xml`: which files there are, and what each is for.

use roxmltree::{Document, Node};

use crate::{Element, NAME, VERSION};

const NAMESPACE: &str = "http://fmi-standard.org/fmi-ls-manifest";
const DESCRIPTION: &str = "Layered Standard providing information on related files included in an FMU.";

/// The roles without sub-roles that the draft knows.
pub const ROLES: [&str; 18] = [
    "document",
    "requirement",
    "specification",
    "model",
    "parameter",
    "system",
    "testcase",
    "experiment",
    "result",
    "method",
    "rationale",
    "report",
    "request",
    "delivery",
    "configuration",
    "signature",
    "meta-data",
    "other",
];
/// What an experiment may be for.
const PURPOSES: [&str; 3] = ["smoke-test", "validation", "uncertainty-analysis"];

/// What a file is for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Role(pub String);

impl Role {
    /// Its main role.
    pub fn main(&self) -> &str {
        self.0.split('/').next().unwrap_or_default()
    }

    /// Whether the draft knows it.
    pub fn is_known(&self) -> bool {
        match self.0.split_once('/') {
            None => ROLES.contains(&&*self.0) || self.0 == "serialized-state",
            Some(("experiment", purpose)) => PURPOSES.contains(&purpose),
            Some((main, _)) => main == "serialized-state",
        }
    }
}

/// `<Related>`: a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Related {
    /// MIME type.
    pub media: String,
    /// Its address, relative to the manifest.
    pub source: String,
    /// What it is for.
    pub role: Role,
    /// What it is, for people.
    pub description: String,
}

impl Related {
    /// A file beside the manifest.
    pub fn new(media: &str, source: &str, role: &str, description: impl Into<String>) -> Self {
        let (media, source, role) = (media.into(), source.into(), Role(role.into()));
        Self { media, source, role, description: description.into() }
    }

    fn read(node: Node) -> Self {
        let text = |name: &str| node.attribute(name).map(str::to_owned);
        Self {
            media: text("type").unwrap_or_else(|| "application/octet-stream".into()),
            source: text("source").unwrap_or_default(),
            role: Role(text("role").unwrap_or_default()),
            description: text("description").unwrap_or_default(),
        }
    }
}

/// The files of an FMU.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Manifest {
    /// In the order of the document.
    pub related: Vec<Related>,
}

impl Manifest {
    /// The document.
    pub fn document(&self) -> Vec<u8> {
        let files = self.related.iter().map(|it| {
            Element::new("Related")
                .with("type", &it.media)
                .with("source", &it.source)
                .with("role", &it.role.0)
                .with("description", &it.description)
        });
        Element::new("fmiReferences")
            .with("xmlns:fmi-ls", NAMESPACE)
            .with("fmi-ls:fmi-ls-name", NAME)
            .with("fmi-ls:fmi-ls-version", VERSION)
            .with("fmi-ls:fmi-ls-description", DESCRIPTION)
            .of(files)
            .document()
    }

    /// Reads a document, as it is.
    ///
    /// # Errors
    /// If its root is not that of a manifest.
    pub fn read(document: &Document) -> Result<Self, String> {
        let root = document.root_element();
        if root.tag_name().name() != "fmiReferences" {
            return Err(format!("its root is <{}> and not <fmiReferences>", root.tag_name().name()));
        }
        let files = root.children().filter(|it| it.has_tag_name("Related"));
        Ok(Self { related: files.map(Related::read).collect() })
    }

    /// What is wrong with the attributes of the root, each a sentence.
    pub fn head(document: &Document) -> Vec<String> {
        let root = document.root_element();
        let wanted = [("fmi-ls-name", Some(NAME)), ("fmi-ls-version", None), ("fmi-ls-description", None)];
        let wrong = |(name, value): (&str, Option<&str>)| match (root.attribute((NAMESPACE, name)), value) {
            (None, _) => Some(format!("<fmiReferences> lacks the attribute `{name}` of {NAMESPACE}")),
            (Some(given), Some(value)) if given != value => {
                Some(format!("`{name}` is `{given}` and not `{value}`"))
            }
            _ => None,
        };
        wanted.into_iter().filter_map(wrong).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_manifest_reads_back() {
        let file = Related::new("text/csv", "a&b.csv", "experiment/validation", "the \"validation\" record");
        let manifest = Manifest { related: vec![file] };
        let text = String::from_utf8(manifest.document()).unwrap();
        let document = Document::parse(&text).unwrap();
        assert_eq!(Manifest::read(&document).unwrap(), manifest);
        assert_eq!(Manifest::head(&document), Vec::<String>::new());
        let other = text.replace(NAME, "org.fmi-standard.fmi-ls-xcp");
        assert_eq!(Manifest::head(&Document::parse(&other).unwrap()).len(), 1);
    }

    #[test]
    fn roles_are_those_of_the_draft() {
        let known = |role: &str| Role(role.into()).is_known();
        assert!(
            known("experiment") && known("experiment/validation") && known("serialized-state/x86_64-linux")
        );
        assert!(!known("experiment/other") && !known("parameter/fast") && !known("licence") && !known(""));
        assert_eq!(Role("experiment/validation".into()).main(), "experiment");
    }
}
