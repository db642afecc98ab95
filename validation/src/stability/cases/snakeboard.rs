//! The vakonomic snakeboard, by Hamilton's equations in the speed of the board.

use motion::{VAKONOMIC, VAKONOMIC_COSTATE};
use scene::Scene;

use crate::stability::question::Question;
use crate::stability::reference::Reference;

/// Middle to wheels, and the rotor's and the wheels' moment of inertia; `m = 1`.
const ARM: f64 = 0.4;
const ROTOR: f64 = 0.06;
const WHEELS: f64 = 0.01;

/// At the start: θ and φ, and the rates of θ, ψ, φ.
const ANGLES: [f64; 2] = [0.2, 0.5];
const RATES: [f64; 3] = [0.5, 1.5, 0.3];

pub(super) fn questions(duration: f64) -> Vec<Question> {
    let text = include_str!("../../../../crates/scene/classics/snakeboard.toml");
    let scene = move || Scene::parse_with("snakeboard", text, &[("duration".into(), duration)]);
    let mut questions =
        super::questions(duration, scene, &[VAKONOMIC, VAKONOMIC_COSTATE], |_| Board::at_start().reference());
    for question in &mut questions {
        question.each = true;
    }
    questions
}

/// What is constant: `p_x`, `p_y`, `p_θ + x p_y − y p_x` and `p_ψ`.
#[derive(Clone, Copy)]
struct Board {
    place: [f64; 2],
    turning: f64,
    rotor: f64,
}

/// The board has the velocity `u cos φ` along itself, none across, and `θ̇ = u sin φ/r`. With `P` and `S`,
/// the momentum along and across, `p_θ` and `k = (p_θ − p_ψ)/r`:
///
/// ```text
/// H = N²/2D + p_ψ²/2J_r + p_φ²/4J_w,    N = P cos φ + k sin φ,    D = 1 − J_r sin²φ/r²,    u = N/D
/// ```
struct Instant {
    u: f64,
    along: f64,
    across: f64,
    turning: f64,
    k: f64,
}

impl Board {
    /// `μ₀ = 0`.
    fn at_start() -> Board {
        let ([theta, phi], [turn, spin, _]) = (ANGLES, RATES);
        let along = ARM * turn / phi.tan();
        Board {
            place: [along * theta.cos(), along * theta.sin()],
            turning: ARM * ARM * turn + ROTOR * spin,
            rotor: ROTOR * (spin + turn),
        }
    }

    fn at(&self, y: &[f64]) -> Instant {
        let ([px, py], (sin, cos), (s, c)) = (self.place, y[2].sin_cos(), y[4].sin_cos());
        let (along, across) = (px * cos + py * sin, py * cos - px * sin);
        let turning = self.turning - y[0] * py + y[1] * px;
        let k = (turning - self.rotor) / ARM;
        let u = (along * c + k * s) / (1.0 - ROTOR * (s / ARM).powi(2));
        Instant { u, along, across, turning, k }
    }

    /// States `(x, y, θ, ψ, φ, p_φ)`. With `p = ∂𝓛/∂v`, `𝓛 = L + μ·f`:
    ///
    /// ```text
    /// P = u cos φ − (μ₁ − μ₂) sin φ,    S = (μ₁ + μ₂) cos φ,    p_θ = r² θ̇ + J_r ψ̇ + (μ₁ − μ₂) r cos φ
    /// ```
    fn reference(self) -> Reference {
        let ([theta, phi], [.., steer]) = (ANGLES, RATES);
        Reference::Ode {
            y: vec![0.0, 0.0, theta, 0.0, phi, 2.0 * WHEELS * steer],
            rates: Box::new(move |_, y, rates| {
                let Instant { u, along, k, .. } = self.at(y);
                let ((sin, cos), (s, c)) = (y[2].sin_cos(), y[4].sin_cos());
                let turn = u * s / ARM;
                rates[..3].copy_from_slice(&[u * c * cos, u * c * sin, turn]);
                rates[3] = self.rotor / ROTOR - turn;
                rates[4] = y[5] / (2.0 * WHEELS);
                rates[5] = u * (along * s - k * c) - u * u * ROTOR * s * c / (ARM * ARM);
            }),
            read: Box::new(move |_, y| {
                let (Instant { u, along, across, turning, .. }, (s, c)) = (self.at(y), y[4].sin_cos());
                let rotor = self.rotor - ROTOR * u * s / ARM;
                let difference = (turning - ARM * u * s - rotor) / ARM * c - (along - u * c) * s;
                let sum = across / c;
                [&y[..5], &[(sum + difference) / 2.0, (sum - difference) / 2.0]].concat()
            }),
        }
    }
}
