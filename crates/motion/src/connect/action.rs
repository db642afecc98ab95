//! The action of a motion, `∫ L dt`, by quadrature.

use mechanics::System;

use crate::{Motion, SolveError};

/// Panels of the coarser quadrature.
const PANELS: usize = 48;
/// Nodes and weights of Gauss and Legendre on [−1, 1], four points; both signs.
const NODES: [[f64; 2]; 2] =
    [[0.339_981_043_584_856_3, 0.652_145_154_862_546_1], [0.861_136_311_594_052_6, 0.347_854_845_137_453_9]];

/// The action of all the motion and the difference of two quadratures, the second of twice as many panels.
pub(super) fn action(system: &System, motion: &mut Motion) -> Result<[f64; 2], SolveError> {
    let inputs = [system.positions(), system.velocities(), vec![system.time]].concat();
    let mut lagrangian = system.evaluator::<f64>(&inputs, &[system.lagrangian])?;
    let (start, end) = (motion.start(), motion.end());
    let mut integral = |panels: usize| -> Result<f64, SolveError> {
        let (mut sum, half) = (0.0, 0.5 * (end - start) / panels as f64);
        for panel in 0..panels {
            let middle = start + half * (2 * panel + 1) as f64;
            for [node, weight] in NODES {
                for t in [middle - half * node, middle + half * node] {
                    let at = motion.at(t)?;
                    let values = [&at.coordinates[..], &at.velocities, &[t]].concat();
                    sum += half * weight * lagrangian.evaluate(&values)[0];
                }
            }
        }
        Ok(sum)
    };
    let (coarse, fine) = (integral(PANELS)?, integral(2 * PANELS)?);
    Ok([fine, (fine - coarse).abs()])
}
