//! Findings on a claim.

use random::{Findings, Word};

fn words(say: impl Fn(&mut Findings)) -> Vec<Word> {
    let mut found = Findings::default();
    say(&mut found);
    found.findings.iter().map(|finding| finding.word).collect()
}

#[test]
fn what_is_over_its_limit_fails_and_so_does_what_is_no_number() {
    let words = words(|found| {
        for figure in [0.0, 1.0, 1.0 + f64::EPSILON, f64::INFINITY, f64::NAN] {
            found.bound(1, "claim", figure, 1.0);
        }
        found.bound(1, "claim", 0.0, f64::NAN);
    });
    let wanted = [Word::Holds, Word::Holds, Word::Fails, Word::Fails, Word::Fails, Word::Fails];
    assert_eq!(words, wanted);
}

#[test]
fn what_is_not_so_fails() {
    let words = words(|found| [true, false].into_iter().for_each(|so| found.require(1, "claim", so, "note")));
    assert_eq!(words, [Word::Holds, Word::Fails]);
}

#[test]
fn one_failure_is_the_word_on_a_theorem_and_one_doubt_that_of_none() {
    let mut found = Findings::default();
    assert_eq!(found.word(1), None);
    found.require(1, "claim", true, "");
    assert_eq!((found.word(1), found.word(2)), (Some(Word::Holds), None));
    found.undecided(1, "claim", "why");
    assert_eq!(found.word(1), Some(Word::Undecided));
    found.bound(1, "claim", 2.0, 1.0);
    found.require(1, "claim", true, "");
    assert_eq!(found.word(1), Some(Word::Fails));
    assert_eq!(found.failures().count(), 1);
}
