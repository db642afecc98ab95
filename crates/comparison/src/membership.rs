//! Is one formulation's motion another's, for some free constants? Decided, not searched; a no is proved.

use decision::{
    Certificate, Decision, DecisionError, DecisionSettings, ExactStart, Family, Finding, Proof, Question, Section,
    Verdict, decide_flow,
};
use equations::{Derivation, Equations, Formulation};
use mechanics::{ConstantsRule, Removal, System};
use nalgebra::{DMatrix, DVector};
use scene::Scene;
use symbolic::Expr;

use crate::LeadingTerm;
use motion::{CHETAEV, Choice, Metric, SolveError, VAKONOMIC, choices_among};

/// All constants that give a formulation a given motion: what was computed and what was proved of them.
///
/// Forces act in every family by virtual work, `∫ (δL + Q·δq) dt = 0` for its own `δq`.
#[derive(Clone, Debug)]
pub struct Membership {
    /// The set in floating point, with the least mismatch of accelerations ρ and its noise.
    pub decision: Decision,
    /// The proof by Taylor coefficients of the mismatch.
    pub proof: Proof,
    /// `c = φ(q, v)` for every start, where that was found; it says whether it is proved.
    pub section: Option<Section>,
    /// The least mismatch that the proved one implies, in the same unit as ρ; looked for only where the
    /// numbers show none.
    pub implied: Option<f64>,
    /// Why every `μ₀` gives Chetaev's motion, where a theorem says so.
    pub theorem: Option<&'static str>,
    /// Whether the set is that of the constants with regular equations ([`Family::may_be_singular`]).
    pub where_regular: bool,
}

/// The answer on the set of constants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Empty: at this order a Taylor coefficient of the mismatch is not zero, for any constants.
    NoneProved {
        /// The order.
        order: usize,
    },
    /// It is empty, in floating point.
    None {
        /// Why that is not proved.
        unproved: String,
    },
    /// It is not empty: an identity shows it, checked symbolically.
    SomeProved,
    /// It is not empty, as far as it was checked.
    Some {
        /// Taylor coefficients agree up to this order; `None` where there are none.
        order: Option<usize>,
        /// Whether the ranks of these, modulo two primes, have stopped growing. That is not a proof.
        settled: bool,
    },
    /// Round-off hides it, or proof and numbers contradict each other ([`Membership::contradiction`]).
    Undecided,
}

impl Membership {
    /// Whether a theorem, or a section that is proved, gives the constants.
    pub(crate) fn is_identity(&self) -> bool {
        self.theorem.is_some() || self.section.as_ref().is_some_and(|section| section.proved)
    }

    /// The dimension of the set by ranks modulo two primes, where these grow no more, or leave less than
    /// numbers tell.
    pub(crate) fn ranked(&self) -> Option<usize> {
        let (all, in_numbers) = (self.decision.constants.len(), self.decision.set.dimension());
        match self.proof.this_start {
            Finding::Contained { rank, .. } => Some(all - rank),
            Finding::ThroughOrder { rank, .. } => Some(all - rank).filter(|left| *left < in_numbers),
            _ => None,
        }
    }

    /// The dimension of the set: what fixes a constant may be less than round-off, and ranks see it.
    pub fn dimension(&self) -> usize {
        self.ranked().unwrap_or(self.decision.set.dimension())
    }

    /// Whether numbers do not tell up to the end what holds on the branch of the start.
    fn may_leave_its_branch(&self) -> bool {
        self.proof.domain.branch && self.decision.until.is_some()
    }

    /// Whether what holds on the branch of the start does not hold up to the end.
    fn leaves_its_branch(&self) -> bool {
        self.proof.domain.branch && self.decision.verdict == Verdict::NotContained
    }

    /// The answer. A proof is about the numbers as they are written, and has the last word, unless what is
    /// computed in floating point excludes it: then one of the two is wrong, and there is no answer.
    pub fn answer(&self) -> Answer {
        if self.contradiction().is_some() {
            return Answer::Undecided;
        }
        let (order, unproved) = match &self.proof.this_start {
            Finding::None(none) if none.full_rank => return Answer::NoneProved { order: none.order },
            Finding::None(none) => {
                let reason = "no minor of full size shows it: ranks modulo two primes do";
                return Answer::None { unproved: format!("{reason} (order {})", none.order) };
            }
            Finding::Contained { .. } if self.leaves_its_branch() => {
                return Answer::None { unproved: "near the start some do, on a branch that the motion leaves".into() };
            }
            Finding::Contained { .. } if self.is_identity() => return Answer::SomeProved,
            Finding::Contained { order, .. } if !self.may_leave_its_branch() => {
                return Answer::Some { order: Some(*order), settled: true };
            }
            Finding::Contained { order, .. } => (Some(*order), String::new()),
            Finding::ThroughOrder { order, .. } => {
                (Some(*order), format!("Taylor coefficients agree through order {order}"))
            }
            Finding::NotApplicable(reason) => (None, reason.clone()),
        };
        match self.decision.verdict {
            Verdict::Contained if self.is_identity() => Answer::SomeProved,
            Verdict::Contained => Answer::Some { order, settled: false },
            Verdict::NotContained => Answer::None { unproved },
            Verdict::Undecided => Answer::Undecided,
        }
    }
}

/// A motion of a scene and a family of motions through the same start.
pub struct Pairing<'a> {
    scene: &'a Scene,
    curve: Equations,
    constants: Vec<f64>,
    family: Family,
}

impl<'a> Pairing<'a> {
    /// The motion of `curve`, free constants given or zero, and the motions of `family` for all of its own.
    ///
    /// # Errors
    /// [`SolveError::Derivation`] if one is refused; [`SolveError::Decision`] if not affine in costates.
    pub fn new(scene: &'a Scene, curve: &Choice, family: &Choice) -> Result<Self, SolveError> {
        let equations = as_derived(&scene.system, curve)?;
        let reason = "its constants are found by a search, and have no exact values".to_owned();
        let constants = match &curve.constants {
            ConstantsRule::Zero => vec![0.0; equations.free_constants.len()],
            ConstantsRule::Given(values) => values.clone(),
            ConstantsRule::Natural { .. } => {
                return Err(DecisionError::Unsuited { formulation: equations.formulation, reason }.into());
            }
        };
        Pairing::with_curve(scene, equations, constants, family)
    }

    /// [`Pairing::new`] for a motion of equations in no table, with values for their free constants.
    ///
    /// # Errors
    /// As [`Pairing::new`].
    pub fn with_curve(
        scene: &'a Scene,
        curve: Equations,
        constants: Vec<f64>,
        family: &Choice,
    ) -> Result<Self, SolveError> {
        let equations = as_derived(&scene.system, family)?;
        let family = Family::new(&scene.system, &equations)?;
        Ok(Pairing { scene, curve, constants, family })
    }

    /// Decides for which constants of the family the motion is one of its own, up to `end`.
    ///
    /// # Errors
    /// [`SolveError::Decision`] where the motion cannot be followed.
    pub fn decide(&self, end: f64) -> Result<Membership, SolveError> {
        symbolic::question(|| self.decided(end)).map_err(DecisionError::from)?
    }

    fn decided(&self, end: f64) -> Result<Membership, SolveError> {
        let (system, start) = (&self.scene.system, &self.scene.start);
        let question = self.question()?;
        let exact = self.exact_start()?;
        let proof = question.prove(&exact);
        let flow = question.flow(system, start, end);
        // the numbers only tell how far a motion misses a family in which it is proved not to be
        let refuted = matches!(proof.this_start, Finding::None(_));
        let decision = decide_flow(&self.family, &flow, &DecisionSettings { refuted, ..DecisionSettings::default() })?;
        // an identity would be one at almost every start
        let all = decision.verdict == Verdict::Contained && decision.set.dimension() == decision.set.point.len();
        let section = match proof.almost_every_start {
            Finding::None(_) => None,
            _ if !self.constants.is_empty() => None,
            Finding::NotApplicable(_) if all => question.every_constant(system),
            _ => question.section(system, &exact, start)?,
        };
        let theorem = if all && section.is_none() { self.theorem(&exact) } else { None };
        let unseen = refuted && decision.verdict == Verdict::Contained;
        let least = |time| question.least_by_series(system, start, time);
        let implied = unseen.then(|| least(decision.until.unwrap_or(end - start.t))).flatten();
        Ok(Membership { decision, proof, section, implied, theorem, where_regular: self.family.may_be_singular() })
    }

    /// Vakonomic motions are Chetaev's for every `μ₀` where the constraints are integrable (theorem 3):
    /// `f = g dh/dt` with an invertible `g`, and for `dh/dt` the equations contain `μ` as a rate only, `−λ`.
    /// At rest they do so as well.
    fn theorem(&self, start: &ExactStart) -> Option<&'static str> {
        if self.curve.formulation != CHETAEV.name || self.family.formulation() != VAKONOMIC.name {
            return None;
        }
        if start.is_at_rest() {
            return Some("nothing moves, and the constraints are linear in the velocities");
        }
        let all = start.integrable_combinations() == self.scene.system.constraints.len();
        all.then_some("the constraints are integrable")
    }

    /// The constants of least mismatch of accelerations up to `end`, in floating point: those that give the
    /// motion, if any do, or else a first guess at those of the motion nearest to it.
    ///
    /// # Errors
    /// [`SolveError::Decision`] where the motion cannot be followed.
    pub fn nearest(&self, end: f64) -> Result<Vec<f64>, SolveError> {
        let flow = self.question()?.flow(&self.scene.system, &self.scene.start, end);
        let settings = DecisionSettings { refuted: true, ..DecisionSettings::default() };
        Ok(decide_flow(&self.family, &flow, &settings)?.set.point)
    }

    /// The certificate that no constants do from the scene's start, or from one drawn at random and so from
    /// almost every one, for others to check; the reason in words where there is none.
    ///
    /// # Errors
    /// [`SolveError::Decision`] where an expression cannot be evaluated.
    pub fn certificate(&self, almost_every_start: bool) -> Result<Result<Certificate, String>, SolveError> {
        let question = self.question()?;
        let start = self.exact_start()?;
        Ok(if almost_every_start { question.almost_every_certificate(&start) } else { question.certificate(&start) })
    }

    /// How the family's motion with `constants` leaves the other; `None` without a term up to the twelfth.
    ///
    /// # Errors
    /// [`SolveError::Decision`] where an expression cannot be evaluated.
    pub fn leading_term(&self, constants: &[f64]) -> Result<Option<LeadingTerm>, SolveError> {
        let (system, start) = (&self.scene.system, &self.scene.start);
        let question = self.question()?;
        let exact = self.exact_start()?;
        let Some(term) = question.leading_difference(system, start, Some(&exact), constants) else { return Ok(None) };
        let length = Metric::new(system)?.length(start.t, &start.q, &start.v, &term.coefficient);
        let exponent = term.exponent as u32;
        let (from, reach, proved) = (term.from, term.reach, term.exact);
        Ok(Some(LeadingTerm { exponent, coefficient: term.coefficient, length, from, reach, proved }))
    }

    /// Names of the constants of the family.
    pub fn constants(&self) -> &[String] {
        self.family.constants()
    }

    fn question(&self) -> Result<Question<'_>, DecisionError> {
        Question::new(&self.scene.system, &self.curve, &self.constants, &self.family)
    }

    fn exact_start(&self) -> Result<ExactStart, DecisionError> {
        let scene = self.scene;
        ExactStart::new(&scene.system, &scene.start, &scene.completion, scene.removals.first())
    }
}

/// A choice's equations, nothing left out.
fn as_derived(system: &System, choice: &Choice) -> Result<Equations, SolveError> {
    let derivation = Derivation { removal: choice.removal.as_ref(), start: None, all_costates: true };
    Ok((choice.formulation.derive)(system, &derivation)?)
}

/// Decides whether Chetaev's motion of a scene up to `end` is vakonomic; `None` where there is no constraint.
///
/// # Errors
/// As [`Pairing::new`] and [`Pairing::decide`].
pub fn membership(scene: &Scene, end: f64) -> Result<Option<Membership>, SolveError> {
    principal(scene)?.map(|pairing| pairing.decide(end)).transpose()
}

/// The certificate that no `μ₀` makes the vakonomic motion Chetaev's, from the scene's start or from almost
/// every one; or the reason in words.
///
/// # Errors
/// As [`Pairing::new`] and [`Pairing::certificate`].
pub fn certificate(scene: &Scene, almost_every_start: bool) -> Result<Result<Certificate, String>, SolveError> {
    let nothing = Ok(Err("nothing is constrained".into()));
    principal(scene)?.map_or(nothing, |pairing| pairing.certificate(almost_every_start))
}

/// Chetaev's motion and the vakonomic family; none where nothing is constrained.
fn principal(scene: &Scene) -> Result<Option<Pairing<'_>>, SolveError> {
    let choices = choices_among(scene, |own| own == CHETAEV || own == VAKONOMIC);
    let of = |own: &Formulation| choices.iter().find(|choice| choice.formulation == own);
    match (of(CHETAEV), of(VAKONOMIC)) {
        (Some(curve), Some(family)) if !scene.system.constraints.is_empty() => {
            Pairing::new(scene, curve, family).map(Some)
        }
        _ => Ok(None),
    }
}

/// The costates with which the motion of a removal by coordinates is the vakonomic motion with `multipliers`:
///
/// ```text
/// P₀ = −∂(L + μ₀·f)/∂ẇ        (for f = ẇ − B: μ₀ = −P₀ − L_ẇ) .
/// ```
///
/// `None` where some parameter or memory variable is not a coordinate: then the two families differ.
///
/// # Errors
/// [`SolveError::Compile`] where an expression has no value at the start.
pub fn costates_of(scene: &Scene, removal: &Removal, multipliers: &[f64]) -> Result<Option<Vec<f64>>, SolveError> {
    let Some((momenta, jacobian)) = along_memory(scene, removal)? else { return Ok(None) };
    let pull = jacobian.transpose() * DVector::from_column_slice(multipliers);
    Ok(Some(momenta.iter().zip(&pull).map(|(p, pull)| -p - pull).collect()))
}

/// The multipliers with which the vakonomic motion is that of a removal by coordinates with `costates`, one a
/// memory variable: the inverse of [`costates_of`].
///
/// # Errors
/// [`SolveError::Compile`] where an expression has no value at the start.
pub fn multipliers_of(scene: &Scene, removal: &Removal, costates: &[f64]) -> Result<Option<Vec<f64>>, SolveError> {
    let Some((momenta, jacobian)) = along_memory(scene, removal)? else { return Ok(None) };
    let pull = DVector::from_iterator(momenta.len(), momenta.iter().zip(costates).map(|(p, c)| -p - c));
    Ok(jacobian.transpose().lu().solve(&pull).map(|mu| mu.as_slice().to_vec()))
}

/// `L_ẇ` and `∂f/∂ẇ` (h×h).
type AlongMemory = (Vec<f64>, DMatrix<f64>);

/// These at the start, where all parameters and memory variables are coordinates.
fn along_memory(scene: &Scene, removal: &Removal) -> Result<Option<AlongMemory>, SolveError> {
    let system = scene.system.clone();
    let g = &system.graph;
    let memory: Option<Vec<usize>> = removal.memory.iter().map(|w| w.coordinate).collect();
    let Some(memory) = memory.filter(|memory| {
        !memory.is_empty()
            && memory.len() == system.constraints.len()
            && removal.parameters.iter().all(|u| u.coordinate.is_some())
    }) else {
        return Ok(None);
    };
    let rates: Vec<_> = memory.iter().map(|&i| system.coordinates[i].velocity).collect();
    let values = system.values_at(&scene.start);
    let numbers = |es: &[Expr]| es.iter().map(|&e| g.evaluate(e, &values)).collect::<Result<Vec<f64>, _>>();
    let momenta = numbers(&g.gradient(system.lagrangian, &rates))?;
    let jacobian = numbers(g.jacobian(&system.constraints, &rates).entries())?;
    Ok(Some((momenta, DMatrix::from_row_slice(rates.len(), rates.len(), &jacobian))))
}
