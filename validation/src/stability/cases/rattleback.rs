//! The rattleback, by Newton's and Euler's equations.

use motion::CHETAEV;
use nalgebra::{Matrix3, Rotation3, Vector3};
use scene::Scene;

use super::GRAVITY;
use crate::stability::question::Question;
use crate::stability::reference::Reference;

/// Squares of the half axes; `m = 1`.
const SQUARES: [f64; 3] = [0.20 * 0.20, 0.05 * 0.05, 0.04 * 0.04];

/// `(x, y)`, `(ψ, α, β)` and `ω` in body axes at the start.
const START: [f64; 8] = [0.0, 0.0, 0.3, 0.0, 0.0, 0.1, 0.4, 3.0];

pub(super) fn questions(duration: f64) -> Vec<Question> {
    let text = include_str!("../../../../crates/scene/classics/rattleback.toml");
    let scene = move || Scene::parse_with("rattleback", text, &[("duration".into(), duration)]);
    let mut questions = super::questions(duration, scene, &[CHETAEV], |_| Reference::Ode {
        y: START.to_vec(),
        rates: Box::new(|_, y, rates| {
            let ((sin, cos), spin) = (y[4].sin_cos(), Vector3::new(y[5], y[6], y[7]));
            let body = Body::at(y);
            let velocity = Rotation3::from_axis_angle(&Vector3::z_axis(), y[2]) * body.tilt * body.velocity;
            let turn = (spin.z * cos - spin.x * sin) / y[3].cos();
            let turns = [turn, spin.x * cos + spin.z * sin, spin.y - turn * y[3].sin()];
            rates[..2].copy_from_slice(&velocity.as_slice()[..2]);
            rates[2..5].copy_from_slice(&turns);
            rates[5..].copy_from_slice(body.spin_rate.as_slice());
        }),
        read: Box::new(|_, y| {
            let body = Body::at(y);
            [&[y[0], y[1], body.height, y[2], y[3], y[4]], (body.tilt * body.force).as_slice()].concat()
        }),
    });
    for question in &mut questions {
        question.each = true;
    }
    questions
}

/// Vectors in body axes; `tilt` takes them to axes that follow ψ only.
struct Body {
    tilt: Rotation3<f64>,
    height: f64,
    velocity: Vector3<f64>,
    spin_rate: Vector3<f64>,
    /// Of the ground.
    force: Vector3<f64>,
}

impl Body {
    /// With the vertical `n`, `ṅ = n × ω`, the height `z = (n·D²n)^½` and the contact at `r = −D²n/z` from
    /// the centre:
    ///
    /// ```text
    /// v = r × ω,    v̇ + ω × v = F − g n,    I ω̇ + ω × Iω = r × F
    /// ```
    ///
    /// where `v̇ = ṙ × ω + r × ω̇`, so that `(I + r² − r rᵀ) ω̇ = r × (ṙ × ω + ω × v + g n) − ω × Iω`.
    fn at(y: &[f64]) -> Body {
        let inertia = Matrix3::new(0.0008, 0.0010, 0.0, 0.0010, 0.0080, 0.0, 0.0, 0.0, 0.0084);
        let (squares, spin) = (Vector3::from(SQUARES), Vector3::new(y[5], y[6], y[7]));
        let tilt =
            Rotation3::from_axis_angle(&Vector3::x_axis(), y[3]) * Rotation3::from_axis_angle(&Vector3::y_axis(), y[4]);
        let n = tilt.inverse() * Vector3::z();
        let n_rate = n.cross(&spin);
        let (pole, pole_rate) = (squares.component_mul(&n), squares.component_mul(&n_rate));
        let height = n.dot(&pole).sqrt();
        let (r, r_rate) = (-pole / height, pole * (n_rate.dot(&pole) / height.powi(3)) - pole_rate / height);
        let velocity = r.cross(&spin);
        let pull = r_rate.cross(&spin) + spin.cross(&velocity) + GRAVITY * n;
        let about_contact = inertia + Matrix3::identity() * r.norm_squared() - r * r.transpose();
        let moment = r.cross(&pull) - spin.cross(&(inertia * spin));
        // positive definite as long as there is a number in it
        let spin_rate = about_contact.cholesky().map_or(moment * f64::NAN, |factors| factors.solve(&moment));
        Body { tilt, height, velocity, spin_rate, force: r.cross(&spin_rate) + pull }
    }
}
