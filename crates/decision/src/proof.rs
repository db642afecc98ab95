//! The proof over a finite field.

use equations::Equations;
use mechanics::System;

use crate::DecisionError;
use crate::curve::Dynamics;
use crate::exact::{Coefficient, Jet, Modular, ORDER, ORDERS, PRIME, inverse};
use crate::family::{Family, inputs};
use crate::program::Program;
use crate::series::{CurveSeries, MismatchSeries, NoSeries, SeriesStart};
use crate::start::ExactStart;

/// Seeds of the random starts: a rank that two of them agree on is the generic one, but for an accident.
const SEEDS: [u64; 2] = [0x5eed_0001, 0x5eed_0002];

/// What the jets of the mismatch say about a start.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// No constants give this motion.
    None(NoConstants),
    /// Some do: the rank of `[O | o]` is that of `O` at every order, and grows no more.
    Contained {
        /// The rank of `O`: so many constants are fixed.
        rank: usize,
        /// The order from which on the ranks stay.
        order: usize,
    },
    /// Up to this order some do, and nothing is known beyond.
    ThroughOrder {
        /// The rank of `O` there.
        rank: usize,
        /// The highest order that was looked at.
        order: usize,
    },
    /// There is no proof of this kind, for this reason.
    NotApplicable(String),
}

/// A proof that no constants give the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct NoConstants {
    /// The order of the derivative of the mismatch at which the last choice is gone.
    pub order: usize,
    /// The minor that is not zero. There is none where `O` has less than full rank; then the proof rests on ranks modulo `p`, which are those of the
    /// real numbers but for an accident of a probability of about 1e-17.
    pub certificate: Option<Certificate>,
}

/// What somebody else needs to check a proof.
///
/// The images of `e^{i a}` and `e^a` are `circle^a` and `neper^a`, exponents modulo [`Certificate::root_order`].
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// `p`.
    pub prime: u64,
    /// `r`, a prime factor of `p − 1`.
    pub root_order: u64,
    /// Images of `e^i`, `e` and `√−1`.
    pub circle: u64,
    /// Image of `e`.
    pub neper: u64,
    /// Image of `√−1`.
    pub imaginary: u64,
    /// `q₀`, then `v₀`.
    pub start: Vec<StartNumber>,
    /// The order that decides.
    pub order: usize,
    /// Rows of `[O | o]`, each as the order and the place among the accelerations of the family.
    pub rows: Vec<(usize, usize)>,
    /// The minor, row by row: coefficients of the constants, then `y₀`.
    pub minor: Vec<Vec<u64>>,
    /// Its determinant, not zero.
    pub determinant: u64,
    /// What was divided by, with its image, not zero.
    pub divided_by: Vec<(String, u64)>,
}

/// A number of the start, with its image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StartNumber {
    /// Name of the coordinate or velocity.
    pub name: String,
    /// The number, where it is rational or a multiple of π/2.
    pub exact: Option<String>,
    /// Its image; 0 for a multiple of π/2, which has one inside of sines and cosines only.
    pub image: u64,
}

/// What can be proved about one start and about almost every start.
#[derive(Clone, Debug, PartialEq)]
pub struct Proof {
    /// About the start as it is written.
    pub this_start: Finding,
    /// About all starts on the constraint but a set of measure zero.
    pub almost_every_start: Finding,
    /// Velocities that were given as decimals and are solved from the constraints here, which their decimals miss by round-off.
    pub completed: Vec<String>,
}

/// Ranks of `O` and `[O | o]` up to each order.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Ranks {
    by_order: Vec<(usize, usize)>,
    rows: Vec<(usize, usize)>,
}

impl Ranks {
    fn of(series: &MismatchSeries<Modular>) -> Ranks {
        let (width, last) = (series.width, series.width - 1);
        let mut echelon: Vec<(usize, Vec<Modular>)> = Vec::new();
        let (mut by_order, mut rows) = (Vec::new(), Vec::new());
        for (order, entries) in series.orders.iter().enumerate() {
            for (place, row) in entries.chunks_exact(width).enumerate() {
                let mut row = row.to_vec();
                for (pivot, other) in &echelon {
                    let factor = row[*pivot];
                    if !factor.is_zero() {
                        row.iter_mut().zip(other).for_each(|(x, &y)| *x = *x - factor * y);
                    }
                }
                let pivot = row.iter().position(|x| !x.is_zero());
                if let Some((pivot, over)) = pivot.and_then(|pivot| Some((pivot, row[pivot].inverse()?))) {
                    row.iter_mut().for_each(|x| *x = *x * over);
                    echelon.push((pivot, row));
                    rows.push((order, place));
                }
            }
            let whole = echelon.len();
            by_order.push((whole - usize::from(echelon.iter().any(|(pivot, _)| *pivot == last)), whole));
        }
        Ranks { by_order, rows }
    }

    /// The order at which no constants are left.
    fn refuted(&self) -> Option<usize> {
        self.by_order.iter().position(|(of_constants, whole)| whole > of_constants)
    }

    /// The order from which on the ranks stay the same.
    fn settled(&self) -> Option<usize> {
        (1..self.by_order.len()).find(|&k| self.by_order[k] == self.by_order[k - 1])
    }

    fn last(&self) -> usize {
        self.by_order.last().map_or(0, |(rank, _)| *rank)
    }
}

/// A random start with its series and their ranks.
type Sampled = (SeriesStart<Modular>, CurveSeries<Modular>, MismatchSeries<Modular>, Ranks);

/// Equations of a curve and a family of motions, ready for series.
#[derive(Clone)]
pub struct Question<'a> {
    family: &'a Family,
    dynamics: Dynamics,
    constants: Vec<f64>,
    names: Vec<String>,
    /// What `L`, `f` and `Q` divide by.
    denominators: Program,
    divisors: Vec<String>,
}

impl<'a> Question<'a> {
    /// Is the motion of `curve`, equations as derived for `system` with `constants` for their own free constants, in `family`?
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
            constants: constants.to_vec(),
            names: system.positions().into_iter().chain(system.velocities()).map(|s| g.name(s)).collect(),
            denominators: Program::new(g, &inputs(system, &[]), &divisors)?,
            divisors: divisors.iter().map(|&e| g.plain(e)).collect(),
        })
    }

    pub(crate) fn family(&self) -> &Family {
        self.family
    }

    /// Orders that are looked at: `2h + 4`, and a few more.
    fn orders(&self) -> usize {
        (2 * self.family.shape.constants + 7).min(ORDERS)
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
        let almost_every_start = self.generic(start);
        let (this_start, completed) = match start.series() {
            Ok((exact, completed)) => (self.particular(&exact, &almost_every_start), completed),
            Err(fault) => (Finding::NotApplicable(fault.to_string()), Vec::new()),
        };
        Proof { this_start, almost_every_start, completed }
    }

    fn particular(&self, start: &SeriesStart<Modular>, generic: &Finding) -> Finding {
        let orders = self.orders();
        let (curve, series) = match self.series(start, orders) {
            Ok(series) => series,
            Err(fault) => return Finding::NotApplicable(fault.to_string()),
        };
        let ranks = Ranks::of(&series);
        if let Some(order) = ranks.refuted() {
            return Finding::None(NoConstants {
                order,
                certificate: self.certificate(start, &curve, &series, &ranks, order),
            });
        }
        // where the rank is the generic one it stays so nearby, and the jets obey one linear equation
        match generic {
            Finding::Contained { rank, order } if *rank == ranks.last() => {
                Finding::Contained { rank: *rank, order: *order }
            }
            _ => Finding::ThroughOrder { rank: ranks.last(), order: orders - 1 },
        }
    }

    fn generic(&self, start: &ExactStart) -> Finding {
        let orders = self.orders();
        let mut found: Vec<Sampled> = Vec::new();
        for seed in SEEDS {
            let series = match start.random(seed) {
                Ok(exact) => self.series(&exact, orders).map(|(curve, series)| (exact, curve, series)),
                Err(fault) => return Finding::NotApplicable(fault.to_string()),
            };
            match series {
                Ok((exact, curve, series)) => {
                    let ranks = Ranks::of(&series);
                    found.push((exact, curve, series, ranks));
                }
                Err(fault) => return Finding::NotApplicable(fault.to_string()),
            }
        }
        for (exact, curve, series, ranks) in &found {
            if let Some(order) = ranks.refuted() {
                return Finding::None(NoConstants {
                    order,
                    certificate: self.certificate(exact, curve, series, ranks, order),
                });
            }
        }
        let ranks = &found[0].3;
        match ranks.settled() {
            Some(order) if found.iter().all(|(.., other)| other.by_order == ranks.by_order) => {
                Finding::Contained { rank: ranks.last(), order }
            }
            _ => Finding::ThroughOrder { rank: ranks.last(), order: orders - 1 },
        }
    }

    /// The minor of full size, where there is one.
    fn certificate(
        &self,
        start: &SeriesStart<Modular>,
        curve: &CurveSeries<Modular>,
        series: &MismatchSeries<Modular>,
        ranks: &Ranks,
        order: usize,
    ) -> Option<Certificate> {
        let width = series.width;
        let rows: Vec<(usize, usize)> = ranks.rows.iter().copied().filter(|(k, _)| *k <= order).collect();
        if rows.len() < width {
            return None;
        }
        let row = |&(k, place): &(usize, usize)| series.orders[k][place * width..(place + 1) * width].to_vec();
        let minor: Vec<Vec<Modular>> = rows.iter().map(row).collect();
        let (_, determinant) = inverse(&minor.concat(), width, Modular::one())?;
        let numbers = start.positions.iter().chain(&start.velocities).zip(&self.names);
        let divisors = self.denominators.evaluator::<Jet<Modular>>().run(&curve.inputs).to_vec();
        let mut divided_by = vec![
            ("determinant of the equations of the curve at the start".to_owned(), curve.determinant.value()),
            ("determinant of the equations of the family at the start".to_owned(), series.determinant.value()),
        ];
        let values = divisors.iter().map(|x| x.coefficient(0).value());
        divided_by.extend(self.divisors.iter().cloned().zip(values));
        Some(Certificate {
            prime: PRIME,
            root_order: ORDER,
            circle: Modular::circle().value(),
            neper: Modular::neper().value(),
            imaginary: Modular::imaginary().value(),
            start: numbers
                .map(|(x, name)| StartNumber {
                    name: name.clone(),
                    exact: x.exact().map(|x| x.to_string()),
                    image: x.coefficient(0).value(),
                })
                .collect(),
            order,
            rows,
            minor: minor.iter().map(|row| row.iter().map(|x| x.value()).collect()).collect(),
            determinant: determinant.value(),
            divided_by,
        })
    }
}
