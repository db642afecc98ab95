//! A motion computed by two methods, the one that is kept at two tolerances.

use equations::{Dynamics, Equations, Real};
use mechanics::{State, System};

use crate::metric::{Metric, Point};
use crate::start::{Start, start};
use crate::taylor::Taylor;
use crate::{DoubleDouble, ReferenceError, extrapolation};

/// The motion that is asked for.
#[derive(Clone, Copy)]
pub struct Question<'a> {
    /// The system.
    pub system: &'a System,
    /// `(t₀, q₀, v₀)`, taken as exact; see [`reference()`] for what becomes of `v₀`.
    pub start: &'a State,
    /// The equations of motion.
    pub equations: &'a Equations,
    /// Values of the free constants, taken as exact.
    pub constants: &'a [f64],
}

/// Largest distances between the runs behind a reference, `√|Δqᵀ M Δq|`: the kinetic metric.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Extrapolation and Taylor series, both at the tighter tolerance.
    pub methods: f64,
    /// Taylor series at two tolerances.
    pub taylor: f64,
}

/// A motion at some times, with a known error.
#[derive(Clone, Debug)]
pub struct Reference<T = DoubleDouble> {
    /// Times, in order.
    pub times: Vec<f64>,
    /// The motion there, by the Taylor series at the tighter tolerance.
    pub points: Vec<Point<T>>,
    /// Its doubt at each time, in the kinetic metric: the distance from the other method or the looser
    /// tolerance, the larger one.
    pub errors: Vec<f64>,
    /// The largest distances behind that.
    pub agreement: Agreement,
    /// Largest `|fᵢ|` at the points: no run is projected onto the constraint.
    pub constraint_residual: f64,
    pub(crate) metric: Vec<Vec<f64>>,
}

impl<T: Real> Reference<T> {
    /// Largest of [`Reference::errors`].
    pub fn error(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }

    /// `√|Δqᵀ M Δq|` between the coordinates `q` and the reference at the time of index `i`, with `M` there:
    /// the error of a run that claims `q`. The difference is taken in the wide type.
    ///
    /// # Panics
    /// If there is no such time, or `q` has another length than the coordinates.
    pub fn distance(&self, i: usize, q: &[f64]) -> f64 {
        assert_eq!(q.len(), self.points[i].coordinates.len(), "coordinates");
        self.distance_at(i, q.iter().map(|&x| T::from_f64(x)))
    }

    /// Largest distance `√|Δqᵀ M Δq|` from another reference at the same times, say in another form.
    ///
    /// # Panics
    /// If the times differ.
    pub fn gap(&self, other: &Self) -> f64 {
        assert_eq!(self.times, other.times, "times");
        let at = |i: usize| self.distance_at(i, other.points[i].coordinates.iter().copied());
        (0..self.times.len()).map(at).fold(0.0, f64::max)
    }

    fn distance_at(&self, i: usize, q: impl Iterator<Item = T>) -> f64 {
        let difference: Vec<f64> = q.zip(&self.points[i].coordinates).map(|(x, &r)| (x - r).to_f64()).collect();
        crate::metric::length(&self.metric[i], &difference)
    }
}

/// Tolerance of the first run over the accuracy asked for, and of the second ones over the first.
const FIRST: f64 = 1e-5;
const TIGHTER: f64 = 1e-2;

/// The tightest tolerance over the spacing of the numbers.
const LEAST_SPACINGS: f64 = 8.0;

/// How often a tighter tolerance is tried.
const TRIES: usize = 3;

/// The motion at `times` with an error of at most `accuracy` (kinetic metric) in double-double arithmetic.
///
/// Two methods: Taylor series of rates and residuals, at two tolerances, and at the tighter one
/// Gragg–Bulirsch–Stoer extrapolation over tapes with a linear solve per evaluation. They share start, tapes,
/// the solution of one instant and the number type, not how they go from time to time.
/// [`Reference::errors`] is how far the kept run,
/// Taylor series at the tighter tolerance, is from the other method and from the looser tolerance. While that
/// is over `accuracy`, tolerances become tighter, three times at most.
///
/// Times, parameters, constants and `q₀` are the given `f64`, exactly (0.4 is not 2/5), as for a run in
/// `f64`. The velocity at the start is nearest to `v₀` with `f = 0` in the kinetic metric, to the last wide
/// digit: what a run in `f64` projects to except for rounding. Rounding its own start is part of a run's
/// error.
///
/// ```
/// use mechanics::State;
/// use reference::{Question, reference};
/// use symbolic::Graph;
/// // x'' = −x from x = 1 is the cosine
/// let mut system = mechanics::System::new(Graph::new(), &[("x", "m")]);
/// system.lagrangian = system.expression("(x'^2 - x^2)/2")?;
/// let g = &system.graph;
/// let (x, v) = (system.coordinates[0].position, system.coordinates[0].velocity);
/// let mut equations = equations::Equations::new("by hand", &system);
/// equations.add_positions_and_velocities(&system);
/// equations.states[1].rate = g.neg(g.variable(x));
/// equations.coordinates = vec![g.variable(x)];
/// equations.velocities = vec![g.variable(v)];
/// equations.graph = g.clone();
///
/// let start = State { t: 0.0, q: vec![1.0], v: vec![0.0] };
/// let question = Question { system: &system, start: &start, equations: &equations, constants: &[] };
/// let motion = reference(&question, &[1.0, 2.0], 1e-20)?;
/// use symbolic::Scalar;
/// let right = reference::DoubleDouble::from_f64(2.0).cos();
/// assert!(motion.error() < 1e-20);
/// assert!(reference::Entry::size(motion.points[1].coordinates[0] - right) < 1e-25);
/// assert!(motion.distance(1, &[2.0_f64.cos()]) < 1e-16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReferenceError`]; [`ReferenceError::NotReached`] where number type or methods miss the accuracy.
pub fn reference(question: &Question, times: &[f64], accuracy: f64) -> Result<Reference, ReferenceError> {
    reference_in(question, times, accuracy)
}

/// [`reference()`] in any wide type.
///
/// # Errors
/// As [`reference()`].
pub fn reference_in<T: Real>(
    question: &Question,
    times: &[f64],
    accuracy: f64,
) -> Result<Reference<T>, ReferenceError> {
    let runs = Runs::new(question, times)?;
    let tightest = LEAST_SPACINGS * T::EPSILON;
    let mut tolerance = (accuracy * FIRST).max(tightest / TIGHTER);
    let mut looser = runs.taylor(tolerance)?;
    let (mut error, mut next) = (f64::INFINITY, TIGHTER);
    for _ in 0..TRIES {
        tolerance = (tolerance * next).max(tightest);
        let tighter = runs.taylor(tolerance)?;
        let found = runs.compared(&looser, &tighter, &runs.extrapolation(tolerance)?)?;
        if found.error() <= accuracy {
            return Ok(found);
        }
        error = error.min(found.error());
        if tolerance == tightest {
            break;
        }
        // errors go with the tolerance
        next = (0.1 * accuracy / found.error()).clamp(1e-4, 0.1);
        looser = tighter;
    }
    Err(ReferenceError::NotReached { error, accuracy, epsilon: T::EPSILON })
}

/// Called at each of the times, with the state there.
type Reached<'a, T> = &'a mut dyn FnMut(&mut Dynamics<T>, f64, &[T]) -> Result<(), ReferenceError>;

/// What all runs share.
struct Runs<'a, T> {
    question: &'a Question<'a>,
    times: &'a [f64],
    start: Start<T>,
    /// The equations with parameters as constants behind the free ones, and the values of all.
    equations: Equations,
    constants: Vec<T>,
}

impl<'a, T: Real> Runs<'a, T> {
    fn new(question: &'a Question, times: &'a [f64]) -> Result<Self, ReferenceError> {
        let Question { system, start: state, equations, constants } = *question;
        let (found, expected) = (constants.len(), equations.free_constants.len());
        if found != expected {
            return Err(ReferenceError::Constants { found, expected });
        }
        let mut before = state.t;
        for &time in times {
            if !(time >= before && time.is_finite()) {
                return Err(ReferenceError::Times { time, start: state.t });
            }
            before = time;
        }
        let (free, parameters) = equations.free_parameters();
        let constants: Vec<T> = constants.iter().chain(&parameters).map(|&x| T::from_f64(x)).collect();
        Ok(Runs { start: start(system, state, &free, &constants, found)?, question, times, equations: free, constants })
    }

    /// The equations, ready at the start.
    fn instant(&self) -> Result<Dynamics<T>, ReferenceError> {
        let mut instant = Dynamics::new(&self.equations)?;
        instant.set_constants(&self.constants);
        if !self.start.guess.is_empty() {
            instant.set_guess(&self.start.guess);
        }
        Ok(instant)
    }

    fn taylor(&self, tolerance: f64) -> Result<Vec<Point<T>>, ReferenceError> {
        let mut instant = self.instant()?;
        let mut taylor = Taylor::new(&self.equations, tolerance)?;
        self.points(|start, reached| taylor.integrate(&mut instant, start, self.times, reached))
    }

    fn extrapolation(&self, tolerance: f64) -> Result<Vec<Point<T>>, ReferenceError> {
        let mut instant = self.instant()?;
        self.points(|start, reached| extrapolation::integrate(&mut instant, start, self.times, tolerance, reached))
    }

    /// Results of a method at each time.
    fn points(
        &self,
        method: impl FnOnce((f64, &[T]), Reached<T>) -> Result<(), ReferenceError>,
    ) -> Result<Vec<Point<T>>, ReferenceError> {
        let (n, multipliers) = (self.equations.coordinates.len(), self.equations.multipliers.len());
        let mut points = Vec::new();
        method((self.question.start.t, &self.start.states), &mut |instant, t, y| {
            let time = T::from_f64(t);
            instant.settle(time, y).map_err(ReferenceError::at(time))?;
            let values = instant.outputs();
            points.push(Point {
                coordinates: values[..n].to_vec(),
                velocities: values[n..2 * n].to_vec(),
                multipliers: values[2 * n..][..multipliers].to_vec(),
                states: y.to_vec(),
            });
            Ok(())
        })?;
        Ok(points)
    }

    /// The tighter runs, compared with each other and with the looser one.
    fn compared(
        &self,
        looser: &[Point<T>],
        tighter: &[Point<T>],
        extrapolation: &[Point<T>],
    ) -> Result<Reference<T>, ReferenceError> {
        let mut metric: Metric<T> = Metric::new(self.question.system)?;
        let mut agreement = Agreement::default();
        let (mut errors, mut masses, mut constraint_residual) = (Vec::new(), Vec::new(), 0.0_f64);
        for (i, point) in tighter.iter().enumerate() {
            metric.load(T::from_f64(self.times[i]), point);
            constraint_residual = constraint_residual.max(metric.constraint_residual());
            let methods = metric.distance(point, &extrapolation[i]);
            let taylor = metric.distance(point, &looser[i]);
            agreement.methods = agreement.methods.max(methods);
            agreement.taylor = agreement.taylor.max(taylor);
            errors.push(methods.max(taylor));
            masses.push(metric.mass());
        }
        Ok(Reference {
            times: self.times.to_vec(),
            points: tighter.to_vec(),
            errors,
            agreement,
            constraint_residual,
            metric: masses,
        })
    }
}
