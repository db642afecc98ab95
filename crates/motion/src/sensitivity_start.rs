//! Along which directions the start of a motion moves with numbers of its scene.
//!
//! A number moves the start by way of formulas, of velocities that constraints supply, of a projection, of
//! the variables of a removal and of momenta: a smooth map to `y(t₀)` that costs microseconds and is right to
//! the last digits: its derivative is a difference ([`crate::differences`]).

use mechanics::ConstantsRule;
use mechanics::linear::Factors;
use scene::{Scene, Starts};

use crate::constants::constant_names;
use crate::differences::{derivative, size};
use crate::direction::Direction;
use crate::{ByName, Choice, Prepared, SolveError, Varying};

/// The numbers that a start depends on: those of names, then the free constants.
pub(crate) struct Numbers<'a> {
    pub(crate) varying: Varying,
    scene: &'a Scene,
    /// Values of the parameters that vary, and of the other free constants.
    parameters: Vec<f64>,
    own: Vec<f64>,
    numbers: Vec<Number>,
}

/// One of them.
struct Number {
    name: String,
    value: f64,
    moves: Moves,
}

/// What moves with a number.
enum Moves {
    /// The start, by the formulas and conditions of the scene, and this parameter, if it is one.
    Start(Box<Starts>, Option<usize>),
    Constant(usize),
}

impl<'a> Numbers<'a> {
    /// As `choice` has them, with those constants that its rule gives.
    pub(crate) fn new(by_name: ByName, scene: &'a Scene, choice: &Choice, names: &[&str]) -> Result<Self, SolveError> {
        let varied = by_name.parameters();
        let mut varying = by_name.into_varying();
        let Prepared { constants, .. } = varying.prepared();
        let parameters = constants[constants.len() - varied.len()..].to_vec();
        varying.set(&scene.start, &parameters, &choice.constants, false)?;
        let (own, prepared) = (varying.constants().to_vec(), varying.prepared());
        let g = &prepared.equations.graph;
        let known = &constant_names(&prepared.equations)[..own.len()];
        let number = |name: &&str| -> Result<Number, SolveError> {
            let name = name.to_string();
            if let Some(i) = known.iter().position(|own| *own == name) {
                if matches!(choice.constants, ConstantsRule::Natural { .. }) {
                    let reason = format!("{name} is natural at a horizon: nothing can be derived by it");
                    return Err(SolveError::Member { reason });
                }
                return Ok(Number { name, value: own[i], moves: Moves::Constant(i) });
            }
            let symbol = g.find_symbol(&name);
            let parameter = varied.iter().position(|s| Some(*s) == symbol);
            let value = parameter.map(|i| parameters[i]).or_else(|| prepared.values.value(symbol?)).unwrap_or(0.0);
            let starts = scene.starts(&[&name]).map_err(|error| SolveError::Scene(Box::new(error)))?;
            Ok(Number { name, value, moves: Moves::Start(Box::new(starts), parameter) })
        };
        let numbers = names.iter().map(number).collect::<Result<_, _>>()?;
        Ok(Numbers { varying, scene, parameters, own, numbers })
    }

    /// Sets the numbers that were there first.
    pub(crate) fn reset(&mut self) -> Result<(), SolveError> {
        self.set_own(&self.own.clone())
    }

    fn set_own(&mut self, own: &[f64]) -> Result<(), SolveError> {
        self.varying.set(&self.scene.start, &self.parameters, &ConstantsRule::Given(own.to_vec()), false)
    }

    /// Number of the free constants that are no parameters.
    pub(crate) fn own(&self) -> usize {
        self.own.len()
    }

    /// The direction of the number of this name, other free constants fixed.
    pub(crate) fn along_name(&mut self, i: usize) -> Result<Direction, SolveError> {
        let Number { name, value, moves } = &self.numbers[i];
        let (name, value) = (name.clone(), *value);
        let parameter = match moves {
            Moves::Constant(constant) => return self.along_constant(*constant),
            Moves::Start(_, parameter) => *parameter,
        };
        let start = self.derivative(&name, value, &mut |numbers, x| {
            let Moves::Start(starts, _) = &mut numbers.numbers[i].moves else { unreachable!("looked at before") };
            let start = starts.at(&[x]).map_err(|fault| SolveError::Member { reason: fault.to_string() })?;
            let mut parameters = numbers.parameters.clone();
            parameter.into_iter().for_each(|i| parameters[i] = x);
            let own = ConstantsRule::Given(numbers.own.clone());
            numbers.varying.set(&start.state, &parameters, &own, false)
        })?;
        Ok(self.scaled(start, parameter.map(|i| self.own.len() + i), value))
    }

    /// The direction of a free constant that is no parameter.
    pub(crate) fn along_constant(&mut self, constant: usize) -> Result<Direction, SolveError> {
        let value = self.own[constant];
        let name = constant_names(&self.varying.prepared().equations)[constant].clone();
        let start = self.derivative(&name, value, &mut |numbers, x| {
            let mut own = numbers.own.clone();
            own[constant] = x;
            numbers.set_own(&own)
        })?;
        Ok(self.scaled(start, Some(constant), value))
    }

    fn scaled(&self, start: Vec<f64>, constant: Option<usize>, value: f64) -> Direction {
        let scale = size(value);
        let mut constants = vec![0.0; self.own.len() + self.parameters.len()];
        constant.into_iter().for_each(|i| constants[i] = scale);
        Direction { start: start.into_iter().map(|x| x * scale).collect(), constants, scale }
    }

    fn derivative(
        &mut self,
        name: &str,
        x: f64,
        set: &mut dyn FnMut(&mut Self, f64) -> Result<(), SolveError>,
    ) -> Result<Vec<f64>, SolveError> {
        let found = derivative(name, x, &mut |x| {
            set(self, x)?;
            Ok(self.varying.prepared().start.clone())
        });
        self.reset()?;
        found
    }
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
