//! Measures and integrals of autonomous systems with homogeneous constraints and a potential.

use decision::exact::{FIELDS, agreed};
use decision::{DecisionError, ExactStart};
use mechanics::System;
use scene::Scene;

use crate::Open;
use crate::density::{Density, density};
use crate::flag::Flag;
use crate::killing::{Kernel, Killing, rank};
use crate::local::{Reversible, at_random};
use crate::multiplier::{Reduction, reductions};

/// Seeds of the random points, one per field.
const SEEDS: [u64; FIELDS.len()] = [0x17e6_0001, 0x17e6_0002, 0x17e6_0003, 0x17e6_0004];
/// Numbers of weights beyond the heaviest bracket that are tried, a few first.
const ORDERS: [usize; 2] = [6, 9];

/// Whether a measure `e^{σ(q)} dq dp`, smooth and positive, is invariant near almost every point.
#[derive(Clone, Debug, PartialEq)]
pub enum Measure {
    /// None is.
    None {
        /// Whether a minor of full size is not zero: a proof. Else it rests on ranks modulo two primes.
        proved: bool,
    },
    /// One is: by ranks at random points of two fields.
    Local {
        /// It, where it can be written down.
        density: Option<Density>,
        /// Where every density depends on a coordinate that the system does not contain.
        cyclic: Option<Cyclic>,
    },
    /// It is not known, for this reason.
    Open(Open),
}

/// Coordinates on which every density depends, though the equations of motion do not contain them: the
/// equations without these have no measure. Where these are angles none is single-valued: its average over
/// them would be free of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Cyclic {
    /// Their places.
    pub places: Vec<usize>,
    /// Whether a minor of full size is not zero: a proof. Else it rests on ranks modulo two primes.
    pub proved: bool,
}

/// How many independent integrals there are that are polynomials of one degree in the velocities, and of
/// lower degrees of the same parity beside it, near almost every point.
#[derive(Clone, Debug, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Found {
    /// Of the polynomials.
    #[serde(skip)]
    pub degree: usize,
    /// Their number, over the real numbers: an upper bound always, and the number itself if `settled`.
    #[serde(rename = "at_most")]
    pub count: usize,
    /// How many of them the energy, constants and products of those of lower degrees make.
    pub trivial: usize,
    /// Whether the number stays over as many orders as brackets have.
    #[serde(skip)]
    pub settled: bool,
    /// The weight to which Taylor series were looked at.
    pub order: usize,
}

impl Found {
    /// Those that the others do not give.
    pub fn further(&self) -> usize {
        self.count - self.trivial
    }

    /// Whether it is proved that there are no further ones.
    pub fn none_proved(&self) -> bool {
        self.count == self.trivial
    }
}

/// The answers of the method without an ansatz.
#[derive(Clone, Debug, PartialEq)]
pub struct Reversed {
    /// Invariant measures.
    pub measure: Measure,
    /// Chaplygin's reduced motions, with their multipliers.
    pub reductions: Result<Vec<Reduction>, Open>,
    /// Integrals, degree by degree from 1 on.
    pub integrals: Vec<Result<Found, Open>>,
}

/// Whether Chetaev's motion has an invariant measure.
///
/// # Errors
/// [`Open`].
fn decide_measure(system: &Reversible, start: &ExactStart) -> Result<Measure, Open> {
    // where no density is free of the coordinates `held`: whether that is proved
    let none = |held: &[usize]| -> Result<Option<bool>, Open> {
        let ranks = |seed| {
            at_random(start, seed, |point| {
                let flag = Flag::new(system, point, seed, held)?;
                Ok((flag.fields.len(), flag.with_rates.len()))
            })
        };
        // brackets stay on the leaves of integrable combinations; held coordinates do not
        let most = || system.coordinates - if held.is_empty() { start.integrable_combinations() } else { 0 };
        let proved =
            |&(rank, with_rates): &(usize, usize)| with_rates > rank && (rank == system.coordinates || rank == most());
        let found = agreed(SEEDS, ranks, proved).map_err(Open::or_accident)?;
        Ok((found.1 > found.0).then(|| proved(&found)))
    };
    if let Some(proved) = none(&[])? {
        return Ok(Measure::None { proved });
    }
    let places = system.cyclic();
    let density = density(&system.clone().solved_for(&places), start)?;
    // one that is written down is free of them
    let bound = if density.is_some() || places.is_empty() { None } else { none(&places)? };
    Ok(Measure::Local { density, cyclic: bound.map(|proved| Cyclic { places, proved }) })
}

/// Integrals of `degree` at one point of one field.
fn count(killing: &Killing, degree: usize) -> Result<Found, Open> {
    let lower: Vec<Kernel> = (0..degree).map(|d| killing.kernel(d, false)).collect::<Result<_, _>>()?;
    let found = killing.kernel(degree, true)?;
    let trivial = killing.trivial(degree, &lower);
    let known = rank(&killing.ring, &trivial, found.order);
    let together = [&found.integrals[..], &trivial].concat();
    if rank(&killing.ring, &together, found.order) > found.integrals.len() {
        return Err(Open::Contradiction("a product of integrals, or the energy, is none by its series".into()));
    }
    Ok(Found { degree, count: found.integrals.len(), trivial: known, settled: found.settled, order: found.order })
}

fn decide_integrals(system: &Reversible, start: &ExactStart, degree: usize) -> Result<Found, Open> {
    let mut last = Err(Open::Accident);
    for extra in ORDERS {
        let found = agreed(
            SEEDS,
            |seed| {
                at_random(start, seed, |point| {
                    let flag = Flag::new(system, point, seed, &[])?;
                    let step = flag.fields.iter().map(|y| y.weight).max().unwrap_or(1);
                    count(&Killing::new(system, &flag, point, step + extra, seed)?, degree)
                })
            },
            Found::none_proved,
        )
        .map_err(Open::or_accident);
        match found {
            Ok(found) if found.settled || found.none_proved() => return Ok(found),
            Ok(found) => last = Ok(found),
            Err(open) if last.is_err() => return Err(open),
            Err(_) => break,
        }
    }
    last
}

/// [`reversible`] of a scene and its start.
///
/// # Errors
/// A start that cannot be read.
pub fn reversible_scene(scene: &Scene, degree: usize) -> Result<Reversed, DecisionError> {
    let start = ExactStart::new(&scene.system, &scene.start, &scene.completion, None)?;
    Ok(reversible(&scene.system, &start, degree))
}

/// Decides measure and integrals up to a degree.
pub fn reversible(system: &System, start: &ExactStart, degree: usize) -> Reversed {
    let reversible = match Open::unless(|| Reversible::new(system)) {
        Ok(reversible) => reversible,
        Err(open) => {
            let (measure, reductions) = (Measure::Open(open.clone()), Err(open.clone()));
            return Reversed { integrals: vec![Err(open); degree], measure, reductions };
        }
    };
    let measure = Open::unless(|| decide_measure(&reversible, start)).unwrap_or_else(Measure::Open);
    let is_given = matches!(&measure, Measure::Local { density: Some(_), .. });
    Reversed {
        reductions: Open::unless(|| reductions(&reversible, start, is_given)),
        measure,
        integrals: (1..=degree).map(|d| Open::unless(|| decide_integrals(&reversible, start, d))).collect(),
    }
}
