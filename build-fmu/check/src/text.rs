//! Encodings of XML files: what the standards demand, and what can be read all the same.

use crate::finding::Finding;
use crate::rules::{Rule, fmi, practice, ssp};

/// Whose file it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standard {
    /// FMI 2.0: its first line names the encoding.
    Fmi,
    /// SSP 1.0: it is XML 1.0.
    Ssp,
}

/// The text of a file, with findings on its encoding.
pub fn decoded(bytes: &[u8], standard: Standard, file: &str) -> (String, Vec<Finding>) {
    let mut findings = Vec::new();
    let (encoding, version) = match standard {
        Standard::Fmi => (fmi::ENCODING, practice::XML_VERSION),
        Standard::Ssp => (ssp::ENCODING, ssp::ENCODING),
    };
    let mut wrong = |rule: &'static Rule, message: String, help: &str| {
        findings.push(Finding::error(rule, message).at(file).help(help));
    };
    let save = "save it in UTF-8, and write <?xml version=\"1.0\" encoding=\"UTF-8\"?> into the first line";
    let units = |order: fn([u8; 2]) -> u16| -> String {
        let pairs = bytes[2..].chunks_exact(2).map(|pair| order([pair[0], pair[1]]));
        char::decode_utf16(pairs).map(|it| it.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
    };
    let text = match bytes {
        [0xff, 0xfe, ..] => {
            wrong(encoding, format!("{file} is encoded in UTF-16"), save);
            return (units(u16::from_le_bytes), findings);
        }
        [0xfe, 0xff, ..] => {
            wrong(encoding, format!("{file} is encoded in UTF-16"), save);
            return (units(u16::from_be_bytes), findings);
        }
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(error) => {
                let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
                wrong(encoding, format!("{file} is not encoded in UTF-8: line {line}"), save);
                // Each byte is a character in the encodings that are found instead.
                bytes.iter().copied().map(char::from).collect()
            }
        },
    };
    let plain = text.trim_start_matches('\u{feff}');
    let head = plain.strip_prefix("<?xml").and_then(|rest| Some(rest.split_once("?>")?.0));
    match head.and_then(|head| attribute(head, "encoding")) {
        Some(name) if !name.eq_ignore_ascii_case("utf-8") => {
            wrong(encoding, format!("{file} says that it is encoded in {name}"), save);
        }
        None if standard == Standard::Fmi => {
            wrong(fmi::ENCODING_NAMED, format!("the first line of {file} does not name the encoding"), save);
        }
        _ => {}
    }
    if let Some(other) = head.and_then(|head| attribute(head, "version")).filter(|it| *it != "1.0") {
        let message = format!("{file} is XML {other}");
        let finding = match standard {
            Standard::Fmi => Finding::warning(version, message),
            Standard::Ssp => Finding::error(version, message),
        };
        findings.push(finding.at(file).help("few readers know another version than 1.0"));
    }
    if plain.len() < text.len() {
        let message = format!("{file} begins with a mark of the byte order");
        let help = "some readers of XML stop there; save it in UTF-8 without a mark (BOM)";
        findings.push(Finding::warning(practice::MARK, message).at(file).help(help));
    }
    (plain.to_owned(), findings)
}

/// The value of an attribute in the first line.
fn attribute<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    let value = head.split_once(name)?.1.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|quote| matches!(quote, '"' | '\''))?;
    value[1..].split(quote).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules(bytes: &[u8], standard: Standard) -> Vec<&'static str> {
        decoded(bytes, standard, "x.xml").1.iter().map(|finding| finding.rule.name).collect()
    }

    #[test]
    fn encodings_are_told_apart() {
        let fine = "<?xml version=\"1.0\" encoding='utf-8'?><ä/>";
        assert_eq!(rules(fine.as_bytes(), Standard::Fmi), Vec::<&str>::new());
        let none = b"<?xml version=\"1.0\"?><a/>";
        assert_eq!(rules(none, Standard::Fmi), ["description.encoding.named"]);
        assert_eq!(rules(none, Standard::Ssp), Vec::<&str>::new());
        let latin = b"<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><a b=\"\xe4\"/>";
        assert_eq!(rules(latin, Standard::Fmi), ["description.encoding", "description.encoding"]);
        assert!(decoded(latin, Standard::Fmi, "x").0.contains('ä'));
        let wide: Vec<u8> = "\u{feff}<a/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(rules(&wide, Standard::Fmi), ["description.encoding"]);
        assert_eq!(decoded(&wide, Standard::Fmi, "x").0, "<a/>");
        let marked = format!("\u{feff}{fine}");
        assert_eq!(rules(marked.as_bytes(), Standard::Ssp), ["description.encoding.mark"]);
        let newer = b"<?xml version=\"1.1\" encoding=\"UTF-8\"?><a/>";
        assert_eq!(rules(newer, Standard::Fmi), ["description.encoding.version"]);
    }
}
