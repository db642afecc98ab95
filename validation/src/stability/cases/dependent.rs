//! Two constraints that are nearly one.

use equations::Formulation;
use motion::{CHETAEV, REMOVED_CONSTRAINT};
use scene::Scene;

use super::FORMULATIONS;
use crate::stability::question::Question;
use crate::stability::reference::Reference;

const START: [f64; 4] = [0.3, -0.5, 1.0, 0.5];

/// With `d = 2^exponent`.
pub(super) fn questions(exponent: i32) -> Vec<Question> {
    let d = 2.0_f64.powi(exponent);
    let scene = move || Scene::parse_with("dependent", include_str!("dependent.toml"), &[("d".into(), d)]);
    super::questions(d, scene, &FORMULATIONS, reference)
}

/// `X = (1, 0, y, −y)`, `Y = (0, 1, 0, x)`: a basis of ker `A`, with products
/// `G = [1 + 2y², −xy; −xy, 1 + x²]`:
///
/// ```text
/// Chetaev    G (ẍ, ÿ) = (−yẋẏ, 0)
/// vakonomic  G (ẋ, ẏ) = (p·X, p·Y), ṗ_x = −ẏp_w − yẋẏ + xẏ², ṗ_y = −ẋ(p_z − p_w) + 2yẋ² − xẋẏ, ṗ_z = ṗ_w = 0
/// ```
///
/// The removed-constraint motion with `P(t₀) = 0` is the vakonomic one with `p_z = p_w = 0` (T2).
fn reference(formulation: &Formulation) -> Reference {
    let [x, y, dx, dy] = START;
    let solve = |x: f64, y: f64, a: f64, b: f64| {
        let (g, h, k) = (1.0 + 2.0 * y * y, -x * y, 1.0 + x * x);
        let determinant = g * k - h * h;
        ((k * a - h * b) / determinant, (g * b - h * a) / determinant)
    };
    if formulation == CHETAEV {
        return Reference::Ode {
            y: vec![x, y, 0.0, 0.0, dx, dy],
            rates: Box::new(move |_, s, rates| {
                let (x, y, dx, dy) = (s[0], s[1], s[4], s[5]);
                let (ddx, ddy) = solve(x, y, -y * dx * dy, 0.0);
                rates.copy_from_slice(&[dx, dy, y * dx, x * dy - y * dx, ddx, ddy]);
            }),
            read: Box::new(|_, s| s[..4].to_vec()),
        };
    }
    let (pz, pw) = if formulation == REMOVED_CONSTRAINT { (0.0, 0.0) } else { (y * dx, x * dy - y * dx) };
    let (along_x, along_y) = ((1.0 + 2.0 * y * y) * dx - x * y * dy, (1.0 + x * x) * dy - x * y * dx);
    Reference::Ode {
        y: vec![x, y, 0.0, 0.0, along_x - y * (pz - pw), along_y - x * pw],
        rates: Box::new(move |_, s, rates| {
            let (x, y) = (s[0], s[1]);
            let (dx, dy) = solve(x, y, s[4] + y * (pz - pw), s[5] + x * pw);
            let along_x = -dy * pw - y * dx * dy + x * dy * dy;
            let along_y = -dx * (pz - pw) + 2.0 * y * dx * dx - x * dx * dy;
            rates.copy_from_slice(&[dx, dy, y * dx, x * dy - y * dx, along_x, along_y]);
        }),
        read: Box::new(|_, s| s[..4].to_vec()),
    }
}
