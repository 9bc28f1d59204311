//! From a file's columns to the model's signals: names, units, signs, delays.
//!
//! ```toml
//! time = { column = "Timestamp", unit = "ms" }     # or its name alone; of files without one: rate = 1000.0, in Hz
//! skip_rows = 12                                   # lines above the names, where they are not found
//! sheet = "Run 3"                                  # of a spreadsheet
//!
//! [signals]
//! deflection = { column = "Weg_FL", unit = "mm", scale = -1.0, offset = 0.01, delay = 0.002 }
//! command = "U_act"
//! force = { formula = "pA * 12.6 cm2 - pB * 8.2 cm2", units = { pA = "bar", pB = "bar" }, offset = "at rest" }
//! ```
//! A signal is `scale` times the column in the model's unit plus `offset` in the model's unit; a column that
//! comes `delay` seconds late is moved earlier by as much. What is no column's name is a formula of columns
//! ([`super::formula`]). An offset `at rest` makes the signal zero while nothing moves at the start of the record.

mod computed;

use super::check::standstill;
use super::formula::Formula;
use super::interpolate::linear;
use super::table::did_you_mean;
use super::{Channel, DataError, Reading, Record, TimeColumn, units};
use serde::Deserialize;
use std::collections::BTreeMap;

/// What the user says about the columns of the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Map {
    /// What it says about the files as a whole.
    pub reading: Reading,
    /// Where the signals come from, by the model's names.
    pub signals: BTreeMap<String, Source>,
}

/// Where a signal comes from.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// The column's name in the file, or a formula of columns.
    #[serde(alias = "formula")]
    pub column: String,
    /// Its unit instead of the file's.
    pub unit: Option<String>,
    /// Factor; −1 turns the sign.
    #[serde(default = "one")]
    pub scale: f64,
    /// Added after the factor.
    #[serde(default)]
    pub offset: Offset,
    /// By how much the column comes late, in seconds.
    #[serde(default)]
    pub delay: f64,
    /// Units of a formula's columns instead of the file's.
    #[serde(default)]
    pub units: BTreeMap<String, String>,
}

/// What is added to a signal.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Offset {
    /// A number, in the model's unit.
    Number(f64),
    /// What makes it zero while the rig is at rest at the start of the record.
    Word(AtRest),
}

/// The word for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum AtRest {
    /// `at rest`.
    #[serde(rename = "at rest")]
    AtRest,
}

impl Default for Offset {
    fn default() -> Self {
        Self::Number(0.0)
    }
}

impl Source {
    /// A column as it is.
    fn of(column: String) -> Self {
        let offset = Offset::default();
        Self { column, unit: None, scale: 1.0, offset, delay: 0.0, units: BTreeMap::new() }
    }

    /// The negative of it, or itself.
    fn signed(&self, sign: f64) -> Self {
        let offset = match self.offset {
            Offset::Number(offset) => Offset::Number(sign * offset),
            at_rest @ Offset::Word(_) => at_rest,
        };
        Self { scale: sign * self.scale, offset, ..self.clone() }
    }
}

/// Where a signal was found.
enum Found {
    /// In a column.
    Column(usize),
    /// In several of them.
    Formula(Formula),
}

/// A signal that the model knows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// The model's name.
    pub name: String,
    /// The model's unit, SI; empty where the model states none.
    pub unit: String,
    /// Other names that a column may have; with a leading `-` the column is its negative.
    pub aliases: Vec<String>,
}

impl Wanted {
    /// What it is called, its own name first, and the sign under which it is.
    fn names(&self) -> impl Iterator<Item = (&str, f64)> {
        std::iter::once(&self.name)
            .chain(&self.aliases)
            .map(|name| name.strip_prefix('-').map_or((name.as_str(), 1.0), |name| (name, -1.0)))
    }

    /// Whether it is called so, whatever its sign.
    pub fn is_called(&self, name: &str) -> bool {
        self.names().any(|(of, _)| of == name)
    }

    /// How a value in a column's unit becomes the model's. A model that states no unit counts in those of the SI.
    fn conversion(&self, unit: &str) -> Result<units::Conversion, String> {
        match self.unit.is_empty() {
            true => units::si(unit).map(|(conversion, _)| conversion),
            false => units::conversion(unit, &self.unit),
        }
    }
}

/// A record with the model's names and units.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapped {
    /// The signals that were found, in the order in which they were wanted.
    pub record: Record,
    /// Where each of them comes from.
    pub taken: Vec<Taken>,
    /// Columns of the file that no signal comes from.
    pub unused: Vec<Channel>,
    /// Signals that were wanted, but are not in the file.
    pub missing: Vec<String>,
}

/// Where a signal comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Taken {
    /// The model's name.
    pub signal: String,
    /// The column, or the formula of columns.
    pub column: String,
    /// Its unit.
    pub unit: String,
    /// Whether the unit is the model's because neither the file nor the map says one.
    pub assumed: bool,
}

fn one() -> f64 {
    1.0
}

impl Map {
    /// Reads a map from TOML.
    ///
    /// # Errors
    /// It is not TOML, has keys that are not known, or numbers that are not finite.
    pub fn parse(text: &str) -> Result<Self, DataError> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct File {
            time: Option<toml::Value>,
            rate: Option<f64>,
            skip_rows: Option<usize>,
            sheet: Option<String>,
            #[serde(default)]
            signals: BTreeMap<String, toml::Value>,
        }
        let file: File = toml::from_str(text).map_err(|e| DataError::Map(e.to_string()))?;
        let time = match file.time {
            Some(toml::Value::String(column)) => Some(TimeColumn { column, unit: None }),
            Some(table) => Some(table.try_into().map_err(|e| DataError::Map(format!("`time`: {e}")))?),
            None => None,
        };
        let mut signals = BTreeMap::new();
        for (name, value) in file.signals {
            let source = match value {
                toml::Value::String(column) => Source::of(column),
                table => table.try_into().map_err(|e| DataError::Map(format!("`{name}`: {e}")))?,
            };
            let finite = !matches!(source.offset, Offset::Number(it) if !it.is_finite());
            let sound =
                source.scale != 0.0 && finite && [source.scale, source.delay].iter().all(|v| v.is_finite());
            if !sound {
                let text =
                    format!("`{name}`: scale must not be 0; scale, offset and delay have to be finite");
                return Err(DataError::Map(text));
            }
            signals.insert(name, source);
        }
        let reading = Reading { time, rate: file.rate, skip_rows: file.skip_rows, sheet: file.sheet };
        Ok(Self { reading, signals })
    }

    /// Takes the wanted signals out of a record. What the map does not mention is found by its name or an alias,
    /// whatever their case and whether the parts are joined by `.` or `_`.
    ///
    /// # Errors
    /// The map names a column or a signal that does not exist; a unit is unknown or does not fit.
    pub fn apply(&self, record: Record, wanted: &[Wanted]) -> Result<Mapped, DataError> {
        for name in self.signals.keys() {
            if !wanted.iter().any(|wanted| wanted.is_called(name)) {
                let hint = did_you_mean(name, wanted.iter().map(|wanted| wanted.name.as_str()));
                return Err(DataError::Map(format!("the model has no signal `{name}`{hint}")));
            }
        }
        let mut used = vec![false; record.channels.len()];
        let (mut channels, mut taken, mut missing) = (Vec::new(), Vec::new(), Vec::new());
        for wanted in wanted {
            let Some((found, source)) = self.source(&record, wanted)? else {
                missing.push(wanted.name.clone());
                continue;
            };
            let (columns, values, unit) = match found {
                Found::Column(index) => {
                    let (values, unit) = converted(&record, index, &source, wanted)?;
                    (vec![index], values, unit)
                }
                Found::Formula(formula) => {
                    let (columns, values) = computed::values(&record, &formula, &source, wanted)?;
                    (columns, values, Some(wanted.unit.clone()))
                }
            };
            taken.push(Taken {
                signal: wanted.name.clone(),
                column: source.column.clone(),
                assumed: unit.is_none(),
                unit: unit.unwrap_or_else(|| wanted.unit.clone()),
            });
            columns.into_iter().for_each(|index| used[index] = true);
            channels.push(corrected(&record, values, &source, wanted)?);
        }
        let unused = record.channels.iter().zip(used).filter(|(_, used)| !used);
        let unused = unused.map(|(channel, _)| channel.clone()).collect();
        if channels.is_empty() {
            let columns: Vec<&str> = record.channels.iter().map(|it| it.name.as_str()).collect();
            let text = format!(
                "none of the model's signals is among its columns, {}; name the columns in a map: `[signals]`, `{} = \"…\"`",
                columns.join(", "),
                wanted.first().map_or("signal", |wanted| &wanted.name)
            );
            return Err(DataError::file(&record.name, text));
        }
        Ok(Mapped { record: Record { channels, ..record }, taken, unused, missing })
    }

    /// Where a signal is and what to do with it; none if the file does not have it.
    fn source(&self, record: &Record, wanted: &Wanted) -> Result<Option<(Found, Source)>, DataError> {
        for (name, sign) in wanted.names() {
            let Some(source) = self.signals.get(name) else { continue };
            let unit = source.unit.as_deref();
            let unread = || record.unread.iter().find(|it| it.is_called(&source.column));
            let found = match only(record, wanted, unit, |column| column.is_called(&source.column))? {
                Some(index) => Found::Column(index),
                None => match unread() {
                    Some(unread) => {
                        let text = format!("the map takes `{name}` from it, but {}", unread.why);
                        return Err(DataError::signal(&record.name, &unread.name, text));
                    }
                    None => Found::Formula(computed::read(record, name, &source.column)?),
                },
            };
            return Ok(Some((found, source.signed(sign))));
        }
        for (name, sign) in wanted.names() {
            let called = |column: &str| {
                let without_unit = units::split_suffix(column, &wanted.unit).map(|(name, _)| plain(name));
                plain(column) == plain(name) || without_unit.is_some_and(|it| it == plain(name))
            };
            if let Some(index) = only(record, wanted, None, |column| called(&column.name))? {
                let source = Source::of(record.channels[index].name.clone());
                return Ok(Some((Found::Column(index), source.signed(sign))));
            }
            if let Some(unread) = record.unread.iter().find(|it| called(&it.name)) {
                let text = match unread.name == wanted.name {
                    true => unread.why.clone(),
                    false => format!("this is `{}`, but {}", wanted.name, unread.why),
                };
                return Err(DataError::signal(&record.name, &unread.name, text));
            }
        }
        Ok(None)
    }
}

/// The column that is called as it should be. Of several of one name (`Force (V)`, `Force (N)`) the one whose unit fits.
fn only(
    record: &Record,
    wanted: &Wanted,
    unit: Option<&str>,
    called: impl Fn(&Channel) -> bool,
) -> Result<Option<usize>, DataError> {
    let of_the_name: Vec<usize> =
        (0..record.channels.len()).filter(|it| called(&record.channels[*it])).collect();
    let fits = |index: &&usize| {
        let unit = unit.unwrap_or(&record.channels[**index].unit).trim();
        unit.is_empty() || wanted.conversion(unit).is_ok()
    };
    let fitting: Vec<&usize> = of_the_name.iter().filter(fits).collect();
    if let [one, other, ..] = fitting[..] {
        let [one, other] = [one, other].map(|it| &record.channels[*it]);
        let text = format!(
            "there are two of it, in {} and {}: name the one in the map, `\"{}\" = \"{}\"`",
            one.unit,
            other.unit,
            wanted.name,
            one.title()
        );
        return Err(DataError::signal(&record.name, &one.name, text));
    }
    // If none fits, the unit of the first is what is wrong.
    Ok(fitting.first().copied().or(of_the_name.first()).copied())
}

/// A name without what does not tell names apart.
pub fn plain(name: &str) -> String {
    name.trim().to_lowercase().replace(['.', ' '], "_")
}

/// A column in the model's unit, and the unit that it has in the file or the map: in the header, or at the end of its name.
/// A column without one is in the model's.
fn converted(
    record: &Record,
    index: usize,
    source: &Source,
    wanted: &Wanted,
) -> Result<(Vec<f64>, Option<String>), DataError> {
    let column = &record.channels[index];
    if !source.units.is_empty() {
        let text = "`units` are those of a formula's columns; give this one's in the map as `unit`";
        return Err(DataError::signal(&record.name, &column.name, text));
    }
    let header = Some(column.unit.trim()).filter(|unit| !unit.is_empty());
    let suffix = || units::split_suffix(&column.name, &wanted.unit).map(|(_, unit)| unit);
    let unit = source.unit.as_deref().or(header).or_else(suffix);
    let conversion = wanted.conversion(unit.unwrap_or(&wanted.unit)).map_err(|problem| {
        let text = format!(
            "{problem}: `{}` is wanted in {}; correct the header, or give the column's unit in the map",
            wanted.name, wanted.unit
        );
        DataError::signal(&record.name, &column.name, text)
    })?;
    Ok((column.values.iter().map(|it| conversion.apply(*it)).collect(), unit.map(str::to_owned)))
}

/// The signal with its factor, offset and delay.
fn corrected(
    record: &Record,
    values: Vec<f64>,
    source: &Source,
    wanted: &Wanted,
) -> Result<Channel, DataError> {
    let mut values: Vec<f64> = values.into_iter().map(|it| source.scale * it).collect();
    let offset = match source.offset {
        Offset::Number(offset) => offset,
        Offset::Word(AtRest::AtRest) => -at_rest(record, &values, wanted)?,
    };
    values.iter_mut().for_each(|it| *it += offset);
    if source.delay != 0.0 {
        values = record.time.iter().map(|t| linear(&record.time, &values, t + source.delay)).collect();
    }
    Ok(Channel { name: wanted.name.clone(), unit: wanted.unit.clone(), values })
}

/// Mean of a signal while nothing moves at the start of the record.
fn at_rest(record: &Record, values: &[f64], wanted: &Wanted) -> Result<f64, DataError> {
    let known = |rest: std::ops::Range<usize>| {
        values[rest].iter().copied().filter(|it| it.is_finite()).collect::<Vec<_>>()
    };
    let still = standstill(record).map(known).filter(|it| !it.is_empty()).ok_or_else(|| {
        let text = "its offset is that at rest, and the record does not start with a second and 200 samples of rest: give \
                    a number"
            .to_owned();
        DataError::signal(&record.name, &wanted.name, text)
    })?;
    Ok(still.iter().sum::<f64>() / still.len() as f64)
}

#[cfg(test)]
mod tests;
