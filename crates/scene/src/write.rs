//! From a scene to its text.

use std::fmt::{self, Write};

use crate::Scene;
use crate::format::FORMAT;
use mechanics::{Body, ConstantsRule, Removal, System, Touch, View};
use symbolic::Expr;

impl Scene {
    /// The scene as a file, start values numbers: [`Scene::parse`] gives the same system, start, removals.
    pub fn to_toml(&self) -> String {
        written(self)
    }
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene").field("name", &self.name).field("text", &self.to_toml()).finish()
    }
}

/// The scene as TOML.
fn written(scene: &Scene) -> String {
    let Scene { system, start, .. } = scene;
    let g = &system.graph;
    let mut text = Table::default();
    text.line("format", &FORMAT.to_string());
    text.line("title", &quoted(&scene.title));
    for (key, value) in [("source", &scene.source), ("notes", &scene.notes)] {
        if !value.is_empty() {
            text.line(key, &quoted(value));
        }
    }
    if !system.parameters.is_empty() {
        text.header("parameters");
        for p in &system.parameters {
            let written = system.written_parameter(p);
            let is_number = g.as_number(written).is_some();
            let value = if is_number { format!("{:?}", p.value) } else { quoted(&g.plain(written)) };
            text.line(&g.name(p.symbol), &value);
        }
    }
    text.header("coordinates");
    for (c, &q) in system.coordinates.iter().zip(&start.q) {
        text.line(&c.name, &format!("{{ unit = {}, start = {q:?} }}", quoted(&c.unit)));
    }
    write_system(&mut text, system);
    for (header, constant) in [("invariants", true), ("observables", false)] {
        let watched: Vec<_> = system.watched.iter().filter(|watched| watched.is_constant() == constant).collect();
        if !watched.is_empty() {
            text.header(header);
        }
        for watched in watched {
            text.line(&watched.name, &quoted(&g.plain(watched.expression)));
        }
    }
    for filmed in &scene.film {
        text.header(&format!("film.{}", key(&filmed.name)));
        text.line("is", &quoted(&g.plain(filmed.expression)));
        if let Some(sigma) = filmed.sigma {
            text.line("sigma", &format!("{sigma:?}"));
        }
    }
    for body in &scene.view.bodies {
        write_body(&mut text, &scene.view, body);
    }
    text.header("start");
    text.line("time", &format!("{:?}", start.t));
    text.header("start.velocities");
    for (c, &v) in system.coordinates.iter().zip(&start.v) {
        text.line(&g.name(c.velocity), &format!("{v:?}"));
    }
    for r in &scene.removals {
        removal(&mut text, system, r);
    }
    if !scene.multipliers.is_empty() {
        text.header("vakonomic");
        text.line("multipliers", &format!("{:?}", scene.multipliers));
    }
    text.header("run");
    text.line("duration", &format!("{:?}", scene.duration));
    if !system.breakpoints.is_empty() {
        text.line("breakpoints", &format!("{:?}", system.breakpoints));
    }
    text.0
}

fn write_system(text: &mut Table, system: &System) {
    let g = &system.graph;
    text.header("system");
    text.line("lagrangian", &quoted(&g.plain(system.lagrangian)));
    for (key, expressions) in [("constraints", &system.constraints), ("virtual", &system.virtual_conditions)] {
        let lines: Vec<String> = expressions.iter().map(|&f| format!("  {},\n", quoted(&g.plain(f)))).collect();
        if !lines.is_empty() {
            text.line(key, &format!("[\n{}]", lines.concat()));
        }
    }
    if system.has_forces() {
        text.header("system.forces");
        for (c, &force) in system.coordinates.iter().zip(&system.forces) {
            if !g.is_zero(force) {
                text.line(&c.name, &quoted(&g.plain(force)));
            }
        }
    }
}

fn write_body(text: &mut Table, View { graph, bodies }: &View, body: &Body) {
    let vector =
        |entries: &[Expr]| format!("[{}]", entries.iter().map(|&e| graph.plain(e)).collect::<Vec<_>>().join(", "));
    text.header(&format!("view.{}", key(&body.name)));
    text.line("shape", &quoted(body.shape.kind.word()));
    text.line("size", &format!("{:?}", body.shape.size));
    text.line("at", &quoted(&vector(&body.at)));
    let rows: Vec<String> = (0..3).map(|i| vector(body.rotation.row(i))).collect();
    text.line("rotation", &quoted(&format!("[{}]", rows.join(", "))));
    let touch = |touch: &Touch| format!("{} = {}", key(&bodies[touch.body].name), quoted(&vector(&touch.at)));
    if !body.touches.is_empty() {
        text.line("touches", &format!("{{ {} }}", body.touches.iter().map(touch).collect::<Vec<_>>().join(", ")));
    }
}

fn removal(text: &mut Table, system: &System, removal: &Removal) {
    let g = &system.graph;
    let path = format!("removal.{}", key(&removal.name));
    text.header(&path);
    let parameters: Vec<String> = removal.parameters.iter().map(|u| quoted(&g.name(u.symbol))).collect();
    text.line("parameters", &format!("[{}]", parameters.join(", ")));
    match &removal.constants {
        ConstantsRule::Zero => text.line("constants", "\"zero\""),
        ConstantsRule::Natural { horizon } => text.line("constants", &format!("{{ horizon = {horizon:?} }}")),
        ConstantsRule::Given(values) => {
            let entry = |(w, x): (&mechanics::MemoryVariable, &f64)| format!("{} = {x:?}", key(&g.name(w.symbol)));
            let entries: Vec<String> = removal.memory.iter().zip(values).map(entry).collect();
            text.line("constants", &format!("{{ start = {{ {} }} }}", entries.join(", ")));
        }
    }
    let mut tables: [(&str, Vec<(String, String)>); 4] =
        [("rates", Vec::new()), ("direct", Vec::new()), ("memory", Vec::new()), ("start", Vec::new())];
    for w in &removal.memory {
        let place = if w.coordinate.is_some() { 0 } else { 2 };
        tables[place].1.push((g.name(w.symbol), g.plain(w.rate)));
    }
    for (i, c) in system.coordinates.iter().enumerate() {
        let is_memory = removal.memory.iter().any(|w| w.coordinate == Some(i));
        let is_parameter = removal.parameters.iter().any(|u| u.coordinate == Some(i));
        if !is_memory && !is_parameter {
            tables[1].1.push((c.name.clone(), g.plain(removal.coordinates[i])));
        }
    }
    tables[3].1 = removal.start.iter().map(|(&s, &e)| (g.name(s), g.plain(e))).collect();
    tables[3].1.sort();
    for (name, entries) in tables.iter().filter(|t| !t.1.is_empty()) {
        text.header(&format!("{path}.{name}"));
        for (key, expression) in entries {
            text.line(key, &quoted(expression));
        }
    }
}

/// Text of a TOML file.
#[derive(Default)]
struct Table(String);

impl Table {
    fn header(&mut self, path: &str) {
        self.0 += &format!("\n[{path}]\n");
    }

    fn line(&mut self, name: &str, value: &str) {
        self.0 += &format!("{} = {value}\n", key(name));
    }
}

/// A key, in quotes where it has to be.
pub(super) fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) { name.into() } else { quoted(name) }
}

/// `text` as a basic string of TOML.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => {
                out.push('\\');
                out.push(c);
            }
            '\n' => out += "\\n",
            '\t' => out += "\\t",
            c if c.is_control() => {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out + "\""
}
