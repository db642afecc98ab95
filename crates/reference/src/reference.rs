//! A motion computed by two methods, each at two tolerances.

use mechanics::{Equations, State, System};

use crate::instant::{Instant, Point};
use crate::metric::Metric;
use crate::start::{Start, start};
use crate::taylor::Taylor;
use crate::{DoubleDouble, ReferenceError, Wide, extrapolation};

/// The motion that is asked for.
#[derive(Clone, Copy)]
pub struct Question<'a> {
    /// The system.
    pub system: &'a System,
    /// `(t₀, q₀, v₀)`, taken as exact; see [`reference`] for what becomes of `v₀`.
    pub start: &'a State,
    /// The equations of motion.
    pub equations: &'a Equations,
    /// Values of the free constants, taken as exact.
    pub constants: &'a [f64],
}

/// How far two runs are apart at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// `√|Δqᵀ M Δq|`, the kinetic metric.
    pub positions: f64,
    /// `√|Δq̇ᵀ M Δq̇|`.
    pub velocities: f64,
    /// Largest difference of a multiplier or costate.
    pub multipliers: f64,
}

impl Distance {
    fn max(self, other: Distance) -> Distance {
        Distance {
            positions: self.positions.max(other.positions),
            velocities: self.velocities.max(other.velocities),
            multipliers: self.multipliers.max(other.multipliers),
        }
    }
}

/// Largest distances between the runs behind a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Extrapolation and Taylor series, both at the tighter tolerance.
    pub methods: Distance,
    /// Extrapolation at two tolerances.
    pub extrapolation: Distance,
    /// Taylor series at two tolerances.
    pub taylor: Distance,
    /// The tighter tolerance; the other one is 100 times that.
    pub tolerance: f64,
}

/// A motion at some times, with a known error.
#[derive(Clone, Debug)]
pub struct Reference<T = DoubleDouble> {
    /// Times, in order.
    pub times: Vec<f64>,
    /// The motion there, by the Taylor series at the tighter tolerance.
    pub points: Vec<Point<T>>,
    /// What of it is in doubt at each time: the largest distance between two of the four runs.
    pub errors: Vec<Distance>,
    /// Where the largest distances come from.
    pub agreement: Agreement,
    /// Largest `|fᵢ|` at the points: no run is projected onto the constraint.
    pub constraint_residual: f64,
    /// Largest distance of a point from the first one, kinetic metric.
    pub scale: f64,
    metric: Vec<Vec<f64>>,
}

impl<T: Wide> Reference<T> {
    /// Largest of [`Reference::errors`] in the positions, kinetic metric.
    pub fn error(&self) -> f64 {
        self.errors.iter().fold(0.0, |worst, e| worst.max(e.positions))
    }

    /// `√|Δqᵀ M Δq|` between the coordinates `q` and the reference at the time of index `i`, with `M` there: the error of a run that claims `q`. The
    /// difference is taken in the wide type.
    ///
    /// # Panics
    /// If there is no such time, or `q` has another length than the coordinates.
    pub fn distance(&self, i: usize, q: &[f64]) -> f64 {
        let right = &self.points[i].coordinates;
        assert_eq!(q.len(), right.len(), "coordinates");
        let difference: Vec<f64> = q.iter().zip(right).map(|(&x, &r)| (T::from_f64(x) - r).to_f64()).collect();
        crate::metric::length(&self.metric[i], &difference)
    }
}

/// Tolerance of the tighter runs over the accuracy that is asked for; what a failure makes of it; how often.
const TIGHTER: f64 = 1e-7;
const AGAIN: f64 = 1e-2;
const TRIES: usize = 3;

/// Tolerance of the looser runs over that of the tighter.
const LOOSER: f64 = 1e2;

/// The motion at `times` with an error of at most `accuracy` (kinetic metric, relative to the length of the way where that is over 1), in
/// double-double arithmetic.
///
/// Two methods compute it, each at two tolerances: Gragg–Bulirsch–Stoer extrapolation over tapes and a linear solve per evaluation, and a Taylor
/// series of the traced residuals. They share the expressions and the number type, nothing else. [`Reference::errors`] is the largest distance
/// between any two of the four runs.
///
/// Times, parameters, constants and `q₀` are the given `f64`, exactly (0.4 is not 2/5), as they are for a run in `f64`. The velocity at the start is the one
/// with `f = 0` nearest to `v₀` in the kinetic metric, to the last digit of the wide type: what the projection of a run in `f64` would give
/// without rounding. How a run rounds its own start is part of its error.
///
/// ```
/// use mechanics::State;
/// use reference::{Question, reference};
/// use symbolic::Graph;
/// // x'' = −x from x = 1 is the cosine
/// let graph = Graph::new();
/// let mut system = mechanics::System::new(graph, &[("x", "m")]);
/// let g = system.graph.clone();
/// let (x, v) = (system.coordinates[0].position, system.coordinates[0].velocity);
/// let square = |s| g.mul(g.ratio(1, 2), g.powi(g.variable(s), 2));
/// system.lagrangian = g.sub(square(v), square(x));
/// let mut equations = mechanics::Equations::new("by hand", &system);
/// equations.add_positions_and_velocities(&system);
/// equations.states[1].rate = g.neg(g.variable(x));
/// equations.coordinates = vec![g.variable(x)];
/// equations.velocities = vec![g.variable(v)];
/// equations.graph = g.clone();
/// system.graph = g;
///
/// let start = State { t: 0.0, q: vec![1.0], v: vec![0.0] };
/// let question = Question { system: &system, start: &start, equations: &equations, constants: &[] };
/// let motion = reference(&question, &[1.0, 2.0], 1e-20)?;
/// // cos 2 to 30 digits
/// let right = reference::DoubleDouble::sum(-0.4161468365471424, 1.6250325e-17);
/// assert!(motion.error() < 1e-20 && motion.distance(1, &[2.0_f64.cos()]) < 1e-16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReferenceError`]; [`ReferenceError::NotReached`] where the number type or the methods do not give the accuracy.
pub fn reference(question: &Question, times: &[f64], accuracy: f64) -> Result<Reference, ReferenceError> {
    reference_in(question, times, accuracy)
}

/// [`reference`] in any wide type.
///
/// # Errors
/// As [`reference`].
pub fn reference_in<T: Wide>(
    question: &Question,
    times: &[f64],
    accuracy: f64,
) -> Result<Reference<T>, ReferenceError> {
    let runs = Runs::new(question, times)?;
    let mut tolerance = accuracy * TIGHTER;
    let mut best: Option<Reference<T>> = None;
    for _ in 0..TRIES {
        match runs.confirmed(tolerance) {
            Ok(found) if found.error() <= accuracy * found.scale.max(1.0) => return Ok(found),
            Ok(found) if best.as_ref().is_none_or(|b| found.error() < b.error()) => best = Some(found),
            Ok(_) => break,
            Err(error) if best.is_none() => return Err(error),
            Err(_) => break,
        }
        tolerance *= AGAIN;
    }
    let error = best.map_or(f64::NAN, |b| b.error());
    Err(ReferenceError::NotReached { error, accuracy, epsilon: T::EPSILON })
}

/// What all runs share.
struct Runs<'a, T> {
    question: &'a Question<'a>,
    times: &'a [f64],
    start: Start<T>,
}

impl<'a, T: Wide> Runs<'a, T> {
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
        Ok(Runs { start: start(system, state, equations, constants)?, question, times })
    }

    /// The equations, ready at the start.
    fn instant(&self) -> Result<Instant<T>, ReferenceError> {
        let mut instant = Instant::new(self.question.equations, self.question.constants)?;
        instant.set_guess(&self.start.guess);
        Ok(instant)
    }

    fn extrapolation(&self, tolerance: f64) -> Result<Vec<Point<T>>, ReferenceError> {
        let mut points = Vec::with_capacity(self.times.len());
        let start = (self.question.start.t, &self.start.states[..]);
        extrapolation::integrate(&mut self.instant()?, start, self.times, tolerance, |instant, t, y| {
            points.push(instant.point(T::from_f64(t), y)?);
            Ok(())
        })?;
        Ok(points)
    }

    fn taylor(&self, tolerance: f64) -> Result<Vec<Point<T>>, ReferenceError> {
        let mut points = Vec::with_capacity(self.times.len());
        let mut instant = self.instant()?;
        let mut taylor = Taylor::new(self.question.equations, &instant, tolerance)?;
        let start = (self.question.start.t, &self.start.states[..]);
        taylor.integrate(&mut instant, start, self.times, |instant, t, y| {
            points.push(instant.point(T::from_f64(t), y)?);
            Ok(())
        })?;
        Ok(points)
    }

    /// All four runs, compared.
    fn confirmed(&self, tolerance: f64) -> Result<Reference<T>, ReferenceError> {
        let points = self.taylor(tolerance)?;
        let others =
            [self.extrapolation(tolerance)?, self.taylor(tolerance * LOOSER)?, self.extrapolation(tolerance * LOOSER)?];
        let mut metric: Metric<T> = Metric::new(self.question.system)?;
        let mut agreement = Agreement {
            methods: Distance::default(),
            extrapolation: Distance::default(),
            taylor: Distance::default(),
            tolerance,
        };
        let (mut errors, mut masses) = (Vec::new(), Vec::new());
        let (mut constraint_residual, mut scale) = (0.0_f64, 0.0_f64);
        for (i, point) in points.iter().enumerate() {
            metric.load(T::from_f64(self.times[i]), point);
            constraint_residual = constraint_residual.max(metric.constraint_residual());
            scale = scale.max(metric.length(&point.coordinates, &points[0].coordinates));
            let distance = |a: &Point<T>, b: &Point<T>| metric.distance(a, b);
            let [extrapolated, looser, looser_extrapolated] = others.each_ref().map(|run| &run[i]);
            let methods = distance(point, extrapolated);
            let taylor = distance(point, looser);
            let extrapolation = distance(extrapolated, looser_extrapolated);
            let crossed = distance(point, looser_extrapolated).max(distance(extrapolated, looser));
            agreement.methods = agreement.methods.max(methods);
            agreement.taylor = agreement.taylor.max(taylor);
            agreement.extrapolation = agreement.extrapolation.max(extrapolation);
            errors.push(methods.max(taylor).max(extrapolation).max(crossed));
            masses.push(metric.mass());
        }
        Ok(Reference {
            times: self.times.to_vec(),
            points,
            errors,
            agreement,
            constraint_residual,
            scale,
            metric: masses,
        })
    }
}
