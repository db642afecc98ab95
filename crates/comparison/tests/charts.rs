//! Changes of charts, with invariants of the user's own.

use comparison::multipliers_of;
use mechanics::{ConstantsRule, Removal, State};
use motion::{
    Choice, Ensemble, EnsembleOptions, Motion, REMOVED_CONSTRAINT, Setting, Settings, VAKONOMIC, choices, derive_at,
    setting, solve, solve_choice,
};
use scene::Scene;

/// A sleigh that turns past heading 90°, where its pivot vanishes, with these invariants.
fn sleigh(invariants: &str) -> Motion {
    let scene = read(&text(invariants), &[]);
    solve_choice(&scene, &removed(&scene), &Settings::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn text(invariants: &str) -> String {
    format!(
        "title = \"sleigh\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n\
         phi = {{ start = 0.3 }}\n[system]\n\
         lagrangian = \"((x' - 0.2*phi'*sin(phi))^2 + (y' + 0.2*phi'*cos(phi))^2 + phi'^2)/2 + 0.3*x\"\n\
         constraints = [\"y'*cos(phi) - x'*sin(phi)\"]\n{invariants}\n\
         [start]\nvelocities = {{ \"x'\" = 0.6, \"phi'\" = 1.1 }}\n[run]\nduration = 4\n"
    )
}

fn read(text: &str, overrides: &[(String, f64)]) -> Scene {
    Scene::parse_with("sleigh", text, overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// Without the constraint by a removal of coordinates.
fn removed(scene: &Scene) -> Choice {
    let removal = Some(Removal::by_coordinates(&scene.system, &scene.start).expect("linear"));
    let constants = ConstantsRule::Given(vec![0.02]);
    Choice { label: "removed".into(), formulation: REMOVED_CONSTRAINT, removal, constants }
}

#[test]
fn invariants_of_the_users_own_neither_move_nor_stop_a_motion() {
    let mut plain = sleigh("");
    assert!(plain.is_complete() && plain.charts.len() == 1, "{:?}", plain.ending);
    let end = plain.at(4.0).expect("it is there").coordinates;
    for invariants in
        ["turning = \"phi'\"", "\"momentum x\" = \"phi'\"", "\"momentum phi\" = \"x'\"", "energy = \"x'\""]
    {
        let mut motion = sleigh(&format!("[invariants]\n{invariants}"));
        assert!(motion.is_complete() && motion.charts.len() == 1, "{invariants}: {:?}", motion.ending);
        let here = motion.at(4.0).expect("it is there");
        let apart = here.coordinates.iter().zip(&end).fold(0.0_f64, |a, (x, y)| a.max((x - y).abs()));
        assert!(apart < 1e-9, "{invariants}: {apart:e}");
        // what it lists is what was asked for, in either chart
        let expected = if invariants.ends_with("\"x'\"") { here.velocities[0] } else { here.velocities[2] };
        let last = here.invariants.last().expect("the user's own");
        assert!((last - expected).abs() < 1e-9, "{invariants}: {last} instead of {expected}");
    }
}

/// Members leave their charts at other times, or never; by starts and by a parameter.
#[test]
fn ensembles_complete_what_single_motions_complete() {
    let text = text("").replace("[coordinates]", "[parameters]\nk = 0.3\n[coordinates]").replace("0.3*x", "k*x");
    let scene = read(&text, &[]);
    let all = |scene: &Scene| [choices(scene), vec![removed(scene)]].concat();
    let (mut passed, mut refused) = (0, 0);
    for (place, choice) in all(&scene).into_iter().enumerate() {
        let names = ["phi'", "k"];
        let ensemble = Ensemble::new(&scene, &choice, &names, &Settings::default()).expect("derives");
        let rows = [[1.1, 0.3], [0.2, 0.3], [0.9, -0.5], [-1.1, 0.1]];
        let motions = ensemble.answers(ensemble.members(&rows, 1), &[1.0, 4.0], &EnsembleOptions::default());
        for (row, motion) in rows.iter().zip(motions) {
            let alone = read(&text, &[("phi'".into(), row[0]), ("k".into(), row[1])]);
            let mut single = solve_choice(&alone, &all(&alone)[place], &Settings::default()).expect("starts");
            let member = motion.unwrap_or_else(|error| panic!("{} {row:?}: {error}", choice.label));
            let (status, cause) = member.status();
            if !single.is_complete() {
                assert_eq!(status, "stopped", "{} {row:?}", choice.label);
                refused += 1;
                continue;
            }
            assert_eq!(status, "completed", "{} {row:?}: {cause:?}", choice.label);
            let [one, two] = [single.at(4.0).unwrap(), member.outputs[1].clone()];
            for (a, b) in one.coordinates.iter().zip(&two.coordinates) {
                assert!((a - b).abs() < 1e-8, "{} {row:?}: {one:?} {two:?}", choice.label);
            }
            assert_eq!(one.multipliers.len(), two.multipliers.len());
            for (a, b) in one.multipliers.iter().zip(&two.multipliers) {
                assert!((a - b).abs() < 1e-7, "{} {row:?}: {one:?} {two:?}", choice.label);
            }
            passed += usize::from(!single.charts.is_empty());
        }
    }
    println!("{passed} members go on by another chart, {refused} stop as single motions do");
    assert!(passed >= 2 && refused == 0, "{passed} {refused}");
}

const CARRIAGE: &str = include_str!("../../scene/classics/two-wheeled-carriage.toml");
const RACER: &str = include_str!("../../scene/classics/roller-racer.toml");

/// `P = 0` at the horizon, beyond the end of a chart. The judge is the vakonomic motion that it is, whose
/// momentum `∂(L + μ·f)/∂ẇ` vanishes there.
#[test]
fn natural_constants_are_found_beyond_the_end_of_a_chart() {
    let text = text("");
    let scenes = [("sleigh", &text[..], 4.0), ("carriage", CARRIAGE, 1.0), ("racer", RACER, 4.0)];
    for (name, text, horizon) in scenes {
        let scene = read(text, &[]);
        let within = Setting { end: horizon, ..setting(&scene) };
        let removal = Removal::by_coordinates(&scene.system, &scene.start).expect("linear");
        let equations = derive_at(&scene.system, &scene.start, &removed(&scene)).expect("derives");
        let natural = ConstantsRule::Natural { horizon };
        let motion = solve(within, equations, &natural, &Settings::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(motion.is_complete() && !motion.charts.is_empty(), "{name}: {:?}", motion.ending);
        let mut costates = vec![0.0; removal.memory.len()];
        for (constant, value) in motion.equations.free_constants.iter().zip(&motion.constants) {
            costates[constant.memory.expect("of a memory variable")] = *value;
        }
        let multipliers = multipliers_of(&scene, &removal, &costates).expect("evaluates").expect("by coordinates");
        let family = choices(&scene).into_iter().find(|c| c.formulation == VAKONOMIC).expect("constrained");
        let equations = derive_at(&scene.system, &scene.start, &family).expect("derives");
        let given = ConstantsRule::Given(multipliers);
        let mut judge = solve(within, equations, &given, &Settings::default()).expect("a vakonomic motion");
        let end = judge.at(horizon).expect("it is there");
        let (system, g) = (&scene.system, &scene.system.graph);
        let state = State { t: horizon, q: end.coordinates, v: end.velocities };
        let mut values = system.parameter_values();
        values.extend(system.values_at(&state));
        let number = |e| g.evaluate(e, &values).expect("finite");
        for w in &removal.memory {
            let i = system.coordinates.iter().position(|c| c.position == w.symbol).expect("a coordinate");
            let v = system.coordinates[i].velocity;
            let own = number(g.derivative(system.lagrangian, v));
            let parts = system.constraints.iter().zip(&end.multipliers);
            let parts: Vec<f64> = parts.map(|(f, mu)| mu * number(g.derivative(*f, v))).collect();
            let momentum = own + parts.iter().sum::<f64>();
            let size = own.abs() + parts.iter().map(|x| x.abs()).sum::<f64>();
            assert!(momentum.abs() < 1e-6 * size.max(1e-3), "{name}: p_{} = {momentum:e} of {size:e}", g.name(v));
        }
    }
}

/// Heading `0.3 + 1.1 t`: at the middle instant it is so near 90° that terms of the first chart, which is
/// left before, are large there. They are none of the motion.
#[test]
fn terms_of_a_chart_that_was_left_are_no_round_off() {
    let middle = (std::f64::consts::FRAC_PI_2 - 0.3) / 1.1;
    for off in [1e-3, 1e-5, 1e-7] {
        let text = format!(
            "title = \"sledge\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\nphi = {{ start = 0.3 }}\n\
             [system]\nlagrangian = \"(x'^2 + y'^2 + phi'^2)/2\"\nconstraints = [\"y'*cos(phi) - x'*sin(phi)\"]\n\
             [start]\nvelocities = {{ \"x'\" = 0.6, \"phi'\" = 1.1 }}\n[run]\nduration = {:?}\n",
            2.0 * middle * (1.0 + off)
        );
        let scene = read(&text, &[]);
        let choice = Choice { constants: ConstantsRule::Given(vec![0.0]), ..removed(&scene) };
        let motion = solve_choice(&scene, &choice, &Settings::default()).expect("a motion");
        assert!(motion.is_complete() && motion.charts.len() == 1, "{off}: {:?}", motion.ending);
        assert_eq!(motion.doubt, None, "{off}");
    }
}

/// `x' = 10^(−x) z'` has a constant pivot beside an entry that grows to 10¹⁴¹: a particle on a curve, whose
/// length `√2 t` is a closed form in x. The velocity that the other one is a combination of underflows.
#[test]
fn entries_that_grow_beside_a_constant_pivot_change_the_chart() {
    let text = "title = \"curve\"\n[coordinates]\nx = { start = 0 }\nz = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + z'^2)/2\"\nconstraints = [\"x' - 10^(-x)*z'\"]\n\
                [start.velocities]\n\"x'\" = -1\n\"z'\" = -1\n[run]\nduration = 100\n";
    let scene = read(text, &[]);
    let root = 2.0_f64.sqrt();
    let before = (root - 1.0 - ((1.0 + root) / 2.0).ln()) / 10.0_f64.ln();
    let mut complete = 0;
    for choice in choices(&scene) {
        let mut motion = solve_choice(&scene, &choice, &Settings::default()).unwrap_or_else(|error| panic!("{error}"));
        let end = motion.end();
        for t in [10.0, 50.0, 100.0].into_iter().filter(|t| *t <= end) {
            let x = motion.at(t).expect("it is there").coordinates[0];
            assert!((x + root * t - before).abs() < 1e-9, "{} at {t}: {x}", choice.label);
        }
        assert!(motion.is_complete() || choice.removal.is_some(), "{}: {:?}", choice.label, motion.ending);
        complete += usize::from(motion.is_complete() && !motion.charts.is_empty());
    }
    assert!(complete > 1, "{complete}");
}
