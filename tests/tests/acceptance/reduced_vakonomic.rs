//! Vakonomic in quasi-velocities: instants against the costate form, motions against the multiplier form.

use std::cell::Cell;

use equations::{Compiled, Equations, Formulation, Outputs, Plan};
use integrate::Method;
use motion::{REDUCED_VAKONOMIC, Settings, VAKONOMIC, VAKONOMIC_COSTATE};
use proptest::prop_assert;
use reduction::Frame;
use scene::Scene;
use scene::catalogue::trailer::{self, Coordinates};
use symbolic::Function;

use super::support::{
    TIGHT, at, constraint_residual, derived, equations, for_all_linear, known_gap, linear_scenes, motion_of, must,
    scene, some_multipliers, start, tight, vakonomic,
};

fn raw(scene: &Scene, name: &Formulation) -> Equations {
    derived(scene, name, None, Some(&scene.start)).unwrap_or_else(|e| panic!("{e}"))
}

/// Rates and outputs at the start.
fn instant(scene: &Scene, equations: &Equations, mut compiled: Compiled, mu: &[f64]) -> (Vec<f64>, Outputs) {
    let (y, guess) = start(scene, equations, mu);
    compiled.set_constants(mu);
    compiled.set_guess(&guess);
    let mut rates = vec![0.0; y.len()];
    compiled.rates(scene.start.t, &y, &mut rates).expect("regular");
    (rates, compiled.outputs(scene.start.t, &y).expect("regular"))
}

/// Largest difference, relative to the largest entry.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = b.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs() / largest)
        .fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
}

/// The rates of `(q, p)` as those of `(q, e_k · p)`: `d/dt (e_k · p) = ė_k · p + e_k · ṗ`.
fn in_the_states_of_a_frame(scene: &Scene, y: &[f64], rates: &[f64]) -> Vec<f64> {
    let system = scene.system.clone();
    let (g, n) = (&system.graph, system.dimension());
    let frame = Frame::new(&system, Some(&scene.start)).expect("the form is in it");
    let symbols = |stem: &str| (0..n).map(|i| g.symbol(&format!("{stem}{i}"))).collect::<Vec<_>>();
    let (p, p_rates) = (symbols("test_p"), symbols("test_rate"));
    let (q, v) = (system.positions(), system.velocities());
    let flow: Vec<_> = [&q[..], &p].concat().into_iter().zip(g.variables(&[&v[..], &p_rates].concat())).collect();
    let moved = g.total_derivatives(&frame.along(g, &g.variables(&p)), &flow);
    let tape = g.compile(&[&q[..], &p, &v, &p_rates].concat(), &moved, &system.parameter_values()).expect("compiles");
    let mut values = vec![0.0; n];
    tape.evaluate(&[y, rates].concat(), &mut tape.workspace(), &mut values);
    [&rates[..n], &values].concat()
}

/// Differences of rates, velocities and multipliers of the two forms; the reduced one as chosen and plain.
pub fn differences(scene: &Scene, mu: &[f64]) -> [f64; 3] {
    let (costate, reduced) = (raw(scene, VAKONOMIC_COSTATE), raw(scene, REDUCED_VAKONOMIC));
    let (rates, outputs) = instant(scene, &costate, Compiled::plain(&costate).expect("compiles"), mu);
    let rates = match &reduced.chosen[..] {
        [] => rates,
        _ => in_the_states_of_a_frame(scene, &start(scene, &costate, mu).0, &rates),
    };
    let mut largest = [0.0_f64; 3];
    for compiled in [Compiled::new(&reduced), Compiled::plain(&reduced)] {
        let (other, others) = instant(scene, &reduced, compiled.expect("compiles"), mu);
        let found = [
            apart(&other, &rates),
            apart(&others.velocities, &outputs.velocities),
            apart(&others.multipliers, &outputs.multipliers),
        ];
        largest.iter_mut().zip(found).for_each(|(largest, d)| *largest = largest.max(d));
        let energy = |e: &Equations, o: &Outputs| {
            e.invariants.iter().zip(&o.invariants).find(|(n, _)| n.name == "energy").map(|(_, &x)| x)
        };
        let energies = [energy(&costate, &outputs), energy(&reduced, &others)];
        assert_eq!(energies[0].is_some(), energies[1].is_some());
        if let [Some(one), Some(two)] = energies {
            largest[0] = largest[0].max(apart(&[one], &[two]));
        }
        assert_eq!(costate.invariants.len(), reduced.invariants.len());
    }
    largest
}

#[test]
fn rates_are_those_of_the_costate_form_on_every_scene() {
    for scene in linear_scenes() {
        let [rates, velocities, multipliers] = differences(&scene, &some_multipliers(&scene));
        must(&format!("{}: rates against the costate form", scene.name), rates, 1e-13);
        must(&format!("{}: velocities", scene.name), velocities, 1e-13);
        must(&format!("{}: multipliers", scene.name), multipliers, 1e-12);
    }
}

/// With friction, a pull and a drive on every coordinate.
fn pushed(scene: &Scene) -> Scene {
    let mut pushed = scene.clone();
    let (g, q, v) = (&pushed.system.graph, scene.system.positions(), scene.system.velocities());
    let force = |i: usize| {
        let pull = g.call(Function::Sin, g.add(g.variable(q[(i + 1) % q.len()]), g.variable(scene.system.time)));
        g.sub(g.mul(g.ratio(1, 4), pull), g.mul(g.ratio(i as i64 + 1, 8), g.variable(v[i])))
    };
    pushed.system.forces = (0..q.len()).map(force).collect();
    pushed
}

#[test]
fn rates_are_those_of_the_costate_form_on_random_systems() {
    let worst = Cell::new([0.0_f64; 3]);
    for_all_linear(1983, |scene| {
        for scene in [scene, &pushed(scene)] {
            let found = differences(scene, &some_multipliers(scene));
            worst.set(std::array::from_fn(|i| worst.get()[i].max(found[i])));
            prop_assert!(found.iter().all(|&d| d < 1e-9), "{found:?}\n{}", scene.to_toml());
        }
        Ok(())
    });
    println!("largest differences {:?}", worst.get().map(|d| format!("{d:.1e}")));
    assert!(worst.get()[0] > 0.0, "round-off is never zero on every system: nothing was compared");
}

#[test]
fn motions_are_those_of_the_multiplier_form() {
    for scene in linear_scenes() {
        let mu: Vec<f64> = some_multipliers(&scene).iter().map(|mu| 0.3 * mu).collect();
        let mut reference = motion_of(&scene, equations(&scene.system, VAKONOMIC, None), &mu, &tight());
        let mut motion = motion_of(&scene, equations(&scene.system, REDUCED_VAKONOMIC, None), &mu, &tight());
        let (distance, end) = known_gap(&mut reference, &mut motion);
        let guards = motion.equations.guards.len();
        must(&format!("{}: quasi-velocities, {guards} guards, to {end:.2} s", scene.name), distance, 1e-9);
        assert!(guards > 0 || end > 0.0, "{}: nothing was compared", scene.name);
        let residual = constraint_residual(&scene, &mut motion);
        must(&format!("{}: |f| without projection", scene.name), residual, 1e-11);
    }
}

#[test]
fn multipliers_and_series_follow_along_the_motion() {
    for scene in [scene("sledge", &[]), scene("disc", &[]), trailer::scene(2, Coordinates::Maximal).expect("parses")] {
        let mu: Vec<f64> = some_multipliers(&scene).iter().map(|mu| 0.3 * mu).collect();
        let mut reference = vakonomic(&scene, &mu);
        let settings = Settings { method: Some(Method::Taylor), tolerance: TIGHT, ..tight() };
        let mut motion = motion_of(&scene, equations(&scene.system, REDUCED_VAKONOMIC, None), &mu, &settings);
        let (distance, end) = known_gap(&mut reference, &mut motion);
        must(&format!("{}: by Taylor series, to {end:.2} s", scene.name), distance, 1e-9);
        let t = scene.start.t + 0.5 * (end - scene.start.t);
        let found = [&mut reference, &mut motion].map(|m| at(m, t).multipliers);
        must(&format!("{}: multipliers at {t:.2} s", scene.name), apart(&found[1], &found[0]), 1e-8);
    }
}

/// `L` quartic in the velocities: `w` by Newton's method.
const QUARTIC: &str = include_str!("../scenes/quartic.toml");

#[test]
fn a_lagrangian_that_is_not_quadratic_is_solved_by_newton() {
    let scene = Scene::parse("quartic", QUARTIC).expect("parses");
    let [rates, velocities, multipliers] = differences(&scene, &[0.4]);
    must("quartic: rates", rates, 1e-13);
    must("quartic: velocities and multipliers", velocities.max(multipliers), 1e-12);
    let mut reference = vakonomic(&scene, &[0.4]);
    for method in [Method::Dop853, Method::Taylor] {
        let settings = Settings { method: Some(method), ..tight() };
        let mut motion = motion_of(&scene, equations(&scene.system, REDUCED_VAKONOMIC, None), &[0.4], &settings);
        must(&format!("quartic: {method:?}"), known_gap(&mut reference, &mut motion).0, 1e-10);
    }
}

#[test]
fn a_train_takes_two_unknowns_whatever_its_length() {
    let scene = trailer::scene(12, Coordinates::Maximal).expect("parses");
    let equations = raw(&scene, REDUCED_VAKONOMIC);
    assert_eq!(equations.unknowns().len(), 2);
    assert!(equations.guards.is_empty());
    let form = Plan::choose(&equations, None).expect("compiles");
    assert!(form.left.is_empty(), "{:?}", form.why);
    let [rates, velocities, multipliers] = differences(&scene, &some_multipliers(&scene));
    must("12 trailers: rates", rates, 1e-11);
    must("12 trailers: velocities and multipliers", velocities.max(multipliers), 1e-11);
}

#[test]
fn constraints_that_are_not_linear_are_refused() {
    let refusal = |scene: &Scene| derived(scene, REDUCED_VAKONOMIC, None, None).expect_err("refused").to_string();
    let error = refusal(&scene("appell-hamel", &[]));
    assert!(error.contains("not linear in the velocities"), "{error}");
}
