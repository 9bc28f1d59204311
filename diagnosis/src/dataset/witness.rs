//! Whether records are witnesses of their own: of different excitations, each long enough to say something.

use strut_model::Declaration;

use crate::data::check::DataProblem;
use crate::data::check::noise_floor;
use crate::dataset::recorded::{BLOCK, Dataset, Source};
use crate::diagnosis::root_mean_square;
use crate::report::words::{self, digits};
use crate::screening::rms;

/// Difference of two signals, over their magnitude, below which one is a repetition of the other.
const SAME: f64 = 0.05;
/// The same over the noise of both together.
const BUT_FOR_NOISE: f64 = 1.5;
/// Magnitude of a signal over its noise below which it shows nothing but noise.
const MOVES: f64 = 3.0;
/// Share of an input's magnitude on the validation records below which the estimation records hardly excite it: a hundredth of
/// the power.
const HARDLY: f64 = 0.1;
/// Blocks of time that a record needs: over fewer, nobody can tell how much errors vary by chance.
const BLOCKS: f64 = 4.0;

/// What one input says of the excitation of two records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Compared {
    Same,
    Different,
    /// It rests in both.
    Nothing,
}

/// Whether every measured input is the same in two records but for noise, and one of them moves. One record may be longer.
pub fn same_excitation(one: &Dataset, two: &Dataset) -> bool {
    let pairs: Vec<Compared> = one
        .inputs
        .iter()
        .zip(&two.inputs)
        .map(|pair| match pair {
            (Source::Measured(one), Source::Measured(two)) => compared(one, two),
            (Source::Measured(_), _) | (_, Source::Measured(_)) => Compared::Different,
            _ => Compared::Nothing,
        })
        .collect();
    (one.step - two.step).abs() < 1e-6 * one.step
        && pairs.contains(&Compared::Same)
        && !pairs.contains(&Compared::Different)
}

fn compared(one: &[f64], two: &[f64]) -> Compared {
    let length = one.len().min(two.len());
    let (one, two) = (&one[..length], &two[..length]);
    let differences: Vec<f64> = one.iter().zip(two).map(|(one, two)| one - two).collect();
    let (difference, size) = (root_mean_square(&differences), rms(one));
    let noise = [one, two].map(noise_floor);
    let but_for_noise = difference <= BUT_FOR_NOISE * noise[0].hypot(noise[1]);
    let moves = size > MOVES * noise[0] || rms(two) > MOVES * noise[1];
    if size > 0.0 && difference < SAME * size || moves && but_for_noise {
        Compared::Same
    } else if but_for_noise {
        Compared::Nothing
    } else {
        Compared::Different
    }
}

/// Whether two records hold the same values.
fn same_record(one: &Dataset, two: &Dataset) -> bool {
    let same = |one: &[f64], two: &[f64]| {
        one.len() == two.len() && one.iter().zip(two).all(|(one, two)| one.to_bits() == two.to_bits())
    };
    let inputs = one.inputs.iter().zip(&two.inputs).all(|pair| match pair {
        (Source::Measured(one), Source::Measured(two)) => same(one, two),
        (one, two) => one == two,
    });
    let outputs = one.measured.iter().zip(&two.measured);
    inputs
        && one.measured.len() == two.measured.len()
        && outputs.into_iter().all(|(one, two)| one.output == two.output && same(&one.values, &two.values))
}

/// Notes on records that are no witnesses: too short ones, repetitions of an earlier one, and inputs that move in validation
/// alone.
pub fn notes(train: &[Dataset], test: &[Dataset], inputs: &[Declaration]) -> Vec<DataProblem> {
    let mut notes = Vec::new();
    let mut note = |record: &Dataset, signal: &str, text: String| {
        notes.push(DataProblem { record: record.name.clone(), signal: signal.into(), text, fatal: false });
    };
    let all: Vec<&Dataset> = train.iter().chain(test).collect();
    for (index, record) in all.iter().enumerate() {
        let earlier = || all[..index].iter();
        if earlier().any(|it| it.name == record.name && same_record(it, record)) {
            continue;
        }
        let seconds = record.sections.iter().map(|it| it.len() as f64 * record.step).sum::<f64>();
        if seconds < BLOCKS * BLOCK {
            let text = format!(
                "only {} s long: errors are compared over blocks of {BLOCK} s, and fewer than {BLOCKS:.0} of them do not \
                 show what is chance. Intervals and p-values are not reliable. Record at least {} s",
                digits(seconds, 2),
                digits(BLOCKS * BLOCK, 1)
            );
            note(record, "time", text);
        }
    }
    for (number, record) in train.iter().enumerate() {
        if let Some(other) = train[..number].iter().find(|it| same_record(it, record)) {
            let text = format!("the same data as {}: they count twice. Give each record once", other.name);
            note(record, "all", text);
        }
    }
    for record in test {
        if let Some(other) = train.iter().find(|it| same_record(it, record)) {
            let text = format!(
                "the same data as the estimation record {}: they validate nothing. Record another excitation for \
                 validation",
                other.name
            );
            note(record, "all", text);
        } else if let Some(other) = train.iter().find(|it| same_excitation(it, record)) {
            let text = format!(
                "the same excitation as the estimation record {}: an error of the model can repeat itself unnoticed. \
                 Record another excitation for validation",
                other.name
            );
            note(record, "all inputs", text);
        }
    }
    for (index, input) in inputs.iter().enumerate() {
        let size = |record: &Dataset| match &record.inputs[index] {
            Source::Measured(values) => rms(values),
            Source::DerivativeOf(_) | Source::RateOf(_) | Source::Constant(_) => 0.0,
        };
        let learned = train.iter().map(size).fold(0.0, f64::max);
        let moves = test.iter().filter(|it| shows(it, index)).max_by(|a, b| size(a).total_cmp(&size(b)));
        if let Some(record) = moves.filter(|it| learned < HARDLY * size(it)) {
            let unit = words::unit(input.unit.symbol);
            let text = format!(
                "moves by {} {unit} (rms), and by {} {unit} in the estimation records: effects that depend on it cannot \
                 be identified. Give this record, or a part of it, for estimation",
                digits(size(record), 3),
                digits(learned, 3)
            );
            note(record, &input.name, text);
        }
    }
    notes
}

/// Whether an input of a record shows more than noise.
fn shows(record: &Dataset, input: usize) -> bool {
    matches!(&record.inputs[input], Source::Measured(values) if rms(values) > MOVES * noise_floor(values))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::Measured;
    use crate::signal::random::{multisine, white};
    use proptest::prelude::*;

    fn record(name: &str, inputs: Vec<Vec<f64>>, seed: u64) -> Dataset {
        let length = inputs[0].len();
        let values: Vec<f64> = white(seed, length);
        Dataset {
            name: name.into(),
            step: 1e-3,
            inputs: inputs.into_iter().map(Source::Measured).collect(),
            measured: vec![Measured { output: 0, values, noise_floor: 0.1 }],
            sections: std::iter::once(0..length).collect(),
            ..Dataset::default()
        }
    }

    fn noisy(signal: &[f64], sigma: f64, seed: u64) -> Vec<f64> {
        signal.iter().zip(white(seed, signal.len())).map(|(signal, noise)| signal + sigma * noise).collect()
    }

    fn texts(train: &[Dataset], test: &[Dataset]) -> Vec<String> {
        let inputs = ["force", "current"].map(Declaration::named);
        let inputs = &inputs[..train[0].inputs.len()];
        notes(train, test, inputs)
            .into_iter()
            .map(|it| format!("{} {}: {}", it.record, it.signal, it.text))
            .collect()
    }

    proptest! {
        /// The same motion again, with other noise up to a third of it, beside an input that only shows noise; and another one.
        #[test]
        fn a_repetition_is_told_from_another_excitation(
            seed in 0_u64..40, sigma in 0.0..0.25_f64, shorter in 0_usize..500,
        ) {
            let motion = multisine(seed, 3000);
            let rest = vec![0.0; 3000];
            let one = record("a", vec![noisy(&motion, sigma, seed), noisy(&rest, 0.1, seed + 1)], 1);
            let again = [noisy(&motion, sigma, seed + 2), noisy(&rest, 0.1, seed + 3)];
            let again = again.iter().map(|it| it[..3000 - shorter].to_vec()).collect();
            let again = record("b", again, 2);
            prop_assert!(same_excitation(&one, &again) && same_excitation(&again, &one));
            let other = vec![noisy(&multisine(seed + 50, 3000), sigma, seed), noisy(&rest, 0.1, seed + 1)];
            prop_assert!(!same_excitation(&one, &record("c", other, 3)));
        }
    }

    #[test]
    fn what_rests_says_nothing_and_another_level_is_another_excitation() {
        let (motion, rest) = (multisine(1, 3000), vec![2.0; 3000]);
        let of = |level: f64| record("a", vec![motion.clone(), vec![level; 3000]], 1);
        assert!(same_excitation(&of(2.0), &of(2.0)));
        // A damper at another current.
        assert!(!same_excitation(&of(2.0), &of(2.5)));
        let still = record("b", vec![rest.clone(), rest], 1);
        assert!(!same_excitation(&still, &still));
        let mut driven = of(2.0);
        driven.inputs[1] = Source::Constant(2.0);
        assert!(!same_excitation(&driven, &of(2.0)));
    }

    #[test]
    fn what_is_no_witness_is_told_once() {
        let [a, b] = [1, 2].map(|seed| record("a.csv", vec![multisine(seed, 3000)], seed));
        let b = Dataset { name: "b.csv".into(), ..b };
        assert!(texts(std::slice::from_ref(&a), std::slice::from_ref(&b)).is_empty());
        let same = texts(std::slice::from_ref(&a), std::slice::from_ref(&a));
        assert!(same.len() == 1 && same[0].contains("they validate nothing"), "{same:?}");
        let again = Dataset { name: "c.csv".into(), ..record("", vec![multisine(1, 3000)], 9) };
        let again = texts(&[b.clone(), a.clone()], &[again]);
        assert!(again.len() == 1 && again[0].contains("the same excitation as the estimation record a.csv"));
        let twice = texts(&[a.clone(), a], &[b]);
        assert!(twice.len() == 1 && twice[0].contains("count twice"), "{twice:?}");
    }

    #[test]
    fn an_input_that_moves_in_validation_alone_is_told() {
        let of = |name: &str, current: f64, seed: u64| {
            let current: Vec<f64> = multisine(seed + 9, 3000).iter().map(|it| current * it).collect();
            record(name, vec![multisine(seed, 3000), noisy(&current, 1e-3, seed)], seed)
        };
        let (still, moved) = (of("a.csv", 1e-3, 1), of("b.csv", 1.0, 2));
        let told = texts(std::slice::from_ref(&still), std::slice::from_ref(&moved));
        assert!(told.len() == 1 && told[0].starts_with("b.csv current: moves by"), "{told:?}");
        assert!(texts(std::slice::from_ref(&moved), std::slice::from_ref(&still)).is_empty());
        assert!(texts(&[still, of("c.csv", 0.3, 3)], &[moved]).is_empty());
    }

    #[test]
    fn a_short_record_is_told_once_however_often_it_is_given() {
        let short = record("a.csv", vec![multisine(1, 540)], 1);
        let told = texts(std::slice::from_ref(&short), std::slice::from_ref(&short));
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].contains("only 0.54 s long") && told[0].contains("at least 2 s"), "{}", told[0]);
        let enough = record("a.csv", vec![multisine(1, 2000)], 1);
        assert!(texts(&[enough], &[]).is_empty());
    }
}
