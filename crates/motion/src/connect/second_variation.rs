//! What the second variation says of a motion of stationary action.

use mechanics::{SingularValues, System, fresh_symbol};
use nalgebra::DMatrix;
use symbolic::Symbol;
use symbolic::limits::{NOTHING, SAME};

use crate::band::limits::INSTANTS;
use crate::connect::conjugate::ConjugateTime;
use crate::{Metric, Motion, SolveError};

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
    let near = |time: &ConjugateTime| (SAME * (end - start)).max(if time.error.is_finite() { time.error } else { 0.0 });
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
    let weights: Vec<Symbol> =
        (1..=system.constraints.len()).map(|i| fresh_symbol(g, &format!("weight_{i}"))).collect();
    let lagrangian = g.add(system.lagrangian, g.dot(&g.variables(&weights), &system.constraints));
    let mut metric = Metric::varying(&System { lagrangian, ..system.clone() }, &weights)?;
    let jacobian = system.constraint_jacobian();
    let inputs = [system.positions(), system.velocities(), vec![system.time]].concat();
    let mut program = system.evaluator::<f64>(&inputs, jacobian.entries())?;
    let (start, end) = (motion.start(), motion.end());
    let mut found = [false; 2];
    for k in 0..=INSTANTS {
        let t = start + (end - start) * k as f64 / INSTANTS as f64;
        let at = motion.at(t)?;
        // constraints that follow from others have no multiplier
        let mut multipliers = at.multipliers.clone();
        multipliers.resize(weights.len(), 0.0);
        metric.set_parameters(&multipliers);
        let a = program.evaluate(&[&at.coordinates[..], &at.velocities, &[t]].concat());
        let held = SingularValues::of(&DMatrix::from_row_slice(jacobian.rows(), jacobian.columns(), a));
        let free = held.on_kernel(NOTHING * held.values.iter().fold(0.0, |m: f64, x| m.max(*x)));
        let w = metric.matrix(t, &at.coordinates, &at.velocities);
        if w.iter().any(|x| !x.is_finite()) {
            return Ok([false; 2]);
        }
        let values = (&free * w * &free).symmetric_eigenvalues();
        let limit = NOTHING * values.amax();
        // as many are zero as directions are held
        if values.iter().filter(|x| x.abs() > limit).count() != free.trace().round() as usize {
            return Ok([false; 2]);
        }
        found = [found[0] || values.min() < -limit, found[1] || values.max() > limit];
    }
    Ok(found)
}
