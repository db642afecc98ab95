//! Two derivation paths, one answer: results that cannot both be true, in one place for all commands.
//!
//! Motions, the decision in floating point, the proof over a finite field and Frobenius' test share little
//! code. If two of them contradict each other, one is wrong, and no conclusion is drawn from either. What
//! other packages say of a scene is held against its own motion, or another derivation, as [`Beside`].

use std::fmt::{self, Display, Formatter};

use decision::{Finding, Verdict as Floating};
use mechanics::{Domain, Integrability};
use scene::Scene;

use crate::fits::Fit;
use crate::runs::{Decided, Pair};
use crate::{Answer, Comparison, Growth, LeadingTerm, Membership, Run, Verdict, membership};
use motion::band::{Answer as Asked, Breach, Known, ask};
use motion::{CHETAEV, Motion, PRESCRIBED, TRUSTED, VAKONOMIC, VAKONOMIC_COSTATE, is_in_table};

/// Two results that exclude each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contradiction {
    /// Statement of the first.
    pub one: String,
    /// Statement of the second.
    pub other: String,
}

impl Display for Contradiction {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}, but {}", self.one, self.other)
    }
}

/// The explanation of a contradiction in messages.
pub(crate) const FAULT: &str = "This is a fault of the program: please report it, with the scene.";

/// Results contradict each other, and no conclusion is drawn from them.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("results contradict each other. {FAULT}{}", .0.iter().map(|found| format!("\n  {found}")).collect::<String>())]
pub struct Contradicted(pub Vec<String>);

/// Checks a certificate ([`crate::certificate`]) against results in floating point, which share little code
/// with it and can only contradict it.
///
/// # Errors
/// [`Contradicted`], with the name of the scene.
pub fn holds_beside_numbers(scene: &Scene) -> Result<(), Contradicted> {
    let numbers = membership(scene, scene.start.t + scene.duration).ok().flatten();
    contradicted(scene, numbers.and_then(|found| found.contradiction()).as_slice())
}

/// A sentence on a scene, and what is known of the same from its motion, another derivation or a search.
#[derive(Clone, Copy, Debug)]
pub enum Beside<'a> {
    /// A quantity is constant; its change along a motion ([`Known::change`]).
    Constant(&'a str, Known),
    /// A quantity is proved not to be constant on almost every motion; its changes along several.
    NotConstant(&'a str, &'a [Known]),
    /// There are at most so many of a kind; those that were found.
    AtMost(&'a str, usize, &'a [&'a str]),
    /// Frobenius' verdict; integrable combinations by ranks of brackets over a finite field.
    Brackets(&'a Integrability, usize),
    /// Chetaev's motions are proved to be those of a family, whose least χ² is so much above theirs.
    Contained(&'a str, f64),
    /// Two methods of one question do not agree.
    Methods(&'a str),
}

/// Holds sentences on a scene against what is known beside them.
///
/// # Errors
/// [`Contradicted`], with the name of the scene.
pub fn hold<'a>(scene: &Scene, sentences: impl IntoIterator<Item = Beside<'a>>) -> Result<(), Contradicted> {
    let found: Vec<Contradiction> = sentences.into_iter().filter_map(|beside| beside.contradiction(scene)).collect();
    contradicted(scene, &found)
}

fn contradicted(scene: &Scene, found: &[Contradiction]) -> Result<(), Contradicted> {
    let lines: Vec<String> = found.iter().map(|found| format!("{}: {found}", scene.name)).collect();
    if lines.is_empty() { Ok(()) } else { Err(Contradicted(lines)) }
}

impl Beside<'_> {
    fn contradiction(self, scene: &Scene) -> Option<Contradiction> {
        let largest = |changes: &[Known]| changes.iter().map(Known::of_terms).fold(0.0, f64::max);
        let (is_wrong, one, other) = match self {
            // a motion may leave the branch of its start
            Beside::Constant(quantity, change) => (
                change.is_certain() && !Domain::of(&scene.system).branch,
                format!("{quantity} = const"),
                format!("it changes by {:.0e} of its terms along the motion", change.of_terms()),
            ),
            Beside::NotConstant(quantity, changes) => (
                !changes.is_empty() && !changes.iter().any(|change| change.is_certain()),
                format!("it is proved that {quantity} is not constant"),
                format!("along {} motions it changes by {:.0e} of its terms", changes.len(), largest(changes)),
            ),
            Beside::AtMost(kind, bound, found) => (
                found.len() > bound,
                format!("at most {bound} {kind}"),
                format!("{} were found: {}", found.len(), found.join(", ")),
            ),
            Beside::Brackets(verdict, found) => {
                let count = match verdict {
                    Integrability::Nonintegrable { .. } => Some(0),
                    Integrability::PartlyIntegrable { integrals, .. } => Some(*integrals),
                    Integrability::Integrable { .. } => Some(scene.system.constraints.len()),
                    _ => None,
                };
                (
                    count.is_some_and(|count| count != found),
                    format!("the constraint is {verdict}"),
                    format!("ranks of brackets leave {found} integrable combinations"),
                )
            }
            Beside::Contained(family, above) => (
                true,
                format!("every motion of {} is one of {family}, which is proved", CHETAEV.title),
                format!("its least χ² that was found is {above:.1} above"),
            ),
            Beside::Methods(fault) => (true, fault.into(), "another method does not agree".into()),
        };
        is_wrong.then(|| contradiction(one, other))
    }
}

fn contradiction(one: impl Into<String>, other: impl Into<String>) -> Contradiction {
    Contradiction { one: one.into(), other: other.into() }
}

impl Membership {
    /// The decision in floating point and the proof, where they exclude each other.
    pub fn contradiction(&self) -> Option<Contradiction> {
        let number = |x: f64| format!("{x:.1e}");
        let (least, noise) = (number(self.decision.least), number(self.decision.noise));
        match (&self.proof.this_start, self.decision.verdict) {
            (Finding::None(none), _) if self.section.is_some() => Some(contradiction(
                format!("it is proved that no constants give the motion (order {})", none.order),
                "a formula gives such constants for all starts",
            )),
            (Finding::None(none), Floating::Contained) => {
                let implied = self.implied.filter(|implied| self.decision.shows(*implied))?;
                Some(contradiction(
                    format!(
                        "it is proved that no constants give the motion (order {}), with a mismatch of at least {}",
                        none.order,
                        number(implied)
                    ),
                    format!("the least mismatch found is {least} with noise {noise}"),
                ))
            }
            // a motion may leave the branch of its start
            (_, Floating::NotContained) if self.proof.domain.branch => None,
            (Finding::Contained { .. }, Floating::NotContained) => Some(contradiction(
                "ranks show that some constants give the motion",
                format!("the least mismatch found is {least} with noise {noise}"),
            )),
            (_, Floating::NotContained) if self.section.is_some() => Some(contradiction(
                "a formula gives such constants for all starts",
                format!("the least mismatch found is {least} with noise {noise}"),
            )),
            _ => None,
        }
    }
}

impl Comparison {
    /// Results of this comparison that exclude each other; none, unless the program is wrong.
    pub fn contradictions(&self) -> Vec<Contradiction> {
        let mut found: Vec<Contradiction> = self.decided.iter().flat_map(|decided| self.of_decided(decided)).collect();
        found.extend(self.pairs.iter().flat_map(|pair| self.of_pair(pair)));
        found.extend(self.of_forms());
        for fit in self.fits.iter().filter(|fit| fit.by_identity && !self.is_chetaev(fit.target)) {
            if fit.fitted.as_ref().is_some_and(|fitted| fitted.gap.verdict == Verdict::Different) {
                found.push(contradiction(
                    format!("{} and {} are one family", self.name(fit.run), self.name(fit.target)),
                    "their motions differ with the constants that should make them one",
                ));
            }
        }
        found
    }

    /// An error where results exclude each other.
    ///
    /// # Errors
    /// [`Contradicted`], with the name of the scene and [`Comparison::contradictions`].
    pub fn is_sound(&self) -> Result<(), Contradicted> {
        contradicted(&self.scene, &self.contradictions())
    }

    /// Two forms of the vakonomic equations, one of which keeps clearly what the other changes.
    fn of_forms(&self) -> Option<Contradiction> {
        let of = |own| self.runs[self.run(own)?].outcome.as_ref().ok().filter(|motion| motion.doubt.is_none());
        let motions = [of(VAKONOMIC)?, of(VAKONOMIC_COSTATE)?];
        let one_sided = |[one, other]: [&Motion; 2]| {
            let kept = |breach: &&Breach| breach.is_clear() && other.keeps(breach);
            one.breaches.iter().find(kept).map(|breach| format!("{breach}"))
        };
        let found = one_sided(motions).or_else(|| one_sided([motions[1], motions[0]]))?;
        Some(contradiction(
            format!("of two forms of the vakonomic equations one says that {found}"),
            "the other keeps it",
        ))
    }

    fn of_decided(&self, decided: &Decided) -> Option<Contradiction> {
        let membership = decided.outcome.as_ref().ok()?;
        let [family, curve] = [decided.family, decided.curve].map(|i| self.name(i));
        if let Some(Contradiction { one, other }) = membership.contradiction() {
            return Some(contradiction(format!("{family} beside {curve}: {one}"), other));
        }
        let answer = membership.answer();
        let none = matches!(answer, Answer::NoneProved { .. } | Answer::None { .. });
        // an identity in all multipliers is involutive constraints (theorem 3)
        let all = membership.section.as_ref().is_some_and(|section| section.every && section.proved);
        let several =
            matches!(self.integrability, Integrability::Nonintegrable { .. } | Integrability::PartlyIntegrable { .. });
        if all && several && self.is_chetaev(decided.curve) && self.runs[decided.family].choice.formulation == VAKONOMIC
        {
            let one = format!("the constraint is {}", self.integrability);
            return Some(contradiction(one, format!("every μ₀ gives {family} the motion of {curve} from all starts")));
        }
        // gaps show what is no small part of a motion's accelerations, but for impulses that cancel
        let family_run = self.runs[decided.family].outcome.as_ref();
        let clear = membership.decision.least > TRUSTED * membership.decision.acceleration
            && family_run.is_ok_and(|motion| motion.equations.steep().is_empty());
        let same = |fit: &&Fit| {
            (fit.run, fit.target) == (decided.family, decided.curve)
                && fit.fitted.as_ref().is_some_and(|fitted| fitted.gap.verdict == Verdict::Same)
        };
        if none && clear && self.fits.iter().any(|fit| same(&fit)) {
            let one = format!("no constants give {family} the motion of {curve}");
            return Some(contradiction(one, "a search found constants that do"));
        }
        let some = matches!(answer, Answer::SomeProved | Answer::Some { .. });
        let fault = decided.witness.as_ref().filter(|_| some).and_then(|witness| match witness {
            Err(refused) => Some(format!("with those found there is no motion: {refused}")),
            Ok(fitted) => {
                let apart = fitted.gap.verdict == Verdict::Different;
                apart.then(|| format!("those found leave a gap of {:.1e}", fitted.gap.largest))
            }
        });
        if let Some(fault) = fault {
            return Some(contradiction(format!("some constants give {family} the motion of {curve}"), fault));
        }
        if none && self.agree_if_integrable(decided.family, decided.curve) {
            let one = format!("the constraint is {}", self.integrability);
            return Some(contradiction(one, format!("no constants of {family} give the motion of {curve}")));
        }
        let gap = &self.pair(decided.family, decided.curve)?.gap;
        let every = membership.dimension() == membership.decision.constants.len();
        match (answer, &gap.verdict) {
            (Answer::SomeProved, Verdict::Different) if every => Some(contradiction(
                format!("every choice of constants gives {family} the motion of {curve}"),
                "the two motions differ",
            )),
            _ => None,
        }
    }

    fn of_pair(&self, pair: &Pair) -> Option<Contradiction> {
        let [first, second] = [pair.first, pair.second].map(|i| self.name(i));
        if pair.gap.verdict == Verdict::Different && self.agree_if_integrable(pair.first, pair.second) {
            let one = format!("the constraint is {}", self.integrability);
            return Some(contradiction(one, format!("the motions of {first} and {second} differ")));
        }
        let predicted = pair.predicted.as_ref().filter(|predicted| predicted.proved)?;
        let start = self.runs[pair.first].outcome.as_ref().ok()?.start();
        if pair.gap.certain_from.is_none() && stands_out(predicted, pair, start) {
            return Some(contradiction(
                format!("{first} and {second} agree within their errors"),
                format!("it is proved that they part as {:.1e} t^{}", predicted.length, predicted.exponent),
            ));
        }
        let measured = pair.growth.as_ref().filter(|growth| is_another(growth, predicted))?;
        Some(contradiction(
            format!("it is proved that {first} and {second} part as t^{}", predicted.exponent),
            format!("they were measured to part as t^{:.2}", measured.exponent),
        ))
    }

    /// Whether T1 says that two runs agree: Chetaev's, vakonomic motions and removals by coordinates do for
    /// an integrable constraint; not where it creeps, nor where reactions are prescribed.
    fn agree_if_integrable(&self, first: usize, second: usize) -> bool {
        let is_bound = |run: &Run| {
            let by_coordinates = |u: &mechanics::DisplacementParameter| u.coordinate.is_some();
            is_in_table(run.choice.formulation)
                && run.choice.formulation != PRESCRIBED
                && run.outcome.as_ref().is_ok_and(|motion| !motion.equations.creeps)
                && run.choice.removal.as_ref().is_none_or(|removal| removal.parameters.iter().all(by_coordinates))
        };
        self.integrability.is_integrable() && [first, second].into_iter().all(|i| is_bound(&self.runs[i]))
    }

    fn is_chetaev(&self, run: usize) -> bool {
        self.runs[run].choice.formulation == CHETAEV
    }

    fn name(&self, run: usize) -> &str {
        &self.runs[run].choice.label
    }
}

/// Whether a leading term would have been seen while it leads; one beyond all numbers tells nothing of gaps.
fn stands_out(predicted: &LeadingTerm, pair: &Pair, start: f64) -> bool {
    predicted.length.is_finite()
        && pair.gap.points.iter().any(|point| {
            let past = point.t - start;
            let leads = predicted.leads(past, past);
            leads && predicted.length * past.powi(predicted.exponent as i32) > 2.0 * point.limit
        })
}

fn is_another(growth: &Growth, predicted: &LeadingTerm) -> bool {
    // exponents are whole numbers
    let exponent = f64::from(predicted.exponent);
    growth.exponent.round() != exponent
        && ask(growth.exponent - exponent, Some(growth.uncertainty)) == Asked::Apart
        && growth.is_of(predicted)
}
