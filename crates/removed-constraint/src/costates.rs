//! Costates of the memory variables: which move, and which are zero throughout.

use equations::{Equations, FreeConstant, LeftOut, Named, Role, StateVariable, Statement};
use mechanics::{Removal, fresh_symbol};
use symbolic::{Expr, Graph, Symbol};

use crate::work::Work;

pub(crate) struct Costates {
    /// `G = L + P·B`.
    pub(crate) generating_function: Expr,
    costates: Vec<Costate>,
}

/// The costate of one memory variable.
struct Costate {
    /// `P` at an instant.
    symbol: Symbol,
    /// `P(t₀)`.
    start: Symbol,
    /// `Ṗ = −∂G/∂w − Q_w`; `None` where `P` is zero throughout.
    rate: Option<Expr>,
}

impl Costates {
    /// Finds the costates that `removal` needs for the rewritten Lagrangian.
    ///
    /// A memory variable in neither `L` nor a `B` with a costate, and on which no force does work, is a mere
    /// quadrature: its costate does not move, and is zero if it starts or ends at zero. Their set is the
    /// largest consistent one, unless `all`.
    pub(crate) fn new(g: &Graph, removal: &Removal, lagrangian: Expr, work: &Work, all: bool) -> Self {
        let memory = &removal.memory;
        let named = |stem: &str| -> Vec<Symbol> {
            memory.iter().map(|w| fresh_symbol(g, &format!("{stem}_{}", g.name(w.symbol)))).collect()
        };
        let (starts, symbols) = (named("P0"), named("P"));
        let mut zero: Vec<bool> = work.by_memory.iter().map(|&work| !all && g.is_zero(work)).collect();
        let worked = (0..memory.len()).filter(|&i| !all && !zero[i]).map(|i| memory[i].rate);
        let mut reached: Vec<Expr> = [lagrangian].into_iter().chain(worked).collect();
        while let Some(e) = reached.pop() {
            for (i, w) in memory.iter().enumerate() {
                if zero[i] && !g.is_zero(g.derivative(e, w.symbol)) {
                    zero[i] = false;
                    reached.push(w.rate);
                }
            }
        }
        let coupled = (0..memory.len()).filter(|&i| !zero[i]).map(|i| g.mul(g.variable(symbols[i]), memory[i].rate));
        let generating_function = g.sum(&[lagrangian].into_iter().chain(coupled).collect::<Vec<Expr>>());
        let costate = |i: usize| Costate {
            symbol: symbols[i],
            start: starts[i],
            rate: (!zero[i])
                .then(|| g.neg(g.add(g.derivative(generating_function, memory[i].symbol), work.by_memory[i]))),
        };
        Costates { generating_function, costates: (0..memory.len()).map(costate).collect() }
    }

    /// Rates of memory variables and of the costates that move.
    pub(crate) fn flow(&self, removal: &Removal) -> Vec<(Symbol, Expr)> {
        let memory = removal.memory.iter().map(|w| (w.symbol, w.rate));
        memory.chain(self.costates.iter().filter_map(|p| Some((p.symbol, p.rate?)))).collect()
    }

    /// Adds memory variables, costates, free constants and the words about them.
    pub(crate) fn hand_over(&self, g: &Graph, removal: &Removal, equations: &mut Equations) {
        for w in &removal.memory {
            let role = if w.coordinate.is_some() { Role::Position } else { Role::Memory };
            let start = g.variable(w.symbol);
            equations.states.push(StateVariable { symbol: w.symbol, role, rate: w.rate, start });
            let rate = g.variable(g.symbol(&format!("{}'", g.name(w.symbol))));
            equations.statements.push(Statement { meaning: "memory".into(), left: rate, right: w.rate });
        }
        for (i, p) in self.costates.iter().enumerate() {
            let Some(rate) = p.rate else {
                let words =
                    "costate identically zero: neither L nor a rate with a costate contains the variable, no force acts on it".into();
                equations.left_out.push(LeftOut { variables: vec![p.symbol], words });
                continue;
            };
            let costate = g.variable(p.symbol);
            let left = g.variable(g.symbol(&format!("{}'", g.name(p.symbol))));
            equations.statements.push(Statement { meaning: "costate".into(), left, right: rate });
            let start = g.variable(p.start);
            equations.states.push(StateVariable { symbol: p.symbol, role: Role::MemoryCostate, rate, start });
            equations.free_constants.push(FreeConstant { symbol: p.start, natural: Some(costate), memory: Some(i) });
            equations.multipliers.push(Named { name: g.name(p.symbol), expression: costate });
        }
        let second = removal.parameters.iter().any(|u| g.depends_on(self.generating_function, u.second_rate));
        if !second {
            let words = "second rates of the parameters: G is of first order".into();
            equations.left_out.push(LeftOut { variables: Vec::new(), words });
        }
    }
}
