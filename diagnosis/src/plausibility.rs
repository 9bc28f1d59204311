//! Columns that cannot be what they say: found by one simulation of the nominal model, before any fit.
//!
//! Each record is compared on its own, over its first seconds. Magnitudes are judged only where the parameters are those of a
//! data sheet: of a model's start values nobody knows what the rig has. Columns of one motion are compared with each other in
//! any case, two of one unit with both of the model's signals, and without a data sheet lengths with what test rigs do.

mod kinematics;

use crate::data::check::DataProblem;
use crate::data::units::conversion;
use crate::dataset::recorded::{Dataset, Measured, Source};
use crate::dataset::split::Split;
use crate::decision::plausible::{
    Alternative, FACTOR, Likeness, Plausible, Reading, chosen, is_exchanged, usual_units,
};
use crate::diagnosis::{Options, root_mean_square};
use crate::estimation::hypothesis::Baseline;
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::plant::Dynamics;
use crate::report::words::{digits, unit};
use crate::rig::Rig;
use crate::screening::{bent_rms, rms};
use crate::signal::distortion::Fault;

/// Seconds of a record that are compared.
const SECONDS: f64 = 10.0;
/// Seconds over which other units of the inputs are tried.
const FEWER_SECONDS: f64 = 5.0;
/// Mean of the outputs' errors over their measured rms from which they are tried.
const DOUBTFUL: f64 = 0.3;

/// Standard deviation over the value of a given parameter from which the value says nothing of magnitudes.
const VAGUE: f64 = 0.5;

/// What cannot be as it is recorded.
///
/// # Errors
/// If the model refuses its settings.
pub fn problems(rig: &Rig, records: &Split, options: &Options) -> Result<Vec<DataProblem>, String> {
    let records_of = || records.train.iter().chain(&records.test);
    let mut problems: Vec<DataProblem> = records_of().flat_map(|it| kinematics::problems(rig, it)).collect();
    if !problems.is_empty() {
        return Ok(problems);
    }
    problems.extend(records_of().flat_map(|it| kinematics::late(rig, it)));
    // A vague value says nothing of magnitudes.
    let given = |index: usize| {
        let own = options.known.iter().find(|(other, _, _)| *other == index);
        own.is_some_and(|(_, value, deviation)| *deviation < VAGUE * value.abs())
    };
    let known = |index: usize| rig.stated[index] || given(index);
    let mut nominal = rig.nominal().filter_map(|name| rig.plant.parameter(name));
    // A start value of zero claims no magnitude.
    let has_sheet = nominal.all(|index| known(index) || rig.parameters[index] == 0.0);
    let dynamics = rig.plant.prepare(&rig.choices)?;
    for record in records_of() {
        let [whole, part] = [SECONDS, FEWER_SECONDS].map(|seconds| shortened(record, seconds));
        let [whole, part] = [&whole, &part].map(|it| Compared::new(rig, it, records, options, &*dynamics));
        if has_sheet {
            problems.extend(whole.problems(&part));
        } else {
            problems.extend(kinematics::beyond_any_rig(rig, record));
            problems.extend(whole.exchanged(&whole.simulated(whole.nominal())));
        }
    }
    Ok(problems)
}

/// The first seconds of a record.
fn shortened(record: &Dataset, seconds: f64) -> Dataset {
    let end = (seconds / record.step) as usize;
    let sections = record.sections.iter().filter(|it| it.start < end).map(|it| it.start..it.end.min(end));
    let sections: Vec<_> = sections.collect();
    if sections.is_empty() { record.clone() } else { Dataset { sections, ..record.clone() } }
}

/// A record to be compared with the nominal model.
struct Compared<'a> {
    rig: &'a Rig,
    record: &'a Dataset,
    baseline: Baseline<'a>,
    dynamics: &'a dyn Dynamics,
}

impl<'a> Compared<'a> {
    fn new(
        rig: &'a Rig,
        record: &'a Dataset,
        records: &'a Split,
        options: &Options,
        dynamics: &'a dyn Dynamics,
    ) -> Self {
        let mut baseline = Baseline::new(rig, records, options.clone());
        for (row, measured) in record.measured.iter().enumerate() {
            baseline.sigma[measured.output] = bent_rms(std::slice::from_ref(record), row);
        }
        Self { rig, record, baseline, dynamics }
    }

    fn nominal(&self) -> Estimate {
        let starts = self.baseline.starts(std::slice::from_ref(self.record));
        let mut nominal = Estimate { starts, ..self.baseline.origin() };
        for (parameter, value, _) in &self.baseline.known {
            nominal.parameters[*parameter] = *value;
        }
        nominal
    }

    /// What is to be said with the inputs as they are, unless another unit of one explains more: tried on a shorter record.
    fn problems(&self, shorter: &Self) -> Vec<DataProblem> {
        let now = self.simulated(self.nominal());
        let exchanged = self.exchanged(&now);
        if !exchanged.is_empty() {
            return exchanged;
        }
        let as_they_are = Alternative::new(None, &self.outputs(&now));
        let outputs = &as_they_are.outputs;
        let error = outputs.iter().map(|(likeness, _)| likeness.error).sum::<f64>() / outputs.len() as f64;
        if error > DOUBTFUL || outputs.iter().any(|(_, it)| *it != Plausible::Fine) {
            let as_they_are = Alternative::new(None, &shorter.outputs(&shorter.simulated(shorter.nominal())));
            let others = shorter.others();
            let chosen = chosen(&as_they_are, &others);
            if chosen.input.is_some() {
                return shorter.told(chosen);
            }
        }
        self.told(&as_they_are)
    }

    /// The outputs with each input in other units.
    fn others(&self) -> Vec<Alternative> {
        let mut others = Vec::new();
        for (index, source) in self.record.inputs.iter().enumerate() {
            let Source::Measured(values) = source else { continue };
            if rms(values) == 0.0 {
                continue;
            }
            for reading in readings(self.rig.plant.inputs[index].unit.symbol) {
                let mut point = self.nominal();
                point.set(Unknown::Input(index, Fault::Gain), 1.0 / reading.factor - 1.0);
                let then = self.outputs(&self.simulated(point));
                others.push(Alternative::new(Some((index, reading)), &then));
            }
        }
        others
    }

    /// The measured outputs as the model has them, each from the states at the start that fit best.
    fn simulated(&self, point: Estimate) -> Dataset {
        let fit = self.baseline.fit(self.dynamics, std::slice::from_ref(self.record), Vec::new());
        let point = fit.settled(point);
        let signals = fit.predictions(&point).swap_remove(0);
        let measured = self.record.measured.iter().zip(signals).map(|(measured, mut values)| {
            // What is not known of one is not compared with the other.
            for (value, known) in values.iter_mut().zip(&measured.values) {
                if !known.is_finite() {
                    *value = f64::NAN;
                }
            }
            Measured { values, ..measured.clone() }
        });
        Dataset { measured: measured.collect(), ..self.record.clone() }
    }

    /// The likeness of each output to the model's, and the units that it may have.
    fn outputs(&self, simulated: &Dataset) -> Vec<(Likeness, Vec<Reading>)> {
        let of = |row: usize| {
            let unit = self.rig.plant.outputs[self.record.measured[row].output].unit.symbol;
            (likeness(&self.record.bent(row), &simulated.bent(row)), readings(unit))
        };
        (0..self.record.measured.len()).map(of).collect()
    }

    /// Pairs of outputs that look exchanged.
    fn exchanged(&self, simulated: &Dataset) -> Vec<DataProblem> {
        let declared = |row: usize| &self.rig.plant.outputs[self.record.measured[row].output];
        let of = |row: usize, other: usize| likeness(&self.record.bent(row), &simulated.bent(other));
        let rows = self.record.measured.len();
        let pairs = (0..rows).flat_map(|one| (one + 1..rows).map(move |two| (one, two)));
        let pairs = pairs.filter(|(one, two)| declared(*one).unit == declared(*two).unit).filter_map(|(one, two)| {
            let (own, cross) = ((of(one, one), of(one, two)), (of(two, two), of(two, one)));
            is_exchanged(own, cross).then(|| {
                let (one, two) = (&declared(one).name, &declared(two).name);
                let fit = |it: Likeness| digits(1.0 - it.error, 2);
                self.problem(
                    &format!("{one}, {two}"),
                    true,
                    format!(
                        "are these two swapped? {one} looks like the model's {two} (fit {} instead of {}), and {two} \
                         like its {one} (fit {} instead of {}). If they are, exchange their names in the header or in \
                         a map (--map)",
                        fit(own.1),
                        fit(own.0),
                        fit(cross.1),
                        fit(cross.0)
                    ),
                )
            })
        });
        pairs.collect()
    }

    /// What is to be said of a reading of the columns.
    fn told(&self, reading: &Alternative) -> Vec<DataProblem> {
        let mut problems = Vec::new();
        if let Some((index, wrong)) = reading.input
            && let Source::Measured(values) = &self.record.inputs[index]
        {
            let declared = &self.rig.plant.inputs[index];
            let size = format!("its rms is {} {}", digits(rms(values), 2), unit(declared.unit.symbol));
            let text = match self.record.measured.len() {
                1 => "and the model fits the other column only",
                _ => "and the model fits the other columns only",
            };
            let text = format!("{size}, {text} if {}", mended(&declared.name, declared.unit.symbol, wrong));
            problems.push(self.problem(&declared.name, true, text));
        }
        for (row, (likeness, it)) in reading.outputs.iter().enumerate() {
            let declared = &self.rig.plant.outputs[self.record.measured[row].output];
            let symbol = declared.unit.symbol;
            let size = || {
                let measured = root_mean_square(&self.record.bent(row));
                let (measured, model) = (digits(measured, 2), digits(measured / likeness.ratio, 2));
                let unit = unit(symbol);
                format!(
                    "its rms is {measured} {unit}, and that of the model with the same inputs {model} {unit}"
                )
            };
            let (fatal, text) = match it {
                Plausible::Fine => continue,
                Plausible::Scaled(wrong) => {
                    (true, format!("{}. That fits if {}", size(), mended(&declared.name, symbol, *wrong)))
                }
                Plausible::Unexplained => {
                    let more = if likeness.ratio > 1.0 { "larger" } else { "smaller" };
                    let text = format!(
                        "{}: more than {FACTOR:.0} times {more}. No usual unit explains it. Check the sensor, its gain \
                         and the column's name",
                        size()
                    );
                    (false, text)
                }
            };
            problems.push(self.problem(&declared.name, fatal, text));
        }
        problems
    }

    fn problem(&self, signal: &str, fatal: bool, text: String) -> DataProblem {
        DataProblem { record: self.record.name.clone(), signal: signal.into(), text, fatal }
    }
}

/// What is wrong with a unit, and what to do.
fn mended(name: &str, si: &str, reading: Reading) -> String {
    let Reading { unit: other, in_header, .. } = reading;
    let (values, header) = if in_header { (si, other) } else { (other, si) };
    let is = if in_header { format!("{header}, as the header says") } else { header.to_owned() };
    format!(
        "the values are in {values}, not in {is}. Write the unit in the header, e.g. \"{name} [{values}]\", or in a map \
         (--map)"
    )
}

/// The units in which values of an SI unit may be instead.
fn readings(si: &'static str) -> Vec<Reading> {
    let of = |unit: &&'static str| {
        let scale = conversion(unit, si).ok()?.scale;
        Some([(false, 1.0 / scale), (true, scale)].map(|(in_header, factor)| Reading {
            unit,
            in_header,
            factor,
        }))
    };
    usual_units(si).iter().filter_map(of).flatten().collect()
}

/// The likeness of two signals with values at the same times, both about a mean of zero.
fn likeness(measured: &[f64], simulated: &[f64]) -> Likeness {
    let unknown = Likeness { ratio: f64::NAN, correlation: f64::NAN, error: f64::NAN };
    if measured.len() != simulated.len() {
        return unknown;
    }
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (own, model) = (product(measured, measured), product(simulated, simulated));
    if !(own > 0.0 && model > 0.0 && own.is_finite() && model.is_finite()) {
        return unknown;
    }
    let difference: Vec<f64> = measured.iter().zip(simulated).map(|(a, b)| a - b).collect();
    Likeness {
        ratio: (own / model).sqrt(),
        correlation: product(measured, simulated) / (own * model).sqrt(),
        error: (product(&difference, &difference) / own).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_are_compared_where_both_are_known() {
        let model = [1.0, -1.0, 2.0, -2.0];
        let measured = model.map(|it| -1e3 * it);
        let it = likeness(&measured, &model);
        assert!((it.ratio - 1e3).abs() < 1e-9 && (it.correlation + 1.0).abs() < 1e-12, "{it:?}");
        assert!((it.error - 1.001).abs() < 1e-9, "{it:?}");
        // The model rests or diverges: there is nothing to compare.
        for other in [&[0.0; 4][..], &[1.0, f64::INFINITY, 0.0, 0.0], &[1.0; 3]] {
            assert!(likeness(&measured, other).ratio.is_nan());
        }
    }

    #[test]
    fn a_length_is_read_in_millimetres_either_way() {
        let all = readings("m");
        let has = |unit: &str, in_header: bool, factor: f64| {
            let mut same = all.iter().filter(|it| it.unit == unit && it.in_header == in_header);
            same.any(|it| (it.factor / factor - 1.0).abs() < 1e-9)
        };
        assert!(has("mm", false, 1e3) && has("mm", true, 1e-3) && has("cm", false, 1e2));
        assert!(readings("1").is_empty());
    }

    #[test]
    fn the_message_says_what_to_write() {
        let of =
            |in_header| mended("suspension.deflection", "m", Reading { unit: "mm", in_header, factor: 1e3 });
        assert!(of(false).contains("\"suspension.deflection [mm]\""), "{}", of(false));
        assert!(of(false).starts_with("the values are in mm, not in m."), "{}", of(false));
        assert!(of(true).starts_with("the values are in m, not in mm, as the header says."), "{}", of(true));
    }
}
