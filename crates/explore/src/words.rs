//! Equations, and what is decided, in words.

use comparison::words::{Headline, decisions, rows};
use comparison::{Answer, Comparison, Extent, Pair, Verdict, integrability};
use mechanics::Integrability;
use motion::{CHETAEV, EquationStyle, VAKONOMIC, derive_at, equations_text, system_text};
use serde_json::{Value, json};

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
    let pairs: Vec<Value> = rows(&comparison).map(|p| pair(&comparison, p)).collect();
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

/// A row of the table: the verdict with its reason where it is undecided; the first time at which a
/// difference is certain and the one at which the gap passes 1e-3, in s; the largest gap in the kinetic
/// metric; the largest difference of every coordinate in its unit.
fn pair(comparison: &Comparison, pair: &Pair) -> Value {
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
        "proved": gap.proved, "certain": gap.certain_from, "visible": gap.passes[1], "largest": gap.largest,
        "until": gap.end, "coordinates": coordinates.collect::<Vec<_>>(),
    })
}

/// Why Chetaev's and the vakonomic motion are the same or not, in one sentence without symbols of its own;
/// `None` where one of them is not among the motions.
fn sentence(comparison: &Comparison) -> Option<String> {
    let (chetaev, vakonomic) = (comparison.run(CHETAEV)?, comparison.run(VAKONOMIC)?);
    let verdict = &comparison.pair(chetaev, vakonomic)?.gap.verdict;
    let constraint = match &comparison.integrability {
        Integrability::Unconstrained => {
            return Some(
                "Nothing is constrained, so Chetaev's and the vakonomic equations are both Lagrange's.".into(),
            );
        }
        Integrability::Integrable { .. } => "the constraint on velocities is one on places in disguise",
        Integrability::PartlyIntegrable { .. } => "only a part of the constraints forbids places",
        Integrability::Nonintegrable { .. } => "the constraint forbids velocities and no place",
        Integrability::NonlinearInVelocity => "the constraint is not linear in the velocities",
        Integrability::Undecided { .. } => "it is undecided whether the constraint forbids places",
    };
    let forbids_places = comparison.integrability.is_integrable();
    Some(match verdict {
        Verdict::Same if forbids_places => format!(
            "Chetaev's and the vakonomic motion are the same, because {constraint}: both formulations then compare with \
             the same neighbours."
        ),
        Verdict::Same => format!(
            "Chetaev's and the vakonomic motion show no difference from this start with these multipliers, although \
             {constraint}."
        ),
        Verdict::Different if forbids_places => format!(
            "Chetaev's and the vakonomic motion differ although {constraint}: that contradicts the theory, and one of the \
             results is wrong."
        ),
        Verdict::Different => format!(
            "Chetaev's and the vakonomic motion part because {constraint}: Chetaev compares with neighbours that the \
             constraint allows at each instant, the vakonomic formulation with neighbouring paths that keep it."
        ),
        Verdict::Undecided { because } => {
            format!("Whether Chetaev's and the vakonomic motion are the same is undecided: {because}.")
        }
    })
}
