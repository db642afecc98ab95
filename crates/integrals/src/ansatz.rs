//! Integrals of any formulation's equations, among combinations of given functions.
//!
//! Is some `Σ c_i B_i(q, v)` constant on `{f = 0}`? The rates `Ḃ_i` at random points over a finite field,
//! times drawn as well, are the rows of a matrix whose kernel the integrals are: a combination with a rate
//! that is not zero at one point is none, and what is in the kernel of more rows than there are functions
//! is one, but for an accident. What is printed has coefficients that are fractions, and is tried at random
//! points of another field.

use decision::exact::{Echelon, Exact, FIELDS, Jet, Modular, in_field};
use decision::{Dynamics, ExactStart, Program};
use equations::Equations;
use mechanics::System;
use symbolic::{Expr, Symbol};

use crate::Open;
use crate::killing::{nullspace, velocity_monomials};
use crate::local::draws;

/// Most functions.
const FUNCTIONS: usize = 420;
/// Points beyond as many as there are functions.
const MORE: usize = 8;
/// The highest degree in coordinates, or in sines and cosines of one.
const SPATIAL: usize = 4;

/// A function of the ansatz.
#[derive(Clone, Debug)]
struct Function {
    expression: Expr,
    /// Degree in the velocities.
    degree: usize,
    is_energy: bool,
}

/// An integral that can be written down.
#[derive(Clone, Debug)]
pub struct Printed {
    /// It, in the graph of the equations.
    pub expression: Expr,
    /// It, in the names of the scene.
    pub text: String,
    /// Its terms, likewise.
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

impl Printed {
    /// The sum of its terms without their signs.
    pub(crate) fn without_signs(&self) -> String {
        self.terms.iter().map(|term| format!("sqrt(({term})^2)")).collect::<Vec<_>>().join(" + ")
    }
}

/// What was found in an ansatz.
#[derive(Clone, Debug)]
pub struct Ansatz {
    /// Functions that are independent on `f = 0`, the number 1 not among them.
    pub functions: usize,
    /// Dimension of the integrals among their combinations, products of others included.
    pub dimension: usize,
    /// Those that are written down; none is a combination of products of those before it.
    pub printed: Vec<Printed>,
    /// Others, with coefficients that are no fractions of moderate size.
    pub unprinted: usize,
    /// Coordinates that the functions contain.
    pub names: Vec<String>,
    /// Highest degree in these, or in their sines and cosines.
    pub spatial: usize,
}

/// Integrals of `equations`, derived for `system`, up to `degree` in the velocities; functions contain the
/// coordinates `names`, or those that `L` and `f` contain where there are none.
///
/// # Errors
/// [`Open`]: equations that cannot be followed over a finite field, or names that are no coordinates.
pub fn ansatz(
    system: &System,
    equations: &Equations,
    start: &ExactStart,
    degree: usize,
    names: &[String],
) -> Result<Ansatz, Open> {
    let system = &System { graph: equations.graph.clone(), ..system.clone() };
    let places = chosen(system, names)?;
    let (spatial, functions) = functions(system, &places, degree);
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

/// Functions at random points of the motions.
struct Sample<'a> {
    dynamics: Dynamics,
    program: Program,
    start: &'a ExactStart,
    constants: usize,
    inputs: usize,
}

/// Values and rates, function by function, one for each point.
type Columns = (Vec<Vec<Modular>>, Vec<Vec<Modular>>);

impl<'a> Sample<'a> {
    fn new(system: &System, equations: &Equations, start: &'a ExactStart, functions: &[Expr]) -> Result<Self, Open> {
        let dynamics = Dynamics::new(system, equations).map_err(|fault| Open::Other(fault.to_string()))?;
        let program = Program::new(&system.graph, &[], &[]).map_err(|fault| Open::Other(fault.to_string()))?;
        let mut sample = Sample { dynamics, program, start, constants: equations.constant_symbols().len(), inputs: 0 };
        sample.ask(system, functions)?;
        Ok(sample)
    }

    /// Takes these functions in the place of the others.
    fn ask(&mut self, system: &System, functions: &[Expr]) -> Result<(), Open> {
        let mut inputs: Vec<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        inputs.push(system.time);
        inputs.extend(system.positions().into_iter().chain(system.velocities()));
        self.inputs = inputs.len();
        let program = Program::new(&system.graph, &inputs, functions);
        self.program = program.map_err(|fault| Open::Other(fault.to_string()))?;
        Ok(())
    }

    fn columns(&self, points: usize, seed: u64) -> Result<Columns, Open> {
        let mut evaluator = self.program.evaluator::<Jet<Modular>>();
        let (mut values, mut rates): Columns = Default::default();
        let mut draw = draws(seed);
        for point in 0..points as u64 {
            let constants: Vec<Jet<Modular>> = (0..self.constants).map(|_| Jet::constant(draw(), None)).collect();
            let along = decision::at_random(self.start, seed << 32 | point, |at| {
                let curve = self.dynamics.series(&at, &constants, 3).map_err(|fault| fault.to_string())?;
                let along = evaluator.run(&curve.inputs[..self.inputs]);
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
    let mut integrals = Echelon::default();
    for mut x in nullspace(&columns, 0).1 {
        x.reverse();
        integrals.add(x);
    }
    let mut integrals = reduced(integrals);
    integrals.reverse();
    let mut known = Echelon::default();
    known.add(vec![Modular::one(); points]);
    let mut of_degree: Vec<(usize, Vec<Modular>)> = Vec::new();
    let (mut printed, mut unprinted) = (Vec::new(), 0);
    let highest = functions.iter().map(|f| f.degree).max().unwrap_or(0);
    let dimension = integrals.len();
    for mut x in integrals {
        x.reverse();
        let used = || kept.iter().zip(&x).filter(|(_, c)| !c.is_zero()).map(|(&i, &c)| (i, c));
        let degree = used().map(|(i, _)| functions[i].degree).max().unwrap_or(0);
        let along = used().fold(vec![Modular::ZERO; points], |sum, (i, c)| {
            sum.iter().zip(&values[i]).map(|(&sum, &x)| sum + c * x).collect()
        });
        if !known.add(along.clone()) {
            continue;
        }
        let mut products: Vec<(usize, Vec<Modular>)> = vec![(degree, along)];
        for place in 0.. {
            let Some((d, a)) = products.get(place).cloned() else { break };
            for (e, b) in &of_degree {
                let product: Vec<Modular> = a.iter().zip(b).map(|(&x, &y)| x * y).collect();
                if d + e <= highest && known.add(product.clone()) {
                    products.push((d + e, product));
                }
            }
            if place == 0 && 2 * d <= highest {
                let square: Vec<Modular> = a.iter().map(|&x| x * x).collect();
                if known.add(square.clone()) {
                    products.push((2 * d, square));
                }
            }
        }
        of_degree.extend(products.into_iter().take(1));
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

/// The reduced echelon form, leading places first.
fn reduced(rows: Echelon) -> Vec<Vec<Modular>> {
    let mut rows = rows.0;
    rows.sort_by_key(|(pivot, _)| *pivot);
    for i in (0..rows.len()).rev() {
        let (pivot, row) = rows[i].clone();
        for (_, above) in &mut rows[..i] {
            let factor = above[pivot];
            if !factor.is_zero() {
                above.iter_mut().zip(&row).for_each(|(x, &y)| *x = *x - factor * y);
            }
        }
    }
    rows.into_iter().map(|(_, row)| row).collect()
}

fn chosen(system: &System, names: &[String]) -> Result<Vec<usize>, Open> {
    if names.is_empty() {
        let written = system.written();
        let present = |i: &usize| written.iter().any(|&e| system.graph.depends_on(e, system.coordinates[*i].position));
        return Ok((0..system.dimension()).filter(present).collect());
    }
    let place = |name: &String| {
        let place = system.coordinates.iter().position(|c| c.name == *name);
        place.ok_or_else(|| {
            let all: Vec<&str> = system.coordinates.iter().map(|c| &c.name[..]).collect();
            Open::Name { name: name.clone(), all: all.join(", ") }
        })
    };
    names.iter().map(place).collect()
}

/// Monomials in velocities times monomials in coordinates, or in sines and cosines of angles, simple ones
/// first; with the energy and the momenta. Their degree in coordinates is as high as few functions allow.
fn functions(system: &System, places: &[usize], degree: usize) -> (usize, Vec<Function>) {
    let g = &system.graph;
    let v = g.variables(&system.velocities());
    let fast = velocity_monomials(v.len(), degree);
    let mut fast: Vec<Vec<usize>> =
        fast.into_iter().chain(degree.checked_sub(1).map_or(Vec::new(), |d| velocity_monomials(v.len(), d))).collect();
    fast.sort_by_key(Vec::len);
    let mut spatial = 0;
    let mut slow = vec![(0, g.one())];
    for most in 1..=SPATIAL {
        let more = spatial_monomials(system, places, most);
        if more.len() * fast.len() > FUNCTIONS {
            break;
        }
        (spatial, slow) = (most, more);
    }
    slow.sort_by_key(|(d, _)| *d);
    let mut all: Vec<Function> = Vec::new();
    let push = |all: &mut Vec<Function>, expression: Expr, degree: usize, is_energy: bool| {
        if g.as_number(expression).is_none() {
            all.push(Function { expression, degree, is_energy });
        }
    };
    for d in 0..=degree {
        if d == 2 {
            push(&mut all, energy(system), 2, true);
        }
        for (_, place) in &slow {
            for monomial in fast.iter().filter(|m| m.len() == d) {
                let factors: Vec<Expr> = monomial.iter().map(|&c| v[c]).chain([*place]).collect();
                push(&mut all, g.product(&factors), d, false);
            }
        }
        if d == 1 {
            for momentum in g.gradient(system.lagrangian, &system.velocities()) {
                push(&mut all, momentum, 1, false);
            }
        }
    }
    (spatial, all)
}

/// The energy, without its terms that cancel where `L` is quadratic in the velocities: `L − 2 L(v = 0)`.
fn energy(system: &System) -> Expr {
    let (g, v) = (&system.graph, system.velocities());
    let at_rest = g.substitute(system.lagrangian, &v.iter().map(|&v| (v, g.zero())).collect());
    let short = g.sub(system.lagrangian, g.mul(g.integer(2), at_rest));
    let energy = system.energy();
    if g.vanishes_exactly(g.sub(short, energy)) { short } else { energy }
}

fn spatial_monomials(system: &System, places: &[usize], most: usize) -> Vec<(usize, Expr)> {
    let g = &system.graph;
    let mut all = vec![(0, g.one())];
    for &i in places {
        let q = g.variable(system.coordinates[i].position);
        let own: Vec<(usize, Expr)> = if is_angle(system, i) {
            let (sine, cosine) = (g.call(symbolic::Function::Sin, q), g.call(symbolic::Function::Cos, q));
            let powers = (0..=most).map(|k| (k, g.powi(cosine, k as i32)));
            // sin² = 1 − cos²
            powers.clone().chain(powers.map(|(k, power)| (k + 1, g.mul(sine, power)))).collect()
        } else {
            (0..=most).map(|k| (k, g.powi(q, k as i32))).collect()
        };
        all = all
            .iter()
            .flat_map(|&(d, e)| own.iter().map(move |&(k, x)| (d + k, e, x)))
            .filter(|(d, ..)| *d <= most)
            .map(|(d, e, x)| (d, g.mul(e, x)))
            .collect();
    }
    all
}

/// Whether `L` and `f` stay when a coordinate grows by 2π, which is seen in doubles: only what the ansatz
/// contains depends on it. One that they do not contain is an angle if its unit says so.
fn is_angle(system: &System, place: usize) -> bool {
    let (g, coordinate) = (&system.graph, &system.coordinates[place]);
    let written = system.written();
    if !written.iter().any(|&e| g.depends_on(e, coordinate.position)) {
        return coordinate.unit == "rad";
    }
    let mut random = symbolic::SplitMix::new(7);
    let mut values = system.parameter_values();
    for symbol in system.positions().into_iter().chain(system.velocities()).chain([system.time]) {
        values.insert(symbol, random.unit());
    }
    let before: Vec<f64> = written.iter().filter_map(|&e| g.evaluate(e, &values).ok()).collect();
    if let Some(q) = values.get_mut(&coordinate.position) {
        *q += std::f64::consts::TAU;
    }
    let after: Vec<f64> = written.iter().filter_map(|&e| g.evaluate(e, &values).ok()).collect();
    before.iter().zip(&after).all(|(a, b)| (a - b).abs() <= 1e-9 * (1.0 + a.abs()))
}
