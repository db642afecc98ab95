//! Derivatives of a motion along directions, carried with it.
//!
//! Along a direction the constants `c`, among them parameters that are inputs of the equations, move by `ċ`
//! and the start by `ẏ₀`. Then `ẏ = dy` moves by the linear equations
//!
//! ```text
//! d(dy)/dt = F_y dy + F_c dc ,    dz = −R_z⁻¹ (R_y dy + R_c dc)    for the unknowns of an instant,
//! ```
//!
//! which are the rates, and their Taylor coefficients, of numbers with tangents ([`Dual`]): the tapes are
//! those of the motion. What is integrated is `(y, dy along direction 1, dy along direction 2, …)`.

use mechanics::linear::{Factors, PIVOT_LIMIT, Singular};
use symbolic::{Dual, Evaluator, LANES, Scalar};

use crate::blocks::{CompiledBlock, EvaluationFailure};
use crate::compiled::Compiled;
use crate::outputs::Outputs;
use crate::planned::again;
use crate::programs::Programs;
use crate::series::Series;

/// Tapes of [`Compiled`] in numbers with tangents. Clone it for another thread.
#[derive(Clone)]
pub struct Tangents {
    directions: usize,
    programs: Programs<Dual>,
    projector: Option<Evaluator<Dual>>,
    factors: Factors,
    series: Option<Series<Dual>>,
    plain_series: Option<Series<Dual>>,
    /// `t, y, constants, z` in this order.
    inputs: Vec<Dual>,
}

impl Tangents {
    /// For this number of directions of `compiled`, whose constants and guess count.
    ///
    /// # Panics
    /// If there are none, or more than [`LANES`].
    pub fn new(compiled: &Compiled, directions: usize) -> Self {
        assert!((1..=LANES).contains(&directions), "1 to {LANES} directions");
        let room = compiled.projector.as_ref().map_or(0, |p| p.places.len() + p.constraints);
        Tangents {
            directions,
            programs: Programs::of(&compiled.instant, compiled.planned.as_ref()),
            projector: compiled.projector.as_ref().map(|projector| again(&projector.program)),
            factors: Factors::new(room),
            series: compiled.series.as_ref().map(Series::again),
            plain_series: compiled.plain_series.as_ref().map(Series::again),
            inputs: vec![Dual::from_f64(0.0); compiled.instant.inputs.len()],
        }
    }

    /// Number of directions.
    pub fn directions(&self) -> usize {
        self.directions
    }

    /// Sets the components of a direction along the free constants.
    ///
    /// # Panics
    /// If there is no such direction, or the length is not that of [`crate::Equations::free_constants`].
    pub fn set_constants(&mut self, compiled: &Compiled, direction: usize, tangents: &[f64]) {
        assert!(direction < self.directions, "{} directions", self.directions);
        assert_eq!(tangents.len(), compiled.instant.sizes.constants, "free constants");
        for (x, tangent) in self.inputs[1 + compiled.instant.sizes.states..].iter_mut().zip(tangents) {
            x.tangents.0[direction] = *tangent;
        }
    }

    /// The rates of `(y, dy, …)`.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn rates(
        &mut self,
        compiled: &mut Compiled,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let values = self.evaluate(compiled, t, y, 0)?;
        spread(values, compiled.instant.sizes.states, rates);
        Ok(())
    }

    /// Outputs at `(y, dy, …)`, then their derivatives along each direction.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn outputs(
        &mut self,
        compiled: &mut Compiled,
        t: f64,
        y: &[f64],
    ) -> Result<(Outputs, Vec<Outputs>), EvaluationFailure> {
        let directions = self.directions;
        let values = self.evaluate(compiled, t, y, 1)?;
        let of =
            |pick: &dyn Fn(&Dual) -> f64| compiled.instant.sizes.outputs(&values.iter().map(pick).collect::<Vec<_>>());
        Ok((of(&|x| x.value), (0..directions).map(|l| of(&|x| x.tangents.0[l])).collect()))
    }

    /// [`Compiled::taylor`] of `(y, dy, …)`.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    ///
    /// # Panics
    /// If [`Compiled::with_series`] was not called before [`Tangents::new`].
    pub fn taylor(
        &mut self,
        compiled: &mut Compiled,
        t: f64,
        y: &[f64],
        unit: f64,
        coefficients: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let trusted = self.solve(compiled, t, y)?;
        let series = if trusted { &mut self.series } else { &mut self.plain_series };
        let series = series.as_mut().expect("compiled with_series");
        let (n, orders) = (compiled.instant.sizes.states, coefficients.len() / y.len());
        let blocks = (&mut compiled.instant.blocks[..], 2);
        series.expand(&self.inputs, unit, orders - 1, blocks, |block, residual| {
            each_part(residual, |part| block.factors.solve(part));
        });
        coefficients.fill(0.0);
        for i in 0..n {
            let value = [self.inputs[1 + i]];
            for (k, x) in series.state(i).unwrap_or(&value).iter().enumerate() {
                coefficients[i * orders + k] = x.value;
                for l in 0..self.directions {
                    coefficients[((1 + l) * n + i) * orders + k] = x.tangents.0[l];
                }
            }
        }
        Ok(())
    }

    /// [`Compiled::project`]; the derivatives follow: `M dδv + Aᵀ dκ = 0`, `f + A dδv` keeps its tangents 0.
    ///
    /// # Errors
    /// As [`Compiled::project`].
    pub fn project(&mut self, compiled: &mut Compiled, t: f64, y: &mut [f64]) -> Result<f64, EvaluationFailure> {
        let n = compiled.instant.sizes.states;
        let moved = compiled.project(t, &mut y[..n])?;
        let (Some(program), Some(projector)) = (&mut self.projector, &compiled.projector) else { return Ok(moved) };
        load(&mut self.inputs, compiled, t, y, self.directions);
        let (known, size) = (compiled.instant.sizes.known(), projector.places.len() + projector.constraints);
        let (matrix, f) = program.evaluate(&self.inputs[..known]).split_at(size * size);
        let values: Vec<f64> = matrix.iter().map(|x| x.value).collect();
        self.factors.factorize(&values).map_err(|Singular { reciprocal }| EvaluationFailure::Singular {
            reciprocal,
            limit: PIVOT_LIMIT,
            regular: "constraint Jacobian of full row rank, metric regular on its kernel",
        })?;
        for l in 0..self.directions {
            let mut right = vec![0.0; size];
            right[projector.places.len()..].iter_mut().zip(f).for_each(|(r, f)| *r = -f.tangents.0[l]);
            self.factors.solve(&mut right);
            for (change, place) in right.iter().zip(&projector.places) {
                y[(1 + l) * n + place] += change;
            }
        }
        Ok(moved)
    }

    /// Rates (0) or outputs (1).
    fn evaluate(
        &mut self,
        compiled: &mut Compiled,
        t: f64,
        y: &[f64],
        which: usize,
    ) -> Result<&[Dual], EvaluationFailure> {
        let trusted = self.solve(compiled, t, y)?;
        let Programs { rates, outputs, planned, .. } = &mut self.programs;
        Ok(match planned.as_mut().filter(|_| trusted) {
            Some(planned) if which == 0 => planned.rates(&self.inputs).0,
            Some(planned) => planned.outputs(&self.inputs).0,
            None => [rates, outputs][which].evaluate(&self.inputs),
        })
    }

    /// The unknowns of the instant with their derivatives: those of blocks left, or where the plan is not to
    /// be trusted, which is then said, of all.
    fn solve(&mut self, compiled: &mut Compiled, t: f64, y: &[f64]) -> Result<bool, EvaluationFailure> {
        let trusted = compiled.solve_trusted(t, &y[..compiled.instant.sizes.states])?;
        load(&mut self.inputs, compiled, t, y, self.directions);
        let known = compiled.instant.sizes.known();
        for (x, z) in self.inputs[known..].iter_mut().zip(&compiled.instant.inputs[known..]) {
            *x = Dual::from_f64(*z);
        }
        for (k, block) in compiled.instant.blocks.iter_mut().enumerate() {
            if trusted && !compiled.left.contains(&k) {
                continue;
            }
            // the factors of a Newton iteration are those of the point before the last
            for _ in 0..if block.linear { 1 } else { 2 } {
                let mut residual = residual(block, &mut self.programs.blocks[k], &self.inputs, known);
                each_part(&mut residual, |part| block.factors.solve(part));
                for (z, change) in self.inputs[known + block.first..].iter_mut().zip(residual) {
                    z.tangents = z.tangents - change.tangents;
                }
            }
        }
        Ok(trusted)
    }
}

/// `R(z; t, y)` of a block.
fn residual(block: &CompiledBlock, program: &mut Evaluator<Dual>, inputs: &[Dual], known: usize) -> Vec<Dual> {
    let n = block.size;
    let values = program.evaluate(if block.linear { &inputs[..known] } else { inputs });
    let (matrix, rest) = values.split_at(n * n);
    if !block.linear {
        return rest.to_vec();
    }
    let z = &inputs[known + block.first..][..n];
    let row = |i: usize| matrix[i * n..][..n].iter().zip(z).fold(rest[i], |sum, (&m, &z)| sum + m * z);
    (0..n).map(row).collect()
}

/// Applies what is linear to the values, and to the tangents along each direction.
fn each_part(x: &mut [Dual], mut apply: impl FnMut(&mut [f64])) {
    let mut part: Vec<f64> = x.iter().map(|x| x.value).collect();
    apply(&mut part);
    x.iter_mut().zip(&part).for_each(|(x, part)| x.value = *part);
    for l in 0..LANES {
        part.iter_mut().zip(&*x).for_each(|(part, x)| *part = x.tangents.0[l]);
        if part.iter().any(|part| *part != 0.0) {
            apply(&mut part);
            x.iter_mut().zip(&part).for_each(|(x, part)| x.tangents.0[l] = *part);
        }
    }
}

/// Time, states and constants; the tangents of constants stay.
fn load(inputs: &mut [Dual], compiled: &Compiled, t: f64, y: &[f64], directions: usize) {
    let (n, known) = (compiled.instant.sizes.states, compiled.instant.sizes.known());
    inputs[0].value = t;
    for (i, x) in inputs[1..=n].iter_mut().enumerate() {
        x.value = y[i];
        for l in 0..directions {
            x.tangents.0[l] = y[(1 + l) * n + i];
        }
    }
    let constants = inputs[1 + n..known].iter_mut().zip(&compiled.instant.inputs[1 + n..known]);
    constants.for_each(|(x, constant)| x.value = *constant);
}

/// Values, then tangents direction by direction.
fn spread(values: &[Dual], n: usize, into: &mut [f64]) {
    for (part, row) in into.chunks_exact_mut(n).enumerate() {
        for (x, value) in row.iter_mut().zip(values) {
            *x = if part == 0 { value.value } else { value.tangents.0[part - 1] };
        }
    }
}
