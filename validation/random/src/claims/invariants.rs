//! T6 and T7: energy and momenta, written out here and not taken from what is judged.

use equations::Outputs;
use mechanics::System;
use motion::{CERTAINTY, Motion, SolveError};
use symbolic::limits::OF_TERMS;
use symbolic::{Bounded, Expr, Scalar, Symbol};

use super::CheckError;
use crate::Case;
use motion::band::INSTANTS;

/// A quantity along a motion, with its error estimate.
struct Drift {
    /// Largest change from the start.
    change: f64,
    /// What the errors explain.
    limit: f64,
}

impl Drift {
    fn is_certain(&self) -> bool {
        self.change > self.limit
    }
}

/// Follows `e(t, q, v, multipliers)` along a motion, whose first multipliers `multipliers` names; what they
/// are factors of is known to a part `floor`.
fn drift(
    system: &System,
    e: Expr,
    multipliers: &[Symbol],
    motion: &mut Motion,
    floor: f64,
) -> Result<Drift, SolveError> {
    let symbols = [&[system.time], &system.positions()[..], &system.velocities(), multipliers].concat();
    let mut evaluator = system.evaluator::<Bounded>(&symbols, &[e])?;
    let mut value = |t: f64, o: &Outputs| {
        let read = [&[t], &o.coordinates[..], &o.velocities, &o.multipliers[..multipliers.len()]].concat();
        let read: Vec<Bounded> = read.into_iter().map(Bounded::from_f64).collect();
        evaluator.evaluate(&read)[0]
    };
    let (mut first, mut change, mut error, mut size) = (None, 0.0_f64, 0.0_f64, 1.0_f64);
    for t in motion.grid(INSTANTS) {
        let (kept, looser) = motion.at_in_both_runs(t)?;
        let (now, other) = (value(t, &kept), value(t, &looser));
        let start = *first.get_or_insert(now.value);
        change = change.max((now.value - start).abs());
        error = error.max((now.value - other.value).abs());
        // terms μ_i A_ij, P_k B_k may cancel: of nearly dependent constraints they are large
        let multiplier = kept.multipliers.iter().fold(0.0_f64, |largest, mu| largest.max(mu.abs()));
        size = size.max(now.magnitude).max(kept.velocities.iter().map(|v| v * v).sum()).max(multiplier);
    }
    Ok(Drift { change, limit: CERTAINTY * (error + OF_TERMS * size) + floor * size })
}

/// T6: `v·L_v − L` for Chetaev where nothing depends on time, no force acts, and `f` is homogeneous; with
/// `𝓛 = L + μ·f`, and with `G`, for the others wherever nothing depends on time and no force acts.
pub(super) fn energy(case: &mut Case) -> Result<(), CheckError> {
    let system = case.scene.system.clone();
    let g = &system.graph;
    if !system.is_autonomous() || system.has_forces() {
        return Ok(());
    }
    let (v, floor) = (system.velocities(), case.floor);
    let of = |l: Expr| g.sub(g.dot(&g.variables(&v), &g.gradient(l, &v)), l);
    let plain = of(system.lagrangian);
    let drifted = drift(&system, plain, &[], &mut case.chetaev, 0.0)?;
    if case.recipe.is_homogeneous() {
        case.found.bound(6, "Chetaev: energy", drifted.change, drifted.limit);
    } else {
        case.found.count(6, "affine constraints, and Chetaev's energy is not constant", drifted.is_certain());
    }
    let mu: Vec<Symbol> = (0..system.constraints.len()).map(|i| g.symbol(&format!("multiplier {i}"))).collect();
    let augmented = g.add(system.lagrangian, g.dot(&g.variables(&mu), &system.constraints));
    let drifted = drift(&system, of(augmented), &mu, &mut case.vakonomic, floor)?;
    case.found.bound(6, "vakonomic: energy", drifted.change, drifted.limit);
    for removed in &mut case.removed {
        let removal = &removed.removal;
        // G = L + P·B in (u̇, q), with u̇ and P read from what the motion gives out
        let names: Vec<String> = removed.motion.equations.multipliers.iter().map(|m| m.name.clone()).collect();
        let read_out: Vec<Symbol> = names.iter().map(|name| g.symbol(&format!("{name} of removal"))).collect();
        let costate = |w: &mechanics::MemoryVariable| {
            let name = format!("P_{}", g.name(w.symbol));
            names.iter().position(|n| *n == name).map_or(g.zero(), |k| g.variable(read_out[k]))
        };
        let coupling: Vec<Expr> = removal.memory.iter().map(|w| g.mul(costate(w), w.rate)).collect();
        let generating = g.add(removal.rewrite(&system, system.lagrangian), g.sum(&coupling));
        let terms = removal.parameters.iter().map(|u| g.mul(g.variable(u.rate), g.derivative(generating, u.rate)));
        let energy = g.sub(g.sum(&terms.collect::<Vec<_>>()), generating);
        // u̇ from (q, v): what the removal says of its own start holds all along
        let energy = g.substitute(energy, &removal.start.iter().map(|(&s, &e)| (s, e)).collect());
        let drifted = drift(&system, energy, &read_out, &mut removed.motion, floor)?;
        case.found.bound(6, "removed constraint: energy", drifted.change, drifted.limit);
    }
    Ok(())
}

/// T7: `∂𝓛/∂v_i` of every coordinate in neither `L` nor `f` on which no force acts.
pub(super) fn momentum(case: &mut Case) -> Result<(), CheckError> {
    let system = case.scene.system.clone();
    let g = &system.graph;
    let floor = case.floor;
    let mu: Vec<Symbol> = (0..system.constraints.len()).map(|i| g.symbol(&format!("multiplier {i}"))).collect();
    let augmented = g.add(system.lagrangian, g.dot(&g.variables(&mu), &system.constraints));
    for (c, &force) in system.coordinates.iter().zip(&system.forces) {
        let occurs = |e: &Expr| g.depends_on(*e, c.position);
        if occurs(&system.lagrangian) || system.constraints.iter().any(occurs) || !g.is_zero(force) {
            continue;
        }
        let momentum = g.derivative(augmented, c.velocity);
        let drifted = drift(&system, momentum, &mu, &mut case.vakonomic, floor)?;
        case.found.bound(7, "vakonomic: momentum of a cyclic coordinate", drifted.change, drifted.limit);
        if system.constraints.iter().any(|&f| g.depends_on(f, c.velocity)) {
            let plain = g.derivative(system.lagrangian, c.velocity);
            let drifted = drift(&system, plain, &[], &mut case.chetaev, 0.0)?;
            case.found.count(
                7,
                "a constraint acts on a cyclic coordinate, and Chetaev does not keep its momentum",
                drifted.is_certain(),
            );
        }
    }
    Ok(())
}
