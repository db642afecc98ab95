//! Results that exclude each other, forged one at a time: each is noticed, and there is no verdict.

use comparison::words::Headline;
use comparison::{Beside, Comparison, Verdict, compare, hold};
use decision::{Finding, NoConstants};
use equations::Formulation;
use mechanics::Integrability;
use motion::band::Known;
use motion::{CHETAEV, REMOVED_CONSTRAINT, Settings, VAKONOMIC, choices};
use scene::Scene;

use crate::compared::compared;

/// Nonintegrable; no multipliers give Chetaev's motion.
fn sledge() -> Comparison {
    compared("sledge", include_str!("../../scene/sledge.toml"))
}

/// Integrable: all multipliers do.
fn bowl() -> Comparison {
    compared("bowl", include_str!("../../scene/scenes/bowl.toml"))
}

/// Some multipliers do, by an identity.
fn disc() -> Comparison {
    compared("disc", include_str!("../../scene/scenes/disc.toml"))
}

fn no_constants() -> Finding {
    Finding::None(NoConstants { order: 1, full_rank: true, size: 2 })
}

/// The one thing that is found, the page's first words and the command's error.
fn found(comparison: &Comparison) -> String {
    let [found] = &comparison.contradictions()[..] else { panic!("{:?}", comparison.contradictions()) };
    let headline = Headline::of(comparison);
    assert!(headline.verdict.starts_with("No verdict: results contradict each other."), "{}", headline.verdict);
    assert!(headline.why.contains(&found.to_string()) && headline.sure.is_empty(), "{}", headline.why);
    assert!(comparison.is_sound().unwrap_err().to_string().contains(&found.to_string()));
    found.to_string()
}

/// What was decided about Chetaev's motion and the vakonomic family.
fn decided(comparison: &mut Comparison) -> &mut comparison::Membership {
    let asked = (comparison.run(VAKONOMIC), comparison.run(CHETAEV));
    let is = |d: &&mut comparison::Decided| (Some(d.family), Some(d.curve)) == asked;
    comparison.decided.iter_mut().find(is).and_then(|d| d.outcome.as_mut().ok()).expect("a decision")
}

fn pair<'a>(comparison: &'a mut Comparison, other: &Formulation) -> &'a mut comparison::Pair {
    let wanted = (comparison.run(CHETAEV).unwrap(), comparison.run(other).unwrap());
    comparison.pairs.iter_mut().find(|p| (p.first, p.second) == wanted).expect("a pair")
}

#[test]
fn scenes_as_they_are_contradict_nothing() {
    for comparison in [sledge(), bowl(), disc()] {
        assert_eq!(comparison.contradictions(), Vec::new());
        assert!(comparison.is_sound().is_ok());
    }
}

#[test]
fn a_proof_that_some_do_beside_a_mismatch() {
    let mut sledge = sledge();
    decided(&mut sledge).proof.this_start = Finding::Contained { rank: 1, order: 3 };
    assert!(found(&sledge).contains("ranks show that some constants give the motion, but the least mismatch"));
}

/// Multipliers of the costate form grow as 1e13: what the elimination adds up is more than the equations do.
#[test]
fn costates_that_grow_contradict_nothing() {
    let scene = "title = 'exponential'\n[coordinates]\nx = { start = 0.3 }\ny = { start = 0.7 }\n[system]\n\
                 lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"x' - x*y'\"]\n\
                 forces = { x = \"-atan2(atan2(y, y'), y' + t)\", y = \"y' - 9\" }\n\
                 [start]\nproject = true\nvelocities = { \"y'\" = 0.3 }\n[run]\nduration = 2\n";
    assert_eq!(compared("exponential", scene).contradictions(), Vec::new());
}

/// The decision holds up to a part of the acceleration, and what is left is a smaller one.
#[test]
fn a_gap_below_what_was_decided_contradicts_nothing() {
    let scene = "title = 'nearly'\n[coordinates]\nx = { start = 1.1 }\ny = { start = 1.1 }\nz = { start = 0.4 }\n\
                 phi = { start = 0.3 }\n[system]\nlagrangian = \"(x'^2 + y'^2 + z'^2 + phi'^2)/2 + (y - x)*x'*z'\"\n\
                 constraints = [\"x' - sqrt(1 + y'^2*exp(-9)^2)\", \"y - 1.1 + (z - 0.4)*pi*phi\", \
                 \"z' + 2/5.125*phi' - step(t, 0.1, 0.4, 1e-3)\"]\n\
                 [start]\nproject = true\nvelocities = { \"phi'\" = 0.3 }\n[run]\nduration = 1\n";
    let scene = crate::support::read("nearly", scene);
    let choices = choices(&scene);
    let comparison = compare(scene, choices, Vec::new(), &Settings::default()).expect("a comparison");
    assert_eq!(comparison.contradictions(), Vec::new());
}

#[test]
fn a_motion_that_leaves_the_branch_of_its_start() {
    let scene = "title = 'branch'\n[coordinates]\nx = { start = 1 }\ny = { start = 0.3 }\nz = { start = 0 }\n[system]\n\
                 lagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"z' - (x - sqrt(x^2))*y'\"]\n\
                 [start]\nvelocities = { \"x'\" = -1, \"y'\" = 0.7 }\n[run]\nduration = 3\n";
    let mut branch = compared("branch", scene);
    assert_eq!(branch.contradictions(), Vec::new());
    let answer = decided(&mut branch).answer();
    assert!(matches!(&answer, comparison::Answer::None { unproved } if unproved.contains("branch")), "{answer:?}");
}

#[test]
fn a_proof_that_none_do_beside_a_formula_and_beside_no_mismatch() {
    let mut disc = disc();
    decided(&mut disc).proof.this_start = no_constants();
    assert!(found(&disc).contains("but a formula gives such constants for all starts"));
    let membership = decided(&mut disc);
    (membership.section, membership.implied) = (None, Some(1e-3));
    assert!(found(&disc).contains("with a mismatch of at least 1.0e-3, but the least mismatch found is"));
    // a mismatch that noise hides is no contradiction
    let membership = decided(&mut disc);
    membership.implied = Some(membership.decision.noise);
    assert_eq!(disc.contradictions(), Vec::new());
}

#[test]
fn a_formula_for_all_starts_beside_a_mismatch() {
    let (mut sledge, mut disc) = (sledge(), disc());
    decided(&mut sledge).section = decided(&mut disc).section.clone();
    decided(&mut sledge).proof.this_start = Finding::ThroughOrder { rank: 1, order: 3 };
    assert!(found(&sledge).contains("a formula gives such constants for all starts, but the least mismatch"));
}

#[test]
fn an_integrable_constraint_beside_motions_that_differ_or_no_multipliers() {
    let mut sledge = sledge();
    sledge.integrability = Integrability::Integrable { exact: true };
    let all = sledge.contradictions();
    assert!(all.iter().any(|c| c.other == "the motions of Chetaev and vakonomic differ"), "{all:?}");
    assert!(all.iter().any(|c| c.other == "no constants of vakonomic give the motion of Chetaev"), "{all:?}");
    let mut bowl = bowl();
    pair(&mut bowl, REMOVED_CONSTRAINT).gap.verdict = Verdict::Different;
    assert!(found(&bowl).starts_with("the constraint is holonomic"));
}

#[test]
fn every_multiplier_beside_motions_that_differ() {
    let mut bowl = bowl();
    bowl.integrability = Integrability::NonlinearInVelocity;
    pair(&mut bowl, VAKONOMIC).gap.verdict = Verdict::Different;
    assert!(found(&bowl).ends_with("but the two motions differ"));
}

#[test]
fn a_proved_difference_beside_motions_that_agree_and_beside_another_growth() {
    let mut sledge = sledge();
    let gap = &mut pair(&mut sledge, VAKONOMIC).gap;
    let certain_from = gap.certain_from.take();
    assert!(found(&sledge).contains("agree within their errors, but it is proved that they part as"));
    let predicted = pair(&mut sledge, VAKONOMIC).predicted.as_mut().expect("a term");
    let length = std::mem::replace(&mut predicted.length, f64::INFINITY);
    assert_eq!(sledge.contradictions(), Vec::new());
    pair(&mut sledge, VAKONOMIC).predicted.as_mut().expect("a term").length = length;
    let pair = pair(&mut sledge, VAKONOMIC);
    pair.gap.certain_from = certain_from;
    pair.growth.as_mut().expect("a growth").exponent += 1.0;
    assert!(found(&sledge).contains("part as t^3, but they were measured to part as t^4.0"));
    // nothing is where another term is the larger one
    let pair = self::pair(&mut sledge, VAKONOMIC);
    let (growth, predicted) = (pair.growth.as_mut().expect("a growth"), pair.predicted.as_ref().expect("a term"));
    growth.to = 0.5 * predicted.reach;
    assert_eq!(sledge.contradictions(), Vec::new());
}

#[test]
fn one_family_whose_motions_differ() {
    let scene = Scene::parse("heisenberg", include_str!("../../scene/scenes/heisenberg.toml")).expect("a scene");
    let choices = choices(&scene);
    let mut heisenberg = compare(scene, choices, Vec::new(), &Settings::default()).expect("a comparison");
    assert_eq!(heisenberg.contradictions(), Vec::new());
    let chetaev = heisenberg.run(CHETAEV);
    let fit = heisenberg.fits.iter_mut().find(|fit| fit.by_identity && Some(fit.target) != chetaev).expect("a fit");
    fit.fitted.as_mut().expect("a motion").gap.verdict = Verdict::Different;
    assert!(found(&heisenberg).contains("are one family, but their motions differ"));
}

#[test]
fn every_multiplier_at_all_starts_beside_a_constraint_that_is_not_integrable() {
    let mut bowl = bowl();
    let section = disc_section();
    decided(&mut bowl).section = Some(decision::Section { every: true, proved: true, ..section });
    bowl.integrability = Integrability::Nonintegrable { depth: 1, growth: None };
    assert!(found(&bowl).ends_with("but every μ₀ gives vakonomic the motion of Chetaev from all starts"));
}

fn disc_section() -> decision::Section {
    decided(&mut disc()).section.clone().expect("an identity")
}

#[test]
fn constants_that_are_decided_beside_their_motion() {
    let mut disc = disc();
    disc.fit(comparison::Fits::None, &Settings::default()).expect("no fit");
    let asked = (disc.run(VAKONOMIC), disc.run(CHETAEV));
    let is = |d: &comparison::Decided| (Some(d.family), Some(d.curve)) == asked;
    let place = disc.decided.iter().position(is).expect("a decision");
    let fitted = disc.decided[place].witness.as_ref().expect("a motion").as_ref().expect("a motion");
    assert!(fitted.gap.largest < 1e-9, "{:?}", fitted.constants);
    assert_eq!(disc.contradictions(), Vec::new());
    let witness = |disc: &mut Comparison, verdict: Verdict| {
        let fitted = disc.decided[place].witness.as_mut().expect("a motion").as_mut().expect("a motion");
        fitted.gap.verdict = verdict;
    };
    witness(&mut disc, Verdict::Undecided { because: "the digits of the constants leave it open".into() });
    assert_eq!(disc.contradictions(), Vec::new());
    witness(&mut disc, Verdict::Different);
    assert!(found(&disc).contains("some constants give vakonomic the motion of Chetaev, but those found leave a gap"));
    disc.decided[place].witness = Some(Err("singular".into()));
    assert!(found(&disc).ends_with("but with those found there is no motion: singular"));
}

#[test]
fn none_beside_constants_that_a_search_found() {
    let mut sledge = sledge();
    sledge.fit(comparison::Fits::All, &Settings::default()).expect("fits");
    assert_eq!(sledge.contradictions(), Vec::new());
    let asked = (sledge.run(VAKONOMIC), sledge.run(CHETAEV));
    let fit = sledge.fits.iter_mut().find(|fit| (Some(fit.run), Some(fit.target)) == asked).expect("a fit");
    fit.fitted.as_mut().expect("a motion").gap.verdict = Verdict::Same;
    assert!(found(&sledge).ends_with("but a search found constants that do"));
}

#[test]
fn sentences_of_other_commands() {
    let [sledge, bowl] = [sledge().scene, bowl().scene];
    let [still, moved] = [1e-14, 0.3].map(|value| Known { value, error: 1e-11, size: value, reach: 1.0 });
    let nonintegrable = Integrability::Nonintegrable { depth: 1, growth: None };
    let partly = Integrability::PartlyIntegrable { integrals: 1, constraints: 2, exact: true };
    let sound = [
        Beside::Constant("E", still),
        Beside::NotConstant("E", &[still, moved]),
        Beside::NotConstant("E", &[]),
        Beside::AtMost("linear integrals", 1, &["E"]),
        Beside::Brackets(&nonintegrable, 0),
        Beside::Brackets(&Integrability::NonlinearInVelocity, 3),
    ];
    assert!(hold(&sledge, sound).is_ok());
    let planted = [
        (Beside::Constant("E", moved), "sledge: E = const, but it changes by 3e-1 of its terms along the motion"),
        (Beside::NotConstant("E", &[still, still]), "E is not constant, but along 2 motions it changes by 1e-14"),
        (Beside::AtMost("linear integrals", 0, &["x'", "y'"]), "at most 0 linear integrals, but 2 were found: x', y'"),
        (Beside::Brackets(&nonintegrable, 1), "but ranks of brackets leave 1 integrable combinations"),
        (Beside::Brackets(&partly, 0), "but ranks of brackets leave 0 integrable combinations"),
        (
            Beside::Contained("vakonomic", 12.0),
            "every motion of Chetaev is one of vakonomic, which is proved, but its least",
        ),
        (Beside::Methods("a product is none"), "a product is none, but another method does not agree"),
    ];
    for (beside, words) in planted {
        let told = hold(&sledge, [beside]).unwrap_err().to_string();
        assert!(told.contains(words), "{told}");
    }
    assert!(hold(&bowl, [Beside::Brackets(&Integrability::Integrable { exact: true }, 0)]).is_err());
}

/// A rigid body that turns about its third axis at the rate 1, and rests otherwise: `P_φ` acts on `ψ', θ'`
/// alone, on nothing at the start. The vakonomic motion has `P_φ = −(∂L/∂φ' + μ)`, any `P_ψ`.
#[test]
fn a_costate_without_effect_at_the_start_is_decided_later() {
    let text = r#"
title = "Turning"
[coordinates]
psi = { start = -1 }
theta = { start = 0.3 }
phi = { start = 0.5 }
[definitions]
R = "rotation(zxz, psi, theta, phi)"
W = "body_angular_velocity(R)"
[system]
lagrangian = "dot(W, diag(1, 2, 3)*W)/2 - R.zz"
constraints = ["W.z - 1"]
[start.velocities]
"psi'" = 0
"theta'" = 0
[run]
duration = 2
"#;
    let scene = Scene::parse("turning", text).unwrap_or_else(|e| panic!("{e}"));
    let choices = motion::choices(&scene);
    let of = |name: &str| choices.iter().find(|choice| choice.label.contains(name)).expect("a formulation");
    let pairing = comparison::Pairing::new(&scene, of("vakonomic"), of("quasi-velocities")).expect("a pair");
    let found = pairing.decide(2.0).expect("a decision");
    let decision = &found.decision;
    assert_eq!(found.contradiction(), None);
    assert_eq!((decision.until, decision.set.dimension()), (None, 1), "{decision:?}");
    assert!(decision.set.distance(&[0.7, -3.0]) < 1e-8 && decision.set.distance(&[0.7, 0.0]) > 1.0, "{decision:?}");
}
