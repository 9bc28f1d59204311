//! From a file's columns to the model's signals: names, units, signs, delays.
//!
//! ```toml
//! time = { column = "Timestamp", unit = "ms" }     # or its name alone
//!
//! [signals]
//! deflection = { column = "Weg_FL", unit = "mm", scale = -1.0, offset = 0.01, delay = 0.002 }
//! command = "U_act"
//! ```
//! A signal is `scale` times the column in the model's unit plus `offset` in the model's unit; a column that
//! comes `delay` seconds late is moved earlier by as much.

use super::interpolate::linear;
use super::table::did_you_mean;
use super::{Channel, DataError, Record, TimeColumn, units};
use serde::Deserialize;
use std::collections::BTreeMap;

/// What the user says about the columns of the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Map {
    /// The column of time, for [`super::read_with`].
    pub time: Option<TimeColumn>,
    /// Where the signals come from, by the model's names.
    pub signals: BTreeMap<String, Source>,
}

/// Where a signal comes from.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// The column's name in the file.
    pub column: String,
    /// Its unit instead of the file's.
    pub unit: Option<String>,
    /// Factor; −1 turns the sign.
    #[serde(default = "one")]
    pub scale: f64,
    /// Added after the factor, in the model's unit.
    #[serde(default)]
    pub offset: f64,
    /// By how much the column comes late, in seconds.
    #[serde(default)]
    pub delay: f64,
}

/// A signal that the model knows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// The model's name.
    pub name: String,
    /// The model's unit, SI.
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
}

/// A record with the model's names and units.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapped {
    /// The signals that were found, in the order in which they were wanted.
    pub record: Record,
    /// Columns of the file that no signal comes from.
    pub unused: Vec<Channel>,
    /// Signals that were wanted, but are not in the file.
    pub missing: Vec<String>,
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
                toml::Value::String(column) => {
                    Source { column, unit: None, scale: 1.0, offset: 0.0, delay: 0.0 }
                }
                table => table.try_into().map_err(|e| DataError::Map(format!("`{name}`: {e}")))?,
            };
            let sound = source.scale != 0.0
                && [source.scale, source.offset, source.delay].iter().all(|v| v.is_finite());
            if !sound {
                let text =
                    format!("`{name}`: scale must not be 0; scale, offset and delay have to be finite");
                return Err(DataError::Map(text));
            }
            signals.insert(name, source);
        }
        Ok(Self { time, signals })
    }

    /// Takes the wanted signals out of a record. What the map does not mention is found by its name or an alias,
    /// whatever their case and whether the parts are joined by `.` or `_`.
    ///
    /// # Errors
    /// The map names a column or a signal that does not exist; a unit is unknown or does not fit.
    pub fn apply(&self, record: Record, wanted: &[Wanted]) -> Result<Mapped, DataError> {
        for name in self.signals.keys() {
            if !wanted.iter().any(|wanted| wanted.names().any(|(of, _)| of == name)) {
                let hint = did_you_mean(name, wanted.iter().map(|wanted| wanted.name.as_str()));
                return Err(DataError::Map(format!("the model has no signal `{name}`{hint}")));
            }
        }
        let mut used = vec![false; record.channels.len()];
        let mut channels = Vec::new();
        let mut missing = Vec::new();
        for wanted in wanted {
            let Some((index, source)) = self.source(&record, wanted)? else {
                missing.push(wanted.name.clone());
                continue;
            };
            used[index] = true;
            channels.push(take(&record, index, &source, wanted)?);
        }
        let unused = record.channels.iter().zip(used).filter(|(_, used)| !used);
        let unused = unused.map(|(channel, _)| channel.clone()).collect();
        if channels.is_empty() {
            let text = format!(
                "none of the model's signals is among its columns; name the columns in a map: `[signals]`, `{} = \"…\"`",
                wanted.first().map_or("signal", |wanted| &wanted.name)
            );
            return Err(DataError::file(&record.name, text));
        }
        Ok(Mapped { record: Record { channels, ..record }, unused, missing })
    }

    /// The column of a signal and what to do with it; none if the file does not have it.
    fn source(&self, record: &Record, wanted: &Wanted) -> Result<Option<(usize, Source)>, DataError> {
        let columns = &record.channels;
        for (name, sign) in wanted.names() {
            let Some(source) = self.signals.get(name) else { continue };
            let unit = source.unit.as_deref();
            let index = only(record, wanted, unit, |column| column.is_called(&source.column))?;
            let index = index.ok_or_else(|| {
                let hint = did_you_mean(&source.column, columns.iter().map(|column| column.name.as_str()));
                let text = format!("the map takes `{name}` from it, but there is no such column{hint}");
                DataError::signal(&record.name, &source.column, text)
            })?;
            let (scale, offset) = (sign * source.scale, sign * source.offset);
            return Ok(Some((index, Source { scale, offset, ..source.clone() })));
        }
        for (name, scale) in wanted.names() {
            if let Some(index) = only(record, wanted, None, |column| plain(&column.name) == plain(name))? {
                let column = columns[index].name.clone();
                return Ok(Some((index, Source { column, unit: None, scale, offset: 0.0, delay: 0.0 })));
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
        unit.is_empty() || units::conversion(unit, &wanted.unit).is_ok()
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

/// A column as the model's signal. A column without a unit is in the model's.
fn take(record: &Record, index: usize, source: &Source, wanted: &Wanted) -> Result<Channel, DataError> {
    let column = &record.channels[index];
    let unit = source.unit.as_ref().unwrap_or(&column.unit);
    let unit = if unit.trim().is_empty() { &wanted.unit } else { unit };
    let conversion = units::conversion(unit, &wanted.unit).map_err(|problem| {
        let text = format!(
            "{problem}: `{}` is wanted in {}; correct the header, or give the column's unit in the map",
            wanted.name, wanted.unit
        );
        DataError::signal(&record.name, &column.name, text)
    })?;
    let value = |v: f64| source.scale * conversion.apply(v) + source.offset;
    let mut values: Vec<f64> = column.values.iter().map(|&v| value(v)).collect();
    if source.delay != 0.0 {
        values = record.time.iter().map(|t| linear(&record.time, &values, t + source.delay)).collect();
    }
    Ok(Channel { name: wanted.name.clone(), unit: wanted.unit.clone(), values })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(columns: &[(&str, &str, [f64; 4])]) -> Record {
        let channel = |(name, unit, values): &(&str, &str, [f64; 4])| Channel {
            name: (*name).into(),
            unit: (*unit).into(),
            values: values.to_vec(),
        };
        let time = vec![0.0, 0.5, 1.0, 1.5];
        Record { name: "run.csv".into(), time, channels: columns.iter().map(channel).collect() }
    }

    fn wanted(name: &str, unit: &str, aliases: &[&str]) -> Wanted {
        let aliases = aliases.iter().map(|&alias| alias.into()).collect();
        Wanted { name: name.into(), unit: unit.into(), aliases }
    }

    const RAMP: [f64; 4] = [0.0, 1.0, 2.0, 3.0];

    fn error(map: &str, record: Record, wanted: &[Wanted]) -> String {
        Map::parse(map).and_then(|map| map.apply(record, wanted)).unwrap_err().to_string()
    }

    #[test]
    fn a_column_may_be_named_with_its_unit_as_in_the_header() {
        let file = record(&[("Weg FL", "mm", RAMP), ("Kraft", "", RAMP)]);
        let signals = [wanted("deflection", "m", &[]), wanted("force", "N", &[])];
        for column in ["Weg FL [mm]", "Weg FL (mm)", "Weg FL"] {
            let map = format!("[signals]\n\"deflection\" = \"{column}\"\n\"force\" = \"Kraft\"\n");
            let mapped = Map::parse(&map).and_then(|map| map.apply(file.clone(), &signals)).unwrap();
            assert_eq!(mapped.record.channels[0].values, [0.0, 0.001, 0.002, 0.003]);
        }
        // Another unit is another column.
        let error = error("[signals]\n\"deflection\" = \"Weg FL [m]\"\n", file, &signals);
        assert!(error.contains("did you mean `Weg FL`?"), "{error}");
    }

    #[test]
    fn names_and_aliases_without_a_map() {
        let file = record(&[("Body.Acceleration", "g", RAMP), ("travel", "mm", RAMP), ("spare", "", RAMP)]);
        let signals = [
            wanted("body_acceleration", "m/s2", &[]),
            wanted("deflection", "m", &["-compression", "-travel"]),
            wanted("force", "N", &[]),
        ];
        let mapped = Map::default().apply(file, &signals).unwrap();
        assert_eq!(mapped.unused.iter().map(Channel::title).collect::<Vec<_>>(), ["spare"]);
        assert_eq!(mapped.missing, ["force"]);
        let [acceleration, deflection] = &mapped.record.channels[..] else { panic!() };
        assert_eq!((acceleration.name.as_str(), acceleration.unit.as_str()), ("body_acceleration", "m/s2"));
        assert_eq!(acceleration.values[1], 9.80665);
        assert_eq!(deflection.values, [0.0, -0.001, -0.002, -0.003]);
    }

    #[test]
    fn scale_offset_unit_and_delay() {
        let map = "[signals]\nx = { column = \"Weg\", unit = \"mm\", scale = -1.0, offset = 0.5, delay = 0.25 }\n\
                   u = \"U\"\n";
        let file = record(&[("Weg", "V", [0.0, 1000.0, 2000.0, 3000.0]), ("U", "", RAMP)]);
        let mapped =
            Map::parse(map).unwrap().apply(file, &[wanted("x", "m", &[]), wanted("u", "V", &[])]).unwrap();
        let x = &mapped.record.channels[0].values;
        assert_eq!(x[..3], [0.0, -1.0, -2.0]);
        assert!(x[3].is_nan());
        assert_eq!(mapped.record.channels[1].values, RAMP);
    }

    #[test]
    fn the_column_of_time() {
        let map = Map::parse("time = { column = \"Stamp\", unit = \"ms\" }").unwrap();
        let record = crate::data::parse("run.csv", b"Stamp,x\n0,1\n5,2\n", map.time.as_ref()).unwrap();
        assert_eq!(record.time, [0.0, 0.005]);
        let map = Map::parse("time = \"x\"").unwrap();
        let record = crate::data::parse("run.csv", b"Stamp,x\n0,1\n5,2\n", map.time.as_ref()).unwrap();
        assert_eq!(record.time, [1.0, 2.0]);
        assert!(Map::parse("time = { columns = \"x\" }").unwrap_err().to_string().contains("columns"));
    }

    #[test]
    fn a_map_may_use_an_alias() {
        let map = Map::parse("[signals]\nstroke = { column = \"x\", scale = 2.0, offset = 1.0 }").unwrap();
        let mapped =
            map.apply(record(&[("x", "mm", RAMP)]), &[wanted("position", "m", &["-stroke"])]).unwrap();
        assert_eq!(mapped.record.channels[0].values[..2], [-1.0, -1.002]);
    }

    #[test]
    fn of_two_columns_of_a_name_the_unit_decides() {
        let file = || record(&[("Force", "V", RAMP), ("Force", "kN", RAMP)]);
        let signals = [wanted("force", "N", &[])];
        for map in ["", "[signals]\nforce = \"Force\"", "[signals]\nforce = \"Force (kN)\""] {
            let mapped = Map::parse(map).unwrap().apply(file(), &signals).unwrap();
            assert_eq!(mapped.record.channels[0].values, RAMP.map(|it| 1e3 * it), "{map}");
        }
        let both = || record(&[("Force", "N", RAMP), ("Force", "kN", RAMP)]);
        let message = error("", both(), &signals);
        assert!(message.contains("`\"force\" = \"Force [N]\"`"), "{message}");
        let mapped = Map::parse("[signals]\nforce = \"Force [N]\"").unwrap().apply(both(), &signals);
        assert_eq!(mapped.unwrap().record.channels[0].values, RAMP);
    }

    #[test]
    fn errors_say_what_to_do() {
        let file = || record(&[("deflection", "mm", RAMP), ("force", "V", RAMP)]);
        let signals = [wanted("strut_force", "N", &["force"]), wanted("x", "m", &[])];
        let message = error("", file(), &signals);
        assert!(message.starts_with("run.csv, force: `V` does not measure the same as `N`"), "{message}");
        let message = error("[signals]\nx = \"deflexion\"", file(), &signals[1..]);
        assert!(message.contains("did you mean `deflection`?"), "{message}");
        let message = error("[signals]\nstrut_forse = \"force\"", file(), &signals);
        assert!(message.contains("did you mean `strut_force`?"), "{message}");
        let message = error("", file(), &[wanted("y", "m", &[])]);
        assert!(message.contains("none of the model's signals"), "{message}");
        let message = error("[signals]\nx = { column = \"deflection\", units = \"mm\" }", file(), &signals);
        assert!(message.contains("units"), "{message}");
        let message = error("[signals]\nx = { column = \"deflection\", scale = 0.0 }", file(), &signals);
        assert!(message.contains("scale must not be 0"), "{message}");
        assert!(error("signal = 3", file(), &signals).contains("signal"));
        let message =
            error("[signals]\nx = { column = \"deflection\", unit = \"furlong\" }", file(), &signals[1..]);
        assert!(message.contains("`furlong` is not a unit known here"), "{message}");
    }
}
