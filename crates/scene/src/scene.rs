//! A scene: system, start, removals, duration.

use mechanics::{Completion, Removal, State, System, View};
use symbolic::Expr;

/// A system together with a consistent start and everything else a scene file says.
#[derive(Clone)]
pub struct Scene {
    /// Name by which the scene is called: that of the file, without its ending.
    pub name: String,
    /// One line.
    pub title: String,
    /// Where the example is from, empty if the file does not say.
    pub source: String,
    /// Remarks, empty if there are none.
    pub notes: String,
    /// `L`, `f`, `Q`, coordinates and parameters.
    pub system: System,
    /// `(t₀, q₀, v₀)` with `f(q₀, v₀, t₀) = 0`.
    pub start: State,
    /// How the start velocities came about.
    pub completion: Completion,
    /// Hand-written parametrizations, verified, in the order of the file.
    pub removals: Vec<Removal>,
    /// `μ₀`, length h; zero where the file does not say.
    pub multipliers: Vec<f64>,
    /// Length of the run, in units of `t`; positive.
    pub duration: f64,
    /// What columns of films show.
    pub film: Vec<Filmed>,
    /// The drawing; without bodies where the file has no `[view]`.
    pub view: View,
    /// What the scene's bodies mean; none where it has no bodies.
    pub meant: Option<Meant>,
}

/// What the bodies of a scene mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Meant {
    /// The same scene without bodies, as a file: it has the same system, start and picture.
    pub formulas: String,
    /// What each constraint says, in their order: its multiplier in Chetaev's equations is the force, or
    /// torque, that the contact exerts on the body there.
    pub constraints: Vec<String>,
    /// Slips at all contacts, in the graph of the system: along, across and along the normal, whether the
    /// law demands that they vanish or not.
    pub slips: Vec<Expr>,
    /// Constraints that were left out, because others say the same.
    pub left_out: Vec<String>,
}

/// The quantity in a column of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct Filmed {
    /// Name of the column.
    pub name: String,
    /// It, in `(q, v, t)` and parameters, in the graph of the system.
    pub expression: Expr,
    /// Standard deviation of its errors, positive, where the scene says it.
    pub sigma: Option<f64>,
}

impl Scene {
    /// For readers that know neither bodies nor vectors: the scene's own `text` where it has no bodies,
    /// otherwise the same scene by components.
    #[must_use]
    pub fn without_bodies(&self, text: &str) -> String {
        if self.meant.is_some() { self.to_toml() } else { text.to_owned() }
    }

    /// Names of the multipliers `μ₀`, one per constraint: those of the free constants of vakonomic motions.
    #[must_use]
    pub fn multiplier_names(&self) -> Vec<String> {
        self.system.constraint_numbers().into_iter().map(|number| multiplier_name(number - 1)).collect()
    }
}

/// Name of multiplier `i` at the start, with `i` from 0: `mu0_1` is the first.
pub(crate) fn multiplier_name(i: usize) -> String {
    format!("mu0_{}", i + 1)
}
