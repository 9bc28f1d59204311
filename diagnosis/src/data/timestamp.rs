//! Dates and times of day, as loggers write them, into seconds.

use chrono::{DateTime, NaiveDate, NaiveDateTime, NaiveTime};

/// Times of day with a date before them, or `T` between the two.
const LOCAL: [&str; 3] = ["%Y-%m-%d %H:%M:%S%.f", "%Y-%m-%dT%H:%M:%S%.f", "%d.%m.%Y %H:%M:%S%.f"];

/// A column of timestamps, in seconds from its first one: seconds from some distant day would lose their last digits.
#[derive(Debug)]
pub(crate) struct Timestamps {
    first: NaiveDateTime,
}

impl Timestamps {
    /// From the column's first cell; none if that is none.
    pub fn from(cell: &str) -> Option<Self> {
        instant(cell).map(|first| Self { first })
    }

    /// A cell of it in seconds; none if it is not a timestamp.
    pub fn seconds(&self, cell: &str) -> Option<f64> {
        let passed = instant(cell)? - self.first;
        Some(passed.num_seconds() as f64 + 1e-9 * f64::from(passed.subsec_nanos()))
    }
}

/// ISO 8601 with or without an offset from UTC, German dates, or a time of day alone. What begins with a month is
/// not read: it may be a day.
fn instant(cell: &str) -> Option<NaiveDateTime> {
    let local = || LOCAL.iter().find_map(|format| NaiveDateTime::parse_from_str(cell, format).ok());
    let of_a_day = || {
        let time = NaiveTime::parse_from_str(cell, "%H:%M:%S%.f").ok()?;
        Some(NaiveDate::default().and_time(time))
    };
    let universal = DateTime::parse_from_rfc3339(cell).ok().map(|it| it.naive_utc());
    universal.or_else(local).or_else(of_a_day)
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
        for cell in ["", "1.5", "20251114", "05/25/2022 05:46:08", "2025-11-14", "25:00:00", "NaN"] {
            assert!(Timestamps::from(cell).is_none(), "{cell}");
        }
    }
}
