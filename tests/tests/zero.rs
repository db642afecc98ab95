//! What is zero at the start and switched on later stays in the equations: by steps, edges and bumps, at a
//! time or a place on the way, in every form, removal and ensemble. And where it is lost, the motion says so.

use comparison::{Verdict, compare_motions, multipliers_of};
use equations::Formulation;
use mechanics::{ConstantsRule, Coordinate, Parameter, fresh_symbol};
use motion::{
    CHETAEV, Choice, Ensemble, EnsembleOptions, EnsembleStart, Form, Metric, Motion, REMOVED_CONSTRAINT, Setting,
    Settings, VAKONOMIC, VAKONOMIC_COSTATE, choices_among, derive_in_form, error_estimate, forms, setting, solve,
    solve_choice,
};
use scene::Scene;
use scene::catalogue::built_in;
use symbolic::{Expr, SplitMix};

/// Number of switched scenes that are drawn; `SWITCHED` asks for more, 0 for all (`docs/long-checks.md`).
const SWITCHED: usize = 20;
/// Coordinates, velocities and constraints, one each.
const PLACES: [&str; 3] = ["(1 + tanh(24*U))/2", "exp(-36*U^2)", "step(t, T0 + 0.2*T, T0 + 0.9*T, 0.005*T)"];

/// Steps of a run after which a motion counts as refused, and where longer runs are cut (s): a bicycle that
/// tumbles takes 50,000.
const MAX_STEPS: usize = 2_000;
const LONGEST: f64 = 5.0;

/// A motion, if there is one that is trusted.
fn trusted(scene: &Scene, choice: &Choice, form: Form) -> Option<Motion> {
    let settings = Settings { form, max_steps: MAX_STEPS, ..Settings::default() };
    let mut motion = solve_choice(scene, choice, &settings).ok()?;
    let estimate = error_estimate(&mut motion, setting(scene)).ok()?;
    (estimate.status(&motion).0 == "completed").then_some(motion)
}

fn choice(scene: &Scene, name: &Formulation) -> Choice {
    let all = choices_among(scene, |_| true).into_iter().chain(forms(scene));
    all.into_iter().find(|choice| choice.formulation == name).expect("a formulation")
}

/// Holds all forms, removals and ensembles of a scene against each other: how many agreed, how many were
/// refused or are not trusted, and what contradicts. A removal that is no vakonomic motion is held against
/// `f` alone.
#[derive(Default)]
struct Tally {
    agreed: usize,
    alone: usize,
    refused: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn pair(&mut self, what: &str, scene: &Scene, motions: [&mut Option<Motion>; 2]) {
        let [Some(one), Some(two)] = motions else {
            self.refused += 1;
            return;
        };
        let mut metric = Metric::new(&scene.system).unwrap();
        match compare_motions(one, two, &mut metric).map(|gap| gap.verdict) {
            Ok(Verdict::Different) => self.wrong.push(what.into()),
            Ok(Verdict::Same) => self.agreed += 1,
            _ => self.refused += 1,
        }
    }

    fn scene(&mut self, what: &str, scene: &Scene) {
        let mut plain = trusted(scene, &choice(scene, CHETAEV), Form::Named);
        let mut suited = trusted(scene, &choice(scene, CHETAEV), Form::Suited);
        self.pair(&format!("{what}: Chetaev, forms"), scene, [&mut plain, &mut suited]);
        self.ensemble(&format!("{what}: ensemble"), scene, suited);
        let mut plain = trusted(scene, &choice(scene, VAKONOMIC), Form::Named);
        for (name, form) in [(VAKONOMIC, Form::Suited), (VAKONOMIC_COSTATE, Form::Named)] {
            let mut other = trusted(scene, &choice(scene, name), form);
            self.pair(&format!("{what}: vakonomic, {name:?} {form:?}"), scene, [&mut plain, &mut other]);
        }
        for choice in choices_among(scene, |name| name == REMOVED_CONSTRAINT) {
            let Some(removal) = &choice.removal else { continue };
            let zeros = vec![0.0; removal.memory.len()];
            let choice = Choice { constants: ConstantsRule::Zero, ..choice.clone() };
            let mut removed = trusted(scene, &choice, Form::Suited);
            match multipliers_of(scene, removal, &zeros) {
                Ok(Some(mu)) => {
                    let scene = Scene { multipliers: mu, ..scene.clone() };
                    let mut other = trusted(&scene, &self::choice(&scene, VAKONOMIC), Form::Named);
                    self.pair(&format!("{what}: {}", choice.label), &scene, [&mut other, &mut removed]);
                }
                Ok(None) if removed.is_some() => self.alone += 1,
                _ => self.refused += 1,
            }
        }
    }

    fn ensemble(&mut self, what: &str, scene: &Scene, alone: Option<Motion>) {
        let settings = Settings { max_steps: MAX_STEPS, ..Settings::default() };
        let Ok(mut ensemble) = Ensemble::new(scene, &choice(scene, CHETAEV), &[], &settings) else {
            self.refused += 1;
            return;
        };
        let member = ensemble.member_at(&EnsembleStart::of(scene, &[], ConstantsRule::Zero)).unwrap();
        let end = setting(scene).end;
        let options = EnsembleOptions { threads: 1, estimate: true };
        let found = ensemble.motions(&[member], &[end], &options).remove(0);
        let (Some(mut alone), Ok(found)) = (alone, found) else {
            self.refused += 1;
            return;
        };
        if found.status().0 != "completed" {
            self.refused += 1;
            return;
        }
        let estimate = error_estimate(&mut alone, setting(scene)).unwrap();
        let single = alone.at(end).unwrap().coordinates;
        let member = found.estimate.expect("an estimate").coordinates;
        let off = |i: usize| {
            let size = 1e-10 * (1.0 + single[i].abs());
            (single[i] - found.outputs[0].coordinates[i]).abs() > 10.0 * (estimate.coordinates[i] + member[i]) + size
        };
        match (0..single.len()).find(|&i| off(i)) {
            Some(i) => self.wrong.push(format!("{what}: coordinate {i}")),
            None => self.agreed += 1,
        }
    }
}

/// A switch that is off at the start: its text in the coordinate that goes farthest, at half of the time.
fn switch(scene: &Scene, kind: usize) -> Option<(usize, Expr)> {
    let mut motion = trusted(scene, &choice(scene, CHETAEV), Form::Suited)?;
    let (start, half) = (scene.start.q.clone(), motion.at(scene.start.t + 0.5 * scene.duration).ok()?.coordinates);
    let moved = |&i: &usize| (half[i] - start[i]).abs() / (1.0 + start[i].abs());
    let farthest = (0..start.len()).max_by(|a, b| moved(a).total_cmp(&moved(b)))?;
    let way = half[farthest] - start[farthest];
    let place = format!("(({} - {:?})/{way:?})", scene.system.coordinates[farthest].name, half[farthest]);
    let text = PLACES[kind].replace("T0", &format!("{:?}", scene.start.t)).replace('U', &place);
    let text = text.replace('T', &format!("{:?}", scene.duration));
    (way != 0.0).then(|| (farthest, scene.system.expression(&text).unwrap_or_else(|e| panic!("{text}: {e}"))))
}

/// The scene with its `i`-th constraint's coefficient of the `j`-th velocity times 1 + switch.
fn multiplied(scene: &Scene, i: usize, j: usize, kind: usize) -> Option<Scene> {
    let mut scene = Scene { removals: Vec::new(), ..scene.clone() };
    scene.system.graph = scene.system.graph.clone();
    let velocity = scene.system.coordinates[j].velocity;
    let coefficient = scene.system.graph.derivative(scene.system.constraints[i], velocity);
    if scene.system.graph.is_zero(coefficient) {
        return None;
    }
    let (_, switch) = switch(&scene, kind)?;
    let g = &scene.system.graph;
    let more = g.product(&[switch, coefficient, g.variable(velocity)]);
    let f = g.add(scene.system.constraints[i], more);
    scene.system.constraints[i] = f;
    Some(scene)
}

/// The scene with a coordinate `w`, and `(2 + cos q) w' − f₁ − switch · q'`: without constant pivot.
fn with_one_more(scene: &Scene, kind: usize) -> Option<Scene> {
    let mut scene = Scene { removals: Vec::new(), ..scene.clone() };
    let (farthest, switch) = switch(&scene, kind)?;
    let g = scene.system.graph.clone();
    let first = *scene.system.constraints.first()?;
    let [position, velocity, acceleration] = ["w_", "w_'", "w_''"].map(|name| fresh_symbol(&g, name));
    let w = g.variable(velocity);
    let half = g.div(g.one(), g.integer(2));
    let weight = g.mul(g.number(-0.2), g.variable(position));
    let [q, v] = [scene.system.coordinates[farthest].position, scene.system.coordinates[farthest].velocity];
    let [q, v] = [q, v].map(|s| g.variable(s));
    let factor = g.add(g.integer(2), g.call(symbolic::Function::Cos, q));
    let f = g.sum(&[g.mul(factor, w), g.neg(first), g.neg(g.mul(switch, v))]);
    let system = &mut scene.system;
    system.lagrangian = g.sum(&[system.lagrangian, g.mul(half, g.powi(w, 2)), weight]);
    system.constraints.push(f);
    system.forces.push(g.zero());
    let name = g.name(position);
    system.coordinates.push(Coordinate { name, unit: String::new(), position, velocity, acceleration });
    system.graph = g;
    scene.start.q.push(0.0);
    scene.start.v.push(0.0);
    scene.multipliers.push(0.0);
    Some(scene)
}

/// A switched scene: its name, and how it is made.
type Made = (String, Box<dyn Fn() -> Option<Scene>>);

fn switched() -> Vec<Made> {
    let mut all: Vec<Made> = Vec::new();
    for (name, text) in built_in().filter(|scene| !scene::catalogue::PRESCRIBED.contains(scene)) {
        let scene = Scene::parse(name, text).unwrap();
        let scene = Scene { duration: scene.duration.min(LONGEST), ..scene };
        for kind in 0..PLACES.len() {
            for i in 0..scene.system.constraints.len() {
                for j in 0..scene.system.dimension() {
                    let scene = scene.clone();
                    let what = format!("{name}, constraint {i}, velocity {j}, switch {kind}");
                    all.push((what, Box::new(move || multiplied(&scene, i, j, kind))));
                }
            }
            let scene = scene.clone();
            all.push((format!("{name} and one more, switch {kind}"), Box::new(move || with_one_more(&scene, kind))));
        }
    }
    all
}

#[test]
fn switched_scenes_agree_in_all_forms_or_are_refused() {
    let wanted = std::env::var("SWITCHED").map_or(SWITCHED, |n| n.parse().unwrap());
    let (mut made, mut random) = (switched(), SplitMix::new(35));
    let (mut tally, mut scenes) = (Tally::default(), 0);
    while !made.is_empty() && (wanted == 0 || scenes < wanted) {
        let drawn = (random.bits() % made.len() as u64) as usize;
        let (what, scene) = made.swap_remove(drawn);
        let Some(scene) = scene() else { continue };
        scenes += 1;
        tally.scene(&what, &scene);
    }
    let Tally { agreed, alone, refused, .. } = tally;
    println!("{scenes} switched scenes: {agreed} agree, {alone} keep their constraint, {refused} refused or untrusted");
    assert!(tally.wrong.is_empty(), "{:#?}", tally.wrong);
    assert!(agreed > 6 * refused, "{agreed} agree, {refused} refused");
}

/// Equations from the scene before something was switched in it: a term is lost, and `f` says so.
#[test]
fn a_term_taken_out_by_hand_is_caught_by_the_residual() {
    let (mut caught, mut kept) = (0, Vec::new());
    for (name, text) in built_in() {
        let lost = Scene::parse(name, text).unwrap();
        let places = (0..lost.system.constraints.len()).map(|i| (i, (0..lost.system.dimension()).collect::<Vec<_>>()));
        let places: Vec<(usize, usize)> = places.flat_map(|(i, all)| all.into_iter().map(move |j| (i, j))).collect();
        for kind in 0..PLACES.len() {
            let made = places.iter().find_map(|&(i, j)| multiplied(&lost, i, j, kind));
            let Some(true_scene) = made else { continue };
            let (equations, _) =
                derive_in_form(&lost.system, &lost.start, &choice(&lost, CHETAEV), Form::Suited).unwrap();
            let all = setting(&true_scene);
            let here = Setting { system: &true_scene.system, start: &lost.start, end: all.end };
            let Ok(mut motion) = solve(here, equations, &ConstantsRule::Zero, &Settings::default()) else { continue };
            let mut metric = Metric::new(&true_scene.system).unwrap();
            let residual = motion.grid(400).into_iter().filter_map(|t| {
                let now = motion.at(t).ok()?;
                Some(metric.constraint_residual(t, &now.coordinates, &now.velocities))
            });
            let residual = residual.fold(0.0, f64::max);
            match &motion.doubt {
                Some(doubt) if doubt.because.contains("does not hold") => caught += 1,
                _ if residual < 1e-6 => {}
                _ => kept.push(format!("{name}, switch {kind}: {residual:.1e}, {:?}", motion.doubt)),
            }
        }
    }
    println!("{caught} lost terms are caught");
    assert!(kept.is_empty() && caught > 60, "{caught} caught, not: {kept:#?}");
}

fn scene_of(coordinates: &[&str], lagrangian: &str, constraints: &[&str], velocities: &str, rest: &str) -> Scene {
    let coordinates = coordinates.iter().map(|c| format!("{c} = {{ unit = \"m\", start = 0 }}\n")).collect::<String>();
    let text = format!(
        "title = \"Switched\"\n[parameters]\nX = 5\n[coordinates]\n{coordinates}[system]\nlagrangian = \"{lagrangian}\"\n\
         constraints = {constraints:?}\n[start.velocities]\n{velocities}\n[run]\nduration = 3\n{rest}"
    );
    Scene::parse("switched", &text).unwrap_or_else(|e| panic!("{e}"))
}

const PLACE: [&str; 2] = ["z' - y'", "(2 + cos(x))*w' - z' + y' - y'*(1 + tanh(50*(x - X)))/2"];
const WEIGHED: &str = "(x'^2 + y'^2 + z'^2 + w'^2)/2 + 0.3*z*x - 0.2*w";

fn place() -> Scene {
    scene_of(&["x", "y", "z", "w"], WEIGHED, &PLACE, "\"x'\" = 4\n\"y'\" = 1\n\"z'\" = 1", "")
}

#[test]
fn a_constraint_that_begins_at_a_place_is_no_other_in_any_form() {
    let mut tally = Tally::default();
    let scenes = [
        place(),
        scene_of(
            &["x", "y", "z", "w"],
            WEIGHED,
            &[PLACE[0], "(2 + cos(x))*w' - z' + y' - y'*step(x, X, 50, 0.05)"],
            "\"x'\" = 4\n\"y'\" = 1\n\"z'\" = 1",
            "",
        ),
        // a chain whose last link is no rate from a = 5 on
        scene_of(
            &["a", "b", "c", "d", "e", "h"],
            "a'^2/2 + b'^2/2 + h'^2/2 + (a' + (2 + cos(b))*b')^2/2 + (a' + (2 + cos(b))*b' + (2 + cos(c))*c')^2/2 \
             + (a' + (2 + cos(b))*b' + (2 + cos(c))*c' + (2 + cos(d))*d')^2/2 + (a' + (2 + cos(b))*b' + (2 + cos(c))*c' + (2 + cos(d))*d' + (2 + cos(e))*e')^2/2 \
             + (a' + (2 + cos(b))*b' + (2 + cos(c))*c' + (2 + cos(d))*d' + (2 + cos(e))*e' + (2 + tanh(50*(a - X)))*h')^2/2 + 0.1*e - 0.2*h",
            &["h' - b'*cos(c)"],
            "\"a'\" = 4\n\"b'\" = 0.3\n\"h'\" = 0.3\n\"c'\" = 0.2\n\"d'\" = 0\n\"e'\" = 0",
            "",
        ),
    ];
    for (i, scene) in scenes.iter().enumerate() {
        tally.scene(&format!("scene {i}"), scene);
    }
    assert!(tally.wrong.is_empty() && tally.agreed > 10, "{:?}, {} agree", tally.wrong, tally.agreed);
    // by two independent programs: w(3) = 1.986
    let w = trusted(&scenes[0], &choice(&scenes[0], CHETAEV), Form::Suited).unwrap().at(3.0).unwrap().coordinates[3];
    assert!((w - 1.98604516020986).abs() < 1e-10, "{w}");
}

/// All members have the term that vanishes at the scene's start and for its own parameters.
#[test]
fn members_have_terms_that_vanish_at_the_start_of_the_scene() {
    let scene = place();
    for formulation in [CHETAEV, VAKONOMIC] {
        let chosen = choice(&scene, formulation);
        let mut ensemble = Ensemble::new(&scene, &chosen, &["x", "X"], &Settings::default()).unwrap();
        let rows = [[0.0, 5.0], [3.0, 5.0], [7.0, 5.0], [0.0, -20.0], [0.0, 2.0]];
        for row in rows {
            let member = ensemble.member(&row).unwrap();
            let found = ensemble.motions(&[member], &[3.0], &EnsembleOptions::default()).remove(0).unwrap();
            assert_eq!(found.status(), ("completed", None), "{row:?}");
            let mut alone = scene.clone();
            alone.start.q[0] = row[0];
            let place = alone.system.graph.find_symbol("X").unwrap();
            alone.system.parameters = vec![Parameter { symbol: place, value: row[1], formula: None }];
            if row != [0.0, 5.0] && row != [3.0, 5.0] && row != [0.0, 2.0] {
                // switched on at the start: z' = y' there, so w' = y'/(2 + cos x)
                alone.start.v[3] = alone.start.v[1] / (2.0 + row[0].cos());
            }
            let mut alone = trusted(&alone, &choice(&alone, formulation), Form::Named).unwrap();
            let off = (alone.at(3.0).unwrap().coordinates[3] - found.outputs[0].coordinates[3]).abs();
            assert!(off < 1e-9, "{formulation:?}, {row:?}: w is {off} off");
        }
    }
}

#[test]
fn a_removal_by_hand_that_forgets_what_begins_is_refused() {
    let constraint = "z' - x' - x'*(1 + tanh(50*(x - X)))/2";
    let text = |constraint: &str| {
        format!(
            "title = \"By hand\"\n[parameters]\nX = 5\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n\
             z = {{ start = 0 }}\n[system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"{constraint}\"]\n\
             [removal.hand]\nparameters = [\"x\", \"y\"]\nrates = {{ z = \"x'\" }}\n\
             [start.velocities]\n\"x'\" = 4\n\"y'\" = 1\n[run]\nduration = 3\n"
        )
    };
    let error = Scene::parse("hand", &text(constraint)).expect_err("a constraint remains").to_string();
    assert!(error.contains("does not satisfy constraint 1"), "{error}");
    // far away: no random point finds it, and the motion runs into it
    let mut scene = Scene::parse("hand", &text("z' - x' - x'*exp(-((x - 801)/20)^2)")).unwrap();
    (scene.start.v[0], scene.start.v[2]) = (400.0, 400.0);
    let removed = choices_among(&scene, |name| name == REMOVED_CONSTRAINT).remove(0);
    let motion = solve_choice(&scene, &removed, &Settings::default()).unwrap();
    assert!(motion.doubt.as_ref().is_some_and(|d| d.because.contains("does not hold")), "{:?}", motion.doubt);
}

/// What is listed as constant is: the energy of a constraint that becomes affine is not.
#[test]
fn what_is_listed_as_constant_is_constant() {
    let constraint = "z' - y*x' - 3*(1 + tanh(50*(x - X)))/2";
    let scene =
        scene_of(&["x", "y", "z"], "(x'^2 + y'^2 + z'^2)/2 - 0.2*z", &[constraint], "\"x'\" = 4\n\"y'\" = 1", "");
    let mut found = Vec::new();
    for (formulation, form) in [(CHETAEV, Form::Suited), (CHETAEV, Form::Named), (VAKONOMIC, Form::Suited)] {
        let mut motion = trusted(&scene, &choice(&scene, formulation), form).unwrap();
        let times = motion.grid(50);
        found.extend(motion.invariant_drift(&times).unwrap());
    }
    for removed in choices_among(&scene, |name| name == REMOVED_CONSTRAINT) {
        let mut motion = trusted(&scene, &removed, Form::Suited).unwrap();
        let times = motion.grid(50);
        found.extend(motion.invariant_drift(&times).unwrap());
    }
    assert!(found.iter().all(|(_, _, drift)| *drift < 1e-9) && !found.is_empty(), "{found:?}");
    // Chetaev's energy changes by this, and was listed: to the last digit, `f` is homogeneous at first
    let mut motion = trusted(&scene, &choice(&scene, CHETAEV), Form::Named).unwrap();
    let energy = |t: f64, motion: &mut Motion| {
        let now = motion.at(t).unwrap();
        0.5 * now.velocities.iter().map(|v| v * v).sum::<f64>() + 0.2 * now.coordinates[2]
    };
    let changed = energy(3.0, &mut motion) - energy(0.0, &mut motion);
    assert!(changed.abs() > 1.0 && motion.equations.invariants.iter().all(|i| i.name != "energy"), "{changed}");
}
