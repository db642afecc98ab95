//! Taylor series of the solution, order by order, from the problem's own recurrences.
//!
//! Order and step as Jorba and Zou choose them, with the tolerance of [`Options`] for the norm of the state.
//! With `‖c_k‖` the largest coefficient of order k in tolerances (a maximum over components, not a mean),
//!
//! ```text
//! p = ⌈1 − c ln(relative tolerance)⌉,
//! h = e^(−0.7/(p−1)) min( (e² ‖c_p‖)^(−1/p), (e^(2−1/c) ‖c_{p−1}‖)^(−1/(p−1)) ):
//! ```
//!
//! the last term is at most an eighth of the tolerance, and terms fall by `e^(1/c)` per order. The source has
//! c = 1/2, best where a step costs the square of its order. Here it costs hardly more than the order: c = 1,
//! with 1.9 times longer steps at 1e-10, was 1.2 to 1.4 times faster on sledge and ball in a cone, and 1.2 no
//! faster than that. Where coefficients come in groups with zeros between, the last two say little; so no
//! earlier term may be over 1000 times what such a fall from first to last gives it.
//!
//! Coefficients do not depend on the step, which is shortened until the terms are small.
//!
//! A series does not see past a branch point: that of √(1 + y) along y = (1 − t/2)² − 1 goes on as 1 − t/2
//! where the root is t/2 − 1. So the slope of the polynomial at the end of the step is compared with the
//! rates there, which the next expansion needs anyway; if they differ, the step is halved. Where that came to
//! pass, it is likely to again: the rates are then computed alone first, for a small part of an expansion.
//! The same is done at places inside a step that no term limits: a force (4t(1 − t))⁴⁰ is zero to order 39
//! at both ends of [0, 1]. Where the equations have such powers, every step is.
//!
//! Source: À. Jorba, M. Zou, *A software package for the numerical integration of ODEs by means of high-order
//! Taylor methods*, Experimental Mathematics 14 (2005), section 3.

use std::array::from_fn;

use crate::dense::Basis;
use crate::options::Options;
use crate::problem::Start;
use crate::status::StopCause;
use crate::stepper::{Attempt, Stepper, next_step};
use crate::system::{Failure, System};
use crate::taylor_step::{
    DEFECT, Ends, GROUP, LEAST_RELATIVE, MANY, UNLIMITED, first_powers, longest_step, once, order,
};
use std::f64::consts::GOLDEN_RATIO;

/// Where coefficients overflow, the unit of time is shortened by this factor, this often.
const SHORTER_UNIT: f64 = 1e-8;
const UNITS: usize = 30;
/// Allowed difference of rates over what the last digits of the state make of them.
const DIGITS: f64 = 4.0;
/// Places in a step as long as what is raised to a power takes to rise and fall, over the root of the power.
const WITHIN: f64 = 2.5;

pub(crate) struct Taylor<'s, 'p> {
    system: &'s System<'p>,
    end: f64,
    relative_tolerance: f64,
    absolute_tolerances: Vec<f64>,
    order: usize,
    t: f64,
    /// Coefficients at `t` of the powers of time over `unit`, component after component.
    coefficients: Vec<f64>,
    unit: f64,
    /// The same at the end of the candidate.
    next_coefficients: Vec<f64>,
    next_unit: f64,
    candidate: Vec<f64>,
    /// The candidate before it was moved, and the polynomial's slope there times the step.
    reached: Vec<f64>,
    slope: Vec<f64>,
    /// Whether a candidate was dropped since the last step, and whether since the one before it.
    dropped: bool,
    rough: bool,
    /// The rates at the candidate, where they are looked at first.
    rates: Vec<f64>,
    /// Changes of the rates with the last digits of the state at `t`; empty until computed.
    digits: Vec<f64>,
    /// The polynomial inside the step, its slope there times the step, and the last place, as a part of it.
    inside: Vec<f64>,
    inside_slope: Vec<f64>,
    place: f64,
    /// [`crate::Problem::highest_power`].
    highest_power: f64,
    /// Length of the step to try next.
    step: f64,
    /// Largest coefficient of each order, in tolerances.
    sizes: Vec<f64>,
    /// Powers of the step over the unit, terms of the polynomial at its end, and the numbers 0, 1, 2, …
    powers: Vec<Parts>,
    terms: Vec<f64>,
    exponents: Vec<Parts>,
    /// The step of the candidate, of either sign, and its end.
    taken: f64,
    taken_to: f64,
}

impl<'s, 'p> Taylor<'s, 'p> {
    /// Computes the coefficients at the start.
    pub(crate) fn new(system: &'s System<'p>, start: &Start, end: f64, options: &Options) -> Result<Self, Failure> {
        let n = system.dimension();
        let order = order(options.relative_tolerance);
        let groups = (order + 1).div_ceil(GROUP);
        let mut taylor = Self {
            system,
            end,
            relative_tolerance: options.relative_tolerance,
            absolute_tolerances: options.absolute_tolerances(n),
            order,
            t: start.t,
            coefficients: vec![0.0; (order + 1) * n],
            unit: 1.0,
            next_coefficients: vec![0.0; (order + 1) * n],
            next_unit: (end - start.t).abs(),
            candidate: start.y.clone(),
            reached: vec![0.0; n],
            slope: vec![0.0; n],
            dropped: false,
            rough: false,
            rates: vec![0.0; n],
            digits: Vec::new(),
            inside: vec![0.0; n],
            inside_slope: vec![0.0; n],
            place: 0.0,
            highest_power: system.highest_power(),
            step: 0.0,
            sizes: vec![0.0; order + 1],
            powers: vec![[0.0; GROUP]; groups],
            terms: vec![0.0; (order + 1) * n],
            exponents: (0..groups).map(|i| from_fn(|l| (i * GROUP + l) as f64)).collect(),
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
            let rates_are_finite =
                || self.next_coefficients.chunks_exact(order + 1).all(|row| row[0].is_finite() && row[1].is_finite());
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
        self.digits.clear();
        std::mem::swap(&mut self.coefficients, &mut self.next_coefficients);
        self.step = self.choose_step();
    }

    /// Terms, candidate and slope of the polynomial at the end of the step.
    fn evaluate(&mut self, theta: f64) {
        let orders = self.order + 1;
        let (powers, exponents) = (&mut self.powers[..], &self.exponents[..]);
        let rows = self.coefficients.chunks_exact(orders).zip(self.terms.chunks_exact_mut(orders));
        let ends = self.reached.iter_mut().zip(&mut self.slope);
        pulp::Arch::new().dispatch(
            #[inline(always)]
            move || {
                let powers = once(powers);
                let (first, [step]) = first_powers([theta]);
                let mut scale = 1.0;
                for group in powers.iter_mut() {
                    *group = first.map(|[power]| power * scale);
                    scale *= step;
                }
                powers[0][0] = 0.0;
                for ((row, terms), (y, slope)) in rows.zip(ends) {
                    (*y, *slope) = sums(row, powers, exponents, terms);
                }
            },
        );
        self.candidate.copy_from_slice(&self.reached);
    }

    /// Compares the slope of the polynomial with the rates inside a step that its terms did not limit, where
    /// what the end does not show may pass; and inside every step where there are high powers, narrow as
    /// `1/√n`: terms of other components may have limited it.
    fn check_inside(&mut self) -> Result<(), Failure> {
        if self.highest_power == 0.0 && UNLIMITED * self.taken.abs() >= self.step {
            return Ok(());
        }
        let places = MANY.max((WITHIN * self.highest_power.sqrt()) as usize);
        let (theta, order, begin) = (self.taken / self.unit, self.order, self.t);
        let relative = self.relative_tolerance.max(LEAST_RELATIVE);
        // rates of constraints that are nearly dependent are known as badly as a projection moves the end
        let ends = self.candidate.iter().zip(&self.reached).zip(&self.absolute_tolerances);
        let moves = ends.map(|((y, reached), absolute)| (y - reached).abs() / (absolute + relative * y.abs()));
        let forgiven = 1.0 + moves.fold(0.0, f64::max);
        for _ in 0..places {
            self.place = (self.place + GOLDEN_RATIO).fract();
            let t = begin + self.taken * self.place;
            let x = (t - begin) / self.unit;
            for (row, (y, slope)) in
                self.coefficients.chunks_exact(order + 1).zip(self.inside.iter_mut().zip(&mut self.inside_slope))
            {
                (*y, *slope) = row.iter().rev().fold((0.0, 0.0), |(y, slope), c| (y * x + c, slope * x + y));
                *slope *= theta;
            }
            self.system.rates(t, &self.inside, &mut self.rates)?;
            for (component, absolute) in self.absolute_tolerances.iter().enumerate() {
                let (y, slope) = (self.inside[component], self.inside_slope[component]);
                let allowed = DEFECT * (absolute + relative * y.abs().max(slope.abs()));
                if (slope - self.rates[component] * self.taken).abs() > allowed * forgiven {
                    return Err(Failure::NotSmooth { component });
                }
            }
        }
        Ok(())
    }

    /// Compares the slope of the polynomial at the end with the rates there. A difference that the last
    /// digits of the start make in the rates is allowed as well: a pendulum 1e-12 rad from its top.
    fn check_slope(&mut self) -> Result<(), Failure> {
        let ends = Ends {
            reached: self.reached.as_chunks::<1>().0,
            candidate: self.candidate.as_chunks().0,
            slope: self.slope.as_chunks().0,
            next_coefficients: self.next_coefficients.as_chunks().0,
            share: [self.taken / self.next_unit],
        };
        let defect = ends.defect(self.absolute_tolerances.as_chunks().0, self.relative_tolerance);
        let Some(component) = defect.component(0) else { return Ok(()) };
        self.find_digits()?;
        let allowed = DIGITS * self.digits[component] * self.taken.abs();
        let rate = self.next_coefficients[component * (self.order + 1) + 1] * self.taken / self.next_unit;
        if (self.slope[component] - rate).abs() <= allowed { Ok(()) } else { Err(Failure::NotSmooth { component }) }
    }

    /// Sums the changes of the rates with the last digits of the state at the start of the step; once per
    /// start, however often the step is halved.
    fn find_digits(&mut self) -> Result<(), Failure> {
        if !self.digits.is_empty() {
            return Ok(());
        }
        let starts = self.coefficients.iter().step_by(self.order + 1);
        self.inside.iter_mut().zip(starts).for_each(|(y, c)| *y = *c);
        self.system.rates(self.t, &self.inside, &mut self.inside_slope)?;
        let mut sums = vec![0.0; self.inside.len()];
        for j in 0..self.inside.len() {
            let y = self.inside[j];
            self.inside[j] = y * (1.0 + f64::EPSILON.sqrt());
            self.system.rates(self.t, &self.inside, &mut self.rates)?;
            let changes = self.rates.iter().zip(&self.inside_slope).map(|(moved, rate)| (moved - rate).abs());
            sums.iter_mut().zip(changes).for_each(|(sum, change)| *sum += change * f64::EPSILON.sqrt());
            self.inside[j] = y;
        }
        self.digits = sums;
        Ok(())
    }

    /// The longest step > 0 whose last terms are below the tolerance; infinite for a constant.
    fn choose_step(&mut self) -> f64 {
        let (coefficients, absolute) = (self.coefficients.as_chunks::<1>().0, self.absolute_tolerances.as_chunks().0);
        let (relative, sizes) = (self.relative_tolerance, self.sizes.as_chunks_mut().0);
        let [theta] = pulp::Arch::new().dispatch(
            #[inline(always)]
            move || longest_step(coefficients, absolute, relative, once(sizes)),
        );
        theta * self.unit
    }
}

type Parts = [f64; GROUP];

/// Writes the terms of a polynomial; their sum, and their sum weighted by the exponents. The first power is 0
/// instead of 1. Powers and exponents may go on behind the last term.
#[inline(always)]
fn sums(row: &[f64], powers: &[Parts], exponents: &[Parts], terms: &mut [f64]) -> (f64, f64) {
    let (mut sum, mut weighted) = ([0.0; GROUP], [0.0; GROUP]);
    let (of_row, rest_of_row) = row.as_chunks::<GROUP>();
    let (groups, rest) = terms.as_chunks_mut::<GROUP>();
    let last = groups.len();
    for (((group, c), power), k) in groups.iter_mut().zip(of_row).zip(powers).zip(exponents) {
        let terms: Parts = from_fn(|l| c[l] * power[l]);
        *group = terms;
        for l in 0..GROUP {
            sum[l] += terms[l];
            weighted[l] += terms[l] * k[l];
        }
    }
    for (l, (term, c)) in rest.iter_mut().zip(rest_of_row).enumerate() {
        *term = c * powers[last][l];
        sum[l] += *term;
        weighted[l] += *term * exponents[last][l];
    }
    // The first term is not among the summands, so that none is lost in it.
    terms[0] = row[0];
    let total = |x: Parts| ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
    (row[0] + total(sum), total(weighted))
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
        let step = self.step * (self.end - self.t).signum();
        (self.taken, self.taken_to) = match next_step((self.t, self.end), step, 1.0, self.system.longest) {
            Ok(step) => step,
            Err(cause) => return Attempt::GaveUp(cause),
        };
        self.evaluate(self.taken / self.unit);
        Attempt::Candidate { t: self.taken_to, rejected: 0 }
    }

    fn candidate(&mut self) -> &mut [f64] {
        &mut self.candidate
    }

    // The next expansion shows whether the rates are defined at the end. A projection's move, of the size of
    // the error, goes into the last coefficient: polynomials stay continuous.
    fn finish(&mut self, moved: bool, segment: Option<&mut [f64]>) -> Result<(), Failure> {
        self.next_unit = self.taken.abs();
        if self.rough {
            self.system.rates(self.taken_to, &self.candidate, &mut self.rates)?;
            for (row, rate) in self.next_coefficients.chunks_exact_mut(self.order + 1).zip(&self.rates) {
                row[1] = rate * self.next_unit;
            }
            self.check_slope()?;
        }
        self.check_inside()?;
        self.expand()?;
        self.check_slope()?;
        let Some(segment) = segment else { return Ok(()) };
        segment.copy_from_slice(&self.terms);
        if moved {
            let last = segment.iter_mut().skip(self.order).step_by(self.order + 1);
            for ((c, y), reached) in last.zip(&self.candidate).zip(&self.reached) {
                *c += y - reached;
            }
        }
        Ok(())
    }

    fn advance(&mut self) -> Result<(), StopCause> {
        self.adopt();
        self.rough = std::mem::take(&mut self.dropped);
        Ok(())
    }

    fn shrink(&mut self) -> Result<(), StopCause> {
        self.step = 0.5 * self.taken.abs();
        (self.rough, self.dropped) = (true, true);
        Ok(())
    }
}
