//! High powers, saws and quotients in forces and constraints: never wrong in silence, alone or in lanes.

use integrate::Method;
use motion::{CHETAEV, Settings, choices, error_estimate, setting, solve_choice};

use crate::ends::ends;
use crate::support::{choice, read};

/// Panels of the quadrature: the jumps of all saws are at their edges.
const PANELS: usize = 5040;
/// Nodes and weights of Gauss and Legendre on 0 … 1.
const NODES: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let h = 1.0 / PANELS as f64;
    let panel = |k: usize| NODES.iter().map(|(x, w)| w * f((k as f64 + x) * h)).sum::<f64>();
    h * (0..PANELS).map(panel).sum::<f64>()
}

/// A function of time on 0 … 1 as scenes write it, and in numbers.
type Shape = (String, Box<dyn Fn(f64) -> f64>);

/// Powers, pulses of powers, saws, quotients: twenty functions, positive or more than −1.
fn shapes() -> Vec<Shape> {
    let mut shapes: Vec<Shape> = Vec::new();
    for n in [8, 20, 40, 80, 200] {
        shapes.push((format!("t^{n}"), Box::new(move |t| t.powi(n))));
        shapes.push((format!("(4*t*(1 - t))^{n}"), Box::new(move |t| (4.0 * t * (1.0 - t)).powi(n))));
    }
    for k in [1, 2, 3, 5, 7] {
        let w = 2.0 * std::f64::consts::PI * f64::from(k);
        let saw = move |t: f64| (w * t).sin().atan2((w * t).cos()) / 4.0;
        shapes.push((format!("atan2(sin({w:?}*t), cos({w:?}*t))/4"), Box::new(saw)));
    }
    for w in [0.3, 0.1, 0.03, 0.01, 0.003] {
        let hill = move |t: f64| 1.0 / (1.0 + ((t - 0.37) / w).powi(2));
        shapes.push((format!("1/(1 + ((t - 0.37)/{w:?})^2)"), Box::new(hill)));
    }
    shapes
}

/// The scene, its formulation Chetaev's; and where x is at 1.
fn cases() -> Vec<(String, f64)> {
    let scene = |system: &str, velocities: &str| {
        format!(
            "title = \"steep\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\n\
             lagrangian = \"(x'^2 + y'^2)/2\"\n{system}\n[start]\n\
             velocities = {{ {velocities} }}\n[run]\nduration = 1\n"
        )
    };
    let mut cases = Vec::new();
    for (text, f) in shapes() {
        let pushed = scene(&format!("forces = {{ x = \"{text}\" }}"), "\"x'\" = 0, \"y'\" = 0");
        cases.push((pushed, integral(|t| (1.0 - t) * f(t))));
        // the reaction is along the velocity: a straight line, at the speed asked for
        let speed = (1.0 + f(0.0)).sqrt();
        let constraint = format!("constraints = [\"x'^2 + y'^2 - 1 - {text}\"]");
        let velocities = format!("\"x'\" = {:?}, \"y'\" = {:?}", 0.6 * speed, 0.8 * speed);
        cases.push((scene(&constraint, &velocities), 0.6 * integral(|t| (1.0 + f(t)).sqrt())));
        // y follows x: its rate is given
        let linear = scene(
            &format!("constraints = [\"x' - ({text})*y' - {text}\"]\nforces = {{ y = \"0\" }}"),
            &format!("\"x'\" = {:?}, \"y'\" = 0", f(0.0)),
        );
        cases.push((linear, f64::NAN));
    }
    // x' = f (1 + y'), x'' f + y'' = 0: (1 + f²) y'' = −f f' (1 + y'), so (1 + y')² (1 + f²) is constant
    for (case, (_, f)) in cases.iter_mut().skip(2).step_by(3).zip(shapes()) {
        let constant = (1.0 + f(0.0).powi(2)).sqrt();
        case.1 = integral(|t| f(t) * constant / (1.0 + f(t).powi(2)).sqrt());
    }
    cases
}

#[test]
fn powers_saws_and_quotients_are_never_wrong_in_silence() {
    let (mut right, mut told, mut wrong) = (0, 0, Vec::new());
    for (text, truth) in cases() {
        let scene = read("steep", &text);
        for (by, found) in ends(&scene, &choice(&scene, CHETAEV)) {
            match found.map(|(q, errors)| (q[0], errors[0])) {
                Err(_) => told += 1,
                Ok((x, estimate)) if (x - truth).abs() <= 10.0 * estimate + 1e-12 => right += 1,
                Ok((x, estimate)) => {
                    wrong.push(format!("{by}: {:.1e}, estimate {estimate:.1e}\n{text}", (x - truth).abs()));
                }
            }
        }
    }
    println!("{right} right, {told} told, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{right} right, {told} told, {} wrong: {}", wrong.len(), wrong.join("\n"));
    assert!(told * 4 < right, "{right} right, {told} told");
}

/// Hills of a high power are nothing at both ends of a step that another coordinate limits; energy is not
/// watched here.
#[test]
fn hills_of_high_powers_are_not_passed() {
    let pushed = |hill: &str, x: f64, speed: f64, method: Option<Method>| {
        let text = format!(
            "title = \"Hill\"\n[coordinates]\nx = {{ start = {x:?} }}\ny = {{ start = 1 }}\n[system]\n\
             lagrangian = \"(x'^2 + y'^2)/2 - {speed:?}^2*y^2/2\"\nforces = {{ x = \"{hill}\" }}\n[start]\n\
             velocities = {{ \"x'\" = 1, \"y'\" = 0 }}\n[run]\nduration = 8\n"
        );
        let scene = read("hill", &text);
        let settings = Settings { method, ..Settings::default() };
        let mut motion = solve_choice(&scene, &choices(&scene)[0], &settings).expect("a motion");
        let estimate = error_estimate(&mut motion, setting(&scene)).expect("in range");
        let is_told = estimate.status(&motion).0 != "completed";
        (motion.at(motion.end()).expect("in range").coordinates[0], estimate.coordinates[0], is_told)
    };
    // forces of the hills (4x(1 - x))^100, 0.6 high, and 0.6/(1 + x^2)^60
    let bell = "-240*(4*x*(1 - x))^99*(1 - 2*x)";
    for (hill, x) in [(bell, 0.0), ("72*x*(1 + x^2)^(-61)", -3.0)] {
        let (mut ends, mut told) = (Vec::new(), 0);
        for speed in [0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 7.0, 14.0] {
            for method in [None, Some(Method::Dop853), Some(Method::Radau5)] {
                let (end, error, is_told) = pushed(hill, x, speed, method);
                told += usize::from(is_told);
                ends.extend((!is_told).then_some((end, error, speed, method)));
            }
        }
        let (truth, least, ..) = *ends.iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("one that is right");
        assert!(truth < x + 0.6, "{hill}: passed, {ends:?}");
        for (end, error, speed, method) in &ends {
            assert!((end - truth).abs() <= 10.0 * (error + least), "{hill}, {speed}, {method:?}: {end}, {truth}");
        }
        assert!(told <= 4, "{hill}: {told} told, {ends:?}");
    }
}
