//! Taylor coefficients in time of everything in a trace, one order after another.

use crate::Wide;
use crate::trace::{ABSENT, Node, Operation, Value};

/// Series of all values of a trace.
///
/// Coefficient `k` of an operation follows from coefficients up to `k` of its operands and up to `k − 1` of itself and its weights.
pub(crate) struct Series<T> {
    operations: Vec<Operation>,
    /// Whether the value depends on an unknown, and whether it depends on no input but those that do not move.
    by_unknown: Vec<bool>,
    constant: Vec<bool>,
    /// Series of one operation after that of another.
    coefficients: Vec<T>,
    length: usize,
}

/// Which operations to compute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    All,
    ByUnknown,
}

impl<T: Wide> Series<T> {
    /// Room for `length` coefficients. `is_unknown` and `is_fixed` say which inputs are unknowns, and which do not move.
    pub(crate) fn new(
        operations: Vec<Operation>,
        length: usize,
        is_unknown: impl Fn(usize) -> bool,
        is_fixed: impl Fn(usize) -> bool,
    ) -> Self {
        let size = operations.len();
        let mut series = Series {
            coefficients: vec![T::zero(); size * length],
            by_unknown: vec![false; size],
            constant: vec![false; size],
            operations,
            length,
        };
        for i in 0..size {
            let operands = operands(series.operations[i]);
            let of = |flags: &[bool]| operands.map(|o| o.is_some_and(|o| flags[o as usize]));
            series.by_unknown[i] = match series.operations[i] {
                Operation::Input(place) => is_unknown(place as usize),
                _ => of(&series.by_unknown).contains(&true),
            };
            series.constant[i] = match series.operations[i] {
                Operation::Input(place) => is_fixed(place as usize),
                _ => operands.iter().flatten().all(|&o| series.constant[o as usize]),
            };
        }
        series
    }

    /// Coefficient `k` of a value.
    pub(crate) fn at(&self, node: Node, k: usize) -> T {
        self.coefficients[node as usize * self.length + k]
    }

    /// Computes coefficient `k` of every operation, or only of those that depend on an unknown, for inputs whose coefficient is `input(place)`.
    pub(crate) fn advance(&mut self, k: usize, part: Part, input: impl Fn(usize) -> T) {
        for i in 0..self.operations.len() {
            if part == Part::ByUnknown && !self.by_unknown[i] || k > 0 && self.constant[i] {
                continue;
            }
            let value = match (self.operations[i], k) {
                (Operation::Input(place), _) => input(place as usize),
                (operation, 0) => self.first(operation),
                (operation, _) => self.coefficient(operation, i as Node, k),
            };
            self.coefficients[i * self.length + k] = value;
        }
    }

    /// The value itself.
    fn first(&self, operation: Operation) -> T {
        let of = |node| self.at(node, 0);
        match operation {
            Operation::Input(_) => T::zero(),
            Operation::Float(bits) => T::from_f64(f64::from_bits(bits)),
            Operation::Ratio(numerator, denominator) => T::from_ratio(numerator, denominator),
            Operation::Neg(a) => -of(a),
            Operation::Add(a, b) => of(a) + of(b),
            Operation::Sub(a, b) => of(a) - of(b),
            Operation::Mul(a, b) => of(a) * of(b),
            Operation::Div(a, b) => of(a) / of(b),
            Operation::Sqrt(a) => of(a).sqrt(),
            Operation::Integral { value, arguments: [a, b], .. } => match value {
                Value::Function(function) => function.apply(of(a)),
                Value::Power => of(a).powf(of(b)),
                Value::Angle => of(a).atan2(of(b)),
            },
        }
    }

    /// Coefficient `k ≥ 1`; `this` is the operation's own series.
    fn coefficient(&self, operation: Operation, this: Node, k: usize) -> T {
        let of = |node| self.at(node, k);
        match operation {
            Operation::Input(_) | Operation::Float(_) | Operation::Ratio(..) => T::zero(),
            Operation::Neg(a) => -of(a),
            Operation::Add(a, b) => of(a) + of(b),
            Operation::Sub(a, b) => of(a) - of(b),
            // a constant factor has one coefficient only
            Operation::Mul(a, b) if self.constant[a as usize] => self.at(a, 0) * of(b),
            Operation::Mul(a, b) if self.constant[b as usize] => of(a) * self.at(b, 0),
            Operation::Mul(a, b) => self.convolution(a, b, 0, k, k),
            Operation::Div(a, b) if self.constant[b as usize] => of(a) / self.at(b, 0),
            // c b = a
            Operation::Div(a, b) => (of(a) - self.convolution(this, b, 0, k - 1, k)) / self.at(b, 0),
            // c c = a
            Operation::Sqrt(a) => {
                let rest = if k > 1 { self.convolution(this, this, 1, k - 1, k) } else { T::zero() };
                (of(a) - rest) / (self.at(this, 0) + self.at(this, 0))
            }
            // k c_k = Σ j a_j w_{k−j}
            Operation::Integral { arguments, weights, .. } => {
                let mut sum = T::zero();
                for (&a, &w) in arguments.iter().zip(&weights) {
                    if w != ABSENT && !self.constant[a as usize] {
                        for j in 1..=k {
                            sum = sum + T::from_f64(j as f64) * self.at(a, j) * self.at(w, k - j);
                        }
                    }
                }
                sum / T::from_f64(k as f64)
            }
        }
    }

    /// `Σ a_j b_{k−j}` over `j = from … to`.
    fn convolution(&self, a: Node, b: Node, from: usize, to: usize, k: usize) -> T {
        let row = |node: Node| &self.coefficients[node as usize * self.length..];
        T::convolution(&row(a)[from..=to], &row(b)[k - to..=k - from])
    }
}

fn operands(operation: Operation) -> [Option<Node>; 2] {
    match operation {
        Operation::Input(_) | Operation::Float(_) | Operation::Ratio(..) => [None, None],
        Operation::Neg(a) | Operation::Sqrt(a) => [Some(a), None],
        Operation::Add(a, b) | Operation::Sub(a, b) | Operation::Mul(a, b) | Operation::Div(a, b) => [Some(a), Some(b)],
        Operation::Integral { arguments: [a, b], .. } => [Some(a), Some(b)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DoubleDouble;
    use crate::trace::{Traced, record};
    use symbolic::Scalar;

    /// Sum of the series of `e(a(t), b(t))` at `h` minus the value there, for `a = a₀ + t − t²/2` and `b = 3/4 + t/3`.
    fn misses(
        start: (i64, i64),
        e: impl Fn(Traced, Traced) -> Traced,
        exact: fn(DoubleDouble, DoubleDouble) -> DoubleDouble,
    ) -> f64 {
        const LENGTH: usize = 26;
        let (operations, node) = record(|| e(Traced::input(0), Traced::input(1)).0);
        let ratio = DoubleDouble::from_ratio;
        let inputs = [vec![ratio(start.0, start.1), ratio(1, 1), ratio(-1, 2)], vec![ratio(3, 4), ratio(1, 3)]];
        let mut series: Series<DoubleDouble> = Series::new(operations, LENGTH, |_| false, |_| false);
        for k in 0..LENGTH {
            series.advance(k, Part::All, |place| inputs[place].get(k).copied().unwrap_or(DoubleDouble::ZERO));
        }
        let h = ratio(1, 100);
        let sum =
            |c: &dyn Fn(usize) -> DoubleDouble| (0..LENGTH).rev().fold(DoubleDouble::ZERO, |sum, k| sum * h + c(k));
        let [a, b] = inputs.each_ref().map(|c| sum(&|k| c.get(k).copied().unwrap_or(DoubleDouble::ZERO)));
        (sum(&|k| series.at(node, k)) - exact(a, b)).size()
    }

    #[test]
    fn series_of_all_operations_are_those_of_their_values() {
        macro_rules! check {
            ($start:expr, $e:expr) => {
                let error = misses($start, $e, $e);
                assert!(error < 1e-29, "{}: {error:.1e}", stringify!($e));
            };
        }
        check!((2, 5), |a, b| a * b - b / a + -a);
        check!((2, 5), |a, b| (a * b).sqrt());
        check!((2, 5), |a, b| a.sin() * b.cos());
        check!((2, 5), |a, _| a.cos());
        check!((2, 5), |a, b| a.tan() + b.tanh());
        check!((2, 5), |a, b| a.sinh() * b.cosh());
        check!((2, 5), |a, _| a.asin());
        check!((2, 5), |a, _| a.acos());
        check!((2, 5), |a, _| a.atan());
        check!((2, 5), |a, _| a.asinh());
        check!((5, 2), |a, _| a.acosh());
        check!((2, 5), |a, _| a.atanh());
        check!((2, 5), |a, b| (a * b).exp());
        check!((2, 5), |a, b| (a / b).log());
        check!((2, 5), |a, b| a.powf(b));
        check!((-2, 5), |a, b| a.powf(Scalar::from_f64(3.0)) + b);
        check!((-2, 5), |a, b| a.atan2(b));
    }
}
