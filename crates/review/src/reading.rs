//! Somebody's equations as expressions `F(q̈, q̇, q, t, unknowns) = 0` beside those of the scene.

use std::cell::RefCell;
use std::collections::HashMap;

use mechanics::System;
use scene::Scene;
use symbolic::{Expr, Graph, Scope, Symbol, Value, names_in};

use crate::ReviewError;

/// A line of their text in the notation of scenes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    /// `FILE:LINE`.
    pub(crate) place: String,
    /// `left = right`, or what is zero.
    pub(crate) text: String,
    /// Whether the name on the left stands for the right from here on, whatever it was before.
    pub(crate) defines: bool,
}

/// One of their equations: `expression = 0`.
#[derive(Clone, Debug)]
pub(crate) struct Stated {
    pub(crate) expression: Expr,
    pub(crate) text: String,
}

/// Both sides in one graph and in the same variables, theirs.
pub(crate) struct Reading {
    /// That of the scene, in a graph that knows their names as well.
    pub(crate) system: System,
    /// Their coordinates, and those of the scene that they share or leave out, with rates and second rates.
    pub(crate) coordinates: Vec<[Symbol; 3]>,
    /// Numbers that may have any value, with the one of the scene.
    pub(crate) parameters: Vec<(Symbol, f64)>,
    /// Names of the scene as formulas of these.
    pub(crate) map: HashMap<Symbol, Expr>,
    pub(crate) equations: Vec<Stated>,
    /// Unknowns without rate: multipliers, under whatever name.
    pub(crate) multipliers: Vec<Symbol>,
    /// Unknowns with a rate, and that: quasi-velocities, or multipliers that have a history.
    pub(crate) states: Vec<[Symbol; 2]>,
}

impl Reading {
    /// The rates of their variables, for total derivatives.
    pub(crate) fn flow(&self) -> Vec<(Symbol, Expr)> {
        let g = &self.system.graph;
        let states = self.states.iter().map(|&[s, rate]| (s, g.variable(rate)));
        flow(&self.system, &self.coordinates).into_iter().chain(states).collect()
    }

    /// Expressions of the scene in their variables, `g` being their graph.
    pub(crate) fn of_scene(&self, g: &Graph, es: &[Expr]) -> Vec<Expr> {
        if self.map.is_empty() { es.to_vec() } else { g.substitute_all(es, &self.map) }
    }
}

fn flow(system: &System, coordinates: &[[Symbol; 3]]) -> Vec<(Symbol, Expr)> {
    let g = &system.graph;
    let moves = coordinates.iter().flat_map(|&[q, v, a]| [(q, g.variable(v)), (v, g.variable(a))]);
    moves.chain([(system.time, g.one())]).collect()
}

/// A coordinate with the symbols of its rates, under a name.
fn coordinate(g: &Graph, name: &str) -> [Symbol; 3] {
    ["", "'", "''"].map(|primes| g.symbol(&format!("{name}{primes}")))
}

/// Name and number of primes.
fn base(name: &str) -> (&str, usize) {
    let stem = name.trim_end_matches('\'');
    (stem, name.len() - stem.len())
}

struct Names<'a> {
    g: &'a Graph,
    system: &'a System,
    known: HashMap<String, Expr>,
    flow: Vec<(Symbol, Expr)>,
    definitions: RefCell<HashMap<String, Expr>>,
    /// Names that nobody knows, with the most primes they have.
    unknown: RefCell<Vec<(String, usize)>>,
    /// Whether names may be unknown.
    open: bool,
}

impl Names<'_> {
    /// What `name` means, unless it is an unknown.
    fn find(&self, name: &str) -> Option<Expr> {
        let own = |name: &str| self.definitions.borrow().get(name).or_else(|| self.known.get(name)).copied();
        let (stem, primes) = base(name);
        // x_dot, xdot: a coordinate with dots
        let ends = [("_ddot", "''"), ("ddot", "''"), ("_dot", "'"), ("dot", "'")].into_iter();
        let dotted = |(end, dots): (&str, &str)| own(&format!("{}{dots}", name.strip_suffix(end)?));
        let rate = || {
            let e = self.definitions.borrow().get(stem).copied().filter(|_| primes > 0)?;
            Some((0..primes).fold(e, |e, _| self.g.total_derivative(e, &self.flow)))
        };
        own(name).or_else(|| ends.clone().find_map(dotted)).or_else(rate)
    }
}

impl Scope for Names<'_> {
    fn value(&self, name: &str) -> Option<Value> {
        if let Some(e) = self.find(name) {
            return Some(Value::Scalar(e));
        }
        let (stem, primes) = base(name);
        let taken = self.known.contains_key(stem) || self.system.graph.parse(stem, &|_: &str| None).is_ok();
        if !self.open || taken || primes > 1 {
            return None;
        }
        let mut unknown = self.unknown.borrow_mut();
        match unknown.iter_mut().find(|(own, _)| own == stem) {
            Some((_, most)) => *most = primes.max(*most),
            None => unknown.push((stem.to_owned(), primes)),
        }
        Some(Value::Scalar(self.g.variable(self.g.symbol(name))))
    }

    fn rate(&self, e: Expr) -> Option<Expr> {
        Some(self.g.total_derivative(e, &self.flow))
    }

    fn known(&self) -> &[String] {
        &[]
    }
}

/// Reads `lines`; `wheres` are formulas `NAME = …` for coordinates and parameters of the scene, in their
/// names.
///
/// # Errors
/// [`ReviewError`] with the place.
pub(crate) fn read(scene: &Scene, lines: &[Line], wheres: &[String]) -> Result<Reading, ReviewError> {
    let own_system = scene.system.clone();
    let (system, g) = (&own_system, &own_system.graph);
    let mapped: Vec<(&str, &str)> = wheres.iter().map(|text| split_where(system, text)).collect::<Result<_, _>>()?;
    let is_mapped = |name: &str| mapped.iter().any(|(own, _)| *own == name);
    let is_coordinate = |name: &str| system.coordinates.iter().any(|c| c.name == name);
    let mut coordinates: Vec<[Symbol; 3]> = Vec::new();
    for c in system.coordinates.iter().filter(|c| !is_mapped(&c.name)) {
        coordinates.push([c.position, c.velocity, c.acceleration]);
    }
    let values = system.parameter_values();
    let formula = |symbol: Symbol, value: f64| {
        let written = scene.completion.written.iter().find(|(s, _)| *s == symbol).map(|(_, e)| *e);
        written.filter(|&e| !g.symbols_of(e).is_empty() && g.evaluate(e, &values) == Ok(value))
    };
    let own = system.parameters.iter().filter(|p| !is_mapped(&g.name(p.symbol)));
    // a parameter that is a formula of others follows them, which may have any value
    let (follow, free): (Vec<_>, Vec<_>) = own.partition(|p| formula(p.symbol, p.value).is_some());
    let mut parameters: Vec<(Symbol, f64)> = free.iter().map(|p| (p.symbol, p.value)).collect();
    let mut map: HashMap<Symbol, Expr> = HashMap::new();
    let moves = |name: &str| {
        let primed =
            |text: &str| names_in(text).iter().any(|(n, at)| *n == name && text[at + n.len()..].starts_with('\''));
        lines.iter().any(|line| line.text.split('=').any(primed))
    };
    for (own, formula) in &mapped {
        for (name, _) in names_in(formula) {
            let symbol = g.symbol(name);
            let known = coordinates.iter().any(|c| c[0] == symbol) || parameters.iter().any(|p| p.0 == symbol);
            let is_function = formula.contains(&format!("{name}("));
            if known || symbol == system.time || name == "pi" || is_function {
                continue;
            }
            if is_coordinate(own) && moves(name) {
                coordinates.push(coordinate(g, name));
            } else {
                parameters.push((symbol, 1.0));
            }
        }
    }
    let mut names = Names {
        g,
        system,
        known: HashMap::new(),
        flow: Vec::new(),
        definitions: RefCell::default(),
        unknown: RefCell::default(),
        open: false,
    };
    names.known.insert("t".into(), g.variable(system.time));
    names.known.extend(parameters.iter().map(|(s, _)| (g.name(*s), g.variable(*s))));
    names.known.extend(coordinates.iter().flatten().map(|s| (g.name(*s), g.variable(*s))));
    names.flow = flow(system, &coordinates);
    for ((own, formula), text) in mapped.iter().zip(wheres) {
        let fault = |e: symbolic::ParseError| ReviewError::Where { text: text.clone(), what: e.kind.to_string() };
        let mut e = g.parse(formula, &names).map_err(fault)?;
        for primes in ["", "'", "''"].iter().take(if is_coordinate(own) { 3 } else { 1 }) {
            map.insert(g.symbol(&format!("{own}{primes}")), e);
            e = g.total_derivative(e, &names.flow);
        }
    }
    for p in follow {
        let e = formula(p.symbol, p.value).unwrap_or(g.zero());
        map.insert(p.symbol, g.substitute(e, &map));
    }
    // where both sides have a name, theirs counts
    for (s, e) in &map {
        names.known.entry(g.name(*s)).or_insert(*e);
    }
    names.open = true;
    let mut equations = Vec::new();
    for line in lines {
        equations.extend(state(&names, line)?);
    }
    let (mut multipliers, mut states) = (Vec::new(), Vec::new());
    for (name, primes) in names.unknown.into_inner() {
        let [s, rate, _] = coordinate(g, &name);
        if primes == 0 { multipliers.push(s) } else { states.push([s, rate]) }
    }
    Ok(Reading { system: own_system, coordinates, parameters, map, equations, multipliers, states })
}

/// The parts of `NAME = FORMULA`.
fn split_where<'t>(system: &System, text: &'t str) -> Result<(&'t str, &'t str), ReviewError> {
    let fault = |what: &str| ReviewError::Where { text: text.into(), what: what.into() };
    let (own, formula) = text.split_once('=').ok_or_else(|| fault("this is not NAME=FORMULA"))?;
    let own = own.trim();
    let known = system.coordinates.iter().any(|c| c.name == own)
        || system.parameters.iter().any(|p| system.graph.name(p.symbol) == own);
    if !known {
        return Err(fault(&format!("`{own}` is neither a coordinate nor a parameter of the scene")));
    }
    Ok((own, formula.trim()))
}

/// What one line says; nothing where it defines a name.
fn state(names: &Names, line: &Line) -> Result<Option<Stated>, ReviewError> {
    let (g, text) = (names.g, line.text.as_str());
    let parse = |part: &str, offset: usize| {
        g.parse(part, names).map_err(|mut error| {
            error.offset += offset;
            error.text = text.into();
            error.also = Box::default();
            ReviewError::Formula { place: line.place.clone(), error: Box::new(error) }
        })
    };
    let Some((left, right)) = text.split_once('=') else {
        return Ok(Some(Stated { expression: parse(text, 0)?, text: text.into() }));
    };
    let offset = left.len() + 1;
    let (right, offset) = right.strip_prefix('=').map_or((right, offset), |right| (right, offset + 1));
    if right.contains('=') {
        let what = "more than one `=` stands in the line".into();
        return Err(ReviewError::Unreadable { place: line.place.clone(), what });
    }
    let name = left.trim();
    let is_name = names_in(name) == [(name, 0)];
    let used = || names.unknown.borrow().iter().any(|(own, _)| own == name);
    if line.defines || is_name && names.find(name).is_none() && !used() {
        let e = parse(right, offset)?;
        if line.defines || !used() {
            names.definitions.borrow_mut().insert(name.into(), e);
            return Ok(None);
        }
    }
    let expression = g.sub(parse(left, 0)?, parse(right, offset)?);
    Ok(Some(Stated { expression, text: text.trim().into() }))
}
