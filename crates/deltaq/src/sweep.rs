//! One point of a sweep: where Chetaev's and the vakonomic motion of a scene part, and whether they have to.

use scene::Scene;

use crate::{Answer, Comparison, Extent, Membership, Settings, SolveError, THRESHOLDS, Verdict, choices_among};

/// What a comparison of Chetaev's and the vakonomic motion found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweepPoint {
    /// `same`, `different` or `undecided`; empty where one has no motion.
    pub verdict: &'static str,
    /// First time at which the gap passes 1e-3, over the start time.
    pub apart: Option<f64>,
    /// Largest gap, in the kinetic metric.
    pub largest: Option<f64>,
    /// What a gap had to pass at the end.
    pub limit: Option<f64>,
    /// Whether some `μ₀` makes the vakonomic motion Chetaev's: `some`, `none` or `undecided`, with ` proved`.
    pub answer: &'static str,
    /// The order of the Taylor coefficient that proves there is none.
    pub order: Option<usize>,
    /// Dimension of the set of such `μ₀`.
    pub dimension: Option<usize>,
    /// Least mismatch of accelerations over the motion's own, ρ.
    pub mismatch: Option<f64>,
    /// Why there is no verdict or no answer.
    pub cause: String,
}

/// The comparison of one scene, without fits: a pure function of it.
pub fn sweep_point(scene: Scene, settings: &Settings) -> SweepPoint {
    let mut point = SweepPoint::default();
    if let Err(error) = fill(&mut point, scene, settings) {
        point.cause = error.to_string();
    }
    point
}

fn fill(point: &mut SweepPoint, scene: Scene, settings: &Settings) -> Result<(), SolveError> {
    let start = scene.start.t;
    let choices = choices_among(&scene, |name| name == "chetaev" || name == "vakonomic");
    let mut comparison = Comparison::new(scene, Extent::Answer, settings)?;
    for choice in choices {
        comparison.solve(choice, settings)?;
    }
    if let Some(Err(error)) = comparison.runs.iter().map(|run| &run.outcome).find(|outcome| outcome.is_err()) {
        point.cause = error.to_string();
    }
    if let Some(pair) = comparison.pairs.first() {
        let gap = &pair.gap;
        point.verdict = gap.verdict.word();
        if let Verdict::Undecided { because } = &gap.verdict {
            point.cause.clone_from(because);
        }
        point.apart = THRESHOLDS.iter().position(|&at| at == 1e-3).and_then(|i| gap.passes[i]).map(|t| t - start);
        point.largest = Some(gap.largest);
        point.limit = gap.points.last().map(|last| last.limit);
    }
    comparison.decide_next();
    match comparison.membership() {
        None => {}
        Some(Err(error)) => point.cause = error.to_string(),
        Some(Ok(membership)) => decided(point, membership),
    }
    Ok(())
}

fn decided(point: &mut SweepPoint, membership: &Membership) {
    let decision = &membership.decision;
    point.answer = match membership.answer() {
        Answer::NoneProved { order } => {
            point.order = Some(order);
            "none proved"
        }
        Answer::None { .. } => "none",
        Answer::SomeProved => "some proved",
        Answer::Some { .. } => "some",
        Answer::Undecided => "undecided",
    };
    point.dimension = point.answer.starts_with("some").then(|| decision.set.dimension());
    point.mismatch = Some(decision.least / decision.acceleration).filter(|mismatch| mismatch.is_finite());
}
