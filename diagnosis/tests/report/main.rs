//! The report: whole pages of every verdict.

mod samples;
mod simulation;

use std::path::Path;

use proptest::prelude::*;
use strut_diagnosis::report;
use strut_diagnosis::report::findings::{Evidence, Findings, Verdict};
use unicode_width::UnicodeWidthStr;

use samples::{VERDICTS, empty, sample};

/// The page as XML; the void elements of HTML are closed for that.
fn parsed(page: &str) -> Result<(), String> {
    let open = page.split('<').filter(|tag| tag.starts_with("meta"));
    let mut text = page.to_owned();
    for tag in open.collect::<Vec<_>>() {
        let tag = tag.split('>').next().unwrap_or_default();
        text = text.replace(&format!("<{tag}>"), &format!("<{tag}/>"));
    }
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(&text, options)
        .map(drop)
        .map_err(|error| format!("{error}\n{page}"))
}

fn check(findings: &Findings) -> Result<(), String> {
    let page = report::html(findings);
    parsed(&page)?;
    for odd in ["NaN", "=\"inf", "-inf"] {
        if let Some(place) = page.find(odd) {
            let around: String = page[..place].chars().rev().take(100).collect();
            return Err(format!("the page contains {}{odd}", around.chars().rev().collect::<String>()));
        }
    }
    serde_json::from_str::<serde_json::Value>(&report::json(findings)).map_err(|error| error.to_string())?;
    match report::terminal(findings).lines().find(|line| line.width() > 100) {
        Some(line) => Err(format!("wider than the terminal: {line}")),
        None => Ok(()),
    }
}

#[test]
fn every_verdict_gives_a_page_that_is_well_formed_small_and_needs_no_other() {
    for verdict in VERDICTS {
        let findings = sample(verdict);
        check(&findings).unwrap();
        let page = report::html(&findings);
        assert!(page.len() < 2_000_000, "{verdict:?}: {} bytes", page.len());
        for outside in ["<script", "<link", "<img", "src=", "url(", "@import"] {
            assert!(!page.contains(outside), "{verdict:?}: {outside}");
        }
        // The pages stay there to be looked at.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{verdict:?}"));
        report::write(&findings, &folder).unwrap();
        assert_eq!(std::fs::read_to_string(folder.join("report.html")).unwrap(), page);
        let summary = report::terminal(&findings);
        std::fs::write(folder.join("terminal.txt"), &summary).unwrap();
        assert!(summary.lines().count() <= 32, "{summary}");
    }
}

#[test]
fn empty_findings_give_a_page() {
    for verdict in VERDICTS {
        check(&empty(verdict)).unwrap();
    }
}

#[test]
fn names_are_text_and_not_markup() {
    let odd = "<b>&\"'\u{1b}[2J\u{0}名前".to_owned();
    let mut findings = sample(Verdict::Named);
    findings.rig.clone_from(&odd);
    findings.test = vec![odd.clone()];
    findings.effects[0].name.clone_from(&odd);
    findings.effects[0].element.clone_from(&odd);
    findings.effects[0].ambiguous_with = vec![odd.clone()];
    findings.effects[0].equation.clone_from(&odd);
    findings.signals[0].name = odd.repeat(20);
    findings.pictures.traces[0].signal.clone_from(&odd);
    findings.pictures.scatters[0].variable.clone_from(&odd);
    findings.data_problems[0].text = odd.repeat(30);
    findings.candidates[0].outcome = odd;
    check(&findings).unwrap();
    let page = report::html(&findings);
    assert!(!page.contains("<b>") && page.contains("&lt;b&gt;&amp;"));
    assert!(!report::terminal(&findings).contains(['\u{1b}', '\u{0}']));
}

#[test]
fn the_page_says_what_the_findings_say() {
    let named = report::html(&sample(Verdict::Named));
    for text in ["Coulomb friction in the strut", "t = 7.31", "56.2", "54.8 … 57.6", "F_c tanh"] {
        assert!(named.contains(text), "{text}");
    }
    let ambiguous = report::html(&sample(Verdict::Ambiguous));
    for text in ["Guide friction in the body’s guide", "Stribeck friction", "Lock the wheel"] {
        assert!(ambiguous.contains(text), "{text}");
    }
    let mut several = sample(Verdict::Ambiguous);
    several.effects.extend(sample(Verdict::Named).effects.into_iter().filter(|effect| effect.id != "01"));
    let several = report::html(&several);
    assert!(
        several.contains("cogging in the actuator; and Coulomb friction in the strut, guide friction in the")
    );
    let nothing = report::html(&sample(Verdict::NoEffect));
    for text in ["Seen for certain from", "3.10 N", "Bump stop in the strut: not excited"] {
        assert!(nothing.contains(text), "{text}");
    }
}

#[test]
fn what_was_fitted_along_is_told_apart_from_the_causes() {
    let mut findings = sample(Verdict::Named);
    assert!(!report::html(&findings).contains("What was fitted along"));
    findings.common = findings.effects.split_off(1);
    let page = report::html(&findings);
    let (_, along) = page.split_once("What was fitted along").unwrap();
    assert!(along.contains("<li>Cogging in the actuator (actuator.cogging.amplitude = 11.40 N)</li>"));
    let terminal = report::terminal(&findings);
    let told = "Fitted along, as every rig has a little of it: cogging in the actuator";
    assert!(terminal.contains(told), "{terminal}");
}

#[test]
fn the_numbers_beside_the_headline_are_of_all_signals() {
    let mut findings = sample(Verdict::Named);
    for (signal, (before, after)) in
        findings.signals.iter_mut().zip([(0.2, 0.9), (0.6, 0.7), (f64::NAN, 0.1)])
    {
        (signal.phi_before, signal.phi_after) = (before, after);
        (signal.rms_before, signal.rms_after, signal.noise_floor) = (2.0, 1.0 + after, 0.5);
    }
    let page = report::html(&findings);
    let text: String =
        page.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect();
    for fact in ["mean of 2 signals0.40 → 0.80", "× noise floor2.2 … 3.8", "Held-out evidencet = 7.31"] {
        assert!(text.contains(fact), "{fact}");
    }
    findings.signals.iter_mut().for_each(|signal| signal.noise_floor = 1e-9);
    assert!(report::html(&findings).contains("&gt; 1000"));
}

#[test]
fn the_schematic_shows_the_rig_at_hand() {
    let of = |elements: &[&str]| {
        let mut findings = sample(Verdict::Named);
        findings.candidates.retain(|candidate| elements.contains(&candidate.element.as_str()));
        findings.effects.retain(|effect| elements.contains(&effect.element.as_str()));
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{}", elements[0]));
        report::write(&findings, &folder).unwrap();
        report::html(&findings)
    };
    for (elements, shown) in [
        (&["tire", "strut"][..], &["body", "wheel", "tyre", "strut"][..]),
        (&["strut"], &["crosshead", "shaker", "strut"]),
        (&["actuator"], &["carriage", "frame", "actuator"]),
    ] {
        let page = of(elements);
        for label in
            ["body", "wheel", "tyre", "strut", "actuator", "crosshead", "shaker", "carriage", "frame"]
        {
            let drawn = page.contains(&format!(">{label}</text>"));
            let expected = shown.contains(&label) || (label == "actuator" && elements[0] == "tire");
            assert_eq!(drawn, expected, "{label} for {elements:?}");
        }
    }
}

#[test]
fn a_balance_tells_what_it_says_and_one_that_cannot_be_formed_what_it_needs() {
    let text = |findings: &Findings| -> String {
        let page = report::html(findings);
        page.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect()
    };
    let named = sample(Verdict::Named);
    for words in [
        "r1 forces on the body ✗ 45 × noise → ✓ holds",
        "rms: start 54.3, fitted 54.2, extended 1.60, noise 1.20 N",
        "If it does not hold: the strut has a law that the model lacks.",
        "r4 kinematics cannot be formed: it needs the wheel’s acceleration.",
    ] {
        assert!(text(&named).contains(words), "{words}: {}", text(&named));
    }
    let mut left = named.clone();
    left.pictures.parity[0].rms_after = 12.0;
    assert!(text(&left).contains("r1 forces on the body ✗ 45 × noise → ✗ 10 × noise"));
    let mut none = named;
    none.pictures.parity.clear();
    assert!(!text(&none).contains("Which balances hold"));
}

#[test]
fn the_page_tells_noise_from_what_is_driven() {
    let mut findings = sample(Verdict::Named);
    let page = report::html(&findings);
    for words in ["Yes, as far as can be told", "rebound stop", "largest errors left"] {
        assert!(page.contains(words), "{words}");
    }
    assert_eq!(page.matches("Is it driven by").count(), findings.pictures.coherences.len());
    for periodogram in &mut findings.pictures.periodograms {
        periodogram.distance_after = 0.3;
    }
    for trace in &mut findings.pictures.traces {
        trace.marks.clear();
    }
    let page = report::html(&findings);
    assert!(page.contains("No: 0.30 off, chance makes 0.021"));
    assert!(!page.contains("Yes, as far as can be told"));
    assert!(!page.contains("rebound stop") && !page.contains("largest errors left"));
}

#[test]
fn a_gate_that_is_not_passed_is_marked_and_one_that_need_not_be_says_why() {
    let mut findings = sample(Verdict::Named);
    let shown =
        |findings: &Findings| ["not passed", "not asked for"].map(|it| report::html(findings).contains(it));
    assert_eq!(shown(&findings), [false, false]);
    findings.effects[0].evidence.held_out_t = Evidence::REQUIRED.held_out_t;
    findings.effects[0].evidence.explained = 0.2;
    assert_eq!(shown(&findings), [true, false]);
    findings.effects[0].evidence.explained = 0.5;
    assert!(findings.effects[0].evidence.refusal().is_none());
    assert_eq!(shown(&findings), [false, true]);
    findings.effects[0].evidence =
        Evidence { explained: 1e-3, grave: true, ..sample(Verdict::Named).effects[0].evidence };
    assert!(findings.effects[0].evidence.refusal().is_none());
    assert_eq!(shown(&findings), [false, true]);
    assert!(report::html(&findings).contains("a signal that is so late matters"));
}

#[test]
fn without_a_curve_the_nearest_law_is_told_as_such() {
    let mut findings = sample(Verdict::Unnamed);
    findings.nearest = sample(Verdict::Named).effects;
    let curve = findings.unnamed.as_mut().unwrap();
    for list in [&mut curve.x, &mut curve.y, &mut curve.low, &mut curve.high] {
        list.clear();
    }
    check(&findings).unwrap();
    let page = report::html(&findings);
    assert!(page.contains("Nearest comes") && page.contains(&findings.nearest[0].name), "{page}");
    assert!(!page.contains("with its 95 % band"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report-Nearest");
    report::write(&findings, &folder).unwrap();
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error_with_advice() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let error = report::write(&empty(Verdict::NoEffect), &file.path().join("report")).unwrap_err();
    assert!(error.to_string().contains("choose another with --out"), "{error}");
}

#[test]
fn a_report_replaces_an_older_one_and_leaves_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    for verdict in [Verdict::NoEffect, Verdict::BadData] {
        report::write(&empty(verdict), folder.path()).unwrap();
    }
    let mut names: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["report.html", "report.json"]);
    let json = std::fs::read_to_string(folder.path().join("report.json")).unwrap();
    assert!(json.contains("\"bad_data\""));
}

/// Every key of an object, with those of the objects within.
fn keys(value: &serde_json::Value, found: &mut std::collections::BTreeSet<String>) {
    match value {
        serde_json::Value::Object(fields) => {
            for (key, value) in fields {
                found.insert(key.clone());
                keys(value, found);
            }
        }
        serde_json::Value::Array(items) => items.iter().for_each(|item| keys(item, found)),
        _ => {}
    }
}

#[test]
fn every_field_and_verdict_is_described_in_the_readme() {
    let readme = include_str!("../../README.md");
    let section = readme.split("## report.json, version 1").nth(1).expect("the section on report.json");
    let mut found = std::collections::BTreeSet::new();
    for verdict in VERDICTS {
        let value: serde_json::Value = serde_json::from_str(&report::json(&sample(verdict))).unwrap();
        assert_eq!(value["format"], 1);
        assert!(
            section.contains(&format!("`{}`", value["verdict"].as_str().unwrap())),
            "{}",
            value["verdict"]
        );
        keys(&value, &mut found);
    }
    let required = Evidence::REQUIRED;
    for (gate, limit) in [
        ("delta_bic", required.delta_bic),
        ("block_t", required.block_t),
        ("chance", required.chance),
        ("held_out_t", required.held_out_t),
        ("explained", required.explained),
        ("phi_gain", required.phi_gain),
        ("taken", required.taken),
    ] {
        assert!(section.contains(&format!("| `{gate}` | 1 | {limit} |")), "the limit of {gate}");
    }
    let usual = Evidence::REQUIRED_OF_USUAL;
    let more = format!("`phi_gain` has to exceed {} or `taken` {}", usual.phi_gain, usual.taken);
    assert!(section.contains(&more), "{more}");
    assert!(found.len() > 60, "{found:?}");
    for key in found {
        assert!(section.contains(&format!("`{key}`")), "{key} is not described");
    }
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(f64::NEG_INFINITY),
        Just(0.0),
        Just(f64::MAX),
        Just(f64::MIN_POSITIVE),
        -10.0..10.0,
    ]
}

/// The findings with each of their numbers replaced.
fn with_numbers(mut findings: Findings, numbers: &[f64]) -> Findings {
    let mut cycle = numbers.iter().copied().cycle();
    let mut next = || cycle.next().unwrap_or_default();
    for effect in &mut findings.effects {
        for parameter in &mut effect.parameters {
            (parameter.value, parameter.low, parameter.high) = (next(), next(), next());
        }
        let evidence = &mut effect.evidence;
        (evidence.delta_bic, evidence.block_t, evidence.held_out_t) = (next(), next(), next());
        (evidence.chance, evidence.explained) = (next(), next());
        (evidence.phi_gain, evidence.taken) = (next(), next());
    }
    for parameter in &mut findings.base_parameters {
        (parameter.before, parameter.after, parameter.low, parameter.high) = (next(), next(), next(), next());
    }
    for signal in &mut findings.signals {
        (signal.phi_before, signal.phi_fitted, signal.phi_after) = (next(), next(), next());
        signal.phi_quiet = next();
        (signal.rms_before, signal.rms_fitted, signal.rms_after) = (next(), next(), next());
        (signal.noise_floor, signal.repeatability) = (next(), Some(next()));
    }
    for candidate in &mut findings.candidates {
        candidate.detectable = Some(next());
    }
    let mut fill = |values: &mut Vec<f64>, count: usize| {
        values.clear();
        values.extend((0..count).map(|_| next()));
    };
    // Lists of unequal lengths must not panic either.
    if let Some(curve) = &mut findings.unnamed {
        let lists = [&mut curve.x, &mut curve.y, &mut curve.low, &mut curve.high];
        lists.into_iter().zip([9, 9, 9, 4]).for_each(|(list, count)| fill(list, count));
    }
    for trace in &mut findings.pictures.traces {
        let lists = [&mut trace.time, &mut trace.measured, &mut trace.before, &mut trace.after];
        lists.into_iter().zip([30, 31, 30, 7]).for_each(|(list, count)| fill(list, count));
    }
    for spectrum in &mut findings.pictures.spectra {
        let lists =
            [&mut spectrum.frequency, &mut spectrum.measured, &mut spectrum.before, &mut spectrum.after];
        lists.into_iter().zip([20, 20, 3, 0]).for_each(|(list, count)| fill(list, count));
    }
    for trace in &mut findings.pictures.traces {
        for mark in &mut trace.marks {
            let mut ends = Vec::new();
            fill(&mut ends, 2);
            (mark.from, mark.to) = (ends[0], ends[1]);
        }
    }
    for coherence in &mut findings.pictures.coherences {
        fill(&mut coherence.frequency, 20);
        let mut list = Vec::new();
        fill(&mut list, 30);
        coherence.before = list[..20].iter().copied().map(Some).collect();
        coherence.after = list[20..].iter().copied().map(Some).collect();
        coherence.limit = list[0];
    }
    for periodogram in &mut findings.pictures.periodograms {
        let lists = [&mut periodogram.frequency, &mut periodogram.before, &mut periodogram.after];
        lists.into_iter().zip([20, 21, 9]).for_each(|(list, count)| fill(list, count));
        (periodogram.distance_before, periodogram.distance_after) =
            (periodogram.before[0], periodogram.after[0]);
        periodogram.limit = periodogram.before[1];
    }
    for parity in &mut findings.pictures.parity {
        let lists = [&mut parity.time, &mut parity.before, &mut parity.after];
        lists.into_iter().zip([20, 21, 9]).for_each(|(list, count)| fill(list, count));
        (parity.rms_before, parity.rms_fitted, parity.rms_after) =
            (parity.before[0], parity.before[1], parity.before[2]);
        (parity.noise, parity.band) = (parity.before[3], parity.before[4]);
    }
    for scatter in &mut findings.pictures.scatters {
        fill(&mut scatter.x, 31);
        let mut list = Vec::new();
        fill(&mut list, 93);
        scatter.rising = list[..31].iter().copied().map(Some).collect();
        scatter.falling = list[31..62].iter().copied().map(Some).collect();
        scatter.two_sigma = list[62..80].iter().copied().map(Some).collect();
    }
    findings.seconds = numbers.first().copied().unwrap_or_default();
    findings
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn no_number_breaks_a_report(numbers in prop::collection::vec(number(), 1..40)) {
        static SAMPLES: std::sync::LazyLock<[Findings; 2]> =
            std::sync::LazyLock::new(|| [sample(Verdict::Named), sample(Verdict::Unnamed)]);
        for findings in SAMPLES.iter() {
            let findings = with_numbers(findings.clone(), &numbers);
            check(&findings).map_err(TestCaseError::fail)?;
        }
    }
}
