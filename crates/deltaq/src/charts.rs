//! Motions that go on where pivots have become small: in another chart, by other pivots.
//!
//! What is handed over belongs to the coordinates, not to the chart: `(q, v)`, and multipliers `μ` or
//! canonical momenta. Of a removal by coordinates, of which some are parameters `u` and the others memory
//! `w`, these are
//!
//! ```text
//! p_u = G_u̇ ,      p_w = −P      (P = −∂(L + μ·f)/∂ẇ) ,      so   P = −p_w   for whatever w the next chart
//! has.
//! ```
//!
//! Both runs of a motion change at the time of the kept one, each from its own state.

use integrate::{ProjectionReport, Work};
use mechanics::{ConstantsRule, Removal};

use crate::choice::derive_at;
use crate::later_chart::{Later, Names, momentum};
use crate::single_run::chart_size;
use crate::trajectory::Trajectory;
use crate::{Choice, Ending, Prepared, Setting, Settings, SingleRun, SolveError, TIGHTER};

/// That a motion went on by other pivots.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartChange {
    /// From this time on.
    pub t: f64,
    /// The velocities, or coordinates with the velocities, of which the others are combinations from then on.
    pub independent: Vec<String>,
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

/// A new chart is taken where the squares of its coefficients are smaller by this factor.
const BETTER: f64 = 4.0;

type Legs = Vec<(SingleRun, Option<Box<Later>>)>;

/// Both runs of `prepared`, which starts at `setting.start`.
pub(crate) fn run(setting: Setting, prepared: &mut Prepared, settings: &Settings) -> Result<Runs, SolveError> {
    let (mut work, mut projection, mut fallbacks) = (Work::default(), ProjectionReport::default(), 0);
    let (mut legs, mut changes): ([Legs; 2], Vec<ChartChange>) = Default::default();
    let mut later: Option<(Prepared, Box<Later>)> = None;
    let first = Names::of(&prepared.equations);
    let mut options = settings.options(settings.tolerance * TIGHTER);
    let ending = loop {
        let own = later.as_ref().map(|(_, own)| own.clone());
        let here = later.as_mut().map_or(&mut *prepared, |(here, _)| here);
        let mut kept = here.run(setting.end, &options, true)?;
        let mut looser = here.second_run(&kept, setting.end, settings)?;
        let mut next = None;
        if kept.left_chart {
            if looser.end() == kept.end() {
                next = next_chart(setting, here, [&kept, &looser], settings);
            }
            let names = next.as_ref().map(|next| Names::of(&next.equations));
            next = next.filter(|_| names.is_some_and(|names| names.give(&first)));
            if next.is_none() {
                kept = here.run(setting.end, &options, false)?;
                looser = here.second_run(&kept, setting.end, settings)?;
            }
        }
        options.max_steps = options.max_steps.saturating_sub(kept.solution.work.steps + kept.solution.work.rejected);
        add(&mut work, &kept.solution.work);
        projection = together(projection, &kept.solution.projection);
        fallbacks += kept.fallbacks;
        legs.iter_mut().zip([kept, looser]).for_each(|(legs, run)| legs.push((run, own.clone())));
        let Some(next) = next else {
            let last = [0, 1].map(|i| &legs[i][changes.len()].0.solution);
            let [end, other] = last.map(|run| Ending::of(&here.equations, &mut here.compiled, run));
            break Ending::joint(end, other, [setting.start.t, setting.end]);
        };
        changes.push(ChartChange {
            t: next.t,
            independent: next.equations.chart.as_ref().map_or(Vec::new(), |chart| chart.independent.clone()),
        });
        let own = Box::new(Later::new(setting.system, prepared, &next));
        later = Some((next, own));
    };
    let trajectory = |mut legs: Legs| match legs.len() {
        1 => Trajectory::TimeLoop(Box::new(legs.remove(0).0)),
        _ => Trajectory::Charts(legs),
    };
    Ok(Runs { trajectories: legs.map(trajectory), changes, ending, work, projection, fallbacks })
}

/// The equations by the best pivots where both runs have left `here`, started there; none if there are none
/// that are better.
fn next_chart(setting: Setting, here: &mut Prepared, runs: [&SingleRun; 2], settings: &Settings) -> Option<Prepared> {
    let system = setting.system;
    let t = runs[0].end();
    let own = Names::of(&here.equations);
    let [kept, looser] = runs.map(|run| run.at(&mut here.compiled, t));
    let [(start, momenta), (other, other_momenta)] =
        [kept.ok()?, looser.ok()?].map(|outputs| own.handed_over(t, outputs));
    let removal = here.equations.removal.as_ref().map(|_| Removal::by_coordinates(system, &start)).transpose().ok()?;
    let costates = removal.iter().flat_map(|removal| &removal.memory).map(|w| {
        let name = momentum(&system.graph.name(w.symbol));
        -momenta.get(&name).copied().unwrap_or(0.0)
    });
    let constants = ConstantsRule::Given(costates.collect());
    let choice = Choice { label: String::new(), formulation: here.equations.formulation, removal, constants };
    let equations = derive_at(system, &start, &choice).ok()?;
    let names = Names::of(&equations);
    let setting = Setting { start: &start, ..setting };
    let mut next = Prepared::around(setting, equations, names.constants(&momenta), settings).ok()?;
    let before = chart_size(&mut here.compiled, t, runs[0].solution.dense.end_state());
    if BETTER * chart_size(&mut next.compiled, t, &next.start) > before {
        return None;
    }
    next.values.set(&system.values_at(&other));
    next.values.set_constants(&names.constants(&other_momenta));
    next.other_start = Some(next.values.evaluate().0.to_vec());
    Some(next)
}

fn add(work: &mut Work, more: &Work) {
    work.steps += more.steps;
    work.rejected += more.rejected;
    work.evaluations += more.evaluations;
    work.jacobians += more.jacobians;
    work.orders += more.orders;
}

fn together(a: ProjectionReport, b: &ProjectionReport) -> ProjectionReport {
    ProjectionReport {
        projections: a.projections + b.projections,
        largest: a.largest.max(b.largest),
        total: a.total + b.total,
    }
}
