//! Judges: what is wrong with equations, from the values of `L`, `f` and `Q` alone.

use equations::Formulation;
use motion::{CHETAEV, FIRST_ORDER, PRESCRIBED, REDUCED_CHETAEV};
use nalgebra::DVector;
use symbolic::Symbol;

use super::reading::{Instant, Reading, Sample};
use super::truth::{Point, Truth, slope};

/// What was found, and how far it is from what it should be.
pub struct Findings {
    worst: Vec<(&'static str, f64)>,
}

/// Over this a finding is one.
const LIMIT: f64 = 1e-7;

impl Findings {
    pub fn new() -> Findings {
        Findings { worst: Vec::new() }
    }

    /// `found` against `wanted`, relative where they are large.
    pub fn same(&mut self, what: &'static str, found: &[f64], wanted: &[f64]) {
        let apart = if found.len() != wanted.len() { f64::INFINITY } else { distance(found, wanted) };
        self.worst.push((what, apart));
    }

    pub fn zero(&mut self, what: &'static str, found: &[f64], size: f64) {
        let largest = found.iter().fold(0.0_f64, |m, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) });
        self.worst.push((what, largest / (1.0 + size)));
    }

    pub fn must(&mut self, what: &'static str, holds: bool) {
        self.worst.push((what, if holds { 0.0 } else { f64::INFINITY }));
    }

    /// What is wrong, if anything is; else how near the limit it came.
    pub fn verdict(&self) -> Result<f64, String> {
        let worst = self.worst.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            Some((what, apart)) if apart.is_nan() || *apart > LIMIT => Err(format!("{what}: {apart:.1e}")),
            Some((_, apart)) => Ok(*apart),
            None => Ok(0.0),
        }
    }
}

/// Largest difference, relative where numbers are over 1.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| if a == b { 0.0 } else { (a - b).abs() / (1.0 + a.abs().max(b.abs())) });
    apart.fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
}

fn length(a: &[f64]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Which principle the equations are to follow.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Principle {
    Chetaev,
    /// `d/dt 𝓛_v − 𝓛_q = Q − κ Aᵀ μ`: for `κ = 0` vakonomic.
    Vakonomic {
        kappa: f64,
    },
    /// `d/dt L_v − L_q = Q + (Aᵀ − ε C) λ`.
    FirstOrder {
        epsilon: f64,
    },
    /// `d/dt L_v − L_q = Q + Wᵀ λ`.
    Prescribed,
}

impl Principle {
    /// That of a formulation or form.
    pub fn of(formulation: &Formulation) -> Principle {
        match formulation {
            own if [CHETAEV, REDUCED_CHETAEV].contains(&own) => Principle::Chetaev,
            own if own == FIRST_ORDER => Principle::FirstOrder { epsilon: KAPPA },
            own if own == PRESCRIBED => Principle::Prescribed,
            own if own == motion::KAPPA => Principle::Vakonomic { kappa: KAPPA },
            _ => Principle::Vakonomic { kappa: 0.0 },
        }
    }
}

/// The number of every parameter that a formulation needs.
pub const KAPPA: f64 = 0.7;

/// Equations with states that lead to every `(q, v)` on the constraint.
pub fn judge(truth: &Truth, principle: Principle, samples: &[Sample], reading: &Reading) -> Findings {
    let mut findings = Findings::new();
    let mut constant = vec![true; truth.n + 1];
    for (sample, instant) in samples.iter().zip(&reading.instants) {
        let at = common(&mut findings, sample, instant);
        let (mut at, a) = (at, &instant.along.velocities);
        let mut rate = vec![0.0; truth.h];
        if let Principle::Vakonomic { .. } = principle {
            findings.same("multipliers at the start", &instant.now.multipliers, &sample.point.mu);
            rate.clone_from(&instant.along.multipliers);
        } else {
            at.mu = vec![0.0; truth.h];
        }
        if rate.len() != truth.h {
            findings.must("a rate for each multiplier", false);
            return findings;
        }
        let curve = |s: f64| at.moved(a, &rate, s);
        let turned = slope(|s| truth.momenta(&curve(s)));
        let mut applied = truth.gradient(&at);
        applied.iter_mut().zip(truth.forces(&at)).for_each(|(x, force)| *x += force);
        let (mut reactions, forces) = (truth.reactions(&at), truth.forces(&at));
        match principle {
            Principle::FirstOrder { epsilon } => reactions -= truth.curvature(&at, a) * epsilon,
            Principle::Prescribed => reactions = truth.prescribed(&at),
            Principle::Chetaev | Principle::Vakonomic { .. } => {}
        }
        if let Principle::Vakonomic { kappa } = principle {
            let drag = &reactions * DVector::from_row_slice(&at.mu) * kappa;
            applied.iter_mut().zip(drag.iter()).for_each(|(x, drag)| *x -= drag);
        }
        let mut rest: Vec<f64> = turned.iter().zip(&applied).map(|(turned, applied)| turned - applied).collect();
        let size = length(&turned) + length(&applied);
        if !matches!(principle, Principle::Vakonomic { .. }) {
            rest = match &instant.now.multipliers[..] {
                [] if principle == Principle::Chetaev => truth.without_reactions(&at, &rest),
                given if given.len() == truth.h => {
                    let reaction = &reactions * DVector::from_row_slice(given);
                    rest.iter().zip(reaction.iter()).map(|(rest, reaction)| rest - reaction).collect()
                }
                _ => vec![f64::INFINITY],
            };
        }
        findings.zero("the principle", &rest, size);
        findings.zero("the constraint along the motion", &slope(|s| truth.constraints(&curve(s))), length(a));
        // what nothing can change in any of these states, and only that, is to be handed over
        let pulls = principle != Principle::Vakonomic { kappa: 0.0 };
        let small = |x: f64| x.abs() < LIMIT * (1.0 + size);
        for (i, constant) in constant[..truth.n].iter_mut().enumerate() {
            *constant &= small(applied[i]) && !(pulls && reactions.row(i).iter().any(|x| !small(*x)));
        }
        let power = reactions.transpose() * DVector::from_row_slice(&at.v);
        let driven = forces.iter().any(|x| !small(*x)) || pulls && power.iter().any(|x| !small(*x));
        constant[truth.n] &= small(truth.by_time(&at)) && !driven;
        let values = truth.momenta(&at).into_iter().chain([truth.energy(&at)]);
        for (i, (name, value)) in reading.invariants.iter().zip(&instant.now.invariants).enumerate() {
            let wanted = values.clone().zip(0..).find(|(_, place)| truth.conserved(*place) == *name);
            findings.must("an invariant has a name", wanted.is_some());
            findings.same("value of an invariant", &[*value], &[wanted.map_or(f64::NAN, |w| w.0)]);
            findings.zero("an invariant along the motion", &instant.along.invariants[i..=i], size);
        }
        projected(&mut findings, truth, &at, instant, reading);
    }
    findings.must("guards", reading.guarded.iter().all(|singular| *singular));
    for (place, constant) in constant.into_iter().enumerate() {
        let named = reading.invariants.contains(&truth.conserved(place));
        findings.must("invariants", named == constant);
    }
    findings
}

/// Projection moves velocities only, onto the constraint, by what reactions alone could have done.
fn projected(findings: &mut Findings, truth: &Truth, at: &Point, instant: &Instant, reading: &Reading) {
    let places = |symbols: &[Symbol]| -> Option<Vec<usize>> {
        symbols.iter().map(|s| reading.states.iter().position(|y| y == s)).collect()
    };
    let (Some(q), Some(v)) = (places(&truth.positions), places(&truth.velocities)) else { return };
    let pick = |y: &[f64], places: &[usize]| places.iter().map(|&i| y[i]).collect::<Vec<f64>>();
    let (before, after) = (pick(&instant.beside, &v), pick(&instant.projected, &v));
    let moved: Vec<f64> = after.iter().zip(&before).map(|(after, before)| after - before).collect();
    let at = Point { q: pick(&instant.beside, &q), v: after, ..at.clone() };
    findings.zero("the constraint after projection", &truth.constraints(&at), 0.0);
    let needed = truth.inertia(&at, &moved);
    let pull = truth.without_reactions(&at, &needed);
    if truth.linear {
        findings.zero("the direction of projection", &pull, 0.0);
    } else {
        // the reactions turn a little on the way
        findings.must("the direction of projection", length(&pull) <= 0.1 * length(&needed));
    }
    let mut others = instant.projected.clone();
    v.iter().for_each(|&i| others[i] = instant.beside[i]);
    findings.same("projection moves velocities only", &others, &instant.beside);
}

/// What holds for every formulation.
pub fn common(findings: &mut Findings, sample: &Sample, instant: &Instant) -> Point {
    let at = sample.point.clone();
    findings.same("coordinates at the start", &instant.now.coordinates, &at.q);
    findings.same("velocities at the start", &instant.now.velocities, &at.v);
    findings.same("velocities are rates", &instant.along.coordinates, &at.v);
    findings.zero("equations for the reader", &instant.statements, length(&instant.rates));
    at
}

/// Another form of equations: outputs stay the same.
pub fn same_motion(before: &Reading, after: &Reading) -> Findings {
    let mut findings = Findings::new();
    findings.same("rates where the form is least accurate", &after.near, &before.near);
    findings.must("a form that is trusted", after.fallbacks == 0);
    findings.must("multipliers are the same", before.multipliers == after.multipliers);
    let kept: Vec<Option<usize>> =
        after.invariants.iter().map(|name| before.invariants.iter().position(|other| other == name)).collect();
    findings.must("invariants are the same", kept.iter().all(Option::is_some));
    for (before, after) in before.instants.iter().zip(&after.instants) {
        for (before, after) in [(&before.now, &after.now), (&before.along, &after.along)] {
            findings.same("coordinates", &after.coordinates, &before.coordinates);
            findings.same("velocities", &after.velocities, &before.velocities);
            findings.same("multipliers", &after.multipliers, &before.multipliers);
            let same = kept.iter().flatten().map(|&i| before.invariants[i]).collect::<Vec<f64>>();
            findings.same("invariants", &after.invariants, &same);
        }
        findings.same("guards", &after.guards, &before.guards);
        findings.zero("equations for the reader", &after.statements, 0.0);
    }
    findings
}
