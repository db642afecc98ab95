//! From the graph to a straight-line program.

mod scaled;

use crate::Expr;
use crate::Symbol;
use crate::programs::program::{Id, Program, Value};
use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
use rustc_hash::FxHashMap;

/// The program that computes `outputs` by way of `definitions`, and the value of each output.
pub(crate) fn lower(
    arena: &Arena,
    inputs: &[Symbol],
    definitions: &[(Symbol, Expr)],
    outputs: &[Expr],
) -> (Program, Vec<Id>) {
    let (symbols, values) = (FxHashMap::default(), FxHashMap::default());
    let mut lowering = Lowering { arena, program: Program::default(), symbols, values };
    for (i, s) in inputs.iter().enumerate() {
        let index = u32::try_from(i).expect("fewer than 2^32 inputs");
        let input = lowering.program.push(Value::Input(index));
        lowering.symbols.entry(*s).or_insert(Parts::of(input));
    }
    for (symbol, e) in definitions {
        lowering.nodes(&[*e]);
        let parts = lowering.values[e];
        lowering.symbols.entry(*symbol).or_insert(parts);
    }
    lowering.nodes(outputs);
    let outputs = outputs.iter().map(|e| lowering.whole(*e)).collect();
    (lowering.program, outputs)
}

/// A value and whether it is to be negated.
pub(super) type Signed = (bool, Id);

/// A value as constant · varying; either may be absent, for 1.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    pub(super) constant: Option<Id>,
    pub(super) varying: Option<Id>,
}

impl Parts {
    fn of(varying: Id) -> Self {
        Self { constant: None, varying: Some(varying) }
    }
}

pub(super) struct Lowering<'a> {
    pub(super) arena: &'a Arena,
    pub(super) program: Program,
    symbols: FxHashMap<Symbol, Parts>,
    values: FxHashMap<Expr, Parts>,
}

impl Lowering<'_> {
    fn nodes(&mut self, roots: &[Expr]) {
        let open = self.arena.reachable(roots, |e| !self.values.contains_key(&e));
        self.values.reserve(open.len());
        self.program.reserve(open.len());
        for e in open {
            let parts = self.node(e);
            self.values.insert(e, parts);
        }
    }

    pub(super) fn whole(&mut self, e: Expr) -> Id {
        match self.values[&e] {
            Parts { constant: None, varying: None } => self.program.constant(Number::ONE),
            Parts { constant: Some(v), varying: None } | Parts { constant: None, varying: Some(v) } => v,
            Parts { constant: Some(a), varying: Some(b) } => self.program.push(Value::Mul(a, b)),
        }
    }

    fn parts(&self, v: Id) -> Parts {
        if self.program.is_constant(v) { Parts { constant: Some(v), varying: None } } else { Parts::of(v) }
    }

    fn node(&mut self, e: Expr) -> Parts {
        let arena = self.arena;
        let v = match arena.node(e) {
            Node::Number(n) => self.program.constant(*n),
            Node::Symbol(s) => return self.symbols[s],
            Node::Sum(constant, terms) => self.sum(*constant, terms),
            Node::Product(factors) => return self.product(factors),
            Node::Power(base, exponent) => {
                let (base, exponent) = (self.whole(*base), self.whole(*exponent));
                self.program.push(Value::Pow(base, exponent))
            }
            Node::Call(function, argument) => {
                let argument = self.whole(*argument);
                self.program.push(Value::Call(*function, argument))
            }
            Node::Atan2(y, x) => {
                let (y, x) = (self.whole(*y), self.whole(*x));
                self.program.push(Value::Atan2(y, x))
            }
        };
        self.parts(v)
    }

    /// Σ c·t, terms with the same |c| added up before c is multiplied.
    fn sum(&mut self, constant: Number, terms: &[(Expr, Number)]) -> Id {
        if let [(t, c)] = terms
            && let (Some(place), Parts { constant: None, varying: Some(x) }) = (place(constant, *c), self.values[t])
        {
            let place = self.program.constant(place);
            let distance = self.program.push(Value::Sub(x, place));
            let factor = self.program.constant(*c);
            return self.program.push(Value::Mul(factor, distance));
        }
        let mut groups: Vec<(Option<Id>, Vec<Signed>)> = Vec::new();
        let mut rest: Vec<Signed> = Vec::new();
        for (t, c) in terms {
            let parts = self.values[t];
            let scale = self.scaled(c.abs(), parts.constant);
            let Some(varying) = parts.varying else {
                rest.push((c.is_negative(), self.or_one(scale)));
                continue;
            };
            let term = (c.is_negative(), varying);
            match groups.iter_mut().find(|(known, _)| *known == scale) {
                Some((_, members)) => members.push(term),
                None => groups.push((scale, vec![term])),
            }
        }
        if !constant.is_zero() {
            rest.push((constant.is_negative(), self.program.constant(constant.abs())));
        }
        let mut total: Vec<Signed> = Vec::new();
        for (scale, members) in groups {
            let (negative, value) = match scale {
                // Without a factor the terms are just terms of the whole sum.
                None => {
                    total.extend(members);
                    continue;
                }
                Some(scale) => {
                    let (negative, value) = self.signed_sum(&members);
                    (negative, self.program.push(Value::Mul(scale, value)))
                }
            };
            total.push((negative, value));
        }
        if !rest.is_empty() {
            total.push(self.signed_sum(&rest));
        }
        match self.signed_sum(&total) {
            (false, v) => v,
            (true, v) => self.program.push(Value::Neg(v)),
        }
    }

    /// Σ ±v as (is it to be negated?, value): it starts with a positive term where there is one.
    pub(super) fn signed_sum(&mut self, terms: &[Signed]) -> Signed {
        let first = terms.iter().position(|(negative, _)| !negative);
        let all_negative = first.is_none();
        let first = first.unwrap_or(0);
        let mut value = terms[first].1;
        for (i, (negative, v)) in terms.iter().enumerate() {
            if i != first {
                value = self.program.push(if *negative != all_negative {
                    Value::Sub(value, *v)
                } else {
                    Value::Add(value, *v)
                });
            }
        }
        (all_negative, value)
    }

    fn scaled(&mut self, c: Number, constant: Option<Id>) -> Option<Id> {
        if c.is_one() {
            return constant;
        }
        let c = self.program.constant(c);
        Some(match constant {
            Some(k) => self.program.push(Value::Mul(c, k)),
            None => c,
        })
    }

    fn or_one(&mut self, v: Option<Id>) -> Id {
        v.unwrap_or_else(|| self.program.constant(Number::ONE))
    }

    pub(super) fn product(&mut self, factors: &[(Expr, Rational)]) -> Parts {
        let mut sides = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
        for (v, exponent) in self.scaled_factors(factors) {
            let side = 2 * usize::from(self.program.is_constant(v)) + usize::from(exponent.is_negative());
            let power = self.positive_power(v, exponent);
            sides[side].push(power);
        }
        let [above, below, constant_above, constant_below] = sides;
        Parts { constant: self.quotient(&constant_above, &constant_below), varying: self.quotient(&above, &below) }
    }

    fn quotient(&mut self, above: &[Id], below: &[Id]) -> Option<Id> {
        let mut multiply = |factors: &[Id]| factors.iter().copied().reduce(|a, b| self.program.push(Value::Mul(a, b)));
        match (multiply(above), multiply(below)) {
            (above, None) => above,
            (None, Some(b)) => Some(self.program.push(Value::Recip(b))),
            (Some(a), Some(b)) => Some(self.program.push(Value::Div(a, b))),
        }
    }

    /// v to the absolute value of a non-zero exponent
    pub(super) fn positive_power(&mut self, v: Id, exponent: Rational) -> Id {
        let (n, d) = (exponent.numerator().unsigned_abs(), exponent.denominator());
        match d {
            1 => self.program.powi(v, n),
            2 => {
                let root = self.program.push(Value::Sqrt(v));
                if n == 1 {
                    return root;
                }
                let whole = self.program.powi(v, n / 2);
                self.program.push(Value::Mul(whole, root))
            }
            _ => {
                let exponent = if exponent.is_negative() { exponent.neg() } else { exponent };
                let exponent = self.program.constant(Number::Exact(exponent));
                self.program.push(Value::Pow(v, exponent))
            }
        }
    }
}

/// The place `p` of `k + c x = c (x − p)`, where it is a decimal of a few digits and `c` no sign, or where
/// `c` is large: what is far from the origin and narrow, as `(t − 1000007)/0.01`, loses nothing where `x` is
/// near. Exact numbers stay exact.
fn place(k: Number, c: Number) -> Option<Number> {
    const DIGITS: i64 = 1_000_000_000_000;
    const NARROW: f64 = 1e3;
    let place = k.mul(c.recip()).neg();
    let is_narrow = c.to_f64().abs() >= NARROW && place.to_f64().is_normal();
    match place {
        Number::Exact(r) if !r.is_zero() && !c.abs().is_one() && DIGITS % r.denominator() == 0 => Some(place),
        Number::Float(_) if k.is_exact() && c.is_exact() => None,
        _ => is_narrow.then_some(place),
    }
}
