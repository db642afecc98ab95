//! Dormand and Prince's explicit Runge–Kutta method of order 8(5,3), with dense output of order 7.
//!
//! Step control, starting step and dense output as in E. Hairer's code DOP853 (without its stabilisation of
//! the step size, β = 0, its default).
//!
//! Ours: verdicts need errors far below the gaps and roots on the dense output, every motion is run twice,
//! and the explicit method of `diffsol` has order 5. In our loop its projection costs no evaluation.

use crate::dop853_tableau::*;
use crate::options::Options;
use crate::problem::Start;
use crate::status::StopCause;
use crate::stepper::{Attempt, SAFETY, Stepper, next_step};
use crate::system::{Failure, System};

/// How much steps may shrink and grow.
const FACTORS: [f64; 2] = [0.333, 6.0];
const ORDER: f64 = 8.0;
/// From here on the longest first step goes with the root of the tolerance.
const COARSE: f64 = 1e-6;
/// Below this the error estimate measures round-off.
const TIGHTEST: f64 = 2e-15;

pub(crate) struct Dop853<'s, 'p> {
    system: &'s System<'p>,
    end: f64,
    relative_tolerance: f64,
    absolute_tolerances: Vec<f64>,
    t: f64,
    y: Vec<f64>,
    /// Stage rates, one after the other; stage 0 is F(t, y).
    k: Vec<f64>,
    candidate: Vec<f64>,
    /// Argument of the stage being evaluated.
    argument: Vec<f64>,
    /// The step to try next, of either sign; 0: not yet chosen.
    step: f64,
    /// The step of the candidate, and its end.
    taken: f64,
    taken_to: f64,
    /// The step that the error of the candidate suggests.
    next: f64,
    /// The last attempt failed: the next step may not grow.
    failed: bool,
}

impl<'s, 'p> Dop853<'s, 'p> {
    /// Evaluates F at the start.
    pub(crate) fn new(system: &'s System<'p>, start: &Start, end: f64, options: &Options) -> Result<Self, Failure> {
        let n = system.dimension();
        let mut k = vec![0.0; STAGES * n];
        system.rates(start.t, &start.y, &mut k[..n])?;
        Ok(Self {
            system,
            end,
            relative_tolerance: options.relative_tolerance.max(TIGHTEST),
            absolute_tolerances: options.absolute_tolerances(n),
            t: start.t,
            y: start.y.clone(),
            k,
            candidate: vec![0.0; n],
            argument: vec![0.0; n],
            step: 0.0,
            taken: 0.0,
            taken_to: start.t,
            next: 0.0,
            failed: false,
        })
    }

    /// Hairer's starting step: a hundredth of |y|/|F|, then from an estimate of the second derivative,
    /// and at most |y|/|F|; ours is shorter by the root of the tolerance. Two runs may not share the first
    /// step: their difference would not show its error, a motion's only one near the start.
    fn choose_first_step(&mut self) {
        let n = self.y.len();
        let longest = (self.end - self.t).abs();
        let sign = (self.end - self.t).signum();
        let (mut size, mut rate) = (0.0, 0.0);
        for ((y, f), absolute) in self.y.iter().zip(&self.k).zip(&self.absolute_tolerances) {
            let scale = absolute + self.relative_tolerance * y.abs();
            size += (y / scale).powi(2);
            rate += (f / scale).powi(2);
        }
        let first = if rate <= 1e-10 || size <= 1e-10 { 1e-6 } else { 0.01 * (size / rate).sqrt() };
        let first = first.min(longest);
        for ((a, y), f) in self.argument.iter_mut().zip(&self.y).zip(&self.k) {
            *a = y + sign * first * f;
        }
        let (here, there) = self.k.split_at_mut(n);
        if self.system.rates(self.t + sign * first, &self.argument, &mut there[..n]).is_err() {
            // A wall nearby: begin with a step that stays well clear of it.
            self.step = sign * 0.01 * first;
            return;
        }
        let mut curvature = 0.0;
        for (((y, f), g), absolute) in self.y.iter().zip(here).zip(there).zip(&self.absolute_tolerances) {
            let scale = absolute + self.relative_tolerance * y.abs();
            curvature += ((*g - *f) / scale).powi(2);
        }
        let steepest = (curvature.sqrt() / first).max(rate.sqrt());
        let second = if steepest <= 1e-15 { (first * 1e-3).max(1e-6) } else { (0.01 / steepest).powf(1.0 / ORDER) };
        let share = (self.relative_tolerance / COARSE).min(1.0).powf(1.0 / ORDER);
        self.step = sign * share * (100.0 * first).min(longest).min(second / share);
    }

    /// Evaluates stage `stage` at `y + h Σ_m weight[m] k[from[m]]`.
    #[inline(always)]
    fn stage<const M: usize>(&mut self, stage: usize, row: &Row<M>, h: f64) -> Result<(), Failure> {
        let n = self.y.len();
        combine(row, &self.k, n, |i, sum| self.argument[i] = self.y[i] + h * sum);
        let rates = &mut self.k[stage * n..(stage + 1) * n];
        self.system.rates(self.t + NODES[stage] * h, &self.argument, rates)
    }

    /// The eleven stages after the first, and the candidate's state.
    fn stages(&mut self, h: f64) -> Result<(), Failure> {
        self.stage(1, &STAGE_1, h)?;
        self.stage(2, &STAGE_2, h)?;
        self.stage(3, &STAGE_3, h)?;
        self.stage(4, &STAGE_4, h)?;
        self.stage(5, &STAGE_5, h)?;
        self.stage(6, &STAGE_6, h)?;
        self.stage(7, &STAGE_7, h)?;
        self.stage(8, &STAGE_8, h)?;
        self.stage(9, &STAGE_9, h)?;
        self.stage(10, &STAGE_10, h)?;
        self.stage(11, &STAGE_11, h)?;
        let n = self.y.len();
        combine(&STEP, &self.k, n, |i, sum| self.candidate[i] = self.y[i] + h * sum);
        crate::system::check_finite(&self.candidate)
    }

    /// The error of the candidate in units of the tolerance: `|h| e₅² / √(n (e₅² + e₃²/100))`.
    fn error(&mut self, h: f64) -> f64 {
        let n = self.y.len();
        let (mut fifth, mut third) = (0.0, 0.0);
        let (y, candidate) = (&self.y, &self.candidate);
        let scale = |i: usize| {
            let size = f64::max(y[i].abs(), candidate[i].abs());
            self.absolute_tolerances[i] + self.relative_tolerance * size
        };
        combine(&ERROR_5, &self.k, n, |i, sum| fifth += (sum / scale(i)).powi(2));
        combine(&STEP, &self.k, n, |i, sum| self.argument[i] = sum);
        let argument = &self.argument;
        combine(&EMBEDDED_3, &self.k, n, |i, sum| third += ((argument[i] - sum) / scale(i)).powi(2));
        let weight = fifth + 0.01 * third;
        if weight <= 0.0 { 0.0 } else { h.abs() * fifth / (n as f64 * weight).sqrt() }
    }
}

/// `write(i, Σ_m weight[m] · k[from[m]][i])` for every component i.
#[inline(always)]
fn combine<const M: usize>(row: &Row<M>, k: &[f64], n: usize, mut write: impl FnMut(usize, f64)) {
    let stages: [&[f64]; M] = row.from.map(|stage| &k[stage * n..][..n]);
    #[allow(clippy::needless_range_loop)] // both loops run over slices of known length side by side
    for i in 0..n {
        let mut sum = 0.0;
        for m in 0..M {
            sum += row.weight[m] * stages[m][i];
        }
        write(i, sum);
    }
}

impl Stepper for Dop853<'_, '_> {
    fn degree(&self) -> usize {
        7
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn attempt(&mut self) -> Attempt {
        if self.step == 0.0 {
            self.choose_first_step();
        }
        let (h, to) = match next_step((self.t, self.end), self.step, 1.01, self.system.longest) {
            Ok(step) => step,
            Err(cause) => return Attempt::GaveUp(cause),
        };
        (self.taken, self.taken_to) = (h, to);
        if let Err(failure) = self.stages(h) {
            return Attempt::Failed(failure);
        }
        let error = self.error(h);
        if !error.is_finite() {
            let component = self.argument.iter().position(|x| !x.is_finite()).unwrap_or(0);
            return Attempt::Failed(Failure::NotFinite { component });
        }
        let factor = SAFETY * error.powf(-1.0 / ORDER);
        if error > 1.0 {
            self.step = h * factor.max(FACTORS[0]);
            self.failed = true;
            return Attempt::Rejected;
        }
        self.next = h * factor.clamp(FACTORS[0], if self.failed { 1.0 } else { FACTORS[1] });
        Attempt::Candidate { t: self.taken_to, rejected: 0 }
    }

    fn candidate(&mut self) -> &mut [f64] {
        &mut self.candidate
    }

    // The rates at the end are those of the moved state: the next polynomial then joins with equal slope. The
    // move is of the size of the local error: the dense output keeps its order.
    fn finish(&mut self, _moved: bool, segment: Option<&mut [f64]>) -> Result<(), Failure> {
        let n = self.y.len();
        let h = self.taken;
        self.system.rates(self.taken_to, &self.candidate, &mut self.k[12 * n..13 * n])?;
        let Some(segment) = segment else { return Ok(()) };
        self.stage(13, &STAGE_13, h)?;
        self.stage(14, &STAGE_14, h)?;
        self.stage(15, &STAGE_15, h)?;
        for i in 0..n {
            let change = self.candidate[i] - self.y[i];
            let bend = h * self.k[i] - change;
            segment[i] = self.y[i];
            segment[n + i] = change;
            segment[2 * n + i] = bend;
            segment[3 * n + i] = change - h * self.k[12 * n + i] - bend;
        }
        let (fourth, rest) = segment[4 * n..].split_at_mut(n);
        let (fifth, rest) = rest.split_at_mut(n);
        let (sixth, seventh) = rest.split_at_mut(n);
        combine(&DENSE_4, &self.k, n, |i, sum| fourth[i] = h * sum);
        combine(&DENSE_5, &self.k, n, |i, sum| fifth[i] = h * sum);
        combine(&DENSE_6, &self.k, n, |i, sum| sixth[i] = h * sum);
        combine(&DENSE_7, &self.k, n, |i, sum| seventh[i] = h * sum);
        Ok(())
    }

    fn advance(&mut self) -> Result<(), StopCause> {
        let n = self.y.len();
        self.t = self.taken_to;
        std::mem::swap(&mut self.y, &mut self.candidate);
        self.k.copy_within(12 * n..13 * n, 0);
        self.step = self.next;
        self.failed = false;
        Ok(())
    }

    fn shrink(&mut self) -> Result<(), StopCause> {
        self.step = 0.5 * self.taken;
        self.failed = true;
        Ok(())
    }
}
