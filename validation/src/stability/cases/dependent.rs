//! Two constraints that are nearly one.

use scene::Scene;

use super::FORMULATIONS;
use crate::stability::question::{Case, Question};
use crate::stability::reference::Reference;

pub(super) const CASE: Case = Case {
    name: "dependent",
    about: "A point in four dimensions with f₁ = ż − yẋ and f₂ = f₁ + d (ż + ẇ − xẏ): the rows of A are at an angle of about d. The values of d are \
            powers of 2, so that 1 + d is exact and the constraints are equivalent to ż = yẋ, ẇ = xẏ − yẋ for every d.",
    reference: "hand-derived equations in x and y alone, with d eliminated; double run of DOP853",
    variable: "d",
    questions,
};

/// Exponents of `d`: 10⁻² … 10⁻¹⁴, nearly.
const EXPONENTS: [i32; 9] = [-7, -13, -20, -23, -26, -30, -33, -40, -46];

fn questions() -> Vec<Question> {
    let of = |exponent: &i32| {
        let d = 2.0_f64.powi(*exponent);
        super::questions(d, move || scene(d), &FORMULATIONS, reference)
    };
    EXPONENTS.iter().flat_map(of).collect()
}

const START: [f64; 4] = [0.3, -0.5, 1.0, 0.5];

/// The scene with `d`.
pub(super) fn scene(d: f64) -> Result<Scene, scene::SceneError> {
    let [x, y, dx, dy] = START;
    let text = format!(
        r#"
title = "Two constraints that are nearly one"
[parameters]
d = {d:?}
[coordinates]
x = {{ start = {x:?} }}
y = {{ start = {y:?} }}
z = {{ start = 0 }}
w = {{ start = 0 }}
[system]
lagrangian = "(x'^2 + y'^2 + z'^2 + w'^2)/2"
constraints = ["z' - y*x'", "(1 + d)*z' - y*x' + d*w' - d*x*y'"]
[start.velocities]
"x'" = {dx:?}
"y'" = {dy:?}
[run]
duration = 5
"#
    );
    Scene::parse("dependent", &text)
}

/// With `X = (1, 0, y, −y)` and `Y = (0, 1, 0, x)`, a basis of the kernel of `A`, and their products `G = [1 + 2y², −xy; −xy, 1 + x²]`:
///
/// ```text
/// Chetaev      G (ẍ, ÿ) = (−yẋẏ, 0)
/// vakonomic    G (ẋ, ẏ) = (p·X, p·Y),   ṗ_x = −ẏp_w − yẋẏ + xẏ²,   ṗ_y = −ẋ(p_z − p_w) + 2yẋ² − xẋẏ,   p_z, p_w constant
/// ```
///
/// The removed-constraint motion with `P(t₀) = 0` is the vakonomic one with `p_z = p_w = 0` (T2).
fn reference(formulation: &'static str) -> Reference {
    let [x, y, dx, dy] = START;
    let solve = |x: f64, y: f64, a: f64, b: f64| {
        let (g, h, k) = (1.0 + 2.0 * y * y, -x * y, 1.0 + x * x);
        let determinant = g * k - h * h;
        ((k * a - h * b) / determinant, (g * b - h * a) / determinant)
    };
    if formulation == "chetaev" {
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
    let (pz, pw) = if formulation == "removed-constraint" { (0.0, 0.0) } else { (y * dx, x * dy - y * dx) };
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
