//! Frames: velocities `u = U(q) v` in which the kinetic energy is a sum of squares with constant coefficients.
//!
//! Where `L` is quadratic in the velocities, elimination of its mass matrix writes the kinetic energy as a sum of squares,
//!
//! ```text
//! ½ vᵀM(q) v = ½ Σ c_k u_k² ,      u_k = s_k (v_k + Σ l_kj v_j) ,
//! ```
//!
//! and where all `c_k` are constant, its equations of motion contain coordinates by way of how the frame turns only:
//! with `ω^k = u_k` as a form, `e_k` the vector with `ω^j(e_k) = δ_jk`, and `P_k = c_k u_k`,
//!
//! ```text
//! Ṗ_k + Σ_c P_c dω^c(q̇, e_k) = e_k · (force on the coordinates)       on every virtual displacement.
//! ```
//!
//! For a rigid body these are Euler's equations: `u` is its angular velocity, and `dω^c(e_a, e_b)` are numbers where Euler angles stood. Two
//! velocities of equal inertia are turned into each other where a constraint then contains one of them only. What is eliminated next are
//! constraints with constant coefficients, and no mass matrix is left to be eliminated along the way.
//!
//! The frame breaks down where an `s_k` vanishes. There `M` is singular. It is taken only where the constraints do not contain `1/s_k`: then the
//! mass matrix of the admissible velocities is singular there, too, whatever they are written in.
//!
//! Sources: G. Hamel 1904; Ju. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, chapter III.

use std::collections::{BTreeMap, HashMap, HashSet};

use symbolic::{Expr, Graph, Symbol};

use mechanics::{State, System};

mod builder;
mod squares;

use builder::{Builder, Building};
use squares::Tie;

/// A sparse vector.
type Sparse = BTreeMap<usize, Expr>;

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

/// A constraint `Σ coefficient · u + offset = 0`.
#[derive(Clone, Debug)]
pub struct FrameConstraint {
    /// Places in the frame, with coefficients in `(q, t)`.
    pub terms: Vec<(usize, Expr)>,
    /// What is left at rest.
    pub offset: Expr,
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
    /// The constraints of the system.
    pub constraints: Vec<FrameConstraint>,
    /// The `s_k` that are not constant: where one of them vanishes, so does a direction of `M`, and the frame ends.
    pub ends: Vec<Expr>,
    /// The velocities of the coordinates, and of frames on the way to this one, each in `u` and earlier ones.
    pub recursion: Vec<(Symbol, Expr)>,
    /// `u, s, v` where `v = u/s` is the velocity of a coordinate.
    quotients: Vec<[Expr; 3]>,
}

/// Coordinates over which no frame is looked for.
const SMALL: usize = 8;

impl Frame {
    /// The frame of `system`, if its kinetic energy is seen to be a sum of squares with constant coefficients in other velocities than those of its
    /// coordinates. What must not vanish does not at `start`; without a start, at a point of no significance.
    ///
    /// `None` for more than 8 coordinates, where `L` is not quadratic in the velocities or its mass matrix constant or moving with time, where a
    /// constraint is not linear, and where the frame would end before the mass matrix of the admissible velocities does.
    ///
    /// ```
    /// use mechanics::System;
    /// use reduction::Frame;
    /// use symbolic::Graph;
    /// // a point in polar coordinates: L = (r'^2 + r^2 phi'^2)/2, u = (r', r phi')
    /// let mut system = System::new(Graph::new(), &[("r", "m"), ("phi", "rad")]);
    /// let g = system.graph.clone();
    /// let scope = |name: &str| g.find_symbol(name).map(|s| g.variable(s));
    /// system.lagrangian = g.parse("(r'^2 + r^2*phi'^2)/2", &scope, &[])?;
    /// system.graph = g;
    /// let frame = Frame::new(&system, None).expect("a sum of squares");
    /// let g = &system.graph;
    /// assert_eq!(g.plain(frame.velocities[1].start), "r*phi'");
    /// // d(r dphi) = dr ∧ dphi = 1/r on the two unit vectors
    /// let [turning] = frame.turning[..] else { panic!("one form turns") };
    /// assert_eq!((turning.form, turning.between, g.plain(turning.coefficient)), (1, (0, 1), "1/r".into()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(system: &System, start: Option<&State>) -> Option<Frame> {
        let g = &system.graph;
        let v = system.velocities();
        if v.len() > SMALL {
            return None;
        }
        let momenta = g.gradient(system.lagrangian, &v);
        let mass = g.sparse_jacobian(&momenta, &v);
        let parameters: HashSet<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        let within: HashSet<Symbol> = system.positions().into_iter().chain(parameters.iter().copied()).collect();
        let all = |known: &HashSet<Symbol>, e: Expr| g.symbols_of(e).iter().all(|s| known.contains(s));
        let entries = || mass.iter().flatten().map(|(_, e)| *e);
        if entries().all(|e| all(&parameters, e)) || !entries().all(|e| all(&within, e)) {
            return None;
        }
        let places: HashMap<Symbol, usize> = v.iter().enumerate().map(|(i, &s)| (s, i)).collect();
        let row = |row: Vec<(Symbol, Expr)>| row.into_iter().map(|(s, e)| (places[&s], e)).collect::<Sparse>();
        let mass: Vec<Sparse> = mass.into_iter().map(row).collect();
        let jacobian: Vec<Sparse> = g.sparse_jacobian(&system.constraints, &v).into_iter().map(row).collect();
        if jacobian.iter().flat_map(Sparse::values).any(|&e| g.symbols_of(e).iter().any(|s| places.contains_key(s))) {
            return None;
        }
        let builder = Builder::new(system, parameters, point(system, start));
        let mut best: Option<(usize, Building)> = None;
        let mut orders: Vec<Vec<usize>> = Vec::new();
        for tie in [Tie::Latest, Tie::Earliest] {
            let Some(squares) = builder.squares(&mass, tie) else { continue };
            let order = squares.iter().map(|s| s.coordinate).collect();
            if orders.contains(&order) {
                continue;
            }
            orders.push(order);
            let Some(building) = builder.build(squares, &jacobian) else { continue };
            let size = building.size(g);
            if best.as_ref().is_none_or(|(least, _)| size < *least) {
                best = Some((size, building));
            }
        }
        best.map(|(_, building)| builder.finish(building))
    }

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

/// Values of parameters, time, coordinates and velocities at `start`, or at a point of no significance.
pub(crate) fn point(system: &System, start: Option<&State>) -> HashMap<Symbol, f64> {
    let n = system.dimension();
    let mut values = system.parameter_values();
    match start {
        Some(state) => values.extend(system.values_at(state)),
        None => {
            let q: Vec<f64> = (1..=n).map(|i| 0.3 + (i as f64 * 0.618_033_988_749_895).fract()).collect();
            values.extend(system.values_at(&State { t: 0.3, q, v: vec![0.0; n] }));
        }
    }
    values
}

/// `e`, with terms multiplied out or common factors drawn out, whatever is shortest.
fn shortest(g: &Graph, e: Expr) -> Expr {
    let expanded = g.expand(e);
    let ways = [e, g.factored(e), expanded, g.factored(expanded)];
    ways.into_iter().min_by_key(|&e| g.size(&[e])).unwrap_or(e)
}
