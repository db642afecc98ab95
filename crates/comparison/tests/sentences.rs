//! Every sentence of a headline against rows that say what it should: numbers, names, counts.

use comparison::words::{Headline, enumerate, or_dash, rows, short};
use comparison::{Comparison, Gap, Pair, Run, Verdict, compare_unfitted};
use equations::Formulation;
use motion::{CHETAEV, Choice, Settings, SolveError, VAKONOMIC, VAKONOMIC_COSTATE, choices};
use scene::Scene;

/// Three motions of the sledge; nothing is known of them but what rows say.
fn three() -> Comparison {
    let scene = Scene::parse("sledge", include_str!("../../scene/sledge.toml")).expect("a scene");
    let mut three: Vec<Choice> = choices(&scene);
    three.retain(|choice| choice.formulation != VAKONOMIC_COSTATE);
    three.truncate(3);
    let mut comparison = compare_unfitted(scene, three, Vec::new(), &Settings::default()).expect("a comparison");
    comparison.decided.clear();
    for pair in &mut comparison.pairs {
        (pair.growth, pair.predicted) = (None, None);
        pair.gap = same(&pair.gap, 10.0);
    }
    assert_eq!(comparison.pairs.len(), 3);
    comparison
}

fn same(gap: &Gap, end: f64) -> Gap {
    let mut points = gap.points.clone();
    points.iter_mut().for_each(|p| (p.gap, p.limit, p.certain) = (1e-13, 2e-12, false));
    let (verdict, passes, largest, certain_from) = (Verdict::Same, [None; 3], 1e-13, None);
    let certain_by_coordinate = vec![None; gap.certain_by_coordinate.len()];
    Gap { verdict, end, passes, largest, certain_from, certain_by_coordinate, points, proved: false, ..gap.clone() }
}

/// Apart from the second point on, and at these times by 1e-6, 1e-3 and 0.1.
fn apart(gap: &Gap, passes: [Option<f64>; 3], largest: f64) -> Gap {
    let mut points = gap.points.clone();
    points.iter_mut().skip(1).for_each(|p| (p.gap, p.certain) = (largest, true));
    let certain_from = Some(points[1].t);
    Gap { verdict: Verdict::Different, passes, largest, certain_from, points, ..gap.clone() }
}

/// The row of two of the three motions.
fn row(comparison: &mut Comparison, first: usize, second: usize) -> &mut Gap {
    &mut comparison.pairs.iter_mut().find(|p| (p.first, p.second) == (first, second)).expect("a row").gap
}

fn verdict(comparison: &Comparison) -> String {
    assert_eq!(comparison.contradictions(), Vec::new());
    Headline::of(comparison).verdict
}

#[test]
fn what_is_the_same_is_so_up_to_the_earliest_end() {
    let mut three = three();
    for ((first, second), end) in [((0, 1), 7.0), ((0, 2), 3.25), ((1, 2), 5.0)] {
        row(&mut three, first, second).end = end;
    }
    let same = "No formulation's motion differs from another's by more than the error estimates up to 3.25 s.";
    assert_eq!(verdict(&three), same);
    // a row that is no "same" has no say in this
    let gap = row(&mut three, 0, 2).clone();
    *row(&mut three, 0, 2) = apart(&gap, [Some(0.5), None, None], 4e-4);
    *row(&mut three, 1, 2) = apart(&gap, [Some(0.7), Some(0.875), None], 2.5e-2);
    let told = verdict(&three);
    assert!(told.starts_with("2 different motions: Chetaev ≈ vakonomic; removed"), "{told}");
    assert!(told.contains("≈: no difference above the error estimates up to 7 s."), "{told}");
    // the first of the three is under 1e-3, the second passes it
    let removed = three.runs[2].choice.label.clone();
    assert!(told.contains(&format!("Chetaev and {removed} differ by less than 1e-3, by up to 4.0e-4.")), "{told}");
    let passed = format!("vakonomic and {removed} differ by 1e-3 after 0.875 s and by up to 0.025.");
    assert!(told.contains(&passed), "{told}");
}

#[test]
fn a_class_is_of_motions_that_are_all_the_same() {
    let mut three = three();
    let gap = row(&mut three, 1, 2).clone();
    *row(&mut three, 1, 2) = apart(&gap, [Some(0.1), Some(0.2), Some(0.3)], 1.5);
    let told = verdict(&three);
    let removed = three.runs[2].choice.label.clone();
    assert!(told.starts_with("Chetaev and vakonomic: no difference above the error estimates up to 10 s."), "{told}");
    assert!(told.contains(&format!("vakonomic and {removed} differ by 1e-3 after 0.2 s and by up to 1.5.")), "{told}");
}

#[test]
fn what_is_undecided_and_what_has_no_motion_is_told_with_its_own_reason() {
    let mut three = three();
    for ((first, second), because) in [((0, 1), "one stops"), ((0, 2), "round-off"), ((1, 2), "one stops")] {
        row(&mut three, first, second).verdict = Verdict::Undecided { because: because.into() };
    }
    let removed = three.runs[2].choice.label.clone();
    let told = verdict(&three);
    let expected = format!(
        "Chetaev and vakonomic; vakonomic and {removed}: undecided, one stops. Chetaev and {removed}: undecided, round-off."
    );
    assert_eq!(told, expected);
    // and one that has none is not among those that agree
    let mut three = self::three();
    let choice = Choice { label: "fourth".into(), ..three.runs[1].choice.clone() };
    three.runs.push(Run { choice, outcome: Err(SolveError::Member { reason: "vakonomic: no start".into() }) });
    let told = verdict(&three);
    assert!(told.ends_with("fourth: no motion, no start.") && !told.contains("No formulation's"), "{told}");
    assert!(told.contains(&format!("Chetaev, vakonomic and {removed}: no difference above the error")), "{told}");
}

#[test]
fn a_proved_difference_that_is_not_seen_is_under_gap_and_limit() {
    let mut three = three();
    for (first, second) in [(0, 1), (0, 2), (1, 2)] {
        let gap = row(&mut three, first, second);
        (gap.proved, gap.verdict) = (true, Verdict::Different);
        gap.points.last_mut().expect("points").gap = 3e-12;
        (gap.largest, gap.end) = (3e-12, 8.0);
    }
    let told = verdict(&three);
    assert!(told.starts_with("3 different motions: Chetaev; vakonomic; removed"), "{told}");
    let unseen = "Chetaev and vakonomic differ, which is proved; by less than 5.0e-12 up to 8 s: measured.";
    assert!(told.contains(unseen), "{told}");
}

#[test]
fn the_largest_estimate_of_all_rows_is_told() {
    let mut three = three();
    for ((first, second), estimates) in [((0, 1), [1e-12, 3e-12]), ((0, 2), [1e-12, 4.5e-11]), ((1, 2), [2e-12, 4e-11])]
    {
        row(&mut three, first, second).estimates = estimates;
    }
    let sure = Headline::of(&three).sure;
    assert!(sure.starts_with("Error estimates: at most 4.5e-11; a gap counts from 10 times the sum of two."), "{sure}");
    assert_eq!([0, 1, 2].map(|run| three.estimate(run)), [Some(1e-12), Some(3e-12), Some(4.5e-11)]);
    row(&mut three, 0, 1).estimates[1] = f64::NAN;
    assert!(Headline::of(&three).sure.contains("at most NaN"));
}

/// Beside the table, where no name leads to it.
static CONTROL: Formulation = Formulation { name: "control", ..chetaev::FORMULATION };

#[test]
fn the_control_has_no_say() {
    let mut three = three();
    let expected = verdict(&three);
    // a fourth motion, of no formulation of the table, that differs from all of them by much
    let outcome = three.runs[0].outcome.clone();
    let choice = Choice { formulation: &CONTROL, label: "control".into(), ..three.runs[0].choice.clone() };
    three.runs.push(Run { choice, outcome });
    let gap = apart(row(&mut three, 0, 1), [Some(0.1); 3], 7.0);
    three.pairs.push(Pair {
        first: 0,
        second: 3,
        gap: Gap { estimates: [1.0; 2], end: 0.5, ..gap },
        growth: None,
        predicted: None,
    });
    let Headline { verdict, sure, .. } = Headline::of(&three);
    assert_eq!(verdict, expected);
    assert!(!sure.contains("at most 1;"), "{sure}");
    assert_eq!(rows(&three).count(), 3);
}

#[test]
fn what_the_curvature_predicts_and_what_was_measured_are_told_apart() {
    let scene = Scene::parse("sledge", include_str!("../../scene/sledge.toml")).expect("a scene");
    let choices = choices(&scene);
    let mut sledge = compare_unfitted(scene, choices, Vec::new(), &Settings::default()).expect("a comparison");
    let pair = sledge.pairs.iter_mut().find(|p| (p.first, p.second) == (0, 1)).expect("a pair");
    pair.growth.as_mut().expect("a growth").length = 2.0;
    pair.predicted.as_mut().expect("a prediction").length = 3.0;
    let why = Headline::of(&sledge).why;
    assert!(
        why.contains("Predicted growth of the gap between Chetaev and vakonomic: 3.0000 t^3; fitted: 2.0000 t^3.00."),
        "{why}"
    );
    // substitution is said of removals without costates, and only of those
    let said =
        "t^3.00. No memory variable has a costate (P = 0) in removed constraint (coordinates): this is substitution";
    assert!(why.contains(said) && why.matches("substitution").count() == 1, "{why}");
}

/// The costate form is the vakonomic motion once more, which is not said.
#[test]
fn a_second_form_that_agrees_is_not_named() {
    let scene = Scene::parse("sledge", include_str!("../../scene/sledge.toml")).expect("a scene");
    let mut all = choices(&scene);
    all.retain(|choice| [CHETAEV, VAKONOMIC, VAKONOMIC_COSTATE].contains(&choice.formulation));
    assert_eq!(all.len(), 3);
    let told = verdict(&compare_unfitted(scene, all, Vec::new(), &Settings::default()).expect("a comparison"));
    assert!(told.starts_with("2 different motions: Chetaev; vakonomic") && !told.contains('≈'), "{told}");
}

#[test]
fn short_numbers() {
    let cases =
        [(0.0, "0"), (0.12345, "0.123"), (12.0, "12"), (1.0e-7, "1.0e-7"), (-2.71328, "-2.71"), (2500.0, "2500")];
    for (x, text) in cases {
        assert_eq!(short(x), text);
    }
    assert_eq!(enumerate(&["a".into(), "b".into(), "c".into()]), "a, b and c");
    assert_eq!([None, Some(0.12345)].map(or_dash), ["–", "0.123"]);
}

/// A particle of constant speed, `x'² + y'² = 1`: at `μ₀ = −1/2`, `L + μ f` has no velocities left.
#[test]
fn every_multiplier_is_one_with_regular_equations() {
    let text = "title = \"Constant speed\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
        lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"x'^2 + y'^2 - 1\"]\n[start.velocities]\n\"x'\" = 0.6\n\
        \"y'\" = 0.8\n[run]\nduration = 1\n";
    let answer = comparison::words::answer(&crate::compared::compared("speed", text)).expect("an answer");
    assert!(answer.contains("Same: Chetaev and vakonomic, for every μ₀ with regular equations (proved)"), "{answer}");
}

#[test]
fn a_system_without_constraints_has_no_multipliers() {
    let scene = "title = 'free'\n[coordinates]\nx = { start = 0 }\n[system]\nlagrangian = \"x'^2/2 - x^2\"\n\
                 [start]\nvelocities = { \"x'\" = 1 }\n[run]\nduration = 1\n";
    let free = crate::compared::compared("free", scene);
    let first = comparison::words::answer(&free).expect("an answer");
    assert_eq!(first, "Same: Chetaev and vakonomic, within the error estimates.");
}

/// Far from the start a later term is the larger one: its growth is not held against the first.
#[test]
fn a_growth_is_fitted_where_its_term_leads() {
    let mut sledge = crate::compared::compared("sledge", include_str!("../../scene/sledge.toml"));
    let pair = sledge.pairs.iter_mut().find(|pair| pair.growth.is_some() && pair.predicted.is_some());
    let pair = pair.expect("a pair");
    let (growth, predicted) = (pair.growth.as_mut().expect("one"), pair.predicted.as_ref().expect("one"));
    (growth.exponent, growth.to) = (growth.exponent + 1.0, 2.0 * predicted.reach);
    assert!(!growth.is_of(predicted));
    assert!(!Headline::of(&sledge).why.contains("fitted"), "{}", Headline::of(&sledge).why);
}
