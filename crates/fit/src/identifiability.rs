//! Identifiability: the rank of the derivatives of a film's Taylor coefficients with respect to the unknowns.
//!
//! A film without gaps and noise shows the coefficients `c_k` of its columns, `c(t₀ + s) = Σ c_k s^k`. These
//! are algebraic in the numbers of the scene (see [`decision`]); at random unknowns in a finite field, with
//! known numbers as written, `∂c_k/∂θ` comes from series whose coefficients carry derivatives ([`Dual`]).
//!
//! - Full rank: a minor that is not zero modulo a prime is not zero. Analytic in θ, it is not zero at almost
//!   all θ, and there other θ nearby give other films: *proved*. A prior counts as a measurement. Where a
//!   variable expression stands under a root, or has kinks, the set of θ has several pieces: *open*.
//! - Lower rank, up to an order equal to the number of states and unknowns, in two fields: no proof; the
//!   unknowns in the kernel are named.
//!
//! Source: A. Sedoglavic, *A probabilistic algorithm to test local algebraic observability in polynomial
//! time*, J. Symbolic Computation 33 (2002) 735.

use decision::exact::{Coefficient, Dual, Exact, Jet, Modular, ORDERS, agreed, nullspace};
use std::sync::Arc;

use decision::{Dynamics, ExactStart, random_integer};
use motion::{Choice, derive};
use scene::Scene;
use symbolic::{Evaluator, SplitMix, Symbol, Tape};

use crate::Film;
use crate::film::expression;
use crate::part::{Part, Place};
use crate::unknown::{Unknown, constant_names};

/// Random unknowns are integers of either sign up to 2 to one of these powers: functions are taken of them.
const BITS: [u32; 3] = [20, 8, 3];
/// Coefficients beyond as many as there are unknowns per column, before as many as are needed.
const MORE: usize = 2;

/// Whether films of these columns can show the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub enum Identifiability {
    /// At almost all unknowns films tell each of them from values nearby: proved.
    Proved {
        /// Whether something is known before, which counts as measured.
        with_priors: bool,
    },
    /// At almost all unknowns derivatives to this order do not change with these combinations, by ranks in
    /// two fields. Each is given by the unknowns in it.
    Hidden {
        /// Labels of the unknowns of each combination.
        combinations: Vec<Vec<String>>,
        /// The highest order.
        order: usize,
    },
    /// Numbers or equations have no images in a finite field: why.
    Open(String),
}

impl Identifiability {
    /// In words.
    pub fn words(&self) -> String {
        match self {
            Identifiability::Proved { with_priors } => {
                let known = if *with_priors { ", with what is known before," } else { "" };
                format!("at almost all numbers such films{known} tell each of the unknowns from others nearby: proved")
            }
            Identifiability::Hidden { combinations, order } => {
                let each: Vec<String> = combinations.iter().map(|names| names.join(" with ")).collect();
                format!("no such film shows {} (derivatives to order {order}, in two finite fields)", each.join(", "))
            }
            Identifiability::Open(reason) => {
                format!("whether such films can show each of the unknowns is open: {reason}")
            }
        }
    }
}

/// What films of the columns of `parts` can show of the unknowns, as motions of `choice`.
pub(crate) fn identifiability(scene: &Scene, choice: &Choice, parts: &[Part], unknowns: &[Unknown]) -> Identifiability {
    let found = Jets::new(scene, choice, parts, unknowns).and_then(|jets| {
        let few = unknowns.len() + MORE;
        let all = (jets.states + few).min(ORDERS - 1);
        for orders in [few.min(all), all] {
            let seeds = std::array::from_fn(|i| i as u64 + 1);
            let found = agreed(seeds, |seed| jets.hidden(orders, seed), Vec::is_empty);
            let hidden = found.map_err(|fault| fault.unwrap_or_else(|| "finite fields do not agree".into()))?;
            if hidden.is_empty() {
                let with_priors = unknowns.iter().any(|unknown| unknown.prior.is_some());
                return Ok(Identifiability::Proved { with_priors });
            }
            if orders == all && all < jets.states + few {
                return Err(format!(
                    "series are cut at order {}, where {} would be needed",
                    all - 1,
                    jets.states + few - 1
                ));
            }
            if orders == all {
                let names = |of: &Vec<usize>| of.iter().map(|&i| unknowns[i].label()).collect();
                let combinations = hidden.iter().map(names).collect();
                return Ok(Identifiability::Hidden { combinations, order: orders - 1 });
            }
        }
        Err("no order".into())
    });
    found.unwrap_or_else(Identifiability::Open)
}

/// Columns of films as series in the time since the start, with derivatives by the unknowns.
struct Jets<'a> {
    start: ExactStart,
    dynamics: Dynamics,
    /// The columns, from parameters, `t`, `q`, `v`; film by film.
    columns: Vec<Arc<Tape>>,
    inputs: usize,
    states: usize,
    /// Names of the free constants, in the order of the equations.
    constants: Vec<String>,
    scene: &'a Scene,
    parts: &'a [Part],
    unknowns: &'a [Unknown],
}

impl<'a> Jets<'a> {
    fn new(scene: &'a Scene, choice: &Choice, parts: &'a [Part], unknowns: &'a [Unknown]) -> Result<Self, String> {
        let system = &scene.system;
        let start = ExactStart::new(system, &scene.start, &scene.completion, choice.removal.as_ref());
        let start = start.map_err(|fault| fault.to_string())?;
        if start.domain().branch {
            return Err("something that varies stands under a root or has a kink in L, f or Q".into());
        }
        let equations = derive(system, choice).map_err(|fault| fault.to_string())?;
        let dynamics = Dynamics::new(system, &equations).map_err(|fault| fault.to_string())?;
        let constants = constant_names(scene, choice);
        let count = equations.constant_symbols().len();
        if count > 0 && count != constants.len() {
            return Err("some constants do not enter the equations".into());
        }
        let symbols: Vec<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        let inputs = [&symbols[..], &[system.time], &system.positions(), &system.velocities()].concat();
        let program = |film: &Film| {
            let columns = film.columns.iter().map(|column| expression(scene, &column.name));
            let columns = columns.collect::<Result<Vec<_>, _>>().map_err(|fault| fault.to_string())?;
            if !system.graph.kinks(&columns).is_empty() || !system.graph.radicands(&columns).is_empty() {
                return Err("a column contains a root or has a kink".into());
            }
            system.graph.tape(&inputs, &columns).map_err(|fault| fault.to_string())
        };
        let columns = parts.iter().map(|part| program(&part.film)).collect::<Result<_, _>>()?;
        let (states, inputs) = (equations.states.len(), inputs.len());
        let constants = constants[..count].to_vec();
        Ok(Jets { start, dynamics, columns, inputs, states, constants, scene, parts, unknowns })
    }

    /// Unknowns in each combination that coefficients up to this many do not show.
    fn hidden(&self, orders: usize, seed: u64) -> Result<Vec<Vec<usize>>, String> {
        let mut fault = None;
        for bits in BITS {
            match self.slopes(orders, seed, bits) {
                Ok(columns) => {
                    let kernel = nullspace(&columns, 0).1.into_iter();
                    let of = |x: Vec<Modular>| (0..x.len()).filter(|&j| !x[j].is_zero()).collect();
                    return Ok(kernel.map(of).collect());
                }
                Err(reason) => fault = fault.or(Some(reason)),
            }
        }
        Err(fault.unwrap_or_default())
    }

    /// By unknown: derivatives of all coefficients, and of what is known before.
    fn slopes(&self, orders: usize, seed: u64, bits: u32) -> Result<Vec<Vec<Modular>>, String> {
        let mut random = SplitMix::new(seed);
        let mut draw = || Exact::ratio(random_integer(&mut random, bits), 1).ok_or("no number".to_string());
        let numbers = self.unknowns.iter().map(|_| draw()).collect::<Result<Vec<_>, _>>()?;
        let column = |j: usize| -> Result<Vec<Modular>, String> {
            let mut slopes = Vec::new();
            for (part, program) in self.parts.iter().zip(&self.columns) {
                slopes.extend(self.film(part, program, &numbers, j, orders)?);
            }
            let before = self.unknowns.iter().enumerate().filter(|(_, unknown)| unknown.prior.is_some());
            slopes.extend(before.map(|(i, _)| if i == j { Modular::one() } else { Modular::ZERO }));
            Ok(slopes)
        };
        (0..self.unknowns.len()).map(column).collect()
    }

    /// Derivatives of the coefficients of one film by unknown `j`.
    fn film(
        &self,
        part: &Part,
        program: &Arc<Tape>,
        numbers: &[Exact],
        j: usize,
        orders: usize,
    ) -> Result<Vec<Modular>, String> {
        let graph = &self.scene.system.graph;
        let mut constants = vec![Jet::of(0.0); self.constants.len()];
        let mut others: Vec<(Symbol, Jet<Dual>)> = Vec::new();
        for (name, place) in part.model.names().iter().zip(&part.places) {
            let value = match *place {
                Place::Known(value) => Jet::of(value),
                Place::Unknown(i) => {
                    let value = Modular::of(numbers[i]).map_err(|flaw| flaw.to_string())?;
                    let slope = if i == j { Modular::one() } else { Modular::ZERO };
                    Jet::constant(Dual { value, slope }, Some(numbers[i]))
                }
            };
            match (self.constants.iter().position(|own| own == name), graph.find_symbol(name)) {
                (Some(i), _) => constants[i] = value,
                (None, Some(symbol)) => others.push((symbol, value)),
                // a constant that does not enter the equations
                (None, None) => {}
            }
        }
        let start = self.start.with(&others).map_err(|fault| fault.to_string())?;
        let curve = self.dynamics.series(&start, &constants, orders).map_err(|fault| fault.to_string())?;
        let mut evaluator = Evaluator::<Jet<Dual>>::new(program.clone());
        let seen = evaluator.evaluate(&curve.inputs[..self.inputs]);
        if let Some(flaw) = seen.iter().find_map(|column| column.flaw()) {
            return Err(flaw.to_string());
        }
        // a clock that is slow by c has k-th coefficients (1 + c)^k times as large; ranks are those of c = 0
        let is_clock = matches!(part.clock, Some(Place::Unknown(i)) if i == j);
        let slope = |c: Dual, k: usize| if is_clock { Modular::new(k as u64) * c.value } else { c.slope };
        Ok(seen.iter().flat_map(|column| (0..orders).map(|k| slope(column.coefficient(k), k))).collect())
    }
}
