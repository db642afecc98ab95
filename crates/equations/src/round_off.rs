//! What is added up to rates and invariants, of which round-off is a part.

use symbolic::{Bounded, Evaluator, Scalar};

use crate::blocks::{CompiledBlock, EvaluationFailure};
use crate::compiled::Compiled;

impl Compiled {
    /// How much was added up to each invariant at `(t, y)`: [`Bounded::magnitude`], of states and unknowns as
    /// they are.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_invariants(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        self.solve_instant(t, y)?;
        let inputs: Vec<Bounded> = self.inputs.iter().map(|&x| Bounded::from_f64(x)).collect();
        let values = in_terms(&self.outputs, &inputs);
        Ok(values[values.len() - self.sizes.invariants..].iter().map(|x| x.magnitude).collect())
    }

    /// How much was added up to each rate at `(t, y)`, that of the unknowns `z` of the instant included: of a
    /// block `R(z; t, y) = 0` it is `|∂R/∂z|⁻¹` times that of `R`.
    ///
    /// The rates in the chosen plan have round-off of the same size.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_rates(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        let inputs = self.in_terms(t, y, y)?;
        Ok(in_terms(&self.rates, &inputs).iter().map(|x| x.magnitude).collect())
    }

    /// The same of multipliers, from a start at time `begin` on: what was added up to states since
    /// then counts, too.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_multipliers(&mut self, begin: f64, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        let rates = self.terms_of_rates(t, y)?;
        let states: Vec<f64> = y.iter().zip(rates).map(|(y, term)| y.abs() + term * (t - begin).abs()).collect();
        let values = self.terms_of_outputs(t, y, &states)?;
        Ok(values[2 * self.sizes.coordinates..][..self.sizes.multipliers].to_vec())
    }

    /// How much was added up to each coordinate at `(t, y)` whose states have come from sums of these sizes.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn terms_of_coordinates(&mut self, t: f64, y: &[f64], states: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        let mut values = self.terms_of_outputs(t, y, states)?;
        values.truncate(self.sizes.coordinates);
        Ok(values)
    }

    fn terms_of_outputs(&mut self, t: f64, y: &[f64], states: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        let inputs = self.in_terms(t, y, states)?;
        Ok(in_terms(&self.outputs, &inputs).iter().map(|x| x.magnitude).collect())
    }

    /// `t, y, constants, z`, with what was added up to `y` and to `z`.
    fn in_terms(&mut self, t: f64, y: &[f64], states: &[f64]) -> Result<Vec<Bounded>, EvaluationFailure> {
        self.solve_instant(t, y)?;
        let known = self.sizes.known();
        let mut inputs: Vec<Bounded> = self.inputs.iter().map(|&x| Bounded::from_f64(x)).collect();
        inputs[1..].iter_mut().zip(states).for_each(|(y, size)| y.magnitude = size.abs());
        for block in &mut self.equations_of_instant {
            let terms = terms_of_unknowns(block, &inputs, known);
            let first = known + block.first;
            inputs[first..].iter_mut().zip(terms).for_each(|(z, terms)| z.magnitude = z.magnitude.max(terms));
        }
        Ok(inputs)
    }
}

fn in_terms(program: &Evaluator<f64>, inputs: &[Bounded]) -> Vec<Bounded> {
    Evaluator::new(program.tape().clone()).evaluate(inputs).to_vec()
}

/// `|∂R/∂z|⁻¹` times what is added up to `R`, by the factors of a block that was solved at these inputs.
fn terms_of_unknowns(block: &mut CompiledBlock, inputs: &[Bounded], known: usize) -> Vec<f64> {
    let n = block.size;
    let values = in_terms(&block.program, if block.linear { &inputs[..known] } else { inputs });
    let (matrix, residual) = values.split_at(n * n);
    let z = &inputs[known + block.first..][..n];
    let of_row = |(row, r): (&[Bounded], &Bounded)| {
        // the residual of a linear block is that of z = 0
        let products: f64 = row.iter().zip(z).map(|(m, z)| m.magnitude * z.value.abs()).sum();
        r.magnitude + if block.linear { products } else { 0.0 }
    };
    let terms: Vec<f64> = matrix.chunks_exact(n).zip(residual).map(of_row).collect();
    let mut found = vec![0.0; n];
    for (k, term) in terms.iter().enumerate() {
        let mut column = vec![0.0; n];
        column[k] = 1.0;
        block.factors.solve(&mut column);
        found.iter_mut().zip(column).for_each(|(sum, x)| *sum += x.abs() * term);
    }
    found
}
