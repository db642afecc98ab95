//! Sentences are about the scene that was given: its numbers as they are read, its clock, its motion.

use comparison::words::{Headline, answer};
use comparison::{Comparison, Verdict};
use motion::{CHETAEV, VAKONOMIC};

use crate::compared::compared;

fn between<'a>(of: &'a Comparison, verdict: &str) -> &'a comparison::Gap {
    let [chetaev, vakonomic] = [CHETAEV, VAKONOMIC].map(|own| of.run(own).expect("a run"));
    let gap = &of.pair(chetaev, vakonomic).expect("a pair").gap;
    assert_eq!(gap.verdict.word(), verdict);
    gap
}

fn particle(constraint: &str, time: &str) -> Comparison {
    let scene = format!(
        "title = 'particle'\n[coordinates]\nx = {{ start = 0.3 }}\ny = {{ start = 0.2 }}\nz = {{ start = 0 }}\n[system]\n\
         lagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"{constraint}\"]\n[start]\n{time}\n\
         [start.velocities]\n\"x'\" = 1\n\"y'\" = 0.3\n[run]\nduration = 1\n"
    );
    compared("particle", &scene)
}

/// The disc turns at a constant rate by Chetaev; that the vakonomic one does not is said of it, and its
/// motion is as good as before.
#[test]
fn an_integral_of_one_formulation_is_a_finding_about_another() {
    let disc = |more: &str| {
        let text = include_str!("../../scene/scenes/disc.toml");
        compared("disc", &format!("{text}{more}"))
    };
    let (plain, told) = (disc(""), disc("\n[invariants]\nturning = \"phi'\"\n"));
    let [one, two] = [&plain, &told].map(|own| between(own, "different").largest);
    assert!(one > 1.0 && (one - two).abs() < 1e-9 * one, "{one} {two}");
    let why = Headline::of(&told).why;
    assert!(why.contains("turning is not constant for ") && why.contains("; constant for Chetaev"), "{why}");
    assert_eq!(told.contradictions(), Vec::new());
}

/// Numbers of a coefficient that almost cancel: 1/3 − 0.3333333333333333 is 3e-17 and not zero, and so is
/// proved to be, where motions are the same in all digits.
#[test]
fn a_coefficient_is_what_is_written() {
    let small = particle("z' - (1/3 - 0.3333333333333333)*x*y'", "");
    let first = answer(&small).expect("an answer");
    assert!(first.starts_with("Different: Chetaev and vakonomic, for every μ₀ (proved)."), "{first}");
    assert!(between(&small, "different").certain_from.is_none());
    let zero = answer(&particle("z' - (2*cos(pi/3) - 1)*x*y'", "")).expect("an answer");
    assert!(zero.starts_with("Same: Chetaev and vakonomic, for every μ₀ (proved)"), "{zero}");
}

/// What is seen after so many seconds is seen after as many, whenever it starts.
#[test]
fn a_time_on_the_clock_is_no_duration() {
    let [now, later] = ["", "time = 100"].map(|time| Headline::of(&particle("z' - x*y'", time)).verdict);
    assert!(now.contains("differ by 1e-3 after 0.293 s"), "{now}");
    assert_eq!(now, later);
}

/// A chaotic double pendulum: without constraints there is one equation of motion, and the numbers are lost.
#[test]
fn an_estimate_that_has_grown_is_not_rest() {
    let scene = "title = 'double pendulum'\n[coordinates]\na = { start = 2 }\nb = { start = 2.5 }\n[system]\n\
                 lagrangian = \"a'^2 + b'^2/2 + a'*b'*cos(a - b) + 9.81*(2*cos(a) + cos(b))\"\n[start.velocities]\n\
                 \"a'\" = 0\n\"b'\" = 0\n[run]\nduration = 40\n";
    let pendulum = compared("double pendulum", scene);
    let Verdict::Undecided { because } = &between(&pendulum, "undecided").verdict else { panic!("{pendulum:?}") };
    assert!(because.contains("has grown to the size of the motion"), "{because}");
    let first = answer(&pendulum).expect("an answer");
    assert_eq!(first, format!("Same: Chetaev and vakonomic. Not seen in numbers: {because}."));
}

/// A pulse of e^{-30·25/9} at w = 1/3 turns y' into a force on w for every μ₀ but 0, under all digits:
/// ranks see it.
#[test]
fn a_multiplier_that_round_off_frees_is_not_free() {
    let of = |factor: &str| {
        let scene = format!(
            "title = 'pulse'\n[coordinates]\ny = {{ start = 0 }}\nw = {{ start = \"1/3\" }}\ns = {{ start = 0 }}\n[system]\n\
             lagrangian = \"(y'^2 + w'^2 + s'^2)/2\"\nconstraints = [\"{factor}*(s' - exp(-30*(w - 2)^2)*y')\"]\n\
             [start.velocities]\n\"y'\" = 1\n\"w'\" = 0\n[run]\nduration = 1\n"
        );
        let pulse = compared("pulse", &scene);
        let found = pulse.membership().expect("asked").as_ref().expect("a decision");
        (found.dimension(), answer(&pulse).expect("an answer"))
    };
    for factor in ["1", "(2 + sin(y))"] {
        let (dimension, first) = of(factor);
        assert!(dimension == 0 && !first.contains("every μ₀"), "{factor}: {dimension}, {first}");
    }
}
