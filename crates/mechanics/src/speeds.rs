//! How fast each coordinate is with the same energy: what makes velocities of different units comparable.

use symbolic::Expr;

use crate::elimination::LinearForms;
use crate::{State, System};

impl System {
    /// `|∂²L/∂vᵢ²|^(−1/2)` at `state`, in the unit of the coordinate's velocity over that of `√L`. A
    /// coordinate without inertia has the least that makes it as fast as the others in one of the linear
    /// `constraints`; 1 where there is no such one.
    pub(crate) fn speeds(&self, constraints: &LinearForms, state: &State) -> Vec<f64> {
        let system = self.clone(); // second derivatives are built in a graph of their own
        let g = &system.graph;
        let values = system.values_at(state);
        let number = |e: Expr| g.evaluate(e, &values).unwrap_or(f64::NAN);
        let speed = |v| {
            let mass = number(g.derivative(g.derivative(system.lagrangian, v), v)).abs();
            Some(mass.sqrt().recip()).filter(|speed| speed.is_normal()).unwrap_or(0.0)
        };
        let known: Vec<f64> = system.velocities().into_iter().map(speed).collect();
        let rows: Vec<Vec<(usize, f64)>> =
            constraints.rows.iter().map(|row| row.iter().map(|(&j, &e)| (j, number(e).abs())).collect()).collect();
        let filled = |j: usize| {
            let largest = |row: &Vec<(usize, f64)>| row.iter().map(|(k, a)| a * known[*k]).fold(0.0, f64::max);
            let own = |row: &Vec<(usize, f64)>| row.iter().find(|(k, _)| *k == j).map(|(_, a)| *a);
            let speeds = rows.iter().filter_map(|row| Some(largest(row) / own(row)?));
            speeds.filter(|speed| speed.is_normal()).reduce(f64::min).unwrap_or(1.0)
        };
        (0..known.len()).map(|j| if known[j] > 0.0 { known[j] } else { filled(j) }).collect()
    }
}
