//! Removed-constraint motions inside the vakonomic family, and outside of it (T2, T3).

use comparison::best_fit;
use motion::{Metric, VAKONOMIC, setting};
use scene::Scene;

use super::support::{
    at, common_times, equations, gap, matching_multipliers, must, must_exceed, number, parameter, removal, removed,
    scene, state_at, tight, vakonomic, values,
};

/// `t₁ = −u̇₀/(g sin α cos φ₀)` and `g sin α`: the horizon for which `p_u = 0`.
fn sledge_horizon(scene: &Scene) -> (f64, f64) {
    let gravity = parameter(scene, "g") * parameter(scene, "alpha").sin();
    let (v, phi) = (&scene.start.v, scene.start.q[2]);
    let speed = v[0] * phi.cos() + v[1] * phi.sin();
    (-speed / (gravity * phi.cos()), gravity)
}

#[test]
fn sledge_with_the_matching_horizon_is_vakonomic() {
    let scene = scene("sledge", &[("duration", 3.0)]);
    let arc = removal(&scene, "arc-length");
    let (t1, gravity) = sledge_horizon(&scene);
    let phi = scene.start.q[2];
    // P_x = g sin α (t₁ − t)
    let mut gao = removed(&scene, arc, &[gravity * t1]);
    let start = at(&mut gao, 0.0);
    let name = |n: &str| gao.equations.multipliers.iter().position(|m| m.name == n).expect(n);
    let (p_u, p_x) = (start.multipliers[name("p_u")], start.multipliers[name("P_x")]);
    must("sledge, matching t₁: |p_u|", p_u.abs(), 1e-14);

    // Aᵀ μ₀ = p_q − L_v with p_q = (−P_x, 0, p_φ), A = (−sin φ, cos φ, 0)
    let mu0 = gravity * t1 * phi.sin();
    let v = &scene.start.v;
    let along_x = -p_x - v[0] + mu0 * phi.sin();
    let along_y = -v[1] - mu0 * phi.cos();
    must(
        "sledge, matching t₁: μ₀ = g t₁ sin α sin φ₀ solves Aᵀμ₀ = p_q − L_v",
        along_x.abs().max(along_y.abs()),
        1e-14,
    );
    let (distance, end) = gap(&mut gao, &mut vakonomic(&scene, &[mu0]));
    assert_eq!(end, 3.0);
    must("sledge, matching t₁: removed constraint against vakonomic, 3 s", distance, 1e-10);
    must_exceed("sledge, the other sign of μ₀", gap(&mut gao, &mut vakonomic(&scene, &[-mu0])).0, 1e-3);
}

#[test]
fn sledge_with_another_horizon_is_on_no_vakonomic_motion() {
    let scene = scene("sledge", &[("duration", 3.0)]);
    let arc = removal(&scene, "arc-length");
    let vakonomic_equations = equations(&scene.system, VAKONOMIC, None);
    let mut metric = Metric::new(&scene.system).expect("compiles");
    let (matching, gravity) = sledge_horizon(&scene);
    for (t1, there_is_one) in [(matching, true), (matching + 1.0, false), (0.0, false), (10.0, false)] {
        let mut gao = removed(&scene, arc, &[gravity * t1]);
        let guesses: Vec<Vec<f64>> = [0.0, 1.0, -1.0, 5.0, -5.0, 12.0].map(|mu| vec![mu]).to_vec();
        let fitted = best_fit(setting(&scene), &vakonomic_equations, &mut gao, &guesses, &mut metric, &tight());
        let mut fitted = fitted.expect("a fit").expect("a motion");
        let what = format!("sledge, t₁ = {t1:.3}: gap to the best vakonomic (μ₀ = {:.4})", fitted.constants[0]);
        let left = gap(&mut gao, &mut fitted).0;
        if there_is_one {
            must(&what, left, 1e-9);
        } else {
            must_exceed(&what, left, 1e-2);
        }
    }
}

#[test]
fn three_cylinders_by_turn_is_vakonomic_and_keeps_its_constraints() {
    let scene = scene("three-cylinders", &[]);
    let by_turn = removal(&scene, "by-turn");
    // the scene's own constants: P of φ₁, φ₂, s at the start
    let constants = match &by_turn.constants {
        mechanics::ConstantsRule::Given(values) => values.clone(),
        other => panic!("{other:?}"),
    };
    let mut given: Vec<f64> = constants.iter().copied().filter(|&c| c != 0.0).collect();
    given.sort_by(f64::total_cmp);
    assert_eq!(given, [-0.03, 0.05, 0.08]);
    let mut gao = removed(&scene, by_turn, &constants);
    let (mu0, residual) = matching_multipliers(&scene, by_turn, &mut gao);
    must("three-cylinders: residual of Aᵀμ₀ = p_q − L_v, 6 equations for 4", residual, 1e-12);
    let (distance, end) = gap(&mut gao, &mut vakonomic(&scene, &mu0));
    assert_eq!(end, 1.0);
    must("three-cylinders: removed constraint against vakonomic, 1 s", distance, 1e-10);
    let (mut worst, g) = (0.0_f64, &scene.system.graph);
    for t in common_times(&[&gao]) {
        let values = values(&scene.system, &state_at(&mut gao, t));
        worst = scene.system.constraints.iter().map(|&f| number(g, f, &values).abs()).fold(worst, f64::max);
    }
    must("three-cylinders: constraints (14)-(17) along the motion", worst, 1e-10);
}
