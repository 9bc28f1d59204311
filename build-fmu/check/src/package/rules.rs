//! Rules for the archive itself.

use std::collections::HashMap;

use super::Package;
use super::directory::Entry;
use crate::finding::{Finding, names};
use crate::rules::{Rule, fmi, practice, ssp};
use crate::text::Standard;

/// Deflated, by its number.
const DEFLATE: u16 = 8;
/// Stored as it is.
const STORE: u16 = 0;

/// A rule, what breaks it, what is said and what is to be done.
type Wrong<'a> = (&'static Rule, &'a dyn Fn(&Entry) -> bool, &'a str, &'a str);

impl Package {
    /// What is wrong with the archive itself.
    pub fn findings(&self, standard: Standard, file: &std::path::Path) -> Vec<Finding> {
        let mut findings = self.entries_findings(standard);
        findings.extend(self.twice());
        findings.extend(self.places(standard));
        let (rule, wanted) = match standard {
            Standard::Fmi => (fmi::ENDING, "fmu"),
            Standard::Ssp => (ssp::ENDING, "ssp"),
        };
        if file.extension().is_none_or(|ending| ending != wanted) {
            let message = format!("the name of the file does not end in .{wanted}");
            findings.push(Finding::error(rule, message));
        }
        findings
    }

    fn entries_findings(&self, standard: Standard) -> Vec<Finding> {
        let is_fmi = standard == Standard::Fmi;
        let either = |fmi: &'static Rule, ssp: &'static Rule| if is_fmi { fmi } else { ssp };
        let not_ascii = |entry: &Entry| !entry.name.is_ascii();
        let of = |entry: &Entry, wrong: &dyn Fn(&str) -> bool| wrong(&entry.shown());
        let outside = |name: &str| {
            let absolute = name.starts_with('/') || name.chars().nth(1) == Some(':');
            absolute || name.split(['/', '\\']).any(|part| part == "..")
        };
        let errors: [Wrong; 8] = [
            (
                either(fmi::SEPARATOR, ssp::SEPARATOR),
                &|entry| entry.name.contains(&b'\\'),
                "paths in the archive are separated by backslashes",
                "a zip archive has `/` in its paths, on Windows too",
            ),
            (
                practice::OUTSIDE,
                &|entry| of(entry, &outside),
                "paths lead out of the archive",
                "name files relative to the archive's root, without `..`",
            ),
            (
                either(fmi::COMPRESSION, ssp::COMPRESSION),
                &|entry| entry.method != STORE && entry.method != DEFLATE,
                "files are compressed in another way than `deflate`",
                "FMI and SSP want `deflate`, the one that every tool can read",
            ),
            (
                either(fmi::ENCRYPTION, ssp::ENCRYPTION),
                &Entry::is_encrypted,
                "files are encrypted",
                "no importer asks for a password",
            ),
            (
                either(fmi::ZIP_VERSION, ssp::ZIP_VERSION),
                &|entry| {
                    entry.needed > 20
                        && !entry.is_encrypted()
                        && (entry.method == STORE || entry.method == DEFLATE)
                },
                "files need a newer version of the zip format than 2.0",
                "write them without Zip64, as is possible below 4 GB",
            ),
            (
                fmi::DESCRIPTOR,
                &|entry| {
                    is_fmi && entry.has_descriptor() && entry.method == STORE && !entry.name.ends_with(b"/")
                },
                "stored files have their sizes after their data",
                "deflate them, or write the sizes first: who reads from the front finds no end",
            ),
            (
                fmi::LINKS,
                &|entry| is_fmi && entry.is_link(),
                "there are links in the archive",
                "put the file itself there",
            ),
            (
                if is_fmi { practice::FILE_NAMES } else { ssp::NAMES_ENCODING },
                &|entry| not_ascii(entry) && !entry.is_utf8(),
                "names beyond ASCII are not flagged as UTF-8",
                "they have other letters on other machines",
            ),
        ];
        let mut findings = Vec::new();
        for (rule, is_wrong, message, help) in errors {
            let wrong: Vec<String> =
                self.entries.iter().filter(|entry| is_wrong(entry)).map(Entry::shown).collect();
            if !wrong.is_empty() {
                let message = format!("{message}: {}", names(&wrong));
                // What is only recommended, or what no rule demands but unpackers stumble over.
                let names_only = rule == practice::FILE_NAMES || rule == ssp::NAMES_ENCODING;
                let finding =
                    if names_only { Finding::warning(rule, message) } else { Finding::error(rule, message) };
                findings.push(finding.help(help));
            }
        }
        findings
    }

    fn twice(&self) -> Vec<Finding> {
        let mut findings = Vec::new();
        let mut seen: HashMap<String, String> = HashMap::new();
        for name in self.entries.iter().map(Entry::shown) {
            match seen.insert(name.to_lowercase(), name.clone()) {
                Some(other) if other == name => {
                    let message = format!("`{name}` is in the archive twice");
                    let help = "which of the two is unpacked depends on the tool";
                    findings.push(Finding::error(practice::ENTRY_TWICE, message).help(help));
                }
                Some(other) => {
                    let message = format!("`{name}` and `{other}` differ only in upper and lower case");
                    let help = "on Windows, one is written over the other";
                    findings.push(Finding::warning(practice::ENTRY_TWICE, message).help(help));
                }
                None => {}
            }
        }
        findings
    }

    /// Which folders there may be.
    fn places(&self, standard: Standard) -> Vec<Finding> {
        let mut findings = Vec::new();
        if standard == Standard::Fmi {
            // A domain has two parts at least.
            let plain = |name: &&str| {
                let rest = name.strip_prefix("extra/").filter(|rest| !rest.is_empty());
                rest.is_some_and(|rest| {
                    !rest.split('/').next().is_some_and(|it| it.contains('.')) || !rest.contains('/')
                })
            };
            let wrong: Vec<&str> = self.files().filter(plain).collect();
            if !wrong.is_empty() {
                let message = format!("files in extra/ are in no folder of a domain: {}", names(&wrong));
                let help =
                    "put them into a folder whose name is a domain of yours, reversed: extra/com.example";
                findings.push(Finding::warning(fmi::EXTRA, message).help(help));
            }
            return findings;
        }
        let known = ["resources/", "extra/", "documentation/"];
        let other = |name: &&str| {
            let description = !name.contains('/') && name.ends_with(".ssd");
            !description && !known.iter().any(|prefix| name.starts_with(prefix))
        };
        let others: Vec<&str> = self.files().filter(other).collect();
        if !others.is_empty() {
            let message = format!("files are at places that SSP reserves: {}", names(&others));
            findings.push(Finding::warning(ssp::PREFIX, message).help("put them into resources/"));
        }
        let documented = self.files().any(|name| name.starts_with("documentation/"));
        if documented && !self.files().any(|name| name == "documentation/index.html") {
            let message = "there is a documentation, but no documentation/index.html";
            findings.push(Finding::error(ssp::DOCUMENTATION, message));
        }
        findings
    }
}
