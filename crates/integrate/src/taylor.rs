//! Taylor series of the solution, order by order, from the problem's own recurrences.
//!
//! Order and step as Jorba and Zou choose them, with the tolerance that [`Options`] define in place of the norm of the state. With
//! `‖c_k‖` the largest coefficient of order k in units of the tolerance (its maximum over the components, not their mean),
//!
//! ```text
//! p = ⌈1 − c ln(relative tolerance)⌉,   h = e^(−0.7/(p−1)) min( ‖c_{p−1}‖^(−1/(p−1)), (e² ‖c_p‖)^(−1/p) ):
//! ```
//!
//! the last term is at most an eighth of the tolerance. That presumes that coefficients fall off by the same factor, about e² a step, as they do. Where
//! they come in groups with zeros between, the last two say little; so no earlier term may be over 1000 times what such a fall gives it.
//! No step is ever rejected for its error: coefficients do not depend on the step, which is shortened until the terms are small.
//!
//! Source: À. Jorba, M. Zou, *A software package for the numerical integration of ODEs by means of high-order Taylor methods*,
//! Experimental Mathematics 14 (2005), section 3; there c = 1/2, which suits a cost that grows with the square of the order.

use crate::dense::{Basis, evaluate_segment};
use crate::options::Options;
use crate::problem::Start;
use crate::status::StopCause;
use crate::stepper::{Attempt, Stepper, shortest_step};
use crate::system::{Failure, System};

/// Orders per factor e of the tolerance.
const ORDERS: f64 = 0.5;
/// Tolerances below are for the order as this one.
const TIGHTEST: f64 = 1e-18;
const LEAST_ORDER: f64 = 4.0;
/// So much may a term before the last two be over the geometric sequence.
const SLACK: f64 = 1e3;
/// Where coefficients overflow, the unit of time is shortened by this factor, so many times.
const SHORTER_UNIT: f64 = 1e-8;
const UNITS: usize = 30;

pub(crate) struct Taylor<'s, 'p> {
    system: &'s System<'p>,
    end: f64,
    relative_tolerance: f64,
    absolute_tolerance: f64,
    order: usize,
    t: f64,
    /// Coefficients at `t` of the powers of time over `unit`: order k, component i at `k n + i`.
    coefficients: Vec<f64>,
    unit: f64,
    /// The same at the end of the candidate.
    next_coefficients: Vec<f64>,
    next_unit: f64,
    candidate: Vec<f64>,
    /// The candidate before it was moved.
    reached: Vec<f64>,
    /// Length of the step to try next.
    step: f64,
    /// The step of the candidate, of either sign, and its end.
    taken: f64,
    taken_to: f64,
}

impl<'s, 'p> Taylor<'s, 'p> {
    /// Computes the coefficients at the start.
    pub(crate) fn new(system: &'s System<'p>, start: &Start, end: f64, options: &Options) -> Result<Self, Failure> {
        let n = system.dimension();
        let tolerance = options.relative_tolerance.max(TIGHTEST);
        let order = (1.0 - ORDERS * tolerance.ln()).ceil().max(LEAST_ORDER) as usize;
        let mut taylor = Self {
            system,
            end,
            relative_tolerance: options.relative_tolerance,
            absolute_tolerance: options.absolute_tolerance,
            order,
            t: start.t,
            coefficients: vec![0.0; (order + 1) * n],
            unit: 1.0,
            next_coefficients: vec![0.0; (order + 1) * n],
            next_unit: (end - start.t).abs(),
            candidate: start.y.clone(),
            reached: vec![0.0; n],
            step: 0.0,
            taken: 0.0,
            taken_to: start.t,
        };
        taylor.expand()?;
        taylor.adopt();
        Ok(taylor)
    }

    /// The coefficients at the end of the candidate.
    fn expand(&mut self) -> Result<(), Failure> {
        let mut attempts = 0;
        loop {
            let (t, unit, order) = (self.taken_to, self.next_unit, self.order);
            let result = self.system.taylor(t, &self.candidate, unit, order, &mut self.next_coefficients);
            let rates_are_finite = || self.next_coefficients[..2 * self.candidate.len()].iter().all(|x| x.is_finite());
            match result {
                Err(Failure::NotFinite { .. }) if attempts < UNITS && rates_are_finite() => {
                    self.next_unit *= SHORTER_UNIT;
                    attempts += 1;
                }
                other => return other,
            }
        }
    }

    /// Goes on from the candidate.
    fn adopt(&mut self) {
        self.t = self.taken_to;
        self.unit = self.next_unit;
        std::mem::swap(&mut self.coefficients, &mut self.next_coefficients);
        self.step = self.choose_step();
    }

    /// The longest step, of positive length, whose last terms are below the tolerance; infinite for a polynomial.
    fn choose_step(&self) -> f64 {
        let n = self.candidate.len();
        let (y, rest) = self.coefficients.split_at(n);
        let p = self.order;
        let size = |k: usize| {
            let row = &rest[(k - 1) * n..][..n];
            row.iter().zip(y).fold(0.0, |largest: f64, (c, y)| {
                largest.max(c.abs() / (self.absolute_tolerance + self.relative_tolerance * y.abs()))
            })
        };
        let (last, before) = (size(p), size(p - 1));
        let e = std::f64::consts::E;
        let mut theta = f64::INFINITY;
        if last > 0.0 {
            theta = (e * e * last).powf(-1.0 / p as f64);
        }
        if before > 0.0 {
            theta = theta.min(before.powf(-1.0 / (p - 1) as f64));
        }
        theta *= (-0.7 / (p - 1) as f64).exp();
        // Largest term of order k: SLACK e^(2 (p − k) − 2) tolerances.
        let mut allowed = SLACK * e * e;
        for k in (1..p - 1).rev() {
            let size = size(k);
            if size > 0.0 && (theta == f64::INFINITY || size * theta.powi(k as i32) > allowed) {
                theta = theta.min((allowed / size).powf(1.0 / k as f64));
            }
            allowed *= e * e;
        }
        theta * self.unit
    }
}

impl Stepper for Taylor<'_, '_> {
    fn degree(&self) -> usize {
        self.order
    }

    fn basis(&self) -> Basis {
        Basis::Powers
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn attempt(&mut self) -> Attempt {
        let remaining = self.end - self.t;
        let last = self.step >= remaining.abs();
        let limit = shortest_step(self.t);
        if self.step <= limit && !last {
            return Attempt::GaveUp(StopCause::StepTooSmall { step: self.step, limit });
        }
        self.taken = if last { remaining } else { self.step * remaining.signum() };
        self.taken_to = if last { self.end } else { self.t + self.taken };
        evaluate_segment(Basis::Powers, &self.coefficients, self.taken / self.unit, &mut self.candidate);
        self.reached.copy_from_slice(&self.candidate);
        Attempt::Candidate { t: self.taken_to, rejected: 0 }
    }

    fn candidate(&mut self) -> &mut [f64] {
        &mut self.candidate
    }

    // Whether the rates are defined at the end is seen by the expansion there, which the next step needs anyway. What
    // a projection moved goes into the last coefficient: it is of the size of the error, and the polynomial ends where the next one begins.
    fn finish(&mut self, moved: bool, segment: Option<&mut [f64]>) -> Result<(), Failure> {
        self.next_unit = self.taken.abs();
        self.expand()?;
        let Some(segment) = segment else { return Ok(()) };
        let n = self.candidate.len();
        let theta = self.taken / self.unit;
        let mut power = 1.0;
        for (to, from) in segment.chunks_exact_mut(n).zip(self.coefficients.chunks_exact(n)) {
            for (to, from) in to.iter_mut().zip(from) {
                *to = from * power;
            }
            power *= theta;
        }
        if moved {
            for ((c, y), reached) in segment[self.order * n..].iter_mut().zip(&self.candidate).zip(&self.reached) {
                *c += y - reached;
            }
        }
        Ok(())
    }

    fn advance(&mut self) -> Result<(), StopCause> {
        self.adopt();
        Ok(())
    }

    fn shrink(&mut self) -> Result<(), StopCause> {
        self.step = 0.5 * self.taken.abs();
        Ok(())
    }
}
