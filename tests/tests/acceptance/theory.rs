//! Numbers of `docs/theory.md` and `docs/removal.md`, each with a case in which a hypothesis is dropped.

use comparison::{Answer, membership};
use mechanics::ConstantsRule;
use motion::{CHETAEV, FIRST_ORDER, KAPPA, Motion, REMOVED_CONSTRAINT, VAKONOMIC, solve_choice};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use random::realization::{at_momentum, massive, with_added_mass, with_friction};
use scene::Scene;

use super::support::{
    at, chetaev, choice, complete, equations, gap, matrix, motion_of, must, must_exceed, number, parameter, removal,
    scene, state_at, tight, vakonomic, values,
};

/// The sledge with `term` added to its Lagrangian, for 2 s.
fn sledge_with(term: &str) -> Scene {
    let text = scene::catalogue::source("sledge").expect("built in");
    let text = format!("{text}\n[system]\nlagrangian = \"0 {term}\"\n");
    Scene::parse_with("sledge", &text, &[("duration".to_string(), 2.0_f64)]).unwrap_or_else(|e| panic!("{e}"))
}

/// A scene in `x`, `y`, `z` that starts at `x`, `y = 0.3`, `z = 0` with `x' = 0.8`, `y' = 0.5`, for 1 s.
fn particle(x: f64, lagrangian: &str, constraint: &str) -> Scene {
    let text = format!(
        "title = \"particle\"\n[coordinates]\nx = {{ start = {x} }}\ny = {{ start = 0.3 }}\nz = {{ start = 0 }}\n\
         [system]\nlagrangian = \"{lagrangian}\"\nconstraints = [\"{constraint}\"]\n\
         [start.velocities]\n\"x'\" = 0.8\n\"y'\" = 0.5\n[run]\nduration = 1\n"
    );
    Scene::parse("particle", &text).unwrap_or_else(|e| panic!("{e}"))
}

fn by_arc_length(scene: &Scene, constants: ConstantsRule) -> Motion {
    let choice = choice(REMOVED_CONSTRAINT, Some(removal(scene, "arc-length")), constants);
    complete(scene, solve_choice(scene, &choice, &tight()).unwrap_or_else(|e| panic!("{e}")))
}

fn x_at_2(motion: &mut Motion) -> f64 {
    at(motion, 2.0).coordinates[0]
}

/// Theorem 4(d) and Proposition 2: `P(t₀) = 0` and `P(t₁) = 0` see `dF/dt`, and nothing sees `φ·f` but
/// Chetaev.
#[test]
fn removal_sees_the_gauge_of_l() {
    let (plain, gauge) = (sledge_with(""), sledge_with("+ 0.7*x'"));
    let off = sledge_with("+ 0.7*(y'*cos(phi) - x'*sin(phi))");
    let horizon = || ConstantsRule::Natural { horizon: 10.0 };
    let given = |p: f64| ConstantsRule::Given(vec![p, 0.0]);
    for (what, scene, rule, expected) in [
        ("L, P(t₀) = 0", &plain, ConstantsRule::Zero, 1.98898),
        ("L + 0.7 f, P(t₀) = 0", &off, ConstantsRule::Zero, 1.98898),
        ("L + 0.7 x', P(t₀) = 0", &gauge, ConstantsRule::Zero, 2.88268),
        ("L + 0.7 x', P(t₀) = (−0.7, 0)", &gauge, given(-0.7), 1.98898),
        ("L, P(10) = 0", &plain, horizon(), 6.04463),
        ("L + 0.7 f, P(10) = 0", &off, horizon(), 6.04463),
        ("L + 0.7 x', P(10) = 0", &gauge, horizon(), 5.98632),
    ] {
        must(&format!("sledge, {what}: x(2)"), (x_at_2(&mut by_arc_length(scene, rule)) - expected).abs(), 6e-6);
    }
    let removed = |scene: &Scene, p: f64| by_arc_length(scene, given(p));
    let (mut one, mut two) = (removed(&plain, 0.0), removed(&gauge, -0.7));
    must("sledge: P(t₀) − F_w selects the same motion", gap(&mut one, &mut two).0, 1e-9);

    must("Chetaev sees no gauge", gap(&mut chetaev(&plain), &mut chetaev(&gauge)).0, 1e-9);
    must("nor does vakonomic", gap(&mut vakonomic(&plain, &[0.0]), &mut vakonomic(&gauge, &[0.0])).0, 1e-9);
    must("L + 0.7 f: μ₀ − 0.7", gap(&mut vakonomic(&plain, &[0.0]), &mut vakonomic(&off, &[-0.7])).0, 1e-9);
    must_exceed("L + 0.7 f: Chetaev is another", gap(&mut chetaev(&plain), &mut chetaev(&off)).0, 1.0);
    must("Chetaev: x(2)", (x_at_2(&mut chetaev(&plain)) - 0.28259).abs(), 6e-6);
    must("vakonomic: x(2)", (x_at_2(&mut vakonomic(&plain, &[0.0])) - 1.55397).abs(), 6e-6);
    must("Chetaev of L + 0.7 f: x(2)", (x_at_2(&mut chetaev(&off)) - 2.69820).abs(), 6e-6);
}

/// Theorem 4(b): the family of quasi-velocities is the union of vakonomic families of `L − c·θ`.
#[test]
fn removal_by_arc_length_is_vakonomic_for_another_l() {
    let plain = sledge_with("");
    let along = |c: f64| sledge_with(&format!("- {c}*(x'*cos(phi) + y'*sin(phi))"));
    let mut zero = by_arc_length(&plain, ConstantsRule::Zero);
    // c = G_u' = speed along the blade + P along it
    must("P(t₀) = 0 is vakonomic for L − u'/2, μ₀ = 0", gap(&mut zero, &mut vakonomic(&along(0.5), &[0.0])).0, 1e-9);
    must_exceed("and not for L", gap(&mut zero, &mut vakonomic(&plain, &[0.0])).0, 0.1);

    let (p, phi) = ([0.3, -0.8], plain.start.q[2]);
    let c = 0.5 + p[0] * phi.cos() + p[1] * phi.sin();
    // Aᵀμ₀ = −P − L_v + c θ_v; A = (−sin φ, cos φ, 0) is orthogonal to θ_v and to the speed
    let mu0 = p[0] * phi.sin() - p[1] * phi.cos();
    must("c", (c - 0.55018).abs(), 6e-6);
    must("μ₀", (mu0 - 0.85293).abs(), 6e-6);
    let mut given = by_arc_length(&plain, ConstantsRule::Given(p.to_vec()));
    must("P(t₀) = (0.3, −0.8): x(2)", (x_at_2(&mut given) - 3.04603).abs(), 6e-6);
    must("it is vakonomic for L − c u'", gap(&mut given, &mut vakonomic(&along(c), &[mu0])).0, 1e-9);
}

/// Theorem 9(d): `κ → ∞` leads to Chetaev only if the start is regular at `s μ₀` on the whole way to 0.
#[test]
fn kappa_needs_a_regular_way_from_its_multiplier() {
    for kappa in [20.0, 200.0] {
        let own = scene("appell-hamel", &[("kappa", kappa), ("duration", 0.5)]);
        let critical = parameter(&own, "m") / (2.0 * parameter(&own, "a").powi(2));
        let family = |mu0: f64| motion_of(&own, equations(&own.system, KAPPA, None), &[mu0], &tight());
        let above = family(1.5 * critical);
        assert!(!above.is_complete(), "κ = {kappa}: goes on");
        let expected = 1.5_f64.ln() / kappa;
        must(&format!("Appell–Hamel, κ = {kappa}: end over ln(1.5)/κ"), (above.end() / expected - 1.0).abs(), 0.02);
        let mut below = complete(&own, family(0.5 * critical));
        must("below the critical multiplier it is Chetaev's", gap(&mut below, &mut chetaev(&own)).0, 1e-9);
    }
}

/// `Cᵢ` at the start of Chetaev's motion, from the rates of `A` along it, with its row `A`.
fn derivative_of_constraint(scene: &Scene, motion: &mut Motion, t: f64) -> [Vector3<f64>; 2] {
    let g = &scene.system.graph;
    let row = |motion: &mut Motion, t: f64| {
        let values = values(&scene.system, &state_at(motion, t));
        Vector3::from_iterator(matrix(g, &scene.system.constraint_jacobian(), &values).iter().copied())
    };
    let h = 1e-3;
    let rate = ((row(motion, t + h) - row(motion, t - h)) * 8.0 - row(motion, t + 2.0 * h) + row(motion, t - 2.0 * h))
        / (12.0 * h);
    let by_place = g.jacobian(&scene.system.constraints, &scene.system.positions());
    let by_place = matrix(g, &by_place, &values(&scene.system, &state_at(motion, t)));
    [Vector3::from_iterator(by_place.iter().copied()) - rate, row(motion, t)]
}

/// Theorem 3(i): an integrable constraint that is no total derivative has `C ≠ 0`, no curvature, and one
/// motion.
#[test]
fn a_factor_gives_c_but_no_curvature() {
    let lagrangian = "(x'^2 + y'^2 + z'^2)/2 - x*y + z/3";
    let own = particle(0.2, lagrangian, "x*(z' + x'*y + x*y')");
    let mut plain = chetaev(&own);
    let [c, a] = derivative_of_constraint(&own, &mut plain, 0.5);
    must_exceed("x d/dt(z + xy): |C|", c.norm(), 0.1);
    must("NᵀC: C × A over |A|", c.cross(&a).norm() / a.norm(), 1e-8);
    for mu0 in [0.0, 0.9, -2.0] {
        must(&format!("Chetaev and vakonomic, μ₀ = {mu0}"), gap(&mut plain, &mut vakonomic(&own, &[mu0])).0, 1e-9);
    }
    let curved = particle(0.2, lagrangian, "x*(z' + x'*y)");
    let mut plain = chetaev(&curved);
    let [c, a] = derivative_of_constraint(&curved, &mut plain, 0.5);
    must_exceed("x (z' + x'y): NᵀC", c.cross(&a).norm() / a.norm(), 1e-2);
    must_exceed("Chetaev and vakonomic, μ₀ = 0.9", gap(&mut plain, &mut vakonomic(&curved, &[0.9])).0, 1e-3);
}

/// Theorem 3(iii): of one integrable and one nonintegrable constraint, the multiplier of the first does
/// nothing.
#[test]
fn a_multiplier_of_an_integrable_part_does_nothing() {
    let text = "title = \"partly integrable\"\n[coordinates]\nx = { start = 0.5 }\ny = { start = 0.3 }\n\
                z = { start = 0 }\nw = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2 + z'^2 + w'^2)/2 + x - w*z\"\n\
                constraints = [\"z' - x*y' - y*x'\", \"w' - y*x'\"]\n\
                [start.velocities]\n\"x'\" = 0.4\n\"y'\" = 0.2\n[run]\nduration = 1.5\n";
    let own = Scene::parse("partly", text).unwrap_or_else(|e| panic!("{e}"));
    let mut zero = vakonomic(&own, &[0.0, 0.0]);
    must("μ₀ = (0.9, 0) and 0", gap(&mut zero, &mut vakonomic(&own, &[0.9, 0.0])).0, 1e-9);
    must_exceed("μ₀ = (0, 0.9) and 0", gap(&mut zero, &mut vakonomic(&own, &[0.0, 0.9])).0, 1e-3);
}

/// Theorem 3(iv): with one velocity left free, linear autonomous constraints admit one motion.
#[test]
fn one_free_velocity_leaves_one_motion() {
    let of = |second: &str| {
        let text = format!(
            "title = \"one free velocity\"\n[coordinates]\nx = {{ start = 0.5 }}\ny = {{ start = 0.3 }}\n\
             z = {{ start = 0.4 }}\n[system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2 + x - y*z\"\n\
             constraints = [\"z' - y*x'\", \"{second}\"]\n[start.velocities]\n\"x'\" = 0.4\n\
             [run]\nduration = 1\n"
        );
        Scene::parse("one-free", &text).unwrap_or_else(|e| panic!("{e}"))
    };
    let apart = |scene: Scene| gap(&mut chetaev(&scene), &mut vakonomic(&scene, &[0.9, -0.4])).0;
    must("linear, autonomous", apart(of("y' - z*x'")), 1e-9);
    must_exceed("affine", apart(of("y' - z*x' - x")), 1e-3);
}

/// Theorem 5: for `f` nonlinear in `v` the coefficient needs `Π` at `μ₀`.
#[test]
fn the_gap_begins_with_the_projector_at_the_multiplier() {
    let own = particle(0.2, "(x'^2 + y'^2 + z'^2)/2 - x*y", "z' - x'^2/2 - y*x'");
    let (x, y, vx, vy, mu0) = (0.2, 0.3, 0.8, 0.5, 0.7);
    let a: Vector3<f64> = Vector3::new(-vx - y, 0.0, 1.0);
    let force: Vector3<f64> = Vector3::new(-y, -x, 0.0);
    // A a = x'y' with a = force + Aᵀλ
    let lambda: f64 = (vx * vy - a.dot(&force)) / a.norm_squared();
    let acceleration: Vector3<f64> = force + a * lambda;
    let c = Vector3::new(acceleration.x + vy, -vx, 0.0);
    let predicted = |hessian: Matrix3<f64>| {
        let n = DMatrix::from_column_slice(3, 2, &[1.0, 0.0, vx + y, 0.0, 1.0, 0.0]);
        let inner = n.transpose() * DMatrix::from_column_slice(3, 3, hessian.as_slice()) * &n;
        let right = n.transpose() * DVector::from_column_slice((c * mu0).as_slice());
        (n * inner.lu().solve(&right).expect("regular") / 2.0).norm()
    };
    // M + μ·f_vv
    let with = |mu: f64| predicted(Matrix3::from_diagonal(&Vector3::new(1.0 - mu, 1.0, 1.0)));
    let [at_mu, at_zero] = [mu0, 0.0].map(with);
    must("with Π at μ₀", (at_mu - 0.28572).abs(), 6e-6);
    must("with Π at 0", (at_zero - 0.28269).abs(), 6e-6);
    let (mut one, mut two) = (chetaev(&own), vakonomic(&own, &[mu0]));
    let mut ratio = |t: f64| {
        let [a, b] = [&mut one, &mut two].map(|m| DVector::from_vec(at(m, t).coordinates));
        (b - a) / (t * t)
    };
    // c + c₁ t + c₂ t² from t, 2t and 4t
    let measured = ((ratio(0.002) * 8.0 - ratio(0.004) * 6.0 + ratio(0.008)) / 3.0).norm();
    must("measured: off the one", (measured - at_mu).abs(), 5e-5);
    must_exceed("measured: off the other", (measured - at_zero).abs(), 2e-3);
}

/// Theorem 10: `(κ)` and `(ε)` are `O(ε²)` apart for `μ₀ = 0`, `O(ε)` for a fixed `μ₀`, unless the start is
/// kicked.
#[test]
fn a_multiplier_at_the_start_kicks() {
    let apart = |kappa: f64, mu0: f64, kicked: bool| {
        let epsilon = 1.0 / kappa;
        let family = scene("sledge", &[("kappa", kappa), ("duration", 2.0)]);
        let motion = motion_of(&family, equations(&family.system, KAPPA, None), &[mu0], &tight());
        let mut family = complete(&family, motion);
        // Π C μ₀ = μ₀ (φ' along the blade, −u'/k²)
        let kick = if kicked { epsilon * mu0 } else { 0.0 };
        let (speed, turn) = (0.5 + kick * 1.1, 1.1 - kick * 0.5 / 0.49);
        let start = [("epsilon", epsilon), ("duration", 2.0), ("x'", speed * 0.3_f64.cos()), ("phi'", turn)];
        let law = scene("sledge", &start);
        let mut law = complete(&law, motion_of(&law, equations(&law.system, FIRST_ORDER, None), &[], &tight()));
        gap(&mut family, &mut law).0
    };
    for (what, mu0, kicked, least, most) in [
        ("μ₀ = 0", 0.0, false, 3.4, 4.6),
        ("μ₀ = 1", 1.0, false, 1.7, 2.3),
        ("μ₀ = 1 with the kick", 1.0, true, 3.4, 4.6),
    ] {
        let [one, two] = [200.0, 400.0].map(|kappa| apart(kappa, mu0, kicked));
        println!("sledge, {what}: {one:.2e} at κ = 200, {two:.2e} at κ = 400");
        must_exceed(&format!("sledge, {what}: their ratio"), one / two, least);
        must(&format!("sledge, {what}: their ratio"), one / two, most);
    }
}

/// Proposition 1: `f → g f` changes nothing of `(κ)`, and `(ε)` by `O(ε²)`.
#[test]
fn a_factor_of_the_constraint() {
    let text = scene::catalogue::source("sledge").expect("built in");
    let factor = "(2 + sin(phi) + x^2)*(y'*cos(phi) - x'*sin(phi))";
    let factor = format!("\n[system]\nconstraints = [\"{factor}\"]\n[start.velocities]");
    let (free, contact) = text
        .split_once("[contact")
        .and_then(|(head, tail)| tail.split_once("[start.velocities]").map(|(_, tail)| (head, tail)))
        .expect("a contact");
    let other = format!("{free}{factor}{contact}");
    let both = |numbers: &[(&str, f64)]| {
        let numbers: Vec<(String, f64)> = numbers.iter().map(|&(n, x)| (n.to_string(), x)).collect();
        [&text, &other].map(|text| Scene::parse_with("sledge", text, &numbers).unwrap_or_else(|e| panic!("{e}")))
    };
    let [plain, other] = both(&[("kappa", 5.0), ("duration", 1.0)]);
    let family = |scene: &Scene, mu0: f64| motion_of(scene, equations(&scene.system, KAPPA, None), &[mu0], &tight());
    // μ₀ = g μ₀′, g = 2 + sin 0.3 at the start
    let scaled = 0.8 / (2.0 + 0.3_f64.sin());
    must("κ: f and g f", gap(&mut family(&plain, 0.8), &mut family(&other, scaled)).0, 1e-9);
    must_exceed("κ: with the same μ₀", gap(&mut family(&plain, 0.8), &mut family(&other, 0.8)).0, 1e-3);
    let apart = |epsilon: f64| {
        let [mut one, mut two] = both(&[("epsilon", epsilon), ("duration", 1.0)])
            .map(|scene| motion_of(&scene, equations(&scene.system, FIRST_ORDER, None), &[], &tight()));
        gap(&mut one, &mut two).0
    };
    let [one, two] = [0.005, 0.0025].map(apart);
    must_exceed("ε: distance of f and g f at ε over that at ε/2", one / two, 3.6);
    must_exceed("ε: it is not zero", two, 1e-6);
}

/// Theorem 9(a): friction slows a slip if `A M⁻¹ Aᵀ` is positive, and drives it on if it is negative.
#[test]
fn friction_needs_the_right_half_plane() {
    for (sign, slows) in [("+", true), ("-", false)] {
        let own = particle(0.2, &format!("(x'^2 + y'^2 {sign} z'^2)/2"), "z' - y*x'");
        let free = Scene { system: with_friction(&own.system, 30.0), duration: 0.3, ..own.clone() };
        let mut motion = motion_of(&free, equations(&free.system, CHETAEV, None), &[], &tight());
        let state = state_at(&mut motion, 0.3);
        let g = &own.system.graph;
        let slip = number(g, own.system.constraints[0], &values(&own.system, &state)).abs();
        if slows {
            must("friction, M = (1, 1, 1): slip after 0.3 s", slip, 0.03);
        } else {
            must_exceed("friction, M = (1, 1, −1): slip after 0.3 s", slip, 1.0);
        }
    }
}

/// Theorem 9(b): in `(q, v, μ = N f)` added mass is a regular perturbation of the vakonomic motion, in
/// velocities alone it is stiff.
#[test]
fn added_mass_is_a_regular_perturbation_with_its_multiplier() {
    let own = scene("particle", &[]);
    let strength = 1e6;
    let setting = motion::setting(&own);
    let (start, multipliers) = at_momentum(setting, strength, &[0.4]).expect("momenta");
    let setting = motion::Setting { start: &start, ..setting };
    let (free, equations_in_mu) = massive(&own.system, strength, 0.0).expect("equations");
    let run = |system: &mechanics::System, equations, constants: &[f64]| {
        let settings = motion::Settings {
            tolerance: 1e-9,
            method: Some(integrate::Method::Dop853),
            ..motion::Settings::default()
        };
        let rule = ConstantsRule::Given(constants.to_vec());
        let motion = motion::solve(motion::Setting { system, ..setting }, equations, &rule, &settings);
        motion.unwrap_or_else(|e| panic!("{e}"))
    };
    let mut with = run(&free, equations_in_mu, &multipliers);
    let stiff = with_added_mass(&own.system, strength);
    let mut without = run(&stiff, equations(&stiff, CHETAEV, None), &[]);
    let [few, many] = [&with, &without].map(|motion| motion.work.evaluations);
    println!("particle, N = 1e6: {few} evaluations with μ, {many} without");
    assert!(with.is_complete() && 20 * few < many, "{few} evaluations with μ, {many} without");
    // the limit, and the same motion by other equations as far as these get
    let end = without.end();
    must(
        "added mass with and without μ",
        (at(&mut with, end).coordinates[1] - at(&mut without, end).coordinates[1]).abs(),
        1e-6,
    );
    must("added mass and vakonomic", gap(&mut vakonomic(&own, &[0.4]), &mut with).0, 1e-4);
    must_exceed("they are not the same", gap(&mut vakonomic(&own, &[0.4]), &mut with).0, 1e-9);
}

/// Theorem 7(a, b): at generic starts the order `h` is enough, and it is attained.
#[test]
fn the_order_h_is_attained() {
    use comparison::Finding;
    for (name, h) in [("three-cylinders", 4), ("sledge", 1)] {
        let own = scene(name, &[]);
        assert_eq!(own.system.constraints.len(), h, "{name}");
        let found = membership(&own, own.start.t + 1.0).expect("decided").expect("constrained");
        let Finding::None(none) = &found.proof.almost_every_start else { panic!("{name}: {:?}", found.proof) };
        println!("{name}: none for almost every start, order {} of h = {h}", none.order);
        assert!(none.order <= h, "{name}: order {} > {h}", none.order);
        if name == "three-cylinders" {
            assert_eq!(none.order, h, "{name}");
        }
    }
}

/// Theorem 7(c): one constraint, and yet the order that refutes depends on the start.
#[test]
fn no_order_is_enough_for_special_starts() {
    for (x, power, order) in [(0.2, 4, 1), (0.0, 4, 8), (0.0, 9, 18)] {
        let own = particle(x, "(x'^2 + y'^2 + z'^2)/2", &format!("z' - x^{power}*y*x'"));
        let found = membership(&own, 1.0).expect("decided").expect("constrained").answer();
        assert_eq!(found, Answer::NoneProved { order }, "x = {x}, x^{power}");
    }
}

/// The vakonomic equations are those of `(κ)` at `κ = 0`.
#[test]
fn kappa_zero_is_vakonomic() {
    let own = scene("sledge", &[("kappa", 0.0), ("duration", 1.0)]);
    let mut family = motion_of(&own, equations(&own.system, KAPPA, None), &[0.7], &tight());
    let mut plain = motion_of(&own, equations(&own.system, VAKONOMIC, None), &[0.7], &tight());
    must("κ = 0", gap(&mut family, &mut plain).0, 1e-10);
}
