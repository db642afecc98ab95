//! Two-point problems against closed forms, and against collocation of equations by hand.

use crate::collocation::{Rates, flow, two_points};
use crate::ends::built_in;
use crate::support::choice;
use equations::Formulation;
use integrate::Interrupt;
use mechanics::ConstantsRule;
use motion::{
    Aim, CHETAEV, Choice, Connections, REMOVED_CONSTRAINT, SecondVariation, Settings, SolveError, VAKONOMIC, connect,
};
use nalgebra::DMatrix;
use scene::Scene;

fn aim(to: &[(&str, f64)], t: f64, starts: usize) -> Aim {
    Aim { t, to: to.iter().map(|(name, q)| (name.to_string(), *q)).collect(), starts, threads: 1 }
}

fn found(name: &str, formulation: &Formulation, aim: &Aim) -> Connections {
    let scene = built_in(name);
    let found = connect(&scene, &choice(&scene, formulation), aim, &Settings::default()).expect("a search");
    let led = found.found.iter().map(|motion| motion.starts).sum::<usize>();
    assert_eq!(led + found.failures.iter().map(|failure| failure.1).sum::<usize>(), aim.starts);
    // each motion took a run in the search and one in the end, and derivatives
    assert!(found.runs[0] >= 2 * found.found.len() && found.runs[1] >= found.found.len(), "{:?}", found.runs);
    for motion in &found.found {
        assert!(motion.residuals.iter().all(|r| r.abs() < 1e-8), "{:?}", motion.residuals);
    }
    found
}

/// The root of a function between two numbers.
fn root(f: impl Fn(f64) -> f64, [mut a, mut b]: [f64; 2]) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (a + b);
        if (f(middle) > 0.0) == (f(a) > 0.0) { a = middle } else { b = middle }
    }
    0.5 * (a + b)
}

/// Geodesics of the Heisenberg group are circles on which the velocity turns by τ = μT. With chord ρ and the
/// area A between arc and chord, A/ρ² = (τ − sin τ)/(8 sin²(τ/2)); conjugate to the start is where
/// sin(τ/2) = 0 or tan(τ/2) = τ/2.
#[test]
fn geodesics_of_the_heisenberg_group_are_all_found_with_their_conjugate_times() {
    let (t, goal, from) = (8.0, [0.2, 0.5, 1.2], [0.5, 0.0]);
    let all = found("heisenberg", VAKONOMIC, &aim(&[("x", goal[0]), ("y", goal[1]), ("z", goal[2])], t, 60));
    let chord = (goal[0] - from[0]).powi(2) + (goal[1] - from[1]).powi(2);
    // what the chord itself sweeps, seen from the origin of the plane
    let area = goal[2] - 0.5 * (from[0] * goal[1] - from[1] * goal[0]);
    let mismatch = |tau: f64| (tau - tau.sin()) / 8.0 - area / chord * (0.5 * tau).sin().powi(2);
    let mut expected = Vec::new();
    for k in -3000..3000 {
        let between = [f64::from(k) * 0.01 + 0.003, f64::from(k + 1) * 0.01 + 0.003];
        if mismatch(between[0]) * mismatch(between[1]) < 0.0 && between[0] * between[1] > 0.0 {
            expected.push(root(mismatch, between));
        }
    }
    expected.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    assert_eq!(all.found.len(), expected.len(), "{expected:?}");
    assert!(expected.len() >= 3);
    let conjugate = |tau: f64| {
        let half = 0.5 * tau;
        half.sin() * (half.sin() - half * half.cos())
    };
    let mut zeros: Vec<f64> = (1..4000)
        .map(|k| [f64::from(k) * 0.01 + 0.003, f64::from(k + 1) * 0.01 + 0.003])
        .filter(|between| conjugate(between[0]) * conjugate(between[1]) < 0.0)
        .map(|between| root(conjugate, between))
        .collect();
    zeros.sort_by(f64::total_cmp);
    assert!((zeros[0] - std::f64::consts::TAU).abs() < 1e-12);
    let mut by_turn: Vec<_> = all.found.iter().collect();
    by_turn.sort_by(|a, b| a.unknowns[2].abs().total_cmp(&b.unknowns[2].abs()));
    for (motion, tau) in by_turn.iter().zip(&expected) {
        let mu = motion.unknowns[2];
        assert!((mu * t - tau).abs() < 1e-10, "{} for {tau}", mu * t);
        // speed: chord = 2 (v/μ) sin(τ/2); the action is v² T/2
        let speed = (chord.sqrt() * mu / (2.0 * (0.5 * tau).sin())).abs();
        assert!((motion.action[0] - 0.5 * speed * speed * t).abs() < 1e-10 * motion.action[0]);
        let expected: Vec<f64> = zeros.iter().map(|zero| zero / mu.abs()).filter(|zero| *zero < t).collect();
        let times = motion.conjugate.as_ref().expect("they are determined");
        assert_eq!(times.len(), expected.len(), "{times:?} for {expected:?}");
        for (time, expected) in times.iter().zip(&expected) {
            assert!((time.t - expected).abs() < 1e-9 && time.multiplicity == 1, "{time:?} for {expected}");
        }
        assert_eq!(motion.is_minimum, Some(expected.is_empty()));
    }
    // the first one turns by less than once, and is the shortest
    assert_eq!(all.found[0].unknowns, by_turn[0].unknowns);
    assert_eq!(all.found[0].is_minimum, Some(true));
}

/// Above the start all circles that turn once lead to the goal: a family.
#[test]
fn one_of_a_family_is_said_to_be_one() {
    let (t, z) = (2.0, 0.3);
    let all = found("heisenberg", VAKONOMIC, &aim(&[("x", 0.5), ("y", 0.0), ("z", z)], t, 12));
    let circle = all.found.iter().find(|motion| (motion.unknowns[2] * t - std::f64::consts::TAU).abs() < 1e-3);
    let circle = circle.expect("a circle");
    assert!(!circle.is_isolated(), "{:e}", circle.condition);
    // conjugate at its end, not before it
    assert_eq!((circle.second_variation, circle.is_minimum), (SecondVariation::AtTheEnd, None));
}

/// `x, y, φ` and their momenta: μ = p_y cos φ − p_x sin φ, speed u = p_x cos φ + p_y sin φ, ṗ_φ = −μu.
fn sledge(y: &[f64]) -> Vec<f64> {
    let (slope, k) = (9.81 * 0.4_f64.sin(), 0.7);
    let (s, c) = y[2].sin_cos();
    let (mu, u) = (y[4] * c - y[3] * s, y[3] * c + y[4] * s);
    vec![u * c, u * s, y[5] / (k * k), slope, 0.0, -mu * u]
}

/// `x, y, ψ, φ` and their momenta: ψ' = (p_ψ + R (p_x cos φ + p_y sin φ))/(I + mR²), μ = p − m v.
fn disc(y: &[f64]) -> Vec<f64> {
    let (m, r, i, j) = (1.0, 0.5, 0.125, 0.0625);
    let (s, c) = y[3].sin_cos();
    let roll = (y[6] + r * (y[4] * c + y[5] * s)) / (i + m * r * r);
    let (mu1, mu2) = (y[4] - m * r * roll * c, y[5] - m * r * roll * s);
    vec![r * roll * c, r * roll * s, roll, y[7] / j, 0.0, 0.0, 0.0, r * roll * (mu1 * s - mu2 * c)]
}

/// Momenta at q, v and μ.
type Momenta<'a> = &'a dyn Fn(&[f64], &[f64], &[f64]) -> Vec<f64>;

/// Each motion that was found is one of collocation, with its conjugate times where a determinant of
/// differences changes its sign.
fn judged(name: &str, rates: Rates, aim: &Aim, momenta: Momenta) -> usize {
    const PANELS: usize = 30;
    let all = found(name, VAKONOMIC, aim);
    let mut times = 0;
    for motion in all.found.iter().take(4) {
        let (q0, v0) = (&motion.start.q, &motion.start.v);
        let n = q0.len();
        let constants = &motion.motion.constants;
        let first = [&q0[..], &momenta(q0, v0, constants)].concat();
        // the collocation starts from ends that are wrong in the third digit
        let coarse = |k: usize| {
            let y = flow(rates, &first, aim.t * k as f64 / PANELS as f64, 2 * PANELS);
            y.iter().enumerate().map(|(i, y)| y * (1.0 + 1e-3 * ((7 * k + i) as f64).sin())).collect::<Vec<f64>>()
        };
        let guess: Vec<Vec<f64>> = (0..=PANELS).map(coarse).collect();
        let goal: Vec<f64> = aim.to.iter().map(|(_, q)| *q).collect();
        let exact = two_points(rates, [q0, &goal], aim.t, guess);
        let size = exact.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        for (ours, theirs) in first.iter().zip(&exact) {
            assert!((ours - theirs).abs() < 1e-8 * size, "{name}: {first:?} for {exact:?}");
        }
        // ∂q/∂p₀ instead of ∂q/∂(v₀, μ₀): the map between these is linear and regular
        let determinant = |t: f64| {
            let moved = |j: usize, by: f64| {
                let mut y = first.clone();
                y[n + j] += by;
                flow(rates, &y, t, 2 * PANELS)
            };
            let both: Vec<_> = (0..n).map(|j| (moved(j, 1e-5), moved(j, -1e-5))).collect();
            DMatrix::from_fn(n, n, |i, j| (both[j].0[i] - both[j].1[i]) / 2e-5).determinant()
        };
        for time in motion.conjugate.as_ref().expect("determined") {
            let near = 1e-6 * aim.t;
            assert!(determinant(time.t - near) * determinant(time.t + near) < 0.0, "{name}: {time:?}");
            times += 1;
        }
        // and there are no others: as many changes of sign as were found
        let signs: Vec<bool> = (5..=100).map(|k| determinant(aim.t * f64::from(k) / 100.0) > 0.0).collect();
        let changes = signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert_eq!(changes, motion.conjugate.as_ref().map_or(0, Vec::len), "{name}");
    }
    times
}

#[test]
fn motions_of_the_sledge_are_those_of_collocation() {
    let momenta =
        |q: &[f64], v: &[f64], mu: &[f64]| vec![v[0] - mu[0] * q[2].sin(), v[1] + mu[0] * q[2].cos(), 0.49 * v[2]];
    let short = aim(&[("x", 0.8), ("y", 0.3), ("phi", 0.8)], 1.0, 20);
    assert_eq!(judged("sledge", &sledge, &short, &momenta), 0);
    let long = aim(&[("x", 8.0), ("y", 1.0), ("phi", 2.0)], 2.0, 20);
    assert!(judged("sledge", &sledge, &long, &momenta) >= 4);
}

#[test]
fn motions_of_the_disc_are_those_of_collocation() {
    let momenta = |q: &[f64], v: &[f64], mu: &[f64]| {
        let along = mu[0] * q[3].cos() + mu[1] * q[3].sin();
        vec![v[0] + mu[0], v[1] + mu[1], 0.125 * v[2] - 0.5 * along, 0.0625 * v[3]]
    };
    let near = aim(&[("x", 1.0), ("y", 1.0), ("psi", 3.0), ("phi", 1.5)], 2.0, 20);
    judged("disc", &disc, &near, &momenta);
}

/// Chetaev's disc turns and rolls at constant rates.
#[test]
fn chetaevs_disc_is_aimed_in_two_coordinates() {
    let all = found("disc", CHETAEV, &aim(&[("psi", 3.0), ("phi", 1.5)], 2.0, 8));
    let [motion] = &all.found[..] else { panic!("{} motions", all.found.len()) };
    assert_eq!((motion.starts, motion.is_minimum), (8, None));
    assert!((motion.start.v[2] - 1.5).abs() < 1e-12 && (motion.start.v[3] - 0.55).abs() < 1e-12);
    // half of (m R² + I) ψ'² + J φ'²
    let action = 0.5 * ((0.25 + 0.125) * 1.5 * 1.5 + 0.0625 * 0.55 * 0.55) * 2.0;
    assert!((motion.action[0] - action).abs() < 1e-12);
}

/// Two oscillators alike meet again after half a period, in both directions at once.
#[test]
fn an_oscillator_has_a_conjugate_time_of_multiplicity_two() {
    let text = "title = \"Oscillator\"\n[coordinates]\nx = { start = 0.3 }\ny = { start = 0.1 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2 - x^2 - y^2)/2\"\n[start.velocities]\n\"x'\" = 1\n\"y'\" = 0\n[run]\nduration = 4\n";
    let scene = Scene::parse("oscillator", text).expect("a scene");
    let goal = aim(&[("x", -0.2), ("y", 0.5)], 4.0, 4);
    let all = connect(&scene, &choice(&scene, CHETAEV), &goal, &Settings::default()).expect("a search");
    let [motion] = &all.found[..] else { panic!("{} motions", all.found.len()) };
    let times = motion.conjugate.as_ref().expect("determined");
    assert_eq!(times.len(), 1, "{times:?}");
    assert!((times[0].t - std::f64::consts::PI).abs() < 1e-7 && times[0].multiplicity == 2, "{times:?}");
    assert_eq!(motion.is_minimum, Some(false));
    let expected = (-0.2 - 0.3 * 4.0_f64.cos()) / 4.0_f64.sin();
    assert!((motion.unknowns[0] - expected).abs() < 1e-10);
}

/// The costates of a removal are unknowns as multipliers are: by coordinates it is the vakonomic family.
#[test]
fn a_removal_by_coordinates_has_the_vakonomic_motions() {
    let goal = aim(&[("x", 0.2), ("y", 0.5), ("z", 0.3)], 8.0, 30);
    let vakonomic = found("heisenberg", VAKONOMIC, &goal);
    let scene = built_in("heisenberg");
    let removal = Choice { constants: ConstantsRule::Given(vec![-0.5]), ..choice(&scene, REMOVED_CONSTRAINT) };
    let removed = connect(&scene, &removal, &goal, &Settings::default()).expect("a search");
    assert_eq!(removed.unknowns, ["x'", "y'", "P0_z"]);
    let [ours] = &vakonomic.found[..] else { panic!("{} motions", vakonomic.found.len()) };
    let [same] = &removed.found[..] else { panic!("{} motions", removed.found.len()) };
    for (a, b) in ours.start.v.iter().zip(&same.start.v) {
        assert!((a - b).abs() < 1e-10);
    }
    assert!((ours.unknowns[2] + same.unknowns[2]).abs() < 1e-10, "P_z = −μ");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let scene = built_in("heisenberg");
    let refused = |aim: &Aim, settings: &Settings| match connect(&scene, &choice(&scene, VAKONOMIC), aim, settings) {
        Err(error) => error,
        Ok(_) => panic!("{aim:?} should be refused"),
    };
    let usual = Settings::default();
    let whole = [("x", 0.2), ("y", 0.5), ("z", 0.3)];
    for (aim, words) in [
        (aim(&whole[..2], 8.0, 4), "vakonomic has 3 unknowns (x', y', mu0_1), and 2 coordinates are given at the end"),
        (aim(&[("w", 1.0)], 8.0, 4), "no coordinate `w`; there are x, y, z"),
        (aim(&[("x", 1.0), ("x", 2.0)], 8.0, 4), "`x` is given twice"),
        (aim(&[("x", f64::NAN)], 8.0, 4), "x is NaN at the end; it must be finite"),
        (aim(&whole, 0.0, 4), "the end 0.0 is not after the start 0.0"),
        (aim(&whole, 8.0, 0), "a search from 0 starts finds nothing"),
    ] {
        let SolveError::TwoPoint { reason } = refused(&aim, &usual) else { panic!("{aim:?}") };
        assert!(reason.starts_with(words), "{reason}");
    }
    let raised = Interrupt::default();
    raised.raise();
    let settings = Settings { interrupt: Some(raised), ..Settings::default() };
    assert!(matches!(refused(&aim(&whole, 8.0, 4), &settings), SolveError::Interrupted { .. }));
}

/// Where constraints can be integrated multipliers move nothing, and ends beside the leaf are not reached.
#[test]
fn an_end_on_another_leaf_is_said_to_have_no_motion() {
    let text = "title = \"Bead\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y' - x'\"]\n[start.velocities]\n\"x'\" = 1\n[run]\nduration = 1\n";
    let scene = Scene::parse("bead", text).expect("a scene");
    let goal = aim(&[("x", 1.0), ("y", 2.0)], 1.0, 4);
    let all = connect(&scene, &choice(&scene, VAKONOMIC), &goal, &Settings::default()).expect("a search");
    assert!(all.found.is_empty());
    // y − x is another by one
    assert!(all.none.as_deref().is_some_and(|why| why.contains("1.000000")), "{:?}", all.none);
}

fn found_in(text: &str, aim: &Aim) -> motion::Connections {
    let scene = Scene::parse("scene", text).unwrap_or_else(|error| panic!("{error}"));
    let choice = choice(&scene, VAKONOMIC);
    connect(&scene, &choice, aim, &Settings::default()).unwrap_or_else(|error| panic!("{error}"))
}

const MARTINET: &str = "title = \"Martinet\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\nz = { start = 0 }\n\
    [system]\nlagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"z' - x^2*y'/2\"]\n[start.velocities]\n\"x'\" = 0.5\n\
    \"y'\" = 0.2\n[run]\nduration = 2\n";

/// The straight line on x = 0 of the flat Martinet plane is a motion for every μ₀, and the shortest: it is
/// one curve, and conjugate times say nothing of it.
#[test]
fn an_abnormal_curve_is_one_and_has_no_statement() {
    let all = found_in(MARTINET, &aim(&[("x", 0.0), ("y", 1.0), ("z", 0.0)], 2.0, 8));
    let lines: Vec<_> = all.found.iter().filter(|motion| (motion.action[0] - 0.25).abs() < 1e-6).collect();
    let [line] = &lines[..] else { panic!("{} lines", lines.len()) };
    assert_eq!((line.second_variation, line.is_minimum), (SecondVariation::Abnormal, None));
    assert!(line.conjugate.is_none() && line.starts >= 2, "{}", line.starts);
}

/// A chain that hangs: f = v² − c², and `∂²(L + μ f)/∂v² = 1 + 2μ` along it is negative: the action, its
/// potential energy turned round, has a maximum.
#[test]
fn a_hanging_chain_is_a_maximum() {
    let text = "title = \"Chain\"\n[parameters]\ng = 1.0\nc = 1.5\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n\
        [system]\nlagrangian = \"(x'^2+y'^2)/2 - g*y\"\nconstraints = [\"x'^2+y'^2-c^2\"]\n[start]\n\
        guess = { \"y'\" = -1 }\n[start.velocities]\n\"x'\" = 1.0\n[run]\nduration = 1\n";
    let all = found_in(text, &aim(&[("x", 1.0), ("y", 0.0)], 1.0, 60));
    let [chain] = &all.found[..] else { panic!("{} motions", all.found.len()) };
    assert_eq!((chain.second_variation, chain.is_minimum), (SecondVariation::Maximum, Some(false)));
    // y = a cosh((x − 1/2)/a) + const of length c: 2 a sinh(1/(2a)) = c, and x' = c/cosh at the start
    let a = root(|a: f64| 2.0 * a * (0.5 / a).sinh() - 1.5, [0.2, 1.0]);
    assert!((chain.unknowns[0] - 1.5 / (0.5 / a).cosh()).abs() < 1e-10, "{}", chain.unknowns[0]);
}

/// A pendulum by a velocity constraint, x x' + y y' = 0: on its circle every μ₀ does, off it there is no
/// motion.
#[test]
fn ends_are_on_the_leaf_of_the_start_or_there_is_no_motion() {
    let text = "title = \"Pendulum\"\n[coordinates]\nx = { start = 0 }\ny = { start = -1 }\n[system]\n\
        lagrangian = \"(x'^2+y'^2)/2 - y\"\nconstraints = [\"x*x'+y*y'\"]\n[start.velocities]\n\"x'\" = 0.5\n[run]\n\
        duration = 2\n";
    let on = found_in(text, &aim(&[("x", 0.8), ("y", -0.6)], 1.0, 12));
    let [motion] = &on.found[..] else { panic!("{} motions", on.found.len()) };
    assert!(on.every_constant && on.unknowns == ["x'"] && motion.residuals.iter().all(|r| r.abs() < 1e-10));
    assert_eq!(motion.is_minimum, Some(true));
    let off = found_in(text, &aim(&[("x", 0.5), ("y", 0.5)], 1.0, 12));
    // (x² + y²)/2 is 1/2 at the start and 1/4 there
    assert!(off.found.is_empty() && off.none.as_deref().is_some_and(|why| why.contains("-0.250000")), "{:?}", off.none);
}
