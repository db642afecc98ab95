//! One system, as text for the program and as functions of numbers; Euler–Lagrange expressions by
//! differences.

use equations::{Compiled, Equations};
use mechanics::System;

/// Positions at which equations are judged.
pub const Q: [f64; 3] = [0.4, -0.7, 0.3];
/// The time.
pub const T: f64 = 0.9;

/// Velocities with which the constraint holds there.
pub fn velocities() -> [f64; 3] {
    let (x, phi) = (0.8, 1.1);
    [x, (x * Q[2].sin() + T * Q[0] / 2.0) / Q[2].cos(), phi]
}

/// `L`: masses that depend on place, coupled velocities, time.
pub fn lagrangian(q: &[f64], v: &[f64], t: f64) -> f64 {
    (1.0 + q[0] * q[0]) / 2.0 * v[0] * v[0]
        + v[1] * v[1] / 2.0
        + (2.0 + q[2].cos()) / 4.0 * v[2] * v[2]
        + v[0] * v[1] * t.sin() / 3.0
        - q[0] * q[1]
}

/// `f`: a blade on a floor that moves.
pub fn constraint(q: &[f64], v: &[f64], t: f64) -> f64 {
    v[1] * q[2].cos() - v[0] * q[2].sin() - t * q[0] / 2.0
}

/// `∂f/∂v`.
pub const fn jacobian(sin: f64, cos: f64) -> [f64; 3] {
    [-sin, cos, 0.0]
}

/// `Q`.
pub fn forces(v: &[f64]) -> [f64; 3] {
    [-v[0] / 5.0, 0.0, 0.3]
}

/// The system.
pub fn system() -> System {
    let mut system = System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
    let text = "(1 + x^2)/2*x'^2 + y'^2/2 + (2 + cos(phi))/4*phi'^2 + x'*y'*sin(t)/3 - x*y";
    system.lagrangian = system.expression(text).expect("L");
    system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi) - t*x/2").expect("f")];
    system.forces = ["-x'/5", "0", "0.3"].map(|text| system.expression(text).expect("Q")).to_vec();
    system
}

/// The rates of the state `y` at [`T`].
pub fn rates(equations: &Equations, y: &[f64]) -> Vec<f64> {
    let mut rates = vec![0.0; y.len()];
    Compiled::new(equations).expect("compiled").rates(T, y, &mut rates).expect("regular");
    rates
}

/// `df/ds` at 0, to the fourth order.
pub fn derivative(f: impl Fn(f64) -> f64) -> f64 {
    let h = 1e-2;
    (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)
}

/// `d/dt ∂𝓛/∂v − ∂𝓛/∂q` along `q + v s + ½ a s²`, for `𝓛(q, v, s)` with time `T + s`.
pub fn euler_lagrange(l: impl Fn(&[f64], &[f64], f64) -> f64, v: &[f64], a: &[f64]) -> Vec<f64> {
    let moved = |x: &[f64], i: usize, by: f64| {
        let mut x = x.to_vec();
        x[i] += by;
        x
    };
    let place = |s: f64| -> Vec<f64> { (0..3).map(|i| Q[i] + v[i] * s + a[i] * s * s / 2.0).collect() };
    let speed = |s: f64| -> Vec<f64> { (0..3).map(|i| v[i] + a[i] * s).collect() };
    let momentum = |i: usize, s: f64| derivative(|e| l(&place(s), &moved(&speed(s), i, e), s));
    (0..3).map(|i| derivative(|s| momentum(i, s)) - derivative(|e| l(&moved(&Q, i, e), v, 0.0))).collect()
}

/// `df/dt` along the curve.
pub fn drift(v: &[f64], a: &[f64]) -> f64 {
    let place = |s: f64| -> Vec<f64> { (0..3).map(|i| Q[i] + v[i] * s + a[i] * s * s / 2.0).collect() };
    derivative(|s| constraint(&place(s), &(0..3).map(|i| v[i] + a[i] * s).collect::<Vec<_>>(), T + s))
}
