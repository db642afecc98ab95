//! Every built-in scene loads, starts on its constraint, and survives being written and read.

use std::path::PathBuf;

use mechanics::{ConstantsRule, Kind, Pose, Removal, State, System, complete_removal_start};
use scene::Scene;
use symbolic::{Expr, Symbol};

fn scenes() -> Vec<Scene> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../crates/scene/scenes");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.sort();
    let scenes: Vec<Scene> = paths.iter().map(|p| Scene::load(p).unwrap_or_else(|e| panic!("{e}"))).collect();
    assert!(scenes.len() >= 12);
    scenes
}

fn scene(name: &str) -> Scene {
    scenes().into_iter().find(|s| s.name == name).unwrap()
}

#[test]
fn all_scenes_start_on_their_constraint() {
    for scene in scenes() {
        assert!(scene.completion.residual < 1e-15, "{}: {:e}", scene.name, scene.completion.residual);
        let supplied = scene.completion.supplied.len() + scene.completion.given.len();
        assert!(supplied >= scene.system.dimension(), "{}", scene.name);
        assert_eq!(scene.multipliers.len(), scene.system.constraints.len());
    }
}

#[test]
fn written_scenes_read_back_the_same() {
    for scene in scenes() {
        let text = scene.to_toml();
        let again = Scene::parse(&scene.name, &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert_eq!(again.start, scene.start, "{}", scene.name);
        assert_eq!(again.duration, scene.duration);
        assert_eq!(again.multipliers, scene.multipliers);
        for (a, b) in expressions(&again).into_iter().zip(expressions(&scene)) {
            assert!(same(&again, a, &scene, b), "{}: {}", scene.name, again.system.graph.plain(a));
        }
        let view = |s: &Scene| {
            let shapes: Vec<_> = s.view.bodies.iter().map(|b| (b.name.clone(), b.shape.clone())).collect();
            (shapes, s.view.poses(&s.system).unwrap().at(s.start.t, &s.start.q))
        };
        let ((shapes, poses), (same_shapes, poses_again)) = (view(&scene), view(&again));
        assert!(!shapes.is_empty() && shapes == same_shapes, "{}", scene.name);
        for (a, b) in poses.iter().zip(&poses_again) {
            let numbers = |p: &Pose| [&[p.at], &p.rotation[..], &p.touches].concat().concat();
            let apart = numbers(a).iter().zip(&numbers(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(numbers(a).len() == numbers(b).len() && apart < 1e-15, "{}: {apart:e}", scene.name);
        }
        let constants = |s: &Scene| s.removals.iter().map(|r| r.constants.clone()).collect::<Vec<_>>();
        assert_eq!(constants(&again), constants(&scene));
    }
}

fn expressions(scene: &Scene) -> Vec<Expr> {
    let System { lagrangian, constraints, forces, .. } = &scene.system;
    let rates = scene.removals.iter().flat_map(|r| r.memory.iter().map(|w| w.rate).chain(r.coordinates.clone()));
    [&[*lagrangian], &constraints[..], forces].concat().into_iter().chain(rates).collect()
}

#[test]
fn the_words_for_shapes_are_those_of_the_table() {
    let words: Vec<&str> = Kind::ALL.iter().map(|(_, word, _)| *word).collect();
    assert_eq!(scene::format::SHAPES, format!("one of {}", words.join(", ")));
}

/// Whether two expressions from different graphs are identical.
fn same(left: &Scene, a: Expr, right: &Scene, b: Expr) -> bool {
    let g = &right.system.graph;
    let a = g.parse(&left.system.graph.plain(a), g).unwrap();
    g.vanishes(g.sub(a, b), &right.system.parameter_values()).is_zero()
}

#[test]
fn removals_reproduce_the_start() {
    for scene in scenes() {
        for removal in &scene.removals {
            let start = complete_removal_start(&scene.system, removal, &scene.start)
                .unwrap_or_else(|e| panic!("{}, {}: {e}", scene.name, removal.name));
            let state = rebuilt(&scene, removal, &start.values());
            let gap = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(gap(&state.q, &scene.start.q) < 1e-13, "{}, {}", scene.name, removal.name);
            assert!(gap(&state.v, &scene.start.v) < 1e-13, "{}, {}", scene.name, removal.name);
        }
    }
}

fn rebuilt(scene: &Scene, removal: &Removal, values: &std::collections::HashMap<Symbol, f64>) -> State {
    let g = &scene.system.graph;
    let mut all = scene.system.parameter_values();
    all.insert(scene.system.time, scene.start.t);
    all.extend(values);
    let number = |e: Expr| g.evaluate(e, &all).unwrap();
    State {
        t: scene.start.t,
        q: removal.coordinates.iter().map(|&e| number(e)).collect(),
        v: removal.velocities(&scene.system).into_iter().map(number).collect(),
    }
}

#[test]
fn start_velocities_from_the_paper() {
    let sledge = scene("sledge");
    let (s, c) = 0.3_f64.sin_cos();
    let expected = [0.5 * c, 0.5 * s, 1.1];
    assert!(sledge.start.v.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-16), "{:?}", sledge.start.v);
    assert_eq!(sledge.completion.supplied, ["y'"]);
    assert_eq!(sledge.completion.projected, None);
    assert_eq!(sledge.removals[0].constants, ConstantsRule::Natural { horizon: 10.0 });
    assert_eq!(sledge.removals.iter().map(|r| r.name.as_str()).collect::<Vec<_>>(), ["arc-length", "along-x"]);
}

#[test]
fn rate_of_a_removal_parameter_gives_the_velocities() {
    let cylinders = scene("three-cylinders");
    assert_eq!(cylinders.completion.given, ["theta'", "W'"]);
    assert_eq!(cylinders.completion.supplied.len(), 5);
    let removal = &cylinders.removals[0];
    let start = complete_removal_start(&cylinders.system, removal, &cylinders.start).unwrap();
    let rate = cylinders.system.graph.find_symbol("W'").unwrap();
    assert!((start.values()[&rate] - 0.6).abs() < 1e-13);
    assert!(start.second_rates.is_empty());
    // the paper's (u, theta): phi' contains u'' and theta''
    let start = complete_removal_start(&cylinders.system, &cylinders.removals[1], &cylinders.start).unwrap();
    assert_eq!(start.second_rates.len(), 2);
    assert_eq!(start.memory.len(), 4);
}
