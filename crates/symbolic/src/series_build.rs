//! From a straight-line program to a [`SeriesTape`].

use crate::Function;
use crate::number::{Number, Rational};
use crate::program::{Id, Program, Value};
use crate::series::{Bilinear, Definition, Implicit, Row, SeriesInput, SeriesTape, Slot, Source};
use crate::tape::Tape;
use rustc_hash::FxHashMap;

/// The tape for `outputs`, of which those behind the rates are residuals of blocks, `blocks` a length each.
pub(crate) fn build(
    program: Program,
    inputs: &[SeriesInput],
    outputs: &[Id],
    own_outputs: usize,
    blocks: &[usize],
) -> SeriesTape {
    let steady = |input: &SeriesInput| match *input {
        SeriesInput::State(rate) => {
            matches!(program.value(outputs[rate]), Value::Constant(n) if n.is_zero())
        }
        other => other == SeriesInput::Steady,
    };
    let inputs: Vec<SeriesInput> = inputs.iter().map(|i| if steady(i) { SeriesInput::Steady } else { *i }).collect();
    let mut builder = Builder::new(program, &inputs);
    builder.decide(outputs);
    for id in 0..builder.decisions.len() {
        if builder.decisions[id] == Decision::Row {
            builder.row(id as Id);
        }
    }
    builder.finish(&inputs, outputs, own_outputs, blocks)
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
    /// A multiple of a value, of which the products that use it take the factor.
    Peeled,
}

/// Terms of a series; weights are values of order 0.
#[derive(Default)]
struct Sum {
    terms: Vec<(Id, Row)>,
    pairs: Vec<(Id, Row, Row)>,
    pairs_over_k: Vec<(Id, Row, Row)>,
}

struct Builder<'i> {
    program: Program,
    inputs: &'i [SeriesInput],
    /// 0: constant in time; else 1 + number of the block on whose unknowns the value depends last, counted from 1.
    stages: Vec<usize>,
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
    fn new(mut program: Program, inputs: &'i [SeriesInput]) -> Self {
        let one = program.constant(Number::ONE);
        let mut builder = Builder {
            program,
            inputs,
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
        builder
    }

    fn extend_stages(&mut self) {
        for id in self.stages.len()..self.program.len() {
            let value = self.program.value(id as Id);
            let stage = match value {
                Value::Input(i) => match self.inputs[i as usize] {
                    SeriesInput::Steady => 0,
                    SeriesInput::Time | SeriesInput::State(_) => 1,
                    SeriesInput::Unknown(block) => 2 + block,
                },
                _ => {
                    let (operands, count) = value.operands();
                    operands[..count].iter().map(|o| self.stages[*o as usize]).max().unwrap_or(0)
                }
            };
            self.stages.push(stage);
        }
    }

    fn push(&mut self, value: Value) -> Id {
        let id = self.program.push(value);
        self.extend_stages();
        id
    }

    fn varies(&self, id: Id) -> bool {
        self.stages[id as usize] > 0
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

    /// Decides from the last value to the first, so that all users of a value come before it.
    fn decide(&mut self, outputs: &[Id]) {
        let n = self.program.len();
        let (mut linear, mut factor) = (vec![0_usize; n], vec![0_usize; n]);
        self.decisions = vec![Decision::None; n];
        for o in outputs {
            linear[*o as usize] += 2;
        }
        for id in (0..n).rev() {
            let (terms, factors) = (linear[id], factor[id]);
            if terms + factors == 0 || !self.varies(id as Id) {
                continue;
            }
            let value = self.program.value(id as Id);
            let multiple = self.multiple(id as Id);
            let bilinear = multiple.is_some()
                || matches!(value, Value::Add(..) | Value::Sub(..) | Value::Mul(..) | Value::Square(_));
            self.decisions[id] = if bilinear && terms == 1 && factors == 0 {
                Decision::Absorbed
            } else if multiple.is_some() && terms == 0 {
                Decision::Peeled
            } else {
                Decision::Row
            };
            if let Some((_, a)) = multiple {
                match self.decisions[id] {
                    Decision::Peeled => factor[a as usize] += factors,
                    _ => linear[a as usize] += 1,
                }
                continue;
            }
            match value {
                Value::Add(a, b) | Value::Sub(a, b) => {
                    linear[a as usize] += 1;
                    linear[b as usize] += 1;
                }
                Value::Div(a, b) => {
                    linear[a as usize] += 1;
                    factor[b as usize] += 1;
                }
                _ => {
                    let (operands, count) = value.operands();
                    for o in &operands[..count] {
                        factor[*o as usize] += 1;
                    }
                }
            }
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
                let row = self.row(id);
                sum.terms.push((weight, row));
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
                other => unreachable!("{other:?} is no sum of products"),
            }
        }
    }

    /// `weight · a · b` into the sum; both vary.
    fn product(&mut self, sum: &mut Sum, a: Id, b: Id, weight: Id) {
        let ((a, weight), square) = (self.peel(a, weight), a == b);
        let (b, weight) = self.peel(b, weight);
        let rows = (self.row(a), self.row(b));
        sum.pairs.push((weight, rows.0, rows.1));
        if square {
            let two = self.number(2);
            let double = self.times(weight, two);
            sum.terms.push((self.times(double, a), rows.0));
        } else {
            sum.terms.push((self.times(weight, b), rows.0));
            sum.terms.push((self.times(weight, a), rows.1));
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

    fn define(&mut self, id: Id) -> Row {
        let value = self.program.value(id);
        match value {
            Value::Input(_) => self.fresh(Some(id)),
            Value::Neg(_) | Value::Add(..) | Value::Sub(..) | Value::Mul(..) | Value::Square(_) => self.linear(id),
            Value::Div(_, b) if !self.varies(b) => self.linear(id),
            Value::Div(a, b) => self.quotient(id, Some(a), b),
            Value::Recip(b) => self.quotient(id, None, b),
            Value::Sqrt(a) => self.square_root(id, a),
            Value::Call(function, a) => self.call(id, function, a),
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
        let divisor = self.row(b);
        let row = self.fresh(Some(id));
        let minus = self.minus(reciprocal);
        sum.pairs.push((minus, divisor, row));
        sum.terms.push((self.times(minus, id), divisor));
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
        let sum = Sum { terms: vec![(id, argument)], pairs_over_k: vec![(self.one, slope, row)], ..Sum::default() };
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
        let of_sine = Sum { terms: vec![(c, argument)], pairs_over_k: vec![(one, slope, rows.1)], ..Sum::default() };
        let of_cosine =
            Sum { terms: vec![(weight, argument)], pairs_over_k: vec![(sign, slope, rows.0)], ..Sum::default() };
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
        let sum = Sum { terms: vec![(u, argument)], pairs_over_k: vec![(self.one, slope, of_u)], ..Sum::default() };
        self.definitions.push((row, sum));
        let mut sum = Sum::default();
        self.absorb(&mut sum, u, self.one, true);
        self.definitions.push((of_u, sum));
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
            terms: vec![(self.times(scaled, id), base)],
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
            sum.terms.push((self.times(weight, factor), moving));
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

    fn finish(mut self, inputs: &[SeriesInput], outputs: &[Id], own_outputs: usize, blocks: &[usize]) -> SeriesTape {
        let input_ids: Vec<Id> = (0..inputs.len()).map(|i| self.push(Value::Input(i as u32))).collect();
        let input_rows: Vec<Option<Row>> =
            input_ids.iter().map(|id| if self.varies(*id) { Some(self.row(*id)) } else { None }).collect();
        let of_outputs: Vec<Option<Row>> =
            outputs.iter().map(|id| if self.varies(*id) { Some(self.row(*id)) } else { None }).collect();

        // By stage; within one as they were made, operands first.
        let mut definitions = std::mem::take(&mut self.definitions);
        let stage = |row: Row| self.of_row[row as usize].map_or(1, |id| self.stages[id as usize]);
        definitions.sort_by_key(|(row, _)| stage(*row));
        let stages = (0..=blocks.len()).map(|b| definitions.partition_point(|(row, _)| stage(*row) <= 1 + b)).collect();

        let none = self.fresh(None);
        let mut totals: Vec<Row> = Vec::new();
        for (_, sum) in &mut definitions {
            let bare = sum.pairs.is_empty() && sum.pairs_over_k.is_empty();
            totals.push(if bare { none } else { self.fresh(None) });
            let terms = std::mem::take(&mut sum.terms);
            sum.terms = self.merged(terms);
        }
        let zero = self.push(Value::Constant(Number::ZERO));
        let mut first: Vec<Id> = self.of_row.iter().map(|id| id.unwrap_or(zero)).collect();
        let mut slots: FxHashMap<Id, Slot> = FxHashMap::default();
        let mut slot = |id: Id| {
            *slots.entry(id).or_insert_with(|| {
                first.push(id);
                Slot::try_from(first.len() - 1).expect("fewer than 2^32 values")
            })
        };
        let mut products = [Vec::new(), Vec::new()];
        let (mut terms, mut ends) = (Vec::new(), Vec::new());
        for ((row, sum), total) in definitions.iter().zip(&totals) {
            terms.extend(sum.terms.iter().map(|(weight, operand)| (slot(*weight), *operand)));
            ends.push(Definition { row: *row, products: *total, end: terms.len() });
            for (list, pairs) in products.iter_mut().zip([&sum.pairs, &sum.pairs_over_k]) {
                list.extend(pairs.iter().enumerate().map(|(i, (scale, left, right))| {
                    (i, Bilinear { scale: slot(*scale), target: *total, left: *left, right: *right })
                }));
            }
        }
        // The first pair of every sum, then the second …: neighbours have different targets and do not wait for each other.
        let products = products.map(|mut list| {
            list.sort_by_key(|(i, _)| *i);
            list.into_iter().map(|(_, product)| product).collect()
        });
        let sources: Vec<Source> = outputs
            .iter()
            .zip(&of_outputs)
            .map(|(id, row)| row.map_or_else(|| Source::Steady(slot(*id)), Source::Row))
            .collect();
        let rows = self.of_row.len();
        self.program.fuse(&first);
        let mut states = Vec::new();
        let mut time = None;
        let mut implicit: Vec<Implicit> = Vec::new();
        let mut next = own_outputs;
        for size in blocks {
            implicit.push(Implicit { unknowns: Vec::new(), residuals: sources[next..next + size].to_vec() });
            next += size;
        }
        for (input, row) in inputs.iter().zip(&input_rows) {
            match (*input, *row) {
                (SeriesInput::State(rate), Some(row)) => states.push((row, sources[rate])),
                (SeriesInput::Unknown(block), Some(row)) => implicit[block].unknowns.push(row),
                (SeriesInput::Time, row) => time = row,
                _ => {}
            }
        }
        SeriesTape {
            first: Tape::assemble(&self.program, inputs.len(), &first),
            rows,
            inputs: input_rows,
            time,
            states,
            outputs: sources[..own_outputs].to_vec(),
            blocks: implicit,
            products,
            definitions: ends,
            stages,
            terms,
            slopes: self.slope_list,
        }
    }

    /// Terms with the same operand become one.
    fn merged(&mut self, terms: Vec<(Id, Row)>) -> Vec<(Id, Row)> {
        let mut merged: Vec<(Id, Row)> = Vec::new();
        for (weight, row) in terms {
            match merged.iter_mut().find(|(_, other)| *other == row) {
                Some((total, _)) => *total = self.push(Value::Add(*total, weight)),
                None => merged.push((weight, row)),
            }
        }
        merged
    }
}

/// A factor that is constant in time.
#[derive(Clone, Copy)]
enum Multiple {
    Minus,
    By(Id),
    Over(Id),
}
