//! The equations of a two-point problem, with their derivatives.

use equations::Outputs;
use integrate::{BoundaryError, Dense, Options, Residuals, Status};
use mechanics::{ConstantsRule, State, System};
use nalgebra::{DMatrix, DVector};
use scene::Scene;

use crate::connect::velocities::Velocities;
use crate::connect::{Aim, own_constant_names};
use crate::direction::Direction;
use crate::variational::{VariationalRun, Which};
use crate::{Choice, Metric, Settings, SolveError, VAKONOMIC, Varying};

/// `r_i(x) = (q_i(t₁; x) − q₁_i)/size_i`, x in units of the problem.
#[derive(Clone)]
pub(super) struct TwoPoint {
    pub(super) system: System,
    pub(super) scene_start: State,
    pub(super) aim: Aim,
    /// Coordinates with their values at the end.
    pub(super) goal: Vec<(usize, f64)>,
    /// Others that follow, where constraints are integrable: what is found has to have them as well.
    pub(super) others: Vec<(usize, f64)>,
    /// Whether every constant gives the same motion, so that none is unknown.
    pub(super) every_constant: bool,
    pub(super) names: Vec<String>,
    pub(super) varying: Varying,
    pub(super) velocities: Velocities,
    pub(super) first_constants: Vec<f64>,
    pub(super) settings: Settings,
    pub(super) units: Vec<f64>,
    pub(super) sizes: Vec<f64>,
    /// Runs so far, and those with derivatives among them.
    pub(super) runs: [usize; 2],
}

impl TwoPoint {
    /// In units of the scene.
    pub(super) fn new(scene: &Scene, choice: &Choice, aim: &Aim, settings: &Settings) -> Result<Self, SolveError> {
        let system = scene.system.clone();
        let refused = |reason: String| Err(SolveError::TwoPoint { reason });
        let known: Vec<&str> = system.coordinates.iter().map(|c| c.name.as_str()).collect();
        let mut goal = Vec::new();
        for (name, value) in &aim.to {
            let Some(i) = known.iter().position(|known| known == name) else {
                return refused(format!("no coordinate `{name}`; there are {}", known.join(", ")));
            };
            if !value.is_finite() {
                return refused(format!("{name} is {value} at the end; it must be finite"));
            }
            if goal.iter().any(|&(other, _)| other == i) {
                return refused(format!("`{name}` is given twice"));
            }
            goal.push((i, *value));
        }
        if !(aim.t > scene.start.t && aim.t.is_finite()) {
            return refused(format!("the end {:?} is not after the start {:?}", aim.t, scene.start.t));
        }
        if aim.starts == 0 {
            return refused("a search from 0 starts finds nothing; give 1 or more".into());
        }
        let mut metric = Metric::new(&system)?;
        let velocities = Velocities::new(scene, &mut metric)?;
        let mut varying = Varying::new(scene, choice, &[], settings)?;
        let rule = match &choice.constants {
            ConstantsRule::Natural { .. } => &ConstantsRule::Zero,
            other => other,
        };
        varying.set(&scene.start, &[], rule, false)?;
        let first_constants = varying.constants().to_vec();
        let mut names: Vec<String> = velocities.free.iter().map(|&i| format!("{}'", known[i])).collect();
        let integrable = || mechanics::integrability(&scene.system.clone(), &scene.start, aim.t);
        let every_constant = choice.formulation == VAKONOMIC
            && goal.len() == system.dimension()
            && integrable().is_ok_and(|found| found.is_integrable());
        let (goal, others) = match every_constant {
            true => goal.into_iter().partition(|(i, _)| velocities.free.contains(i)),
            false => (goal, Vec::new()),
        };
        if !every_constant {
            names.extend(own_constant_names(&varying));
        }
        if names.len() != goal.len() {
            return refused(format!(
                "{} has {} unknowns ({}), and {} coordinates are given at the end: there have to be as many",
                choice.formulation.name,
                names.len(),
                names.join(", "),
                goal.len()
            ));
        }
        if names.is_empty() {
            return refused("the constraints leave no velocity free".into());
        }
        let (units, sizes) = (vec![1.0; names.len()], vec![1.0; names.len()]);
        let (scene_start, aim, settings) = (scene.start.clone(), aim.clone(), settings.clone());
        Ok(TwoPoint {
            system,
            scene_start,
            aim,
            goal,
            others,
            every_constant,
            names,
            varying,
            velocities,
            first_constants,
            settings,
            units,
            sizes,
            runs: [0, 0],
        })
    }

    /// With these units of unknowns and sizes of coordinates.
    pub(super) fn scaled(mut self, units: &[f64], sizes: &[f64]) -> Self {
        (self.units, self.sizes) = (units.to_vec(), sizes.to_vec());
        self
    }

    /// Unknowns in the units of the scene.
    pub(super) fn in_units(&self, unknowns: &[f64]) -> Vec<f64> {
        unknowns.iter().zip(&self.units).map(|(x, unit)| x * unit).collect()
    }

    /// The start and the constants with these unknowns, in the units of the scene.
    pub(super) fn start(&mut self, x: &[f64]) -> Result<(State, Vec<f64>), SolveError> {
        let (free, constants) = x.split_at(self.velocities.free.len());
        let constants = if self.every_constant { &self.first_constants } else { constants };
        Ok((self.velocities.start(free)?, constants.to_vec()))
    }

    /// Sets what the motion with these unknowns starts from.
    pub(super) fn set(&mut self, x: &[f64]) -> Result<(), SolveError> {
        let (state, constants) = self.start(x)?;
        self.varying.set(&state, &[], &ConstantsRule::Given(constants), false)
    }

    pub(super) fn options(&self, tolerance: f64) -> Options {
        let method = Some(self.varying.prepared().method.method);
        Settings { method, ..self.settings.clone() }.options(tolerance)
    }

    /// The coordinates at the end, or why there are none.
    pub(super) fn end(&mut self, x: &[f64]) -> Result<Vec<f64>, BoundaryError> {
        self.set(x).map_err(refused)?;
        self.runs[0] += 1;
        let options = Options { dense: Dense::EndOnly, ..self.options(self.settings.tolerance * crate::TIGHTER) };
        let prepared = self.varying.prepared_mut();
        let run = prepared.integrate(self.aim.t, &options).map_err(refused)?;
        run.solution.completed()?;
        Ok(run.at(&mut prepared.compiled, self.aim.t).map_err(refused)?.coordinates)
    }

    /// The coordinates aimed at, in units of the problem, at `count` times up to the end; none where the
    /// motion does not come there.
    pub(super) fn curve(&mut self, unknowns: &[f64], count: usize) -> Option<Vec<f64>> {
        self.set(&self.in_units(unknowns)).ok()?;
        let options = self.options(self.settings.tolerance);
        let (start, end) = (self.scene_start.t, self.aim.t);
        let prepared = self.varying.prepared_mut();
        let run = prepared.integrate(end, &options).ok()?;
        run.solution.completed().ok()?;
        let mut curve = Vec::new();
        for k in 1..=count {
            let at = run.at(&mut prepared.compiled, start + (end - start) * k as f64 / count as f64).ok()?.coordinates;
            curve.extend(self.goal.iter().zip(&self.sizes).map(|((i, _), size)| at[*i] / size));
        }
        Some(curve)
    }

    /// How the start moves with each unknown.
    pub(super) fn directions(&mut self, x: &[f64]) -> Result<Vec<Direction>, SolveError> {
        let free = self.velocities.free.len();
        let mut along = Vec::new();
        for j in 0..free {
            let (name, scale, mut moved) = (self.names[j].clone(), self.units[j], x.to_vec());
            along.push(Direction::by(&name, x[j], scale, &mut |value| {
                moved[j] = value;
                self.set(&moved)?;
                Ok(self.varying.prepared().start_and_constants())
            })?);
        }
        self.set(x)?;
        let prepared = self.varying.prepared();
        along.extend((free..x.len()).map(|j| prepared.along_constant(j - free, self.units[j])));
        Ok(along)
    }

    /// `∂q_i/∂x_j`, both in units of the problem.
    pub(super) fn matrix(&self, derivatives: &[Outputs]) -> DMatrix<f64> {
        DMatrix::from_fn(self.goal.len(), derivatives.len(), |i, j| {
            derivatives[j].coordinates[self.goal[i].0] * self.units[j] / self.sizes[i]
        })
    }

    /// The unknowns of a motion to the same goal that takes longer by `later`, to first order:
    /// `x − (∂q/∂x)⁻¹ q̇(t₁) later`.
    pub(super) fn followed(&mut self, unknowns: &[f64], later: f64) -> Option<Vec<f64>> {
        let (outputs, matrix) = self.derivatives(&self.in_units(unknowns)).ok()??;
        let moved = self.goal.iter().zip(&self.sizes).map(|((i, _), size)| outputs.velocities[*i] * later / size);
        let change = matrix.lu().solve(&DVector::from_iterator(self.goal.len(), moved))?;
        Some(unknowns.iter().zip(change.iter()).map(|(x, change)| x - change).collect())
    }

    /// Outputs at the end, and `∂q_i/∂x_j` there, with these unknowns in the units of the scene; `None` where
    /// the motion stops before.
    fn derivatives(&mut self, x: &[f64]) -> Result<Option<(Outputs, DMatrix<f64>)>, SolveError> {
        let along = self.directions(x)?;
        self.runs = self.runs.map(|runs| runs + 1);
        let options = Options { dense: Dense::EndOnly, ..self.options(self.settings.tolerance * crate::TIGHTER) };
        let prepared = self.varying.prepared_mut();
        let mut carried = VariationalRun::run(prepared, &along, self.aim.t, &options, Which::Kept)?;
        if *carried.status() != Status::Completed {
            return Ok(None);
        }
        let (outputs, derivatives) = carried.at(prepared, self.aim.t)?;
        Ok(Some((outputs, self.matrix(&derivatives))))
    }

    /// The same at `t`.
    pub(super) fn matrix_at(&mut self, carried: &mut VariationalRun, t: f64) -> Result<DMatrix<f64>, SolveError> {
        let (_, derivatives) = carried.at(self.varying.prepared_mut(), t)?;
        Ok(self.matrix(&derivatives))
    }
}

fn refused(error: SolveError) -> BoundaryError {
    BoundaryError::Residual { reason: error.to_string() }
}

impl Residuals for TwoPoint {
    fn residual(&mut self, unknowns: &[f64], residual: &mut [f64]) -> Result<(), BoundaryError> {
        let q = self.end(&self.in_units(unknowns))?;
        for ((r, (i, goal)), size) in residual.iter_mut().zip(&self.goal).zip(&self.sizes) {
            *r = (q[*i] - goal) / size;
        }
        Ok(())
    }

    fn jacobian(&mut self, unknowns: &[f64], jacobian: &mut [f64]) -> Result<bool, BoundaryError> {
        let x = self.in_units(unknowns);
        let Some((_, matrix)) = self.derivatives(&x).map_err(refused)? else { return Ok(false) };
        for (i, row) in jacobian.chunks_exact_mut(x.len()).enumerate() {
            row.iter_mut().enumerate().for_each(|(j, entry)| *entry = matrix[(i, j)]);
        }
        Ok(true)
    }
}
