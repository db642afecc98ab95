//! Switches and pulses as they are usually written, late clocks, domains of formulas, pivots of ensembles.

use discrete::Composition;
use motion::{
    Ensemble, EnsembleOptions, Motion, Settings, SolveError, Steps, VAKONOMIC_COSTATE, choices, error_estimate,
    setting, shared_text, solve_by_steps, solve_choice,
};
use scene::Scene;

fn scene(coordinates: &str, system: &str, velocities: &str, run: &str) -> Scene {
    let text = format!(
        "title = \"test\"\n{coordinates}\n[system]\n{system}\n[start.velocities]\n{velocities}\n[run]\n{run}\n"
    );
    Scene::parse("test", &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn solve(scene: &Scene) -> Result<Motion, SolveError> {
    solve_choice(scene, &choices(scene)[0], &Settings::default())
}

/// Forces with `x(10)` from rest, for `t₀ = 0`: `∫ (10 − t) F dt` in closed form, tails under 1e-300 left
/// out.
fn switches() -> Vec<(&'static str, f64)> {
    let (pi, w) = (std::f64::consts::PI, 0.009);
    let logistic = 4.5 + w * w * pi * pi / 6.0;
    vec![
        ("1/(1 + exp(-(t - 7)/0.009))", logistic),
        ("exp((t - 7)/0.009)/(1 + exp((t - 7)/0.009))", logistic),
        ("3/(3 + 3*exp(-(t - 7)/0.009))", logistic),
        ("1 - 1/(1 + exp((t - 7)/0.009))", logistic),
        ("(1 + sinh((t - 7)/0.018)/cosh((t - 7)/0.018))/2", logistic),
        ("1/cosh((t - 7)/0.01)^2", 0.06),
        ("exp(2*(t - 7)/0.01)/(1 + exp(2*(t - 7)/0.01))^2", 0.015),
        ("4/(exp((t - 7)/0.01) + exp(-(t - 7)/0.01))^2", 0.06),
        ("1/cosh((t - 7)/0.01)", 0.03 * pi),
        ("2/(exp((t - 7)/0.01) + exp(-(t - 7)/0.01))", 0.03 * pi),
        ("exp(-((t - 7)/0.01)^2)", 0.03 * pi.sqrt()),
    ]
}

#[test]
fn switches_and_pulses_are_integrated_at_any_time_of_the_clock() {
    for start in [0.0, 1e6, 1_700_000_000.0] {
        for (force, expected) in switches() {
            let force = force.replace("t - 7", &format!("t - {}", start + 7.0));
            let scene = Scene::parse("test", &scene_text(&force, start)).unwrap_or_else(|error| panic!("{error}"));
            let mut motion = solve(&scene).unwrap_or_else(|error| panic!("{force}: {error}"));
            assert!(motion.is_complete(), "{force}: {:?}", motion.ending);
            let x = motion.at(start + 10.0).unwrap().coordinates[0];
            assert!((x - expected).abs() < 1e-10, "{force}: {x} for {expected}");
        }
    }
}

fn scene_text(force: &str, start: f64) -> String {
    format!(
        "title = \"test\"\n[coordinates]\nx = {{ start = 0 }}\n[system]\nlagrangian = \"x'^2/2\"\n\
         forces = {{ x = \"{force}\" }}\n[start]\ntime = {start:?}\nvelocities = {{ \"x'\" = 0 }}\n[run]\nduration = 10\n"
    )
}

#[test]
fn a_wall_of_logistic_functions_in_a_coordinate_turns_a_particle_back() {
    // a potential step of height 0.6 at x = 2, energy 0.5, by L and by Q
    let by_potential = scene(
        "[coordinates]\nx = { start = 0 }",
        "lagrangian = \"x'^2/2 - 0.6/(1 + exp(-(x - 2)/0.001))\"",
        "\"x'\" = 1",
        "duration = 5",
    );
    let by_force = scene(
        "[coordinates]\nx = { start = 0 }",
        "lagrangian = \"x'^2/2\"\nforces = { x = \"-150/cosh((x - 2)/0.002)^2\" }",
        "\"x'\" = 1",
        "duration = 5",
    );
    for scene in [by_potential, by_force] {
        let mut motion = solve(&scene).unwrap();
        let at_end = motion.at(5.0).unwrap();
        assert!(motion.is_complete() && (at_end.velocities[0] + 1.0).abs() < 1e-7, "{at_end:?}");
    }
}

#[test]
fn a_motion_ends_where_a_formula_as_written_has_no_value() {
    // z = 1 − t²/2, and what is written in its place is z for z > 0 only
    let written = [
        "sqrt(z)^2",
        "sqrt(z)*sqrt(z)",
        "(z^(1/3))^3",
        "exp(log(z))",
        "z + log(z) - log(z)",
        "z + 0*log(z)",
        "log(z)*z/log(z)",
        "z + sqrt(z) - sqrt(z)",
        "(z^0.5)^4/z",
        "z*ln(z)^0",
        "z + pow(z, 1.5) - z*sqrt(z)",
        "z + acosh(1 + z) - acosh(1 + z)",
        "z + atanh(z - 1)*0",
    ];
    for formula in written {
        let system = format!("lagrangian = \"z'^2/2 - ({formula})\"");
        let scene = scene("[coordinates]\nz = { start = 1 }", &system, "\"z'\" = 0", "duration = 3");
        let motion = solve(&scene).unwrap_or_else(|error| panic!("{formula}: {error}"));
        assert!((motion.end() - 2_f64.sqrt()).abs() < 1e-6, "{formula}: {} {:?}", motion.end(), motion.ending);
    }
    let system = "lagrangian = \"z'^2/2 - sqrt(z)^2\"";
    let outside = scene("[coordinates]\nz = { start = -1 }", system, "\"z'\" = 0", "duration = 3");
    assert!(matches!(solve(&outside), Err(SolveError::OutsideDomain { value: -1.0, .. })));
    // sums of squares have no such end
    let system = "lagrangian = \"z'^2/2 - sqrt(z^2 + 1)^2/2\"";
    let inside = scene("[coordinates]\nz = { start = 1 }", system, "\"z'\" = 0", "duration = 3");
    assert!((solve(&inside).unwrap().at(3.0).unwrap().coordinates[0] - 3_f64.cos()).abs() < 1e-10);
}

#[test]
fn an_ensemble_has_members_whose_pivots_vanish() {
    let head = "[parameters]\ne = 0.5\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\nz = { start = 0 }";
    let system = "lagrangian = \"(x'^2 + y'^2 + z'^2)/2 - x*y\"\nconstraints = [\"e*x' + (1 - e)*y' - z*z'\"]";
    let scene = scene(head, system, "\"x'\" = 0\n\"y'\" = 0\n\"z'\" = 0.3", "duration = 1");
    let ensemble = Ensemble::new(&scene, &choices(&scene)[0], &["e"], &Settings::default()).unwrap();
    let members = ensemble.members(&[[0.0], [0.25], [0.5], [1.0]], 1);
    let motions = ensemble.answers(members, &[1.0], &EnsembleOptions::default());
    let ends: Vec<_> = motions.into_iter().map(|motion| motion.unwrap().outputs.remove(0)).collect();
    // x and y change places with e and 1 − e
    let (first, last) = (&ends[0], &ends[3]);
    assert!((first.coordinates[0] - last.coordinates[1]).abs() < 1e-10, "{first:?} {last:?}");
    assert!((first.multipliers[0] - last.multipliers[0]).abs() < 1e-9, "{first:?} {last:?}");
    for (e, end) in [0.0, 0.25, 0.5, 1.0].into_iter().zip(&ends) {
        let alone = Scene::parse("test", &scene_with(e)).unwrap();
        let found = solve(&alone).unwrap().at(1.0).unwrap();
        assert!((found.coordinates[2] - end.coordinates[2]).abs() < 1e-10, "{e}: {found:?} {end:?}");
    }
}

fn scene_with(e: f64) -> String {
    format!(
        "title = \"test\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\nz = {{ start = 0 }}\n[system]\n\
         lagrangian = \"(x'^2 + y'^2 + z'^2)/2 - x*y\"\nconstraints = [\"{e:?}*x' + (1 - {e:?})*y' - z*z'\"]\n\
         [start.velocities]\n\"x'\" = 0\n\"y'\" = 0\n\"z'\" = 0.3\n[run]\nduration = 1\n"
    )
}

#[test]
fn nested_definitions_are_printed_once_under_their_names() {
    let mut head = "[coordinates]\nx = { start = 0.01 }\n[definitions]\nd1 = \"x\"\n".to_owned();
    for i in 2..=25 {
        let before = i - 1;
        head += &format!("d{i} = \"d{before}*d{before} + sin(d{before})\"\n");
    }
    let scene = scene(&head, "lagrangian = \"x'^2/2 - d25\"", "\"x'\" = 0", "duration = 1");
    let g = &scene.system.graph;
    let (shared, formulas) = shared_text(g, &[scene.system.lagrangian], false);
    assert_eq!(formulas, ["x'^2/2 - d24^2 - sin(d24)"]);
    assert_eq!((shared.len(), &shared[3]), (23, &["d5".to_owned(), "d4^2 + sin(d4)".to_owned()]));
    let equations = motion::derive_at(&scene.system, &scene.start, &choices(&scene)[0]).unwrap();
    let text = motion::equations_text(&equations, motion::EquationStyle::Plain);
    assert!(text.len() < 10_000 && text.contains("d24 = d23^2 + sin(d23)"), "{}", text.len());
}

/// Classical Runge–Kutta steps of `y' = f(y)`.
fn stepped<const N: usize>(f: impl Fn([f64; N]) -> [f64; N], mut y: [f64; N], end: f64) -> [f64; N] {
    let h = end / 4000.0;
    let moved = |y: [f64; N], k: [f64; N], part: f64| std::array::from_fn(|i| y[i] + part * h * k[i]);
    for _ in 0..4000 {
        let a = f(y);
        let b = f(moved(y, a, 0.5));
        let c = f(moved(y, b, 0.5));
        let d = f(moved(y, c, 1.0));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    y
}

#[test]
fn first_order_states_are_coordinates_without_mass_and_currents_rates_of_charges() {
    let filter = scene(
        "[coordinates]\nx = { start = 1 }\ns = { start = 0 }",
        "lagrangian = \"(x'^2 - x^2)/2\"\nconstraints = [\"s' - (x - s)/0.5\"]\nforces = { x = \"-0.3*s\" }",
        "\"x'\" = 0",
        "duration = 2",
    );
    let end = solve(&filter).unwrap().at(2.0).unwrap();
    let [x, _, s] = stepped(|[x, v, s]| [v, -x - 0.3 * s, (x - s) / 0.5], [1.0, 0.0, 0.0], 2.0);
    assert!((end.coordinates[0] - x).abs() < 1e-10 && (end.coordinates[1] - s).abs() < 1e-10, "{end:?} {x} {s}");
    assert!(end.multipliers[0].abs() < 1e-12, "{end:?}");
    // Bouc–Wen: z' = v − ½ |v| z, |v| smooth
    let hysteresis = scene(
        "[coordinates]\nx = { start = 1 }\nz = { start = 0 }",
        "lagrangian = \"x'^2/2\"\nconstraints = [\"z' - x' + sqrt(x'^2 + 0.01)*z/2\"]\nforces = { x = \"-x - z\" }",
        "\"x'\" = 0",
        "duration = 2",
    );
    let end = solve(&hysteresis).unwrap().at(2.0).unwrap();
    let rates = |[x, v, z]: [f64; 3]| [v, -x - z, v - (v * v + 0.01).sqrt() * z / 2.0];
    let [x, _, z] = stepped(rates, [1.0, 0.0, 0.0], 2.0);
    assert!((end.coordinates[0] - x).abs() + (end.coordinates[1] - z).abs() < 1e-9, "{end:?} {x} {z}");
    assert!(end.multipliers[0].abs() < 1e-12, "{end:?}");
    let motor = scene(
        "[coordinates]\nphi = { start = 0 }\nq = { start = 0 }",
        "lagrangian = \"0.02*phi'^2/2 + 0.1*q'^2/2 + 0.5*phi*q'\"\nforces = { q = \"12 - q'\" }",
        "\"phi'\" = 0\n\"q'\" = 0",
        "duration = 1",
    );
    let end = solve(&motor).unwrap().at(1.0).unwrap();
    let [omega, i] = stepped(|[omega, i]| [25.0 * i, 10.0 * (12.0 - i - 0.5 * omega)], [0.0, 0.0], 1.0);
    assert!((end.velocities[0] - omega).abs() < 1e-9 && (end.velocities[1] - i).abs() < 1e-9, "{end:?} {omega} {i}");
}

#[test]
fn equal_steps_end_where_the_rates_jump_with_an_angle() {
    let run = |force: &str| {
        let system = format!("lagrangian = \"x'^2/2\"\nforces.x = \"{force}\"");
        let scene = scene("[coordinates]\nx = { start = 0 }", &system, "\"x'\" = 0", "duration = 10");
        let steps = Steps { step: 0.01, composition: Composition::Fourth };
        solve_by_steps(&scene, &choices(&scene)[0], steps, &Settings::default()).expect("a motion")
    };
    let jumps = run("atan2(sin(t), cos(t))");
    let told = format!("{:?}", jumps.ending);
    assert!((jumps.end() - std::f64::consts::PI).abs() < 0.02, "{told}");
    assert!(told.contains("passes over a jump of the rates") && told.contains("breakpoints"), "{told}");
    // nothing jumps
    for force in ["cos(2*atan2(sin(t), cos(t)))", "atan2(sin(t), 2 + cos(t))"] {
        assert!(run(force).is_complete(), "{force}: {:?}", run(force).ending);
    }
}

#[test]
fn a_motion_looked_at_after_whole_periods_only_has_its_size() {
    // 200 periods, and 200 times at which sizes are taken
    let period = 2.0 * std::f64::consts::PI;
    let system = "lagrangian = \"x'^2/2 - x^2/2\"";
    let scene =
        scene("[coordinates]\nx = { start = 0 }", system, "\"x'\" = 1", &format!("duration = {:?}", 200.0 * period));
    let mut motion = solve(&scene).expect("a motion");
    let estimate = error_estimate(&mut motion, setting(&scene)).expect("an estimate");
    assert_eq!(estimate.status(&motion), ("completed", None), "{estimate:?}");
    assert!(estimate.relative < 1e-8, "{estimate:?}");
}

/// A constraint nonlinear in the velocities whose multiplier changes by much where the impulse of a step is
/// small: steps of 0.01 are short enough, and errors fall with the square of the step. The judge is the time
/// loop.
#[test]
fn steps_are_as_long_as_their_impulses_allow() {
    let text = "title = \"quadric\"\n[coordinates]\nx = { start = -0.5 }\ny = { start = 0.4375 }\nz = { start = 0 }\n\
                [system]\nlagrangian = \"(x'^2 + y'^2)/2 + 19*(x*y' - x'*y)/16 - 13*(x^2 + y^2 + z^2)/32 + \
                11*z'*sin(x)/16\"\nconstraints = [\"z'^2 - (x'^2 + y'^2)/4 - 1/16\"]\n[start]\n\
                guess = { \"z'\" = 1 }\n[start.velocities]\n\"x'\" = 0.6875\n\"y'\" = -0.75\n[run]\nduration = 4\n";
    let scene = Scene::parse("quadric", text).unwrap_or_else(|e| panic!("{e}"));
    let choice = &choices(&scene)[0];
    let truth = solve_choice(&scene, choice, &Settings::default()).expect("a motion").at(4.0).expect("its end");
    let off = |step: f64| {
        let steps = Steps { step, composition: Composition::Second };
        let mut motion = solve_by_steps(&scene, choice, steps, &Settings::default()).expect("a motion");
        let end = motion.at(4.0).expect("its end");
        let apart = end.coordinates.iter().zip(&truth.coordinates).map(|(a, b)| (a - b).abs());
        apart.fold(0.0, f64::max)
    };
    let [coarse, fine] = [off(0.01), off(0.005)];
    assert!(coarse < 1e-4 && (3.0..5.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
}

#[test]
fn switches_of_velocities_are_seen_where_velocities_are_unknowns_or_outputs() {
    // M is not diagonal, so that the costate form solves p = M v at every instant; with a constraint, which
    // is holonomic, some velocities are combinations of others. All formulations have one motion
    let free = ("[coordinates]\nx = { start = 0 }\ny = { start = 0 }", "x'^2/2 + y'^2/2 + cos(y)*x'*y'/2", "[]");
    let bound = (
        "[coordinates]\nx = { start = 0 }\ny = { start = 0 }\nz = { start = 0 }",
        "x'^2/2 + y'^2/2 + z'^2/2",
        "[\"x' - z'*cos(z)\"]",
    );
    let cases = [
        (free, "x", "1 - step(x', 0.5, 0.52, 1e-9)/2"),
        (free, "x", "cos(t) + 0.3*step(x', 0.5, 0.52, 1e-6)"),
        (free, "x", "cos(t) + 0.5*exp(-((x' - 0.55)*1000)^2)"),
        (free, "x", "cos(t) + 3*exp(-((x' - 0.85)*1000)^2)"),
        (bound, "z", "cos(t) + 3*exp(-((x' - 0.5)*1000)^2)"),
        (bound, "z", "cos(t) + 3*exp(-((z' - 0.5)*1000)^2)"),
    ];
    for ((coordinates, lagrangian, constraints), along, force) in cases {
        let forces = format!("forces = {{ {along} = \"{force}\", y = \"sin(t)\" }}");
        let system = format!("lagrangian = \"{lagrangian}\"\nconstraints = {constraints}\n{forces}");
        let velocities = format!("\"{along}'\" = 0.2\n\"y'\" = 0.3");
        let scene = scene(coordinates, &system, &velocities, "duration = 10");
        let choices = choices(&scene);
        assert!(choices.iter().any(|choice| choice.formulation == VAKONOMIC_COSTATE));
        let ends = choices.iter().map(|choice| {
            let mut motion = solve_choice(&scene, choice, &Settings::default()).unwrap();
            assert!(motion.is_complete(), "{force}: {:?}", motion.ending);
            motion.at(10.0).unwrap().coordinates
        });
        let ends: Vec<Vec<f64>> = ends.collect();
        for end in &ends {
            assert!(end.iter().zip(&ends[0]).all(|(a, b)| (a - b).abs() < 1e-8), "{force}: {ends:?}");
        }
    }
}
