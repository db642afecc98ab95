//! Radau IIA of order 5 for stiff problems: L-stable, collocation at `c = (4 − √6)/10, (4 + √6)/10, 1`.
//!
//! Ours, because the implicit methods of `diffsol` have order 5 at most in several steps and 3 in one, and
//! take very many steps at tight tolerances.
//!
//! Newton iteration, error estimate, step control and starting values follow Hairer's and Wanner's RADAU5:
//! one real and one complex matrix of n rows are factorized, `(γ/h) − J` and `((α + iβ)/h) − J`, and kept
//! while the iteration contracts well. Otherwise, unlike there, each stage has its own Jacobian ([`newton`]).
//! Dense output is the collocation polynomial, of degree 3. The estimate, of order 3 too, is held under the
//! tolerance, not under RADAU5's `0.1 · tolerance^(2/3)`: dense output keeps the tolerance, ends of steps are
//! better by orders. It does not see what is stiff, where the polynomial may be wrong between collocation
//! points: a second estimate compares the end of a step with where the polynomial before leads.
//!
//! E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, 2nd ed., Springer 1996, IV.8.

mod newton;

use nalgebra::{Complex, DVector, Dyn, LU};

use crate::options::Options;
use crate::problem::Start;
use crate::radau5_tableau::{ERROR, NODES};
use crate::status::StopCause;
use crate::stepper::{Attempt, SAFETY, Stepper, next_step};
use crate::system::{Failure, System, check_finite};
use crate::taylor_step::LEAST_RELATIVE;

/// Steps shrink and grow by 8 at most, by 5 before that for the estimate's sake (RADAU5's `FACL`, `FACR`).
const QUOTIENTS: [f64; 2] = [0.125, 5.0];
/// Largest `θ (θ − c₁)(θ − c₂)(1 − θ)` on a step.
const BETWEEN: f64 = 0.018;
/// Newton iterations of one step.
const ITERATIONS: usize = 7;
/// The Jacobian is kept while the iteration contracts by this.
const GOOD_CONTRACTION: f64 = 1e-3;
/// The step is kept, and the factors with it, if the new one would be longer by at most this factor.
const SAME_STEP: f64 = 1.2;

struct Factors {
    step: f64,
    real: LU<f64, Dyn, Dyn>,
    complex: LU<Complex<f64>, Dyn, Dyn>,
}

pub(crate) struct Radau5<'s, 'p> {
    system: &'s System<'p>,
    end: f64,
    relative: f64,
    absolute: Vec<f64>,
    newton_tolerance: f64,
    t: f64,
    y: Vec<f64>,
    rates: Vec<f64>,
    jacobian: Vec<f64>,
    /// Whether the Jacobian was evaluated at `(t, y)`.
    jacobian_is_new: bool,
    factors: Option<Factors>,
    /// Factors of the matrix with all stages' Jacobians, and the number of steps still to solve with it.
    all_stages: Option<LU<f64, Dyn, Dyn>>,
    proper_steps: usize,
    /// `z_i = Y_i − y` of the three stages, and their transforms.
    z: [Vec<f64>; 3],
    w: [Vec<f64>; 3],
    stages: [Vec<f64>; 3],
    argument: Vec<f64>,
    /// The last step's length and its polynomial without the constant, for starting values.
    last: Option<(f64, [Vec<f64>; 3])>,
    contraction: f64,
    /// `z₃` as guessed.
    guessed_end: Vec<f64>,
    /// `Θ/(1 − Θ)`, kept from step to step.
    margin: f64,
    candidate: Vec<f64>,
    step: f64,
    taken: f64,
    taken_to: f64,
    next: f64,
    /// Length and error of the last accepted step.
    accepted: Option<(f64, f64)>,
    error: f64,
    failed: bool,
}

impl<'s, 'p> Radau5<'s, 'p> {
    /// Evaluates F at the start.
    pub(crate) fn new(system: &'s System<'p>, start: &Start, end: f64, options: &Options) -> Result<Self, Failure> {
        let n = system.dimension();
        let mut rates = vec![0.0; n];
        system.rates(start.t, &start.y, &mut rates)?;
        let relative = options.relative_tolerance.max(LEAST_RELATIVE);
        let absolute = options.absolute_tolerances(n);
        let scale = |i: usize| absolute[i] + relative * start.y[i].abs();
        let norm = |v: &[f64]| rms(v.iter().enumerate().map(|(i, x)| x / scale(i)));
        let (size, slope) = (norm(&start.y), norm(&rates));
        let first = if size > 1e-5 && slope > 1e-5 { 1e-3 * size / slope } else { 1e-6 };
        let length = end - start.t;
        let empty = || [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        Ok(Self {
            system,
            end,
            relative,
            absolute,
            newton_tolerance: (10.0 * f64::EPSILON / relative).max(relative.sqrt().min(0.03)),
            t: start.t,
            y: start.y.clone(),
            rates,
            jacobian: vec![0.0; n * n],
            jacobian_is_new: false,
            factors: None,
            all_stages: None,
            proper_steps: 0,
            z: empty(),
            w: empty(),
            stages: empty(),
            argument: vec![0.0; n],
            last: None,
            contraction: 1.0,
            guessed_end: vec![0.0; n],
            margin: 1.0,
            candidate: vec![0.0; n],
            step: length.signum() * first.min(length.abs()),
            taken: 0.0,
            taken_to: start.t,
            next: 0.0,
            accepted: None,
            error: 0.0,
            failed: false,
        })
    }

    fn scale(&self, i: usize) -> f64 {
        self.absolute[i] + self.relative * self.y[i].abs()
    }

    /// The error of the polynomial between collocation points in units of the tolerance: both it and that of
    /// its predecessor's continuation are `h⁴ y⁗/24` times the product of the distances from the points.
    fn estimate_between(&self, h: f64) -> f64 {
        let Some((before, _)) = &self.last else { return 0.0 };
        let ratio = h / before;
        let reach: f64 = NODES.iter().map(|c| (1.0 + ratio - c) / ratio).product::<f64>() * (1.0 + ratio) / ratio;
        let differences = (0..self.y.len()).map(|i| (self.z[2][i] - self.guessed_end[i]) / self.scale(i));
        BETWEEN * rms(differences) / reach
    }

    /// The error of the candidate in units of the tolerance.
    fn estimate(&mut self, h: f64) -> Result<f64, Failure> {
        let n = self.y.len();
        let Some(factors) = &self.factors else { return Ok(f64::INFINITY) };
        let stages: Vec<f64> = (0..n).map(|i| (0..3).map(|s| ERROR[s] / h * self.z[s][i]).sum()).collect();
        let solve = |rates: &[f64]| {
            let mut right = DVector::from_fn(n, |i, _| stages[i] + rates[i]);
            factors.real.solve_mut(&mut right);
            right
        };
        let size = |v: &DVector<f64>| rms((0..n).map(|i| v[i] / self.scale(i))).max(1e-10);
        let found = solve(&self.rates);
        let error = size(&found);
        if error < 1.0 || !(self.accepted.is_none() || self.failed) {
            return Ok(error);
        }
        // the stiff part of the first estimate is too large; once more through the equations
        let moved: Vec<f64> = self.y.iter().zip(found.iter()).map(|(y, e)| y + e).collect();
        let mut rates = vec![0.0; n];
        self.system.rates(self.t, &moved, &mut rates)?;
        Ok(size(&solve(&rates)))
    }
}

fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len() as f64;
    (values.map(|x| x * x).sum::<f64>() / n).sqrt()
}

impl Stepper for Radau5<'_, '_> {
    fn degree(&self) -> usize {
        3
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn attempt(&mut self) -> Attempt {
        let (h, to) = match next_step((self.t, self.end), self.step, 1.0001, self.system.longest) {
            Ok(step) => step,
            Err(cause) => return Attempt::GaveUp(cause),
        };
        (self.taken, self.taken_to) = (h, to);
        if let Err(failure) = self.prepare(h) {
            return Attempt::Failed(failure);
        }
        let iterations = match self.stages(h) {
            Err(failure) => return Attempt::Failed(failure),
            Ok(Ok(iterations)) => iterations,
            Ok(Err(factor)) => {
                self.step = factor * h;
                self.failed = true;
                self.contraction = 1.0;
                return Attempt::Rejected;
            }
        };
        let error = match self.estimate(h) {
            Ok(error) => error.max(self.estimate_between(h)),
            Err(failure) => return Attempt::Failed(failure),
        };
        for i in 0..self.y.len() {
            self.candidate[i] = self.y[i] + self.z[2][i];
        }
        if let Err(failure) = check_finite(&self.candidate) {
            return Attempt::Failed(failure);
        }
        let turns = 2.0 * ITERATIONS as f64;
        let safety = SAFETY.min(SAFETY * (1.0 + turns) / (iterations as f64 + turns));
        let mut quotient = (error.powf(0.25) / safety).clamp(QUOTIENTS[0], QUOTIENTS[1]);
        if error >= 1.0 {
            self.step = if self.accepted.is_none() { 0.1 * h } else { h / quotient };
            self.failed = true;
            return Attempt::Rejected;
        }
        if let Some((before, error_before)) = self.accepted {
            let predicted = (before / h) * (error * error / error_before).powf(0.25) / SAFETY;
            quotient = quotient.max(predicted.clamp(QUOTIENTS[0], QUOTIENTS[1]));
        }
        let longest = if self.failed { h.abs() } else { f64::INFINITY };
        self.next = h.signum() * (h / quotient).abs().min(longest);
        self.error = error;
        Attempt::Candidate { t: self.taken_to, rejected: 0 }
    }

    fn candidate(&mut self) -> &mut [f64] {
        &mut self.candidate
    }

    // The move of a projection is spread over the step in proportion to time.
    fn finish(&mut self, _moved: bool, segment: Option<&mut [f64]>) -> Result<(), Failure> {
        let n = self.y.len();
        self.system.rates(self.taken_to, &self.candidate, &mut self.argument)?;
        let Some(segment) = segment else { return Ok(()) };
        let [a, b, _] = NODES;
        for i in 0..n {
            // what is left of the polynomial after its chord, over θ (1 − θ), is linear in θ
            let end = self.z[2][i];
            let at_a = (self.z[0][i] - a * end) / (a * (1.0 - a));
            let at_b = (self.z[1][i] - b * end) / (b * (1.0 - b));
            let slope = (at_b - at_a) / (b - a);
            segment[i] = self.y[i];
            segment[n + i] = self.candidate[i] - self.y[i];
            segment[2 * n + i] = at_a - a * slope;
            segment[3 * n + i] = slope;
        }
        Ok(())
    }

    fn advance(&mut self) -> Result<(), StopCause> {
        let n = self.y.len();
        let [a, b, _] = NODES;
        let (_, parts) = self.last.get_or_insert_with(|| (0.0, [vec![0.0; n], vec![0.0; n], vec![0.0; n]]));
        let [one, two, three] = parts;
        for i in 0..n {
            let [z1, z2, z3] = [self.z[0][i], self.z[1][i], self.z[2][i]];
            one[i] = (z2 - z3) / (b - 1.0);
            let slope = (z1 - z2) / (a - b);
            two[i] = (slope - one[i]) / (a - 1.0);
            three[i] = two[i] - (slope - z1 / a) / b;
        }
        if let Some((length, _)) = &mut self.last {
            *length = self.taken;
        }
        self.t = self.taken_to;
        std::mem::swap(&mut self.y, &mut self.candidate);
        std::mem::swap(&mut self.rates, &mut self.argument);
        self.accepted = Some((self.taken, self.error.max(1e-2)));
        self.failed = false;
        self.jacobian_is_new = false;
        let growth = self.next / self.taken;
        let keep = self.contraction <= GOOD_CONTRACTION && (1.0..=SAME_STEP).contains(&growth);
        self.step = if keep { self.taken } else { self.next };
        Ok(())
    }

    fn shrink(&mut self) -> Result<(), StopCause> {
        self.step = 0.5 * self.taken;
        self.failed = true;
        self.last = None;
        Ok(())
    }
}
