//! From definitions of series to the tape.

use super::ahead::{AHEAD, DERIVED, STEADY, Stage};
use super::{Builder, Part};
use crate::programs::program::{Id, Value};
use crate::programs::tape::Tape;
use crate::series::{Addition, Bilinear, Group, Implicit, Row, SeriesInput, SeriesTape, Slot, Source, State, Term};
use crate::store::number::Number;
use rustc_hash::FxHashMap;

impl Builder<'_> {
    pub(super) fn finish(mut self, own_outputs: usize, blocks: &[usize]) -> SeriesTape {
        let (inputs, outputs) = (self.inputs, self.outputs);
        let input_ids: Vec<Id> = (0..inputs.len()).map(|i| self.push(Value::Input(i as u32))).collect();
        let input_rows: Vec<Option<Row>> =
            input_ids.iter().map(|id| if self.varies(*id) { Some(self.row(*id)) } else { None }).collect();
        let of_outputs: Vec<Option<Row>> =
            outputs.iter().map(|id| if self.varies(*id) { Some(self.row(*id)) } else { None }).collect();

        // By stage; within one as they were made, operands first.
        let mut definitions = std::mem::take(&mut self.definitions);
        definitions.sort_by_key(|(row, _)| self.stage(*row));
        let stages = AHEAD..=DERIVED + blocks.len();
        let ends: Vec<usize> = stages.map(|s| definitions.partition_point(|(row, _)| self.stage(*row) <= s)).collect();

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
            sum.terms.sort_by_key(|term| if term.late { 0 } else { known[term.row as usize] });
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
        let mut groups = [Group::default(), Group::default()];
        let (mut additions, mut places) = (Vec::new(), vec![0]);
        let nothing = Term { weight: slot(zero), row: none, late: false };
        for ((row, sum), total) in definitions.iter().zip(&totals) {
            let mut terms: Vec<Term> =
                sum.terms.iter().map(|t| Term { weight: slot(t.weight), row: t.row, late: t.late }).collect();
            // what is known last stays last
            let missing = if terms.is_empty() { 2 } else { terms.len() % 2 };
            terms.splice(..0, vec![nothing; missing]);
            let mut start = *total;
            for pair in terms.as_chunks().0 {
                additions.push(Addition { target: *row, start, terms: *pair });
                start = *row;
            }
            places.push(additions.len());
            for (list, pairs) in groups[self.group(*row)].products.iter_mut().zip([&sum.pairs, &sum.pairs_over_k]) {
                list.extend(pairs.iter().map(|(scale, left, right)| Bilinear {
                    scale: slot(*scale),
                    target: *total,
                    left: *left,
                    right: *right,
                }));
            }
        }
        // So that coefficients have been written for a while when they are read in groups.
        for list in groups.iter_mut().flat_map(|group| &mut group.products) {
            list.sort_by_key(|product: &Bilinear| known[product.left as usize].max(known[product.right as usize]));
        }
        let sources: Vec<Source> = outputs
            .iter()
            .zip(&of_outputs)
            .map(|(id, row)| row.map_or_else(|| Source::Steady(slot(*id)), Source::Row))
            .collect();
        let rows = self.of_row.len();
        let one = slot(self.one);
        let integrated = self.integrated.iter().map(|(id, i)| State {
            row: self.rows[id],
            rate: Source::Row(self.rows[&i.rate]),
            factor: slot(i.factor),
        });
        let integrated: Vec<State> = integrated.collect();
        self.program.fuse(&first);
        let mut states: Vec<State> = Vec::new();
        let mut time = None;
        let mut implicit: Vec<Implicit> = Vec::new();
        let mut next = own_outputs;
        for size in blocks {
            implicit.push(Implicit { unknowns: Vec::new(), residuals: sources[next..next + size].to_vec() });
            next += size;
        }
        for (input, row) in inputs.iter().zip(&input_rows) {
            match (*input, *row) {
                (SeriesInput::State(rate), Some(row)) => states.push(State { row, rate: sources[rate], factor: one }),
                (SeriesInput::Unknown(block), Some(row)) => implicit[block].unknowns.push(row),
                (SeriesInput::Time, row) => time = row,
                _ => {}
            }
        }
        for state in states.into_iter().chain(integrated) {
            groups[self.group(state.row)].states.push(state);
        }
        for (slope, of) in &self.slope_list {
            groups[self.group(*of)].slopes.push((*slope, *of));
        }
        let mut derivatives: Vec<(Row, Row)> = self
            .derivatives
            .iter()
            .filter_map(|(derivative, of)| Some((*self.rows.get(derivative)?, *self.rows.get(of)?)))
            .collect();
        derivatives.sort_unstable();
        SeriesTape {
            first: Tape::assemble(&self.program, inputs.len(), &first),
            rows,
            inputs: input_rows,
            time,
            outputs: sources[..own_outputs].to_vec(),
            blocks: implicit,
            groups,
            additions,
            stages: ends.into_iter().map(|end| places[end]).collect(),
            derivatives,
        }
    }

    fn stage(&self, row: Row) -> Stage {
        self.of_row[row as usize].map_or(STEADY, |id| self.stages[id as usize])
    }

    fn group(&self, row: Row) -> usize {
        usize::from(self.stage(row) > AHEAD)
    }

    /// Terms with the same operand become one.
    fn merged(&mut self, terms: Vec<Part>) -> Vec<Part> {
        let mut merged: Vec<Part> = Vec::new();
        for term in terms {
            match merged.iter_mut().find(|other| (other.row, other.late) == (term.row, term.late)) {
                Some(total) => total.weight = self.push(Value::Add(total.weight, term.weight)),
                None => merged.push(term),
            }
        }
        merged
    }
}
