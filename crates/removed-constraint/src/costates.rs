//! Costates of the memory variables: which are needed, which are constant, which are zero.

use mechanics::{Equations, FreeConstant, Named, Removal, Role, StateVariable, Statement, fresh_symbol};
use symbolic::{Expr, Graph, Symbol};

/// What a costate turned out to be.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Zero at the start with a rate that vanishes: zero throughout.
    Zero,
    /// Its rate vanishes: a free constant.
    Constant,
    /// A state with `Ṗ = −∂G/∂w`.
    Moving,
}

pub(crate) struct Costates {
    /// `G = L + P·B`.
    pub(crate) generating_function: Expr,
    kinds: Vec<Kind>,
    /// `P` at an instant.
    symbols: Vec<Symbol>,
    /// `P(t₀)`.
    starts: Vec<Symbol>,
    /// `Ṗ = −∂G/∂w`.
    rates: Vec<Expr>,
}

impl Costates {
    /// Classifies the costates of `removal` for the rewritten Lagrangian.
    ///
    /// The set of zero costates is the largest one that is consistent: `P_w = 0` for all its `w` if `L + Σ P·B`, summed over the
    /// costates outside the set, contains none of them.
    pub(crate) fn new(g: &Graph, removal: &Removal, lagrangian: Expr, zero_where_possible: bool) -> Self {
        let memory = &removal.memory;
        let names: Vec<String> = memory.iter().map(|w| g.name(w.symbol)).collect();
        let starts: Vec<Symbol> = names.iter().map(|name| fresh_symbol(g, &format!("P0_{name}"))).collect();
        let symbols: Vec<Symbol> = names.iter().map(|name| fresh_symbol(g, &format!("P_{name}"))).collect();
        let generating = |zero: &[bool]| {
            let terms = (0..memory.len()).filter(|&i| !zero[i]).map(|i| g.mul(g.variable(symbols[i]), memory[i].rate));
            g.sum(&std::iter::once(lagrangian).chain(terms).collect::<Vec<_>>())
        };
        let mut zero = vec![zero_where_possible; memory.len()];
        let mut generating_function = generating(&zero);
        while let Some(i) =
            (0..memory.len()).find(|&i| zero[i] && !g.is_zero(g.derivative(generating_function, memory[i].symbol)))
        {
            zero[i] = false;
            generating_function = generating(&zero);
        }
        let rates = g.gradient(generating_function, &memory.iter().map(|w| w.symbol).collect::<Vec<_>>());
        let rates: Vec<Expr> = rates.into_iter().map(|e| g.neg(e)).collect();
        let kinds = (0..memory.len())
            .map(|i| match (zero[i], g.is_zero(rates[i])) {
                (true, _) => Kind::Zero,
                (false, true) => Kind::Constant,
                (false, false) => Kind::Moving,
            })
            .collect();
        Costates { generating_function, kinds, symbols, starts, rates }
    }

    /// Rates of memory variables and of the costates that move.
    pub(crate) fn flow(&self, g: &Graph, removal: &Removal) -> Vec<(Symbol, Expr)> {
        let memory = removal.memory.iter().map(|w| (w.symbol, w.rate));
        let costates = (0..self.kinds.len()).map(|i| {
            let rate = if self.kinds[i] == Kind::Moving { self.rates[i] } else { g.zero() };
            (self.symbols[i], rate)
        });
        memory.chain(costates).collect()
    }

    /// Adds memory variables, costates, free constants and the words about them.
    pub(crate) fn hand_over(&self, g: &Graph, removal: &Removal, equations: &mut Equations) {
        for w in &removal.memory {
            let role = if w.coordinate.is_some() { Role::Position } else { Role::Memory };
            let start = g.variable(w.symbol);
            equations.states.push(StateVariable { symbol: w.symbol, role, rate: w.rate, start });
            let rate = g.symbol(&format!("{}'", g.name(w.symbol)));
            equations.statements.push(Statement { meaning: "memory".into(), left: g.variable(rate), right: w.rate });
        }
        for (i, w) in removal.memory.iter().enumerate() {
            let costate = self.symbols[i];
            let named = Named { name: g.name(costate), expression: g.variable(costate) };
            let latex = g.latex_symbol(costate);
            match self.kinds[i] {
                Kind::Zero => {
                    equations.left_out.push(format!("${latex}$: costate identically zero"));
                    continue;
                }
                Kind::Constant => {
                    let why = format!("neither $L$ nor a needed rate contains ${}$", g.latex_symbol(w.symbol));
                    equations.left_out.push(format!("${latex}$ as a state: constant, because {why}"));
                    equations.free_constants.push(FreeConstant { symbol: costate, natural: Some(g.variable(costate)) });
                }
                Kind::Moving => {
                    equations.states.push(StateVariable {
                        symbol: costate,
                        role: Role::MemoryCostate,
                        rate: self.rates[i],
                        start: g.variable(self.starts[i]),
                    });
                    let rate = g.symbol(&format!("{}'", g.name(costate)));
                    let (left, right) = (g.variable(rate), self.rates[i]);
                    equations.statements.push(Statement { meaning: "costate".into(), left, right });
                    equations
                        .free_constants
                        .push(FreeConstant { symbol: self.starts[i], natural: Some(g.variable(costate)) });
                }
            }
            equations.multipliers.push(named);
        }
        let second = removal.parameters.iter().any(|u| g.depends_on(self.generating_function, u.second_rate));
        if !second && !removal.parameters.is_empty() {
            equations.left_out.push("second rates in $G$: $L$ is of first order in the parameters".into());
        }
    }
}
