//! Values that are linear in states and time, and functions of these, whose series are integrated.

use rustc_hash::FxHashSet;

use super::{Builder, Integrated};
use crate::Function;
use crate::programs::program::{Id, Value};
use crate::series::SeriesInput;

/// How a value moves, as far as that is seen from it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Motion {
    /// Constant in time.
    Steady,
    /// Linear in time.
    Line,
    /// A linear combination of states and time, coefficients constant in time.
    Combination,
    Any,
}

impl Builder<'_> {
    /// Once stages are known.
    pub(super) fn extend_motions(&mut self) {
        for id in self.motions.len()..self.program.len() {
            let of = |a: Id| self.motions[a as usize];
            let motion = match self.program.value(id as Id) {
                _ if !self.varies(id as Id) => Motion::Steady,
                Value::Input(i) => match self.inputs[i as usize] {
                    SeriesInput::State(rate) if self.varies(self.outputs[rate]) => Motion::Combination,
                    SeriesInput::State(_) | SeriesInput::Time => Motion::Line,
                    SeriesInput::Steady | SeriesInput::Unknown(_) => Motion::Any,
                },
                Value::Neg(a) => of(a),
                Value::Add(a, b) | Value::Sub(a, b) => of(a).max(of(b)),
                Value::Mul(a, b) if !self.varies(a) || !self.varies(b) => of(a).max(of(b)),
                Value::Div(a, b) if !self.varies(b) => of(a),
                _ => Motion::Any,
            };
            self.motions.push(motion);
        }
    }

    pub(super) fn is_line(&self, id: Id) -> bool {
        self.motions[id as usize] == Motion::Line
    }

    /// The rate of a linear combination of states and time, or of a value that is constant in time.
    pub(super) fn rate(&mut self, id: Id) -> Id {
        if !self.varies(id) {
            return self.number(0);
        }
        if let Some((factor, a)) = self.multiple(id) {
            let rate = self.rate(a);
            return self.scaled(rate, factor);
        }
        match self.program.value(id) {
            Value::Input(i) => match self.inputs[i as usize] {
                SeriesInput::State(rate) => self.outputs[rate],
                _ => self.one,
            },
            Value::Add(a, b) if !self.varies(b) => self.rate(a),
            Value::Add(a, b) if !self.varies(a) => self.rate(b),
            Value::Add(a, b) => {
                let (a, b) = (self.rate(a), self.rate(b));
                self.push(Value::Add(a, b))
            }
            Value::Sub(a, b) if !self.varies(b) => self.rate(a),
            Value::Sub(a, b) => {
                let b = self.rate(b);
                let minus = self.minus(b);
                if !self.varies(a) {
                    return minus;
                }
                let a = self.rate(a);
                self.push(Value::Sub(a, b))
            }
            other => unreachable!("{other:?} is not a linear combination"),
        }
    }

    /// Finds the functions that are integrated: `(sin φ)' = φ' cos φ` is a product like those that equations
    /// of motion are full of, so that it is often there already; and where `φ'` is constant it is none.
    ///
    /// Returns all values whose series the outputs need.
    pub(super) fn integrate_functions(&mut self) -> FxHashSet<Id> {
        let mut seen = FxHashSet::default();
        let mut pending = self.outputs.to_vec();
        while let Some(id) = pending.pop() {
            if !seen.insert(id) {
                continue;
            }
            if let Some(of) = self.derivatives.get(&id) {
                pending.push(*of);
                continue;
            }
            let value = self.program.value(id);
            let (operands, count) = value.operands();
            pending.extend(&operands[..count]);
            let (Value::Call(_, a) | Value::Logistic(a) | Value::Sech(a)) = value else { continue };
            if !matches!(self.motions[a as usize], Motion::Line | Motion::Combination) {
                continue;
            }
            let Some((sign, derivative)) = self.derivative(id, value, a) else { continue };
            let slope = self.rate(a);
            let (factor, rate) = match self.multiple(slope) {
                _ if !self.varies(slope) => (self.times(sign, slope), derivative),
                Some((factor, a)) => (self.scaled(sign, factor), self.push(Value::Mul(a, derivative))),
                None => (sign, self.push(Value::Mul(slope, derivative))),
            };
            self.integrated.insert(id, Integrated { factor, rate });
            pending.push(rate);
        }
        seen
    }

    /// The derivative of a function by its argument: a number and a value that varies.
    fn derivative(&mut self, id: Id, of: Value, a: Id) -> Option<(Id, Id)> {
        use Function::*;
        let (one, minus_one) = (self.one, self.number(-1));
        let function = match of {
            Value::Call(function, _) => function,
            Value::Logistic(_) => {
                let opposite = self.minus(a);
                let other = self.push(Value::Logistic(opposite));
                return Some((one, self.push(Value::Mul(id, other))));
            }
            _ => {
                let tanh = self.push(Value::Call(Tanh, a));
                return Some((minus_one, self.push(Value::Mul(id, tanh))));
            }
        };
        let value = match function {
            Sin => Value::Call(Cos, a),
            Cos => Value::Call(Sin, a),
            Sinh => Value::Call(Cosh, a),
            Cosh => Value::Call(Sinh, a),
            Exp => Value::Call(Exp, a),
            Tan => Value::Add(one, self.push(Value::Square(id))),
            Tanh => Value::Sub(one, self.push(Value::Square(id))),
            _ => return None,
        };
        Some((if function == Cos { minus_one } else { one }, self.push(value)))
    }
}
