//! Chetaev in quasi-velocities is Chetaev: against the saddle-point form and Maggi's, derived independently.

use equations::{Compiled, Equations};
use mechanics::State;
use motion::REDUCED_CHETAEV;
use proptest::{prop_assert, test_runner::TestCaseError};
use referees::maggi::Maggi;
use scene::Scene;
use scene::catalogue::trailer::{self, Coordinates};
use symbolic::{Expr, Symbol};

use super::support::{
    at, chetaev, common_times, constraint_residual, derived, equations, for_all_linear, known_gap, linear_scenes,
    motion_of, must, scene, tight,
};

pub fn reduced(scene: &Scene) -> Equations {
    equations(&scene.system, REDUCED_CHETAEV, None)
}

fn train(trailers: usize, coordinates: Coordinates) -> Scene {
    trailer::scene(trailers, coordinates).expect("its own text parses")
}

/// The states of reduced equations at `(t, q, v)`, and what their rates should be for the accelerations `a`.
fn states_and_rates(scene: &Scene, equations: &Equations, state: &State, a: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (system, g) = (&scene.system, &equations.graph);
    let mut symbols: Vec<Symbol> = [system.positions(), system.velocities(), system.accelerations()].concat();
    symbols.push(system.time);
    let point = [&state.q[..], &state.v, a, &[state.t]].concat();
    let starts: Vec<Expr> = equations.states.iter().map(|y| y.start).collect();
    let mut flow = system.flow();
    // coefficients that have a name of their own move as well
    for &(symbol, e) in &equations.definitions {
        if !system.velocities().contains(&symbol) {
            flow.push((symbol, g.total_derivative(e, &flow)));
        }
    }
    let mut outputs = starts.clone();
    outputs.extend(g.total_derivatives(&starts, &flow));
    let tape = equations.tape(&symbols, &outputs).expect("compiles");
    let mut values = vec![0.0; outputs.len()];
    tape.evaluate(&point, &mut tape.workspace(), &mut values);
    let rates = values.split_off(starts.len());
    (values, rates)
}

/// The states at the scene's start.
pub fn states(scene: &Scene, equations: &Equations) -> Vec<f64> {
    states_and_rates(scene, equations, &scene.start, &vec![0.0; scene.system.dimension()]).0
}

/// Largest difference of rates from Maggi's accelerations, relative to the largest; the same of velocities.
pub fn differences(scene: &Scene, equations: &Equations, state: &State) -> (f64, f64) {
    let mut maggi = Maggi::new(&scene.system).expect("differentiates");
    let a = maggi.accelerations(state.t, &state.q, &state.v).expect("regular");
    let (y, expected) = states_and_rates(scene, equations, state, &a);
    let mut compiled = Compiled::new(equations).expect("compiles");
    let mut rates = vec![0.0; y.len()];
    compiled.rates(state.t, &y, &mut rates).expect("regular");
    let v = compiled.outputs(state.t, &y).expect("regular").velocities;
    let largest = |values: &[f64]| values.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (apart(&rates, &expected) / largest(&expected), apart(&v, &state.v) / largest(&state.v))
}

#[test]
fn reduced_rates_are_those_by_maggi_on_every_scene() {
    for scene in linear_scenes() {
        let (rates, velocities) = differences(&scene, &reduced(&scene), &scene.start);
        must(&format!("{}: rates in quasi-velocities against Maggi", scene.name), rates, 1e-11);
        must(&format!("{}: velocities out of quasi-velocities", scene.name), velocities, 1e-12);
    }
}

#[test]
fn reduced_rates_are_those_by_maggi_on_random_systems() {
    let worst = std::cell::Cell::new(0.0_f64);
    for_all_linear(1894, |scene| {
        let equations = derived(scene, REDUCED_CHETAEV, None, Some(&scene.start));
        let equations = equations.map_err(|e| TestCaseError::fail(e.to_string()))?;
        let (rates, velocities) = differences(scene, &equations.leave_out_unneeded(), &scene.start);
        worst.set(worst.get().max(rates));
        // thousands from the origin digits are lost in both: seen 2e-7
        let is_far = scene.start.q.iter().any(|q| q.abs() > 1e3);
        let limit = if is_far { 1e-5 } else { 1e-8 };
        prop_assert!(rates < limit && velocities < 1e-10, "{rates:e}, {velocities:e}\n{}", scene.to_toml());
        Ok(())
    });
    println!("largest difference {:.1e}", worst.get());
    assert!(worst.get() > 0.0, "round-off is never zero on every system: nothing was compared");
}

#[test]
fn reduced_motions_are_chetaevs_on_every_scene_and_stay_on_the_constraint() {
    for scene in linear_scenes() {
        let mut reference = chetaev(&scene);
        let mut motion = motion_of(&scene, reduced(&scene), &[], &tight());
        let (distance, end) = known_gap(&mut reference, &mut motion);
        let guards = motion.equations.guards.len();
        assert!(guards > 0 || end > 0.99 * scene.duration, "{}: no guard, and stopped at {end}", scene.name);
        must(&format!("{}: quasi-velocities, {guards} guards, to {end:.2} s", scene.name), distance, 1e-9);
        let residual = constraint_residual(&scene, &mut motion);
        must(&format!("{}: |f| without projection", scene.name), residual, 1e-11);
    }
}

#[test]
fn a_train_is_the_same_in_maximal_and_minimal_coordinates() {
    for trailers in [1, 3] {
        let (maximal, minimal) = (train(trailers, Coordinates::Maximal), train(trailers, Coordinates::Minimal));
        let mut long = motion_of(&maximal, reduced(&maximal), &[], &tight());
        let mut short = chetaev(&minimal);
        assert!(long.is_complete() && long.equations.guards.is_empty(), "{:?}", long.ending);
        let times = common_times(&[&long, &short]);
        let apart = times.iter().map(|&t| {
            let (long, short) = (at(&mut long, t).coordinates, at(&mut short, t).coordinates);
            let headings = (0..=trailers).map(|i| (3 * i + 2, i + 2));
            let pairs = [(0, 0), (1, 1)].into_iter().chain(headings);
            pairs.map(|(i, j)| (long[i] - short[j]).abs()).fold(0.0, f64::max)
        });
        must(&format!("{trailers} trailers: maximal against minimal"), apart.fold(0.0, f64::max), 1e-9);
        let hitches = (1..=trailers).map(|i| {
            let q = at(&mut long, maximal.duration).coordinates;
            let (front, own) = (&q[3 * i - 3..3 * i], &q[3 * i..3 * i + 3]);
            (own[0] + 0.8 * own[2].cos() - front[0]).hypot(own[1] + 0.8 * own[2].sin() - front[1])
        });
        must(&format!("{trailers} trailers: hitches at the end"), hitches.fold(0.0, f64::max), 1e-10);
    }
}

#[test]
fn the_train_with_three_trailers_is_the_scene() {
    let (built_in, generated) = (scene("trailer", &[]), train(3, Coordinates::Minimal));
    let apart = built_in.start.q.iter().zip(&generated.start.q).chain(built_in.start.v.iter().zip(&generated.start.v));
    must("start", apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max), 1e-14);
    let mut two = motion_of(&generated, reduced(&generated), &[], &tight());
    let gap = super::support::gap(&mut chetaev(&built_in), &mut two).0;
    must("scene against generated train", gap, 1e-9);
    // the loader, which solves the constraints for the velocities, comes to the same start
    for (name, coordinates) in [("n-trailer-3", Coordinates::Maximal), ("n-trailer-minimal-3", Coordinates::Minimal)] {
        let (loaded, direct) = (scene(name, &[]), train(3, coordinates));
        let apart = loaded.start.v.iter().zip(&direct.start.v).map(|(a, b)| (a - b).abs());
        must(&format!("{name}: start velocities"), apart.fold(0.0, f64::max), 1e-12);
    }
}

#[test]
fn constraints_that_are_not_linear_are_refused() {
    let error = derived(&scene("appell-hamel", &[]), REDUCED_CHETAEV, None, None).expect_err("refused").to_string();
    assert!(error.contains("not linear in the velocities"), "{error}");
}

/// What is constant cannot vanish along the way; of constant coefficients small ones lose digits.
#[test]
fn pivots_are_constant_where_they_can_be_and_then_large() {
    let of = |constraint: &str| {
        let text = format!(
            "title = \"pivots\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\nz = {{ start = 1 }}\n\
             [system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"{constraint}\"]\n\
             [start.velocities]\n\"y'\" = 0\n\"z'\" = 0\n[run]\nduration = 1\n"
        );
        let scene = Scene::parse("pivots", &text).unwrap_or_else(|e| panic!("{e}"));
        let equations = reduced(&scene);
        let names: Vec<String> = equations.states.iter().map(|y| equations.graph.name(y.symbol)).collect();
        (equations.chart.is_none(), ["x'", "y'", "z'"].map(|name| names.iter().any(|known| known == name)))
    };
    for small in ["1", "1e-4", "1e-8"] {
        assert_eq!(of(&format!("{small}*x' + sin(z)*y'")), (true, [false, true, true]), "{small}");
    }
    assert!(!of("1e-12*x' + sin(z)*y'").0);
    assert_eq!(of("x' + 1e-9*y' + sin(z)*z'"), (true, [false, true, true]));
    assert_eq!(of("1e-9*x' + y' + sin(z)*z'"), (true, [true, false, true]));
}
