//! Certificates of answers, which `validation/proof/verify.py` checks.

use decision::exact::{Modular, in_any_field, inverse};
use decision::{ExactStart, Images, PlainScene, SeriesStart};
use mechanics::System;
use motion::CHETAEV;
use symbolic::Fraction;

use crate::certified::{Certified, Common, Exponents, Proof};
use crate::flag::Flag;
use crate::killing::Killing;
use crate::local::{Reversible, at_random};
use crate::{Density, Found, Integrals, Measure, Multiplier, NoAnswer, Open, words};

/// Of the random points.
const SEED: u64 = 0x17e6_0005;

/// A certificate by the name of what it is about, or why there is none.
pub type Certificate = (String, Result<Certified, Open>);

/// What certificates of a scene share.
struct Question<'a> {
    system: &'a System,
    start: ExactStart,
    set: &'a [(String, String)],
}

impl Integrals {
    /// Certificates of what is proved, bounded or written down about Chetaev's motion; `set` are the numbers
    /// that were set, as they were written.
    ///
    /// # Errors
    /// [`NoAnswer::Start`].
    pub fn certificates(&self, set: &[(String, String)]) -> Result<Vec<Certificate>, NoAnswer> {
        let mut all = Vec::new();
        if self.formulation != CHETAEV.name {
            return Ok(all);
        }
        let system = &self.scene.system;
        let start = ExactStart::new(system, &self.scene.start, &self.scene.completion, None)?;
        let question = Question { system, start, set };
        if let (Some(found), Ok(reversible)) = (&self.reversed, Reversible::new(system)) {
            match &found.measure {
                Measure::None { proved: true } => all.push(("measure".into(), question.no_measure(&reversible))),
                Measure::Local { density: Some(density), .. } => {
                    all.push((
                        "measure".into(),
                        question.of(|_| {
                            let (free, density) = question.density(density);
                            Ok(Proof::Measure { free, density })
                        }),
                    ));
                }
                _ => {}
            }
            for (i, reduction) in found.reductions.iter().flatten().enumerate() {
                let certificate = match &reduction.multiplier {
                    Multiplier::None => {
                        question.of(|_| Ok(Proof::NoMultiplier { free: question.velocities(&reduction.over) }))
                    }
                    Multiplier::Local(Some(factor)) => question.of(|_| {
                        let (free, density) = question.density(factor);
                        Ok(Proof::Multiplier { free, density })
                    }),
                    Multiplier::Local(None) => continue,
                };
                all.push((format!("multiplier-{}", i + 1), certificate));
            }
            for found in found.integrals.iter().flatten().filter(|found| found.none_proved() || found.settled) {
                all.push((words::degree(found.degree - 1).into(), question.bound(&reversible, found)));
            }
        }
        for (i, printed) in self.ansatz.iter().flat_map(|found| &found.printed).enumerate() {
            let proof = |_: &_| Ok(Proof::Integral { integral: printed.text.clone() });
            all.push((format!("integral-{}", i + 1), question.of(proof)));
        }
        Ok(all)
    }
}

impl Question<'_> {
    /// A certificate whose own fields are computed at a random point, of the first field where they can be.
    fn of(&self, compute: impl Fn(&SeriesStart<Modular>) -> Result<Proof, Open>) -> Result<Certified, Open> {
        // whoever verifies them draws points on all leaves
        if !self.system.on_positions.is_empty() {
            let why = "it is about the leaf of constraints on positions, and certificates are about all leaves";
            return Err(Open::Other(why.into()));
        }
        self.on_any_leaf(compute)
    }

    /// The same where the claim is about the leaf of the point as well.
    fn on_any_leaf(&self, compute: impl Fn(&SeriesStart<Modular>) -> Result<Proof, Open>) -> Result<Certified, Open> {
        let at = |point: &SeriesStart<Modular>| {
            let scene = PlainScene::at_random_point(&self.start, point).map_err(Open::Other)?;
            let images = Images::at(&self.start, point).map_err(Open::Other)?;
            Ok(Certified { common: Common::of(&scene, &images, self.set), proof: compute(point)? })
        };
        in_any_field(|| at_random(&self.start, SEED, at))
    }

    fn velocities(&self, places: &[usize]) -> Vec<String> {
        places.iter().map(|&i| format!("{}'", self.system.coordinates[i].name)).collect()
    }

    fn no_measure(&self, reversible: &Reversible) -> Result<Certified, Open> {
        self.on_any_leaf(|point| {
            let flag = Flag::new(reversible, point, SEED, &[])?;
            let size = self.system.dimension() + 1;
            if flag.with_rates.len() < size {
                return Err(Open::Other(
                    "the minor that shows it is smaller, as combinations of the constraints are integrable: certificates \
                     have minors of full size"
                        .into(),
                ));
            }
            let (places, rows): (Vec<usize>, Vec<Vec<Modular>>) = flag.with_rates.iter().cloned().unzip();
            let minor = if rows.len() == size { inverse(&rows.concat(), size, Modular::one()) } else { None };
            let (_, minor) = minor.ok_or(Open::Accident)?;
            let (brackets, places) = needed(flag.free.len(), &flag.brackets, &places);
            let free = self.velocities(&flag.free);
            Ok(Proof::NoMeasure { free, brackets, rows: places, minor: minor.value() })
        })
    }

    fn density(&self, density: &Density) -> (Vec<String>, Exponents) {
        let text = |x: &Fraction| x.to_string();
        let angle = |(i, [sine, cosine]): &(usize, [Fraction; 2])| {
            (self.system.coordinates[*i].name.clone(), [text(sine), text(cosine)])
        };
        let angles = density.of_angles.iter().map(angle).collect();
        let metric = text(&density.of_metric);
        (self.velocities(&density.free), Exponents { metric, angles })
    }

    fn bound(&self, reversible: &Reversible, found: &Found) -> Result<Certified, Open> {
        self.of(|point| {
            let flag = Flag::new(reversible, point, SEED, &[])?;
            let killing = Killing::new(reversible, &flag, point, found.order, SEED)?;
            let kernel = killing.kernel(found.degree, true)?;
            let ring = &killing.ring;
            let series = killing.chart.iter().zip(&point.positions).map(|(chart, q)| {
                let terms = ring
                    .monomials
                    .iter()
                    .zip(chart)
                    .enumerate()
                    .map(|(place, (exponents, &x))| (exponents, if place == 0 { q.coefficient(0) } else { x }));
                terms.filter(|(_, x)| !x.is_zero()).map(|(exponents, x)| (exponents.clone(), x.value())).collect()
            });
            let names = self.system.coordinates.iter().map(|c| c.name.clone());
            Ok(Proof::Bound {
                degree: found.degree,
                free: self.velocities(&flag.free),
                weights: ring.weights.clone(),
                order: kernel.order,
                chart: names.zip(series).collect(),
                bound: kernel.integrals.len(),
            })
        })
    }
}

/// The brackets that `rows` are made of, and their new places, `m` fields coming first.
fn needed(m: usize, brackets: &[[usize; 2]], rows: &[usize]) -> (Vec<[usize; 2]>, Vec<usize>) {
    let mut used = vec![false; m + brackets.len()];
    rows.iter().for_each(|&place| used[place] = true);
    for (k, bracket) in brackets.iter().enumerate().rev() {
        if used[m + k] {
            bracket.iter().for_each(|&place| used[place] = true);
        }
    }
    let mut count = m;
    let places: Vec<usize> = (0..used.len())
        .map(|place| match place < m {
            true => place,
            false => {
                count += usize::from(used[place]);
                count - 1
            }
        })
        .collect();
    let kept = brackets.iter().enumerate().filter(|(k, _)| used[m + k]);
    (kept.map(|(_, bracket)| bracket.map(|place| places[place])).collect(), rows.iter().map(|&i| places[i]).collect())
}
