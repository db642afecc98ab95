//! Where a reference starts: on the constraint, to the last digit of the wide type.
//!
//! `(t₀, q₀, v₀)` are `f64` and taken as exact, but then `f(q₀, v₀, t₀)` is zero to round-off only. The
//! reference starts at the velocity with `f = 0` nearest to `v₀` in the metric of `M`, to which every run in
//! `f64` projects except for rounding. How a run in `f64` rounds its start is part of its error. Everything
//! else (`y₀`, a removal's parameters) follows from that velocity in the wide type.

use equations::{Equations, Real};
use mechanics::linear::{Factors, Singular};
use mechanics::{Removal, State, System, complete_removal_start};
use symbolic::limits::ITERATIONS;
use symbolic::{Evaluator, Expr, Symbol};

use crate::ReferenceError;
use crate::limits::SMALL;

const VELOCITY: &str = "constraint at the start";
const REMOVAL: &str = "parametrization at the start";

/// `y(t₀)` and the unknowns near the solution of the first instant.
pub(crate) struct Start<T> {
    pub(crate) states: Vec<T>,
    /// Empty where the derivation knows none.
    pub(crate) guess: Vec<T>,
}

/// Symbols with values.
struct Values<T> {
    symbols: Vec<Symbol>,
    values: Vec<T>,
}

impl<T: Real> Values<T> {
    fn push(&mut self, symbol: Symbol, value: T) {
        self.symbols.push(symbol);
        self.values.push(value);
    }
}

/// `constants`: as many free ones as said, then parameters.
pub(crate) fn start<T: Real>(
    system: &System,
    state: &State,
    equations: &Equations,
    constants: &[T],
    free: usize,
) -> Result<Start<T>, ReferenceError> {
    let names = equations.constant_symbols();
    let mut known = Values { symbols: names[free..].to_vec(), values: constants[free..].to_vec() };
    known.push(system.time, T::from_f64(state.t));
    for (symbol, &x) in system.positions().into_iter().zip(&state.q) {
        known.push(symbol, T::from_f64(x));
    }
    let v = velocity(system, state, &known)?;
    for (symbol, x) in system.velocities().into_iter().zip(v) {
        known.push(symbol, x);
    }
    if let Some(removal) = &equations.removal {
        complete(system, removal, state, &mut known)?;
    }
    for (symbol, &x) in names.into_iter().zip(&constants[..free]) {
        known.push(symbol, x);
    }
    let mut outputs: Vec<Expr> = equations.states.iter().map(|y| y.start).collect();
    outputs.extend(equations.blocks.iter().flat_map(|b| b.guess.iter().copied()));
    let tape = equations.graph.compile(&known.symbols, &outputs, &Default::default())?;
    let mut states = Evaluator::new(tape).evaluate(&known.values).to_vec();
    let guess = states.split_off(equations.states.len());
    let whole = guess.len() == equations.unknowns().len();
    Ok(Start { states, guess: if whole { guess } else { Vec::new() } })
}

/// The velocity nearest to `v₀` with `f = 0`: `M δv + Aᵀ κ = 0`, `f(q₀, v₀ + δv, t₀) = 0`.
///
/// Matrices are those at the current velocity: Newton's matrix lacks only terms of size `κ`, round-off.
fn velocity<T: Real>(system: &System, state: &State, known: &Values<T>) -> Result<Vec<T>, ReferenceError> {
    let (n, h) = (system.dimension(), system.constraints.len());
    let start: Vec<T> = state.v.iter().map(|&x| T::from_f64(x)).collect();
    let (mass, jacobian) = (system.velocity_hessian(), system.constraint_jacobian());
    let outputs = [mass.entries(), jacobian.entries(), &system.constraints].concat();
    let symbols = [&known.symbols[..], &system.velocities()].concat();
    let mut program = Evaluator::new(system.graph.compile(&symbols, &outputs, &Default::default())?);
    let size = n + h;
    let mut v = start.clone();
    // κ of the last step stands in the residual, so that the sum of the steps is the shortest one
    let mut kappa = vec![T::from_f64(0.0); h];
    newton(VELOCITY, state.t, || {
        let inputs = [&known.values[..], &v].concat();
        let values = program.evaluate(&inputs);
        let (m, rest) = values.split_at(n * n);
        let (a, f) = rest.split_at(h * n);
        let mut matrix = vec![T::from_f64(0.0); size * size];
        let mut residual = vec![T::from_f64(0.0); size];
        for i in 0..n {
            for j in 0..n {
                matrix[i * size + j] = m[i * n + j];
                residual[i] = residual[i] + m[i * n + j] * (v[j] - start[j]);
            }
            for k in 0..h {
                matrix[i * size + n + k] = a[k * n + i];
                matrix[(n + k) * size + i] = a[k * n + i];
                residual[i] = residual[i] + a[k * n + i] * kappa[k];
            }
        }
        residual[n..].copy_from_slice(f);
        let step = solution(&matrix, residual)?;
        let length = subtract(&mut v, &step);
        for (x, &dx) in kappa.iter_mut().zip(&step[n..]) {
            *x = *x - dx;
        }
        Ok(length)
    })?;
    Ok(v)
}

/// Adds the parametrization's variables: `q = q₀`, `q̇ = v₀` solved in the wide type from `f64` values.
///
/// What the scene names keeps the expression there, what nothing fixes its value in `f64`.
fn complete<T: Real>(
    system: &System,
    removal: &Removal,
    state: &State,
    known: &mut Values<T>,
) -> Result<(), ReferenceError> {
    let g = &system.graph;
    let in_f64 = complete_removal_start(system, removal, state)?;
    let named: Vec<(Symbol, Expr)> = removal.start.iter().map(|(&s, &e)| (s, e)).collect();
    let expressions: Vec<Expr> = named.iter().map(|n| n.1).collect();
    let tape = g.compile(&known.symbols, &expressions, &Default::default())?;
    let values = Evaluator::new(tape).evaluate(&known.values).to_vec();
    for ((symbol, _), value) in named.into_iter().zip(values) {
        if !known.symbols.contains(&symbol) {
            known.push(symbol, value);
        }
    }
    let mut rough: Vec<(Symbol, f64)> =
        in_f64.values().into_iter().filter(|(s, _)| !known.symbols.contains(s)).collect();
    rough.sort_by_key(|(s, _)| *s);
    let (open, solved): (Vec<_>, Vec<_>) = rough.into_iter().partition(|(s, _)| in_f64.free.contains(s));
    for (symbol, x) in open {
        known.push(symbol, T::from_f64(x));
    }
    let unknowns: Vec<Symbol> = solved.iter().map(|(s, _)| *s).collect();
    let mut x: Vec<T> = solved.iter().map(|(_, x)| T::from_f64(*x)).collect();
    let equations = removal.residuals(system);
    let (m, n) = (equations.len(), unknowns.len());
    if n > 0 {
        let mut outputs = equations.clone();
        outputs.extend(g.jacobian(&equations, &unknowns).entries());
        let symbols = [&known.symbols[..], &unknowns].concat();
        let mut program = Evaluator::new(g.compile(&symbols, &outputs, &Default::default())?);
        newton(REMOVAL, state.t, || {
            let inputs = [&known.values[..], &x].concat();
            let values = program.evaluate(&inputs);
            let (r, j) = values.split_at(m);
            // the equations are consistent: normal equations find their root
            let mut normal = vec![T::from_f64(0.0); n * n];
            let mut right = vec![T::from_f64(0.0); n];
            for row in 0..m {
                for a in 0..n {
                    right[a] = right[a] + j[row * n + a] * r[row];
                    for b in 0..n {
                        normal[a * n + b] = normal[a * n + b] + j[row * n + a] * j[row * n + b];
                    }
                }
            }
            Ok(subtract(&mut x, &solution(&normal, right)?))
        })?;
    }
    for (symbol, x) in unknowns.into_iter().zip(x) {
        known.push(symbol, x);
    }
    Ok(())
}

/// Takes a step off `x`; its length relative to what is left.
fn subtract<T: Real>(x: &mut [T], step: &[T]) -> f64 {
    let (mut length, mut size) = (0.0_f64, f64::MIN_POSITIVE);
    for (x, &dx) in x.iter_mut().zip(step) {
        *x = *x - dx;
        length = length.max(dx.size());
        size = size.max(x.size());
    }
    length / size
}

/// The solution of `matrix x = right`.
fn solution<T: Real>(matrix: &[T], mut right: Vec<T>) -> Result<Vec<T>, Singular> {
    let mut factors = Factors::new(right.len());
    factors.factorize(matrix)?;
    factors.solve(&mut right);
    Ok(right)
}

/// Repeats `step`, which returns its relative length, until one is small, and once more.
fn newton(
    what: &'static str,
    time: f64,
    mut step: impl FnMut() -> Result<f64, Singular>,
) -> Result<(), ReferenceError> {
    let mut length = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let last = length < SMALL;
        length = step().map_err(|singular| ReferenceError::Singular { what, time, pivot: singular.reciprocal })?;
        if last {
            return Ok(());
        }
    }
    Err(ReferenceError::NotConverged { what, time, step: length, limit: SMALL })
}
