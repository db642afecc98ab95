//! The ball near the apex of the cone, and near the ends of its chart.

use equations::Formulation;
use mechanics::State;
use motion::{CHETAEV, REMOVED_CONSTRAINT, VAKONOMIC};
use nalgebra::Vector3;
use scene::{Scene, SceneError};

use super::GRAVITY;
use crate::stability::question::Question;
use crate::stability::reference::Reference;

const RADIUS: f64 = 0.1;
const HALF_ANGLE: f64 = 0.6;
/// `m = 1`, `k² = 2a²/5`.
const GYRATION: f64 = 0.4 * RADIUS * RADIUS;

/// Coordinates that are compared: r and γ.
const COMPARED: usize = 2;

/// Near the apex both vakonomic forms have the same equations of one instant; one of them will do.
const FORMULATIONS: [&Formulation; 3] = [CHETAEV, VAKONOMIC, REMOVED_CONSTRAINT];

pub(super) fn apex(d: f64) -> Vec<Question> {
    questions(d, &[("r", RADIUS / HALF_ANGLE.tan() + d), ("r'", -0.3), ("duration", 1.0)])
}

pub(super) fn chart(theta: f64) -> Vec<Question> {
    // no spin about the ball's axis that a small θ would blow up
    let speed = RADIUS * -0.5 * 0.4_f64.sin();
    questions(theta, &[("theta", theta), ("theta'", -0.5), ("r'", speed), ("duration", 1.0)])
}

fn questions(point: f64, overrides: &[(&str, f64)]) -> Vec<Question> {
    let overrides: Vec<(String, f64)> = overrides.iter().map(|&(name, x)| (name.into(), x)).collect();
    let scene = move || -> Result<Scene, SceneError> {
        Scene::parse_with("ball-in-cone", include_str!("../../../../crates/scene/scenes/ball-in-cone.toml"), &overrides)
    };
    let start = scene().map(|scene| scene.start);
    let mut questions = super::questions(point, scene, &FORMULATIONS, |name| match &start {
        Ok(start) => Ball::at(start).reference(name),
        // the scene is refused, and nothing is compared
        Err(_) => Reference::Closed(Box::new(|_| vec![f64::NAN; COMPARED])),
    });
    for question in &mut questions {
        question.compared = COMPARED;
    }
    questions
}

/// Unit vectors at azimuth γ: away from the axis, around it, along the generator, and into the cone.
struct Frame {
    out: Vector3<f64>,
    around: Vector3<f64>,
    along: Vector3<f64>,
    normal: Vector3<f64>,
}

impl Frame {
    fn at(gamma: f64) -> Frame {
        let ((s, c), (sin, cos)) = (gamma.sin_cos(), HALF_ANGLE.sin_cos());
        Frame {
            out: Vector3::new(c, s, 0.0),
            around: Vector3::new(-s, c, 0.0),
            along: Vector3::new(sin * c, sin * s, cos),
            normal: Vector3::new(-cos * c, -cos * s, sin),
        }
    }
}

/// The ball: contact `r` from the apex, centre `ρ = r sin α − a cos α` off the axis, `ω` in the cone's frame.
struct Ball {
    r: f64,
    gamma: f64,
    spin: Vector3<f64>,
    r_rate: f64,
    gamma_rate: f64,
}

fn centre(r: f64) -> f64 {
    r * HALF_ANGLE.sin() - RADIUS * HALF_ANGLE.cos()
}

fn vector(y: &[f64]) -> Vector3<f64> {
    Vector3::new(y[0], y[1], y[2])
}

impl Ball {
    /// From `(r, γ, φ, χ, θ)` and their rates, the line of nodes at `χ + γ`.
    fn at(start: &State) -> Ball {
        let (q, v) = (&start.q, &start.v);
        let (node, theta) = (q[3] + q[1], q[4]);
        let spin = v[4] * Vector3::new(node.cos(), node.sin(), 0.0)
            + (v[3] + v[1]) * Vector3::z()
            + v[2] * Vector3::new(theta.sin() * node.sin(), -theta.sin() * node.cos(), theta.cos());
        Ball { r: q[0], gamma: q[1], spin, r_rate: v[0], gamma_rate: v[1] }
    }

    /// Vakonomic with `μ₀ = 0`; removed with `P(t₀) = 0`, the vakonomic motion without momenta of r, γ (T2).
    fn reference(&self, formulation: &Formulation) -> Reference {
        let rho = centre(self.r);
        match formulation {
            own if own == CHETAEV => self.newton(),
            own if own == REMOVED_CONSTRAINT => {
                let turning = rho * rho * self.gamma_rate + GYRATION * self.spin.z;
                self.lie_poisson(-turning / (self.r * HALF_ANGLE.sin()), -self.r_rate)
            }
            _ => self.lie_poisson(0.0, 0.0),
        }
    }

    /// `ċ = a ω × n`, `I ω̇ = −a n × F`, `F = m (c̈ − g)`, whose component along `n` does not enter.
    fn newton(&self) -> Reference {
        Reference::Ode {
            y: vec![self.r, self.gamma, self.spin.x, self.spin.y, self.spin.z],
            rates: Box::new(|_, y, rates| {
                let (frame, spin) = (Frame::at(y[1]), vector(&y[2..]));
                let n = frame.normal;
                let velocity = RADIUS * spin.cross(&n);
                let turn = velocity.dot(&frame.around) / centre(y[0]);
                let n_rate = -turn * HALF_ANGLE.cos() * frame.around;
                let pull = RADIUS * spin.cross(&n_rate) + GRAVITY * Vector3::z();
                let tangential = (pull - n * n.dot(&pull)) / (1.0 + RADIUS * RADIUS / GYRATION);
                let spin_rate = -RADIUS / GYRATION * n.cross(&tangential);
                rates[..2].copy_from_slice(&[velocity.dot(&frame.along), turn]);
                rates[2..].copy_from_slice(spin_rate.as_slice());
            }),
            read: Box::new(|_, y| y[..2].to_vec()),
        }
    }

    /// `𝓛 = ½(ṙ² + ρ²γ̇² + k²ω²) − g r cos α + μ₁(ργ̇ + a ω·e_r) + μ₂(ṙ − a ω·e_γ)`: states
    /// `(r, γ, p_r, p_γ, π)` with `π = ∂𝓛/∂ω`, `π̇ = ω × π`.
    fn lie_poisson(&self, first: f64, second: f64) -> Reference {
        let (rho, frame) = (centre(self.r), Frame::at(self.gamma));
        let momentum = GYRATION * self.spin + RADIUS * (first * frame.along - second * frame.around);
        let (along, around) = (self.r_rate + second, rho * rho * self.gamma_rate + rho * first);
        Reference::Ode {
            y: vec![self.r, self.gamma, along, around, momentum.x, momentum.y, momentum.z],
            rates: Box::new(|_, y, rates| {
                let (rho, frame, momentum) = (centre(y[0]), Frame::at(y[1]), vector(&y[4..]));
                let (along, around) = (y[2], y[3]);
                let weight = GYRATION + RADIUS * RADIUS;
                let r_rate = RADIUS * (momentum.dot(&frame.around) + RADIUS * along) / weight;
                let speed = -RADIUS * (momentum.dot(&frame.along) - RADIUS * around / rho) / weight;
                let (first, second) = (around / rho - speed, along - r_rate);
                let spin = (momentum - RADIUS * (first * frame.along - second * frame.around)) / GYRATION;
                let turn = speed / rho;
                let sin = HALF_ANGLE.sin();
                rates[0] = r_rate;
                rates[1] = turn;
                rates[2] = (rho * turn + first) * sin * turn - GRAVITY * HALF_ANGLE.cos();
                rates[3] = RADIUS * (first * sin * spin.dot(&frame.around) + second * spin.dot(&frame.out));
                rates[4..].copy_from_slice(spin.cross(&momentum).as_slice());
            }),
            read: Box::new(|_, y| y[..2].to_vec()),
        }
    }
}
