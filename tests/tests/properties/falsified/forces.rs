//! Claims that fail where the forces of a system are forgotten in a motion.

use equations::Formulation;
use mechanics::Removal;
use motion::{CHETAEV, Motion, REMOVED_CONSTRAINT, SolveError, VAKONOMIC};
use random::{Case, Kind, Removed, equations, free_constants};

use super::{False, in_case};

const FORCELESS: &str = "the forces forgotten, where there are some";

/// The motion of a formulation without the forces.
fn without_forces(
    case: &Case,
    formulation: &'static Formulation,
    removal: Option<&Removal>,
    constants: &[f64],
) -> Result<Motion, SolveError> {
    let mut system = case.scene.system.clone();
    system.forces.fill(system.graph.zero());
    let equations = equations(&system, formulation, removal)?;
    let own = free_constants(&equations, constants);
    case.run(equations, if removal.is_some() { &own } else { constants })
}

fn forceless(case: &mut Case) -> Result<(), SolveError> {
    case.chetaev = without_forces(case, CHETAEV, None, &[])?;
    Ok(())
}

fn forceless_vakonomic(case: &mut Case) -> Result<(), SolveError> {
    case.vakonomic = without_forces(case, VAKONOMIC, None, &case.scene.multipliers)?;
    Ok(())
}

fn forceless_removed(case: &mut Case) -> Result<(), SolveError> {
    for i in 0..case.removed.len() {
        let Removed { removal, costates, .. } = &case.removed[i];
        case.removed[i].motion = without_forces(case, REMOVED_CONSTRAINT, Some(removal), costates)?;
    }
    Ok(())
}

/// Of each formulation and of what is compared with it.
pub(super) const FALSE: &[False] = &[
    in_case(0, "Chetaev: multipliers and Maggi's equations", Kind::Linear, FORCELESS, forceless),
    in_case(0, "vakonomic: multiplier form and costate form", Kind::Linear, FORCELESS, forceless_vakonomic),
    in_case(1, "vakonomic agrees with Chetaev", Kind::Integrable, FORCELESS, forceless_vakonomic),
    in_case(1, "coordinate removal agrees with Chetaev", Kind::Integrable, FORCELESS, forceless_removed),
    in_case(
        2,
        "removed constraint is vakonomic motion of the augmented system",
        Kind::Linear,
        FORCELESS,
        forceless_removed,
    ),
    in_case(
        3,
        "coordinate removal is the vakonomic motion with mu = -P - L_w'",
        Kind::Affine,
        FORCELESS,
        forceless_removed,
    ),
    in_case(3, "vakonomic is the coordinate removal with P = -mu - L_w'", Kind::Affine, FORCELESS, forceless_vakonomic),
    in_case(4, "Chetaev: constraints recombined", Kind::Affine, FORCELESS, forceless),
    in_case(4, "vakonomic: constraints recombined", Kind::Affine, FORCELESS, forceless_vakonomic),
    in_case(4, "Chetaev: other coordinates", Kind::Nonlinear, FORCELESS, forceless),
    in_case(4, "vakonomic: other coordinates", Kind::Nonlinear, FORCELESS, forceless_vakonomic),
    in_case(5, "coefficient of the leading divergence", Kind::Linear, FORCELESS, forceless_vakonomic),
    in_case(8, "friction tends to Chetaev at rate 1/N", Kind::Linear, FORCELESS, forceless),
    in_case(8, "added mass tends to vakonomic at rate 1/N", Kind::Linear, FORCELESS, forceless_vakonomic),
    in_case(8, "the family between begins at vakonomic", Kind::Linear, FORCELESS, forceless_vakonomic),
    in_case(8, "the family between tends to Chetaev at rate 1/kappa", Kind::Linear, FORCELESS, forceless),
    in_case(9, "the multipliers found give Chetaev's motion", Kind::Integrable, FORCELESS, forceless),
    in_case(10, "Chetaev runs back the way it came", Kind::Linear, FORCELESS, forceless),
    in_case(10, "vakonomic runs back the way it came", Kind::Linear, FORCELESS, forceless_vakonomic),
    in_case(10, "removed constraint runs back the way it came", Kind::Affine, FORCELESS, forceless_removed),
    in_case(10, "Chetaev in other units", Kind::Affine, FORCELESS, forceless),
    in_case(10, "vakonomic in other units", Kind::Affine, FORCELESS, forceless_vakonomic),
    in_case(10, "removed constraint in other units", Kind::Linear, FORCELESS, forceless_removed),
    in_case(14, "removal with p_u = 0 is Newton's motion", Kind::Integrable, FORCELESS, forceless),
];
