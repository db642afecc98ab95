//! Products that stay finite where their factors overflow, such as `1/(1 + exp u)` and `1/cosh²u`.
//!
//! With `X = exp g = σ(g)/σ(−g)`, `σ(g) = 1/(1 + exp(−g))`, a sum of powers of `X` from the `l`-th to the
//! `h`-th is
//!
//! ```text
//! Σ aⱼ Xʲ = Xˡ · σ(−g)^(l−h) · Σ aⱼ σ(g)^(j−l) σ(−g)^(h−j) ,
//! ```
//!
//! in which nothing overflows but the powers in front; those of all factors of a product are put together. So
//! with `cosh g` and `sinh g = cosh g tanh g` as well, where the sum is multiplied by powers of `1/cosh g`.

use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
use crate::{Expr, Function};

/// Largest whole number that a unit is a part by.
const SMALL: i64 = 64;

/// Which functions of the unit are scaled.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Scale {
    /// `exp(n g)`, by σ(g) and σ(−g).
    Logistic,
    /// `cosh g`, `sinh g`, and `exp(±n g) = (2 σ(±2g) cosh g)ⁿ`, by `1/cosh g`.
    Hyperbolic,
}

/// An expression over a whole number.
pub(crate) type Unit = (Expr, i64);

/// Powers of a unit's functions in a term: `exp(n g)`, `cosh g`, `sinh g`.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(crate) struct Degrees {
    pub(crate) exp: i64,
    pub(crate) cosh: i64,
    pub(crate) sinh: i64,
}

/// A term of a sum: its number, what of it does not contain the unit, and the powers of the unit's functions.
pub(crate) struct ScaledTerm {
    pub(crate) number: Number,
    pub(crate) rest: Vec<(Expr, Rational)>,
    pub(crate) degrees: Degrees,
}

/// A factor in which the unit's functions stand.
pub(crate) struct ScaledFactor {
    /// Its place among the factors.
    pub(crate) place: usize,
    pub(crate) exponent: Rational,
    pub(crate) terms: Vec<ScaledTerm>,
}

/// The factors of a product that overflow together.
pub(crate) struct Group {
    pub(crate) scale: Scale,
    /// A multiple of `g`, and which one.
    pub(crate) unit: Unit,
    pub(crate) factors: Vec<ScaledFactor>,
    /// Powers in front: of σ(g) and σ(−g), or of `1/cosh g` twice.
    pub(crate) powers: [Rational; 2],
}

impl ScaledTerm {
    fn is_free(&self) -> bool {
        self.degrees == Degrees::default()
    }
}

impl Degrees {
    /// The power of `cosh g` that the term grows with.
    pub(crate) fn growth(self) -> i64 {
        self.exp.abs() + self.cosh + self.sinh
    }
}

impl ScaledFactor {
    /// The least and the largest power of `exp g`, or 0 and that of `cosh g`.
    pub(crate) fn ends(&self, scale: Scale) -> (i64, i64) {
        let degrees = self.terms.iter().map(|term| match scale {
            Scale::Logistic => term.degrees.exp,
            Scale::Hyperbolic => term.degrees.growth(),
        });
        let low = if scale == Scale::Hyperbolic { 0 } else { degrees.clone().min().unwrap_or(0) };
        (low, degrees.max().unwrap_or(0))
    }
}

impl Group {
    /// Whether the product is bounded as far as the unit's functions go.
    pub(crate) fn is_bounded(&self) -> bool {
        self.powers.iter().all(|r| !r.is_negative())
    }

    /// The largest multiple of `g` that stands in an exponential.
    pub(crate) fn multiple(&self) -> i64 {
        let degrees = self.factors.iter().flat_map(|factor| &factor.terms).map(|term| term.degrees);
        degrees.map(|d| d.exp.abs().max((d.cosh + d.sinh).min(1))).max().unwrap_or(1)
    }
}

impl Arena {
    /// The groups among these factors.
    pub(crate) fn saturating_groups(&self, factors: &[(Expr, Rational)]) -> Vec<Group> {
        let mut groups = Vec::new();
        if !factors.iter().any(|(_, r)| r.is_negative()) {
            return groups;
        }
        let mut taken = vec![false; factors.len()];
        while let Some(group) = self.saturating(factors, &taken) {
            group.factors.iter().for_each(|factor| taken[factor.place] = true);
            groups.push(group);
        }
        groups
    }

    /// The first group among these factors, those at places that are `taken` left out.
    fn saturating(&self, factors: &[(Expr, Rational)], taken: &[bool]) -> Option<Group> {
        let divisors = factors.iter().zip(taken).filter(|((_, r), taken)| r.is_negative() && !**taken);
        for ((base, _), _) in divisors {
            let Some((scale, (unit, part))) = self.unit(*base) else { continue };
            let mut found = self.group(scale, (unit, part), factors, taken);
            // with √(1 + exp g) by σ(±g/2), no root of what may underflow is taken
            let roots =
                found.as_ref().map_or(1, |group| group.powers[0].denominator().max(group.powers[1].denominator()));
            if scale == Scale::Logistic && (2..=SMALL / part).contains(&roots) {
                found = self.group(scale, (unit, part * roots), factors, taken);
            }
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// What a divisor asks to be scaled by.
    fn unit(&self, base: Expr) -> Option<(Scale, Unit)> {
        let mut least: Option<Unit> = None;
        for f in self.top_calls(base) {
            match *self.node(f) {
                Node::Call(Function::Cosh | Function::Sinh, g) => return Some((Scale::Hyperbolic, (g, 1))),
                Node::Call(Function::Exp, g) if f != base => {
                    // of arguments that are 2 g and 3 g: their common divisor
                    least = least.map_or(Some((g, 1)), |(h, d)| match self.ratio(g, h) {
                        Some(r) if (1..=SMALL).contains(&(d * r.denominator())) => Some((h, d * r.denominator())),
                        _ => Some((h, d)),
                    });
                }
                _ => {}
            }
        }
        least.map(|g| (Scale::Logistic, g))
    }

    /// Calls that are terms of a sum or factors of its terms, or the whole.
    fn top_calls(&self, e: Expr) -> Vec<Expr> {
        let factors = self.terms_of(e).1.into_iter().flat_map(|(t, _)| self.factors_of(t));
        factors.map(|(base, _)| base).filter(|f| matches!(self.node(*f), Node::Call(..))).collect()
    }

    fn group(&self, scale: Scale, unit: Unit, factors: &[(Expr, Rational)], taken: &[bool]) -> Option<Group> {
        let mut involved = Vec::new();
        let mut powers = [Rational::integer(0); 2];
        for (place, (base, exponent)) in factors.iter().enumerate().filter(|(place, _)| !taken[*place]) {
            let (constant, terms) = self.terms_of(*base);
            let mut terms: Vec<ScaledTerm> =
                terms.into_iter().map(|(t, c)| self.scaled_term(scale, unit, t, c)).collect();
            if !constant.is_zero() {
                terms.push(ScaledTerm { number: constant, rest: Vec::new(), degrees: Degrees::default() });
            }
            if terms.iter().all(ScaledTerm::is_free) {
                continue;
            }
            let factor = ScaledFactor { place, exponent: *exponent, terms };
            let (low, high) = factor.ends(scale);
            let [first, second] = match scale {
                Scale::Logistic => [low, -high],
                Scale::Hyperbolic => [-high, -high],
            };
            powers[0] = powers[0].add(exponent.mul(Rational::integer(first))?)?;
            powers[1] = powers[1].add(exponent.mul(Rational::integer(second))?)?;
            involved.push(factor);
        }
        let both = powers[0].add(powers[1])?;
        let finite = scale == Scale::Hyperbolic || !both.is_negative();
        (finite && !involved.is_empty()).then_some(Group { scale, unit, factors: involved, powers })
    }

    /// The powers of the unit's functions in `number · e`; none where these stand inside other factors as
    /// well.
    fn scaled_term(&self, scale: Scale, unit: Unit, e: Expr, number: Number) -> ScaledTerm {
        let whole = || ScaledTerm { number, rest: vec![(e, Rational::ONE)], degrees: Degrees::default() };
        let (mut rest, mut degrees) = (Vec::new(), Degrees::default());
        for (base, exponent) in self.factors_of(e) {
            match self.degrees(scale, unit, base) {
                Some(found) => {
                    let Some(n) = exponent.as_integer() else { return whole() };
                    if n < 0 && (found.cosh, found.sinh) != (0, 0) {
                        return whole();
                    }
                    degrees.exp += n * found.exp;
                    degrees.cosh += n * found.cosh;
                    degrees.sinh += n * found.sinh;
                }
                None => rest.push((base, exponent)),
            }
        }
        let inside = |n: Expr| self.degrees(scale, unit, n).is_some();
        let bases: Vec<Expr> = rest.iter().map(|(b, _)| *b).collect();
        if degrees != Degrees::default() && self.reachable(&bases, |_| true).into_iter().any(inside) {
            return whole();
        }
        ScaledTerm { number, rest, degrees }
    }

    /// `exp(n g)`, `cosh g` or `sinh g`.
    fn degrees(&self, scale: Scale, unit: Unit, e: Expr) -> Option<Degrees> {
        match *self.node(e) {
            Node::Call(Function::Exp, u) => {
                let exp = self.ratio(u, unit.0)?.mul(Rational::integer(unit.1))?.as_integer()?;
                Some(Degrees { exp, ..Degrees::default() })
            }
            Node::Call(Function::Cosh, u) if scale == Scale::Hyperbolic && u == unit.0 => {
                Some(Degrees { cosh: 1, ..Degrees::default() })
            }
            Node::Call(Function::Sinh, u) if scale == Scale::Hyperbolic && u == unit.0 => {
                Some(Degrees { sinh: 1, ..Degrees::default() })
            }
            _ => None,
        }
    }

    /// `a/b`, where that is a fraction that is seen from the two.
    pub(crate) fn ratio(&self, a: Expr, b: Expr) -> Option<Rational> {
        if a == b {
            return Some(Rational::ONE);
        }
        let (k, of_a) = self.terms_of(a);
        let (l, of_b) = self.terms_of(b);
        let same = of_a.len() == of_b.len() && of_a.iter().zip(&of_b).all(|(x, y)| x.0 == y.0);
        let exact = |n: &Number| if let Number::Exact(r) = n { Some(*r) } else { None };
        if !same || k.is_zero() != l.is_zero() {
            return None;
        }
        let pairs = of_a.iter().zip(&of_b).map(|(x, y)| (x.1, y.1)).chain((!k.is_zero()).then_some((k, l)));
        let mut found = None;
        for (x, y) in pairs {
            let ratio = exact(&x)?.mul(exact(&y)?.recip()?)?;
            if *found.get_or_insert(ratio) != ratio {
                return None;
            }
        }
        found
    }
}
