//! Is Chetaev's motion vakonomic for some choice of the multipliers? Decided, not searched, and a no is proved.

use decision::{
    Decision, DecisionSettings, ExactStart, Family, Finding, Flow, Proof, Question, Section, Verdict, decide_flow,
};
use equations::Derivation;
use mechanics::System;
use scene::Scene;

use crate::SolveError;

/// The set of all `μ₀` with which the vakonomic motion is Chetaev's: what was computed and what was proved about it.
///
/// Forces act on both by `∫ (δL + Q·δq) dt = 0`.
#[derive(Clone, Debug)]
pub struct Membership {
    /// The set in floating point, with the least mismatch of accelerations ρ and its noise.
    pub decision: Decision,
    /// What the Taylor coefficients of the mismatch prove.
    pub proof: Proof,
    /// `μ₀ = φ(q, v)` for every start, where that was found and verified.
    pub section: Option<Section>,
}

/// What is known of the set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// It is empty: at this order a Taylor coefficient of the mismatch is not zero, whatever `μ₀` is.
    NoneProved {
        /// The order.
        order: usize,
    },
    /// It is empty, in floating point.
    None {
        /// Why that is not proved.
        unproved: String,
    },
    /// It is not empty: an identity shows it, or ranks that grow no more.
    SomeProved,
    /// It is not empty, as far as it was looked at.
    Some {
        /// Taylor coefficients agree up to this order; `None` where there are none.
        order: Option<usize>,
    },
    /// Round-off hides it.
    Undecided,
}

impl Membership {
    /// The answer. A proof is about the numbers as they are written, and has the last word.
    pub fn answer(&self) -> Answer {
        let (order, unproved) = match &self.proof.this_start {
            Finding::None(none) => return Answer::NoneProved { order: none.order },
            Finding::Contained { .. } => return Answer::SomeProved,
            Finding::ThroughOrder { order, .. } => {
                (Some(*order), format!("Taylor coefficients agree through order {order}"))
            }
            Finding::NotApplicable(reason) => (None, reason.clone()),
        };
        match self.decision.verdict {
            Verdict::Contained if self.section.is_some() => Answer::SomeProved,
            Verdict::Contained => Answer::Some { order },
            Verdict::NotContained => Answer::None { unproved },
            Verdict::Undecided => Answer::Undecided,
        }
    }
}

/// Decides whether Chetaev's motion of a scene up to `end` is vakonomic; `None` where there is no constraint.
///
/// # Errors
/// [`SolveError::Derivation`] where one of the two is refused; [`SolveError::Decision`] where the motion cannot be followed.
pub fn membership(scene: &Scene, end: f64) -> Result<Option<Membership>, SolveError> {
    let system = &scene.system;
    if system.constraints.is_empty() {
        return Ok(None);
    }
    let curve = chetaev::derive(system, &Derivation::default())?;
    let without_forces = System { forces: vec![system.graph.zero(); system.dimension()], ..system.clone() };
    let family = Family::new(system, &vakonomic::derive(&without_forces, &Derivation::default())?, false)?;
    let flow = Flow::new(system, &curve, &scene.start, &[], end)?;
    let decision = decide_flow(&family, &flow, &DecisionSettings::default())?;
    let question = Question::new(system, &curve, &[], &family)?;
    let start = ExactStart::new(system, &scene.start, &scene.completion, scene.removals.first())?;
    let proof = question.prove(&start);
    // an identity would be one at almost every start
    let section = match proof.almost_every_start {
        Finding::None(_) => None,
        _ => question.section(system, &start, &scene.start)?,
    };
    Ok(Some(Membership { decision, proof, section }))
}
