//! The findings of a diagnosis on such cars, as a page.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value as Json;

use super::{Car, Hidden, write};

/// A row of the page: cause and size as hidden and as found, verdict and time. A car that has a report is not
/// diagnosed again.
///
/// # Errors
/// If the program cannot be run or leaves no report.
pub fn judged(program: &Path, seed: u64, hidden: Option<&Hidden>, below: &Path) -> Result<String, String> {
    let name = hidden.map_or_else(|| format!("{seed} none"), |it| format!("{seed} {}", it.named()));
    let folder = below.join(name.replace(' ', "-"));
    let file = |name: &str| folder.join(name);
    let car = Car::real(seed, hidden);
    let mut said = String::new();
    if !file("report/report.json").exists() {
        write(&car, seed, &folder)?;
        let [train, test] = [file("train.csv"), file("test.csv")];
        let output = Command::new(program)
            .args(["--parameters".as_ref(), file("start.toml").as_os_str()])
            .args(["--train".as_ref(), train.as_os_str(), "--test".as_ref(), test.as_os_str()])
            .args(["--out".as_ref(), file("report").as_os_str(), "--no-fmu".as_ref()])
            .output()
            .map_err(|error| format!("{} cannot be run: {error}", program.display()))?;
        said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    }
    let text = fs::read_to_string(file("report/report.json"))
        .map_err(|error| format!("{name}: {error}; it said: {said}"))?;
    let report: Json = serde_json::from_str(&text).map_err(|error| format!("{name}: {error}"))?;
    let effects = report["effects"].as_array().map_or(&[][..], Vec::as_slice);
    let text = |value: &Json| value.as_str().unwrap_or_default().to_owned();
    let found: Vec<String> =
        effects.iter().map(|it| format!("{} {}", text(&it["id"]), text(&it["element"]))).collect();
    let expected: Vec<String> = hidden.iter().map(|it| it.named()).collect();
    let right = if found == expected { "yes" } else { "no" };
    let shown = |list: &[String]| if list.is_empty() { "nothing".to_owned() } else { list.join(", ") };
    let number = |size: Option<f64>| match size {
        Some(size) if size.abs() >= 1e4 => format!("{size:.3e}"),
        Some(size) => format!("{size:.4}"),
        None => String::new(),
    };
    Ok(format!(
        "| {seed} | {} | {} | {} | {} | {right} | {} | {:.0} |\n",
        shown(&expected),
        number(hidden.map(|it| car.amount(it.law))),
        shown(&found),
        number(effects.first().and_then(|it| it["parameters"][0]["value"].as_f64())),
        text(&report["verdict"]),
        report["seconds"].as_f64().unwrap_or_default()
    ))
}

/// The page of some rows.
pub fn page(program: &str, seeds: u64, rows: &[String]) -> String {
    let right = rows.iter().filter(|row| is_right(row)).count();
    format!(
        "# A car on four wheels\n\n{right} of {} cars right, by `blind four-wheels --program {program} --seeds {seeds}`. Sizes are those of an \
         effect's first parameter: N, a share, N/m³ or N/m².\n\n\
         | seed | hidden | size | found | size | right | verdict | seconds |\n|---|---|---|---|---|---|---|---|\n{}",
        rows.len(),
        rows.concat()
    )
}

fn is_right(row: &str) -> bool {
    row.contains("| yes |")
}

/// Seed and cause of rows that are wrong and are right on an earlier page.
pub fn worse(rows: &[String], page: &str) -> Vec<String> {
    let key = |row: &str| row.split('|').skip(1).take(2).map(str::trim).collect::<Vec<_>>().join(" ");
    let was_right = |row: &str| page.lines().any(|it| is_right(it) && key(it) == key(row));
    rows.iter().filter(|row| !is_right(row) && was_right(row)).map(|row| key(row)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_become_wrong_is_told_from_what_was_wrong() {
        let row = |seed: u64, right: &str| {
            format!("| {seed} | 01 strut.front_left | 1 | x | 1 | {right} | identified | 9 |\n")
        };
        let page = page("diagnose", 2, &[row(1, "yes"), row(2, "no")]);
        assert!(page.contains("1 of 2 cars right"), "{page}");
        assert_eq!(worse(&[row(1, "no"), row(2, "no"), row(3, "no")], &page), ["1 01 strut.front_left"]);
    }
}
