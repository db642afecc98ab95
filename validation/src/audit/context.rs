//! What the names in an equation stand for.
//!
//! A context has constants, free functions of time, integrals (with integrands as rates) and definitions. A
//! prime is a time derivative: a symbol for a free function, else the derivative along the rates.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};

use anyhow::{Context as _, Result, anyhow, bail};
use symbolic::limits::DEPTH;
use symbolic::{Expr, Graph, Symbol};
use toml::{Table, Value};

/// Derivatives of a free function that are symbols.
const ORDERS: usize = 9;

/// Names and what they stand for, on one graph.
#[derive(Clone)]
pub(super) struct Context {
    /// Where the expressions live.
    pub(super) graph: Graph,
    constants: BTreeSet<String>,
    functions: BTreeSet<String>,
    integrals: HashMap<String, String>,
    definitions: HashMap<String, String>,
    partials: Vec<String>,
    zero: Vec<String>,
    /// Expressions made by code, and those that were looked up before.
    found: RefCell<HashMap<String, Expr>>,
}

impl Context {
    /// Reads a context: `constants`, `functions`, `integrals`, `definitions`, `partials`.
    pub(super) fn read(data: &Table) -> Result<Context> {
        let context = Context {
            graph: Graph::new(),
            constants: words(data, "constants")?.into_iter().collect(),
            functions: words(data, "functions")?.into_iter().collect(),
            integrals: texts(data, "integrals")?.into_iter().collect(),
            definitions: texts(data, "definitions")?.into_iter().collect(),
            partials: words(data, "partials")?,
            zero: words(data, "zero")?,
            found: RefCell::default(),
        };
        // symbols are printed in the order in which they come to be: constants before functions, or as said
        for name in words(data, "order")?.iter().chain(&words(data, "constants")?) {
            context.graph.symbol(name);
        }
        for name in texts(data, "integrals")?.iter().map(|(name, _)| name).chain(&words(data, "functions")?) {
            for primes in ["", "'", "''"] {
                context.graph.symbol(&format!("{name}{primes}"));
            }
        }
        Ok(context)
    }

    /// Adds what code knows: the expression that a name stands for.
    pub(super) fn add(&self, name: &str, e: Expr) {
        self.found.borrow_mut().insert(name.into(), e);
    }

    /// Adds an integral from `t₀`, by its integrand.
    pub(super) fn add_integral(&mut self, name: &str, integrand: &str) {
        self.integrals.insert(name.into(), integrand.into());
        self.found.get_mut().remove(name);
        self.found.get_mut().remove(&format!("{name}'"));
    }

    pub(super) fn add_constant(&mut self, name: &str) {
        self.constants.insert(name.into());
    }

    /// `text` as printed, names as symbols. `left = right` gives both sides, anything else 0 on the right.
    pub(super) fn sides(&self, text: &str) -> Result<[Expr; 2]> {
        let (left, right) = text.split_once('=').unwrap_or((text, "0"));
        Ok([self.raw(left)?, self.raw(right)?])
    }

    /// An expression as it stands.
    pub(super) fn raw(&self, text: &str) -> Result<Expr> {
        let g = &self.graph;
        self.parse(text, |name| Ok(self.meaning(name, 0)?.map(|_| g.variable(g.symbol(name)))))
    }

    /// A raw expression with every name replaced by what it stands for.
    pub(super) fn resolved(&self, raw: Expr) -> Result<Expr> {
        self.resolve_deep(raw, 0)
    }

    /// [`Context::raw`] and [`Context::resolved`] in one.
    pub(super) fn expression(&self, text: &str) -> Result<Expr> {
        self.resolved(self.raw(text)?)
    }

    /// A resolved expression with the symbols in `zero` put to zero.
    pub(super) fn in_the_end(&self, e: Expr) -> Expr {
        let g = &self.graph;
        g.substitute(e, &self.zero.iter().map(|name| (g.symbol(name), g.zero())).collect())
    }

    /// `de/dt` of a resolved expression along the rates.
    pub(super) fn rate(&self, e: Expr) -> Result<Expr> {
        self.rate_deep(e, 0)
    }

    /// A raw expression as LaTeX. Partial derivatives `F_u1` are `F_{\dot u}`, their rates with `d/dt`.
    pub(super) fn latex(&self, raw: Expr) -> String {
        let g = &self.graph;
        let mut text = g.latex(raw);
        let mut replaced: Vec<(String, String)> =
            g.symbols_of(raw).into_iter().filter_map(|s| Some((g.latex_symbol(s), self.partial_latex(s)?))).collect();
        // the longest first: one may be within another
        replaced.sort_by_key(|(old, _)| std::cmp::Reverse(old.len()));
        for (old, new) in replaced {
            text = text.replace(&old, &new);
        }
        text
    }

    fn partial_latex(&self, symbol: Symbol) -> Option<String> {
        let g = &self.graph;
        let name = g.name(symbol);
        let stem = name.trim_end_matches('\'');
        let (function, variable) = stem.split_once('_')?;
        if function == "delta" {
            let varied = format!("{variable}{}", &name[stem.len()..]);
            return Some(format!(r"\delta {}", g.latex_symbol(g.symbol(&varied))));
        }
        self.partials.iter().find(|p| *p == function)?;
        let variable = g.latex_symbol(g.symbol(&self.with_primes(variable)));
        let partial = format!("{}_{{{variable}}}", g.latex_symbol(g.symbol(function)));
        Some(match name.len() - stem.len() {
            0 => partial,
            1 => format!(r"\bigl(\tfrac{{d}}{{dt}} {partial}\bigr)"),
            n => format!(r"\bigl(\tfrac{{d^{n}}}{{dt^{n}}} {partial}\bigr)"),
        })
    }

    /// `u2` as `u''`, for a free function `u` (and for the coordinates `q`, which no function here contains).
    fn with_primes(&self, variable: &str) -> String {
        let stem = variable.trim_end_matches(['0', '1', '2']);
        let order = variable[stem.len()..].parse::<usize>().ok().filter(|order| *order < 3);
        match order {
            Some(order) if self.functions.contains(stem) || stem == "q" => format!("{stem}{}", "'".repeat(order)),
            _ => variable.to_string(),
        }
    }

    /// What a name stands for.
    fn meaning(&self, name: &str, depth: usize) -> Result<Option<Expr>> {
        if depth > DEPTH {
            bail!("`{name}` is defined by itself");
        }
        if let Some(&e) = self.found.borrow().get(name) {
            return Ok(Some(e));
        }
        let Some(e) = self.look_up(name, depth + 1)? else { return Ok(None) };
        self.found.borrow_mut().insert(name.into(), e);
        Ok(Some(e))
    }

    fn look_up(&self, name: &str, depth: usize) -> Result<Option<Expr>> {
        let g = &self.graph;
        if let Some(text) = self.definitions.get(name) {
            let raw = self.parse_deep(text, depth).with_context(|| format!("definition of `{name}`"))?;
            return Ok(Some(raw));
        }
        if self.constants.contains(name) || self.functions.contains(name) || self.integrals.contains_key(name) {
            return Ok(Some(g.variable(g.symbol(name))));
        }
        let stem = name.trim_end_matches('\'');
        if self.functions.contains(stem) && name.len() - stem.len() <= ORDERS {
            return Ok(Some(g.variable(g.symbol(name))));
        }
        if let Some(shorter) = name.strip_suffix('\'') {
            if let Some(integrand) = self.integrals.get(shorter) {
                let rate = self.parse_deep(integrand, depth).with_context(|| format!("integrand of `{shorter}`"))?;
                return Ok(Some(rate));
            }
            return self.meaning(shorter, depth)?.map(|e| self.rate_deep(e, depth)).transpose();
        }
        if name == "t" {
            return Ok(Some(g.variable(g.symbol("t"))));
        }
        let Some((function, variable)) = name.split_once('_') else { return Ok(None) };
        if !self.partials.iter().any(|p| p == function) {
            return Ok(None);
        }
        let symbol = g.symbol(&self.with_primes(variable));
        Ok(self.meaning(function, depth)?.map(|e| g.derivative(e, symbol)))
    }

    fn parse_deep(&self, text: &str, depth: usize) -> Result<Expr> {
        self.parse(text, |name| self.meaning(name, depth))
    }

    /// `text` with names as `meaning` has them; a fault of theirs comes before one of the text.
    fn parse(&self, text: &str, meaning: impl Fn(&str) -> Result<Option<Expr>>) -> Result<Expr> {
        let fault = RefCell::new(None);
        let scope = |name: &str| {
            meaning(name).unwrap_or_else(|error| {
                *fault.borrow_mut() = Some(error);
                None
            })
        };
        let parsed = self.graph.parse(text, &scope);
        match fault.into_inner() {
            Some(error) => Err(error),
            None => parsed.map_err(|error| anyhow!("{error}")),
        }
    }

    fn resolve_deep(&self, raw: Expr, depth: usize) -> Result<Expr> {
        let g = &self.graph;
        let mut map = HashMap::new();
        for symbol in g.symbols_of(raw) {
            let name = g.name(symbol);
            let e = self.meaning(&name, depth)?.with_context(|| format!("`{name}` stands for nothing"))?;
            map.insert(symbol, e);
        }
        Ok(g.substitute(raw, &map))
    }

    fn rate_deep(&self, e: Expr, depth: usize) -> Result<Expr> {
        let g = &self.graph;
        let mut rates = Vec::new();
        for symbol in g.symbols_of(e) {
            let name = g.name(symbol);
            let stem = name.trim_end_matches('\'');
            if name == "t" && !self.constants.contains("t") {
                rates.push((symbol, g.one()));
            } else if self.functions.contains(stem) {
                if name.len() - stem.len() >= ORDERS {
                    bail!("more than {ORDERS} derivatives of `{stem}`");
                }
                rates.push((symbol, g.variable(g.symbol(&format!("{name}'")))));
            } else if self.integrals.contains_key(&name) {
                let rate = self.meaning(&format!("{name}'"), depth)?;
                rates.push((symbol, rate.with_context(|| format!("`{name}` has no integrand"))?));
            }
        }
        Ok(g.total_derivative(e, &rates))
    }

    /// For `∫ L dt` with integrals `w` in `L`, each with a costate `P`: with `G = L + P·ẇ` the kernels
    ///
    /// ```text
    /// K_u = d²/dt² G_ü − d/dt G_u̇ + G_u ,      costate_w = Ṗ + G_w   (zero where P is the right one).
    /// ```
    pub(super) fn add_kernels(&self, action: &Table) -> Result<()> {
        let g = &self.graph;
        let name = action.get("lagrangian").and_then(Value::as_str).context("action: `lagrangian` is missing")?;
        let lagrangian = self.expression(name)?;
        let costates = texts(action, "costates")?;
        let mut generating = lagrangian;
        for (w, p) in &costates {
            let power = g.mul(self.expression(p)?, self.expression(&format!("{w}'"))?);
            generating = g.add(generating, power);
        }
        for u in words(action, "parameters")? {
            let [zeroth, first, second] = ["", "'", "''"].map(|primes| g.symbol(&format!("{u}{primes}")));
            let second = self.rate(self.rate(g.derivative(generating, second))?)?;
            let first = self.rate(g.derivative(generating, first))?;
            let kernel = g.sum(&[second, g.neg(first), g.derivative(generating, zeroth)]);
            self.add(&format!("K_{u}"), kernel);
        }
        for (w, p) in &costates {
            let residual = g.add(self.expression(&format!("{p}'"))?, g.derivative(generating, g.symbol(w)));
            self.add(&format!("costate_{w}"), residual);
        }
        self.add("G", generating);
        self.add_variations(&texts(action, "variation")?)
    }

    /// `delta_F`: the derivative of `F` at `ε = 0`, `ε` variations added to varied names and derivatives.
    fn add_variations(&self, variations: &[(String, String)]) -> Result<()> {
        if variations.is_empty() {
            return Ok(());
        }
        let g = &self.graph;
        let step = g.symbol("eps");
        let mut varied = HashMap::new();
        for (name, variation) in variations {
            let orders = if self.functions.contains(name) { 3 } else { 1 };
            for primes in ["", "'", "''"].into_iter().take(orders) {
                let symbol = g.symbol(&format!("{name}{primes}"));
                let change = g.variable(g.symbol(&format!("{variation}{primes}")));
                varied.insert(symbol, g.add(g.variable(symbol), g.mul(g.variable(step), change)));
            }
        }
        let at_zero = HashMap::from([(step, g.zero())]);
        for function in &self.partials {
            let e = g.substitute(self.expression(function)?, &varied);
            let variation = g.substitute(g.derivative(e, step), &at_zero);
            self.add(&format!("delta_{function}"), variation);
        }
        Ok(())
    }
}

/// A list of words.
pub(super) fn words(data: &Table, key: &str) -> Result<Vec<String>> {
    let Some(value) = data.get(key) else { return Ok(Vec::new()) };
    let list = value.as_array().with_context(|| format!("`{key}` has to be a list"))?;
    list.iter()
        .map(|v| v.as_str().map(str::to_string).with_context(|| format!("`{key}` has to be a list of texts")))
        .collect()
}

/// Names with texts, in order.
pub(super) fn texts(data: &Table, key: &str) -> Result<Vec<(String, String)>> {
    let Some(value) = data.get(key) else { return Ok(Vec::new()) };
    let table = value.as_table().with_context(|| format!("`{key}` has to be a table"))?;
    let text = |(name, v): (&String, &Value)| {
        let text = v.as_str().with_context(|| format!("`{key}.{name}` has to be a text"))?;
        Ok((name.clone(), text.to_string()))
    };
    table.iter().map(text).collect()
}
