//! The audit of the paper: every verdict again, and that a wrong correction is noticed.

use validation::audit::{BUMPS, Paper, STATEMENT, Stationarity, Verdict, Which, bump, cone, refusal};

fn paper() -> Paper {
    Paper::new().unwrap_or_else(|e| panic!("{e:#}"))
}

/// An equation has a correction where it does not hold as printed, and nowhere else.
#[test]
fn every_equation_holds_as_printed_or_as_corrected() {
    let paper = paper();
    for number in paper.numbers() {
        let finding = paper.check(number).unwrap_or_else(|e| panic!("{number}: {e:#}"));
        let corrected = !finding.corrected.lines.is_empty();
        match finding.verdict {
            Verdict::Definition => assert!(["(1)", "(2)"].contains(&number), "{number}"),
            Verdict::Holds => assert!(!corrected, "{number}: {finding:#?}"),
            Verdict::Misprint | Verdict::Incomplete => assert!(corrected && finding.corrected.holds(), "{finding:#?}"),
            Verdict::Open => panic!("{number}: {finding:#?}"),
        }
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

#[test]
fn every_other_reading_holds_or_not_as_is_known() {
    let data: toml::Table = include_str!("../audit/paper.toml").parse().expect("the paper's formulas");
    let list =
        |value: &toml::Value, key: &str| value.get(key).and_then(|list| list.as_array().cloned()).unwrap_or_default();
    let readings = list(&data.into(), "equation").iter().flat_map(|e| list(e, "variants")).collect::<Vec<_>>();
    let refuted = readings.iter().filter(|reading| reading.get("refuted").is_some());
    let refuted: Vec<&str> = refuted.map(|reading| reading["words"].as_str().expect("words")).collect();
    let paper = paper();
    let mut found = 0;
    for number in paper.numbers() {
        for variant in paper.check(number).expect(number).variants {
            let expected = !refuted.contains(&variant.words.as_str());
            assert_eq!(variant.form.holds(), expected, "{number}: {}: {:?}", variant.words, variant.form.lines);
            found += usize::from(!expected);
        }
    }
    assert_eq!((found, refuted.len()), (15, 15));
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

#[test]
fn bumps_vanish_at_both_ends_with_their_derivatives() {
    let span = [0.5, 2.0];
    for k in 0..BUMPS {
        for t in span {
            let [value, slope, _] = bump(k, span, t);
            assert!(value.abs() < 1e-14 && slope.abs() < 1e-13, "{k}: {value} {slope}");
        }
        let h = 1e-4;
        let [before, now, after] = [1.0 - h, 1.0, 1.0 + h].map(|t| bump(k, span, t));
        assert!(((after[0] - before[0]) / (2.0 * h) - now[1]).abs() < 1e-5, "{k}");
        assert!(((after[1] - before[1]) / (2.0 * h) - now[2]).abs() < 1e-4, "{k}");
    }
}
