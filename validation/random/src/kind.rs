//! Kinds of random systems, and what is known of each by construction.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What a random system is, by construction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// No constraint.
    Free,
    /// `f = d/dt (q_d + ψ(q_i))`, and nothing contains `q_d`: integrable, in Chaplygin form.
    ChaplyginIntegrable,
    /// `f = d/dt (q_d + ψ(q, t))`.
    Integrable,
    /// The same behind a linear recombination of the constraints.
    HiddenIntegrable,
    /// Some constraints as in [`Kind::Integrable`], the others as in [`Kind::Linear`], recombined.
    PartlyIntegrable,
    /// `f = d/dt (q_d + ψ(q)) − s(q₁) v₂`, linear in the velocities and nonintegrable.
    Linear,
    /// `f = d/dt (q_d + ψ(q)) − s(q₁) (γ v₂ + β)`, affine and nonintegrable.
    Affine,
    /// As [`Kind::Affine`], and time enters.
    TimeDependent,
    /// `f = v_d² − c(q)² |v_i|²`, homogeneous of degree 2.
    Nonlinear,
    /// As [`Kind::Linear`], recombined so that two constraints are nearly the same.
    NearRankLoss,
}

/// What Frobenius' test has to find.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// Nothing is constrained.
    Unconstrained,
    /// All constraints are integrable.
    Integrable,
    /// This many combinations are, the others are not.
    PartlyIntegrable {
        /// Number of integrable combinations.
        integrals: usize,
    },
    /// No combination is.
    Nonintegrable,
    /// The test does not apply.
    NotLinear,
}

impl Kind {
    /// Every kind, simplest first.
    pub const ALL: [Kind; 10] = [
        Kind::Free,
        Kind::ChaplyginIntegrable,
        Kind::Integrable,
        Kind::HiddenIntegrable,
        Kind::PartlyIntegrable,
        Kind::Linear,
        Kind::Affine,
        Kind::TimeDependent,
        Kind::Nonlinear,
        Kind::NearRankLoss,
    ];

    /// Its name on the command line and in reports.
    pub fn name(self) -> &'static str {
        self.words().0
    }

    /// What it is, for the help of the command line.
    pub fn about(self) -> &'static str {
        self.words().1
    }

    fn words(self) -> (&'static str, &'static str) {
        match self {
            Kind::Free => ("free", "no constraint"),
            Kind::ChaplyginIntegrable => (
                "chaplygin-integrable",
                "`f = d/dt (q_d + ψ(q_i))`, and nothing contains `q_d`: integrable, in Chaplygin form",
            ),
            Kind::Integrable => ("integrable", "`f = d/dt (q_d + ψ(q, t))`"),
            Kind::HiddenIntegrable => {
                ("hidden-integrable", "the same behind a linear recombination of the constraints")
            }
            Kind::PartlyIntegrable => {
                ("partly-integrable", "some constraints as in `integrable`, the others as in `linear`, recombined")
            }
            Kind::Linear => {
                ("linear", "`f = d/dt (q_d + ψ(q)) − s(q₁) v₂`, linear in the velocities and nonintegrable")
            }
            Kind::Affine => ("affine", "`f = d/dt (q_d + ψ(q)) − s(q₁) (γ v₂ + β)`, affine and nonintegrable"),
            Kind::TimeDependent => ("time-dependent", "as `affine`, and time enters"),
            Kind::Nonlinear => ("nonlinear", "`f = v_d² − c(q)² |v_i|²`, homogeneous of degree 2"),
            Kind::NearRankLoss => {
                ("near-rank-loss", "as `linear`, recombined so that two constraints are nearly the same")
            }
        }
    }

    /// These kinds, simplest first.
    ///
    /// ```
    /// use random::Kind;
    /// assert_eq!(Kind::which(|kind| !kind.is_linear()), [Kind::Nonlinear, Kind::NearRankLoss]);
    /// ```
    pub fn which(is_so: impl Fn(Kind) -> bool) -> Vec<Kind> {
        Kind::ALL.into_iter().filter(|&kind| is_so(kind)).collect()
    }

    /// Whether constraints are linear (or affine) in the velocities and well conditioned (or there is none).
    pub fn is_linear(self) -> bool {
        !matches!(self, Kind::Nonlinear | Kind::NearRankLoss)
    }

    /// Whether all constraints are integrable (or there is none).
    pub fn is_integrable(self) -> bool {
        matches!(self, Kind::Free | Kind::ChaplyginIntegrable | Kind::Integrable | Kind::HiddenIntegrable)
    }

    /// Whether constraints may contain a part that is free of velocities.
    pub(super) fn has_drift(self) -> bool {
        matches!(self, Kind::Affine | Kind::TimeDependent)
    }

    /// Least and largest number of constraints on `n` coordinates; `None` if the kind does not exist.
    pub(super) fn constraints(self, n: usize) -> Option<(usize, usize)> {
        let range = match self {
            Kind::Free => (0, 0),
            Kind::ChaplyginIntegrable | Kind::Integrable | Kind::HiddenIntegrable => (1, n - 1),
            Kind::PartlyIntegrable | Kind::NearRankLoss => (2, n.saturating_sub(2)),
            // a line field is integrable: one free direction needs a drift
            Kind::Linear => (1, n.saturating_sub(2)),
            Kind::Affine | Kind::TimeDependent | Kind::Nonlinear => (1, n - 1),
        };
        (range.0 <= range.1).then_some(range)
    }

    /// The fewest coordinates with which the kind exists.
    pub(super) fn fewest_coordinates(self) -> usize {
        (2..).find(|&n| self.constraints(n).is_some()).unwrap_or(2)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
