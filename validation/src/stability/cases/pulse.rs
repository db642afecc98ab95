//! Pulses in time: nothing, a push, nothing.

use symbolic::SplitMix;

use super::FORMULATIONS;
use super::disc::{Disc, HEADING, INERTIA};
use super::integral::Integral;
use super::wall::DURATION;
use crate::stability::question::Question;

const ROLL: f64 = 0.3;

/// A function of time in widths from its middle, as text in `U` and in numbers; both depend on the width.
struct Shape {
    name: &'static str,
    text: fn(f64) -> String,
    on: fn(f64, f64) -> f64,
}

const SHAPES: [Shape; 8] = [
    Shape { name: "bell", text: |_| "exp(-U^2)".into(), on: |u, _| (-u * u).exp() },
    Shape {
        name: "switch",
        text: |_| "(tanh(10*U + 5) - tanh(10*U - 5))/2".into(),
        on: |u, _| ((10.0 * u + 5.0).tanh() - (10.0 * u - 5.0).tanh()) / 2.0,
    },
    Shape { name: "soliton", text: |_| "(1 - tanh(U)^2)".into(), on: |u, _| u.cosh().powi(-2) },
    Shape { name: "quotient", text: |_| "1/(1 + U^2)^4".into(), on: |u, _| (1.0 + u * u).powi(-4) },
    Shape { name: "flat top", text: |_| "exp(-U^8)".into(), on: |u, _| (-u.powi(8)).exp() },
    Shape { name: "power of ten", text: |_| "10^(-U^2)".into(), on: |u, _| 10.0_f64.powf(-u * u) },
    Shape { name: "secant", text: |_| "1/cosh(U)^2".into(), on: |u, _| u.cosh().powi(-2) },
    Shape {
        name: "high power",
        text: |width| format!("cos(U*{width}/4)^{}", exponent(width)),
        // other pulses are beyond the run
        on: |u, width| (u * width / 4.0).clamp(-1.5, 1.5).cos().powf(exponent(width)),
    },
];

/// That of a cosine of a quarter of the time which is nearly a bell of this width.
fn exponent(width: f64) -> f64 {
    (32.0 / (width * width)).round()
}

/// Number of widths beyond which every shape is zero.
const REACH: f64 = 1000.0;

/// A push somewhere within the run.
struct Pulse {
    shape: &'static Shape,
    at: f64,
    width: f64,
    strength: f64,
}

impl Pulse {
    /// Place and strength are random.
    fn new(shape: &'static Shape, width: f64, seed: u64) -> Pulse {
        let mut random = SplitMix::new(seed ^ width.to_bits());
        let at = 1.0 + (2.0 * DURATION - 2.0) * random.unit();
        Pulse { shape, at, width, strength: 0.5 + 1.5 * random.unit() }
    }

    fn text(&self) -> String {
        let Pulse { shape, at, width, strength } = self;
        format!("{strength}*{}", (shape.text)(*width).replace('U', &format!("((t - {at})/{width})")))
    }

    /// `∫₀ᵗ (t − s) on(s) ds`: the way of a unit mass from rest. With `s = at + width sinh v`.
    fn way(self) -> impl Fn(f64) -> f64 + Send + Sync {
        let Pulse { shape, at, width, strength } = self;
        let (on, end) = (shape.on, REACH.asinh());
        let points: Vec<f64> = (-320..=320).map(|i| end * f64::from(i) / 320.0).collect();
        let sum = Integral::new(move |v: f64| on(v.sinh(), width) * v.cosh(), points.clone());
        let moment = Integral::new(move |v: f64| on(v.sinh(), width) * v.sinh() * v.cosh(), points);
        move |t| {
            let (u, first) = ((t - at) / width, -at / width);
            let [to, from] = [u, first].map(|u| u.clamp(-REACH, REACH).asinh());
            strength * width * width * (u * (sum.at(to) - sum.at(from)) - (moment.at(to) - moment.at(from)))
        }
    }
}

/// A force of every shape, which turns the disc, too.
pub(super) fn forces(width: f64, speeds: [f64; 2]) -> Vec<Question> {
    let of_shape = |shape: &'static Shape| {
        let pulse = Pulse::new(shape, width, shape.name.len() as u64);
        let on = pulse.text();
        let disc = Disc {
            term: "0".into(),
            forces: [on.clone(), format!("0.1*{on}")],
            roll: ROLL,
            speeds,
            duration: 2.0 * DURATION,
        };
        let way = pulse.way();
        disc.turning(width, shape.name, move |t| {
            let push = way(t);
            [ROLL + speeds[0] * t + push / INERTIA[0], HEADING + speeds[1] * t + 0.1 * push / INERTIA[1]]
        })
    };
    SHAPES.iter().map(of_shape).collect()
}

/// A potential along the way, one shape after the other.
pub(super) fn potentials(width: f64, speed: f64) -> Vec<Question> {
    let (disc, roll) = along(width, speed);
    disc.straight(width, roll)
}

/// The same of a tenth of a second, by equal steps.
pub(super) fn steps(step: f64) -> Vec<Question> {
    let (disc, roll) = along(0.1, 0.3);
    let scene = disc.clone();
    super::stepped(disc.straight(step, roll), step, move || scene.scene(), &FORMULATIONS)
}

fn along(width: f64, speed: f64) -> (Disc, impl Fn(f64) -> f64 + Send + Sync) {
    let shape = &SHAPES[(2.0 * width.log10()).round().abs() as usize % SHAPES.len()];
    let pulse = Pulse::new(shape, width, 7);
    let (term, forces) = (format!("a*{}", pulse.text()), ["0".into(), "0".into()]);
    let way = pulse.way();
    let disc = Disc { term, forces, roll: ROLL, speeds: [speed, 0.0], duration: 2.0 * DURATION };
    (disc, move |t| ROLL + speed * t + way(t) / INERTIA[0])
}
