//! Constraints on positions, solved for a coordinate each: what is left are the motions on the leaf of a
//! start.

use std::collections::HashMap;

use symbolic::limits::SAME;
use symbolic::{Expr, Symbol};

use crate::{State, System};

impl System {
    /// The system and its state in the coordinates of the leaf `g(q, t) = 0` of `state`: each `g` that is
    /// linear or quadratic in a coordinate gives that, on the branch of `state`, which is put into all
    /// constraints and left out. Other `g` stay. `L` stays as it is, and the rest has a graph of its own.
    pub(crate) fn on_leaf(&self, state: &State) -> (System, State) {
        let (mut rest, mut state) = (self.clone(), state.clone());
        while let Some((which, i, value)) = rest.solved_position(&state) {
            let g = &rest.graph;
            let coordinate = &rest.coordinates[i];
            let rate = g.total_derivative(value, &rest.flow());
            let put_in = HashMap::from([(coordinate.position, value), (coordinate.velocity, rate)]);
            let all = g.substitute_all(&rest.constraints, &put_in);
            let others: Vec<Expr> = rest.on_positions.iter().map(|(_, g)| *g).collect();
            let others = g.substitute_all(&others, &put_in);
            let (place, _) = rest.on_positions[which];
            let later = |at: usize| at - usize::from(at > place);
            let left = rest.on_positions.iter().zip(others).enumerate().filter(|(k, _)| *k != which);
            rest.on_positions = left.map(|(_, ((at, _), g))| (later(*at), g)).collect();
            rest.constraints = all;
            rest.constraints.remove(place);
            rest.coordinates.remove(i);
            rest.forces.remove(i);
            rest.virtual_conditions.clear();
            state.q.remove(i);
            state.v.remove(i);
        }
        (rest, state)
    }

    /// A constraint on positions, the coordinate that it gives, and how.
    fn solved_position(&self, state: &State) -> Option<(usize, usize, Expr)> {
        let g = &self.graph;
        let values = self.values_at(state);
        let number = |e: Expr| g.evaluate(e, &values).ok().filter(|x| x.is_finite()).unwrap_or(0.0);
        self.on_positions.iter().enumerate().find_map(|(which, &(_, e))| {
            let slopes: Vec<Expr> = self.coordinates.iter().map(|c| g.derivative(e, c.position)).collect();
            let numbers: Vec<f64> = slopes.iter().map(|&slope| number(slope)).collect();
            let largest = numbers.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
            let given = (0..slopes.len()).filter(|&i| numbers[i].abs() > SAME * largest);
            let given = given.filter_map(|i| {
                let s = self.coordinates[i].position;
                let value = self.value_of(e, s, slopes[i], numbers[i])?;
                Some((g.size(&[value]), i, value))
            });
            given.min_by_key(|(size, ..)| *size).map(|(_, i, value)| (which, i, value))
        })
    }

    /// `s` with `e = a s² + b s + c = 0`, where `∂e/∂s = 2 a s + b = ±√(b² − 4 a c)` has the sign of
    /// `at_start`.
    fn value_of(&self, e: Expr, s: Symbol, slope: Expr, at_start: f64) -> Option<Expr> {
        let g = &self.graph;
        let at_zero = |e: Expr| g.substitute(e, &HashMap::from([(s, g.zero())]));
        let (b, c) = (at_zero(slope), at_zero(e));
        let twice_a = g.derivative(slope, s);
        if g.is_zero(twice_a) {
            return Some(g.neg(g.div(c, b)));
        }
        if g.depends_on(twice_a, s) {
            return None;
        }
        let root = g.sqrt(g.sub(g.powi(b, 2), g.product(&[g.integer(2), twice_a, c])));
        Some(g.div(g.sub(if at_start < 0.0 { g.neg(root) } else { root }, b), twice_a))
    }
}
