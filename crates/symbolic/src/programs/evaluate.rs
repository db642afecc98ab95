//! From expressions to values.

use super::lower;
use crate::programs::program::{Id, Program};
use crate::programs::tape::Tape;
use crate::series::{SeriesInput, SeriesTape, build};
use crate::store::arena::{Arena, Node};
use crate::store::number::Number;
use crate::{Evaluator, Expr, Function, Graph, Symbol};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::HashMap;
use std::sync::Arc;

/// Why an expression cannot be evaluated.
///
/// ```
/// use std::collections::HashMap;
/// use symbolic::{CompileError, Graph};
/// let g = Graph::new();
/// let x = g.variable(g.symbol("x"));
/// let error = g.evaluate(x, &HashMap::new());
/// assert_eq!(error, Err(CompileError::Unbound { name: "x".into() }));
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum CompileError {
    /// A symbol that is neither input nor constant.
    #[error("`{name}` has no value: it is neither an input nor a constant")]
    Unbound { name: String },
    /// A part that depends on no input and is not a finite number.
    #[error("`{expression}` is not finite")]
    NotFinite {
        /// That part, with the constants in it; cut if it is long.
        expression: String,
    },
}

impl Graph {
    /// A flat program for `outputs`. `constants` are folded in; a symbol that is both is an input.
    ///
    /// # Errors
    /// If a symbol is neither input nor constant, or something is not finite whatever the inputs.
    pub fn compile(
        &self,
        inputs: &[Symbol],
        outputs: &[Expr],
        constants: &HashMap<Symbol, f64>,
    ) -> Result<Tape, CompileError> {
        self.compile_with(inputs, &[], outputs, constants)
    }

    /// [`Graph::compile`] without constants, to be shared by evaluators in numbers of several kinds.
    ///
    /// # Errors
    /// As [`Graph::compile`].
    pub fn tape(&self, inputs: &[Symbol], outputs: &[Expr]) -> Result<Arc<Tape>, CompileError> {
        Ok(Arc::new(self.compile(inputs, outputs, &HashMap::new())?))
    }

    /// [`Graph::compile`] with intermediate quantities: each of `definitions` is computed once, from inputs,
    /// constants and earlier definitions, and stands under its symbol for the later ones and the outputs. So
    /// a long recursion keeps its length, whatever it would be with everything put in.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// let g = symbolic::Graph::new();
    /// let (x, s) = (g.symbol("x"), g.symbol("s"));
    /// let square = g.powi(g.variable(x), 2);
    /// let outputs = [g.add(g.variable(s), g.one())];
    /// let tape = g.compile_with(&[x], &[(s, square)], &outputs, &HashMap::new())?;
    /// let mut y = [0.0];
    /// tape.evaluate(&[3.0], &mut tape.workspace(), &mut y);
    /// assert_eq!(y, [10.0]);
    /// # Ok::<(), symbolic::CompileError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Graph::compile`]; a definition that is used before its place has no value there.
    pub fn compile_with(
        &self,
        inputs: &[Symbol],
        definitions: &[(Symbol, Expr)],
        outputs: &[Expr],
        constants: &HashMap<Symbol, f64>,
    ) -> Result<Tape, CompileError> {
        self.lowered(inputs, definitions, outputs, constants, |mut program, ids| {
            program.fuse(ids);
            Tape::assemble(&program, inputs.len(), ids)
        })
    }

    /// Taylor coefficients of `outputs`, and residuals of implicit equations (`blocks`), along a motion.
    ///
    /// `inputs` says what each symbol is as a function of time; states are integrated by the way. Definitions
    /// and constants are as in [`Graph::compile_with`]. `derivatives`: definitions that are time derivatives
    /// along the motion, with what they are derivatives of.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// use symbolic::{Graph, SeriesInput};
    /// let g = Graph::new();
    /// let x = g.symbol("x");
    /// let rate = g.powi(g.variable(x), 2); // x' = x², x(0) = 1: x = 1/(1 − t)
    /// let tape = g.compile_series(&[(x, SeriesInput::State(0))], &[], &[rate], &[], &[], &HashMap::new())?;
    /// let mut workspace = tape.workspace::<f64>(5);
    /// tape.expand(&[1.0], 1.0, &mut workspace, 0, &mut |_, _| {});
    /// assert_eq!(tape.input(0, &workspace), Some(&[1.0; 6][..]));
    /// # Ok::<(), symbolic::CompileError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Graph::compile_with`].
    ///
    /// # Panics
    /// If an input is the state of an output, or the unknown of a block, that is not there.
    pub fn compile_series(
        &self,
        inputs: &[(Symbol, SeriesInput)],
        definitions: &[(Symbol, Expr)],
        outputs: &[Expr],
        blocks: &[Vec<Expr>],
        derivatives: &[(Symbol, Expr)],
        constants: &HashMap<Symbol, f64>,
    ) -> Result<SeriesTape, CompileError> {
        let (symbols, kinds): (Vec<Symbol>, Vec<SeriesInput>) = inputs.iter().copied().unzip();
        let sizes: Vec<usize> = blocks.iter().map(Vec::len).collect();
        let mut all: Vec<Expr> = outputs.iter().chain(blocks.iter().flatten()).copied().collect();
        let count = all.len();
        all.extend(derivatives.iter().flat_map(|&(symbol, of)| [self.variable(symbol), of]));
        let mut series = None;
        self.lowered(&symbols, definitions, &all, constants, |program, ids| {
            let (ids, declared) = ids.split_at(count);
            let declared = declared.as_chunks().0.iter().map(|&[derivative, of]| (derivative, of));
            let tape = series.insert(build::build(program, &kinds, ids, outputs.len(), &sizes, declared));
            tape.first.clone()
        })?;
        Ok(series.expect("made where the program was lowered"))
    }

    /// What `assemble` makes of the program that computes `outputs`.
    fn lowered(
        &self,
        inputs: &[Symbol],
        definitions: &[(Symbol, Expr)],
        outputs: &[Expr],
        constants: &HashMap<Symbol, f64>,
        assemble: impl FnOnce(Program, &[Id]) -> Tape,
    ) -> Result<Tape, CompileError> {
        let (symbols, defined): (Vec<Symbol>, Vec<Expr>) = definitions.iter().copied().unzip();
        let originals = [&defined[..], outputs].concat();
        let known: FxHashSet<Symbol> = inputs.iter().chain(&symbols).copied().collect();
        let mut values = self.as_numbers(constants);
        values.retain(|s, _| !known.contains(s));
        let folded = self.substituted(&originals, &values);
        let mut bound: FxHashSet<Symbol> = inputs.iter().copied().collect();
        for (i, e) in folded[..symbols.len()].iter().enumerate() {
            self.check_bound(&[*e], |s| bound.contains(&s))?;
            bound.insert(symbols[i]);
        }
        self.check_bound(&folded[symbols.len()..], |s| bound.contains(&s))?;
        let arena = self.arena.borrow();
        for (e, original) in folded.iter().zip(&originals) {
            if let Some(n) = arena.as_number(*e)
                && !n.is_finite()
            {
                drop(arena);
                return Err(self.not_finite(*original));
            }
        }
        let (defined, results) = folded.split_at(symbols.len());
        let definitions: Vec<(Symbol, Expr)> = symbols.into_iter().zip(defined.iter().copied()).collect();
        let (program, ids) = lower::lower(&arena, inputs, &definitions, results);
        let tape = assemble(program, &ids);
        // An intermediate power may overflow where its reciprocal is zero: the expressions decide.
        if !tape.workspace::<f64>().is_finite() {
            let constant = |e: Expr| arena.dependencies(e).is_empty();
            let culprit = arena
                .reachable(&folded, |_| true)
                .into_iter()
                .find(|e| constant(*e) && !arena.constant_value(*e).is_finite());
            if let Some(culprit) = culprit {
                drop(arena);
                return Err(self.not_finite(culprit));
            }
        }
        Ok(tape)
    }

    /// The constants as expressions, in the order of their symbols, so that every run has the same nodes.
    pub(crate) fn as_numbers(&self, constants: &HashMap<Symbol, f64>) -> HashMap<Symbol, Expr> {
        let mut ordered: Vec<(Symbol, f64)> = constants.iter().map(|(&s, &x)| (s, x)).collect();
        ordered.sort_by_key(|(s, _)| *s);
        ordered.into_iter().map(|(s, x)| (s, self.number(x))).collect()
    }

    /// The value of `e`. Slow: for single values.
    ///
    /// # Errors
    /// If a symbol has no value, or the value is not finite.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// let g = symbolic::Graph::new();
    /// let x = g.symbol("x");
    /// let e = g.powi(g.variable(x), -1);
    /// assert_eq!(g.evaluate(e, &HashMap::from([(x, 4.0)])), Ok(0.25));
    /// assert!(g.evaluate(e, &HashMap::from([(x, 0.0)])).is_err());
    /// ```
    pub fn evaluate(&self, e: Expr, values: &HashMap<Symbol, f64>) -> Result<f64, CompileError> {
        self.check_bound(&[e], |s| values.contains_key(&s))?;
        let arena = self.arena.borrow();
        let mut known: FxHashMap<Expr, f64> = FxHashMap::default();
        let mut overflown = None;
        for n in arena.reachable(&[e], |_| true) {
            let value = match arena.node(n) {
                Node::Symbol(s) => values[s],
                _ => arena.value(n, &known),
            };
            if !value.is_finite() {
                let grows =
                    |n: &Expr| matches!(arena.node(*n), Node::Call(Function::Exp | Function::Cosh | Function::Sinh, _));
                if !arena.reachable(&[n], |_| true).iter().any(grows) {
                    drop(arena);
                    return Err(self.not_finite(n));
                }
                overflown.get_or_insert(n);
            }
            known.insert(n, value);
        }
        drop(arena);
        let Some(culprit) = overflown else { return Ok(known[&e]) };
        // what overflows may stand in a quotient that does not
        let inputs: Vec<(Symbol, f64)> = values.iter().map(|(s, x)| (*s, *x)).collect();
        let symbols: Vec<Symbol> = inputs.iter().map(|(s, _)| *s).collect();
        let numbers: Vec<f64> = inputs.iter().map(|(_, x)| *x).collect();
        let mut value = Evaluator::new(self.compile(&symbols, &[e], &HashMap::new())?);
        let value = value.evaluate(&numbers)[0];
        if value.is_finite() { Ok(value) } else { Err(self.not_finite(culprit)) }
    }

    pub(crate) fn check_bound(&self, es: &[Expr], bound: impl Fn(Symbol) -> bool) -> Result<(), CompileError> {
        match self.symbols_of_all(es).into_iter().find(|s| !bound(*s)) {
            Some(s) => Err(CompileError::Unbound { name: self.name(s) }),
            None => Ok(()),
        }
    }

    fn not_finite(&self, e: Expr) -> CompileError {
        let mut expression = if self.size(&[e]) > 50 { "…".to_owned() } else { self.plain(e) };
        if let Some((end, _)) = expression.char_indices().nth(100) {
            expression.truncate(end);
            expression.push('…');
        }
        CompileError::NotFinite { expression }
    }
}

impl Arena {
    /// The value of one node from those of its children; children that are missing must be constant.
    fn value(&self, e: Expr, known: &FxHashMap<Expr, f64>) -> f64 {
        let of = |c: &Expr| match known.get(c) {
            Some(x) => *x,
            None => self.constant_value(*c),
        };
        match self.node(e) {
            Node::Number(n) => n.to_f64(),
            Node::Symbol(_) => f64::NAN,
            Node::Sum(constant, terms) => {
                constant.to_f64() + terms.iter().map(|(t, c)| c.to_f64() * of(t)).sum::<f64>()
            }
            Node::Product(factors) => factors
                .iter()
                .map(|(b, r)| match r.as_integer().and_then(|n| i32::try_from(n).ok()) {
                    Some(n) => of(b).powi(n),
                    None => of(b).powf(r.to_f64()),
                })
                .product(),
            Node::Power(base, exponent) => of(base).powf(of(exponent)),
            Node::Call(function, argument) => function.apply(of(argument)),
            Node::Atan2(y, x) => of(y).atan2(of(x)),
        }
    }

    /// The value of an expression without symbols.
    fn constant_value(&self, e: Expr) -> f64 {
        if let Some(n) = self.as_number(e) {
            return Number::to_f64(n);
        }
        let mut known = FxHashMap::default();
        for n in self.reachable(&[e], |_| true) {
            let value = self.value(n, &known);
            known.insert(n, value);
        }
        known[&e]
    }
}
