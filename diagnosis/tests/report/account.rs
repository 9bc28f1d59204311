//! The account, the missing signal and the unmodelled rest.

use strut_diagnosis::report;
use strut_diagnosis::report::findings::Verdict;

use super::samples::sample;

#[test]
fn every_signal_has_a_bar_whose_parts_are_named_once() {
    let mut findings = sample(Verdict::Identified);
    let page = report::html(&findings);
    let account = page.split_once("Where the error goes").unwrap().1.split_once("<section").unwrap().0;
    assert_eq!(account.matches("role=\"img\"").count(), findings.account.len());
    assert_eq!(account.matches("class=\"key ").count(), 5, "{account}");
    for text in [
        "Account of body.acceleration: sensor noise",
        "Coulomb friction in the strut",
        "makes the signal worse",
    ] {
        assert!(account.contains(text), "{text}: {account}");
    }
    // Of a bar with parts that make the signal worse, the positive ones fill it.
    for bar in account.split("role=\"img\"").skip(1) {
        let bar = bar.split("</div>").next().unwrap();
        let widths =
            bar.split("width:").skip(1).map(|it| it.split('%').next().unwrap().parse::<f64>().unwrap());
        let total: f64 = widths.sum();
        assert!((total - 100.0).abs() < 0.1, "{total}");
    }
    assert!(!account.contains("till unexplained:"));
    findings.account[0].open = true;
    assert!(report::html(&findings).contains("till unexplained:"));
    findings.account.clear();
    assert!(!report::html(&findings).contains("Where the error goes"));
}

#[test]
fn the_missing_signal_has_a_place_and_what_cannot_be_told_from_it() {
    let mut findings = sample(Verdict::Unmodelled);
    let page = report::html(&findings);
    for text in
        ["The missing signal", "cannot tell it from actuator.force", "Over the velocity", "Over frequency"]
    {
        assert!(page.contains(text), "{text}");
    }
    // The first five places, and the number of the others.
    assert!(page.contains("2241") && page.contains("Further places: 1."));
    let missing = findings.missing.as_mut().unwrap();
    for list in [&mut missing.deflection, &mut missing.velocity] {
        list.clear();
    }
    let page = report::html(&findings);
    assert!(!page.contains("Over the velocity") && page.contains("Over frequency"));
    findings.missing = None;
    assert!(!report::html(&findings).contains("The missing signal"));
}

#[test]
fn an_unmodelled_signal_has_its_shares_and_its_curve_if_there_is_one() {
    let mut findings = sample(Verdict::Unmodelled);
    let page = report::html(&findings);
    for text in
        ["No effect of the catalogue explains it.", "88 %", "81 %", "17.3 Hz", "velocity and deflection"]
    {
        assert!(page.contains(text), "{text}");
    }
    assert!(page.contains("with its 95 % band"));
    findings.unmodelled[0].curve = None;
    assert!(!report::html(&findings).contains("with its 95 % band"));
    let terminal = report::terminal(&findings);
    assert!(terminal.contains("Unmodelled: a signal that follows the velocity"), "{terminal}");
}

#[test]
fn the_terminal_has_the_account_in_per_cent() {
    let findings = sample(Verdict::Identified);
    let terminal = report::terminal(&findings);
    let header = terminal.lines().find(|line| line.contains("rms error")).expect("the account's header");
    for column in ["signal", "noise", "parameters", "effects", "unmodelled", "unexplained"] {
        assert!(header.contains(column), "{column}: {header}");
    }
    assert!(terminal.contains("strut.coulomb.force = 56.2 N (95 %: 54.8 … 57.6)"), "{terminal}");
}
