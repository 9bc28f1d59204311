//! The columns of a file before it is known which of them is the time.

use super::reading::Reading;
use super::{Channel, DataError, LISTED, Record, Unread, timestamp, units};

/// Names that a column of time goes by, in lower case.
const TIME_NAMES: [&str; 11] = [
    "t",
    "time",
    "timestamp",
    "timestamps",
    "elapsed time",
    "elapsed",
    "date/time",
    "datetime",
    "date time",
    "zeit",
    "tout",
];

/// Whether a column of this name is the time.
pub fn is_time(name: &str) -> bool {
    let name = units::split_suffix(name, "s").map_or(name, |(name, _)| name);
    TIME_NAMES.contains(&name.to_lowercase().as_str())
}

/// The columns of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Table {
    /// The file's name.
    pub name: String,
    /// All columns, of one length.
    pub columns: Vec<Channel>,
    /// The column that the format itself declares as time.
    pub master: Option<usize>,
    /// Contents of the file that are not used, with the reason.
    pub unread: Vec<Unread>,
    /// What else there is to say about how the file was read.
    pub notes: Vec<String>,
}

impl Table {
    /// Takes the time out of the columns and turns it into seconds. Infinite samples become missing ones.
    pub(crate) fn into_record(mut self, reading: &Reading) -> Result<Record, DataError> {
        for value in self.columns.iter_mut().flat_map(|column| &mut column.values) {
            if value.is_infinite() {
                *value = f64::NAN;
            }
        }
        let (time, seconds_assumed) = match reading.rate {
            Some(rate) => (self.even(rate, reading)?, false),
            None => self.seconds(reading)?,
        };
        if self.columns.is_empty() {
            return Err(DataError::file(&self.name, "there is a time, but no signal beside it"));
        }
        let Self { name, columns: channels, unread, notes, .. } = self;
        Ok(Record { name, time, channels, unread, notes, seconds_assumed })
    }

    /// Times of an even rate. A column of time that the file has nevertheless is left out.
    fn even(&mut self, rate: f64, reading: &Reading) -> Result<Vec<f64>, DataError> {
        if !(rate.is_finite() && rate > 0.0) {
            return Err(DataError::Map(format!(
                "`rate` is {rate}: give the samples per second, such as 1000.0"
            )));
        }
        if let Some(time) = &reading.time {
            let text =
                format!("`rate` and the column of time `{}` exclude each other: leave one out", time.column);
            return Err(DataError::Map(text));
        }
        if let Ok(index) = self.time_index(None) {
            let Channel { name, unit, .. } = self.columns.remove(index);
            self.unread.push(Unread { name, unit, why: "the rate that was given takes its place".into() });
        }
        let count = self.columns.first().map_or(0, |column| column.values.len());
        Ok((0..count).map(|sample| sample as f64 / rate).collect())
    }

    /// The column of time in seconds, and whether no one says that it is in seconds.
    fn seconds(&mut self, reading: &Reading) -> Result<(Vec<f64>, bool), DataError> {
        let wanted = reading.time.as_ref();
        let index = self.time_index(wanted.map(|it| it.column.as_str()))?;
        let time = self.columns.remove(index);
        let suffix = units::split_suffix(&time.name, "s").map(|(_, unit)| unit);
        let own = Some(time.unit.trim()).filter(|unit| !unit.is_empty()).or(suffix);
        let stated = wanted.and_then(|wanted| wanted.unit.as_deref()).or(own);
        let to_seconds = units::conversion(stated.unwrap_or("s"), "s").map_err(|problem| {
            let remedy =
                "write s, ms, us or min in the header, or `time = { column = …, unit = … }` in the map";
            DataError::signal(&self.name, &time.name, format!("this is the time, but {problem}: {remedy}"))
        })?;
        Ok((time.values.iter().map(|&t| to_seconds.apply(t)).collect(), stated.is_none()))
    }

    fn time_index(&self, wanted: Option<&str>) -> Result<usize, DataError> {
        if let Some(wanted) = wanted {
            if let Some(index) = self.columns.iter().position(|column| column.is_called(wanted)) {
                return Ok(index);
            }
            if let Some(unread) = self.unread.iter().find(|it| it.is_called(wanted)) {
                return Err(self.no_time(unread));
            }
            let text = format!(
                "the map takes the time from it, but there is no such column{}",
                did_you_mean(wanted, self.columns.iter().map(|column| column.name.as_str()))
            );
            return Err(DataError::signal(&self.name, wanted, text));
        }
        let named = |column: &Channel| is_time(&column.name);
        // A first column without a known name is believed if its unit is one of time.
        let timed = |column: &Channel| units::conversion(&column.unit, "s").is_ok();
        let found = self
            .master
            .or_else(|| self.columns.iter().position(named))
            .or_else(|| self.columns.first().filter(|column| timed(column)).map(|_| 0));
        found.ok_or_else(|| match self.unread.iter().find(|it| is_time(&it.name)) {
            Some(unread) => self.no_time(unread),
            None => {
                let names = listed(self.columns.iter().map(|c| c.name.as_str()));
                let text = format!(
                    "no column of time among {names}: call it `time [s]`, or name it in the map: \
                     `time = {{ column = \"…\", unit = \"s\" }}`; without one, give the samples per second: \
                     `rate = 1000.0` in the map, or --sampling-rate"
                );
                DataError::file(&self.name, text)
            }
        })
    }

    /// That the column of time holds none.
    fn no_time(&self, unread: &Unread) -> DataError {
        let text = format!("this is the time, but {}; {}", unread.why, timestamp::FORMS);
        DataError::signal(&self.name, &unread.name, text)
    }
}

/// `: did you mean x?` if one of the names is near, and otherwise the names.
pub fn did_you_mean<'a>(wrong: &str, names: impl Iterator<Item = &'a str> + Clone) -> String {
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
