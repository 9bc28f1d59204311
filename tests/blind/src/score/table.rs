//! What came out of many cases.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::{Gain, Outcome, Score};

/// Wilson's 95 % interval of a share.
pub fn wilson(hits: usize, of: usize) -> (f64, f64) {
    if of == 0 {
        return (0.0, 1.0);
    }
    let (n, z) = (of as f64, 1.959_963_985);
    let share = hits as f64 / n;
    let middle = share + z * z / (2.0 * n);
    let half = z * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z * z / n;
    (((middle - half) / scale).max(0.0), ((middle + half) / scale).min(1.0))
}

/// The table of targets and the confusion matrix, as Markdown.
pub fn markdown(scores: &[Score]) -> String {
    let mut text = "| figure | wanted | seen | cases | 95 % interval |\n|---|---|---|---|---|\n".to_owned();
    let mut row = |name: &str, wanted: &str, judged: &mut dyn Iterator<Item = bool>| {
        let all: Vec<bool> = judged.collect();
        let hits = all.iter().filter(|hit| **hit).count();
        let (low, high) = wilson(hits, all.len());
        let (seen, interval) = if all.is_empty() {
            ("–".to_owned(), "–".to_owned())
        } else {
            let percent = 100.0 * hits as f64 / all.len() as f64;
            (format!("{percent:.1} %"), format!("{:.1}–{:.1} %", 100.0 * low, 100.0 * high))
        };
        writeln!(text, "| {name} | {wanted} | {seen} | {hits}/{} | {interval} |", all.len())
            .expect("a string takes everything");
    };
    let single = || scores.iter().filter(|score| score.effects == 1 && !score.out_of_catalogue);
    let without = |clutter| scores.iter().filter(move |score| score.effects == 0 && score.clutter == clutter);
    let unnamed = || scores.iter().filter(|score| score.out_of_catalogue);
    let good = |score: &Score| matches!(score.outcome, Outcome::Correct | Outcome::OneOfTwo);
    let alarm = |score: &Score| score.outcome == Outcome::FalseAlarm;
    row("correct, or one of two", "≥ 95 %", &mut single().map(good));
    let full = || single().filter(|score| score.full_size);
    row("the same where effects are as large as the targets ask", "≥ 95 %", &mut full().map(good));
    let beside = |score: &Score| matches!(score.beside_clutter, Outcome::Correct | Outcome::OneOfTwo);
    row("the same but for what of the clutter is there and named", "–", &mut single().map(beside));
    row("first name right", "≥ 95 %", &mut single().filter_map(|score| score.first_right));
    row("false alarms without clutter", "≤ 1 %", &mut without(false).map(alarm));
    row("false alarms with clutter", "≤ 5 %", &mut without(true).map(alarm));
    let pairs = scores.iter().filter(|score| score.effects == 2 && !score.out_of_catalogue);
    row("pairs: exact set", "≥ 80 %", &mut pairs.map(good));
    let wrong = |outcome: Outcome| outcome == Outcome::WrongName;
    row("out of catalogue: falsely named", "≤ 5 %", &mut unnamed().map(|score| wrong(score.outcome)));
    let beside = |score: &Score| wrong(score.beside_clutter);
    row("the same but for what of the clutter is there and named", "–", &mut unnamed().map(beside));
    let nothing = |score: &Score| score.outcome == Outcome::Missed;
    row("out of catalogue: reported as no effect", "–", &mut unnamed().map(nothing));
    let (place, variable) = (Score::is_at_place, Score::is_over_variable);
    row("out of catalogue: place right", "–", &mut unnamed().map(place));
    row("out of catalogue: variable right", "–", &mut unnamed().map(variable));
    let both = |score: &Score| place(score) && variable(score);
    row("out of catalogue: location and variable right", "≥ 85 %", &mut unnamed().map(both));
    let frequency = &mut unnamed().filter_map(|score| score.frequency_right);
    row("out of catalogue: frequency right, where one is reported", "–", frequency);
    row("sensor or plant", "≥ 95 %", &mut scores.iter().filter_map(|score| score.sensor_or_plant));
    let each = |(hits, of): (usize, usize)| (0..of).map(move |k| k < hits);
    row("95 % intervals that cover", "90–98 %", &mut scores.iter().flat_map(|score| each(score.covered)));
    let mut base = scores.iter().flat_map(|score| each(score.base_covered));
    row("the same of nominal parameters", "90–98 %", &mut base);
    let gains: Vec<Gain> = scores.iter().filter_map(|score| score.gained).collect();
    let sum = |of: fn(&Gain) -> f64| gains.iter().map(of).sum::<f64>();
    let oracles = [
        ("Φ gained on validation data, of an oracle's", "≥ 90 %", sum(|it| it.recorded)),
        ("the same of one that knows the inputs without noise", "–", sum(|it| it.exact)),
    ];
    for (name, wanted, oracle) in oracles.iter().filter(|it| it.2 > 0.0) {
        let percent = 100.0 * sum(|it| it.model) / oracle;
        writeln!(text, "| {name} | {wanted} | {percent:.1} % | {} | – |", gains.len())
            .expect("a string takes everything");
    }
    if !scores.is_empty() {
        let mean = scores.iter().map(|score| score.seconds).sum::<f64>() / scores.len() as f64;
        writeln!(text, "\nMean time of a diagnosis: {mean:.1} s.").expect("a string takes everything");
    }
    text + "\n" + &confusion(scores)
}

/// Which truth was called what, most frequent names first.
pub fn confusion(scores: &[Score]) -> String {
    let mut table: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for score in scores {
        *table.entry(&score.truth).or_default().entry(&score.first).or_default() += 1;
    }
    let mut text = "| truth | called first (times) |\n|---|---|\n".to_owned();
    for (truth, called) in table {
        let mut called: Vec<(&str, usize)> = called.into_iter().collect();
        called.sort_by_key(|(_, times)| std::cmp::Reverse(*times));
        let called: Vec<String> = called.iter().map(|(name, times)| format!("{name} ({times})")).collect();
        writeln!(text, "| {truth} | {} |", called.join(", ")).expect("a string takes everything");
    }
    text
}
