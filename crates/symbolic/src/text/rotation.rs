//! Rotations as products of turns, and their angular velocities.

use crate::text::value::{Scope, Turn, Value};
use crate::{Expr, Function, Graph, Matrix};

impl Graph {
    /// The turns about the axes of `word` one after the other, each about an axis of the body as the turns
    /// before have left it: `rotation(zxz, ψ, θ, φ) = R_z(ψ) R_x(θ) R_z(φ)`, which takes components in the
    /// body to those in space. `None` where a letter is none of `xyz` or the angles are not as many.
    pub(crate) fn rotation(&self, word: &str, angles: &[Expr]) -> Option<Value> {
        let turn = |(letter, &angle): (char, &Expr)| {
            let place = "xyz".find(letter)?;
            let axis = [0, 1, 2].map(|i| if i == place { self.one() } else { self.zero() });
            Some(Turn { axis, angle })
        };
        if word.chars().count() != angles.len() {
            return None;
        }
        word.chars().zip(angles).map(turn).collect::<Option<Vec<_>>>().map(|turns| self.turned(turns))
    }

    /// The turn about `axis`, which is divided by its length unless that is 1 exactly.
    pub(crate) fn rotation_about(&self, axis: &[Expr; 3], angle: Expr) -> Value {
        let square = self.dot(axis, axis);
        let unit = self.vanishes_exactly(self.sub(square, self.one()));
        let length = self.sqrt(square);
        let axis = if unit { *axis } else { axis.map(|a| self.div(a, length)) };
        self.turned(vec![Turn { axis, angle }])
    }

    /// `Rᵀ`; of turns the same ones backwards.
    pub(crate) fn transpose_value(&self, m: &Matrix, turns: &[Turn]) -> Value {
        let back = |turn: &Turn| Turn { angle: self.neg(turn.angle), ..turn.clone() };
        Value::Matrix(m.transpose(), turns.iter().rev().map(back).collect())
    }

    fn turned(&self, turns: Vec<Turn>) -> Value {
        let mut product: Option<Value> = None;
        for turn in &turns {
            let one = Value::Matrix(self.turn_matrix(turn), vec![turn.clone()]);
            product = match &product {
                None => Some(one),
                Some(before) => self.multiply_values(before, &one),
            };
        }
        match product {
            Some(product) => product,
            None => unreachable!("a rotation has a turn"),
        }
    }

    /// `R = cos α I + sin α [n]× + (1 − cos α) n nᵀ`.
    fn turn_matrix(&self, Turn { axis, angle }: &Turn) -> Matrix {
        let (cos, sin) = (self.call(Function::Cos, *angle), self.call(Function::Sin, *angle));
        let rest = self.sub(self.one(), cos);
        Matrix::from_fn(3, 3, |i, j| {
            let along = self.mul(axis[i], axis[j]);
            if i == j {
                // cos α + (1 − cos α) nᵢ², which is 1 along the axis
                return self.add(self.mul(cos, self.sub(self.one(), along)), along);
            }
            let across = self.mul(sin, axis[3 - i - j]);
            let even = (j + 3 - i) % 3 == 2;
            let across = if even { across } else { self.neg(across) };
            self.add(self.mul(rest, along), across)
        })
    }

    /// `ω` with `Ṙ = [ω]× R`, in space: the sum of `R₁…Rₖ₋₁ ωₖ`, of each turn
    /// `ωₖ = α̇ n + sin α ṅ + (1 − cos α) n × ṅ`. In the body `Rᵀ ω`: the sum of `(Rₖ…Rₘ)ᵀ ωₖ`.
    /// `None` where an angle or axis has no rate that could be written.
    pub(crate) fn angular_velocity(&self, turns: &[Turn], in_body: bool, scope: &dyn Scope) -> Option<Vec<Expr>> {
        let mut sum = vec![self.zero(); 3];
        // from the far end inwards, what is there is carried on through each turn
        let order: Vec<&Turn> = if in_body { turns.iter().collect() } else { turns.iter().rev().collect() };
        for turn in order {
            let own = self.turning_rate(turn, scope)?;
            let matrix = self.turn_matrix(turn);
            let add = |a: Vec<Expr>, b: &[Expr]| a.iter().zip(b).map(|(&x, &y)| self.add(x, y)).collect::<Vec<_>>();
            sum = match in_body {
                true => self.transpose_vec(&matrix, &add(sum, &own)),
                false => add(self.mat_vec(&matrix, &sum), &own),
            };
        }
        Some(sum)
    }

    fn turning_rate(&self, Turn { axis, angle }: &Turn, scope: &dyn Scope) -> Option<Vec<Expr>> {
        let rate = scope.rate(*angle)?;
        let axis_rate = axis.iter().map(|&a| scope.rate(a)).collect::<Option<Vec<_>>>()?;
        let sin = self.call(Function::Sin, *angle);
        let rest = self.sub(self.one(), self.call(Function::Cos, *angle));
        let across = self.cross(axis, &axis_rate);
        let entry =
            |i: usize| self.sum(&[self.mul(rate, axis[i]), self.mul(sin, axis_rate[i]), self.mul(rest, across[i])]);
        Some((0..3).map(entry).collect())
    }
}
