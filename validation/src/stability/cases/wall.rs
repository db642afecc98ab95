//! Walls, wells and kinks in the state, and friction: steep where the disc is somewhere, or slow.

use super::disc::{Disc, HEADING, INERTIA};
use super::integral::{Integral, distances};
use crate::stability::question::Question;

/// From here, at this speed, where it does not start at rest.
const START: f64 = -1.0;
const SPEED: f64 = 1.0;
pub(super) const DURATION: f64 = 3.0;

/// The disc in a potential `V(a)`, as text, rolling from `roll` at `speed`.
fn disc(potential: &str, roll: f64, speed: f64) -> Disc {
    let forces = ["0".into(), "0".into()];
    Disc { term: format!("(-({potential}))"), forces, roll, speeds: [speed, 0.0], duration: DURATION }
}

/// Over a hill or a well of this width around 0: `t = ∫ da/√(2(E − V)/M)`.
fn across(width: f64, text: &str, potential: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Vec<Question> {
    let energy = INERTIA[0] * SPEED * SPEED / 2.0 + potential(START);
    let mut points: Vec<f64> = distances(width, -START).iter().rev().map(|d| -d).collect();
    points.extend(distances(width, 10.0).into_iter().skip(1));
    let time = Integral::new(move |a| (INERTIA[0] / 2.0 / (energy - potential(a))).sqrt(), points);
    disc(text, START, SPEED).straight(width, move |t| time.inverse(t))
}

/// A hill that is passed.
pub(super) fn hill(width: f64) -> Vec<Question> {
    across(width, &format!("0.5*(1 - tanh(a/{width:?})^2)"), move |a| 0.5 * (a / width).cosh().powi(-2))
}

/// A step up, passed.
pub(super) fn step(width: f64) -> Vec<Question> {
    across(width, &format!("0.3*(1 + tanh(a/{width:?}))"), move |a| 0.3 * (1.0 + (a / width).tanh()))
}

/// A deep well.
pub(super) fn well(width: f64) -> Vec<Question> {
    across(width, &format!("-2*exp(-(a/{width:?})^2)"), move |a| -2.0 * (-(a / width).powi(2)).exp())
}

/// The roll of what turns back at `turn`, with this kinetic energy at a distance before it: `a = turn − q²`,
/// `t = ∫ 2q dq/√(2T/M)`. It starts at `from`.
fn back(
    [width, turn, from]: [f64; 3],
    kinetic: impl Fn(f64) -> f64 + Send + Sync,
) -> impl Fn(f64) -> f64 + Send + Sync {
    let time =
        Integral::new(move |q| 2.0 * q * (INERTIA[0] / 2.0 / kinetic(q * q)).sqrt(), distances(width.sqrt(), 4.0));
    let turned = time.at((turn - from).sqrt());
    move |t| turn - time.inverse((t - turned).abs()).powi(2)
}

/// A wall `1.5 (1 + tanh(a/width))/2`, twice as high as the disc comes.
pub(super) fn tanh(width: f64) -> Vec<Question> {
    let potential = move |a: f64| 0.75 * (1.0 + (a / width).tanh());
    let energy = INERTIA[0] * SPEED * SPEED / 2.0 + potential(START);
    let turn = width * (energy / 0.75 - 1.0).atanh();
    // tanh x − tanh (x − y) = sinh y/(cosh x cosh (x − y))
    let kinetic = move |d: f64| {
        let (x, y) = (turn / width, d / width);
        let quotient = if y < 300.0 { y.sinh() / (x - y).cosh() } else { x.exp() };
        0.75 * quotient / x.cosh()
    };
    let roll = back([width, turn, START], kinetic);
    disc(&format!("0.75*(1 + tanh(a/{width:?}))"), START, SPEED).straight(width, roll)
}

/// A wall `e^(a/width)`.
pub(super) fn exponential(width: f64) -> Vec<Question> {
    let energy = INERTIA[0] * SPEED * SPEED / 2.0 + (START / width).exp();
    let roll = back([width, width * energy.ln(), START], move |d| -energy * (-d / width).exp_m1());
    disc(&format!("exp(a/{width:?})"), START, SPEED).straight(width, roll)
}

/// The same from rest on the wall, where it is steep.
pub(super) fn on_the_wall(width: f64) -> Vec<Question> {
    let roll = back([width, 0.0, 0.0], move |d| -(-d / width).exp_m1());
    disc(&format!("exp(a/{width:?})"), 0.0, 0.0).straight(width, roll)
}

/// From rest in a valley `√(a² + width²)`, to and fro.
pub(super) fn valley(width: f64) -> Vec<Question> {
    const TOP: f64 = 0.4;
    // V(top) − V(a) = (top² − a²)/(V(top) + V(a)), top − a = q²
    let kinetic = move |d: f64| d * (2.0 * TOP - d) / (TOP.hypot(width) + (TOP - d).hypot(width));
    let bottom = TOP.sqrt();
    let points = distances(width / 2.0 / bottom, bottom).iter().rev().map(|d| bottom - d).collect();
    let time = Integral::new(move |q: f64| 2.0 * q * (INERTIA[0] / 2.0 / kinetic(q * q)).sqrt(), points);
    let quarter = time.at(bottom);
    disc(&format!("sqrt(a^2 + {width:?}^2)"), TOP, 0.0).straight(width, move |t| {
        let quarters = (t / quarter).floor();
        let part = t - quarters * quarter;
        let fall = |t: f64| TOP - time.inverse(t).powi(2);
        match quarters as usize % 4 {
            0 => fall(part),
            1 => -fall(quarter - part),
            2 => -fall(part),
            _ => fall(quarter - part),
        }
    })
}

/// Pushes with a kink where the heading, which turns evenly, is 1: in value, and in slope.
pub(super) fn kinks(width: f64) -> Vec<Question> {
    const RATE: f64 = 0.5;
    let question = |kind: &str, text: String, twice: [fn(f64, f64) -> f64; 2]| {
        let disc = Disc {
            term: "0".into(),
            forces: [text, "0".into()],
            roll: START,
            speeds: [SPEED, RATE],
            duration: DURATION,
        };
        disc.turning(width, kind, move |t| {
            let [u, first] = [HEADING + RATE * t - 1.0, HEADING - 1.0];
            let way = twice[1](u, width) - twice[1](first, width) - twice[0](first, width) * (u - first);
            [START + SPEED * t + way / RATE.powi(2) / INERTIA[0], HEADING + RATE * t]
        })
    };
    let root = format!("sqrt((b - 1)^2 + {width:?}^2)");
    // ∫ √(u² + w²) du, and that integrated once more
    let area: fn(f64, f64) -> f64 = |u, w| (u * u.hypot(w) + w * w * (u / w).asinh()) / 2.0;
    let volume: fn(f64, f64) -> f64 =
        |u, w| u.hypot(w).powi(3) / 6.0 + w * w * (u * (u / w).asinh() - u.hypot(w)) / 2.0;
    vec![
        question("kink", root.clone(), [area, volume]),
        question("jump", format!("(b - 1)/{root}"), [|u, w| u.hypot(w), area]),
    ]
}

/// Friction `−tanh(ȧ/width)` and `−0.05 tanh(ḃ/width)`: with `u = ȧ/width`,
///
/// ```text
/// sinh u = sinh u₀ e^(−Ft/(M width)),  ∫ ȧ dt = (M width²/F) ∫ u coth u du,  u coth u = u + 2u/(e^(2u) − 1)
/// ```
pub(super) fn friction(width: f64) -> Question {
    const SPEEDS: [f64; 2] = [1.0, 0.6];
    const FRICTION: [f64; 2] = [1.0, 0.05];
    let disc = Disc {
        term: "0".into(),
        forces: [format!("-tanh(a'/{width:?})"), format!("-0.05*tanh(b'/{width:?})")],
        roll: START,
        speeds: SPEEDS,
        duration: 2.0 * DURATION,
    };
    let rest = Integral::new(|u: f64| 2.0 * u / (2.0 * u).exp_m1(), (0..=100).map(|i| 0.2 * f64::from(i)).collect());
    let area = move |u: f64| u * u / 2.0 + rest.at(u.min(20.0));
    disc.turning(width, "friction", move |t| {
        let way = |k: usize| {
            let first = SPEEDS[k] / width;
            // ln sinh u
            let now = first + (-(-2.0 * first).exp()).ln_1p() - 2.0_f64.ln() - FRICTION[k] * t / INERTIA[k] / width;
            let u = if now > 20.0 { now + 2.0_f64.ln() } else { now.exp().asinh() };
            INERTIA[k] * width * width / FRICTION[k] * (area(first) - area(u))
        };
        [START + way(0), HEADING + way(1)]
    })
}
