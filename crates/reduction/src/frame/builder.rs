//! A frame in the making: squares inverted, turned to the constraints, differentiated.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap, HashSet};

use symbolic::{Expr, Graph, Symbol};

use super::parts::{Frame, FrameVelocity, Turning};
use super::squares::Square;
use crate::expressions::{Sparse, products, shortest};
use mechanics::System;
use mechanics::elimination::LinearForms;

pub(super) struct Builder<'a> {
    system: &'a System,
    g: &'a Graph,
    /// Symbols made for frames that were tried.
    names: RefCell<HashSet<Symbol>>,
}

/// A frame that is being made, without how it turns.
pub(super) struct Building {
    velocities: Vec<FrameVelocity>,
    inertia: Vec<Expr>,
    /// Rows of `U`, by coordinate.
    forms: Vec<Sparse>,
    vectors: Vec<Sparse>,
    constraints: Vec<Sparse>,
    ends: Vec<Expr>,
    recursion: Vec<(Symbol, Expr)>,
    quotients: Vec<[Expr; 3]>,
}

impl Building {
    /// Nodes of vectors and constraints.
    pub(super) fn size(&self, g: &Graph) -> usize {
        let entries: Vec<Expr> =
            self.vectors.iter().chain(&self.constraints).flat_map(|row| row.values().copied()).collect();
        g.size(&entries)
    }
}

impl<'a> Builder<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        Builder { system, g: &system.graph, names: RefCell::default() }
    }

    /// The frame of the squares, turned to the constraints; `None` if these contain a singular part of it.
    pub(super) fn build(&self, squares: Vec<Square>, jacobian: &[Sparse]) -> Option<Building> {
        let mut building = self.inverted(squares);
        let g = self.g;
        for row in jacobian {
            let transformed = building.vectors.iter().enumerate().map(|(k, vector)| (k, self.dot(row, vector)));
            let transformed: Sparse = transformed.filter(|(_, e)| !g.is_zero(*e)).collect();
            let known = g.denominators(&row.values().copied().collect::<Vec<Expr>>());
            let found = g.denominators(&transformed.values().copied().collect::<Vec<Expr>>());
            if found.iter().any(|e| !known.contains(e) && !self.system.is_constant(*e)) {
                return None;
            }
            building.constraints.push(transformed);
        }
        while self.turn(&mut building) {}
        Some(building)
    }

    /// The frame of the squares: `v_k = u_k/s_k − Σ l_kj v_j`, last one first.
    fn inverted(&self, squares: Vec<Square>) -> Building {
        let (system, g) = (self.system, self.g);
        let v = g.variables(&system.velocities());
        let mut rows: Vec<Sparse> = vec![Sparse::new(); v.len()];
        let (mut recursion, mut quotients) = (Vec::new(), Vec::new());
        let mut velocities = Vec::new();
        let mut forms = Vec::new();
        for (place, square) in squares.iter().enumerate().rev() {
            let Square { coordinate, scale, others, .. } = square;
            let own = &system.coordinates[*coordinate];
            let mut row = Sparse::from([(place, g.powi(*scale, -1))]);
            let mut form = Sparse::from([(*coordinate, *scale)]);
            for &(j, l) in others {
                form.insert(j, g.mul(*scale, l));
                for (&k, &e) in &rows[j] {
                    let before = row.get(&k).copied().unwrap_or(g.zero());
                    row.insert(k, shortest(g, g.sub(before, g.mul(l, e))));
                }
            }
            row.retain(|_, e| !g.is_zero(*e));
            rows[*coordinate] = row;
            let velocity = if others.is_empty() && *scale == g.one() {
                FrameVelocity { symbol: own.velocity, rate: own.acceleration, start: v[*coordinate] }
            } else {
                let start = g.sum(&form.iter().map(|(&j, &e)| g.mul(e, v[j])).collect::<Vec<Expr>>());
                let velocity = self.named(&own.name, start, &recursion, &velocities);
                let (u, l) = (g.variable(velocity.symbol), |&(j, l): &(usize, Expr)| g.neg(g.mul(l, v[j])));
                let terms: Vec<Expr> = [g.div(u, *scale)].into_iter().chain(others.iter().map(l)).collect();
                recursion.push((own.velocity, g.sum(&terms)));
                if others.is_empty() {
                    quotients.push([u, *scale, v[*coordinate]]);
                }
                velocity
            };
            velocities.push(velocity);
            forms.push(form);
        }
        velocities.reverse();
        forms.reverse();
        let mut vectors = vec![Sparse::new(); v.len()];
        for (i, row) in rows.into_iter().enumerate() {
            row.into_iter().for_each(|(k, e)| {
                vectors[k].insert(i, e);
            });
        }
        let inertia = squares.iter().map(|s| s.inertia).collect();
        let ends = squares.iter().map(|s| s.scale).filter(|&e| !self.system.is_constant(e)).collect();
        Building { velocities, inertia, forms, vectors, constraints: Vec::new(), ends, recursion, quotients }
    }

    /// A velocity with a name that is neither taken in the system nor in this frame.
    fn named(
        &self,
        coordinate: &str,
        start: Expr,
        recursion: &[(Symbol, Expr)],
        others: &[FrameVelocity],
    ) -> FrameVelocity {
        let g = self.g;
        let mut name = format!("w_{coordinate}");
        let taken = |s: Symbol| {
            let used = recursion.iter().any(|r| r.0 == s) || others.iter().any(|u| u.symbol == s);
            used || !self.names.borrow().contains(&s)
        };
        while g.find_symbol(&name).is_some_and(taken) {
            name.push('_');
        }
        let symbol = g.symbol(&name);
        self.names.borrow_mut().insert(symbol);
        FrameVelocity { symbol, rate: g.symbol(&format!("{name}'")), start }
    }

    fn dot(&self, a: &Sparse, b: &Sparse) -> Expr {
        let terms = products(self.g, a, b);
        if terms.len() > 1 { shortest(self.g, self.g.sum(&terms)) } else { self.g.sum(&terms) }
    }

    /// Turns two velocities of equal inertia so that a constraint contains one of them only, with a constant
    /// coefficient; `false` where there are none.
    fn turn(&self, building: &mut Building) -> bool {
        let Some((pair, factors)) = building.constraints.iter().find_map(|row| self.couple(row, &building.inertia))
        else {
            return false;
        };
        self.turn_by(building, pair, factors);
        true
    }

    /// Places of two coefficients `a, b` that are not constant with constant a² + b² = l², and `a/l, b/l`.
    fn couple(&self, row: &Sparse, inertia: &[Expr]) -> Option<((usize, usize), (Expr, Expr))> {
        let g = self.g;
        let moving: Vec<(usize, Expr)> =
            row.iter().map(|(&k, &e)| (k, e)).filter(|(_, e)| !self.system.is_constant(*e)).collect();
        for (i, &(first, a)) in moving.iter().enumerate() {
            for &(second, b) in &moving[i + 1..] {
                let square = g.add(g.powi(a, 2), g.powi(b, 2));
                if inertia[first] == inertia[second] && self.system.is_constant(square) {
                    let root = g.square(square, &|_| false).map(|(c, root)| g.mul(g.sqrt(c), root));
                    let length = root.unwrap_or_else(|| g.sqrt(square));
                    return Some(((first, second), (g.div(a, length), g.div(b, length))));
                }
            }
        }
        None
    }

    /// `u₁, u₂` are replaced by `p u₁ + q u₂` and `p u₂ − q u₁`, where p² + q² = 1.
    fn turn_by(&self, building: &mut Building, (first, second): (usize, usize), (p, q): (Expr, Expr)) {
        let g = self.g;
        let pair = |a: Expr, b: Expr| (g.add(g.mul(p, a), g.mul(q, b)), g.sub(g.mul(p, b), g.mul(q, a)));
        let turned = |one: &Sparse, two: &Sparse| {
            let mut turned = (Sparse::new(), Sparse::new());
            let places: BTreeSet<usize> = one.keys().chain(two.keys()).copied().collect();
            for i in places {
                let at = |row: &Sparse| row.get(&i).copied().unwrap_or(g.zero());
                let (a, b) = pair(at(one), at(two));
                turned.0.insert(i, shortest(g, a));
                turned.1.insert(i, shortest(g, b));
            }
            turned.0.retain(|_, e| !g.is_zero(*e));
            turned.1.retain(|_, e| !g.is_zero(*e));
            turned
        };
        let old = [first, second].map(|k| building.velocities[k].clone());
        let (start_p, start_q) = pair(old[0].start, old[1].start);
        for (k, start) in [(first, start_p), (second, start_q)] {
            let name = g.name(building.velocities[k].symbol);
            let name = name.trim_end_matches('\'').trim_start_matches("w_");
            building.velocities[k] = self.named(name, start, &building.recursion, &building.velocities);
        }
        let new = [first, second].map(|k| g.variable(building.velocities[k].symbol));
        building.recursion.push((old[0].symbol, g.sub(g.mul(p, new[0]), g.mul(q, new[1]))));
        building.recursion.push((old[1].symbol, g.add(g.mul(q, new[0]), g.mul(p, new[1]))));
        for rows in [&mut building.forms, &mut building.vectors] {
            let (one, two) = turned(&rows[first], &rows[second]);
            (rows[first], rows[second]) = (one, two);
        }
        for row in &mut building.constraints {
            let [one, two] = [first, second].map(|k| row.remove(&k).unwrap_or(g.zero()));
            let (one, two) = pair(one, two);
            row.insert(first, shortest(g, one));
            row.insert(second, shortest(g, two));
            row.retain(|_, e| !g.is_zero(*e));
        }
    }

    /// With how it turns.
    pub(super) fn finish(&self, building: Building) -> Frame {
        let (system, g) = (self.system, self.g);
        let turning = self.turning(&building);
        let Building { velocities, inertia, forms, vectors, constraints, ends, recursion, quotients } = building;
        let constraints = LinearForms { rows: constraints, offsets: system.at_rest(&system.constraints) };
        let recursion = in_order(g, recursion);
        Frame { velocities, inertia, forms, vectors, turning, constraints, ends, recursion, quotients }
    }

    /// `dω(e_a, e_b) = Σ ∂_i U_j (e_a^i e_b^j − e_b^i e_a^j)` for `ω = Σ U_j dq_j`.
    fn turning(&self, building: &Building) -> Vec<Turning> {
        let g = self.g;
        let positions = self.system.positions();
        let places: HashMap<Symbol, usize> = positions.iter().enumerate().map(|(i, &s)| (s, i)).collect();
        let mut found = Vec::new();
        for (form, row) in building.forms.iter().enumerate() {
            let mut slopes: Vec<(usize, usize, Expr)> = Vec::new();
            for (&j, &e) in row {
                slopes.extend(g.sparse_gradient(e, &positions).into_iter().map(|(s, d)| (places[&s], j, d)));
            }
            for a in 0..building.vectors.len() {
                for b in a + 1..building.vectors.len() {
                    let mut terms = Vec::new();
                    let (one, two) = (&building.vectors[a], &building.vectors[b]);
                    for &(i, j, slope) in &slopes {
                        if let (Some(&x), Some(&y)) = (one.get(&i), two.get(&j)) {
                            terms.push(g.product(&[slope, x, y]));
                        }
                        if let (Some(&x), Some(&y)) = (two.get(&i), one.get(&j)) {
                            terms.push(g.neg(g.product(&[slope, x, y])));
                        }
                    }
                    let sum = g.sum(&terms);
                    let coefficient = if g.is_zero(sum) { sum } else { shortest(g, sum) };
                    if !g.is_zero(coefficient) {
                        found.push(Turning { form, between: (a, b), coefficient });
                    }
                }
            }
        }
        found
    }
}

/// Definitions in an order in which each contains earlier ones only.
fn in_order(g: &Graph, mut waiting: Vec<(Symbol, Expr)>) -> Vec<(Symbol, Expr)> {
    let mut ordered = Vec::new();
    while !waiting.is_empty() {
        let symbols: HashSet<Symbol> = waiting.iter().map(|d| d.0).collect();
        let (later, ready): (Vec<_>, Vec<_>) =
            waiting.into_iter().partition(|(_, e)| g.symbols_of(*e).iter().any(|s| symbols.contains(s)));
        assert!(!ready.is_empty(), "velocities are a recursion");
        ordered.extend(ready);
        waiting = later;
    }
    ordered
}
