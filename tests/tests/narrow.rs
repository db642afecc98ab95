//! Pulses and walls of any width at any place are resolved, or the run fails with a reason, by every method:
//! compared with integrals.

use diffsol_methods::{BDF, ESDIRK34, EVERY, TR_BDF2};
use integrate::Method;
use motion::{CHETAEV, Ending, Settings, choices, error_estimate, setting, solve_choice};
use scene::Scene;
use symbolic::SplitMix;

/// Draws of each family; `NARROW` asks for more.
const DRAWS: usize = 1;
/// Widths over this part of their place are to be found, but for so large a part of the runs.
const WIDE: f64 = 1e-9;
const REFUSED: f64 = 0.02;
/// What a run may be off by beside ten times its estimate, over what the pulse does; and by methods of low
/// order, whose two runs may be off alike.
const ALLOWED: f64 = 1e-7;
const BY_LOW_ORDER: f64 = 1e-5;

/// `f(u)` as scenes write it, with `U` for `u`, and in numbers.
type Shape = (&'static str, fn(f64) -> f64);

/// Forces, of the time.
const PULSES: [Shape; 10] = [
    ("exp(-U^2)", |u| (-u * u).exp()),
    ("(tanh(4*(U + 1)) - tanh(4*(U - 1)))/2", |u| ((4.0 * (u + 1.0)).tanh() - (4.0 * (u - 1.0)).tanh()) / 2.0),
    ("1/cosh(U)^2", |u| u.cosh().powi(-2)),
    ("exp(-U)/(1 + exp(-U))^2", |u| (0.5 / (0.5 * u).cosh()).powi(2)),
    ("1/cosh(U)", |u| 1.0 / u.cosh()),
    ("exp(-U^4)", |u| (-u.powi(4)).exp()),
    ("1/(1 + U^2)", |u| 1.0 / (1.0 + u * u)),
    ("1/(1 + U^2)^2", |u| (1.0 + u * u).powi(-2)),
    ("1/(1 + U^8)", |u| 1.0 / (1.0 + u.powi(8))),
    ("(1 + tanh(U))/2", |u| 0.5 * (1.0 + u.tanh())),
];

/// Potentials, of the place.
const WALLS: [Shape; 7] = [
    ("exp(-U^2)", |u| (-u * u).exp()),
    ("1/cosh(U)^2", |u| u.cosh().powi(-2)),
    ("1/(1 + U^2)", |u| 1.0 / (1.0 + u * u)),
    ("exp(-U^4)", |u| (-u.powi(4)).exp()),
    ("(1 + tanh(U))/2", |u| 0.5 * (1.0 + u.tanh())),
    ("(tanh(4*(U + 1)) - tanh(4*(U - 1)))/2", |u| ((4.0 * (u + 1.0)).tanh() - (4.0 * (u - 1.0)).tanh()) / 2.0),
    ("1/(1 + U^4)", |u| 1.0 / (1.0 + u.powi(4))),
];

/// ∫ g(u) du from `a` to `b`, by panels that grow away from 0, where `g` is steep.
fn integral(a: f64, b: f64, g: &dyn Fn(f64) -> f64) -> f64 {
    let mut ends = vec![0.0];
    let mut end = 0.0;
    while end < a.abs().max(b.abs()) {
        end = if end < 40.0 { end + 0.05 } else { end * 1.2 };
        ends.push(end);
    }
    let both = ends.iter().skip(1).rev().map(|x| -x).chain(ends.iter().copied());
    let mut edges: Vec<f64> = both.map(|x| x.clamp(a.min(b), a.max(b))).collect();
    edges.dedup();
    let nodes =
        [(0.069_431_844_202_973_71, 0.173_927_422_568_726_93), (0.330_009_478_207_571_87, 0.326_072_577_431_273_07)];
    let panel = |edge: &[f64]| {
        let (low, width) = (edge[0], edge[1] - edge[0]);
        let pair = |(x, weight): (f64, f64)| weight * (g(low + x * width) + g(low + (1.0 - x) * width));
        width * nodes.into_iter().map(pair).sum::<f64>()
    };
    edges.windows(2).map(panel).sum::<f64>() * (b - a).signum()
}

/// A particle, where it is at the end, and what is done to it.
struct Case {
    scene: String,
    truth: f64,
    effect: f64,
    width: f64,
    place: f64,
}

fn scene(lagrangian: &str, force: &str, speed: f64, duration: f64) -> String {
    format!(
        "title = \"narrow\"\n[coordinates]\nx = {{ start = 0 }}\n[system]\nlagrangian = \"{lagrangian}\"\n{force}\n\
         [start]\nvelocities = {{ \"x'\" = {speed:?} }}\n[run]\nduration = {duration:?}\n"
    )
}

impl Case {
    fn new(family: usize, random: &mut SplitMix) -> Case {
        let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
        let place = (10.0_f64).powf(between(-0.1, 6.0));
        let least = 100.0 * f64::EPSILON * place;
        let width = (10.0_f64).powf(between(least.log10(), -1.0));
        let (strength, far) = (between(0.5, 2.0), place * between(1.3, 2.0));
        let u = |what: &str| format!("(({what} - {place:?})/{width:?})");
        match PULSES.get(family) {
            Some((text, f)) => {
                // x(T) = ∫ (T − t) P f dt, P such that the velocity at the end is of size 1
                let unit = if text.starts_with("(1 + tanh") { 1.0 / place } else { 1.0 / width };
                let push = strength * unit;
                let (a, b) = (-place / width, (far - place) / width);
                let truth = push * width * width * integral(a, b, &|u| (b - u) * f(u));
                let force = format!("forces = {{ x = \"{push:?}*({})\" }}", text.replace('U', &u("t")));
                Case { scene: scene("x'^2/2", &force, 0.0, far), truth, effect: truth.abs(), width, place }
            }
            None => {
                let (text, f) = WALLS[family - PULSES.len()];
                // of energy 1/2, which the wall is not near
                let height = if strength > 1.25 { 0.5 * strength } else { 0.4 * strength };
                let (truth, effect) = passage(place, width, height, far, f);
                let lagrangian = format!("x'^2/2 - {height:?}*({})", text.replace('U', &u("x")));
                // the potential at the start takes from the energy
                let speed = (1.0 - 2.0 * height * f(-place / width)).sqrt();
                Case { scene: scene(&lagrangian, "", speed, far), truth, effect, width, place }
            }
        }
    }
}

/// Where a particle of energy 1/2 from 0 is after a time, with a wall at `place`; and what the wall does.
fn passage(place: f64, width: f64, height: f64, time: f64, f: fn(f64) -> f64) -> (f64, f64) {
    let square = |u: f64| 1.0 - 2.0 * height * f(u);
    let start = -place / width;
    // in units of the width; longer than at the speed 1 by
    let slower = |u: f64| 1.0 / square(u).sqrt() - 1.0;
    if height * f(0.0).max(f(50.0)) < 0.5 {
        // x with x + ∫ slower = time
        let (mut low, mut high) = (0.0, 2.0 * time);
        for _ in 0..60 {
            let x = 0.5 * (low + high);
            let passed = x + width * integral(start, (x - place) / width, &slower);
            if passed < time { low = x } else { high = x }
        }
        return (low, low);
    }
    let (mut low, mut high) = (-50.0_f64.max(start), if f(50.0) > 0.5 { 50.0 } else { 0.0 });
    for _ in 0..100 {
        let u = 0.5 * (low + high);
        if square(u) > 0.0 { low = u } else { high = u }
    }
    // u = turn − s², to which the root of the speed is nearly proportional
    let near = (low - 4.0).max(start);
    let steps = 20_000;
    let h = (low - near).sqrt() / f64::from(steps);
    let last: f64 = (0..steps)
        .map(|i| (f64::from(i) + 0.5) * h)
        .map(|s| 2.0 * s * h / square(low - s * s).max(1e-300).sqrt())
        .sum();
    let there = (near - start) + integral(start, near, &slower) + last;
    // back at the speed 1, later by what it was slower on the way
    let rest = time - 2.0 * width * there;
    let back = |x: f64| width * integral(start, ((x - place) / width).min(near), &slower);
    let (mut low, mut high) = (-2.0 * time, place);
    for _ in 0..60 {
        // from x = 0 on, where it is after the time of there and back
        let x = 0.5 * (low + high);
        if -(x + back(x)) > rest { low = x } else { high = x }
    }
    (low, 2.0 * (time - place).abs().max(place))
}

#[test]
fn pulses_and_walls_are_found_or_told_at_any_place() {
    let draws = std::env::var("NARROW").ok().and_then(|n| n.parse().ok()).unwrap_or(DRAWS);
    let mut random = SplitMix::new(36);
    let (mut right, mut wide, mut told, mut told_wide, mut wrong) = (0, 0, 0, 0, Vec::new());
    let methods = EVERY.into_iter().map(Some).chain([None]);
    for case in (0..draws).flat_map(|_| 0..PULSES.len() + WALLS.len()).map(|family| Case::new(family, &mut random)) {
        let Case { truth, effect, width, place, .. } = case;
        let scene = Scene::parse("narrow", &case.scene).unwrap_or_else(|e| panic!("{e}\n{}", case.scene));
        let chetaev = choices(&scene).into_iter().find(|c| c.formulation == CHETAEV).expect("it is there");
        let is_wide = width > WIDE * place;
        for method in methods.clone() {
            let one_of = |methods: &[Method]| method.is_some_and(|method| methods.contains(&method));
            let tolerance = if one_of(&[TR_BDF2, ESDIRK34]) { 1e-6 } else { 1e-8 };
            let is_low = one_of(&[BDF, TR_BDF2, ESDIRK34]);
            let allowed = if is_low { BY_LOW_ORDER } else { ALLOWED };
            let settings = Settings { method, tolerance, ..Settings::default() };
            wide += usize::from(is_wide);
            let status = solve_choice(&scene, &chetaev, &settings).map_err(|e| e.to_string()).and_then(|mut motion| {
                let estimate = error_estimate(&mut motion, setting(&scene)).map_err(|e| e.to_string())?;
                match (&motion.ending, estimate.status(&motion)) {
                    (Ending::Completed, ("completed", _)) => {
                        let end = motion.at(motion.end()).map_err(|e| e.to_string())?;
                        Ok((end.coordinates[0], estimate.coordinates[0]))
                    }
                    (_, (status, cause)) => Err(format!("{status}: {}", cause.unwrap_or_default())),
                }
            });
            let by = format!("{}, width {width:.1e} at {place:.3e}", method.map_or("default", Method::name));
            match status {
                Err(cause) => {
                    println!("{by}: {cause}");
                    told += 1;
                    told_wide += usize::from(is_wide);
                }
                Ok((x, estimate)) if (x - truth).abs() <= 10.0 * estimate + allowed * effect => right += 1,
                Ok((x, estimate)) => {
                    wrong.push(format!("{by}: {x} for {truth}, estimate {estimate:.1e}\n{}", case.scene));
                }
            }
        }
    }
    println!("{right} right, {told} told, {told_wide} of {wide} wide ones, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{right} right, {told} told, {} wrong:\n{}", wrong.len(), wrong.join("\n"));
    assert!(told_wide as f64 <= REFUSED * wide as f64 + 1.0, "{told_wide} of {wide} wide ones are refused");
}
