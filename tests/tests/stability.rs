//! Stiff and extreme cases: no method returns a wrong trajectory in silence; what was mended stays so.

use diffsol_methods::{ESDIRK34, EVERY, TR_BDF2};
use equations::{Equations, Formulation};
use integrate::Method;
use mechanics::{ConstantsRule, Recombination};
use motion::{
    CHETAEV, Choice, Ending, Motion, Setting, Settings, Stepping, VAKONOMIC, VAKONOMIC_COSTATE, default_constants,
    derive, derive_at, setting, solve,
};
use random::realization::with_added_mass;
use scene::Scene;
use serde_json::Value;
use validation::stability::{
    Answering, CASES, COMPARED, Case, Cell, LONG, Long, MILLION, Question, Reference, Verdict,
};

fn questions(case: &str) -> Vec<Question> {
    let case = CASES.iter().find(|c| c.name == case).expect("a case of that name");
    (case.questions)()
}

fn question(case: &str, point: f64, formulation: &str) -> Question {
    let found = questions(case).into_iter().find(|q| q.point == point && q.formulation == formulation);
    found.expect("a question at that point")
}

fn is_wrong(cell: &Cell) -> bool {
    matches!(cell.verdict, Verdict::Wrong { .. })
}

/// The committed verdicts are those of a fresh run: `cargo xtask reports` compares them.
#[test]
fn nothing_is_wrong_and_no_case_is_only_refused() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../reports/verdicts.json"));
    let verdicts: Value = serde_json::from_str(&text.expect("verdicts")).expect("verdicts");
    let stability = &verdicts["stability"];
    assert_eq!(stability["wrong"], 0);
    let answers = |case: &str| -> Vec<(String, Value)> {
        let lines = stability["cases"][case].as_object().unwrap_or_else(|| panic!("no answers to {case}")).values();
        lines.flat_map(|line| line.as_object().expect("an answer a method").clone()).collect()
    };
    let accurate = |case: &Case| answers(case.name).into_iter().filter(|(_, word)| word == "accurate");
    for case in CASES.iter().filter(|case| !case.name.starts_with("blow-up")) {
        assert!(accurate(case).next().is_some(), "{} has no accurate answer", case.name);
    }
    for method in EVERY {
        let mut all = CASES.iter().flat_map(accurate);
        assert!(all.any(|(name, _)| name == method.name()), "{method:?} has no accurate answer");
    }
}

/// The committed table is that of a fresh run: `cargo xtask reports` compares it.
#[test]
fn a_million_steps_keep_what_they_are_to_keep() {
    let table = concat!(env!("CARGO_MANIFEST_DIR"), "/../reports/data/stability/million-steps.csv");
    let table = std::fs::read_to_string(table).expect("a table");
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().expect("a head");
    let place = |name: &str| names.iter().position(|other| *other == name).expect(name);
    let [duration, method, steps, energy, trend, constraint, verdict] =
        ["duration (s)", "method", "steps", "energy", "trend", "constraint", "verdict"].map(place);
    let runs: Vec<_> = lines.collect();
    assert_eq!(runs.len(), LONG.len() * COMPARED.len());
    for run in &runs {
        let number = |place: usize| run[place].parse::<f64>().expect("a number");
        assert_eq!(run[verdict], "accurate", "{run:?}");
        assert!(number(constraint) < 1e-10, "{run:?}");
        if run[method] == Stepping::Leapfrog.name() {
            assert_eq!(run[steps], MILLION.to_string());
            assert!(number(constraint) < 1e-15, "{run:?}");
            // where the motion comes back, its energy does
            assert!(number(duration) < 100.0 || number(trend) < 1e-2 * number(energy), "{run:?}");
        }
    }
}

#[test]
fn a_long_run_that_goes_elsewhere_is_called_wrong() {
    let elsewhere = |_: &Formulation| Reference::Closed(Box::new(|t| vec![0.0, 0.0, 0.3 + 1.1 * t]));
    let known = LONG[0].reference;
    for (reference, word) in [(known, "accurate"), (Some(elsewhere as fn(&Formulation) -> Reference), "wrong")] {
        let long = Long { scene: "sledge", formulation: CHETAEV, duration: 20.0, constants: None, reference };
        let run = long.run(Stepping::Adaptive(Some(Method::Dop853))).expect("a scene");
        assert_eq!(run.verdict.word(), word, "{run:?}");
    }
}

#[test]
fn radau_steps_over_friction_whatever_its_strength() {
    for strength in [1e1, 1e4, 1e7, 1e10] {
        let motion = motion(&question("viscous", strength, "Newton, with friction"), Method::Radau5, 1e-7, 4_000);
        assert!(motion.is_complete() && motion.doubt.is_none(), "N = {strength:e}: {:?}", motion.ending);
        // 900 to 1100 at the tighter tolerance, 1e-9, whatever N
        assert!(motion.work.steps + motion.work.rejected < 1500, "N = {strength:e}: {:?}", motion.work);
    }
}

#[test]
fn the_method_suits_the_motion() {
    for (strength, expected) in [(1.0, Method::Taylor), (1e6, Method::Radau5), (1e10, Method::Radau5)] {
        let motion = motion(&question("viscous", strength, "Newton, with friction"), None, 1e-9, 8_000);
        let chosen = motion.method.as_ref().expect("a method");
        assert!(motion.is_complete() && motion.doubt.is_none(), "N = {strength:e}: {:?}", motion.ending);
        assert_eq!(chosen.method, expected, "N = {strength:e}: {}", chosen.why);
    }
    let text = r#"
title = "A spring that only pulls back from one side"
[coordinates]
x = { start = 0.5 }
[system]
lagrangian = "x'^2/2"
forces = { x = "-x - sqrt(x^2)" }
[start.velocities]
"x'" = 0.3
[run]
duration = 5
"#;
    let scene = scene::Scene::parse("kink", text).expect("a scene");
    let motion = motion::solve_choice(&scene, &motion::choices(&scene)[0], &Settings::default()).expect("starts");
    let chosen = motion.method.as_ref().expect("a method");
    assert!(chosen.method == Method::Dop853 && chosen.why.contains("where x is zero"), "{chosen:?}");
}

#[test]
fn what_nearly_dependent_constraints_lose_is_in_the_estimate() {
    // at an angle of 1e-9 round-off in the constraints is worth 1e-7
    let point = 2.0_f64.powi(-30);
    for cell in question("dependent", point, "Chetaev").cells("dependent").expect("a reference") {
        let Verdict::Accurate { error, estimate } = cell.verdict else { panic!("{cell:?}") };
        assert!(error < estimate, "{cell:?}");
    }
}

#[test]
fn steps_that_round_off_decides_are_said() {
    // added mass in velocities alone: f is a difference of terms that agree to ten digits
    let scene = scene::catalogue::find("particle", &[]).expect("built in");
    let massive = with_added_mass(&scene.system, 1e10);
    let settings = Settings { tolerance: 1e-10, method: Some(Method::Dop853), max_steps: 4_000, ..Settings::default() };
    let newton = random::equations(&massive, CHETAEV, None).expect("equations");
    let noisy = solve(Setting { system: &massive, ..setting(&scene) }, newton, &ConstantsRule::Zero, &settings);
    let noisy = noisy.expect("starts");
    assert!(noisy.doubt.as_ref().is_some_and(|doubt| doubt.because.contains("round-off limits")), "{:?}", noisy.doubt);
}

#[test]
fn a_motion_that_is_off_and_does_not_know_is_called_wrong() {
    for (off, wrong) in [(0.0, false), (1e-4, true), (f64::NAN, true)] {
        let mut asked = question("sledge-long", 10.0, "Chetaev");
        let Reference::Closed(road) = asked.reference else { panic!("the sledge has a closed form") };
        asked.reference = Reference::Closed(Box::new(move |t| {
            let mut q = road(t);
            q[0] += off * t;
            q
        }));
        let cell = of_dop853(&asked);
        assert_eq!(is_wrong(&cell), wrong, "a reference that is off by {off}: {cell:?}");
    }
}

fn of_dop853(asked: &Question) -> Cell {
    let cells = asked.cells("off").expect("the reference reaches as far");
    cells.into_iter().find(|cell| cell.method == Answering::Method(Some(Method::Dop853))).expect("of every method")
}

#[test]
fn a_single_coordinate_or_multiplier_that_is_off_is_called_wrong() {
    // the height, which moves by millimetres, and the reaction along it: the kinetic metric sees neither
    for (i, off) in [(2, 1e-8), (8, 1e-4)] {
        for each in [false, true] {
            let mut asked = question("rattleback", 1.0, "Chetaev");
            let Reference::Ode { y, rates, read } = asked.reference else { panic!("equations by hand") };
            let read = Box::new(move |t: f64, y: &[f64]| {
                let mut values = read(t, y);
                values[i] += off * t;
                values
            });
            (asked.reference, asked.each) = (Reference::Ode { y, rates, read }, each);
            let cell = of_dop853(&asked);
            assert_eq!(is_wrong(&cell), each, "value {i} off by {off}, each by itself: {each}: {cell:?}");
        }
    }
}

#[test]
fn runaway_motions_stop_at_the_pole() {
    for start in [0.01, 1.0, 100.0] {
        let cells = question("blow-up-across", start, "Chetaev").cells("blow-up-across").expect("a closed form");
        for cell in &cells {
            let Verdict::Refused { t: Some(t), .. } = cell.verdict else { panic!("{cell:?}") };
            // the others may run out of steps before
            let limit = if cell.method == Answering::Method(Some(Method::Dop853)) { 1e-9 } else { 1e-2 };
            assert!((t * start - 1.0).abs() < limit, "the pole is at {}: {cell:?}", 1.0 / start);
        }
    }
}

#[test]
fn a_sledge_of_a_picometre_is_resolved() {
    // with an absolute tolerance in metres, BDF had an error of 1.2e-2 and an estimate of 3e-4
    let cells = question("unit-of-length", 1e12, "Chetaev").cells("unit-of-length").expect("a closed form");
    for cell in cells {
        let is_low = [TR_BDF2, ESDIRK34].map(|method| Answering::Method(Some(method))).contains(&cell.method);
        let limit = if is_low { 1e-3 } else { 1e-6 };
        match cell.verdict {
            Verdict::Accurate { error, .. } => assert!(error < limit, "{cell:?}"),
            _ => panic!("{cell:?}"),
        }
    }
}

fn motion(question: &Question, method: impl Into<Option<Method>>, tolerance: f64, max_steps: usize) -> Motion {
    let subject = (question.subject)().expect("equations");
    let settings = Settings { tolerance, method: method.into(), max_steps, ..Settings::default() };
    let setting = Setting { system: &subject.system, start: &subject.start, end: subject.end };
    solve(setting, subject.equations, &subject.constants, &settings).expect("starts")
}

#[test]
fn steps_that_the_tolerance_does_not_decide_are_said() {
    // both runs take steps of 1e-5 and have the same error, which their difference does not show
    let stiff = motion(&question("viscous", 1e10, "Newton, with friction"), ESDIRK34, 1e-7, 4_000);
    assert!(
        stiff.doubt.as_ref().is_some_and(|doubt| doubt.because.contains("something else limits")),
        "{:?}",
        stiff.doubt
    );
    let soft = motion(&question("viscous", 1e1, "Newton, with friction"), ESDIRK34, 1e-7, 4_000);
    assert_eq!(soft.doubt, None);
}

#[test]
fn a_motion_ends_where_the_run_for_its_estimate_ends() {
    // stiff, by series: low order is stable for short steps only, so the looser run first uses up its steps
    let stiff = motion(&question("viscous", 1e6, "Newton, with friction"), Method::Taylor, 1e-10, 4_000);
    let Ending::Stopped { t, cause } = &stiff.ending else { panic!("complete") };
    assert!(cause.starts_with("the run that estimates the error stops here"), "{cause}");
    assert!(stiff.end() >= 0.99 * t, "ends at {}, says {t}", stiff.end());
    // near a chart's end the tighter run stops first, following its round-off; the looser goes no farther
    let asked = question("cone-chart", 1e-5, "Chetaev");
    let stuck = motion(&asked, Method::Dop853, 1e-10, 4_000);
    let Ending::Stopped { t, .. } = &stuck.ending else { panic!("complete") };
    assert!(stuck.end() <= *t && stuck.end() >= 0.99 * t, "ends at {}, says {t}", stuck.end());
}

const NEARLY_ONE: &str = include_str!("scenes/nearly-one.toml");

/// `f₂ = f₁ + d (ż + ẇ − xẏ)`, or the bracket alone.
fn nearly_one(d: Option<f64>) -> Scene {
    let second = match d {
        Some(d) => format!("(1 + {d:?})*z' - y*x' + {d:?}*(w' - x*y')"),
        None => "z' + w' - x*y'".into(),
    };
    Scene::parse("nearly-one", &NEARLY_ONE.replace("SECOND", &second)).expect("a scene")
}

fn choice(scene: &Scene, formulation: &'static Formulation) -> Choice {
    let constants = default_constants(formulation, scene);
    Choice { label: formulation.title.into(), formulation, removal: None, constants }
}

fn solved(scene: &Scene, equations: Equations, constants: ConstantsRule) -> Motion {
    solve(setting(scene), equations, &constants, &Settings::default()).expect("starts")
}

#[test]
fn recombined_constraints_have_the_same_motion_and_the_multipliers_of_those_given() {
    let d = 2.0_f64.powi(-13);
    let (near, apart) = (nearly_one(Some(d)), nearly_one(None));
    assert!(Recombination::at(&near.system, &near.start).expect("independent").is_some());
    assert!(Recombination::at(&apart.system, &apart.start).expect("independent").is_none());
    // with f₂ = f₁ + d f₃: μ₁f₁ + μ₂f₂ = (μ₁ + μ₂) f₁ + d μ₂ f₃
    let given = [-700.0, 900.0];
    let same = [given[0] + given[1], d * given[1]];
    for (name, near_rule, apart_rule) in [
        (CHETAEV, ConstantsRule::Zero, ConstantsRule::Zero),
        (VAKONOMIC, ConstantsRule::Given(given.to_vec()), ConstantsRule::Given(same.to_vec())),
        (VAKONOMIC_COSTATE, ConstantsRule::Given(given.to_vec()), ConstantsRule::Given(same.to_vec())),
    ] {
        let equations = derive_at(&near.system, &near.start, &choice(&near, name)).expect("equations");
        assert!(equations.left_out.iter().any(|l| l.words.contains("nearly dependent")), "{name:?} does not say so");
        let mut one = solved(&near, equations, near_rule);
        let mut two = solved(&apart, derive(&apart.system, &choice(&apart, name)).expect("equations"), apart_rule);
        assert!(one.is_complete() && two.is_complete(), "{name:?}: {:?}", one.ending);
        for t in [0.0, 1.0, 3.0] {
            let (one, two) = (one.at(t).expect("a state"), two.at(t).expect("a state"));
            for (a, b) in one.coordinates.iter().zip(&two.coordinates) {
                assert!((a - b).abs() < 1e-9, "{name:?} at t = {t}: {a} is not {b}");
            }
            let (found, known) = (&one.multipliers, &two.multipliers);
            let expected = [known[0] - known[1] / d, known[1] / d];
            let size = expected[0].abs().max(expected[1].abs()).max(1.0);
            for (a, b) in found.iter().zip(expected) {
                assert!((a - b).abs() < 1e-8 * size, "{name:?} at t = {t}: multiplier {a} is not {b}");
            }
        }
    }
}

#[test]
fn constraints_that_round_off_makes_one_are_refused_with_their_angle() {
    let text = NEARLY_ONE.replace("SECOND", "(1 + 1e-14)*z' - y*x' + 1e-14*(w' - x*y')");
    let error = Scene::parse("nearly-one", &text).expect_err("dependent").to_string();
    assert!(error.contains("dependent at the start") && error.contains("limit 1e-10"), "{error}");
}
