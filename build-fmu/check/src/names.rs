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

/// An element of an array: the array's name, and the element's indices.
pub fn place_in_array(name: &str) -> Option<(String, Vec<u32>)> {
    let (front, rest) = name.rsplit_once('[')?;
    let (indices, back) = rest.split_once(']')?;
    let indices: Option<Vec<u32>> = indices.split(',').map(|index| index.trim().parse().ok()).collect();
    // What stands behind the indices is a part of a record, of which each element has one.
    Some((format!("{front}[]{back}"), indices.filter(|_| back.is_empty() || back == ")")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_of_arrays_have_their_place() {
        assert_eq!(place_in_array("a.b[1,2]"), Some(("a.b[]".into(), vec![1, 2])));
        assert_eq!(place_in_array("der(x[3])"), Some(("der(x[])".into(), vec![3])));
        assert_eq!(
            (place_in_array("x[1].y"), place_in_array("x"), place_in_array("x[i]")),
            (None, None, None)
        );
    }

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
