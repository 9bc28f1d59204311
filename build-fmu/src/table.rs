//! The table of what was built.

use unicode_width::UnicodeWidthStr;

/// Aligned columns with a head; the columns named `right` are aligned to the right.
pub fn aligned(head: &[&str], right: &[usize], rows: &[Vec<String>]) -> String {
    let widths: Vec<usize> = (0..head.len())
        .map(|column| {
            rows.iter().map(|row| row[column].width()).chain([head[column].width()]).max().unwrap_or(0)
        })
        .collect();
    let mut text = String::new();
    let head: Vec<String> = head.iter().map(|cell| (*cell).to_owned()).collect();
    for row in std::iter::once(&head).chain(rows) {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            let space = " ".repeat(widths[column] - cell.width());
            if column > 0 {
                line.push_str("  ");
            }
            if right.contains(&column) {
                line.push_str(&space);
                line.push_str(cell);
            } else {
                line.push_str(cell);
                line.push_str(&space);
            }
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// A size in bytes, in units of 1000.
pub fn size(bytes: usize) -> String {
    match bytes {
        0..1_000 => format!("{bytes} B"),
        1_000..1_000_000 => format!("{} kB", bytes.div_ceil(1_000)),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let rows = [
            vec!["Road".into(), "0 → 2".into(), "9 kB".into()],
            vec!["Ü".into(), "1 → 12".into(), "120 kB".into()],
        ];
        let table = aligned(&["NAME", "PORTS", "SIZE"], &[2], &rows);
        assert_eq!(table, "NAME  PORTS     SIZE\nRoad  0 → 2     9 kB\nÜ     1 → 12  120 kB\n");
    }

    #[test]
    fn sizes_are_short() {
        assert_eq!([999, 1_001, 654_321, 1_250_000].map(size), ["999 B", "2 kB", "655 kB", "1.2 MB"]);
    }
}
