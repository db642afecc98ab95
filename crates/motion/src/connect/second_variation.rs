//! What the second variation says of a motion of stationary action.

use mechanics::System;
use nalgebra::DMatrix;

use crate::connect::conjugate::ConjugateTime;
use crate::{Motion, SolveError};

/// Instants at which Legendre's condition is looked at.
const INSTANTS: usize = 48;
/// Eigenvalues within this part of the largest count as zero; directions within it of none are held.
const NONE: f64 = 1e-9;
/// A conjugate time this part of the whole before the end is at the end.
const AT_THE_END: f64 = 1e-7;

/// The answer. With `W = ∂²(L + μ·f)/∂v²` on the velocities that the constraints leave, `A w = 0`, along the
/// motion:
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SecondVariation {
    /// `W > 0` and no conjugate time up to the end: a local minimum of the action.
    Minimum,
    /// `W < 0` and no conjugate time up to the end: a local maximum.
    Maximum,
    /// A conjugate time before the end, where W is definite.
    Conjugate,
    /// W is indefinite at some time.
    Indefinite,
    /// W is definite, and the first conjugate time is at the end: the second variation vanishes along a
    /// neighbour.
    AtTheEnd,
    /// The curve is a motion for several `μ₀`: it has an abnormal lift, and conjugate times say nothing.
    Abnormal,
    /// The action is not stationary, W is singular, or conjugate times are not known.
    Unknown,
}

impl SecondVariation {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            SecondVariation::Minimum => "a local minimum of the action, by its conjugate times",
            SecondVariation::Maximum => "a local maximum of the action, by its conjugate times",
            SecondVariation::Conjugate => "no minimum of the action, and no maximum",
            SecondVariation::Indefinite => {
                "no minimum of the action, and no maximum: Legendre's condition does not hold"
            }
            SecondVariation::AtTheEnd => "conjugate first at its end: whether a minimum is not known",
            SecondVariation::Abnormal => {
                "an abnormal curve, one for several values of the constants: no statement on a minimum"
            }
            SecondVariation::Unknown => "no statement on a minimum",
        }
    }

    /// Whether the action has a local minimum; `None` where that is not known.
    pub fn is_minimum(self) -> Option<bool> {
        match self {
            SecondVariation::Minimum => Some(true),
            SecondVariation::Maximum | SecondVariation::Conjugate | SecondVariation::Indefinite => Some(false),
            _ => None,
        }
    }
}

/// That of a motion of stationary action up to its end, which others beside it do not reach if it
/// `is_isolated`.
pub(super) fn second_variation(
    system: &System,
    motion: &mut Motion,
    conjugate: Option<&[ConjugateTime]>,
    is_isolated: bool,
) -> Result<SecondVariation, SolveError> {
    let signs = signs(system, motion)?;
    let (Some(times), [below, above]) = (conjugate, signs) else { return Ok(SecondVariation::Unknown) };
    if below && above {
        return Ok(SecondVariation::Indefinite);
    }
    if !(below || above) {
        return Ok(SecondVariation::Unknown);
    }
    let (start, end) = (motion.start(), motion.end());
    let near =
        |time: &ConjugateTime| (AT_THE_END * (end - start)).max(if time.error.is_finite() { time.error } else { 0.0 });
    let before = times.iter().any(|time| end - time.t > near(time));
    Ok(match (before, times.is_empty() && is_isolated) {
        (true, _) => SecondVariation::Conjugate,
        (false, false) => SecondVariation::AtTheEnd,
        (false, true) if above => SecondVariation::Minimum,
        (false, true) => SecondVariation::Maximum,
    })
}

/// Whether W has a negative eigenvalue at some time, and a positive one; neither where it is singular at one.
fn signs(system: &System, motion: &mut Motion) -> Result<[bool; 2], SolveError> {
    let g = &system.graph;
    let (n, h) = (system.dimension(), system.constraints.len());
    let v = system.velocities();
    let inputs = [system.positions(), v.clone(), vec![system.time]].concat();
    let hessian = |e| g.jacobian(&g.gradient(e, &v), &v).entries().to_vec();
    let mut outputs = hessian(system.lagrangian);
    system.constraints.iter().for_each(|&f| outputs.extend(hessian(f)));
    outputs.extend(system.constraint_jacobian().entries());
    let mut program = system.evaluator::<f64>(&inputs, &outputs)?;
    let (start, end) = (motion.start(), motion.end());
    let mut found = [false; 2];
    for k in 0..=INSTANTS {
        let t = start + (end - start) * k as f64 / INSTANTS as f64;
        let at = motion.at(t)?;
        let values = program.evaluate(&[&at.coordinates[..], &at.velocities, &[t]].concat());
        let part = |i: usize| DMatrix::from_row_slice(n, n, &values[i * n * n..(i + 1) * n * n]);
        let mut w = part(0);
        for i in 0..h {
            w += part(1 + i) * at.multipliers.get(i).copied().unwrap_or(0.0);
        }
        let a = DMatrix::from_row_slice(h, n, &values[(1 + h) * n * n..]);
        // AᵀA has the kernel of A, and all its directions
        let held = (a.transpose() * &a).symmetric_eigen();
        let largest = held.eigenvalues.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let free: Vec<usize> =
            (0..n).filter(|&i| held.eigenvalues[i] <= NONE * largest.max(f64::MIN_POSITIVE)).collect();
        let basis = held.eigenvectors.select_columns(&free);
        let restricted = basis.transpose() * w * &basis;
        let values = restricted.symmetric_eigenvalues();
        let size = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if values.iter().any(|x| x.is_nan() || x.abs() <= NONE * size) {
            return Ok([false; 2]);
        }
        found = [found[0] || values.iter().any(|x| *x < 0.0), found[1] || values.iter().any(|x| *x > 0.0)];
    }
    Ok(found)
}
