//! Recurrences for the coefficients of quotients, roots and functions.

use super::{Builder, Part, Sum};
use crate::Function;
use crate::programs::program::{Id, Value};
use crate::series::Row;

impl Builder<'_> {
    /// Gives a value that varies its series.
    pub(super) fn define(&mut self, id: Id) -> Row {
        if let Some(of) = self.derivatives.get(&id).copied() {
            self.row(of);
            return self.fresh(Some(id));
        }
        let value = self.program.value(id);
        match value {
            Value::Input(_) => self.fresh(Some(id)),
            Value::Neg(_) | Value::Add(..) | Value::Sub(..) | Value::Mul(..) | Value::Square(_) => self.linear(id),
            Value::Div(_, b) if !self.varies(b) => self.linear(id),
            Value::Div(a, b) => self.quotient(id, Some(a), b),
            Value::Recip(b) => self.quotient(id, None, b),
            Value::Sqrt(a) => self.square_root(id, a),
            Value::Call(function, a) => self.call(id, function, a),
            Value::Logistic(a) => self.logistic(id, a),
            Value::Sech(a) => self.hyperbolic_secant(id, a),
            Value::Pow(a, b) => self.power(id, a, b),
            Value::Atan2(y, x) => self.angle(id, y, x),
            Value::Constant(_) | Value::MulAdd(..) | Value::MulSub(..) | Value::NegMulAdd(..) | Value::Mul3(..) => {
                unreachable!("{value:?} does not vary, or is made later")
            }
        }
    }

    fn linear(&mut self, id: Id) -> Row {
        let mut sum = Sum::default();
        self.absorb(&mut sum, id, self.one, true);
        let row = self.fresh(Some(id));
        self.definitions.push((row, sum));
        row
    }

    /// b c = a
    fn quotient(&mut self, id: Id, numerator: Option<Id>, b: Id) -> Row {
        let (mut sum, reciprocal) = (Sum::default(), self.push(Value::Recip(b)));
        if let Some(a) = numerator {
            self.absorb(&mut sum, a, reciprocal, false);
        }
        let minus = self.minus(reciprocal);
        if self.is_line(b) {
            let (slope, row) = (self.rate(b), self.fresh(Some(id)));
            sum.push_late(self.times(minus, slope), row);
            self.definitions.push((row, sum));
            return row;
        }
        let divisor = self.row(b);
        let row = self.fresh(Some(id));
        sum.pairs.push((minus, divisor, row));
        sum.push(self.times(minus, id), divisor);
        self.definitions.push((row, sum));
        row
    }

    /// s² = a
    fn square_root(&mut self, id: Id, a: Id) -> Row {
        let two = self.number(2);
        let double = self.times(two, id);
        let weight = self.push(Value::Recip(double));
        let mut sum = Sum::default();
        self.absorb(&mut sum, a, weight, false);
        let row = self.fresh(Some(id));
        sum.pairs.push((self.minus(weight), row, row));
        self.definitions.push((row, sum));
        row
    }

    fn call(&mut self, id: Id, function: Function, a: Id) -> Row {
        use Function::*;
        if self.integrated.contains_key(&id) {
            return self.fresh(Some(id));
        }
        match function {
            Sin | Cos => self.sine_and_cosine(id, a, (Sin, Cos), true),
            Sinh | Cosh => self.sine_and_cosine(id, a, (Sinh, Cosh), false),
            Tan => self.tangent(id, a, Value::Add),
            Tanh => self.tangent(id, a, Value::Sub),
            Exp => self.exponential(id, a),
            Log => self.integral(id, a, a, self.one),
            Asin | Acos | Atan | Asinh | Acosh | Atanh => {
                let square = self.push(Value::Square(a));
                let (one, minus_one) = (self.one, self.number(-1));
                let radicand = self.push(match function {
                    Asin | Acos | Atanh => Value::Sub(one, square),
                    Acosh => Value::Sub(square, one),
                    _ => Value::Add(one, square),
                });
                let rational = matches!(function, Atan | Atanh);
                let divisor = if rational { radicand } else { self.push(Value::Sqrt(radicand)) };
                let sign = if function == Acos { minus_one } else { one };
                self.integral(id, a, divisor, sign)
            }
        }
    }

    /// e' = a' e, with any value at order 0
    fn exponential(&mut self, id: Id, a: Id) -> Row {
        let argument = self.row(a);
        let slope = self.slope(argument);
        let row = self.fresh(Some(id));
        let sum =
            Sum { terms: vec![Part::of(id, argument)], pairs_over_k: vec![(self.one, slope, row)], ..Sum::default() };
        self.definitions.push((row, sum));
        row
    }

    /// s' = a' c, c' = ∓a' s; the upper sign if it is a circle
    fn sine_and_cosine(&mut self, id: Id, a: Id, (sine, cosine): (Function, Function), circle: bool) -> Row {
        let argument = self.row(a);
        let slope = self.slope(argument);
        let (s, c) = (self.push(Value::Call(sine, a)), self.push(Value::Call(cosine, a)));
        let rows = (self.fresh(Some(s)), self.fresh(Some(c)));
        let (one, minus_one) = (self.one, self.number(-1));
        let (sign, weight) = if circle { (minus_one, self.minus(s)) } else { (one, s) };
        let of_sine =
            Sum { terms: vec![Part::of(c, argument)], pairs_over_k: vec![(one, slope, rows.1)], ..Sum::default() };
        let of_cosine = Sum {
            terms: vec![Part::of(weight, argument)],
            pairs_over_k: vec![(sign, slope, rows.0)],
            ..Sum::default()
        };
        self.definitions.push((rows.0, of_sine));
        self.definitions.push((rows.1, of_cosine));
        if id == s { rows.0 } else { rows.1 }
    }

    /// x' = a' u, u = 1 ± x²
    fn tangent(&mut self, id: Id, a: Id, sign: fn(Id, Id) -> Value) -> Row {
        let argument = self.row(a);
        let slope = self.slope(argument);
        let square = self.push(Value::Square(id));
        let u = self.push(sign(self.one, square));
        let row = self.fresh(Some(id));
        let of_u = match self.rows.get(&u) {
            Some(row) => *row,
            None => self.fresh(Some(u)),
        };
        let sum =
            Sum { terms: vec![Part::of(u, argument)], pairs_over_k: vec![(self.one, slope, of_u)], ..Sum::default() };
        self.definitions.push((row, sum));
        let mut sum = Sum::default();
        self.absorb(&mut sum, u, self.one, true);
        self.definitions.push((of_u, sum));
        row
    }

    /// s' = a' p, p = s σ(−a) = s − s²
    fn logistic(&mut self, id: Id, a: Id) -> Row {
        if self.integrated.contains_key(&id) {
            return self.fresh(Some(id));
        }
        let argument = self.row(a);
        let opposite = self.minus(a);
        let other = self.push(Value::Logistic(opposite));
        let p = self.push(Value::Mul(id, other));
        let square = self.push(Value::Square(id));
        let difference = self.push(Value::Sub(id, square));
        self.with_hidden(id, argument, p, difference, self.one)
    }

    /// y' = −a' p, p = y tanh a
    fn hyperbolic_secant(&mut self, id: Id, a: Id) -> Row {
        if self.integrated.contains_key(&id) {
            return self.fresh(Some(id));
        }
        let argument = self.row(a);
        let tanh = self.push(Value::Call(Function::Tanh, a));
        self.row(tanh);
        let p = self.push(Value::Mul(id, tanh));
        let minus_one = self.number(-1);
        self.with_hidden(id, argument, p, p, minus_one)
    }

    /// x' = sign · a' p for a hidden `p`, whose orders from the first on are those of `moving`.
    fn with_hidden(&mut self, id: Id, argument: Row, p: Id, moving: Id, sign: Id) -> Row {
        let slope = self.slope(argument);
        let row = self.fresh(Some(id));
        let of_p = self.fresh(Some(p));
        let weight = self.times(sign, p);
        let sum =
            Sum { terms: vec![Part::of(weight, argument)], pairs_over_k: vec![(sign, slope, of_p)], ..Sum::default() };
        self.definitions.push((row, sum));
        let mut sum = Sum::default();
        self.absorb(&mut sum, moving, self.one, true);
        self.definitions.push((of_p, sum));
        row
    }

    /// x' d = sign · a'
    fn integral(&mut self, id: Id, a: Id, divisor: Id, sign: Id) -> Row {
        let reciprocal = self.push(Value::Recip(divisor));
        let mut sum = Sum::default();
        let weight = self.times(sign, reciprocal);
        self.absorb(&mut sum, a, weight, false);
        let d = self.row(divisor);
        let row = self.fresh(Some(id));
        let slope = self.slope(row);
        sum.pairs_over_k.push((self.minus(reciprocal), slope, d));
        self.definitions.push((row, sum));
        row
    }

    /// a p' = r a' p for a constant r, else p = exp(r log a)
    fn power(&mut self, id: Id, a: Id, r: Id) -> Row {
        if self.varies(r) {
            let logarithm = self.push(Value::Call(Function::Log, a));
            let product = self.push(Value::Mul(r, logarithm));
            return self.exponential(id, product);
        }
        let base = self.row(a);
        let row = self.fresh(Some(id));
        let reciprocal = self.push(Value::Recip(a));
        let scaled = self.times(r, reciprocal);
        let (of_base, of_power) = (self.slope(base), self.slope(row));
        let sum = Sum {
            terms: vec![Part::of(self.times(scaled, id), base)],
            pairs_over_k: vec![(scaled, of_base, row), (self.minus(reciprocal), of_power, base)],
            ..Sum::default()
        };
        self.definitions.push((row, sum));
        row
    }

    /// θ' (x² + y²) = x y' − y x'
    fn angle(&mut self, id: Id, y: Id, x: Id) -> Row {
        let squares = [x, y].map(|a| self.push(Value::Square(a)));
        let d = self.push(Value::Add(squares[0], squares[1]));
        let reciprocal = self.push(Value::Recip(d));
        let minus = self.minus(reciprocal);
        let divisor = self.row(d);
        let [of_y, of_x] = [y, x].map(|a| if self.varies(a) { Some(self.row(a)) } else { None });
        let row = self.fresh(Some(id));
        let mut sum = Sum::default();
        for (moving, other, factor, weight) in [(of_y, of_x, x, reciprocal), (of_x, of_y, y, minus)] {
            let Some(moving) = moving else { continue };
            sum.push(self.times(weight, factor), moving);
            if let Some(other) = other {
                let slope = self.slope(moving);
                sum.pairs_over_k.push((weight, slope, other));
            }
        }
        let slope = self.slope(row);
        sum.pairs_over_k.push((minus, slope, divisor));
        self.definitions.push((row, sum));
        row
    }
}
