//! What is wrong with one signal.

use super::{Channel, MOST_MISSING, Problems, describe, number, percent, runs, spread};
use crate::noise::{lattice, median, noise_floor};
use std::ops::Range;

/// Share of samples that differ from the one before, from which a signal counts as a moving measurement.
const MOVING: f64 = 0.5;
/// Share of the record during which a stuck sensor stands still.
const STUCK: f64 = 0.2;
/// Size of the jump, over the median change, with which a stuck sensor comes back.
const JUMP: f64 = 5.0;
/// Samples at an extreme value in a row that make a flat top, and how many of them make saturation.
const FLAT: usize = 3;
const FEWEST_FLAT: usize = 5;
/// How much more often the extreme value is taken than the next one. A sine on a lattice has 2.4 at most.
const PILED: usize = 4;
/// Change over a lattice's step below which it is one step.
const CREEPING: f64 = 1.5;
/// Noise over the spread of a signal, below which flat parts may be its own: what the noise's estimate leaves of a
/// smooth signal is a few parts in ten thousand.
const SMOOTH: f64 = 1e-3;
/// Equal samples in a row, at least, over which a moving signal was held, and how often in a record chance may make as
/// many.
const HELD: usize = 4;
const BY_CHANCE: f64 = 1e-3;
/// Held stretches that make a fault.
const FEWEST_HELD: usize = 3;
/// Share of a record beyond which a signal holds its values by nature: it is a command, which may switch, or its source is slower.
const BY_NATURE: f64 = 0.2;
/// Longest run of zeros that is a dropout.
const DROPOUT: usize = 10;
/// Size of a dropout over the median change and over the largest change nearby.
const ABOVE_USUAL: f64 = 10.0;
const ABOVE_NEAR: f64 = 5.0;
/// Share of the samples beyond which spikes are what the signal does.
const SELDOM: f64 = 0.01;
/// Factor of both below which twice as many are found where spikes are the tail of what the signal does anyway, as a controller's
/// kicks are, and no faults.
const TAIL: f64 = 0.5;
/// Values that a measurement should use at least; with fewer than four it is a switched command.
const FEWEST_LEVELS: usize = 32;
const SWITCHED: usize = 4;

/// What is said of some samples of a signal.
struct Fault {
    text: String,
    samples: Vec<Range<usize>>,
}

/// Checks one signal; `others` tell whether anything moved at all. Returns the samples at which the sensor did not show
/// what it should.
pub(super) fn check<'a>(
    time: &[f64],
    channel: &Channel,
    others: &(impl Iterator<Item = &'a Channel> + Clone),
    problems: &mut Problems,
) -> Vec<Range<usize>> {
    let values = &channel.values;
    let present: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    if present.is_empty() {
        problems.add(&channel.name, true, "has no samples: leave it out".into());
        return Vec::new();
    }
    let mut unusable = Vec::new();
    let mut add = |text: String| problems.add(&channel.name, false, text);
    if present.iter().all(|&v| v == present[0]) {
        let text = format!(
            "is {} {} all the time: it carries no information; if it should move, check its sensor",
            number(present[0]),
            channel.unit
        );
        add(text);
    } else {
        let mut faults = Vec::new();
        let moving = moves(values, MOVING);
        let steady: Option<Range<usize>> = moving.then(|| stuck(values, others.clone())).flatten();
        if let Some(run) = &steady {
            let text = format!(
                "is stuck at {} {} from {} to {} s while other signals move: check the sensor and its cable, and leave \
                 this stretch or the signal out",
                number(values[run.start]),
                channel.unit,
                number(time[run.start]),
                number(time[run.end - 1])
            );
            faults.push(Fault { text, samples: vec![run.clone()] });
        }
        if moving && steady.is_none() {
            for (extreme, word) in [(f64::max as fn(f64, f64) -> f64, "highest"), (f64::min, "lowest")] {
                faults.extend(saturation(time, channel, extreme, word));
            }
            faults.extend(held(time, channel, others));
        }
        faults.extend(dropouts(time, channel));
        for Fault { text, samples } in faults {
            add(text);
            unusable.extend(samples);
        }
        quantisation(channel).into_iter().for_each(&mut add);
    }
    missing(time, channel, problems);
    unusable
}

fn missing(time: &[f64], channel: &Channel, problems: &mut Problems) {
    let gone: Vec<bool> = channel.values.iter().map(|v| !v.is_finite()).collect();
    let stretches = runs(&gone, true);
    let Some(longest) = stretches.iter().max_by_key(|run| run.len()) else { return };
    let count: usize = stretches.iter().map(Range::len).sum();
    let share = count as f64 / gone.len() as f64;
    let fatal = share > MOST_MISSING;
    let text = format!(
        "{count} samples are missing ({}), the first at {} s, at most {} in a row at {} s{}",
        percent(share),
        number(time[stretches[0].start]),
        longest.len(),
        number(time[longest.start]),
        if fatal { ": more than 10 %; leave this signal out, or record all signals at one rate" } else { "" }
    );
    problems.add(&channel.name, fatal, text);
}

/// Whether a signal changes at this share of the samples.
fn moves(values: &[f64], share: f64) -> bool {
    // Runs of equal values are left out: a stuck or saturated sensor moves between them.
    let changes = values.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let still = values.windows(4).filter(|w| w.iter().all(|v| *v == w[0])).count();
    changes as f64 > share * (values.len().saturating_sub(still)) as f64
}

/// The longest stretch in which the signal stands still, if it is long, another signal moves in it, and it is no
/// rest: a resting signal moves off smoothly, and shows its noise if that is more than its rounding.
fn stuck<'a>(values: &[f64], mut others: impl Iterator<Item = &'a Channel>) -> Option<Range<usize>> {
    let equal: Vec<bool> = values.windows(2).map(|pair| pair[0] == pair[1]).collect();
    let longest = runs(&equal, true).into_iter().max_by_key(Range::len)?;
    let run = longest.start..longest.end + 1;
    let long = run.len() as f64 > STUCK * values.len() as f64;
    if !long || !others.any(|other| moves(&other.values[run.clone()], MOVING)) {
        return None;
    }
    let change = |pair: &[f64]| (pair[1] - pair[0]).abs();
    let mut changes: Vec<f64> = values.windows(2).map(change).filter(|&c| c > 0.0).collect();
    let usual = median(&mut changes)?;
    let jump = values.get(run.end).map_or(0.0, |next| (next - values[run.start]).abs());
    let step = lattice(values).map_or(0.0, |lattice| lattice.step);
    let noise = noise_floor(&values[..run.start]).max(noise_floor(&values[run.end..]));
    (jump > JUMP * usual || noise > (0.5 * step).max(1e-3 * usual)).then_some(run)
}

/// Flat tops at the extreme value.
fn saturation(time: &[f64], channel: &Channel, extreme: fn(f64, f64) -> f64, word: &str) -> Option<Fault> {
    let values = &channel.values;
    // f64's max and min pass over NaN.
    let top = values.iter().copied().reduce(extreme)?;
    let next = values.iter().copied().filter(|&v| v != top).reduce(extreme)?;
    let at = |wanted: f64| values.iter().filter(|&&v| v == wanted).count();
    // At either end of the record the signal may simply be at rest, and where a coarse one creeps to its highest value by a step of its lattice
    // and off again, it turned or rested there.
    let inner = |run: &Range<usize>| run.len() >= FLAT && run.start > 0 && run.end < values.len();
    let mut tops: Vec<_> = runs(values, top).into_iter().filter(inner).collect();
    if tops.is_empty() {
        return None;
    }
    let step = lattice(values).map_or(0.0, |lattice| lattice.step);
    let creeps = |run: &Range<usize>| {
        let beside = [run.start - 1, run.end].map(|it| (values[it] - top).abs());
        beside.iter().all(|it| *it < CREEPING * step)
    };
    tops.retain(|run| !creeps(run));
    let count: usize = tops.iter().map(Range::len).sum();
    let by_nature = count as f64 > BY_NATURE * values.len() as f64 || tops.len() < steps(values, step);
    (count >= FEWEST_FLAT && count > PILED * at(next) && !by_nature).then(|| {
        let places = describe(tops.iter().map(|run| format!("{} s", number(time[run.start]))));
        let text = format!(
            "is flat at its {word} value {} {} for {} of the record ({places}): the sensor or its amplifier is \
             saturated, or a stop or a limit is reached; use a larger range or less excitation",
            number(top),
            channel.unit,
            percent(count as f64 / values.len() as f64)
        );
        Fault { text, samples: if is_smooth(values) { Vec::new() } else { tops } }
    })
}

/// How often a signal jumps to a value between its extreme ones and stays there, as a stepped command does.
fn steps(values: &[f64], step: f64) -> usize {
    let extremes = [f64::max as fn(f64, f64) -> f64, f64::min].map(|of| values.iter().copied().reduce(of));
    let equal: Vec<bool> = values.windows(2).map(|pair| pair[0] == pair[1]).collect();
    let jumps = |run: &Range<usize>| {
        let jump = run.start.checked_sub(1).map_or(0.0, |before| (values[run.start] - values[before]).abs());
        run.len() + 1 >= FLAT && !extremes.contains(&Some(values[run.start])) && jump > CREEPING * step
    };
    runs(&equal, true).iter().filter(|run| jumps(run)).count()
}

/// Whether a signal has so little noise that flat parts may be its own, as a computed force's of an open contact.
fn is_smooth(values: &[f64]) -> bool {
    noise_floor(values) < SMOOTH * spread(values).1
}

/// Whether a rig stands still: every signal keeps its value, and goes on from there. Where samples were lost, what moves has
/// gone on meanwhile.
fn rests<'a>(run: &Range<usize>, mut others: impl Iterator<Item = &'a Channel> + Clone) -> bool {
    let goes_on = |Channel { values, .. }: &Channel| {
        let change = |pair: &[f64]| (pair[1] - pair[0]).abs();
        let mut changes: Vec<f64> = values.windows(2).map(change).filter(|it| *it > 0.0).collect();
        let usual = median(&mut changes).unwrap_or(0.0);
        let kept = values[run.clone()].iter().all(|it| *it == values[run.start]);
        kept && values.get(run.end).is_none_or(|next| (next - values[run.start]).abs() <= JUMP * usual)
    };
    others.clone().next().is_some() && others.all(goes_on)
}

/// Short stretches over which a moving signal keeps one value, as where samples were lost and the last one repeated.
fn held<'a>(
    time: &[f64],
    channel: &Channel,
    others: &(impl Iterator<Item = &'a Channel> + Clone),
) -> Option<Fault> {
    let values = &channel.values;
    // What has no noise may be at rest, and what has less than its lattice's steps keeps its values at every turn.
    if is_smooth(values) || lattice(values).is_some_and(|lattice| noise_floor(values) < lattice.step) {
        return None;
    }
    let equal: Vec<bool> = values.windows(2).map(|pair| pair[0] == pair[1]).collect();
    let stretches = runs(&equal, true);
    // Chance makes single equal pairs first of all.
    let pairs = stretches.iter().filter(|run| run.len() == 1).count().max(1) as f64 / values.len() as f64;
    let by_chance = |length: usize| values.len() as f64 * pairs.powi(length as i32 - 1);
    let extremes = [f64::max as fn(f64, f64) -> f64, f64::min].map(|of| values.iter().copied().reduce(of));
    let stretches: Vec<_> = stretches
        .into_iter()
        .map(|run| run.start..run.end + 1)
        .filter(|run| run.len() >= HELD && by_chance(run.len()) < BY_CHANCE)
        // Flat tops are another matter.
        .filter(|run| !extremes.contains(&Some(values[run.start])) && !rests(run, others.clone()))
        .collect();
    let total: usize = stretches.iter().map(Range::len).sum();
    if total as f64 > BY_NATURE * values.len() as f64 {
        return None;
    }
    let longest = stretches.iter().map(Range::len).max().filter(|_| stretches.len() >= FEWEST_HELD)?;
    // What friction holds moves off smoothly; a signal of which samples were lost has gone on meanwhile.
    let change = |pair: &[f64]| (pair[1] - pair[0]).abs();
    let mut changes: Vec<f64> = values.windows(2).map(change).filter(|&c| c > 0.0).collect();
    let usual = median(&mut changes)?;
    let mut jumps: Vec<f64> =
        stretches.iter().filter_map(|run| Some((values.get(run.end)? - values[run.start]).abs())).collect();
    if median(&mut jumps)? < usual {
        return None;
    }
    let places = describe(stretches.iter().map(|run| format!("{} s", number(time[run.start]))));
    let text = format!(
        "keeps one value for up to {longest} samples {} times, at {places}: samples were lost and the last one \
         repeated; check the bus or the wireless link",
        stretches.len()
    );
    Some(Fault { text, samples: stretches })
}

/// Single samples, or short runs of zeros, far from their neighbours.
fn dropouts(time: &[f64], channel: &Channel) -> Option<Fault> {
    let values = &channel.values;
    let change = |i: usize| (values[i + 1] - values[i]).abs();
    let mut changes: Vec<f64> =
        (0..values.len().saturating_sub(1)).map(change).filter(|c| c.is_finite()).collect();
    let usual = median(&mut changes)?;
    // A signal that stands still most of the time is a switched command: its pulses are meant.
    if usual == 0.0 {
        return None;
    }
    let found = spikes(values, usual, 1.0);
    let is_usual = found.len() as f64 > SELDOM * values.len() as f64;
    if is_usual || spikes(values, usual, TAIL).len() > 2 * found.len() {
        return None;
    }
    (!found.is_empty()).then(|| {
        let places = describe(found.iter().map(|it| format!("{} s", number(time[it.start]))));
        let text = format!(
            "drops out or spikes for single samples {} times, at {places}: check plugs and cables; these samples are \
             interpolated in an input, and not compared in an output",
            found.len()
        );
        Fault { text, samples: found }
    })
}

/// Single samples, or short runs of zeros, that are by so much farther from their neighbours than what usually changes and what changes
/// nearby, in the two limits for that.
fn spikes(values: &[f64], usual: f64, limits: f64) -> Vec<Range<usize>> {
    let change = |i: usize| (values[i + 1] - values[i]).abs();
    let mut found = Vec::new();
    let mut i = 1;
    while i + 1 < values.len() {
        let zeros = values[i..].iter().take_while(|v| **v == 0.0).count();
        let length = zeros.clamp(1, DROPOUT);
        let end = i + length;
        if end < values.len() {
            let jump = change(i - 1).min(change(end - 1));
            let opposite = (values[i] - values[i - 1]) * (values[end] - values[end - 1]) < 0.0;
            let near = (i.saturating_sub(6)..i - 1).chain(end..(end + 5).min(values.len() - 1)).map(change);
            let drift = 2.0 * (values[end] - values[i - 1]).abs() / (length + 1) as f64;
            let largest_near = near.fold(drift, f64::max);
            if opposite && jump > limits * ABOVE_USUAL * usual && jump > limits * ABOVE_NEAR * largest_near {
                found.push(i..end);
                i = end;
            }
        }
        i += 1;
    }
    found
}

fn quantisation(channel: &Channel) -> Option<String> {
    let lattice = lattice(&channel.values)?;
    if !(SWITCHED..FEWEST_LEVELS).contains(&lattice.levels) {
        return None;
    }
    // A coarse measurement creeps from value to value, a command jumps over several.
    let changes = || channel.values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|c| *c > 0.0);
    let small = changes().filter(|c| *c < CREEPING * lattice.step).count();
    (2 * small > changes().count()).then(|| {
        format!(
            "uses {} different values only, {} {} apart, which is a noise of {} {}: use a smaller range or more bits",
            lattice.levels,
            number(lattice.step),
            channel.unit,
            number(lattice.noise()),
            channel.unit
        )
    })
}
