//! The shortest of a few frames.

use mechanics::{State, System};
use symbolic::Expr;

use super::builder::{Builder, Building};
use super::parts::Frame;
use super::squares::{Known, Tie};
use crate::expressions::{Sparse, point, sparse_rows};

/// Coordinates over which no frame is looked for.
const SMALL: usize = 8;

impl Frame {
    /// The frame of `system`, if its kinetic energy is seen as squares with constant coefficients in other
    /// velocities than its own. What must not vanish does not at `start`, or at a point of no significance.
    ///
    /// `None` for more than 8 coordinates, where `L` is not quadratic in the velocities or its mass matrix
    /// constant or moving with time, where a constraint is not linear, and where the frame would end before
    /// the mass matrix of the admissible velocities does.
    ///
    /// ```
    /// use mechanics::System;
    /// use reduction::Frame;
    /// use symbolic::Graph;
    /// // a point in polar coordinates: L = (r'^2 + r^2 phi'^2)/2, u = (r', r phi')
    /// let mut system = System::new(Graph::new(), &[("r", "m"), ("phi", "rad")]);
    /// system.lagrangian = system.expression("(r'^2 + r^2*phi'^2)/2")?;
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
        let mass = sparse_rows(g, &momenta, &v);
        let q = system.positions();
        let is_at_place = |e: Expr| g.symbols_of(e).into_iter().all(|s| q.contains(&s) || system.is_parameter(s));
        let entries = || mass.iter().flat_map(Sparse::values).copied();
        if entries().all(|e| system.is_constant(e)) || !entries().all(is_at_place) {
            return None;
        }
        let jacobian = system.linear_constraints().ok()?.rows;
        let (known, builder) = (Known { system, values: point(system, start) }, Builder::new(system));
        let mut best: Option<(usize, Building)> = None;
        let mut orders: Vec<Vec<usize>> = Vec::new();
        for tie in [Tie::Latest, Tie::Earliest] {
            let Some(squares) = known.squares(&mass, tie) else { continue };
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
}
