//! T1, T2, T3, T11, T14: where formulations give the same motion.

use comparison::{costates_of, growth, integrability, integrals_by_ranks, multipliers_of};
use mechanics::{ConstantsRule, Integrability, Removal, SingularValues, complete_removal_start};
use motion::{Choice, REMOVED_CONSTRAINT, Setting, SolveError, VAKONOMIC, derive};
use nalgebra::{DMatrix, DVector};
use scene::Scene;
use symbolic::Symbol;
use symbolic::limits::NOTHING;

use super::CheckError;
use super::growth::is_certain;
use crate::case::Which;
use crate::derived::{equations, free_constants};
use crate::realization::{augmented_start, momenta, numbers};
use crate::{Case, Findings, Kind, Recipe, Truth};

/// T1, by construction: for every `μ₀`, and by coordinate removal for every `P(t₀)`.
pub(super) fn integrable(case: &mut Case) -> Result<(), CheckError> {
    let by_coordinates: Vec<usize> = (0..case.removed.len()).filter(|&i| is_chart(&case.removed[i].removal)).collect();
    if case.recipe.kind.is_integrable() {
        let mut vakonomic = case.vakonomic.clone();
        case.same(1, "vakonomic agrees with Chetaev", Which::Chetaev, &mut vakonomic);
        for i in by_coordinates {
            let mut removed = case.removed[i].motion.clone();
            case.same(1, "coordinate removal agrees with Chetaev", Which::Chetaev, &mut removed);
        }
        return Ok(());
    }
    divergence(case, Which::Chetaev, Which::Vakonomic, &DIVERGES[0])?;
    if let Some(&i) = by_coordinates.first() {
        divergence(case, Which::Chetaev, Which::Removed(i), &DIVERGES[1])?;
        divergence(case, Which::Vakonomic, Which::Removed(i), &DIVERGES[2])?;
    }
    if case.control.is_some() {
        divergence(case, Which::Chetaev, Which::Control, &DIVERGES[3])?;
    }
    Ok(())
}

/// Names of what is counted of a pair: whether it differs, when the gap passes 1e-3, how it grows at first.
pub struct Divergence {
    /// Counted: whether the two differ.
    pub differs: &'static str,
    /// Observed: when the gap passes 1e-3.
    pub passes: &'static str,
    /// Observed: the exponent of the gap near the start.
    pub grows: &'static str,
}

/// The pairs that are measured on systems that are not integrable.
pub const DIVERGES: [Divergence; 4] = [
    Divergence {
        differs: "vakonomic differs from Chetaev",
        passes: "tau(1e-3), vakonomic and Chetaev",
        grows: "growth exponent, vakonomic and Chetaev",
    },
    Divergence {
        differs: "coordinate removal differs from Chetaev",
        passes: "tau(1e-3), coordinate removal and Chetaev",
        grows: "growth exponent, coordinate removal and Chetaev",
    },
    Divergence {
        differs: "coordinate removal differs from vakonomic",
        passes: "tau(1e-3), coordinate removal and vakonomic",
        grows: "growth exponent, coordinate removal and vakonomic",
    },
    Divergence {
        differs: "substitution differs from Chetaev",
        passes: "tau(1e-3), substitution and Chetaev",
        grows: "growth exponent, substitution and Chetaev",
    },
];

fn divergence(case: &mut Case, first: Which, second: Which, names: &Divergence) -> Result<(), CheckError> {
    let gap = case.gap(first, second)?;
    let differs = gap.certain_from.is_some();
    case.found.count(1, names.differs, differs);
    if let [_, Some(passes), _] = gap.passes {
        case.found.observe(1, names.passes, passes - case.scene.start.t);
    }
    if differs {
        let limit = |t: f64| gap.limit_at(t);
        let (mut metric, mut other) = (case.metric.clone(), case.motion(second).clone());
        if let Some(growth) = growth(&mut other, case.motion(first), &mut metric, &limit)?
            && is_certain(&growth)
        {
            case.found.observe(1, names.grows, growth.exponent);
        }
    }
    Ok(())
}

/// Every parameter is a coordinate.
fn is_chart(removal: &Removal) -> bool {
    removal.parameters.iter().all(|u| u.coordinate.is_some())
}

/// T2, for every removal: the augmented system with `μ = −P − ∂L/∂ẇ`.
pub(super) fn bridge(case: &mut Case) -> Result<(), CheckError> {
    for i in 0..case.removed.len() {
        let removal = case.removed[i].removal.clone();
        let n = case.scene.system.dimension();
        let setting = Setting { system: &case.scene.system, start: &case.scene.start, end: case.end() };
        let (system, start, multipliers) = augmented_start(setting, &removal, &case.removed[i].costates)?;
        let mut equations = equations(&system, VAKONOMIC, None)?;
        equations.coordinates.truncate(n);
        equations.velocities.truncate(n);
        let mut motion = case.solve(&system, &start, case.end(), equations, &multipliers)?;
        case.same(2, "removed constraint is vakonomic motion of the augmented system", Which::Removed(i), &mut motion);
    }
    Ok(())
}

/// T3: `A_wᵀ μ₀ = −P₀ − L_ẇ`: bijection of removed (by coordinates, all costates) and vakonomic family.
pub(super) fn bijection(case: &mut Case) -> Result<(), CheckError> {
    let (system, given) = (case.scene.system.clone(), case.scene.multipliers.clone());
    for i in (0..case.removed.len()).filter(|_| !given.is_empty()).collect::<Vec<_>>() {
        let (removal, costates) = (case.removed[i].removal.clone(), case.removed[i].costates.clone());
        let Some(mu) = multipliers_of(&case.scene, &removal, &costates)? else { continue };
        let mut motion = case.run(equations(&system, VAKONOMIC, None)?, &mu)?;
        case.same(3, "coordinate removal is the vakonomic motion with mu = -P - L_w'", Which::Removed(i), &mut motion);
        let Some(costates) = costates_of(&case.scene, &removal, &given)? else { continue };
        let choice = Choice {
            label: removal.name.clone(),
            formulation: REMOVED_CONSTRAINT,
            removal: Some(removal),
            constants: ConstantsRule::Given(costates.clone()),
        };
        let equations = derive(&system, &choice)?;
        let constants = free_constants(&equations, &costates);
        let mut motion = case.run(equations, &constants)?;
        case.same(3, "vakonomic is the coordinate removal with P = -mu - L_w'", Which::Vakonomic, &mut motion);
    }
    Ok(())
}

/// T11.
pub(super) fn frobenius(case: &mut Case) -> Result<(), CheckError> {
    integrals_put_in(&case.recipe, &case.scene, &mut case.found)
}

/// T11 of a recipe and its scene: it needs no motion.
///
/// # Errors
/// Where integrals cannot be counted by ranks.
pub fn integrals_put_in(recipe: &Recipe, scene: &Scene, findings: &mut Findings) -> Result<(), CheckError> {
    let (system, start) = (&scene.system, &scene.start);
    let found = integrability(scene)?;
    let right = match (recipe.truth(), &found) {
        (Truth::Unconstrained, Integrability::Unconstrained)
        | (Truth::Integrable, Integrability::Integrable { .. })
        | (Truth::Nonintegrable, Integrability::Nonintegrable { .. })
        | (Truth::NotLinear, Integrability::NonlinearInVelocity) => true,
        (Truth::PartlyIntegrable { integrals: put }, Integrability::PartlyIntegrable { integrals, .. }) => {
            put == *integrals
        }
        _ => false,
    };
    let by_ranks = match recipe.truth() {
        Truth::Unconstrained | Truth::NotLinear => None,
        _ => integrals_by_ranks(system, start)?,
    };
    let claim = "Frobenius' test finds what the construction put in";
    match &found {
        // its words begin with that one
        Integrability::Undecided { .. } => findings.undecided(11, claim, found.to_string().replace("undecided: ", "")),
        _ => findings.require(11, claim, right, &found),
    }
    if let Some((integrals, _)) = by_ranks {
        let note = format!("{integrals} by ranks");
        let right = integrals == recipe.integrals();
        findings.require(11, "ranks over a finite field count the integrals", right, note);
    }
    if let Integrability::Integrable { exact } = found {
        findings.count(11, "integrable, and the brackets vanish identically", exact);
    }
    Ok(())
}

/// T14: with `Φ_u̇ᵀ (L_v + P) = 0` at the start (`p_u = 0`), removal by recipe parameters is Newton's motion.
pub(super) fn sanity(case: &mut Case) -> Result<(), CheckError> {
    if !case.recipe.kind.is_integrable() {
        return Ok(());
    }
    let system = case.scene.system.clone();
    let g = &system.graph;
    let Some(place) = case.removed.iter().position(|r| r.removal.parameters.iter().all(|u| u.coordinate.is_none()))
    else {
        return Ok(());
    };
    let removal = case.removed[place].removal.clone();
    let equations = equations(&system, REMOVED_CONSTRAINT, Some(&removal))?;
    let rates: Vec<Symbol> = removal.parameters.iter().map(|u| u.rate).collect();
    let phi = g.jacobian(&removal.velocities(&system), &rates);
    let mut values = system.values_at(&case.scene.start);
    values.extend(complete_removal_start(&system, &removal, &case.scene.start).map_err(SolveError::from)?.values());
    let phi = DMatrix::from_row_slice(phi.rows(), phi.columns(), &numbers(g, phi.entries(), &values)?).transpose();
    let momenta = DVector::from_vec(momenta(&system, &case.scene.start)?);
    // only memory variables with a costate of their own have a free P
    let free: Vec<usize> = equations.free_constants.iter().filter_map(|c| c.memory).collect();
    let columns: Vec<usize> = free.iter().filter_map(|&k| removal.memory[k].coordinate).collect();
    let solution = solution(&phi.select_columns(&columns), &-(&phi * &momenta), momenta.norm().max(1.0));
    case.found.count(14, "p_u = 0 is within the free constants", solution.is_some());
    let Some(solution) = solution else { return Ok(()) };
    let mut costates = vec![0.0; removal.memory.len()];
    for (&k, &p) in free.iter().zip(solution.iter()) {
        costates[k] = p;
    }
    let constants = free_constants(&equations, &costates);
    let mut motion = case.run(equations, &constants)?;
    case.same(14, "removal with p_u = 0 is Newton's motion", Which::Chetaev, &mut motion);
    let differs = case.gap(Which::Chetaev, Which::Removed(place))?.certain_from.is_some();
    let what = if case.recipe.kind == Kind::Free {
        "no constraint, other constants, and removal is not Newton's motion"
    } else {
        "integrable, other constants, and removal is not Newton's motion"
    };
    case.found.count(14, what, differs);
    Ok(())
}

/// The shortest solution of `matrix x = right`, whose terms have this size; `None` where there is none.
pub fn solution(matrix: &DMatrix<f64>, right: &DVector<f64>, size: f64) -> Option<DVector<f64>> {
    let solution = match matrix.ncols() {
        0 => DVector::zeros(0),
        _ => SingularValues::of(matrix).solve(right, 1e-12),
    };
    ((matrix * &solution - right).norm() <= NOTHING * size).then_some(solution)
}
