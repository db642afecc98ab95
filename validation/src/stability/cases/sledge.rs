//! The sledge with a mass that hardly resists turning, or hardly turns; and for a long time.

use equations::Formulation;
use motion::{CHETAEV, REMOVED_CONSTRAINT};
use referees::closed_forms;
use scene::{Scene, SceneError};

use super::disc::HEADING;
use super::{FORMULATIONS, GRAVITY};
use crate::stability::question::Question;
use crate::stability::reference::Reference;

pub(super) fn questions(point: f64, k: f64, duration: f64) -> Vec<Question> {
    super::questions(point, move || scene(k, duration), &FORMULATIONS, |name| Sledge { k }.reference(name))
}

/// The sledge of the scene over 10 s by equal steps.
pub(super) fn steps(step: f64) -> Vec<Question> {
    super::stepped(questions(step, RADIUS, 10.0), step, || scene(RADIUS, 10.0), &FORMULATIONS)
}

fn scene(k: f64, duration: f64) -> Result<Scene, SceneError> {
    let overrides = [("k".into(), k), ("duration".into(), duration)];
    Scene::parse_with("sledge", include_str!("../../../../crates/scene/scenes/sledge.toml"), &overrides)
}

/// The sledge of the scene with radius of gyration `k`.
pub(super) struct Sledge {
    pub(super) k: f64,
}

/// Radius of gyration of the scene.
pub(super) const RADIUS: f64 = 0.7;
const SLOPE: f64 = 0.4;
const OMEGA: f64 = 1.1;
const SPEED: f64 = 0.5;

impl Sledge {
    /// Chetaev; vakonomic with `μ₀ = 0`; removed constraint by arc length with `P(t₀) = 0`.
    pub(super) fn reference(&self, formulation: &Formulation) -> Reference {
        let (sin, cos) = HEADING.sin_cos();
        match formulation {
            own if own == CHETAEV => {
                let gravity_along = GRAVITY * SLOPE.sin();
                let sledge =
                    closed_forms::Sledge { gravity_along, x: 0.0, y: 0.0, phi: HEADING, speed: SPEED, omega: OMEGA };
                Reference::Closed(Box::new(move |t| {
                    let state = sledge.at(t);
                    vec![state.x, state.y, state.phi]
                }))
            }
            own if own == REMOVED_CONSTRAINT => self.by_heading([0.0, 0.0]),
            _ => self.by_heading([SPEED * cos, SPEED * sin]),
        }
    }

    /// With `e = (cos φ, sin φ)`, `n = (−sin φ, cos φ)` and `p = (p_x + g t sin α, p_y)`:
    ///
    /// ```text
    /// k² φ̈ = −u̇ p·n,    u̇ = u̇₀ + p·e − p₀·e₀,    (ẋ, ẏ) = u̇ e
    /// ```
    ///
    /// Hamilton's for `½(p·e)² + ½p_φ²/k² − g x sin α`, `p₀ = u̇₀ e₀ + μ₀ n₀`; by arc length `p₀ = −P(t₀)`.
    fn by_heading(&self, momentum: [f64; 2]) -> Reference {
        let square = self.k * self.k;
        let push = GRAVITY * SLOPE.sin();
        let rest = SPEED - momentum[0] * HEADING.cos() - momentum[1] * HEADING.sin();
        Reference::Ode {
            y: vec![HEADING, OMEGA, 0.0, 0.0],
            rates: Box::new(move |t, y, rates| {
                let (sin, cos) = y[0].sin_cos();
                let (px, py) = (momentum[0] + push * t, momentum[1]);
                let speed = rest + px * cos + py * sin;
                rates[0] = y[1];
                rates[1] = -speed * (py * cos - px * sin) / square;
                rates[2] = speed * cos;
                rates[3] = speed * sin;
            }),
            read: Box::new(|_, y| vec![y[2], y[3], y[0]]),
        }
    }
}
