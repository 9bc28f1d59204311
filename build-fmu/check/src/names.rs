//! Names of variables.

/// Whether a name is a structured one, by the grammar of FMI 2.0.4, section 2.2.9.
pub fn is_structured(name: &str) -> bool {
    let inner = match name.strip_prefix("der(").and_then(|rest| rest.strip_suffix(')')) {
        Some(inner) => match inner.rsplit_once(',') {
            // der(x,2): the comma of an index lies within brackets.
            Some((front, order)) if !order.contains(']') => {
                if order.is_empty() || !order.bytes().all(|c| c.is_ascii_digit()) {
                    return false;
                }
                front
            }
            _ => inner,
        },
        None => name,
    };
    let mut rest = inner;
    loop {
        let Some(after) = part(rest) else { return false };
        match after.strip_prefix('.') {
            Some(next) => rest = next,
            None => return after.is_empty(),
        }
    }
}

/// What follows a name's part with its indices.
fn part(text: &str) -> Option<&str> {
    let after = if let Some(quoted) = text.strip_prefix('\'') {
        let mut escaped = false;
        let end = quoted.char_indices().find(|(_, c)| {
            let ends = *c == '\'' && !escaped;
            escaped = *c == '\\' && !escaped;
            ends
        })?;
        if end.0 == 0 {
            return None;
        }
        &quoted[end.0 + 1..]
    } else {
        let end = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len());
        if end == 0 || text.starts_with(|c: char| c.is_ascii_digit()) {
            return None;
        }
        &text[end..]
    };
    let Some(indices) = after.strip_prefix('[') else { return Some(after) };
    let (indices, after) = indices.split_once(']')?;
    let number = |index: &str| !index.is_empty() && index.bytes().all(|c| c.is_ascii_digit());
    indices.split(',').all(number).then_some(after)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structured_names_are_told_from_others() {
        for name in
            ["a", "_a1.b[2].c", "x[1,2]", "der(x)", "der(a.b[1,2])", "der(x,2)", "'any thing'.b", "'it\\'s'"]
        {
            assert!(is_structured(name), "{name}");
        }
        for name in ["", "1a", "a b", "a..b", "a[", "a[x]", "der(x", "der(x,y)", "a.", "ä", "''", "a-b"] {
            assert!(!is_structured(name), "{name}");
        }
    }
}
