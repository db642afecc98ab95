//! Integrals of any formulation's equations, among combinations of given functions.
//!
//! Is some `Σ c_i B_i(q, v)` constant on `{f = 0}`? The rates `Ḃ_i` at random points over a finite field,
//! times drawn as well, are the rows of a matrix whose kernel the integrals are: a combination with a rate
//! that is not zero at one point is none, and what is in the kernel of more rows than there are functions
//! is one, except by accident. What is printed has coefficients that are fractions, and is tried at random
//! points of another field.

use std::sync::Arc;

use decision::exact::{Echelon, Exact, FIELDS, Jet, Modular, in_field, nullspace};
use decision::{Dynamics, ExactStart};
use equations::{Equations, Role};
use mechanics::System;
use mechanics::elimination::{eliminate, open};
use symbolic::{Evaluator, Expr, Symbol, Tape};

use crate::Open;
use crate::functions::{Function, chosen, functions};
use crate::local::draws;

/// Points beyond as many as there are functions.
const MORE: usize = 8;
/// An integral that can be written down.
#[derive(Clone, Debug)]
pub struct Printed {
    /// It, in the graph of the equations.
    pub expression: Expr,
    /// It, in the names of the scene.
    pub text: String,
    /// Its terms, in the same way.
    pub terms: Vec<String>,
    /// Degree in the velocities.
    pub degree: usize,
    /// Whether all its terms are linear in the velocities.
    pub is_linear: bool,
    /// Whether it is the energy and nothing else.
    pub is_energy: bool,
    /// Whether it is the energy and something of a lower degree: a moving energy.
    pub is_moving_energy: bool,
}

/// The integrals found in an ansatz.
#[derive(Clone, Debug, serde::Serialize, schemars::JsonSchema)]
pub struct Ansatz {
    /// Functions that are independent on `f = 0`, the number 1 not among them.
    pub functions: usize,
    /// Dimension of the integrals among their combinations, products of others included.
    pub dimension: usize,
    /// Integrals given as formulas; none is a combination of products of earlier ones.
    #[serde(skip)]
    pub printed: Vec<Printed>,
    /// Number of other integrals, whose coefficients are not fractions of moderate size.
    pub unprinted: usize,
    /// Coordinates that the functions contain.
    #[serde(rename = "coordinates")]
    pub names: Vec<String>,
    /// Highest degree in these, or in their sines and cosines.
    #[serde(rename = "spatial_degree")]
    pub spatial: usize,
}

/// Integrals of `equations`, derived for `system`, up to `degree` in the velocities, to which multipliers
/// that are states are counted: the vakonomic motion is one in `(q, v, μ)`. Functions contain the
/// coordinates `names`, or those that `L` and `f` contain where there are none.
///
/// # Errors
/// [`Open`]: equations that cannot be followed over a finite field, or names that are not coordinates.
pub fn ansatz(
    system: &System,
    equations: &Equations,
    start: &ExactStart,
    degree: usize,
    names: &[String],
) -> Result<Ansatz, Open> {
    let system = &System { graph: equations.graph.clone(), ..system.clone() };
    let places = chosen(system, names)?;
    let multipliers: Vec<Symbol> = multipliers(equations).into_iter().map(|(mu, _)| mu).collect();
    let (spatial, functions) = functions(system, &multipliers, &places, !names.is_empty(), degree)?;
    let expressions: Vec<Expr> = functions.iter().map(|f| f.expression).collect();
    let mut sample = Sample::new(system, equations, start, &expressions)?;
    let points = functions.len() + MORE;
    let mut found = in_field(&FIELDS[0], || found(system, &functions, &sample.columns(points, 1)?))?;
    let printed: Vec<Expr> = found.printed.iter().map(|p| p.expression).collect();
    sample.ask(system, &printed)?;
    in_field(&FIELDS[1], || holds(&sample, &found.printed))?;
    found.spatial = spatial;
    found.names = places.iter().map(|&i| system.coordinates[i].name.clone()).collect();
    Ok(found)
}

/// Which of these functions of `(q, v, t)` are constant along almost every motion: their rates are zero at
/// random points of two fields. One that is not zero proves the contrary.
///
/// # Errors
/// As [`ansatz`].
pub fn constants(
    system: &System,
    equations: &Equations,
    start: &ExactStart,
    functions: &[Expr],
) -> Result<Vec<bool>, Open> {
    let system = &System { graph: equations.graph.clone(), ..system.clone() };
    let sample = Sample::new(system, equations, start, functions)?;
    let mut held = vec![true; functions.len()];
    for field in &FIELDS[..2] {
        let (_, rates) = in_field(field, || sample.columns(MORE, 3))?;
        held.iter_mut().zip(rates).for_each(|(held, rates)| *held &= rates.iter().all(|x| x.is_zero()));
    }
    Ok(held)
}

fn holds(sample: &Sample, printed: &[Printed]) -> Result<(), Open> {
    for (rates, integral) in sample.columns(MORE, 2)?.1.iter().zip(printed) {
        if rates.iter().any(|x| !x.is_zero()) {
            return Err(Open::Contradiction(format!(
                "{} is constant modulo one prime, not modulo another",
                integral.text
            )));
        }
    }
    Ok(())
}

/// Multipliers that are states, and their places among these.
pub(crate) fn multipliers(equations: &Equations) -> Vec<(Symbol, usize)> {
    let states = equations.states.iter().enumerate().filter(|(_, y)| y.role == Role::Multiplier);
    states.map(|(i, y)| (y.symbol, i)).collect()
}

/// Functions at random points of the motions.
struct Sample<'a> {
    dynamics: Dynamics,
    program: Arc<Tape>,
    start: &'a ExactStart,
    /// Symbols of multipliers, and their places among the states.
    multipliers: Vec<(Symbol, usize)>,
    constants: usize,
    inputs: usize,
}

/// Values and rates, function by function, one for each point.
type Columns = (Vec<Vec<Modular>>, Vec<Vec<Modular>>);

impl<'a> Sample<'a> {
    fn new(system: &System, equations: &Equations, start: &'a ExactStart, functions: &[Expr]) -> Result<Self, Open> {
        let dynamics = Dynamics::new(system, equations).map_err(|fault| Open::Other(fault.to_string()))?;
        let program = system.graph.tape(&[], &[]).map_err(|fault| Open::Other(fault.to_string()))?;
        let constants = equations.constant_symbols().len();
        let mut sample = Sample { dynamics, program, start, multipliers: multipliers(equations), constants, inputs: 0 };
        sample.ask(system, functions)?;
        Ok(sample)
    }

    /// Takes these functions instead of the others.
    fn ask(&mut self, system: &System, functions: &[Expr]) -> Result<(), Open> {
        let mut inputs: Vec<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        inputs.push(system.time);
        inputs.extend(system.positions().into_iter().chain(system.velocities()));
        self.inputs = inputs.len();
        inputs.extend(self.multipliers.iter().map(|(mu, _)| *mu));
        let program = system.graph.tape(&inputs, functions);
        self.program = program.map_err(|fault| Open::Other(fault.to_string()))?;
        Ok(())
    }

    fn columns(&self, points: usize, seed: u64) -> Result<Columns, Open> {
        let mut evaluator = Evaluator::<Jet<Modular>>::new(self.program.clone());
        let (mut values, mut rates): Columns = Default::default();
        let mut draw = draws(seed);
        for point in 0..points as u64 {
            let constants: Vec<Jet<Modular>> = (0..self.constants).map(|_| Jet::constant(draw(), None)).collect();
            let along = decision::at_random(self.start, seed << 32 | point, |at| {
                let curve = self.dynamics.series(&at, &constants, 3).map_err(|fault| fault.to_string())?;
                let mut inputs = curve.inputs[..self.inputs].to_vec();
                inputs.extend(self.multipliers.iter().map(|&(_, i)| curve.states[i]));
                let along = evaluator.evaluate(&inputs);
                match along.iter().find_map(Jet::flaw) {
                    Some(flaw) => Err(flaw.to_string()),
                    None => Ok(along.iter().map(|x| [x.coefficient(0), x.coefficient(1)]).collect::<Vec<_>>()),
                }
            });
            let along = along.map_err(Open::Other)?;
            values.resize(along.len(), Vec::new());
            rates.resize(along.len(), Vec::new());
            for (i, [value, rate]) in along.into_iter().enumerate() {
                values[i].push(value);
                rates[i].push(rate);
            }
        }
        Ok((values, rates))
    }
}

fn found(system: &System, functions: &[Function], (values, rates): &Columns) -> Result<Ansatz, Open> {
    let points = values.first().map_or(0, Vec::len);
    let mut independent = Echelon::default();
    independent.add(vec![Modular::one(); points]);
    let kept: Vec<usize> = (0..functions.len()).filter(|&i| independent.add(values[i].clone())).collect();
    let columns: Vec<Vec<Modular>> = kept.iter().map(|&i| rates[i].clone()).collect();
    // leading are the last functions: those before are simpler
    let mut integrals = nullspace(&columns, 0).1;
    eliminate(&mut integrals, |rows, done| {
        open(rows, done, kept.len()).filter(|&(i, j)| !rows[i][j].is_zero()).max_by_key(|&(_, j)| j)
    });
    integrals.reverse();
    let mut known = Echelon::default();
    known.add(vec![Modular::one(); points]);
    let mut of_degree: Vec<(usize, Vec<Modular>)> = Vec::new();
    let (mut printed, mut unprinted) = (Vec::new(), 0);
    let highest = functions.iter().map(|f| f.degree).max().unwrap_or(0);
    let dimension = integrals.len();
    for x in integrals {
        let used = || kept.iter().zip(&x).filter(|(_, c)| !c.is_zero()).map(|(&i, &c)| (i, c));
        let degree = used().map(|(i, _)| functions[i].degree).max().unwrap_or(0);
        let along = used().fold(vec![Modular::ZERO; points], |sum, (i, c)| {
            sum.iter().zip(&values[i]).map(|(&sum, &x)| sum + c * x).collect()
        });
        if !known.add(along.clone()) {
            continue;
        }
        of_degree.push((degree, along.clone()));
        let mut products: Vec<(usize, Vec<Modular>)> = vec![(degree, along)];
        for place in 0.. {
            let Some((d, a)) = products.get(place).cloned() else { break };
            for (e, b) in of_degree.iter().filter(|(e, _)| d + e <= highest) {
                let product: Vec<Modular> = a.iter().zip(b).map(|(&x, &y)| x * y).collect();
                // powers without velocities have no end, and few are combinations of these functions
                let counts = d.min(*e) > 0 || independent.spans(product.clone());
                if counts && known.add(product.clone()) {
                    products.push((d + e, product));
                }
            }
        }
        let coefficients: Option<Vec<(usize, Exact)>> = used().map(|(i, c)| Some((i, c.small_fraction()?))).collect();
        match coefficients {
            None => unprinted += 1,
            Some(coefficients) => printed.push(written(system, functions, &coefficients, degree)),
        }
    }
    Ok(Ansatz { functions: kept.len(), dimension, printed, unprinted, names: Vec::new(), spatial: 0 })
}

fn written(system: &System, functions: &[Function], coefficients: &[(usize, Exact)], degree: usize) -> Printed {
    let g = &system.graph;
    let terms: Vec<Expr> =
        coefficients.iter().map(|&(i, c)| g.mul(g.fraction(c.fraction()), functions[i].expression)).collect();
    let expression = g.sum(&terms);
    let energy = coefficients.iter().any(|&(i, _)| functions[i].is_energy);
    let others = coefficients.iter().filter(|&&(i, _)| !functions[i].is_energy);
    let lower = energy && others.clone().all(|&(i, _)| functions[i].degree < 2);
    Printed {
        text: g.plain(expression),
        terms: terms.iter().map(|&term| g.plain(term)).collect(),
        expression,
        is_linear: coefficients.iter().all(|&(i, _)| functions[i].degree == 1),
        degree,
        is_energy: lower && coefficients.len() == 1,
        is_moving_energy: lower && coefficients.len() > 1,
    }
}
