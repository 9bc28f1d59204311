//! Tables with another column, alone or within an FMU.

use std::fs;
use std::path::Path;

use zip::{CompressionMethod, ZipArchive};

/// A table with another function of one of its columns.
pub fn with_column(text: &str, name: &str, change: impl Fn(&[f64]) -> Vec<f64>) -> String {
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let column = rows[0].iter().position(|title| title.starts_with(name)).expect(name);
    let values: Vec<f64> = rows[1..].iter().map(|row| row[column].parse().expect("a number")).collect();
    let changed = change(&values);
    let row = |(row, value): (&Vec<&str>, &f64)| {
        let value = value.to_string();
        let cells =
            row.iter().enumerate().map(|(index, cell)| if index == column { value.as_str() } else { *cell });
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    rows[0].join(",") + "\n" + &rows[1..].iter().zip(&changed).map(row).collect::<String>()
}

/// A table with a column times a factor.
pub fn scaled(text: &str, name: &str, factor: f64) -> String {
    with_column(text, name, |values| values.iter().map(|value| factor * value).collect())
}

/// The files of an FMU.
pub fn files(fmu: &Path) -> Vec<(String, Vec<u8>)> {
    let mut archive = ZipArchive::new(fs::File::open(fmu).expect("it is there")).expect("a zip archive");
    let count = archive.len();
    let file = |index| {
        let mut file = archive.by_index(index).expect("an entry");
        let mut contents = Vec::new();
        std::io::Read::read_to_end(&mut file, &mut contents).expect("readable");
        (file.name().expect("UTF-8").into_owned(), contents)
    };
    (0..count).map(file).collect()
}

/// Writes an FMU that has a column of one of its tables times a factor.
pub fn scaled_in(fmu: &Path, file: &str, column: &str, factor: f64, to: &Path) {
    let files = files(fmu);
    let changed = files.iter().map(|(name, contents)| {
        let text = || scaled(std::str::from_utf8(contents).expect("CSV"), column, factor).into_bytes();
        (name.as_str(), if name.ends_with(file) { text() } else { contents.clone() })
    });
    let changed: Vec<(&str, Vec<u8>)> = changed.collect();
    assert!(changed.iter().zip(&files).any(|(one, other)| one.1 != other.1), "{file}");
    let entries = changed.iter().map(|(name, bytes)| (*name, bytes.as_slice(), CompressionMethod::Deflated));
    fs::write(to, crate::subject::archive(entries)).expect("it is ours");
}
