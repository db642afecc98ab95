//! Removed-constraint equations written with momenta, for readers, and checked against the derived ones.
//!
//! With velocities `V_i` in the displacement parameters, `p_i = ∂L/∂q̇_i`, rates `B_k` of memory variables:
//!
//! ```text
//! d/dt [ Σ_i p_i ∂V_i/∂u̇ + Σ_k P_k ∂B_k/∂u̇ ] = Σ_i (p_i ∂V_i/∂u + L_{q_i} ∂q_i/∂u) + Σ_k P_k ∂B_k/∂u ,
//! Ṗ_k = −Σ_i (p_i ∂V_i/∂w_k + L_{q_i} ∂q_i/∂w_k) − Σ_j P_j ∂B_j/∂w_k .
//! ```

use motion::REMOVED_CONSTRAINT;
use std::collections::HashMap;

use anyhow::{Context as _, Result};
use equations::Equations;
use mechanics::{Removal, System};
use symbolic::limits::SHORT;
use symbolic::{Expr, Graph, Symbol, Vanishing};

use random::equations;

use super::constants::removal;

/// An example written out.
#[derive(Clone, Debug)]
pub struct Example {
    /// Named quantities: name, what it is, both LaTeX.
    pub quantities: Vec<(String, String)>,
    /// The equations as LaTeX.
    pub equations: Vec<String>,
    /// Each balance and costate equation minus the derived one.
    pub residuals: Vec<Vanishing>,
}

/// Example 2. (Example 3 is shorter in quantities of its own, which are among the formulas.)
///
/// # Errors
/// Where it cannot be derived.
pub fn cone() -> Result<Example> {
    let scene = scene::catalogue::find("ball-in-cone", &[])?;
    let removal = removal(&scene, "paper")?;
    let derived = equations(&scene.system, REMOVED_CONSTRAINT, Some(removal))?;
    Writer::new(&scene.system, removal, derived).write()
}

/// Why the equations for the paper's `u` and `θ` of example 3 cannot be integrated.
///
/// # Errors
/// Where they can.
pub fn refusal() -> Result<String> {
    let scene = scene::catalogue::find("three-cylinders", &[])?;
    match equations(&scene.system, REMOVED_CONSTRAINT, Some(removal(&scene, "paper")?)) {
        Err(error) => Ok(error.to_string()),
        Ok(_) => anyhow::bail!("the paper's parametrization of example 3 is not refused"),
    }
}

/// Quantities that got a name, with what they stand for.
struct Writer<'a> {
    /// On the graph of the derived equations.
    system: System,
    removal: &'a Removal,
    derived: Equations,
    /// Name and meaning, in the order of their introduction.
    named: Vec<(Symbol, Expr)>,
    /// How a named quantity is written.
    latex: HashMap<Symbol, String>,
    quantities: Vec<(String, String)>,
}

impl<'a> Writer<'a> {
    fn new(system: &System, removal: &'a Removal, derived: Equations) -> Self {
        let system = System { graph: derived.graph.clone(), ..system.clone() };
        Writer { system, removal, derived, named: Vec::new(), latex: HashMap::new(), quantities: Vec::new() }
    }

    fn graph(&self) -> &Graph {
        &self.system.graph
    }

    /// A symbol for `meaning`, written `latex`, if it is long; else `meaning`.
    fn name(&mut self, latex: String, meaning: Expr, always: bool) -> Expr {
        let g = self.graph();
        if !always && (g.size(&[meaning]) <= SHORT || g.as_number(meaning).is_some()) {
            return meaning;
        }
        let known = self.named.iter().find(|(symbol, e)| *e == meaning && self.latex[symbol] == latex);
        if let Some((symbol, _)) = known {
            return g.variable(*symbol);
        }
        let symbol = g.symbol(&format!("q{}", 1000 + self.named.len()));
        let printed = g.latex(meaning);
        let e = g.variable(symbol);
        self.quantities.push((latex.clone(), printed));
        self.latex.insert(symbol, latex);
        self.named.push((symbol, meaning));
        e
    }

    fn write(mut self) -> Result<Example> {
        let (system, removal) = (self.system.clone(), self.removal);
        let mut momenta = Vec::new();
        let velocities = removal.velocities(&self.system);
        for c in &system.coordinates {
            let own = self.graph().derivative(system.lagrangian, c.velocity);
            let position = self.graph().latex_symbol(c.position);
            let absent = self.graph().is_zero(own);
            momenta.push(if absent { own } else { self.name(format!("p_{{{position}}}"), own, true) });
        }
        let costates: Vec<Option<Symbol>> = removal
            .memory
            .iter()
            .map(|w| self.graph().find_symbol(&format!("P_{}", self.graph().name(w.symbol))))
            .collect();
        let costates: Vec<Option<Symbol>> =
            costates.into_iter().map(|p| p.filter(|p| self.derived.states.iter().any(|y| y.symbol == *p))).collect();
        let mut balances = Vec::new();
        for u in &removal.parameters {
            let momentum = self.generalized(&momenta, &velocities, &costates, u.rate)?;
            let force = self.generalized(&momenta, &velocities, &costates, u.symbol)?;
            balances.push((u, momentum, force));
        }
        let mut rates = Vec::new();
        for (k, w) in removal.memory.iter().enumerate() {
            if let Some(p) = costates[k] {
                let force = self.generalized(&momenta, &velocities, &costates, w.symbol)?;
                rates.push((p, force));
            }
        }
        self.finish(balances, rates)
    }

    /// `Σ p_i ∂V_i/∂z + Σ L_{q_i} ∂q_i/∂z + Σ P_k ∂B_k/∂z`, long coefficients named.
    fn generalized(
        &mut self,
        momenta: &[Expr],
        velocities: &[Expr],
        costates: &[Option<Symbol>],
        z: Symbol,
    ) -> Result<Expr> {
        let (system, removal) = (self.system.clone(), self.removal);
        let variable = self.graph().latex_symbol(z);
        let mut terms = Vec::new();
        for (i, c) in system.coordinates.iter().enumerate() {
            let slope = self.graph().derivative(velocities[i], z);
            if !self.graph().is_zero(slope) && !self.graph().is_zero(momenta[i]) {
                let letter = self.graph().latex_symbol(c.velocity);
                let slope = self.name(format!(r"\tfrac{{\partial {letter}}}{{\partial {variable}}}"), slope, false);
                terms.push(self.graph().mul(momenta[i], slope));
            }
            let slope = self.graph().derivative(removal.coordinates[i], z);
            let force = self.graph().derivative(system.lagrangian, c.position);
            if !self.graph().is_zero(slope) && !self.graph().is_zero(force) {
                let letter = self.graph().latex_symbol(c.position);
                let force = self.name(format!(r"\tfrac{{\partial L}}{{\partial {letter}}}"), force, false);
                terms.push(self.graph().mul(force, slope));
            }
        }
        for (k, w) in removal.memory.iter().enumerate() {
            let (Some(p), slope) = (costates[k], self.graph().derivative(w.rate, z)) else { continue };
            if !self.graph().is_zero(slope) {
                let name = self.graph().name(w.symbol);
                let letter = self.graph().latex_symbol(self.graph().symbol(&format!("{name}'")));
                let slope = self.name(format!(r"\tfrac{{\partial {letter}}}{{\partial {variable}}}"), slope, false);
                terms.push(self.graph().mul(self.graph().variable(p), slope));
            }
        }
        Ok(self.graph().sum(&terms))
    }

    fn finish(
        self,
        balances: Vec<(&mechanics::DisplacementParameter, Expr, Expr)>,
        rates: Vec<(Symbol, Expr)>,
    ) -> Result<Example> {
        let g = self.graph();
        let removal = self.removal;
        let mut lines = Vec::new();
        let mut residuals = Vec::new();
        let mut flow: Vec<(Symbol, Expr)> = self.derived.states.iter().map(|y| (y.symbol, y.rate)).collect();
        flow.push((self.system.time, g.one()));
        for (u, momentum, force) in &balances {
            lines.push(format!(r"\frac{{d}}{{dt}}\left[{}\right] = {}", self.print(*momentum), self.print(*force)));
            let written = g.sub(g.total_derivative(self.plain(*momentum), &flow), self.plain(*force));
            let name = format!("balance for {}", g.name(u.symbol));
            let statement = self.derived.statements.iter().find(|s| s.meaning == name).context("no balance")?;
            let rest = g.sub(written, g.sub(statement.left, statement.right));
            residuals.push(self.system.vanishes(rest));
        }
        for (p, force) in &rates {
            let state = self.derived.states.iter().find(|y| y.symbol == *p).context("no costate")?;
            let rate = g.symbol(&format!("{}'", g.name(*p)));
            lines.push(format!("{} = {}", g.latex_symbol(rate), self.print(g.neg(*force))));
            residuals.push(self.system.vanishes(g.add(state.rate, self.plain(*force))));
        }
        for w in &removal.memory {
            let rate = g.symbol(&format!("{}'", g.name(w.symbol)));
            lines.push(format!("{} = {}", g.latex_symbol(rate), g.latex(w.rate)));
        }
        for (i, c) in self.system.coordinates.iter().enumerate() {
            if g.as_symbol(removal.coordinates[i]) != Some(c.position) {
                lines.push(format!("{} = {}", g.latex_symbol(c.position), g.latex(removal.coordinates[i])));
            }
        }
        Ok(Example { quantities: self.quantities, equations: lines, residuals })
    }

    /// Names replaced by what they stand for, velocities and coordinates by the parametrization.
    fn plain(&self, e: Expr) -> Expr {
        let g = self.graph();
        let map: HashMap<Symbol, Expr> = self
            .named
            .iter()
            // slopes are in the parameters already; momenta and forces are in q and v
            .map(|&(symbol, meaning)| (symbol, self.removal.rewrite(&self.system, meaning)))
            .collect();
        g.substitute(e, &map)
    }

    fn print(&self, e: Expr) -> String {
        let g = self.graph();
        let mut text = g.latex(e);
        for (symbol, latex) in &self.latex {
            text = text.replace(&g.latex_symbol(*symbol), &format!("{{{latex}}}"));
        }
        text
    }
}
