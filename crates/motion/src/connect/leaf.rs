//! Integrable constraints: ends on another leaf than the start.

use mechanics::{State, System};
use symbolic::limits::SAME;

use crate::SolveError;
use crate::band::INSTANTS;
use crate::connect::action::integral;

/// Why no motion leads from `start` to the coordinates `end`: a constraint that is the rate of a function of
/// the position, `A_i·v = dh_i/dt` with `∂A_ij/∂q_k = ∂A_ik/∂q_j` identically, and h_i has another value
/// there. The difference is `∫ A_i·dq` along the straight line.
pub(super) fn other_leaf(system: &System, start: &State, end: &[f64]) -> Result<Option<String>, SolveError> {
    let g = &system.graph;
    let Ok(forms) = system.linear_constraints() else { return Ok(None) };
    let (positions, jacobian) = (system.positions(), system.constraint_jacobian());
    let (n, entries) = (positions.len(), jacobian.entries());
    let is_rate = |i: usize| {
        let row = &entries[i * n..(i + 1) * n];
        let alike = |j: usize, k: usize| {
            g.vanishes_exactly(g.sub(g.derivative(row[j], positions[k]), g.derivative(row[k], positions[j])))
        };
        g.is_zero(forms.offsets[i])
            && row.iter().all(|&a| !g.depends_on(a, system.time))
            && (0..n).all(|j| (0..j).all(|k| alike(j, k)))
    };
    let inputs = [positions.clone(), vec![system.time]].concat();
    for i in (0..system.constraints.len()).filter(|&i| is_rate(i)) {
        let mut row = system.evaluator::<f64>(&inputs, &entries[i * n..(i + 1) * n])?;
        let mut sum = |of: fn(f64) -> f64| {
            integral([0.0, 1.0], 2 * INSTANTS, &mut |part| {
                let q = start.q.iter().zip(end).map(|(a, b)| a + part * (b - a));
                let at: Vec<f64> = q.chain([start.t]).collect();
                let terms = row.evaluate(&at).iter().zip(start.q.iter().zip(end)).map(|(a, (p, q))| a * (q - p));
                Ok(terms.map(of).sum())
            })
        };
        let (change, size) = (sum(|x| x)?, sum(f64::abs)?);
        if change.abs() > SAME * size {
            let constraint = g.plain(system.constraints[i]);
            return Ok(Some(format!(
                "`{constraint}` is the rate of a function of the position, constant along every motion; at the end it \
                 is another by {change:.6}"
            )));
        }
    }
    Ok(None)
}
