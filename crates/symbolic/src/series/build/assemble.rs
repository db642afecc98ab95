//! From definitions of series to the tape.

use super::ahead::{AHEAD, DERIVED, STEADY, Stage};
use super::{Builder, Integrated, Part};
use crate::programs::program::{Id, Value};
use crate::programs::tape::Tape;
use crate::series::{
    Addition, Bilinear, Group, Implicit, Row, SeriesInput, SeriesTape, Slot, Source, State, TERMS, Term,
};
use crate::store::number::Number;
use rustc_hash::FxHashMap;

impl Builder<'_> {
    pub(super) fn finish(mut self, own_outputs: usize, blocks: &[usize]) -> SeriesTape {
        let (inputs, outputs) = (self.inputs, self.outputs);
        let input_ids: Vec<Id> = (0..inputs.len()).map(|i| self.push(Value::Input(i as u32))).collect();
        let input_rows: Vec<Option<Row>> =
            input_ids.iter().map(|id| if self.varies(*id) { Some(self.row(*id)) } else { None }).collect();
        let one = self.one;
        let multiple = |builder: &mut Self, id: Id, factor: Id| {
            let (id, factor) = builder.peel(id, factor);
            (builder.row(id), factor)
        };
        let of_outputs: Vec<Option<(Row, Id)>> =
            outputs.iter().map(|&id| if self.varies(id) { Some(multiple(&mut self, id, one)) } else { None }).collect();
        let integrated: Vec<(Id, Integrated)> = self.integrated.iter().map(|(id, i)| (*id, *i)).collect();
        let integrated: Vec<(Row, (Row, Id))> =
            integrated.into_iter().map(|(id, i)| (self.rows[&id], multiple(&mut self, i.rate, i.factor))).collect();

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
        // Products, each once: those whose factors are known last stand last.
        let rows = self.of_row.len();
        let mut groups = [Group::default(), Group::default()];
        let mut products: FxHashMap<(usize, usize, Row, Row), Row> = FxHashMap::default();
        for (row, sum) in &definitions {
            let group = self.group(*row);
            for (list, pairs) in [&sum.pairs, &sum.pairs_over_k].into_iter().enumerate() {
                for (_, left, right) in pairs {
                    let (left, right) = (*left.min(right), *left.max(right));
                    products.entry((group, list, left, right)).or_insert_with(|| {
                        groups[group].products[list].push(Bilinear { left, right });
                        0
                    });
                }
            }
        }
        let mut next = rows;
        for (group, lists) in groups.iter_mut().enumerate() {
            for (list, all) in lists.products.iter_mut().enumerate() {
                all.sort_by_key(|p| known[p.left as usize].max(known[p.right as usize]));
                for p in all {
                    products.insert((group, list, p.left, p.right), Row::try_from(next).expect("fewer than 2^32"));
                    next += 1;
                }
            }
        }
        let mut linear = 0;
        for (row, sum) in &mut definitions {
            let group = self.group(*row);
            let terms = std::mem::take(&mut sum.terms);
            sum.terms = self.merged(terms);
            linear += 2 * sum.terms.len().div_ceil(2).max(1);
            let pairs = [std::mem::take(&mut sum.pairs), std::mem::take(&mut sum.pairs_over_k)];
            for (list, pairs) in pairs.into_iter().enumerate() {
                let product = |l: Row, r: Row| products[&(group, list, l.min(r), l.max(r))];
                sum.terms.extend(pairs.into_iter().map(|(weight, l, r)| Part::of(weight, product(l, r))));
            }
            let terms = std::mem::take(&mut sum.terms);
            sum.terms = self.merged(terms);
            let waits = |term: &Part| known.get(term.row as usize).copied().filter(|_| !term.late).unwrap_or(0);
            sum.terms.sort_by_key(waits);
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
        let (mut additions, mut places) = (Vec::new(), vec![0]);
        for (target, sum) in &definitions {
            let is_plain = |term: &Part| term.weight == self.one && !term.late;
            let plain: Vec<Row> = sum.terms.iter().filter(|t| is_plain(t)).map(|t| t.row).collect();
            let others = sum.terms.iter().filter(|t| !is_plain(t));
            let terms: Vec<Term> = others.map(|t| Term { weight: slot(t.weight), row: t.row, late: t.late }).collect();
            // what is known last comes last, in a full addition
            let (mut plain, mut terms) = (&plain[..], &terms[..]);
            let mut addition =
                Addition { target: *target, counts: [0; 2], plain: [0; TERMS], terms: [Term::default(); TERMS] };
            loop {
                let begun = addition.counts[0];
                let taken =
                    [plain.len().min(TERMS - begun), terms.len() - terms.len().saturating_sub(1) / TERMS * TERMS];
                let (some, rest) = plain.split_at(taken[0]);
                let (weighted, others) = terms.split_at(taken[1]);
                addition.plain[begun..begun + some.len()].copy_from_slice(some);
                addition.terms[..weighted.len()].copy_from_slice(weighted);
                addition.counts = [begun + some.len(), weighted.len()];
                additions.push(addition);
                (plain, terms) = (rest, others);
                if plain.is_empty() && terms.is_empty() {
                    break;
                }
                addition.plain[0] = *target;
                addition.counts[0] = 1;
            }
            places.push(additions.len());
        }
        let sources: Vec<Source> = outputs
            .iter()
            .zip(&of_outputs)
            .map(|(id, row)| match row {
                Some((row, factor)) => Source::Row(*row, slot(*factor)),
                None => Source::Steady(slot(*id)),
            })
            .collect();
        let integrated: Vec<State> = integrated
            .into_iter()
            .map(|(row, (rate, factor))| State { row, rate: Source::Row(rate, slot(factor)) })
            .collect();
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
                (SeriesInput::State(rate), Some(row)) => states.push(State { row, rate: sources[rate] }),
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
            linear,
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
