//! Removes from equations what the motion does not need, in one place for all formulations.
//!
//! Quadratures are named only, and stay under the error control of the time loop: users want those
//! coordinates as accurate as the others. Without them DOP853 takes as many steps and is 1 % to 13 % faster
//! (scenes whose other equations are not trivial).

use std::collections::{BTreeMap, HashMap, HashSet};

use symbolic::{Expr, Symbol};

use crate::definitions::{apart, symbols_behind};
use crate::equations::{Block, Equations, LeftOut, Named, Role};

impl Equations {
    /// Leaves out what the motion does not need, and writes down what went.
    ///
    /// Blocks fall apart into independent ones; an unknown with a constant coefficient and an equation of its
    /// own is solved on the spot; unknowns and states on which no coordinate or velocity depends are dropped;
    /// coordinates that nothing else depends on are named as quadratures.
    pub fn leave_out_unneeded(mut self) -> Self {
        self.split_blocks();
        self.solve_single_unknowns();
        self.drop_unneeded();
        self.name_quadratures();
        self
    }

    fn split_blocks(&mut self) {
        let mut split = Vec::new();
        for block in std::mem::take(&mut self.blocks) {
            let places: HashMap<Symbol, usize> = block.unknowns.iter().enumerate().map(|(i, &z)| (z, i)).collect();
            let occurring =
                |&r: &Expr| self.graph.symbols_of(r).iter().filter_map(|z| places.get(z).copied()).collect();
            let depends: Vec<Vec<usize>> = block.residuals.iter().map(occurring).collect();
            // each unknown points at one of its group with a smaller place, the first at itself
            let mut group: Vec<usize> = (0..block.unknowns.len()).collect();
            let first = |group: &[usize], mut j: usize| {
                while group[j] != j {
                    j = group[j];
                }
                j
            };
            for row in &depends {
                let linked: Vec<usize> = row.iter().map(|&j| first(&group, j)).collect();
                if let Some(&smallest) = linked.iter().min() {
                    linked.iter().for_each(|&j| group[j] = smallest);
                    row.iter().for_each(|&j| group[j] = smallest);
                }
            }
            let mut members: BTreeMap<usize, (Vec<usize>, Vec<usize>)> = BTreeMap::new();
            for j in 0..group.len() {
                members.entry(first(&group, j)).or_default().1.push(j);
            }
            for (i, row) in depends.iter().enumerate() {
                if let Some(part) = row.first().and_then(|&j| members.get_mut(&first(&group, j))) {
                    part.0.push(i);
                }
            }
            let parts: Vec<(Vec<usize>, Vec<usize>)> = members.into_values().collect();
            if parts.iter().any(|(rows, columns)| rows.len() != columns.len()) {
                split.push(block); // structurally singular: kept whole, refused with its name when it is solved
                continue;
            }
            for (rows, columns) in parts {
                split.push(Block {
                    unknowns: columns.iter().map(|&j| block.unknowns[j]).collect(),
                    residuals: rows.iter().map(|&i| block.residuals[i]).collect(),
                    guess: columns.iter().filter_map(|&j| block.guess.get(j).copied()).collect(),
                    regular: block.regular,
                });
            }
        }
        self.blocks = split;
    }

    fn solve_single_unknowns(&mut self) {
        let g = self.graph.clone();
        let parameters: HashSet<Symbol> = self.parameters.keys().copied().collect();
        let mut solved: Vec<(Symbol, Expr)> = Vec::new();
        self.blocks.retain(|block| {
            let ([unknown], [residual]) = (&block.unknowns[..], &block.residuals[..]) else { return true };
            let coefficient = g.derivative(*residual, *unknown);
            let constant = g.symbols_of(coefficient).iter().all(|s| parameters.contains(s));
            let value = g.evaluate(coefficient, &self.parameters).unwrap_or(0.0);
            if !constant || value == 0.0 || !value.is_finite() {
                return true;
            }
            let rest = g.substitute(*residual, &HashMap::from([(*unknown, g.zero())]));
            let solution = g.neg(g.div(rest, coefficient));
            solved.push((*unknown, solution));
            false
        });
        self.graph = g;
        let unknowns: Vec<Symbol> = solved.iter().map(|s| s.0).collect();
        let (known, waiting) = apart(&self.graph, &self.definitions, &unknowns);
        if !waiting.is_empty() {
            self.definitions = [known, solved, waiting].concat();
        } else if !solved.is_empty() {
            self.rewrite(&solved.into_iter().collect());
        }
    }

    /// Substitutes in rates, outputs, invariants and guards.
    fn rewrite(&mut self, map: &HashMap<Symbol, Expr>) {
        let g = &self.graph;
        for e in self
            .states
            .iter_mut()
            .map(|s| &mut s.rate)
            .chain(&mut self.coordinates)
            .chain(&mut self.velocities)
            .chain(self.multipliers.iter_mut().map(|n| &mut n.expression))
            .chain(self.invariants.iter_mut().map(|n| &mut n.expression))
            .chain(&mut self.guards)
        {
            *e = g.substitute(*e, map);
        }
    }

    fn drop_unneeded(&mut self) {
        let g = self.graph.clone();
        let definitions: HashMap<Symbol, Expr> = self.definitions.iter().copied().collect();
        let rates: HashMap<Symbol, Expr> = self.states.iter().map(|y| (y.symbol, y.rate)).collect();
        let mut needed: HashSet<Symbol> = HashSet::new();
        let mut pending: Vec<Expr> = self.coordinates.iter().chain(&self.velocities).copied().collect();
        pending.extend(self.multipliers.iter().map(|m| m.expression));
        while let Some(e) = pending.pop() {
            for s in g.symbols_of(e) {
                if !needed.insert(s) {
                    continue;
                }
                pending.extend(definitions.get(&s).into_iter().chain(rates.get(&s)));
                for b in self.blocks.iter().filter(|b| b.unknowns.contains(&s)) {
                    pending.extend(&b.residuals);
                }
            }
        }
        let unneeded: Vec<Symbol> = self.states.iter().map(|y| y.symbol).filter(|s| !needed.contains(s)).collect();
        if !unneeded.is_empty() {
            let words = "nothing that is asked for depends on it".into();
            self.left_out.push(LeftOut { variables: unneeded, words });
        }
        let dropped: HashSet<Symbol> =
            self.states.iter().map(|y| y.symbol).chain(self.unknowns()).filter(|s| !needed.contains(s)).collect();
        self.states.retain(|y| !dropped.contains(&y.symbol));
        self.blocks.retain(|b| b.unknowns.iter().any(|z| !dropped.contains(z)));
        if !dropped.is_empty() {
            let is_kept = |i: &Named| symbols_behind(&g, &self.definitions, [i.expression]).is_disjoint(&dropped);
            let mut own = self.invariants.split_off(self.invariants.len() - self.watched);
            self.invariants.retain(is_kept);
            own.retain(is_kept);
            self.watched = own.len();
            self.invariants.extend(own);
        }
        self.graph = g;
    }

    fn name_quadratures(&mut self) {
        let g = &self.graph;
        let rates = self.states.iter().map(|y| y.rate);
        let used =
            symbols_behind(g, &self.definitions, rates.chain(self.blocks.iter().flat_map(|b| b.residuals.clone())));
        let quadratures: Vec<Symbol> = self
            .states
            .iter()
            .filter(|y| matches!(y.role, Role::Position | Role::Memory | Role::DisplacementParameter))
            .map(|y| y.symbol)
            .filter(|symbol| !used.contains(symbol))
            .collect();
        if !quadratures.is_empty() {
            let words = "in no equation of motion; found by quadrature along the way".into();
            self.left_out.push(LeftOut { variables: quadratures, words });
        }
    }
}
