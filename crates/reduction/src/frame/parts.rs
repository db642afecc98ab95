//! Parts of a frame: velocities, constraints in them, and structure coefficients.

use std::collections::BTreeMap;

use mechanics::elimination::LinearForms;
use symbolic::{Expr, Graph, Symbol};

use crate::expressions::Sparse;

/// A velocity of a frame.
#[derive(Clone, Debug)]
pub struct FrameVelocity {
    /// Symbol of `u`; that of `q̇ᵢ` where it is one.
    pub symbol: Symbol,
    /// Symbol of `u̇`.
    pub rate: Symbol,
    /// `u` in `(q, v)`.
    pub start: Expr,
}

/// How a form of the frame changes: `dω^form(e_a, e_b)`.
#[derive(Clone, Copy, Debug)]
pub struct Turning {
    /// Place of the form.
    pub form: usize,
    /// Places of the two vectors.
    pub between: (usize, usize),
    /// The coefficient, in `q`; the opposite for the vectors exchanged.
    pub coefficient: Expr,
}

/// Velocities `u = U(q) v`, as many as coordinates, in which the kinetic energy is `½ Σ c_k u_k²`.
#[derive(Clone, Debug)]
pub struct Frame {
    /// `u`.
    pub velocities: Vec<FrameVelocity>,
    /// `c_k`, in parameters.
    pub inertia: Vec<Expr>,
    /// Rows of `U`, by coordinate.
    pub forms: Vec<BTreeMap<usize, Expr>>,
    /// `e_k`: `q̇` for `u_k = 1` and all others zero, by coordinate.
    pub vectors: Vec<BTreeMap<usize, Expr>>,
    /// Where it is not zero.
    pub turning: Vec<Turning>,
    /// The constraints of the system in `u`, by place in the frame, with coefficients in `(q, t)`.
    pub constraints: LinearForms,
    /// The `s_k` that are not constant: where one vanishes, so does a direction of `M`, and the frame ends.
    pub ends: Vec<Expr>,
    /// The velocities of the coordinates, and of frames on the way to this one, each in `u` and earlier ones.
    pub recursion: Vec<(Symbol, Expr)>,
    /// `u, s, v` where `v = u/s` is the velocity of a coordinate.
    pub(super) quotients: Vec<[Expr; 3]>,
}

impl Frame {
    /// What the frame is, in words.
    pub fn words(&self, g: &Graph) -> String {
        let ends: Vec<String> = self.ends.iter().map(|&e| g.plain(e)).collect();
        let ends = match ends.len() {
            0 => "regular everywhere".into(),
            _ => format!("singular with the mass matrix, where one of these vanishes: {}", ends.join(", ")),
        };
        format!(
            "velocities of a frame in which the kinetic energy is a sum of squares with constant coefficients; {ends}"
        )
    }

    /// `Σ_c m_c dω^c(q̇, e_k)` for every k, for momenta `m`.
    pub fn turned(&self, g: &Graph, momenta: &[Expr]) -> Vec<Expr> {
        let u: Vec<Expr> = self.velocities.iter().map(|u| g.variable(u.symbol)).collect();
        // dω^c(q̇, e_k) by k and c
        let mut slopes: Vec<BTreeMap<usize, Vec<Expr>>> = vec![BTreeMap::new(); u.len()];
        for &Turning { form, between: (a, b), coefficient } in &self.turning {
            let term = |k: usize| self.by_quotients(g, g.mul(u[k], coefficient));
            slopes[b].entry(form).or_default().push(term(a));
            slopes[a].entry(form).or_default().push(g.neg(term(b)));
        }
        let total = |slopes: BTreeMap<usize, Vec<Expr>>| {
            let each = slopes.iter().flat_map(|(&c, terms)| terms.iter().map(move |&e| g.mul(momenta[c], e)));
            let flat = g.factored(g.sum(&each.collect::<Vec<Expr>>()));
            let whole: Vec<Expr> = slopes.iter().map(|(&c, terms)| g.mul(momenta[c], g.sum(terms))).collect();
            let whole = g.factored(g.sum(&whole));
            if g.size(&[flat]) < g.size(&[whole]) { flat } else { whole }
        };
        slopes.into_iter().map(total).collect()
    }

    /// `e_k · covector` for every k, with the entries of `covector` by coordinate.
    pub fn along(&self, g: &Graph, covector: &[Expr]) -> Vec<Expr> {
        let dot = |vector: &Sparse| g.sum(&vector.iter().map(|(&i, &e)| g.mul(e, covector[i])).collect::<Vec<Expr>>());
        self.vectors.iter().map(dot).collect()
    }

    /// `term`, a product, by way of `v` where it contains `u/s`.
    fn by_quotients(&self, g: &Graph, term: Expr) -> Expr {
        self.quotients.iter().fold(term, |term, &[u, s, v]| {
            let rest = g.product(&[term, s, g.powi(u, -1)]);
            let taken = g.denominators(&[term]).contains(&s) && !g.denominators(&[rest]).contains(&u);
            if taken { g.mul(rest, v) } else { term }
        })
    }
}
