//! Is the action stationary on the motions of (34)? And on those of the statement with `G`?
//!
//! `ẏ = ẋ²/2`, removed by `x = u + ε u̇`, `y = λ = ∫ ẋ²/2 dt`, so `β` contains `ü`; `L = (ẋ² + ẏ² − x² −
//! y²)/2`. Each reading of (34), solved for the highest derivative of `u`, goes back from `P(t₁) = 0`.

use std::collections::HashMap;

use anyhow::{Context as _, Result, anyhow};
use integrate::{DenseOutput, EvaluationError, Options, Problem, Start, integrate};
use mechanics::{ConstantsRule, State};
use motion::{REMOVED_CONSTRAINT, Setting, Settings, TIGHTER, solve};
use scene::Scene;
use symbolic::{Evaluator, Expr, Symbol};

use super::action::{Action, BUMPS, Jet, bump};
use super::context::Context;
use super::paper::Paper;
use random::equations;

/// Readings of (34), each as what has to be zero, with `P = C − ∫ L_λ dt`. (The fourth, second operator on
/// `L` and first on `β`, divides by `P`, which is zero at `t₁`.)
const READINGS: [(&str, &str); 4] = [
    (STATEMENT, "K_u"),
    ("(34), first operator on L, second on β", "L_u2'' - L_u1' + L_u0 - P*(beta_u1' - beta_u0) + beta_u1*L_lambda"),
    ("(34), first operator on both", "L_u2'' - L_u1' + L_u0 - P*(beta_u2'' - beta_u1' + beta_u0) + beta_u1*L_lambda"),
    ("(34), second operator on both", "L_u1' - L_u0 - P*(beta_u1' - beta_u0) + beta_u1*L_lambda"),
];

/// The statement with `G`.
pub const STATEMENT: &str = "the statement with G";

const EPSILON: f64 = 0.5;
const SPAN: [f64; 2] = [0.0, 1.0];
/// `u, u̇, ü, u⃛` and `λ` at `t₁`.
const END: [f64; 4] = [0.4, 0.7, -0.5, 0.3];
const LAMBDA: f64 = 0.6;

/// What was found of one reading.
#[derive(Clone, Debug)]
pub struct Reading {
    /// Its name.
    pub name: &'static str,
    /// Order of its differential equation.
    pub order: usize,
    /// `dI/dε` for every variation.
    pub derivatives: Vec<f64>,
}

impl Reading {
    /// The largest derivative of the action.
    pub fn largest(&self) -> f64 {
        self.derivatives.iter().fold(0.0, |a, d| a.max(d.abs()))
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Stationarity {
    /// Every reading, the statement with `G` first.
    pub readings: Vec<Reading>,
    /// Largest difference of `x`, `y` between this statement's motion and that of `removed-constraint`.
    pub gap: f64,
    /// `dI/dε` of example 1's sledge: measured, by printed and by corrected kernels of `δI`, per variation.
    pub sledge: Vec<[f64; 3]>,
}

impl Stationarity {
    /// Integrates every reading and perturbs the action on each motion.
    ///
    /// # Errors
    /// Where a motion cannot be computed.
    pub fn new(paper: &Paper) -> Result<Stationarity> {
        let context = paper.context("stationarity")?;
        let constants = HashMap::from([(context.graph.symbol("epsilon"), EPSILON)]);
        let mut readings = Vec::new();
        let mut gap = f64::NAN;
        for (name, text) in READINGS {
            let mut law = Law::new(context, text, &constants)?;
            let motion = law.integrate().with_context(|| name.to_string())?;
            let order = law.order;
            let mut action = Action::new(context, "L", &["u"], &["lambda"], &constants)?;
            let start = law.at(&motion, SPAN[0])?;
            action.start = vec![start.lambda];
            let law = std::cell::RefCell::new(law);
            let curve = |t: f64| vec![law.borrow_mut().at(&motion, t).map_or([f64::NAN; 3], |point| point.jet)];
            let derivatives =
                (0..BUMPS).map(|k| action.derivative(&curve, &|t| vec![bump(k, SPAN, t)], SPAN)).collect::<Vec<f64>>();
            if name == STATEMENT {
                gap = gap_to_derivation(context, &mut law.borrow_mut(), &motion, &constants)?;
            }
            readings.push(Reading { name, order, derivatives });
        }
        Ok(Stationarity { readings, gap, sledge: sledge(paper)? })
    }
}

/// An equation for the highest derivative of `u`, with `λ̇ = β` and `Ṗ = −L_λ`: state `(u, u̇, …, λ, P)`.
struct Law {
    /// The highest derivative in it.
    order: usize,
    evaluator: Evaluator<f64>,
    inputs: Vec<Symbol>,
}

/// A point of a motion.
struct Point {
    jet: Jet,
    lambda: f64,
}

impl Law {
    fn new(context: &Context, text: &str, constants: &HashMap<Symbol, f64>) -> Result<Law> {
        let g = &context.graph;
        let residual = context.expression(text)?;
        let derivative = |k: usize| g.symbol(&format!("u{}", "'".repeat(k)));
        let order = (2..=4).rev().find(|&k| g.depends_on(residual, derivative(k))).context("no equation for u")?;
        let highest = derivative(order);
        let slope = g.derivative(residual, highest);
        let rest = g.substitute(residual, &HashMap::from([(highest, g.zero())]));
        let solved = g.neg(g.div(rest, slope));
        let mut inputs: Vec<Symbol> = (0..order).map(derivative).collect();
        inputs.extend([g.symbol("lambda"), g.symbol("P")]);
        let mut outputs: Vec<Expr> = (1..order).map(|k| g.variable(derivative(k))).collect();
        outputs.extend([solved, context.expression("lambda'")?, context.expression("P'")?]);
        // an equation of order 2 has its own ü in β
        let outputs = g.substitute_all(&outputs, &HashMap::from([(highest, solved)]));
        let tape = g.compile(&inputs, &outputs, constants)?;
        Ok(Law { order, evaluator: Evaluator::new(tape), inputs })
    }

    fn integrate(&mut self) -> Result<DenseOutput> {
        let mut y = END[..self.order].to_vec();
        y.extend([LAMBDA, 0.0]);
        let options = Options::with_tolerance(TIGHTER * Settings::default().tolerance);
        let solution = integrate(self, &Start { t: SPAN[1], y }, SPAN[0], &options).map_err(|e| anyhow!("{e}"))?;
        match solution.status {
            integrate::Status::Stopped { t, cause } => Err(anyhow!("stopped at {t}: {cause}")),
            _ => Ok(solution.dense),
        }
    }

    fn at(&mut self, motion: &DenseOutput, t: f64) -> Result<Point> {
        let mut y = vec![0.0; self.inputs.len()];
        motion.evaluate(t, &mut y);
        let mut rates = vec![0.0; y.len()];
        self.rates(t, &y, &mut rates)?;
        let second = if self.order > 2 { y[2] } else { rates[1] };
        Ok(Point { jet: [y[0], y[1], second], lambda: y[self.order] })
    }
}

impl Problem for Law {
    fn dimension(&self) -> usize {
        self.inputs.len()
    }
    fn rates(&mut self, _t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        rates.copy_from_slice(self.evaluator.evaluate(y));
        Ok(())
    }
}

/// The same system as a scene.
const SCENE: &str = include_str!("second-order.toml");

/// Distance of this motion from that of `removed-constraint` with the same start and constants.
fn gap_to_derivation(
    context: &Context,
    law: &mut Law,
    motion: &DenseOutput,
    constants: &HashMap<Symbol, f64>,
) -> Result<f64> {
    let g = &context.graph;
    let mut y = vec![0.0; law.inputs.len()];
    motion.evaluate(SPAN[0], &mut y);
    let mut values = constants.clone();
    values.extend(law.inputs.iter().copied().zip(y));
    let number = |text: &str| -> Result<f64> { Ok(g.evaluate(context.expression(text)?, &values)?) };
    // p = G_u̇ − d/dt G_ü
    let generating = context.expression("G")?;
    let second = context.rate(g.derivative(generating, g.symbol("u''")))?;
    let momentum = g.evaluate(g.sub(g.derivative(generating, g.symbol("u'")), second), &values)?;
    let constants = ConstantsRule::Given(vec![number("P")?, momentum]);
    let mut scene = Scene::parse("second-order", SCENE).map_err(|e| anyhow!("{e}"))?;
    let speed = number("x'")?;
    scene.start = State { t: SPAN[0], q: vec![number("x")?, number("lambda")?], v: vec![speed, speed * speed / 2.0] };
    let equations = equations(&scene.system, REMOVED_CONSTRAINT, scene.removals.first())?;
    let setting = Setting { system: &scene.system, start: &scene.start, end: SPAN[1] };
    let mut derived = solve(setting, equations, &constants, &Settings::default())?;
    let mut gap = 0.0_f64;
    for t in derived.grid(40) {
        let point = law.at(motion, t)?;
        let q = derived.at(t)?.coordinates;
        let x = point.jet[0] + EPSILON * point.jet[1];
        gap = gap.max((q[0] - x).abs()).max((q[1] - point.lambda).abs());
    }
    Ok(gap)
}

/// Some curve of the sledge, `u = sin t + t²/2`, `φ = 0.3 + t − t³/5`.
fn some_curve(t: f64) -> Vec<Jet> {
    vec![[t.sin() + t * t / 2.0, t.cos() + t, 1.0 - t.sin()], [0.3 + t - t.powi(3) / 5.0, 1.0 - 0.6 * t * t, -1.2 * t]]
}

/// `dI/dε` of example 1 along that curve: measured, and by the kernels of `δI`.
fn sledge(paper: &Paper) -> Result<Vec<[f64; 3]>> {
    let context = paper.context("sledge")?;
    let g = &context.graph;
    let numbers = [("g", 9.81), ("alpha", 0.4), ("k", 0.7), ("x0", 0.2), ("y0", 0.0), ("t1", SPAN[1])];
    let constants: HashMap<Symbol, f64> = numbers.iter().map(|&(name, x)| (g.symbol(name), x)).collect();
    let mut action = Action::new(context, "L", &["u", "phi"], &["lambda"], &constants)?;
    let kernels = |which| -> Result<Vec<String>> {
        let lines = paper.lines("δI", which)?;
        Ok(lines.iter().filter_map(|line| Some(line.split_once('=')?.1.to_string())).collect())
    };
    let printed = kernels(super::paper::Which::Printed)?;
    let corrected = kernels(super::paper::Which::Corrected)?;
    let mut found = Vec::new();
    for k in 0..BUMPS {
        // both vary, each in its own way
        let variation = move |t: f64| vec![bump(k, SPAN, t), bump((k + 1) % BUMPS, SPAN, t)];
        let measured = action.derivative(&some_curve, &variation, SPAN);
        let mut row = [measured, 0.0, 0.0];
        for (entry, kernels) in row[1..].iter_mut().zip([&printed, &corrected]) {
            let [u, phi] = &kernels[..] else { return Err(anyhow!("two kernels")) };
            let mut first = Action::new(context, u, &["u", "phi"], &[], &constants)?;
            let mut second = Action::new(context, phi, &["u", "phi"], &[], &constants)?;
            let weigh = |i: usize| move |t: f64| variation(t)[i][0];
            *entry = first.weighted(&some_curve, &weigh(0), SPAN) + second.weighted(&some_curve, &weigh(1), SPAN);
        }
        found.push(row);
    }
    Ok(found)
}
