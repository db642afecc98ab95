//! A start in exact numbers: as it was written, or drawn at random on the constraint.

use std::cell::OnceCell;
use std::collections::HashMap;
use std::sync::Arc;

use mechanics::elimination::{eliminate, largest, open};
use mechanics::{Completion, Domain, Integrability, Removal, State, System, integrability};
use symbolic::{Evaluator, Expr, Graph, Scalar, Symbol, Tape};

use crate::DecisionError;
use crate::exact::{Coefficient, Echelon, Exact, Flaw, Jet, Modular, agreed, inverse, subtract_product};
use crate::leaf::Leaf;
use crate::series::SeriesStart;

/// Why a start has no exact numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum NoExactStart {
    /// A number of it has no image.
    #[error("{0}")]
    Flaw(#[from] Flaw),
    /// The velocities that the constraints supply are not rational functions of the given ones.
    #[error("the velocities that the constraints supply are not rational functions of the given ones")]
    Nonlinear,
    /// Start equations supply velocities at the start.
    #[error("start equations supply velocities at the start; write these as formulas under [start.velocities]")]
    Equations,
    /// The velocities at the start are projected ones.
    #[error("the velocities at the start are not those of the scene, but projected ones")]
    Projected,
    /// Random positions on which the constraints on positions hold are not found.
    #[error(
        "the constraints on positions cannot be solved at random points: each coordinate occurs in several of them, or with a degree over 2"
    )]
    Positions,
    /// The constraints hold on several surfaces, and which of them the start is on is not seen in the field.
    #[error("the constraints are products, and at random starts it is not known which factor is zero")]
    Product,
    /// The start is given by way of a parametrization whose own start is not written.
    #[error("the start goes by way of the removal `{removal}`, and {what}")]
    Removal { removal: String, what: String },
}

/// A start as it is written: positions and some velocities as expressions in parameters and time.
#[derive(Clone)]
pub struct ExactStart {
    pub(crate) system: System,
    /// Parameters, time, positions and velocities as they are written.
    pub(crate) written: Vec<Expr>,
    /// Parameters, then time; from parameters.
    given: Written,
    /// Positions and velocities; from parameters, time and positions.
    values: Written,
    /// Velocities that the constraints supply.
    pub(crate) supplied: Vec<usize>,
    /// The state as it was found.
    rounded: State,
    integrable: OnceCell<usize>,
    /// What `v` a constraint would be solved for, if none is supplied and the given miss it by round-off.
    pub(crate) spare: Vec<usize>,
    /// `∂f/∂v` at the start, row by row.
    pub(crate) slopes: Vec<f64>,
    pub(crate) constraints: Arc<Tape>,
    pub(crate) leaf: Leaf,
    /// Where random starts are: on the branch of this one they are near it.
    pub(crate) domain: Domain,
    problem: Option<NoExactStart>,
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
        let symbols: Vec<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        let as_written = |symbol: &Symbol| completion.written.iter().find(|(s, _)| s == symbol).map(|(_, e)| *e);
        let positions = q.iter().zip(&state.q).map(|(s, x)| as_written(s).unwrap_or_else(|| decimal(x)));
        let is_rate = |s: &Symbol| *s != system.time && !q.contains(s) && !symbols.contains(s);
        let rates: Vec<(Symbol, Expr)> = completion.written.iter().filter(|(s, _)| is_rate(s)).copied().collect();
        let known = system.parameter_values();
        let unknown = |e: Expr| g.as_number(e).is_some_and(f64::is_nan);
        // a number that was replaced since is no longer what was written
        let time = as_written(&system.time).filter(|&e| unknown(e) || g.evaluate(e, &known) == Ok(state.t));
        let time = time.unwrap_or_else(|| decimal(&state.t));
        let given: Vec<Expr> = system.parameters.iter().map(|p| system.written_parameter(p)).chain([time]).collect();
        let mut written = given.clone();
        let given = Written::new(g, &symbols, &given)?;
        let is_projected = completion.projected.is_some_and(|length| length > 0.0);
        let mut problem = is_projected.then_some(NoExactStart::Projected);
        if !completion.equations.is_empty() {
            problem = Some(NoExactStart::Equations);
        }
        let mut supplied = Vec::new();
        let velocities: Vec<Expr> = if rates.iter().any(|(s, _)| !v.contains(s)) {
            by_removal(system, removal, &rates).unwrap_or_else(|fault| {
                problem = Some(fault);
                vec![g.zero(); v.len()]
            })
        } else if rates.is_empty() || is_projected {
            supplied = (0..v.len()).filter(|&i| completion.supplied.contains(&g.name(v[i]))).collect();
            let decimals = state.v.iter().enumerate();
            decimals.map(|(i, x)| if supplied.contains(&i) { g.zero() } else { decimal(x) }).collect()
        } else {
            supplied = (0..v.len()).filter(|&i| as_written(&v[i]).is_none()).collect();
            v.iter().map(|s| as_written(s).unwrap_or_else(|| g.zero())).collect()
        };
        let mut inputs = symbols;
        inputs.push(system.time);
        inputs.extend(&q);
        let values: Vec<Expr> = positions.chain(velocities).collect();
        written.extend(&values);
        let values = Written::new(g, &inputs, &values)?;
        inputs.extend(&v);
        let mut outputs = system.constraints.clone();
        outputs.extend(g.jacobian(&system.constraints, &v).entries());
        let constraints = g.tape(&inputs, &outputs)?;
        let slopes = slopes(system, state, &constraints);
        let spare = independent_columns(&slopes, system.dimension());
        let (leaf, domain) = (Leaf::new(system)?, Domain::of(system));
        let (system, rounded, integrable) = (system.clone(), state.clone(), OnceCell::new());
        Ok(ExactStart {
            system,
            written,
            given,
            values,
            supplied,
            rounded,
            integrable,
            spare,
            slopes,
            constraints,
            leaf,
            domain,
            problem,
        })
    }

    /// Where what holds at random starts holds.
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// How many independent combinations of the constraints are known to be integrable, exactly: motions stay
    /// on their leaves, and `O` has as many independent columns fewer (theorem 3, iii).
    pub fn integrable_combinations(&self) -> usize {
        *self.integrable.get_or_init(|| {
            let (system, state) = (&self.system.clone(), &self.rounded);
            let h = system.constraints.len();
            match integrability(system, state, state.t + 1.0) {
                Ok(Integrability::Integrable { exact: true }) => h,
                Ok(Integrability::PartlyIntegrable { integrals, exact: true, .. }) => integrals,
                _ => system.integrable_constraints(state),
            }
        })
    }

    /// How many rows of expressions of `g` in parameters, time and positions are independent at the start:
    /// the rank in two fields; `None` where they do not agree, or a number has no image.
    pub fn rank(&self, g: &Graph, rows: &[Vec<Expr>]) -> Option<usize> {
        let parameters = self.system.parameters.iter().map(|p| p.symbol);
        let inputs: Vec<Symbol> = parameters.chain([self.system.time]).chain(self.system.positions()).collect();
        let (program, width) = (g.tape(&inputs, &rows.concat()).ok()?, rows.first()?.len());
        let count = |_| -> Result<usize, NoExactStart> {
            let (parameters, time) = self.given();
            let [q, _] = self.written_state(&parameters, time, &[])?;
            let mut program = Evaluator::<Jet<Modular>>::new(program.clone());
            let values = program.evaluate(&[&parameters[..], &[time], &q].concat());
            if let Some(flaw) = values.iter().find_map(Jet::flaw) {
                return Err(flaw.into());
            }
            let mut found = Echelon::default();
            let row = |row: &[Jet<Modular>]| row.iter().map(|x| x.coefficient(0)).collect();
            Ok(values.chunks(width).filter(|own| found.add(row(own))).count())
        };
        agreed(Default::default(), count, |_| false).ok()
    }

    /// Names of given velocities solved from the constraints, which their decimals miss by round-off.
    pub(crate) fn series(&self) -> Result<(SeriesStart<Modular>, Vec<String>), NoExactStart> {
        if let Some(problem) = &self.problem {
            return Err(problem.clone());
        }
        let (parameters, time) = self.given();
        let [q, v] = self.written_state(&parameters, time, &[])?;
        let start = |v: Vec<Jet<Modular>>| SeriesStart {
            parameters: parameters.clone(),
            time,
            positions: q.clone(),
            velocities: v,
        };
        let solved = self.solved(&parameters, time, &q, &v, &self.supplied);
        match solved {
            Ok(v) => Ok((start(v), Vec::new())),
            Err(NoExactStart::Nonlinear) if self.supplied.is_empty() && !self.spare.is_empty() => {
                let g = &self.system.graph;
                let names = self.spare.iter().map(|&i| g.name(self.system.coordinates[i].velocity)).collect();
                Ok((start(self.solved(&parameters, time, &q, &v, &self.spare)?), names))
            }
            // what is supplied is not determined here: the decimals found count, if they fulfil the
            // constraints
            Err(NoExactStart::Nonlinear) => {
                let mut v = v.clone();
                self.supplied.iter().for_each(|&i| v[i] = Jet::of(self.rounded.v[i]));
                Ok((start(self.solved(&parameters, time, &q, &v, &[])?), Vec::new()))
            }
            Err(fault) => Err(fault),
        }
    }

    /// The start with other numbers for some parameters, coordinates and velocities: what is written by way
    /// of these follows, and velocities that the constraints supply are solved for.
    ///
    /// # Errors
    /// [`NoExactStart`].
    pub fn with<C: Coefficient>(&self, others: &[(Symbol, Jet<C>)]) -> Result<SeriesStart<C>, NoExactStart>
    where
        Jet<C>: Scalar,
    {
        if let Some(problem) = &self.problem {
            return Err(problem.clone());
        }
        let (mut parameters, time) = self.given();
        let other = |symbol: Symbol| others.iter().find(|(own, _)| *own == symbol).map(|(_, x)| *x);
        let own = self.system.parameters.iter().map(|p| other(p.symbol));
        parameters.iter_mut().zip(own).for_each(|(x, own)| *x = own.unwrap_or(*x));
        let [positions, v] = self.written_state(&parameters, time, others)?;
        let h = self.system.constraints.len();
        let open = if self.supplied.len() == h { &self.supplied } else { &self.spare };
        let velocities = self.solved(&parameters, time, &positions, &v, open)?;
        let moved = |i: &usize| other(self.system.coordinates[*i].velocity).is_some();
        if open.iter().any(moved) {
            return Err(NoExactStart::Nonlinear);
        }
        Ok(SeriesStart { parameters, time, positions, velocities })
    }

    /// Positions and velocities as they are written, except those that are others.
    pub(crate) fn written_state<C: Coefficient>(
        &self,
        parameters: &[Jet<C>],
        time: Jet<C>,
        others: &[(Symbol, Jet<C>)],
    ) -> Result<[Vec<Jet<C>>; 2], NoExactStart>
    where
        Jet<C>: Scalar,
    {
        let n = self.system.dimension();
        let mut inputs = [parameters, &[time]].concat();
        let first = inputs.len();
        inputs.resize(first + n, Jet::of(0.0));
        let symbols = [self.system.positions(), self.system.velocities()].concat();
        let other =
            |i: usize, value: Jet<C>| others.iter().find(|(own, _)| *own == symbols[i]).map_or(value, |(_, x)| *x);
        // each position may contain the earlier ones
        for (i, place) in (first..first + n).enumerate() {
            inputs[place] = other(i, self.values.run(&inputs)[i]);
        }
        let values = self.values.run(&inputs);
        let mut values: Vec<Jet<C>> = values.into_iter().enumerate().map(|(i, x)| other(i, x)).collect();
        if let Some(flaw) = values.iter().find_map(Jet::own_flaw) {
            return Err(flaw.into());
        }
        let velocities = values.split_off(n);
        Ok([values, velocities])
    }

    /// Places of velocities solved from the constraints, where [`Self::series`] `completed` these.
    pub(crate) fn open(&self, completed: &[String]) -> &[usize] {
        if completed.is_empty() { &self.supplied } else { &self.spare }
    }

    /// Parameters and time.
    pub(crate) fn given<C: Coefficient>(&self) -> (Vec<Jet<C>>, Jet<C>)
    where
        Jet<C>: Scalar,
    {
        let count = self.system.parameters.len();
        let zeros = vec![Jet::of(0.0); count];
        let mut parameters = self.given.run(&zeros);
        parameters.truncate(count);
        let time = self.given.run(&parameters)[count];
        (parameters, time)
    }

    /// `v` with the entries `open` replaced by what solves `f(q, v, t) = 0`, where that is linear in them.
    pub(crate) fn solved<C: Coefficient, const N: usize>(
        &self,
        parameters: &[Jet<C, N>],
        time: Jet<C, N>,
        q: &[Jet<C, N>],
        v: &[Jet<C, N>],
        open: &[usize],
    ) -> Result<Vec<Jet<C, N>>, NoExactStart>
    where
        Jet<C, N>: Scalar,
    {
        let (h, n) = (self.system.constraints.len(), v.len());
        let mut program = Evaluator::<Jet<C, N>>::new(self.constraints.clone());
        let mut run = |v: &[Jet<C, N>]| -> Result<Vec<C>, NoExactStart> {
            let inputs = [parameters, &[time], q, v].concat();
            let values = program.evaluate(&inputs);
            match values.iter().find_map(Jet::flaw) {
                Some(flaw) => Err(flaw.into()),
                None => Ok(values.iter().map(|x| x.coefficient(0)).collect()),
            }
        };
        let mut v = v.to_vec();
        if open.len() == h && h > 0 {
            let values = run(&v)?;
            let matrix: Vec<C> =
                (0..h).flat_map(|i| open.iter().map(move |&j| (i, j))).map(|(i, j)| values[h + i * n + j]).collect();
            let (over, _) = inverse(&matrix, h, C::of(Exact::ONE)?).ok_or(NoExactStart::Nonlinear)?;
            let mut change = vec![C::ZERO; h];
            subtract_product(&mut change, &over, &values[..h], h, 1);
            for (&i, &dv) in open.iter().zip(&change) {
                v[i] = Jet::constant(v[i].coefficient(0) + dv, None);
            }
        }
        let rest = run(&v)?;
        if rest[..h].iter().all(|x| x.weight() == 0.0) { Ok(v) } else { Err(NoExactStart::Nonlinear) }
    }
}

/// Expressions as they are written, and the decimals among them that a graph has no room for.
#[derive(Clone)]
struct Written {
    program: Arc<Tape>,
    decimals: Vec<Option<f64>>,
}

impl Written {
    fn new(g: &Graph, inputs: &[Symbol], values: &[Expr]) -> Result<Self, DecisionError> {
        // what was written and is not known is NaN
        let is_decimal = |e: Expr, x: f64| x.is_nan() || (g.as_fraction(e).is_none() && e == g.number(x));
        let decimal = |&e: &Expr| g.as_number(e).filter(|&x| is_decimal(e, x));
        let decimals: Vec<Option<f64>> = values.iter().map(decimal).collect();
        let rest = values.iter().zip(&decimals).map(|(&e, x)| if x.is_some() { g.zero() } else { e });
        Ok(Written { program: g.tape(inputs, &rest.collect::<Vec<_>>())?, decimals })
    }

    fn run<C: Coefficient>(&self, inputs: &[Jet<C>]) -> Vec<Jet<C>>
    where
        Jet<C>: Scalar,
    {
        let mut evaluator = Evaluator::<Jet<C>>::new(self.program.clone());
        let values = evaluator.evaluate(inputs).iter().zip(&self.decimals);
        values.map(|(value, decimal)| decimal.map_or(*value, Jet::of)).collect()
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

/// `∂f/∂v` at `state`, row by row.
fn slopes(system: &System, state: &State, constraints: &Arc<Tape>) -> Vec<f64> {
    let parameters: Vec<f64> = system.parameters.iter().map(|p| p.value).collect();
    let inputs = [&parameters[..], &[state.t], &state.q, &state.v].concat();
    Evaluator::<f64>::new(constraints.clone()).evaluate(&inputs)[system.constraints.len()..].to_vec()
}

/// As many velocities as constraints, the best to solve these for; none if they are dependent.
fn independent_columns(slopes: &[f64], n: usize) -> Vec<usize> {
    let mut rows: Vec<Vec<f64>> = slopes.chunks_exact(n).map(<[f64]>::to_vec).collect();
    let mut columns = eliminate(&mut rows, |rows, done| largest(rows, open(rows, done, n)));
    columns.sort_unstable();
    if columns.len() < rows.len() { Vec::new() } else { columns }
}
