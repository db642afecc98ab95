//! The decision in floating point.

use nalgebra::{DMatrix, DVector};

use crate::DecisionError;
use crate::curve::{Curve, Flow};
use crate::family::Family;
use crate::transport::Transport;

/// Gauss nodes a panel, and the least number of panels: at least 256 nodes.
const NODES: usize = 4;
const PANELS: usize = 64;
/// Turns of every pair of columns until they are orthogonal: the sixth changes nothing any more.
const SWEEPS: usize = 10;
/// A mismatch up to this many times its noise is none.
const CERTAIN: f64 = 10.0;
/// What round-off leaves of the rows at best, relative to their size.
const ROUND_OFF: f64 = 1e-14;
/// Noise over this part of the terms that cancel tells nothing: a mismatch below it could be a real one.
const TOO_LOUD: f64 = 1e-5;

/// Where round-off shortens steps: factors of the tolerances, with steps for each; the last spares nothing.
const ATTEMPTS: [(f64, usize); 3] = [(1.0, 3_000), (1e2, 3_000), (1.0, 100_000)];

/// How the decision is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecisionSettings {
    /// Relative tolerance of the looser run.
    pub tolerance: f64,
    /// The tighter run has this part of it.
    pub tighter: f64,
}

impl Default for DecisionSettings {
    fn default() -> Self {
        DecisionSettings { tolerance: 1e-10, tighter: 1e-2 }
    }
}

/// Whether the curve is a motion of the family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Some constants leave no mismatch that stands out from the noise.
    Contained,
    /// None do.
    NotContained,
    /// The noise is too loud to tell.
    Undecided,
}

/// Constants `point + span(directions)`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AffineSet {
    /// The element of least norm.
    pub point: Vec<f64>,
    /// Orthonormal directions; none for a single point, all for every choice.
    pub directions: Vec<Vec<f64>>,
}

impl AffineSet {
    /// Its dimension.
    pub fn dimension(&self) -> usize {
        self.directions.len()
    }

    /// The distance of `constants` from it.
    pub fn distance(&self, constants: &[f64]) -> f64 {
        let mut rest = DVector::from_column_slice(constants) - DVector::from_column_slice(&self.point);
        for direction in &self.directions {
            let direction = DVector::from_column_slice(direction);
            rest -= &direction * direction.dot(&rest);
        }
        rest.norm()
    }
}

/// What was decided, and from which numbers.
///
/// The mismatch of accelerations is `y(t) = O(t) c + y₀(t)` for constants `c`; lengths are
/// `(∫ |y|²_M dt)^{1/2}`, in the unit of `√E/√T`.
#[derive(Clone, Debug)]
pub struct Decision {
    /// The answer.
    pub verdict: Verdict,
    /// The constants of least mismatch: the answer for [`Verdict::Contained`], else the nearest miss.
    pub set: AffineSet,
    /// The least mismatch, ρ.
    pub least: f64,
    /// The mismatch at `c = 0`.
    pub at_zero: f64,
    /// What ρ is known to.
    pub noise: f64,
    /// `(∫ |a|²_M dt)^{1/2}` of the curve: what ρ is compared with for the reader.
    pub acceleration: f64,
    /// Names of the constants.
    pub constants: Vec<String>,
    triangle: DMatrix<f64>,
    rows_noise: f64,
    /// What counts as a size of accelerations: the curve's own, and its speed over the time.
    size: f64,
}

impl Decision {
    /// The mismatch that the constants `c` leave.
    pub fn mismatch_at(&self, constants: &[f64]) -> f64 {
        let mut c = DVector::from_column_slice(constants);
        c = c.push(1.0);
        (&self.triangle * c).norm()
    }

    /// Whether the constants `c` leave no mismatch that stands out from the noise.
    pub fn admits(&self, constants: &[f64]) -> bool {
        let reach = (1.0 + constants.iter().map(|c| c * c).sum::<f64>()).sqrt();
        self.mismatch_at(constants) <= CERTAIN * self.rows_noise * reach
    }

    /// The same question with only the constants `kept` (by their places), the others zero.
    pub fn keeping(&self, kept: &[usize]) -> Decision {
        let last = self.triangle.ncols() - 1;
        let columns: Vec<usize> = kept.iter().copied().chain([last]).collect();
        let triangle = compressed(self.triangle.select_columns(&columns));
        let constants = kept.iter().map(|&i| self.constants[i].clone()).collect();
        judge(triangle, self.rows_noise, self.size, self.acceleration, constants)
    }
}

/// Decides whether a curve is a motion of `family` for some choice of the family's constants.
///
/// The same curve comes twice: as well as it is known, and less well; the difference tells the noise. A
/// motion has its two runs; [`decide_flow`] does it for a curve that is integrated here.
///
/// # Errors
/// [`DecisionError`] where curve or constants cannot be followed to the end.
pub fn decide(
    family: &Family,
    tighter: &mut dyn Curve,
    looser: &mut dyn Curve,
    settings: &DecisionSettings,
) -> Result<Decision, DecisionError> {
    let (start, end) = tighter.span();
    let mut fine = Transport::new(family, tighter);
    let mut coarse = Transport::new(family, looser);
    let mut runs = Err(DecisionError::Curve { reason: String::new() });
    for (factor, steps) in ATTEMPTS {
        let tolerance = settings.tolerance * factor;
        runs = fine.run(tolerance * settings.tighter, steps).and_then(|run| Ok((run, coarse.run(tolerance, steps)?)));
        if !matches!(runs, Err(DecisionError::Steps { .. })) {
            break;
        }
    }
    let (fine_run, coarse_run) = runs?;
    let steps = fine_run.as_ref().map_or(0, |run| run.step_times().len());
    let panels = PANELS.max(steps);
    let size = family.constants().len() + 1;
    let mut triangle = DMatrix::zeros(0, size);
    let (mut difference, mut acceleration, mut speed) = (0.0, 0.0, 0.0);
    let width = (end - start) / panels as f64;
    let (nodes, n) = (legendre(), family.shape.coordinates);
    for panel in 0..panels {
        let above = triangle.nrows();
        triangle = triangle.resize_vertically(above + NODES * n, 0.0);
        for (i, (x, weight)) in nodes.into_iter().enumerate() {
            let t = start + width * (panel as f64 + x);
            let root = (weight * width.abs()).sqrt();
            let own = fine.mismatch(fine_run.as_ref(), t)?;
            triangle.rows_mut(above + i * n, n).copy_from(&(&own.rows * root));
            if i == panel % NODES {
                let other = coarse.mismatch(coarse_run.as_ref(), t)?;
                difference += (own.rows - other.rows).norm_squared() * width.abs();
            }
            acceleration += (own.acceleration * root).powi(2);
            speed += (own.speed * root).powi(2);
        }
        triangle = compressed(triangle);
    }
    let size = (acceleration + speed / (end - start).powi(2)).sqrt();
    let rows_noise = difference.sqrt().max(ROUND_OFF * triangle.norm().max(size));
    Ok(judge(triangle, rows_noise, size, acceleration.sqrt(), family.constants().to_vec()))
}

/// [`decide`] for a curve that is integrated beside the transport of the constants.
///
/// # Errors
/// As [`decide`].
pub fn decide_flow(family: &Family, flow: &Flow, settings: &DecisionSettings) -> Result<Decision, DecisionError> {
    decide(family, &mut flow.clone(), &mut flow.clone(), settings)
}

fn judge(triangle: DMatrix<f64>, rows_noise: f64, size: f64, acceleration: f64, constants: Vec<String>) -> Decision {
    let last = triangle.ncols() - 1;
    let goal = -triangle.column(last);
    let matrix = triangle.columns(0, last).into_owned();
    let mut point = DVector::zeros(last);
    let mut directions = Vec::new();
    let (images, preimages) = orthogonal(&matrix);
    for (image, preimage) in images.column_iter().zip(preimages.column_iter()) {
        if image.norm() > CERTAIN * rows_noise {
            point += preimage * (image.dot(&goal) / image.norm_squared());
        } else {
            directions.push(preimage.iter().copied().collect());
        }
    }
    let least = (&matrix * &point - &goal).norm();
    let reach = (1.0 + point.norm_squared()).sqrt();
    let noise = rows_noise * reach;
    let scale = size.max(triangle.norm() * reach);
    let verdict = if least > CERTAIN * noise {
        Verdict::NotContained
    } else if CERTAIN * noise <= TOO_LOUD * scale {
        Verdict::Contained
    } else {
        Verdict::Undecided
    };
    Decision {
        verdict,
        set: AffineSet { point: point.as_slice().to_vec(), directions },
        least,
        at_zero: goal.norm(),
        noise,
        acceleration,
        constants,
        triangle,
        rows_noise,
        size,
    }
}

/// `A V` with orthogonal columns, and the orthogonal `V` (one-sided Jacobi): small columns stay sharp.
fn orthogonal(matrix: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let size = matrix.ncols();
    let (mut images, mut preimages) = (matrix.clone(), DMatrix::identity(size, size));
    for (i, j) in (0..SWEEPS).flat_map(|_| (0..size).flat_map(|i| (0..i).map(move |j| (i, j)))) {
        let (one, two) = (images.column(i), images.column(j));
        let (a, b, c) = (one.norm_squared(), two.norm_squared(), one.dot(&two));
        if c.abs() <= f64::EPSILON * (a * b).sqrt() {
            continue;
        }
        let cotangent = (b - a) / (2.0 * c);
        let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
        let cosine = tangent.hypot(1.0).recip();
        for columns in [&mut images, &mut preimages] {
            for k in 0..columns.nrows() {
                let (x, y) = (columns[(k, i)], columns[(k, j)]);
                columns[(k, i)] = cosine * (x - tangent * y);
                columns[(k, j)] = cosine * (y + tangent * x);
            }
        }
    }
    (images, preimages)
}

/// The triangular factor: the same lengths in at most as many rows as columns.
fn compressed(rows: DMatrix<f64>) -> DMatrix<f64> {
    if rows.nrows() <= rows.ncols() { rows } else { rows.qr().r() }
}

/// Nodes and weights of the Gauss-Legendre rule on [0, 1].
fn legendre() -> [(f64, f64); NODES] {
    let n = NODES as f64;
    std::array::from_fn(|i| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..50 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=NODES {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        ((1.0 - x) / 2.0, 1.0 / ((1.0 - x * x) * slope * slope))
    })
}
