//! Curves and mismatches as power series in the time since the start.

use equations::Programs;
use symbolic::{Evaluator, Scalar};

use crate::curve::Dynamics;
use crate::exact::{Coefficient, Exact, Flaw, Jet, ORDERS, subtract_product};
use crate::family::{CostateRate, Family};
use crate::order_by_order::{NoSeries, SeriesSolve, one, order, sound};

/// A start in numbers of one kind, with their exact values where they are followed.
#[derive(Clone, Debug)]
pub struct SeriesStart<C> {
    /// As the system has them.
    pub parameters: Vec<Jet<C>>,
    /// `t₀`.
    pub time: Jet<C>,
    /// `q₀`.
    pub positions: Vec<Jet<C>>,
    /// `v₀`.
    pub velocities: Vec<Jet<C>>,
}

/// `q, v, a` along a curve, up to `s^{orders − 1}`, and what was divided by.
#[derive(Clone, Debug)]
pub struct CurveSeries<C> {
    /// Parameters, `t`, `q`, `v`, `a`: what a family asks for.
    pub inputs: Vec<Jet<C>>,
    /// All states, in the order of the equations.
    pub states: Vec<Jet<C>>,
    /// The unknowns of an instant, order by order.
    pub(crate) unknowns: Vec<Vec<C>>,
    /// Determinant of the equations of the first instant.
    pub(crate) determinant: C,
    /// Whether no state has a rate: where time stands nowhere, they stay for ever.
    pub(crate) at_rest: bool,
}

/// `t₀ + s`
fn time<C: Coefficient>(start: &Jet<C>, orders: usize) -> Result<Jet<C>, Flaw> {
    let mut coefficients = vec![C::ZERO; orders];
    coefficients[0] = start.coefficient(0);
    if orders > 1 {
        coefficients[1] = one()?;
    }
    Ok(Jet::series(&coefficients, start.exact()))
}

impl Dynamics {
    /// The solution through `start` with these free constants, `orders` coefficients of it.
    ///
    /// # Errors
    /// [`NoSeries`]: a number without an image, or equations that are singular there.
    pub fn series<C: Coefficient>(
        &self,
        start: &SeriesStart<C>,
        constants: &[Jet<C>],
        orders: usize,
    ) -> Result<CurveSeries<C>, NoSeries>
    where
        Jet<C>: Scalar,
    {
        let orders = orders.min(ORDERS);
        let at_start =
            [&start.parameters[..], std::slice::from_ref(&start.time), &start.positions, &start.velocities, constants]
                .concat();
        let first = Evaluator::<Jet<C>>::new(self.start.clone()).evaluate(&at_start).to_vec();
        let exact: Vec<Option<Exact>> = first.iter().map(Jet::exact).collect();
        if let Some(flaw) = first.iter().find_map(Jet::own_flaw) {
            return Err(flaw.into());
        }
        let mut states: Vec<Vec<C>> = first.iter().map(|y| vec![y.coefficient(0)]).collect();
        let parameters: Vec<Jet<C>> = self.parameters.iter().map(|&i| start.parameters[i]).collect();
        let mut programs = Programs::<Jet<C>>::plain(&self.instant);
        let mut solves: Vec<SeriesSolve<C>> = Vec::new();
        loop {
            let k = states.first().map_or(orders, Vec::len);
            let mut inputs = vec![time(&start.time, k)?];
            inputs.extend(states.iter().zip(&exact).map(|(y, exact)| Jet::series(y, *exact)));
            inputs.extend(constants.iter().chain(&parameters));
            let known = inputs.len();
            for (i, (program, &size)) in programs.blocks.iter_mut().zip(&self.blocks).enumerate() {
                let values = program.evaluate(&inputs[..known]);
                sound(values)?;
                let (matrix, rest) = values.split_at(size * size);
                if i == solves.len() {
                    solves.push(SeriesSolve::new(matrix, size, 1, "curve")?);
                }
                let solve = &mut solves[i];
                solve.next(matrix, &order(rest, k - 1));
                let unknown = |i| Jet::series(&solve.solved.iter().map(|z| z[i]).collect::<Vec<C>>(), None);
                inputs.extend((0..size).map(unknown));
            }
            if k < orders {
                let rates = programs.rates.evaluate(&inputs);
                sound(rates)?;
                let over = C::of(Exact::over(k)?)?;
                for (y, rate) in states.iter_mut().zip(rates) {
                    y.push(rate.coefficient(k - 1) * over);
                }
                continue;
            }
            let point = programs.outputs.evaluate(&inputs);
            if let Some(flaw) = point.iter().find_map(Jet::own_flaw) {
                return Err(flaw.into());
            }
            let mut inputs = start.parameters.clone();
            inputs.push(time(&start.time, orders)?);
            inputs.extend(point);
            let unknowns = |k: usize| solves.iter().flat_map(|solve| solve.solved[k].iter().copied()).collect();
            return Ok(CurveSeries {
                inputs,
                states: states.iter().zip(&exact).map(|(y, exact)| Jet::series(y, *exact)).collect(),
                determinant: solves.iter().fold(one()?, |product, solve| product * solve.determinant),
                unknowns: (0..orders).map(unknowns).collect(),
                at_rest: states.iter().all(|y| y[1..].iter().take(1).all(|rate| rate.weight() == 0.0)),
            });
        }
    }
}

/// The mismatch `y(s) = O(s) c + y₀(s)` of a family along a curve.
#[derive(Clone, Debug)]
pub(crate) struct MismatchSeries<C> {
    /// `orders[k]`: rows of `[O_k | y₀_k]`, one for each acceleration of the family, constants + 1 wide.
    pub(crate) orders: Vec<Vec<C>>,
    /// The same as accelerations of the coordinates, n rows.
    pub(crate) accelerations: Vec<Vec<C>>,
    pub(crate) width: usize,
    /// `M` and `A` at the start.
    pub(crate) mass: Vec<C>,
    pub(crate) jacobian: Vec<C>,
    /// Whether curve and lift are at rest.
    pub(crate) at_rest: bool,
}

impl Family {
    /// Its mismatch along `curve`, as many orders as that has.
    pub(crate) fn series<C: Coefficient>(
        &self,
        curve: &CurveSeries<C>,
        orders: usize,
    ) -> Result<MismatchSeries<C>, NoSeries>
    where
        Jet<C>: Scalar,
    {
        let shape = &self.shape;
        let mut inputs = curve.inputs.clone();
        let mut at_rest = curve.at_rest;
        if let Some(lift) = &self.lift {
            let lifted = lift.series(&curve.inputs, orders)?;
            at_rest &= lifted[..lift.parameters + lift.memory].iter().all(|x| x.coefficient(1).weight() == 0.0);
            inputs.extend(lifted);
        }
        let values = self.evaluator::<Jet<C>>().evaluate(&inputs).to_vec();
        sound(&values)?;
        let instant = shape.instant(&values);
        let (size, k, width) = (shape.unknowns, shape.costates, shape.constants + 1);
        let start = self.start(&inputs);
        sound(&start)?;
        // η, order by order: k rows of `width`
        let mut costates: Vec<Vec<C>> = vec![order(&start, 0)];
        let mut solve = SeriesSolve::new(instant.matrix, size, width, "family")?;
        let along = |costates: &[Vec<C>], rows: &dyn Fn(usize) -> Vec<C>, rest: &[C], at: usize| {
            let mut sum = vec![C::ZERO; rest.len() * width];
            for j in 0..=at {
                subtract_product(&mut sum, &rows(j), &costates[at - j], k, width);
            }
            let mut sum: Vec<C> = sum.into_iter().map(|x| -x).collect();
            for (i, &r) in rest.iter().enumerate() {
                sum[(i + 1) * width - 1] = sum[(i + 1) * width - 1] + r;
            }
            sum
        };
        for at in 0..orders {
            let rest = along(&costates, &|j| order(instant.by_costate, j), &order(instant.rest, at), at);
            solve.next(instant.matrix, &rest);
            let explicit = |j: usize| -> Vec<C> {
                let rows = instant.explicit.chunks_exact(k + 1);
                rows.flat_map(|row| order(&row[..k], j)).collect()
            };
            let rest: Vec<C> = instant.explicit.chunks_exact(k + 1).map(|row| row[k].coefficient(at)).collect();
            let explicit = along(&costates, &explicit, &rest, at);
            let over = C::of(Exact::over(at + 1)?)?;
            let mut next = Vec::with_capacity(k * width);
            for rate in &shape.rates {
                let (from, place) = match *rate {
                    CostateRate::Unknown(place) => (&solve.solved[at], place),
                    CostateRate::Explicit(place) => (&explicit, place),
                };
                next.extend(from[place * width..(place + 1) * width].iter().map(|&x| x * over));
            }
            costates.push(next);
        }
        let rows = |z: &Vec<C>| -> Vec<C> {
            shape.accelerations.iter().flat_map(|&i| z[i * width..(i + 1) * width].to_vec()).collect()
        };
        let unknowns: Vec<Vec<C>> = solve.solved.iter().map(rows).collect();
        let count = shape.accelerations.len();
        let accelerations = (0..orders).map(|at| {
            let mut sum = vec![C::ZERO; shape.coordinates * width];
            for j in 0..=at {
                subtract_product(&mut sum, &order(instant.to_acceleration, j), &unknowns[at - j], count, width);
            }
            sum.into_iter().map(|x| -x).collect()
        });
        let accelerations = accelerations.collect();
        let (mass, jacobian) = (order(instant.mass, 0), order(instant.jacobian, 0));
        Ok(MismatchSeries { accelerations, orders: unknowns, width, mass, jacobian, at_rest })
    }
}
