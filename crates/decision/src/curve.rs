//! Curves `q(t)`: given by the caller, or integrated from the equations of a formulation.

use std::sync::Arc;

use equations::{Equations, Named, Role};
use integrate::{EvaluationError, Gauge};
use mechanics::{State, System};
use symbolic::{Evaluator, Expr, Symbol, Tape};

use crate::DecisionError;
use crate::flow::{flow, timeless};

/// A point of a curve: positions, velocities and accelerations, each of length n.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// `q`.
    pub q: Vec<f64>,
    /// `v = q̇`.
    pub v: Vec<f64>,
    /// `a = q̈`, the curve's own.
    pub a: Vec<f64>,
}

/// A curve on `f = 0` in the space of coordinates.
///
/// A curve that is known everywhere answers with [`Point`]s and has no states. One that has to be integrated
/// hands its states and their rates to the same time loop in which the constants are transported.
pub trait Curve {
    /// Start and end of the time for which the question is put.
    fn span(&self) -> (f64, f64);

    /// States at the start.
    fn states(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Sizes that states are held to have, where coordinates have these `scales` in all the `time`; `None`
    /// where what a state is at the start has to tell.
    fn scales(&self, _scales: &[f64], _time: f64) -> Vec<Option<f64>> {
        Vec::new()
    }

    /// Gauges of functions that may change within little of their arguments: see
    /// [`integrate::Problem::gauges`].
    fn gauges(&self) -> &[Gauge] {
        &[]
    }

    /// Writes the arguments of these functions.
    fn gauged(&mut self, _t: f64, _states: &[f64], _arguments: &mut [f64]) {}

    /// The point at `t`, where the states are `states`; writes their rates.
    ///
    /// # Errors
    /// [`EvaluationError`] where the curve has no such point.
    fn point(&mut self, t: f64, states: &[f64], rates: &mut [f64]) -> Result<Point, EvaluationError>;
}

/// A curve that is known everywhere: any motion, as a function of time.
pub struct Known<F> {
    span: (f64, f64),
    point: F,
}

impl<F: FnMut(f64) -> Result<Point, EvaluationError>> Known<F> {
    /// The curve `point` between two times.
    pub fn new(start: f64, end: f64, point: F) -> Self {
        Known { span: (start, end), point }
    }
}

impl<F: FnMut(f64) -> Result<Point, EvaluationError>> Curve for Known<F> {
    fn span(&self) -> (f64, f64) {
        self.span
    }

    fn point(&mut self, t: f64, _: &[f64], _: &mut [f64]) -> Result<Point, EvaluationError> {
        (self.point)(t)
    }
}

/// The solution of a formulation's equations through one start, with values for its free constants.
#[derive(Clone)]
pub struct Flow {
    programs: Dynamics,
    steep: Evaluator<f64>,
    /// Free constants and parameters.
    constants: Vec<f64>,
    /// `t`, states and these, for `steep`.
    inputs: Vec<f64>,
    start: Vec<f64>,
    span: (f64, f64),
}

/// Equations whose instants are linear in their unknowns `z`, for numbers of any kind.
#[derive(Clone)]
pub struct Dynamics {
    coordinates: usize,
    /// The number of unknowns of each block.
    pub(crate) blocks: Vec<usize>,
    /// Which coordinate each state is, or is the rate of.
    kinds: Vec<Option<(usize, bool)>>,
    /// Whether time stands in nothing of this.
    pub(crate) timeless: bool,
    /// Rates of `y`; outputs are `q`, `v`, `a`. Its constants are the free ones, then parameters.
    pub(crate) instant: equations::Dynamics,
    /// Places of these parameters among those of the system.
    pub(crate) parameters: Vec<usize>,
    /// Arguments of steep functions from `t, y` and the constants, and their gauges.
    steep: Arc<Tape>,
    gauges: Vec<Gauge>,
    /// `y(t₀)` from parameters, `t, q, v` and the free constants.
    pub(crate) start: Arc<Tape>,
}

impl Dynamics {
    /// Those of `equations`, derived for `system`.
    ///
    /// # Errors
    /// [`DecisionError::Unsuited`] where unknowns stand nonlinearly or velocities are unknowns.
    pub fn new(system: &System, equations: &Equations) -> Result<Self, DecisionError> {
        // new expressions, which the copy has to know
        let steep = equations.steep();
        let system = &System { graph: equations.graph.clone(), ..system.clone() };
        let g = &system.graph;
        let unsuited =
            |reason: &str| DecisionError::Unsuited { formulation: equations.formulation, reason: reason.into() };
        if !equations.definitions.is_empty() {
            return Err(unsuited("intermediate quantities stand in its equations; take the form as derived"));
        }
        if equations.states.iter().any(|y| matches!(y.role, Role::DisplacementParameter | Role::Memory)) {
            return Err(unsuited(
                "its start needs values for parameters of a removal; hand its motion over as a known curve",
            ));
        }
        if equations.blocks.iter().any(|block| equations.linear_system(block).1.is_none()) {
            return Err(unsuited("the equations of one instant are not linear"));
        }
        let unknowns = equations.unknowns();
        if equations.velocities.iter().any(|&e| unknowns.iter().any(|&z| g.depends_on(e, z))) {
            return Err(unsuited("velocities are solved for at every instant; take the form in which they are states"));
        }
        let (mut free, _) = equations.free_parameters();
        let named = |expression| Named { name: String::new(), expression };
        let accelerations = g.total_derivatives(&equations.velocities, &flow(system, equations));
        free.multipliers = accelerations.into_iter().map(named).collect();
        // handed over last, with what is new in it
        free.graph = g.clone();
        free.invariants.clear();
        let own = |symbol: &Symbol| system.parameters.iter().position(|p| p.symbol == *symbol);
        let behind = free.constant_symbols().split_off(equations.free_constants.len());
        let parameters: Option<Vec<usize>> = behind.iter().map(own).collect();
        let parameters =
            parameters.ok_or_else(|| unsuited("parameters stand in them that the system does not have"))?;
        let arguments: Vec<Expr> = steep.iter().map(|steep| steep.argument).collect();
        let mut at_start: Vec<_> = system.parameters.iter().map(|p| p.symbol).collect();
        at_start.push(system.time);
        at_start.extend(system.positions().into_iter().chain(system.velocities()).chain(equations.constant_symbols()));
        let starts: Vec<Expr> = equations.states.iter().map(|y| y.start).collect();
        let (positions, velocities) = (system.positions(), system.velocities());
        let place = |all: &[symbolic::Symbol], symbol| all.iter().position(|s| *s == symbol);
        let kind = |y: symbolic::Symbol| {
            let position = place(&positions, y).map(|i| (i, false));
            position.or_else(|| place(&velocities, y).map(|i| (i, true)))
        };
        Ok(Dynamics {
            kinds: equations.states.iter().map(|y| kind(y.symbol)).collect(),
            coordinates: system.dimension(),
            blocks: equations.blocks.iter().map(|block| block.unknowns.len()).collect(),
            timeless: timeless(system.time, equations),
            steep: g.tape(&free.known_symbols(), &arguments)?,
            gauges: steep.iter().map(|steep| steep.gauge).collect(),
            instant: equations::Dynamics::new(&free)?,
            parameters,
            start: g.tape(&at_start, &starts)?,
        })
    }

    /// Steps of one evaluation.
    pub(crate) fn steps(&self) -> usize {
        self.instant.steps()
    }
}

impl Flow {
    /// The motion of `equations`, derived for `system`, from `start` to `end` with free `constants`.
    ///
    /// # Errors
    /// [`DecisionError::Unsuited`] for equations that cannot be followed so; take [`Known`] for these.
    pub fn new(
        system: &System,
        equations: &Equations,
        start: &State,
        constants: &[f64],
        end: f64,
    ) -> Result<Self, DecisionError> {
        Ok(Flow::of(Dynamics::new(system, equations)?, system, start, constants, end))
    }

    pub(crate) fn of(programs: Dynamics, system: &System, start: &State, constants: &[f64], end: f64) -> Self {
        let parameters: Vec<f64> = system.parameters.iter().map(|p| p.value).collect();
        let at_start = [&parameters[..], &[start.t], &start.q, &start.v, constants].concat();
        let start_states = Evaluator::new(programs.start.clone()).evaluate(&at_start).to_vec();
        let own = programs.parameters.iter().map(|&i| parameters[i]);
        let constants: Vec<f64> = constants.iter().copied().chain(own).collect();
        let mut programs = programs;
        programs.instant.set_constants(&constants);
        Flow {
            steep: Evaluator::new(programs.steep.clone()),
            programs,
            constants,
            inputs: Vec::new(),
            start: start_states,
            span: (start.t, end),
        }
    }
}

impl Curve for Flow {
    fn span(&self) -> (f64, f64) {
        self.span
    }

    fn states(&self) -> Vec<f64> {
        self.start.clone()
    }

    fn scales(&self, scales: &[f64], time: f64) -> Vec<Option<f64>> {
        let scale = |(i, is_rate): (usize, bool)| if is_rate { scales[i] / time } else { scales[i] };
        self.programs.kinds.iter().map(|kind| kind.map(scale)).collect()
    }

    fn gauges(&self) -> &[Gauge] {
        &self.programs.gauges
    }

    fn gauged(&mut self, t: f64, states: &[f64], arguments: &mut [f64]) {
        self.inputs.clear();
        self.inputs.push(t);
        self.inputs.extend(states.iter().chain(&self.constants));
        arguments.copy_from_slice(self.steep.evaluate(&self.inputs));
    }

    fn point(&mut self, t: f64, states: &[f64], rates: &mut [f64]) -> Result<Point, EvaluationError> {
        let instant = &mut self.programs.instant;
        instant.solve(t, states).map_err(|failure| EvaluationError {
            reason: format!("the equations of the curve cannot be solved at t = {t}: {failure}"),
        })?;
        rates.copy_from_slice(instant.rates());
        let point = instant.outputs();
        let part = |i: usize| point[i * self.programs.coordinates..][..self.programs.coordinates].to_vec();
        Ok(Point { q: part(0), v: part(1), a: part(2) })
    }
}
