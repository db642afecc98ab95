//! Systems built backwards: what is known to have a measure and integrals has them in random coordinates,
//! with random combinations of constraints; with a random term in its energy it has none.
//!
//! `INTEGRALS=200` tries 200 of each.

use decision::ExactStart;
use integrals::{Measure, Reversed, reversible};
use mechanics::{Completion, State, System};
use symbolic::{Expr, Graph, SplitMix, Symbol};

use crate::questions::built_in;

/// Systems each of the tests tries, by default.
const SAMPLE: u64 = 3;

fn sample() -> u64 {
    std::env::var("INTEGRALS").map_or(SAMPLE, |count| count.parse().expect("a number of systems"))
}

struct Random(SplitMix);

impl Random {
    /// An integer from −3 to 3, not zero.
    fn small(&mut self) -> i64 {
        [-3, -2, -1, 1, 2, 3][(self.0.bits() % 6) as usize]
    }

    /// `Σ` of two random monomials of degree 1 and 2 in these.
    fn polynomial(&mut self, g: &Graph, of: &[Symbol]) -> Expr {
        let mut any = || g.variable(of[(self.0.bits() % of.len() as u64) as usize]);
        let (a, b, c) = (any(), any(), any());
        let (i, j) = (self.small(), self.small());
        g.add(g.mul(g.integer(i), a), g.mul(g.ratio(j, 5), g.mul(b, c)))
    }
}

/// `q_i = Q_i + p_i(Q_{i+1}, …)` with polynomials `p_i`, and `f` times a matrix with ones on its diagonal.
fn in_random_coordinates(system: &System, random: &mut Random) -> System {
    let (g, q) = (&system.graph, system.positions());
    let mut changed = system.clone();
    let mut map = std::collections::HashMap::new();
    for (i, c) in system.coordinates.iter().enumerate() {
        let own = g.variable(c.position);
        let new = if i + 1 < q.len() { g.add(own, random.polynomial(g, &q[i + 1..])) } else { own };
        map.insert(c.position, new);
        map.insert(c.velocity, g.total_derivative(new, &system.flow()));
    }
    changed.lagrangian = g.substitute(system.lagrangian, &map);
    changed.constraints = g.substitute_all(&system.constraints, &map);
    for i in 1..changed.constraints.len() {
        let factor = random.polynomial(g, &q);
        changed.constraints[i] = g.add(changed.constraints[i], g.mul(factor, changed.constraints[i - 1]));
    }
    // that of a clone does not have them
    changed.graph = g.clone();
    changed
}

fn asked(system: &System, degree: usize) -> Reversed {
    let n = system.dimension();
    let state = State { t: 0.0, q: vec![0.5; n], v: vec![0.0; n] };
    let start = ExactStart::new(system, &state, &Completion::default(), None).expect("a start");
    reversible(system, &start, degree)
}

#[test]
fn what_is_there_is_found_in_any_coordinates() {
    let mut random = Random(SplitMix::new(41));
    for round in 0..sample() {
        for (name, has_measure, linear) in [
            ("particle", true, 4),
            ("heisenberg", true, 5),
            ("sleigh", false, 2),
            ("martinet", true, 4),
            ("veselova", true, 2),
        ] {
            let system = in_random_coordinates(&built_in(name, &[]).system, &mut random);
            let found = asked(&system, 1);
            assert_eq!(matches!(found.measure, Measure::Local { .. }), has_measure, "{name}, round {round}: {found:?}");
            let integrals = found.integrals[0].as_ref().unwrap_or_else(|open| panic!("{name}: {open}"));
            assert_eq!((integrals.count, integrals.settled), (linear, true), "{name}, round {round}");
        }
    }
}

/// Quadratic integrals, those among them that linear ones and the energy make; the number is settled.
#[test]
fn what_is_quadratic_is_found_in_any_coordinates() {
    let mut random = Random(SplitMix::new(47));
    for round in 0..sample().div_ceil(3) {
        for (name, count, trivial) in [("sleigh", 4, 4), ("particle", 11, 11), ("martinet", 11, 11), ("veselova", 5, 5)]
        {
            let system = in_random_coordinates(&built_in(name, &[]).system, &mut random);
            let found = asked(&system, 2);
            let integrals = found.integrals[1].as_ref().unwrap_or_else(|open| panic!("{name}: {open}"));
            assert_eq!((integrals.count, integrals.trivial), (count, trivial), "{name}, round {round}: {integrals:?}");
        }
    }
}

#[test]
fn what_is_perturbed_is_proved_to_have_none() {
    let mut random = Random(SplitMix::new(43));
    for round in 0..sample() {
        for name in ["particle", "heisenberg", "martinet"] {
            let mut system = in_random_coordinates(&built_in(name, &[]).system, &mut random);
            let (g, q, v) = (system.graph.clone(), system.positions(), system.velocities());
            for &v in &v[..2] {
                // every coordinate is in it: one that was left out may have a momentum
                let linear = q.iter().map(|&q| g.mul(g.integer(random.small()), g.variable(q))).collect::<Vec<_>>();
                let (rate, factor) = (g.variable(v), g.add(g.sum(&linear), random.polynomial(&g, &q)));
                // ½ (1 + p²) v² is a kinetic energy, too
                let more = g.product(&[g.ratio(1, 2), g.powi(factor, 2), g.powi(rate, 2)]);
                system.lagrangian = g.add(system.lagrangian, more);
            }
            system.graph = g;
            let found = asked(&system, 1);
            assert_eq!(found.measure, Measure::None { proved: true }, "{name}, round {round}");
            let integrals = found.integrals[0].as_ref().unwrap_or_else(|open| panic!("{name}: {open}"));
            assert!(integrals.none_proved() && integrals.count == 0, "{name}, round {round}: {integrals:?}");
        }
    }
}
