//! Vectors, matrices and rotations in formulas.

use crate::limits::LONG;
use crate::store::arena::Node;
use crate::{Expr, Graph, Matrix};

/// A turn about a unit vector `n` by an angle `α`.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// `n`, in the axes that are turned.
    pub axis: [Expr; 3],
    /// `α`.
    pub angle: Expr,
}

/// What a formula stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Scalar(Expr),
    /// Two or more numbers.
    Vector(Vec<Expr>),
    /// Rows of numbers; with the turns that it is the product of, if it was written as rotations.
    Matrix(Matrix, Vec<Turn>),
}

/// What names stand for where a formula is read.
pub trait Scope {
    /// What `name`, with its primes, stands for.
    fn value(&self, name: &str) -> Option<Value>;

    /// `de/dt`, where it can be written: with velocities, without accelerations.
    fn rate(&self, _: Expr) -> Option<Expr> {
        None
    }

    /// Names that may have been meant by one that stands for nothing.
    fn known(&self) -> &[String] {
        &[]
    }
}

/// Names that stand for numbers.
impl<F: Fn(&str) -> Option<Expr>> Scope for F {
    fn value(&self, name: &str) -> Option<Value> {
        self(name).map(Value::Scalar)
    }
}

/// The names of its symbols.
impl Scope for Graph {
    fn value(&self, name: &str) -> Option<Value> {
        self.find_symbol(name).map(|symbol| Value::Scalar(self.variable(symbol)))
    }
}

impl Value {
    /// How it is called in messages.
    pub fn shape(&self) -> String {
        match self {
            Value::Scalar(_) => "a number".into(),
            Value::Vector(v) => format!("a vector of {}", v.len()),
            Value::Matrix(m, _) => format!("a matrix of {} by {}", m.rows(), m.columns()),
        }
    }

    /// The number, if it is one.
    pub fn scalar(&self) -> Option<Expr> {
        match self {
            Value::Scalar(e) => Some(*e),
            _ => None,
        }
    }

    /// All its numbers, those of a matrix row by row.
    pub fn entries(&self) -> &[Expr] {
        match self {
            Value::Scalar(e) => std::slice::from_ref(e),
            Value::Vector(v) => v,
            Value::Matrix(m, _) => m.entries(),
        }
    }

    /// The same shape with other numbers, in the order of [`Value::entries`].
    pub fn with(&self, entries: Vec<Expr>) -> Value {
        match self {
            Value::Scalar(_) => Value::Scalar(entries[0]),
            Value::Vector(_) => Value::Vector(entries),
            Value::Matrix(m, _) => Value::Matrix(Matrix::new(m.rows(), m.columns(), entries), Vec::new()),
        }
    }

    /// `[a, b, …]`: of numbers a vector, of vectors a matrix with these rows.
    pub(crate) fn list(items: Vec<Value>) -> Option<Value> {
        if items.len() < 2 {
            return None;
        }
        if let Some(numbers) = items.iter().map(Value::scalar).collect() {
            return Some(Value::Vector(numbers));
        }
        let row = |item: &Value| if let Value::Vector(v) = item { Some(v.clone()) } else { None };
        let rows: Vec<Vec<Expr>> = items.iter().map(row).collect::<Option<_>>()?;
        let columns = rows[0].len();
        let equal = rows.iter().all(|r| r.len() == columns);
        equal.then(|| Value::Matrix(Matrix::new(rows.len(), columns, rows.concat()), Vec::new()))
    }

    /// The component `x`, `y` or `z` of a vector, `xx` to `zz` of a matrix.
    pub(crate) fn component(&self, name: &str) -> Option<Expr> {
        let place = |c: char| "xyz".find(c);
        match (self, &name.chars().map(place).collect::<Option<Vec<_>>>()?[..]) {
            (Value::Vector(v), [i]) => v.get(*i).copied(),
            (Value::Matrix(m, _), [i, j]) => (*i < m.rows() && *j < m.columns()).then(|| m[(*i, *j)]),
            _ => None,
        }
    }
}

impl Graph {
    /// `a + b`, entry by entry; `None` where the shapes differ.
    pub(crate) fn add_values(&self, a: &Value, b: &Value) -> Option<Value> {
        let same = match (a, b) {
            (Value::Matrix(m, _), Value::Matrix(n, _)) => (m.rows(), m.columns()) == (n.rows(), n.columns()),
            _ => std::mem::discriminant(a) == std::mem::discriminant(b) && a.entries().len() == b.entries().len(),
        };
        let short = |e| if a.scalar().is_some() { e } else { self.short(e) };
        same.then(|| a.with(a.entries().iter().zip(b.entries()).map(|(&x, &y)| short(self.add(x, y))).collect()))
    }

    /// `s a`.
    pub(crate) fn scale_value(&self, s: Expr, a: &Value) -> Value {
        a.with(a.entries().iter().map(|&x| self.mul(s, x)).collect())
    }

    /// `a b`, of matrices and vectors as usual; `None` where that means nothing.
    pub(crate) fn multiply_values(&self, a: &Value, b: &Value) -> Option<Value> {
        match (a, b) {
            (Value::Scalar(s), other) | (other, Value::Scalar(s)) => Some(self.scale_value(*s, other)),
            (Value::Matrix(m, _), Value::Vector(v)) => {
                let product = || self.mat_vec(m, v).into_iter().map(|e| self.short(e)).collect();
                (m.columns() == v.len()).then(|| Value::Vector(product()))
            }
            (Value::Matrix(m, first), Value::Matrix(n, second)) => (m.columns() == n.rows()).then(|| {
                let columns: Vec<Vec<Expr>> = (0..n.columns()).map(|j| n.column(j)).collect();
                let product =
                    Matrix::from_fn(m.rows(), n.columns(), |i, j| self.short(self.dot(m.row(i), &columns[j])));
                let both = !first.is_empty() && !second.is_empty();
                Value::Matrix(product, if both { [&first[..], second].concat() } else { Vec::new() })
            }),
            _ => None,
        }
    }

    /// `a × b` of three numbers each.
    pub(crate) fn cross(&self, a: &[Expr], b: &[Expr]) -> Vec<Expr> {
        let entry = |i: usize, j: usize| self.short(self.sub(self.mul(a[i], b[j]), self.mul(a[j], b[i])));
        vec![entry(1, 2), entry(2, 0), entry(0, 1)]
    }

    /// A sum, multiplied out where that is shorter: what turns and turns back cancels.
    fn short(&self, e: Expr) -> Expr {
        let is_sum = matches!(self.arena.borrow().node(e), Node::Sum(_, terms) if terms.len() > 1);
        if is_sum { self.expand_if_shorter(e, LONG) } else { e }
    }
}
