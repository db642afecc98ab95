//! T9: whether a motion is vakonomic for some multipliers: decided, proved, and fitted.

use comparison::{Answer, Gap, Membership, Pairing, best_fit};
use decision::{Finding, Verdict};
use motion::{Settings, TRUSTED, VAKONOMIC, choices, setting};

use super::CheckError;
use crate::case::Which;
use crate::derived::equations;
use crate::{Case, Findings, Kind};

/// Decides whether the Chetaev motion is vakonomic; finds a vakonomic motion's multipliers from itself.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let Some(found) = case.membership()? else { return Ok(()) };
    planted(case)?;
    let (decision, h) = (&found.decision, case.scene.system.constraints.len());
    let note = format!(
        "{:?}, rho {:.1e}, noise {:.1e}; {}",
        decision.verdict,
        decision.least,
        decision.noise,
        words(&found.proof.this_start)
    );
    let contradiction = found.contradiction();
    let told = contradiction.as_ref().map_or(note.clone(), ToString::to_string);
    case.found.require(9, "decision and proof agree", contradiction.is_none(), told);
    // theorem 7(a): a rank that stays once stays, and it has h + 1 columns to grow in
    let orders = |finding: &Finding| match finding {
        Finding::None(none) => Some(none.order),
        Finding::Contained { order, .. } => Some(order - 1),
        _ => None,
    };
    if let Some(order) = orders(&found.proof.almost_every_start) {
        case.found.require(
            9,
            "almost every start: ranks are final at order h",
            order <= h,
            format!("order {order} of {h}"),
        );
    }
    if decision.verdict != Verdict::NotContained && matches!(found.proof.this_start, Finding::None(_)) {
        // a proved mismatch need not stand out from the noise
        return Ok(());
    }
    let dimension = decision.set.dimension();
    if let (Verdict::Contained, Finding::Contained { rank, .. }) = (decision.verdict, &found.proof.this_start)
        && case.recipe.kind != Kind::NearRankLoss
    {
        // nearly dependent constraints fix some constants by less than round-off
        case.found.require(9, "the set has the dimension that ranks ask for", dimension + rank == h, &note);
    }
    if case.recipe.kind.is_integrable() {
        let every = decision.verdict == Verdict::Contained && dimension == h;
        case.found.require(9, "integrable constraints leave every mu0", every, &note);
        let by_ranks = matches!(found.answer(), Answer::SomeProved | Answer::Some { settled: true, .. });
        match found.proof.almost_every_start {
            // roots have images at few starts: no ranks
            Finding::NotApplicable(_) => {
                case.found.count(
                    9,
                    "every mu0 does, random starts have no image, and it is proved symbolically",
                    by_ranks,
                );
            }
            _ => case.found.require(9, "and ranks say so", by_ranks, &note),
        }
    } else if case.recipe.integrals() > 0 {
        case.found.require(9, "integrals leave a mu0 each", dimension >= case.recipe.integrals(), &note);
    }
    match decision.verdict {
        Verdict::Contained => {
            let equations = equations(&case.scene.system, VAKONOMIC, None)?;
            let mut motion = case.run(equations, &decision.set.point)?;
            case.same(9, "the multipliers found give Chetaev's motion", Which::Chetaev, &mut motion);
        }
        Verdict::Undecided => case.found.undecided(9, "Chetaev's motion is vakonomic or it is not", note),
        Verdict::NotContained => match found.answer() {
            Answer::None { unproved } if matches!(found.proof.this_start, Finding::NotApplicable(_)) => {
                case.found.count(9, "no mu0, and the start has no image in the field", unproved.contains("root"));
            }
            answer => {
                let proved = matches!(answer, Answer::NoneProved { .. });
                let by_ranks = matches!(&found.proof.this_start, Finding::None(none) if !none.full_rank);
                case.found.count(
                    9,
                    "no mu0, and that is proved, or shown by ranks modulo two primes",
                    proved || by_ranks,
                );
                case.found.count(9, "no mu0, and that is proved", proved);
            }
        },
    }
    if !case.recipe.kind.is_integrable() {
        case.found.count(9, "vakonomic differs from Chetaev, for every mu0", decision.verdict == Verdict::NotContained);
    }
    Ok(())
}

/// The vakonomic motion of the scene is vakonomic, with the multipliers of the scene.
fn planted(case: &mut Case) -> Result<(), CheckError> {
    let (choices, multipliers) = (choices(&case.scene), &case.scene.multipliers);
    let [Some(family), Some(curve)] =
        [VAKONOMIC, case.planted].map(|own| choices.iter().find(|choice| choice.formulation == own))
    else {
        return Ok(());
    };
    let Membership { decision, proof, .. } = Pairing::new(&case.scene, curve, family)?.decide(case.end())?;
    let proof = proof.this_start;
    let left = decision.mismatch_at(multipliers);
    let note =
        format!("rho {:.1e}, {left:.1e} at mu0, noise {:.1e}; {}", decision.least, decision.noise, words(&proof));
    let claim = "a planted vakonomic motion is found";
    match decision.verdict {
        Verdict::Undecided => case.found.undecided(9, claim, note),
        verdict => {
            let missed = verdict == Verdict::NotContained || !decision.admits(multipliers);
            case.found.require(9, claim, !missed, &note);
            case.found.require(9, "nor is it refuted", !matches!(proof, Finding::None(_)), note);
        }
    }
    Ok(())
}

fn words(finding: &Finding) -> String {
    match finding {
        Finding::None(none) => format!("none: proved at order {}", none.order),
        other => format!("{other:?}"),
    }
}

/// A fit finds nothing where nothing is.
pub(super) fn fit(case: &mut Case) -> Result<(), CheckError> {
    if case.recipe.kind.is_integrable() || case.recipe.kind == Kind::NearRankLoss {
        return Ok(());
    }
    let Some(found) = case.membership()? else { return Ok(()) };
    let settings = Settings { max_steps: 3_000, ..Settings::default() };
    let equations = equations(&case.scene.system, VAKONOMIC, None)?;
    let (mut chetaev, mut metric) = (case.chetaev.clone(), case.metric.clone());
    let guesses = [found.decision.set.point.clone()];
    let fitted = best_fit(setting(&case.scene), &equations, &mut chetaev, &guesses, &mut metric, &settings)?;
    let Some(mut fitted) = fitted else { return Ok(()) };
    let before = case.gap(Which::Chetaev, Which::Vakonomic)?;
    let after = comparison::compare_motions(&mut chetaev, &mut fitted, &mut metric)?;
    if found.decision.verdict == Verdict::NotContained {
        let note = format!("gap {:.1e}, rho {:.1e}", after.largest, found.decision.least);
        let visible = visible(found.decision.least, case.scene.duration);
        denied(&mut case.found, &after, visible, note);
        if before.largest > 0.0 {
            case.found.observe(9, "gap after the best fit over gap before", after.largest / before.largest);
        }
    }
    Ok(())
}

/// The gap, over this duration, from which on the mismatch `least` has to be seen.
pub fn visible(least: f64, duration: f64) -> f64 {
    TRUSTED * least * duration.powf(1.5)
}

/// A fit has to leave a gap, where one that is `visible` would be seen.
pub fn denied(found: &mut Findings, after: &Gap, visible: f64, note: String) {
    let (claim, apart) = ("a fit does not find what the decision denies", after.certain_from.is_some());
    if apart || after.points.iter().all(|p| p.limit < visible) {
        found.require(9, claim, apart, note);
    } else {
        found.undecided(9, claim, "the motions are too close to tell");
    }
}
