//! Time series in CSV, as importers of FMUs write and read them: a row of names, `time` first, then a row for each time.

/// Signals over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Times in seconds.
    pub time: Vec<f64>,
    /// Name and values of each signal; a value that is missing is no number.
    pub signals: Vec<(String, Vec<f64>)>,
}

impl Series {
    /// The text. A missing value is an empty cell.
    pub fn text(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let names = self.signals.iter().map(|(name, _)| name.clone());
        let mut add = |row: Vec<String>| writer.write_record(row).expect("memory is written without errors");
        add(std::iter::once("time".to_owned()).chain(names).collect());
        for (row, time) in self.time.iter().enumerate() {
            let cell = |(_, values): &(String, Vec<f64>)| match values[row] {
                value if value.is_finite() => shortest(value),
                _ => String::new(),
            };
            add(std::iter::once(time.to_string()).chain(self.signals.iter().map(cell)).collect());
        }
        let bytes = writer.into_inner().expect("memory is written without errors");
        String::from_utf8(bytes).expect("names and numbers are text")
    }

    /// Reads a text.
    ///
    /// # Errors
    /// With the line, if a value is no number, a row has another length, times fall, or there is no row.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| error.to_string())?.clone();
        if header.get(0).is_none_or(|name| name.trim_start_matches('\u{feff}') != "time") {
            return Err("its first column is not `time`".into());
        }
        let mut series = Self {
            time: Vec::new(),
            signals: header.iter().skip(1).map(|name| (name.to_owned(), Vec::new())).collect(),
        };
        for (line, row) in (2..).zip(reader.records()) {
            let row = row.map_err(|error| error.to_string())?;
            let number = |cell: &str, name: &str| {
                let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
                value.ok_or_else(|| format!("line {line}: `{cell}` of `{name}` is no number"))
            };
            let mut cells = row.iter();
            let time = number(cells.next().unwrap_or_default(), "time")?;
            if series.time.last().is_some_and(|last| time < *last) {
                return Err(format!("line {line}: the time {time} is before that of the row above"));
            }
            series.time.push(time);
            for ((name, values), cell) in series.signals.iter_mut().zip(cells) {
                values.push(if cell.is_empty() { f64::NAN } else { number(cell, name)? });
            }
        }
        if series.time.is_empty() { Err("it has no row of values".into()) } else { Ok(series) }
    }
}

/// The shorter of both ways to write a number.
fn shortest(value: f64) -> String {
    let (plain, power) = (format!("{value}"), format!("{value:e}"));
    if power.len() < plain.len() { power } else { plain }
}

/// Values rounded to a number of digits of the largest one. Further digits would be noise and take room.
pub fn rounded(values: &[f64], digits: i32) -> Vec<f64> {
    let largest =
        values.iter().filter(|it| it.is_finite()).fold(0.0_f64, |largest, it| largest.max(it.abs()));
    if largest == 0.0 {
        return values.to_vec();
    }
    let decimals = digits - 1 - largest.log10().floor() as i32;
    let round = |value: &f64| match usize::try_from(decimals) {
        // Through the text: a product with a power of ten would leave digits of its own.
        Ok(decimals) => format!("{value:.decimals$}").parse().unwrap_or(*value),
        Err(_) => value.round(),
    };
    values.iter().map(round).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_reads_back() {
        let signals = vec![("a[1,2]".into(), vec![1.0, -2.5e-9]), ("der(x)".into(), vec![0.1, 1e300])];
        let series = Series { time: vec![0.0, 0.001], signals };
        assert_eq!(Series::read(&series.text()), Ok(series));
    }

    #[test]
    fn a_missing_value_stays_missing() {
        let series =
            Series { time: vec![0.0], signals: vec![("a".into(), vec![f64::NAN]), ("b".into(), vec![1.0])] };
        assert_eq!(series.text(), "time,a,b\n0,,1\n");
        assert!(Series::read(&series.text()).unwrap().signals[0].1[0].is_nan());
    }

    #[test]
    fn bad_rows_are_said_with_their_line() {
        for (text, part) in [
            ("t,a\n0,1\n", "first column"),
            ("time,a\n", "no row"),
            ("time,a\n0,1\n0.1,x\n", "line 3: `x` of `a`"),
            ("time,a\n0,1\n-1,1\n", "line 3: the time -1"),
            ("time,a\n0,1,2\n", "line: 2"),
            ("time,a\nNaN,1\n", "line 2: `NaN` of `time`"),
        ] {
            let error = Series::read(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn rounding_keeps_digits_of_the_largest_value() {
        assert_eq!(rounded(&[123.456_789, -0.000_123], 5), [123.46, -0.0]);
        assert_eq!(rounded(&[0.012_345_678], 4), [0.012_35]);
        assert_eq!(rounded(&[123_456_789.0], 3), [123_456_789.0]);
        assert!(rounded(&[f64::NAN, 1.0], 3)[0].is_nan());
    }
}
