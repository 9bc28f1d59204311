//! Where a resource URI points to.

use std::path::PathBuf;

/// The path that a `fmuResourceLocation` names.
///
/// Hosts write it in many ways; whatever can only mean one thing is understood: `file:/`, `file:///`,
/// `file://localhost/`, percent-encoded or not, with a drive letter, or a plain path.
///
/// # Errors
/// A sentence that says what cannot be understood and what would be right.
pub fn to_path(uri: &str) -> Result<PathBuf, String> {
    let path = match scheme(uri) {
        None => uri.to_owned(),
        Some(scheme) if scheme.eq_ignore_ascii_case("file") => local_path(&uri[scheme.len() + 1..], uri)?,
        Some(scheme) => {
            return Err(format!(
                "the resource location {uri:?} is of the scheme {scheme:?}, which cannot be read: \
                 unpack the FMU and give the folder as file:///..."
            ));
        }
    };
    if path.contains('\0') {
        return Err(format!("the resource location {uri:?} contains a zero byte, which no path does"));
    }
    Ok(PathBuf::from(path))
}

/// The scheme, if there is one; a single letter is a drive.
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let legal = scheme.len() > 1
        && scheme.starts_with(|c: char| c.is_ascii_alphabetic())
        && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    legal.then_some(scheme)
}

/// The path in what follows `file:`.
fn local_path(rest: &str, uri: &str) -> Result<String, String> {
    let encoded = match rest.strip_prefix("//") {
        None => rest,
        // `file://C:/...` lacks a slash, but cannot mean anything else.
        Some(after) if starts_with_drive(after) => after,
        Some(after) => {
            let (host, path) = after.split_at(after.find('/').unwrap_or(after.len()));
            if !host.is_empty() && !host.eq_ignore_ascii_case("localhost") {
                return Err(format!(
                    "the resource location {uri:?} is on the host {host:?}: only local folders can be read, \
                     file:///... with three slashes"
                ));
            }
            path
        }
    };
    let path = decode(encoded).ok_or_else(|| {
        format!("the resource location {uri:?} is not UTF-8 once %xx is decoded: encode it as UTF-8")
    })?;
    match path.strip_prefix('/') {
        Some(drive) if starts_with_drive(drive) => Ok(drive.to_owned()),
        Some(_) => Ok(path),
        None if starts_with_drive(&path) => Ok(path),
        None => Err(format!("the resource location {uri:?} has no absolute path: write file:///...")),
    }
}

fn starts_with_drive(path: &str) -> bool {
    matches!(path.as_bytes(), [letter, b':', b'/' | b'\\', ..] if letter.is_ascii_alphabetic())
}

/// Replaces `%xx`; a `%` that begins no such thing is one.
fn decode(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        let escaped = match (first, tail) {
            (b'%', [high, low, ..]) => hex(*high).zip(hex(*low)).map(|(high, low)| high * 16 + low),
            _ => None,
        };
        bytes.push(escaped.unwrap_or(*first));
        rest = if escaped.is_some() { &tail[2..] } else { tail };
    }
    String::from_utf8(bytes).ok()
}

fn hex(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).and_then(|digit| u8::try_from(digit).ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_ways_in_which_hosts_write_it() {
        for (uri, path) in [
            ("file:/tmp/fmu/resources", "/tmp/fmu/resources"),
            ("file:///tmp/fmu/resources", "/tmp/fmu/resources"),
            ("FILE:///tmp/fmu/resources/", "/tmp/fmu/resources/"),
            ("file://localhost/tmp/resources", "/tmp/resources"),
            ("file:////tmp/resources", "//tmp/resources"),
            ("file:///tmp/my%20car/r%C3%A4der", "/tmp/my car/räder"),
            ("file:///tmp/my car/räder", "/tmp/my car/räder"),
            ("file:///tmp/100%/%zz/%4", "/tmp/100%/%zz/%4"),
            ("file:///C:/Users/me/resources", "C:/Users/me/resources"),
            ("file:///C%3A/Users/me", "C:/Users/me"),
            ("file:/C:/Users/me", "C:/Users/me"),
            ("file://C:/Users/me", "C:/Users/me"),
            ("file:C:\\Users\\me", "C:\\Users\\me"),
            ("C:\\Users\\me", "C:\\Users\\me"),
            ("/tmp/a%20b", "/tmp/a%20b"),
            ("resources", "resources"),
        ] {
            assert_eq!(to_path(uri), Ok(PathBuf::from(path)), "{uri}");
        }
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        for (uri, part) in [
            ("http://example.org/resources", "scheme \"http\""),
            ("fmi2://resources", "scheme \"fmi2\""),
            ("file://server/share", "host \"server\""),
            ("file:resources", "no absolute path"),
            ("file:///%ff", "not UTF-8"),
            ("file:///a%00b", "zero byte"),
        ] {
            let error = to_path(uri).unwrap_err();
            assert!(error.contains(part) && error.contains(uri), "{error}");
        }
    }

    fn encode(path: &str) -> String {
        let keep = |byte: u8| byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte);
        path.bytes()
            .map(|byte| if keep(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
            .collect()
    }

    proptest! {
        #[test]
        fn every_encoded_path_comes_back(path in "/[^\u{0}/:][^\u{0}]{0,30}") {
            prop_assume!(!starts_with_drive(&path[1..]));
            for start in ["file:", "file://", "file://localhost"] {
                prop_assert_eq!(to_path(&format!("{start}{}", encode(&path))), Ok(PathBuf::from(&path)));
            }
        }

        #[test]
        fn no_text_makes_it_panic(uri in ".{0,40}", rest in "file:.{0,20}") {
            let _ = (to_path(&uri), to_path(&rest));
        }
    }
}
