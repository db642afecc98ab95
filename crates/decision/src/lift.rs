//! Lift of a curve `q(t)` to the variables of a removal, where these are not coordinates.

use std::sync::Arc;

use equations::Equations;
use mechanics::elimination::{eliminate, largest, open};
use mechanics::{Removal, RemovalStart, State, System, complete_removal_start};
use symbolic::{Evaluator, Expr, Scalar, Symbol, Tape};

use crate::DecisionError;
use crate::exact::{Coefficient, Exact, Jet};
use crate::flow::inputs;
use crate::order_by_order::{NoSeries, SeriesSolve, order, sound};

/// `u`, `w` that are not coordinates, integrated beside the curve; `u̇`, `ü` by `q̇(u̇, u, w, t) = v` and on.
#[derive(Clone)]
pub(crate) struct Lift {
    /// Integrated `u` then `w`; then `u̇`, then `ü`.
    pub(crate) symbols: Vec<Symbol>,
    /// Number of `u` and of `w`.
    pub(crate) parameters: usize,
    pub(crate) memory: usize,
    pub(crate) coordinates: usize,
    /// `∂q̇/∂u̇` (n×m'), then `q̇ − v` at `u̇ = 0`.
    pub(crate) velocities: Arc<Tape>,
    /// `q̈ − a` at `ü = 0`, then the rates of `w` at `ü = 0`.
    pub(crate) accelerations: Arc<Tape>,
    /// Start values of the integrated `u`, `w` as written, in parameters, `t, q, v`; or the first missing.
    written: Arc<Tape>,
    missing: Option<String>,
    system: System,
    removal: Removal,
}

impl Lift {
    /// `None` where every variable of `removal` is a coordinate.
    pub(crate) fn new(
        system: &System,
        removal: &Removal,
        equations: &Equations,
    ) -> Result<Option<Self>, DecisionError> {
        let g = &system.graph;
        let unsuited = |reason: String| DecisionError::Unsuited { formulation: equations.formulation, reason };
        let own: Vec<_> = removal.parameters.iter().filter(|u| u.coordinate.is_none()).collect();
        let memory: Vec<_> = removal.memory.iter().filter(|w| w.coordinate.is_none()).collect();
        if own.is_empty() && memory.is_empty() {
            return Ok(None);
        }
        let rates: Vec<Symbol> = own.iter().map(|u| u.rate).collect();
        let seconds: Vec<Symbol> = own.iter().map(|u| u.second_rate).collect();
        let by_second = |e: Expr| removal.parameters.iter().any(|u| g.depends_on(e, u.second_rate));
        let slopes = g.jacobian(&equations.velocities, &rates);
        let bent = slopes.entries().iter().any(|&e| rates.iter().any(|&s| g.depends_on(e, s)));
        let second = equations.velocities.iter().chain(memory.iter().map(|w| &w.rate)).any(|&e| by_second(e));
        if bent || second {
            let what = if second { "contain second rates of" } else { "are not linear in the rates of" };
            return Err(unsuited(format!(
                "removal `{}`: velocities {what} its parameters, and a curve q(t) does not tell these without more start data",
                removal.name
            )));
        }
        let at_rest = rates.iter().map(|&s| (s, g.zero())).collect();
        let mut first = slopes.entries().to_vec();
        for (c, &v) in system.coordinates.iter().zip(&equations.velocities) {
            first.push(g.sub(g.substitute(v, &at_rest), g.variable(c.velocity)));
        }
        let coasting = seconds.iter().map(|&s| (s, g.zero())).collect();
        let flow = removal.flow(system);
        let mut then: Vec<Expr> = Vec::new();
        for (c, &v) in system.coordinates.iter().zip(&equations.velocities) {
            let rate = g.substitute(g.total_derivative(v, &flow), &coasting);
            then.push(g.sub(rate, g.variable(c.acceleration)));
        }
        then.extend(memory.iter().map(|w| w.rate));
        let missing =
            |s: &Symbol| !removal.start.contains_key(s) && removal.coordinates.iter().any(|&q| g.depends_on(q, *s));
        let mut symbols: Vec<Symbol> = own.iter().map(|u| u.symbol).chain(memory.iter().map(|w| w.symbol)).collect();
        let starts: Vec<Expr> =
            symbols.iter().map(|s| removal.start.get(s).copied().unwrap_or_else(|| g.zero())).collect();
        let written = g.tape(&inputs(system, &[]), &starts)?;
        let missing = symbols.iter().find(|s| missing(s)).map(|&s| g.name(s));
        let velocities = g.tape(&inputs(system, &symbols), &first)?;
        symbols.extend(&rates);
        let accelerations = g.tape(&inputs(system, &symbols), &then)?;
        symbols.extend(&seconds);
        Ok(Some(Lift {
            parameters: own.len(),
            memory: memory.len(),
            coordinates: system.dimension(),
            symbols,
            velocities,
            accelerations,
            written,
            missing,
            system: system.clone(),
            removal: removal.clone(),
        }))
    }

    /// Values of the integrated `u` and `w` where the curve starts.
    pub(crate) fn start(&self, state: &State) -> Result<Vec<f64>, DecisionError> {
        let RemovalStart { parameters, memory, .. } = complete_removal_start(&self.system, &self.removal, state)?;
        let value = |s: &Symbol| parameters.get(s).or_else(|| memory.get(s)).copied().unwrap_or(0.0);
        Ok(self.symbols[..self.parameters + self.memory].iter().map(value).collect())
    }

    /// Series of everything that the lift adds, along `curve`.
    pub(crate) fn series<C: Coefficient>(&self, curve: &[Jet<C>], orders: usize) -> Result<Vec<Jet<C>>, NoSeries>
    where
        Jet<C>: Scalar,
    {
        if let Some(name) = &self.missing {
            return Err(NoSeries::Unwritten { name: name.clone() });
        }
        let (n, m) = (self.coordinates, self.parameters);
        let first = Evaluator::<Jet<C>>::new(self.written.clone()).evaluate(curve).to_vec();
        sound(&first)?;
        let exact: Vec<_> = first.iter().map(Jet::exact).collect();
        let mut own: Vec<Vec<C>> = first.iter().map(|x| vec![x.coefficient(0)]).collect();
        let mut velocities = Evaluator::<Jet<C>>::new(self.velocities.clone());
        let mut accelerations = Evaluator::<Jet<C>>::new(self.accelerations.clone());
        let mut solves: Option<(Vec<usize>, SeriesSolve<C>, SeriesSolve<C>)> = None;
        for k in 1..=orders {
            let mut inputs = curve.to_vec();
            inputs.extend(own.iter().zip(&exact).map(|(x, exact)| Jet::series(x, *exact)));
            let values = velocities.evaluate(&inputs).to_vec();
            sound(&values)?;
            let (slopes, rest) = values.split_at(n * m);
            if solves.is_none() {
                let rows = independent_rows(&order(slopes, 0), m);
                let square = |rows: &[usize]| -> Vec<Jet<C>> {
                    rows.iter().flat_map(|&i| slopes[i * m..(i + 1) * m].to_vec()).collect()
                };
                let [one, two] = [(); 2].map(|()| SeriesSolve::new(&square(&rows), m, 1, "removal"));
                solves = Some((rows, one?, two?));
            }
            let Some((rows, speeds, seconds)) = &mut solves else { continue };
            let square: Vec<Jet<C>> = rows.iter().flat_map(|&i| slopes[i * m..(i + 1) * m].to_vec()).collect();
            let picked = |rest: &[Jet<C>]| rows.iter().map(|&i| rest[i].coefficient(k - 1)).collect::<Vec<C>>();
            speeds.next(&square, &picked(rest));
            let of = |solve: &SeriesSolve<C>, i: usize| {
                Jet::series(&solve.solved.iter().map(|z| z[i]).collect::<Vec<C>>(), None)
            };
            inputs.extend((0..m).map(|i| of(speeds, i)));
            let values = accelerations.evaluate(&inputs);
            sound(values)?;
            seconds.next(&square, &picked(values));
            if k == orders {
                let base = curve.len();
                let mut lifted = inputs[base..].to_vec();
                lifted.extend((0..m).map(|i| of(seconds, i)));
                return Ok(lifted);
            }
            let over = C::of(Exact::over(k)?)?;
            let rates: Vec<C> = speeds.solved[k - 1].iter().copied().chain(order(&values[n..], k - 1)).collect();
            for (x, rate) in own.iter_mut().zip(rates) {
                x.push(rate * over);
            }
        }
        Ok(Vec::new())
    }
}

/// Rows of a matrix of `columns` columns by which it has full rank; fewer where it has not.
fn independent_rows<C: Coefficient>(matrix: &[C], columns: usize) -> Vec<usize> {
    let column = |j: usize| matrix.iter().skip(j).step_by(columns).copied().collect();
    let mut transposed: Vec<Vec<C>> = (0..columns).map(column).collect();
    eliminate(&mut transposed, |rows, done| {
        largest(rows, open(rows, done, rows.first().map_or(0, Vec::len)).filter(|(i, _)| *i == done.len()))
    })
}
