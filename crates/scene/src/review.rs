//! What a reviewer would ask about a scene that can be read.

use std::collections::{HashMap, HashSet};

use mechanics::{Body, Kind, State, System, View};
use symbolic::limits::SAME;
use symbolic::{Evaluator, Expr, Graph, SplitMix, Symbol, names_in};
use toml::de::DeValue;

use super::context::Context;
use super::section::Section;
use crate::{Remark, SceneError, SceneErrorKind};

/// Sections whose formulas make a name one that is used; words of the other keys are not formulas.
const WORDS: [&str; 11] =
    ["title", "source", "notes", "unit", "shape", "of", "on", "law", "parameters", "definitions", "joint"];

/// All that is remarkable, in the order of the file.
pub(super) fn remarks(context: &Context, view: &View, start: &State) -> Vec<SceneError> {
    let reviewer = Reviewer::new(context, start);
    let mut found = unused(context);
    found.extend(masses(context));
    found.extend(reviewer.kinetic_energy());
    found.extend(reviewer.weight(view));
    found.extend(reviewer.driving());
    found.extend(reviewer.slips(view));
    found.sort_by_key(|remark| (remark.line, remark.column));
    found
}

/// Names in all formulas of a value.
fn names(value: &DeValue, found: &mut HashSet<String>) {
    match value {
        DeValue::String(text) => found.extend(names_in(text).into_iter().map(|(name, _)| name.to_owned())),
        DeValue::Array(array) => array.iter().for_each(|item| names(item.get_ref(), found)),
        DeValue::Table(table) => {
            let formulas = table.iter().filter(|(key, value)| {
                let is_word = value.get_ref().as_str().is_some() && WORDS.contains(&key.get_ref().as_ref());
                !is_word
            });
            formulas.for_each(|(_, value)| names(value.get_ref(), found));
        }
        _ => {}
    }
}

/// Parameters and definitions that no formula uses.
fn unused(context: &Context) -> Vec<SceneError> {
    let sections = ["parameters", "definitions"].map(|key| context.root.section(key).ok().flatten());
    let made = &context.follows.made.definitions;
    let mut used = HashSet::new();
    let others = context.root.entries().filter(|entry| !WORDS.contains(&entry.key));
    others.for_each(|entry| names(entry.value, &mut used));
    loop {
        let before = used.len();
        for entry in sections.iter().flatten().flat_map(Section::entries) {
            if used.contains(entry.key) {
                names(entry.value, &mut used);
            }
        }
        if used.len() == before {
            break;
        }
    }
    let all = sections.iter().flatten().flat_map(Section::entries);
    let idle = all.filter(|entry| !used.contains(entry.key) && made.iter().all(|made| made.name != entry.key));
    let remark = |entry: super::section::Entry| {
        entry.error_at_key(SceneErrorKind::Remark(Remark::Unused { name: entry.key.to_owned() }))
    };
    idle.map(remark).collect()
}

/// Masses below zero, and moments that no body has.
fn masses(context: &Context) -> Vec<SceneError> {
    let section = context.root.section("body").ok().flatten();
    let mut found = Vec::new();
    for body in section.iter().flat_map(Section::entries).filter_map(|entry| entry.section().ok()) {
        let name = |what| format!("{what} of [{}]", body.path);
        if let Some(entry) = body.get("mass")
            && let Some(value) = context.constant(&entry).ok().filter(|mass| *mass < 0.0)
        {
            found.push(entry.error(SceneErrorKind::Remark(Remark::Negative { what: name("the mass"), value })));
        }
        let Some(entry) = body.get("inertia") else { continue };
        let rows = entry.elements("").unwrap_or_default();
        let moment = |k: usize| {
            let row = rows.get(k)?;
            let element = row.elements("").ok().and_then(|row| row.into_iter().nth(k)).unwrap_or_else(|| row.clone());
            context.constant(&element).ok()
        };
        let (Some(a), Some(b), Some(c)) = (moment(0), moment(1), moment(2)) else { continue };
        let moments = [a, b, c];
        let largest = moments.into_iter().fold(0.0, f64::max);
        if let Some(&value) = moments.iter().find(|moment| **moment < 0.0) {
            found.push(entry.error(SceneErrorKind::Remark(Remark::Negative { what: name("a moment"), value })));
        } else if moments.iter().all(|m| *m > 0.0) && 2.0 * largest > (a + b + c) * (1.0 + SAME) {
            found.push(entry.error(SceneErrorKind::Remark(Remark::Moments { moments })));
        }
    }
    found
}

struct Reviewer<'c> {
    context: &'c Context<'c>,
    start: &'c State,
    values: HashMap<Symbol, f64>,
    /// Orthonormal rows that span those of `∂f/∂v` at the start.
    normals: Vec<Vec<f64>>,
}

impl<'c> Reviewer<'c> {
    fn new(context: &'c Context<'c>, start: &'c State) -> Self {
        let system = &context.system;
        let mut reviewer = Reviewer { context, start, values: system.values_at(start), normals: Vec::new() };
        for &f in &system.constraints {
            let row = reviewer.gradient(f, &system.velocities(), &reviewer.values);
            let length = norm(&row);
            let rest = reviewer.admissible(row);
            if norm(&rest) > SAME * length {
                let length = norm(&rest);
                reviewer.normals.push(rest.into_iter().map(|x| x / length).collect());
            }
        }
        reviewer
    }

    fn value(&self, e: Expr, values: &HashMap<Symbol, f64>) -> f64 {
        self.context.system.graph.evaluate(e, values).unwrap_or(f64::NAN)
    }

    fn gradient(&self, e: Expr, symbols: &[Symbol], values: &HashMap<Symbol, f64>) -> Vec<f64> {
        let gradient = self.context.system.graph.gradient(e, symbols);
        gradient.into_iter().map(|e| self.value(e, values)).collect()
    }

    /// The part of a velocity that the constraints admit.
    fn admissible(&self, mut w: Vec<f64>) -> Vec<f64> {
        for normal in self.normals.iter().chain(&self.normals) {
            let along = dot(normal, &w);
            w.iter_mut().zip(normal).for_each(|(w, n)| *w -= along * n);
        }
        w
    }

    /// Admissible directions: those of the coordinates, then random ones.
    fn directions(&self) -> Vec<Vec<f64>> {
        let n = self.context.system.dimension();
        let mut random = SplitMix::new(1);
        let unit = (0..n).map(|i| (0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect());
        let random = (0..n + 4).map(|_| (0..n).map(|_| random.unit() - 0.5).collect());
        unit.chain(random).map(|w| self.admissible(w)).collect()
    }

    fn of_system(&self, key: &str, remark: Remark) -> SceneError {
        let root = &self.context.root;
        let system = root.section("system").ok().flatten();
        let entry = system.as_ref().and_then(|system| system.get(key));
        let span = entry.map(|entry| entry.key_span).or(system.map(|system| system.span));
        let bodies = || root.get("body").map(|bodies| bodies.key_span);
        let span = span.filter(|span| !span.is_empty()).or_else(bodies).unwrap_or(0..0);
        self.context.source.error(&span, SceneErrorKind::Remark(remark))
    }

    /// `wᵀ M w < 0` for an admissible `w`.
    fn kinetic_energy(&self) -> Option<SceneError> {
        let system = &self.context.system;
        let hessian = system.velocity_hessian();
        let entries: Vec<f64> = hessian.entries().iter().map(|&e| self.value(e, &self.values)).collect();
        let n = system.dimension();
        let size = entries.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        // by the circles of Gershgorin
        let is_positive =
            |i: usize| 2.0 * entries[i * n + i] >= entries[i * n..(i + 1) * n].iter().map(|x| x.abs()).sum::<f64>();
        if (0..n).all(is_positive) {
            return None;
        }
        let energy = |w: &Vec<f64>| -> f64 { (0..n).map(|i| w[i] * dot(&entries[i * n..(i + 1) * n], w)).sum() };
        let least = self.directions().iter().map(|w| energy(w) / dot(w, w).max(SAME)).fold(f64::INFINITY, f64::min);
        let negative = least < -SAME * size;
        negative.then(|| self.of_system("lagrangian", Remark::KineticEnergy { value: least }))
    }

    /// What the parameter `g` gives to `L` should fall with the height of what is drawn.
    fn weight(&self, view: &View) -> Option<SceneError> {
        let system = &self.context.system;
        let g = &system.graph;
        let gravity = g.find_symbol("g").filter(|g| system.parameters.iter().any(|p| p.symbol == *g))?;
        let weight = g.derivative(system.lagrangian, gravity);
        let q = system.positions();
        let moved: Vec<_> = view.bodies.iter().filter(|body| view.is_moved(system, body)).collect();
        let heights: Vec<Expr> = moved.iter().map(|body| body.at[2]).collect();
        let mut values = self.values.clone();
        values.extend(system.velocities().into_iter().map(|v| (v, 0.0)));
        let tape = view.graph.compile(&[&[system.time], &q[..]].concat(), &heights, &system.parameter_values()).ok()?;
        let mut program = Evaluator::<f64>::new(tape);
        let mut height = |q: &[f64]| program.evaluate(&[&[self.start.t], q].concat()).iter().sum::<f64>();
        let mut random = SplitMix::new(2);
        let mut grows = 0;
        for _ in 0..5 {
            let at: Vec<f64> = self.start.q.iter().map(|x| x + 0.1 * (random.unit() - 0.5)).collect();
            values.extend(q.iter().copied().zip(at.iter().copied()));
            let lifts: Vec<f64> = (0..at.len())
                .map(|i| {
                    let [up, down] = [1e-5, -1e-5].map(|step| {
                        let mut moved = at.clone();
                        moved[i] += step;
                        height(&moved)
                    });
                    (up - down) / 2e-5
                })
                .collect();
            let up = self.admissible(lifts);
            let lift = dot(&up, &up);
            let gain = dot(&self.gradient(weight, &q, &values), &up);
            if !(lift > 1e-6 && gain > 1e-6 * lift) {
                return None;
            }
            grows += 1;
        }
        let bodies = moved.iter().map(|body| body.name.clone()).collect::<Vec<_>>().join(", ");
        (grows > 0).then(|| self.of_system("lagrangian", Remark::Weight { bodies }))
    }

    /// Forces that depend on velocities and drive whichever way the system moves.
    fn driving(&self) -> Option<SceneError> {
        let system = &self.context.system;
        let velocities = system.velocities();
        let depends = |&e: &Expr| velocities.iter().any(|&v| system.graph.depends_on(e, v));
        if !system.forces.iter().any(depends) {
            return None;
        }
        let force = |v: &[f64]| -> Vec<f64> {
            let mut values = self.values.clone();
            values.extend(velocities.iter().copied().zip(v.iter().copied()));
            system.forces.iter().map(|&e| self.value(e, &values)).collect()
        };
        let at_rest = force(&vec![0.0; velocities.len()]);
        let power = |v: &[f64]| dot(&force(v), v) - dot(&at_rest, v);
        let least = |w: &Vec<f64>| {
            let back: Vec<f64> = w.iter().map(|x| -x).collect();
            power(w).min(power(&back))
        };
        let powers: Vec<f64> = self.directions().iter().map(least).collect();
        let value = powers.iter().copied().fold(0.0, f64::max);
        let drives = value > SAME && powers.iter().all(|power| *power > -SAME * value);
        drives.then(|| self.of_system("forces", Remark::Driving { value }))
    }

    /// Contacts of the picture where a wheel slips or a blade moves sideways, although there are constraints.
    fn slips(&self, view: &View) -> Vec<SceneError> {
        let (context, system, g) = (self.context, &self.context.system, &view.graph);
        let Some(section) = context.root.section("view").ok().flatten().filter(|_| !system.constraints.is_empty())
        else {
            return Vec::new();
        };
        let (mut contacts, mut slips) = (Vec::new(), Vec::new());
        for (i, body) in view.bodies.iter().enumerate() {
            for touch in &body.touches {
                let [here, there] = [body, &view.bodies[touch.body]].map(|body| material(system, g, body, touch.at));
                let against: [Expr; 3] = std::array::from_fn(|k| g.sub(here[k], there[k]));
                let sideways = (0..3).map(|k| g.mul(body.rotation.entries()[3 * k + 1], against[k]));
                slips.extend(match body.shape.kind {
                    Kind::Disc | Kind::Ball | Kind::Ellipsoid | Kind::Cylinder => against,
                    Kind::Blade | Kind::Cart => [sideways.fold(g.zero(), |sum, e| g.add(sum, e)), g.zero(), g.zero()],
                    _ => [g.zero(); 3],
                });
                contacts.push((i, touch.body));
            }
        }
        let inputs = [&[system.time], &system.positions()[..], &system.velocities()].concat();
        let Ok(tape) = g.compile(&inputs, &slips, &system.parameter_values()) else { return Vec::new() };
        let mut program = Evaluator::<f64>::new(tape);
        let mut largest = vec![(0.0_f64, String::new()); view.bodies.len()];
        let still = vec![0.0; system.dimension()];
        for w in [still].into_iter().chain(self.directions()) {
            let v: Vec<f64> = self.start.v.iter().zip(&w).map(|(v, w)| v + w).collect();
            let mut values = self.values.clone();
            values.extend(system.velocities().into_iter().zip(v.iter().copied()));
            let size = 1.0 + norm(&v);
            if system.constraints.iter().any(|&f| self.value(f, &values).abs().total_cmp(&(SAME * size)).is_ge()) {
                continue;
            }
            let now = program.evaluate(&[&[self.start.t], &self.start.q[..], &v].concat());
            for (slip, (i, on)) in now.chunks(3).map(norm).zip(&contacts) {
                if slip > 10.0 * SAME * size && slip > largest[*i].0 {
                    largest[*i] = (slip, view.bodies[*on].name.clone());
                }
            }
        }
        let slipping = section.entries().zip(largest).filter(|(_, (slip, _))| *slip > 0.0);
        let remark = |(entry, (slip, on)): (super::section::Entry, (f64, String))| {
            entry.error_at_key(SceneErrorKind::Remark(Remark::Slips { body: entry.key.to_owned(), on, slip }))
        };
        slipping.map(remark).collect()
    }
}

/// The velocity of the material point of a body that is at `p`: `ċ + Ṙ Rᵀ (p − c)`.
fn material(system: &System, g: &Graph, body: &Body, p: [Expr; 3]) -> [Expr; 3] {
    let rotation = body.rotation.entries();
    let rates = g.total_derivatives(&[&body.at, rotation].concat(), &system.flow());
    let sum = |terms: [Expr; 3]| g.add(g.add(terms[0], terms[1]), terms[2]);
    let from: [Expr; 3] = std::array::from_fn(|k| g.sub(p[k], body.at[k]));
    let own: [Expr; 3] = std::array::from_fn(|k| sum(std::array::from_fn(|i| g.mul(rotation[3 * i + k], from[i]))));
    std::array::from_fn(|i| g.add(rates[i], sum(std::array::from_fn(|k| g.mul(rates[3 + 3 * i + k], own[k])))))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
