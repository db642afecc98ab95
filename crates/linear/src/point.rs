//! Rates and their Jacobian at one point of a motion.

use equations::{Compiled, Equations, EvaluationFailure, Role};
use integrate::Method;
use motion::{Choice, Prepared, Setting, Settings, SolveError, derive_at, formulation_in, prepare};
use nalgebra::DMatrix;

use crate::LinearError;
use crate::limits::ROUNDINGS;
use crate::weyl::Weyl;

/// Compiled equations and a point `(t, y)`.
pub(crate) struct Point {
    pub(crate) equations: Equations,
    pub(crate) compiled: Compiled,
    pub(crate) t: f64,
    pub(crate) y: Vec<f64>,
}

/// Roles of coordinates, and of velocities or what replaces them.
pub(crate) const COORDINATES: [Role; 3] = [Role::Position, Role::DisplacementParameter, Role::Memory];
pub(crate) const VELOCITIES: [Role; 3] = [Role::Velocity, Role::QuasiVelocity, Role::ParameterRate];
/// Number of points near it.
const SAMPLES: usize = 3;
/// How far they are, in parts of the states or of 1; 0: the point itself.
const APART: [f64; 9] = [1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-15, 0.0];
/// An entry has to exceed, by this factor, what the last digits of the states change it by.
const DIGITS: f64 = 100.0;
/// Where the sum of terms behind an entry exceeds this many times the entry, its round-off counts as noise.
const CANCELLED: f64 = 1e4;

impl Point {
    /// The equations at a point, compiled for it.
    pub(crate) fn of(equations: Equations, t: f64, y: Vec<f64>) -> Result<Point, LinearError> {
        let compile = || Compiled::plain(&equations)?.with_jacobian(&equations);
        let compiled = compile().map_err(SolveError::from)?;
        Ok(Point { equations, compiled, t, y })
    }

    pub(crate) fn start(setting: Setting, choice: &Choice) -> Result<Point, LinearError> {
        // an implicit method: the Jacobian is compiled, and no Taylor series
        let settings = Settings { method: Some(Method::Radau5), plain: true, ..Settings::default() };
        let choice = in_quasi_velocities(setting, choice);
        let equations = derive_at(setting.system, setting.start, &choice)?;
        let prepared = prepare(setting, equations, &choice.constants, &settings)?;
        let y = prepared.start_without_round_off();
        let Prepared { equations, compiled, t, .. } = prepared;
        Ok(Point { equations, compiled, t, y })
    }

    /// `F(t, y)`.
    pub(crate) fn rates(&mut self, y: &[f64]) -> Result<Vec<f64>, LinearError> {
        let mut rates = vec![0.0; y.len()];
        let found = self.compiled.rates(self.t, y, &mut rates);
        self.finite(found, &rates)?;
        Ok(rates)
    }

    /// `∂F/∂y`.
    pub(crate) fn jacobian(&mut self, y: &[f64]) -> Result<DMatrix<f64>, LinearError> {
        let n = y.len();
        let mut entries = vec![0.0; n * n];
        let found = self.compiled.jacobian(self.t, y, &mut entries);
        self.finite(found, &entries)?;
        Ok(DMatrix::from_row_slice(n, n, &entries))
    }

    fn finite(&self, found: Result<(), EvaluationFailure>, values: &[f64]) -> Result<(), LinearError> {
        found.map_err(at(self.t))?;
        if values.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(LinearError::NotFinite { t: self.t }) }
    }

    /// Errors of the entries of the Jacobian at `y`: their change with the last digits of `y`, and round-off
    /// of the sums of terms behind them.
    pub(crate) fn noise(&mut self, y: &[f64], jacobian: &DMatrix<f64>) -> Result<DMatrix<f64>, LinearError> {
        let mut random = Weyl::default();
        let mut noise = DMatrix::zeros(y.len(), y.len());
        for _ in 0..SAMPLES {
            let y: Vec<f64> = y.iter().map(|x| x * (1.0 + 4.0 * f64::EPSILON * random.number())).collect();
            noise = noise.sup(&(self.jacobian(&y)? - jacobian).abs());
        }
        let terms = self.terms_of_jacobian(y)?;
        Ok(noise.zip_zip_map(jacobian, &terms, |noise, entry, terms| {
            let is_cancelled = entry != 0.0 && terms > CANCELLED * entry.abs();
            let digits = if is_cancelled { f64::EPSILON * terms } else { 0.0 };
            let all = if entry.abs() <= ROUNDINGS * f64::EPSILON * terms { entry.abs() } else { 0.0 };
            noise.max(digits).max(all)
        }))
    }

    /// The sum of terms behind each entry of the Jacobian at `y`.
    fn terms_of_jacobian(&mut self, y: &[f64]) -> Result<DMatrix<f64>, LinearError> {
        let terms = self.compiled.terms_of_jacobian(self.t, y).map_err(at(self.t))?;
        Ok(DMatrix::from_row_slice(y.len(), y.len(), &terms))
    }

    /// Places of the states in these roles.
    pub(crate) fn places(&self, roles: &[Role]) -> Vec<usize> {
        (0..self.y.len()).filter(|&i| roles.contains(&self.equations.states[i].role)).collect()
    }

    /// The coordinates on which no rate depends but those of other such coordinates, by place.
    pub(crate) fn carried(&mut self) -> Result<Vec<usize>, LinearError> {
        let coupled = self.dependences()?;
        let coordinates = self.places(&COORDINATES);
        let mut left: Vec<usize> = (0..self.y.len()).collect();
        loop {
            let free = |&j: &usize| left.iter().all(|&i| !coupled[(i, j)]);
            match left.iter().copied().find(|j| coordinates.contains(j) && free(j)) {
                Some(j) => left.retain(|&i| i != j),
                None => return Ok((0..self.y.len()).filter(|j| !left.contains(j)).collect()),
            }
        }
    }

    /// How much is added up to each rate at the point.
    pub(crate) fn terms(&mut self) -> Result<Vec<f64>, LinearError> {
        self.compiled.terms_of_rates(self.t, &self.y).map_err(at(self.t))
    }

    /// Which rates depend on which states, at random points near by: a trap of a micrometre is not seen from
    /// a tenth of a metre.
    fn dependences(&mut self) -> Result<DMatrix<bool>, LinearError> {
        let n = self.y.len();
        let mut random = Weyl::default();
        let mut coupled = DMatrix::from_element(n, n, false);
        for apart in APART.iter().flat_map(|apart| [apart; SAMPLES]) {
            let y: Vec<f64> = self.y.iter().map(|x| x + apart * x.abs().max(1.0) * random.number()).collect();
            let Ok(jacobian) = self.jacobian(&y) else { continue };
            let entries = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let is_new = |&at: &(usize, usize)| !coupled[at] && jacobian[at] != 0.0;
            let new: Vec<(usize, usize)> = entries.filter(is_new).collect();
            // noise takes Jacobians of its own, and has a say in what is new only
            if new.is_empty() {
                continue;
            }
            let Ok(noise) = self.noise(&y, &jacobian) else { continue };
            for at in new {
                coupled[at] = jacobian[at].abs() > DIGITS * noise[at];
            }
        }
        Ok(coupled)
    }
}

/// What failed at a time, as an error.
pub(crate) fn at(t: f64) -> impl FnOnce(EvaluationFailure) -> LinearError {
    move |failure| LinearError::Evaluation { t, failure }
}

/// The form of `choice` in quasi-velocities, where it can be derived; itself elsewhere.
pub(crate) fn in_quasi_velocities(setting: Setting, choice: &Choice) -> Choice {
    let own = choice.clone();
    let Some((form, _)) = formulation_in("quasi-velocities", choice.formulation) else { return own };
    if setting.system.constraints.is_empty() || !setting.system.constraints_linear_in_velocity() {
        return own;
    }
    Choice { formulation: form, ..own }
}
