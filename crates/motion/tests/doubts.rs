//! Whether the difference of two runs says how wrong they are, by their steps.

use integrate::Method;
use motion::Doubt;

/// Steps of the looser run per stretch, in the search for where a doubt begins.
const TOGETHER: usize = 16;

/// Ends of `count` equal steps from 0 to 1, then of `more` times as many from 1 to 2.
fn steps(count: usize, more: usize) -> Vec<f64> {
    let first = (0..count).map(|i| i as f64 / count as f64);
    let second = (0..=count * more).map(|i| 1.0 + i as f64 / (count * more) as f64);
    first.chain(second).collect()
}

fn doubt(kept: Vec<f64>, looser: Vec<f64>, direction: f64) -> Option<Doubt> {
    let [kept, looser] = [kept, looser].map(|times| times.into_iter().map(|t| direction * t).collect::<Vec<f64>>());
    Doubt::of([&kept, &looser], direction * 2.0, true, Some(Method::Dop853))
}

#[test]
fn what_the_order_explains_is_not_doubted() {
    // order 8: a hundredth of the tolerance takes 1.8 times the steps
    assert_eq!(doubt(steps(540, 1), steps(300, 1), 1.0), None);
}

#[test]
fn a_doubt_begins_where_round_off_takes_over() {
    for direction in [1.0, -1.0] {
        let doubt = doubt(steps(540, 60), steps(300, 1), direction).expect("too many steps");
        assert!(doubt.because.contains("round-off limits"), "{doubt:?}");
        let before = 1.0 - direction * doubt.from;
        assert!((0.0..=TOGETHER as f64 / 300.0).contains(&before), "{doubt:?}");
    }
}

#[test]
fn a_doubt_begins_where_steps_follow_something_else() {
    let (kept, looser) = (steps(54, 50), steps(30, 90));
    let doubt = doubt(kept, looser, 1.0).expect("2700 steps at both tolerances");
    assert!(doubt.because.contains("something else limits") && doubt.because.contains("stiff"), "{doubt:?}");
    assert!((doubt.from - 1.0).abs() < 0.2, "{doubt:?}");
}

#[test]
fn a_method_made_for_stiff_equations_is_not_advised_to_itself() {
    let (kept, looser) = (steps(54, 50), steps(30, 90));
    let doubt = Doubt::of([&kept, &looser], 2.0, true, Some(Method::Radau5)).expect("too few steps");
    assert!(doubt.because.ends_with("something else limits the steps"), "{doubt:?}");
}

#[test]
fn steps_just_before_a_stop_are_not_doubted() {
    // to 1.9 as the order explains, and then short ones
    let (mut kept, looser) = (steps(540, 1), steps(300, 1));
    kept.retain(|t| *t < 1.9);
    kept.extend((0..=100_000).map(|i| 1.9 + 1e-6 * f64::from(i)));
    let doubt = |complete| Doubt::of([&kept, &looser], 2.0, complete, Some(Method::Dop853));
    assert_eq!(doubt(false), None);
    assert!(doubt(true).is_some_and(|doubt| doubt.from > 1.8));
}
