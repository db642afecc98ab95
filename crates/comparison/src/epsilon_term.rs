//! Size of the first-order vakonomic term `−ε C λ` along Chetaev's motion.

use equations::Compiled;
use scene::Scene;

use motion::{Metric, Motion, SolveError};

/// Change of the acceleration per unit of `ε`, and the acceleration itself: largest lengths in the kinetic
/// metric along the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EpsilonTerm {
    /// `|∂a/∂ε|` at `ε = 0`.
    pub slope: f64,
    /// `|a|`.
    pub acceleration: f64,
}

/// Of Chetaev's motion of a scene, at `count` instants; `None` without a constraint, or where the equations
/// of one of these instants are singular.
///
/// # Errors
/// [`SolveError`] where the motion cannot be read off.
pub fn epsilon_term(scene: &Scene, chetaev: &mut Motion, count: usize) -> Result<Option<EpsilonTerm>, SolveError> {
    let system = &scene.system;
    if system.constraints.is_empty() {
        return Ok(None);
    }
    let (g, n) = (&system.graph, system.dimension());
    // central differences lose least there
    let step = f64::EPSILON.cbrt() * (chetaev.end() - chetaev.start()).abs();
    let compiled = |epsilon: f64| Compiled::new(&first_order::law(system, g.number(epsilon), None));
    let mut laws = [compiled(-step)?, compiled(0.0)?, compiled(step)?];
    let mut metric = Metric::new(system)?;
    let mut found = EpsilonTerm { slope: 0.0, acceleration: 0.0 };
    for t in chetaev.grid(count) {
        let now = chetaev.at(t)?;
        let (q, v) = (&now.coordinates, &now.velocities);
        let (y, mut rates) = ([&q[..], v].concat(), [vec![0.0; 2 * n], vec![0.0; 2 * n], vec![0.0; 2 * n]]);
        if laws.iter_mut().zip(&mut rates).any(|(law, rates)| law.rates(t, &y, rates).is_err()) {
            return Ok(None);
        }
        let [before, at, after] = rates;
        let slope: Vec<f64> = (n..2 * n).map(|i| (after[i] - before[i]) / (2.0 * step)).collect();
        found.slope = found.slope.max(metric.length(t, q, v, &slope));
        found.acceleration = found.acceleration.max(metric.length(t, q, v, &at[n..]));
    }
    Ok(Some(found))
}
