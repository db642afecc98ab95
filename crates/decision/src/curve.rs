//! Curves `q(t)`: given by the caller, or integrated from the equations of a formulation.

use std::sync::Arc;

use equations::{Equations, Role};
use integrate::{EvaluationError, Gauge};
use mechanics::{State, System};
use symbolic::{Bounded, Evaluator, Expr, Scalar, Tape};

use crate::DecisionError;
use crate::exact::solve;
use crate::flow::{flow, timeless};
use crate::scales;

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
    instant: Evaluator<f64>,
    rates: Evaluator<f64>,
    steep: Evaluator<f64>,
    inputs: Vec<f64>,
    start: Vec<f64>,
    span: (f64, f64),
    /// Factors of the equations and sizes of the unknowns of an instant.
    units: [Vec<f64>; 2],
}

/// Equations whose instants are linear in their unknowns `z`, as programs for numbers of any kind.
#[derive(Clone)]
pub struct Dynamics {
    pub(crate) coordinates: usize,
    pub(crate) states: usize,
    pub(crate) unknowns: usize,
    /// Which coordinate each state is, or is the rate of.
    kinds: Vec<Option<(usize, bool)>>,
    /// Whether time stands in nothing of this.
    pub(crate) timeless: bool,
    /// `J` (N×N), then `R` at `z = 0`; from parameters, `t, y`.
    pub(crate) instant: Arc<Tape>,
    /// Rates of `y`, then `q`, `v`, `a`; from parameters, `t, y, z`.
    pub(crate) rates: Arc<Tape>,
    /// Arguments of steep functions from parameters, `t, y`, and their gauges.
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
        let unknowns = equations.unknowns();
        let residuals: Vec<Expr> = equations.blocks.iter().flat_map(|b| b.residuals.clone()).collect();
        let matrix = g.jacobian(&residuals, &unknowns);
        let free = |e: Expr| unknowns.iter().all(|&z| !g.depends_on(e, z));
        if !matrix.entries().iter().all(|&e| free(e)) {
            return Err(unsuited("the equations of one instant are not linear"));
        }
        if !equations.velocities.iter().all(|&e| free(e)) {
            return Err(unsuited("velocities are solved for at every instant; take the form in which they are states"));
        }
        let mut inputs: Vec<_> = system.parameters.iter().map(|p| p.symbol).collect();
        inputs.push(system.time);
        let mut at_start = inputs.clone();
        inputs.extend(equations.state_symbols());
        at_start.extend(system.positions().into_iter().chain(system.velocities()).chain(equations.constant_symbols()));
        let at_zero = unknowns.iter().map(|&z| (z, g.zero())).collect();
        let mut instant = matrix.entries().to_vec();
        instant.extend(g.substitute_all(&residuals, &at_zero));
        let instant = g.tape(&inputs, &instant)?;
        let arguments: Vec<Expr> = steep.iter().map(|steep| steep.argument).collect();
        let arguments = g.tape(&inputs, &arguments)?;
        inputs.extend(&unknowns);
        let mut rates: Vec<Expr> = equations.states.iter().map(|y| y.rate).collect();
        rates.extend(&equations.coordinates);
        rates.extend(&equations.velocities);
        rates.extend(g.total_derivatives(&equations.velocities, &flow(system, equations)));
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
            states: equations.states.len(),
            unknowns: unknowns.len(),
            timeless: timeless(system.time, equations),
            instant,
            steep: arguments,
            gauges: steep.iter().map(|steep| steep.gauge).collect(),
            rates: g.tape(&inputs, &rates)?,
            start: g.tape(&at_start, &starts)?,
        })
    }
}

impl Dynamics {
    /// Steps of one evaluation.
    pub(crate) fn steps(&self) -> usize {
        self.instant.len() + self.rates.len()
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
        let inputs: Vec<Bounded> =
            parameters.iter().chain([&start.t]).chain(&start_states).map(|&x| Bounded::from_f64(x)).collect();
        let matrix = Evaluator::<Bounded>::new(programs.instant.clone()).evaluate(&inputs).to_vec();
        Flow {
            units: scales::balanced(programs.unknowns, &matrix),
            instant: Evaluator::new(programs.instant.clone()),
            rates: Evaluator::new(programs.rates.clone()),
            steep: Evaluator::new(programs.steep.clone()),
            programs,
            inputs: parameters,
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
        let parameters = self.inputs.len();
        self.inputs.push(t);
        self.inputs.extend(states);
        arguments.copy_from_slice(self.steep.evaluate(&self.inputs));
        self.inputs.truncate(parameters);
    }

    fn point(&mut self, t: f64, states: &[f64], rates: &mut [f64]) -> Result<Point, EvaluationError> {
        let parameters = self.inputs.len();
        self.inputs.push(t);
        self.inputs.extend(states);
        let size = self.programs.unknowns;
        self.instant.evaluate(&self.inputs);
        let (matrix, rest) = self.instant.values_mut().split_at_mut(size * size);
        let [factors, sizes] = &self.units;
        for (i, factor) in factors.iter().enumerate() {
            matrix[i * size..(i + 1) * size].iter_mut().zip(sizes).for_each(|(x, size)| *x *= factor * size);
            rest[i] *= factor;
        }
        let solved = solve(matrix, rest, size, 1, 1.0);
        let point = solved.map(|_| {
            self.inputs.extend(rest.iter().zip(sizes).map(|(z, size)| -z * size));
            let (of_states, point) = self.rates.evaluate(&self.inputs).split_at(states.len());
            rates.copy_from_slice(of_states);
            let part = |i: usize| point[i * self.programs.coordinates..(i + 1) * self.programs.coordinates].to_vec();
            Point { q: part(0), v: part(1), a: part(2) }
        });
        self.inputs.truncate(parameters);
        point.ok_or_else(|| EvaluationError { reason: format!("the equations of the curve are singular at t = {t}") })
    }
}
