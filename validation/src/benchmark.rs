//! Reference motions for other programs: starts drawn around those of scenes, motions in double-double
//! arithmetic by two methods. `validation/benchmark/judge.py` compares answers with them.

use std::fmt::Write;

use anyhow::{Context, Result, bail};
use equations::Formulation;
use mechanics::{ConstantsRule, project_velocity};
use motion::{
    CHETAEV, Choice, REMOVED_CONSTRAINT, Settings, VAKONOMIC, choices, constant_names, derive, prepare, setting,
};
use program::File;
use reference::{DoubleDouble, Entry, Point, Question, reference};
use scene::Scene;
use scene::catalogue::find;
use serde_json::{Value, json};
use symbolic::SplitMix;

/// Scenes: linear, affine and nonlinear constraints, one and two of them, two to five coordinates.
pub const SYSTEMS: [&str; 12] = [
    "sledge",
    "sleigh",
    "disc",
    "particle",
    "heisenberg",
    "velocity-pendulum",
    "pursuit",
    "turntable",
    "appell-hamel",
    "snakeboard",
    "roller-racer",
    "chaplygin-sphere",
];
/// The formulations: the scene's first removal where one is needed.
pub const FORMULATIONS: [&Formulation; 3] = [CHETAEV, VAKONOMIC, REMOVED_CONSTRAINT];
/// Starts of each scene.
pub const STARTS: usize = 10;
/// Times of each motion, the start left out.
const TIMES: usize = 4;
/// The longest motion, in the scene's unit of time.
const LONGEST: f64 = 2.0;
/// How far numbers of a start are from those of the scene, over the larger of their size and one.
const WIDTH: f64 = 0.2;
/// The largest free constant at the start.
const CONSTANT: f64 = 0.5;
/// Asked of each motion, in the kinetic metric.
const ACCURACY: f64 = 1e-18;
/// Starts that are drawn before one is given up, where equations cannot be solved at others.
pub(crate) const TRIES: u64 = 20;

/// One motion at one time.
#[derive(Clone, Debug)]
pub struct Row {
    /// Name of the formulation.
    pub formulation: &'static str,
    /// Number of the start, from 1.
    pub start: usize,
    /// The time.
    pub t: f64,
    /// `q`, `q̇`.
    pub state: Vec<f64>,
    /// Free constants at the start by name; only there.
    pub constants: Vec<(String, f64)>,
    /// What `q` is wrong by at most before it is rounded, `√(Δqᵀ M Δq)`: two methods, two tolerances.
    pub error: f64,
}

/// The motions of one scene from `starts`, numbered from 1: all formulations from each.
///
/// # Errors
/// A scene that is not built in, and one where no start was found from which all formulations have a motion.
pub fn motions(name: &str, starts: impl IntoIterator<Item = usize>) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for start in starts {
        let seed = name.bytes().fold(start as u64, |seed, byte| SplitMix::new(seed ^ u64::from(byte)).bits());
        let mut random = SplitMix::new(seed);
        let mut last = None;
        let found = (0..TRIES).find_map(|_| from_one_start(name, start, &mut random).map_err(|e| last = Some(e)).ok());
        match (found, last) {
            (Some(found), _) => rows.extend(found),
            (None, Some(error)) => {
                return Err(error).with_context(|| format!("{name}: no start {start} after {TRIES} tries"));
            }
            (None, None) => bail!("{name}: no try"),
        }
    }
    Ok(rows)
}

fn from_one_start(name: &str, start: usize, random: &mut SplitMix) -> Result<Vec<Row>> {
    let mut scene = find(name, &[])?;
    let mut drawn = |width: f64| width * (2.0 * random.unit() - 1.0);
    let mut moved = scene.start.clone();
    for x in moved.q.iter_mut().chain(&mut moved.v) {
        *x += drawn(WIDTH) * x.abs().max(1.0);
    }
    scene.multipliers.iter_mut().for_each(|mu| *mu = drawn(CONSTANT));
    scene.start = project_velocity(&scene.system, &moved)?.0;
    let mut rows = Vec::new();
    for formulation in FORMULATIONS {
        let mut choice =
            choices(&scene).into_iter().find(|choice| choice.formulation == formulation).context("no such choice")?;
        rows.extend(motion(&scene, &mut choice, start, random)?);
    }
    Ok(rows)
}

fn motion(scene: &Scene, choice: &mut Choice, start: usize, random: &mut SplitMix) -> Result<Vec<Row>> {
    let equations = derive(&scene.system, choice)?;
    if choice.formulation == REMOVED_CONSTRAINT {
        let drawn = equations.free_constants.iter().map(|_| CONSTANT * (2.0 * random.unit() - 1.0));
        choice.constants = ConstantsRule::Given(drawn.collect());
    }
    let ready = prepare(setting(scene), equations, &choice.constants, &Settings::default())?;
    let (system, from) = (&scene.system, &scene.start);
    let question = Question { system, start: from, equations: &ready.equations, constants: &ready.constants };
    let length = scene.duration.min(LONGEST);
    let times: Vec<f64> = (1..=TIMES).map(|i| from.t + length * i as f64 / TIMES as f64).collect();
    let found = reference(&question, &times, ACCURACY)?;
    let formulation = choice.formulation.name;
    let constants = constant_names(&ready.equations).into_iter().zip(ready.constants.iter().copied()).collect();
    let state = [&from.q[..], &from.v].concat();
    let mut rows = vec![Row { formulation, start, t: from.t, state, constants, error: 0.0 }];
    let rounded = |p: &Point<DoubleDouble>| p.coordinates.iter().chain(&p.velocities).map(|x| x.to_f64()).collect();
    for ((&t, point), &error) in times.iter().zip(&found.points).zip(&found.errors) {
        rows.push(Row { formulation, start, t, state: rounded(point), constants: Vec::new(), error });
    }
    Ok(rows)
}

/// The table of a scene, a line per motion and time.
pub fn csv(scene: &Scene, rows: &[Row]) -> String {
    let constants = constant_columns(rows);
    let mut text =
        format!("formulation,start,t,{},error\n", [state_names(scene), constants.clone()].concat().join(","));
    for row in rows {
        let _ = write!(text, "{},{},{}", row.formulation, row.start, row.t);
        for x in &row.state {
            let _ = write!(text, ",{x}");
        }
        for name in &constants {
            let value = row.constants.iter().find(|(n, _)| n == name).map(|(_, x)| x.to_string());
            let _ = write!(text, ",{}", value.unwrap_or_default());
        }
        let _ = writeln!(text, ",{:.0e}", row.error);
    }
    text
}

fn state_names(scene: &Scene) -> Vec<String> {
    let names: Vec<String> = scene.system.coordinates.iter().map(|c| c.name.clone()).collect();
    let rates: Vec<String> = names.iter().map(|name| format!("{name}'")).collect();
    [names, rates].concat()
}

fn constant_columns(rows: &[Row]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (name, _) in rows.iter().flat_map(|row| &row.constants) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// What the columns of a scene's table are: a resource of a Data Package, its fields in their order.
fn resource(name: &str, scene: &Scene, rows: &[Row]) -> Value {
    let field = |name: &str, kind: &str, what: String| json!({ "name": name, "type": kind, "description": what });
    let mut fields = vec![
        field("formulation", "string", "chetaev, vakonomic or removed-constraint".into()),
        field("start", "integer", "number of the start".into()),
        field("t", "number", "time".into()),
    ];
    for (i, column) in state_names(scene).iter().enumerate() {
        let coordinates = &scene.system.coordinates;
        let unit = &coordinates[i % coordinates.len()].unit;
        let per = if i < coordinates.len() { "" } else { " per unit of time" };
        fields.push(field(column, "number", format!("{unit}{per}")));
    }
    for column in constant_columns(rows) {
        fields.push(field(&column, "number", "value at the start, in rows of the start of its formulation".into()));
    }
    fields.push(field("error", "number", "of the coordinates before rounding, in the kinetic metric".into()));
    let removal = choices(scene).into_iter().find_map(|c| c.removal).map(|r| r.name);
    json!({
        "name": name, "title": scene.title, "path": format!("{name}.csv"), "format": "csv", "removal": removal,
        "schema": { "fields": fields, "primaryKey": ["formulation", "start", "t"], "missingValues": [""] },
    })
}

/// The tables of `systems`, and what their columns are.
///
/// # Errors
/// Those of [`motions`].
pub fn files(systems: &[String], starts: usize, mut progress: impl FnMut(&str)) -> Result<Vec<File>> {
    let (mut files, mut resources) = (Vec::new(), Vec::new());
    for name in systems {
        progress(name);
        let (scene, rows) = (find(name, &[])?, motions(name, 1..=starts)?);
        resources.push(resource(name, &scene, &rows));
        files.push(File { path: format!("{name}.csv").into(), text: csv(&scene, &rows) });
    }
    let package = json!({
        "name": "deltaq-benchmark", "title": "Reference motions under velocity constraints, three formulations",
        "licenses": [{ "name": "MIT" }, { "name": "Apache-2.0" }], "resources": resources,
    });
    files.push(File { path: "datapackage.json".into(), text: format!("{package:#}\n") });
    Ok(files)
}
