//! One problem, solved by everybody in turns.

use std::time::Duration;

use anyhow::{Context, Result};
use scene::Scene;
use serde_json::{Value, json};
use validation::casadi_job::Tag;

use crate::reference::{Reference, coordinates};
use crate::rows::row;
use crate::{Entrant, Problem, Refusal, Tools};

/// Errors that have to be reached.
pub(crate) const TARGETS: [f64; 3] = [1e-9, 1e-10, 1e-11];
/// How far a right-hand side at the start may be from ours, relative to the largest rate.
const RIGHT: f64 = 1e-12;
/// A method that is slower by this factor than another one of its row, at a larger error, climbs no further.
const HOPELESS: f64 = 10.0;

/// How much is done.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Tolerances 10⁻ᵏ: every how many-th k.
    pub step: usize,
    /// Turns of everybody.
    pub rounds: usize,
    /// Seconds of repeats in a turn.
    pub repeat: f64,
    /// A run that takes longer is the last one of its method.
    pub slow: f64,
    /// Seconds that a single question may take.
    pub limit: u64,
}

impl Effort {
    /// For figures that are kept.
    pub const FULL: Effort = Effort { step: 1, rounds: 2, repeat: 0.05, slow: 0.5, limit: 60 };
    /// For a look.
    pub const QUICK: Effort = Effort { step: 2, rounds: 1, repeat: 0.02, slow: 0.3, limit: 30 };
}

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// The coordinates at all times; the error is the largest of them.
    Trajectory,
    /// The coordinates at the end, and their error.
    End,
}

impl Task {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Task::Trajectory => "trajectory",
            Task::End => "end",
        }
    }
}

/// A method at a tolerance.
#[derive(Clone, Debug)]
pub struct Rung {
    /// Row of the tables.
    pub row: String,
    /// Who.
    pub entrant: Entrant,
    /// Method.
    pub method: String,
    /// Tolerance.
    pub tolerance: f64,
    /// Task.
    pub task: Task,
    /// Least seconds of a run.
    pub seconds: f64,
    /// Seconds of what this method and tolerance need before the first run.
    pub prepare: f64,
    /// Seconds of the derivation.
    pub setup: f64,
    /// Error in the kinetic metric.
    pub error: f64,
    /// Seconds from the text of the scene to the coordinates at all times; for the peers the sum of the parts.
    pub total: f64,
}

/// What did not come off.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Row of the tables.
    pub row: String,
    /// What was tried.
    pub what: String,
    /// What became of it.
    pub words: String,
}

/// A problem and what was found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The problem.
    pub problem: Problem,
    /// How far our tightest run is from the reference; or why there is none, and then nothing is timed.
    pub reference: Result<f64, String>,
    /// Rows and seconds of the derivations.
    pub setups: Vec<(String, f64)>,
    /// Largest relative difference of a right-hand side from ours at the start, by row.
    pub checks: Vec<(String, f64)>,
    /// Everything that was timed.
    pub rungs: Vec<Rung>,
    /// Everything that failed.
    pub failures: Vec<Failure>,
}

/// Everybody's process of this problem, and what it answers to.
pub(crate) struct Race<'a> {
    tools: &'a mut Tools,
    pub(crate) effort: Effort,
    pub(crate) outcome: Outcome,
    expected: Option<Vec<(Tag, f64)>>,
}

/// Runs one problem.
///
/// # Errors
/// Where ours cannot read the problem or the tools cannot be started; what the tools fail at is in [`Outcome::failures`].
pub fn race(problem: &Problem, tools: &mut Tools, effort: Effort) -> Result<Outcome> {
    let limit = Duration::from_secs(effort.limit);
    let mut problem = problem.clone();
    let scene = Scene::parse(&problem.case.name, &problem.case.toml)?;
    let expected = start(&mut problem, &scene, tools, limit);
    let failures = match &expected {
        Ok(_) => Vec::new(),
        Err(error) => vec![Failure {
            row: crate::rows::OURS.into(),
            what: "the plain equations at the start, for the check of right-hand sides".into(),
            words: format!("{error:#}"),
        }],
    };
    let (setups, checks, rungs) = (Vec::new(), Vec::new(), Vec::new());
    let outcome = Outcome { problem, reference: Err("none".into()), setups, checks, rungs, failures };
    let mut race = Race { tools, effort, outcome, expected: expected.ok() };
    let methods = race.set_everybody_up();
    let timed = race.outcome.problem.entrants.iter().any(|entrant| !["ours", "sympy"].contains(&entrant.tool));
    let reference = if timed {
        Reference::new(&race.outcome.problem, &scene, race.tools, limit)
    } else {
        Err(anyhow::anyhow!("not timed"))
    };
    match reference {
        Ok(mut reference) => {
            race.outcome.reference = Ok(reference.confirmed);
            for (entrant, method, setup) in &methods {
                race.climb(entrant, method, *setup, &mut reference);
            }
            for _ in 0..effort.rounds {
                race.turn();
            }
            race.totals();
        }
        Err(error) => race.outcome.reference = Err(format!("{error:#}")),
    }
    race.tools.end_all();
    Ok(race.outcome)
}

/// Start and rates there by our equations as derived, put into the case and handed back.
fn start(problem: &mut Problem, scene: &Scene, tools: &mut Tools, limit: Duration) -> Result<Vec<(Tag, f64)>> {
    let names = || scene.system.coordinates.iter().map(|c| c.name.clone());
    let pairs = |kind: &str, values: &[f64]| -> Vec<(Tag, f64)> {
        names().zip(values).map(|(name, &x)| ((kind.to_string(), name), x)).collect()
    };
    let mut values = [pairs("q", &scene.start.q), pairs("v", &scene.start.v)].concat();
    let head = |v: &[f64], theta: f64| v[0] * theta.cos() + v[1] * theta.sin();
    if problem.trailers.is_some() {
        values.push((("u".into(), String::new()), head(&scene.start.v, scene.start.q[2])));
        values.push((("omega".into(), String::new()), scene.start.v[2]));
    }
    (problem.case.tags, problem.case.start) = values.iter().cloned().unzip();
    let first = crate::Case { tags: Vec::new(), start: Vec::new(), ..problem.case.clone() };
    tools.ask("ours", "start", &Tools::set_up(&first), limit)?;
    let answer = tools.ask("ours", "start", &json!({ "do": "rates" }), limit)?;
    let tags: Vec<Tag> = serde_json::from_value(answer["tags"].clone())?;
    let rates: Vec<f64> = serde_json::from_value(answer["rates"].clone())?;
    let mut expected: Vec<(Tag, f64)> = tags.iter().cloned().zip(rates).collect();
    if problem.trailers.is_some() {
        let of = |name: &str| {
            expected.iter().find(|((kind, of), _)| kind == "v" && of == name).map_or(f64::NAN, |(_, x)| *x)
        };
        let (theta, v) = (scene.start.q[2], &scene.start.v);
        // d/dt of the forward speed; its second part is the side slip, which is zero
        let forwards = head(&[of("x"), of("y")], theta) + v[2] * (v[1] * theta.cos() - v[0] * theta.sin());
        let turn = of("theta0");
        expected.push((("u".into(), String::new()), forwards));
        expected.push((("omega".into(), String::new()), turn));
    } else {
        (problem.case.tags, problem.case.start) = (tags, serde_json::from_value(answer["start"].clone())?);
    }
    Ok(expected)
}

impl Race<'_> {
    pub(crate) fn fail(&mut self, row: String, what: String, words: String) {
        self.outcome.failures.push(Failure { row, what, words });
    }

    pub(crate) fn ask(&mut self, entrant: &Entrant, question: &Value) -> Result<Value, Refusal> {
        let name = format!("{}-{}", entrant.tool, entrant.form);
        let limit = Duration::from_secs(self.effort.limit);
        let mut case = self.outcome.problem.case.clone();
        case.form = entrant.form.into();
        // a process that had to be ended is set up anew
        if question["do"] != "setup" && !self.tools.is_running(&name) {
            self.tools.ask(entrant.tool, &name, &Tools::set_up(&case), limit)?;
        }
        let question = if question["do"] == "setup" { Tools::set_up(&case) } else { question.clone() };
        self.tools.ask(entrant.tool, &name, &question, limit)
    }

    /// Derivations, right-hand sides checked; entrant, method and seconds of the derivation for what may be timed.
    fn set_everybody_up(&mut self) -> Vec<(Entrant, String, f64)> {
        let mut methods = Vec::new();
        let trailers = self.outcome.problem.trailers.is_some();
        for entrant in self.outcome.problem.entrants.clone() {
            let name = row(&entrant, "", trailers);
            match self.ask(&entrant, &json!({ "do": "setup" })) {
                Err(refusal) => self.fail(name, "derivation".into(), refusal.to_string()),
                Ok(answer) => {
                    let seconds = answer["seconds"].as_f64().unwrap_or(f64::NAN);
                    self.outcome.setups.push((name.clone(), seconds));
                    match self.check(&entrant) {
                        Ok(apart) if apart <= RIGHT => {
                            self.outcome.checks.push((name, apart));
                            let listed = answer["methods"].as_array().into_iter().flatten().filter_map(Value::as_str);
                            methods.extend(listed.map(|method| (entrant.clone(), method.to_string(), seconds)));
                        }
                        Ok(apart) => {
                            let words = format!("{apart:.1e} from ours at the start: not timed");
                            self.fail(name, "right-hand side".into(), words);
                        }
                        Err(error) => self.fail(name, "right-hand side".into(), format!("{error:#}: not timed")),
                    }
                }
            }
        }
        methods
    }

    /// Largest difference of the rates at the start from ours, relative to the largest.
    fn check(&mut self, entrant: &Entrant) -> Result<f64> {
        if self.expected.is_none() || entrant.tool == "ours" {
            // ours is what the others are compared with; where it has no answer, the reference has to do
            return Ok(0.0);
        }
        let answer = self.ask(entrant, &json!({ "do": "rates" }))?;
        let tags: Vec<Tag> = serde_json::from_value(answer["tags"].clone())?;
        let rates: Vec<f64> = serde_json::from_value(answer["rates"].clone())?;
        let expected = self.expected.as_deref().unwrap_or_default();
        let (mut apart, mut largest) = (0.0_f64, 1.0_f64);
        for (tag, rate) in tags.iter().zip(&rates) {
            let (_, ours) =
                expected.iter().find(|(known, _)| known == tag).with_context(|| format!("no {tag:?} of ours"))?;
            apart = if (rate - ours).is_nan() { f64::NAN } else { apart.max((rate - ours).abs()) };
            largest = largest.max(ours.abs());
        }
        Ok(apart / largest)
    }

    /// Tighter and tighter until the tightest target is reached, each tolerance once.
    fn climb(&mut self, entrant: &Entrant, method: &str, setup: f64, reference: &mut Reference) {
        let name = row(entrant, method, self.outcome.problem.trailers.is_some());
        // heyoka compiles for every tolerance: those that cannot do are left out
        let first = if entrant.tool == "heyoka" { 9 } else { 7 };
        for k in (first..=15).step_by(self.effort.step) {
            let tolerance = 10.0_f64.powi(-k);
            let what = |task: Task| format!("{method} at 1e-{k}, {}", task.name());
            let mut prepare = f64::NAN;
            let mut best = f64::INFINITY;
            let mut slowest = 0.0_f64;
            for task in [Task::Trajectory, Task::End] {
                let about = json!({ "method": method, "tolerance": tolerance, "task": task.name(), "repeat": 0 });
                let with = |what: &str| {
                    let mut question = about.clone();
                    question["do"] = what.into();
                    question
                };
                let found = self.ask(entrant, &with("prepare")).map_err(anyhow::Error::from).and_then(|prepared| {
                    let answer = self.ask(entrant, &with("run"))?;
                    let error = reference.error(&coordinates(&answer)?)?;
                    let seconds = answer["seconds"].as_f64().context("seconds")?;
                    Ok((prepared["seconds"].as_f64().context("seconds")?, seconds, error))
                });
                match found {
                    Err(error) => {
                        self.fail(name, what(task), format!("{error:#}"));
                        return;
                    }
                    Ok((prepared, seconds, error)) => {
                        prepare = if prepare.is_nan() { prepared } else { prepare };
                        (best, slowest) = (best.min(error), slowest.max(seconds));
                        self.outcome.rungs.push(Rung {
                            row: name.clone(),
                            entrant: entrant.clone(),
                            method: method.into(),
                            tolerance,
                            task,
                            seconds,
                            prepare,
                            setup,
                            error,
                            total: setup + prepare + seconds,
                        });
                    }
                }
            }
            if best <= 0.5 * TARGETS[2] {
                return;
            }
            if let Some(other) = self.far_better(&name, method, slowest, best) {
                let words = format!("stopped there: {other} is over {HOPELESS} times as fast, with a smaller error");
                self.fail(name, what(Task::Trajectory), words);
                return;
            }
            if slowest > self.effort.slow {
                let words = format!("stopped there: {slowest:.1} s a run, error {best:.0e}");
                self.fail(name, what(Task::Trajectory), words);
                return;
            }
        }
        let reached = self.rungs_of(&name, method).map(|rung| rung.error).fold(f64::INFINITY, f64::min);
        if reached > TARGETS[2] {
            self.fail(name, format!("{method}, all tolerances"), format!("no error below {reached:.0e}"));
        }
    }

    /// Another method of the row that reaches every target and a smaller error in a fraction of the time.
    fn far_better(&self, row: &str, method: &str, seconds: f64, error: f64) -> Option<String> {
        let better = |rung: &&Rung| {
            rung.row == row
                && rung.method != method
                && rung.task == Task::Trajectory
                && rung.error <= TARGETS[2].min(error)
                && HOPELESS * rung.seconds < seconds
        };
        self.outcome.rungs.iter().find(better).map(|rung| format!("{} at {:.0e}", rung.method, rung.tolerance))
    }

    fn rungs_of<'a>(&'a self, row: &'a str, method: &'a str) -> impl Iterator<Item = &'a Rung> {
        self.outcome.rungs.iter().filter(move |rung| rung.row == row && rung.method == method)
    }
}
