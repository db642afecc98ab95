//! Along which directions the start of a motion moves with numbers of its scene.

use mechanics::ConstantsRule;
use mechanics::linear::Factors;
use scene::Scene;

use crate::constants::constant_names;
use crate::differences::size;
use crate::direction::Direction;
use crate::{ByName, Choice, SolveError};

/// Those of the numbers that `by_name` has, at their values in the scene: each alone, so that formulas of
/// others follow it, and other free constants fixed. The motion of `choice` is set. Then those of all free
/// constants, where these are natural at a horizon.
///
/// # Errors
/// [`SolveError`] without a start; [`SolveError::Member`] for a constant that is natural, or a number with
/// which the start does not move smoothly.
pub(crate) fn directions(
    by_name: &mut ByName,
    scene: &Scene,
    choice: &Choice,
) -> Result<[Vec<Direction>; 2], SolveError> {
    let (varied, names) = (by_name.parameters(), by_name.names().to_vec());
    let varying = by_name.varying_mut();
    let all = &varying.prepared().constants;
    let parameters = all[all.len() - varied.len()..].to_vec();
    varying.set(&scene.start, &parameters, &choice.constants, false)?;
    let own = varying.constants().to_vec();
    let given = ConstantsRule::Given(own.clone());
    let known = constant_names(&varying.prepared().equations);
    let is_natural = matches!(choice.constants, ConstantsRule::Natural { .. });
    let mut along = Vec::new();
    for name in &names {
        let prepared = varying.prepared();
        if let Some(i) = known[..own.len()].iter().position(|own| own == name) {
            if is_natural {
                let reason = format!("{name} is natural at a horizon: nothing can be derived by it");
                return Err(SolveError::Member { reason });
            }
            along.push(prepared.along_constant(i, size(own[i])));
            continue;
        }
        let symbol = prepared.equations.graph.find_symbol(name);
        let parameter = varied.iter().position(|s| Some(*s) == symbol);
        let start = || prepared.values.value(symbol?);
        let value = parameter.map(|i| parameters[i]).or_else(start).unwrap_or(0.0);
        let mut starts = scene.starts(&[name]).map_err(|error| SolveError::Scene(Box::new(error)))?;
        let direction = Direction::by(name, value, size(value), &mut |x| {
            let start = starts.at(&[x]).map_err(|fault| SolveError::Member { reason: fault.to_string() })?;
            let mut parameters = parameters.clone();
            parameter.into_iter().for_each(|i| parameters[i] = x);
            varying.set(&start.state, &parameters, &given, false)?;
            Ok(varying.prepared().start_and_constants())
        });
        // the start that was there first
        varying.set(&scene.start, &parameters, &given, false)?;
        along.push(direction?);
    }
    let prepared = varying.prepared();
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
