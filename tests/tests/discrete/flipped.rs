//! A control of the referees: a sign is flipped in each derivation, and at least two referees must see it.
//!
//! The equations come from the table of deltaq as they are derived, are corrupted in their own graph, and integrated by deltaq. What
//! judges them starts from `L` and `f` again:
//!
//! | derivation | first referee | second referee |
//! | --- | --- | --- |
//! | Chetaev | discrete Lagrange–d'Alembert principle | Maggi's equations |
//! | vakonomic | discrete vakonomic action | costate form |
//! | removed constraint | discrete action of the removal | vakonomic motion of the augmented system (T2) |
//!
//! The same referees must have nothing to say against the equations without the flip.

use deltaq::{Motion, Setting, Settings, TIGHTER, formulation, solve};
use equations::{Derivation, Equations};
use mechanics::{ConstantsRule, Removal, State, System, complete_removal_start};
use proptest::strategy::ValueTree;
use random::{Kind, augmented, draw};
use referees::discrete::Discrete;
use referees::maggi::Maggi;
use scene::Scene;
use symbolic::Symbol;
use validation::catalogue::find;

use super::flip::{Flip, corrupt};
use super::support::{HORIZON, measure, removed, short};

/// A referee objects where its difference is over this many times the errors that it knows of.
const FAR: f64 = 1e6;

/// A referee has nothing to say where its difference is under this many times the errors that it knows of.
const NEAR: f64 = 3.0;

/// The least error that a referee may claim.
const ROUND_OFF: f64 = 2e-13;

/// Instants at which motions are compared.
const INSTANTS: usize = 8;

/// A flip that moves nothing by more than this is no error.
const HARMLESS: f64 = 1e-7;

const SETTINGS: Settings = Settings {
    tolerance: 1e-12,
    method: integrate::Method::Dop853,
    projection: integrate::Projection::EveryStep,
    max_steps: 40_000,
    plain: false,
    interrupt: None,
};

/// What a referee found: how far the motion is from its own, and by how much the two may be wrong. Relative to coordinates over 1.
struct Word {
    referee: &'static str,
    difference: f64,
    error: f64,
}

/// What is judged: a formulation on a scene, with its removal and constants (`μ₀`, or `P(t₀)` one a memory variable).
pub struct Trial {
    pub what: String,
    formulation: &'static str,
    pub scene: Scene,
    pub removal: Option<Removal>,
    constants: Vec<f64>,
}

impl Trial {
    /// A flip in `G_u` says nothing where `u` itself is in nothing, so there a parameter has to be a coordinate.
    fn new(formulation: &'static str, scene: Scene, flip: Flip) -> Trial {
        let what = format!("{}, {formulation}", scene.name);
        let some = |count: usize| (0..count).map(|i| [0.7, -0.5, 0.4][i % 3]).collect();
        let (removal, constants) = match formulation {
            "vakonomic" => (None, some(scene.system.constraints.len())),
            "removed-constraint" => {
                let removals = deltaq::removals(&scene).unwrap_or_else(|e| panic!("{what}: {e}"));
                let keeps = |r: &Removal| r.parameters.iter().any(|u| u.coordinate.is_some());
                let removal = removals.into_iter().find(|r| !matches!(flip, Flip::ParameterForce) || keeps(r));
                let count = removal.as_ref().map_or(0, |r| r.memory.len());
                (removal, some(count))
            }
            _ => (None, Vec::new()),
        };
        Trial { what, formulation, scene, removal, constants }
    }

    fn equations(&self) -> Equations {
        let entry = formulation(self.formulation).unwrap_or_else(|| panic!("no {}", self.formulation));
        let derived =
            (entry.derive)(&self.scene.system, &Derivation { removal: self.removal.as_ref(), ..Derivation::default() });
        derived.unwrap_or_else(|e| panic!("{}: {e}", self.what))
    }

    /// `P(t₀)` of those memory variables that have a costate, zero for the others.
    fn costates(&self, equations: &Equations) -> Vec<f64> {
        let has = |i: usize| equations.free_constants.iter().any(|c| c.memory == Some(i));
        self.constants.iter().enumerate().map(|(i, &p)| if has(i) { p } else { 0.0 }).collect()
    }

    fn solve(&self, equations: Equations) -> Motion {
        let constants = match &self.removal {
            Some(_) => {
                let costates = self.costates(&equations);
                equations.free_constants.iter().filter_map(|c| c.memory.map(|i| costates[i])).collect()
            }
            None => self.constants.clone(),
        };
        motion(&self.what, &self.scene.system, &self.scene.start, equations, constants)
    }

    /// What both referees say to a motion up to `end`.
    fn judge(&self, judged: &mut Motion, end: f64) -> [Word; 2] {
        let Scene { system, start, .. } = &self.scene;
        let discrete = match &self.removal {
            None if self.formulation == "chetaev" => Discrete::chetaev(system, start, end),
            None => Discrete::vakonomic(system, start, &self.constants, end),
            Some(removal) => {
                let costates = self.costates(&judged.equations);
                let discrete = removed(system, removal, start, &costates, end);
                discrete.unwrap_or_else(|| panic!("{}: not of first order", self.what))
            }
        };
        let found = measure(&self.what, discrete, judged);
        let discrete = Word {
            referee: "discrete",
            difference: found.difference,
            error: found.estimate + own_error(judged, end) + ROUND_OFF,
        };
        [discrete, self.second(judged, end)]
    }

    fn second(&self, judged: &mut Motion, end: f64) -> Word {
        let Scene { system, start, .. } = &self.scene;
        match &self.removal {
            None if self.formulation == "chetaev" => self.maggi(judged, end),
            None => {
                let entry = formulation("vakonomic-costate").unwrap_or_else(|| panic!("no costate form"));
                let equations = (entry.derive)(system, &Derivation::default());
                let equations = equations.unwrap_or_else(|e| panic!("{}: {e}", self.what));
                let other = motion(&self.what, system, start, equations, self.constants.clone());
                against("costate form", judged, other, end)
            }
            Some(removal) => {
                let (system, start, multipliers) = self.augmented(removal, &self.costates(&judged.equations));
                let entry = formulation("vakonomic").unwrap_or_else(|| panic!("no vakonomic"));
                let equations = (entry.derive)(&system, &Derivation::default());
                let mut equations = equations.unwrap_or_else(|e| panic!("{}: {e}", self.what));
                equations.coordinates.truncate(self.scene.system.dimension());
                equations.velocities.truncate(self.scene.system.dimension());
                let other = motion(&self.what, &system, &start, equations, multipliers);
                against("augmented system", judged, other, end)
            }
        }
    }

    fn maggi(&self, judged: &mut Motion, end: f64) -> Word {
        let Scene { system, start, .. } = &self.scene;
        let tolerances = [SETTINGS.tolerance, SETTINGS.tolerance * TIGHTER];
        let runs = Maggi::new(system).and_then(|mut maggi| maggi.solve_twice(start, end, tolerances));
        let mut runs = runs.unwrap_or_else(|e| panic!("{}: {e}", self.what));
        let (mut difference, mut error) = (0.0_f64, 0.0_f64);
        for t in instants(start.t, end) {
            let [looser, kept] = runs.each_mut().map(|run| run.state(t).unwrap_or_else(|e| panic!("{e}")).q);
            difference = difference.max(distance(&coordinates(judged, t), &kept));
            error = error.max(distance(&looser, &kept));
        }
        Word { referee: "Maggi", difference, error: error + own_error(judged, end) + ROUND_OFF }
    }

    /// The augmented system with its start and its multipliers `μ = −P − ∂L/∂ẇ`.
    fn augmented(&self, removal: &Removal, costates: &[f64]) -> (System, State, Vec<f64>) {
        let Scene { system, start, .. } = &self.scene;
        let values = complete_removal_start(system, removal, start).unwrap_or_else(|e| panic!("{e}")).values();
        let mut longer = start.clone();
        for u in removal.parameters.iter().filter(|u| u.coordinate.is_none()) {
            longer.q.push(values[&u.symbol]);
            longer.v.push(values[&u.rate]);
        }
        let momenta = gradient_at(system, start, &system.velocities());
        let multipliers = removal.memory.iter().zip(costates);
        let multipliers = multipliers.map(|(w, p)| -p - w.coordinate.map_or(0.0, |c| momenta[c])).collect();
        (augmented(system, removal), longer, multipliers)
    }
}

/// `∂L/∂s` at a state.
fn gradient_at(system: &System, state: &State, symbols: &[Symbol]) -> Vec<f64> {
    let mut values = system.parameter_values();
    values.extend(system.values_at(state));
    let gradient = system.graph.gradient(system.lagrangian, symbols);
    gradient.iter().map(|&e| system.graph.evaluate(e, &values).unwrap_or_else(|e| panic!("{e}"))).collect()
}

fn motion(what: &str, system: &System, start: &State, equations: Equations, constants: Vec<f64>) -> Motion {
    let setting = Setting { system, start, end: start.t + HORIZON };
    solve(setting, equations, &ConstantsRule::Given(constants), &SETTINGS).unwrap_or_else(|e| panic!("{what}: {e}"))
}

fn coordinates(motion: &mut Motion, t: f64) -> Vec<f64> {
    motion.at(t).unwrap_or_else(|e| panic!("at t = {t}: {e}")).coordinates
}

fn instants(start: f64, end: f64) -> impl Iterator<Item = f64> {
    (0..=INSTANTS).map(move |i| start + (end - start) * i as f64 / INSTANTS as f64)
}

/// Largest difference, relative to coordinates over 1.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / b.abs().max(1.0)).fold(0.0, f64::max)
}

/// Largest difference of the two runs of a motion.
fn own_error(motion: &mut Motion, end: f64) -> f64 {
    let times: Vec<f64> = instants(motion.start(), end).collect();
    let largest = |t| {
        let (kept, looser) = motion.at_in_both_runs(t).unwrap_or_else(|e| panic!("at t = {t}: {e}"));
        distance(&looser.coordinates, &kept.coordinates)
    };
    times.into_iter().map(largest).fold(0.0, f64::max)
}

fn against(referee: &'static str, judged: &mut Motion, mut other: Motion, end: f64) -> Word {
    assert!(other.end() >= end, "{referee}: {:?}", other.ending);
    let times = instants(judged.start(), end);
    let difference = times.map(|t| distance(&coordinates(judged, t), &coordinates(&mut other, t))).fold(0.0, f64::max);
    let error = own_error(judged, end) + own_error(&mut other, end) + ROUND_OFF;
    Word { referee, difference, error }
}

/// Both referees pass the equations and both object to the flip. Returns whether the flip moves anything.
fn caught(trial: &Trial, flip: Flip) -> bool {
    let equations = trial.equations();
    let mut right = trial.solve(equations.clone());
    let mut wrong = trial.solve(corrupt(trial, equations, flip));
    let end = short(&right).min(short(&wrong));
    let apart = instants(right.start(), end);
    let apart = apart.map(|t| distance(&coordinates(&mut wrong, t), &coordinates(&mut right, t))).fold(0.0, f64::max);
    let (passes, objections) = (trial.judge(&mut right, end), trial.judge(&mut wrong, end));
    let harmless = apart < HARMLESS;
    for (pass, objection) in passes.iter().zip(&objections) {
        println!(
            "{:<44} {flip:?}, {:<17} right {:.1e} (± {:.0e}), wrong {:.1e} (± {:.0e})",
            trial.what, pass.referee, pass.difference, pass.error, objection.difference, objection.error
        );
        assert!(
            pass.difference <= NEAR * pass.error,
            "{} objects to {}: {:.3e} ± {:.1e}",
            pass.referee,
            trial.what,
            pass.difference,
            pass.error
        );
        assert!(
            harmless || objection.difference > FAR * objection.error,
            "{} does not see {flip:?} in {}: {:.3e} ± {:.1e}",
            objection.referee,
            trial.what,
            objection.difference,
            objection.error
        );
    }
    !harmless
}

/// The named scenes, and random systems of kinds with something nonintegrable, linear in the velocities and well conditioned.
fn trials(formulation: &'static str, names: &[&str], flip: Flip) -> Vec<Trial> {
    let kinds = [Kind::Linear, Kind::Affine, Kind::TimeDependent, Kind::PartlyIntegrable];
    let built_in = names.iter().map(|name| find(name, &[]).unwrap_or_else(|e| panic!("{e}")));
    let random = (0..RANDOM).map(|index| {
        let recipe = draw(SEED, index, &kinds).current();
        recipe.scene(&format!("random {index}, {}", recipe.kind))
    });
    built_in.chain(random).map(|scene| Trial::new(formulation, scene, flip)).collect()
}

/// Random systems for each flip.
const RANDOM: u64 = 12;

/// Their seed.
const SEED: u64 = 1895;

/// Every flip is caught, and on all built-in scenes and nearly all random systems there is something to catch.
fn assert_caught(formulation: &'static str, names: &[&str], flip: Flip) {
    let moved: Vec<bool> = trials(formulation, names, flip).iter().map(|trial| caught(trial, flip)).collect();
    let count = moved.iter().filter(|&&moved| moved).count();
    println!("{formulation}, {flip:?}: caught by both referees on {count} of {} systems", moved.len());
    assert!(moved[..names.len()].iter().all(|&moved| moved), "{formulation}, {flip:?}: {moved:?}");
    assert!(moved.len() - count <= 3, "{formulation}, {flip:?} moves {count} of {} systems only", moved.len());
}

#[test]
fn a_flipped_sign_in_chetaev_is_caught() {
    assert_caught("chetaev", &["sledge", "velocity-pendulum", "sleigh"], Flip::Force);
}

#[test]
fn a_flipped_sign_in_vakonomic_is_caught() {
    assert_caught("vakonomic", &["sledge", "velocity-pendulum", "sleigh"], Flip::Force);
    assert_caught("vakonomic", &["sledge", "heisenberg", "disc", "particle"], Flip::Curvature);
}

#[test]
fn a_flipped_sign_in_the_removed_constraint_is_caught() {
    assert_caught("removed-constraint", &["sledge", "ball-in-cone", "planar-body"], Flip::ParameterForce);
    assert_caught("removed-constraint", &["sledge", "ball-in-cone", "planar-body"], Flip::Costate);
}
