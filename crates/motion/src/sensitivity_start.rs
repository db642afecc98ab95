//! Along which directions the start of a motion moves with numbers of its scene.

use mechanics::ConstantsRule;
use mechanics::linear::Factors;
use scene::Scene;

use crate::constants::constant_names;
use crate::differences::size;
use crate::direction::Direction;
use crate::{ByName, Choice, SolveError};

/// Those of the numbers that `by_name` has, at their values in the scene, other free constants fixed: the
/// motion of `choice` is set. Then those of all free constants, where these are natural at a horizon.
///
/// # Errors
/// [`SolveError`] without a start; [`SolveError::Member`] for a constant that is natural, or a number with
/// which the start does not move smoothly.
pub(crate) fn directions(
    by_name: &mut ByName,
    scene: &Scene,
    choice: &Choice,
) -> Result<[Vec<Direction>; 2], SolveError> {
    let varied = by_name.parameters();
    let varying = by_name.varying_mut();
    let all = &varying.prepared().constants;
    let parameters = all[all.len() - varied.len()..].to_vec();
    varying.set(&scene.start, &parameters, &choice.constants, false)?;
    let own = varying.constants().to_vec();
    let known = constant_names(&varying.prepared().equations);
    let constant = |name: &String| known[..own.len()].iter().position(|own| own == name);
    let is_natural = matches!(choice.constants, ConstantsRule::Natural { .. });
    if let Some(name) = by_name.names().iter().find(|name| is_natural && constant(name).is_some()) {
        let reason = format!("{name} is natural at a horizon: nothing can be derived by it");
        return Err(SolveError::Member { reason });
    }
    let prepared = by_name.varying().prepared();
    let value = |name: &String| {
        let symbol = prepared.equations.graph.find_symbol(name);
        let parameter = varied.iter().position(|s| Some(*s) == symbol).map(|i| parameters[i]);
        let start = || prepared.values.value(symbol?);
        constant(name).map(|i| own[i]).or(parameter).or_else(start).unwrap_or(0.0)
    };
    let row: Vec<f64> = by_name.names().iter().map(value).collect();
    let given = ConstantsRule::Given(own.clone());
    let mut along = by_name.directions(&row, Some(&given))?;
    by_name.varying_mut().set(&scene.start, &parameters, &given, false)?;
    let prepared = by_name.varying().prepared();
    for (direction, name) in along.iter_mut().zip(by_name.names()) {
        if let Some(i) = constant(name) {
            *direction = prepared.along_constant(i, direction.scale);
        }
    }
    let natural = (0..own.len()).filter(|_| is_natural).map(|i| prepared.along_constant(i, size(own[i]))).collect();
    Ok([along, natural])
}

/// Directions along which quantities that are natural at a horizon stay zero: to each of `along`, directions
/// of numbers with the derivatives `of_numbers` of these quantities, is added what the free `constants` have
/// to do, with the derivatives `of_constants`; `None` where these are dependent.
pub(crate) fn kept_natural(
    along: &mut [Direction],
    constants: &[Direction],
    of_numbers: &[Vec<f64>],
    of_constants: &[Vec<f64>],
) -> Option<()> {
    let m = constants.len();
    let mut factors = Factors::new(m);
    let matrix: Vec<f64> = (0..m * m).map(|i| of_constants[i % m][i / m]).collect();
    factors.factorize(&matrix).ok()?;
    for (direction, quantities) in along.iter_mut().zip(of_numbers) {
        let mut moves: Vec<f64> = quantities.iter().map(|x| -x).collect();
        factors.solve(&mut moves);
        for (by, constant) in moves.into_iter().zip(constants) {
            direction.start.iter_mut().zip(&constant.start).for_each(|(x, c)| *x += by * c);
            direction.constants.iter_mut().zip(&constant.constants).for_each(|(x, c)| *x += by * c);
        }
    }
    Some(())
}
