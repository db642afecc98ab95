//! The cheapest plan that is safe at the start and near it.

use std::collections::HashSet;

use symbolic::limits::{self, TOO_LONG};
use symbolic::{CompileError, Evaluator, Expr, Symbol};

use super::chosen::Plan;
use super::common_factors::collected;
use super::elimination::{Eliminated, Elimination};
use super::linear_block::{LinearBlock, linear_block, make_symmetric, pattern};
use super::pivots::{NEAR, Order, POINTS, Pattern, Strategy};
use crate::definitions::{apart, symbols_behind};
use crate::equations::{Block, Equations};

/// Expressions up to these sizes stay inside others: long ones let terms meet that cancel, short ones keep
/// products apart that are used more than once.
const LONG_PARTS: usize = 12;
const SHORT_PARTS: usize = 3;

/// Multiplications over which only one way is tried.
const LONG: usize = 400;

/// A full block of this size takes as much eliminated as factorized.
const FULL: usize = 5;

/// A condition of a plan, at one of the points around the start, over which that counts as bad.
const BAD: f64 = 1e3;

/// What LU factorization takes, in the multiplications of an elimination, which are products of series: for
/// each order `J z`, and an exact solution by the factors, numbers all of them. Measured on blocks of
/// [`FULL`] unknowns and more, full and sparse; smaller ones are eliminated.
fn factorized(size: usize, entries: usize) -> usize {
    2 * entries + 3 * size * size / 4
}

impl Plan {
    /// The cheapest plan that is safe near `(t, y, free constants)`, or near a point that stands for all.
    ///
    /// # Errors
    /// [`CompileError`] as [`crate::Compiled::new`].
    ///
    /// # Panics
    /// If the point has not one entry for time and each state and free constant.
    pub fn choose(equations: &Equations, point: Option<&[f64]>) -> Result<Plan, CompileError> {
        Plan::search(equations, point, true)
    }

    /// The cheapest plan without a factorization where there is one, as lanes need it, and as
    /// [`Plan::choose`] finds it.
    ///
    /// # Errors
    /// As [`Plan::choose`].
    pub fn eliminated(equations: &Equations, point: Option<&[f64]>) -> Result<Plan, CompileError> {
        Plan::search(equations, point, false)
    }

    fn search(equations: &Equations, point: Option<&[f64]>, priced: bool) -> Result<Plan, CompileError> {
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
            match eliminated(equations, block, &known, (&points, &around), names, priced)? {
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
    (0..limits::POINTS).map(|k| first.iter().enumerate().map(shifted(k)).collect()).collect()
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
    definitions: Eliminated,
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
        let price = way_taken.tape().len() * (limits::POINTS + 4 * bad);
        if self.best.as_ref().is_none_or(|best| price < best.price) {
            self.best = Some(Best { price, definitions: found, way, clean: bad == 0 });
        }
        Ok(())
    }
}

/// Eliminated for one block with words about them, or why there are none.
type Outcome = Result<(Eliminated, String), String>;

fn eliminated(
    equations: &Equations,
    block: &Block,
    known: &[Symbol],
    (points, around): (&[Vec<f64>; POINTS], &[Vec<f64>]),
    names: usize,
    priced: bool,
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
    let mut orders: Vec<_> =
        ways.into_iter().filter_map(|w| Some((w, pattern.order(w, &unneeded, TOO_LONG)?))).collect();
    orders.sort_by_key(|(_, order)| order.operations);
    if orders.first().is_some_and(|(_, order)| order.operations > LONG) {
        orders.truncate(1);
    }
    let operations = orders.first().map_or(0, |(_, order)| order.operations);
    if priced && size >= FULL && operations > factorized(size, pattern.entries()) {
        return Ok(Err(format!("{size} unknowns, most of them in most equations: LU factorization takes less")));
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

fn guarded(found: &Eliminated) -> String {
    match found.moving {
        0 => "no multiplier of the elimination can become large".into(),
        1 => "one pivot is watched, LU factorization where it is small".into(),
        count => format!("{count} pivots are watched, LU factorization where one is small"),
    }
}
