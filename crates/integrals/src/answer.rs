//! All answers about a scene.

use std::iter::zip;

use comparison::{Beside, Contradicted, hold};
use decision::{DecisionError, ExactStart};
use equations::Outputs;
use mechanics::{Constancy, System, Watched, project_velocity};
use motion::band::{INSTANTS, Known};
use motion::{CHETAEV, Choice, Settings, SolveError, TIGHTER, derive, solve_choice};
use scene::Scene;
use symbolic::{Expr, Graph, Symbol};

use crate::ansatz::{self, ansatz};
use crate::{Ansatz, Open, Printed, Reversed, constants, reversible};

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
    /// The change of each integral that is printed along the scene's own motion; or why there is no such one.
    pub drifts: Result<Vec<Known>, String>,
    /// Names of the scene's invariants, with whether they are constant on almost every motion.
    pub invariants: Result<Vec<(String, bool)>, Open>,
}

/// Why nothing is answered.
#[derive(Debug, thiserror::Error)]
pub enum NoAnswer {
    /// A name that is not a coordinate, or equations that cannot be followed over a finite field.
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
        let (drifts, own) = match changes(scene, choice, printed) {
            Ok((drifts, own)) => (Ok(drifts), own),
            Err(why) => (Err(why), Vec::new()),
        };
        let formulation = choice.formulation.name;
        let found = Integrals { scene: scene.clone(), formulation, reversed, ansatz, drifts, invariants };
        found.hold(choice, &own)?;
        Ok(found)
    }

    /// Holds what is said against the scene's own motion, Frobenius' test, and what else is said.
    fn hold(&self, choice: &Choice, invariants: &[Known]) -> Result<(), Contradicted> {
        let system = &self.scene.system;
        let printed = self.ansatz.as_ref().map_or(&[][..], |found| &found.printed);
        let own = || self.invariants.iter().flatten();
        let mut all: Vec<Beside> = Vec::new();
        all.extend(zip(printed, self.drifts.iter().flatten()).map(|(p, change)| Beside::Constant(&p.text, *change)));
        let held = zip(own(), invariants).filter(|((_, held), _)| *held);
        all.extend(held.map(|((name, _), change)| Beside::Constant(name, *change)));
        let others = self.changes_of_others(choice, invariants);
        all.extend(others.iter().map(|(name, changes)| Beside::NotConstant(name, changes)));
        let linear = self.reversed.as_ref().and_then(|found| found.integrals.first());
        let is_seen = |name: &str| is_linear(system, name);
        let found: Vec<&str> = printed.iter().filter(|p| p.is_linear).map(|p| &p.text[..]).collect();
        let known: Vec<&str> = own().filter(|(own, held)| *held && is_seen(own)).map(|(own, _)| &own[..]).collect();
        if let Some(Ok(linear)) = linear {
            all.push(Beside::AtMost("linear integrals", linear.count, &found));
            if linear.count == 0 {
                all.push(Beside::AtMost("linear integrals", 0, &known));
            }
        }
        let brackets = match linear {
            Some(Ok(_)) => Some(0),
            Some(Err(Open::Integrable { rank, dimension })) => Some(dimension - rank),
            _ => None,
        };
        let until = self.scene.start.t + self.scene.duration;
        let frobenius = brackets.map(|_| mechanics::integrability(&system.clone(), &self.scene.start, until));
        if let (Some(left), Some(Ok(verdict))) = (brackets, &frobenius) {
            all.push(Beside::Brackets(verdict, left + system.on_positions.len()));
        }
        let open = self.reversed.iter().flat_map(|found| &found.integrals).filter_map(|found| found.as_ref().err());
        let faults: Vec<String> = open
            .chain(self.ansatz.as_ref().err())
            .filter(|open| matches!(open, Open::Contradiction(_)))
            .map(Open::to_string)
            .collect();
        all.extend(faults.iter().map(|fault| Beside::Methods(fault)));
        hold(&self.scene, all)
    }

    /// Changes along several motions of invariants that are proved not to be constant, where the scene's own
    /// motion shows none.
    fn changes_of_others(&self, choice: &Choice, invariants: &[Known]) -> Vec<(&str, Vec<Known>)> {
        let said = zip(self.invariants.iter().flatten(), invariants).enumerate();
        let said: Vec<_> = said.filter(|(_, ((_, held), change))| !*held && !change.is_certain()).collect();
        if said.is_empty() {
            return Vec::new();
        }
        let others: Vec<Vec<Known>> = (1..=OTHERS)
            .filter_map(|number| changes(&other(&self.scene, number)?, choice, &[]).ok())
            .map(|(_, invariants)| invariants)
            .collect();
        let along = |i: usize| others.iter().filter_map(move |of| of.get(i).copied());
        said.into_iter().map(|(i, ((name, _), own))| (&name[..], along(i).chain([*own]).collect())).collect()
    }
}

/// Other starts that a quantity is looked at from which the scene's own motion does not change.
const OTHERS: u32 = 3;

/// The scene with other start velocities, of the size of its own or 1; `None` where that fails.
fn other(scene: &Scene, number: u32) -> Option<Scene> {
    let mut start = scene.start.clone();
    let size = match start.v.iter().fold(0.0, |size: f64, v| size.max(v.abs())) {
        0.0 => 1.0,
        size => size,
    };
    start.v.iter_mut().zip(1..).for_each(|(v, i)| *v += size * (f64::from(number) * 78.2 + f64::from(i) * 12.9).sin());
    let (start, _) = project_velocity(&scene.system, &start).ok()?;
    Some(Scene { start, ..scene.clone() })
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
    g.parse(text, g).map_err(|fault| fault.to_string())
}

/// Changes along the motion of `choice` of what is printed, and of the scene's invariants.
fn changes(scene: &Scene, choice: &Choice, printed: &[Printed]) -> Result<(Vec<Known>, Vec<Known>), String> {
    let system = &scene.system;
    let own: Vec<&Watched> = system.watched.iter().filter(|watched| watched.is_constant()).collect();
    if printed.is_empty() && own.is_empty() {
        return Ok(Default::default());
    }
    let settings = Settings { tolerance: TIGHTER * Settings::default().tolerance, ..Settings::default() };
    let mut motion = solve_choice(scene, choice, &settings).map_err(|fault| fault.to_string())?;
    let g = motion.equations.graph.clone();
    let printed: Vec<Expr> = printed.iter().map(|p| again(&g, &p.text)).collect::<Result<_, _>>()?;
    let count = printed.len();
    let terms: Vec<Vec<Expr>> =
        printed.into_iter().chain(own.iter().map(|own| own.expression)).map(|e| g.terms(e)).collect();
    let symbols: Vec<Symbol> = system.positions().into_iter().chain(system.velocities()).chain([system.time]).collect();
    let multipliers: Vec<Option<Symbol>> =
        motion.equations.multipliers.iter().map(|m| g.find_symbol(&m.name)).collect();
    let (from, to, mut values) = (motion.start(), motion.end(), system.parameter_values());
    // of each quantity its value and the sum of its terms without signs
    let mut read = |t: f64, now: Outputs| -> Result<Vec<[f64; 2]>, String> {
        values.extend(zip(symbols.iter().copied(), now.coordinates.into_iter().chain(now.velocities).chain([t])));
        values.extend(zip(&multipliers, now.multipliers).filter_map(|(mu, x)| Some(((*mu)?, x))));
        let value = |&e: &Expr| g.evaluate(e, &values).map_err(|fault| fault.to_string());
        let sums = |terms: &Vec<Expr>| {
            let terms: Vec<f64> = terms.iter().map(value).collect::<Result<_, _>>()?;
            Ok([terms.iter().sum(), terms.iter().map(|x| x.abs()).sum()])
        };
        terms.iter().map(sums).collect()
    };
    let (mut runs, mut sizes) = (vec![Vec::new(); terms.len()], vec![0.0_f64; terms.len()]);
    let times = (0..=INSTANTS as u32).map(|i| from + (to - from) * f64::from(i) / f64::from(INSTANTS as u32));
    for t in times.filter(|&t| t == from || !motion.is_doubted(t)).collect::<Vec<_>>() {
        let (kept, looser) = motion.at_in_both_runs(t).map_err(|fault| fault.to_string())?;
        for (i, (kept, looser)) in zip(read(t, kept)?, read(t, looser)?).enumerate() {
            runs[i].push([kept[0], looser[0]]);
            sizes[i] = sizes[i].max(kept[1]);
        }
    }
    let mut changes: Vec<Known> = zip(&runs, sizes).map(|(run, size)| Known::change(run, size)).collect();
    let own = changes.split_off(count);
    Ok((changes, own))
}

/// Whether an invariant of the scene is linear in the velocities, and not zero.
fn is_linear(system: &System, name: &str) -> bool {
    let (g, v) = (&system.graph, system.velocities());
    system.watched.iter().filter(|watched| watched.name == name).any(|watched| {
        let slopes = g.gradient(watched.expression, &v);
        slopes.iter().all(|&e| v.iter().all(|&v| !g.depends_on(e, v)))
            && g.vanishes_exactly(system.at_rest(&[watched.expression])[0])
    })
}
