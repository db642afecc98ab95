//! The graph and its constructors.

use crate::Fraction;
use crate::store::arena::{Arena, Node};
use crate::store::matrix::Matrix;
use crate::store::number::{Number, Rational};
use crate::{Expr, Function, Symbol, faults};
use std::cell::RefCell;

/// The store of expressions. Building needs only `&Graph`; it is `Send`, not `Sync`; clones keep all ids.
///
/// An [`Expr`] or [`Symbol`] belongs to its graph and later clones; others panic.
///
/// ```
/// use symbolic::Graph;
/// let g = Graph::new();
/// let x = g.variable(g.symbol("x"));
/// assert_eq!(g.mul(x, g.add(x, x)), g.mul(g.integer(2), g.powi(x, 2)));
/// ```
#[derive(Default)]
pub struct Graph {
    pub(crate) arena: RefCell<Arena>,
}

/// Derived, it would be compiled in the crates that call it, and as little optimized as these.
impl Clone for Graph {
    fn clone(&self) -> Self {
        Graph { arena: RefCell::new(self.arena.borrow().fork()) }
    }
}

impl std::fmt::Debug for Graph {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Graph").finish_non_exhaustive()
    }
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// The symbol of that name, always the same: an identifier and primes, as in `x`, `x'` or `mu_1'`.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// assert_eq!(g.symbol("x'"), g.symbol("x'"));
    /// ```
    pub fn symbol(&self, name: &str) -> Symbol {
        self.arena.borrow_mut().symbol(name)
    }

    /// The symbol of that name, if there is one already.
    pub fn find_symbol(&self, name: &str) -> Option<Symbol> {
        self.arena.borrow().find_symbol(name)
    }

    /// The name of a symbol, with its primes.
    pub fn name(&self, symbol: Symbol) -> String {
        self.arena.borrow().name(symbol).to_owned()
    }

    /// The symbol as an expression.
    #[track_caller]
    pub fn variable(&self, symbol: Symbol) -> Expr {
        let variable = self.arena.borrow_mut().intern(Node::Symbol(symbol));
        self.perhaps_negative(variable)
    }

    /// Several symbols as expressions.
    #[track_caller]
    pub fn variables(&self, symbols: &[Symbol]) -> Vec<Expr> {
        let mut variables = Vec::with_capacity(symbols.len());
        for s in symbols {
            variables.push(self.variable(*s));
        }
        variables
    }

    /// The symbol that `e` is, if it is one.
    pub fn as_symbol(&self, e: Expr) -> Option<Symbol> {
        match self.arena.borrow().node(e) {
            Node::Symbol(s) => Some(*s),
            _ => None,
        }
    }

    /// 0
    pub fn zero(&self) -> Expr {
        Arena::ZERO
    }

    /// 1
    #[track_caller]
    pub fn one(&self) -> Expr {
        self.perhaps_negative(Arena::ONE)
    }

    /// The integer n, exactly.
    #[track_caller]
    pub fn integer(&self, n: i64) -> Expr {
        let number = self.arena.borrow_mut().number(Number::integer(n));
        self.perhaps_negative(number)
    }

    /// The fraction numerator/denominator, exactly; not finite for a zero denominator.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// assert_eq!(g.ratio(2, 4), g.number(0.5));
    /// ```
    pub fn ratio(&self, numerator: i64, denominator: i64) -> Expr {
        self.arena.borrow_mut().number(Number::ratio(numerator, denominator))
    }

    /// The number x; exactly its shortest decimal's fraction where that fits: `number(9.81)` is 981/100.
    pub fn number(&self, x: f64) -> Expr {
        self.arena.borrow_mut().number(Number::from_f64(x))
    }

    /// π, as the quotient [`crate::PI`]: multiples of it stay what they are.
    pub fn pi(&self) -> Expr {
        self.arena.borrow_mut().number(Number::PI)
    }

    /// `e`, if it is a number that nothing has rounded; π is the quotient [`crate::PI`].
    ///
    /// ```
    /// use symbolic::Fraction;
    /// let g = symbolic::Graph::new();
    /// assert_eq!(g.as_fraction(g.number(9.81)), Fraction::new(981, 100));
    /// assert_eq!(g.as_fraction(g.number(1e-45)), Fraction::decimal("1e-45"));
    /// assert_eq!(g.as_fraction(g.number(0.1 + 0.2)), None);
    /// ```
    pub fn as_fraction(&self, e: Expr) -> Option<Fraction> {
        self.arena.borrow().as_number(e).and_then(Number::fraction)
    }

    /// This number; rounded where it has too many digits.
    pub fn fraction(&self, x: Fraction) -> Expr {
        self.arena.borrow_mut().number(Number::of(x).unwrap_or(Number::rounded(x.to_f64())))
    }

    /// The value of `e`, if it is a number. A division by zero among numbers is a number that is not finite.
    pub fn as_number(&self, e: Expr) -> Option<f64> {
        self.arena.borrow().as_number(e).map(Number::to_f64)
    }

    /// Structurally the number 0 (see [`Graph::vanishes`] for the test that also expands and samples).
    #[track_caller]
    pub fn is_zero(&self, e: Expr) -> bool {
        (e == Arena::ZERO) != faults::goes_wrong("answer turned")
    }

    /// a + b
    #[track_caller]
    pub fn add(&self, a: Expr, b: Expr) -> Expr {
        self.sum(&[a, b])
    }

    /// a − b
    #[track_caller]
    pub fn sub(&self, a: Expr, b: Expr) -> Expr {
        let mut parts = vec![(a, Number::ONE), (b, Number::MINUS_ONE)];
        faults::spoil_terms(&mut parts);
        self.arena.borrow_mut().linear(Number::ZERO, parts)
    }

    /// a · b
    #[track_caller]
    pub fn mul(&self, a: Expr, b: Expr) -> Expr {
        self.product(&[a, b])
    }

    /// a / b; not finite for b = 0.
    #[track_caller]
    pub fn div(&self, a: Expr, b: Expr) -> Expr {
        let mut factors = vec![(a, Rational::ONE), (b, Rational::integer(-1))];
        faults::spoil_factors(&mut factors);
        self.arena.borrow_mut().power_product(Number::ONE, factors)
    }

    /// −a
    #[track_caller]
    pub fn neg(&self, a: Expr) -> Expr {
        if a != Arena::ZERO && faults::goes_wrong("sign left as it is") {
            return a;
        }
        self.arena.borrow_mut().scale(Number::MINUS_ONE, a)
    }

    /// base^exponent, with 0⁰ = 1; not finite for a negative power of 0.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// assert_eq!(g.pow(g.sqrt(x), g.integer(2)), x);
    /// assert_ne!(g.sqrt(g.powi(x, 2)), x); // it is |x|
    /// ```
    #[track_caller]
    pub fn pow(&self, base: Expr, exponent: Expr) -> Expr {
        self.arena.borrow_mut().pow(base, exponent)
    }

    /// baseⁿ for an integer n
    #[track_caller]
    pub fn powi(&self, base: Expr, exponent: i32) -> Expr {
        let mut factors = vec![(base, Rational::integer(exponent.into()))];
        faults::spoil_factors(&mut factors);
        self.arena.borrow_mut().power_product(Number::ONE, factors)
    }

    /// √a
    #[track_caller]
    pub fn sqrt(&self, a: Expr) -> Expr {
        self.pow(a, self.ratio(1, 2))
    }

    /// function(argument), with the sign of an odd or even function's argument taken out.
    ///
    /// ```
    /// use symbolic::{Function, Graph};
    /// let g = Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let odd = g.call(Function::Sin, g.neg(x));
    /// assert_eq!(odd, g.neg(g.call(Function::Sin, x)));
    /// ```
    pub fn call(&self, function: Function, argument: Expr) -> Expr {
        self.arena.borrow_mut().call(function, argument)
    }

    /// The angle of the point (x, y).
    pub fn atan2(&self, y: Expr, x: Expr) -> Expr {
        self.arena.borrow_mut().atan2(y, x)
    }

    /// Σ terms
    #[track_caller]
    pub fn sum(&self, terms: &[Expr]) -> Expr {
        let mut parts = terms.iter().map(|t| (*t, Number::ONE)).collect();
        faults::spoil_terms(&mut parts);
        self.arena.borrow_mut().linear(Number::ZERO, parts)
    }

    /// Π factors
    #[track_caller]
    pub fn product(&self, factors: &[Expr]) -> Expr {
        let mut factors = factors.iter().map(|f| (*f, Rational::ONE)).collect();
        faults::spoil_factors(&mut factors);
        self.arena.borrow_mut().power_product(Number::ONE, factors)
    }

    /// Σ aᵢ bᵢ
    ///
    /// # Panics
    /// If the two differ in length.
    #[track_caller]
    pub fn dot(&self, a: &[Expr], b: &[Expr]) -> Expr {
        assert_eq!(a.len(), b.len(), "the dot product needs two vectors of the same length");
        let mut terms = Vec::with_capacity(a.len());
        for (a, b) in a.iter().zip(b) {
            terms.push(self.mul(*a, *b));
        }
        self.sum(&terms)
    }

    /// m v
    ///
    /// # Panics
    /// If `v` does not have as many entries as `m` has columns.
    #[track_caller]
    pub fn mat_vec(&self, m: &Matrix, v: &[Expr]) -> Vec<Expr> {
        assert_eq!(m.columns(), v.len(), "a matrix times a vector of another length");
        let mut product = Vec::with_capacity(m.rows());
        for i in 0..m.rows() {
            product.push(self.dot(m.row(i), v));
        }
        product
    }

    /// mᵀ v
    ///
    /// # Panics
    /// If `v` does not have as many entries as `m` has rows.
    #[track_caller]
    pub fn transpose_vec(&self, m: &Matrix, v: &[Expr]) -> Vec<Expr> {
        assert_eq!(m.rows(), v.len(), "a transposed matrix times a vector of another length");
        let mut product = Vec::with_capacity(m.columns());
        for j in 0..m.columns() {
            product.push(self.dot(&m.column(j), v));
        }
        product
    }
}
