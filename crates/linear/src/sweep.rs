//! Eigenvalues over a parameter, and where stability changes.

use deltaq::{Choice, Ensemble, EnsembleStart, Form, Settings, SolveError, setting};
use equations::Compiled;
use mechanics::{ConstantsRule, State};
use scene::{Scene, Starts};

use crate::find::chetaev;
use crate::point::{Point, in_quasi_velocities};
use crate::{LinearError, Linearization, Part};

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
    /// Width of the interval in which it is: no error leaves another one open.
    pub width: f64,
    /// Deviations that grow before and behind it.
    pub unstable: [usize; 2],
    /// Imaginary part of the eigenvalue that crosses, ≥ 0: 0 for one that does not oscillate.
    pub frequency: f64,
}

/// Bisection ends where the values are closer than this, over their size.
const CLOSE: f64 = 1e-14;
/// So near, over the size of a value, the real part of an eigenvalue is minus its error where it crosses.
const NEAR: [f64; 3] = [1e-12, 1e-11, 1e-9];

/// `count` values from one to another, both included.
pub fn equidistant(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count.max(2) - 1) as f64).collect()
}

/// The equations of `choice` to first order about the start of `scene`, with each of `values` in the place of
/// the parameter, start value or multiplier `name`; the `free` coordinates as in [`Linearization::part`]. The
/// start has to be a steady motion at each value, or, with `find`, is where one is looked for.
///
/// Between two neighbours with different numbers of growing deviations, the value where that number changes
/// is found by bisection; where it changes and comes back between them, it is not seen.
///
/// # Errors
/// [`LinearError::At`] with the value; [`LinearError::Solve`] for a name that cannot vary, or a formulation
/// that refuses the system.
pub fn sweep(
    scene: &Scene,
    choice: &Choice,
    free: &[&str],
    (name, values): (&str, &[f64]),
    find: bool,
) -> Result<Sweep, LinearError> {
    let mut family = Family::new(scene, choice, name)?;
    let mut finder = find.then(|| Family::new(scene, &chetaev(), name)).transpose()?;
    let mut at = |value: f64| -> Result<SweepPoint, LinearError> {
        let mut found = || {
            let state = finder.as_mut().map(|finder| finder.at(value, None)?.settle()).transpose()?;
            let linearization = Linearization::steady(family.at(value, state)?)?;
            Ok(SweepPoint { value, part: linearization.part(free)?, linearization })
        };
        found().map_err(|error| LinearError::At { name: name.into(), value, error: Box::new(error) })
    };
    let mut sweep = Sweep { name: name.into(), points: Vec::new(), changes: Vec::new() };
    for &value in values {
        let point = at(value)?;
        let mut low = sweep.points.last().unwrap_or(&point).clone();
        // not more often than there are eigenvalues, whatever round-off does
        for _ in 0..point.part.states.len() {
            if low.part.unstable() == point.part.unstable() {
                break;
            }
            let (change, behind) = change(&mut at, low, point.clone())?;
            sweep.changes.push(change);
            low = behind;
        }
        sweep.points.push(point);
    }
    Ok(sweep)
}

/// The equations of a scene with other numbers in the place of one, derived and compiled once.
struct Family {
    ensemble: Ensemble,
    starts: Starts,
    constants: ConstantsRule,
    point: Point,
}

impl Family {
    fn new(scene: &Scene, choice: &Choice, name: &str) -> Result<Family, LinearError> {
        let starts = scene.starts(&[name]).map_err(|error| SolveError::Scene(Box::new(error)))?;
        let choice = in_quasi_velocities(setting(scene), choice);
        let settings = Settings { form: Form::Named, plain: true, ..Settings::default() };
        let ensemble = Ensemble::new(scene, &choice, &[name], &settings)?;
        let equations = ensemble.equations().clone();
        let compile = || Compiled::plain(&equations)?.with_jacobian(&equations);
        let compiled = compile().map_err(SolveError::from)?;
        let point = Point { equations, compiled, t: scene.start.t, y: Vec::new() };
        Ok(Family { ensemble, starts, constants: choice.constants, point })
    }

    /// The start with this value, or another state with the same numbers.
    fn at(&mut self, value: f64, other: Option<State>) -> Result<&mut Point, LinearError> {
        let start = self.starts.at(&[value]).map_err(|error| LinearError::Scene(Box::new(error)))?;
        let varied = self.starts.vary_multipliers();
        let constants = if varied { ConstantsRule::Given(start.multipliers) } else { self.constants.clone() };
        let (state, end) = (other.unwrap_or(start.state), f64::INFINITY);
        let start = EnsembleStart { state, end, parameters: start.parameters, constants };
        let member = self.ensemble.member_at(&start)?;
        member.set(&mut self.point.compiled);
        self.point.y = member.start().to_vec();
        Ok(&mut self.point)
    }
}

type At<'a> = &'a mut dyn FnMut(f64) -> Result<SweepPoint, LinearError>;

/// The first change that bisection comes upon, and a point just behind it.
///
/// The number of growing deviations changes where a real part is as large as its error; close to that, if the
/// eigenvalue crosses, lies the value at which it is minus its error. The change is between the two.
fn change(at: At, low: SweepPoint, high: SweepPoint) -> Result<(Change, SweepPoint), LinearError> {
    let [low, high] = bisect(at, low, high, Part::unstable)?;
    let unstable = [&low, &high].map(|point| point.part.unstable());
    let most = if unstable[0] > unstable[1] { &low } else { &high };
    let growing = most.part.eigenvalues.iter().filter(|e| e.is_unstable());
    let crossing = growing.min_by(|a, b| a.value.re.total_cmp(&b.value.re));
    let frequency = crossing.map_or(0.0, |e| e.value.im.abs());
    let mut ends = [low.value, high.value];
    let scale = low.value.abs() + high.value.abs();
    for near in NEAR {
        let around = [at(low.value - near * scale)?, at(high.value + near * scale)?];
        if not_decaying(&around[0].part) != not_decaying(&around[1].part) {
            let [a, b] = around;
            let others = bisect(at, a, b, not_decaying)?.map(|point| point.value);
            ends = [ends[0].min(others[0]), ends[1].max(others[1])];
            break;
        }
    }
    let (value, width) = (0.5 * (ends[0] + ends[1]), (ends[1] - ends[0]).abs());
    Ok((Change { value, width, unstable, frequency }, high))
}

/// How many deviations do not decay beyond what their errors leave open.
fn not_decaying(part: &Part) -> usize {
    part.zeros + part.eigenvalues.iter().filter(|e| e.value.re >= -e.error).count()
}

/// Two neighbours between which a count changes.
fn bisect(
    at: At,
    mut low: SweepPoint,
    mut high: SweepPoint,
    count: fn(&Part) -> usize,
) -> Result<[SweepPoint; 2], LinearError> {
    let limit = CLOSE * (low.value.abs() + high.value.abs());
    while (high.value - low.value).abs() > limit {
        let middle = at(0.5 * (low.value + high.value))?;
        if count(&middle.part) == count(&low.part) { low = middle } else { high = middle }
    }
    Ok([low, high])
}
