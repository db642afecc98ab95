//! Certificates: proofs that others can check.

use std::collections::{BTreeMap, BTreeSet};

use schemars::JsonSchema;
use serde::Serialize;
use symbolic::Evaluator;
use symbolic::limits::PRIMES;

use crate::exact::{Echelon, Exact, Jet, Modular, PARTS, in_any_field, inverse};
use crate::family::CostateRate;
use crate::flow::inputs;
use crate::order_by_order::order;
use crate::plain_scene::PlainScene;
use crate::proof::Question;
use crate::random_start::at_random;
use crate::series::SeriesStart;
use crate::start::ExactStart;

/// A proof that no `μ₀` makes a Chetaev motion vakonomic; `validation/proof/verify.py` checks it.
///
/// With `μ = μ₀ + μ₁ s + …` the powers `s⁰ … s^K` of `Aᵀ μ̇ + (Ȧᵀ − f_qᵀ) μ = −E` are linear equations
/// `S x = b` for `x = (μ₀, …, μ_{K+1})`. Some of their rows make `[S | −b]` a square matrix whose determinant
/// modulo `p` is not zero. Numbers are in `0..p`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Certificate {
    /// The system and the start.
    #[serde(skip)]
    pub scene: PlainScene,
    /// What numbers go to.
    #[serde(skip)]
    pub images: Images,
    /// Whether the start stands for almost every one; it is then not the scene file's.
    pub almost_every_start: bool,
    /// `K`.
    pub order: usize,
    /// Order and coordinate of each row of `[S | −b]`, from 0.
    pub rows: Vec<(usize, usize)>,
    /// Their determinant, not zero.
    pub minor: u64,
    /// What was divided by, with its image, not zero.
    pub divided_by: BTreeMap<String, u64>,
    /// Given velocities that are solved from the constraints, which their decimals miss by round-off.
    pub completed: Vec<String>,
    /// Taylor coefficients `0 … K + 2` by coordinate, along the motion.
    pub motion: BTreeMap<String, Vec<u64>>,
    /// Coefficients `0 … K` of the h reactions `λ`.
    pub reactions: Vec<Vec<u64>>,
}

/// What numbers go to in the field of a certificate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Images {
    /// `p`.
    pub prime: u64,
    /// `M` and the image of `e^{2πi/M}`.
    pub unity: (u64, u64),
    /// Of `e^{ia}` and `e^a` for a fraction `a`.
    pub exponents: ImagesOfExponents,
    /// Images of the roots of primes that are used.
    pub roots: BTreeMap<String, u64>,
}

/// Images of `e^i` and `e`, and a prime `r`, the power of both that is 1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[expect(missing_docs, reason = "said above")]
pub struct ImagesOfExponents {
    pub order: u64,
    #[serde(rename = "e^i")]
    pub circle: u64,
    pub e: u64,
}

impl Images {
    /// Those that formulas of the system take at `point`, in the field of the computation.
    ///
    /// # Errors
    /// A symbol that is none of the system's, in words.
    pub fn at(start: &ExactStart, point: &SeriesStart<Modular>) -> Result<Self, String> {
        let (system, n) = (&start.system, point.positions.len());
        let written = [&[system.lagrangian][..], &system.constraints, &system.forces, &start.written].concat();
        let under_roots: Vec<_> = system.graph.under_roots(&written).into_iter().collect();
        let program = system.graph.tape(&inputs(system, &[]), &under_roots);
        let program = program.map_err(|fault| fault.to_string())?;
        let rest = vec![Jet::constant(Modular::ZERO, None); n];
        let numbers = [&point.parameters[..], &[point.time], &point.positions, &point.velocities, &rest].concat();
        let mut evaluator = Evaluator::<Jet<Modular>>::new(program.clone());
        let (order, circle, e) = Modular::exponents();
        Ok(Images {
            prime: Modular::prime(),
            unity: (2 * PARTS as u64, Modular::root_of_unity(1).value()),
            exponents: ImagesOfExponents { order, circle, e },
            roots: roots(evaluator.evaluate(&numbers).iter().filter_map(Jet::exact)),
        })
    }
}

/// Of random starts.
const SEED: u64 = 0x5eed_0001;

/// The primes under roots of these fractions, with the images of their roots.
fn roots(radicands: impl Iterator<Item = Exact>) -> BTreeMap<String, u64> {
    let mut primes = BTreeSet::new();
    for x in radicands.filter(|x| x.is_rational()) {
        let (n, d, twos, fives) = x.fraction.parts();
        primes.extend([(2, twos), (5, fives)].into_iter().filter(|(_, exponent)| *exponent != 0).map(|(p, _)| p));
        let mut rest = n.saturating_mul(d).abs();
        for prime in 2..i128::from(PRIMES) {
            while rest > 1 && rest % prime == 0 {
                rest /= prime;
                primes.insert(prime);
            }
        }
        primes.extend((1 < rest && rest < i128::from(PRIMES * PRIMES)).then_some(rest));
    }
    primes.into_iter().filter_map(|p| Some((p.to_string(), Modular::root_of_prime(p)?.value()))).collect()
}

impl Question<'_> {
    /// The certificate that no vakonomic motion, for any `μ₀`, is Chetaev's from `start`; else the reason.
    ///
    /// # Errors
    /// The reason, in words.
    pub fn certificate(&self, start: &ExactStart) -> Result<Certificate, String> {
        in_any_field(|| {
            let (exact, completed) = start.series().map_err(|fault| fault.to_string())?;
            // decimals stand in the place of velocities that are not determined by the constraints
            let decimal = |i: &usize| exact.velocities[*i].exact().is_some();
            let open = start.open(&completed);
            let open = if open.iter().any(decimal) { &[] } else { open };
            self.certified(start, &exact, open, completed, false)
        })
    }

    /// The same from a start drawn at random, of fractions, or else from the scene's own: a minor that is not
    /// zero at one start is zero at almost none.
    ///
    /// # Errors
    /// The reason, in words.
    pub fn almost_every_certificate(&self, start: &ExactStart) -> Result<Certificate, String> {
        let drawn = in_any_field(|| {
            at_random(start, SEED, |exact| {
                let solved = |i: &usize| exact.velocities[*i].exact().is_none();
                let open: Vec<usize> = (0..exact.velocities.len()).filter(solved).collect();
                self.certified(start, &exact, &open, Vec::new(), true)
            })
        });
        let found = drawn.or_else(|reason| self.certificate(start).map_err(|_| reason))?;
        Ok(Certificate { almost_every_start: true, ..found })
    }

    fn certified(
        &self,
        start: &ExactStart,
        exact: &SeriesStart<Modular>,
        open: &[usize],
        completed: Vec<String>,
        at_random: bool,
    ) -> Result<Certificate, String> {
        let refuted = self.ranks(exact, |_| false)?.refuted(start).ok_or("Taylor coefficients leave some μ₀")?;
        let (curve, _) = self.series(exact, refuted.order + 3).map_err(|fault| fault.to_string())?;
        let shape = &self.family().shape;
        let (n, h, last) = (shape.coordinates, shape.constraints, refuted.order);
        if ![0, h].contains(&open.len()) {
            return Err("the start that was drawn has numbers that are not fractions".into());
        }
        if shape.rates.iter().any(|rate| matches!(rate, CostateRate::Explicit(_))) || curve.unknowns[0].len() != n + h {
            return Err("certificates are written for Chetaev's motion as a vakonomic one only".into());
        }
        if refuted.full_rank && refuted.size <= shape.constants {
            return Err(format!(
                "it is proved by a minor of size {} for {} multipliers, as combinations of the constraints are integrable: \
                 certificates have minors of full size",
                refuted.size, shape.constants
            ));
        }
        if !refuted.full_rank {
            return Err(
                "coefficients of less than full rank have no minor to show: there are only ranks modulo p".into()
            );
        }
        let system = &start.system;
        let g = &system.graph;
        let velocity = |i: &usize| system.coordinates[*i].velocity;
        let slopes = g.jacobian(&system.constraints, &open.iter().map(velocity).collect::<Vec<_>>());
        if slopes.entries().iter().any(|&e| open.iter().any(|i| g.depends_on(e, velocity(i)))) {
            return Err("the constraints are not linear in the velocities that they supply".into());
        }
        let values = self.family().evaluator::<Jet<Modular>>().evaluate(&curve.inputs).to_vec();
        let instant = shape.instant(&values);
        let width = h * (last + 2) + 1;
        let (mut echelon, mut rows, mut minor) = (Echelon::default(), Vec::new(), Vec::new());
        for (k, i) in (0..=last).flat_map(|k| (0..n).map(move |i| (k, i))) {
            let mut row = vec![Modular::ZERO; width];
            for (l, (j, rate)) in (0..=k).flat_map(|l| shape.rates.iter().enumerate().map(move |rate| (l, rate))) {
                let CostateRate::Unknown(place) = *rate else { continue };
                let (now, next) = (h * (k - l) + j, h * (k - l + 1) + j);
                let times = Modular::new((k - l) as u64 + 1);
                row[next] = row[next] + times * instant.matrix[i * shape.unknowns + place].coefficient(l);
                row[now] = row[now] + instant.by_costate[i * h + j].coefficient(l);
            }
            row[width - 1] = instant.rest[i].coefficient(k);
            if echelon.add(row.clone()) {
                rows.push((k, i));
                minor.extend(row);
            }
        }
        let one = Modular::one();
        let (_, minor) = inverse(&minor, width, one).ok_or("there is no minor of full size")?;
        let jacobian = order(instant.jacobian, 0);
        let matrix: Vec<Modular> =
            (0..h).flat_map(|i| open.iter().map(move |j| i * n + j)).map(|at| jacobian[at]).collect();
        let (_, supplied) = inverse(&matrix, open.len(), one).ok_or("the start is not unique")?;
        let mut divided_by = BTreeMap::from([
            ("equations of motion".to_owned(), curve.determinant.value()),
            ("constraints at the start".to_owned(), supplied.value()),
        ]);
        let divisors = order(Evaluator::<Jet<Modular>>::new(self.denominators.clone()).evaluate(&curve.inputs), 0);
        divided_by.extend(self.divisors.iter().cloned().zip(divisors.iter().map(|x| x.value())));
        let coordinates = curve.inputs.len() - 3 * n;
        let jet = |i: usize| (0..last + 3).map(|k| curve.inputs[coordinates + i].coefficient(k).value()).collect();
        let scene = PlainScene::new(start, exact, open, at_random)?;
        Ok(Certificate {
            scene,
            images: Images::at(start, exact)?,
            almost_every_start: false,
            order: last,
            rows,
            minor: minor.value(),
            divided_by,
            completed,
            motion: self.names.iter().enumerate().map(|(i, name)| (name.clone(), jet(i))).collect(),
            reactions: curve.unknowns[..=last].iter().map(|z| z[n..].iter().map(|x| x.value()).collect()).collect(),
        })
    }
}
