//! What is said of a fit where the decision denies one.

use comparison::Gap;
use random::judged::{denied, visible};
use random::{Case, Findings, Kind, Which, Word, draw_recipe};

/// A mismatch of 2 over a time of 4 makes a gap of 16; a thousandth of it has to be seen.
#[test]
fn a_fit_is_denied_where_a_thousandth_of_the_gap_would_be_seen() {
    let mut case = Case::new(draw_recipe(1, 0, &[Kind::Linear]), "fits").unwrap_or_else(|e| panic!("{e}"));
    let mut none = case.gap(Which::Chetaev, Which::Chetaev).expect("a gap");
    for (part, close) in [(0.3, Word::Fails), (3.0, Word::Undecided)] {
        none.points.iter_mut().for_each(|p| p.limit = part * 1.6e-2);
        for (certain_from, word) in [(Some(1.0), Word::Holds), (None, close)] {
            let (mut found, after) = (Findings::default(), Gap { certain_from, ..none.clone() });
            denied(&mut found, &after, visible(2.0, 4.0), String::new());
            assert_eq!(found.word(9), Some(word), "{part}, {certain_from:?}");
        }
    }
}
