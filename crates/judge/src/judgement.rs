//! The judgement on one table: laws side by side, numbers, constraint, integrals.

use review::Law;
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::balance::{Balance, Instant};
use crate::laws::{FirstOrder, Misfit, as_force, first_order, left_out, misfits, vakonomic};
use crate::regression::{Number, rms};
use crate::substituted::substituted;
use crate::{JudgeError, Samples};

/// Residual of a law on the motion.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Left {
    /// The law.
    pub law: Law,
    /// Residual of the balance of forces and of the rate of the constraint, rms, in `√E/T`.
    #[schemars(with = "Option<f64>")]
    pub residual: f64,
    /// Fitted numbers: `mu0_1 = …`, the removal.
    pub with: String,
}

/// A quantity that should not move, and how far it does.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Drift {
    /// Its name.
    pub name: String,
    /// At the first sample.
    pub start: f64,
    /// The farthest it is from that.
    pub largest: f64,
}

/// How far one constraint is off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Constraint")]
pub struct Residual {
    /// Largest `|f|`.
    pub largest: f64,
    /// The rms of it.
    pub rms: f64,
    /// The rms of its parts `Aᵢⱼ vⱼ`.
    pub parts: f64,
}

/// The judgement on one table.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Judgement {
    /// Mean distance of two samples.
    pub step: f64,
    /// Samples that were looked at.
    pub samples: usize,
    /// Forces and accelerations by which residuals are measured, rms, in `√E/T`.
    pub scale: f64,
    /// What differences make of the balance, rms: by how much two orders of them differ.
    pub noise: f64,
    /// Laws, in the order in which one is preferred to another.
    pub laws: Vec<Left>,
    /// The laws that leave no more than three times the least, or than three times the noise; none where
    /// the least is more than `tolerance` of the scale.
    pub fitting: Vec<Law>,
    /// What of the scene is another in the motion, where that leaves less by far than Chetaev's law with its
    /// numbers: all that leave as little, the least first. They are said instead of these.
    pub misfits: Vec<Misfit>,
    /// `ε`, in `T`; as slip and drag only where it is a number of the law: what is left is noise, or much
    /// more would be left without it, or it is zero within its error.
    #[serde(skip)]
    pub epsilon: Option<Number>,
    /// `1/N`, in `T [f]²/E`.
    #[serde(skip)]
    pub slip: Option<Number>,
    /// `γ` of `−γ M v`, in `1/T`.
    #[serde(skip)]
    pub drag: Option<Number>,
    /// The part of `ḟ − A a` that is left out: 1 where the constraint is not differentiated as it is.
    #[serde(skip)]
    pub left_out: Option<Number>,
    /// By constraint.
    pub constraints: Vec<Residual>,
    /// Energy where it should be kept, and what the scene says is constant.
    pub drifts: Vec<Drift>,
}

impl Judgement {
    /// What of it is not a finite number.
    fn not_finite(&self) -> Option<String> {
        let laws = self.laws.iter().map(|left| (left.law.name().into(), left.residual));
        let size = |r: &Residual| r.largest.hypot(r.rms).hypot(r.parts);
        let constraints = (1..).zip(&self.constraints).map(|(i, r)| (format!("f_{i}"), size(r)));
        let drifts = self.drifts.iter().map(|d| (d.name.clone(), d.start.abs() + d.largest));
        let step = ("the step".to_owned(), self.step);
        [step]
            .into_iter()
            .chain(laws)
            .chain(constraints)
            .chain(drifts)
            .find(|(_, x)| !x.is_finite())
            .map(|(what, _)| what)
    }

    /// The law: the first of those that fit.
    pub fn law(&self) -> Option<Law> {
        self.fitting.first().copied()
    }
}

/// Residuals up to this many times the least, or the noise, are not distinguished from it.
const NOISES: f64 = 3.0;

/// Which law does the program that computed these samples integrate?
///
/// # Errors
/// [`JudgeError`]: too few samples, a motion in which nothing happens, dependent constraints, a mass matrix
/// that is not positive definite.
pub fn judge(scene: &Scene, samples: &Samples, tolerance: f64) -> Result<Judgement, JudgeError> {
    let (found, n, h) = (samples.t.len(), scene.system.dimension(), scene.system.constraints.len());
    let limit = MEMORY / 2 / (8 * (6 * n + 2 * n * h + 4 * h + n * (n + scene.system.parameters.len())) + 800);
    if found > limit {
        return Err(JudgeError::TooMany { found, limit });
    }
    let reach = if samples.v.is_some() { 3 } else { 4 };
    let mut balance = Balance::new(&scene.system)?;
    let fine = balance.along(samples, reach, reach)?;
    let coarse = balance.along(samples, reach - 1, reach)?;
    let noise = rms(fine.iter().zip(&coarse).map(|(a, b)| (&a.balance - &b.balance).norm()));
    let scale = rms(fine.iter().map(|i| i.inertia.norm() + i.balance.norm()));
    if !(scale + noise).is_finite() {
        return Err(JudgeError::TooLarge { what: "the sum of squares of forces".into() });
    }
    if scale <= NOISES * noise {
        return Err(JudgeError::Rest { scale, noise });
    }
    let [numbers, others] = [first_order(&fine), first_order(&coarse)];
    let before = balance.before(samples, reach, reach)?;
    let laws = laws(scene, &before, &fine, &numbers)?;
    let least = laws.iter().map(|l| l.residual).fold(f64::INFINITY, f64::min);
    let limit = NOISES * least.max(noise);
    let fits = |l: &&Left| l.residual <= limit && least <= tolerance * scale;
    let fitting = laws.iter().filter(fits).map(|l| l.law).collect();
    let constraint = |c: usize| {
        let values = || fine.iter().map(move |i| i.constraint[c]);
        let largest = values().fold(0.0, |m: f64, f| m.max(f.abs()));
        Residual { largest, rms: rms(values()), parts: rms(fine.iter().map(|i| i.parts[c])) }
    };
    let coordinates: Vec<String> = scene.system.coordinates.iter().map(|c| c.name.clone()).collect();
    let mut misfits = misfits(&fine, &balance.parameters, &coordinates);
    let as_little = misfits.first().map_or(0.0, |least| NOISES * least.residual.max(noise));
    misfits.retain(|m| {
        numbers.balance > NOISES * noise && NOISES * m.residual < numbers.balance && m.residual <= as_little
    });
    let of_the_law = |number: Option<Number>, without: f64| {
        let is_noise = numbers.balance <= NOISES * noise;
        let is_number = |n: &Number| {
            is_noise || misfits.is_empty() && without >= NOISES * numbers.balance || n.value.abs() <= NOISES * n.error
        };
        number.filter(is_number)
    };
    let judgement = Judgement {
        step: samples.step(),
        samples: fine.len(),
        scale,
        noise,
        laws,
        fitting,
        epsilon: of_the_law(both(numbers.epsilon, others.epsilon), numbers.without[0]),
        slip: both(numbers.slip, others.slip),
        drag: of_the_law(both(numbers.drag, others.drag), numbers.without[1]),
        misfits,
        left_out: both(left_out(&fine), left_out(&coarse)),
        constraints: (0..h).map(constraint).collect(),
        drifts: drifts(scene, &fine)?,
    };
    match judgement.not_finite() {
        Some(what) => Err(JudgeError::TooLarge { what }),
        None => Ok(judgement),
    }
}

/// Bytes that all samples may take, each with finer and with coarser differences.
const MEMORY: usize = 600 << 20;

/// The estimate with the better differences; what worse ones change is part of its error.
fn both(fine: Option<Number>, coarse: Option<Number>) -> Option<Number> {
    let (fine, coarse) = (fine?, coarse?);
    Some(Number { value: fine.value, error: fine.error.hypot(fine.value - coarse.value) })
}

fn laws(
    scene: &Scene,
    before: &[Instant],
    instants: &[Instant],
    numbers: &FirstOrder,
) -> Result<Vec<Left>, JudgeError> {
    let kept = rms(instants.iter().map(|i| as_force(i, &(&i.driven + &i.rest)).norm()));
    let driven = rms(instants.iter().map(|i| as_force(i, &i.driven).norm()));
    let of = |law, a: f64, b: f64, with: String| Left { law, residual: a.hypot(b), with };
    let mut laws = vec![
        of(Law::Chetaev, numbers.balance, numbers.constraint, String::new()),
        of(Law::MissingRate, numbers.balance, driven, String::new()),
    ];
    if let Some((left, start)) = vakonomic(before, instants) {
        let start = start.iter().enumerate();
        let start = start.filter_map(|(i, n)| n.map(|n| format!("mu0_{} = {:.6e}", i + 1, n.value)));
        laws.push(of(Law::Vakonomic, left, kept, start.collect::<Vec<_>>().join(", ")));
    }
    if let Some((left, removal)) = substituted(scene, instants)? {
        laws.push(of(Law::Substitution, left, kept, format!("removal {removal}")));
    }
    Ok(laws)
}

fn drifts(scene: &Scene, instants: &[Instant]) -> Result<Vec<Drift>, JudgeError> {
    let system = &scene.system;
    let mut wanted: Vec<(String, symbolic::Expr)> =
        system.watched.iter().filter(|w| w.is_constant()).map(|w| (w.name.clone(), w.expression)).collect();
    let kept = system.is_autonomous() && !system.has_forces() && system.is_workless(&system.constraint_jacobian());
    if kept {
        wanted.insert(0, ("energy".into(), system.energy()));
    }
    let inputs = [&[system.time], &system.positions()[..], &system.velocities()].concat();
    let expressions: Vec<_> = wanted.iter().map(|(_, e)| *e).collect();
    let mut program = system.evaluator::<f64>(&inputs, &expressions)?;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for i in instants {
        rows.push(program.evaluate(&[&[i.t], &i.state[0][..], &i.state[1]].concat()).to_vec());
    }
    let drift = |(k, (name, _)): (usize, (String, symbolic::Expr))| {
        let largest = rows.iter().map(|row| (row[k] - rows[0][k]).abs()).fold(0.0, f64::max);
        Drift { name, start: rows[0][k], largest }
    };
    Ok(wanted.into_iter().enumerate().map(drift).collect())
}
