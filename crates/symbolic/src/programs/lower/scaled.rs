//! Products of factors that overflow, written in functions that do not.

use super::{Lowering, Signed};
use crate::programs::program::{Id, Value};
use crate::programs::saturate::{Group, Scale, ScaledFactor, ScaledTerm, Unit};
use crate::store::number::{Number, Rational};
use crate::{Expr, Function};

impl Lowering<'_> {
    /// The factors as values, those of a group ([`Group`]) scaled.
    pub(super) fn scaled_factors(&mut self, factors: &[(Expr, Rational)]) -> Vec<(Id, Rational)> {
        let mut values = Vec::new();
        let mut taken = vec![false; factors.len()];
        for group in self.arena.saturating_groups(factors) {
            for factor in &group.factors {
                taken[factor.place] = true;
                if let Some(v) = self.scaled_factor(&group, factor) {
                    values.push((v, factor.exponent));
                }
            }
            self.in_front(&group, &mut values);
        }
        let rest: Vec<_> = factors.iter().zip(taken).filter(|(_, taken)| !taken).map(|(factor, _)| *factor).collect();
        values.extend(rest.into_iter().map(|(base, exponent)| (self.whole(base), exponent)));
        values
    }

    /// Σ aⱼ σ(g)^(j−l) σ(−g)^(h−j), or Σ a tanhʲ g / cosh^(h−j) g; `None` for 1.
    fn scaled_factor(&mut self, group: &Group, factor: &ScaledFactor) -> Option<Id> {
        let (low, high) = factor.ends(group.scale);
        if let [a, b] = &factor.terms[..]
            && (group.scale, high - low) == (Scale::Logistic, 1)
            && a.degrees != b.degrees
            && a.number == b.number
            && a.rest.is_empty()
            && b.rest.is_empty()
        {
            // σ(g) + σ(−g) = 1
            return (!a.number.is_one()).then(|| self.program.constant(a.number));
        }
        let terms: Vec<Signed> = factor.terms.iter().map(|term| self.scaled_term(group, term, low, high)).collect();
        if let [term] = &factor.terms[..]
            && term.number.is_one()
            && term.rest.is_empty()
            && term.degrees.sinh == 0
            && (group.scale == Scale::Logistic || term.degrees.exp == 0)
        {
            return None;
        }
        Some(match self.signed_sum(&terms) {
            (false, v) => v,
            (true, v) => self.program.push(Value::Neg(v)),
        })
    }

    fn scaled_term(&mut self, group: &Group, term: &ScaledTerm, low: i64, high: i64) -> Signed {
        let mut factors = Vec::new();
        if !term.number.abs().is_one() {
            factors.push(self.program.constant(term.number.abs()));
        }
        if !term.rest.is_empty() {
            let rest = self.product(&term.rest);
            factors.extend([rest.constant, rest.varying].into_iter().flatten());
        }
        let degrees = term.degrees;
        let powers = match group.scale {
            Scale::Logistic => {
                let [above, below] = self.logistics(group.unit, 1);
                vec![(above, degrees.exp - low), (below, high - degrees.exp)]
            }
            Scale::Hyperbolic => {
                let mut powers = vec![(self.sech(group.unit), high - degrees.growth())];
                if degrees.sinh > 0 {
                    let unit = self.whole(group.unit.0);
                    powers.push((self.program.push(Value::Call(Function::Tanh, unit)), degrees.sinh));
                }
                if degrees.exp != 0 {
                    let [above, below] = self.logistics(group.unit, 2);
                    let two = self.program.constant(Number::integer(2));
                    let twice = self.program.push(Value::Mul(two, if degrees.exp > 0 { above } else { below }));
                    powers.push((twice, degrees.exp.abs()));
                }
                powers
            }
        };
        for (v, n) in powers.into_iter().filter(|(_, n)| *n > 0) {
            factors.push(self.program.powi(v, n.unsigned_abs()));
        }
        let product = factors.into_iter().reduce(|a, b| self.program.push(Value::Mul(a, b)));
        (term.number.is_negative(), product.unwrap_or_else(|| self.program.constant(Number::ONE)))
    }

    /// The powers that stand before the sums; what grows is a power of `exp g` or `cosh g`.
    fn in_front(&mut self, group: &Group, values: &mut Vec<(Id, Rational)>) {
        let mut push = |v: Id, exponent: Rational| {
            if !exponent.is_zero() {
                values.push((v, exponent));
            }
        };
        let [first, second] = group.powers;
        if group.scale == Scale::Hyperbolic {
            if first.is_negative() {
                let unit = self.whole(group.unit.0);
                push(self.program.push(Value::Call(Function::Cosh, unit)), first.neg());
            } else {
                push(self.sech(group.unit), first);
            }
            return;
        }
        let [above, below] = self.logistics(group.unit, 1);
        let both = first.add(second).unwrap_or(Rational::integer(0));
        if second.is_negative() {
            push(above, both);
            push(self.exponential(group.unit, second.neg()), Rational::ONE);
        } else if first.is_negative() {
            push(below, both);
            push(self.exponential(group.unit, first), Rational::ONE);
        } else {
            push(above, first);
            push(below, second);
        }
    }

    /// exp(r g)
    fn exponential(&mut self, unit: Unit, r: Rational) -> Id {
        let argument = self.multiple(unit, r);
        self.program.push(Value::Call(Function::Exp, argument))
    }

    fn sech(&mut self, (unit, _): Unit) -> Id {
        let unit = self.whole(unit);
        self.program.push(Value::Sech(unit))
    }

    /// σ(n g) and σ(−n g)
    fn logistics(&mut self, unit: Unit, n: i64) -> [Id; 2] {
        let argument = self.multiple(unit, Rational::integer(n));
        let opposite = match self.program.value(argument) {
            Value::Neg(a) => a,
            _ => self.program.push(Value::Neg(argument)),
        };
        [argument, opposite].map(|a| self.program.push(Value::Logistic(a)))
    }

    /// r g
    fn multiple(&mut self, (unit, part): Unit, r: Rational) -> Id {
        let (argument, factor) = (self.whole(unit), Number::Exact(r).mul(Number::ratio(1, part)));
        if factor.is_one() {
            return argument;
        }
        let factor = self.program.constant(factor);
        self.program.push(Value::Mul(factor, argument))
    }
}
