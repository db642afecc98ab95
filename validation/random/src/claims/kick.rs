//! T18: the multiplier of the start acts on the law of first order as a kick.

use mechanics::{Parameter, State, System};
use motion::{CERTAINTY, FIRST_ORDER, KAPPA, TRUSTED};
use nalgebra::{DMatrix, DVector};

use super::CheckError;
use super::invariance::values;
use super::realization::{STRENGTH, own_error};
use crate::derived::equations;
use crate::realization::{constraint_jacobian, distance, numbers, with_kappa};
use crate::{Case, Kind};

/// How many pairs of `κ` and `10 κ` are tried until the distance falls as it should.
const PAIRS: i32 = 2;
/// What lies between `O(1/κ)`, a tenth, and `O(1/κ²)`, a hundredth.
const RATE: f64 = 30.0;

const CLAIM: &str = "the law of first order from v0 + Pi C mu0/kappa is O(1/kappa^2) off the family";
const WITHOUT: &str = "not integrable, and Pi C mu0 is not zero: from v0 it is O(1/kappa) off";

/// The family between from a fixed `μ₀`, and the law of first order from `v₀ + ΠCμ₀/κ`, are `O(1/κ²)` apart
/// (theorem 10).
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let system = case.scene.system.clone();
    let is_affine = system.constraints_linear_in_velocity() && !system.constraints.is_empty();
    if !is_affine || case.recipe.kind == Kind::NearRankLoss || case.recipe.kind.is_integrable() {
        return Ok(());
    }
    let kick = kick(&system, case)?;
    let mut before = apart(case, &system, &kick, STRENGTH)?;
    for power in 1..=PAIRS {
        let after = apart(case, &system, &kick, STRENGTH * 10_f64.powi(power))?;
        let ([with, without, _], [next, next_without, own]) = (before, after);
        let note = format!("distances {with:.1e}, {next:.1e}; without the kick {without:.1e}, {next_without:.1e}");
        if !(with + next).is_finite() || with <= CERTAINTY * RATE * own {
            case.found.undecided(18, CLAIM, format!("{note}, own error {own:.1e}"));
            return Ok(());
        }
        if with >= RATE * next || power == PAIRS {
            case.found.require(18, CLAIM, with >= RATE * (next - CERTAINTY * own), note);
            if kick.iter().any(|x| x.abs() > TRUSTED) {
                case.found.count(18, WITHOUT, without < RATE * next_without);
            }
            return Ok(());
        }
        before = after;
    }
    Ok(())
}

/// `ΠCμ₀` at the start, for `f` affine in `v`.
fn kick(system: &System, case: &Case) -> Result<Vec<f64>, CheckError> {
    let (g, start) = (&system.graph, &case.scene.start);
    let multipliers: Vec<_> = case.scene.multipliers.iter().map(|&mu| g.number(mu)).collect();
    let work = g.dot(&multipliers, &system.constraints);
    let rates = g.total_derivatives(&g.gradient(work, &system.velocities()), &system.flow());
    let slopes = g.gradient(work, &system.positions());
    let turned: Vec<_> = slopes.into_iter().zip(rates).map(|(slope, rate)| g.sub(slope, rate)).collect();
    let values = values(system, case);
    let (n, h) = (system.dimension(), system.constraints.len());
    let mass = DMatrix::from_row_slice(n, n, &numbers(g, system.velocity_hessian().entries(), &values)?);
    let a = constraint_jacobian(system, start)?;
    let mut saddle = DMatrix::zeros(n + h, n + h);
    saddle.view_mut((0, 0), (n, n)).copy_from(&mass);
    saddle.view_mut((n, 0), (h, n)).copy_from(&a);
    saddle.view_mut((0, n), (n, h)).copy_from(&a.transpose());
    let mut right = numbers(g, &turned, &values)?;
    right.resize(n + h, 0.0);
    let solved = saddle.lu().solve(&DVector::from_vec(right));
    Ok(solved.map_or(vec![f64::NAN; n], |x| x.rows(0, n).iter().copied().collect()))
}

/// Distances of the law from the family at `kappa`: with the kick, without it, and the motions' own error.
fn apart(case: &mut Case, system: &System, kick: &[f64], kappa: f64) -> Result<[f64; 3], CheckError> {
    let mut family = match case.between.clone() {
        Some(motion) => motion,
        None => case.run(equations(&with_kappa(system, kappa), KAPPA, None)?, &case.scene.multipliers)?,
    };
    let mut law = system.clone();
    law.parameters.push(Parameter { symbol: law.graph.symbol("epsilon"), value: 1.0 / kappa, formula: None });
    let equations = equations(&law, FIRST_ORDER, None)?;
    let mut metric = case.metric.clone();
    let mut own = own_error(&mut family, &mut metric)?;
    let mut distances = [0.0; 2];
    for (found, size) in distances.iter_mut().zip([1.0 / kappa, 0.0]) {
        let v = case.scene.start.v.iter().zip(kick).map(|(v, kick)| v + size * kick).collect();
        let start = State { v, ..case.scene.start.clone() };
        let mut motion = case.solve(&law, &start, case.end(), equations.clone(), &[])?;
        *found = distance(&mut family, &mut motion, &mut metric)?;
        own = own.max(own_error(&mut motion, &mut metric)?);
    }
    Ok([distances[0], distances[1], own])
}
