//! Every answer about constants, reached and refused: what was found on the left, what is said on the right.

use comparison::words::{Headline, decisions, sentence};
use comparison::{Answer, Comparison, Fit, FittedMotion, Gap, Membership, Section, Sweep, compare_unfitted};
use decision::{AffineSet, Finding, NoConstants, Verdict};
use motion::{CHETAEV, Settings, VAKONOMIC, choices_among};
use scene::Scene;

use crate::compared::compared;

fn membership(comparison: &mut Comparison) -> &mut Membership {
    let asked = (comparison.run(VAKONOMIC), comparison.run(CHETAEV));
    let is = |d: &&mut comparison::Decided| (Some(d.family), Some(d.curve)) == asked;
    comparison.decided.iter_mut().find(is).and_then(|d| d.outcome.as_mut().ok()).expect("a decision")
}

/// What is known of a start in exact numbers: nothing, a no with a proof or by ranks, a yes, neither so far.
fn findings() -> [(&'static str, Finding); 5] {
    let none = |full_rank| Finding::None(NoConstants { order: 4, full_rank, size: 2 });
    [
        ("a no", none(true)),
        ("a no by ranks", none(false)),
        ("a yes", Finding::Contained { rank: 2, order: 3 }),
        ("open", Finding::ThroughOrder { rank: 1, order: 7 }),
        ("nothing", Finding::NotApplicable("a table is not a formula".into())),
    ]
}

/// Exact numbers, floating point, a section (`-`, `?` or proved `!`), whether on one branch only; the answer.
const TABLE: &str = "\
a no            Contained    -  no : none proved 4
a no            NotContained -  no : none proved 4
a no            Undecided    -  no : none proved 4
a no            Contained    !  no : contradicted
a no            NotContained ?  no : contradicted
a no by ranks   Contained    -  no : none ranks modulo two primes do (order 4)
a no by ranks   NotContained -  no : none ranks modulo two primes do (order 4)
a no by ranks   Undecided    -  no : none ranks modulo two primes do (order 4)
a no by ranks   Undecided    !  no : contradicted
a yes           Contained    -  no : some 3 settled
a yes           Contained    ?  no : some 3 settled
a yes           Contained    !  no : some proved
a yes           Undecided    -  no : some 3 settled
a yes           Undecided    !  no : some proved
a yes           NotContained -  no : contradicted
a yes           NotContained !  no : contradicted
a yes           NotContained -  yes: none on a branch that the motion leaves
a yes           NotContained !  yes: none on a branch that the motion leaves
a yes           Contained    !  yes: some proved
open            Contained    -  no : some 7
open            Contained    ?  no : some 7
open            Contained    !  no : some proved
open            Undecided    -  no : undecided
open            Undecided    !  no : undecided
open            NotContained -  no : none Taylor coefficients agree through order 7
open            NotContained ?  no : contradicted
open            NotContained ?  yes: none Taylor coefficients agree through order 7
nothing         Contained    -  no : some
nothing         Contained    ?  no : some
nothing         Contained    !  no : some proved
nothing         Undecided    -  no : undecided
nothing         NotContained -  no : none a table is not a formula
nothing         NotContained !  no : contradicted
";

/// An answer as in the table.
fn told(found: &Membership) -> String {
    match found.answer() {
        Answer::NoneProved { order } => format!("none proved {order}"),
        Answer::None { unproved } => format!("none {unproved}"),
        Answer::SomeProved => "some proved".into(),
        Answer::Some { order, settled } => {
            let order = order.map_or(String::new(), |order| format!(" {order}"));
            format!("some{order}{}", if settled { " settled" } else { "" })
        }
        Answer::Undecided if found.contradiction().is_some() => "contradicted".into(),
        Answer::Undecided => "undecided".into(),
    }
}

/// What the sentence about the answer and its row have to say, and what they must not.
fn words_of(answer: &str) -> (&'static str, &'static str, bool) {
    match answer.split_once(' ').map_or(answer, |(first, _)| first) {
        "none" => ("No μ₀ makes the vakonomic motion Chetaev's: ", "**no** μ₀", answer.starts_with("none proved")),
        "some" => ("the vakonomic motion is the Chetaev motion: ", "μ₀ = (", answer == "some proved"),
        _ => ("Whether some μ₀ gives Chetaev's motion is undecided: ", "undecided", false),
    }
}

#[test]
fn every_answer_follows_from_what_was_found() {
    let mut disc = compared("disc", include_str!("../../scene/scenes/disc.toml"));
    let mut section: Section = membership(&mut disc).section.clone().expect("an identity");
    let mut reached = std::collections::BTreeSet::new();
    for row in TABLE.lines() {
        let (given, expected) = row.split_once(':').expect("two sides");
        let [exact, floating, found, branch] =
            [&given[..16], &given[16..29], &given[29..31], &given[31..]].map(str::trim);
        let is_so = membership(&mut disc);
        is_so.proof.this_start = findings().into_iter().find(|(name, _)| *name == exact).expect("a finding").1;
        is_so.decision.verdict = match floating {
            "Contained" => Verdict::Contained,
            "NotContained" => Verdict::NotContained,
            _ => Verdict::Undecided,
        };
        section.proved = found == "!";
        is_so.section = if found == "-" { None } else { Some(section.clone()) };
        (is_so.proof.domain.branch, is_so.implied) = (branch == "yes", None);
        let (answer, expected) = (told(is_so), expected.trim());
        assert!(
            expected.strip_prefix("none ").map_or(answer == expected, |ends| answer.ends_with(ends)),
            "{row}\nis answered: {answer}"
        );
        let (begins, cell, proved) = words_of(expected);
        let said = sentence(is_so);
        assert!(said.contains(begins), "{row}\n{said}");
        // "ranks grow no more" and the like are not proofs, and say so
        assert!(
            expected == "contradicted" || said.replace("not proved", "").contains("proved") == proved,
            "{row}\n{said}"
        );
        let rows = decisions(&disc);
        let row_of = rows.iter().find(|row| row[0] == "vakonomic" && row[1] == "Chetaev").expect("a row");
        assert!(row_of[2].contains(cell) && said.contains(&row_of[3]), "{row}\n{row_of:?}\n{said}");
        reached.insert(answer.split(' ').take(2).collect::<Vec<_>>().join(" "));
    }
    for word in ["none proved", "some proved", "some 3", "some 7", "some", "undecided", "contradicted"] {
        assert!(reached.contains(word), "{word} is not reached: {reached:?}");
    }
}

#[test]
fn what_is_said_of_a_mismatch_and_of_constants_has_its_numbers() {
    let mut disc = compared("disc", include_str!("../../scene/scenes/disc.toml"));
    let found = membership(&mut disc);
    (found.section, found.proof.this_start) = (None, Finding::ThroughOrder { rank: 1, order: 7 });
    (found.decision.least, found.decision.noise, found.decision.acceleration) = (3e-9, 2e-7, 50.0);
    // 4e-9 of the motion's own acceleration: under 1e-8
    found.decision.set.point = vec![0.25, 1e-17];
    let fixed = AffineSet { directions: Vec::new(), ..found.decision.set.clone() };
    let along = AffineSet { directions: vec![vec![1.0, 0.0]], ..fixed.clone() };
    let all = AffineSet { directions: vec![vec![1.0, 0.0], vec![0.0, 1.0]], ..fixed.clone() };
    for (set, which) in [
        (fixed, "μ₀ = (0.25000, 0)"),
        (along, "every μ₀ of a set of dimension 1 through (0.25000, 0)"),
        // a rank that does not grow any more leaves no more than that
        (all, "μ₀ of a set of dimension 1 by ranks, 2 in numbers, through (0.25000, 0)"),
    ] {
        found.decision.set = set;
        let said = sentence(found);
        let expected = format!("With {which} the vakonomic motion is the Chetaev motion: through order 7 and to 1e-8.");
        assert_eq!(said, expected);
    }
    // the dimension by ranks has the word, and numbers that say otherwise are named
    found.decision.set = AffineSet { directions: vec![vec![1.0, 0.0]], ..found.decision.set.clone() };
    for (rank, which) in [
        (0, "μ₀ of a set of dimension 2 by ranks, 1 in numbers, through (0.25000, 0)"),
        (1, "every μ₀ of a set of dimension 1 through (0.25000, 0)"),
    ] {
        found.proof.this_start = Finding::Contained { rank, order: 7 };
        assert!(sentence(found).starts_with(&format!("With {which} the vakonomic")), "{}", sentence(found));
    }
    found.proof.this_start = Finding::ThroughOrder { rank: 1, order: 7 };
    // more than the motion's own, which is not at rest
    found.decision.least = 60.0;
    assert!(sentence(found).ends_with(": through order 7 and without acceleration."), "{}", sentence(found));
    found.decision.least = 3e-9;
    found.decision.until = Some(1.5);
    assert!(sentence(found).ends_with("to 1e-8 up to 1.5 s, and later undecided."));
    found.decision.verdict = Verdict::NotContained;
    found.decision.least = 20.0;
    let said = sentence(found);
    let expected = "No μ₀ makes the vakonomic motion Chetaev's: the least mismatch of accelerations is 0.4 times the motion's own \
                    up to 1.5 s, and later undecided; not proved: Taylor coefficients agree \
                    through order 7.";
    assert_eq!(said, expected);
    // the gap that a search has reached is printed with its constants
    let [run, target] = [VAKONOMIC, CHETAEV].map(|own| disc.run(own).expect("a run"));
    let gap = Gap { largest: 0.375, ..disc.pair(run, target).expect("a pair").gap.clone() };
    let constants = vec![("mu0_1".to_string(), 0.5), ("mu0_2".to_string(), -2.0)];
    let fitted = FittedMotion { constants, gap, starts: 11, by_half: 0.378 };
    assert!(fitted.is_settled());
    disc.fits.push(Fit { run, target, fitted: Some(fitted), by_identity: false });
    let sure = Headline::of(&disc).sure;
    let told = "The best found of 11 starts, μ₀ = (0.50000, -2.0000), leaves a largest gap of 0.375; half of the starts: 0.378.";
    assert!(sure.contains(told), "{sure}");
    // one that depends on the number of starts has no digits
    let fit = disc.fits.last_mut().and_then(|fit| fit.fitted.as_mut()).expect("a fit");
    fit.by_half = 0.41;
    assert!(!fit.is_settled());
    let sure = Headline::of(&disc).sure;
    let told = "leaves a largest gap of at most 0.4 (not settled); half of the starts: 0.5.";
    assert!(sure.contains(told), "{sure}");
}

#[test]
fn a_point_of_a_sweep_has_the_answer_of_its_scene() {
    let branch = "title = 'branch'\n[coordinates]\nx = { start = 1 }\ny = { start = 0.3 }\nz = { start = 0 }\n[system]\n\
                  lagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"z' - (x - sqrt(x^2))*y'\"]\n\
                  [start]\ntime = 5\nvelocities = { \"x'\" = -1, \"y'\" = 0.7 }\n[run]\nduration = 3\n";
    let sledge = include_str!("../../scene/sledge.toml");
    let (mut reached, mut late) = (std::collections::BTreeSet::new(), 0);
    for (name, text, varied) in [("branch", branch, "y"), ("sledge", sledge, "phi"), ("sledge", sledge, "phi'")] {
        let names = [varied.to_string()];
        let sweep = Sweep::new::<f64>(name, text, &[], &names, None, &Settings::default()).expect("a sweep");
        for value in [0.0, 0.4] {
            let point = sweep.point(&[value]);
            let scene = Scene::parse_with(name, text, &[(varied.into(), value)]).expect("a scene");
            let choices = choices_among(&scene, |own| [CHETAEV, VAKONOMIC].contains(&own));
            let mut one = compare_unfitted(scene, choices, Vec::new(), &Settings::default()).expect("a comparison");
            let passes = one.pairs[0].gap.passes[1];
            assert_eq!(point.apart, passes.map(|t| t - one.scene.start.t), "{name} {varied} {value}");
            late += usize::from(passes.is_some() && one.scene.start.t == 5.0);
            let found = membership(&mut one);
            let (answer, order, dimension) = match found.answer() {
                Answer::NoneProved { order } => ("none proved", Some(order), None),
                Answer::None { .. } => ("none", None, None),
                Answer::SomeProved => ("some proved", None, Some(found.decision.set.dimension())),
                Answer::Some { .. } => ("some", None, Some(found.decision.set.dimension())),
                Answer::Undecided => ("undecided", None, None),
            };
            assert_eq!(
                (point.answer, point.order, point.dimension),
                (answer, order, dimension),
                "{name} {varied} {value}"
            );
            let mismatch = found.decision.least / found.decision.acceleration;
            assert_eq!(point.mismatch, Some(mismatch).filter(|x| x.is_finite()), "{name} {varied} {value}");
            assert!(found.decision.acceleration != 1.0);
            reached.insert(answer);
        }
    }
    assert!(reached.contains("none") && reached.contains("none proved") && late > 0, "{reached:?}, {late}");
}

/// Where the constraints are integrable a theorem says that every μ₀ gives Chetaev's motion; without this it
/// is not named.
#[test]
fn theorems_prove_what_ranks_only_show() {
    let text = |potential: &str, constraints: &str| {
        format!(
            "title = \"theorem\"\n[coordinates]\nx = {{ start = 0.3 }}\ny = {{ start = 0.2 }}\nz = {{ start = 0.1 }}\n\
             [system]\nlagrangian = \"(x'^2 + 2*y'^2 + z'^2)/2 - {potential}\"\nconstraints = [{constraints}]\n\
             [start.velocities]\n\"x'\" = 0.8\n[run]\nduration = 1\n"
        )
    };
    let of = |potential: &str, constraints: &str| {
        let scene = Scene::parse("theorem", &text(potential, constraints)).unwrap_or_else(|e| panic!("{e}"));
        comparison::membership(&scene, 1.0).expect("constraints").expect("decided")
    };
    for (constraints, theorem) in [
        ("\"z' - y*x' - x*y'\", \"y' - x'\"", Some("the constraints are integrable")),
        ("\"z' - y*x'\", \"y' - sin(x)*x'\"", Some("the constraints are integrable")),
        ("\"z' - y*x'\", \"y' - z*x'\"", Some("the constraints are integrable")),
        ("\"z' - y*x' - t\", \"y' - z*x'\"", None),
    ] {
        let found = of("sin(x)*y + z^2", constraints);
        assert_eq!(found.theorem, theorem, "{constraints}");
        assert_eq!(found.answer() == Answer::SomeProved, theorem.is_some(), "{constraints}: {:?}", found.answer());
    }
}
