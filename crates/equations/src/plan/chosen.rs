//! A plan of evaluation: definitions in place of blocks.

use symbolic::{Expr, Symbol};

use crate::definitions::apart;
use crate::equations::Equations;

/// Definitions that take the place of blocks.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Intermediate quantities and unknowns in the order in which they are computed, in `(t, y)`, free
    /// constants, unknowns of blocks that are left, and earlier definitions.
    pub definitions: Vec<(Symbol, Expr)>,
    /// `κ(t, y)`: the definitions are accurate where `κ ≤` [`Plan::LIMIT`]; `None` where they are everywhere.
    pub condition: Option<Expr>,
    /// Places of the blocks that are solved numerically.
    pub left: Vec<usize>,
    /// What was chosen for each block and why, in words.
    pub why: Vec<String>,
    /// All definitions and the rates as they are evaluated, where there is a shorter way to write them.
    pub collected: Option<Collected>,
}

/// Definitions and rates of a plan, written shorter.
#[derive(Clone, Debug)]
pub struct Collected {
    /// All definitions, those of the equations and those of the plan, each after what it contains.
    pub definitions: Vec<(Symbol, Expr)>,
    /// `ẏ`.
    pub rates: Vec<Expr>,
}

impl Plan {
    /// Largest condition of used definitions. A multiplier of 1000 takes three digits at most.
    pub const LIMIT: f64 = 1e6;

    /// The rates as they are evaluated.
    pub(crate) fn rates(&self, equations: &Equations) -> Vec<Expr> {
        match &self.collected {
            Some(collected) => collected.rates.clone(),
            None => equations.states.iter().map(|y| y.rate).collect(),
        }
    }

    /// Those of the equations and those of the plan, each after what it contains.
    pub(crate) fn all_definitions(&self, equations: &Equations) -> Vec<(Symbol, Expr)> {
        if let Some(collected) = &self.collected {
            return collected.definitions.clone();
        }
        let (known, waiting) = apart(&equations.graph, &equations.definitions, &equations.unknowns());
        [known, self.definitions.clone(), waiting].concat()
    }

    /// Places in `(t, y, constants, z)` of what the definitions take: of `z` the unknowns of blocks left.
    pub(crate) fn places(&self, equations: &Equations) -> Vec<usize> {
        let mut first = equations.known_symbols().len();
        let mut places: Vec<usize> = (0..first).collect();
        for (k, block) in equations.blocks.iter().enumerate() {
            let end = first + block.unknowns.len();
            if self.left.contains(&k) {
                places.extend(first..end);
            }
            first = end;
        }
        places
    }

    /// All blocks are solved by LU factorization.
    pub fn plain(equations: &Equations) -> Plan {
        Plan { left: (0..equations.blocks.len()).collect(), ..Plan::default() }
    }
}
