//! Whether the difference of two runs says how wrong they are.

use integrate::Method;

use super::limits::{BEFORE_THE_END, CERTAINTY, FEW_STEPS, MORE_STEPS, SOME};
use crate::TIGHTER;
use crate::numbers::precise;

/// That the difference of the two runs is not an error estimate from some time on.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// From this time on.
    pub from: f64,
    /// Why, in words.
    pub because: String,
}

impl Doubt {
    /// From the ends of the steps of the kept and of the looser run, up to the `end` of the motion, by this
    /// method; equal steps have none.
    ///
    /// Two runs with the same steps have the same error, which their difference hides; a run whose steps
    /// follow its round-off is not better than the looser one. Doubt begins where this first shows.
    pub fn of([kept, looser]: [&[f64]; 2], end: f64, complete: bool, method: Option<Method>) -> Option<Doubt> {
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
            |loose: usize, tight: usize| tight as f64 > CERTAINTY * loose.max(1) as f64 * expected.unwrap_or(1.0);
        let (off, what): (&dyn Fn(usize, usize) -> bool, _) = if loose >= FEW_STEPS && too_few(loose, tight) {
            (&too_few, too_few_words(method))
        } else if tight >= FEW_STEPS && too_many(loose, tight) {
            (&too_many, "round-off limits the steps".into())
        } else {
            return None;
        };
        let marks: Vec<usize> = (0..loose).step_by(SOME).chain([loose.saturating_sub(1)]).collect();
        let stretch = marks.windows(2).find(|ends| {
            let [from, to] = [ends[0], ends[1]].map(|i| until(kept, looser[i]));
            off(ends[1] - ends[0], to - from)
        });
        let from = stretch.map_or(start, |ends| looser[ends[0]]);
        let because = format!(
            "the error estimate is not to be trusted from t = {} on: {loose} steps at one tolerance, {tight} at a hundredth of it, so that {what}",
            precise(from)
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
