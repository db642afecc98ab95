//! `deltaq solve`: one scene, one formulation, one trajectory.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, bail, ensure};
use discrete::Composition;
use equations::{Formulation, Outputs};
use indexmap::IndexMap;
use integrals::watched;
use integrate::{Interrupt, Projection};
use mechanics::{Constancy, ConstantsRule, Observables, Removal, Watched};
use motion::band::SAMPLES;
use motion::{
    ChartChange, Choice, ErrorEstimate, Form, STEP_LIMIT, Seconds, Setting, Settings, Stepping, Steps,
    default_constants, equidistant, error_estimates, formulation_in, removal, removal_names, removals, sensitivities,
    setting, solve_by_steps, solve_choice,
};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::{Format, FreeArguments, Limits, MotionArguments, SolveArguments};
use crate::columns::{
    Columns, Derivatives, MOST_NUMBERS, Numbers, Table, derivative_row, error_row, header, named, named_columns, row,
};
use program::{Answer, complain, parallel, typed};

/// Runs the command.
pub(crate) fn run(arguments: &SolveArguments, quiet: bool) -> Result<Answer> {
    let mut settings = settings(&arguments.motion)?;
    match arguments.method {
        Stepping::Adaptive(method) => settings.method = method,
        // as many as --step asks for
        Stepping::Leapfrog if arguments.motion.limits.max_steps.is_none() => settings.max_steps = STEP_LIMIT,
        Stepping::Leapfrog => {}
    }
    let mut scene = arguments.motion.scene.find()?;
    let MotionArguments { formulation, form, free, .. } = &arguments.motion;
    let choice = choice(&scene, (formulation, form), free)?;
    if arguments.integrals {
        let kept = watched(&scene, &choice)?;
        // a coordinate or velocity has a column of its own
        let is_shown = |own: &&Watched| scene.system.graph.find_symbol(&own.name).is_none();
        let shown = kept.iter().filter(is_shown);
        let shown = shown.map(|own| Watched { constancy: Constancy::Free, ..own.clone() });
        let all: Vec<Watched> = shown.chain(kept.iter().cloned()).collect();
        scene.system.watched.extend(all);
    }
    let wanted = match &arguments.motion.times {
        Some(text) => times(text, &scene)?,
        None => equidistant(scene.start.t, scene.start.t + scene.duration, 101).collect(),
    };
    let (n, h) = (scene.system.dimension(), scene.system.constraints.len());
    let columns = 1 + 3 * n + 2 * h + scene.system.watched.len() + 2 * (2 * n + h) * arguments.sensitivities.len();
    let most = MOST_NUMBERS / columns;
    ensure!(wanted.len() <= most, "--times: of this scene and {columns} columns at most {most} times are possible");
    let steps = steps(arguments)?;
    let watched = Interrupt::default();
    (settings.interrupt, settings.times) = (Some(watched.clone()), Some(wanted.clone()));
    let mut motion = progress(&watched, setting(&scene), quiet, || match steps {
        None => solve_choice(&scene, &choice, &settings),
        Some(steps) => solve_by_steps(&scene, &choice, steps, &settings),
    })?;
    let (mut reached, mut grid) = (wanted, motion.grid(SAMPLES));
    reached.retain(|&t| t <= motion.end());
    let (mut so_far, estimate) = error_estimates(&mut motion, setting(&scene), &reached)?;
    let derived = match &arguments.sensitivities[..] {
        [] => None,
        names => {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            Some(sensitivities(&scene, &choice, &names, &reached, &settings)?)
        }
    };
    // it may end earlier by now, and derivatives may be known up to an earlier time
    let known =
        derived.as_ref().map_or(f64::INFINITY, |derived| derived.times.last().copied().unwrap_or(scene.start.t));
    let is_reached = |t: f64| t <= motion.end() && t <= known;
    grid.retain(|&t| is_reached(t));
    (reached, so_far) = reached.into_iter().zip(so_far).filter(|(t, _)| is_reached(*t)).unzip();
    let (status, mut complaint) = estimate.status(&motion);
    if let (true, Some(words)) = (motion.is_complete() && motion.doubt.is_none(), &mut complaint) {
        *words += if steps.is_some() { "; ask for a smaller --step" } else { "; ask for a smaller --tolerance" };
    }
    complaint = complaint.or_else(|| derived.as_ref()?.complaint());
    // findings about the formulation, not about its motion
    motion.breaches.iter().filter(|_| !quiet).for_each(|breach| complain(&format!("deltaq: note: {breach}")));
    let rows = reached.iter().map(|&t| motion.at(t)).collect::<Result<Vec<_>, _>>()?;
    let columns = Columns::of(&scene, &motion.equations);
    let mut program = Observables::of(&scene.system)?;
    let observed: Vec<Vec<f64>> =
        reached.iter().zip(&rows).map(|(&t, now)| program.at(t, &now.coordinates, &now.velocities).to_vec()).collect();
    let text = match arguments.motion.format {
        Format::Csv => {
            let rows = rows.iter().zip(&so_far).zip(reached.iter().zip(&observed)).enumerate();
            type Row<'a> = ((&'a Outputs, &'a ErrorEstimate), (&'a f64, &'a Vec<f64>));
            let line = |(i, ((now, errors), (&t, observed))): (usize, Row)| {
                let observed: String = observed.iter().map(|x| format!(",{x:?}")).collect();
                let derivatives = derived.as_ref().map_or(String::new(), |derived| derivative_row(derived, i));
                row(t, now) + "," + &error_row(errors) + &observed + &derivatives + "\n"
            };
            let derivatives = derived.as_ref().map_or(Vec::new(), |derived| columns.derivative_names(derived));
            let names = [columns.names(), columns.error_names(), program.names().to_vec(), derivatives].concat();
            let mut text = header(&names)?;
            text.extend(rows.map(line));
            text
        }
        Format::Json => {
            let invariants = motion.invariant_drift(&grid)?.into_iter().map(|(name, start, drift)| {
                let constant = motion.breaches.iter().all(|breach| breach.name != name);
                (name, Invariant { start, drift, constant })
            });
            let answer = Solved {
                invariants: invariants.collect(),
                scene: &scene.name,
                formulation: choice.formulation.name,
                removal: choice.removal.as_ref().map(|removal| &removal.name[..]),
                end: motion.end(),
                free_constants: named(motion::constant_names(&motion.equations), &motion.constants),
                projection: Projections { count: motion.projection.projections, largest: motion.projection.largest },
                work: Work {
                    steps: motion.work.steps,
                    rejected: motion.work.rejected,
                    evaluations: motion.work.evaluations,
                    orders: motion.work.orders,
                },
                method: motion.method.as_ref().map(|m| Stepper { name: m.method.name(), why: &m.why }),
                form: Evaluated {
                    name: motion.form.chosen.name,
                    because: &motion.form.chosen.why,
                    why: &motion.form.why,
                    fallbacks: motion.form.fallbacks,
                },
                charts: &motion.charts,
                seconds: motion.seconds,
                status,
                cause: complaint.as_deref(),
                times: &reached,
                error_estimate: estimate.absolute,
                error_estimates: columns.errors(&so_far),
                columns: columns.table(&rows),
                sensitivities: derived.as_ref().map(|derived| columns.derivatives(derived)),
                observables: named_columns(program.names(), &observed, |row| row),
            };
            typed(&answer)?
        }
    };
    Ok(Answer { text, complaint, ..Answer::default() })
}

/// A motion: `deltaq solve --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "solve/2")]
pub(crate) struct Solved<'a> {
    scene: &'a str,
    formulation: &'a str,
    /// Name of the removal, of removed-constraint equations.
    removal: Option<&'a str>,
    /// Time that the motion reached, s.
    end: f64,
    /// What the start leaves open, by name.
    free_constants: Numbers,
    /// Value at the start, and the largest difference from it.
    invariants: IndexMap<String, Invariant>,
    /// Projections onto the constraint, and the largest.
    projection: Projections,
    work: Work,
    /// The time-stepping method, and why it was taken; null in equal steps.
    method: Option<Stepper<'a>>,
    /// The form that was integrated.
    form: Evaluated<'a>,
    /// Where pivots became small, and by what the motion went on from that time, s.
    charts: &'a [ChartChange],
    /// Seconds of the clock.
    seconds: Seconds,
    #[schemars(extend("enum" = ["completed", "stopped", "untrusted"]))]
    status: &'static str,
    /// Why it is not completed or not to be trusted.
    cause: Option<&'a str>,
    /// Times, s; ascending as asked for.
    times: &'a [f64],
    /// Of the whole motion, in the kinetic metric; null where there is no motion.
    #[schemars(with = "Option<f64>")]
    error_estimate: f64,
    /// Of each coordinate, velocity and multiplier, in its unit: the largest difference of the two runs up to
    /// each time.
    error_estimates: Table<Vec<f64>>,
    #[serde(flatten)]
    columns: Table<Vec<f64>>,
    /// Where derivatives are asked for: those of all columns by each number, by its name.
    #[serde(skip_serializing_if = "Option::is_none")]
    sensitivities: Option<IndexMap<String, Derivatives>>,
    /// What the scene wants to see besides.
    observables: IndexMap<String, Vec<f64>>,
}

#[derive(Serialize, JsonSchema)]
struct Invariant {
    start: f64,
    drift: f64,
    /// False where the drift of an expected invariant exceeds its error estimate.
    constant: bool,
}

#[derive(Serialize, JsonSchema)]
struct Projections {
    count: usize,
    largest: f64,
}

#[derive(Serialize, JsonSchema)]
struct Work {
    steps: usize,
    rejected: usize,
    evaluations: usize,
    orders: usize,
}

#[derive(Serialize, JsonSchema)]
struct Stepper<'a> {
    name: &'static str,
    why: &'a str,
}

#[derive(Serialize, JsonSchema)]
struct Evaluated<'a> {
    name: &'static str,
    /// Why this form.
    because: &'a str,
    /// How the equations of an instant are solved, and why.
    why: &'a [String],
    /// How often the plain way stood in.
    fallbacks: usize,
}

/// What is not done by then has a progress bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// Does `work`, and shows on a terminal how far that is which is watched, unless `quiet`.
fn progress<T>(watched: &Interrupt, setting: Setting, quiet: bool, work: impl FnOnce() -> T) -> T {
    let (start, end) = (setting.start.t, setting.end);
    let (done, news) = channel::<()>();
    thread::scope(|scope| {
        scope.spawn(move || {
            let mut bar = None;
            while news.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let bar = bar.get_or_insert_with(|| parallel::progress(SAMPLES, quiet));
                let (t, steps) = watched.reached();
                bar.set_position(((t - start) / (end - start) * SAMPLES as f64) as u64);
                bar.set_message(format!("t = {t:.6}, {steps} steps"));
            }
            if let Some(bar) = bar {
                bar.finish_and_clear();
            }
        });
        let result = work();
        drop(done);
        result
    })
}

/// The steps of the method that has no time loop; none for the others.
fn steps(arguments: &SolveArguments) -> Result<Option<Steps>> {
    if arguments.method != Stepping::Leapfrog {
        if arguments.step.is_some() || arguments.order.is_some() {
            bail!(
                "--step and --order belong to --method leapfrog; the other methods choose their steps by --tolerance"
            );
        }
        return Ok(None);
    }
    if arguments.motion.no_projection {
        bail!("--no-projection is for the other methods: every step of leapfrog ends on the constraint");
    }
    if !arguments.sensitivities.is_empty() {
        bail!("--sensitivities are for the other methods: leapfrog carries no derivatives");
    }
    if arguments.motion.limits.max_step.is_some() {
        bail!("--max-step is for the other methods: all steps of leapfrog are as long as --step says");
    }
    let step = arguments.step.context("--method leapfrog takes equal steps: say how long with --step")?;
    let order = arguments.order.as_deref().unwrap_or("2");
    let composition = order.parse().ok().and_then(Composition::of_order);
    Ok(Some(Steps { step, composition: composition.with_context(|| format!("there is no order {order}"))? }))
}

/// Tolerance, projection and limits that were asked for.
pub(crate) fn settings(arguments: &MotionArguments) -> Result<Settings> {
    let projection = if arguments.no_projection { Projection::Off } else { Projection::EveryStep };
    let form = if arguments.form == "auto" { Form::Suited } else { Form::Named };
    limited(Settings { tolerance: arguments.tolerance, projection, form, ..Settings::default() }, &arguments.limits)
}

/// Settings with these limits.
pub(crate) fn limited(settings: Settings, limits: &Limits) -> Result<Settings> {
    if let Some(seconds) = limits.time_limit.filter(|seconds| seconds.is_nan() || *seconds <= 0.0) {
        bail!("--time-limit is {seconds:?}; it must be above 0");
    }
    let max_step = limits.max_step.unwrap_or(f64::INFINITY);
    if max_step.is_nan() || max_step <= 0.0 {
        bail!("--max-step is {max_step:?}; it must be above 0");
    }
    settings.check()?;
    let max_steps = limits.max_steps.map_or(settings.max_steps, |limit| limit as usize);
    Ok(Settings { max_steps, max_step, time_limit: limits.time_limit, ..settings })
}

/// The formulation with the removal and the constants that were asked for.
pub(crate) fn choice(
    scene: &Scene,
    (own, word): (&'static Formulation, &str),
    arguments: &FreeArguments,
) -> Result<Choice> {
    let no_such_form = || format!("--form {word}: {} has no such form", own.name);
    let (entry, _) = formulation_in(word, own).with_context(no_such_form)?;
    let removal = if entry.needs_removal() { Some(pick_removal(scene, arguments.removal.as_deref())?) } else { None };
    if removal.is_none() && (arguments.removal.is_some() || arguments.constants.is_some()) {
        bail!("--removal and --constants belong to the removed-constraint formulation, not to {}", entry.name);
    }
    if arguments.mu0.is_some() && !entry.starts_multipliers {
        bail!("--mu0 belongs to the vakonomic formulation, not to {}", entry.name);
    }
    let constants = match (&removal, &arguments.constants, &arguments.mu0) {
        (Some(_), Some(text), _) => constants_rule(text)?,
        (Some(removal), None, _) => removal.constants.clone(),
        (None, _, Some(mu0)) => ConstantsRule::Given(mu0.clone()),
        (None, _, None) => default_constants(entry, scene),
    };
    Ok(Choice { label: entry.title.into(), formulation: entry, removal, constants })
}

fn pick_removal(scene: &Scene, name: Option<&str>) -> Result<Removal> {
    let Some(name) = name else { return Ok(removals(scene)?.swap_remove(0)) };
    removal(scene, name)?
        .with_context(|| format!("unknown removal `{name}`; known: {}", removal_names(scene).join(", ")))
}

fn constants_rule(text: &str) -> Result<ConstantsRule> {
    let numbers = |list: &str| -> Result<Vec<f64>> {
        list.split(',')
            .map(|x| x.trim().parse().with_context(|| format!("`{x}` in `{text}` is not a number")))
            .collect()
    };
    match text.split_once('=') {
        None if text == "zero" => Ok(ConstantsRule::Zero),
        Some(("horizon", time)) => {
            Ok(ConstantsRule::Natural { horizon: time.parse().with_context(|| format!("`{time}` is not a time"))? })
        }
        Some(("start", list)) => Ok(ConstantsRule::Given(numbers(list)?)),
        _ => bail!("`{text}` is none of zero, horizon=T, start=A,B,…"),
    }
}

/// The times that `text` says: `a,b,c` or `from:to:count`, all of them within the run.
pub(crate) fn times(text: &str, scene: &Scene) -> Result<Vec<f64>> {
    let (start, end) = (scene.start.t, scene.start.t + scene.duration);
    let number = |x: &str| -> Result<f64> {
        x.trim().parse().with_context(|| format!("`{x}` in --times {text} is not a number"))
    };
    let times: Vec<f64> = match text.split(':').collect::<Vec<_>>()[..] {
        [from, to, count] => {
            let count: usize = count.parse().with_context(|| format!("`{count}` in --times {text} is not a count"))?;
            if !(1..=1_000_000).contains(&count) {
                bail!("--times {text} asks for {count} times; 1 to 1000000 are possible");
            }
            equidistant(number(from)?, number(to)?, count).collect()
        }
        [list] => list.split(',').map(number).collect::<Result<_>>()?,
        _ => bail!("--times {text} is neither `a,b,c` nor `from:to:count`"),
    };
    for &t in &times {
        if !(start..=end).contains(&t) {
            bail!("--times: {t:?} is outside of the run, which goes from {start:?} to {end:?}; see --set duration=…");
        }
    }
    Ok(times)
}
