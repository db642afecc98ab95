//! The plan in which equations are evaluated: linear blocks eliminated beforehand, in expressions, where that is cheap and safe.
//!
//! A block `J(t, y) z = b(t, y)` whose pivots are known beforehand needs no factorization at run time: elimination in expressions leaves a list of
//! definitions, one after the other, in which structural zeros cost nothing, numbers are folded and `sin² + cos²` is 1. Pivots are chosen by
//! numbers at the start, so that none is small there (as partial pivoting would choose them); along the motion they may become
//! small. So the squares of all multipliers, and of what cancelled in a pivot over that pivot, are watched in every evaluation: where they exceed
//! [`Plan::LIMIT`], or a rate is not finite, the same instant is solved by LU factorization with pivoting instead, and counted. What is known to
//! stay small (by [`Graph::range`]) is not watched.

use std::collections::{BTreeMap, HashMap, HashSet};

use symbolic::{CompileError, Evaluator, Expr, Graph, Symbol};

use crate::definitions::{apart, symbols_behind};
use crate::equations::{Block, Equations};

mod collection;
mod elimination;
mod pivots;

pub use collection::Collected;
use collection::collected;
use elimination::{Definitions, Elimination, LinearBlock};
use pivots::{Entry, NEAR, Order, POINTS, Pattern, Strategy};

/// Definitions that take the place of blocks.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Intermediate quantities and unknowns in the order in which they are computed, in `(t, y)`, free constants, unknowns of blocks that are
    /// left, and earlier definitions.
    pub definitions: Vec<(Symbol, Expr)>,
    /// `κ(t, y)`: the definitions are accurate where `κ ≤` [`Plan::LIMIT`]; `None` where they are everywhere.
    pub condition: Option<Expr>,
    /// Places of the blocks that are solved numerically.
    pub left: Vec<usize>,
    /// What was chosen for each block and why, in words.
    pub why: Vec<String>,
    /// All definitions and the rates as they are evaluated, where there is a shorter way to write them.
    pub collected: Option<Collected>,
}

/// Expressions up to these sizes stay inside others: long ones let terms meet that cancel, short ones keep products apart that are used more than once.
const LONG_PARTS: usize = 12;
const SHORT_PARTS: usize = 3;

/// Multiplications over which a block is left to the LU: the code would be too long.
const MOST: usize = 20_000;

/// Multiplications over which only one way is tried.
const LONG: usize = 400;

/// Points around the start at which the condition of a plan is tried, and the one over which a point counts as bad.
const AROUND: usize = 32;
const BAD: f64 = 1e3;

impl Plan {
    /// Largest condition with which the definitions are used. A multiplier of 1000 takes three digits at most.
    pub const LIMIT: f64 = 1e6;

    /// Those of the equations and those of the plan, each after what it contains.
    pub(crate) fn all_definitions(&self, equations: &Equations) -> Vec<(Symbol, Expr)> {
        if let Some(collected) = &self.collected {
            return collected.definitions.clone();
        }
        let (known, waiting) = apart(&equations.graph, &equations.definitions, &equations.unknowns());
        [known, self.definitions.clone(), waiting].concat()
    }

    /// Places in `(t, y, constants, z)` of what the definitions take: of `z` the unknowns of blocks that are left.
    pub(crate) fn places(&self, equations: &Equations) -> Vec<usize> {
        let mut first = equations.known_symbols().len();
        let mut places: Vec<usize> = (0..first).collect();
        for (k, block) in equations.blocks.iter().enumerate() {
            let end = first + block.unknowns.len();
            if self.left.contains(&k) {
                places.extend(first..end);
            }
            first = end;
        }
        places
    }

    /// All blocks are solved by LU factorization.
    pub fn plain(equations: &Equations) -> Plan {
        Plan { left: (0..equations.blocks.len()).collect(), ..Plan::default() }
    }

    /// The cheapest plan that is safe near `(t, y, free constants)`, the point given; without one, near a point that stands for all.
    ///
    /// # Errors
    /// [`CompileError`] as [`crate::Compiled::new`].
    ///
    /// # Panics
    /// If the point has not one entry for time and each state and free constant.
    pub fn choose(equations: &Equations, point: Option<&[f64]>) -> Result<Plan, CompileError> {
        let mut known = equations.known_symbols();
        let mut points = points(known.len(), point);
        let mut around = around(&points[0]);
        add_definitions(equations, &mut known, points.iter_mut().chain(&mut around))?;
        let mut plan = Plan::default();
        let mut watched = Vec::new();
        let unknowns: HashSet<Symbol> = equations.unknowns().into_iter().collect();
        let foreign = |block: &Block| {
            let own: HashSet<Symbol> = block.unknowns.iter().copied().collect();
            block
                .residuals
                .iter()
                .any(|&r| equations.graph.symbols_of(r).iter().any(|s| unknowns.contains(s) && !own.contains(s)))
        };
        if equations.blocks.iter().any(foreign) {
            return Ok(Plan {
                why: vec!["blocks hang together: solved one after the other".into()],
                ..Plan::plain(equations)
            });
        }
        for (k, block) in equations.blocks.iter().enumerate() {
            let names = plan.definitions.len();
            match eliminated(equations, block, &known, &points, &around, names)? {
                Ok((found, words)) => {
                    plan.definitions.extend(found.list);
                    watched.extend(found.watched);
                    plan.why.push(words);
                }
                Err(words) => {
                    plan.left.push(k);
                    plan.why.push(words);
                }
            }
        }
        plan.condition = (!watched.is_empty()).then(|| equations.graph.sum(&watched));
        plan.collected = collected(equations, &plan)?;
        let words = || "common factors drawn out of definitions and rates".into();
        plan.why.extend(plan.collected.as_ref().map(|_| words()));
        Ok(plan)
    }
}

/// The given point, one beside it, and some all around.
fn points(size: usize, given: Option<&[f64]>) -> [Vec<f64>; POINTS] {
    let first = given.map_or_else(|| (0..size).map(|i| 0.2 + golden(i + 1)).collect(), <[f64]>::to_vec);
    assert_eq!(first.len(), size, "time, states and free constants");
    let mut points = [(); POINTS].map(|()| first.clone());
    for (x, part) in points[1].iter_mut().zip((8..).map(golden)) {
        *x += 0.1 * (1.0 + x.abs()) * (2.0 * part - 1.0);
    }
    points[NEAR..].clone_from_slice(&around(&first)[..POINTS - NEAR]);
    points
}

/// Adds the definitions that contain no unknowns to the symbols, and their values to the points.
fn add_definitions<'a>(
    equations: &Equations,
    known: &mut Vec<Symbol>,
    points: impl Iterator<Item = &'a mut Vec<f64>>,
) -> Result<(), CompileError> {
    let (definitions, _) = apart(&equations.graph, &equations.definitions, &equations.unknowns());
    let symbols: Vec<Symbol> = definitions.iter().map(|d| d.0).collect();
    if symbols.is_empty() {
        return Ok(());
    }
    let mut values = equations.evaluator(known, &equations.graph.variables(&symbols))?;
    for point in points {
        point.extend_from_slice(values.evaluate(point));
    }
    known.extend(symbols);
    Ok(())
}

/// Multiples of the golden section, which fill the interval from 0 to 1 evenly.
fn golden(i: usize) -> f64 {
    (0.618_033_988_749_894_9 * i as f64).fract()
}

/// Points all around the first, about as far from it as it is from zero.
fn around(first: &[f64]) -> Vec<Vec<f64>> {
    let shifted = |k: usize| {
        move |(i, x): (usize, &f64)| x + 1.5 * (1.0 + x.abs()) * (2.0 * golden((i + 1) * (k + 1) * (k + 3)) - 1.0)
    };
    (0..AROUND).map(|k| first.iter().enumerate().map(shifted(k)).collect()).collect()
}

/// Ways to eliminate a block, the best so far with its price.
struct Trial<'a> {
    equations: &'a Equations,
    known: &'a [Symbol],
    /// Unknowns that rates need.
    wanted: Vec<Expr>,
    linear: &'a LinearBlock,
    pattern: &'a Pattern,
    around: &'a [Vec<f64>],
    names: usize,
    best: Option<Best>,
}

struct Best {
    price: usize,
    definitions: Definitions,
    way: Strategy,
    /// No pivot is small at any of the points.
    clean: bool,
}

impl Trial<'_> {
    /// The price: instructions, and more of them the more often a pivot is small somewhere.
    fn make(&mut self, way: Strategy, order: &Order, inline: usize) -> Result<(), CompileError> {
        let g = &self.equations.graph;
        let work = Elimination::new(g, &self.equations.parameters, inline, self.names);
        let Some(found) = work.run(self.linear, order, way == Strategy::Symmetric, &self.pattern.row_scale) else {
            return Ok(());
        };
        let outputs = [&self.wanted[..], &[g.sum(&found.watched)]].concat();
        let mut way_taken =
            Evaluator::new(g.compile_with(self.known, &found.list, &outputs, &self.equations.parameters)?);
        let mut is_bad = |point: &Vec<f64>| {
            way_taken.evaluate(point).last().is_none_or(|&condition| condition.is_nan() || condition > BAD)
        };
        let bad = self.around.iter().filter(|point| is_bad(point)).count();
        let price = way_taken.tape().len() * (AROUND + 4 * bad);
        if self.best.as_ref().is_none_or(|best| price < best.price) {
            self.best = Some(Best { price, definitions: found, way, clean: bad == 0 });
        }
        Ok(())
    }
}

/// Definitions for one block with words about them, or why there are none.
type Outcome = Result<(Definitions, String), String>;

fn eliminated(
    equations: &Equations,
    block: &Block,
    known: &[Symbol],
    points: &[Vec<f64>; POINTS],
    around: &[Vec<f64>],
    names: usize,
) -> Result<Outcome, CompileError> {
    let g = &equations.graph;
    let size = block.unknowns.len();
    let Some(mut linear) = linear_block(g, block) else {
        let words = format!("{size} unknowns that do not enter linearly: Newton's method with LU factorization");
        return Ok(Err(words));
    };
    let symmetric = make_symmetric(g, &mut linear);
    let Some(pattern) = pattern(equations, &linear, known, points)? else {
        return Ok(Err(format!("{size} unknowns, singular or not finite at the start: LU factorization")));
    };
    let needed = symbols_behind(g, &equations.definitions, equations.states.iter().map(|y| y.rate));
    let unneeded: Vec<bool> = block.unknowns.iter().map(|z| !needed.contains(z)).collect();
    let wanted: Vec<Expr> = block.unknowns.iter().filter(|z| needed.contains(z)).map(|&z| g.variable(z)).collect();
    let mut ways = Vec::new();
    if symmetric {
        ways.push(Strategy::Symmetric);
    }
    ways.push(Strategy::Sparse);
    if unneeded.contains(&true) {
        ways.push(Strategy::UnneededFirst);
    }
    let mut orders: Vec<_> = ways.into_iter().filter_map(|w| Some((w, pattern.order(w, &unneeded, MOST)?))).collect();
    orders.sort_by_key(|(_, order)| order.operations);
    if orders.first().is_some_and(|(_, order)| order.operations > LONG) {
        orders.truncate(1);
    }
    let mut trial = Trial { equations, known, wanted, linear: &linear, pattern: &pattern, around, names, best: None };
    for (way, order) in &orders {
        trial.make(*way, order, LONG_PARTS)?;
        // more operations are no better; they are tried for the sake of pivots only
        if trial.best.as_ref().is_some_and(|best| best.clean) {
            break;
        }
    }
    if let Some(Best { way, .. }) = &trial.best
        && let Some((way, order)) = orders.iter().find(|(w, _)| w == way)
    {
        trial.make(*way, order, SHORT_PARTS)?;
    }
    let Some(Best { definitions: found, way, .. }) = trial.best else {
        return Ok(Err(format!(
            "{size} unknowns without pivots that are safe at the start, or too many of them: LU factorization"
        )));
    };
    let words = match size {
        1 => "one unknown: a quotient".into(),
        _ => format!("{size} unknowns {}; {}", described(way), guarded(&found)),
    };
    Ok(Ok((found, words)))
}

fn described(way: Strategy) -> &'static str {
    match way {
        Strategy::Symmetric => "eliminated beforehand as a symmetric matrix",
        Strategy::Sparse => "eliminated beforehand, sparse",
        Strategy::UnneededFirst => "eliminated beforehand, those first that no rate needs",
    }
}

fn guarded(found: &Definitions) -> String {
    match found.moving {
        0 => "no multiplier of the elimination can become large".into(),
        1 => "one pivot is watched, LU factorization where it is small".into(),
        count => format!("{count} pivots are watched, LU factorization where one is small"),
    }
}

/// The block as `J z = b`; `None` where it is not linear.
fn linear_block(g: &Graph, block: &Block) -> Option<LinearBlock> {
    let places: HashMap<Symbol, usize> = block.unknowns.iter().enumerate().map(|(j, &z)| (z, j)).collect();
    let at_zero: HashMap<Symbol, Expr> = block.unknowns.iter().map(|&z| (z, g.zero())).collect();
    let mut rows = Vec::new();
    for &r in &block.residuals {
        let mut row = BTreeMap::new();
        for z in g.symbols_of(r) {
            let Some(&j) = places.get(&z) else { continue };
            let entry = g.derivative(r, z);
            if g.symbols_of(entry).iter().any(|s| places.contains_key(s)) {
                return None;
            }
            if !g.is_zero(entry) {
                row.insert(j, entry);
            }
        }
        rows.push(row);
    }
    let right = g.substitute_all(&block.residuals, &at_zero).into_iter().map(|r| g.neg(r)).collect();
    Some(LinearBlock { unknowns: block.unknowns.clone(), rows, right })
}

/// Changes the signs of rows so that `J` is its own transpose, where that does it.
fn make_symmetric(g: &Graph, block: &mut LinearBlock) -> bool {
    let n = block.rows.len();
    let mut signs = vec![0_i8; n];
    for start in 0..n {
        if signs[start] != 0 {
            continue;
        }
        signs[start] = 1;
        let mut pending = vec![start];
        while let Some(i) = pending.pop() {
            for (&j, &e) in &block.rows[i] {
                let sign = match block.rows[j].get(&i) {
                    Some(&mirrored) if mirrored == e => signs[i],
                    Some(&mirrored) if mirrored == g.neg(e) => -signs[i],
                    _ => return false,
                };
                match signs[j] {
                    0 => {
                        signs[j] = sign;
                        pending.push(j);
                    }
                    found if found != sign => return false,
                    _ => {}
                }
            }
        }
    }
    for (i, _) in signs.iter().enumerate().filter(|(_, s)| **s < 0) {
        block.rows[i].values_mut().for_each(|e| *e = g.neg(*e));
        block.right[i] = g.neg(block.right[i]);
    }
    true
}

/// The matrix in numbers; `None` where it is not finite or has an empty row or column.
fn pattern(
    equations: &Equations,
    block: &LinearBlock,
    known: &[Symbol],
    points: &[Vec<f64>; POINTS],
) -> Result<Option<Pattern>, CompileError> {
    let g = &equations.graph;
    let entries: Vec<Expr> = block.rows.iter().flat_map(|row| row.values().copied()).collect();
    let mut evaluator = Evaluator::new(g.compile(known, &entries, &equations.parameters)?);
    let mut values: Vec<Vec<f64>> = points.iter().map(|point| evaluator.evaluate(point).to_vec()).collect();
    if !values[1].iter().all(|x| x.is_finite()) {
        values[1] = values[0].clone(); // the point beside it is outside of where the equations mean something
    }
    let mut entry = 0;
    let rows = block.rows.iter().map(|row| {
        row.iter()
            .map(|(&j, &e)| {
                let constant = g.symbols_of(e).iter().all(|s| equations.parameters.contains_key(s));
                let values = std::array::from_fn(|point| values[point][entry]);
                entry += 1;
                (j, Entry { values, constant })
            })
            .collect()
    });
    Ok(Pattern::new(rows.collect()))
}
