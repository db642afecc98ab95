//! Chains in few coordinates, by the velocities of their bodies, are the same systems.

use equations::{Compiled, Plan};
use mechanics::ConstantsRule;
use motion::{
    CHETAEV, REDUCED_CHETAEV, REDUCED_VAKONOMIC, Settings, choices, derive_at, error_estimate, setting, solve_choice,
};
use reference::{Entry, Question, reference};
use scene::Scene;
use scene::catalogue::trailer::{self, Coordinates};
use symbolic::Scalar;

use super::support::{at, chetaev, choice, common_times, equations, must, some_multipliers};
use super::{reduced_form, reduced_vakonomic};

pub fn train(trailers: usize, coordinates: Coordinates) -> Scene {
    trailer::scene(trailers, coordinates).expect("its own text parses")
}

/// Links that hang one on another from a cart, the last one with a blade at its end.
pub fn hanging(links: usize) -> Scene {
    let (mut x, mut y, mut height) = ("x'".to_string(), "0".to_string(), "0".to_string());
    let mut text =
        "title = \"Links\"\n[parameters]\nl = 0.7\nk = 0.3\n[coordinates]\nx = { start = 0.2 }\n".to_string();
    let mut energies = vec!["x'^2 - 2*x^2".to_string()];
    let mut blade = format!("x'*cos(th{links})");
    for i in 1..=links {
        text += &format!("th{i} = {{ start = {:?} }}\n", 0.3 + 0.17 * (i * i % 7) as f64);
        x += &format!(" + l*th{i}'*cos(th{i})");
        y += &format!(" + l*th{i}'*sin(th{i})");
        height += &format!(" - l*cos(th{i})");
        blade += &format!(" + l*th{i}'*cos(th{i} - th{links})");
        energies.push(format!("({x})^2/2 + ({y})^2/2 + k*(th1' - th{i}')^2 - 3*({height})"));
    }
    let start: Vec<String> = (1..links).map(|i| format!("\"th{i}'\" = {:?}\n", 0.9 - 0.4 * (i % 3) as f64)).collect();
    text += &format!("[system]\nlagrangian = \"{}\"\nconstraints = [\"{blade}\"]\n", energies.join(" + "));
    text += &format!("[start.velocities]\n\"x'\" = 0.4\n{}[run]\nduration = 1.0\n", start.concat());
    Scene::parse("hanging", &text).unwrap_or_else(|e| panic!("{e}"))
}

/// A full block is factorized in every instant, a sparse one eliminated beforehand; either way the rates are
/// the same.
#[test]
fn full_blocks_are_factorized_and_sparse_ones_eliminated() {
    let bicycle = super::machines::with_formulas("bicycle", include_str!("../scenes/by-hand/bicycle.toml"));
    let bicycle = super::machines::parsed(&bicycle);
    let sparse = [hanging(2), train(9, Coordinates::Minimal), bicycle];
    for (scene, is_full) in [(hanging(8), true)].into_iter().chain(sparse.map(|scene| (scene, false))) {
        let motion = &mut chetaev(&scene);
        let equations = motion.equations.clone();
        let plans =
            [Plan::choose(&equations, None), Plan::eliminated(&equations, None)].map(|plan| plan.expect("a plan"));
        assert_eq!((plans[0].left.is_empty(), plans[1].left.is_empty()), (!is_full, true), "{}", scene.name);
        let (t, point) = (motion.end(), motion.states_at(motion.end()).expect("readable"));
        let [one, other] = plans.map(|plan| {
            let mut rates = vec![0.0; point.len()];
            let mut compiled = Compiled::with_plan(&equations, &plan).expect("compiles");
            compiled.rates(t, &point, &mut rates).expect("regular");
            rates
        });
        let size = one.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
        let off = one.iter().zip(&other).fold(0.0, |off: f64, (a, b)| off.max((a - b).abs()));
        must(&format!("{}: rates", scene.name), off / size, 1e-11);
    }
}

#[test]
fn instants_of_chains_are_those_of_the_forms_without_quasi_velocities() {
    for mut scene in [train(5, Coordinates::Minimal), train(9, Coordinates::Minimal), hanging(8)] {
        let name = format!("{} in {} coordinates", scene.name, scene.system.dimension());
        let equations = reduced_form::reduced(&scene);
        assert_eq!(equations.coordinates.len(), scene.system.dimension());
        assert!(equations.graph.find_symbol("z_1'").is_some(), "{name}: taken for no chain");
        let mut motion = chetaev(&scene);
        for t in common_times(&[&motion]).into_iter().step_by(25) {
            let point = at(&mut motion, t);
            scene.start = mechanics::State { t, q: point.coordinates, v: point.velocities };
            let (rates, velocities) = reduced_form::differences(&scene, &equations, &scene.start);
            must(&format!("{name}: rates by Maggi, t = {t:.2} s"), rates, 1e-11);
            must(&format!("{name}: velocities"), velocities, 1e-12);
            let [rates, velocities, multipliers] = reduced_vakonomic::differences(&scene, &some_multipliers(&scene));
            must(&format!("{name}: rates of the costate form"), rates, 1e-11);
            must(&format!("{name}: velocities and multipliers"), velocities.max(multipliers), 1e-11);
        }
    }
}

#[test]
fn a_train_costs_the_same_in_few_coordinates() {
    for form in [REDUCED_CHETAEV, REDUCED_VAKONOMIC] {
        let [many, few] = [Coordinates::Maximal, Coordinates::Minimal].map(|coordinates| {
            let scene = train(20, coordinates);
            let choice = choice(form, None, ConstantsRule::Zero);
            let equations = derive_at(&scene.system, &scene.start, &choice).unwrap_or_else(|e| panic!("{e}"));
            assert!(equations.guards.is_empty() && equations.unknowns().len() <= 2);
            Compiled::new(&equations).expect("compiles").cost()[1].operations()
        });
        println!("{form:?}: {many} operations, {few} in few coordinates");
        assert!(2 * few <= 3 * many, "{form:?}: {few} operations over {many}");
    }
}

/// The motion up to the scene's duration is trusted, and as good as it says: against the form with
/// multipliers in double-double arithmetic. Returned: the largest estimate of a multiplier over the largest
/// multiplier.
fn must_be_as_good_as_it_says(name: &str, scene: &Scene) -> f64 {
    let mut motion = solve_choice(scene, &choices(scene)[0], &Settings::default()).expect("a motion");
    assert_eq!(motion.form.chosen.name, REDUCED_CHETAEV.name, "{name}");
    let estimate = error_estimate(&mut motion, setting(scene)).expect("its start");
    assert_eq!((&motion.doubt, estimate.complaint()), (&None, None), "{name}");
    let end = at(&mut motion, scene.duration);
    let equations = equations(&scene.system, CHETAEV, None);
    let question = Question { system: &scene.system, start: &scene.start, equations: &equations, constants: &[] };
    let truth = reference(&question, &[scene.duration], 1e-20).expect("in double-double arithmetic");
    must(&format!("{name}: estimate"), estimate.absolute, 1e-8);
    let error = truth.distance(0, &end.coordinates);
    must(&format!("{name}: error over its estimate"), error / estimate.absolute, 1.0);
    let size = end.multipliers.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    let each = end.multipliers.iter().zip(&truth.points[0].multipliers).zip(&estimate.multipliers);
    let over =
        each.map(|((now, right), said)| (*right - Scalar::from_f64(*now)).to_f64().abs() / said.max(1e-14 * size));
    must(&format!("{name}: errors of multipliers over their estimates"), over.fold(0.0, f64::max), 1.0);
    estimate.multipliers.iter().copied().fold(0.0, f64::max) / size
}

/// Of paths from a number to a velocity of the n-th trailer there are 2ⁿ, which cancel.
#[test]
fn a_long_train_is_trusted_and_as_good_as_it_says() {
    let mut scene = train(20, Coordinates::Maximal);
    scene.duration = 2.0;
    let multipliers = must_be_as_good_as_it_says("20 trailers", &scene);
    must("20 trailers: largest estimate of a multiplier", multipliers, 1e-8);
}

/// Where hitches are short, axles are nearly at one place, and constraints nearly dependent: multipliers are
/// badly known. The pivots of quasi-velocities are as constant as before.
#[test]
fn short_hitches_are_no_reason_for_another_form() {
    for (trailers, hitch) in [(4, 1e-2), (3, 1e-5)] {
        let overrides = [("d", hitch), ("duration", 3.0 * hitch)].map(|(name, x)| (name.to_string(), x.into()));
        let scene = scene::catalogue::find(&format!("n-trailer-{trailers}"), &overrides).expect("a train");
        must_be_as_good_as_it_says(&format!("{trailers} trailers, hitches of {hitch:e}"), &scene);
    }
}
