//! Formulations that must agree: two forms of one, all on integrable constraints, rewritten ones (T1, T4).

use deltaq::Choice;
use mechanics::{ConstantsRule, Removal};
use scene::Scene;
use symbolic::Matrix;

use super::support::{
    at, chetaev, complete, constrained_scenes, equations, gap, index, known_gap, largest_difference, linear_scenes,
    matrix, motion_of, must, must_exceed, removal, removed, scene, scenes, some_multipliers, tight, vakonomic, values,
};
use nalgebra::DVector;

#[test]
fn multiplier_form_and_costate_form_agree_on_every_scene() {
    for scene in scenes() {
        let h = scene.system.constraints.len();
        for mu0 in [vec![0.0; h], some_multipliers(&scene)] {
            let mut one = motion_of(&scene, equations(&scene.system, "vakonomic", None), &mu0, &tight());
            let mut two = motion_of(&scene, equations(&scene.system, "vakonomic-costate", None), &mu0, &tight());
            let (distance, end) = known_gap(&mut one, &mut two);
            assert!(end > 0.2 * scene.duration, "{}: {:?}, {:?}", scene.name, one.ending, two.ending);
            let zero = if mu0.iter().all(|&mu| mu == 0.0) { "μ₀ = 0" } else { "μ₀ ≠ 0" };
            must(
                &format!("{}, {zero}: multiplier form against costate form, to {end:.2} s", scene.name),
                distance,
                1e-9,
            );
        }
    }
}

#[test]
fn integrable_constraints_leave_nothing_to_dispute() {
    for name in ["velocity-pendulum", "bowl"] {
        let scene = scene(name, &[]);
        let mut reference = chetaev(&scene);
        for mu in [0.0, 0.7, -2.0] {
            let distance = gap(&mut vakonomic(&scene, &[mu]), &mut reference).0;
            must(&format!("{name}: vakonomic with μ₀ = {mu} against Chetaev"), distance, 1e-9);
        }
        let by_coordinates = Removal::by_coordinates(&scene.system, &scene.start).expect("a removal");
        for removal in scene.removals.iter().chain([&by_coordinates]) {
            let count = equations(&scene.system, "removed-constraint", Some(removal)).free_constants.len();
            for constant in [0.0, 0.9, -0.4] {
                let mut motion = complete(&scene, removed(&scene, removal, &vec![constant; count]));
                let distance = gap(&mut motion, &mut reference).0;
                let what =
                    format!("{name}: removal {} with P(t₀) = {constant} ({count}) against Chetaev", removal.name);
                must(&what, distance, 1e-9);
            }
        }
    }
}

/// A matrix, regular at every `q`: `(2 + sin(q₁ + 0.3)) I` plus a constant strictly lower triangle.
fn mixing(scene: &Scene) -> Matrix {
    let g = &scene.system.graph;
    let first = g.variable(scene.system.coordinates[0].position);
    let factor = g.add(g.integer(2), g.call(symbolic::Function::Sin, g.add(first, g.ratio(3, 10))));
    let h = scene.system.constraints.len();
    Matrix::from_fn(h, h, |i, j| match i.cmp(&j) {
        std::cmp::Ordering::Equal => factor,
        std::cmp::Ordering::Greater => g.ratio(1 + i as i64 - 2 * j as i64, 3),
        std::cmp::Ordering::Less => g.zero(),
    })
}

#[test]
fn chetaev_and_vakonomic_do_not_depend_on_how_constraints_are_written() {
    for scene in constrained_scenes() {
        let mix = mixing(&scene);
        let mut rewritten = scene.clone();
        let g = rewritten.system.graph.clone();
        rewritten.system.constraints = g.mat_vec(&mix, &scene.system.constraints);
        rewritten.system.graph = g;
        let motion = |scene: &Scene, name: &str, mu0: &[f64]| {
            motion_of(scene, equations(&scene.system, name, None), mu0, &tight())
        };
        let (distance, end) = known_gap(&mut motion(&scene, "chetaev", &[]), &mut motion(&rewritten, "chetaev", &[]));
        assert!(end > 0.5 * scene.duration, "{}: only up to {end}", scene.name);
        must(&format!("{}: Chetaev, constraints rewritten, to {end:.2} s", scene.name), distance, 1e-9);

        // μ·f = μ'·(G f): μ' = G⁻ᵀ μ
        let mu0 = some_multipliers(&scene);
        let at_start = matrix(&scene.system.graph, &mix, &values(&scene.system, &scene.start));
        let transformed = at_start.transpose().lu().solve(&DVector::from_vec(mu0.clone())).expect("regular");
        let mut two = motion(&rewritten, "vakonomic", transformed.as_slice());
        let (distance, end) = known_gap(&mut motion(&scene, "vakonomic", &mu0), &mut two);
        assert!(end > 0.2 * scene.duration, "{}: only up to {end}", scene.name);
        must(&format!("{}: vakonomic, constraints rewritten, to {end:.2} s", scene.name), distance, 1e-9);
    }
}

#[test]
fn removed_constraint_depends_on_the_choice_of_parameter() {
    let scene = scene("sledge", &[("duration", 0.6)]);
    let (arc, along) = (removal(&scene, "arc-length"), removal(&scene, "along-x"));
    // L has no y, so along-x has no constant; no constant of the arc length gives the same motion either
    assert!(equations(&scene.system, "removed-constraint", Some(along)).free_constants.is_empty());
    let mut by_x = complete(&scene, removed(&scene, along, &[]));
    let mut nearest = (f64::INFINITY, 0.0);
    for constant in (-200..=200).map(|i| 0.05 * f64::from(i)) {
        let distance = gap(&mut complete(&scene, removed(&scene, arc, &[constant])), &mut by_x).0;
        if distance < nearest.0 {
            nearest = (distance, constant);
        }
    }
    let zero = gap(&mut complete(&scene, removed(&scene, arc, &[0.0])), &mut by_x).0;
    must_exceed("sledge: arc length with P = 0 against along-x, 0.6 s", zero, 1e-3);
    println!("sledge: nearest of 401 constants for the arc length is P = {:.2}", nearest.1);
    must_exceed("sledge: arc length with the best of 401 constants against along-x, 0.6 s", nearest.0, 1e-3);
}

#[test]
fn chetaev_motion_runs_back_the_way_it_came() {
    for scene in linear_scenes().into_iter().chain([scene("appell-hamel", &[])]) {
        let mut forth = chetaev(&scene);
        let end = super::support::state_at(&mut forth, scene.start.t + scene.duration);
        let mut returning = scene.clone();
        returning.start.q = end.q;
        returning.start.v = end.v.iter().map(|v| -v).collect();
        if scene.name == "turntable" {
            // the reversed motion is one on a table that turns the other way
            for p in returning.system.parameters.iter_mut().filter(|p| scene.system.graph.name(p.symbol) == "Omega") {
                p.value = -p.value;
            }
        }
        let mut back = chetaev(&returning);
        let home = super::support::state_at(&mut back, scene.start.t + scene.duration);
        let position = super::support::largest_difference(&home.q, &scene.start.q);
        let velocities: Vec<f64> = home.v.iter().map(|v| -v).collect();
        let velocity = super::support::largest_difference(&velocities, &scene.start.v);
        must(&format!("{}: there and back, {} s", scene.name, scene.duration), position.max(velocity), 1e-9);
    }
}

#[test]
fn units_do_not_matter() {
    // lengths in centimetres instead of metres; L and μ·f scale by 10⁴, f by 10²
    let metres = scene("sledge", &[]);
    let speed = 0.5 * metres.start.q[2].cos();
    let centimetres = scene("sledge", &[("g", 981.0), ("k", 70.0), ("x'", 100.0 * speed)]);
    let scaled = |mut motion: deltaq::Motion, factor: f64| {
        let now = super::support::at(&mut motion, 10.0);
        let (x, phi) = (index(&metres, "x"), index(&metres, "phi"));
        [now.coordinates[x] / factor, now.coordinates[phi]]
    };
    let runs = [
        ("Chetaev", chetaev(&metres), chetaev(&centimetres)),
        ("vakonomic", vakonomic(&metres, &[0.3]), vakonomic(&centimetres, &[30.0])),
        (
            "removed constraint",
            removed(&metres, removal(&metres, "arc-length"), &[2.0]),
            removed(&centimetres, removal(&centimetres, "arc-length"), &[200.0]),
        ),
    ];
    for (name, one, two) in runs {
        let distance = super::support::largest_difference(&scaled(one, 1.0), &scaled(two, 100.0));
        must(&format!("sledge, {name}: metres against centimetres at t = 10"), distance, 1e-9);
    }
}

/// Random system (seed 2, index 8808): `∂²𝓛/∂v²` nearly singular in `q4'`, another root of `(v, μ)` close by.
const NEAR_A_FOLD: &str = include_str!("../scenes/near-a-fold.toml");

#[test]
fn costate_form_keeps_to_its_branch_near_a_fold() {
    let scene = Scene::parse("fold", NEAR_A_FOLD).unwrap_or_else(|e| panic!("{e}"));
    let mut multiplier = vakonomic(&scene, &scene.multipliers);
    let costate = motion_of(&scene, equations(&scene.system, "vakonomic-costate", None), &scene.multipliers, &tight());
    let mut costate = complete(&scene, costate);
    must("near a fold: multiplier form and costate form", gap(&mut multiplier, &mut costate).0, 1e-9);
    // read off backwards, far from where it was read last: the start velocities come out again
    let start = at(&mut costate, 0.0);
    must("near a fold: velocities read at the start", largest_difference(&start.velocities, &scene.start.v), 1e-11);
}

/// `P₀ = −∂(L + μ₀·f)/∂ẇ` for removals by coordinates with all costates, moving or not; and back.
#[test]
fn removals_by_coordinates_are_the_vakonomic_family() {
    let mut seen = 0;
    for (name, duration) in
        [("heisenberg", 2.0), ("disc", 2.0), ("sledge", 0.5), ("three-cylinders", 0.5), ("turntable", 2.0)]
    {
        let scene = scene(name, &[("duration", duration)]);
        let mu0: Vec<f64> = (0..scene.system.constraints.len()).map(|i| 0.7 - 0.45 * i as f64).collect();
        for removal in deltaq::removals(&scene).expect("removals") {
            let Some(costates) = deltaq::costates_of(&scene, &removal, &mu0).expect("values") else { continue };
            seen += 1;
            let back = deltaq::multipliers_of(&scene, &removal, &costates).expect("values").expect("regular");
            must(&format!("{name} ({}): μ₀ and back", removal.name), largest_difference(&mu0, &back), 1e-12);
            let choice = Choice {
                label: removal.name.clone(),
                formulation: "removed-constraint",
                removal: Some(removal.clone()),
                constants: ConstantsRule::Given(costates),
            };
            let mut removed = deltaq::solve_choice(&scene, &choice, &tight()).expect("a motion");
            let mut other = vakonomic(&scene, &mu0);
            let end = removed.end().min(other.end());
            let (one, two) = (at(&mut removed, end).coordinates, at(&mut other, end).coordinates);
            must(&format!("{name} ({}), t = {end}", removal.name), largest_difference(&one, &two), 1e-8);
        }
    }
    assert!(seen >= 5, "only {seen} removals by coordinates");
}
