//! Forces act by virtual work, `∫ (δL + Q·δq) dt = 0`, in every formulation: against closed forms, against
//! one another, and against the sum `∫ (δL + Q·δq) dt` itself.

use comparison::{Answer, costates_of, membership};
use equations::{Compiled, Derivation, Role};
use mechanics::Removal;
use motion::{CHETAEV, REDUCED_VAKONOMIC, REMOVED_CONSTRAINT, VAKONOMIC, VAKONOMIC_COSTATE};
use scene::Scene;
use symbolic::{Evaluator, Symbol};
use validation::casadi_job::forced;

use super::support::{
    at, complete, equations, error, known_gap, largest_difference, motion_of, must, must_exceed, removal, removed,
    some_multipliers, tight, vakonomic,
};

fn scenes() -> Vec<Scene> {
    let parsed = |(name, text): (String, String)| Scene::parse(&name, &text).unwrap_or_else(|e| panic!("{name}: {e}"));
    forced().into_iter().map(parsed).collect()
}

fn of(name: &str) -> Scene {
    scenes().into_iter().find(|s| s.name == format!("{name} with forces")).expect("one of them")
}

/// Vakonomic, `v = x' + i y'`, linear friction c: μ is constant, `v' = (−c + i μ) v`, a spiral.
#[test]
fn heisenberg_particle_with_linear_friction() {
    let text = scene::catalogue::text_of("heisenberg").expect("built in");
    let c = 0.4;
    let text = format!("{text}\n[system.forces]\nx = \"-{c:?}*x'\"\ny = \"-{c:?}*y'\"\n");
    let scene = Scene::parse("heisenberg", &text).unwrap_or_else(|e| panic!("{e}"));
    let ([x, y, z], [vx, vy]) = ([0, 1, 2].map(|i| scene.start.q[i]), [0, 1].map(|i| scene.start.v[i]));
    for mu in [0.0, 0.7, -2.5] {
        // v = v₀ e^{kt}, s = s₀ + v₀ (e^{kt} − 1)/k, k = −c + iμ; z' = Im(s̄ v)/2
        let square = c * c + mu * mu;
        let exact = |t: f64| {
            let (decay, turn) = ((-c * t).exp(), mu * t);
            let (re, im) = (decay * turn.cos() - 1.0, decay * turn.sin());
            // (e^{kt} − 1)/k
            let (a, b) = ((-c * re + mu * im) / square, (-c * im - mu * re) / square);
            let along = [vx * a - vy * b, vx * b + vy * a];
            // ∫ Im(v̄₀ (e^{k̄t} − 1)/k̄ · v₀ e^{kt}) dt = |v₀|² Im([(1 − e^{−2ct})/2c − (e^{kt} − 1)/k]/k̄)
            let first = (1.0 - decay * decay) / (2.0 * c) - a;
            let area = (vx * vx + vy * vy) * (first * mu + b * c) / square;
            let from_start = x * along[1] - y * along[0];
            vec![x + along[0], y + along[1], z + (from_start + area) / 2.0]
        };
        must(&format!("Heisenberg with friction, mu = {mu}"), error(&mut vakonomic(&scene, &[mu]), &exact), 1e-9);
    }
}

/// Removed constraint with roll and turn as parameters: no force on x, y, so P = 0 and
/// `(I + m R²) ψ'' = τ − c ψ'`, `J φ'' = −k φ'`.
#[test]
fn disc_with_a_motor() {
    let text = scene::catalogue::text_of("disc").expect("built in");
    let (torque, c, k) = (0.2, 0.03, 0.01);
    let text = format!("{text}\n[system.forces]\npsi = \"{torque:?} - {c:?}*psi'\"\nphi = \"-{k:?}*phi'\"\n");
    let scene = Scene::parse("disc", &text).unwrap_or_else(|e| panic!("{e}"));
    let (inertia, about) = (0.125 + 0.25, 0.0625);
    let relaxed = |v: f64, limit: f64, rate: f64, t: f64| limit * t + (v - limit) * (1.0 - (-rate * t).exp()) / rate;
    let mut motion = removed(&scene, removal(&scene, "roll-and-turn"), &[]);
    let far = |t: f64| vec![relaxed(2.0, torque / c, c / inertia, t), 0.4 + relaxed(0.7, 0.0, k / about, t)];
    let worst =
        (0..=20).map(|i| f64::from(i) / 2.0).map(|t| largest_difference(&at(&mut motion, t).coordinates[2..], &far(t)));
    must("disc with a motor, removed constraint", worst.fold(0.0, f64::max), 1e-9);
}

#[test]
fn the_forms_of_the_vakonomic_equations_have_one_motion() {
    for scene in scenes().iter().filter(|s| s.system.linear_constraints().is_ok()) {
        let mu: Vec<f64> = some_multipliers(scene).iter().map(|mu| 0.3 * mu).collect();
        for form in [VAKONOMIC_COSTATE, REDUCED_VAKONOMIC] {
            let mut first = motion_of(scene, equations(&scene.system, VAKONOMIC, None), &mu, &tight());
            let mut second = motion_of(scene, equations(&scene.system, form, None), &mu, &tight());
            let (distance, end) = known_gap(&mut first, &mut second);
            must(&format!("{}: {}, to {end:.2} s", scene.name, form.name), distance, 1e-9);
            assert!(end > scene.start.t, "{}: nothing was compared", scene.name);
        }
    }
}

/// Coordinate removal with all costates is the vakonomic family, with forces too: `P₀ = −∂(L + μ₀·f)/∂ẇ`.
#[test]
fn removed_and_vakonomic_are_one_family_where_parameters_are_coordinates() {
    let mut count = 0;
    for scene in scenes() {
        if scene.system.constraints.is_empty() {
            continue;
        }
        let Ok(by_coordinates) = Removal::by_coordinates(&scene.system, &scene.start) else { continue };
        let mu: Vec<f64> = some_multipliers(&scene).iter().map(|mu| 0.3 * mu).collect();
        let costates = costates_of(&scene, &by_coordinates, &mu).expect("values").expect("coordinates");
        let derivation = Derivation { removal: Some(&by_coordinates), all_costates: true, ..Derivation::default() };
        let derived = (REMOVED_CONSTRAINT.derive)(&scene.system, &derivation).expect("equations");
        let mut own = motion_of(&scene, derived, &costates, &tight());
        let mut family = motion_of(&scene, equations(&scene.system, VAKONOMIC, None), &mu, &tight());
        let (distance, end) = known_gap(&mut own, &mut family);
        must(&format!("{}: one family, to {end:.2} s", scene.name), distance, 1e-8);
        assert!(end > scene.start.t, "{}: nothing was compared", scene.name);
        count += 1;
    }
    assert!(count >= 9, "{count} scenes");
}

/// Where the constraint is integrable all are one, and where it is not Chetaev's motion is another.
#[test]
fn the_decision_knows_the_forces() {
    for (name, wanted) in [("velocity-pendulum", true), ("bowl", true), ("sledge", false)] {
        let found = membership(&of(name), 1.0).expect("decided").expect("constrained").answer();
        let some = matches!(found, Answer::SomeProved | Answer::Some { .. });
        let none = matches!(found, Answer::NoneProved { .. } | Answer::None { .. });
        assert_eq!((some, none), (wanted, !wanted), "{name}: {found:?}");
    }
}

#[test]
fn energy_and_momentum_are_claimed_only_where_no_force_works() {
    for scene in scenes() {
        for formulation in [CHETAEV, VAKONOMIC, VAKONOMIC_COSTATE] {
            let names: Vec<String> =
                equations(&scene.system, formulation, None).invariants.into_iter().map(|i| i.name).collect();
            assert!(!names.contains(&"energy".to_string()), "{}, {}", scene.name, formulation.name);
        }
    }
    // a force on y leaves the momentum of x alone
    let scene = of("disc");
    let names: Vec<String> = equations(&scene.system, VAKONOMIC, None).invariants.into_iter().map(|i| i.name).collect();
    assert_eq!(names, ["momentum y"]);
}

/// `∫ (L + Q·δq) dt` along varied curves of a removal: `u` is varied by a bump, `w` follows by `ẇ = B`.
struct Sum {
    /// `B`, then `q`, `L`, `Q` in `(t, u, u̇, ü, w)`.
    program: Evaluator<f64>,
}

impl Sum {
    fn new(scene: &Scene, removal: &Removal) -> Self {
        let system = &scene.system;
        let of = |pick: fn(&mechanics::DisplacementParameter) -> Symbol| removal.parameters.iter().map(pick);
        let inputs: Vec<Symbol> = [system.time]
            .into_iter()
            .chain(of(|u| u.symbol))
            .chain(of(|u| u.rate))
            .chain(of(|u| u.second_rate))
            .chain(removal.memory.iter().map(|w| w.symbol))
            .collect();
        let mut outputs: Vec<_> = removal.memory.iter().map(|w| w.rate).collect();
        outputs.extend(&removal.coordinates);
        outputs.push(removal.rewrite(system, system.lagrangian));
        outputs.extend(system.forces.iter().map(|&force| removal.rewrite(system, force)));
        let program = system.evaluator(&inputs, &outputs).expect("compiles");
        Sum { program }
    }

    fn at(&mut self, t: f64, u: &[[f64; 3]], w: &[f64]) -> Vec<f64> {
        let rates = (0..3).flat_map(|k| u.iter().map(move |u| u[k]));
        let inputs: Vec<f64> = [t].into_iter().chain(rates).chain(w.iter().copied()).collect();
        self.program.evaluate(&inputs).to_vec()
    }
}

/// `(s − s²)⁴` and its derivatives by `t = t₀ + s T`.
fn bump(s: f64, length: f64) -> [f64; 3] {
    let (b, slope) = (s - s * s, 1.0 - 2.0 * s);
    let second = 12.0 * b.powi(2) * slope * slope - 8.0 * b.powi(3);
    [b.powi(4), 4.0 * b.powi(3) * slope / length, second / length.powi(2)]
}

/// Time steps of the sum, even.
const STEPS: usize = 400;
const EPSILON: f64 = 1e-4;

/// `∫ (δL + Q·δq) dt + P(t₁)·δw(t₁)`, zero along a motion, and the part of the forces, for `δu` along one
/// parameter.
fn first_variation(scene: &Scene, removal: &Removal, along: usize) -> [f64; 2] {
    let derivation = Derivation { removal: Some(removal), all_costates: true, ..Derivation::default() };
    let derived = (REMOVED_CONSTRAINT.derive)(&scene.system, &derivation).unwrap_or_else(|e| panic!("{e}"));
    let constants: Vec<f64> = (0..derived.free_constants.len()).map(|i| [0.1, -0.07, 0.05][i % 3]).collect();
    let mut compiled = Compiled::new(&derived).expect("compiles");
    compiled.set_constants(&constants);
    let mut motion = complete(scene, motion_of(scene, derived, &constants, &tight()));
    let symbols = motion.equations.state_symbols();
    let place = |s: Symbol| symbols.iter().position(|&y| y == s).expect("a state");
    let (start, length) = (motion.start(), motion.end() - motion.start());
    let time = |node: usize| start + length * node as f64 / (2 * STEPS) as f64;
    let mut rates = vec![0.0; symbols.len()];
    let mut curve = Vec::new();
    for node in 0..=2 * STEPS {
        let y = motion.states_at(time(node)).expect("readable");
        compiled.rates(time(node), &y, &mut rates).expect("regular");
        let of = |u: &mechanics::DisplacementParameter| [y[place(u.symbol)], y[place(u.rate)], rates[place(u.rate)]];
        curve.push(removal.parameters.iter().map(of).collect::<Vec<_>>());
    }
    let [first, last] = [start, motion.end()].map(|t| motion.states_at(t).expect("readable"));
    let w: Vec<f64> = removal.memory.iter().map(|w| first[place(w.symbol)]).collect();
    let roles = motion.equations.states.iter().zip(&last);
    let costates: Vec<f64> = roles.filter(|(y, _)| y.role == Role::MemoryCostate).map(|(_, &p)| p).collect();
    assert_eq!(costates.len(), w.len());

    let mut sum = Sum::new(scene, removal);
    let (k, n) = (w.len(), scene.system.dimension());
    // what L, q and Q are at the ends of steps, and w at the end
    let run = |epsilon: f64| {
        let varied = |node: usize| {
            let mut u = curve[node].clone();
            let bump = bump(node as f64 / (2 * STEPS) as f64, length);
            u[along].iter_mut().zip(bump).for_each(|(u, b)| *u += 256.0 * epsilon * b);
            u
        };
        let (h, mut w, mut out) = (length / STEPS as f64, w.clone(), Vec::new());
        for step in 0..=STEPS {
            let here = sum.at(time(2 * step), &varied(2 * step), &w);
            if step < STEPS {
                let moved =
                    |w: &[f64], by: &[f64], h: f64| -> Vec<f64> { w.iter().zip(by).map(|(w, b)| w + h * b).collect() };
                let mut slope = |node: usize, w: &[f64]| sum.at(time(node), &varied(node), w)[..k].to_vec();
                let a = here[..k].to_vec();
                let b = slope(2 * step + 1, &moved(&w, &a, h / 2.0));
                let c = slope(2 * step + 1, &moved(&w, &b, h / 2.0));
                let d = slope(2 * step + 2, &moved(&w, &c, h));
                (0..k).for_each(|i| w[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
            }
            out.push(here[k..].to_vec());
        }
        (out, w)
    };
    let [(own, _), (plus, w_plus), (minus, w_minus)] = [0.0, EPSILON, -EPSILON].map(run);
    let (mut action, mut work) = (0.0, 0.0);
    for step in 0..=STEPS {
        let weight = if step == 0 || step == STEPS { 1.0 } else { (2 + 2 * (step % 2)) as f64 };
        let weight = weight * length / (3 * STEPS) as f64 / (2.0 * EPSILON);
        action += weight * (plus[step][n] - minus[step][n]);
        work += weight * (0..n).map(|i| own[step][n + 1 + i] * (plus[step][i] - minus[step][i])).sum::<f64>();
    }
    let end: f64 = (0..k).map(|i| costates[i] * (w_plus[i] - w_minus[i]) / (2.0 * EPSILON)).sum();
    [action + work + end, work]
}

#[test]
fn the_sum_of_action_and_virtual_work_is_stationary_along_removed_constraint_motions() {
    let asked = [
        ("sledge", "arc-length"),
        ("sledge", "along-x"),
        ("sleigh", "arc-length"),
        ("disc", "roll-and-turn"),
        ("three-cylinders", "by-turn"),
        ("ball-in-cone", "paper"),
        ("heisenberg", "along-xy"),
        ("by-rate", "second-order"),
        ("by-rate", "by-rate"),
    ];
    for (name, by) in asked {
        let scene = Scene { duration: 0.6, ..of(name) };
        let own = removal(&scene, by);
        let mut works = 0.0_f64;
        for along in 0..own.parameters.len() {
            let [left, work] = first_variation(&scene, own, along);
            must(&format!("{name}, {by}, variation {along}, of which forces {work:.1e}"), left.abs(), 2e-7);
            works = works.max(work.abs());
        }
        must_exceed(&format!("{name}, {by}: work of the forces"), works, 1e-4);
    }
}
