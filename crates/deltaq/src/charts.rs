//! Motions that go on where pivots have become small: in another chart, by other pivots.
//!
//! What is handed over belongs to the coordinates, not to the chart: `(q, v)`, and multipliers `μ` or
//! canonical momenta. Of a removal by coordinates, of which some are parameters `u` and the others memory
//! `w`, these are
//!
//! ```text
//! p_u = G_u̇ ,      p_w = −P      (P = −∂(L + μ·f)/∂ẇ) ,
//! ```
//!
//! the momenta `p = ∂(L + μ·f)/∂v` of the vakonomic motion that it is. It goes on as that motion, by
//! Hamilton's equations for `(q, p)`, which have no pivots.
//!
//! Both runs of a motion change at the time of the kept one, each from its own state.

use integrate::{ProjectionReport, Solution, Work};
use mechanics::ConstantsRule;

use crate::choice::derive_at;
use crate::later_chart::{Later, Names, Point};
use crate::single_run::chart_size;
use crate::trajectory::{Legs, Trajectory, outputs_in};
use crate::trial::{NotSuited, not_suited};
use crate::{Choice, Ending, Prepared, Setting, Settings, SingleRun, SolveError, TIGHTER};

/// That a motion went on by other pivots.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartChange {
    /// From this time on.
    pub t: f64,
    /// The velocities, or coordinates with the velocities, of which the others are combinations from then on;
    /// none where it goes on by canonical momenta.
    pub independent: Vec<String>,
}

impl ChartChange {
    /// By what it went on, in words.
    pub fn by(&self) -> String {
        if self.independent.is_empty() { "canonical momenta".into() } else { self.independent.join(", ") }
    }
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

/// Another chart is taken where the squares of its coefficients are smaller by this factor.
const BETTER: f64 = 4.0;
/// One that is known already is good enough, and no still better one is looked for, from this factor on.
const GOOD: f64 = 25.0;

/// Both runs of `prepared`, which starts at `setting.start`. The limits of a run are those of all its charts
/// together. Where none is better, it goes on in the one that it has; it may come back to each of them.
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
    let (mut charts, mut at, mut own): (Vec<Prepared>, Option<usize>, Option<Box<Later>>) = (Vec::new(), None, None);
    let (mut options, mut options_looser) = (settings.options(settings.tolerance * TIGHTER), None);
    options.patience = patience;
    let failure = loop {
        let here = chart(prepared, &mut charts, at);
        let kept = here.run_in_chart(setting.end, &options);
        if patience.is_finite()
            && let Some(reason) = kept.as_ref().ok().and_then(|kept| not_suited(here, kept, setting.end, &options))
        {
            return Ok(Course::Unsuited(reason));
        }
        let runs = kept.and_then(|kept| {
            let options = options_looser.get_or_insert_with(|| settings.options(settings.tolerance));
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
        let next = if left { next_chart(setting, prepared, &mut charts, at, [&kept, &looser], settings) } else { None };
        if left && next.is_none() {
            chart(prepared, &mut charts, at).go_on([&kept, &looser]);
        }
        legs.iter_mut().zip([kept, looser]).for_each(|(legs, run)| legs.push((run, own.clone())));
        if !left {
            break None;
        }
        if let Some(i) = next {
            let independent = charts[i].equations.chart.as_ref().map_or(Vec::new(), |chart| chart.independent.clone());
            changes.push(ChartChange { t, independent });
            own = Some(Box::new(Later::new(setting.system, prepared, &charts[i])));
            at = next;
        }
    };
    let ending = failure.unwrap_or_else(|| {
        let (first, mut before) = (Names::of(&prepared.equations), Vec::new());
        for t in changes.iter().map(|change| change.t).chain((!changes.is_empty()).then_some(setting.start.t)) {
            if let Ok(outputs) = outputs_in(&mut legs[0], &mut prepared.compiled, t) {
                let here = chart(prepared, &mut charts, at);
                before.push((t, here.states_of(setting.system, &first.handed_over(t, outputs))));
            }
        }
        let Prepared { equations, compiled, .. } = chart(prepared, &mut charts, at);
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

/// The chart of this number, or the first.
fn chart<'a>(first: &'a mut Prepared, charts: &'a mut [Prepared], at: Option<usize>) -> &'a mut Prepared {
    at.map_or(first, |i| &mut charts[i])
}

/// The best chart where both runs have left theirs, started there, one that is known if that is good enough;
/// none if none is better.
fn next_chart(
    setting: Setting,
    first: &mut Prepared,
    charts: &mut Vec<Prepared>,
    at: Option<usize>,
    runs: [&SingleRun; 2],
    settings: &Settings,
) -> Option<usize> {
    let (system, t) = (setting.system, runs[0].end());
    let here = chart(first, charts, at);
    let own = Names::of(&here.equations);
    let [kept, looser] = runs.map(|run| run.at(&mut here.compiled, t));
    let points = [kept.ok()?, looser.ok()?].map(|outputs| own.handed_over(t, outputs));
    let before = chart_size(&mut here.compiled, t, runs[0].solution.dense.end_state());
    if charts.is_empty() {
        charts.push(first.clone());
    }
    let mut size = |chart: &mut Prepared| {
        let y = chart.states_of(system, &points[0]);
        chart_size(&mut chart.compiled, t, &y)
    };
    let sizes: Vec<f64> = charts.iter_mut().map(&mut size).collect();
    let mut best =
        (0..sizes.len()).min_by(|&i, &k| sizes[i].total_cmp(&sizes[k])).filter(|&i| GOOD * sizes[i] <= before);
    if best.is_none() {
        let mut next = new_chart(setting, first, &points[0], settings)?;
        if BETTER * size(&mut next) <= before {
            charts.push(next);
            best = Some(charts.len() - 1);
        }
    }
    charts[best?].enter(system, &points);
    best
}

/// The equations by the best pivots at a point, where they tell all that the first chart does.
fn new_chart(setting: Setting, first: &Prepared, (start, momenta): &Point, settings: &Settings) -> Option<Prepared> {
    let equations = if first.equations.removal.is_some() {
        vakonomic::derive_from_momenta(setting.system).ok()?.leave_out_unneeded()
    } else {
        let (label, formulation) = (String::new(), first.equations.formulation);
        let choice = Choice { label, formulation, removal: None, constants: ConstantsRule::Zero };
        derive_at(setting.system, start, &choice).ok()?
    };
    let names = Names::of(&equations);
    if !names.give(&Names::of(&first.equations)) {
        return None;
    }
    Prepared::around(Setting { start, ..setting }, equations, names.constants(momenta), settings).ok()
}
