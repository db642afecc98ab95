//! Derivatives by parameters, start and free constants: closed forms, natural constants, and what is refused.
//! Scene by scene they are judged in `tests/tests/acceptance/sensitivities.rs`.

use equations::Outputs;
use integrate::Method;
use mechanics::ConstantsRule;
use motion::{
    Choice, Ending, Sensitivities, Settings, SolveError, choices, constant_names, sensitivities, solve_choice,
};
use scene::Scene;

use crate::ends::{built_in, text_of};

fn scene(name: &str, text: &str, overrides: &[(String, f64)]) -> Scene {
    Scene::parse_with(name, text, overrides).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn found(scene: &Scene, choice: &Choice, names: &[&str], times: &[f64], settings: &Settings) -> Sensitivities {
    sensitivities(scene, choice, names, times, settings).unwrap_or_else(|error| panic!("{}: {error}", choice.label))
}

fn all(outputs: &Outputs) -> Vec<f64> {
    [&outputs.coordinates[..], &outputs.velocities, &outputs.multipliers].concat()
}

fn oscillator() -> Scene {
    let text = "title = \"Oscillator\"\n[parameters]\nk = 2.0\nm = 0.5\n[coordinates]\nx = { start = 0.3 }\n\
                [system]\nlagrangian = \"m*x'^2/2 - k*x^2/2\"\n[start.velocities]\n\"x'\" = -0.7\n[run]\nduration = 6\n";
    scene("oscillator", text, &[])
}

#[test]
fn an_oscillator_has_the_derivatives_of_its_closed_form() {
    let scene = oscillator();
    let (k, m, x0, v0, t) = (2.0_f64, 0.5_f64, 0.3, -0.7, 5.0);
    let w = (k / m).sqrt();
    let (s, c) = (w * t).sin_cos();
    // x = x₀ cos ωt + v₀ sin(ωt)/ω
    let by_w = -x0 * t * s + v0 * (t * c / w - s / (w * w));
    let expected = [by_w * 0.5 * w / k, -by_w * 0.5 * w / m, c, s / w];
    let of_speed = [-x0 * s - w * x0 * t * c - v0 * t * s, 0.0, 0.0, 0.0];
    for method in [Method::Taylor, Method::Dop853] {
        let settings = Settings { method: Some(method), ..Settings::default() };
        let found = found(&scene, &choices(&scene)[0], &["k", "m", "x", "x'"], &[0.0, t], &settings);
        assert_eq!(found.ending, Ending::Completed);
        for (i, expected) in expected.into_iter().enumerate() {
            let derivative = found.derivatives[1][i].coordinates[0];
            assert!((derivative - expected).abs() < 1e-11, "{method:?} {i}: {derivative} for {expected}");
            assert!((derivative - expected).abs() <= found.errors[1][i].coordinates[0].max(1e-13), "{method:?} {i}");
        }
        let derivative = found.derivatives[1][0].velocities[0];
        assert!((derivative - of_speed[0] * 0.5 * w / k).abs() < 1e-11, "{method:?}: {derivative}");
        // at the start
        assert!((found.derivatives[0][2].coordinates[0] - 1.0).abs() < 1e-14);
        assert_eq!(found.derivatives[0][0].velocities, [0.0]);
    }
}

/// x, y, φ and λ of the sledge at `t`, mathematics of the paper's first example: `(g, α, φ₀, speed, ω)`.
fn sledge([g, alpha, phi0, speed, omega]: [f64; 5], t: f64) -> Vec<f64> {
    let (slope, turn) = (g * alpha.sin(), omega * t);
    let ((s0, c0), (s1, c1)) = (phi0.sin_cos(), (phi0 + turn).sin_cos());
    let (c, s) = ((s1 - s0) / omega, (c0 - c1) / omega);
    let x = speed * c + 0.5 * slope * c * c;
    let y = speed * s + 0.5 * slope * (c * s + (turn - turn.sin()) / (omega * omega));
    vec![x, y, phi0 + turn, omega * (speed + slope * c) + slope * s1]
}

#[test]
fn the_sledge_has_the_derivatives_of_its_closed_form() {
    let scene = built_in("sledge");
    let parameter = |name: &str| {
        let symbol = scene.system.graph.find_symbol(name);
        scene.system.parameters.iter().find(|p| Some(p.symbol) == symbol).unwrap().value
    };
    let (t, v, phi0) = (2.5, &scene.start.v, scene.start.q[2]);
    let at = [parameter("g"), parameter("alpha"), phi0, v[0] * phi0.cos() + v[1] * phi0.sin(), v[2]];
    // x' = 0.5 cos φ₀ follows φ₀, so that the speed stays; alone it takes y' with it: speed = x'/cos φ₀
    let names = ["g", "alpha", "phi", "x'", "phi'"];
    let units = [1.0, 1.0, 1.0, 1.0 / phi0.cos(), 1.0];
    for method in [None, Some(Method::Dop853)] {
        let settings = Settings { method, ..Settings::default() };
        let found = found(&scene, &choices(&scene)[0], &names, &[t], &settings);
        for i in 0..5 {
            let moved = |h: f64| {
                let mut x = at;
                x[i] += h * units[i];
                sledge(x, t)
            };
            let expected = difference(1e-2, moved);
            let outputs = &found.derivatives[0][i];
            let derivative = [&outputs.coordinates[..], &outputs.multipliers].concat();
            for (d, e) in derivative.iter().zip(&expected) {
                assert!(
                    (d - e).abs() < 1e-11 * (1.0 + e.abs()),
                    "{method:?} {}: {derivative:?} {expected:?}",
                    names[i]
                );
            }
        }
    }
}

/// The derivative at 0 by differences of order 8.
fn difference(h: f64, mut f: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let mut sum = Vec::new();
    for (j, w) in (1..).zip(weights) {
        let step = h * f64::from(j);
        let (after, before) = (f(step), f(-step));
        sum.resize(after.len(), 0.0);
        sum.iter_mut().zip(after.iter().zip(&before)).for_each(|(sum, (a, b))| *sum += w * (a - b) / h);
    }
    sum
}

#[test]
fn more_than_eight_numbers_and_what_is_refused() {
    let scene = built_in("sledge");
    let choice = &choices(&scene)[0];
    let names = ["g", "alpha", "x", "y", "phi", "x'", "phi'", "k"];
    let known: Vec<&str> = names.into_iter().filter(|name| scene.starts(&[name]).is_ok()).collect();
    let settings = Settings::default();
    let whole = found(&scene, choice, &known, &[1.0], &settings);
    let two = found(&scene, choice, &["phi", "g"], &[1.0], &settings);
    let place = known.iter().position(|name| *name == "phi").unwrap();
    let difference = whole.derivatives[0][place].coordinates[0] - two.derivatives[0][0].coordinates[0];
    assert!(difference.abs() < 1e-12, "{difference}");
    let refused = |names: &[&str], settings: &Settings| {
        sensitivities(&scene, choice, names, &[1.0], settings).unwrap_err().to_string()
    };
    assert!(refused(&[], &settings).contains("no number to derive by"));
    assert!(refused(&["g", "g"], &settings).contains("named twice"));
    assert!(refused(&["mass"], &settings).contains("mass"));
    assert!(refused(&["mu0_1"], &settings).contains("does not start from them"));
    let radau = Settings { method: Some(Method::Radau5), ..Settings::default() };
    assert!(refused(&["g"], &radau).contains("not by radau5"));
    // the constraint supplies it
    assert!(refused(&["y'"], &settings).contains("constraint"), "{}", refused(&["y'"], &settings));
}

#[test]
fn natural_constants_move_with_the_numbers() {
    let scene = built_in("sledge");
    let mut choice = choices(&scene).into_iter().find(|c| c.removal.is_some()).unwrap();
    let horizon = 2.0;
    choice.constants = ConstantsRule::Natural { horizon };
    let ours = found(&scene, &choice, &["g", "phi'"], &[1.0], &Settings::default());
    for (k, name) in ["g", "phi'"].into_iter().enumerate() {
        let value = if name == "g" { 9.81 } else { scene.start.v[2] };
        let expected = difference(0.01, |step| {
            let other = Scene::parse_with("sledge", &text_of("sledge"), &[(name.to_string(), value + step)]).unwrap();
            let removal = choices(&other).into_iter().find(|c| c.label == choice.label).unwrap();
            let removal = Choice { constants: ConstantsRule::Natural { horizon }, ..removal };
            let settings = Settings { tolerance: 1e-13, ..Settings::default() };
            let mut motion = solve_choice(&other, &removal, &settings).unwrap();
            assert!(!constant_names(&motion.equations).is_empty());
            all(&motion.at(1.0).unwrap())
        });
        let derivative = all(&ours.derivatives[0][k]);
        for (d, e) in derivative.iter().zip(&expected) {
            assert!((d - e).abs() < 1e-8 * (1.0 + e.abs()), "{name}: {derivative:?} {expected:?}");
        }
    }
    let error = sensitivities(&scene, &choice, &["P0_x"], &[1.0], &Settings::default()).unwrap_err();
    assert!(matches!(&error, SolveError::Member { reason } if reason.contains("natural")), "{error}");
}

#[test]
fn a_ramp_that_moves_is_passed_and_a_jump_ends_the_motion() {
    let scene = |force: &str| {
        let text = format!(
            "title = \"Switch\"\n[parameters]\ns = 1.0\nk = 2.0\n[coordinates]\nx = {{ start = 0.3 }}\n[system]\n\
             lagrangian = \"x'^2/2\"\nforces = {{ x = \"{force}\" }}\n[start.velocities]\n\"x'\" = 0\n\
             [run]\nduration = 2\nbreakpoints = [1.0]\n"
        );
        scene("switch", &text, &[])
    };
    // x = 0.3 + k (2 − s)³/6 at t = 2
    let ramp = scene("k*(t - s + sqrt((t - s)^2))/2");
    let ours = found(&ramp, &choices(&ramp)[0], &["s", "k"], &[2.0], &Settings::default());
    println!("{:?}", ours.ending);
    let [by_s, by_k] = [0, 1].map(|k| ours.derivatives[0][k].coordinates[0]);
    assert!((by_s + 1.0).abs() < 1e-10 && (by_k - 1.0 / 6.0).abs() < 1e-10, "{by_s} {by_k}");
    let jump = scene("k*(t - s)/sqrt((t - s)^2)");
    let early = found(&jump, &choices(&jump)[0], &["s"], &[0.5], &Settings::default());
    assert_eq!((early.times.len(), early.missing.len(), early.complaint()), (1, 0, None));
    let ours = found(&jump, &choices(&jump)[0], &["s"], &[0.5, 2.0], &Settings::default());
    assert_eq!((&ours.times[..], &ours.missing[..]), (&[0.5][..], &[2.0][..]));
    assert!(ours.complaint().unwrap().contains("up to t = "), "{:?}", ours.complaint());
    assert!(matches!(ours.ending, Ending::Stopped { t, .. } if (t - 1.0).abs() < 1e-6), "{:?}", ours.ending);
}

/// A point on a line beside another number `y`, with these formulas.
fn kinked(start: &str, lagrangian: &str, force: &str, y: &str) -> Scene {
    let text = format!(
        "title = \"Kink\"\n[parameters]\np = 0.0\nk = 2.0\n[coordinates]\nx = {{ start = \"{start}\" }}\n\
         y = {{ start = {y} }}\n[system]\nlagrangian = \"(x'^2 + y'^2)/2 - k*x^2/2 + {lagrangian}\"\n\
         forces = {{ x = \"{force}\" }}\n[start.velocities]\n\"x'\" = 0\n\"y'\" = 0\n[run]\nduration = 2\n"
    );
    scene("kink", &text, &[])
}

#[test]
fn kinks_at_a_number_are_refused_whatever_the_units() {
    let refusal = |scene: &Scene, name: &str| {
        let result = sensitivities(scene, &choices(scene)[0], &[name], &[2.0], &Settings::default());
        result.map(|found| found.derivatives[0][0].coordinates.clone()).map_err(|error| error.to_string())
    };
    let is_kink = |scene: &Scene, name: &str| {
        let error = refusal(scene, name).unwrap_err();
        assert!(error.contains(name) && error.contains("kink"), "{error}");
    };
    for part in ["sqrt(p^2)", "1e-9*sqrt(p^2)", "1e6*sqrt(p^2)", "(p^2)^(1/2)*cos(k)"] {
        is_kink(&kinked("0.3", &format!("({part})*x"), "0", "1000"), "p");
        is_kink(&kinked(part, "0", "0", "1000"), "p");
    }
    // it is switched on late, and after all but the time that is asked for
    for late in ["1.95", "1.9999"] {
        is_kink(&kinked("0.3", "0", &format!("sqrt(p^2)*(t - {late} + sqrt((t - {late})^2))"), "1000"), "p");
    }
    // the force on x is |y|, and y stays 0
    let resting = kinked("0.3", "0", "sqrt(y^2)", "0");
    is_kink(&resting, "y");
    assert!((refusal(&resting, "x").unwrap()[0] - (2.0 * 2_f64.sqrt()).cos()).abs() < 1e-10);
    // round, and steep beside a kink: no kink
    for part in ["sqrt(1e-12 + p^2)", "p*sqrt(p^2)", "sqrt((p - 1e-6)^2) + p"] {
        let by = refusal(&kinked("0.3", &format!("({part})*x"), "0", "1000"), "p").unwrap();
        assert!(by[0].abs() < 1e-10, "{part}: {by:?}");
    }
}

#[test]
fn a_small_part_of_the_start_is_derived_as_well_as_a_large_one() {
    let found = |scene: &Scene| found(scene, &choices(scene)[0], &["p"], &[0.0], &Settings::default());
    let steep = kinked("1e-9*exp(50*p)", "0", "0", "1000");
    let by = found(&steep).derivatives[0][0].coordinates[0];
    assert!((by - 5e-8).abs() < 1e-10 * 5e-8, "{by}");
}
