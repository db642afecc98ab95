//! Functions of an ansatz: monomials in velocities, and in coordinates or their sines and cosines.

use mechanics::System;
use symbolic::{Expr, Symbol};

use crate::Open;
use crate::killing::velocity_monomials;

/// Most functions, and the highest degree in coordinates, or in their sines and cosines: unasked, and where
/// the coordinates are chosen.
const UNASKED: (usize, usize) = (420, 4);
const CHOSEN: (usize, usize) = (1000, 6);
/// More monomials in the velocities are not taken: the memory grows as their square.
const LARGEST: usize = 2000;

/// A function of the ansatz.
#[derive(Clone, Debug)]
pub(crate) struct Function {
    pub(crate) expression: Expr,
    /// Degree in the velocities.
    pub(crate) degree: usize,
    pub(crate) is_energy: bool,
}

pub(crate) fn chosen(system: &System, names: &[String]) -> Result<Vec<usize>, Open> {
    if names.is_empty() {
        let written = system.written();
        let present = |i: &usize| written.iter().any(|&e| system.graph.depends_on(e, system.coordinates[*i].position));
        return Ok((0..system.dimension()).filter(present).collect());
    }
    let place = |name: &String| {
        let place = system.coordinates.iter().position(|c| c.name == *name);
        place.ok_or_else(|| {
            let all: Vec<&str> = system.coordinates.iter().map(|c| &c.name[..]).collect();
            Open::Name { name: name.clone(), all: all.join(", ") }
        })
    };
    names.iter().map(place).collect()
}

/// Monomials in velocities times monomials in coordinates, or in sines and cosines of angles, simple ones
/// first; with the energy and the momenta. Their degree in coordinates is as high as few functions allow.
pub(crate) fn functions(
    system: &System,
    multipliers: &[Symbol],
    places: &[usize],
    are_chosen: bool,
    degree: usize,
) -> Result<(usize, Vec<Function>), Open> {
    let g = &system.graph;
    let fast: Vec<Symbol> = system.velocities().into_iter().chain(multipliers.iter().copied()).collect();
    let v = g.variables(&fast);
    // the motion with multipliers is that of L + μ·f, without constraints
    let coupled = multipliers.iter().zip(&system.constraints).map(|(&mu, &f)| g.mul(g.variable(mu), f));
    let free = coupled.fold(system.lagrangian, |sum, term| g.add(sum, term));
    let rates = system.velocities();
    // v·∂f/∂v = f: multipliers have no part in the energy
    let homogeneous = system.constraints.iter().all(|&f| {
        let along = g.dot(&g.variables(&rates), &g.gradient(f, &rates));
        g.vanishes_exactly(g.sub(along, f))
    });
    let of_energy = if homogeneous { system.lagrangian } else { free };
    let fast = velocity_monomials(v.len(), degree);
    let mut fast: Vec<Vec<usize>> =
        fast.into_iter().chain(degree.checked_sub(1).map_or(Vec::new(), |d| velocity_monomials(v.len(), d))).collect();
    if fast.len() > LARGEST {
        return Err(Open::Functions { found: fast.len(), most: LARGEST });
    }
    fast.sort_by_key(Vec::len);
    let mut spatial = 0;
    let mut slow = vec![(0, g.one())];
    let (functions, highest) = if are_chosen { CHOSEN } else { UNASKED };
    for most in 1..=highest {
        let more = spatial_monomials(system, places, most);
        if more.len() * fast.len() > functions {
            break;
        }
        (spatial, slow) = (most, more);
    }
    slow.sort_by_key(|(d, _)| *d);
    let mut all: Vec<Function> = Vec::new();
    let push = |all: &mut Vec<Function>, expression: Expr, degree: usize, is_energy: bool| {
        if g.as_number(expression).is_none() {
            all.push(Function { expression, degree, is_energy });
        }
    };
    for d in 0..=degree {
        if d == 2 {
            push(&mut all, energy(system, of_energy), 2, true);
        }
        for (_, place) in &slow {
            for monomial in fast.iter().filter(|m| m.len() == d) {
                let factors: Vec<Expr> = monomial.iter().map(|&c| v[c]).chain([*place]).collect();
                push(&mut all, g.product(&factors), d, false);
            }
        }
        if d == 1 {
            for momentum in g.gradient(free, &rates) {
                push(&mut all, momentum, 1, false);
            }
        }
    }
    Ok((spatial, all))
}

/// The energy of `L`, without its terms that cancel where `L` is quadratic in the velocities: `L − 2 L(v =
/// 0)`.
fn energy(system: &System, lagrangian: Expr) -> Expr {
    let (g, v) = (&system.graph, system.velocities());
    let short = g.sub(lagrangian, g.mul(g.integer(2), system.at_rest(&[lagrangian])[0]));
    let energy = g.sub(g.dot(&g.variables(&v), &g.gradient(lagrangian, &v)), lagrangian);
    if g.vanishes_exactly(g.sub(short, energy)) { short } else { energy }
}

fn spatial_monomials(system: &System, places: &[usize], most: usize) -> Vec<(usize, Expr)> {
    let g = &system.graph;
    let mut all = vec![(0, g.one())];
    for &i in places {
        let q = g.variable(system.coordinates[i].position);
        let own: Vec<(usize, Expr)> = if is_angle(system, i) {
            let (sine, cosine) = (g.call(symbolic::Function::Sin, q), g.call(symbolic::Function::Cos, q));
            let powers = (0..=most).map(|k| (k, g.powi(cosine, k as i32)));
            // sin² = 1 − cos²
            powers.clone().chain(powers.map(|(k, power)| (k + 1, g.mul(sine, power)))).collect()
        } else {
            (0..=most).map(|k| (k, g.powi(q, k as i32))).collect()
        };
        all = all
            .iter()
            .flat_map(|&(d, e)| own.iter().map(move |&(k, x)| (d + k, e, x)))
            .filter(|(d, ..)| *d <= most)
            .map(|(d, e, x)| (d, g.mul(e, x)))
            .collect();
    }
    all
}

/// Whether `L` and `f` stay when a coordinate grows by 2π, which is seen in doubles: only what the ansatz
/// contains depends on it. One that they do not contain is an angle if its unit says so.
fn is_angle(system: &System, place: usize) -> bool {
    let (g, coordinate) = (&system.graph, &system.coordinates[place]);
    let written = system.written();
    if !written.iter().any(|&e| g.depends_on(e, coordinate.position)) {
        return coordinate.unit == "rad";
    }
    let mut random = symbolic::SplitMix::new(7);
    let mut values = system.parameter_values();
    for symbol in system.positions().into_iter().chain(system.velocities()).chain([system.time]) {
        values.insert(symbol, random.unit());
    }
    let before: Vec<f64> = written.iter().filter_map(|&e| g.evaluate(e, &values).ok()).collect();
    if let Some(q) = values.get_mut(&coordinate.position) {
        *q += std::f64::consts::TAU;
    }
    let after: Vec<f64> = written.iter().filter_map(|&e| g.evaluate(e, &values).ok()).collect();
    before.iter().zip(&after).all(|(a, b)| (a - b).abs() <= 1e-9 * (1.0 + a.abs()))
}
