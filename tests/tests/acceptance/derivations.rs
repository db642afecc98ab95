//! What derivations give besides motions: readers' equations, invariants, projections, guards, omissions.

use motion::{CHETAEV, KAPPA, REMOVED_CONSTRAINT, VAKONOMIC, VAKONOMIC_COSTATE};
use std::collections::BTreeSet;

use equations::{Equations, Formulation, Role};
use mechanics::Removal;
use scene::Scene;

use super::support::{self, constrained_scenes, regular_removals, scenes};

fn derived(scene: &Scene, name: &Formulation, removal: Option<&Removal>) -> Equations {
    support::derived(scene, name, removal, None).unwrap_or_else(|e| panic!("{}, {name:?}: {e}", scene.name))
}

/// Every formulation of a scene, removals included.
fn all(scene: &Scene) -> Vec<Equations> {
    let own = [CHETAEV, VAKONOMIC, VAKONOMIC_COSTATE].map(|name| derived(scene, name, None));
    let removed = regular_removals(scene);
    own.into_iter().chain(removed.iter().map(|r| derived(scene, REMOVED_CONSTRAINT, Some(r)))).collect()
}

#[test]
fn the_reader_sees_every_equation_that_is_solved() {
    for scene in scenes() {
        for equations in all(&scene) {
            let said: BTreeSet<_> = equations.statements.iter().map(|s| equations.graph.sub(s.left, s.right)).collect();
            let n = scene.system.dimension();
            let what = format!("{}, {}", scene.name, equations.formulation);
            let balances = match equations.formulation {
                own if [CHETAEV.name, VAKONOMIC.name].contains(&own) => n,
                own if own == REMOVED_CONSTRAINT.name => n - scene.system.constraints.len(),
                _ => 0, // the costate form shows Hamilton's equations; its balances are no residuals
            };
            let solved: Vec<_> = equations.blocks.iter().flat_map(|b| &b.residuals).copied().collect();
            for residual in &solved[..balances] {
                assert!(said.contains(residual), "{what}: not shown: {}", equations.graph.plain(*residual));
            }
            if equations.formulation == REMOVED_CONSTRAINT.name {
                let removal = equations.removal.as_ref().expect("derived with one");
                let meaning = |word: &str| equations.statements.iter().filter(|s| s.meaning == word).count();
                assert_eq!(meaning("memory"), removal.memory.len(), "{what}");
                assert_eq!(meaning("costate"), equations.free_constants.iter().filter(|c| c.memory.is_some()).count());
            } else {
                for f in &scene.system.constraints {
                    assert!(said.contains(f), "{what}: constraint not shown");
                }
            }
        }
    }
}

#[test]
fn states_can_be_put_back_onto_the_constraint_where_they_can_leave_it() {
    for scene in scenes() {
        for equations in all(&scene) {
            let leaves = [CHETAEV.name, VAKONOMIC.name].contains(&equations.formulation);
            let wanted = leaves && !scene.system.constraints.is_empty();
            assert_eq!(equations.projection.is_some(), wanted, "{}, {}", scene.name, equations.formulation);
        }
    }
}

#[test]
fn first_order_is_said_where_no_second_rate_is_needed() {
    for scene in constrained_scenes() {
        for removal in regular_removals(&scene) {
            let equations = derived(&scene, REMOVED_CONSTRAINT, Some(&removal));
            let said = equations.left_out.iter().any(|l| l.words.starts_with("second rates"));
            let states = equations.states.iter().any(|y| y.role == Role::ParameterSecondRate);
            assert_eq!(said, !states, "{}, {}", scene.name, removal.name);
        }
    }
}

const GUARDED: &str = include_str!("../scenes/guarded.toml");

/// `y` is in `L`; `x`, `2 + w` in rates of `L`, `3 + y` in a quadrature's; `k`, a parameter, cannot vanish.
#[test]
fn what_the_equations_divide_by_is_watched() {
    let scene = Scene::parse("guarded", GUARDED).unwrap_or_else(|e| panic!("{e}"));
    let equations = derived(&scene, REMOVED_CONSTRAINT, Some(&scene.removals[0]));
    let guards: BTreeSet<String> = equations.guards.iter().map(|&e| equations.graph.plain(e)).collect();
    assert_eq!(guards, ["w + 2", "x", "y", "y + 3"].map(String::from).into());
}

const DRIVEN: &str = include_str!("../scenes/driven-oscillator.toml");

#[test]
fn what_depends_on_time_has_no_energy() {
    let scene = Scene::parse("driven", DRIVEN).unwrap_or_else(|e| panic!("{e}"));
    let mut all = vec![derived(&scene, CHETAEV, None), derived(&scene, VAKONOMIC, None)];
    all.extend(scene.removals.iter().map(|r| derived(&scene, REMOVED_CONSTRAINT, Some(r))));
    for equations in all {
        let named: Vec<&str> = equations.invariants.iter().map(|i| i.name.as_str()).collect();
        assert!(!named.contains(&"energy"), "{}: {named:?}", equations.formulation);
        assert!(named.iter().any(|name| name.starts_with("momentum")), "{}: {named:?}", equations.formulation);
    }
}

#[test]
fn states_say_what_they_are_and_second_rates_are_not_denied() {
    let scene = Scene::parse("driven", DRIVEN).unwrap_or_else(|e| panic!("{e}"));
    let [mixed, memory] = [0, 1].map(|i| derived(&scene, REMOVED_CONSTRAINT, Some(&scene.removals[i])));
    let first_order = |e: &Equations| e.left_out.iter().any(|l| l.words.starts_with("second rates"));
    assert!(!first_order(&mixed) && first_order(&memory));
    let role = |e: &Equations, name: &str| {
        let state = e.states.iter().find(|y| e.graph.name(y.symbol) == name);
        state.unwrap_or_else(|| panic!("no state {name}")).role
    };
    assert_eq!(role(&memory, "x"), Role::Position, "memory that is a coordinate");
    assert_eq!(role(&memory, "y"), Role::Position);
    assert_eq!(role(&memory, "u"), Role::DisplacementParameter);
    assert_eq!(role(&mixed, "u''"), Role::ParameterSecondRate);
    let scene = &scenes().into_iter().find(|s| s.name == "three-cylinders").expect("built in");
    let by_turn = scene.removals.iter().find(|r| r.name == "by-turn").expect("built in");
    let equations = derived(scene, REMOVED_CONSTRAINT, Some(by_turn));
    for w in &by_turn.memory {
        let wanted = if w.coordinate.is_some() { Role::Position } else { Role::Memory };
        assert_eq!(role(&equations, &equations.graph.name(w.symbol)), wanted);
    }
}

#[test]
fn the_family_between_is_asked_for_by_its_parameter() {
    let without = support::scene("sledge", &[]);
    assert!(motion::choices(&without).iter().all(|choice| choice.formulation != KAPPA));
    let error = (KAPPA.derive)(&without.system, &Default::default());
    assert!(error.expect_err("refused").to_string().contains("a parameter `kappa` is needed"));
    let with = support::scene("sledge", &[("kappa", 2.0)]);
    assert!(motion::choices(&with).iter().any(|choice| choice.formulation == KAPPA));
}
