//! The paper's equations, and what of them holds.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result};
use symbolic::{Expr, Vanishing};
use toml::{Table, Value};

use super::along::along;
use super::context::{Context, texts, words};
use super::geometry;

/// The formulas.
const PAPER: &str = include_str!("../../audit/paper.toml");

/// What is found of an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Says what is meant by something; nothing to check.
    Definition,
    /// Holds as printed.
    Holds,
    /// Holds once a misprint is corrected.
    Misprint,
    /// Holds once it is completed.
    Incomplete,
    /// Neither holds as printed nor as corrected: the audit is wrong, or the equation is.
    Open,
}

impl Verdict {
    /// The verdict in a word.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Definition => "definition",
            Verdict::Holds => "holds",
            Verdict::Misprint => "misprint",
            Verdict::Incomplete => "incomplete",
            Verdict::Open => "open",
        }
    }
}

/// A formula that was checked.
#[derive(Clone, Debug)]
pub struct Line {
    /// The formula as LaTeX.
    pub latex: String,
    /// Whether its residual vanishes.
    pub residual: Vanishing,
}

/// A form of an equation: its formulas with the integrals in them.
#[derive(Clone, Debug, Default)]
pub struct Form {
    /// The formulas.
    pub lines: Vec<Line>,
    /// The integrals as LaTeX, each with its integrand: `J = ∫ … dt`.
    pub integrals: Vec<String>,
}

impl Form {
    /// Whether every residual vanishes.
    pub fn holds(&self) -> bool {
        !self.lines.is_empty() && self.lines.iter().all(|line| line.residual.is_zero())
    }
}

/// Another reading.
#[derive(Clone, Debug)]
pub struct Variant {
    /// What it is.
    pub words: String,
    /// Its formulas.
    pub form: Form,
}

/// What was found of one equation.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The paper's number, or what it is called here.
    pub number: String,
    /// What it is about.
    pub title: String,
    /// The verdict.
    pub verdict: Verdict,
    /// As printed.
    pub printed: Form,
    /// As corrected or completed; empty where it holds as printed.
    pub corrected: Form,
    /// Other readings.
    pub variants: Vec<Variant>,
    /// Largest residuals of the printed and the corrected lines along a computed motion, if checked.
    pub along: Option<[Vec<f64>; 2]>,
    /// Remarks.
    pub note: String,
    /// Where a scanning error is as likely.
    pub scan: String,
}

/// The data, read.
pub struct Paper {
    contexts: BTreeMap<String, Context>,
    equations: Vec<Table>,
    written: Vec<Table>,
}

/// Which formulas of an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// As printed.
    Printed,
    /// As corrected or completed.
    Corrected,
}

/// A context with what code adds to it: `geometry`, `action`.
fn context(data: &Table) -> Result<Context> {
    let context = Context::read(data)?;
    if let Some(name) = data.get("geometry").and_then(Value::as_str) {
        for (name, e) in geometry::definitions(name, &context)? {
            context.add(&name, e);
        }
    }
    if let Some(action) = data.get("action").and_then(Value::as_table) {
        context.add_kernels(action)?;
    }
    Ok(context)
}

impl Paper {
    /// Reads the formulas.
    ///
    /// # Errors
    /// Where the data are faulty.
    pub fn new() -> Result<Paper> {
        let data: Table = PAPER.parse().context("the paper's formulas")?;
        let mut contexts = BTreeMap::new();
        for (name, value) in data.get("context").and_then(Value::as_table).context("no contexts")? {
            let table = value.as_table().with_context(|| format!("context `{name}` has to be a table"))?;
            contexts.insert(name.clone(), context(table).with_context(|| format!("context `{name}`"))?);
        }
        Ok(Paper { contexts, equations: tables(&data, "equation")?, written: tables(&data, "written")? })
    }

    /// Example 3 written out: groups of formulas, each checked.
    ///
    /// # Errors
    /// Where the data are faulty.
    pub fn written(&self) -> Result<Vec<Variant>> {
        self.written.iter().map(|group| self.variant(group)).collect()
    }

    fn variant(&self, variant: &Table) -> Result<Variant> {
        let form = self.form(variant, Which::Printed, &words(variant, "lines")?)?;
        Ok(Variant { words: text(variant, "words").into(), form })
    }

    /// Numbers of the equations, in order.
    pub fn numbers(&self) -> Vec<&str> {
        self.equations.iter().map(|e| text(e, "number")).collect()
    }

    /// A context by name.
    pub(super) fn context(&self, name: &str) -> Result<&Context> {
        self.contexts.get(name).with_context(|| format!("no context `{name}`"))
    }

    /// Checks one equation.
    ///
    /// # Errors
    /// Where its data are faulty.
    pub fn check(&self, number: &str) -> Result<Finding> {
        let equation = self.equation(number)?;
        let printed = self.form(equation, Which::Printed, &self.lines(number, Which::Printed)?)?;
        let corrected = self.form(equation, Which::Corrected, &self.lines(number, Which::Corrected)?)?;
        let verdict = if equation.get("definition").and_then(Value::as_bool) == Some(true) {
            Verdict::Definition
        } else if printed.holds() {
            Verdict::Holds
        } else if !corrected.holds() {
            Verdict::Open
        } else if equation.contains_key("completed") {
            Verdict::Incomplete
        } else {
            Verdict::Misprint
        };
        let mut variants = Vec::new();
        for variant in equation.get("variants").and_then(Value::as_array).into_iter().flatten() {
            let variant = variant.as_table().context("a variant has to be a table")?;
            variants.push(self.variant(variant)?);
        }
        Ok(Finding {
            number: number.into(),
            title: text(equation, "title").into(),
            verdict,
            printed,
            corrected,
            variants,
            along: self.along(number)?,
            note: text(equation, "note").into(),
            scan: text(equation, "scan").into(),
        })
    }

    /// The formulas of an equation, in the scene language.
    ///
    /// # Errors
    /// Where there is no such equation.
    pub fn lines(&self, number: &str, which: Which) -> Result<Vec<String>> {
        let equation = self.equation(number)?;
        match which {
            Which::Printed => words(equation, "printed"),
            Which::Corrected if equation.contains_key("completed") => words(equation, "completed"),
            Which::Corrected => words(equation, "corrected"),
        }
    }

    /// Whether other formulas hold in the place of those of an equation: one answer a line.
    ///
    /// # Errors
    /// Where one cannot be read.
    pub fn try_lines(&self, number: &str, which: Which, lines: &[String]) -> Result<Vec<Vanishing>> {
        let form = self.form(self.equation(number)?, which, lines)?;
        Ok(form.lines.into_iter().map(|line| line.residual).collect())
    }

    fn along(&self, number: &str) -> Result<Option<[Vec<f64>; 2]>> {
        let equation = self.equation(number)?;
        let Some(scene) = equation.get("along").and_then(Value::as_str) else { return Ok(None) };
        let context = self.context(text(equation, "context"))?;
        let residuals = |which| along(context, scene, &self.lines(number, which)?);
        Ok(Some([residuals(Which::Printed)?, residuals(Which::Corrected)?]))
    }

    fn equation(&self, number: &str) -> Result<&Table> {
        self.equations.iter().find(|e| text(e, "number") == number).with_context(|| format!("no equation {number}"))
    }

    fn form(&self, equation: &Table, which: Which, lines: &[String]) -> Result<Form> {
        let corrected = which == Which::Corrected;
        let own = |key: &str| if corrected { equation.get(&format!("corrected_{key}")) } else { None };
        if lines.is_empty() {
            return Ok(Form::default());
        }
        let name = own("context").or(equation.get("context")).and_then(Value::as_str).context("no context")?;
        let mut context = self.context(name)?.clone();
        let key = if own("integrals").is_some() { "corrected_integrals" } else { "integrals" };
        let mut integrals = Vec::new();
        for (name, integrand) in texts(equation, key)? {
            context.add_integral(&name, &integrand);
            let (symbol, integrand) = (context.raw(&name)?, context.raw(&integrand)?);
            let integrand = context.latex(integrand);
            integrals.push(format!(r"{} = \int_{{t_0}}^{{t}} {integrand}\,dt", context.latex(symbol)));
        }
        let constant = equation.get("constant").and_then(Value::as_str);
        if let Some(constant) = constant {
            context.add_constant(constant);
        }
        let truths = words(equation, "truth")?;
        let mut checked = Vec::new();
        for (i, line) in lines.iter().enumerate() {
            let truth = truths.get(i).map_or("", String::as_str);
            let line = check_line(&context, line, truth, constant);
            checked.push(line.with_context(|| format!("{}: `{}`", text(equation, "number"), lines[i]))?);
        }
        Ok(Form { lines: checked, integrals })
    }
}

/// A formula's residual `left − right − truth`; with a constant `C` in it, the rate of the `C` for zero.
fn check_line(context: &Context, line: &str, truth: &str, constant: Option<&str>) -> Result<Line> {
    let g = &context.graph;
    let [left, right] = context.sides(line)?;
    let latex = format!("{} = {}", context.latex(left), context.latex(right));
    let mut residual = context.resolved(g.sub(left, right))?;
    if !truth.is_empty() {
        residual = g.sub(residual, context.expression(truth)?);
    }
    if let Some(constant) = constant {
        let symbol = g.symbol(constant);
        let slope = g.derivative(residual, symbol);
        if !g.is_zero(slope) {
            let rest = g.sub(residual, g.mul(slope, g.variable(symbol)));
            residual = context.rate(g.neg(g.div(without(g, rest, symbol), slope)))?;
        }
    }
    Ok(Line { latex, residual: g.vanishes(context.in_the_end(residual), &Default::default()) })
}

/// `e` with `symbol` put to zero.
fn without(g: &symbolic::Graph, e: Expr, symbol: symbolic::Symbol) -> Expr {
    g.substitute(e, &[(symbol, g.zero())].into())
}

fn text<'a>(table: &'a Table, key: &str) -> &'a str {
    table.get(key).and_then(Value::as_str).unwrap_or("")
}

fn tables(data: &Table, key: &str) -> Result<Vec<Table>> {
    let list = data.get(key).and_then(Value::as_array).with_context(|| format!("no `{key}`"))?;
    let tables: Option<Vec<Table>> = list.iter().map(|e| e.as_table().cloned()).collect();
    tables.with_context(|| format!("`{key}` has to be a list of tables"))
}
