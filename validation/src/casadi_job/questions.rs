//! What the referee is asked: the text of a scene, and our own values of everything that is to be compared.

use std::collections::HashMap;

use anyhow::{Context, Result, bail};
use comparison::Answer;
use equations::{Compiled, Derivation, Equations, Formulation, Role};
use mechanics::{ConstantsRule, complete_removal_start};
use motion::band::BEFORE_THE_END;
use motion::{
    CHETAEV, Choice, Motion, REMOVED_CONSTRAINT, Settings, VAKONOMIC, VAKONOMIC_COSTATE, choices, setting, solve,
};
use scene::Scene;
use serde::Serialize;
use symbolic::SplitMix;

use crate::benchmark::TRIES;

/// How much is asked of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Amount {
    /// Random states for each formulation.
    pub states: usize,
    /// Times at which motions are compared, besides the start; 0 for no motions.
    pub times: usize,
}

/// What a state is, and of what: `("q", "x")`, `("v", "x")`, `("mu", "1")`, `("u", "s")`, `("du", "s")`,
/// `("ddu", "s")`, `("p", "s")`, `("w", "x")`, `("P", "x")`.
type Tag = (String, String);

/// One scene.
#[derive(Clone, Debug, Serialize)]
pub struct Question {
    pub(super) name: String,
    /// Text of the scene.
    pub(super) toml: String,
    /// Text of the scene with all its removals, the automatic ones too.
    pub(super) removals: String,
    pub(super) cases: Vec<Case>,
    pub(super) transcriptions: Vec<Transcription>,
    /// States that go to SymPy.
    pub(super) lagranges_method: usize,
    /// What was decided of the multipliers.
    pub(super) decision: Option<Decided>,
}

/// `μ₀` that make the vakonomic motion Chetaev's: their set's dimension and least-norm element, if any.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Decided {
    /// Velocities at the start, rounded: for those that the text does not say.
    start: Vec<f64>,
    dimension: Option<usize>,
    point: Vec<f64>,
}

/// One formulation of a scene.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Case {
    pub(super) label: String,
    formulation: &'static str,
    removal: Option<String>,
    /// Whether the removal is not in the text of the scene.
    automatic: bool,
    tags: Vec<Tag>,
    pub(super) samples: Option<Samples>,
    motion: Option<MotionTable>,
    solvers: Vec<&'static str>,
}

/// Right-hand sides: `t, y` (N rows), `ẏ` as [`Compiled`] evaluates it, and for Chetaev `λ`.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Samples {
    states: Vec<Vec<f64>>,
    rates: Vec<Vec<f64>>,
    multipliers: Vec<Vec<f64>>,
}

/// A motion read off at some times.
#[derive(Clone, Debug, Serialize)]
struct MotionTable {
    tags: Vec<Tag>,
    start: Vec<f64>,
    times: Vec<f64>,
    coordinates: Vec<Vec<f64>>,
    /// Coordinates of the kept run less those of the looser one.
    differences: Vec<Vec<f64>>,
    /// What happens a little later than these times, if not the time asked for.
    until: Option<&'static str>,
    /// `μ(t)`, vakonomic only.
    multipliers: Vec<Vec<f64>>,
}

/// A short motion that makes the discretized action stationary, or does not.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Transcription {
    label: String,
    formulation: &'static str,
    removal: Option<String>,
    automatic: bool,
    tags: Vec<Tag>,
    times: Vec<f64>,
    /// `y` (s) at each of the times.
    states: Vec<Vec<f64>>,
}

/// How far random states are from the start: positions, parameters and memory; everything else.
const SPREAD: (f64, f64) = (0.25, 1.0);

impl Question {
    /// Everything about `scene`, whose file holds `text`.
    ///
    /// # Errors
    /// Where a motion of ours cannot be read off.
    pub fn new(scene: &Scene, text: &str, amount: Amount) -> Result<Question> {
        // An automatic removal brings symbols of its own into the graph: first the removals, then the copy.
        let removals = motion::removals(scene).unwrap_or_default();
        let whole = Scene { removals, ..scene.clone() };
        let mut cases = Vec::new();
        for choice in choices(scene) {
            cases.extend(case(scene, &choice, amount).with_context(|| choice.label.clone())?);
        }
        let removals = whole.to_toml();
        Ok(Question {
            name: scene.name.clone(),
            toml: text.into(),
            removals,
            cases,
            transcriptions: Vec::new(),
            lagranges_method: 0,
            decision: None,
        })
    }

    /// Asks for the decision about the multipliers of `scene` to be compared, where there is a constraint.
    ///
    /// # Errors
    /// Where it cannot be decided.
    pub fn with_decision(mut self, scene: &Scene) -> Result<Question> {
        let Some(found) = comparison::membership(scene, scene.start.t + scene.duration)? else { return Ok(self) };
        let dimension = match found.answer() {
            Answer::NoneProved { .. } | Answer::None { .. } => None,
            Answer::SomeProved | Answer::Some { .. } => Some(found.dimension()),
            Answer::Undecided => bail!("the multipliers of `{}` are undecided", scene.name),
        };
        let point = dimension.map_or(Vec::new(), |_| found.decision.set.point);
        self.decision = Some(Decided { start: scene.start.v.clone(), dimension, point });
        Ok(self)
    }

    /// Asks for `states` of the Chetaev states to be compared with SymPy's `LagrangesMethod` too.
    #[must_use]
    pub fn with_lagranges_method(mut self, states: usize) -> Question {
        self.lagranges_method = states;
        self
    }

    /// Asks for the action's direct transcription over the first `horizon`, in `intervals` intervals: the
    /// vakonomic motion, and those of the text's removals with `P(t₁) = 0` at the horizon.
    ///
    /// # Errors
    /// Where a motion of ours cannot be computed or read off.
    pub fn with_transcription(mut self, scene: &Scene, horizon: f64, intervals: usize) -> Result<Question> {
        let variational = |c: &&Choice| [VAKONOMIC, REMOVED_CONSTRAINT].contains(&c.formulation);
        let by_hand = |c: &&Choice| !is_automatic(scene, c);
        for choice in choices(scene).iter().filter(variational).filter(by_hand) {
            self.transcriptions.extend(transcription(scene, choice, horizon, intervals)?);
        }
        Ok(self)
    }

    /// For controls: replaces our equations of the first case of `formulation` before evaluation.
    ///
    /// # Errors
    /// Where the equations cannot be evaluated.
    pub fn corrupt(
        &mut self,
        scene: &Scene,
        formulation: &Formulation,
        states: usize,
        change: impl Fn(&mut Equations),
    ) -> Result<()> {
        let choice = choices(scene).into_iter().find(|c| c.formulation == formulation).context("no such case")?;
        let mut equations = equations(scene, &choice).context("refused")?;
        change(&mut equations);
        self.cases.retain(|c| c.label == choice.label);
        for case in &mut self.cases {
            case.samples = samples(scene, &choice, &equations, states)?;
            case.solvers.clear();
        }
        Ok(())
    }
}

/// The equations as derived, nothing left out; `None` where the formulation refuses.
fn equations(scene: &Scene, choice: &Choice) -> Option<Equations> {
    let derivation = Derivation { removal: choice.removal.as_ref(), ..Derivation::default() };
    (choice.formulation.derive)(&scene.system, &derivation).ok()
}

fn is_automatic(scene: &Scene, choice: &Choice) -> bool {
    choice.removal.as_ref().is_some_and(|r| scene.removals.iter().all(|own| own.name != r.name))
}

fn case(scene: &Scene, choice: &Choice, amount: Amount) -> Result<Option<Case>> {
    let Some(full) = equations(scene, choice) else { return Ok(None) };
    let costate_form = choice.formulation == VAKONOMIC_COSTATE;
    let samples = if costate_form { None } else { samples(scene, choice, &full, amount.states)? };
    let tags = if costate_form { Vec::new() } else { tags(&full) };
    let all: HashMap<String, Tag> = names(&full).into_iter().zip(tags.clone()).collect();
    let motion = if amount.times == 0 {
        None
    } else {
        let reduced = full.leave_out_unneeded();
        let motion = solve(setting(scene), reduced, &choice.constants, &Settings::default());
        motion.ok().filter(|m| m.end() > m.start()).map(|m| table(scene, m, &all, amount.times)).transpose()?
    };
    if samples.is_none() && motion.is_none() {
        return Ok(None);
    }
    let solvers = match &motion {
        None => vec![],
        Some(_) if choice.formulation == CHETAEV => vec!["CVODES", "IDAS"],
        Some(_) => vec!["CVODES"],
    };
    Ok(Some(Case {
        label: choice.label.clone(),
        formulation: choice.formulation.name,
        removal: choice.removal.as_ref().map(|r| r.name.clone()),
        automatic: is_automatic(scene, choice),
        tags,
        samples,
        motion,
        solvers,
    }))
}

fn names(equations: &Equations) -> Vec<String> {
    equations.states.iter().map(|y| equations.graph.name(y.symbol)).collect()
}

/// What each state is, in the words that the referee understands.
fn tags(equations: &Equations) -> Vec<Tag> {
    let g = &equations.graph;
    let mut costates = equations.free_constants.iter().filter_map(|c| c.memory);
    let mut multiplier = 0;
    let mut parameter = String::new();
    let mut tags = Vec::new();
    for y in &equations.states {
        let name = g.name(y.symbol);
        let stem = name.trim_end_matches('\'').to_string();
        let (kind, of) = match (y.role, &equations.removal) {
            (Role::Position, None) => ("q", stem),
            (Role::Velocity, _) => ("v", stem),
            (Role::Multiplier, _) => {
                multiplier += 1;
                ("mu", multiplier.to_string())
            }
            (Role::Position | Role::DisplacementParameter | Role::Memory, Some(removal)) => {
                if removal.memory.iter().any(|w| w.symbol == y.symbol) {
                    ("w", stem)
                } else {
                    parameter.clone_from(&stem);
                    ("u", stem)
                }
            }
            (Role::ParameterRate, _) => ("du", stem),
            (Role::ParameterSecondRate, _) => ("ddu", stem),
            (Role::ParameterMomentum, _) => ("p", parameter.clone()),
            (Role::MemoryCostate, Some(removal)) => {
                ("P", costates.next().map_or(stem, |i| g.name(removal.memory[i].symbol)))
            }
            _ => ("?", name),
        };
        tags.push((kind.into(), of));
    }
    tags
}

/// Random states near the start and our rates there; `None` where the removal has no start here.
fn samples(scene: &Scene, choice: &Choice, equations: &Equations, count: usize) -> Result<Option<Samples>> {
    let mut values = scene.system.parameter_values();
    values.extend(scene.system.values_at(&scene.start));
    if let Some(removal) = &equations.removal {
        let Ok(start) = complete_removal_start(&scene.system, removal, &scene.start) else { return Ok(None) };
        values.extend(start.values());
    }
    values.extend(equations.constant_symbols().into_iter().map(|s| (s, 0.0)));
    let base: Vec<f64> =
        equations.states.iter().map(|y| equations.graph.evaluate(y.start, &values)).collect::<Result<_, _>>()?;
    let spread = |role| match role {
        Role::Position | Role::DisplacementParameter | Role::Memory => SPREAD.0,
        _ => SPREAD.1,
    };
    let mut compiled = Compiled::new(equations)?;
    let mut random = SplitMix::new(1);
    // in [−1, 1)
    let mut uniform = || 2.0 * random.unit() - 1.0;
    let mut samples = Samples { states: Vec::new(), rates: Vec::new(), multipliers: Vec::new() };
    let mut rates = vec![0.0; base.len()];
    for _ in 0..TRIES as usize * count {
        if samples.states.len() == count {
            break;
        }
        let t = scene.start.t + 0.5 * (1.0 + uniform());
        let y: Vec<f64> =
            base.iter().zip(&equations.states).map(|(x, state)| x + spread(state.role) * uniform()).collect();
        let solved = compiled.rates(t, &y, &mut rates).is_ok() && rates.iter().all(|x| x.is_finite());
        let Ok(outputs) = compiled.outputs(t, &y) else { continue };
        if !solved {
            continue;
        }
        if choice.formulation == CHETAEV && !outputs.multipliers.is_empty() {
            samples.multipliers.push(outputs.multipliers);
        }
        samples.rates.push(rates.clone());
        samples.states.push([&[t], &y[..]].concat());
    }
    Ok((!samples.states.is_empty()).then_some(samples))
}

fn table(scene: &Scene, mut motion: Motion, all: &HashMap<String, Tag>, times: usize) -> Result<MotionTable> {
    let system = &scene.system;
    let (begin, length) = (motion.start(), motion.end() - motion.start());
    let (until, fraction) = match motion.charts.first() {
        Some(change) => (Some("its chart changes"), BEFORE_THE_END * (change.t - begin) / length),
        None if motion.is_complete() => (None, 1.0),
        None => (Some("it stops"), BEFORE_THE_END),
    };
    let times: Vec<f64> = motion.grid(times).into_iter().map(|t| begin + fraction * (t - begin)).collect();
    let differences = times.iter().map(|&t| motion.difference_of_runs(t)).collect::<Result<_, _>>()?;
    let outputs = times.iter().map(|&t| motion.at(t)).collect::<Result<Vec<_>, _>>()?;
    let vakonomic = [VAKONOMIC.name, VAKONOMIC_COSTATE.name].contains(&motion.equations.formulation);
    let (tags, start) = if motion.equations.removal.is_some() {
        let tags = names(&motion.equations).iter().filter_map(|name| all.get(name).cloned()).collect();
        (tags, motion.states_at(times[0])?)
    } else {
        let of = |kind: &'static str| system.coordinates.iter().map(move |c| (kind.to_string(), c.name.clone()));
        let mut tags: Vec<Tag> = of("q").chain(of("v")).collect();
        let mut start = [&outputs[0].coordinates[..], &outputs[0].velocities].concat();
        if vakonomic {
            tags.extend((1..=system.constraints.len()).map(|i| ("mu".into(), i.to_string())));
            start.extend(&outputs[0].multipliers);
        }
        (tags, start)
    };
    let multipliers = if vakonomic && !system.constraints.is_empty() {
        outputs.iter().map(|o| o.multipliers.clone()).collect()
    } else {
        Vec::new()
    };
    let coordinates = outputs.into_iter().map(|o| o.coordinates).collect();
    Ok(MotionTable { tags, start, times, coordinates, differences, until, multipliers })
}

/// `None` where the motion does not last that long: the vakonomic motion of the scene, or the
/// removed-constraint motion with `P(t₁) = 0` at the horizon, at the ends and middles of the intervals.
fn transcription(scene: &Scene, choice: &Choice, horizon: f64, intervals: usize) -> Result<Option<Transcription>> {
    let Some(full) = equations(scene, choice) else { return Ok(None) };
    let constants = if choice.formulation == VAKONOMIC {
        choice.constants.clone()
    } else {
        ConstantsRule::Natural { horizon: scene.start.t + horizon }
    };
    let mut short = scene.clone();
    short.duration = horizon;
    let tags = tags(&full);
    let mut motion = solve(setting(&short), full, &constants, &Settings::default())
        .with_context(|| format!("{} over {horizon}", choice.label))?;
    if !motion.is_complete() {
        return Ok(None);
    }
    let times = motion.grid(2 * intervals);
    let states = times.iter().map(|&t| motion.states_at(t)).collect::<Result<_, _>>()?;
    Ok(Some(Transcription {
        label: choice.label.clone(),
        formulation: choice.formulation.name,
        removal: choice.removal.as_ref().map(|r| r.name.clone()),
        automatic: false,
        tags,
        times,
        states,
    }))
}
