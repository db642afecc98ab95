//! Methods of integration against a closed form, exact Jacobians against differences.

use deltaq::{Motion, Settings};
use integrate::Method;
use mechanics::{Compiled, Equations, Scene};
use referees::closed_forms::Sledge;

use crate::support::{
    at, equations, linear_scenes, motion_of, must, number, parameter, regular_removals, removal_values, scene, scenes,
    some_multipliers, values,
};

#[test]
fn every_method_reaches_the_closed_form_of_the_sledge() {
    let scene = scene("sledge", &[]);
    let (q, v) = (&scene.start.q, &scene.start.v);
    let exact = Sledge {
        gravity_along: parameter(&scene, "g") * parameter(&scene, "alpha").sin(),
        x: q[0],
        y: q[1],
        phi: q[2],
        speed: v[0].hypot(v[1]),
        omega: v[2],
    };
    let end = exact.at(10.0);
    let size = end.x.hypot(end.y);
    // tolerance of the looser run, and what the tighter run, at a hundredth of it, may be wrong by over its own tolerance
    for (method, tolerance, factor) in [
        (Method::Taylor, 1e-9, 100.0),
        (Method::Dop853, 1e-9, 100.0),
        (Method::Tsit45, 1e-7, 100.0),
        (Method::Bdf, 1e-6, 1000.0),
        (Method::TrBdf2, 1e-5, 100.0),
        (Method::Esdirk34, 1e-6, 100.0),
        (Method::Radau5, 1e-6, 100.0),
    ] {
        let settings = Settings { method, tolerance, ..Settings::default() };
        let mut motion = motion_of(&scene, equations(&scene.system, "chetaev", None), &[], &settings);
        assert!(motion.is_complete(), "{method:?}: {:?}", motion.ending);
        let now = at(&mut motion, 10.0).coordinates;
        let error = crate::support::largest_difference(&now, &[end.x, end.y, end.phi]) / size;
        let kept = tolerance * deltaq::TIGHTER;
        println!("{method:?}: {} steps, {} evaluations", motion.work.steps, motion.work.evaluations);
        must(&format!("sledge, {method:?} at tolerance {kept:.0e}: relative error at t = 10"), error, factor * kept);
    }
}

/// `y(t₀)` as the derivation states it.
fn start(scene: &Scene, equations: &Equations, constants: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut known = match &equations.removal {
        Some(removal) => removal_values(&scene.system, removal, &scene.start),
        None => values(&scene.system, &scene.start),
    };
    known.extend(equations.constant_symbols().into_iter().zip(constants.iter().copied()));
    let y = equations.states.iter().map(|s| number(&equations.graph, s.start, &known)).collect();
    let guess = equations.blocks.iter().flat_map(|b| &b.guess).map(|&e| number(&equations.graph, e, &known)).collect();
    (y, guess)
}

/// Largest deviation of the exact Jacobian from central differences, over the largest entry.
fn jacobian_error(scene: &Scene, equations: &Equations, constants: &[f64]) -> f64 {
    let compiled = Compiled::new(equations).expect("compiles");
    let mut compiled = compiled.with_jacobian(equations).expect("compiles");
    let (mut y, guess) = start(scene, equations, constants);
    compiled.set_constants(constants);
    if !guess.is_empty() {
        compiled.set_guess(&guess);
    }
    let (n, t) = (y.len(), scene.start.t);
    let mut exact = vec![0.0; n * n];
    compiled.jacobian(t, &y, &mut exact).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    let size = exact.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
    let mut rates = |y: &[f64]| {
        let mut rates = vec![0.0; n];
        compiled.rates(t, y, &mut rates).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
        rates
    };
    let mut worst = 0.0_f64;
    for column in 0..n {
        let h = 1e-3 * y[column].abs().max(0.1);
        let centre = y[column];
        // sixth order: 3/4, −3/20, 1/60
        let mut difference = vec![0.0; n];
        for (step, weight) in [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)] {
            for sign in [1.0, -1.0] {
                y[column] = centre + sign * step * h;
                for (d, r) in difference.iter_mut().zip(rates(&y)) {
                    *d += sign * weight * r / h;
                }
            }
        }
        y[column] = centre;
        worst = (0..n).map(|row| (difference[row] - exact[row * n + column]).abs()).fold(worst, f64::max);
    }
    worst / size
}

#[test]
fn jacobians_are_exact_for_every_formulation_on_every_scene() {
    let mut count = 0;
    for scene in scenes() {
        let mu0 = some_multipliers(&scene);
        for (name, constants) in [("chetaev", &[][..]), ("vakonomic", &mu0), ("vakonomic-costate", &mu0)] {
            let equations = equations(&scene.system, name, None);
            must(&format!("{}, {name}: Jacobian", scene.name), jacobian_error(&scene, &equations, constants), 1e-8);
            count += 1;
        }
        for removal in regular_removals(&scene) {
            let equations = equations(&scene.system, "removed-constraint", Some(&removal));
            let constants = vec![0.1; equations.free_constants.len()];
            let error = jacobian_error(&scene, &equations, &constants);
            must(&format!("{}, removal {}: Jacobian", scene.name, removal.name), error, 1e-8);
            count += 1;
        }
    }
    assert!(count >= 3 * scenes().len() + 2 * linear_scenes().len(), "{count}");
}

#[test]
fn implicit_methods_use_those_jacobians() {
    let scene = scene("ball-in-cone", &[("duration", 1.0)]);
    let run = |method| {
        let settings = Settings { method, tolerance: 1e-7, ..Settings::default() };
        motion_of(&scene, equations(&scene.system, "chetaev", None), &[], &settings)
    };
    let mut reference: Motion = run(Method::Dop853);
    for method in [Method::Bdf, Method::Esdirk34] {
        let mut motion = run(method);
        assert!(motion.work.jacobians > 0, "{method:?} asked for no Jacobian");
        let error =
            crate::support::largest_difference(&at(&mut motion, 1.0).coordinates, &at(&mut reference, 1.0).coordinates);
        must(&format!("ball-in-cone, {method:?} at 1e-9 against Dop853"), error, 1e-6);
    }
}
