//! Round-off of an evaluation by adjoints.
//!
//! To first order the round-off of a linear combination `Y` of outputs is
//!
//! ```text
//! δY = Σ_r ∂Y/∂r · δr ,      |δr| ≤ ½ ε |r| ,
//! ```
//!
//! with all inputs, constants and results of instructions `r`. An adjoint `∂Y/∂r` adds up all paths from `r`
//! to `Y` with their signs: along a chain of rotations it stays near 1. [`crate::Bounded`] adds up magnitudes
//! of paths, which is cheaper, and grows exponentially there.
//!
//! Source: A. Griewank, A. Walther, *Evaluating Derivatives*, 2nd ed., SIAM 2008, section 3.4.

use super::{Instruction, Register, Tape, Workspace, run};
use crate::{Dual, LANES, Lanes, Scalar};

/// An evaluation with the slopes of its instructions.
#[derive(Clone, Debug)]
pub struct Recorded {
    steps: Vec<Step>,
    /// Sizes of inputs, zeros for outputs, then of constants; zeros for registers that are written.
    sizes: Vec<f64>,
    inputs: usize,
}

/// Results with their sizes, and operands with the slopes of each result.
#[derive(Clone, Copy, Debug)]
struct Step {
    results: [(Register, f64); 2],
    operands: [(Register, [f64; 2]); 3],
}

impl Tape {
    /// Evaluates at `inputs`, and keeps what [`Recorded::magnitudes`] asks for.
    ///
    /// # Panics
    /// If there are not as many inputs as the tape has, or the workspace is another tape's.
    pub fn record(&self, inputs: &[f64], workspace: &mut Workspace<f64>) -> Recorded {
        let r = &mut workspace.registers[..];
        assert_eq!(inputs.len(), self.inputs, "inputs of a tape");
        assert_eq!(r.len(), self.registers, "the workspace of another tape");
        r[..self.inputs].copy_from_slice(inputs);
        let mut sizes: Vec<f64> = r.iter().map(|x| x.abs()).collect();
        let mut steps = Vec::with_capacity(self.body.len());
        let recorded = &mut steps;
        Dual::vectorize(
            #[inline(always)]
            move || {
                let (all, r) = (recorded, r); // can be called once only, and so is inlined
                all.extend(self.body.iter().map(|&instruction| Step::new(instruction, r)));
            },
        );
        steps.iter().flat_map(|step| step.results).for_each(|(to, _)| sizes[to as usize] = 0.0);
        Recorded { steps, sizes, inputs: self.inputs }
    }
}

impl Step {
    /// Evaluates one instruction, with an operand along each of three directions.
    #[inline(always)]
    fn new(instruction: Instruction, r: &mut [f64]) -> Step {
        let (local, operands, [to, second]) = instruction.apart();
        let mut duals = [Dual::from_f64(0.0); 5];
        for (i, dual) in duals[..3].iter_mut().enumerate() {
            *dual = Dual::along(r[operands[i] as usize], i);
        }
        run(&[local], &mut duals);
        let [one, two] = [duals[3], duals[4]];
        r[second as usize] = two.value;
        r[to as usize] = one.value;
        let slopes = |i: usize| [one.tangents.0[i], two.tangents.0[i]];
        // nothing is rounded where a sign is turned, and a product in an instruction is rounded by itself
        let product = duals[0].value * duals[1].value;
        let within = match local {
            Instruction::Copy(..) | Instruction::Neg(..) => -one.value.abs(),
            Instruction::MulAdd(..) | Instruction::MulSub(..) | Instruction::NegMulAdd(..) => product.abs(),
            Instruction::Mul3(..) => one.value.abs(),
            _ => 0.0,
        };
        // without a second result both are the first register, and the slopes of the second are zero
        let results = [(to, one.value.abs() + within), (second, two.value.abs())];
        Step { results, operands: [0, 1, 2].map(|i| (operands[i], slopes(i))) }
    }
}

impl Instruction {
    /// The same from registers 0, 1, 2 to 3 and 4, with the registers of its operands and of its results. A
    /// missing operand is the first one, with slope zero; a missing second result is the first.
    fn apart(self) -> (Instruction, [Register; 3], [Register; 2]) {
        use Instruction::*;
        let one = |local, to, a| (local, [a; 3], [to; 2]);
        let two = |local, to, a, b| (local, [a, b, a], [to; 2]);
        let three = |local, to, a, b, c| (local, [a, b, c], [to; 2]);
        match self {
            Copy(to, a) => one(Copy(3, 0), to, a),
            Neg(to, a) => one(Neg(3, 0), to, a),
            Square(to, a) => one(Square(3, 0), to, a),
            Recip(to, a) => one(Recip(3, 0), to, a),
            Sqrt(to, a) => one(Sqrt(3, 0), to, a),
            Call(f, to, a) => one(Call(f, 3, 0), to, a),
            Logistic(to, a) => one(Logistic(3, 0), to, a),
            Sech(to, a) => one(Sech(3, 0), to, a),
            SinCos(sine, cosine, a) => (SinCos(3, 4, 0), [a; 3], [sine, cosine]),
            Add(to, a, b) => two(Add(3, 0, 1), to, a, b),
            Sub(to, a, b) => two(Sub(3, 0, 1), to, a, b),
            Mul(to, a, b) => two(Mul(3, 0, 1), to, a, b),
            Div(to, a, b) => two(Div(3, 0, 1), to, a, b),
            Pow(to, a, b) => two(Pow(3, 0, 1), to, a, b),
            Atan2(to, a, b) => two(Atan2(3, 0, 1), to, a, b),
            MulAdd(to, a, b, c) => three(MulAdd(3, 0, 1, 2), to, a, b, c),
            MulSub(to, a, b, c) => three(MulSub(3, 0, 1, 2), to, a, b, c),
            NegMulAdd(to, a, b, c) => three(NegMulAdd(3, 0, 1, 2), to, a, b, c),
            Mul3(to, a, b, c) => three(Mul3(3, 0, 1, 2), to, a, b, c),
        }
    }
}

impl Recorded {
    /// `Σ_r |∂Y/∂r| |r|` for each combination `Y` of outputs (their indices with factors), with these sizes
    /// of the inputs instead of their magnitudes. NaN or infinite where the evaluation is singular.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// use symbolic::Graph;
    /// let g = Graph::new();
    /// let (x, y) = (g.symbol("x"), g.symbol("y"));
    /// let tape = g.compile(&[x, y], &[g.mul(g.variable(x), g.variable(y))], &HashMap::new())?;
    /// let recorded = tape.record(&[3.0, 5.0], &mut tape.workspace());
    /// // both inputs and the product; then without round-off of the inputs
    /// assert_eq!(recorded.magnitudes(&[vec![(0, 1.0)]], &[3.0, 5.0]), [45.0]);
    /// assert_eq!(recorded.magnitudes(&[vec![(0, -2.0)]], &[0.0, 0.0]), [30.0]);
    /// # Ok::<(), symbolic::CompileError>(())
    /// ```
    ///
    /// # Panics
    /// If there are not as many sizes as inputs, or an index is not one of an output.
    pub fn magnitudes(&self, combinations: &[Vec<(usize, f64)>], sizes: &[f64]) -> Vec<f64> {
        assert_eq!(sizes.len(), self.inputs, "inputs of a tape");
        combinations.chunks(LANES).flat_map(|some| self.sweep(some, sizes).into_iter().take(some.len())).collect()
    }

    /// Up to eight combinations at once.
    fn sweep(&self, combinations: &[Vec<(usize, f64)>], sizes: &[f64]) -> [f64; LANES] {
        let mut sums = Lanes([0.0; LANES]);
        let all = &mut sums;
        Lanes::vectorize(
            #[inline(always)]
            move || {
                let sums = all; // can be called once only, and so is inlined
                *sums = self.backwards(combinations, sizes);
            },
        );
        sums.0
    }

    /// From the last instruction to the first.
    #[inline(always)]
    fn backwards(&self, combinations: &[Vec<(usize, f64)>], sizes: &[f64]) -> Lanes {
        let zero = Lanes([0.0; LANES]);
        let mut adjoints = vec![zero; self.sizes.len()];
        for (lane, combination) in combinations.iter().enumerate() {
            for &(output, factor) in combination {
                adjoints[self.inputs + output].0[lane] += factor;
            }
        }
        let mut sums = zero;
        for step in self.steps.iter().rev() {
            let [(first, of_first), (second, of_second)] = step.results;
            let one = std::mem::replace(&mut adjoints[first as usize], zero);
            let two = std::mem::replace(&mut adjoints[second as usize], zero);
            if one == zero && two == zero {
                continue;
            }
            sums = sums + one.share(of_first) + two.share(of_second);
            for (operand, [by_one, by_two]) in step.operands {
                if by_one != 0.0 || by_two != 0.0 {
                    let [a, b] = [Lanes::from_f64(by_one), Lanes::from_f64(by_two)];
                    let into = &mut adjoints[operand as usize];
                    *into = *into + a * one + b * two;
                }
            }
        }
        let all = sizes.iter().chain(&self.sizes[self.inputs..]);
        adjoints.into_iter().zip(all).fold(sums, |sums, (adjoint, &size)| sums + adjoint.share(size))
    }
}

impl Lanes {
    /// `|slope| size`, of no slope 0.
    #[inline(always)]
    fn share(self, size: f64) -> Lanes {
        self.map(|slope| if slope == 0.0 { 0.0 } else { slope.abs() * size })
    }
}
