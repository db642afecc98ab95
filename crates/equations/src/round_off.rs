//! Sums of magnitudes behind rates, their derivatives and invariants: round-off is proportional to them.

use symbolic::{Bounded, Evaluator, Scalar};

use crate::blocks::{CompiledBlock, EvaluationFailure};
use crate::compiled::Compiled;
use crate::plan::Plan;
use crate::planned::again;
use crate::programs::{Programs, Terms};

impl Compiled {
    /// With its programs in terms, which are made once.
    fn with_terms<T>(&mut self, evaluate: impl FnOnce(&mut Self, &mut Terms) -> T) -> T {
        let mut terms = self.terms.take().unwrap_or_else(|| {
            let programs = Programs::of(&self.instant, self.planned.as_ref());
            Box::new(Terms { programs, steep: again(&self.steep.program) })
        });
        let found = evaluate(self, &mut terms);
        self.terms = Some(terms);
        found
    }

    /// The sum of magnitudes behind each invariant at `(t, y)`: [`Bounded::magnitude`], with states and
    /// unknowns taken as exact.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_invariants(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        self.solve_instant(t, y)?;
        let (inputs, count) = (bounded(&self.instant.inputs), self.instant.sizes.invariants);
        let of_last = |values: &[Bounded]| magnitudes(&values[values.len() - count..]);
        Ok(self.with_terms(|_, terms| of_last(terms.programs.outputs.evaluate(&inputs))))
    }

    /// The sum of magnitudes behind each rate at `(t, y)`, including that of the unknowns `z` of the instant:
    /// for a block `R(z; t, y) = 0` the latter is `|∂R/∂z|⁻¹` times that of `R`.
    ///
    /// These sums are those of the equations as written; [`Compiled::terms_of_evaluation`] gives those of
    /// their evaluation.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_rates(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        self.with_terms(|compiled, terms| {
            let inputs = compiled.in_terms(t, y, y, terms)?;
            Ok(magnitudes(terms.programs.rates.evaluate(&inputs)))
        })
    }

    /// The sum of magnitudes in the evaluation of each rate, then of each multiplier:
    /// [`Compiled::terms_of_rates`], and intermediate results of the elimination of a block, in numbers or in
    /// the chosen plan. Errors are a few ε of these sums.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_evaluation(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        self.with_terms(|compiled, terms| {
            let inputs = compiled.inputs_in_terms(t, y, y, terms, Elimination::Counted)?;
            let mut rates = magnitudes(terms.programs.rates.evaluate(&inputs));
            let mut outputs = magnitudes(terms.programs.outputs.evaluate(&inputs));
            // an elimination in a fixed order may add up more than a factorization
            if let Some(planned) = &mut terms.programs.planned {
                raise(&mut rates, planned.rates(&inputs));
                raise(&mut outputs, planned.outputs(&inputs));
            }
            rates.extend(&outputs[2 * compiled.instant.sizes.coordinates..][..compiled.instant.sizes.multipliers]);
            Ok(rates)
        })
    }

    /// The sum of magnitudes behind each entry of the Jacobian at `(t, y)`, row-major, as for rates: entries
    /// below some ε of it are round-off, in any units of the states.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    ///
    /// # Panics
    /// If [`Compiled::with_jacobian`] was not called.
    pub fn terms_of_jacobian(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        self.with_terms(|compiled, terms| {
            let inputs = compiled.in_terms(t, y, y, terms)?;
            let matrix = |(block, program): (&CompiledBlock, &mut Evaluator<Bounded>)| {
                let values =
                    program.evaluate(if block.linear { &inputs[..compiled.instant.sizes.known()] } else { &inputs });
                magnitudes(&values[..block.size * block.size])
            };
            let matrices: Vec<_> = compiled.instant.blocks.iter().zip(&mut terms.programs.blocks).map(matrix).collect();
            let derivatives = compiled.jacobian.as_ref().expect("compiled with_jacobian");
            Ok(derivatives.terms(&inputs, &mut compiled.instant.blocks, &matrices))
        })
    }

    /// The same of multipliers, from a start at time `begin` on: what was added up to states since
    /// then counts as well.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_multipliers(&mut self, begin: f64, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        let rates = self.terms_of_rates(t, y)?;
        let states: Vec<f64> = y.iter().zip(rates).map(|(y, term)| y.abs() + term * (t - begin).abs()).collect();
        let values = self.terms_of_outputs(t, y, &states)?;
        Ok(values[2 * self.instant.sizes.coordinates..][..self.instant.sizes.multipliers].to_vec())
    }

    fn terms_of_outputs(&mut self, t: f64, y: &[f64], states: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        self.with_terms(|compiled, terms| {
            let inputs = compiled.in_terms(t, y, states, terms)?;
            Ok(magnitudes(terms.programs.outputs.evaluate(&inputs)))
        })
    }

    /// The sum of magnitudes behind each argument of [`Compiled::gauges`] at `(t, y)`.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_gauged(&mut self, t: f64, y: &[f64], terms: &mut [f64]) -> Result<(), EvaluationFailure> {
        self.with_terms(|compiled, programs| {
            let inputs = match compiled.steep.need_unknowns {
                true => compiled.in_terms(t, y, y, programs)?,
                false => {
                    compiled.load(t, y);
                    bounded(&compiled.instant.inputs)
                }
            };
            terms.copy_from_slice(&magnitudes(programs.steep.evaluate(&inputs[..compiled.steep.inputs])));
            Ok(())
        })
    }

    /// `t, y, constants, z`, with what was added up to `y` and to `z`.
    fn in_terms(
        &mut self,
        t: f64,
        y: &[f64],
        states: &[f64],
        terms: &mut Terms,
    ) -> Result<Vec<Bounded>, EvaluationFailure> {
        self.inputs_in_terms(t, y, states, terms, Elimination::Exact)
    }

    fn inputs_in_terms(
        &mut self,
        t: f64,
        y: &[f64],
        states: &[f64],
        terms: &mut Terms,
        elimination: Elimination,
    ) -> Result<Vec<Bounded>, EvaluationFailure> {
        self.solve_instant(t, y)?;
        let known = self.instant.sizes.known();
        let mut inputs = bounded(&self.instant.inputs);
        inputs[1..].iter_mut().zip(states).for_each(|(y, size)| y.magnitude = size.abs());
        for (block, program) in self.instant.blocks.iter_mut().zip(&mut terms.programs.blocks) {
            let terms = terms_of_unknowns(block, program, &inputs, known, elimination);
            let first = known + block.first;
            inputs[first..].iter_mut().zip(terms).for_each(|(z, terms)| z.magnitude = z.magnitude.max(terms));
        }
        Ok(inputs)
    }
}

/// To what was added up by a plan, where that is trusted, if it is more.
fn raise(magnitudes: &mut [f64], (wanted, condition): (&[Bounded], &[Bounded])) {
    if condition.iter().all(|x| x.value <= Plan::LIMIT) && wanted.iter().all(|x| x.value.is_finite()) {
        magnitudes.iter_mut().zip(wanted).for_each(|(m, x)| *m = m.max(x.magnitude));
    }
}

/// Whether what the elimination of a linear block adds up counts.
#[derive(Clone, Copy, PartialEq)]
enum Elimination {
    Exact,
    Counted,
}

fn bounded(x: &[f64]) -> Vec<Bounded> {
    x.iter().map(|&x| Bounded::from_f64(x)).collect()
}

fn magnitudes(x: &[Bounded]) -> Vec<f64> {
    x.iter().map(|x| x.magnitude).collect()
}

/// `|∂R/∂z|⁻¹` times what is added up to `R`, by the factors of a block that was solved at these inputs.
fn terms_of_unknowns(
    block: &mut CompiledBlock,
    program: &mut Evaluator<Bounded>,
    inputs: &[Bounded],
    known: usize,
    elimination: Elimination,
) -> Vec<f64> {
    let n = block.size;
    let values = program.evaluate(if block.linear { &inputs[..known] } else { inputs });
    let (matrix, residual) = values.split_at(n * n);
    let z: Vec<f64> = inputs[known + block.first..][..n].iter().map(|z| z.value).collect();
    let mut terms = magnitudes(residual);
    if block.linear {
        // the residual of a linear block is that of z = 0
        let products = |row: &[Bounded]| row.iter().zip(&z).map(|(m, z)| m.magnitude * z.abs()).sum::<f64>();
        terms.iter_mut().zip(matrix.chunks_exact(n)).for_each(|(term, row)| *term += products(row));
        if elimination == Elimination::Counted {
            terms.iter_mut().zip(block.factors.eliminated(&z)).for_each(|(term, sum)| *term += sum);
        }
    }
    let mut found = vec![0.0; n];
    for (column, term) in block.inverse().iter().zip(terms) {
        found.iter_mut().zip(column).for_each(|(sum, x)| *sum += x.abs() * term);
    }
    found
}
