//! Whether the difference of two runs says how wrong they are.

use integrate::Method;

use crate::TIGHTER;

/// That the difference of the two runs is no error estimate from some time on.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// From this time on.
    pub from: f64,
    /// Why, in words.
    pub because: String,
}

/// Fewer steps than this may be those of the start, or of a motion that is a polynomial.
const FEW_STEPS: usize = 200;

/// Part of a stopped motion whose steps count: just before a singularity they are short at any tolerance.
const BEFORE_THE_END: f64 = 0.9;

/// A hundredth of the tolerance takes at least this power of what the order of the method asks for.
const MORE_STEPS: f64 = 1.0 / 3.0;

/// Steps of a hundredth of the tolerance over what the method's order asks for; beyond, it is round-off.
const TOO_MANY: f64 = 10.0;

/// Number of steps of the looser run per stretch, in the search for where the doubt begins.
const TOGETHER: usize = 20;

impl Doubt {
    /// From the ends of the steps of the kept and of the looser run, up to the `end` of the motion, by this
    /// method; equal steps have none.
    ///
    /// Two runs with the same steps have the same error, which their difference hides; a run whose steps
    /// follow its round-off is no better than the looser one. Doubt begins where this first shows.
    pub(crate) fn of([kept, looser]: [&[f64]; 2], end: f64, complete: bool, method: Option<Method>) -> Option<Doubt> {
        let start = kept[0];
        let end = if complete { end } else { start + BEFORE_THE_END * (end - start) };
        let sign = (end - start).signum();
        let until = |times: &[f64], end: f64| times.partition_point(|&t| (end - t) * sign >= 0.0);
        let (tight, loose) = (until(kept, end), until(looser, end));
        let order = method.and_then(Method::order_in_steps);
        let expected = order.map(|order| TIGHTER.recip().powf(1.0 / order));
        let too_few = |loose: usize, tight: usize| {
            expected.is_some_and(|expected| (tight as f64) < loose as f64 * expected.powf(MORE_STEPS))
        };
        let too_many =
            |loose: usize, tight: usize| tight as f64 > TOO_MANY * loose.max(1) as f64 * expected.unwrap_or(1.0);
        let (off, what): (&dyn Fn(usize, usize) -> bool, _) = if loose >= FEW_STEPS && too_few(loose, tight) {
            (&too_few, too_few_words(method))
        } else if tight >= FEW_STEPS && too_many(loose, tight) {
            (&too_many, "round-off limits the steps".into())
        } else {
            return None;
        };
        let marks: Vec<usize> = (0..loose).step_by(TOGETHER).chain([loose.saturating_sub(1)]).collect();
        let stretch = marks.windows(2).find(|ends| {
            let [from, to] = [ends[0], ends[1]].map(|i| until(kept, looser[i]));
            off(ends[1] - ends[0], to - from)
        });
        let from = stretch.map_or(start, |ends| looser[ends[0]]);
        let because = format!(
            "the error estimate is not to be trusted from t = {from:.6} on: {loose} steps at one tolerance, {tight} at a hundredth of it, so that {what}"
        );
        Some(Doubt { from, because })
    }
}

/// Steps that do not follow the tolerance: those of an explicit method follow what it is stable with.
fn too_few_words(method: Option<Method>) -> String {
    let explicit = method.filter(|method| !method.is_implicit());
    let stiff = explicit.map(|method| {
        let name = method.name();
        format!("; stiff equations do that to {name}: radau5 is made for them, and the default method changes to it")
    });
    format!("something else limits the steps{}", stiff.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
