//! The removal of a random system.

use std::collections::BTreeMap;

use mechanics::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal};
use symbolic::Expr;

use super::{Builder, REMOVAL};
use crate::Kind;
use crate::recipe::Shape;

impl Builder<'_> {
    /// `v_i = S(q) u̇` with `S` lower triangular and positive on its diagonal, all coordinates memory; for
    /// nonlinear constraints, and where `S = 1`, the independent coordinates themselves.
    pub(super) fn removal(&self) -> Removal {
        let g = &self.system.graph;
        let plain = self.recipe.kind == Kind::Nonlinear;
        let mut entries = self.recipe.removal.iter();
        let (mut parameters, mut rates, mut start, mut memory) = (Vec::new(), Vec::new(), BTreeMap::new(), Vec::new());
        let mut start_rates: Vec<Expr> = Vec::new();
        for (j, &i) in self.independent.iter().enumerate() {
            if plain {
                let c = &self.system.coordinates[i];
                let (symbol, rate, second_rate) = (c.position, c.velocity, c.acceleration);
                parameters.push(DisplacementParameter { symbol, rate, second_rate, coordinate: Some(i) });
                rates.push(self.v(i));
                continue;
            }
            let symbols = ["", "'", "''"].map(|primes| g.symbol(&format!("u{}{primes}", j + 1)));
            let [symbol, rate, second_rate] = symbols;
            let row: Vec<Expr> = (0..=j)
                .map(|k| {
                    let &(coefficient, place) = entries.next().unwrap_or(&(0, 0));
                    match k == j {
                        true => self.factor(2 * coefficient, place, &self.occurring),
                        false => g.mul(g.ratio(coefficient, 16), self.shape(Shape::Sine, place, None, &self.occurring)),
                    }
                })
                .collect();
            start_rates.push(g.div(g.sub(self.v(i), g.dot(&row[..j], &start_rates)), row[j]));
            start.insert(symbol, g.zero());
            start.insert(rate, start_rates[j]);
            let u: Vec<Expr> = parameters.iter().map(|u: &DisplacementParameter| g.variable(u.rate)).collect();
            parameters.push(DisplacementParameter { symbol, rate, second_rate, coordinate: None });
            rates.push(g.add(g.dot(&row[..j], &u), g.mul(row[j], g.variable(rate))));
            memory.push(MemoryVariable { symbol: self.position(i), rate: rates[j], coordinate: Some(i) });
        }
        let dependent = self.dependent_rates(&rates);
        memory.extend(self.dependent.iter().zip(dependent).map(|(&d, rate)| MemoryVariable {
            symbol: self.position(d),
            rate,
            coordinate: Some(d),
        }));
        memory.sort_by_key(|w| w.coordinate);
        Removal {
            name: REMOVAL.into(),
            parameters,
            memory,
            coordinates: g.variables(&self.system.positions()),
            start,
            constants: ConstantsRule::Zero,
            chart: Vec::new(),
        }
    }
}
