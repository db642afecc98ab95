//! Where a statement about almost every place holds.

use symbolic::Expr;

use crate::System;

/// Where statements hold that are made at random places: all places, or those that motions from the start can
/// reach.
///
/// ```
/// # use mechanics::Domain;
/// assert_eq!(Domain::default().almost_every("place"), "almost every place");
/// let domain = Domain { leaf: true, branch: true };
/// assert_eq!(domain.almost_every("place"), "almost every place of the leaf and branch of this start");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Domain {
    /// Constraints on positions hold, `g(q, t) = 0`, and nothing is said where `g` is another constant.
    pub leaf: bool,
    /// Something that varies stands under a root or has a kink: `√(s²)` is `s` for one sign of `s` and `−s`
    /// for the other, and is what it is at the start.
    pub branch: bool,
}

impl Domain {
    /// That of statements on motions of `system`.
    pub fn of(system: &System) -> Self {
        Domain::of_formulas(system, &[&[system.lagrangian], &system.constraints[..], &system.forces].concat())
    }

    /// That of statements on the constraints alone.
    pub(crate) fn of_constraints(system: &System) -> Self {
        Domain::of_formulas(system, &system.constraints)
    }

    fn of_formulas(system: &System, formulas: &[Expr]) -> Self {
        let g = &system.graph;
        let branch = g.ends_of_pieces(formulas).into_iter().any(|e| !system.is_constant(e));
        Domain { leaf: !system.on_positions.is_empty(), branch }
    }

    /// "almost every place of the leaf of this start", or of what else there are so many.
    pub fn almost_every(self, of: &str) -> String {
        format!("almost every {of}{}", self.part())
    }

    /// " of the leaf and branch of this start", and nothing where that is all.
    pub fn part(self) -> &'static str {
        match (self.leaf, self.branch) {
            (false, false) => "",
            (true, false) => " of the leaf of this start",
            (false, true) => " of the branch of this start",
            (true, true) => " of the leaf and branch of this start",
        }
    }
}
