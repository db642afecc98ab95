//! Equations of motion at several points at once, one per lane: for ensembles.

use symbolic::{CompileError, Evaluator, LANES, Lanes, Scalar, SeriesTape, SeriesWorkspace, Symbol};

use crate::equations::{Block, Equations};
use crate::plan::Plan;
use crate::projection::LIMIT;
use crate::series::Series;
use mechanics::fresh_symbol;
use symbolic::limits::{ITERATIONS, NOTHING};

/// [`crate::Compiled`] for eight motions at a time, in a plan that leaves no block to solve numerically.
///
/// The constants differ from lane to lane. Clone it for another thread.
#[derive(Clone)]
pub struct LaneEquations {
    series: SeriesTape,
    workspace: SeriesWorkspace<Lanes>,
    /// For the first order only.
    rates: SeriesWorkspace<Lanes>,
    condition: Option<Evaluator<Lanes>>,
    guards: Evaluator<Lanes>,
    divisors: Evaluator<Lanes>,
    rows: Option<(Evaluator<Lanes>, (usize, usize))>,
    projection: Option<Projection>,
    states: usize,
    /// `t, y, constants`.
    inputs: Vec<Lanes>,
}

impl LaneEquations {
    /// Compiles `equations` in `plan`; `point`: `(t, y, constants)` at a start. Inner `Err`: why not.
    ///
    /// # Errors
    /// As [`crate::Compiled::new`].
    pub fn new(equations: &Equations, plan: &Plan, point: &[f64]) -> Result<Result<Self, String>, CompileError> {
        if !plan.left.is_empty() {
            let words: Vec<&str> = plan.left.iter().filter_map(|&k| plan.why.get(k)).map(String::as_str).collect();
            return Ok(Err(format!("not in lanes: {}", words.join("; "))));
        }
        if !equations.steep().is_empty() || equations.highest_power() > 0.0 {
            return Ok(Err(
                "not in lanes: functions in the equations may change within a step, which looks closer".into()
            ));
        }
        let rows = equations.rows.as_ref().map_or(&[][..], |rows| rows.jacobian.entries());
        if equations.need_unknowns(rows) {
            return Ok(Err("not in lanes: the rows of the constraints contain unknowns of the instant".into()));
        }
        let divisors = equations.divisors();
        if equations.need_unknowns(&divisors) {
            return Ok(Err("not in lanes: unknowns of the instant stand in a divisor that may vanish".into()));
        }
        let projection = match Projection::new(equations, point)? {
            Ok(projection) => projection,
            Err(words) => return Ok(Err(words)),
        };
        let series = Series::tape(equations, plan)?;
        let known = equations.known_symbols();
        let condition = plan
            .condition
            .map(|condition| equations.evaluator_by(&plan.all_definitions(equations), &known, &[condition]));
        let rows = equations.rows.as_ref().map(|rows| {
            let program = equations.evaluator(&known, rows.jacobian.entries())?;
            Ok::<_, CompileError>((program, (rows.jacobian.rows(), rows.jacobian.columns())))
        });
        Ok(Ok(LaneEquations {
            workspace: series.workspace(1),
            rates: series.workspace(1),
            series,
            condition: condition.transpose()?,
            guards: equations.evaluator(&known, &equations.guards)?,
            divisors: equations.evaluator(&known, &divisors)?,
            rows: rows.transpose()?,
            projection,
            states: equations.states.len(),
            inputs: vec![Lanes::from_f64(0.0); known.len()],
        }))
    }

    /// Number of states.
    pub fn dimension(&self) -> usize {
        self.states
    }

    /// Number of guards.
    pub fn guards(&self) -> usize {
        self.guards.values().len()
    }

    /// Sets the free constants of one lane.
    ///
    /// # Panics
    /// If the length is not that of [`Equations::free_constants`].
    pub fn set_constants(&mut self, lane: usize, constants: &[f64]) {
        let places = &mut self.inputs[1 + self.states..];
        assert_eq!(places.len(), constants.len(), "free constants");
        for (x, constant) in places.iter_mut().zip(constants) {
            x.0[lane] = *constant;
        }
    }

    /// The rates of the states in every lane.
    pub fn rates(&mut self, t: &[f64; LANES], y: &[[f64; LANES]], rates: &mut [[f64; LANES]]) {
        self.load(t, y);
        self.series.expand(&self.inputs, Lanes([1.0; LANES]), &mut self.rates, 1, &mut |_, _| {});
        for (i, rate) in rates.iter_mut().enumerate() {
            *rate = self.series.input(1 + i, &self.rates).map_or([0.0; LANES], |series| series[1].0);
        }
    }

    /// [`crate::Compiled::taylor`] of every lane, and whether the condition of the plan is within
    /// [`Plan::LIMIT`] there. What is not finite shows in the coefficients.
    pub fn taylor(
        &mut self,
        t: &[f64; LANES],
        y: &[[f64; LANES]],
        unit: &[f64; LANES],
        coefficients: &mut [[f64; LANES]],
    ) -> [bool; LANES] {
        self.load(t, y);
        let orders = coefficients.len() / y.len();
        self.series.reorder(&mut self.workspace, orders - 1);
        self.series.expand(&self.inputs, Lanes(*unit), &mut self.workspace, 1, &mut |_, _| {});
        for ((i, y), row) in y.iter().enumerate().zip(coefficients.chunks_exact_mut(orders)) {
            match self.series.input(1 + i, &self.workspace) {
                Some(series) => row.iter_mut().zip(series).for_each(|(c, s)| *c = s.0),
                None => {
                    row.fill([0.0; LANES]);
                    row[0] = *y;
                }
            }
        }
        match &mut self.condition {
            None => [true; LANES],
            Some(condition) => condition.evaluate(&self.inputs)[0].0.map(|x| x <= Plan::LIMIT),
        }
    }

    /// [`crate::Compiled::guard_values`] of every lane.
    pub fn guard_values(&mut self, t: &[f64; LANES], y: &[[f64; LANES]], values: &mut [[f64; LANES]]) {
        self.load(t, y);
        for (value, guard) in values.iter_mut().zip(self.guards.evaluate(&self.inputs)) {
            *value = guard.0;
        }
    }

    /// Number of [`Equations::divisors`].
    pub fn divisors(&self) -> usize {
        self.divisors.values().len()
    }

    /// [`crate::Compiled::divided`] of every lane.
    pub fn divided(&mut self, t: &[f64; LANES], y: &[[f64; LANES]], values: &mut [[f64; LANES]]) {
        self.load(t, y);
        for (value, divisor) in values.iter_mut().zip(self.divisors.evaluate(&self.inputs)) {
            *value = divisor.0;
        }
    }

    /// [`crate::Compiled::rank`].
    pub fn rank(&self) -> (usize, usize) {
        self.rows.as_ref().map_or((0, 0), |(_, shape)| *shape)
    }

    /// [`crate::Compiled::rows`] of every lane.
    pub fn rows(&mut self, t: &[f64; LANES], y: &[[f64; LANES]], entries: &mut [[f64; LANES]]) {
        self.load(t, y);
        if let Some((program, _)) = &mut self.rows {
            entries.iter_mut().zip(program.evaluate(&self.inputs)).for_each(|(x, entry)| *x = entry.0);
        }
    }

    /// [`crate::Compiled::project`] of every lane; the length is NaN for a lane that was not projected.
    pub fn project(&mut self, t: &[f64; LANES], y: &mut [[f64; LANES]]) -> [f64; LANES] {
        self.load(t, y);
        let Some(projection) = &mut self.projection else { return [0.0; LANES] };
        projection.project(&mut self.inputs, y)
    }

    fn load(&mut self, t: &[f64; LANES], y: &[[f64; LANES]]) {
        self.inputs[0] = Lanes(*t);
        for (x, y) in self.inputs[1..].iter_mut().zip(y) {
            *x = Lanes(*y);
        }
    }
}

/// The Newton step of [`crate::ConstraintProjection`], its linear equations eliminated beforehand.
#[derive(Clone)]
struct Projection {
    /// Outputs: `δv`, `f`, then the condition.
    program: Evaluator<Lanes>,
    places: Vec<usize>,
    constraints: usize,
}

impl Projection {
    fn new(equations: &Equations, point: &[f64]) -> Result<Result<Option<Self>, String>, CompileError> {
        let Some(projection) = &equations.projection else { return Ok(Ok(None)) };
        let mut step = equations.clone();
        let g = &step.graph;
        let fresh = |name: &str, count: usize| -> Vec<Symbol> {
            (0..count).map(|i| fresh_symbol(g, &format!("{name}_{i}"))).collect()
        };
        let (n, h) = (projection.velocities.len(), projection.constraints.len());
        let (change, multipliers) = (fresh("change", n), fresh("multiplier", h));
        let rows = (0..n).map(|i| {
            let inertia = (0..n).map(|j| g.mul(projection.metric[(i, j)], g.variable(change[j])));
            let reaction = (0..h).map(|k| g.mul(projection.jacobian[(k, i)], g.variable(multipliers[k])));
            g.sum(&inertia.chain(reaction).collect::<Vec<_>>())
        });
        let constraints = (0..h).map(|k| {
            let moved = (0..n).map(|j| g.mul(projection.jacobian[(k, j)], g.variable(change[j])));
            g.sum(&moved.chain([projection.constraints[k]]).collect::<Vec<_>>())
        });
        let residuals = rows.chain(constraints).collect::<Vec<_>>();
        let unknowns = [&change[..], &multipliers].concat();
        let regular = "constraint Jacobian of full row rank, metric regular on its kernel";
        step.blocks = vec![Block { unknowns, residuals, guess: Vec::new(), regular }];
        let wanted = g.variables(&change);
        let place = |v: &Symbol| equations.states.iter().position(|y| y.symbol == *v);
        let places: Vec<usize> = projection.velocities.iter().filter_map(place).collect();
        for state in &mut step.states {
            state.rate = step.graph.zero();
        }
        for (&place, &change) in places.iter().zip(&wanted) {
            step.states[place].rate = change;
        }
        let plan = Plan::eliminated(&step, Some(point))?;
        if !plan.left.is_empty() {
            return Ok(Err(format!("not in lanes: the projection has {}", plan.why.join("; "))));
        }
        let known = equations.known_symbols();
        let outputs = [&wanted[..], &projection.constraints, plan.condition.as_slice()].concat();
        let program = step.evaluator_by(&plan.all_definitions(&step), &known, &outputs)?;
        Ok(Ok(Some(Projection { program, places, constraints: h })))
    }

    /// `inputs` holds `t, y, constants`. Each lane ends its iteration as if it were alone.
    fn project(&mut self, inputs: &mut [Lanes], y: &mut [[f64; LANES]]) -> [f64; LANES] {
        let n = self.places.len();
        let mut moved = vec![[0.0; LANES]; n];
        let mut under_way = [true; LANES];
        let mut left = [false; LANES];
        for _ in 0..ITERATIONS {
            let values = self.program.evaluate(inputs);
            let (change, rest) = values.split_at(n);
            let (f, condition) = rest.split_at(self.constraints);
            let (mut step, mut speed) = ([0.0_f64; LANES], [0.0_f64; LANES]);
            for l in 0..LANES {
                under_way[l] &= !f.iter().all(|f| f.0[l] == 0.0);
                if under_way[l] && condition.iter().any(|c| c.0[l].is_nan() || c.0[l] > Plan::LIMIT) {
                    moved[0][l] = f64::NAN;
                    under_way[l] = false;
                }
            }
            for (&place, (change, moved)) in self.places.iter().zip(change.iter().zip(&mut moved)) {
                for l in 0..LANES {
                    let change = if under_way[l] { change.0[l] } else { 0.0 };
                    y[place][l] += change;
                    moved[l] += change;
                    step[l] = step[l].max(change.abs());
                    speed[l] = speed[l].max(y[place][l].abs());
                }
                inputs[1 + place] = Lanes(y[place]);
            }
            for l in 0..LANES {
                under_way[l] &= step[l] > LIMIT * speed[l];
                left[l] = under_way[l] && step[l] > NOTHING * speed[l];
            }
            if !under_way.contains(&true) {
                break;
            }
        }
        for l in 0..LANES {
            if left[l] || !moved.iter().all(|row| row[l].is_finite()) {
                moved[0][l] = f64::NAN;
            }
        }
        let mut squares = [0.0; LANES];
        for row in &moved {
            for l in 0..LANES {
                squares[l] += row[l] * row[l];
            }
        }
        squares.map(f64::sqrt)
    }
}
