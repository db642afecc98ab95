//! Residual of Lagrange's equations of `L` with the constraint substituted into it, which are wrong.

use mechanics::Removal;
use nalgebra::{DMatrix, DVector};
use scene::Scene;
use symbolic::{Evaluator, Symbol};

use crate::JudgeError;
use crate::balance::Instant;
use crate::regression::rms;

/// The least of what is left of them, rms, over the removals of the scene whose parameters and memory
/// variables are coordinates, and the name of that removal; none without such a removal, and with forces.
/// Where none can be derived either, there is none: the scene's own were read with it.
pub fn substituted(scene: &Scene, instants: &[Instant]) -> Result<Option<(f64, String)>, JudgeError> {
    if scene.system.has_forces() {
        return Ok(None);
    }
    let Ok(removals) = motion::removals(scene) else { return Ok(None) };
    let mut least: Option<(f64, String)> = None;
    for removal in removals {
        if let Some(left) = left_by(scene, &removal, instants)?
            && least.as_ref().is_none_or(|(least, _)| left < *least)
        {
            least = Some((left, removal.name));
        }
    }
    Ok(least)
}

fn left_by(scene: &Scene, removal: &Removal, instants: &[Instant]) -> Result<Option<f64>, JudgeError> {
    let system = &scene.system;
    let parameters: Option<Vec<usize>> = removal.parameters.iter().map(|u| u.coordinate).collect();
    let memory: Option<Vec<usize>> = removal.memory.iter().map(|w| w.coordinate).collect();
    let (Some(parameters), Some(memory)) = (parameters, memory) else { return Ok(None) };
    let g = &system.graph;
    let residuals = review::substitution::residuals(system, removal);
    let seconds: Vec<Symbol> = removal.parameters.iter().map(|u| u.second_rate).collect();
    let outputs = [&residuals[..], g.jacobian(&residuals, &seconds).entries()].concat();
    let own = removal.parameters.iter().flat_map(|u| [u.symbol, u.rate, u.second_rate]);
    let mut symbols = vec![system.time];
    symbols.extend(own.chain(removal.memory.iter().map(|w| w.symbol)));
    let mut program = Evaluator::<f64>::new(g.compile(&symbols, &outputs, &system.parameter_values())?);
    let m = parameters.len();
    let mut squares = Vec::new();
    for i in instants {
        let mut numbers = vec![i.t];
        numbers.extend(parameters.iter().flat_map(|&u| [i.state[0][u], i.state[1][u], i.state[2][u]]));
        numbers.extend(memory.iter().map(|&w| i.state[0][w]));
        let values = program.evaluate(&numbers);
        let residual = DVector::from_column_slice(&values[..m]);
        let inertia = DMatrix::from_row_slice(m, m, &values[m..]);
        let Some(divided) = inertia.cholesky().and_then(|c| c.l().solve_lower_triangular(&residual)) else {
            return Ok(None);
        };
        squares.push(divided.norm());
    }
    Ok(Some(rms(squares)).filter(|left| left.is_finite()))
}
