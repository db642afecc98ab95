//! From a straight-line program to a [`SeriesTape`].

mod decide;
mod functions;

use super::{Bilinear, Definition, Implicit, Row, SeriesInput, SeriesTape, Slot, Source};
use crate::number::{Number, Rational};
use crate::program::{Id, Program, Value};
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

        // Operands in the order in which they are known: the last one is what a sum waits for.
        let mut known: Vec<usize> = vec![0; self.of_row.len()];
        for (place, (row, _)) in definitions.iter().enumerate() {
            known[*row as usize] = 1 + place;
        }
        for (slope, of) in &self.slope_list {
            known[*slope as usize] = known[*of as usize];
        }
        let none = self.fresh(None);
        let mut totals: Vec<Row> = Vec::new();
        for (_, sum) in &mut definitions {
            let bare = sum.pairs.is_empty() && sum.pairs_over_k.is_empty();
            totals.push(if bare { none } else { self.fresh(None) });
            let terms = std::mem::take(&mut sum.terms);
            sum.terms = self.merged(terms);
            sum.terms.sort_by_key(|(_, operand)| known[*operand as usize]);
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
                list.extend(pairs.iter().map(|(scale, left, right)| Bilinear {
                    scale: slot(*scale),
                    target: *total,
                    left: *left,
                    right: *right,
                }));
            }
        }
        // So that coefficients have been written for a while when they are read in groups.
        for list in &mut products {
            list.sort_by_key(|product: &Bilinear| known[product.left as usize].max(known[product.right as usize]));
        }
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
