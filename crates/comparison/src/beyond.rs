//! What contacts cannot exert: the reaction of a motion along velocities that no contact sees.

use mechanics::elimination::{eliminate, largest, open};
use motion::band::{SAME_ESTIMATE, SOME};
use motion::{Motion, SolveError};
use scene::Scene;
use symbolic::limits::SAME;
use symbolic::{Evaluator, Expr};

/// A generalized force that a motion needs, and that no forces at the contacts of its bodies amount to.
#[derive(Clone, Debug, PartialEq)]
pub struct Beyond {
    /// The coordinate along which it acts, with others following such that no contact slips or lifts.
    pub coordinate: String,
    /// `R·w` with `ẇ = 1` of that coordinate.
    pub force: f64,
    /// When, in units of `t`.
    pub t: f64,
}

/// The generalized reaction of a motion is `R = d/dt ∂L/∂v − ∂L/∂q − Q`. Forces `F` at contacts, where `s` is
/// the slip, give `(∂s/∂v)ᵀ F`: `R` is of this form iff `R·w = 0` for all `w` with `∂s/∂v w = 0`. The largest
/// `R·w` for `w` with one free coordinate of rate 1, at instants of the motion; `None` if it vanishes
/// everywhere.
///
/// # Errors
/// [`SolveError`] where the motion cannot be read off, or `L` contains a symbol that is not defined.
pub fn beyond_contacts(scene: &Scene, motion: &mut Motion) -> Result<Option<Beyond>, SolveError> {
    let Some(meant) = &scene.meant else { return Ok(None) };
    let system = &scene.system;
    let g = &system.graph;
    let (n, q, v) = (system.dimension(), system.positions(), system.velocities());
    let slips = [&meant.slips[..], &system.constraints].concat();
    let columns = g.jacobian(&slips, &v);
    let [momenta, pulls] = [&v, &q].map(|symbols| g.gradient(system.lagrangian, symbols));
    let outputs: Vec<Expr> = [&momenta, &pulls, &system.forces[..], columns.entries()].concat();
    let inputs = [&[system.time], &q[..], &v].concat();
    let mut program = Evaluator::<f64>::new(g.compile(&inputs, &outputs, &system.parameter_values())?);
    let mut at = |motion: &mut Motion, t: f64| -> Result<Vec<f64>, SolveError> {
        let now = motion.at(t)?;
        Ok(program.evaluate(&[&[t], &now.coordinates[..], &now.velocities].concat()).to_vec())
    };
    let (start, end) = (motion.start(), motion.end());
    // differences of order 4 lose least where their error is round-off of them
    let step = f64::EPSILON.powf(0.2) * (end - start);
    let (mut largest, mut size): (Option<Beyond>, f64) = (None, 0.0);
    for k in 0..=SOME {
        let t = start + 2.0 * step + (end - start - 4.0 * step) * k as f64 / SOME as f64;
        let now = at(motion, t)?;
        // central differences of order 4
        let mut rate = vec![0.0; n];
        for (shift, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let there = at(motion, t + shift * step)?;
            rate.iter_mut().zip(&there).for_each(|(rate, p)| *rate += weight * p / (12.0 * step));
        }
        let reaction: Vec<f64> = (0..n).map(|i| rate[i] - now[n + i] - now[2 * n + i]).collect();
        let parts = [&rate[..], &now[n..3 * n]].concat();
        size = parts.iter().fold(size, |size, x| size.max(x.abs()));
        for (i, w) in unseen(now[3 * n..].chunks(n).map(<[f64]>::to_vec).collect(), n) {
            let force: f64 = reaction.iter().zip(&w).map(|(r, w)| r * w).sum();
            if force.is_finite() && largest.as_ref().is_none_or(|found| force.abs() > found.force.abs()) {
                largest = Some(Beyond { coordinate: system.coordinates[i].name.clone(), force, t });
            }
        }
    }
    Ok(largest.filter(|found| found.force.abs() > SAME * size))
}

/// The kernel of `slips`, a vector for each coordinate that it leaves free, of rate 1 there. Pivots are the
/// largest entries, of equals the first: so the coordinates that bodies are placed by are those that follow.
fn unseen(mut slips: Vec<Vec<f64>>, n: usize) -> Vec<(usize, Vec<f64>)> {
    let size = slips.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
    // entries are known as well as the motion
    let counts = |x: f64| x.abs() > SAME_ESTIMATE * size;
    let pivots = eliminate(&mut slips, |rows, done| {
        largest(rows, open(rows, done, n).rev().filter(|&(i, j)| counts(rows[i][j])))
    });
    let vector = |i: usize| {
        let mut w = vec![0.0; n];
        w[i] = 1.0;
        pivots.iter().zip(&slips).for_each(|(&pivot, row)| w[pivot] = -row[i]);
        (i, w)
    };
    (0..n).filter(|i| !pivots.contains(i)).map(vector).collect()
}
