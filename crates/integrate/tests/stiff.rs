//! Stiff problems whose stiff direction turns.

use crate::problems::distance;
use integrate::{EvaluationError, Method, Options, Problem, Start, Status, integrate};

/// A velocity `(v₁, v₂)` with strong friction across a direction that turns with the state's own angle `θ`:
///
/// ```text
/// θ' = 1,     v' = d/dθ (r d) − N n (n·v),     d = (cos θ, sin θ),     n = (−sin θ, cos θ),     r = 1 + ½ sin 2θ
/// ```
///
/// from `d` at `θ = 0`, whatever `N`: `v = r d`.
struct Turning {
    strength: f64,
}

impl Turning {
    fn solution(t: f64) -> [f64; 3] {
        let r = 1.0 + 0.5 * (2.0 * t).sin();
        [t, r * t.cos(), r * t.sin()]
    }
}

impl Problem for Turning {
    fn dimension(&self) -> usize {
        3
    }
    fn rates(&mut self, _: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        let (s, c) = y[0].sin_cos();
        let (r, slope) = (1.0 + 0.5 * (2.0 * y[0]).sin(), (2.0 * y[0]).cos());
        let push = self.strength * (c * y[2] - s * y[1]);
        rates.copy_from_slice(&[1.0, slope * c - r * s + push * s, slope * s + r * c - push * c]);
        Ok(())
    }
    fn jacobian(&mut self, _: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        let (s, c) = y[0].sin_cos();
        let (r, slope, bend) = (1.0 + 0.5 * (2.0 * y[0]).sin(), (2.0 * y[0]).cos(), -2.0 * (2.0 * y[0]).sin());
        let (n, across, along) = (self.strength, c * y[2] - s * y[1], c * y[1] + s * y[2]);
        jacobian[..3].fill(0.0);
        jacobian[3] = (bend - r) * c - 2.0 * slope * s + n * (across * c - along * s);
        jacobian[6] = (bend - r) * s + 2.0 * slope * c + n * (across * s + along * c);
        (jacobian[4], jacobian[5]) = (-n * s * s, n * s * c);
        (jacobian[7], jacobian[8]) = (n * s * c, -n * c * c);
        Ok(())
    }
}

#[test]
fn a_stiff_direction_that_turns_is_stepped_over() {
    // with one Jacobian for all stages of a step, at 1e-7: 826 steps at N = 1e4, 33 000 at 1e10, and still more tries that Newton's iteration gives up
    for (tolerance, most) in [(1e-5, 150), (1e-7, 350), (1e-9, 1000)] {
        for strength in [1e2, 1e4, 1e6, 1e8, 1e10] {
            let options = Options { method: Method::Radau5, ..Options::with_tolerance(tolerance) };
            let start = Start { t: 0.0, y: vec![0.0, 1.0, 0.0] };
            let solution = integrate(&mut Turning { strength }, &start, 10.0, &options).unwrap();
            assert_eq!(solution.status, Status::Completed);
            let error = (0..=1000).map(|i| {
                let (t, mut y) = (f64::from(i) * 0.01, [0.0; 3]);
                solution.dense.evaluate(t, &mut y);
                distance(&y, &Turning::solution(t))
            });
            let (error, work) = (error.fold(0.0, f64::max), solution.work);
            println!("N = {strength:e}, tolerance {tolerance:e}: error {error:e}, {work:?}");
            assert!(error < 10.0 * tolerance, "N = {strength:e}, tolerance {tolerance:e}: error {error:e}");
            assert!(work.steps + work.rejected < most, "N = {strength:e}, tolerance {tolerance:e}: {work:?}");
        }
    }
}
