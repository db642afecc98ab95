//! The audit of the paper: every verdict again, and that a wrong correction is noticed.

use validation::audit::{Paper, STATEMENT, Stationarity, Verdict, Which, cone, refusal};

fn paper() -> Paper {
    Paper::new().unwrap_or_else(|e| panic!("{e:#}"))
}

const MISPRINTS: [&str; 16] = [
    "δI",
    "motion, x",
    "(8)",
    "(12)",
    "(16)",
    "(17)",
    "(19)",
    "(21)",
    "(24)",
    "(25)",
    "(26)",
    "(27)",
    "(28)",
    "after (28)",
    "(31)",
    "(32)",
];
const INCOMPLETE: [&str; 8] = ["a", "C", "(29)", "(30)", "(33)", "(34)", "(35)", "(35) to (34)"];
const DEFINITIONS: [&str; 2] = ["(1)", "(2)"];

#[test]
fn every_equation_has_the_verdict_that_is_known() {
    let paper = paper();
    for number in paper.numbers() {
        let finding = paper.check(number).unwrap_or_else(|e| panic!("{number}: {e:#}"));
        let expected = match number {
            n if MISPRINTS.contains(&n) => Verdict::Misprint,
            n if INCOMPLETE.contains(&n) => Verdict::Incomplete,
            n if DEFINITIONS.contains(&n) => Verdict::Definition,
            _ => Verdict::Holds,
        };
        assert_eq!(finding.verdict, expected, "{number}: {finding:#?}");
        assert!(expected == Verdict::Holds || expected == Verdict::Definition || finding.corrected.holds());
    }
}

#[test]
fn every_numbered_equation_is_there() {
    let paper = paper();
    let numbers = paper.numbers();
    for k in 1..=35 {
        assert!(numbers.contains(&format!("({k})").as_str()), "({k})");
    }
}

/// Readings that do not hold; all others do.
const REFUTED: [&str; 15] = [
    "(3) of the sledge, for displacements with (2) throughout",
    "the printed L, with that r",
    "the corrected (26), from (18), (22), (23) without (25)",
    "first operator, β free of ü",
    "first operator, β with ü",
    "first operator, sign turned, β with ü",
    "first on both; β free of ü",
    "second on both; β free of ü",
    "second on both, all signs turned; β free of ü",
    "second on L, first on β, all signs turned; β free of ü",
    "first on both; β with ü",
    "first operator everywhere",
    "second operator everywhere, all signs turned",
    "completed, β with ü",
    "as printed; φ and β free of ü",
];

#[test]
fn every_other_reading_holds_or_not_as_is_known() {
    let paper = paper();
    let mut refuted = 0;
    for number in paper.numbers() {
        for variant in paper.check(number).expect(number).variants {
            let expected = !REFUTED.contains(&variant.words.as_str());
            assert_eq!(variant.form.holds(), expected, "{number}: {}: {:?}", variant.words, variant.form.lines);
            refuted += usize::from(!expected);
        }
    }
    assert_eq!(refuted, REFUTED.len());
}

/// `line` with one sign, function or trailing factor changed, in every way.
fn mutations(line: &str) -> Vec<String> {
    let mut all = Vec::new();
    let bytes = line.as_bytes();
    for (i, byte) in line.bytes().enumerate() {
        let binary = i > 0 && bytes[i - 1] == b' ' && bytes.get(i + 1) == Some(&b' ');
        let other = match byte {
            b'+' if binary => "-",
            b'-' if binary => "+",
            _ => continue,
        };
        all.push(format!("{}{other}{}", &line[..i], &line[i + 1..]));
    }
    for (name, other) in [("sin(", "cos("), ("cos(", "sin("), ("csc(", "sec("), ("cot(", "tan(")] {
        for (i, _) in line.match_indices(name) {
            let letter = i > 0 && bytes[i - 1].is_ascii_alphabetic();
            if !letter {
                all.push(format!("{}{other}{}", &line[..i], &line[i + name.len()..]));
            }
        }
    }
    all
}

#[test]
fn a_wrong_correction_does_not_pass() {
    let paper = paper();
    let mut tried = 0;
    for number in paper.numbers() {
        let finding = paper.check(number).expect(number);
        let which = match finding.verdict {
            Verdict::Holds => Which::Printed,
            Verdict::Definition => continue,
            _ => Which::Corrected,
        };
        let lines = paper.lines(number, which).expect(number);
        // terms of these are zero by themselves
        if ["(30)", "(35) to (34)"].contains(&number) || number.starts_with("(34), example") {
            continue;
        }
        for (i, line) in lines.iter().enumerate() {
            for wrong in mutations(line) {
                let mut changed = lines.clone();
                changed[i] = wrong.clone();
                let residuals = paper.try_lines(number, which, &changed).expect(number);
                assert!(!residuals[i].is_zero(), "{number}: `{wrong}` passes as well as `{line}`");
                tried += 1;
            }
        }
    }
    println!("{tried} wrong formulas noticed");
    assert!(tried > 300, "{tried}");
}

#[test]
fn action_is_stationary_on_the_motion_of_g_only() {
    let found = Stationarity::new(&paper()).unwrap_or_else(|e| panic!("{e:#}"));
    for reading in &found.readings {
        println!("{}: order {}, {:.3e}", reading.name, reading.order, reading.largest());
        if reading.name == STATEMENT {
            assert!(reading.largest() < 1e-9, "{reading:?}");
        } else {
            assert!(reading.largest() > 1e-3, "{reading:?}");
        }
    }
    assert!(found.gap < 1e-9, "{}", found.gap);
    for [measured, printed, corrected] in found.sledge {
        assert!((measured - corrected).abs() < 1e-8, "{measured} {corrected}");
        assert!((measured - printed).abs() > 1e-2, "{measured} {printed}");
    }
}

#[test]
fn written_examples_are_the_derived_equations() {
    let cone = cone().unwrap_or_else(|e| panic!("{e:#}"));
    assert_eq!(cone.residuals.len(), 4);
    assert!(cone.residuals.iter().all(|r| r.is_zero()), "{:?}", cone.residuals);
    for group in paper().written().unwrap_or_else(|e| panic!("{e:#}")) {
        assert!(group.form.holds(), "{group:#?}");
    }
}

#[test]
fn the_papers_parameters_of_example_3_are_refused() {
    let words = refusal().unwrap_or_else(|e| panic!("{e:#}"));
    assert!(words.contains("u''") && words.contains('1'), "{words}");
}

#[test]
fn the_equation_of_motion_holds_along_the_computed_motion() {
    let finding = paper().check("motion, x").expect("there");
    let [printed, corrected] = finding.along.expect("along a motion");
    assert!(printed[0] > 1.0 && corrected.iter().all(|r| *r < 1e-5), "{printed:?} {corrected:?}");
}
