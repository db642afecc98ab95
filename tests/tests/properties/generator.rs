//! What the generator of random systems promises.

use std::collections::HashSet;

use mechanics::check_regularity;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestCaseError;
use random::{Batch, Kind, LARGEST, MOST, Recipe, Record, draw, recipes_of, shrink};
use scene::Scene;

use super::support::for_all;

/// `|f|` at the start.
const ON_THE_CONSTRAINT: f64 = 1e-12;

#[test]
fn starts_are_on_the_constraint_and_regular_and_removals_remove() {
    for_all(256, &recipes_of(&Kind::ALL), |recipe: Recipe| {
        let scene = recipe.scene("random");
        let mut metric = motion::Metric::new(&scene.system).expect("compiles");
        let residual = metric.constraint_residual(scene.start.t, &scene.start.q, &scene.start.v);
        prop_assert!(residual < ON_THE_CONSTRAINT, "residual {residual:e}");
        prop_assert_eq!(scene.system.constraints.len(), recipe.h());
        let regular = check_regularity(&scene.system, &scene.start);
        prop_assert!(regular.is_ok(), "{regular:?}");
        for removal in motion::removals(&scene).expect("removable") {
            let verified = removal.verify(&scene.system);
            prop_assert!(verified.is_ok(), "{verified:?}");
        }
        Ok(())
    });
}

#[test]
fn scenes_survive_being_written_to_a_file() {
    for_all(64, &recipes_of(&Kind::ALL), |recipe: Recipe| {
        let scene = recipe.scene("random");
        let text = scene.to_toml();
        let again = Scene::parse("random", &text).map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
        prop_assert_eq!(&again.start, &scene.start);
        let (mut one, mut two) = (
            motion::Metric::new(&scene.system).expect("compiles"),
            motion::Metric::new(&again.system).expect("compiles"),
        );
        let (q, v) = (&scene.start.q, &scene.start.v);
        let lengths = [&mut one, &mut two].map(|m| m.length(0.3, q, v, v));
        prop_assert!((lengths[0] - lengths[1]).abs() <= 1e-13 * lengths[0], "{lengths:?}\n{text}");
        prop_assert_eq!(again.removals.len(), 1);
        Ok(())
    });
}

#[test]
fn all_sizes_are_drawn() {
    let batch = |kind: Kind| (0..1000).map(move |index| draw(7, index, &[kind]).current());
    let sizes: HashSet<(usize, usize)> =
        Kind::ALL.into_iter().flat_map(batch).map(|recipe| (recipe.n(), recipe.h())).collect();
    let wanted: HashSet<(usize, usize)> = (2..=MOST).flat_map(|n| (0..n).map(move |h| (n, h))).collect();
    assert!(sizes.is_superset(&wanted), "{:?}", wanted.difference(&sizes));
    let large: HashSet<usize> = sizes.iter().map(|&(n, _)| n).filter(|&n| n > MOST).collect();
    assert_eq!(large, (MOST + 1..=LARGEST).collect());
}

#[test]
fn a_system_is_a_function_of_seed_and_index() {
    let batch = |seed| Batch { seed, kinds: Kind::ALL.to_vec() };
    let record = |seed| Record { seconds: Default::default(), ..batch(seed).record(17) };
    assert_eq!(record(3), record(3));
    assert_eq!(draw(3, 17, &Kind::ALL).current(), draw(3, 17, &Kind::ALL).current());
    assert_ne!(draw(3, 15, &Kind::ALL).current(), draw(4, 15, &Kind::ALL).current());
}

#[test]
fn a_false_claim_is_shrunk_to_a_small_system() {
    // false: "nothing with a nonintegrable constraint moves by more than 0.1"
    let moves = |recipe: &Recipe| {
        // one motion says it, and all others are not asked
        let scene = recipe.scene("small");
        let chetaev = motion::choices(&scene).into_iter().find(|choice| choice.formulation == motion::CHETAEV)?;
        let mut motion = motion::solve_choice(&scene, &chetaev, &motion::Settings::default()).ok()?;
        let (start, end) = (motion.at(motion.start()).ok()?, motion.at(scene.start.t + scene.duration).ok()?);
        let ways = end.coordinates.iter().zip(&start.coordinates).map(|(a, b)| (a - b).abs());
        let way = ways.fold(0.0, f64::max);
        (way > 0.1).then(|| (recipe.clone(), scene))
    };
    let mut found = 0;
    for index in 0..12 {
        let mut tree = draw(11, index, &[Kind::Linear]);
        let before = tree.current();
        let Some((small, scene)) = shrink(&mut tree, &moves) else { continue };
        assert!(small.n() <= before.n());
        assert_eq!((small.n(), small.h()), (3, 1), "not the smallest: {small:?}");
        assert!(small.mass_terms.is_empty() && small.potential.is_empty(), "superfluous terms: {small:?}");
        // what is written is what was found: the file opens, and its motions can be compared
        let again = Scene::parse("small", &scene.to_toml()).expect("opens");
        let choices = motion::choices(&again);
        comparison::compare(again, choices, Vec::new(), &motion::Settings::default()).expect("can be compared");
        found += 1;
    }
    assert!(found > 0, "the claim is false on no system tried");
}

/// What a kind may not have is not drawn, everything else is; velocities have both signs.
#[test]
fn classes_are_those_that_their_kind_may_have() {
    let (mut names, mut signs) = (HashSet::new(), HashSet::new());
    for (kind, index) in Kind::ALL.into_iter().flat_map(|kind| (0..60).map(move |index| (kind, index))) {
        let recipe = draw(5, index, &[kind]).current();
        let own = recipe.drawn.names();
        let has = |name: &str| own.contains(&name);
        assert_eq!(has("more than six coordinates"), recipe.n() > MOST, "{kind} {index}");
        assert!(!has("a start farther than 100") || recipe.features.far.is_some(), "{kind} {index}");
        assert!(!has("constraints nearer than 1e-3") || kind == Kind::NearRankLoss, "{kind} {index}");
        assert!(!has("a constraint that is no cone") || kind == Kind::Nonlinear, "{kind} {index}");
        signs.extend(recipe.velocities.iter().map(|v| v.signum()));
        let Scene { system, start, .. } = recipe.scene("random");
        let timed = ["an L that depends on time", "a breakpoint"].into_iter().any(has);
        let timed = timed || kind == Kind::TimeDependent || recipe.features.switch.is_some();
        assert!(timed || !system.graph.depends_on(system.lagrangian, system.time), "{kind} {index}");
        if recipe.is_homogeneous() && recipe.h() > 0 && system.is_autonomous() {
            // f = 0 at twice the velocities, too
            let twice: Vec<f64> = start.v.iter().map(|v| 2.0 * v).collect();
            let mut metric = motion::Metric::new(&system).expect("compiles");
            let residual = metric.constraint_residual(start.t, &start.q, &twice);
            let size = 1.0 + twice.iter().map(|v| v * v).sum::<f64>();
            assert!(residual < ON_THE_CONSTRAINT * size, "{kind} {index}: {residual:e}");
        }
        names.extend(own);
    }
    assert_eq!((names.len(), signs), (13, HashSet::from([-1, 0, 1])), "{names:?}");
}
