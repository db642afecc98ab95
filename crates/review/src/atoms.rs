//! Single mistakes as what they add to the rows of a derivation.
//!
//! A mistake in a term `τ` of `L`, of a balance or of a constraint's rate adds `κ` times a known column to
//! the rows: `κ = −1` where it is dropped, `−2` where its sign is turned, `1` where it is counted twice. So
//! no derivation is tried for each: which columns make up the residual is a question of linear algebra.

use std::collections::BTreeMap;

use mechanics::System;
use symbolic::limits::TERMS;
use symbolic::{Expr, Function, Graph, Symbol};

use crate::Law;
use crate::reading::Reading;

/// What a mistake is called.
#[derive(Clone, Debug)]
pub(crate) enum Called {
    /// A term, and where it stands; any factor may stand before it.
    Term(String, String),
    /// The same of a sum of terms: a likely explanation only where there is no other.
    Part(String, String),
    /// Only where it is left out.
    LeftOut(String),
    /// Only where its sign is turned.
    Turned(String),
    /// Only as it is.
    Whole(String),
}

/// A mistake, and what it adds to each row.
pub(crate) struct Atom {
    pub(crate) called: Called,
    pub(crate) column: Vec<Expr>,
}

impl Called {
    /// The words for the factor `1 + κ` instead of 1; nothing where it is no such mistake.
    pub(crate) fn words(&self, kappa: f64) -> Option<String> {
        match self {
            Called::Term(term, place) | Called::Part(term, place) => {
                let what = match kappa {
                    -1.0 => "is missing".to_owned(),
                    -2.0 => "has the wrong sign".to_owned(),
                    1.0 => "is counted twice".to_owned(),
                    -0.5 => "is counted half".to_owned(),
                    _ => format!("is counted {} times", 1.0 + kappa),
                };
                Some(if place.is_empty() { format!("`{term}` {what}") } else { format!("`{term}` {what} {place}") })
            }
            Called::LeftOut(words) => (kappa == -1.0).then(|| words.clone()),
            Called::Turned(words) => (kappa == -2.0).then(|| words.clone()),
            Called::Whole(words) => (kappa == 1.0).then(|| words.clone()),
        }
    }
}

/// The terms of `e` as written and multiplied out, each once.
pub(crate) fn terms_of(g: &Graph, e: Expr) -> Vec<Expr> {
    let mut terms = g.terms(e);
    if g.expanded_terms(e) <= TERMS {
        let expanded = g.terms(g.expand(e)).into_iter().filter(|t| !terms.contains(t)).collect::<Vec<Expr>>();
        terms.extend(expanded);
    }
    terms.retain(|&t| !g.is_zero(t));
    terms
}

/// `L` in pieces: the potential, parts of the kinetic energy with the same parameters, terms; with what each
/// is called, and whether only its sign may be turned.
pub(crate) fn pieces(system: &System) -> Vec<(Called, Expr)> {
    let g = &system.graph;
    let v = system.velocities();
    let moves = |e: Expr| v.iter().any(|&s| g.depends_on(e, s));
    let terms = g.terms(g.expand(system.lagrangian));
    let mut pieces = Vec::new();
    let rest: Vec<Expr> = terms.iter().copied().filter(|&t| !moves(t)).collect();
    if !rest.is_empty() {
        let potential = g.sum(&rest);
        pieces.push((Called::Turned("gravity upwards (T + V instead of T − V)".into()), potential));
        if rest.len() > 1 {
            pieces.push((Called::Part("V".into(), "in L".into()), potential));
        }
    }
    let mut alike: BTreeMap<Vec<Expr>, Vec<Expr>> = BTreeMap::new();
    for &t in terms.iter().filter(|&&t| moves(t)) {
        let constants = g.factors(t).into_iter().filter(|&f| system.is_constant(f)).collect();
        alike.entry(constants).or_default().push(t);
    }
    let several = alike.len() > 1;
    for (factors, terms) in alike.into_iter().filter(|(_, terms)| terms.len() > 1 && several) {
        pieces
            .push((Called::Part(g.plain(g.product(&factors)), "in L, wherever it stands in T".into()), g.sum(&terms)));
    }
    let term = |&t: &Expr| match g.expanded_terms(t) {
        1 => (Called::Term(g.plain(t), "in L".into()), t),
        _ => (Called::Part(g.plain(t), "in L".into()), t),
    };
    pieces.extend(terms_of(g, system.lagrangian).iter().map(term));
    pieces
}

/// `t` with one factor more or less: each with what is called.
fn misprints(system: &System, t: Expr, place: &str, all: bool) -> Vec<(Called, Expr)> {
    let g = &system.graph;
    let mut found = Vec::new();
    for factor in g.factors(t) {
        let symbols = g.symbols_of(factor);
        let constant = system.is_constant(factor) && !symbols.is_empty();
        if !constant && !all {
            continue;
        }
        let mut add = |words: String, other: Expr| {
            let words = format!("{words} `{}` {place}", g.plain(t));
            found.push((Called::Whole(words.trim_end().to_owned()), g.sub(other, t)));
        };
        add(format!("factor {} is dropped in", g.plain(factor)), g.div(t, factor));
        if let [s] = symbols.iter().copied().collect::<Vec<Symbol>>()[..] {
            let x = g.variable(s);
            if factor != x && (constant || g.factors(factor) == [g.powi(x, 2)]) {
                add(format!("power of {} is dropped in", g.name(s)), g.mul(g.div(t, factor), x));
            }
            if constant {
                add(format!("factor {} is once too many in", g.name(s)), g.mul(t, x));
            }
            let [sine, cosine] = [Function::Sin, Function::Cos].map(|f| g.call(f, x));
            if factor == sine {
                add("cosine for sine in".into(), g.mul(g.div(t, sine), cosine));
            } else if factor == cosine {
                add("sine for cosine in".into(), g.mul(g.div(t, cosine), sine));
            }
        }
    }
    found
}

/// All single mistakes in the balances and rates of constraints of the scene, likely ones first.
pub(crate) fn atoms(reading: &Reading) -> Vec<Atom> {
    let system = &reading.system;
    let (g, n, h) = (&system.graph, system.dimension(), system.constraints.len());
    let (q, v, flow) = (system.positions(), system.velocities(), system.flow());
    let mut found: Vec<(Called, Vec<Expr>)> = Vec::new();
    let rows = |entries: &[(usize, Expr)]| {
        let mut rows = vec![g.zero(); n + h];
        entries.iter().for_each(|&(i, e)| rows[i] = g.add(rows[i], e));
        rows
    };
    let balances = |l: Expr| {
        let rows = system.balances(&g.gradient(l, &v), &[&g.gradient(l, &q)], &flow);
        rows.into_iter().chain(vec![g.zero(); h]).collect::<Vec<Expr>>()
    };
    let name = |i: usize| &system.coordinates[i].name;
    let still: Vec<(Symbol, Expr)> = flow.iter().copied().filter(|(s, _)| !v.contains(s)).collect();
    let rates = g.total_derivatives(&system.constraints, &flow);
    let driven = g.total_derivatives(&system.constraints, &still);
    for (called, l) in pieces(system) {
        found.push((called, balances(l)));
    }
    // the rate of the rows: of all constraints, and of each
    let all: Vec<(usize, Expr)> = driven.iter().enumerate().map(|(j, &e)| (n + j, e)).collect();
    found.push((Called::LeftOut(Law::MissingRate.words().into()), rows(&all)));
    for &(row, e) in all.iter().filter(|_| h > 1) {
        let words = format!("rate of the coefficients of constraint {} left out", row - n + 1);
        found.push((Called::LeftOut(words), rows(&[(row, e)])));
    }
    let momenta = g.gradient(system.lagrangian, &v);
    let gradient = g.gradient(system.lagrangian, &q);
    let carried = g.total_derivatives(&momenta, &still);
    let every = |of: &[Expr], sign: i64| {
        let of: Vec<(usize, Expr)> = of.iter().enumerate().map(|(i, &e)| (i, g.mul(g.integer(sign), e))).collect();
        of
    };
    found.push((Called::LeftOut("∂L/∂q left out".into()), rows(&every(&gradient, -1))));
    found.push((Called::Turned("∂L/∂q with the wrong sign".into()), rows(&every(&gradient, -1))));
    found.push((Called::LeftOut("rate of the mass matrix left out in d/dt ∂L/∂v".into()), rows(&every(&carried, 1))));
    for i in 0..n {
        let (force, slope) = (g.neg(system.forces[i]), g.neg(gradient[i]));
        found.push((Called::LeftOut(format!("∂L/∂{} left out", name(i))), rows(&[(i, slope)])));
        found.push((Called::Turned(format!("∂L/∂{} with the wrong sign", name(i))), rows(&[(i, slope)])));
        let words = format!("rate of the coefficients of ∂L/∂{}' left out", name(i));
        found.push((Called::LeftOut(words), rows(&[(i, carried[i])])));
        if g.is_zero(force) {
            continue;
        }
        found.push((Called::Term(format!("Q_{}", name(i)), String::new()), rows(&[(i, force)])));
        for j in (0..n).filter(|&j| j != i) {
            let words = format!("force `{}` on {} instead of {}", g.plain(system.forces[i]), name(j), name(i));
            found.push((Called::Whole(words), rows(&[(i, system.forces[i]), (j, force)])));
        }
    }
    let balance = system.balances(&momenta, &[&gradient, &system.forces], &flow);
    let named = (0..n).map(|i| format!("in the equation for {}", name(i)));
    let places: Vec<String> = named.chain((1..=h).map(|j| format!("in the rate of constraint {j}"))).collect();
    let terms: Vec<Vec<Expr>> = balance.iter().chain(&rates).map(|&e| terms_of(g, e)).collect();
    for (i, terms) in terms.iter().enumerate() {
        found.extend(terms.iter().map(|&t| (Called::Term(g.plain(t), places[i].clone()), rows(&[(i, t)]))));
    }
    for &x in &q {
        let words = format!("{} turns the other way in L, as by a rotation transposed", g.name(x));
        found.push((Called::Whole(words), balances(g.sub(turned(g, system.lagrangian, x), system.lagrangian))));
    }
    for t in terms_of(g, system.lagrangian) {
        found.extend(misprints(system, t, "of L", false).into_iter().map(|(called, l)| (called, balances(l))));
    }
    for (i, terms) in terms.iter().enumerate() {
        let wrong = terms.iter().flat_map(|&t| misprints(system, t, &places[i], true));
        found.extend(wrong.map(|(called, e)| (called, rows(&[(i, e)]))));
    }
    found.retain(|(_, column)| column.iter().any(|&e| !g.is_zero(e)));
    let of = |(called, column): (Called, Vec<Expr>)| Atom { called, column: reading.of_scene(g, &column) };
    found.into_iter().map(of).collect()
}

/// `e` with `−sin x` for `sin x`: a rotation by `x` that is transposed.
fn turned(g: &Graph, e: Expr, x: Symbol) -> Expr {
    let sine = g.call(Function::Sin, g.variable(x));
    g.replace(e, &[(sine, g.neg(sine))].into_iter().collect())
}

/// The constraints with one of them written wrong in one term, or all in one way; what is wrong.
pub(crate) fn wrong_constraints(system: &System) -> Vec<(Vec<Expr>, String)> {
    let (g, own) = (&system.graph, &system.constraints);
    let mut found: Vec<(Vec<Expr>, String)> = Vec::new();
    for p in &system.parameters {
        let negative = [(p.symbol, g.neg(g.variable(p.symbol)))].into_iter().collect();
        let words =
            format!("{} has the wrong sign in the constraints, as for a contact on the other side", g.name(p.symbol));
        found.push((g.substitute_all(own, &negative), words));
    }
    for x in system.positions() {
        let words = format!("{} turns the other way in the constraints, as by a rotation transposed", g.name(x));
        found.push((own.iter().map(|&f| turned(g, f, x)).collect(), words));
    }
    for (i, &f) in own.iter().enumerate() {
        let mut add = |f: Expr, words: String| {
            let mut all = own.clone();
            all[i] = f;
            found.push((all, format!("{words} in constraint {}", i + 1)));
        };
        for x in system.positions() {
            let [sine, cosine] = [Function::Sin, Function::Cos].map(|f| g.call(f, g.variable(x)));
            let exchanged = g.replace(f, &[(sine, cosine), (cosine, sine)].into_iter().collect());
            add(exchanged, format!("sine and cosine of {} are exchanged", g.name(x)));
        }
        let terms = terms_of(g, f);
        for &t in terms.iter().filter(|_| terms.len() > 1) {
            for (kappa, factor) in
                [(-1.0, g.integer(-1)), (-2.0, g.integer(-2)), (1.0, g.one()), (-0.5, g.ratio(-1, 2))]
            {
                let words = Called::Term(g.plain(t), String::new()).words(kappa).unwrap_or_default();
                add(g.add(f, g.mul(factor, t)), words);
            }
            for (called, change) in misprints(system, t, "", true) {
                add(g.add(f, change), called.words(1.0).unwrap_or_default());
            }
        }
    }
    found.retain(|(all, _)| all != own);
    found
}
