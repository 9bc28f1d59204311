//! The report: whole pages of every verdict.

mod account;
mod numbers;
mod samples;
mod simulation;

use std::path::Path;

use strut_diagnosis::report;
use strut_diagnosis::report::findings::{Candidate, Evidence, Findings, Verdict};
use strut_words::Scope;
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
    let mut findings = sample(Verdict::Identified);
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
    let named = report::html(&sample(Verdict::Identified));
    for text in ["Coulomb friction in the strut", "t = 7.31", "56.2", "54.8 … 57.6", "F_c tanh"] {
        assert!(named.contains(text), "{text}");
    }
    let ambiguous = report::html(&sample(Verdict::Ambiguous));
    for text in [
        "Guide friction in the body’s guide",
        "Stribeck friction",
        "Drive road.position with a chirp of",
        "guide friction in the body’s guide, not from Stribeck friction in the strut.",
        "Road: kind = Chirp, amplitude = 0.00612 m, chirp.start_frequency",
        "71 %",
    ] {
        assert!(ambiguous.contains(text), "{text}: {ambiguous}");
    }
    let terminal = report::terminal(&sample(Verdict::Ambiguous));
    for text in ["Next experiment: Drive road.position", "99.9 % (d' = 8.2, records 0.50)", "71 %"] {
        assert!(terminal.contains(text), "{text}: {terminal}");
    }
    let mut several = sample(Verdict::Ambiguous);
    several
        .effects
        .extend(sample(Verdict::Identified).effects.into_iter().filter(|effect| effect.id != "01"));
    let several = report::html(&several);
    assert!(several.contains(
        "cogging in the actuator. It also lacks Coulomb friction in the strut, guide friction in the"
    ));
    let nothing = report::html(&sample(Verdict::NoEffect));
    for text in ["no effect", "Next experiment", "drive over a bump of 40 mm"] {
        assert!(nothing.contains(text), "{text}");
    }
}

/// Words of older reports that an engineer does not use; the list is that of all pages.
#[test]
fn no_report_uses_words_that_are_out_of_use() {
    for verdict in VERDICTS {
        let findings = sample(verdict);
        let page = report::html(&findings);
        let (_, body) = page.split_once("<body").unwrap();
        let text: String =
            body.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect();
        for text in [text, report::terminal(&findings)] {
            let found = strut_words::found(&text, &[Scope::Everywhere, Scope::Guides, Scope::Report]);
            assert!(found.is_empty(), "{verdict:?}: {found:?}");
        }
    }
}

#[test]
fn the_numbers_beside_the_headline_are_of_all_signals() {
    let mut findings = sample(Verdict::Identified);
    for (signal, (before, after)) in
        findings.signals.iter_mut().zip([(0.2, 0.9), (0.6, 0.7), (f64::NAN, 0.1)])
    {
        (signal.fit_before, signal.fit_after) = (before, after);
        (signal.rms_before, signal.rms_after, signal.noise_floor) = (2.0, 1.0 + after, 0.5);
    }
    let page = report::html(&findings);
    let text: String =
        page.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect();
    for fact in ["mean of 2 signals0.40 → 0.80", "× sensor noise2.2 … 3.8", "Validationt = 7.31"] {
        assert!(text.contains(fact), "{fact}");
    }
    findings.signals.iter_mut().for_each(|signal| signal.noise_floor = 1e-9);
    assert!(report::html(&findings).contains("&gt; 1000"));
}

#[test]
fn the_schematic_shows_the_rig_at_hand() {
    let of = |elements: &[&str]| {
        let mut findings = sample(Verdict::Identified);
        let candidate = findings.candidates[0].clone();
        let at = |element: &&str| Candidate { element: (*element).into(), ..candidate.clone() };
        findings.candidates = elements.iter().map(at).collect();
        findings.effects.retain(|effect| elements.contains(&effect.element.as_str()));
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{}", elements[0]));
        report::write(&findings, &folder).unwrap();
        report::html(&findings)
    };
    for (elements, shown) in [
        (&["tire", "strut"][..], &["body", "wheel", "tyre", "strut"][..]),
        (&["strut"], &["upper end", "lower end", "strut"]),
        (&["guide", "strut"], &["body", "base", "strut"]),
        (&["actuator"], &["carriage", "frame", "actuator"]),
    ] {
        let page = of(elements);
        for label in [
            "body",
            "wheel",
            "base",
            "tyre",
            "strut",
            "actuator",
            "upper end",
            "lower end",
            "carriage",
            "frame",
        ] {
            let drawn = page.contains(&format!(">{label}</text>"));
            let expected = shown.contains(&label) || (label == "actuator" && elements[0] == "tire");
            assert_eq!(drawn, expected, "{label} for {elements:?}");
        }
    }
}

#[test]
fn a_balance_has_its_residual_and_one_without_has_its_needs() {
    let text = |findings: &Findings| -> String {
        let page = report::html(findings);
        page.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect()
    };
    let named = sample(Verdict::Identified);
    for words in [
        "r1 forces on the body ✗ 45 × noise → ✓ holds",
        "rms: start 54.3, fitted 54.2, extended 1.60, noise 1.20 N",
        "If it does not hold: the strut has a law that the model lacks.",
        "r4 kinematics is not available; it needs the wheel’s acceleration.",
    ] {
        assert!(text(&named).contains(words), "{words}: {}", text(&named));
    }
    let mut left = named.clone();
    left.pictures.parity[0].rms_after = 12.0;
    assert!(text(&left).contains("r1 forces on the body ✗ 45 × noise → ✗ 10 × noise"));
    let mut none = named;
    none.pictures.parity.clear();
    assert!(!text(&none).contains("Balances"));
}

#[test]
fn the_page_separates_noise_from_driven_errors() {
    let mut findings = sample(Verdict::Identified);
    let page = report::html(&findings);
    for words in ["Yes, within the band", "rebound stop", "largest remaining errors"] {
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
    assert!(page.contains("No: distance 0.30, limit 0.021"));
    assert!(!page.contains("Yes, within the band"));
    assert!(!page.contains("rebound stop") && !page.contains("largest remaining errors"));
}

#[test]
fn a_gate_that_is_not_passed_is_marked_and_one_that_need_not_be_says_why() {
    let mut findings = sample(Verdict::Identified);
    let shown =
        |findings: &Findings| ["not passed", "not required"].map(|it| report::html(findings).contains(it));
    assert_eq!(shown(&findings), [false, false]);
    findings.effects[0].evidence.validation_t = Evidence::REQUIRED.validation_t;
    findings.effects[0].evidence.variance_explained = 0.2;
    assert_eq!(shown(&findings), [true, false]);
    findings.effects[0].evidence.variance_explained = 0.5;
    assert!(findings.effects[0].evidence.refusal().is_none());
    assert_eq!(shown(&findings), [false, true]);
    findings.effects[0].evidence =
        Evidence { variance_explained: 1e-3, ..sample(Verdict::Identified).effects[0].evidence };
    assert!(findings.effects[0].evidence.refusal().is_none());
    assert_eq!(shown(&findings), [false, true]);
    assert!(report::html(&findings).contains("the fit of a signal rises visibly"));
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error_with_advice() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let error = report::write(&empty(Verdict::NoEffect), &file.path().join("report")).unwrap_err();
    assert!(error[0].to_string().contains("choose another with --out"), "{error:?}");
}

#[test]
fn a_report_replaces_an_older_one_and_leaves_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    for verdict in [Verdict::NoEffect, Verdict::BadData] {
        report::write(&empty(verdict), folder.path()).unwrap();
        // The extended model of that run would pass for the next one's.
        for name in ["extended.toml", "extended.ssv", "extended.fmu", "augmented.ssp"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
    }
    report::write(&empty(Verdict::BadData), folder.path()).unwrap();
    let mut names: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["report.html", "report.json"]);
    let json = std::fs::read_to_string(folder.path().join("report.json")).unwrap();
    assert!(json.contains("\"bad_data\""));
    let findings = sample(Verdict::Ambiguous);
    report::write(&findings, folder.path()).unwrap();
    let table = std::fs::read_to_string(folder.path().join("experiment.csv")).unwrap();
    assert_eq!(table, findings.deciding_experiment.unwrap().files[0].1);
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
fn every_field_and_verdict_is_described_on_its_page() {
    let page = include_str!("../../../docs/report.md");
    let section = page.split("## report.json, version 3").nth(1).expect("the section on report.json");
    let mut found = std::collections::BTreeSet::new();
    for verdict in VERDICTS {
        let value: serde_json::Value = serde_json::from_str(&report::json(&sample(verdict))).unwrap();
        assert_eq!(value["format"], 3);
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
        ("estimation_t", required.estimation_t),
        ("p_value", required.p_value),
        ("validation_t", required.validation_t),
        ("validation_p_value", required.validation_p_value),
        ("variance_explained", required.variance_explained),
        ("fit_improvement", required.fit_improvement),
        ("residual_reduction", required.residual_reduction),
    ] {
        assert!(section.contains(&format!("| `{gate}` | 1 | {limit} |")), "the limit of {gate}");
    }
    let usual = Evidence { background: true, ..Evidence::default() }.required();
    let more = format!(
        "`fit_improvement` has to exceed {} or `residual_reduction` {}",
        usual.fit_improvement, usual.residual_reduction
    );
    assert!(section.contains(&more), "{more}");
    assert!(found.len() > 60, "{found:?}");
    for key in found {
        assert!(section.contains(&format!("`{key}`")), "{key} is not described");
    }
}
