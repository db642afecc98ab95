//! Systems on which a claim failed once: what was wrong stood between the motions and the word.

use comparison::Answer;
use random::{Batch, Classes, Fault, Kind, Recipe, Word, draw_recipe};
use scene::Scene;

/// Seed, index, kind, the claim's theorem, and what was wrong.
const ONCE_WRONG: [(u64, u64, Kind, u8, &str); 13] = [
    (3141, 829, Kind::NearRankLoss, 10, "what a motion's end is off by grows on the way back"),
    (3141, 2289, Kind::NearRankLoss, 5, "a lower term, lost in round-off, leads"),
    (3141, 4266, Kind::Affine, 3, "a rate is a difference of numbers of a million"),
    (3141, 5002, Kind::Integrable, 8, "the distance to the limit is the method's own error"),
    (3141, 5259, Kind::NearRankLoss, 9, "elimination adds up more than the equations"),
    (3141, 8329, Kind::NearRankLoss, 5, "a later term, lost in round-off, leads soon"),
    (3141, 12399, Kind::NearRankLoss, 9, "elimination adds up more than the equations"),
    (3141, 12999, Kind::NearRankLoss, 9, "elimination adds up more than the equations"),
    (3141, 16435, Kind::Linear, 11, "a direction is lost in round-off at all points"),
    (3141, 16946, Kind::Affine, 2, "a rate is a difference of numbers of a million"),
    (2611, 3489, Kind::NearRankLoss, 9, "elimination adds up more than the equations"),
    (2613, 1539, Kind::NearRankLoss, 9, "elimination adds up more than the equations"),
    (104_729, 10_879, Kind::NearRankLoss, 6, "costates and rates of memory add up more than an energy"),
];

/// The same of systems of later classes.
const LATER: [(u64, u64, Kind, u8, &str); 7] = [
    (5, 458, Kind::Nonlinear, 0, "the tip of a cone is passed, where its direction is lost"),
    (2223, 304, Kind::PartlyIntegrable, 8, "two terms of a distance nearly cancel after a sudden force"),
    (5, 677, Kind::TimeDependent, 5, "derivatives of a steep switch have no value at the start"),
    (1117, 2431, Kind::ChaplyginIntegrable, 12, "an error that is large far from the origin is no difference"),
    (1117, 2841, Kind::ChaplyginIntegrable, 12, "an error that is large far from the origin is no difference"),
    (8, 3299, Kind::NearRankLoss, 9, "constants do for the first moment, the only one that round-off leaves"),
    (424_242, 9913, Kind::HiddenIntegrable, 0, "a costate that is zero is round-off in other units"),
];

#[test]
fn no_claim_fails_where_one_did() {
    // those were drawn without classes
    let plain = |recipe: Recipe| Recipe { drawn: Classes::default(), ..recipe };
    let first = ONCE_WRONG.map(|wrong| (wrong, plain(draw_recipe(wrong.0, wrong.1, &Kind::ALL))));
    let later = LATER.map(|wrong| (wrong, draw_recipe(wrong.0, wrong.1, &Kind::ALL)));
    for ((seed, index, kind, theorem, was), recipe) in first.into_iter().chain(later) {
        let record = Batch { seed, kinds: Kind::ALL.to_vec() }.record_of(recipe, index, &Fault::NONE);
        assert_eq!(record.kind, kind, "seed {seed}, system {index}: systems are drawn in another way");
        let fails: Vec<_> = record.open.iter().filter(|open| open.word == Word::Fails).collect();
        assert!(fails.is_empty(), "seed {seed}, system {index}, where {was}: {fails:?}");
        let claimed = record.word(theorem).is_some();
        assert!(claimed || theorem == 5, "seed {seed}, system {index}: nothing is claimed by T{theorem}");
    }
}

/// Found by a generator of starts at rest: the force on `q2` is held by its constraint, but for 1e-16.
const HELD: &str = r#"
title = "held"
[coordinates]
q1 = { start = 0.75 }
q2 = { start = 0.125 }
q3 = { start = -0.625 }
[system]
lagrangian = "q1'^2/2 + 3*q2'^2/4 + 569*q3'^2/512 + 11*sin(q2)/16"
constraints = ["q2'", "q1'"]
[start.velocities]
"q3'" = 0
[run]
duration = 1.5
"#;

#[test]
fn what_round_off_leaves_of_forces_that_balance_is_no_motion() {
    let scene = Scene::parse("held", HELD).expect("a scene");
    let found = comparison::membership(&scene, 1.5).expect("decided").expect("constrained");
    assert!(found.contradiction().is_none(), "{:?}", found.contradiction());
    assert!(matches!(found.answer(), Answer::Some { .. } | Answer::SomeProved), "{:?}", found.answer());
    assert_eq!(found.decision.set.dimension(), 2);
}
