//! What equations hand over, in numbers, at a few random states.

use std::cell::RefCell;
use std::collections::HashSet;

use equations::{Compiled, Equations, Outputs, Plan};
use mechanics::{Removal, SingularValues, State, complete_removal_start};
use nalgebra::DMatrix;
use scene::Scene;
use symbolic::{CompileError, Evaluator, Symbol};

use super::judge::distance;
use super::truth::{Point, Truth, slope};

/// A state in which equations are read, and the free constants that lead to it.
#[derive(Clone)]
pub struct Sample {
    pub point: Point,
    /// All that start expressions may contain, but the free constants.
    pub known: Vec<(Symbol, f64)>,
    pub constants: Vec<f64>,
}

/// Outputs, rates and guards in one state.
#[derive(Clone)]
pub struct Instant {
    pub y: Vec<f64>,
    pub rates: Vec<f64>,
    pub now: Outputs,
    /// The derivatives of the outputs along the motion.
    pub along: Outputs,
    pub guards: Vec<f64>,
    /// Where projection takes a state beside this one, by how much it was put beside.
    pub beside: Vec<f64>,
    pub projected: Vec<f64>,
    /// Left minus right of the equations for the reader, those that can be read off.
    pub statements: Vec<f64>,
}

/// Readings in several states, with the names of states, multipliers and invariants.
#[derive(Clone)]
pub struct Reading {
    pub states: Vec<Symbol>,
    pub multipliers: Vec<String>,
    pub invariants: Vec<String>,
    pub instants: Vec<Instant>,
    /// Whether the equations are singular where a guard vanishes, for those that do near the first state.
    pub guarded: Vec<bool>,
    /// Rates where the chosen form is least accurate, and how often it was not trusted elsewhere.
    pub near: Vec<f64>,
    pub fallbacks: usize,
}

impl Reading {
    /// How far apart the motions are that two readings tell of.
    pub fn change(&self, other: &Reading) -> f64 {
        let names = |r: &Reading| [r.multipliers.clone(), r.invariants.clone()];
        let (own, others) = (self.numbers(), other.numbers());
        if names(self) != names(other) || own.len() != others.len() { f64::INFINITY } else { distance(&own, &others) }
    }

    /// In whatever variables the equations are: outputs, how they move, and what projection does.
    fn numbers(&self) -> Vec<f64> {
        let outputs = |o: &Outputs| [&o.coordinates[..], &o.velocities, &o.multipliers, &o.invariants].concat();
        let instant = |i: &Instant| {
            let moved = i.projected.iter().zip(&i.beside).filter(|(after, before)| after != before);
            [outputs(&i.now), outputs(&i.along), moved.map(|(after, _)| *after).collect()].concat()
        };
        self.instants.iter().flat_map(instant).chain(self.near.iter().copied()).collect()
    }
}

/// Numbers between −1 and 1 that look random.
pub fn noise(i: usize, k: usize) -> f64 {
    2.0 * (0.618_033_988_749_894_9 * ((i + 1) * (3 * k + 7) * (k + 1)) as f64).fract() - 1.0
}

/// States all around the start of a scene, on its constraints.
pub fn samples(scene: &Scene, truth: &Truth, removal: Option<&Removal>, count: usize) -> Vec<Sample> {
    let n = truth.n;
    let around = |k: usize| {
        let beside = |x: &f64, i: usize| x + 0.3 * (1.0 + x.abs()) * noise(i, k);
        let at = |list: &[f64], first: usize| list.iter().zip(first..).map(|(x, i)| beside(x, i)).collect();
        let start = &scene.start;
        let constants: Vec<f64> = (0..8).map(|i| 0.7 * noise(i + 40, k)).collect();
        let mu = constants[..truth.h].to_vec();
        let point = Point { t: start.t + noise(30, k), q: at(&start.q, 0), v: at(&start.v, n), mu };
        let point = truth.admissible(&point)?;
        let state = State { t: point.t, q: point.q.clone(), v: point.v.clone() };
        let mut known = scene.system.values_at(&state);
        known.extend(scene.system.parameter_values());
        if let Some(removal) = removal {
            known.extend(complete_removal_start(&scene.system, removal, &state).ok()?.values());
        }
        let mut known: Vec<(Symbol, f64)> = known.into_iter().collect();
        known.sort_by_key(|(symbol, _)| *symbol);
        Some(Sample { point, known, constants })
    };
    (0..40).filter_map(around).take(count).collect()
}

/// Reads equations off in the given states, in a form or plain; `near`: a state whose rates are wanted.
pub fn read(
    equations: &Equations,
    form: Option<&Plan>,
    samples: &[Sample],
    near: Option<&[f64]>,
) -> Result<Reading, String> {
    let mut reader = Reader::new(equations, form).map_err(|e| e.to_string())?;
    let names = |list: &[equations::Named]| list.iter().map(|n| n.name.clone()).collect();
    let instants = samples.iter().map(|sample| reader.instant(sample)).collect::<Result<Vec<Instant>, _>>()?;
    let fallbacks = reader.compiled.fallbacks();
    let (t, y) = (samples[0].point.t, &instants[0].y);
    reader.settle(&samples[0])?;
    let guarded = reader.guarded(t, y)?;
    let near = near.map_or(Ok(Vec::new()), |y| reader.rates(t, y))?;
    Ok(Reading {
        states: equations.state_symbols(),
        multipliers: names(&equations.multipliers),
        invariants: names(&equations.invariants),
        instants,
        guarded,
        near,
        fallbacks,
    })
}

/// The state on a line through `y` in which the form is least accurate.
pub fn worst_for(equations: &Equations, form: &Plan, sample: &Sample, y: &[f64]) -> Option<Vec<f64>> {
    let constants = &sample.constants[..equations.free_constants.len()];
    // definitions of the equations themselves may wait for unknowns
    let condition = form.condition.filter(|_| equations.definitions.is_empty())?;
    let known = equations.known_symbols();
    let tape = equations.graph.compile_with(&known, &form.definitions, &[condition], &equations.parameters).ok()?;
    let function = RefCell::new(Evaluator::new(tape));
    let at = |s: f64| -> Vec<f64> { y.iter().enumerate().map(|(i, y)| y + s * noise(i, 5)).collect() };
    let size = |s: f64| function.borrow_mut().evaluate(&[&[sample.point.t][..], &at(s), constants].concat())[0];
    let grid = (-400..=400).map(|i| 0.005 * f64::from(i)).filter(|s| size(*s).is_finite());
    let (mut best, mut step) = (grid.max_by(|a, b| size(*a).total_cmp(&size(*b)))?, 0.0025);
    while step > 1e-9 && size(best) < 1e13 {
        best = [best - step, best, best + step].into_iter().max_by(|a, b| size(*a).total_cmp(&size(*b)))?;
        step *= 0.6;
    }
    (size(best) > Plan::LIMIT).then(|| at(best))
}

struct Reader<'a> {
    equations: &'a Equations,
    compiled: Compiled,
    /// Starts of states, guesses of unknowns, equations for the reader: compiled once for all states.
    starts: Formulas,
    guesses: Formulas,
    sides: Formulas,
    /// Rates by their names in the equations for the reader, with the places of the states.
    names: Vec<(Symbol, usize)>,
}

impl<'a> Reader<'a> {
    fn new(equations: &'a Equations, form: Option<&Plan>) -> Result<Self, CompileError> {
        let compiled = Compiled::with_plan(equations, form.unwrap_or(&Plan::plain(equations)))?;
        let g = &equations.graph;
        let known = [equations.known_symbols(), equations.unknowns()].concat();
        let rate = |(i, y): (usize, Symbol)| Some((g.find_symbol(&format!("{}'", g.name(y)))?, i));
        let rates = equations.state_symbols().into_iter().enumerate().filter_map(rate);
        let rates = rates.filter(|(s, _)| !known.contains(s));
        let [starts, guesses, sides] = [(); 3].map(|()| None);
        Ok(Reader { equations, compiled, starts, guesses, sides, names: rates.collect() })
    }

    /// States and unknowns of a sample, from which equations are solved from now on.
    fn settle(&mut self, sample: &Sample) -> Result<[Vec<f64>; 2], String> {
        let equations = self.equations;
        let t = sample.point.t;
        let count = equations.free_constants.len();
        let constants = sample.constants.get(..count).ok_or("too many free constants")?;
        self.compiled.set_constants(constants);
        let mut known = sample.known.clone();
        known.extend(equations.constant_symbols().into_iter().zip(constants.iter().copied()));
        let starts = || equations.states.iter().map(|y| y.start).collect();
        let y = evaluated(equations, &known, &mut self.starts, starts)?;
        if self.compiled.needs_guess() {
            let guesses = || equations.blocks.iter().flat_map(|b| b.guess.iter().copied()).collect();
            // a block that has no guess starts at the accelerations' zero
            let guess = evaluated(equations, &known, &mut self.guesses, guesses)?;
            if guess.len() == equations.unknowns().len() {
                self.compiled.set_guess(&guess);
            }
        }
        let z = self.compiled.settle(t, &y).map_err(|e| e.to_string())?.to_vec();
        Ok([y, z])
    }

    fn instant(&mut self, sample: &Sample) -> Result<Instant, String> {
        let [y, z] = self.settle(sample)?;
        let equations = self.equations;
        let t = sample.point.t;
        let constants = &sample.constants[..equations.free_constants.len()];
        let rates = self.rates(t, &y)?;
        let now = self.compiled.outputs(t, &y).map_err(|e| e.to_string())?;
        let along = self.along(t, &y, &rates, &now)?;
        let mut guards = vec![0.0; self.compiled.guards()];
        self.compiled.guard_values(t, &y, &mut guards);
        let beside: Vec<f64> = y.iter().enumerate().map(|(i, y)| y + 0.02 * noise(i, 3)).collect();
        let mut projected = beside.clone();
        self.compiled.project(t, &mut projected).map_err(|e| e.to_string())?;
        let instant = self.equations.known_symbols().into_iter().chain(equations.unknowns());
        let numbers = [&[t][..], &y, constants, &z].concat();
        let mut values: Vec<(Symbol, f64)> = instant.zip(numbers).collect();
        values.extend(self.names.iter().map(|&(s, i)| (s, rates[i])));
        let statements = self.statements(&values)?;
        let found = Instant { y, rates, now, along, guards, beside, projected, statements };
        let finite = [&found.rates, &found.now.velocities, &found.projected, &found.statements];
        let finite = finite.into_iter().flatten().all(|x| x.is_finite());
        if finite { Ok(found) } else { Err("not finite".into()) }
    }

    fn rates(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, String> {
        let mut rates = vec![0.0; y.len()];
        self.compiled.rates(t, y, &mut rates).map_err(|e| e.to_string())?;
        Ok(rates)
    }

    /// For each guard that changes sign on a line through `y`: do rates lose digits there, or grow unbounded,
    /// or do the equations lose an unknown?
    fn guarded(&mut self, t: f64, y: &[f64]) -> Result<Vec<bool>, String> {
        let mut guarded = Vec::new();
        for j in 0..self.compiled.guards() {
            let at = |s: f64| -> Vec<f64> { y.iter().enumerate().map(|(i, y)| y + s * noise(i, j + 6)).collect() };
            let mut values = vec![0.0; self.compiled.guards()];
            let mut guard = |s: f64| {
                self.compiled.guard_values(t, &at(s), &mut values);
                values[j]
            };
            let grid: Vec<f64> = (-60..=60).map(|i| 0.05 * f64::from(i) + 0.003).collect();
            let Some(ends) = grid.windows(2).find(|ends| guard(ends[0]) * guard(ends[1]) < 0.0) else { continue };
            let (mut low, mut high) = (ends[0], ends[1]);
            while high - low > 1e-12 {
                let middle = 0.5 * (low + high);
                if guard(low) * guard(middle) < 0.0 { high = middle } else { low = middle }
            }
            // where the guard itself is infinite it says nothing
            if guard(low).abs() < 1e-6 {
                // a smooth function is straight over so short a way
                let rates = [1e-10, 2e-10, 3e-10].map(|s| self.rates(t, &at(low + s)));
                let [Ok(a), Ok(b), Ok(c)] = rates else {
                    guarded.push(true);
                    continue;
                };
                let bent: Vec<f64> = (0..a.len()).map(|i| a[i] - 2.0 * b[i] + c[i]).collect();
                let straight = largest(&bent) < 1e-11 * (1.0 + largest(&b));
                let lost = self.compiled.block_matrices(t, &at(low)).into_iter().any(|block| {
                    let size = block.len().isqrt();
                    let values = SingularValues::of(&DMatrix::from_row_slice(size, size, &block)).values;
                    values.min() < 1e-9 * values.max()
                });
                guarded.push(!straight || lost);
            }
        }
        Ok(guarded)
    }

    fn along(&mut self, t: f64, y: &[f64], rates: &[f64], now: &Outputs) -> Result<Outputs, String> {
        let mut failure = None;
        let slopes = slope(|s| {
            let moved: Vec<f64> = y.iter().zip(rates).map(|(y, rate)| y + s * rate).collect();
            let outputs = self.compiled.outputs(t + s, &moved).map_err(|e| failure = Some(e.to_string()));
            let o = outputs.unwrap_or_else(|()| now.clone());
            [o.coordinates, o.velocities, o.multipliers, o.invariants].concat()
        });
        let (q, rest) = slopes.split_at(now.coordinates.len());
        let (v, rest) = rest.split_at(now.velocities.len());
        let (m, i) = rest.split_at(now.multipliers.len());
        let [coordinates, velocities, multipliers, invariants] = [q, v, m, i].map(<[f64]>::to_vec);
        failure.map_or(Ok(Outputs { coordinates, velocities, multipliers, invariants }), Err)
    }

    fn statements(&mut self, values: &[(Symbol, f64)]) -> Result<Vec<f64>, String> {
        let equations = self.equations;
        let pairs = || {
            let sides: Vec<_> = equations.statements.iter().flat_map(|s| [s.left, s.right]).collect();
            let defined = equations.definitions.iter().map(|d| d.0);
            let bound: HashSet<Symbol> = values.iter().map(|v| v.0).chain(defined).collect();
            let readable = |e: &symbolic::Expr| {
                let parameter = |s: &Symbol| equations.parameters.contains_key(s);
                equations.graph.symbols_of(*e).iter().all(|s| bound.contains(s) || parameter(s))
            };
            sides.chunks(2).filter(|pair| pair.iter().all(readable)).flatten().copied().collect()
        };
        let sides = evaluated(equations, values, &mut self.sides, pairs)?;
        Ok(sides.chunks(2).map(|pair| pair[0] - pair[1]).collect())
    }
}

/// Compiled formulas and their input symbols.
type Formulas = Option<(Vec<Symbol>, Evaluator<f64>)>;

/// Values of what is `wanted`, which is compiled once for the same symbols.
fn evaluated(
    equations: &Equations,
    known: &[(Symbol, f64)],
    compiled: &mut Formulas,
    wanted: impl Fn() -> Vec<symbolic::Expr>,
) -> Result<Vec<f64>, String> {
    let (symbols, inputs): (Vec<Symbol>, Vec<f64>) = known.iter().copied().unzip();
    if compiled.as_ref().is_none_or(|(of, _)| *of != symbols) {
        let tape = equations.tape(&symbols, &wanted()).map_err(|e| e.to_string())?;
        *compiled = Some((symbols, Evaluator::new(tape)));
    }
    Ok(compiled.as_mut().map_or_else(Vec::new, |(_, formulas)| formulas.evaluate(&inputs).to_vec()))
}

fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0_f64, |m, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) })
}
