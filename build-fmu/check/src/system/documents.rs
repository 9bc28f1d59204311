//! Files that the description of a system refers to: beside it, or within the FMU of a component.

use super::structure::{Content, Element};
use super::{System, at, file_of};
use crate::finding::Finding;
use crate::package::Package;
use crate::rules::Rule;

/// What a file is asked for, and by whom.
pub struct Wanted<'a> {
    /// The rule that it breaks if it is not there.
    pub rule: &'static Rule,
    /// What is in it: `values`.
    pub what: &'static str,
    /// Its URI.
    pub source: &'a str,
    /// The element that it is looked for in; none for a file beside the description.
    pub within: Option<&'a Element>,
    /// Line of who asks.
    pub line: u32,
}

impl System {
    /// Reads a file, and tells what is wrong with it by itself; also tells its name. None of a component that cannot be looked into, which is told elsewhere.
    pub(super) fn document<T>(
        &self,
        wanted: &Wanted,
        package: &mut Package,
        parse: impl Fn(&[u8], &str) -> Result<(T, Vec<Finding>), String>,
        findings: &mut Vec<Finding>,
    ) -> Result<Option<(T, String)>, Finding> {
        let Wanted { rule, what, source, within, line } = *wanted;
        let wrong = |message: String| Finding::error(rule, message).at(at(line));
        let Some(element) = within else {
            let file = file_of(source, package)
                .ok_or_else(|| wrong(format!("{what} are in `{source}`, which the archive does not have")))?;
            return parsed(package, &file, &file, parse, findings).map(Some).map_err(wrong);
        };
        let component = match &element.content {
            Content::Component { source, .. } => source,
            Content::System { .. } | Content::Dictionary(_) => {
                let message =
                    format!("{what} are looked for in a component, but {} is none", element.shown());
                return Err(wrong(message)
                    .help("leave sourceBase out, and give a path from the description's folder on"));
            }
        };
        let Some(fmu) = self.files.get(component) else { return Ok(None) };
        let Ok(Some(mut inner)) = package.inner(fmu) else { return Ok(None) };
        let file = file_of(source, &inner)
            .ok_or_else(|| wrong(format!("{what} are in `{source}` of `{fmu}`, which does not have it")))?;
        parsed(&mut inner, &file, &format!("{fmu}/{file}"), parse, findings).map(Some).map_err(wrong)
    }
}

fn parsed<T>(
    package: &mut Package,
    file: &str,
    shown: &str,
    parse: impl Fn(&[u8], &str) -> Result<(T, Vec<Finding>), String>,
    findings: &mut Vec<Finding>,
) -> Result<(T, String), String> {
    let bytes = package.read(file)?.unwrap_or_default();
    let (document, found) = parse(&bytes, shown).map_err(|why| format!("`{shown}` {why}"))?;
    findings.extend(found);
    Ok((document, shown.to_owned()))
}
