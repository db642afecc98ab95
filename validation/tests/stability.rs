//! Stiff and extreme cases: every answer is counted once, and a wrong one is a complaint.

use validation::report::StabilityReport;
use validation::stability::{Answering, CASES, Cell, Verdict};

/// An answer with this verdict.
fn cell(verdict: Verdict) -> Cell {
    Cell {
        case: CASES[0].name,
        point: 1.0,
        formulation: "Newton".into(),
        method: Answering::Method(None),
        verdict,
        steps: 1,
    }
}

#[test]
fn every_answer_is_counted_once_by_its_word() {
    let verdicts = [
        Verdict::Accurate { error: 1e-9, estimate: 2e-9 },
        Verdict::Accurate { error: 3e-9, estimate: 4e-9 },
        Verdict::Accurate { error: 3e-9, estimate: 4e-9 },
        Verdict::Admitted { error: 0.5, estimate: 0.25 },
        Verdict::Admitted { error: 0.5, estimate: 0.25 },
        Verdict::Refused { t: Some(0.75), cause: "a pole".into() },
        Verdict::Wrong { error: 0.125, estimate: 1e-9, t: 0.5 },
    ];
    let report = StabilityReport { cells: verdicts.map(cell).into(), runs: Vec::new() };
    let headline = report.headline();
    let counts = " 3 are accurate, 2 inaccurate but flagged, 1 stopped with a reason.";
    assert!(
        headline.starts_with("One answer is silently wrong: of 7 answers of ") && headline.ends_with(counts),
        "{headline}"
    );
    assert_eq!(report.verdicts()["wrong"], 1);
    let text = report.text();
    for (word, count) in [("accurate", 3), ("admitted", 2), ("refused", 1), ("wrong", 1)] {
        let lines = text.lines().filter(|line| line.split_whitespace().any(|w| w == word)).count();
        assert_eq!((report.count(word), lines), (count, count), "{word}: {text}");
    }
    let last = text.lines().last().expect("lines");
    assert!(last.ends_with("at t = 5.000e-1: error 1.2e-1, estimate 1.0e-9"), "{last}");
}

#[test]
fn a_wrong_cell_is_a_complaint() {
    let report = |wrong: usize| {
        let verdict = |i: usize| match i < wrong {
            true => Verdict::Wrong { error: 0.125, estimate: 1e-9, t: 0.5 },
            false => Verdict::Accurate { error: 1e-9, estimate: 2e-9 },
        };
        StabilityReport { cells: (0..7).map(|i| cell(verdict(i))).collect(), runs: Vec::new() }
    };
    assert_eq!(report(0).complaint(), None);
    assert_eq!(report(2).complaint(), Some("2 of 7 cells are wrong".into()));
}
