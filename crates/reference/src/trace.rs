//! What an evaluation of a tape did, operation by operation: recorded by a number type that computes nothing.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use symbolic::{Function, Scalar};

/// A value in a trace: the number of the operation that makes it.
pub(crate) type Node = u32;

/// How the first coefficient of an [`Operation::Integral`] is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Value {
    Function(Function),
    /// First argument to the power of the second.
    Power,
    /// Angle of the point (second, first).
    Angle,
}

/// One operation on series in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Operation {
    Input(u32),
    /// Bits of an `f64`.
    Float(u64),
    Ratio(i64, i64),
    Neg(Node),
    Add(Node, Node),
    Sub(Node, Node),
    Mul(Node, Node),
    Div(Node, Node),
    Sqrt(Node),
    /// `value(a, b)`, whose derivative in time is `weights[0] ȧ + weights[1] ḃ`. A weight may be a later operation, or this one itself: of weights
    /// one order less is needed. An absent second argument is the first one again, with [`ABSENT`] for its weight.
    Integral {
        value: Value,
        arguments: [Node; 2],
        weights: [Node; 2],
    },
}

/// No weight.
pub(crate) const ABSENT: Node = Node::MAX;

#[derive(Default)]
struct Recorder {
    operations: Vec<Operation>,
    known: HashMap<Operation, Node>,
}

thread_local! {
    // `Scalar` makes numbers out of nothing (`from_f64`), so what is recorded has to be found without a handle
    static RECORDER: RefCell<Recorder> = RefCell::default();
}

/// Records what `work` does with [`Traced`] numbers: operations in the order of their operands, and what `work` returns.
pub(crate) fn record<R>(work: impl FnOnce() -> R) -> (Vec<Operation>, R) {
    let outer = RECORDER.take();
    let result = work();
    (RECORDER.replace(outer).operations, result)
}

/// A number that stands for an operation of the trace under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Traced(pub(crate) Node);

fn append(operation: Operation) -> Node {
    RECORDER.with_borrow_mut(|recorder| {
        let node = Node::try_from(recorder.operations.len()).expect("fewer than 2^32 operations");
        recorder.operations.push(operation);
        node
    })
}

/// The node of an operation, which is recorded once.
fn push(operation: Operation) -> Traced {
    if let Some(&node) = RECORDER.with_borrow(|recorder| recorder.known.get(&operation).copied()).as_ref() {
        return Traced(node);
    }
    let node = append(operation);
    RECORDER.with_borrow_mut(|recorder| recorder.known.insert(operation, node));
    Traced(node)
}

/// `value(a, b)` with weights that `weights` makes from the result; its second entry is for `b`.
fn integral(value: Value, a: Traced, b: Option<Traced>, weights: impl FnOnce(Traced) -> [Traced; 2]) -> Traced {
    let arguments = [a.0, b.unwrap_or(a).0];
    let key = Operation::Integral { value, arguments, weights: [ABSENT; 2] };
    if let Some(&node) = RECORDER.with_borrow(|recorder| recorder.known.get(&key).copied()).as_ref() {
        return Traced(node);
    }
    let node = append(key);
    RECORDER.with_borrow_mut(|recorder| recorder.known.insert(key, node));
    let [first, second] = weights(Traced(node));
    let weights = [first.0, if b.is_some() { second.0 } else { ABSENT }];
    RECORDER.with_borrow_mut(|recorder| {
        recorder.operations[node as usize] = Operation::Integral { value, arguments, weights };
    });
    Traced(node)
}

impl Traced {
    pub(crate) fn input(place: usize) -> Self {
        push(Operation::Input(u32::try_from(place).expect("fewer than 2^32 inputs")))
    }

    fn one() -> Self {
        Self::from_f64(1.0)
    }

    fn function(self, function: Function, weight: impl FnOnce(Self) -> Self) -> Self {
        integral(Value::Function(function), self, None, |value| [weight(value); 2])
    }

    /// Two functions with `ȧ = b ẋ`, `ḃ = back(a) ẋ`.
    fn pair(self, functions: [Function; 2], back: impl Fn(Self) -> Self) -> [Self; 2] {
        let second = |first| self.function(functions[1], |_| back(first));
        let first = self.function(functions[0], second);
        [first, second(first)]
    }
}

impl Add for Traced {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        push(Operation::Add(self.0, other.0))
    }
}

impl Sub for Traced {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        push(Operation::Sub(self.0, other.0))
    }
}

impl Mul for Traced {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        push(Operation::Mul(self.0, other.0))
    }
}

impl Div for Traced {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        push(Operation::Div(self.0, other.0))
    }
}

impl Neg for Traced {
    type Output = Self;
    fn neg(self) -> Self {
        push(Operation::Neg(self.0))
    }
}

impl Scalar for Traced {
    fn from_f64(x: f64) -> Self {
        push(Operation::Float(x.to_bits()))
    }
    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        push(Operation::Ratio(numerator, denominator))
    }
    fn sqrt(self) -> Self {
        push(Operation::Sqrt(self.0))
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    fn sin_cos(self) -> (Self, Self) {
        let [sine, cosine] = self.pair([Function::Sin, Function::Cos], |sine| -sine);
        (sine, cosine)
    }
    fn tan(self) -> Self {
        self.function(Function::Tan, |tangent| Self::one() + tangent * tangent)
    }
    fn sinh(self) -> Self {
        self.pair([Function::Sinh, Function::Cosh], |sine| sine)[0]
    }
    fn cosh(self) -> Self {
        self.pair([Function::Sinh, Function::Cosh], |sine| sine)[1]
    }
    fn tanh(self) -> Self {
        self.function(Function::Tanh, |tangent| Self::one() - tangent * tangent)
    }
    fn asin(self) -> Self {
        self.function(Function::Asin, |_| Self::one() / (Self::one() - self * self).sqrt())
    }
    fn acos(self) -> Self {
        self.function(Function::Acos, |_| -(Self::one() / (Self::one() - self * self).sqrt()))
    }
    fn atan(self) -> Self {
        self.function(Function::Atan, |_| Self::one() / (Self::one() + self * self))
    }
    fn asinh(self) -> Self {
        self.function(Function::Asinh, |_| Self::one() / (Self::one() + self * self).sqrt())
    }
    fn acosh(self) -> Self {
        self.function(Function::Acosh, |_| Self::one() / (self * self - Self::one()).sqrt())
    }
    fn atanh(self) -> Self {
        self.function(Function::Atanh, |_| Self::one() / (Self::one() - self * self))
    }
    fn exp(self) -> Self {
        self.function(Function::Exp, |power| power)
    }
    fn log(self) -> Self {
        self.function(Function::Log, |_| Self::one() / self)
    }
    fn powf(self, exponent: Self) -> Self {
        // d(aᵇ) = b aᵇ/a da + aᵇ log a db
        integral(Value::Power, self, Some(exponent), |power| [exponent * (power / self), power * self.log()])
    }
    fn atan2(self, x: Self) -> Self {
        let square = x * x + self * self;
        integral(Value::Angle, self, Some(x), |_| [x / square, -(self / square)])
    }
}
