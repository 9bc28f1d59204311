//! Files that travel with an FMU: parameter sets, experiments with their expected outputs, reports.
//!
//! They are described as the layered standard FMI-LS-REF does, in its draft 1.0.0-beta.1 of July 2026
//! (<https://github.com/modelica/fmi-ls-ref>), and experiments as MA-HS-Experiments does
//! (<https://github.com/modelica/ma-hs-experiments>). Each document is declared here once, with its writer and its reader.

mod experiments;
mod files;
mod manifest;
mod parameters;
mod series;
mod xml;

pub use experiments::{Agreement, Between, Experiment, Experiments, Stated, Table};
pub use files::Files;
pub use manifest::{Manifest, ROLES, Related, Role};
pub use parameters::{Given, ParameterSet, root, typed};
pub use series::{Series, rounded};
pub use xml::Element;

/// Name of the layered standard.
pub const NAME: &str = "org.fmi-standard.fmi-ls-ref";
/// The version that the draft's text wants in a manifest; its tag is 1.0.0-beta.1.
pub const VERSION: &str = "1.0.0-alpha.1";
/// The folder in the archive.
pub const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";
/// The manifest in it.
pub const MANIFEST: &str = "fmi-ls-manifest.xml";

/// MIME types of related files.
pub mod media {
    /// A parameter set of SSP (SSV).
    pub const PARAMETERS: &str = "application/x-ssp-parameter-set";
    /// Experiments.
    pub const EXPERIMENTS: &str = "application/x-ma-hs-experiments";
    /// Experiments, as FMI-LS-REF 1.0.0-alpha.1 called them.
    pub const EARLIER_EXPERIMENTS: &str = "application/x-ma-ls-experiments";
    /// A table.
    pub const TABLE: &str = "text/csv";
    /// JSON.
    pub const JSON: &str = "application/json";
    /// A page.
    pub const HTML: &str = "text/html";
    /// Plain text.
    pub const TEXT: &str = "text/plain";
}

/// Where a related file is in the archive, from its address and the file that gives it; none for an address that is not within
/// the archive.
pub fn resolved(base: &str, address: &str) -> Option<String> {
    let scheme = address.split_once(':').is_some_and(|(scheme, _)| !scheme.contains('/'));
    if scheme || address.starts_with('/') || address.is_empty() {
        return None;
    }
    let address = address.split(['?', '#']).next().unwrap_or_default();
    let mut path: Vec<String> = base.split('/').map(str::to_owned).collect();
    path.pop();
    for part in address.split('/') {
        match part {
            "" | "." => {}
            ".." => drop(path.pop()?),
            name => path.push(decoded(name)?),
        }
    }
    Some(path.join("/"))
}

/// Without percent signs in place of characters (RFC 3986).
fn decoded(text: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::new(), text.as_bytes());
    while let Some((first, after)) = rest.split_first() {
        rest = after;
        bytes.push(*first);
        if *first == b'%' {
            let digits = std::str::from_utf8(rest.get(..2)?).ok()?;
            *bytes.last_mut()? = u8::from_str_radix(digits, 16).ok()?;
            rest = &rest[2..];
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_relative_to_their_file_and_stay_in_the_archive() {
        let of = |address| resolved("extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml", address);
        assert_eq!(of("a/b%20c.csv").as_deref(), Some("extra/org.fmi-standard.fmi-ls-ref/a/b c.csv"));
        assert_eq!(of("../../documentation/index.html").as_deref(), Some("documentation/index.html"));
        for outside in ["../../../x", "https://example.com/x", "/etc/hostname", "", "%zz"] {
            assert_eq!(of(outside), None, "{outside}");
        }
    }
}
