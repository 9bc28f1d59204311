//! The columns of a file before it is known which of them is the time.

use super::{Channel, DataError, Record, units};
use serde::Deserialize;

/// Names that a column of time goes by, in lower case.
const TIME_NAMES: [&str; 7] = ["t", "time", "timestamp", "timestamps", "time_s", "zeit", "tout"];

/// Which column holds the time, for files that do not say so.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeColumn {
    /// The column's name in the file.
    pub column: String,
    /// Its unit instead of the file's; seconds if neither says.
    pub unit: Option<String>,
}

/// Whether a column of this name is the time.
pub(crate) fn is_time(name: &str) -> bool {
    TIME_NAMES.contains(&name.to_lowercase().as_str())
}

/// The columns of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Table {
    /// The file's name.
    pub name: String,
    /// All columns, of one length.
    pub columns: Vec<Channel>,
    /// The column that the format itself declares as time.
    pub master: Option<usize>,
}

impl Table {
    /// Takes the time out of the columns and turns it into seconds. Infinite samples become missing ones.
    pub(crate) fn into_record(mut self, wanted: Option<&TimeColumn>) -> Result<Record, DataError> {
        let index = self.time_index(wanted)?;
        let time = self.columns.remove(index);
        let unit = match wanted.and_then(|wanted| wanted.unit.clone()) {
            Some(unit) => unit,
            None if time.unit.trim().is_empty() => "s".to_owned(),
            None => time.unit.clone(),
        };
        let to_seconds = units::conversion(&unit, "s").map_err(|problem| {
            let remedy =
                "write s, ms, us or min in the header, or `time = { column = …, unit = … }` in the map";
            DataError::signal(&self.name, &time.name, format!("this is the time, but {problem}: {remedy}"))
        })?;
        for value in self.columns.iter_mut().flat_map(|column| &mut column.values) {
            if value.is_infinite() {
                *value = f64::NAN;
            }
        }
        if self.columns.is_empty() {
            return Err(DataError::file(&self.name, "there is a time, but no signal beside it"));
        }
        let seconds = time.values.iter().map(|&t| to_seconds.apply(t)).collect();
        Ok(Record { name: self.name, time: seconds, channels: self.columns })
    }

    fn time_index(&self, wanted: Option<&TimeColumn>) -> Result<usize, DataError> {
        if let Some(wanted) = wanted {
            return self.columns.iter().position(|column| column.is_called(&wanted.column)).ok_or_else(
                || {
                    let text = format!(
                        "the map takes the time from it, but there is no such column{}",
                        did_you_mean(&wanted.column, self.columns.iter().map(|column| column.name.as_str()))
                    );
                    DataError::signal(&self.name, &wanted.column, text)
                },
            );
        }
        let named = |column: &Channel| is_time(&column.name);
        // A first column without a known name is believed if its unit is one of time.
        let timed = |column: &Channel| units::conversion(&column.unit, "s").is_ok();
        self.master
            .or_else(|| self.columns.iter().position(named))
            .or_else(|| self.columns.first().filter(|column| timed(column)).map(|_| 0))
            .ok_or_else(|| {
                let names = listed(self.columns.iter().map(|c| c.name.as_str()));
                let text = format!(
                    "no column of time among {names}: call it `time [s]`, or name it in the map: \
                     `time = {{ column = \"…\", unit = \"s\" }}`"
                );
                DataError::file(&self.name, text)
            })
    }
}

/// Names that a message lists before it counts the rest.
const LISTED: usize = 12;

/// `: did you mean x?` if one of the names is near, and otherwise the names.
pub(crate) fn did_you_mean<'a>(wrong: &str, names: impl Iterator<Item = &'a str> + Clone) -> String {
    let near = |name: &str| strsim::jaro_winkler(&wrong.to_lowercase(), &name.to_lowercase());
    let best = names.clone().max_by(|a, b| near(a).total_cmp(&near(b)));
    match best {
        Some(best) if near(best) > 0.8 => format!(": did you mean `{best}`?"),
        Some(_) => format!(": there are {}", listed(names)),
        None => String::new(),
    }
}

/// Names as a list, which says how many it leaves out.
fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let all: Vec<&str> = names.collect();
    let shown = if all.len() > LISTED + 1 { LISTED } else { all.len() };
    let rest = match all.len() - shown {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{}{rest}", all[..shown].join(", "))
}
