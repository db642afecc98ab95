//! What is said of a growth beside the predicted one.

use comparison::{Growth, LeadingTerm};
use random::judged::judge_growth;
use random::{Findings, Word};

/// Parts of a limit.
const SIDES: [f64; 2] = [0.3, 3.0];

const PREDICTED: LeadingTerm =
    LeadingTerm { exponent: 2, coefficient: Vec::new(), length: 1.0, from: 1e-4, reach: 1.0, proved: true };

/// `t²`, seen from 10⁻² to 10⁻¹.
fn seen() -> Growth {
    let (exponent, coefficient, length, from, to) = (2.0, vec![1.0], 1.0, 1e-2, 1e-1);
    Growth { exponent, uncertainty: 0.0, coefficient, coefficient_uncertainty: 0.0, length, from, to }
}

/// What is said of `t²` where this was measured, on exponent and coefficient or on both together.
fn said(measured: &Growth) -> Vec<Word> {
    let mut found = Findings::default();
    let predicted = LeadingTerm { coefficient: vec![1.0], ..PREDICTED };
    judge_growth(&mut found, Some(measured), &predicted, false);
    // an exponent is counted where it is judged
    let judged = found.findings.iter().filter(|f| f.claim.starts_with("exponent")).count();
    assert_eq!(found.observations.len(), judged, "{found:?}");
    found.findings.iter().map(|finding| finding.word).collect()
}

fn word(is_over: bool, over: Word) -> Word {
    if is_over { over } else { Word::Holds }
}

#[test]
fn exponents_and_coefficients_may_be_off_by_a_hundredth_and_three_times_their_doubt() {
    for (part, doubt) in SIDES.into_iter().flat_map(|part| [0.0, 0.05].map(|doubt| (part, doubt))) {
        let off = part * (0.01 + 3.0 * doubt);
        let found = said(&Growth { exponent: 2.0 - off, uncertainty: doubt, ..seen() });
        assert_eq!(found, [word(part > 1.0, Word::Fails), Word::Holds], "{part}, {doubt}");
        let found = said(&Growth { coefficient: vec![1.0 + off], coefficient_uncertainty: doubt, ..seen() });
        assert_eq!(found, [Word::Holds, word(part > 1.0, Word::Fails)], "{part}, {doubt}");
    }
}

#[test]
fn what_is_uncertain_by_a_tenth_is_not_judged() {
    for part in SIDES {
        let exponent = said(&Growth { uncertainty: 0.1 * part, ..seen() });
        assert_eq!(exponent.contains(&Word::Undecided), part > 1.0, "{part}: {exponent:?}");
        assert_eq!(exponent.len(), if part > 1.0 { 1 } else { 2 });
        let coefficient = said(&Growth { coefficient_uncertainty: 0.1 * part, ..seen() });
        assert_eq!(coefficient, [Word::Holds, word(part > 1.0, Word::Undecided)], "{part}");
    }
}

#[test]
fn it_is_measured_within_half_of_where_the_term_leads() {
    for part in SIDES {
        for measured in [Growth { to: part * 0.5, ..seen() }, Growth { from: 2e-4 / part, ..seen() }] {
            let found = said(&measured);
            assert_eq!(found == [Word::Undecided], part > 1.0, "{part}: {found:?}");
        }
    }
}

#[test]
fn what_does_not_stand_out_is_undecided() {
    let mut found = Findings::default();
    judge_growth(&mut found, None, &PREDICTED, false);
    assert_eq!(found.word(5), Some(Word::Undecided));
}
