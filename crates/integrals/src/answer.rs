//! All answers about a scene.

use std::iter::zip;

use comparison::Contradicted;
use decision::{DecisionError, ExactStart};
use mechanics::{Constancy, Domain, System, Watched};
use motion::{CHETAEV, Choice, Settings, SolveError, derive, solve_choice};
use scene::Scene;
use symbolic::{Expr, Graph, Symbol};

use crate::ansatz::{self, ansatz};
use crate::{Ansatz, Open, Printed, Reversed, constants, reversible};

/// Tolerance of the motion along which what is printed is looked at, and times at which it is.
const TOLERANCE: f64 = 1e-12;
const TIMES: u32 = 50;
/// An integral that changes by more than this part is none on the motion.
pub(crate) const CHANGED: f64 = 1e-3;

/// Measures and integrals of a scene's motions under one formulation.
#[derive(Clone)]
pub struct Integrals {
    /// The scene.
    pub scene: Scene,
    /// Name of the formulation.
    pub formulation: &'static str,
    /// Without an ansatz; `None` for a formulation other than Chetaev's.
    pub reversed: Option<Reversed>,
    /// In the ansatz.
    pub ansatz: Result<Ansatz, Open>,
    /// Largest change of each integral that is printed along the scene's own motion, in parts of the sum of
    /// its terms without signs; or why there is no such motion.
    pub drifts: Result<Vec<f64>, String>,
    /// Names of the scene's invariants, with whether they are constant on almost every motion.
    pub invariants: Result<Vec<(String, bool)>, Open>,
}

/// Why nothing is answered.
#[derive(Debug, thiserror::Error)]
pub enum NoAnswer {
    /// A name that is no coordinate, or equations that cannot be followed over a finite field.
    #[error(transparent)]
    Open(Open),
    /// The start cannot be read in exact numbers.
    #[error(transparent)]
    Start(#[from] DecisionError),
    /// There are no equations of motion.
    #[error(transparent)]
    Equations(#[from] SolveError),
    /// Answers exclude each other.
    #[error(transparent)]
    Contradicted(#[from] Contradicted),
}

impl Integrals {
    /// Decides about integrals up to `degree` in the velocities; functions of the ansatz contain the
    /// coordinates `names`, or those in `L` and `f` where there are none.
    ///
    /// # Errors
    /// [`NoAnswer`]. What stays open is an answer.
    pub fn find(scene: &Scene, choice: &Choice, degree: usize, names: &[String]) -> Result<Self, NoAnswer> {
        let system = &scene.system;
        let start = ExactStart::new(system, &scene.start, &scene.completion, choice.removal.as_ref())?;
        let reversed = (choice.formulation.name == CHETAEV.name).then(|| reversible(system, &start, degree));
        let equations = derive(system, choice)?;
        let ansatz = Open::unless(|| ansatz(system, &equations, &start, degree, names));
        if let Err(fault @ Open::Name { .. }) = ansatz {
            return Err(NoAnswer::Open(fault));
        }
        let own: Vec<&Watched> = system.watched.iter().filter(|watched| watched.is_constant()).collect();
        let expressions: Vec<_> = own.iter().map(|watched| watched.expression).collect();
        let held = Open::unless(|| constants(system, &equations, &start, &expressions));
        let invariants = held.map(|held| zip(own.iter().map(|watched| watched.name.clone()), held).collect());
        let printed = ansatz.as_ref().map_or(&[][..], |found| &found.printed);
        let drifts = drifts(scene, choice, printed);
        let formulation = choice.formulation.name;
        let found = Integrals { scene: scene.clone(), formulation, reversed, ansatz, drifts, invariants };
        let contradictions = found.contradictions();
        if contradictions.is_empty() { Ok(found) } else { Err(Contradicted(contradictions).into()) }
    }

    /// What cannot be true beside each other.
    fn contradictions(&self) -> Vec<String> {
        let name = &self.scene.name;
        let mut all: Vec<String> = Vec::new();
        let linear = self.reversed.as_ref().and_then(|found| found.integrals.first()?.as_ref().ok());
        if let (Some(linear), Ok(found)) = (linear, &self.ansatz) {
            let printed = found.printed.iter().filter(|p| p.is_linear).count();
            if printed > linear.count {
                all.push(format!("{name}: at most {} linear integrals, but {printed} are printed", linear.count));
            }
        }
        // a motion may leave the branch of its start
        if let (Ok(found), Ok(drifts), false) = (&self.ansatz, &self.drifts, Domain::of(&self.scene.system).branch) {
            let changed = zip(&found.printed, drifts).filter(|(_, drift)| **drift > CHANGED);
            all.extend(changed.map(|(p, drift)| format!("{name}: {} = const, which changes by {drift:.0e}", p.text)));
        }
        let open = self.reversed.iter().flat_map(|found| &found.integrals).filter_map(|found| found.as_ref().err());
        let faults = open.chain(self.ansatz.as_ref().err()).filter(|open| matches!(open, Open::Contradiction(_)));
        all.extend(faults.map(|fault| format!("{name}: {fault}")));
        if linear.is_some_and(|found| found.count == 0) {
            let held =
                self.invariants.iter().flatten().filter(|(own, held)| *held && is_linear(&self.scene.system, own));
            all.extend(held.map(|(own, _)| format!("{name}: no linear integral, but `{own}` is one")));
        }
        all
    }
}

/// What the ansatz writes down about the motion of `choice`, up to degree 2, as quantities that are watched
/// along it: those that contain multipliers, and the energy, are not among them.
///
/// # Errors
/// [`NoAnswer`].
pub fn watched(scene: &Scene, choice: &Choice) -> Result<Vec<Watched>, NoAnswer> {
    let system = &scene.system;
    let start = ExactStart::new(system, &scene.start, &scene.completion, choice.removal.as_ref())?;
    let equations = derive(system, choice)?;
    let found = ansatz(system, &equations, &start, 2, &[]).map_err(NoAnswer::Open)?;
    let multipliers = ansatz::multipliers(&equations);
    let is_seen = |printed: &&Printed| {
        !printed.is_energy && multipliers.iter().all(|(mu, _)| !equations.graph.depends_on(printed.expression, *mu))
    };
    let read = found.printed.iter().filter(is_seen).map(|printed| {
        let expression = again(&system.graph, &printed.text).map_err(Open::Other)?;
        Ok(Watched { name: printed.text.clone(), expression, constancy: Constancy::Certain })
    });
    read.collect::<Result<_, _>>().map_err(NoAnswer::Open)
}

/// The printed formula, parsed with the symbols of `g`.
fn again(g: &Graph, text: &str) -> Result<Expr, String> {
    let known = |name: &str| g.find_symbol(name).map(|symbol| g.variable(symbol));
    g.parse(text, &known, &[]).map_err(|fault| fault.to_string())
}

fn drifts(scene: &Scene, choice: &Choice, printed: &[Printed]) -> Result<Vec<f64>, String> {
    if printed.is_empty() {
        return Ok(Vec::new());
    }
    let system = &scene.system;
    let settings = Settings { tolerance: TOLERANCE, ..Settings::default() };
    let mut motion = solve_choice(scene, choice, &settings).map_err(|fault| fault.to_string())?;
    let g = motion.equations.graph.clone();
    let both = |p: &Printed| Ok([again(&g, &p.text)?, again(&g, &p.without_signs())?]);
    let pairs: Vec<[Expr; 2]> = printed.iter().map(both).collect::<Result<_, String>>()?;
    let symbols: Vec<Symbol> = system.positions().into_iter().chain(system.velocities()).chain([system.time]).collect();
    let multipliers: Vec<Option<Symbol>> =
        motion.equations.multipliers.iter().map(|m| g.find_symbol(&m.name)).collect();
    let (from, to, mut values) = (motion.start(), motion.end(), system.parameter_values());
    let mut at = |t: f64| -> Result<Vec<[f64; 2]>, String> {
        let now = motion.at(t).map_err(|fault| fault.to_string())?;
        values.extend(zip(symbols.iter().copied(), now.coordinates.into_iter().chain(now.velocities).chain([t])));
        values.extend(zip(&multipliers, now.multipliers).filter_map(|(mu, x)| Some(((*mu)?, x))));
        let value = |e: Expr| g.evaluate(e, &values).map_err(|fault| fault.to_string());
        pairs.iter().map(|&[own, size]| Ok([value(own)?, value(size)?])).collect()
    };
    let larger = |a: f64, b: f64| if a >= b { a } else { b };
    let start = at(from)?;
    let mut largest = vec![(0.0, 0.0); printed.len()];
    for i in 0..=TIMES {
        let now = at(from + (to - from) * f64::from(i) / f64::from(TIMES))?;
        for ((drift, size), (now, start)) in largest.iter_mut().zip(zip(now, &start)) {
            (*drift, *size) = (larger(*drift, (now[0] - start[0]).abs()), larger(*size, now[1]));
        }
    }
    Ok(largest.into_iter().map(|(drift, size)| if drift == 0.0 { 0.0 } else { drift / size }).collect())
}

/// Whether an invariant of the scene is linear in the velocities, and not zero.
fn is_linear(system: &System, name: &str) -> bool {
    let (g, v) = (&system.graph, system.velocities());
    let at_rest = |e| g.substitute(e, &v.iter().map(|&v| (v, g.zero())).collect());
    system.watched.iter().filter(|watched| watched.name == name).any(|watched| {
        let slopes = g.gradient(watched.expression, &v);
        slopes.iter().all(|&e| v.iter().all(|&v| !g.depends_on(e, v)))
            && g.vanishes_exactly(at_rest(watched.expression))
    })
}
