//! Domains of formulas as written, which are smaller than those of their simplified forms.

use crate::{Expr, Fraction, Function, Graph, Range};
use std::collections::HashMap;

impl Graph {
    /// [`Graph::pow`] of a formula that is read.
    pub(crate) fn power_as_written(&self, base: Expr, exponent: Expr) -> Expr {
        let power = self.pow(base, exponent);
        if self.as_fraction(exponent).and_then(Fraction::plain).is_none_or(|(_, d)| d != 1) {
            self.arena.borrow_mut().domains.insert((base, power));
        }
        power
    }

    /// [`Graph::call`] of a formula that is read.
    pub(crate) fn call_as_written(&self, function: Function, x: Expr) -> Expr {
        let call = self.call(function, x);
        let within = |low: Expr, sign: i64| self.add(low, self.mul(self.integer(sign), self.powi(x, 2)));
        let domain = match function {
            Function::Log => x,
            Function::Asin | Function::Acos | Function::Atanh => within(self.one(), -1),
            Function::Acosh => self.sub(x, self.one()),
            _ => return call,
        };
        self.arena.borrow_mut().domains.insert((domain, call));
        call
    }

    /// Expressions that have to be non-negative for the formulas read so far, where this no longer follows
    /// from `es`: `√z·√z` and `(z^(1/3))³` are stored as `z`, and `log z − log z` as 0.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let z = g.variable(g.symbol("z"));
    /// let e = g.parse("sqrt(z)^2 + 1", &|_: &str| Some(z))?;
    /// assert_eq!((g.plain(e), g.lost_domains(&[e])), ("z + 1".into(), vec![z]));
    /// let root = g.parse("sqrt(z)^3", &|_: &str| Some(z))?;
    /// assert_eq!(g.lost_domains(&[root]), []);
    /// # Ok::<(), symbolic::ParseError>(())
    /// ```
    pub fn lost_domains(&self, es: &[Expr]) -> Vec<Expr> {
        let arena = self.arena.borrow();
        let reached = arena.reachable(es, |_| true);
        let roots = self.under_roots(es);
        let same = |a: Expr, b: Expr| arena.ratio(a, b).is_some_and(|r| !r.is_negative());
        let kept = |&(domain, function): &(Expr, Expr)| {
            reached.binary_search(&function).is_ok() || roots.iter().any(|root| same(domain, *root))
        };
        let may_fail = |e: Expr| {
            let Range { low, .. } = self.range(e, &HashMap::new());
            low < 0.0
        };
        let mut lost: Vec<Expr> = arena.domains.iter().filter(|d| !kept(d)).map(|d| d.0).collect();
        lost.retain(|&e| arena.as_number(e).is_none() && may_fail(e));
        lost.dedup();
        lost
    }
}
