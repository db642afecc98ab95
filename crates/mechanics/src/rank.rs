//! Ranks of matrices of expressions.

use std::cmp::Ordering;
use std::collections::{BTreeSet, HashMap};

use symbolic::{Bounded, Evaluator, Expr, Graph, Matrix, Scalar, SplitMix, Symbol};

use crate::elimination::{eliminate, largest, open};
use crate::{Parameter, State, System};

/// How far from the centre points are drawn, in sizes.
const REACHES: [f64; 4] = [1.0, 0.1, 3.0, 0.01];
/// The same where something varies under a root or has a kink: on the branch of the centre.
const NEAR: [f64; 4] = [0.01, 0.001, 0.003, 0.0001];
/// The centre itself.
const CENTRE: [f64; 4] = [0.0; 4];
/// Signs of the way from the centre: drawn, all up, all down. Roots and logarithms have a side.
const SIGNS: [Option<f64>; 3] = [None, Some(1.0), Some(-1.0)];

/// Where expressions are tried: constants have their values, everything else a centre and a size.
pub struct Surroundings {
    /// With the round-off of their formulas: what is zero by an identity is none that is certain.
    constants: HashMap<Symbol, Bounded>,
    /// Centre and size; without an entry 0 and 1.
    variables: HashMap<Symbol, (f64, f64)>,
}

impl Surroundings {
    /// Round zero, in sizes of 1.
    pub fn of_zero(system: &System) -> Self {
        let bounded = |p: &Parameter| {
            let formula = system.graph.bounded(system.written_parameter(p), &HashMap::new());
            (p.symbol, formula.filter(|x| x.is_finite()).unwrap_or(Bounded::from_f64(p.value)))
        };
        Surroundings { constants: system.parameters.iter().map(bounded).collect(), variables: HashMap::new() }
    }

    /// Round a start, in sizes that go with the units: of a coordinate how large it is, how far its velocity
    /// takes it up to `end`, how far all kinetic energy and the work of its own force up to `end` could.
    pub fn of_start(system: &System, start: &State, end: f64) -> Self {
        let (g, values) = (&system.graph, system.values_at(start));
        let number = |e: Expr| g.evaluate(e, &values).ok().filter(|x| x.is_finite()).unwrap_or(0.0);
        let time = (end - start.t).abs();
        let momenta = g.gradient(system.lagrangian, &system.velocities());
        let masses: Vec<f64> =
            momenta.iter().zip(&system.coordinates).map(|(&p, c)| number(g.derivative(p, c.velocity)).abs()).collect();
        let forces: Vec<f64> = g.gradient(system.lagrangian, &system.positions()).into_iter().map(number).collect();
        let over = |x: f64, mass: f64| if mass > 0.0 { x / mass } else { 0.0 };
        let own = |i: usize| masses[i] * start.v[i].powi(2) + over((forces[i] * time).powi(2), masses[i]);
        let energy: f64 = (0..masses.len()).map(own).sum();
        let size = |i: usize| {
            let size = start.q[i].abs().max((start.v[i] * time).abs()).max(over(energy, masses[i]).sqrt() * time);
            if size > 0.0 && size.is_finite() { size } else { 1.0 }
        };
        let mut variables: HashMap<Symbol, (f64, f64)> = HashMap::new();
        for (i, c) in system.coordinates.iter().enumerate() {
            let size = size(i);
            variables.insert(c.position, (start.q[i], size));
            variables.insert(c.velocity, (start.v[i], if time > 0.0 { size / time } else { size }));
        }
        variables.insert(system.time, (start.t, if time > 0.0 { time } else { 1.0 }));
        Surroundings { variables, ..Surroundings::of_zero(system) }
    }

    /// Values at one of the points: a pure function of its number and of the places of the symbols.
    fn point(&self, symbols: &[Symbol], point: usize, reaches: [f64; 4]) -> Vec<Bounded> {
        let (reach, sign) = (reaches[point % REACHES.len()], SIGNS[point % SIGNS.len()]);
        let mut random = SplitMix::new(point as u64);
        let value = |symbol: &Symbol| {
            let (magnitude, drawn) = (0.3 + random.unit(), if random.unit() < 0.5 { 1.0 } else { -1.0 });
            let (centre, size) = self.variables.get(symbol).copied().unwrap_or((0.0, 1.0));
            let size = if reaches != REACHES && centre != 0.0 { size.min(centre.abs()) } else { size };
            let varied = centre + size * reach * magnitude * sign.unwrap_or(drawn);
            self.constants.get(symbol).copied().unwrap_or(Bounded::from_f64(varied))
        };
        symbols.iter().map(value).collect()
    }

    /// How many of these fields are certainly independent at the centre; 0 where they have no value there.
    pub(crate) fn rank_at_centre(&self, graph: &Graph, fields: &[Vec<Expr>]) -> usize {
        let entries = fields.concat();
        let symbols: Vec<Symbol> =
            entries.iter().flat_map(|&e| graph.symbols_of(e)).collect::<BTreeSet<_>>().into_iter().collect();
        let Ok(tape) = graph.compile(&symbols, &entries, &HashMap::new()) else { return 0 };
        let values = Evaluator::new(tape).evaluate(&self.point(&symbols, 0, CENTRE)).to_vec();
        let width = fields.first().map_or(1, Vec::len);
        if values.iter().all(|x| x.is_finite()) {
            certain_rank(values.chunks(width).map(<[Bounded]>::to_vec).collect())
        } else {
            0
        }
    }
}

/// The rank of `matrix` almost everywhere, as far as points tell: the largest of those that are certain at
/// one point each. So it is never too large; too small where a point of larger rank was not among them.
/// Where something varies under a root or has a kink, points are on the branch of the centre. `None` where no
/// entry is finite at any of them.
pub fn generic_rank(graph: &Graph, matrix: &Matrix, surroundings: &Surroundings) -> Option<usize> {
    let most = matrix.rows().min(matrix.columns());
    if most == 0 {
        return Some(0);
    }
    let symbols: BTreeSet<Symbol> = matrix.entries().iter().flat_map(|&e| graph.symbols_of(e)).collect();
    let symbols: Vec<Symbol> = symbols.into_iter().collect();
    let varies = |e: &Expr| graph.symbols_of(*e).iter().any(|s| surroundings.variables.contains_key(s));
    let ends: Vec<Expr> = graph.ends_of_pieces(matrix.entries()).into_iter().filter(varies).collect();
    let all = [matrix.entries(), &ends].concat();
    let mut evaluator = Evaluator::new(graph.compile(&symbols, &all, &HashMap::new()).ok()?);
    let signs = |ends: &[Bounded]| ends.iter().map(|e| e.value.partial_cmp(&0.0)).collect::<Vec<_>>();
    let count = matrix.entries().len();
    let own = signs(&evaluator.evaluate(&surroundings.point(&symbols, 0, CENTRE))[count..]);
    let mut found = None;
    for point in 0..REACHES.len() * SIGNS.len() {
        let values =
            evaluator.evaluate(&surroundings.point(&symbols, point, if ends.is_empty() { REACHES } else { NEAR }));
        let (entries, ends) = values.split_at(count);
        let on_branch = own.iter().zip(signs(ends)).all(|(own, sign)| own.is_none_or(Ordering::is_eq) || *own == sign);
        if on_branch && entries.iter().all(|e| e.is_finite()) {
            found = found.max(Some(certain_rank(entries.chunks(matrix.columns()).map(<[Bounded]>::to_vec).collect())));
        }
        if found == Some(most) {
            break;
        }
    }
    found
}

/// How many pivots differ from zero by more than all round-off before them, whatever the units of rows and
/// columns: these are scaled to entries of size 1.
fn certain_rank(mut rows: Vec<Vec<Bounded>>) -> usize {
    let scaled = |x: Bounded, by: f64| Bounded { value: x.value * by, magnitude: x.magnitude * by };
    let inverse = |largest: f64| if largest > 0.0 { largest.log2().round().exp2().recip() } else { 1.0 };
    let columns = rows.first().map_or(0, Vec::len);
    for _ in 0..2 {
        for row in &mut rows {
            let by = inverse(row.iter().map(|x| x.value.abs()).fold(0.0, f64::max));
            row.iter_mut().for_each(|x| *x = scaled(*x, by));
        }
        for j in 0..columns {
            let by = inverse(rows.iter().map(|row| row[j].value.abs()).fold(0.0, f64::max));
            rows.iter_mut().for_each(|row| row[j] = scaled(row[j], by));
        }
    }
    let pick = |rows: &[Vec<Bounded>], done: &[usize]| {
        largest(rows, open(rows, done, columns).filter(|&(i, j)| !rows[i][j].may_be_zero() && rows[i][j].is_finite()))
    };
    eliminate(&mut rows, pick).len()
}
