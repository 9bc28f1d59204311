//! Values of attributes, by their types.

use super::Type;

impl Type {
    /// What is expected, if the text is no value of the type.
    pub fn wrong(self, text: &str) -> Option<String> {
        let trimmed = text.trim();
        let fine = match self {
            Self::Text | Self::Uri | Self::Line => true,
            Self::Named => !text.is_empty(),
            Self::Id => name_without_colon(trimmed),
            Self::Double => double(trimmed).is_some(),
            Self::Int => integer(trimmed).is_some_and(|it| i32::try_from(it).is_ok()),
            Self::UnsignedInt => integer(trimmed).is_some_and(|it| u32::try_from(it).is_ok()),
            Self::Boolean => matches!(trimmed, "true" | "false" | "0" | "1"),
            Self::DateTime => date_time(trimmed),
            Self::Hex => {
                trimmed.len().is_multiple_of(2) && trimmed.bytes().all(|byte| byte.is_ascii_hexdigit())
            }
            Self::OneOf(known) => known.contains(&text),
            Self::Doubles => trimmed.split_whitespace().all(|item| double(item).is_some()),
            Self::UnsignedInts => trimmed
                .split_whitespace()
                .all(|item| integer(item).is_some_and(|it| u32::try_from(it).is_ok())),
            Self::ListOf(known) => trimmed.split_whitespace().all(|item| known.contains(&item)),
        };
        (!fine).then(|| match self {
            Self::Text | Self::Uri | Self::Line => unreachable!("any text is one"),
            Self::Named => "a text of one character at least".into(),
            Self::Id => "a name: a letter or `_`, then letters, digits, `.`, `-` or `_`".into(),
            Self::Double => "a number".into(),
            Self::Int => "a whole number of 32 bits".into(),
            Self::UnsignedInt => "a whole number from 0 to 4294967295".into(),
            Self::Boolean => "true, false, 0 or 1".into(),
            Self::DateTime => "a time like 2026-11-26T08:00:00Z".into(),
            Self::Hex => "bytes in hexadecimal digits".into(),
            Self::OneOf(known) => known.join(", "),
            Self::Doubles => "numbers".into(),
            Self::UnsignedInts => "whole numbers from 0 to 4294967295".into(),
            Self::ListOf(known) => format!("a list of {}", known.join(", ")),
        })
    }

    /// Whether the text is a number that is none, which XML Schema knows and FMI forbids.
    pub fn is_special(self, text: &str) -> bool {
        matches!(self, Self::Double) && double(text.trim()).is_some_and(|value| !value.is_finite())
    }
}

/// `xs:double`: decimal digits with an exponent, or INF, -INF, NaN; Rust reads more.
fn double(text: &str) -> Option<f64> {
    match text {
        "INF" => Some(f64::INFINITY),
        "-INF" => Some(f64::NEG_INFINITY),
        "NaN" => Some(f64::NAN),
        _ => {
            let plain = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
            text.bytes().all(plain).then(|| text.parse().ok())?
        }
    }
}

/// `xs:NCName`.
fn name_without_colon(text: &str) -> bool {
    let letter = |it: char| it.is_alphabetic() || it == '_';
    text.starts_with(letter) && text.chars().all(|it| letter(it) || it.is_numeric() || ".-".contains(it))
}

/// An integer with or without a sign.
fn integer(text: &str) -> Option<i64> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    (!digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())).then(|| text.parse().ok())?
}

/// `xs:dateTime`: date, `T`, time with or without fractions, and perhaps a zone.
fn date_time(text: &str) -> bool {
    let Some((date, time)) = text.split_once('T') else { return false };
    let numbers = |text: &str, separator: char, widths: [usize; 3]| -> Option<[u32; 3]> {
        let mut parts = text.split(separator);
        let mut read = [0; 3];
        for (width, number) in widths.iter().zip(&mut read) {
            let part = parts.next()?;
            let digits = part.split('.').next()?;
            let fine = digits.len() == *width && part.bytes().all(|it| it.is_ascii_digit() || it == b'.');
            *number = fine.then(|| digits.parse().ok())??;
        }
        parts.next().is_none().then_some(read)
    };
    let zone = time.find(['Z', '+', '-']).unwrap_or(time.len());
    let (time, zone) = time.split_at(zone);
    let zoned = zone.is_empty()
        || zone == "Z"
        || (zone.len() == 6
            && zone.as_bytes()[3] == b':'
            && zone[1..3].parse::<u8>().is_ok_and(|it| it <= 14));
    let dated = numbers(date, '-', [4, 2, 2])
        .is_some_and(|[_, month, day]| (1..=12).contains(&month) && (1..=31).contains(&day));
    let timed = numbers(time, ':', [2, 2, 2])
        .is_some_and(|[hour, minute, second]| hour < 25 && minute < 60 && second < 60);
    dated && timed && zoned
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_as_xml_schema_has_it() {
        for (of, fine, wrong) in [
            (
                Type::Double,
                &["1", "-1.5e-3", "+.5", "INF", "NaN", " 1 "][..],
                &["", "half", "inf", "1,5"][..],
            ),
            (Type::Int, &["1", "-2147483648", "+3"], &["2147483648", "1.0", ""]),
            (Type::UnsignedInt, &["0", "4294967295"], &["-1", "4294967296"]),
            (Type::Boolean, &["true", "0"], &["True", "yes"]),
            (
                Type::DateTime,
                &["2026-11-26T08:00:00Z", "2026-11-26T08:00:00", "2026-11-26T08:00:00.25+01:00"],
                &["2026-11-26", "2026-13-26T08:00:00Z", "Thu Nov 26", "2026-11-26T8:00:00Z"],
            ),
            (Type::Id, &["a", "_1.b-c", "ä"], &["", "1a", "a:b", "a b"]),
            (Type::Hex, &["", "00ff"], &["0", "xy"]),
            (Type::UnsignedInts, &["", "1 2 3"], &["1,2", "a"]),
        ] {
            fine.iter().for_each(|text| assert_eq!(of.wrong(text), None, "{text}"));
            wrong.iter().for_each(|text| assert!(of.wrong(text).is_some(), "{text}"));
        }
    }
}
