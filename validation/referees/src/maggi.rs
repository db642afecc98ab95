//! Chetaev's motion by Maggi's equations: no multipliers, no bordered matrix of the multiplier method.
//!
//! With `M = ∂²L/∂v²` (n×n), `F = L_q − L_vq v − L_vt + Q` (n), `A = ∂f/∂v` (h×n) and `γ = f_q v + f_t` (h),
//! d'Alembert's principle with Chetaev's condition and the constraint differentiated once are
//!
//! ```text
//! δq · (M a − F) = 0   for every δq with A δq = 0 ,      A a + γ = 0 .
//! ```
//!
//! Let the columns of `N` (n×m, m = n − h) be a basis of `ker A`. Then `δq = N ε` with `ε` free, and
//!
//! ```text
//! [ NᵀM ]       [ NᵀF ]
//! [  A  ] a  =  [ −γ  ]          n equations for the n accelerations .
//! ```
//!
//! `N` is not derived but computed: the last m columns of the complete orthogonal factor of `Aᵀ`. The first m
//! rows are Maggi's equations (1896). `f` may be nonlinear in `v`, and `M` may be singular: only the stacked
//! matrix has to be regular, that is `NᵀMN`.
//!
//! Scaling: each row of `A` is divided by its length, the rows `NᵀM` together by the largest entry of `M`. So
//! the factors with which constraints and `L` are written do not matter; the units of the coordinates do.
//!
//! Source: J. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, AMS 1972, chapter III.

use mechanics::{State, System};
use nalgebra::{ColPivQR, DMatrix, DVector, Dyn};
use symbolic::{Evaluator, Expr, Symbol};

mod error;
mod motion;

pub use error::MaggiError;
pub use motion::Motion;

/// Smallest over largest diagonal entry of a pivoted QR factorization; under it a matrix counts as singular.
pub const PIVOT_LIMIT: f64 = 1e-13;

/// How far accelerations are from Maggi's equations ([`Maggi::residual`]). Both parts are pure numbers ≥ 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// `|Nᵀ(M a − F)| / (|M| (1 + |a|) + |F|)`, Euclidean (Frobenius) norms.
    pub dynamics: f64,
    /// Largest `|A_i a + γ_i| / (|A_i| (1 + |a|) + |γ_i|)` over the constraints.
    pub constraint: f64,
}

impl Residual {
    /// The larger of the two parts.
    pub fn largest(self) -> f64 {
        self.dynamics.max(self.constraint)
    }
}

/// One system, differentiated and compiled; the referee. Clone it for another thread.
///
/// ```
/// use referees::maggi::Maggi;
/// let scene = scene::Scene::parse("sledge", include_str!("../../../crates/scene/scenes/sledge.toml"))?;
/// let mut maggi = Maggi::new(&scene.system)?;
/// let mut motion = maggi.solve(&scene.start, 2.0, 1e-11)?;
/// let u = |t: f64| 0.5 + 9.81 * 0.4_f64.sin() / 1.1 * ((0.3 + 1.1 * t).sin() - 0.3_f64.sin());
/// assert!((motion.state(2.0)?.v[0] - u(2.0) * 2.5_f64.cos()).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Maggi {
    n: usize,
    h: usize,
    /// `M, F, A, γ, f` from `t, q, v`.
    instant: Evaluator<f64>,
}

/// A pivoted QR factorization.
type Factors = ColPivQR<f64, Dyn, Dyn>;

/// `M, F, A, γ, f` at one instant; matrices row-major.
#[derive(Clone, Copy)]
struct Instant<'a> {
    t: f64,
    mass: &'a [f64],
    force: &'a [f64],
    jacobian: &'a [f64],
    gamma: &'a [f64],
    constraint: &'a [f64],
}

impl Maggi {
    /// Differentiates and compiles `system`, with its parameters as they are now.
    ///
    /// # Errors
    /// [`MaggiError::NoFreedom`] unless `h < n`; [`MaggiError::Compile`].
    pub fn new(system: &System) -> Result<Self, MaggiError> {
        let system = system.clone();
        let (n, h) = (system.dimension(), system.constraints.len());
        if h >= n {
            return Err(MaggiError::NoFreedom { found: h, limit: n });
        }
        let g = &system.graph;
        let (positions, velocities) = (system.positions(), system.velocities());
        let q_rates: Vec<(Symbol, Expr)> = positions.iter().copied().zip(g.variables(&velocities)).collect();
        // d/dt at fixed velocities: e_q v + e_t.
        let drift = |e: Expr| {
            let along = q_rates.iter().map(|&(q, v)| g.mul(g.derivative(e, q), v));
            let terms: Vec<Expr> = along.chain([g.derivative(e, system.time)]).collect();
            g.sum(&terms)
        };
        let momenta = g.gradient(system.lagrangian, &velocities);
        let mut outputs = Vec::with_capacity(n * n + n + h * n + 2 * h);
        outputs.extend(momenta.iter().flat_map(|&p| g.gradient(p, &velocities)));
        outputs.extend((0..n).map(|i| {
            let applied = g.add(g.derivative(system.lagrangian, positions[i]), system.forces[i]);
            g.sub(applied, drift(momenta[i]))
        }));
        outputs.extend(system.constraints.iter().flat_map(|&f| g.gradient(f, &velocities)));
        outputs.extend(system.constraints.iter().map(|&f| drift(f)));
        outputs.extend(&system.constraints);
        let inputs = [&[system.time][..], &positions, &velocities].concat();
        Ok(Maggi { n, h, instant: system.evaluator(&inputs, &outputs)? })
    }

    /// The accelerations `a` (n) of Chetaev's motion at `(t, q, v)`.
    ///
    /// `(q, v)` need not lie on the constraint: what is solved is `A a + γ = 0`, not `f = 0`.
    ///
    /// # Errors
    /// [`MaggiError`]s `Length`, `NotFinite`, `DependentConstraints`, `Singular`.
    pub fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<Vec<f64>, MaggiError> {
        let mut a = vec![0.0; self.n];
        self.write_accelerations(t, q, v, &mut a)?;
        Ok(a)
    }

    /// [`Maggi::accelerations`], written into `a`.
    ///
    /// # Errors
    /// As [`Maggi::accelerations`]; `a` is then untouched.
    pub fn write_accelerations(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> Result<(), MaggiError> {
        self.check_length("accelerations", a)?;
        let (n, m) = (self.n, self.n - self.h);
        let instant = self.instant(t, q, v)?;
        let (complement, lengths) = instant.factor_jacobian(n)?;
        // The last m rows of Qᵀ [M F] are [NᵀM NᵀF]; M is symmetric, so that its rows are its columns.
        let mut projected = DMatrix::from_iterator(n, n + 1, instant.mass.iter().chain(instant.force).copied());
        complement.q_tr_mul(&mut projected);
        let mass_scale = instant.mass_scale()?;
        let scale = |i: usize| if i < m { 1.0 / mass_scale } else { 1.0 / lengths[i - m] };
        let h = n - m;
        let stacked = DMatrix::from_fn(n, n, |i, j| {
            scale(i) * if i < m { projected[(h + i, j)] } else { instant.jacobian[(i - m) * n + j] }
        });
        let right =
            DVector::from_fn(n, |i, _| scale(i) * if i < m { projected[(h + i, n)] } else { -instant.gamma[i - m] });
        let solution = solve_square(t, stacked, right)?;
        a.copy_from_slice(solution.as_slice());
        Ok(())
    }

    /// How far the accelerations `a` (n) are from Maggi's equations at `(t, q, v)`; each part is relative to
    /// its terms, and absolute where the accelerations are below 1.
    ///
    /// # Errors
    /// [`MaggiError::Length`], [`MaggiError::NotFinite`], [`MaggiError::DependentConstraints`].
    pub fn residual(&mut self, t: f64, q: &[f64], v: &[f64], a: &[f64]) -> Result<Residual, MaggiError> {
        self.check_length("accelerations", a)?;
        check_finite("an acceleration", t, a)?;
        let n = self.n;
        let instant = self.instant(t, q, v)?;
        let (complement, lengths) = instant.factor_jacobian(n)?;
        let rows = instant.mass.chunks_exact(n).zip(instant.force);
        let mut unbalanced = DMatrix::from_iterator(n, 1, rows.map(|(row, f)| dot(row, a) - f));
        complement.q_tr_mul(&mut unbalanced);
        let reach = 1.0 + length(a);
        let dynamics = length(&unbalanced.as_slice()[lengths.len()..]);
        let scale = length(instant.mass) * reach + length(instant.force);
        let rows = instant.jacobian.chunks_exact(n).zip(instant.gamma).zip(lengths);
        let constraint = rows
            .map(|((row, gamma), length)| (dot(row, a) + gamma).abs() / (length * reach + gamma.abs()))
            .fold(0.0, f64::max);
        Ok(Residual { dynamics: if dynamics == 0.0 { 0.0 } else { dynamics / scale }, constraint })
    }

    /// Distance of `(t, q, v)` from the constraint: the largest `|f_i| / (|A_i| (1 + |v|))`; 0 without any.
    ///
    /// # Errors
    /// [`MaggiError`]s `Length`, `NotFinite`; `DependentConstraints` where a row of `A` is zero.
    pub fn constraint_residual(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<f64, MaggiError> {
        let n = self.n;
        let instant = self.instant(t, q, v)?;
        let lengths = row_lengths(t, instant.jacobian, n)?;
        let reach = 1.0 + length(v);
        Ok(instant.constraint.iter().zip(lengths).map(|(f, length)| f.abs() / (length * reach)).fold(0.0, f64::max))
    }

    /// The motion from `start` to `end`, forwards or backwards, by [`integrate::Method::Dop853`], both
    /// tolerances `tolerance`, without projection: `f` stays zero as well as the integration is accurate.
    ///
    /// How the run ended is [`Motion::ending`], not an error.
    ///
    /// # Errors
    /// Those of [`Maggi::accelerations`] at the start; [`MaggiError::OffConstraint`]; [`MaggiError::Call`]
    /// for a tolerance or an end that makes no sense.
    pub fn solve(&mut self, start: &State, end: f64, tolerance: f64) -> Result<Motion, MaggiError> {
        motion::solve(self, start, end, tolerance)
    }

    /// [`Maggi::solve`] at two tolerances, so that the difference tells of the error.
    ///
    /// # Errors
    /// As [`Maggi::solve`].
    pub fn solve_twice(&mut self, start: &State, end: f64, tolerances: [f64; 2]) -> Result<[Motion; 2], MaggiError> {
        Ok([self.solve(start, end, tolerances[0])?, self.solve(start, end, tolerances[1])?])
    }

    fn instant(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<Instant<'_>, MaggiError> {
        self.check_length("positions", q)?;
        self.check_length("velocities", v)?;
        let (n, h) = (self.n, self.h);
        let outputs = self.instant.evaluate(&[&[t][..], q, v].concat());
        let (mass, outputs) = outputs.split_at(n * n);
        let (force, outputs) = outputs.split_at(n);
        let (jacobian, outputs) = outputs.split_at(h * n);
        let (gamma, constraint) = outputs.split_at(h);
        check_finite("an entry of the mass matrix", t, mass)?;
        check_finite("a force", t, force)?;
        check_finite("an entry of the constraint Jacobian", t, jacobian)?;
        check_finite("a drift of a constraint", t, gamma)?;
        check_finite("a constraint", t, constraint)?;
        Ok(Instant { t, mass, force, jacobian, gamma, constraint })
    }

    fn check_length(&self, what: &'static str, values: &[f64]) -> Result<(), MaggiError> {
        let (found, expected) = (values.len(), self.n);
        if found == expected { Ok(()) } else { Err(MaggiError::Length { what, found, expected }) }
    }
}

impl Instant<'_> {
    /// The largest entry of `M`, which must not be zero.
    fn mass_scale(&self) -> Result<f64, MaggiError> {
        let largest = self.mass.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if largest > 0.0 {
            return Ok(largest);
        }
        Err(MaggiError::Singular { t: self.t, found: 0.0, limit: PIVOT_LIMIT })
    }

    /// The factors `Q R` of `Aᵀ` with columns of length 1, and the lengths of the rows of `A`. The last m
    /// columns of the complete `Q` (which `q_tr_mul` applies) are an orthonormal basis of `ker A`.
    fn factor_jacobian(&self, n: usize) -> Result<(Factors, Vec<f64>), MaggiError> {
        let lengths = row_lengths(self.t, self.jacobian, n)?;
        let transposed = DMatrix::from_fn(n, lengths.len(), |j, i| self.jacobian[i * n + j] / lengths[i]);
        let factors = ColPivQR::new(transposed);
        let found = pivot_ratio(&factors);
        if found < PIVOT_LIMIT {
            return Err(MaggiError::DependentConstraints { t: self.t, found, limit: PIVOT_LIMIT });
        }
        Ok((factors, lengths))
    }
}

/// Lengths of the rows of `A`, none of them zero.
fn row_lengths(t: f64, jacobian: &[f64], n: usize) -> Result<Vec<f64>, MaggiError> {
    let lengths: Vec<f64> = jacobian.chunks_exact(n).map(length).collect();
    if lengths.contains(&0.0) {
        return Err(MaggiError::DependentConstraints { t, found: 0.0, limit: PIVOT_LIMIT });
    }
    Ok(lengths)
}

/// Smallest over largest diagonal entry of `R`, for matrices scaled to a natural size of 1: the largest
/// counts as 1 at least, so that a matrix of nothing but round-off is singular. 1 for an empty matrix.
fn pivot_ratio(factors: &Factors) -> f64 {
    let diagonal = factors.r().diagonal();
    let largest = diagonal.iter().fold(1.0_f64, |largest, &x| largest.max(x));
    diagonal.iter().fold(1.0, |ratio, &x| ratio.min(x / largest))
}

/// `matrix⁻¹ right`, scaled as for [`pivot_ratio`], by pivoted QR and one step of iterative refinement.
fn solve_square(t: f64, matrix: DMatrix<f64>, right: DVector<f64>) -> Result<DVector<f64>, MaggiError> {
    let factors = ColPivQR::new(matrix.clone());
    let found = pivot_ratio(&factors);
    let mut x = right.clone();
    if found < PIVOT_LIMIT || !factors.solve_mut(&mut x) {
        return Err(MaggiError::Singular { t, found, limit: PIVOT_LIMIT });
    }
    let mut correction = right;
    correction.gemv(-1.0, &matrix, &x, 1.0);
    if factors.solve_mut(&mut correction) {
        x += correction;
    }
    check_finite("an acceleration", t, x.as_slice())?;
    Ok(x)
}

fn check_finite(what: &'static str, t: f64, values: &[f64]) -> Result<(), MaggiError> {
    match values.iter().find(|x| !x.is_finite()) {
        None => Ok(()),
        Some(&found) => Err(MaggiError::NotFinite { what, found, t }),
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn length(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
