//! Sums of magnitudes behind rates and multipliers by adjoints.
//!
//! [`Compiled::terms_of_rates`] adds up magnitudes of paths from numbers to a rate. Through a chain of n
//! bodies there are 2ⁿ paths, which cancel. [`symbolic::Recorded`] adds up the paths themselves first, at the
//! cost of one sweep per eight rates; it is for motions that the cheaper measure does not clear.

use symbolic::Tape;

use crate::blocks::EvaluationFailure;
use crate::compiled::Compiled;

/// Outputs of a tape with factors.
type Combination = Vec<(usize, f64)>;

impl Compiled {
    /// [`Compiled::terms_of_rates`] by adjoints, of the evaluation in the plan where that is trusted; of each
    /// rate the lesser of the two.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn adjoint_terms_of_rates(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        let mut along_paths = self.terms_of_evaluation(t, y)?;
        along_paths.truncate(y.len());
        let sizes = self.adjoint_sizes(t, y)?;
        let (inputs, rates) = (&self.instant.inputs, 0..along_paths.len());
        let is_trusted = self.planned.as_mut().is_some_and(|planned| planned.is_trusted(inputs));
        let found = match &self.planned {
            Some(planned) if is_trusted => {
                let of_plan = |x: &[f64]| planned.places.iter().map(|&i| x[i]).collect::<Vec<f64>>();
                magnitudes(planned.rates.tape(), &of_plan(inputs), &of_plan(&sizes), rates)
            }
            _ => magnitudes(self.instant.rates.tape(), inputs, &sizes, rates),
        };
        Ok(lesser(along_paths, found))
    }

    /// [`Compiled::terms_of_multipliers`] at the instant itself by adjoints, of each multiplier the lesser of
    /// the two.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn adjoint_terms_of_multipliers(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        let along_paths = self.terms_of_multipliers(t, t, y)?;
        let sizes = self.adjoint_sizes(t, y)?;
        let first = 2 * self.instant.sizes.coordinates;
        let found =
            magnitudes(self.instant.outputs.tape(), &self.instant.inputs, &sizes, first..first + along_paths.len());
        Ok(lesser(along_paths, found))
    }

    /// Sizes of `t, y, constants, z`; for `z` the effect of round-off in its equations is added.
    fn adjoint_sizes(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, EvaluationFailure> {
        self.solve_instant(t, y)?;
        let known = self.instant.sizes.known();
        let mut sizes: Vec<f64> = self.instant.inputs.iter().map(|x| x.abs()).collect();
        for block in &mut self.instant.blocks {
            let (n, first) = (block.size, known + block.first);
            let count = if block.linear { known } else { self.instant.inputs.len() };
            // R, of a linear block that at z = 0 and ∂R/∂z z
            let row = |i: usize| -> Combination {
                let products = (0..n).filter(|_| block.linear).map(|j| (i * n + j, self.instant.inputs[first + j]));
                products.chain([(n * n + i, 1.0)]).collect()
            };
            let rows: Vec<Combination> = (0..n).map(row).collect();
            let tape = block.program.tape();
            let terms =
                tape.record(&self.instant.inputs[..count], &mut tape.workspace()).magnitudes(&rows, &sizes[..count]);
            for (column, term) in block.inverse().iter().zip(terms) {
                sizes[first..first + n].iter_mut().zip(column).for_each(|(size, x)| *size += x.abs() * term);
            }
        }
        Ok(sizes)
    }
}

fn magnitudes(tape: &Tape, inputs: &[f64], sizes: &[f64], outputs: std::ops::Range<usize>) -> Vec<f64> {
    let each: Vec<Combination> = outputs.map(|k| vec![(k, 1.0)]).collect();
    tape.record(inputs, &mut tape.workspace()).magnitudes(&each, sizes)
}

/// Of each the lesser; what is not finite along paths stays so, and what is NaN by adjoints counts as none.
fn lesser(along_paths: Vec<f64>, by_adjoints: Vec<f64>) -> Vec<f64> {
    let both = along_paths.into_iter().zip(by_adjoints);
    both.map(|(paths, adjoint)| if paths.is_finite() { paths.min(adjoint) } else { paths }).collect()
}
