//! A signal that was measured.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoVariables, Real, Settings, Variables, bundles,
};

use crate::recording::{self, Header};

/// A measured signal over time, in the unit of the input that it drives.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedSource {
    /// Times and values; none without a file.
    rows: Vec<[f64; 2]>,
}

/// What the first line of the file says: the unit is whichever the signal has.
const HEADER: Header = Header {
    what: "record",
    columns: "time [s], signal [N]",
    is_second: |name| name.starts_with("signal [") && name.ends_with(']'),
};

/// Which record it is.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// File of the record in the FMU's resources, or an absolute path: CSV with a header as `time [s], signal [N]`; without
    /// one the signal is zero
    #[set(start = "")]
    pub file: String,
}

/// When it begins.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Time at which the record is at its time zero
    #[var(unit = S, start = 0.0)]
    pub start_time: R,
}

/// The signal.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Signal, in the unit of the record
    #[var(unit = ANY)]
    pub signal: R,
}

impl Model for RecordedSource {
    const ABOUT: About = About {
        name: "RecordedSource",
        summary: "A measured signal from a file, in the unit of the input that it drives",
        kind: Kind::Source,
        equations: &[Equation {
            text: "y = y_k + (y_(k+1) - y_k) (tau - t_k)/(t_(k+1) - t_k), tau = t - t_0",
            source: "definition",
        }],
        notes: &[
            "y is the signal, t_0 start_time. Straight lines lead from sample to sample, as an importer goes through a table of \
             inputs. Before the first and after the last sample the signal is held.",
            "It has no unit of its own: its parameter set gives it (`[units]`), so that it can be connected with an input of \
             that unit. Values are not converted.",
        ],
        experiment: Experiment { plot: &[], ..Experiment::DEFAULT },
        ..About::DEFAULT
    };

    bundles! { settings: Options, parameters: Parameters, output: Output }

    fn prepare(options: &Options, resources: Option<&Path>) -> Result<Self, String> {
        let rows = if options.file.is_empty() {
            Vec::new()
        } else {
            recording::read(&options.file, resources, HEADER)?
        };
        Ok(Self { rows })
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        let [signal] = (now.time - now.parameters.start_time).lookup(|tau| {
            let [value, slope] = self.at(tau);
            ([value], [slope])
        });
        (NoVariables, Output { signal })
    }
}

impl RecordedSource {
    /// Value and slope.
    fn at(&self, tau: f64) -> [f64; 2] {
        let after = self.rows.partition_point(|[time, _]| *time <= tau);
        let before = after.checked_sub(1).and_then(|index| self.rows.get(index));
        match (before, self.rows.get(after)) {
            (Some([t, y]), Some([next_t, next_y])) => {
                let slope = (next_y - y) / (next_t - t);
                [y + slope * (tau - t), slope]
            }
            (Some([_, held]), None) | (None, Some([_, held])) => [*held, 0.0],
            (None, None) => [0.0; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use strut_model::Value;

    use super::*;
    use crate::testing::Bench;

    fn source(text: &str) -> RecordedSource {
        RecordedSource { rows: recording::parse(text, HEADER).unwrap() }
    }

    #[test]
    fn straight_lines_lead_from_sample_to_sample_and_the_ends_are_held() {
        // Times need not be even. numpy.interp gives the same.
        let source = source("time [s], signal [kN]\n0.5, 2\n1.0, -1\n3.0, 7\n");
        for (time, value, slope) in [
            (0.0, 2.0, 0.0),
            (0.5, 2.0, -6.0),
            (0.75, 0.5, -6.0),
            (1.0, -1.0, 4.0),
            (2.5, 5.0, 4.0),
            (9.0, 7.0, 0.0),
        ] {
            assert_eq!(source.at(time), [value, slope], "{time}");
        }
    }

    #[test]
    fn a_file_is_read_and_begins_when_it_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record.csv");
        std::fs::write(&path, "time [s], signal [1]\n0, 1\n0.1, 2\n").unwrap();
        let file = Value::Text(path.to_str().unwrap().into());
        let mut bench =
            Bench::<RecordedSource>::new().choose("file", file).start("start_time", 0.05).initialized();
        assert_eq!(bench.get("signal"), 1.0);
        bench.step(0.1);
        assert!((bench.get("signal") - 1.5).abs() < 1e-12);
    }

    #[test]
    fn without_a_file_it_is_zero_and_a_wrong_one_is_refused() {
        assert_eq!(RecordedSource { rows: Vec::new() }.at(1.0), [0.0; 2]);
        for text in ["time [s], position [m]\n0,0\n1,1\n", "time, signal [N]\n0,0\n1,1\n"] {
            let error = recording::parse(text, HEADER).unwrap_err();
            assert!(error.contains("expected the header `time [s], signal [N]`"), "{error}");
        }
        let error = RecordedSource::prepare(&Options { file: "none.csv".into() }, None).unwrap_err();
        assert!(error.contains("the record \"none.csv\" cannot be found"), "{error}");
    }
}
