//! From a straight-line program to a [`SeriesTape`].

mod ahead;
mod assemble;
mod decide;
mod functions;
mod motion;

use std::collections::BTreeMap;

use ahead::{STEADY, Stage};
use motion::Motion;

use super::{Row, SeriesInput, SeriesTape};
use crate::programs::program::{Id, Program, Value};
use crate::store::number::{Number, Rational};
use rustc_hash::{FxHashMap, FxHashSet};

/// The tape for `outputs`: rates, then residuals of blocks, with the lengths `blocks`. `derivatives`: values
/// with what they are the time derivatives of.
pub(crate) fn build(
    program: Program,
    inputs: &[SeriesInput],
    outputs: &[Id],
    own_outputs: usize,
    blocks: &[usize],
    derivatives: impl Iterator<Item = (Id, Id)>,
) -> SeriesTape {
    let steady = |input: &SeriesInput| match *input {
        SeriesInput::State(rate) => {
            matches!(program.value(outputs[rate]), Value::Constant(n) if n.is_zero())
        }
        other => other == SeriesInput::Steady,
    };
    let inputs: Vec<SeriesInput> = inputs.iter().map(|i| if steady(i) { SeriesInput::Steady } else { *i }).collect();
    let mut builder = Builder::new(program, &inputs, outputs);
    builder.declare(derivatives);
    builder.decide();
    for id in 0..builder.decisions.len() {
        if builder.decisions[id] == Decision::Row {
            builder.row(id as Id);
        }
    }
    builder.finish(own_outputs, blocks)
}

/// What becomes of a value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Decision {
    /// Constant in time, or not needed.
    None,
    /// It has a series of its own.
    Row,
    /// Its terms go into the one sum that uses it.
    Absorbed,
    /// A multiple of a value; what uses it takes over the factor.
    Peeled,
}

/// `weight · row` of the same order or, `late`, `weight · τ · row` of the order before; the weight: order 0.
#[derive(Clone, Copy)]
struct Part {
    weight: Id,
    row: Row,
    late: bool,
}

impl Part {
    fn of(weight: Id, row: Row) -> Part {
        Part { weight, row, late: false }
    }
}

/// Terms of a series; weights are values of order 0.
#[derive(Default)]
struct Sum {
    terms: Vec<Part>,
    pairs: Vec<(Id, Row, Row)>,
    pairs_over_k: Vec<(Id, Row, Row)>,
}

/// A function of states whose rate is `factor · rate`, the factor constant in time.
#[derive(Clone, Copy)]
struct Integrated {
    factor: Id,
    rate: Id,
}

struct Builder<'i> {
    program: Program,
    inputs: &'i [SeriesInput],
    outputs: &'i [Id],
    /// How values move, as far as that is known.
    motions: Vec<Motion>,
    /// Functions that are integrated.
    integrated: BTreeMap<Id, Integrated>,
    /// Time derivatives, with what they are the derivatives of.
    derivatives: FxHashMap<Id, Id>,
    /// States and integrated functions that are computed one order ahead.
    ahead: FxHashSet<Id>,
    stages: Vec<Stage>,
    decisions: Vec<Decision>,
    rows: FxHashMap<Id, Row>,
    /// The value of each row; `None` for slopes, which are 0 at order 0.
    of_row: Vec<Option<Id>>,
    slopes: FxHashMap<Row, Row>,
    /// The slopes in the order in which they were asked for.
    slope_list: Vec<(Row, Row)>,
    definitions: Vec<(Row, Sum)>,
    one: Id,
}

impl<'i> Builder<'i> {
    fn new(mut program: Program, inputs: &'i [SeriesInput], outputs: &'i [Id]) -> Self {
        let one = program.constant(Number::ONE);
        let mut builder = Builder {
            program,
            inputs,
            outputs,
            motions: Vec::new(),
            integrated: BTreeMap::new(),
            derivatives: FxHashMap::default(),
            ahead: FxHashSet::default(),
            stages: Vec::new(),
            decisions: Vec::new(),
            rows: FxHashMap::default(),
            of_row: Vec::new(),
            slopes: FxHashMap::default(),
            slope_list: Vec::new(),
            definitions: Vec::new(),
            one,
        };
        builder.extend_stages();
        builder.extend_motions();
        builder
    }

    fn push(&mut self, value: Value) -> Id {
        let id = self.program.push(value);
        self.extend_stages();
        self.extend_motions();
        id
    }

    fn varies(&self, id: Id) -> bool {
        self.stages[id as usize] > STEADY
    }

    /// The factor and the value, if `id` is a multiple of a value that varies.
    fn multiple(&self, id: Id) -> Option<(Multiple, Id)> {
        match self.program.value(id) {
            Value::Neg(a) => Some((Multiple::Minus, a)),
            Value::Mul(a, b) if !self.varies(a) => Some((Multiple::By(a), b)),
            Value::Mul(a, b) if !self.varies(b) => Some((Multiple::By(b), a)),
            Value::Div(a, b) if !self.varies(b) => Some((Multiple::Over(b), a)),
            _ => None,
        }
    }

    /// The series of a value that varies.
    fn row(&mut self, id: Id) -> Row {
        match self.rows.get(&id) {
            Some(row) => *row,
            None => self.define(id),
        }
    }

    fn fresh(&mut self, of: Option<Id>) -> Row {
        let row = Row::try_from(self.of_row.len()).expect("fewer than 2^32 series");
        self.of_row.push(of);
        if let Some(id) = of {
            self.rows.insert(id, row);
        }
        row
    }

    /// τ x'
    fn slope(&mut self, of: Row) -> Row {
        if let Some(row) = self.slopes.get(&of) {
            return *row;
        }
        let row = self.fresh(None);
        self.slopes.insert(of, row);
        self.slope_list.push((row, of));
        row
    }

    fn times(&mut self, a: Id, b: Id) -> Id {
        if a == self.one {
            b
        } else if b == self.one {
            a
        } else {
            self.push(Value::Mul(a, b))
        }
    }

    fn minus(&mut self, a: Id) -> Id {
        match self.program.value(a) {
            Value::Neg(b) => b,
            Value::Constant(n) => self.push(Value::Constant(n.neg())),
            _ => self.push(Value::Neg(a)),
        }
    }

    fn scaled(&mut self, weight: Id, by: Multiple) -> Id {
        match by {
            Multiple::Minus => self.minus(weight),
            Multiple::By(a) => self.times(weight, a),
            Multiple::Over(a) => self.push(Value::Div(weight, a)),
        }
    }

    fn number(&mut self, n: i64) -> Id {
        self.push(Value::Constant(Number::Exact(Rational::integer(n))))
    }

    /// Hidden values are used once, by what they are made for.
    fn is_absorbed(&self, id: Id) -> bool {
        match self.decisions.get(id as usize) {
            Some(Decision::Absorbed) => true,
            Some(Decision::Row | Decision::Peeled) => false,
            Some(Decision::None) | None => {
                let sum = matches!(
                    self.program.value(id),
                    Value::Add(..) | Value::Sub(..) | Value::Mul(..) | Value::Square(_) | Value::Neg(_)
                );
                sum && !self.rows.contains_key(&id)
            }
        }
    }

    /// `weight · id` into the sum: what `id` is made of, if it is `whole` or nobody else uses it.
    fn absorb(&mut self, sum: &mut Sum, id: Id, weight: Id, whole: bool) {
        let mut stack = vec![(id, weight, whole)];
        while let Some((id, weight, whole)) = stack.pop() {
            if !self.varies(id) {
                continue;
            }
            if !whole && !self.is_absorbed(id) {
                let (id, weight) = self.peel(id, weight);
                let row = self.row(id);
                sum.push(weight, row);
                continue;
            }
            if let Some((factor, a)) = self.multiple(id) {
                let weight = self.scaled(weight, factor);
                stack.push((a, weight, false));
                continue;
            }
            match self.program.value(id) {
                Value::Add(a, b) => stack.extend([(b, weight, false), (a, weight, false)]),
                Value::Sub(a, b) => {
                    let minus = self.minus(weight);
                    stack.extend([(b, minus, false), (a, weight, false)]);
                }
                Value::Mul(a, b) => self.product(sum, a, b, weight),
                Value::Square(a) => self.product(sum, a, a, weight),
                other => unreachable!("{other:?} is not a sum of products"),
            }
        }
    }

    /// `weight · a · b` into the sum; both vary. A factor linear in time: `(a b)_k = a₀ b_k + a₁ b_{k−1}`.
    fn product(&mut self, sum: &mut Sum, a: Id, b: Id, weight: Id) {
        let ((a, weight), square) = (self.peel(a, weight), a == b);
        let (b, weight) = self.peel(b, weight);
        let (a, b) = if self.is_line(b) && !self.is_line(a) { (b, a) } else { (a, b) };
        let other = self.row(b);
        if self.is_line(a) {
            let slope = self.rate(a);
            sum.push(self.times(weight, a), other);
            sum.push_late(self.times(weight, slope), other);
            return;
        }
        let row = self.row(a);
        sum.pairs.push((weight, row, other));
        if square {
            let two = self.number(2);
            let double = self.times(weight, two);
            sum.push(self.times(double, a), row);
        } else {
            sum.push(self.times(weight, b), row);
            sum.push(self.times(weight, a), other);
        }
    }

    /// Takes constant factors out of a value that has no series of its own.
    fn peel(&mut self, mut id: Id, mut weight: Id) -> (Id, Id) {
        while self.decisions.get(id as usize) == Some(&Decision::Peeled)
            && let Some((factor, a)) = self.multiple(id)
        {
            weight = self.scaled(weight, factor);
            id = a;
        }
        (id, weight)
    }
}

impl Sum {
    fn push(&mut self, weight: Id, row: Row) {
        self.terms.push(Part::of(weight, row));
    }

    fn push_late(&mut self, weight: Id, row: Row) {
        self.terms.push(Part { weight, row, late: true });
    }
}

/// A factor that is constant in time.
#[derive(Clone, Copy)]
enum Multiple {
    Minus,
    By(Id),
    Over(Id),
}
