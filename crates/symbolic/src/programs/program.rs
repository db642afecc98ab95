//! Straight-line programs, every value computed once: a graph lowered, before registers are given out.

use crate::Function;
use crate::store::number::Number;
use rustc_hash::FxHashMap;

/// Index of a value.
pub(crate) type Id = u32;

#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Value {
    Input(u32),
    Constant(Number),
    Neg(Id),
    Square(Id),
    Recip(Id),
    Sqrt(Id),
    Call(Function, Id),
    /// 1/(1 + exp(−a))
    Logistic(Id),
    /// 1/cosh a
    Sech(Id),
    Add(Id, Id),
    Sub(Id, Id),
    Mul(Id, Id),
    Div(Id, Id),
    Pow(Id, Id),
    Atan2(Id, Id),
    /// a·b + c
    MulAdd(Id, Id, Id),
    /// a·b − c
    MulSub(Id, Id, Id),
    /// c − a·b
    NegMulAdd(Id, Id, Id),
    /// a·b·c
    Mul3(Id, Id, Id),
}

impl Value {
    pub(crate) fn operands(self) -> ([Id; 3], usize) {
        match self {
            Value::Input(_) | Value::Constant(_) => ([0; 3], 0),
            Value::Neg(a)
            | Value::Square(a)
            | Value::Recip(a)
            | Value::Sqrt(a)
            | Value::Call(_, a)
            | Value::Logistic(a)
            | Value::Sech(a) => ([a, 0, 0], 1),
            Value::Add(a, b)
            | Value::Sub(a, b)
            | Value::Mul(a, b)
            | Value::Div(a, b)
            | Value::Pow(a, b)
            | Value::Atan2(a, b) => ([a, b, 0], 2),
            Value::MulAdd(a, b, c) | Value::MulSub(a, b, c) | Value::NegMulAdd(a, b, c) | Value::Mul3(a, b, c) => {
                ([a, b, c], 3)
            }
        }
    }
}

/// Values in an order in which operands come first; equal values are the same.
#[derive(Default)]
pub(crate) struct Program {
    values: Vec<Value>,
    /// Does the value need no input?
    constant: Vec<bool>,
    ids: FxHashMap<Value, Id>,
}

impl Program {
    pub(crate) fn value(&self, id: Id) -> Value {
        self.values[id as usize]
    }

    pub(crate) fn len(&self) -> usize {
        self.values.len()
    }

    /// Reserves memory for `count` more values.
    pub(crate) fn reserve(&mut self, count: usize) {
        self.values.reserve(count);
        self.constant.reserve(count);
        self.ids.reserve(count);
    }

    pub(crate) fn is_constant(&self, id: Id) -> bool {
        self.constant[id as usize]
    }

    pub(crate) fn push(&mut self, value: Value) -> Id {
        let value = match value {
            Value::Add(a, b) if b < a => Value::Add(b, a),
            Value::Mul(a, b) if b < a => Value::Mul(b, a),
            other => other,
        };
        if let Some(&id) = self.ids.get(&value) {
            return id;
        }
        let id = Id::try_from(self.values.len()).expect("fewer than 2^32 values");
        let (operands, count) = value.operands();
        let constant =
            !matches!(value, Value::Input(_)) && operands[..count].iter().all(|o| self.constant[*o as usize]);
        self.values.push(value);
        self.constant.push(constant);
        self.ids.insert(value, id);
        id
    }

    pub(crate) fn constant(&mut self, n: Number) -> Id {
        self.push(Value::Constant(n))
    }

    /// vⁿ for n ≥ 1 by repeated squaring
    pub(crate) fn powi(&mut self, v: Id, n: u64) -> Id {
        if n == 1 {
            return v;
        }
        let half = self.powi(v, n / 2);
        let square = self.push(Value::Square(half));
        if n.is_multiple_of(2) { square } else { self.push(Value::Mul(square, v)) }
    }

    /// Puts products that are used once into the sum or product that uses them.
    pub(crate) fn fuse(&mut self, outputs: &[Id]) {
        let mut uses = vec![0_u32; self.values.len()];
        for value in &self.values {
            let (operands, count) = value.operands();
            for o in &operands[..count] {
                uses[*o as usize] += 1;
            }
        }
        for o in outputs {
            uses[*o as usize] += 2;
        }
        for i in 0..self.values.len() {
            let single = |id: Id| match self.values[id as usize] {
                Value::Mul(a, b) if uses[id as usize] == 1 && !self.constant[id as usize] => Some((a, b)),
                Value::Square(a) if uses[id as usize] == 1 && !self.constant[id as usize] => Some((a, a)),
                _ => None,
            };
            let fused = match self.values[i] {
                Value::Add(a, b) => match (single(b), single(a)) {
                    (Some((x, y)), _) => Value::MulAdd(x, y, a),
                    (None, Some((x, y))) => Value::MulAdd(x, y, b),
                    _ => continue,
                },
                Value::Sub(a, b) => match (single(b), single(a)) {
                    (Some((x, y)), _) => Value::NegMulAdd(x, y, a),
                    (None, Some((x, y))) => Value::MulSub(x, y, b),
                    _ => continue,
                },
                Value::Mul(a, b) => match (single(a), single(b)) {
                    (Some((x, y)), _) => Value::Mul3(x, y, b),
                    (None, Some((x, y))) => Value::Mul3(x, y, a),
                    _ => continue,
                },
                _ => continue,
            };
            if !self.constant[i] {
                self.values[i] = fused;
            }
        }
    }
}
