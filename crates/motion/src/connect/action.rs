//! Quadrature, and by it the action of a motion, `∫ L dt`.

use mechanics::System;

use crate::band::INSTANTS;
use crate::{Motion, SolveError};

/// Nodes and weights of Gauss and Legendre on [−1, 1], four points; both signs.
const NODES: [[f64; 2]; 2] =
    [[0.339_981_043_584_856_3, 0.652_145_154_862_546_1], [0.861_136_311_594_052_6, 0.347_854_845_137_453_9]];

/// The action of all the motion and the difference of two quadratures, the second of twice as many panels.
pub(super) fn action(system: &System, motion: &mut Motion) -> Result<[f64; 2], SolveError> {
    let inputs = [system.positions(), system.velocities(), vec![system.time]].concat();
    let mut lagrangian = system.evaluator::<f64>(&inputs, &[system.lagrangian])?;
    let ends = [motion.start(), motion.end()];
    let mut at = |t: f64| {
        let at = motion.at(t)?;
        Ok(lagrangian.evaluate(&[&at.coordinates[..], &at.velocities, &[t]].concat())[0])
    };
    let (coarse, fine) = (integral(ends, INSTANTS, &mut at)?, integral(ends, 2 * INSTANTS, &mut at)?);
    Ok([fine, (fine - coarse).abs()])
}

/// The integral between two ends, by four points of Gauss and Legendre to a panel.
pub(super) fn integral(
    [start, end]: [f64; 2],
    panels: usize,
    at: &mut dyn FnMut(f64) -> Result<f64, SolveError>,
) -> Result<f64, SolveError> {
    let (mut sum, half) = (0.0, 0.5 * (end - start) / panels as f64);
    for panel in 0..panels {
        let middle = start + half * (2 * panel + 1) as f64;
        for [node, weight] in NODES {
            sum += half * weight * (at(middle - half * node)? + at(middle + half * node)?);
        }
    }
    Ok(sum)
}
