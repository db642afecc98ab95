//! Constraints that are total time derivatives, and each own a coordinate: left out before integrability is
//! asked for.

use std::collections::{BTreeMap, BTreeSet};

use symbolic::{Expr, Symbol, Vanishing};

use crate::elimination::{LinearForms, Pivot, SparseMatrix};
use crate::{RemovalError, State, System};

impl System {
    /// The system and its state on the leaf of the start, if constraints on positions hold, and without
    /// constraints `f = d/dt (c q_i + ψ(q, t))`, where `c ≠ 0` is constant and `q_i` stands in no coefficient
    /// of any constraint: `q̇_i` from `f = 0` is put into the others, and `q_i` is left out. The rest has a
    /// graph of its own.
    ///
    /// The other directions are the same on each leaf `c q_i + ψ = const`, so that the rest has exactly one
    /// integrable combination fewer for each, and its brackets nest as deep. `L` stays as it is.
    ///
    /// # Errors
    /// [`RemovalError::NotLinear`]
    ///
    /// ```
    /// # let names = ["x", "y", "z", "w"].map(|name| (name, "m"));
    /// # let mut system = mechanics::System::new(Default::default(), &names);
    /// system.constraints = vec![system.expression("w' - x*x'")?, system.expression("z' - y*w'")?];
    /// let start = mechanics::State { t: 0.0, q: vec![0.0; 4], v: vec![0.0; 4] };
    /// let (rest, _) = system.without_exact_constraints(&start)?;
    /// let names: Vec<&str> = rest.coordinates.iter().map(|c| &c.name[..]).collect();
    /// assert_eq!(names, ["x", "y", "z"]);
    /// assert_eq!(rest.constraints, [rest.expression("z' - x*y*x'")?]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn without_exact_constraints(&self, state: &State) -> Result<(System, State), RemovalError> {
        let (mut rest, state) = self.on_leaf(state);
        let (coordinates, forces, n) = (rest.coordinates.clone(), rest.forces.clone(), rest.dimension());
        let g = &rest.graph;
        let LinearForms { mut rows, offsets } = rest.linear_constraints()?;
        // [A | b]
        for (row, &offset) in rows.iter_mut().zip(&offsets).filter(|(_, b)| !g.is_zero(**b)) {
            row.insert(n, offset);
        }
        let places: Vec<Symbol> = rest.positions().into_iter().chain([self.time]).collect();
        let mut matrix = SparseMatrix::new(rows);
        let (mut left_out, mut kept) = (BTreeSet::new(), BTreeSet::from_iter(0..offsets.len()));
        loop {
            // what stands there is less after each elimination
            let standing: BTreeSet<Symbol> =
                matrix.rows().iter().flat_map(BTreeMap::values).flat_map(|&e| g.symbols_of(e)).collect();
            let before = kept.len();
            for p in kept.clone() {
                let own = |&(&j, &c): &(&usize, &Expr)| {
                    j < n
                        && !standing.contains(&places[j])
                        && places.iter().all(|&place| !g.depends_on(c, place))
                        && matches!(rest.vanishes(c), Vanishing::No { .. })
                };
                let row = &matrix.rows()[p];
                let fewest = row.iter().filter(own).map(|(&j, _)| j).min_by_key(|&j| matrix.rows_with(j).len());
                let Some(i) = fewest.filter(|_| rest.is_total_derivative(row)) else { continue };
                let Some(Pivot { entry, row, column }) = matrix.take(p, i) else { continue };
                for (r, factor) in column {
                    for (&j, &e) in &row {
                        let rest = matrix.entry(r, j, g.zero());
                        *rest = g.sub(*rest, g.mul(g.div(factor, entry), e));
                        let rest = *rest;
                        if g.is_zero(rest) {
                            matrix.set(r, j, None);
                        }
                    }
                }
                left_out.insert(i);
                kept.remove(&p);
            }
            if kept.len() == before {
                break;
            }
        }
        let form = |p: &usize| {
            let terms = matrix.rows()[*p].iter().map(|(&j, &e)| match coordinates.get(j) {
                Some(c) => g.mul(e, g.variable(c.velocity)),
                None => e,
            });
            g.sum(&terms.collect::<Vec<Expr>>())
        };
        let stay: Vec<usize> = (0..n).filter(|i| !left_out.contains(i)).collect();
        let stays = |e: Expr| left_out.iter().all(|&i| !g.depends_on(e, coordinates[i].position));
        let at = |place: &usize| kept.iter().position(|p| p == place);
        let on_positions = rest.on_positions.iter().filter(|(_, e)| stays(*e));
        let on_positions = on_positions.filter_map(|(place, e)| Some((at(place)?, *e))).collect();
        rest.constraints = kept.iter().map(form).collect();
        rest.on_positions = on_positions;
        rest.coordinates = stay.iter().map(|&i| coordinates[i].clone()).collect();
        rest.forces = stay.iter().map(|&i| forces[i]).collect();
        rest.virtual_conditions.clear();
        let of = |x: &[f64]| stay.iter().map(|&i| x[i]).collect();
        Ok((rest, State { t: state.t, q: of(&state.q), v: of(&state.v) }))
    }

    /// Whether `Σ a_j dq_j + b dt` is closed, exactly: `∂a_j/∂q_k = ∂a_k/∂q_j`. Of `row`, `a_j` by `j` and
    /// `b` by `n`.
    pub fn is_total_derivative(&self, row: &BTreeMap<usize, Expr>) -> bool {
        let (g, places) = (&self.graph, [self.positions(), vec![self.time]].concat());
        g.are_exact(&row.values().copied().collect::<Vec<_>>())
            && row.iter().all(|(&j, &a)| {
                let symbols = g.symbols_of(a);
                places.iter().enumerate().filter(|(k, place)| *k != j && symbols.contains(place)).all(|(k, &place)| {
                    let other = row.get(&k).map_or(g.zero(), |&b| g.derivative(b, places[j]));
                    let curl = g.sub(g.derivative(a, place), other);
                    g.vanishes_exactly(curl) || g.vanishes_exactly(self.as_written(curl))
                })
            })
    }
}
