//! Chains in minimal coordinates: velocities of their bodies become rates of additional coordinates.
//!
//! In minimal coordinates, the kinetic energy of a chain is a sum of squares of velocities, each containing
//! an earlier one,
//!
//! ```text
//! ½ Σ c_k ż_k² ,      ż_k = ż_before + Σ d_kj(q) v_j      (few j),
//! ```
//!
//! and its matrix in `v` is full. Where the forms `d_k` are closed, `ż_k` is the rate of a function of `q`:
//! with `z` as coordinates and `ż_k − ż_before − d_k v = 0` as constraints, which are integrable, the motions
//! are the same. `L` is then short, as are constraints of the system once they are written in `ż` too; the
//! elimination of all constraints is sparse. No equation contains `z` itself: it does not become a state.

use std::collections::{HashMap, HashSet};

use equations::{Equations, Named, Role};
use mechanics::elimination::LinearForms;
use mechanics::{Coordinate, System, fresh_symbol};
use symbolic::limits::NOTHING;
use symbolic::{Expr, Graph, Symbol};

use crate::expressions::{Sparse, point, shortest};

/// A velocity that is squared in `L`.
struct Link {
    /// `ż` as it is written, in `(q, v)`.
    written: Expr,
    /// The same, velocity by velocity.
    row: Sparse,
    /// The link that it contains.
    before: Option<usize>,
    /// The rest, without that link.
    own: Sparse,
}

/// A system with the velocities that are squared in its `L` as rates of coordinates.
pub(crate) struct Chain {
    /// Coordinates and constraints of the system itself come first, in their order.
    pub(crate) system: System,
    coordinates: usize,
    constraints: usize,
    /// `ż` as they are written.
    written: HashMap<Symbol, Expr>,
    /// Whether `L` is half as long, or less.
    pub(crate) halves: bool,
}

impl Chain {
    /// `None` where this does not make it shorter.
    pub(crate) fn new(system: &System) -> Option<Chain> {
        let g = &system.graph;
        let links = links(system);
        let length = |link: &Link| link.own.len() + usize::from(link.before.is_some());
        let [short, long] = [links.iter().map(length).sum::<usize>(), links.iter().map(|link| link.row.len()).sum()];
        if short >= long {
            return None;
        }
        let forms = system.linear_constraints().ok()?;
        let mut lifted = system.clone();
        for k in 1..=links.len() {
            let fresh = |primes: &str| fresh_symbol(g, &format!("z_{k}{primes}"));
            let (position, velocity, acceleration) = (fresh(""), fresh("'"), fresh("''"));
            let (name, unit) = (g.name(position), String::new());
            lifted.coordinates.push(Coordinate { name, unit, position, velocity, acceleration });
            lifted.forces.push(g.zero());
        }
        let (coordinates, constraints) = (system.dimension(), system.constraints.len());
        let (v, rates) = (g.variables(&system.velocities()), lifted.velocities().split_off(coordinates));
        let z = g.variables(&rates);
        let by_velocity = |row: &Sparse| row.iter().map(|(&j, &e)| g.mul(e, v[j])).collect::<Vec<Expr>>();
        lifted.lagrangian = g.replace(system.lagrangian, &links.iter().map(|l| l.written).zip(z.clone()).collect());
        let search = Search { system, links: &links, values: point(system, None) };
        for (i, row) in forms.rows.iter().enumerate() {
            if let Some((by_links, rest)) = search.shorter(row) {
                let by_links = by_links.into_iter().map(|(k, c)| g.mul(c, z[k]));
                let terms: Vec<Expr> = by_links.chain(by_velocity(&rest)).chain([forms.offsets[i]]).collect();
                lifted.constraints[i] = g.sum(&terms);
            }
        }
        for (link, &rate) in links.iter().zip(&z) {
            let mut terms = by_velocity(&link.own);
            terms.extend(link.before.map(|k| z[k]));
            lifted.constraints.push(g.sub(rate, g.sum(&terms)));
        }
        lifted.graph = g.clone();
        let written = rates.into_iter().zip(links.iter().map(|link| link.written)).collect();
        Some(Chain { system: lifted, coordinates, constraints, written, halves: 2 * short <= long })
    }

    /// The equations of `system` itself, from those derived for [`Chain::system`].
    ///
    /// Costates of `z` are constant: zero, by the free constants of its constraints, which choose no motion.
    pub(crate) fn own(&self, system: &System, mut equations: Equations) -> Equations {
        let graph = std::mem::take(&mut equations.graph);
        let g = &graph;
        let positions: Vec<Symbol> = self.system.positions().split_off(self.coordinates);
        let costates: Vec<(Symbol, Expr)> =
            equations.states.iter().filter(|y| y.role == Role::Costate).map(|y| (y.symbol, y.start)).collect();
        let costates = costates.get(self.coordinates..).unwrap_or_default();
        let mut starts = self.written.clone();
        let further = equations.free_constants.iter().skip(self.constraints);
        for ((_, start), constant) in costates.iter().zip(further).rev() {
            // 0 = ν + …, in constants of later links
            let rest = g.sub(*start, g.variable(constant.symbol));
            starts.insert(constant.symbol, g.neg(g.substitute(rest, &starts)));
        }
        let zeros: HashMap<Symbol, Expr> = costates.iter().map(|(p, _)| (*p, g.zero())).collect();
        let put_in = |e: &mut Expr| *e = g.substitute(*e, &zeros);

        equations.states.retain(|y| !positions.contains(&y.symbol) && !zeros.contains_key(&y.symbol));
        for y in &mut equations.states {
            put_in(&mut y.rate);
            y.start = g.substitute(y.start, &starts);
        }
        for block in &mut equations.blocks {
            block.residuals.iter_mut().for_each(put_in);
            block.guess = g.substitute_all(&block.guess, &starts);
        }
        equations.definitions.iter_mut().for_each(|(_, e)| put_in(e));
        equations.derivatives.iter_mut().for_each(|(_, e)| put_in(e));
        equations.statements.iter_mut().for_each(|s| [&mut s.left, &mut s.right].into_iter().for_each(put_in));
        equations.statements.retain(|s| s.meaning != "costate" || !g.is_zero(s.right));
        equations.invariants.iter_mut().for_each(|i| put_in(&mut i.expression));
        equations.invariants.retain(|i| !g.is_zero(i.expression));
        if costates.is_empty() {
            equations.invariants.extend(self.momenta(system, g));
        }
        equations.multipliers.truncate(self.constraints);
        equations.free_constants.truncate(self.constraints);
        equations.coordinates.truncate(self.coordinates);
        equations.velocities.truncate(self.coordinates);
        equations.graph = graph;
        equations
    }

    /// Momenta without reactions along coordinates that `L` does not contain: those that `ż` contain too.
    fn momenta(&self, system: &System, g: &Graph) -> Vec<Named> {
        let bound: HashSet<Symbol> = system.constraints.iter().flat_map(|&f| g.symbols_of(f)).collect();
        let linked: HashSet<Symbol> = self.written.values().flat_map(|&e| g.symbols_of(e)).collect();
        let free = |(c, force): &(&Coordinate, &Expr)| {
            let held = g.depends_on(system.lagrangian, c.position) || bound.contains(&c.velocity);
            !held && linked.contains(&c.velocity) && g.is_zero(**force)
        };
        let momentum = |(c, _): (&Coordinate, &Expr)| Named {
            name: format!("momentum {}", c.name),
            expression: g.derivative(system.lagrangian, c.velocity),
        };
        system.coordinates.iter().zip(&system.forces).filter(free).map(momentum).collect()
    }
}

/// The velocities that are squared in `L`, linear in `v`, short ones first.
fn links(system: &System) -> Vec<Link> {
    let g = &system.graph;
    let v = system.velocities();
    let forms = g.squared_sums(system.lagrangian).into_iter().filter_map(|written| {
        let LinearForms { mut rows, offsets } = LinearForms::new(g, &[written], &v).ok()?;
        let row = rows.pop()?;
        (row.len() > 1 && g.is_zero(offsets[0])).then_some((written, row))
    });
    let mut forms: Vec<(Expr, Sparse)> = forms.collect();
    forms.sort_by_key(|(_, row)| row.len());
    let mut links: Vec<Link> = Vec::new();
    for (written, row) in forms {
        let apart = |link: &Link| {
            let shared = row.iter().filter(|(j, e)| link.row.get(j) == Some(e)).count();
            row.len() + link.row.len() - 2 * shared
        };
        let before = (0..links.len()).min_by_key(|&k| apart(&links[k])).filter(|&k| apart(&links[k]) < row.len() - 1);
        let own = before.map_or_else(|| row.clone(), |k| difference(g, &row, &links[k].row));
        if system.is_total_derivative(&own) {
            links.push(Link { written, row, before, own });
        }
    }
    links
}

/// `a − b`
fn difference(g: &Graph, a: &Sparse, b: &Sparse) -> Sparse {
    let mut difference = a.clone();
    for (&j, &e) in b {
        let rest = g.sub(a.get(&j).copied().unwrap_or(g.zero()), e);
        difference.insert(j, rest);
    }
    difference.retain(|_, e| !g.is_zero(*e));
    difference
}

struct Search<'a> {
    system: &'a System,
    links: &'a [Link],
    /// Numbers of no significance.
    values: HashMap<Symbol, f64>,
}

impl Search<'_> {
    /// A linear form as `Σ c_k ż_k` and a rest, if these have fewer terms.
    fn shorter(&self, row: &Sparse) -> Option<(Vec<(usize, Expr)>, Sparse)> {
        let (g, links) = (&self.system.graph, self.links);
        let within = |k: &usize| links[*k].row.len() <= row.len() && links[*k].row.keys().all(|j| row.contains_key(j));
        let longest = (0..links.len()).filter(within).map(|k| links[k].row.len()).max()?;
        let longest: Vec<usize> = (0..links.len()).filter(|k| links[*k].row.len() == longest && within(k)).collect();
        // a velocity that only one of them contains tells how often it does
        let factor = |&k: &usize| {
            let others = || longest.iter().filter(|&&other| other != k);
            let (j, e) = links[k].row.iter().find(|(j, _)| others().all(|&other| !links[other].row.contains_key(j)))?;
            Some((k, g.div(row[j], *e)))
        };
        let factors: Vec<(usize, Expr)> = longest.iter().filter_map(factor).collect();
        let (mut rest, mut cancelled) = (Sparse::new(), Vec::new());
        for (&j, &e) in row {
            let by_links = factors.iter().filter_map(|&(k, c)| Some(g.neg(g.mul(c, *links[k].row.get(&j)?))));
            let terms: Vec<Expr> = [e].into_iter().chain(by_links).collect();
            let numbers: Vec<f64> = terms.iter().map(|&e| g.evaluate(e, &self.values).unwrap_or(f64::NAN)).collect();
            let largest = numbers.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            if numbers.iter().sum::<f64>().abs() <= NOTHING * largest {
                cancelled.push(g.mul(g.sum(&terms), g.variable(self.system.coordinates[j].velocity)));
            } else {
                rest.insert(j, shortest(g, g.sum(&terms)));
            }
        }
        let short = factors.len() + rest.len() < row.len();
        (short && g.vanishes_exactly(g.sum(&cancelled))).then_some((factors, rest))
    }
}
