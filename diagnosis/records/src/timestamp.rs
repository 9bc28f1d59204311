//! Dates and times of day, as loggers write them, into seconds.

use chrono::{DateTime, NaiveDate, NaiveDateTime, NaiveTime};

/// What is read, for messages.
pub(crate) const FORMS: &str = "read are 2025-11-14 19:45:00.37 (also with T, Z or an offset), 2025/11/14 19:45:00, \
                                14.11.2025 19:45:00, 14-Nov-2025 19:45:00, 14/11/2025 19:45:00, 11/14/2025 07:45:00 PM and \
                                19:45:00.37";

/// Characters of a cell that a message shows.
pub(crate) const SHOWN: usize = 40;

/// Times of day with a date before them.
const LOCAL: [&str; 5] = [
    "%Y-%m-%d %H:%M:%S%.f",
    "%Y-%m-%dT%H:%M:%S%.f",
    "%Y/%m/%d %H:%M:%S%.f",
    "%d.%m.%Y %H:%M:%S%.f",
    "%d-%b-%Y %H:%M:%S%.f",
];
/// The same with a day and a month that cannot be told apart up to the twelfth. A clock of twelve hours is American.
const DAY_FIRST: &str = "%d/%m/%Y %H:%M:%S%.f";
const MONTH_FIRST: [&str; 2] = ["%m/%d/%Y %I:%M:%S%.f %p", "%m/%d/%Y %H:%M:%S%.f"];

/// A column of timestamps, in seconds from its first one: seconds from some distant day would lose their last digits.
#[derive(Debug)]
pub(crate) struct Timestamps {
    first: NaiveDateTime,
    /// The way in which the column is written.
    form: Form,
}

/// A way to write an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// ISO 8601 with an offset from UTC.
    Universal,
    /// A date and a time of day.
    Local(&'static str),
    /// A time of day alone.
    TimeOfDay,
}

impl Form {
    /// Every way, in the order in which they are tried.
    fn all() -> impl Iterator<Item = Self> {
        let local = LOCAL.into_iter().chain([DAY_FIRST]).chain(MONTH_FIRST).map(Self::Local);
        [Self::Universal].into_iter().chain(local).chain([Self::TimeOfDay])
    }

    fn read(self, cell: &str) -> Option<NaiveDateTime> {
        match self {
            Self::Universal => DateTime::parse_from_rfc3339(cell).ok().map(|it| it.naive_utc()),
            Self::Local(form) => NaiveDateTime::parse_from_str(cell, form).ok(),
            Self::TimeOfDay => {
                let time = NaiveTime::parse_from_str(cell, "%H:%M:%S%.f").ok()?;
                Some(NaiveDate::default().and_time(time))
            }
        }
    }
}

impl Timestamps {
    /// From the column's first cell; none if that is none.
    pub fn from(cell: &str) -> Option<Self> {
        // Every form has the two colons of a time of day; most cells of a file are numbers.
        if cell.matches(':').count() < 2 {
            return None;
        }
        Form::all().find_map(|form| form.read(cell).map(|first| Self { first, form }))
    }

    /// A cell of it in seconds; NaN for an empty one, none if it is not written as the first.
    pub fn seconds(&self, cell: &str) -> Option<f64> {
        if cell.is_empty() {
            return Some(f64::NAN);
        }
        let passed = self.form.read(cell)? - self.first;
        Some(passed.num_seconds() as f64 + 1e-9 * f64::from(passed.subsec_nanos()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_is_read() {
        for (first, later) in [
            ("2025-11-14 19:45:00.370690", "2025-11-14 19:45:00.374023"),
            ("2025-12-31T23:59:59.998Z", "2026-01-01T01:00:00.001333+01:00"),
            ("14.11.2025 19:45:00.370690", "14.11.2025 19:45:00.374023"),
            ("23:45:00.370690", "23:45:00.374023"),
            ("2025/11/14 19:45:00.370690", "2025/11/14 19:45:00.374023"),
            ("14-Nov-2025 19:45:00.370690", "14-Nov-2025 19:45:00.374023"),
            ("14/11/2025 19:45:00.370690", "14/11/2025 19:45:00.374023"),
            ("11/14/2025 19:45:00.370690", "11/14/2025 19:45:00.374023"),
            ("06/07/2022 11:59:59.998 AM", "06/07/2022 12:00:00.001333 PM"),
        ] {
            let Some(column) = Timestamps::from(first) else { panic!("{first}") };
            assert_eq!(column.seconds(first), Some(0.0));
            assert!((column.seconds(later).unwrap() - 0.003333).abs() < 1e-12, "{later}");
        }
    }

    #[test]
    fn what_comes_before_is_negative_and_numbers_are_none() {
        let column = Timestamps::from("19:45:01").unwrap();
        assert!((column.seconds("19:45:00.25").unwrap() + 0.75).abs() < 1e-12);
        assert!(column.seconds("").unwrap().is_nan());
        assert_eq!(column.seconds("2025-11-14 19:45:01"), None);
        for cell in ["", "1.5", "20251114", "13/25/2022 05:46:08", "2025-11-14", "25:00:00", "NaN"] {
            assert!(Timestamps::from(cell).is_none(), "{cell}");
        }
    }
}
