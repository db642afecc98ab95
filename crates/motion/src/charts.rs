//! Change of charts: where pivots become small, a motion is continued with equations without pivots.
//!
//! The state handed over does not depend on the chart: `(q, v)`, and multipliers `μ` or canonical momenta. A
//! form in quasi-velocities continues with multipliers, the form in which its formulation is derived. For a
//! removal by coordinates, with parameters `u` and memory `w`, the momenta are
//!
//! ```text
//! p_u = G_u̇ ,      p_w = −P      (P = −∂(L + μ·f)/∂ẇ) ,
//! ```
//!
//! equal to `p = ∂(L + μ·f)/∂v`: the motion is vakonomic, and continues by Hamilton's equations for `(q, p)`.
//!
//! Both runs of a motion change at the time of the kept one, each from its own state.

use integrate::{Options, ProjectionReport, Solution, Work};
use mechanics::{ConstantsRule, SingularValues, System};
use nalgebra::{DMatrix, DVector};

use crate::band::limits::ROUND_OFF;
use crate::chart_transition::{Later, Names, Point, Quantity};
use crate::choice::{derive_at, watch};
use crate::lost_rank::watch_rank;
use crate::prepared::GROWTH;
use crate::stiffness_probe::{NotSuited, not_suited};
use crate::table::as_derived;
use crate::trajectory::{Legs, Trajectory, outputs_in};
use crate::wanted::wanted;
use crate::{Choice, Ending, Prepared, Setting, Settings, SingleRun, SolveError, TIGHTER};

/// That a motion went on by equations without pivots.
#[derive(Clone, Debug, PartialEq, serde::Serialize, schemars::JsonSchema)]
#[schemars(rename = "Chart")]
pub struct ChartChange {
    /// From this time on.
    #[serde(rename = "from")]
    pub t: f64,
    /// By what, in words.
    #[schemars(extend("enum" = ["multipliers", "canonical momenta"]))]
    pub by: &'static str,
}

/// Both runs of a motion, from chart to chart.
pub(crate) struct Runs {
    /// The kept and the looser one.
    pub(crate) trajectories: [Trajectory; 2],
    pub(crate) changes: Vec<ChartChange>,
    pub(crate) ending: Ending,
    /// Of the kept run.
    pub(crate) work: Work,
    pub(crate) projection: ProjectionReport,
    pub(crate) fallbacks: usize,
}

/// What became of a motion by a method on trial.
pub(crate) enum Course {
    Run(Box<Runs>),
    Unsuited(NotSuited),
}

/// Both runs of `prepared`, which starts at `setting.start`. The limits of a run are those of all its charts
/// together. Where there is no other chart, it goes on in the one that it has until that may be round-off.
pub(crate) fn run(
    setting: Setting,
    prepared: &mut Prepared,
    settings: &Settings,
    patience: f64,
) -> Result<Course, SolveError> {
    let origin = prepared.origin();
    let course = run_on(setting, prepared, settings, patience);
    prepared.return_to(origin);
    course
}

fn run_on(setting: Setting, prepared: &mut Prepared, settings: &Settings, patience: f64) -> Result<Course, SolveError> {
    let (mut legs, mut changes, mut fallbacks): ([Legs; 2], Vec<ChartChange>, usize) = Default::default();
    let (mut later, mut own): (Option<Prepared>, Option<Box<Later>>) = (None, None);
    let (mut options, mut options_looser) = (settings.options(settings.tolerance * TIGHTER), None);
    options.patience = patience;
    let mut worse = 0;
    let ends = [setting.start.t, setting.end];
    options.wanted = settings.times.as_ref().map(|times| wanted(ends, times));
    let failure = loop {
        let here = later.as_mut().unwrap_or(prepared);
        let kept = here.run_in_chart(setting.end, &options);
        if patience.is_finite()
            && let Some(reason) = kept.as_ref().ok().and_then(|kept| not_suited(here, kept, setting.end, &options))
        {
            return Ok(Course::Unsuited(reason));
        }
        let runs = kept.and_then(|kept| {
            let wanted = options.wanted.clone();
            let looser = || Options { wanted, ..settings.options(settings.tolerance) };
            let options = options_looser.get_or_insert_with(looser);
            let looser = here.second_run(&kept, setting.end, options)?;
            options.before = Some(looser.solution.done());
            Ok([kept, looser])
        });
        let [kept, looser] = match runs {
            Ok(runs) => runs,
            Err(error) if legs[0].is_empty() => return Err(error),
            Err(error) => break Some(Ending::Stopped { t: here.t, cause: error.to_string() }),
        };
        options.before = Some(kept.solution.done());
        fallbacks += kept.fallbacks;
        let t = kept.end();
        let left = kept.left_chart && looser.end() == t && t != setting.end;
        let next = if left { going_on(setting, here, [&kept, &looser], settings) } else { None };
        if left && next.is_none() {
            here.go_on([&kept, &looser]);
            worse += 1;
        }
        legs.iter_mut().zip([kept, looser]).for_each(|(legs, run)| legs.push((run, own.clone())));
        if !left {
            break None;
        }
        if GROWTH.powi(worse) * ROUND_OFF * ROUND_OFF > 1.0 {
            let cause = format!(
                "velocities are combinations of others with coefficients {:.0e} times those of the start, which may \
                 be round-off, and there are no other equations to go on with",
                ROUND_OFF.recip()
            );
            break Some(Ending::Stopped { t, cause });
        }
        if let Some((by, next)) = next {
            changes.push(ChartChange { t, by });
            own = Some(Box::new(Later::new(setting.system, prepared, &next)));
            later = Some(next);
        }
    };
    let ending = failure.unwrap_or_else(|| {
        let (first, mut before) = (Names::of(&prepared.equations), Vec::new());
        for t in changes.iter().map(|change| change.t).chain((!changes.is_empty()).then_some(setting.start.t)) {
            if let Ok(outputs) = outputs_in(&mut legs[0], &mut prepared.compiled, t) {
                let here = later.as_mut().unwrap_or(prepared);
                before.push((t, here.states_of(setting.system, &first.handed_over(t, outputs))));
            }
        }
        let Prepared { equations, compiled, .. } = later.as_mut().unwrap_or(prepared);
        let [end, other] = legs.each_ref().map(|legs| {
            let run = &legs[legs.len() - 1].0;
            Ending::of(equations, compiled, &run.solution, &before)
        });
        Ending::joint(end, other, [setting.start.t, setting.end])
    });
    let Solution { work, projection, .. } = legs[0][legs[0].len() - 1].0.solution;
    let trajectory = |mut legs: Legs| match legs.len() {
        1 => Trajectory::TimeLoop(Box::new(legs.remove(0).0)),
        _ => Trajectory::Charts(legs),
    };
    let runs = Runs { trajectories: legs.map(trajectory), changes, ending, work, projection, fallbacks };
    Ok(Course::Run(Box::new(runs)))
}

/// Where both runs have left their chart: equations without pivots, started there, and by what they go on.
/// They have to tell all that the chart does.
fn going_on(
    setting: Setting,
    here: &mut Prepared,
    runs: [&SingleRun; 2],
    settings: &Settings,
) -> Option<(&'static str, Prepared)> {
    let t = runs[0].end();
    let own = Names::of(&here.equations);
    let [kept, looser] = runs.map(|run| run.at(&mut here.compiled, t));
    let mut points = [kept.ok()?, looser.ok()?].map(|outputs| own.handed_over(t, outputs));
    let chosen = other_rows(setting.system, &mut points);
    let system = chosen.as_ref().unwrap_or(setting.system);
    let setting = Setting { system, ..setting };
    let (start, named) = &points[0];
    let (by, equations) = if here.equations.removal.is_some() {
        let mut equations = vakonomic::derive_from_momenta(system).ok()?;
        watch(&mut equations, system);
        let mut equations = equations.leave_out_unneeded();
        watch_rank(&mut equations, system);
        ("canonical momenta", equations)
    } else {
        let (label, formulation) = (String::new(), as_derived(here.equations.formulation)?);
        let choice = Choice { label, formulation, removal: None, constants: ConstantsRule::Zero };
        let by = if chosen.is_some() { "other constraints of those that depend" } else { "multipliers" };
        (by, derive_at(system, start, &choice).ok()?)
    };
    let names = Names::of(&equations);
    if !names.give(&own) {
        return None;
    }
    let next = Prepared::around(Setting { start, ..setting }, equations, names.constants(named), 0, settings);
    let mut next = next.ok()?;
    next.enter(system, &points);
    Some((by, next))
}

/// The system with the constraints that are well apart at these points, of those that depend; and
/// multipliers that give the same momenta with them.
fn other_rows(system: &System, points: &mut [Point; 2]) -> Option<System> {
    if system.redundant.is_empty() {
        return None;
    }
    let all = system.all_constraints();
    let start = &points[0].0;
    let chosen = all.keeping(&all.independent_constraints(start.t, &start.q)?);
    let numbers = chosen.constraint_numbers();
    let jacobian = all.constraint_jacobian();
    let (h, n) = (jacobian.rows(), jacobian.columns());
    for (state, named) in points {
        let values = system.values_at(state);
        let entries: Option<Vec<f64>> =
            jacobian.entries().iter().map(|&e| system.graph.evaluate(e, &values).ok()).collect();
        let rows = DMatrix::from_row_slice(h, n, &entries?);
        let name = |stem: &str, number: usize| Quantity::Derived(format!("{stem}_{number}"));
        for stem in ["mu", "lambda"] {
            let value = |number: usize| named.get(&name(stem, number)).copied();
            if (1..=h).all(|number| value(number).is_none()) {
                continue;
            }
            let multipliers = DVector::from_fn(h, |i, _| value(i + 1).unwrap_or(0.0));
            let momenta = rows.transpose() * multipliers;
            let own = DMatrix::from_fn(n, numbers.len(), |j, i| rows[(numbers[i] - 1, j)]);
            let svd = SingularValues::of(&own);
            let found = svd.solve(&momenta, f64::EPSILON * svd.values[0]);
            named.extend((1..=h).map(|number| (name(stem, number), 0.0)));
            named.extend(numbers.iter().zip(&found).map(|(&number, &x)| (name(stem, number), x)));
        }
    }
    Some(chosen)
}
