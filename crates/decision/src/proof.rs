//! The proof over a finite field.

use std::sync::Arc;

use equations::Equations;
use mechanics::{Domain, State, System};
use symbolic::{Tape, question};

use crate::DecisionError;
use crate::curve::{Dynamics, Flow};
use crate::exact::{self, Coefficient, Echelon, FIELDS, Jet, Modular, ORDERS};
use crate::family::Family;
use crate::flow::inputs;
use crate::order_by_order::NoSeries;
use crate::random_start::at_random;
use crate::series::{CurveSeries, MismatchSeries, SeriesStart};
use crate::start::ExactStart;

/// Seeds of the random starts, one per field: a rank that two of them agree on is the generic one, except for
/// an accident.
const SEEDS: [u64; FIELDS.len()] = [0x5eed_0001, 0x5eed_0002, 0x5eed_0003, 0x5eed_0004];
/// Orders for which a certificate has room for its series.
const MOST: usize = ORDERS - 3;
/// Work limit in steps of programs times cubes of orders: about half a second.
const WORK: usize = 100_000_000;

/// Result of the proof for a start, from the jets of the mismatch.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// No constants give this motion.
    None(NoConstants),
    /// Some constants do, by ranks modulo two primes: `[O | o]` and `O` have the same rank at every order,
    /// and it stops growing.
    Contained {
        /// The rank of `O`: the number of constants that are fixed.
        rank: usize,
        /// The order from which on the ranks stay the same.
        order: usize,
    },
    /// Some constants do up to this order; higher orders are not known.
    ThroughOrder {
        /// The rank of `O` there.
        rank: usize,
        /// The highest order that was tried.
        order: usize,
    },
    /// There is no proof of this kind, for this reason.
    NotApplicable(String),
}

/// A proof that no constants give the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct NoConstants {
    /// The order of the derivative of the mismatch that excludes the last constants.
    pub order: usize,
    /// Whether `O` has the largest rank that it can have, one less for each integrable combination of the
    /// constraints that is known: then a minor that is not zero is a proof. Otherwise the result rests on
    /// ranks modulo two primes, which equal those of the real numbers except by accident.
    pub full_rank: bool,
    /// The size of that minor: the rank of `[O | o]`.
    pub size: usize,
}

/// Results of the proof for one start and for almost every start.
#[derive(Clone, Debug, PartialEq)]
pub struct Proof {
    /// About the start as it is written.
    pub this_start: Finding,
    /// About all starts on the constraint but a set of measure zero.
    pub almost_every_start: Finding,
    /// Which starts these are.
    pub domain: Domain,
    /// Velocities given as decimals that miss the constraints by round-off, solved from these here.
    pub completed: Vec<String>,
}

/// Ranks of `O` and `[O | o]` up to each order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Ranks {
    by_order: Vec<(usize, usize)>,
    constants: usize,
    at_rest: bool,
}

impl Ranks {
    pub(crate) fn of(series: &MismatchSeries<Modular>) -> Ranks {
        let constants = series.width - 1;
        let mut echelon = Echelon::default();
        let ranks = series.orders.iter().map(|entries| {
            for row in entries.chunks_exact(series.width) {
                echelon.add(row.to_vec());
            }
            let whole = echelon.0.len();
            (whole - usize::from(echelon.0.iter().any(|(pivot, _)| *pivot == constants)), whole)
        });
        Ranks { by_order: ranks.collect(), constants, at_rest: series.at_rest }
    }

    /// The order at which no constants are left.
    pub(crate) fn refuted(&self, start: &ExactStart) -> Option<NoConstants> {
        let order = self.by_order.iter().position(|(of_constants, whole)| whole > of_constants)?;
        let (rank, size) = self.by_order[order];
        let are_multipliers = self.constants == start.system.constraints.len();
        let full_rank =
            rank == self.constants || are_multipliers && rank + start.integrable_combinations() == self.constants;
        Some(NoConstants { order, full_rank, size })
    }

    fn is_refuted(&self) -> bool {
        self.by_order.iter().any(|(of_constants, whole)| whole > of_constants)
    }

    /// The order from which on the ranks stay the same.
    fn settled(&self) -> Option<usize> {
        (1..self.by_order.len()).find(|&k| self.by_order[k] == self.by_order[k - 1])
    }

    fn last(&self) -> usize {
        self.by_order.last().map_or(0, |(rank, _)| *rank)
    }
}

/// Equations of a curve and a family of motions, ready for series.
#[derive(Clone)]
pub struct Question<'a> {
    family: &'a Family,
    dynamics: Dynamics,
    pub(crate) curve: Equations,
    constants: Vec<f64>,
    /// Names of the coordinates.
    pub(crate) names: Vec<String>,
    /// Divisors in `L`, `f` and `Q`.
    pub(crate) denominators: Arc<Tape>,
    pub(crate) divisors: Vec<String>,
}

impl<'a> Question<'a> {
    /// Is the motion of `curve`, equations derived for `system`, own free `constants`, in `family`?
    ///
    /// # Errors
    /// [`DecisionError::Unsuited`].
    pub fn new(
        system: &System,
        curve: &Equations,
        constants: &[f64],
        family: &'a Family,
    ) -> Result<Self, DecisionError> {
        let g = &system.graph;
        let all = [&[system.lagrangian][..], &system.constraints, &system.forces].concat();
        let divisors = g.denominators(&all);
        Ok(Question {
            family,
            dynamics: Dynamics::new(system, curve)?,
            curve: curve.clone(),
            constants: constants.to_vec(),
            names: system.coordinates.iter().map(|c| c.name.clone()).collect(),
            denominators: g.tape(&inputs(system, &[]), &divisors)?,
            divisors: divisors.iter().map(|&e| g.plain(e)).collect(),
        })
    }

    /// The motion in question, from `start` to `end`.
    pub fn flow(&self, system: &System, start: &State, end: f64) -> Flow {
        Flow::of(self.dynamics.clone(), system, start, &self.constants, end)
    }

    pub(crate) fn family(&self) -> &Family {
        self.family
    }

    /// Orders that are looked at: `2h + 7`, and as many more as take no second.
    pub(crate) fn orders(&self) -> usize {
        let work = |orders: usize| (self.dynamics.steps() + self.family.program.len()) * orders.pow(3);
        let usual = (2 * self.family.shape.constants + 7).min(MOST);
        (usual..=MOST).rev().find(|&orders| work(orders) <= WORK).unwrap_or(usual)
    }

    pub(crate) fn series<C: Coefficient>(
        &self,
        start: &SeriesStart<C>,
        orders: usize,
    ) -> Result<(CurveSeries<C>, MismatchSeries<C>), NoSeries>
    where
        Jet<C>: symbolic::Scalar,
    {
        let constants: Vec<Jet<C>> = self.constants.iter().map(|&c| Jet::of(c)).collect();
        let curve = self.dynamics.series(start, &constants, orders)?;
        let mismatch = self.family.series(&curve, orders)?;
        Ok((curve, mismatch))
    }

    /// Proves what can be proved about `start` and about almost every start.
    pub fn prove(&self, start: &ExactStart) -> Proof {
        let almost_every_start = self.prove_almost_every(start);
        let mut completed = Vec::new();
        let ranks = agreed(start, |_| {
            let (exact, names) = start.series().map_err(|fault| fault.to_string())?;
            completed = names;
            self.ranks(&exact, |ranks| is_generic(ranks, &almost_every_start))
        });
        let this_start = match ranks {
            Ok(ranks) => self.particular(start, &ranks, &almost_every_start),
            Err(reason) => Finding::NotApplicable(reason),
        };
        Proof { this_start, almost_every_start, completed, domain: start.domain }
    }

    /// Ranks at few orders where these are `enough`, else at more, else at all.
    pub(crate) fn ranks(&self, start: &SeriesStart<Modular>, enough: impl Fn(&Ranks) -> bool) -> Result<Ranks, String> {
        let h = self.family.shape.constants;
        let all = self.orders();
        for orders in [h + 3, 2 * h + 7] {
            let ranks = Ranks::of(&self.series(start, orders.min(all)).map_err(|fault| fault.to_string())?.1);
            if orders >= all || ranks.is_refuted() || enough(&ranks) {
                return Ok(ranks);
            }
        }
        Ok(Ranks::of(&self.series(start, all).map_err(|fault| fault.to_string())?.1))
    }

    fn particular(&self, start: &ExactStart, ranks: &Ranks, generic: &Finding) -> Finding {
        if let Some(none) = ranks.refuted(start) {
            return Finding::None(none);
        }
        // at rest η obeys one linear equation with constant coefficients, and the constant 1 beside it makes
        // this homogeneous: coefficients beyond its order follow from those before
        let enough = self.family.shape.costates;
        let at_rest = ranks.at_rest && self.dynamics.timeless && self.family.timeless && enough < ranks.by_order.len();
        // where the rank is the generic one it stays so nearby, and the jets obey one linear equation
        match generic {
            _ if at_rest => Finding::Contained { rank: ranks.last(), order: enough },
            Finding::Contained { .. } if is_generic(ranks, generic) => generic.clone(),
            _ => Finding::ThroughOrder { rank: ranks.last(), order: ranks.by_order.len() - 1 },
        }
    }

    /// What can be proved about almost every start on the branch of `start`.
    pub fn prove_almost_every(&self, start: &ExactStart) -> Finding {
        let ranks =
            agreed(start, |seed| at_random(start, seed, |exact| self.ranks(&exact, |ranks| ranks.settled().is_some())));
        match ranks.map(|ranks| (ranks.refuted(start), ranks.settled(), ranks)) {
            Err(reason) => Finding::NotApplicable(reason),
            Ok((Some(none), ..)) => Finding::None(none),
            Ok((None, Some(order), ranks)) => Finding::Contained { rank: ranks.last(), order },
            Ok((None, None, ranks)) => Finding::ThroughOrder { rank: ranks.last(), order: ranks.by_order.len() - 1 },
        }
    }
}

/// Whether ranks are those of almost every start, where that has constants.
fn is_generic(ranks: &Ranks, generic: &Finding) -> bool {
    matches!(generic, Finding::Contained { rank, .. } if *rank == ranks.last())
}

/// Ranks that two fields agree on; a minor that is not zero needs one field only.
fn agreed(start: &ExactStart, ranks: impl FnMut(u64) -> Result<Ranks, String>) -> Result<Ranks, String> {
    let is_proof = |ranks: &Ranks| ranks.refuted(start).is_some_and(|none| none.full_rank);
    let found = question(|| exact::agreed(SEEDS, ranks, is_proof));
    found
        .map_err(|stopped| stopped.to_string())?
        .map_err(|fault| fault.unwrap_or_else(|| "no two fields agree on the ranks".into()))
}
