//! Motions go on where pivots vanish: by other pivots they are those of the equations with multipliers.

use comparison::{costates_of, multipliers_of};
use equations::Formulation;
use mechanics::{ConstantsRule, Removal};
use motion::{
    Choice, Ending, Motion, REDUCED_CHETAEV, REDUCED_VAKONOMIC, REMOVED_CONSTRAINT, Settings, VAKONOMIC, solve_choice,
};
use scene::Scene;

use super::support::{
    at, chetaev, complete, equations, gap, known_gap, largest_difference, motion_of, must, tight, vakonomic,
};

fn parsed(coordinates: &str, lagrangian: &str, constraints: &str, velocities: &str, duration: f64) -> Scene {
    let coordinates: Vec<String> = coordinates
        .split(' ')
        .map(|c| c.split_once('=').unwrap_or((c, "0")))
        .map(|(name, start)| format!("{name} = {{ unit = \"m\", start = {start} }}"))
        .collect();
    let text = format!(
        "title = \"Charts\"\n[coordinates]\n{}\n[system]\nlagrangian = \"{lagrangian}\"\nconstraints = [{constraints}]\n\
         [start]\nvelocities = {{ {velocities} }}\n[run]\nduration = {duration}\n",
        coordinates.join("\n")
    );
    Scene::parse("charts", &text).unwrap_or_else(|e| panic!("{e}"))
}

/// A sleigh on a slope, its mass beside the blade, that turns past heading 90° again and again.
fn sleigh() -> Scene {
    let lagrangian = "((x' - 0.2*phi'*sin(phi))^2 + (y' + 0.2*phi'*cos(phi))^2 + phi'^2)/2 + 0.3*x";
    parsed("x y phi=0.3", lagrangian, "\"y'*cos(phi) - x'*sin(phi)\"", "\"x'\" = 0.6, \"phi'\" = 1.1", 20.0)
}

/// A sleigh on a plate that moves, in a field that turns its path.
fn driven() -> Scene {
    let lagrangian = "(x'^2 + y'^2 + 0.7*phi'^2)/2 + 0.2*(x*y' - y*x') + 0.1*sin(t)*x";
    let constraint = "\"(y' - 0.2*cos(t) - 0.1*x)*cos(phi) - (x' + 0.1*y)*sin(phi)\"";
    parsed("x y phi=0.3", lagrangian, constraint, "\"x'\" = 0.6, \"phi'\" = 1.1", 20.0)
}

/// Two wheels on one axle, at heading 0: both roll, and the axle does not slip sideways.
fn robot() -> Scene {
    let constraints = "\"y'*cos(phi) - x'*sin(phi)\", \"x'*cos(phi) + y'*sin(phi) + 0.3*phi' - 0.1*right'\", \
                       \"x'*cos(phi) + y'*sin(phi) - 0.3*phi' - 0.1*left'\"";
    let lagrangian = "(x'^2 + y'^2 + 0.2*phi'^2 + 0.01*(left'^2 + right'^2))/2 + 0.1*x*y";
    parsed("x y phi left right", lagrangian, constraints, "\"left'\" = 6, \"right'\" = 9", 20.0)
}

/// A car whose front wheel turns past 90° beside its rear wheel: then it turns on the spot.
fn car() -> Scene {
    let constraints =
        "\"y'*cos(phi) - x'*sin(phi)\", \"y'*cos(phi + delta) - x'*sin(phi + delta) + 0.7*phi'*cos(delta)\"";
    let lagrangian = "(x'^2 + y'^2 + 0.4*phi'^2 + 0.02*(phi' + delta')^2 + 2*delta'^2)/2 - 0.1*x";
    parsed("x y phi delta=0.2", lagrangian, constraints, "\"x'\" = 0.8, \"delta'\" = 0.7", 20.0)
}

fn removed(scene: &Scene, constants: ConstantsRule) -> (Removal, Motion) {
    let removal = Removal::by_coordinates(&scene.system, &scene.start).expect("linear constraints");
    let choice =
        Choice { label: "removed".into(), formulation: REMOVED_CONSTRAINT, removal: Some(removal.clone()), constants };
    (removal, solve_choice(scene, &choice, &tight()).unwrap_or_else(|e| panic!("{e}")))
}

/// The form in quasi-velocities.
fn reduced(scene: &Scene, formulation: &'static Formulation, mu0: &[f64]) -> Motion {
    let constants = ConstantsRule::Given(mu0.to_vec());
    let choice = Choice { label: formulation.title.into(), formulation, removal: None, constants };
    complete(scene, solve_choice(scene, &choice, &tight()).unwrap_or_else(|e| panic!("{e}")))
}

fn changes(what: &str, motion: &Motion) -> usize {
    for change in &motion.charts {
        println!("{what}: from t = {:.4} on by {}", change.t, change.by);
    }
    motion.charts.len()
}

#[test]
fn a_removal_by_coordinates_goes_on_where_its_pivot_vanishes() {
    for (name, scene) in [("sleigh", sleigh()), ("driven", driven()), ("robot", robot()), ("car", car())] {
        let h = scene.system.constraints.len();
        for costates in [vec![0.0; h], vec![0.02; h]] {
            let (removal, motion) = removed(&scene, ConstantsRule::Given(costates.clone()));
            let mut motion = complete(&scene, motion);
            assert_eq!(changes(name, &motion), 1, "{name}: {:?}", motion.charts);
            let mu0 = multipliers_of(&scene, &removal, &costates).unwrap().expect("coordinates");
            let mut vakonomic = vakonomic(&scene, &mu0);
            let (apart, end) = gap(&mut motion, &mut vakonomic);
            assert_eq!(end, 20.0);
            must(&format!("{name}, P = {costates:?}: removed against vakonomic over {end} s"), apart, 1e-9);
        }
    }
}

/// A car with two trailers, each hitched behind the axle before it.
fn trailers() -> Scene {
    let constraints = "\"y'*cos(phi) - x'*sin(phi)\", \
                       \"y'*cos(a) - x'*sin(a) - 0.3*phi'*cos(phi - a) - 0.8*a'\", \
                       \"y'*cos(b) - x'*sin(b) - 0.3*phi'*cos(phi - b) - 1.1*a'*cos(a - b) - 0.8*b'\"";
    let lagrangian = "(x'^2 + y'^2 + 0.4*phi'^2 + 0.3*a'^2 + 0.2*b'^2)/2 + 0.1*x - 0.05*y";
    parsed("x y phi a=0.4 b=0.7", lagrangian, constraints, "\"x'\" = 0.8, \"phi'\" = 0.9", 20.0)
}

/// Systems of the literature: as far as both motions are known, they are one, over all changes of charts.
#[test]
fn classic_systems_go_on_by_other_charts_as_with_multipliers() {
    let mut passed = 0;
    for scene in [
        trailers(),
        classic("roller-racer", include_str!("../../../crates/scene/classics/roller-racer.toml"), 20.0),
        classic("rattleback", include_str!("../../../crates/scene/classics/rattleback.toml"), 20.0),
        classic("snakeboard", include_str!("../../../crates/scene/classics/snakeboard.toml"), 20.0),
        // it falls, its front wheel is nearly flat on the ground at 0.9713, and at 3.3287 its constraints are
        // nearly dependent
        by_hand(3.0),
    ] {
        // from 0 the snakeboard comes to where its costates are not determined any more
        let costates =
            if scene.name == "snakeboard" { vec![0.1, 0.1] } else { vec![0.0; scene.system.constraints.len()] };
        let (removal, mut motion) = removed(&scene, ConstantsRule::Given(costates.clone()));
        let mu0 = multipliers_of(&scene, &removal, &costates).unwrap().expect("coordinates");
        let equations = equations(&scene.system, VAKONOMIC, None);
        let mut vakonomic = motion_of(&scene, equations, &mu0, &tight());
        let (apart, end) = known_gap(&mut motion, &mut vakonomic);
        changes(&scene.name, &motion);
        assert!(motion.is_complete() && vakonomic.is_complete(), "{:?}, {:?}", motion.ending, vakonomic.ending);
        must(&format!("{}: removed against vakonomic over {end} s", scene.name), apart, 1e-9);
        passed += motion.charts.iter().filter(|change| change.t < end).count();
    }
    assert_eq!(passed, 5);
}

/// The falling bicycle by formulas that were written by hand.
fn by_hand(duration: f64) -> Scene {
    let text = super::machines::with_formulas("bicycle", include_str!("../scenes/by-hand/bicycle.toml"));
    let set = [("lean'", 0.5), ("yaw", 0.3), ("duration", duration)].map(|(name, x)| (name.to_string(), x));
    Scene::parse_with("bicycle", &text, &set).unwrap_or_else(|e| panic!("{e}"))
}

fn classic(name: &str, text: &str, duration: f64) -> Scene {
    Scene::parse_with(name, text, &[("duration".into(), duration)]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn what_is_read_off_after_a_change_is_what_the_first_chart_means() {
    let scene = sleigh();
    let (removal, mut motion) = removed(&scene, ConstantsRule::Given(vec![0.1]));
    let mut vakonomic = vakonomic(&scene, &multipliers_of(&scene, &removal, &[0.1]).unwrap().expect("coordinates"));
    let names: Vec<String> = motion.equations.multipliers.iter().map(|p| p.name.clone()).collect();
    assert_eq!(names, ["p_x", "p_phi", "P_y"]);
    let energy = at(&mut motion, 0.0).invariants;
    for t in [0.5, 1.5, 4.2, 9.1, 19.7] {
        let then = vakonomic.at(t).unwrap();
        let here = Scene { start: mechanics::State { t, q: then.coordinates, v: then.velocities }, ..scene.clone() };
        let costates = costates_of(&here, &removal, &then.multipliers).unwrap().expect("coordinates");
        let now = at(&mut motion, t);
        must("costate of y, at any heading", largest_difference(&now.multipliers[2..], &costates), 1e-8);
        must("energy", largest_difference(&now.invariants, &energy), 1e-9);
        // the states of the first chart: u, u', w, P
        let states = motion.states_at(t).unwrap();
        assert_eq!(states.len(), motion.equations.states.len());
        let place = |name: &str| {
            motion.equations.states.iter().position(|y| motion.equations.graph.name(y.symbol) == name).expect("a state")
        };
        let found = ["x", "phi", "y", "P_y"].map(|name| states[place(name)]);
        let [x, y, phi] = now.coordinates[..] else { unreachable!() };
        must("states of the first chart", largest_difference(&found, &[x, phi, y, costates[0]]), 1e-8);
    }
}

#[test]
fn quasi_velocities_go_on_where_their_pivot_vanishes() {
    let scene = car();
    let mut own = reduced(&scene, REDUCED_CHETAEV, &[]);
    assert_eq!(changes("Chetaev", &own), 1);
    must("car, Chetaev in quasi-velocities over 20 s", gap(&mut own, &mut chetaev(&scene)).0, 1e-9);
    let mu0 = [0.02, -0.01];
    let (mut own, mut whole) = (reduced(&scene, REDUCED_VAKONOMIC, &mu0), vakonomic(&scene, &mu0));
    assert_eq!(changes("vakonomic", &own), 1);
    must("car, vakonomic in quasi-velocities over 20 s", gap(&mut own, &mut whole).0, 1e-9);
    for t in [1.0, 2.5, 11.0, 20.0] {
        let apart = largest_difference(&at(&mut own, t).multipliers, &at(&mut whole, t).multipliers);
        must("its multipliers", apart, 1e-8);
    }
}

/// `x' cos φ + y' sin φ` and `y' cos φ − x' sin φ` are solved by way of a pivot that vanishes; what they give
/// has none, and neither have the rates of a removal by quasi-velocities.
#[test]
fn quasi_velocities_without_a_pole_have_none() {
    for scene in [sleigh(), robot(), car()] {
        let removal = Removal::by_quasi_velocities(&scene.system, &scene.start).expect("linear constraints");
        let g = &scene.system.graph;
        let rates: Vec<_> = removal.memory.iter().map(|w| w.rate).collect();
        let texts: Vec<String> = rates.iter().map(|&rate| g.plain(rate)).collect();
        assert_eq!(g.denominators(&rates), [], "{texts:?}");
        removal.verify(&scene.system).unwrap_or_else(|e| panic!("{e}"));
        let constants = ConstantsRule::Given(vec![0.01; removal.memory.len()]);
        let choice = Choice { label: "u".into(), formulation: REMOVED_CONSTRAINT, removal: Some(removal), constants };
        complete(&scene, solve_choice(&scene, &choice, &tight()).unwrap_or_else(|e| panic!("{e}")));
    }
}

/// A motion from rest by equations that are not linear in their unknowns, which all vanish there.
#[test]
fn unknowns_that_vanish_are_found() {
    let lagrangian = "-sqrt(1 - x'^2 - y'^2 - z'^2 - phi'^2) + 0.1*x";
    let constraints = "\"y'*cos(phi) - x'*sin(phi) + 0.3*z'*z\", \"z'*cos(phi) + 0.7*x'*sin(z) - 0.2*phi'\"";
    let scene = parsed("x y z=0.7 phi=0.3", lagrangian, constraints, "\"x'\" = 0, \"phi'\" = 0", 3.0);
    for mu0 in [[0.31, 0.47], [-0.2, 0.83], [0.6, -0.09]] {
        let (mut own, mut whole) = (reduced(&scene, REDUCED_VAKONOMIC, &mu0), vakonomic(&scene, &mu0));
        must("from rest, in quasi-velocities", gap(&mut own, &mut whole).0, 1e-9);
    }
}

#[test]
fn all_charts_of_a_run_share_its_limits() {
    let scene = sleigh();
    let (removal, whole) = removed(&scene, ConstantsRule::Zero);
    let limit = (whole.work.steps + whole.work.rejected) / 2;
    let constants = ConstantsRule::Zero;
    let choice = Choice { label: "half".into(), formulation: REMOVED_CONSTRAINT, removal: Some(removal), constants };
    let half = solve_choice(&scene, &choice, &Settings { max_steps: limit, ..tight() }).unwrap();
    let Ending::Stopped { t, cause } = &half.ending else { panic!("{:?}", half.ending) };
    assert!(cause.contains(&format!("more than {limit} steps")) && *t > 5.0 && *t < 15.0, "t = {t}: {cause}");
    let attempts = half.work.steps + half.work.rejected;
    assert!(!half.charts.is_empty() && attempts >= limit && attempts < limit + 5, "{attempts} of {limit}");
}

#[test]
fn only_charts_of_our_own_are_changed() {
    // no pivot of a disc vanishes
    let constraints = "\"x' - 0.5*psi'*cos(phi)\", \"y' - 0.5*psi'*sin(phi)\"";
    let lagrangian = "(x'^2 + y'^2 + 0.3*psi'^2 + 0.2*phi'^2)/2 + 0.1*x";
    let disc = parsed("x y psi phi", lagrangian, constraints, "\"psi'\" = 2, \"phi'\" = 1", 20.0);
    let (_, motion) = removed(&disc, ConstantsRule::Given(vec![0.1, 0.2]));
    assert_eq!(complete(&disc, motion).charts, []);
    // a removal written by hand is what was asked for, and ends with its parametrization
    let scene = sleigh();
    let (mut removal, _) = removed(&scene, ConstantsRule::Zero);
    removal.chart.clear();
    let choice = Choice {
        label: "by hand".into(),
        formulation: REMOVED_CONSTRAINT,
        removal: Some(removal),
        constants: ConstantsRule::Zero,
    };
    let motion = solve_choice(&scene, &choice, &tight()).unwrap();
    let Ending::Stopped { t, cause } = &motion.ending else { panic!("{:?}", motion.ending) };
    assert!(*t < 2.0 && cause.contains("cos(phi)") && motion.charts.is_empty(), "t = {t}: {cause}");
}
