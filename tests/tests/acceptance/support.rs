//! Scenes, motions and gaps, in the words of the tests.

use std::collections::HashMap;

use equations::{Compiled, Derivation, DerivationError, Equations, Formulation, Outputs};
use mechanics::{ConstantsRule, Removal, State, System, complete_removal_start};
use motion::{
    CHETAEV, Choice, Metric, Motion, REMOVED_CONSTRAINT, Settings, VAKONOMIC, VAKONOMIC_COSTATE, derive, setting, solve,
};
use nalgebra::{DMatrix, DVector};
use proptest::test_runner::{Config, RngSeed, TestCaseError, TestRunner};
use random::{Kind, recipes_of};
use scene::Scene;
use symbolic::{Expr, Graph, Matrix, Symbol};

/// The tolerance of the looser of the two runs of every motion; what is measured has a hundredth of it.
pub const TIGHT: f64 = 1e-12;

type Derived = Result<Equations, DerivationError>;

/// Instants at which motions are compared.
pub const INSTANTS: usize = 200;

/// Scenes whose constraints are linear (or affine) in the velocities.
pub fn linear_scenes() -> Vec<Scene> {
    constrained_scenes().into_iter().filter(|s| s.system.constraints_linear_in_velocity()).collect()
}

/// All built-in scenes.
pub fn scenes() -> Vec<Scene> {
    scene::catalogue::SCENES.iter().map(|(name, _)| scene(name, &[])).collect()
}

/// The further systems of the literature.
pub fn classics() -> Vec<Scene> {
    scene::catalogue::CLASSICS.iter().map(|(name, _)| scene(name, &[])).collect()
}

/// A bicycle that is pushed over at 2 m/s.
pub fn falling_bicycle() -> Scene {
    scene("bicycle", &[("lean'", 0.5), ("yaw", 0.3)])
}

/// The built-in scenes in which something is constrained.
pub fn constrained_scenes() -> Vec<Scene> {
    scenes().into_iter().filter(|scene| !scene.system.constraints.is_empty()).collect()
}

/// Puts `test` to random systems whose constraints, if any, are linear (or affine) in the velocities.
pub fn for_all_linear(seed: u64, test: impl Fn(&Scene) -> Result<(), TestCaseError>) {
    let rng_seed = RngSeed::Fixed(seed);
    let config = Config { cases: 256, failure_persistence: None, rng_seed, ..Config::default() };
    let kinds = Kind::which(Kind::is_linear);
    let outcome = TestRunner::new(config).run(&recipes_of(&kinds), |recipe| test(&recipe.scene("random")));
    outcome.unwrap_or_else(|error| panic!("{error}"));
}

/// A built-in scene with other numbers.
pub fn scene(name: &str, overrides: &[(&str, f64)]) -> Scene {
    let overrides: Vec<_> = overrides.iter().map(|&(n, x)| (n.to_string(), x.into())).collect();
    scene::catalogue::find(name, &overrides).unwrap_or_else(|e| panic!("{e}"))
}

pub fn tight() -> Settings {
    Settings { tolerance: TIGHT, max_steps: 40_000, ..Settings::default() }
}

/// Index of a coordinate.
pub fn index(scene: &Scene, coordinate: &str) -> usize {
    let found = scene.system.coordinates.iter().position(|c| c.name == coordinate);
    found.unwrap_or_else(|| panic!("{} has no coordinate {coordinate}", scene.name))
}

/// Value of a parameter.
pub fn parameter(scene: &Scene, name: &str) -> f64 {
    let found = scene.system.parameters.iter().find(|p| scene.system.graph.name(p.symbol) == name);
    found.unwrap_or_else(|| panic!("{} has no parameter {name}", scene.name)).value
}

/// What a formulation is asked for.
pub fn choice(formulation: &'static Formulation, removal: Option<&Removal>, constants: ConstantsRule) -> Choice {
    Choice { label: formulation.title.into(), formulation, removal: removal.cloned(), constants }
}

/// The equations of a formulation.
pub fn equations(system: &System, formulation: &'static Formulation, removal: Option<&Removal>) -> Equations {
    let derived = derive(system, &choice(formulation, removal, ConstantsRule::Zero));
    derived.unwrap_or_else(|e| panic!("{formulation:?}: {e}"))
}

/// The derivation itself, with nothing left out.
pub fn derived(scene: &Scene, formulation: &Formulation, removal: Option<&Removal>, start: Option<&State>) -> Derived {
    (formulation.derive)(&scene.system, &Derivation { removal, start, ..Default::default() })
}

/// The equations of every formulation and regular removal of a scene, with their name and some constants.
pub fn all_equations(scene: &Scene) -> Vec<(String, Equations, Vec<f64>)> {
    let mu = some_multipliers(scene);
    let of = |(own, constants): (&'static Formulation, &[f64])| {
        (own.name.to_string(), equations(&scene.system, own, None), constants.into())
    };
    let plain = [(CHETAEV, &[][..]), (VAKONOMIC, &mu), (VAKONOMIC_COSTATE, &mu)].map(of);
    let removed = regular_removals(scene).into_iter().map(|removal| {
        let equations = equations(&scene.system, REMOVED_CONSTRAINT, Some(&removal));
        let constants = vec![0.1; equations.free_constants.len()];
        (format!("removal {}", removal.name), equations, constants)
    });
    plain.into_iter().chain(removed).collect()
}

/// A motion that must come about; it may stop early.
pub fn motion_of(scene: &Scene, equations: Equations, constants: &[f64], settings: &Settings) -> Motion {
    let rule = ConstantsRule::Given(constants.to_vec());
    let solved = solve(setting(scene), equations, &rule, settings);
    solved.unwrap_or_else(|e| panic!("{}: {e}", scene.name))
}

/// The Chetaev motion, which must reach the end.
pub fn chetaev(scene: &Scene) -> Motion {
    complete(scene, motion_of(scene, equations(&scene.system, CHETAEV, None), &[], &tight()))
}

/// The vakonomic motion with multipliers `mu0`, which must reach the end.
pub fn vakonomic(scene: &Scene, mu0: &[f64]) -> Motion {
    complete(scene, motion_of(scene, equations(&scene.system, VAKONOMIC, None), mu0, &tight()))
}

/// The removed-constraint motion with `P(t₀)`; it may stop where the removal's chart ends.
pub fn removed(scene: &Scene, removal: &Removal, constants: &[f64]) -> Motion {
    motion_of(scene, equations(&scene.system, REMOVED_CONSTRAINT, Some(removal)), constants, &tight())
}

/// A removal of the scene by name.
pub fn removal<'a>(scene: &'a Scene, name: &str) -> &'a Removal {
    let found = scene.removals.iter().find(|r| r.name == name);
    found.unwrap_or_else(|| panic!("{} has no removal {name}", scene.name))
}

pub fn complete(scene: &Scene, motion: Motion) -> Motion {
    assert!(motion.is_complete(), "{}: {:?}", scene.name, motion.ending);
    motion
}

/// Everything at one instant.
pub fn at(motion: &mut Motion, t: f64) -> Outputs {
    motion.at(t).unwrap_or_else(|e| panic!("at t = {t}: {e}"))
}

/// Equidistant times from the start to where both motions last, less a tenth before a singularity.
pub fn common_times(motions: &[&Motion]) -> Vec<f64> {
    let start = motions[0].start();
    let end = |m: &&Motion| if m.is_complete() { m.end() } else { start + 0.9 * (m.end() - start) };
    let end = motions.iter().map(end).fold(f64::INFINITY, f64::min);
    (0..=INSTANTS).map(|i| start + (end - start) * i as f64 / INSTANTS as f64).collect()
}

/// Largest difference of any coordinate between two motions, and the last time looked at.
pub fn gap(one: &mut Motion, two: &mut Motion) -> (f64, f64) {
    let times = common_times(&[one, two]);
    let end = times[times.len() - 1];
    let gaps = times.iter().map(|&t| largest_difference(&at(one, t).coordinates, &at(two, t).coordinates));
    (gaps.fold(0.0, f64::max), end)
}

/// What two runs of one motion may differ by for it to count as known.
const KNOWN: f64 = 3e-10;

/// As [`gap`], up to the time at which one of the motions is itself no longer known to that: some scenes
/// multiply every error a thousandfold each second. Also says up to when.
pub fn known_gap(one: &mut Motion, two: &mut Motion) -> (f64, f64) {
    let (mut largest, mut end) = (0.0_f64, one.start());
    for t in common_times(&[one, two]) {
        let error =
            |m: &mut Motion| m.difference_of_runs(t).expect("readable").iter().fold(0.0_f64, |a, d| a.max(d.abs()));
        if error(one).max(error(two)) > KNOWN {
            break;
        }
        largest = largest.max(largest_difference(&at(one, t).coordinates, &at(two, t).coordinates));
        end = t;
    }
    (largest, end)
}

/// Multipliers of the size that the momenta of the scene suggest, `|L_v|/|A|`, with no zero among them.
pub fn some_multipliers(scene: &Scene) -> Vec<f64> {
    let system = scene.system.clone();
    let g = &system.graph;
    let values = values(&system, &scene.start);
    let momenta = DVector::from_vec(numbers(g, &g.gradient(system.lagrangian, &system.velocities()), &values));
    let size = momenta.norm() / matrix(g, &system.constraint_jacobian(), &values).norm();
    (0..system.constraints.len()).map(|i| size * [0.4, -0.3, 0.2, -0.1][i % 4]).collect()
}

/// Largest difference of any coordinate between a motion and its closed form.
pub fn error(motion: &mut Motion, exact: &dyn Fn(f64) -> Vec<f64>) -> f64 {
    let times = common_times(&[motion]);
    times.iter().map(|&t| largest_difference(&at(motion, t).coordinates, &exact(t))).fold(0.0, f64::max)
}

/// `max |aᵢ − bᵢ|`; NaN counts as infinite.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
}

/// Largest `|f|` along a motion, over the largest velocity where that is over 1.
pub fn constraint_residual(scene: &Scene, motion: &mut Motion) -> f64 {
    let mut metric = Metric::new(&scene.system).expect("compiles");
    let times = common_times(&[motion]);
    let residual = times.iter().map(|&t| {
        let now = at(motion, t);
        let speed = now.velocities.iter().fold(1.0_f64, |m, v| m.max(v.abs()));
        metric.constraint_residual(t, &now.coordinates, &now.velocities) / speed
    });
    residual.fold(0.0, f64::max)
}

/// `y(t₀)` as the derivation states it, and the guess for the unknowns where it states one.
pub fn start(scene: &Scene, equations: &Equations, constants: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut known = match &equations.removal {
        Some(removal) => removal_values(&scene.system, removal, &scene.start),
        None => values(&scene.system, &scene.start),
    };
    known.extend(equations.constant_symbols().into_iter().zip(constants.iter().copied()));
    let (symbols, inputs): (Vec<Symbol>, Vec<f64>) = known.into_iter().unzip();
    let guesses = equations.blocks.iter().flat_map(|b| b.guess.iter().copied());
    let wanted: Vec<Expr> = equations.states.iter().map(|y| y.start).chain(guesses).collect();
    let tape = equations.tape(&symbols, &wanted).expect("compiles");
    let mut y = vec![0.0; wanted.len()];
    tape.evaluate(&inputs, &mut tape.workspace(), &mut y);
    let guess = y.split_off(equations.states.len());
    (y, guess)
}

/// Largest deviation of the exact Jacobian from differences at the start; the largest entry if over 1.
pub fn jacobian_error(scene: &Scene, equations: &Equations, constants: &[f64]) -> (f64, f64) {
    let compiled = Compiled::new(equations).expect("compiles");
    let mut compiled = compiled.with_jacobian(equations).expect("compiles");
    let (mut y, guess) = start(scene, equations, constants);
    compiled.set_constants(constants);
    if !guess.is_empty() {
        compiled.set_guess(&guess);
    }
    let (n, t) = (y.len(), scene.start.t);
    let mut exact = vec![0.0; n * n];
    compiled.jacobian(t, &y, &mut exact).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    let size = exact.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
    let mut rates = |y: &[f64]| {
        let mut rates = vec![0.0; n];
        compiled.rates(t, y, &mut rates).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
        rates
    };
    let mut worst = 0.0_f64;
    for column in 0..n {
        let h = 1e-3 * y[column].abs().max(0.1);
        let centre = y[column];
        // sixth order: 3/4, −3/20, 1/60
        let mut difference = vec![0.0; n];
        for (step, weight) in [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)] {
            for sign in [1.0, -1.0] {
                y[column] = centre + sign * step * h;
                for (d, r) in difference.iter_mut().zip(rates(&y)) {
                    *d += sign * weight * r / h;
                }
            }
        }
        y[column] = centre;
        worst = (0..n).map(|row| (difference[row] - exact[row * n + column]).abs()).fold(worst, f64::max);
    }
    (worst, size)
}

/// Fails with the figure where it is not under the limit, prints it otherwise.
#[track_caller]
pub fn must(what: &str, figure: f64, limit: f64) {
    println!("{what:<76} {figure:9.2e}  (limit {limit:.0e})");
    assert!(figure <= limit, "{what}: {figure:.3e} is over {limit:.0e}");
}

/// Fails with the figure where it is not over the limit, prints it otherwise.
#[track_caller]
pub fn must_exceed(what: &str, figure: f64, limit: f64) {
    println!("{what:<76} {figure:9.2e}  (at least {limit:.0e})");
    assert!(figure >= limit, "{what}: {figure:.3e} is under {limit:.0e}");
}

/// Values of parameters, time, positions and velocities.
pub fn values(system: &System, state: &State) -> HashMap<Symbol, f64> {
    let mut values = system.parameter_values();
    values.extend(system.values_at(state));
    values
}

/// The state of a motion at one instant.
pub fn state_at(motion: &mut Motion, t: f64) -> State {
    let Outputs { coordinates: q, velocities: v, .. } = at(motion, t);
    State { t, q, v }
}

pub fn number(g: &Graph, e: Expr, values: &HashMap<Symbol, f64>) -> f64 {
    g.evaluate(e, values).unwrap_or_else(|e| panic!("{e}"))
}

pub fn numbers(g: &Graph, es: &[Expr], values: &HashMap<Symbol, f64>) -> Vec<f64> {
    es.iter().map(|&e| number(g, e, values)).collect()
}

pub fn matrix(g: &Graph, m: &Matrix, values: &HashMap<Symbol, f64>) -> DMatrix<f64> {
    DMatrix::from_row_slice(m.rows(), m.columns(), &numbers(g, m.entries(), values))
}

/// Values of `(q, v, t)`, parameters, and `(ü, u̇, u, w)` at the start of a removal.
pub fn removal_values(system: &System, removal: &Removal, state: &State) -> HashMap<Symbol, f64> {
    let mut values = values(system, state);
    let start = complete_removal_start(system, removal, state).unwrap_or_else(|e| panic!("{e}"));
    values.extend(start.values());
    values
}

/// `μ₀` that should give `motion`, removed-constraint, as vakonomic, and the largest residual for it (T2).
///
/// In the coordinates `Q = (u, w)` the motion has `p_Q = (G_u̇, −P)`. In the coordinates `q` of the system
/// that is `p_q` with `p_Q = (∂q/∂Q)ᵀ p_q`, and `μ₀` solves `Aᵀ μ₀ = p_q − L_v`.
pub fn matching_multipliers(scene: &Scene, removal: &Removal, motion: &mut Motion) -> (Vec<f64>, f64) {
    let system = scene.system.clone();
    let g = &system.graph;
    let outputs = at(motion, scene.start.t).multipliers;
    let named: HashMap<String, f64> =
        motion.equations.multipliers.iter().map(|m| m.name.clone()).zip(outputs).collect();
    let symbols: Vec<Symbol> =
        removal.parameters.iter().map(|u| u.symbol).chain(removal.memory.iter().map(|w| w.symbol)).collect();
    assert_eq!(symbols.len(), system.dimension(), "(u, w) are not coordinates");
    let momenta = removal.parameters.iter().map(|u| named[&format!("p_{}", g.name(u.symbol))]);
    let costates =
        removal.memory.iter().map(|w| -named.get(&format!("P_{}", g.name(w.symbol))).copied().unwrap_or(0.0));
    let p = DVector::from_iterator(symbols.len(), momenta.chain(costates));
    let values = removal_values(&system, removal, &scene.start);
    let chart = matrix(g, &g.jacobian(&removal.coordinates, &symbols), &values);
    let p = chart.transpose().lu().solve(&p).expect("(u, w) are coordinates near the start");
    let velocity = numbers(g, &g.gradient(system.lagrangian, &system.velocities()), &values);
    let right = p - DVector::from_vec(velocity);
    let a = matrix(g, &system.constraint_jacobian(), &values).transpose();
    let mu = a.clone().svd(true, true).solve(&right, 1e-12).expect("least squares");
    let residual = (a * &mu - right).amax();
    (mu.as_slice().to_vec(), residual)
}

/// The removals of a scene that have regular equations: those written by hand, then the automatic ones.
pub fn regular_removals(scene: &Scene) -> Vec<Removal> {
    let automatic = [Removal::by_coordinates, Removal::by_quasi_velocities];
    let automatic = automatic.iter().filter_map(|find| find(&scene.system, &scene.start).ok());
    let refused = [("three-cylinders", "paper"), ("appell-hamel", "by-heading")];
    let removals = scene.removals.iter().cloned().chain(automatic);
    removals.filter(|removal| !refused.contains(&(scene.name.as_str(), removal.name.as_str()))).collect()
}
