//! Errors of systems drawn here over their estimates, by coordinate and time, against motions in more digits.

use deltaq::{Settings, choices, derive, prepare, setting, solve_choice};
use reference::{DoubleDouble, Question, reference};
use scene::Scene;
use symbolic::{Scalar, SplitMix};

/// So many systems are drawn; `OWN_SYSTEMS` asks for more.
const SYSTEMS: usize = 25;
/// An error may be over its estimate so often, and never so many times as large.
const OFTEN: f64 = 0.01;
const FAR: f64 = 10.0;
/// What of a coordinate no run knows, in units of its last digit.
const DIGITS: f64 = 8.0;
const TIMES: usize = 8;

fn pick<'a>(random: &mut SplitMix, of: &[&'a str]) -> &'a str {
    of[(random.unit() * of.len() as f64) as usize % of.len()]
}

/// With `A`, `B`, `C` for numbers between 0.2 and 1.5, and `E` for a small one.
fn filled(random: &mut SplitMix, text: &str) -> String {
    let mut text = text.to_string();
    for letter in ["A", "B", "C"] {
        text = text.replace(letter, &format!("{:.4}", 0.2 + 1.3 * random.unit()));
    }
    text.replace('E', &format!("{:.3e}", 10.0_f64.powf(-1.0 - 4.0 * random.unit())))
}

const INERTIAS: [&str; 4] = [
    "(x'^2 + y'^2 + z'^2)/2",
    "((1 + A*x^2)*x'^2 + y'^2 + B*z'^2)/2",
    "(x'^2 + y'^2 + C*z'^2)/2 + 0.2*cos(z)*x'*y'",
    "(x'^2 + (1 + B*cos(x)^2)*y'^2 + z'^2)/2",
];
const POTENTIALS: [&str; 6] =
    ["A*x^2/2 + B*y^2/2", "9.81*C*cos(y)", "A*x*y - B*cos(z)", "B*exp(-A*x^2)", "A*x^4/4 + C*sin(x*y)", "0"];
const CONSTRAINTS: [&str; 6] =
    ["y'*cos(z) - x'*sin(z)", "z' - A*y*x'", "z' - B*sin(x)*y'", "y' - A*z' - B*x*x'", "x' - C*cos(z)*y' - A*t", ""];
/// Smooth ones, and those that lose digits.
const FORCES: [&str; 9] = [
    "0",
    "-A*x'",
    "B*cos(C*t)",
    "-A*x' + B*sin(3*t)",
    "A*tanh(B*(t - 1))",
    "-(1 - cos(E*x))*2/(E)^2",
    "-(exp(E*x) - 1)/(E)",
    "(sqrt(1 + E*x) - 1)*2/(E)",
    "A*(sin(x + E) - sin(x))/(E)",
];

fn scene(random: &mut SplitMix) -> String {
    let parts = [&INERTIAS[..], &POTENTIALS, &CONSTRAINTS, &FORCES].map(|of| pick(random, of));
    let [inertia, potential, constraint, force] = parts.map(|text| filled(random, text));
    let constraints = if constraint.is_empty() { String::new() } else { format!("constraints = [\"{constraint}\"]\n") };
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    let starts: Vec<String> =
        ["x", "y", "z"].iter().map(|q| format!("{q} = {{ start = {:.3} }}\n", between(-1.0, 1.0))).collect();
    // the velocity that follows is the one that stands first in the constraint
    let dependent = constraint.get(..1).unwrap_or("");
    let given: Vec<String> = ["x", "y", "z"]
        .iter()
        .filter(|q| **q != dependent)
        .map(|q| format!("\"{q}'\" = {:.3}", between(-1.0, 1.0)))
        .collect();
    format!(
        "title = \"own\"\n[coordinates]\n{}[system]\nlagrangian = \"{inertia} - ({potential})\"\n{constraints}\
         forces = {{ x = \"{force}\" }}\n[start]\nvelocities = {{ {} }}\n[run]\nduration = {:.2}\n",
        starts.concat(),
        given.join(", "),
        between(1.0, 6.0)
    )
}

#[test]
fn errors_are_under_their_estimates() {
    let systems = std::env::var("OWN_SYSTEMS").ok().and_then(|n| n.parse().ok()).unwrap_or(SYSTEMS);
    let mut random = SplitMix::new(3607);
    let (mut errors, mut over, mut told, mut without, mut far) = (0, 0, 0, 0, Vec::new());
    for _ in 0..systems {
        let text = scene(&mut random);
        let scene = Scene::parse("own", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let all = choices(&scene);
        let choice = &all[(random.unit() * all.len() as f64) as usize % all.len()];
        let ready = derive(&scene.system, choice).map_err(|e| e.to_string()).and_then(|e| {
            prepare(setting(&scene), e, &choice.constants, &Settings::default()).map_err(|e| e.to_string())
        });
        let Ok(ready) = ready else {
            told += 1;
            continue;
        };
        let motion = solve_choice(&scene, choice, &Settings::default());
        let Some(mut motion) = motion.ok().filter(|motion| motion.is_complete() && motion.doubt.is_none()) else {
            told += 1;
            continue;
        };
        let times: Vec<f64> = motion.grid(TIMES).into_iter().skip(1).collect();
        let (equations, constants) = (&ready.equations, &ready.constants[..]);
        let question = Question { system: &scene.system, start: &scene.start, equations, constants };
        let Ok(truth) = reference(&question, &times, 1e-17) else {
            without += 1;
            continue;
        };
        let mut estimates = vec![0.0_f64; 3];
        let mut largest = [0.0_f64; 3];
        for (k, &t) in times.iter().enumerate() {
            let here = motion.at(t).expect("in range").coordinates;
            let difference = motion.difference_of_runs(t).expect("in range");
            let right = &truth.points[k].coordinates;
            let off = |i: usize| (DoubleDouble::from_f64(here[i]) - right[i]).parts().0.abs();
            for i in 0..3 {
                estimates[i] = estimates[i].max(difference[i].abs());
                largest[i] = largest[i].max(here[i].abs());
                let ratio = off(i) / (estimates[i] + DIGITS * f64::EPSILON * largest[i]);
                errors += 1;
                over += usize::from(ratio > 1.0);
                if ratio > FAR {
                    far.push(format!("{ratio:.1} times {:.1e}, {i} at {t}, {}\n{text}", estimates[i], choice.label));
                }
            }
        }
    }
    println!("{errors} errors, {over} over their estimates, {} far; {told} told, {without} no reference", far.len());
    assert!(far.is_empty(), "{} far over: {}", far.len(), far.join("\n"));
    assert!(over as f64 <= OFTEN * errors as f64 && errors > 10 * systems, "{over} of {errors} are over");
}
