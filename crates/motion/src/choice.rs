//! A choice of formulation, removal and free constants, and the equations that result.

use std::collections::{HashMap, HashSet};

use equations::{Derivation, Equations, Formulation, LeftOut, Named, Needs};
use mechanics::{ConstantsRule, Recombination, Removal, RemovalError, State, System, check_reactions};
use scene::{Scene, quoted};
use symbolic::{Expr, Symbol, question};

use crate::lost_rank::watch_rank;
use crate::variables::in_variables_of;
use crate::{CHETAEV, FORMS, FORMULATIONS, SolveError};

/// One formulation of the scene, with all choices made.
#[derive(Clone, Debug)]
pub struct Choice {
    /// What the reader sees: the formulation, and the removal where there are several.
    pub label: String,
    /// The formulation: one of [`FORMULATIONS`] or [`FORMS`], or a control of one's own.
    pub formulation: &'static Formulation,
    /// The removal, where the formulation needs one: expressions in the graph of its scene. In that of
    /// another reading of it, or of a clone made before, they mean nothing.
    pub removal: Option<Removal>,
    /// Free constants.
    pub constants: ConstantsRule,
}

/// Every choice that a comparison of `scene` makes. Where no removal can be found, the formulations that need
/// one get a choice without, which [`crate::solve_choice`] refuses with the reason.
pub fn choices(scene: &Scene) -> Vec<Choice> {
    choices_among(scene, |_| true)
}

/// [`choices`] of the formulations that are wanted.
pub fn choices_among(scene: &Scene, wanted: impl Fn(&Formulation) -> bool) -> Vec<Choice> {
    let mut choices = Vec::new();
    let suits = |entry: &&'static Formulation| wanted(entry) && entry.needs.are_met_by(&scene.system);
    for formulation in FORMULATIONS.iter().copied().filter(suits) {
        let removals = if formulation.needs_removal() { removals(scene).unwrap_or_default() } else { Vec::new() };
        if removals.is_empty() {
            choices.push(without_removal(formulation, scene));
        }
        for removal in removals {
            choices.push(Choice {
                label: format!("{} ({})", formulation.title, removal.name),
                formulation,
                constants: removal.constants.clone(),
                removal: Some(removal),
            });
        }
    }
    choices
}

/// A choice of each of [`FORMS`]; [`derive_at`] refuses those that `scene` does not have.
pub fn forms(scene: &Scene) -> Vec<Choice> {
    FORMS.iter().map(|form| without_removal(form, scene)).collect()
}

fn without_removal(formulation: &'static Formulation, scene: &Scene) -> Choice {
    let constants = default_constants(formulation, scene);
    Choice { label: formulation.title.into(), formulation, removal: None, constants }
}

/// Free constants without a removal: the scene's multipliers if the formulation starts from them, else zero.
pub fn default_constants(formulation: &Formulation, scene: &Scene) -> ConstantsRule {
    if formulation.starts_multipliers { ConstantsRule::Given(scene.multipliers.clone()) } else { ConstantsRule::Zero }
}

/// The free constants of `choice` in `scene`: its multipliers where the formulation starts from them.
pub fn constants_of(choice: &Choice, scene: &Scene) -> ConstantsRule {
    if choice.formulation.starts_multipliers {
        default_constants(choice.formulation, scene)
    } else {
        choice.constants.clone()
    }
}

/// Derives the equations of a choice, without what they do not need.
///
/// # Errors
/// [`SolveError::Derivation`], [`SolveError::Removal`].
pub fn derive(system: &System, choice: &Choice) -> Result<Equations, SolveError> {
    derive_from(system, None, choice)
}

/// d'Alembert and Lagrange's equations `d/dt L_v − L_q = f_vᵀ λ`, `f = 0` of a Lagrangian, constraints and
/// coordinates, without a scene. Velocities are primed, `x'`; time is `t`.
///
/// ```
/// use motion::{EquationStyle, equations_of, equations_text};
/// let skate = equations_of("(x'^2 + y'^2 + phi'^2)/2", &["y'*cos(phi) - x'*sin(phi)"], &["x", "y", "phi"])?;
/// assert!(equations_text(&skate, EquationStyle::Plain).contains("phi'' = 0"));
/// # Ok::<(), motion::SolveError>(())
/// ```
///
/// # Errors
/// [`SolveError::Scene`] for a name that cannot be a coordinate's, [`SolveError::Formula`] with its place for
/// a formula that cannot be read; as [`derive()`].
pub fn equations_of(lagrangian: &str, constraints: &[&str], coordinates: &[&str]) -> Result<Equations, SolveError> {
    let coordinate = |name: &&str| format!("{} = {{ unit = \"1\", start = 0 }}\n", quoted(name));
    let velocity = |name: &&str| format!("{} = 0\n", quoted(&format!("{name}'")));
    let squares: Vec<String> = coordinates.iter().map(|name| format!("{name}'^2")).collect();
    let text = format!(
        "title = \"\"\n[coordinates]\n{}[system]\nlagrangian = {}\n[start.velocities]\n{}[run]\nduration = 1\n",
        coordinates.iter().map(coordinate).collect::<String>(),
        quoted(&squares.join(" + ")),
        coordinates.iter().map(velocity).collect::<String>(),
    );
    let mut scene = Scene::parse("coordinates", &text).map_err(|fault| SolveError::Scene(Box::new(fault)))?;
    let system = &mut scene.system;
    let read = |text: &str| system.expression(text).map_err(|fault| SolveError::Formula(Box::new(fault)));
    let (lagrangian, constraints) = (read(lagrangian)?, constraints.iter().map(|f| read(f)).collect::<Result<_, _>>()?);
    (system.lagrangian, system.constraints) = (lagrangian, constraints);
    derive(&scene.system, &without_removal(CHETAEV, &scene))
}

/// [`derive()`] for a motion that starts at `start`, where pivots may have to be chosen.
fn derive_from(system: &System, start: Option<&State>, choice: &Choice) -> Result<Equations, SolveError> {
    let removal = choice.removal.as_ref();
    let derived =
        |all_costates: bool| (choice.formulation.derive)(system, &Derivation { removal, start, all_costates });
    let mut equations = derived(false)?;
    if let ConstantsRule::Given(values) = &choice.constants
        && gives_constant_costates(&equations, values)
    {
        equations = derived(true)?;
    }
    watch(&mut equations, system);
    Ok(equations.leave_out_unneeded())
}

/// Invariants of the user's own, in the states of the equations.
pub(crate) fn watch(equations: &mut Equations, system: &System) {
    let coordinates = system.positions().into_iter().zip(equations.coordinates.iter().copied());
    let velocities = system.velocities().into_iter().zip(equations.velocities.iter().copied());
    let states: HashMap<Symbol, Expr> = coordinates.chain(velocities).collect();
    for watched in system.watched.iter().filter(|watched| watched.is_constant()) {
        let expression = equations.graph.substitute(watched.expression, &states);
        equations.invariants.push(Named { name: watched.name.clone(), expression });
        equations.watched += 1;
    }
}

/// Whether `values`, one per memory variable, give a costate that was left out another value than zero.
fn gives_constant_costates(equations: &Equations, values: &[f64]) -> bool {
    let kept = |i: usize| equations.free_constants.iter().any(|c| c.memory == Some(i));
    let memory = equations.removal.as_ref().map_or(0, |removal| removal.memory.len());
    values.len() == memory && values.iter().enumerate().any(|(i, &x)| x != 0.0 && !kept(i))
}

/// [`derive()`], from constraints made independent at `start` where they nearly are not
/// ([`Recombination`]), except for quasi-velocities without a pivot that may vanish.
///
/// # Errors
/// As [`derive()`]; [`SolveError::Start`] where the constraints are dependent.
pub fn derive_at(system: &System, start: &State, choice: &Choice) -> Result<Equations, SolveError> {
    let mut equations = derive_combined(system, start, choice)?;
    equations.domains = domains_at(system, start, &equations)?;
    equations.guards.extend(&equations.domains);
    equations.cuts = cuts_from(system, start, &equations);
    equations.guards.extend(&equations.cuts);
    watch_rank(&mut equations, system);
    let redundant = |(number, _): &(usize, Expr)| LeftOut {
        variables: Vec::new(),
        words: format!("constraint {number}: it follows from the others; its multiplier is zero"),
    };
    equations.left_out.extend(system.redundant.iter().map(redundant));
    if let Some((stem, _)) = equations.multipliers.first().and_then(|m| m.name.rsplit_once('_')) {
        let stem = stem.to_owned();
        let zero = equations.graph.zero();
        let own = |number: usize| Named { name: format!("{stem}_{number}"), expression: zero };
        equations.multipliers.extend(system.redundant.iter().map(|(number, _)| own(*number)));
    }
    Ok(equations)
}

/// What has to stay positive for the system as it was written, in the variables of its equations.
fn domains_at(system: &System, start: &State, equations: &Equations) -> Result<Vec<Expr>, SolveError> {
    let g = &system.graph;
    let values = system.values_at(start);
    let outside = |e: &&Expr| g.evaluate(**e, &values).is_ok_and(|x| x < 0.0);
    if let Some(e) = system.domains.iter().find(outside) {
        let value = g.evaluate(*e, &values).unwrap_or(f64::NAN);
        return Err(SolveError::OutsideDomain { expression: g.plain(*e), value });
    }
    Ok(in_variables_of(equations, system, &system.domains, &HashSet::new()))
}

/// What is zero where an angle in the momenta `∂L/∂v` or the constraints jumps, if it is not at the start.
fn cuts_from(system: &System, start: &State, equations: &Equations) -> Vec<Expr> {
    let (g, values) = (&system.graph, system.values_at(start));
    let written = [&[system.lagrangian], &system.constraints[..]].concat();
    if g.angles(&written).is_empty() {
        return Vec::new();
    }
    let momenta = g.gradient(system.lagrangian, &system.velocities());
    let mut cuts = g.cuts(&[momenta, system.constraints.clone()].concat());
    cuts.retain(|&e| !equations.is_constant(g, e) && g.evaluate(e, &values).is_ok_and(|x| x > 0.0));
    in_variables_of(equations, system, &cuts, &HashSet::new())
}

fn derive_combined(system: &System, start: &State, choice: &Choice) -> Result<Equations, SolveError> {
    let prescribed = choice.formulation.needs == Needs::VirtualConditions;
    if prescribed && system.virtual_conditions.len() == system.constraints.len() {
        check_reactions(system, start)?;
    }
    let combined = Recombination::at(system, start);
    if choice.removal.is_some() {
        // the constraints stand no more in the equations, but they gave the start
        let mut equations = derive(system, choice)?;
        equations.lost_digits = combined.ok().flatten().map_or(1.0, |combined| combined.ratio.recip());
        return Ok(equations);
    }
    let Some(combined) = combined? else { return derive_from(system, Some(start), choice) };
    let lost_digits = combined.ratio.recip();
    // at any angle constant pivots eliminate the rows as they are, which may be sparse
    if FORMS.contains(&choice.formulation)
        && let Ok(equations) = derive_from(system, Some(start), choice)
        && equations.chart.as_ref().is_none_or(|chart| !chart.may_vanish)
    {
        return Ok(Equations { lost_digits, ..equations });
    }
    let equations = derive_from(&combined.system(system), Some(start), choice)?;
    // multipliers belong to the rows prescribed, which stay as they are
    let restored = if prescribed { equations } else { equations.with_multipliers_restored(&combined) };
    Ok(Equations { lost_digits, ..restored })
}

type Automatic = fn(&System, &mechanics::State) -> Result<Removal, RemovalError>;

/// The removals that need no hand, by name.
const AUTOMATIC: [(&str, Automatic); 2] =
    [(Removal::AUTOMATIC[0], Removal::by_coordinates), (Removal::AUTOMATIC[1], Removal::by_quasi_velocities)];

/// The removals of a scene: those written by hand, then automatic ones that apply and are new.
///
/// # Errors
/// [`RemovalError`] where no removal was written by hand and none can be found automatically.
pub fn removals(scene: &Scene) -> Result<Vec<Removal>, RemovalError> {
    let mut removals = scene.removals.clone();
    let automatic = question(|| Removal::automatic(&scene.system, &scene.start));
    match automatic.map_err(RemovalError::from).flatten() {
        Err(error) if removals.is_empty() => return Err(error),
        Err(_) => {}
        Ok(automatic) => {
            for removal in automatic {
                if !removals.iter().any(|r| same_parameters(&scene.system, r, &removal)) {
                    removals.push(removal);
                }
            }
        }
    }
    Ok(removals)
}

/// Whether two removals use the same coordinates as parameters, and nothing else.
fn same_parameters(system: &System, a: &Removal, b: &Removal) -> bool {
    let coordinates = |r: &Removal| r.parameters.iter().map(|u| u.coordinate).collect::<Option<Vec<usize>>>();
    let plain = |r: &Removal| {
        let memory: usize = r.memory.iter().filter(|w| w.coordinate.is_some()).count();
        memory + r.parameters.len() == system.dimension()
    };
    coordinates(a).is_some() && coordinates(a) == coordinates(b) && plain(a) && plain(b)
}

/// The removal of this name, by hand or automatic; `None` for any other name ([`removal_names`]).
///
/// # Errors
/// [`RemovalError`] where the automatic removal asked for does not apply.
pub fn removal(scene: &Scene, name: &str) -> Result<Option<Removal>, RemovalError> {
    if let Some(removal) = scene.removals.iter().find(|removal| removal.name == name) {
        return Ok(Some(removal.clone()));
    }
    let automatic = AUTOMATIC.iter().find(|(known, _)| *known == name);
    automatic.map(|(_, automatic)| question(|| automatic(&scene.system, &scene.start))?).transpose()
}

/// What [`removal`] can be asked for.
pub fn removal_names(scene: &Scene) -> Vec<&str> {
    scene.removals.iter().map(|removal| &removal.name[..]).chain(AUTOMATIC.map(|(name, _)| name)).collect()
}
