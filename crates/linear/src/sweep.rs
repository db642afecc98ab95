//! Eigenvalues over a parameter, and where stability changes.

use deltaq::{Choice, Setting, setting};
use mechanics::ConstantsRule;
use scene::{Scene, Starts};

use crate::{LinearError, Linearization, Part, find_steady, linearize};

/// The steady motions of a scene over one of its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// What varies.
    pub name: String,
    /// Its values, and what belongs to each.
    pub points: Vec<SweepPoint>,
    /// Where the number of deviations that grow changes, by rising value.
    pub changes: Vec<Change>,
}

/// One value of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// The value.
    pub value: f64,
    /// The equations to first order.
    pub linearization: Linearization,
    /// The eigenvalues that were asked for.
    pub part: Part,
}

/// A value at which stability changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The value.
    pub value: f64,
    /// Width of the interval in which the number changes.
    pub width: f64,
    /// Deviations that grow before and behind it.
    pub unstable: [usize; 2],
    /// Imaginary part of the eigenvalue that crosses, ≥ 0: 0 for one that does not oscillate.
    pub frequency: f64,
}

/// Bisection ends where the values are closer than this, over their size.
const CLOSE: f64 = 1e-13;

/// `count` values from one to another, both included.
pub fn equidistant(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count.max(2) - 1) as f64).collect()
}

/// The equations of `choice` to first order about the start of `scene`, with each of `values` in the place of
/// the parameter, start value or multiplier `name`; the `free` coordinates as in [`Linearization::part`]. The
/// start has to be a steady motion at each value, or, with `find`, is where one is looked for.
///
/// Between two neighbours with different numbers of growing deviations, the value where that number changes is
/// found by bisection; where it changes twice and back, it is not seen.
///
/// # Errors
/// [`LinearError::At`] with the value; [`LinearError::Scene`] for a name that cannot vary.
pub fn sweep(
    scene: &Scene,
    choice: &Choice,
    free: &[&str],
    (name, values): (&str, &[f64]),
    find: bool,
) -> Result<Sweep, LinearError> {
    let mut starts = scene.starts(&[name]).map_err(|error| LinearError::Scene(error.kind))?;
    let mut at = |value: f64| {
        let found = at(scene, &mut starts, choice, free, value, find);
        found.map_err(|error| LinearError::At { name: name.into(), value, error: Box::new(error) })
    };
    let mut sweep = Sweep { name: name.into(), points: Vec::new(), changes: Vec::new() };
    for &value in values {
        let point = at(value)?;
        let mut low = sweep.points.last().unwrap_or(&point).clone();
        while low.part.unstable() != point.part.unstable() {
            let (change, behind) = bisect(&mut at, low, point.clone())?;
            sweep.changes.push(change);
            low = behind;
        }
        sweep.points.push(point);
    }
    Ok(sweep)
}

fn at(
    scene: &Scene,
    starts: &mut Starts,
    choice: &Choice,
    free: &[&str],
    value: f64,
    find: bool,
) -> Result<SweepPoint, LinearError> {
    let start = starts.at(&[value]).map_err(|error| LinearError::Scene(Box::new(error)))?;
    let mut system = scene.system.clone();
    for (symbol, value) in starts.parameters().into_iter().zip(&start.parameters) {
        system.parameters.iter_mut().filter(|p| p.symbol == symbol).for_each(|p| p.value = *value);
    }
    let mut choice = choice.clone();
    if starts.vary_multipliers() {
        choice.constants = ConstantsRule::Given(start.multipliers);
    }
    let given = Setting { system: &system, start: &start.state, ..setting(scene) };
    let steady = if find { find_steady(given)? } else { start.state.clone() };
    let found = linearize(Setting { start: &steady, ..given }, &choice)?;
    Ok(SweepPoint { value, part: found.part(free)?, linearization: found })
}

/// The first change that bisection comes upon, and a point just behind it.
fn bisect(
    at: &mut impl FnMut(f64) -> Result<SweepPoint, LinearError>,
    mut low: SweepPoint,
    mut high: SweepPoint,
) -> Result<(Change, SweepPoint), LinearError> {
    let limit = CLOSE * (low.value.abs() + high.value.abs());
    while (high.value - low.value).abs() > limit {
        let middle = at(0.5 * (low.value + high.value))?;
        if middle.part.unstable() == low.part.unstable() { low = middle } else { high = middle }
    }
    let unstable = [&low, &high].map(|point| point.part.unstable());
    let most = if unstable[0] > unstable[1] { &low } else { &high };
    let growing = most.part.eigenvalues.iter().filter(|e| e.is_unstable());
    let crossing = growing.min_by(|a, b| a.value.re.total_cmp(&b.value.re));
    let frequency = crossing.map_or(0.0, |e| e.value.im.abs());
    let (value, width) = (0.5 * (low.value + high.value), (high.value - low.value).abs());
    Ok((Change { value, width, unstable, frequency }, high))
}
