//! A start in exact numbers: as it was written, or drawn at random on the constraint.

use std::collections::HashMap;

use mechanics::{Completion, Removal, State, System};
use symbolic::{Expr, Symbol};

use crate::DecisionError;
use crate::exact::{Coefficient, Exact, Flaw, Jet, Modular, inverse, subtract_product};
use crate::program::Program;
use crate::series::SeriesStart;

/// Random positions and velocities are integers up to this one.
const LARGEST: u64 = 1 << 20;
/// Draws until the constraints have roots: where they are squares, each has one for every second draw.
const DRAWS: usize = 256;

/// Why a start has no exact numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoExactStart {
    /// A number of it has no image.
    #[error("{0}")]
    Flaw(#[from] Flaw),
    /// The velocities that the constraints supply are not rational functions of the given ones.
    #[error("the velocities that the constraints supply are no rational functions of the given ones")]
    Nonlinear,
    /// The start is given by way of a parametrization whose own start is not written.
    #[error("the start goes by way of the removal `{removal}`, and {what}")]
    Removal {
        /// Its name.
        removal: String,
        /// What is missing.
        what: String,
    },
}

/// A start as it is written: positions and some velocities as expressions in parameters and time.
#[derive(Clone)]
pub struct ExactStart {
    system: System,
    time: f64,
    /// Positions and velocities from parameters, time and positions; numbers among them, which need no graph.
    values: Program,
    numbers: Vec<Option<f64>>,
    /// Velocities that the constraints supply.
    supplied: Vec<usize>,
    /// What `v` a constraint would be solved for, if none is supplied and the given miss it by round-off.
    spare: Vec<usize>,
    constraints: Program,
    problem: Option<NoExactStart>,
    /// Whether velocities are projected ones, not those written.
    pub(crate) projected: bool,
}

impl ExactStart {
    /// The start of `state`, written as `completion` says; `removal`: the one that start rates may be of.
    ///
    /// # Errors
    /// [`DecisionError::Compile`] for expressions with symbols that the system does not have.
    pub fn new(
        system: &System,
        state: &State,
        completion: &Completion,
        removal: Option<&Removal>,
    ) -> Result<Self, DecisionError> {
        let g = &system.graph;
        let (q, v) = (system.positions(), system.velocities());
        let decimal = |x: &f64| g.number(*x);
        let as_written = |symbol: &Symbol| completion.written.iter().find(|(s, _)| s == symbol).map(|(_, e)| *e);
        let positions = q.iter().zip(&state.q).map(|(s, x)| as_written(s).unwrap_or_else(|| decimal(x)));
        let rates: Vec<(Symbol, Expr)> = completion.written.iter().filter(|(s, _)| !q.contains(s)).copied().collect();
        let mut problem = None;
        let mut supplied = Vec::new();
        let velocities: Vec<Expr> = if rates.iter().any(|(s, _)| !v.contains(s)) {
            by_removal(system, removal, &rates).unwrap_or_else(|fault| {
                problem = Some(fault);
                vec![g.zero(); v.len()]
            })
        } else if rates.is_empty() || completion.projected.is_some() {
            supplied = (0..v.len()).filter(|&i| completion.supplied.contains(&g.name(v[i]))).collect();
            let decimals = state.v.iter().enumerate();
            decimals.map(|(i, x)| if supplied.contains(&i) { g.zero() } else { decimal(x) }).collect()
        } else {
            supplied = (0..v.len()).filter(|&i| as_written(&v[i]).is_none()).collect();
            v.iter().map(|s| as_written(s).unwrap_or_else(|| g.zero())).collect()
        };
        let mut inputs: Vec<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        inputs.push(system.time);
        inputs.extend(&q);
        let values: Vec<Expr> = positions.chain(velocities).collect();
        let numbers = values.iter().map(|&e| g.as_number(e)).collect();
        let values = Program::new(g, &inputs, &values)?;
        inputs.extend(&v);
        let mut outputs = system.constraints.clone();
        outputs.extend(g.jacobian(&system.constraints, &v).entries());
        let constraints = Program::new(g, &inputs, &outputs)?;
        let spare = independent_columns(system, state, &constraints);
        let projected = completion.projected.is_some();
        let (system, time) = (system.clone(), state.t);
        Ok(ExactStart { system, time, values, numbers, supplied, spare, constraints, problem, projected })
    }

    /// Names of given velocities solved from the constraints, which their decimals miss by round-off.
    pub(crate) fn series(&self) -> Result<(SeriesStart<Modular>, Vec<String>), NoExactStart> {
        if let Some(problem) = &self.problem {
            return Err(problem.clone());
        }
        let (parameters, time) = self.given();
        let n = self.system.dimension();
        let mut inputs = [&parameters[..], &[time]].concat();
        let first = inputs.len();
        inputs.resize(first + n, Jet::constant(Modular::ZERO, Some(Exact::ZERO)));
        let mut evaluator = self.values.evaluator::<Jet<Modular>>();
        let value = |i: usize, values: &[Jet<Modular>]| self.numbers[i].map_or(values[i], Jet::of);
        // each position may contain the earlier ones
        for i in 0..n {
            inputs[first + i] = value(i, evaluator.run(&inputs));
        }
        let values = evaluator.run(&inputs);
        let values: Vec<Jet<Modular>> = (0..2 * n).map(|i| value(i, values)).collect();
        if let Some(flaw) = values.iter().find_map(Jet::own_flaw) {
            return Err(flaw.into());
        }
        let (q, v) = values.split_at(n);
        let start = |v: Vec<Jet<Modular>>| SeriesStart {
            parameters: parameters.clone(),
            time,
            positions: q.to_vec(),
            velocities: v,
        };
        let solved = self.solved(&parameters, time, q, v, &self.supplied);
        match solved {
            Ok(v) => Ok((start(v), Vec::new())),
            Err(NoExactStart::Nonlinear) if self.supplied.is_empty() && !self.spare.is_empty() => {
                let g = &self.system.graph;
                let names = self.spare.iter().map(|&i| g.name(self.system.coordinates[i].velocity)).collect();
                Ok((start(self.solved(&parameters, time, q, v, &self.spare)?), names))
            }
            Err(fault) => Err(fault),
        }
    }

    /// Places of velocities solved from the constraints, where [`Self::series`] `completed` these.
    pub(crate) fn open(&self, completed: &[String]) -> &[usize] {
        if completed.is_empty() { &self.supplied } else { &self.spare }
    }

    /// Random integers for positions and velocities, the others from the constraints. Square ones: the start
    /// is where `f = 0` has its roots: both signs, unless the constraint is a product.
    pub(crate) fn random(&self, seed: u64) -> Result<SeriesStart<Modular>, NoExactStart> {
        let (parameters, time) = self.given();
        let mut state = seed;
        let mut draw = || {
            // SplitMix64
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut x = state;
            x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            let n = i128::from((x ^ (x >> 31)) % LARGEST) + 1;
            let exact = Exact { numerator: n, denominator: 1, quarters: 0 };
            Modular::of(exact).map(|value| Jet::constant(value, Some(exact)))
        };
        let n = self.system.dimension();
        let choices = [&self.supplied, &self.spare];
        let usual = choices.into_iter().find(|choice| choice.len() == self.system.constraints.len());
        for _ in 0..DRAWS {
            let q = (0..n).map(|_| draw()).collect::<Result<Vec<_>, _>>()?;
            let v = (0..n).map(|_| draw()).collect::<Result<Vec<_>, _>>()?;
            let velocities = match self.solved(&parameters, time, &q, &v, usual.unwrap_or(&self.spare)) {
                Err(NoExactStart::Nonlinear) => self.with_roots(&parameters, time, &q, &v)?,
                solved => Some(solved?),
            };
            if let Some(velocities) = velocities {
                return Ok(SeriesStart { parameters, time, positions: q, velocities });
            }
        }
        Err(NoExactStart::Nonlinear)
    }

    /// `v` on quadratic constraints, each for a velocity that the fewest contain; `None` without a root.
    fn with_roots(
        &self,
        parameters: &[Jet<Modular>],
        time: Jet<Modular>,
        q: &[Jet<Modular>],
        v: &[Jet<Modular>],
    ) -> Result<Option<Vec<Jet<Modular>>>, NoExactStart> {
        let (h, n) = (self.system.constraints.len(), v.len());
        let mut program = self.constraints.evaluator::<Jet<Modular>>();
        let inputs = |v: &[Jet<Modular>]| [parameters, &[time], q, v].concat();
        let values = program.run(&inputs(v)).to_vec();
        let contains = |i: usize, j: usize| !values[h + i * n + j].coefficient(0).is_zero();
        let mut v = v.to_vec();
        let mut open: Vec<usize> = (0..n).collect();
        for i in 0..h {
            let others = |j: &usize| (0..h).filter(|&i| contains(i, *j)).count();
            let Some(j) = open.iter().copied().filter(|&j| contains(i, j)).min_by_key(others) else {
                return Err(NoExactStart::Nonlinear);
            };
            open.retain(|&other| other != j);
            let before = v[j].coefficient(0);
            // v_j + s: coefficients are those of the constraint as a polynomial in s
            let (zero, one) = (Modular::ZERO, Modular::one());
            v[j] = Jet::series(&[before, one, zero, zero, zero], None);
            let f = program.run(&inputs(&v))[i];
            let [c, b, a, third, fourth] = std::array::from_fn(|k| f.coefficient(k));
            if f.flaw().is_some() || !third.is_zero() || !fourth.is_zero() {
                return Err(NoExactStart::Nonlinear);
            }
            let two = Modular::new(2);
            let change = match (two * a).inverse() {
                Some(over) => (b * b - two * two * a * c).square_root().map(|root| (root - b) * over),
                None => b.inverse().map(|over| -c * over),
            };
            let Some(change) = change else { return Ok(None) };
            v[j] = Jet::constant(before + change, None);
        }
        self.solved(parameters, time, q, &v, &[]).map(Some)
    }

    fn given(&self) -> (Vec<Jet<Modular>>, Jet<Modular>) {
        (self.system.parameters.iter().map(|p| Jet::of(p.value)).collect(), Jet::of(self.time))
    }

    /// `v` with the entries `open` replaced by what solves `f(q, v, t) = 0`, where that is linear in them.
    fn solved(
        &self,
        parameters: &[Jet<Modular>],
        time: Jet<Modular>,
        q: &[Jet<Modular>],
        v: &[Jet<Modular>],
        open: &[usize],
    ) -> Result<Vec<Jet<Modular>>, NoExactStart> {
        let (h, n) = (self.system.constraints.len(), v.len());
        let mut program = self.constraints.evaluator::<Jet<Modular>>();
        let mut run = |v: &[Jet<Modular>]| -> Result<Vec<Modular>, NoExactStart> {
            let inputs = [parameters, &[time], q, v].concat();
            let values = program.run(&inputs);
            match values.iter().find_map(Jet::flaw) {
                Some(flaw) => Err(flaw.into()),
                None => Ok(values.iter().map(|x| x.coefficient(0)).collect()),
            }
        };
        let mut v = v.to_vec();
        if open.len() == h && h > 0 {
            let values = run(&v)?;
            let matrix: Vec<Modular> =
                (0..h).flat_map(|i| open.iter().map(move |&j| (i, j))).map(|(i, j)| values[h + i * n + j]).collect();
            let (over, _) = inverse(&matrix, h, Modular::one()).ok_or(NoExactStart::Nonlinear)?;
            let mut change = vec![Modular::ZERO; h];
            subtract_product(&mut change, &over, &values[..h], h, 1);
            for (&i, &dv) in open.iter().zip(&change) {
                v[i] = Jet::constant(v[i].coefficient(0) + dv, None);
            }
        }
        let rest = run(&v)?;
        if rest[..h].iter().all(|x| x.is_zero()) { Ok(v) } else { Err(NoExactStart::Nonlinear) }
    }
}

/// `q̇(ü, u̇, u, w, t)` with everything as written.
fn by_removal(system: &System, removal: Option<&Removal>, rates: &[(Symbol, Expr)]) -> Result<Vec<Expr>, NoExactStart> {
    let g = &system.graph;
    let Some(removal) = removal else {
        return Err(NoExactStart::Removal { removal: "?".into(), what: "there is none".into() });
    };
    let missing = |what: String| NoExactStart::Removal { removal: removal.name.clone(), what };
    let mut known: HashMap<Symbol, Expr> = removal.start.iter().map(|(&s, &e)| (s, e)).collect();
    known.extend(rates.iter().copied());
    let velocities = g.substitute_all(&removal.velocities(system), &known);
    let told = |s: &Symbol| {
        *s == system.time || system.positions().contains(s) || system.parameters.iter().any(|p| p.symbol == *s)
    };
    match velocities.iter().flat_map(|&e| g.symbols_of(e)).find(|s| !told(s)) {
        Some(s) => Err(missing(format!("`{}` is not written", g.name(s)))),
        None => Ok(velocities),
    }
}

/// As many velocities as constraints, the best to solve these for at `state`; none if they are dependent.
fn independent_columns(system: &System, state: &State, constraints: &Program) -> Vec<usize> {
    let (h, n) = (system.constraints.len(), system.dimension());
    let parameters: Vec<f64> = system.parameters.iter().map(|p| p.value).collect();
    let inputs = [&parameters[..], &[state.t], &state.q, &state.v].concat();
    let mut rows: Vec<Vec<f64>> =
        constraints.evaluator::<f64>().run(&inputs)[h..].chunks_exact(n).map(<[f64]>::to_vec).collect();
    let mut columns = Vec::new();
    for step in 0..h {
        let places = (step..h).flat_map(|i| (0..n).map(move |j| (i, j)));
        let best = places.max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs()));
        let Some((row, column)) = best.filter(|&(i, j)| rows[i][j] != 0.0) else { return Vec::new() };
        rows.swap(step, row);
        let pivot = rows[step].clone();
        for other in &mut rows[step + 1..] {
            let factor = other[column] / pivot[column];
            other.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
            other[column] = 0.0;
        }
        columns.push(column);
    }
    columns.sort_unstable();
    columns
}
