//! Tests whether a section is an identity, in expressions with an exact normal form: a zero of that form is a
//! proof.

use std::collections::{HashMap, HashSet};

use equations::Equations;
use mechanics::{Parameter, System};
use symbolic::limits::TOO_LONG;
use symbolic::{Expr, Graph, Symbol, Vanishing};

use crate::family::{Family, costate};

/// Whether the family's equations hold along every motion of `curve` with `η = section`, or with every `η`
/// where that is `None`; wherever both are regular.
///
/// Along such a motion `ẏ` and the unknowns `z` of an instant are those of `curve`, and `f = 0`. So `η̇` is
/// the derivative of the section along them, or an unknown beside `z`. Velocities are put in from `f = 0`;
/// with all unknowns eliminated, which stand linearly, what is left of every equation has to be the number
/// zero. Pivots are not zero identically: what is shown where they differ from zero holds on all of `f = 0`
/// by continuity. What is not an identity for all parameters may be one for those of the system, as written.
pub(crate) fn is_identity(system: &System, curve: &Equations, family: &Family, section: Option<&[Expr]>) -> bool {
    let zero = |(g, rest): (Graph, Vec<Expr>)| g.are_exact(&rest) && rest.iter().all(|&e| vanishes(&g, e));
    [false, true].into_iter().any(|as_written| remainders(system, curve, family, section, as_written).is_some_and(zero))
}

fn vanishes(g: &Graph, e: Expr) -> bool {
    g.vanishes(e, &HashMap::new()) == Vanishing::Exactly
}

/// What is left of the equations, for each choice of signs of velocities that are roots.
fn remainders(
    system: &System,
    curve: &Equations,
    family: &Family,
    section: Option<&[Expr]>,
    as_written: bool,
) -> Option<(Graph, Vec<Expr>)> {
    let equations = &family.equations;
    let g = equations.graph.clone();
    let of_curve = |es: &[Expr]| g.adopt(&curve.graph, es);
    let renamed = |s: Symbol| g.symbol(&curve.graph.name(s));
    let mut z: Vec<Symbol> = curve.unknowns().into_iter().map(renamed).collect();
    let (q, v) = (system.positions(), system.velocities());
    let states: Vec<Symbol> = curve.states.iter().map(|y| renamed(y.symbol)).collect();
    let positions = of_curve(&curve.coordinates);
    if states != [&q[..], &v].concat() || positions != g.variables(&q) || equations.removal.is_some() {
        return None;
    }
    let rates = of_curve(&curve.states.iter().map(|y| y.rate).collect::<Vec<_>>());
    let mut flow: Vec<(Symbol, Expr)> = states.into_iter().zip(rates.iter().copied()).collect();
    flow.push((system.time, g.one()));

    // the equations of the family along the curve
    let etas: Vec<_> = equations.states.iter().filter(|y| costate(y.role)).collect();
    let mut residuals: Vec<Expr> = equations.blocks.iter().flat_map(|b| b.residuals.clone()).collect();
    let explicit: Vec<Expr> = etas.iter().map(|y| y.rate).collect();
    let unknowns = equations.unknowns();
    let is_unknown = |rate: Expr| g.as_symbol(rate).filter(|rate| unknowns.contains(rate));
    let mut put_in: HashMap<Symbol, Expr> =
        system.accelerations().into_iter().zip(rates[q.len()..].iter().copied()).collect();
    let clash = |s: &Symbol| etas.iter().any(|y| y.symbol == *s) || explicit.iter().any(|&e| is_unknown(e) == Some(*s));
    if z.iter().any(clash) {
        return None;
    }
    let mut known: HashSet<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
    known.extend(q.iter().chain(&v).chain([&system.time]));
    match section {
        Some(section) => {
            let section = g.adopt(&system.graph, section);
            put_in.extend(etas.iter().map(|y| y.symbol).zip(section.iter().copied()));
            for (&phi, &rate) in section.iter().zip(&explicit) {
                let along = g.total_derivative(phi, &flow);
                match is_unknown(rate) {
                    Some(unknown) => {
                        put_in.insert(unknown, along);
                    }
                    None => residuals.push(g.sub(rate, along)),
                }
            }
        }
        None => {
            known.extend(etas.iter().map(|y| y.symbol));
            z.extend(explicit.iter().filter_map(|&rate| is_unknown(rate)));
        }
    }
    known.extend(&z);
    let mut all = g.substitute_all(&residuals, &put_in);
    all.extend(of_curve(&curve.blocks.iter().flat_map(|b| b.residuals.clone()).collect::<Vec<_>>()));
    let mut constraints = g.adopt(&system.graph, &system.constraints);
    if as_written {
        let number = |p: &Parameter| (renamed(p.symbol), g.adopt(&system.graph, &[system.written_parameter(p)])[0]);
        let exact = |(_, e): &(Symbol, Expr)| g.are_exact(&[*e]);
        let numbers = system.parameters.iter().map(number).filter(exact).collect();
        (all, constraints) = (g.substitute_all(&all, &numbers), g.substitute_all(&constraints, &numbers));
    }
    let in_terms = all.iter().flat_map(|&e| g.symbols_of(e)).all(|s| known.contains(&s));
    if !in_terms || !g.are_exact(&[&all[..], &constraints].concat()) {
        return None;
    }
    let mut rest = Vec::new();
    for choice in on_constraints(&g, &constraints, &v)? {
        // a velocity may contain later ones
        let put_in = |all: Vec<Expr>, (s, value)| g.substitute_all(&all, &HashMap::from([(s, value)]));
        rest.extend(eliminated(&g, &choice.into_iter().fold(all.clone(), put_in), &z)?);
    }
    Some((g, rest))
}

/// Velocities in terms of the others on `f = 0`, one per constraint, in the order in which they are put in;
/// where constraints are squares, for both signs of every root.
fn on_constraints(g: &Graph, constraints: &[Expr], v: &[Symbol]) -> Option<Vec<Vec<(Symbol, Expr)>>> {
    let Some((&first, others)) = constraints.split_first() else { return Some(vec![Vec::new()]) };
    let slope = |&s: &Symbol| {
        let slope = g.derivative(first, s);
        Some((s, slope)).filter(|_| !v.iter().any(|&w| g.depends_on(slope, w)) && stands(g, slope))
    };
    let cost = |&(_, slope): &(Symbol, Expr)| (g.as_number(slope).is_none(), g.size(&[slope]));
    let at_zero = |e: Expr, s: Symbol| g.substitute(e, &HashMap::from([(s, g.zero())]));
    let roots: Vec<(Symbol, Expr)> = match v.iter().filter_map(slope).min_by_key(cost) {
        Some((s, slope)) => vec![(s, g.neg(g.div(at_zero(first, s), slope)))],
        None => {
            // a s² + c
            let square = |&s: &Symbol| -> Option<(Symbol, Expr)> {
                let slope = g.derivative(first, s);
                let second = g.derivative(slope, s);
                let is_square = stands(g, second) && !g.depends_on(second, s) && vanishes(g, at_zero(slope, s));
                is_square.then_some((s, second))
            };
            let (s, second) = v.iter().filter_map(square).min_by_key(cost)?;
            let root = g.sqrt(g.neg(g.div(g.mul(g.integer(2), at_zero(first, s)), second)));
            vec![(s, root), (s, g.neg(root))]
        }
    };
    let mut all = Vec::new();
    for (s, value) in roots {
        let others = g.substitute_all(others, &HashMap::from([(s, value)]));
        for rest in on_constraints(g, &others, v)? {
            all.push([vec![(s, value)], rest].concat());
        }
    }
    Some(all)
}

/// Whether `e` is a fit pivot: certainly not zero identically.
fn stands(g: &Graph, e: Expr) -> bool {
    matches!(g.vanishes(e, &HashMap::new()), Vanishing::No { .. })
}

/// What is left of equations linear in `z` with `z` eliminated; `None` where they do not determine `z`.
fn eliminated(g: &Graph, equations: &[Expr], z: &[Symbol]) -> Option<Vec<Expr>> {
    let zero: HashMap<Symbol, Expr> = z.iter().map(|&s| (s, g.zero())).collect();
    let slopes = g.jacobian(equations, z);
    if slopes.entries().iter().any(|&e| z.iter().any(|&s| g.depends_on(e, s))) {
        return None;
    }
    let rest = g.substitute_all(equations, &zero);
    let mut rows: Vec<Vec<Expr>> =
        rest.into_iter().enumerate().map(|(i, rest)| [slopes.row(i), &[rest]].concat()).collect();
    let mut left: Vec<usize> = (0..z.len()).collect();
    while !left.is_empty() {
        let places = rows.iter().enumerate().flat_map(|(i, row)| left.iter().map(move |&j| (i, j, row[j])));
        let mut places: Vec<_> = places.filter(|&(.., e)| !g.is_zero(e)).collect();
        places.sort_by_key(|&(i, _, e)| (g.as_number(e).is_none(), g.size(&[e]), g.size(&rows[i])));
        let (i, j, pivot) = places.into_iter().find(|&(.., e)| stands(g, e))?;
        let row = rows.swap_remove(i);
        for other in &mut rows {
            let factor = g.div(other[j], pivot);
            if g.is_zero(factor) {
                continue;
            }
            for (x, &y) in other.iter_mut().zip(&row) {
                *x = g.expand_if_shorter(g.sub(*x, g.mul(factor, y)), TOO_LONG);
            }
            other[j] = g.zero();
            if g.size(other) > TOO_LONG {
                return None;
            }
        }
        left.retain(|&other| other != j);
    }
    Some(rows.into_iter().map(|row| row[z.len()]).collect())
}
