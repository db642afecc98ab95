//! The laws by which motions and equations of motion are named, right ones and classic mistakes.

use schemars::JsonSchema;
use serde::Serialize;

/// A law of motion of a system with constraints. `judge` finds the one of a motion, `review` that of
/// equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Chetaev's.
    Chetaev,
    /// Chetaev's reaction, and `A a = 0` instead of `ḟ = 0`.
    MissingRate,
    /// The vakonomic law, for some `μ₀`.
    Vakonomic,
    /// The constraint put into `L`: [`crate::SUBSTITUTION`].
    Substitution,
}

impl Law {
    /// Its word.
    pub fn name(self) -> &'static str {
        match self {
            Law::Chetaev => "chetaev",
            Law::MissingRate => "missing-rate",
            Law::Vakonomic => "vakonomic",
            Law::Substitution => "substitution",
        }
    }

    /// What was done, said of somebody's equations.
    pub fn words(self) -> &'static str {
        match self {
            Law::Chetaev => "Chetaev's equations",
            Law::MissingRate => "rate of the constraint's coefficients left out",
            Law::Vakonomic => "vakonomic equations",
            Law::Substitution => "constraint put into L",
        }
    }
}
