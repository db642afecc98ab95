//! Is the constraint integrable? Frobenius' test by the Lie flag of the admissible directions.

use std::collections::HashMap;

use symbolic::{Expr, Matrix, Symbol, Vanishing};

use crate::rank::generic_rank;
use crate::solved_constraints::SolvedConstraints;
use crate::{RemovalError, State, System};

/// Verdict of [`integrability`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrability {
    /// There is no constraint.
    Unconstrained,
    /// Every constraint is (a combination of) total time derivatives: `f = 0` confines the configuration.
    Integrable {
        /// Whether the brackets vanish by simplification and not only at random points.
        exact: bool,
    },
    /// Some independent combinations of the constraints are total time derivatives, the others are not.
    PartlyIntegrable {
        /// Number of integrable combinations.
        integrals: usize,
        /// Number of constraints.
        constraints: usize,
    },
    /// No combination of the constraints is integrable: every configuration can be reached.
    Nonintegrable {
        /// Brackets that had to be nested until all directions were reached.
        depth: usize,
    },
    /// A constraint is not linear in the velocities; Frobenius' test is about those that are.
    NonlinearInVelocity,
    /// The next brackets are too long for this test.
    Undecided {
        /// Brackets that were nested.
        depth: usize,
        /// Integrable combinations that these leave at most.
        at_most: usize,
        /// Number of constraints.
        constraints: usize,
    },
}

/// Nodes over which a bracket is too long: each bracket around it makes it several times longer.
const LONGEST: usize = 10_000;

impl Integrability {
    /// Whether the verdict predicts that all formulations agree (T1).
    pub fn is_integrable(self) -> bool {
        matches!(self, Integrability::Unconstrained | Integrability::Integrable { .. })
    }
}

impl std::fmt::Display for Integrability {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Integrability::Unconstrained => write!(f, "no constraint"),
            Integrability::Integrable { exact: true } => write!(f, "integrable (brackets vanish identically)"),
            Integrability::Integrable { exact: false } => write!(f, "integrable (brackets vanish at random points)"),
            Integrability::PartlyIntegrable { integrals, constraints } => {
                write!(f, "partly integrable: {integrals} of {constraints} constraints are integrable combinations")
            }
            Integrability::Nonintegrable { depth } => {
                write!(f, "nonintegrable: brackets nested {depth} deep reach every direction")
            }
            Integrability::Undecided { depth, at_most, constraints } => write!(
                f,
                "undecided: brackets nested {depth} deep leave at most {at_most} of {constraints} integrable combinations, \
                 and the next are too long"
            ),
            Integrability::NonlinearInVelocity => {
                write!(f, "not linear in the velocities: Frobenius' test does not apply")
            }
        }
    }
}

/// Frobenius' test for constraints `A(q,t) v + b(q,t) = 0`.
///
/// Fields `X₁ … X_m` span the admissible directions in `(q, t)` (with `T = c ∂_q + ∂_t` where anything
/// depends on time or `b ≠ 0`). Brackets `[X, Y] = Y_x X − X_x Y` are added until the rank stays; what it
/// lacks is the number of integrals. Ranks are taken at random points; fields are differentiated exactly.
///
/// # Errors
/// [`RemovalError::Dependent`] where `A` has no full row rank at `state`.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// # let start = mechanics::State { t: 0.0, q: vec![0., 0., 0.3], v: vec![0.5, 0.5 * 0.3f64.tan(), 1.] };
/// use mechanics::{Integrability, integrability};
/// // the ice sledge: y'*cos(phi) - x'*sin(phi)
/// assert_eq!(integrability(&system, &start)?, Integrability::Nonintegrable { depth: 1 });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn integrability(system: &System, state: &State) -> Result<Integrability, RemovalError> {
    let h = system.constraints.len();
    if h == 0 {
        return Ok(Integrability::Unconstrained);
    }
    if !system.constraints_linear_in_velocity() {
        return Ok(Integrability::NonlinearInVelocity);
    }
    let g = &system.graph;
    let solved = SolvedConstraints::new(system, state)?;
    let with_time = solved.offset.iter().any(|&e| !g.is_zero(e))
        || system.constraints.iter().any(|&f| g.depends_on(f, system.time));
    let mut space: Vec<Symbol> = system.positions();
    if with_time {
        space.push(system.time);
    }
    let admissible = solved.fields(system, with_time);
    if g.size(&admissible.concat()) > LONGEST {
        return Ok(Integrability::Undecided { depth: 0, at_most: h, constraints: h });
    }
    let constants: HashMap<Symbol, f64> = system.parameter_values();
    let rank_of =
        |fields: &[Vec<Expr>]| generic_rank(g, &Matrix::new(fields.len(), space.len(), fields.concat()), &constants);
    let bracket = |x: &[Expr], y: &[Expr]| -> Vec<Expr> {
        let along = |field: &[Expr], by: &[Expr], i: usize| g.dot(&g.gradient(field[i], &space), by);
        (0..space.len()).map(|i| g.sub(along(y, x, i), along(x, y, i))).collect()
    };

    let mut fields = admissible.clone();
    let mut newest = admissible.clone();
    let mut rank = fields.len();
    let (mut depth, mut exact) = (0, true);
    while rank < space.len() {
        let mut added = Vec::new();
        for (i, x) in admissible.iter().enumerate() {
            // [Y, X] = −[X, Y]
            let first = if depth == 0 { i + 1 } else { 0 };
            for y in newest.iter().skip(first) {
                let z = bracket(x, y);
                if g.size(&z) > LONGEST {
                    return Ok(Integrability::Undecided { depth, at_most: space.len() - rank, constraints: h });
                }
                // where there is a direction more, nobody asks how exactly another bracket vanishes
                if rank == admissible.len() {
                    let verdicts: Vec<Vanishing> = z.iter().map(|&e| g.vanishes(e, &constants)).collect();
                    if verdicts.iter().all(|v| v.is_zero()) {
                        exact &= verdicts.iter().all(|v| matches!(v, Vanishing::Exactly));
                        continue;
                    }
                }
                fields.push(z.clone());
                if rank_of(&fields) > rank {
                    rank += 1;
                    added.push(z);
                } else {
                    exact = false;
                    fields.pop();
                }
            }
        }
        if added.is_empty() {
            break;
        }
        depth += 1;
        newest = added;
    }
    let integrals = space.len() - rank;
    Ok(match integrals {
        0 => Integrability::Nonintegrable { depth },
        _ if integrals == h => Integrability::Integrable { exact },
        _ => Integrability::PartlyIntegrable { integrals, constraints: h },
    })
}
