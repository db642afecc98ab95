//! Equations, and what is decided, in words.

use comparison::words::{Headline, decisions, rows};
use comparison::{Answer, Comparison, Extent, Gap, Pair, Verdict, integrability};
use mechanics::Integrability;
use motion::{CHETAEV, EquationStyle, Metric, SolveError, TRUSTED, VAKONOMIC, derive_at, equations_text, system_text};
use serde_json::{Value, json};

use crate::motions::yardstick;
use crate::question::{Question, Refused};
use crate::run::settings;
use crate::subject::Subject;

/// The system and the equations of every motion, in Markdown with LaTeX.
pub(crate) fn equations(subject: &Subject) -> Result<Value, Refused> {
    let Subject { scene, choices, .. } = subject;
    let motion = |choice: &motion::Choice| match derive_at(&scene.system, &scene.start, choice) {
        Ok(equations) => {
            json!({ "label": choice.label, "equations": equations_text(&equations, EquationStyle::Latex) })
        }
        Err(error) => json!({ "label": choice.label, "refused": error.to_string() }),
    };
    let integrability = integrability(scene)?;
    Ok(json!({
        "system": system_text(&scene.system, EquationStyle::Latex),
        "integrability": integrability.to_string(),
        "motions": choices.iter().map(motion).collect::<Vec<_>>(),
    }))
}

/// The verdict, why, how sure that is, which motion a real system has; pair by pair; and which families have
/// which motions.
pub(crate) fn decision(subject: Subject, question: &Question) -> Result<Value, Refused> {
    let Subject { scene, choices, .. } = subject;
    let settings = settings(question);
    let mut comparison = Comparison::new(scene, Extent::Everything, &settings)?;
    for choice in choices {
        comparison.solve(choice, &settings)?;
    }
    while comparison.decide_next().is_some() {}
    let Headline { verdict, why, sure, which } = Headline::of(&comparison);
    let yardstick = yardstick(&comparison.scene, &mut Metric::new(&comparison.scene.system).map_err(SolveError::from)?);
    let pairs: Vec<Value> = rows(&comparison).map(|p| pair(&comparison, p, yardstick)).collect();
    let decided = comparison.decided.iter().zip(decisions(&comparison));
    let decided = decided.map(|(decided, [family, motion, which, reason])| {
        let answer = decided.outcome.as_ref().map_or("undecided", |found| word(&found.answer()));
        json!({ "family": family, "motion": motion, "which": which, "reason": reason, "answer": answer })
    });
    Ok(json!({
        "verdict": verdict, "why": why, "sure": sure, "whose": which, "sentence": sentence(&comparison), "pairs": pairs,
        "decisions": decided.collect::<Vec<_>>(),
    }))
}

/// Whether some constants of a family give a motion; proved or measured.
fn word(answer: &Answer) -> &'static str {
    match answer {
        Answer::NoneProved { .. } => "none, proved",
        Answer::None { .. } => "none, measured",
        Answer::SomeProved => "some, proved",
        Answer::Some { .. } => "some, measured",
        Answer::Undecided => "undecided",
    }
}

/// A row of the table: the verdict with its reason if it is undecided; the first time at which a difference
/// is certain and the one at which the gap passes [`SEEN`], in s; the largest gap in the unit of the
/// yardstick; the largest difference of every coordinate in its unit.
fn pair(comparison: &Comparison, pair: &Pair, (yardstick, unit): (f64, &str)) -> Value {
    let label = |run: usize| comparison.runs[run].choice.label.as_str();
    let gap = &pair.gap;
    let because = match &gap.verdict {
        Verdict::Undecided { because } => Some(because),
        Verdict::Same | Verdict::Different => None,
    };
    let coordinates = comparison.scene.system.coordinates.iter().zip(&gap.largest_by_coordinate);
    let coordinates = coordinates.map(|(c, by)| json!({ "name": c.name, "unit": c.unit, "by": by }));
    json!({
        "first": label(pair.first), "second": label(pair.second), "verdict": gap.verdict.word(), "because": because,
        "proved": gap.proved, "certain": gap.certain_from, "visible": visible(gap, TRUSTED * yardstick), "largest": gap.largest / yardstick,
        "unit": unit, "until": gap.end, "coordinates": coordinates.collect::<Vec<_>>(),
    })
}

/// The first time at which a gap that is certain passes `threshold`, between points on a line of logarithms.
fn visible(gap: &Gap, threshold: f64) -> Option<f64> {
    let after = gap.points.iter().position(|p| p.gap > threshold && p.gap > p.limit)?;
    let [a, b] = [&gap.points[after.saturating_sub(1)], &gap.points[after]];
    let part = (threshold / a.gap).ln() / (b.gap / a.gap).ln();
    let [from, to] = [a.t - gap.start, b.t - gap.start];
    Some(if a.gap > 0.0 && from > 0.0 { gap.start + from * (to / from).powf(part) } else { b.t })
}

/// Why Chetaev's and the vakonomic motion are the same or not, in one sentence without symbols of its own;
/// `None` where one of them is not among the motions.
fn sentence(comparison: &Comparison) -> Option<String> {
    let (chetaev, vakonomic) = (comparison.run(CHETAEV)?, comparison.run(VAKONOMIC)?);
    let verdict = &comparison.pair(chetaev, vakonomic)?.gap.verdict;
    let constraint = match &comparison.integrability {
        Integrability::Unconstrained => {
            return Some(
                "There is no constraint, so Chetaev's and the vakonomic equations are both Lagrange's.".into(),
            );
        }
        Integrability::Integrable { .. } => "the constraint is holonomic",
        Integrability::PartlyIntegrable { .. } => "the constraints are only partly holonomic",
        Integrability::Nonintegrable { .. } => "the constraint is nonholonomic",
        Integrability::NonlinearInVelocity => "the constraint is not linear in the velocities",
        Integrability::Undecided { .. } => "it is undecided whether the constraint is holonomic",
    };
    let holonomic = comparison.integrability.is_integrable();
    Some(match verdict {
        Verdict::Same if holonomic => format!(
            "Chetaev's and the vakonomic motion are the same because {constraint}. Both formulations then compare a \
             motion with the same curves."
        ),
        Verdict::Same => format!(
            "Chetaev's and the vakonomic motion do not differ measurably from this start with these multipliers, \
             although {constraint}."
        ),
        Verdict::Different if holonomic => format!(
            "Chetaev's and the vakonomic motion differ although {constraint}. That contradicts the theory, so one of \
             the results is wrong."
        ),
        Verdict::Different => format!(
            "Chetaev's and the vakonomic motion diverge because {constraint}. Chetaev compares a motion with small \
             shifts that the constraint allows at each instant, the vakonomic formulation with curves that satisfy it."
        ),
        Verdict::Undecided { because } => {
            format!("Whether Chetaev's and the vakonomic motion are the same is undecided: {because}.")
        }
    })
}
