//! Cost and outputs of compiled equations.

/// Operations of one evaluation of the rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Instructions of tapes.
    pub instructions: usize,
    /// Multiplications of LU factorization and substitution.
    pub factorization: usize,
}

impl Cost {
    /// Both together.
    pub fn operations(self) -> usize {
        self.instructions + self.factorization
    }
}

/// Outputs of a motion at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outputs {
    /// `q`.
    pub coordinates: Vec<f64>,
    /// `q̇`.
    pub velocities: Vec<f64>,
    /// Multipliers or costates.
    pub multipliers: Vec<f64>,
    /// Quantities that should be constant.
    pub invariants: Vec<f64>,
}

/// How many there are of everything that compiled equations take and give.
#[derive(Clone, Copy)]
pub(crate) struct Sizes {
    pub(crate) states: usize,
    pub(crate) constants: usize,
    pub(crate) coordinates: usize,
    pub(crate) multipliers: usize,
    pub(crate) invariants: usize,
    pub(crate) guards: usize,
}

impl Sizes {
    pub(crate) fn known(&self) -> usize {
        1 + self.states + self.constants
    }

    pub(crate) fn outputs(&self, values: &[f64]) -> Outputs {
        let (q, rest) = values.split_at(self.coordinates);
        let (v, rest) = rest.split_at(self.coordinates);
        let (m, i) = rest.split_at(self.multipliers);
        debug_assert_eq!(i.len(), self.invariants);
        Outputs { coordinates: q.to_vec(), velocities: v.to_vec(), multipliers: m.to_vec(), invariants: i.to_vec() }
    }
}
