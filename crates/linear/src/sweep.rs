//! Eigenvalues over a parameter, and where stability changes.

use mechanics::{ConstantsRule, State};
use motion::{Choice, Ensemble, EnsembleStart, Form, Settings, SolveError, setting};
use scene::{Scene, Starts};
use symbolic::limits::LAST_DIGITS;

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
    /// Where the number of eigenvalues with a positive real part changes, by rising value asked for.
    pub changes: Vec<Change>,
}

/// One value of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// The value in the state that is linearized.
    pub value: f64,
    /// The value in the start from which that state was found; the same where none is looked for.
    pub asked: f64,
    /// That state.
    pub state: State,
    /// The equations to first order.
    pub linearization: Linearization,
    /// The eigenvalues that were asked for.
    pub part: Part,
}

/// A value at which stability changes.
#[derive(Clone, Debug, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Change {
    /// The value, in the steady motion there.
    pub value: f64,
    /// Width of the interval in which it is: no error leaves another one open.
    pub width: f64,
    /// The value in the start from which that motion was found; the same where none is looked for.
    pub asked: f64,
    /// A steady motion just behind it.
    #[serde(skip)]
    pub state: State,
    /// Eigenvalues with a positive real part below it and above.
    pub unstable: [usize; 2],
    /// Imaginary part of the eigenvalue that crosses, ≥ 0: 0 for one that does not oscillate.
    pub frequency: f64,
}

/// So near, over the size of a value, errors decide again what eigenvalues on the axis do.
const NEAR: [f64; 5] = [1e-12, 1e-11, 1e-9, 1e-7, 1e-5];

/// The equations of `choice` to first order about the start of `scene`, with each of `values` instead of
/// the parameter, start value or multiplier `name`; the `free` coordinates as in [`Linearization::part`]. The
/// start has to be a steady motion at each value, or, with `find`, is where one is looked for.
///
/// Between two neighbours with different numbers of eigenvalues that have a positive real part, the value
/// where that number changes is found by bisection; where it changes and comes back, it is not seen.
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
            let settled = finder.as_mut().map(|finder| finder.at(value, None)?.0.settle()).transpose()?;
            let (point, state) = family.at(value, settled)?;
            let linearization = Linearization::at(point, true)?;
            let part = linearization.part(free)?;
            let there = in_state(scene, name, &state).unwrap_or(value);
            Ok(SweepPoint { value: there, asked: value, state, linearization, part })
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

/// What a state has instead of a coordinate or a velocity.
fn in_state(scene: &Scene, name: &str, state: &State) -> Option<f64> {
    let (coordinate, values) = name.strip_suffix('\'').map_or((name, &state.q), |coordinate| (coordinate, &state.v));
    let place = scene.system.coordinates.iter().position(|c| c.name == coordinate)?;
    values.get(place).copied()
}

/// The equations of a scene with other numbers instead of one, derived and compiled once.
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
        let point = Point::of(ensemble.equations().clone(), scene.start.t, Vec::new())?;
        Ok(Family { ensemble, starts, constants: choice.constants, point })
    }

    /// The start with this value, or another state with the same numbers, and that state.
    fn at(&mut self, value: f64, other: Option<State>) -> Result<(&mut Point, State), LinearError> {
        let start = self.starts.at(&[value]).map_err(|error| LinearError::Scene(Box::new(error)))?;
        let varied = self.starts.vary_multipliers();
        let constants = if varied { ConstantsRule::Given(start.multipliers) } else { self.constants.clone() };
        let (state, end) = (other.unwrap_or(start.state), f64::INFINITY);
        let start = EnsembleStart { state: state.clone(), end, parameters: start.parameters, constants };
        let member = self.ensemble.member_at(&start)?;
        member.set(&mut self.point.compiled);
        self.point.y = member.start().to_vec();
        Ok((&mut self.point, state))
    }
}

type At<'a> = &'a mut dyn FnMut(f64) -> Result<SweepPoint, LinearError>;

/// The first change that bisection comes upon, and a point just behind it.
///
/// The number of eigenvalues with a positive real part changes where one real part is as large as its error.
/// The value is anywhere between the last points close by at which errors leave as much open as at the ends.
fn change(at: At, first: SweepPoint, last: SweepPoint) -> Result<(Change, SweepPoint), LinearError> {
    let [low, high] = bisect(at, first.clone(), last.clone(), Part::unstable)?;
    let unstable = [&low, &high].map(|point| point.part.unstable());
    let most = if unstable[0] > unstable[1] { &low } else { &high };
    let growing = most.part.eigenvalues.iter().filter(|e| e.is_unstable());
    let crossing = growing.min_by(|a, b| a.value.re.total_cmp(&b.value.re));
    let frequency = crossing.map_or(0.0, |e| e.value.im.abs());
    let ends = [settled(at, &low, &first)?, settled(at, &high, &last)?];
    let middle = |of: fn(&SweepPoint) -> f64| 0.5 * (of(&ends[0]) + of(&ends[1]));
    let (value, width) = (middle(|point| point.value), (ends[1].value - ends[0].value).abs());
    let asked = middle(|point| point.asked);
    Ok((Change { value, width, asked, state: high.state.clone(), unstable, frequency }, high))
}

/// The point nearest to `edge`, on the way to `end`, at which errors leave as much open as there; `edge`
/// where there is none close by.
fn settled(at: At, edge: &SweepPoint, end: &SweepPoint) -> Result<SweepPoint, LinearError> {
    let open = |part: &Part| (part.unstable(), not_decaying(part), part.chains.len());
    let way = end.asked - edge.asked;
    for near in NEAR {
        let step = near * (edge.asked.abs() + end.asked.abs());
        if open(&edge.part) == open(&end.part) || step >= way.abs() {
            break;
        }
        let there = at(edge.asked + step.copysign(way))?;
        if open(&there.part) == open(&end.part) {
            let [_, there] = bisect(at, edge.clone(), there, |part| usize::from(open(part) == open(&end.part)))?;
            return Ok(there);
        }
    }
    Ok(edge.clone())
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
    count: impl Fn(&Part) -> usize,
) -> Result<[SweepPoint; 2], LinearError> {
    let limit = LAST_DIGITS * (low.asked.abs() + high.asked.abs());
    while (high.asked - low.asked).abs() > limit {
        let middle = at(0.5 * (low.asked + high.asked))?;
        if count(&middle.part) == count(&low.part) { low = middle } else { high = middle }
    }
    Ok([low, high])
}
