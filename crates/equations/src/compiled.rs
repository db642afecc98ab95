//! Equations of motion turned into numbers: tapes and small linear solves, ready for any time integrator.

use symbolic::{CompileError, Evaluator, Expr};

use crate::blocks::{CompiledBlock, EvaluationFailure};
use crate::dynamics::Dynamics;
use crate::equations::Equations;
use crate::jacobian::Jacobian;
use crate::of_instant::OfInstant;
use crate::outputs::{Cost, Outputs};
use crate::plan::Plan;
use crate::planned::Planned;
use crate::programs::Terms;
use crate::projection::Projector;
use crate::rows::Rows;
use crate::series::Series;

/// Compiled equations of motion `ẏ = F(t, y)`.
///
/// Evaluation needs `&mut self` because registers are reused; clone it for another thread.
#[derive(Clone)]
pub struct Compiled {
    /// The plain plan, and the inputs of every program.
    pub(crate) instant: Dynamics,
    /// The chosen plan, where there is another than the plain one, and how often it was not to be trusted.
    pub(crate) planned: Option<Planned>,
    pub(crate) left: Vec<usize>,
    fallbacks: usize,
    pub(crate) guards: Evaluator<f64>,
    pub(crate) angles: OfInstant,
    pub(crate) steep: OfInstant,
    pub(crate) gauges: Vec<fn(f64) -> f64>,
    pub(crate) highest_power: f64,
    pub(crate) divisors: OfInstant,
    pub(crate) rows: Option<Rows>,
    /// Programs in terms, once these are asked for.
    pub(crate) terms: Option<Box<Terms>>,
    pub(crate) projector: Option<Projector>,
    pub(crate) jacobian: Option<Jacobian>,
    /// Taylor coefficients in the chosen plan, and in the plain one where that may be needed.
    pub(crate) series: Option<Series>,
    pub(crate) plain_series: Option<Series>,
}

impl Compiled {
    /// Compiles all that a time integrator asks for, without Jacobian, in a plan chosen from structure.
    ///
    /// # Errors
    /// [`CompileError`] where an expression contains a symbol that `equations` does not list: its fault.
    pub fn new(equations: &Equations) -> Result<Self, CompileError> {
        Compiled::with_plan(equations, &Plan::choose(equations, None)?)
    }

    /// [`Compiled::new`] with every block solved by LU factorization.
    ///
    /// # Errors
    /// As [`Compiled::new`].
    pub fn plain(equations: &Equations) -> Result<Self, CompileError> {
        Compiled::with_plan(equations, &Plan::plain(equations))
    }

    /// [`Compiled::new`] in a plan chosen before.
    ///
    /// # Errors
    /// As [`Compiled::new`].
    pub fn with_plan(equations: &Equations, plan: &Plan) -> Result<Self, CompileError> {
        let known = equations.known_symbols();
        let mut all = known.clone();
        all.extend(equations.unknowns());

        let instant = Dynamics::new(equations)?;
        let steep = equations.steep();
        let chart = equations.chart.iter().flat_map(|chart| &chart.coefficients);
        let guards: Vec<Expr> = equations.guards.iter().chain(chart).copied().collect();
        let planned = (plan.left.len() < instant.blocks.len() || plan.collected.is_some())
            .then(|| Planned::new(equations, plan, &all, &equations.output_expressions()))
            .transpose()?;
        Ok(Compiled {
            planned,
            left: plan.left.clone(),
            fallbacks: 0,
            instant,
            guards: equations.evaluator(&known, &guards)?,
            highest_power: equations.highest_power(),
            gauges: steep.iter().map(|steep| steep.gauge).collect(),
            steep: OfInstant::new(equations, &steep.iter().map(|steep| steep.argument).collect::<Vec<_>>())?,
            angles: OfInstant::new(equations, &equations.angles())?,
            divisors: OfInstant::new(equations, &equations.divisors())?,
            rows: Rows::new(equations)?,
            terms: None,
            projector: equations.projection.as_ref().map(|p| Projector::new(equations, p, &known)).transpose()?,
            jacobian: None,
            series: None,
            plain_series: None,
        })
    }

    /// Adds the exact Jacobian `∂F/∂y`, which implicit methods need.
    ///
    /// # Errors
    /// As [`Compiled::new`].
    pub fn with_jacobian(mut self, equations: &Equations) -> Result<Self, CompileError> {
        self.jacobian = Some(Jacobian::new(equations)?);
        Ok(self)
    }

    /// Adds the recurrences of Taylor coefficients, for [`Compiled::taylor`], in the `plan` compiled before.
    ///
    /// # Errors
    /// As [`Compiled::new`].
    pub fn with_series(mut self, equations: &Equations, plan: &Plan) -> Result<Self, CompileError> {
        self.add_series(equations, plan)?;
        Ok(self)
    }

    /// [`Compiled::with_series`] in place.
    ///
    /// # Errors
    /// As [`Compiled::new`].
    pub fn add_series(&mut self, equations: &Equations, plan: &Plan) -> Result<(), CompileError> {
        self.series = Some(Series::new(equations, plan)?);
        if plan.condition.is_some() {
            self.plain_series = Some(Series::new(equations, &Plan::plain(equations))?);
        }
        Ok(())
    }

    /// Whether [`Compiled::with_jacobian`] was called.
    pub fn has_jacobian(&self) -> bool {
        self.jacobian.is_some()
    }

    /// Whether [`Compiled::with_series`] was called.
    pub fn has_series(&self) -> bool {
        self.series.is_some()
    }

    /// Number of states.
    pub fn dimension(&self) -> usize {
        self.instant.sizes.states
    }

    /// Sets the values of the free constants.
    ///
    /// # Panics
    /// If the length is not that of [`Equations::free_constants`].
    pub fn set_constants(&mut self, constants: &[f64]) {
        self.instant.set_constants(constants);
    }

    /// Whether a block is not linear in its unknowns, so that it matters from where it is solved.
    pub fn needs_guess(&self) -> bool {
        self.instant.blocks.iter().any(|block| !block.linear)
    }

    /// Sets the point `z` from which blocks that are not linear are solved: one on the same branch, near by.
    ///
    /// # Panics
    /// If the length is not that of [`Equations::unknowns`].
    pub fn set_guess(&mut self, unknowns: &[f64]) {
        self.instant.set_guess(unknowns);
    }

    /// Solves for the unknowns at `(t, y)` and returns them; blocks not linear start from there from now on.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn settle(&mut self, t: f64, y: &[f64]) -> Result<&[f64], EvaluationFailure> {
        self.instant.settle(t, y)?;
        Ok(self.instant.guess())
    }

    /// `F(t, y)`.
    ///
    /// # Errors
    /// [`EvaluationFailure`] where the equations of the instant cannot be solved.
    pub fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationFailure> {
        if self.planned.is_some() {
            self.load(t, y);
            self.solve_left()?;
            if let Some(values) = self.planned.as_mut().and_then(|s| s.trusted_rates(&self.instant.inputs)) {
                rates.copy_from_slice(values);
                return Ok(());
            }
            self.fallbacks += 1;
        }
        self.solve_instant(t, y)?;
        rates.copy_from_slice(self.instant.rates());
        Ok(())
    }

    /// How often the chosen plan could not be trusted ([`Plan::LIMIT`]), so that the plain one gave rates.
    pub fn fallbacks(&self) -> usize {
        self.fallbacks
    }

    /// Cost of one evaluation of the rates, in the plain plan and in the chosen one.
    pub fn cost(&self) -> [Cost; 2] {
        let plain = self.cost_of(&|_| true, self.instant.rates.tape().len());
        let chosen = self.planned.as_ref().map(|s| self.cost_of(&|k| self.left.contains(&k), s.len()));
        [plain, chosen.unwrap_or(plain)]
    }

    /// Products of series and linear terms per order of [`Compiled::taylor`] in the chosen plan.
    pub fn cost_of_series(&self) -> Option<(usize, usize)> {
        Some(self.series.as_ref()?.work())
    }

    fn cost_of(&self, solved: &dyn Fn(usize) -> bool, rates: usize) -> Cost {
        let blocks = self.instant.blocks.iter().enumerate().filter(|(k, _)| solved(*k)).map(|(_, b)| b);
        blocks.fold(Cost { instructions: rates, factorization: 0 }, |cost, block| Cost {
            instructions: cost.instructions + block.program.tape().len(),
            factorization: cost.factorization
                + block.size * (block.size * block.size - 1) / 3
                + block.size * block.size,
        })
    }

    /// Coordinates, velocities, multipliers and invariants at `(t, y)`.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn outputs(&mut self, t: f64, y: &[f64]) -> Result<Outputs, EvaluationFailure> {
        if self.planned.is_some() {
            self.load(t, y);
            self.solve_left()?;
            if let Some(values) = self.planned.as_mut().and_then(|s| s.trusted_outputs(&self.instant.inputs)) {
                return Ok(self.instant.sizes.outputs(values));
            }
        }
        self.solve_instant(t, y)?;
        let sizes = self.instant.sizes;
        Ok(sizes.outputs(self.instant.outputs()))
    }

    /// Number of guards.
    pub fn guards(&self) -> usize {
        self.instant.sizes.guards
    }

    /// Values of the guards, whose zeros are singularities; where there is room for one more, after them the
    /// sum of the squares of the chart's coefficients, which those of redundant rows are as well.
    pub fn guard_values(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        self.load(t, y);
        let found = self.guards.evaluate(&self.instant.inputs[..self.instant.sizes.known()]);
        let (guards, coefficients) = found.split_at(self.instant.sizes.guards);
        values[..guards.len()].copy_from_slice(guards);
        if let Some(size) = values.get_mut(guards.len()) {
            *size = coefficients.iter().map(|x| x * x).sum();
            if let Some(rows) = self.rows.as_mut().filter(|rows| rows.replaceable) {
                *size += rows.dependence(&self.instant.inputs);
            }
        }
    }

    /// The matrices `∂R/∂z` of the blocks at `(t, y)`, row-major; of those that are not linear at the last
    /// `z`.
    pub fn block_matrices(&mut self, t: f64, y: &[f64]) -> Vec<Vec<f64>> {
        self.load(t, y);
        let (inputs, known) = (&self.instant.inputs, self.instant.sizes.known());
        let matrix = |block: &mut CompiledBlock| {
            let inputs = if block.linear { &inputs[..known] } else { &inputs[..] };
            block.program.evaluate(inputs)[..block.size * block.size].to_vec()
        };
        self.instant.blocks.iter_mut().map(matrix).collect()
    }

    /// Moves the velocities in `y` onto the constraint; returns the Euclidean length of the move.
    ///
    /// # Errors
    /// [`EvaluationFailure`] where constraint Jacobian or metric are singular.
    pub fn project(&mut self, t: f64, y: &mut [f64]) -> Result<f64, EvaluationFailure> {
        self.load(t, y);
        let known = self.instant.sizes.known();
        match &mut self.projector {
            None => Ok(0.0),
            Some(projector) => projector.project(&mut self.instant.inputs[..known], y),
        }
    }

    /// `∂F/∂y`, row-major.
    ///
    /// For a block `R(z; t, y) = 0`: `∂z/∂y = −(∂R/∂z)⁻¹ ∂R/∂y`.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    ///
    /// # Panics
    /// If [`Compiled::with_jacobian`] was not called.
    pub fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationFailure> {
        self.solve_instant(t, y)?;
        let derivatives = self.jacobian.as_mut().expect("compiled with_jacobian");
        derivatives.write(&self.instant.inputs, &mut self.instant.blocks, jacobian);
        Ok(())
    }

    /// Taylor coefficients of the motion through `(t, y)`, component after component, as many orders as there
    /// is room for: `y_i(t + τ) = Σ_k coefficients[i orders + k] (τ/unit)^k`.
    ///
    /// Unknowns of the instant are series: at order k a block is linear in `z_k`, with `∂R/∂z` of order 0.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    ///
    /// # Panics
    /// If [`Compiled::with_series`] was not called, or there is room for less than two orders.
    pub fn taylor(&mut self, t: f64, y: &[f64], unit: f64, coefficients: &mut [f64]) -> Result<(), EvaluationFailure> {
        let series = if self.solve_trusted(t, y)? { &mut self.series } else { &mut self.plain_series };
        let order = coefficients.len() / y.len() - 1;
        let series = series.as_mut().expect("compiled with_series");
        let blocks = (&mut self.instant.blocks[..], 1);
        series.expand(&self.instant.inputs, unit, order, blocks, |block, residual| block.factors.solve(residual));
        series.write(y, coefficients);
        Ok(())
    }

    /// Solves the blocks that the chosen plan leaves, or all where it is not to be trusted, and says which.
    pub(crate) fn solve_trusted(&mut self, t: f64, y: &[f64]) -> Result<bool, EvaluationFailure> {
        self.load(t, y);
        self.solve_left()?;
        let trusted = self.planned.as_mut().is_none_or(|s| s.is_trusted(&self.instant.inputs));
        if !trusted {
            self.fallbacks += 1;
            self.solve_instant(t, y)?;
        }
        Ok(trusted)
    }

    pub(crate) fn load(&mut self, t: f64, y: &[f64]) {
        self.instant.load(t, y);
    }

    pub(crate) fn solve_instant(&mut self, t: f64, y: &[f64]) -> Result<(), EvaluationFailure> {
        self.instant.solve(t, y)
    }

    /// Solves the blocks that the chosen plan leaves.
    fn solve_left(&mut self) -> Result<(), EvaluationFailure> {
        let left = &self.left;
        self.instant.solve_blocks(|k| left.contains(&k))
    }
}
