//! The constraint law of first order, `E = Q + Aᵀλ − εCλ`, `f = −λ/N`, against closed forms and its
//! neighbours.

use equations::Compiled;
use motion::{CHETAEV, FIRST_ORDER, KAPPA, Motion};
use random::realization::with_friction;
use scene::Scene;

use super::support::{
    at, common_times, complete, equations, gap, index, largest_difference, motion_of, must, must_exceed, parameter,
    scene, scenes, start, tight,
};

/// A scene with numbers of the law.
fn law(name: &str, numbers: &[(&str, f64)], duration: f64) -> Scene {
    scene(name, &[numbers, &[("duration", duration)]].concat())
}

fn motion(scene: &Scene) -> Motion {
    complete(scene, motion_of(scene, equations(&scene.system, FIRST_ORDER, None), &[], &tight()))
}

type Complex = nalgebra::Complex<f64>;

/// `V = x' + i y'` of the ball, at `ω_z`: with the homogeneous ball's `I = 2/5 m a²`
///
/// ```text
/// m V' = (1 − iεΩ) λ,   a I (ω_x + i ω_y)' = −i a² (1 − iεω_z) λ,   f = V + i a (ω_x + i ω_y) − iΩ(x + iy),
/// V' = iΩ V (1 − iεΩ) / (7/2 − iε(Ω + 5/2 ω_z))                      where f' = 0
/// ```
fn rate_of_growth(epsilon: f64, table: f64, spin: f64) -> Complex {
    let i = Complex::new(0.0, 1.0);
    i * table * (1.0 - i * epsilon * table) / (3.5 - i * epsilon * (table + 2.5 * spin))
}

#[test]
fn ball_on_a_turntable_drifts_outwards_by_the_first_trace() {
    for (spin, epsilon) in [(0.2, 0.01), (1.4, 0.01), (0.2, -0.03), (-2.0, 0.2)] {
        let scene = law("turntable", &[("epsilon", epsilon), ("psi'", spin)], 1.0);
        let equations = equations(&scene.system, FIRST_ORDER, None);
        let names: Vec<String> = equations.states.iter().map(|y| equations.graph.name(y.symbol)).collect();
        let (y, _) = start(&scene, &equations, &[]);
        let mut rates = vec![0.0; y.len()];
        Compiled::new(&equations).expect("compiles").rates(0.0, &y, &mut rates).expect("regular");
        let of = |list: &[f64], name: &str| list[names.iter().position(|own| own == name).expect(name)];
        let [v, a] = [&y, &rates].map(|list| Complex::new(of(list, "x'"), of(list, "y'")));
        // θ = π/2: ω_z = ψ'
        let expected = rate_of_growth(epsilon, parameter(&scene, "Omega"), spin);
        must(&format!("ball, spin {spin}, ε = {epsilon}: V'/V"), (a / v - expected).norm(), 1e-12);
        let first = 10.0 / 49.0 * 0.7 * (0.7 - spin) * epsilon;
        must("its growth to first order, over ε²", (expected.re - first).abs() / (epsilon * epsilon), 1.0);
    }
}

/// With slip `V` and `f` obey `m V' = −N f`, `m f' = −7/2 N f − i m Ω V`: two exponentials.
#[test]
fn ball_that_creeps_on_a_turntable() {
    for slip in [0.02, 0.2] {
        let scene = law("turntable", &[("slip", slip)], 4.0);
        let (table, viscosity) = (parameter(&scene, "Omega"), 1.0 / slip);
        let i = Complex::new(0.0, 1.0);
        // r² + 7/2 N r − iΩN = 0, V(0) = V₀, V'(0) = 0
        let (half, product) = (1.75 * viscosity, i * table * viscosity);
        let root = (Complex::from(half * half) + product).sqrt();
        let [slow, fast] = [-half + root, -half - root];
        let place = [index(&scene, "x"), index(&scene, "y")];
        let [from, v] = [&scene.start.q, &scene.start.v].map(|list| Complex::new(list[place[0]], list[place[1]]));
        let (a, b) = (-fast * v / (slow - fast), slow * v / (slow - fast));
        let exact = |t: f64| from + a * ((slow * t).exp() - 1.0) / slow + b * ((fast * t).exp() - 1.0) / fast;
        let mut motion = motion(&scene);
        let off = common_times(&[&motion]).into_iter().map(|t| {
            let now = at(&mut motion, t).coordinates;
            (Complex::new(now[place[0]], now[place[1]]) - exact(t)).norm()
        });
        must(&format!("ball that creeps, 1/N = {slip}"), off.fold(0.0, f64::max), 1e-9);
        let growth = 8.0 / 343.0 * table * table * slip;
        must("its growth to first order, over 1/N²", (slow.re - growth).abs() / (slip * slip), 0.1);
    }
}

/// Slip is friction across: the unconstrained system with the force `−N Aᵀ f`, derived another way.
#[test]
fn slip_is_the_realization_by_friction() {
    for name in ["sledge", "disc", "ball-in-cone", "appell-hamel"] {
        let slip = 0.05;
        let own = law(name, &[("slip", slip)], 0.5);
        let plain = scene(name, &[("duration", 0.5)]);
        let free = Scene { system: with_friction(&plain.system, 1.0 / slip), ..plain };
        let mut other = motion_of(&free, equations(&free.system, CHETAEV, None), &[], &tight());
        must(&format!("{name}: slip and friction"), gap(&mut motion(&own), &mut other).0, 1e-9);
    }
}

/// On the slow manifold `μ = −λ/κ + O(1/κ²)`: what is left between the law and the family falls as ε².
#[test]
fn the_law_is_the_family_to_first_order() {
    for (name, end) in [("sledge", 1.0), ("turntable", 1.0), ("sleigh", 1.0), ("trailer", 1.0), ("ball-in-cone", 0.2)] {
        let apart = |epsilon: f64| {
            let own = law(name, &[("epsilon", epsilon)], end);
            let mut ours = motion(&own);
            let now = ours.start();
            let mu: Vec<f64> = at(&mut ours, now).multipliers.iter().map(|lambda| -epsilon * lambda).collect();
            let other = law(name, &[("kappa", 1.0 / epsilon)], end);
            let mut family = motion_of(&other, equations(&other.system, KAPPA, None), &mu, &tight());
            let mut plain = motion_of(&other, equations(&other.system, CHETAEV, None), &[], &tight());
            [gap(&mut ours, &mut family).0, gap(&mut plain, &mut family).0]
        };
        let (one, two) = (apart(0.008), apart(0.004));
        println!("{name}: law and family {:.2e}, {:.2e}; Chetaev and family {:.2e}", one[0], two[0], one[1]);
        must_exceed(&format!("{name}: distance at ε over that at ε/2"), one[0] / two[0], 3.6);
        must(&format!("{name}: distance of the law over that of Chetaev"), one[0] / one[1], 0.1);
    }
}

/// `v·Cλ = 0` for `f` homogeneous in `v`: the energy stays. Slip takes `λ²/N` of it.
#[test]
fn the_trace_does_no_work_and_slip_takes_what_it_must() {
    let mut kept = 0;
    for scene in scenes() {
        let own = law(&scene.name, &[("epsilon", 0.02)], 0.5);
        let mut motion = motion(&own);
        let claimed = |motion: &Motion| motion.equations.invariants.iter().any(|i| i.name == "energy");
        let chetaev = motion_of(&own, equations(&own.system, CHETAEV, None), &[], &tight());
        assert_eq!(claimed(&motion), claimed(&chetaev), "{}", scene.name);
        let times = common_times(&[&motion]);
        for (name, start, drift) in motion.invariant_drift(&times).expect("readable") {
            must(&format!("{}: {name} along the law", scene.name), drift / start.abs().max(1.0), 1e-9);
            kept += usize::from(name == "energy");
        }
    }
    assert!(kept >= 6, "{kept} scenes");

    let scene = law("sledge", &[("slip", 0.1)], 1.0);
    let g = &scene.system.graph;
    let mut motion = motion(&scene);
    assert!(motion.equations.invariants.iter().all(|i| i.name != "energy"));
    let mut energy = |t: f64| {
        let state = super::support::state_at(&mut motion, t);
        super::support::number(g, scene.system.energy(), &super::support::values(&scene.system, &state))
    };
    let lost = energy(0.0) - energy(1.0);
    let mut motion = self::motion(&scene);
    // Simpson
    let (steps, h) = (2000_usize, 1.0 / 2000.0);
    let power = |motion: &mut Motion, i: usize| 0.1 * at(motion, i as f64 * h).multipliers[0].powi(2);
    let weight = |i: usize| if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    let work: f64 = (0..=steps).map(|i| weight(i) * power(&mut motion, i)).sum::<f64>() * h / 3.0;
    must("sledge that creeps: energy lost less ∫ λ²/N", (lost - work).abs(), 1e-8);
    must_exceed("sledge that creeps: energy lost", lost, 1e-2);
}

#[test]
fn without_trace_and_slip_it_is_chetaev() {
    for scene in scenes() {
        let own = law(&scene.name, &[("epsilon", 0.0)], 0.5);
        let mut plain = motion_of(&own, equations(&own.system, CHETAEV, None), &[], &tight());
        let mut law = motion(&own);
        let t = law.end();
        let (one, two) = (at(&mut law, t), at(&mut plain, t));
        must(&format!("{}: ε = 0", scene.name), largest_difference(&one.coordinates, &two.coordinates), 1e-10);
    }
}
