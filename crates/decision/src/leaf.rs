//! Random points that satisfy constraints on positions: on the leaf of a start.

use std::sync::Arc;

use mechanics::System;
use symbolic::{Evaluator, Expr, Symbol, Tape};

use crate::DecisionError;
use crate::exact::{Coefficient, Exact, Jet, Modular};

/// Where roots have branches, these integers count steps of 1/`PART` of each number of the start, away from
/// it.
pub(crate) const PART: i128 = 1 << 30;

/// A number, or a constraint as a polynomial in one velocity up to the order that shows that it is quadratic:
/// draws are many, and short series cheap.
pub(crate) type Short = Jet<Modular, 5>;

/// That random positions on which the constraints hold are not found.
pub(crate) struct Unsolved;

/// Constraints `g(q, t) = 0`.
#[derive(Clone)]
pub(crate) struct Leaf {
    /// `g`, then `∂g/∂q` row by row; from parameters, time and positions.
    program: Arc<Tape>,
    coordinates: usize,
    /// In the order in which they are solved, each for some of its coordinates; `None` where each coordinate
    /// stands in several.
    order: Option<Vec<Given>>,
}

/// A constraint, and coordinates that stand in none that is solved before.
#[derive(Clone)]
struct Given {
    constraint: usize,
    own: Vec<usize>,
    /// Whether nothing else that varies stands in it.
    is_whole: bool,
}

/// A point on `g = 0`, and the constraints that hold there by a root which could be of either sign.
pub(crate) type Placed = (Vec<Short>, Vec<usize>);

impl Leaf {
    pub(crate) fn new(system: &System) -> Result<Self, DecisionError> {
        let (g, q) = (&system.graph, system.positions());
        let all: Vec<Expr> = system.on_positions.iter().map(|(_, e)| *e).collect();
        let mut inputs: Vec<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        inputs.push(system.time);
        inputs.extend(&q);
        let outputs = [&all[..], g.jacobian(&all, &q).entries()].concat();
        let contains = |e: Expr, i: usize| g.depends_on(e, q[i]);
        let mut left: Vec<usize> = (0..all.len()).collect();
        let mut order = Vec::new();
        // the last one first: its own coordinates stand in no other
        while !left.is_empty() {
            let of = |&i: &usize| {
                let others = || left.iter().filter(|&&other| other != i);
                let own = |j: &usize| contains(all[i], *j) && !others().any(|&other| contains(all[other], *j));
                let own: Vec<usize> = (0..q.len()).filter(own).collect();
                let count = (0..q.len()).filter(|&j| contains(all[i], j)).count();
                let is_whole = own.len() == count && !g.depends_on(all[i], system.time);
                (!own.is_empty()).then_some(Given { constraint: i, own, is_whole })
            };
            let Some(given) = left.iter().find_map(of) else { break };
            left.retain(|&i| i != given.constraint);
            order.push(given);
        }
        order.reverse();
        let order = left.is_empty().then_some(order);
        Ok(Leaf { program: g.tape(&inputs, &outputs)?, coordinates: q.len(), order })
    }

    /// How many constraints there are.
    pub(crate) fn constraints(&self) -> usize {
        self.order.as_ref().map_or(1, Vec::len)
    }

    /// `q` moved onto `g = 0`, near `start` where `q` is; `None` where there is no root. A constraint is
    /// `rootless` that once had none: it is not a product then.
    ///
    /// A single coordinate stays; what is linear in a coordinate gives that. A quadric whose coordinates
    /// stand nowhere else is met a second time by the line from `start` in the direction of `q`, in numbers
    /// as exact as both; else a square root is taken in the field.
    pub(crate) fn placed(
        &self,
        parameters: &[Short],
        time: Short,
        start: &[Short],
        mut q: Vec<Short>,
        near: bool,
        rootless: &mut [bool],
    ) -> Result<Option<Placed>, Unsolved> {
        let order = self.order.as_ref().ok_or(Unsolved)?;
        let mut program = Evaluator::<Short>::new(self.program.clone());
        let mut run = |q: &[Short]| program.evaluate(&[parameters, &[time], q].concat()).to_vec();
        let (at_start, mut free) = (run(start), Vec::new());
        for Given { constraint: i, own, is_whole } in order {
            let slope = |values: &[Short], j: usize| values[order.len() + i * self.coordinates + j];
            let is_zero = |x: &Short| x.coefficient(0).is_zero();
            let is_from_start = *is_whole && at_start[*i].flaw().is_none() && is_zero(&at_start[*i]);
            if let ([j], true) = (&own[..], is_from_start) {
                q[*j] = start[*j];
                continue;
            }
            // a factor without this coordinate would be zero at the start, and its slope with it
            let given =
                own.iter().copied().filter(|&j| slope(&at_start, j).flaw().is_none() && !is_zero(&slope(&at_start, j)));
            let mut along = |j: usize| -> Option<[Modular; 3]> {
                let mut line = q.clone();
                line[j] = Short::series(
                    &[q[j].coefficient(0), Modular::one(), Modular::ZERO, Modular::ZERO, Modular::ZERO],
                    q[j].exact(),
                );
                let value = run(&line)[*i];
                let [c, b, a, third, fourth] = std::array::from_fn(|k| value.coefficient(k));
                (value.flaw().is_none() && third.is_zero() && fourth.is_zero()).then_some([c, b, a])
            };
            let polynomials: Vec<(usize, [Modular; 3])> = given.filter_map(|j| Some((j, along(j)?))).collect();
            if let Some(&(j, _)) = polynomials.iter().find(|(_, [_, _, a])| a.is_zero()) {
                let values = run(&q);
                if is_zero(&slope(&values, j)) {
                    return Ok(None);
                }
                q[j] = q[j] - values[*i] / slope(&values, j);
                continue;
            }
            let Some(&(j, [c, b, a])) = polynomials.first() else { return Err(Unsolved) };
            let two = Modular::new(2);
            let root = (b * b - two * two * a * c).square_root();
            rootless[*i] |= root.is_none();
            free.push(*i);
            if is_from_start {
                match self.met_again(*i, j, own, start, &q, near, &at_start, &mut run) {
                    Some(met) => q = met,
                    None => return Ok(None),
                }
                continue;
            }
            let Some((root, over)) = root.zip((two * a).inverse()) else { return Ok(None) };
            q[j] = Short::constant(q[j].coefficient(0) + (root - b) * over, None);
        }
        let is_on = run(&q)[..order.len()].iter().all(|g| g.flaw().is_none() && g.coefficient(0).is_zero());
        if is_on { Ok(Some((q, free))) } else { Err(Unsolved) }
    }

    /// Where a line from `start` meets the quadric again: near `start`, if it is nearly tangent there.
    #[expect(clippy::too_many_arguments, reason = "what the caller has computed")]
    fn met_again(
        &self,
        i: usize,
        pivot: usize,
        own: &[usize],
        start: &[Short],
        q: &[Short],
        near: bool,
        at_start: &[Short],
        run: &mut impl FnMut(&[Short]) -> Vec<Short>,
    ) -> Option<Vec<Short>> {
        let slope = |j: usize| at_start[self.constraints() + i * self.coordinates + j];
        let zero = Short::constant(Modular::ZERO, Some(Exact::ZERO));
        let scale = if near { Exact::ratio(PART, 1)? } else { Exact::ONE };
        let scale = Short::constant(Modular::of(scale).ok()?, Some(scale));
        let mut line: Vec<Short> = q.iter().zip(start).map(|(&q, &start)| (q - start) * scale).collect();
        let sum = |line: &[Short]| own.iter().fold(zero, |sum, &j| sum + slope(j) * line[j]);
        if near {
            let small = (q[pivot] - start[pivot]) * slope(pivot);
            line[pivot] = line[pivot] + (small - sum(&line)) / slope(pivot);
        }
        let mut moved = q.to_vec();
        own.iter().for_each(|&j| moved[j] = start[j] + line[j]);
        // g(start + s line) = b s + a s²
        let b = sum(&line);
        let a = run(&moved)[i] - b;
        if a.coefficient(0).is_zero() {
            return None;
        }
        let s = -(b / a);
        own.iter().for_each(|&j| moved[j] = start[j] + s * line[j]);
        Some(moved)
    }
}
