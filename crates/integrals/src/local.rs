//! A system at a random point: `M`, `N` and `V` as power series there.

use std::sync::Arc;

use decision::exact::{Echelon, Exact, Jet, Modular};
use decision::{ExactStart, SeriesStart};
use mechanics::System;
use symbolic::{Evaluator, Expr, Tape};

use crate::Open;
use crate::ring::{MOST, Rays, Ring, Series, count, minus};

/// `L = ½ vᵀM(q)v − V(q)`, `A(q)v = 0`, as a program.
#[derive(Clone)]
pub(crate) struct Reversible {
    /// From parameters and `q`: `A` (h×n), `M` (n×n), `V`.
    program: Arc<Tape>,
    pub(crate) coordinates: usize,
    pub(crate) constraints: usize,
    /// `g`, then `∂g/∂q` row by row, of the constraints on positions.
    leaf: Arc<Tape>,
    on_positions: usize,
    /// Places of the coordinates that any of these, or a constraint on positions, contains.
    pub(crate) present: Vec<usize>,
    /// Places of coordinates, those first whose velocities `A(q)v = 0` is solved for where it can be.
    pub(crate) order: Vec<usize>,
}

/// Series at a point: of `M`, `V` and a basis of `ker A`.
pub(crate) struct Local {
    pub(crate) mass: Vec<Vec<Series>>,
    pub(crate) potential: Series,
    /// `N`, column by column: `v = Σ_b s^b N_b`.
    pub(crate) basis: Vec<Vec<Series>>,
    /// Places of the free velocities `s`.
    pub(crate) free: Vec<usize>,
    /// `g_ab = N_aᵀ M N_b`.
    pub(crate) metric: Vec<Vec<Series>>,
    /// `g^{ab}`.
    pub(crate) inverse: Vec<Vec<Series>>,
}

impl Reversible {
    /// # Errors
    /// [`Open`]: what stands in `L` or `f` that has no place there.
    pub(crate) fn new(system: &System) -> Result<Self, Open> {
        let (g, v) = (&system.graph, system.velocities());
        if system.has_forces() {
            return Err(Open::Forces);
        }
        if !system.virtual_conditions.is_empty() {
            return Err(Open::OwnReactions);
        }
        if !system.is_autonomous() {
            return Err(Open::Time);
        }
        let (mass, jacobian) = (system.velocity_hessian(), system.constraint_jacobian());
        let free = |es: &[Expr]| es.iter().all(|&e| v.iter().all(|&v| !g.depends_on(e, v)));
        let momenta = system.at_rest(&g.gradient(system.lagrangian, &v));
        if !free(mass.entries()) || !momenta.iter().all(|&e| g.vanishes_exactly(system.as_written(e))) {
            return Err(Open::NotQuadratic);
        }
        let offsets = system.at_rest(&system.constraints);
        if !free(jacobian.entries()) || !offsets.iter().all(|&e| g.vanishes_exactly(system.as_written(e))) {
            return Err(Open::NotHomogeneous);
        }
        let outputs = [jacobian.entries(), mass.entries(), &[g.neg(system.at_rest(&[system.lagrangian])[0])]].concat();
        let mut inputs: Vec<_> = system.parameters.iter().map(|p| p.symbol).collect();
        let positions = system.positions();
        let on_positions: Vec<Expr> = system.on_positions.iter().map(|(_, e)| *e).collect();
        let present = |q: &usize| outputs.iter().chain(&on_positions).any(|&e| g.depends_on(e, positions[*q]));
        let present = (0..positions.len()).filter(present).collect();
        inputs.extend(&positions);
        let program = g.tape(&inputs, &outputs).map_err(|fault| Open::Other(fault.to_string()))?;
        let order = (0..positions.len()).collect();
        let leaf = [&on_positions[..], g.jacobian(&on_positions, &positions).entries()].concat();
        let leaf = g.tape(&inputs, &leaf).map_err(|fault| Open::Other(fault.to_string()))?;
        let (coordinates, constraints, on_positions) = (positions.len(), system.constraints.len(), on_positions.len());
        Ok(Reversible { program, coordinates, constraints, leaf, on_positions, present, order })
    }

    /// The same, solved for the velocities of these coordinates first.
    pub(crate) fn solved_for(mut self, dependent: &[usize]) -> Self {
        let rest = (0..self.coordinates).filter(|i| !dependent.contains(i));
        self.order = dependent.iter().copied().chain(rest).collect();
        self
    }

    /// The dimension of the leaf on which constraints on positions hold.
    pub(crate) fn dimension(&self) -> usize {
        self.coordinates - self.on_positions
    }

    /// Places of the coordinates that none of these contains.
    pub(crate) fn cyclic(&self) -> Vec<usize> {
        (0..self.coordinates).filter(|i| !self.present.contains(i)).collect()
    }

    /// Its series to an order at `point`, in `q − q₀` for the coordinates that are present.
    pub(crate) fn near(&self, point: &SeriesStart<Modular>, order: usize, seed: u64) -> Result<(Ring, Local), Open> {
        let weights = vec![1; self.present.len()];
        count(&weights, order, MOST).ok_or(Open::Size { order, most: MOST })?;
        let ring = Ring::new(&weights, self.present.clone(), order);
        let rays = Rays::new(&ring, &mut draws(seed)).ok_or(Open::Accident)?;
        let local = self.at(point, &ring, &rays, &straight(&ring, self.coordinates, &self.present))?;
        Ok((ring, local))
    }

    /// `chart`, moved onto the leaf `g = 0` of `point` by as many coordinates as there are `g`, by Newton's
    /// steps: each makes twice as many weights right.
    pub(crate) fn on_leaf(
        &self,
        point: &SeriesStart<Modular>,
        ring: &Ring,
        rays: &Rays,
        mut chart: Vec<Series>,
    ) -> Result<Vec<Series>, Open> {
        let (n, k, mut right) = (self.coordinates, self.on_positions, 1);
        while k > 0 && right <= ring.order {
            let all = along(&self.leaf, point, ring, rays, &chart)?;
            let columns = |j: usize| -> Vec<Series> { (0..k).map(|i| all[k + i * n + j].clone()).collect() };
            let mut span = Echelon::default();
            let given: Vec<usize> = (0..n).filter(|&j| span.add(columns(j).iter().map(|x| x[0]).collect())).collect();
            let slopes: Vec<Vec<Series>> =
                (0..k).map(|i| given.iter().map(|&j| all[k + i * n + j].clone()).collect()).collect();
            let over = ring.inverse(&slopes).ok_or(Open::Accident)?;
            for (&j, step) in given.iter().zip(row_times(ring, &over, &all[..k])) {
                chart[j] = minus(&chart[j], &step);
            }
            right *= 2;
        }
        Ok(chart)
    }

    /// Its series at `point`, where `q − q₀ = chart(z)`, without constant terms.
    pub(crate) fn at(
        &self,
        point: &SeriesStart<Modular>,
        ring: &Ring,
        rays: &Rays,
        chart: &[Series],
    ) -> Result<Local, Open> {
        let (n, h) = (self.coordinates, self.constraints);
        let all = along(&self.program, point, ring, rays, chart)?;
        let mut rows: Vec<Vec<Series>> = all[..h * n].chunks_exact(n).map(<[Series]>::to_vec).collect();
        let mass: Vec<Vec<Series>> = all[h * n..h * n + n * n].chunks_exact(n).map(<[Series]>::to_vec).collect();
        let order = &self.order;
        rows.iter_mut().for_each(|row| *row = order.iter().map(|&i| row[i].clone()).collect());
        let pivots = ring.eliminate(&mut rows, n).ok_or(Open::Rank)?;
        let pivots: Vec<usize> = pivots.into_iter().map(|place| order[place]).collect();
        let place = |i: usize| order.iter().position(|&o| o == i);
        let column = |free: usize| -> Vec<Series> {
            let entry = |i: usize| match pivots.iter().position(|&pivot| pivot == i) {
                Some(row) => place(free).map_or(ring.zero(), |at| minus(&ring.zero(), &rows[row][at])),
                None if i == free => ring.constant(Modular::one()),
                None => ring.zero(),
            };
            (0..n).map(entry).collect()
        };
        let free: Vec<usize> = (0..n).filter(|i| !pivots.contains(i)).collect();
        let basis: Vec<Vec<Series>> = free.iter().map(|&i| column(i)).collect();
        let momenta: Vec<Vec<Series>> = basis.iter().map(|x| row_times(ring, &mass, x)).collect();
        let metric: Vec<Vec<Series>> =
            basis.iter().map(|a| momenta.iter().map(|b| ring.dot(a.iter().zip(b))).collect()).collect();
        let inverse = ring.inverse(&metric).ok_or(Open::Singular)?;
        Ok(Local { mass, potential: all[h * n + n * n].clone(), basis, free, metric, inverse })
    }
}

/// The outputs of a program at `q₀ + chart(z)`.
fn along(
    program: &Arc<Tape>,
    point: &SeriesStart<Modular>,
    ring: &Ring,
    rays: &Rays,
    chart: &[Series],
) -> Result<Vec<Series>, Open> {
    let mut evaluator = Evaluator::<Jet<Modular>>::new(program.clone());
    let mut values: Vec<Vec<Jet<Modular>>> = Vec::with_capacity(rays.values.len());
    for monomials in &rays.values {
        let mut inputs = point.parameters.clone();
        for (q, chart) in point.positions.iter().zip(chart) {
            let part = |k: usize| {
                let places = ring.of_weight(k);
                places.fold(Modular::ZERO, |sum, place| sum + chart[place] * monomials[place])
            };
            let mut coefficients: Vec<Modular> = (0..=ring.order).map(part).collect();
            coefficients[0] = q.coefficient(0);
            inputs.push(Jet::series(&coefficients, q.exact()));
        }
        let outputs = evaluator.evaluate(&inputs);
        if let Some(flaw) = outputs.iter().find_map(Jet::flaw) {
            return Err(Open::Flaw(flaw));
        }
        values.push(outputs.to_vec());
    }
    let series = |i: usize| rays.series(ring, &|ray, k| values[ray][i].coefficient(k));
    Ok((0..values.first().map_or(0, Vec::len)).map(series).collect())
}

/// `M x`.
pub(crate) fn row_times(ring: &Ring, matrix: &[Vec<Series>], x: &[Series]) -> Vec<Series> {
    matrix.iter().map(|row| ring.dot(row.iter().zip(x))).collect()
}

/// Random elements of the field.
pub(crate) fn draws(seed: u64) -> impl FnMut() -> Modular {
    let mut random = symbolic::SplitMix::new(seed);
    move || Modular::new(random.bits())
}

/// `q_i = q₀_i + z_i` for the coordinates that are present, the others held.
fn straight(ring: &Ring, coordinates: usize, present: &[usize]) -> Vec<Series> {
    let variable = |i: usize| {
        let mut series = ring.zero();
        if let Some(place) = present.iter().position(|&p| p == i) {
            let of = ring
                .monomials
                .iter()
                .position(|m| m.iter().enumerate().all(|(j, &e)| (j == place) == (e == 1) && e < 2));
            if let Some(of) = of {
                series[of] = Modular::one();
            }
        }
        series
    };
    (0..coordinates).map(variable).collect()
}

/// `compute` at a random point of the start's branch, of as large numbers as are taken.
pub(crate) fn at_random<T>(
    start: &ExactStart,
    seed: u64,
    mut compute: impl FnMut(&SeriesStart<Modular>) -> Result<T, Open>,
) -> Result<T, Open> {
    let mut fault = None;
    let found = decision::at_random(start, seed, |point| {
        compute(&point).map_err(|open| {
            let text = open.to_string();
            fault.get_or_insert(open);
            text
        })
    });
    found.map_err(|text| fault.unwrap_or(Open::Other(text)))
}

/// `1/k!`, as far as is needed.
pub(crate) fn over_factorial(k: u8) -> Modular {
    let over = (2..=k).map(|k| Exact::ratio(1, k.into()).and_then(Modular::fraction));
    over.fold(Modular::one(), |product, x| product * x.unwrap_or(Modular::ZERO))
}
