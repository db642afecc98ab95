//! Motions, sampled, and the gaps between them.

use comparison::compare_motions;
use mechanics::{Constancy, Observables, System, Watched};
use motion::{Metric, SolveError, constant_names};
use scene::Scene;
use serde_json::{Value, json};

use crate::arrows::Arrows;
use crate::bodies::Bodies;
use crate::cache::Cache;
use crate::drag_handles;
use crate::question::{Question, Refused};
use crate::run::{Run, settings};
use crate::subject::Subject;

/// The motions of a question, and the gaps of the first to the others.
///
/// Of each motion `from` is the place of its first row in the numbers, `width` the length of a row, `rows`
/// how many there are. A row is `t`, coordinates, velocities, multipliers, invariants, energy, observables,
/// what [`Arrows::put`] appends where forces are asked for, the place whose path is drawn, and twelve numbers
/// a body that moves: its place, its rotation row by row. Rows of the ground are of twelve numbers a body, at
/// every time or one for all; those of a gap are `t`, the gap, and what it has to pass (infinite in doubt, or
/// at a glance).
pub(crate) fn sampled(
    subject: &Subject,
    question: &Question,
    kept: &mut Cache,
    numbers: &mut Vec<f64>,
) -> Result<Value, Refused> {
    let Subject { scene, choices, .. } = subject;
    kept.turn_to(question, scene);
    let settings = settings(question);
    let steps = question.steps.max(1);
    let time = |i: usize| scene.start.t + scene.duration * i as f64 / steps as f64;
    let mut sampler = Sampler {
        times: (0..=steps).map(time).collect(),
        bodies: Bodies::of(scene).map_err(SolveError::from)?,
        observables: observables(&scene.system)?,
        arrows: if question.forces { Arrows::of(scene)? } else { None },
    };
    let ground = sampler.ground(scene, numbers);
    let (mut answers, mut runs) = (Vec::new(), Vec::new());
    for (i, choice) in choices.iter().enumerate() {
        let mut answer = json!({ "label": choice.label, "formulation": choice.formulation.name });
        let run = match question.glance {
            true => Run::at_a_glance(scene, choice, &settings, kept),
            false => Run::of(scene, choice, &settings),
        };
        match run {
            Err(error) => answer["refused"] = error.to_string().into(),
            Ok(mut run) => {
                sampler.describe(&mut answer, scene, &mut run)?;
                sampler.rows(&mut answer, &mut run, numbers)?;
                runs.push((i, run));
            }
        }
        answers.push(answer);
    }
    let gaps = gaps(scene, &answers, &mut runs, numbers)?;
    let grips = if question.grips { drag_handles::of(scene, question)? } else { None };
    runs.into_iter().for_each(|(i, run)| run.leave(&choices[i], kept));
    Ok(json!({
        "start": scene.start.t, "end": scene.start.t + scene.duration, "times": sampler.times.len(),
        "bodies": sampler.bodies.described(), "ground": ground, "motions": answers, "gaps": gaps,
        "grips": grips, "contacts": sampler.arrows.as_ref().map(Arrows::contacts), "down": if question.glance { Value::Null } else { down(scene, &answers, numbers)? },
    }))
}

/// Which way is down, by three places of the first motion; `null` where no axis is.
fn down(scene: &Scene, answers: &[Value], numbers: &[f64]) -> Result<Value, SolveError> {
    let Some(mut arrows) = Arrows::of(scene)? else { return Ok(Value::Null) };
    let Some(motion) = answers.iter().find(|answer| answer["rows"].is_u64()) else { return Ok(Value::Null) };
    let [from, rows, width] = ["from", "rows", "width"].map(|name| motion[name].as_u64().unwrap_or_default() as usize);
    let state = |row: usize| {
        let at = from + row * width;
        (numbers[at], numbers[at + 1..at + 1 + scene.system.dimension()].to_vec())
    };
    Ok(json!(arrows.down(&[state(0), state(rows / 3), state(2 * rows / 3)])))
}

/// The energy and the observables of a system.
fn observables(system: &System) -> Result<Observables, SolveError> {
    let mut system = system.clone();
    let energy = Watched { name: "energy".into(), expression: system.energy(), constancy: Constancy::Free };
    system.watched.insert(0, energy);
    Ok(Observables::of(&system)?)
}

/// The gaps of the first run to the others; those of single runs at the times of their rows.
fn gaps(
    scene: &Scene,
    answers: &[Value],
    runs: &mut [(usize, Run)],
    numbers: &mut Vec<f64>,
) -> Result<Vec<Value>, SolveError> {
    let mut gaps = Vec::new();
    let [(first, one), others @ ..] = runs else { return Ok(gaps) };
    let mut metric = Metric::new(&scene.system)?;
    let (yardstick, unit) = yardstick(scene, &mut metric);
    let n = scene.system.dimension();
    for (second, other) in others {
        let from = numbers.len();
        let mut answer = json!({ "first": *first, "second": *second, "from": from, "unit": unit });
        if let (Run::Motion(one), Run::Motion(other)) = (&mut *one, other) {
            let gap = compare_motions(one, other, &mut metric)?;
            answer["verdict"] = gap.verdict.word().into();
            answer["largest"] = (gap.largest / yardstick).into();
            answer["certain"] = gap.certain_from.into();
            numbers.extend(gap.points.iter().flat_map(|p| [p.t, p.gap / yardstick, p.limit / yardstick]));
        } else {
            let place = |i: usize, name: &str| answers[i][name].as_u64().unwrap_or_default() as usize;
            // the last row of a motion that ends early is between the times of the others
            for row in 0..place(*first, "rows").min(place(*second, "rows")).saturating_sub(1) {
                let at = |i: usize| place(i, "from") + row * place(i, "width");
                let (a, b) = (at(*first), at(*second));
                let [q, v, other] = [a + 1, a + 1 + n, b + 1].map(|from| &numbers[from..from + n]);
                let gap = [numbers[a], metric.distance(numbers[a], q, v, other) / yardstick, f64::INFINITY];
                numbers.extend(gap);
            }
        }
        answer["rows"] = ((numbers.len() - from) / 3).into();
        gaps.push(answer);
    }
    Ok(gaps)
}

/// `sqrt(Mᵢᵢ)` at the start, the length of a unit step along coordinate `i`, with the unit of `i`: of the
/// coordinate in metres with the most inertia, or without metres of any. Gaps divided by it are in that unit.
pub(crate) fn yardstick<'s>(scene: &'s Scene, metric: &mut Metric) -> (f64, &'s str) {
    let (coordinates, start) = (&scene.system.coordinates, &scene.start);
    let in_metres = coordinates.iter().any(|c| c.unit == "m");
    let mut longest = (0.0, "");
    for (i, coordinate) in coordinates.iter().enumerate().filter(|(_, c)| !in_metres || c.unit == "m") {
        let step: Vec<f64> = (0..coordinates.len()).map(|j| f64::from(i == j)).collect();
        let length = metric.length(start.t, &start.q, &start.v, &step);
        if length > longest.0 {
            longest = (length, coordinate.unit.as_str());
        }
    }
    if longest.0 > 0.0 { longest } else { (1.0, "m √kg") }
}

/// What reads rows off motions.
struct Sampler {
    times: Vec<f64>,
    bodies: Bodies,
    observables: Observables,
    arrows: Option<Arrows>,
}

impl Sampler {
    /// How a motion went, and what stands in its rows.
    fn describe(&self, answer: &mut Value, scene: &Scene, run: &mut Run) -> Result<(), SolveError> {
        let (status, cause, error) = run.status(scene)?;
        let (equations, constants) = run.equations();
        let names = |named: &[equations::Named]| named.iter().map(|n| n.name.clone()).collect::<Vec<_>>();
        let constants = constant_names(equations).into_iter().zip(constants);
        let constants: Vec<Value> = constants.map(|(name, value)| json!({ "name": name, "value": value })).collect();
        (answer["status"], answer["cause"], answer["error"]) = (status.into(), cause.into(), error.into());
        answer["end"] = run.end().into();
        answer["constants"] = constants.into();
        answer["multipliers"] = names(&equations.multipliers).into();
        answer["invariants"] = names(&equations.invariants).into();
        answer["observables"] = self.observables.names().into();
        Ok(())
    }

    /// The bodies that do not move with the coordinates; one row where they do not move at all.
    fn ground(&mut self, scene: &Scene, numbers: &mut Vec<f64>) -> Value {
        let from = numbers.len();
        let rows = if self.bodies.is_still(scene) { 1 } else { self.times.len() };
        for t in &self.times[..rows] {
            self.bodies.put_ground(*t, &scene.start.q, numbers);
        }
        json!({ "from": from, "rows": rows, "width": (numbers.len() - from) / rows })
    }

    /// Rows at all times up to the end of the motion, the last one at its end.
    fn rows(&mut self, answer: &mut Value, run: &mut Run, numbers: &mut Vec<f64>) -> Result<(), SolveError> {
        let (from, end) = (numbers.len(), run.end());
        let before = self.times.iter().take_while(|t| **t < end).count();
        for t in self.times[..before].iter().copied().chain([end]) {
            let now = run.at(t)?;
            numbers.push(t);
            numbers.extend(now.coordinates.iter().chain(&now.velocities).chain(&now.multipliers));
            numbers.extend(&now.invariants);
            numbers.extend(self.observables.at(t, &now.coordinates, &now.velocities));
            if let Some(arrows) = &mut self.arrows {
                arrows.put(run, self.times[0], t, numbers)?;
            }
            self.bodies.put_moved(t, &now.coordinates, numbers);
        }
        (answer["from"], answer["rows"]) = (from.into(), (before + 1).into());
        answer["width"] = ((numbers.len() - from) / (before + 1)).into();
        Ok(())
    }
}
