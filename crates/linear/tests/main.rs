//! Steady motions whose eigenvalues are known, and everything that is refused.

mod chains;
mod scales;

use equations::Formulation;
use linear::core::Core;
use linear::{LinearError, Linearization, Spectrum, find_steady, linearize, linearize_at, sweep};
use mechanics::ConstantsRule;
use motion::{
    CHETAEV, Choice, REMOVED_CONSTRAINT, Setting, Settings, SolveError, VAKONOMIC, VAKONOMIC_COSTATE, choices,
    removals, setting,
};
use nalgebra::{Complex, DMatrix};
use scene::Scene;

/// A scene from its coordinates with starts, its Lagrangian, constraints and start velocities.
fn scene(coordinates: &[(&str, f64)], lagrangian: &str, constraints: &[&str], velocities: &str) -> Scene {
    let coordinates: String =
        coordinates.iter().map(|(name, start)| format!("{name} = {{ start = {start:?} }}\n")).collect();
    let constraints: Vec<String> = constraints.iter().map(|f| format!("\"{f}\"")).collect();
    let text = format!(
        "title = \"test\"\n[parameters]\nk = 4\n[coordinates]\n{coordinates}[system]\nlagrangian = \"{lagrangian}\"\n\
         constraints = [{}]\n[start]\nvelocities = {{ {velocities} }}\n[run]\nduration = 1\n",
        constraints.join(", ")
    );
    Scene::parse("test", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn choice(scene: &Scene, formulation: &Formulation) -> Choice {
    choices(scene).into_iter().find(|c| c.formulation == formulation).expect(formulation.name)
}

fn steady(scene: &Scene, formulation: &Formulation) -> Result<Linearization, LinearError> {
    linearize(setting(scene), &choice(scene, formulation))
}

/// An oscillator of √k rad/s.
fn oscillator(start: f64) -> Scene {
    scene(&[("x", start)], "x'^2/2 - k*x^2/2", &[], "\"x'\" = 0")
}

/// A particle on a sphere of radius 2, by the derivative of its equation, at its lowest point.
fn in_a_sphere(potential: &str) -> Scene {
    let place = [("x", 0.0), ("y", 0.0), ("z", -2.0)];
    let lagrangian = format!("(x'^2 + y'^2 + z'^2)/2 - {potential}");
    scene(&place, &lagrangian, &["x*x' + y*y' + z*z'"], "\"x'\" = 0, \"y'\" = 0")
}

const GRAVITY: &str = "8*z";

#[test]
fn a_position_constraint_is_kept_to_first_order() {
    // rad/s: √(g/r) = 2, twice
    let found = steady(&in_a_sphere(GRAVITY), CHETAEV).expect("an equilibrium");
    let part = found.part(&[]).expect("all");
    let imaginary: Vec<f64> = part.eigenvalues.iter().map(|e| e.value.im.abs()).collect();
    assert_eq!((imaginary.len(), part.zeros, part.unstable()), (4, 1, 0), "{found:?}");
    for eigenvalue in &part.eigenvalues {
        assert!((eigenvalue.value.im.abs() - 2.0).abs() < 1e-14 && eigenvalue.value.re.abs() < 1e-14);
        assert!(eigenvalue.error < 1e-13, "{eigenvalue:?}");
    }
    let z = found.part(&["z"]).expect("z is a state");
    assert_eq!((z.eigenvalues.len(), z.zeros), (0, 1));
}

#[test]
fn every_formulation_of_an_integrable_constraint_swings_alike() {
    // under gravity the multiplier grows: it is the impulse of the reaction
    let error = steady(&in_a_sphere(GRAVITY), VAKONOMIC).expect_err("not steady");
    assert!(matches!(&error, LinearError::NotSteady { state, rate: -8.0, .. } if state == "p_z"), "{error}");
    // springs have the same frequency, and need no reaction
    let scene = in_a_sphere("2*(x^2 + y^2)");
    for formulation in [VAKONOMIC, VAKONOMIC_COSTATE, REMOVED_CONSTRAINT] {
        let own = choice(&scene, formulation);
        let own = if formulation == REMOVED_CONSTRAINT {
            let removal = removals(&scene).expect("linear").into_iter().find(|r| r.name == "coordinates");
            Choice { removal, constants: ConstantsRule::Zero, ..own }
        } else {
            own
        };
        let part = linearize(setting(&scene), &own).and_then(|found| found.part(&[])).expect(formulation.name);
        let swinging = part.eigenvalues.iter().filter(|e| (e.value.im.abs() - 2.0).abs() < 1e-7).count();
        assert!(swinging >= 4, "{formulation:?}: {part:?}");
        assert_eq!(part.unstable(), 0, "{formulation:?}: {part:?}");
    }
}

#[test]
fn chains_of_zeros_are_counted() {
    // x'' = 0 in turned axes: one block, two chains of two
    let turn = |m: DMatrix<f64>| {
        let (s, c) = 0.7_f64.sin_cos();
        let q = DMatrix::from_row_slice(3, 3, &[c, s, 0.0, -s * c, c * c, s, s * s, -s * c, c]);
        &q * m * q.transpose()
    };
    let jordan = turn(DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]));
    let spectrum = Spectrum::of(&jordan, &DMatrix::zeros(3, 3)).expect("converges");
    let zeros: usize = spectrum.blocks.iter().map(|block| block.zeros).sum();
    assert_eq!((zeros, spectrum.zero_vectors), (3, 1));
    // not zero, and defective: the error says what is left of the digits
    let shifted = jordan + DMatrix::identity(3, 3);
    let spectrum = Spectrum::of(&shifted, &DMatrix::zeros(3, 3)).expect("converges");
    for eigenvalue in spectrum.blocks.iter().flat_map(|block| &block.eigenvalues) {
        let off = (eigenvalue.value - 1.0).norm();
        assert!(eigenvalue.error > 1e-7 && eigenvalue.error < 1e-3 && off < 10.0 * eigenvalue.error, "{eigenvalue:?}");
    }
}

#[test]
fn a_steady_motion_is_found_on_its_position_constraint() {
    let mut scene = in_a_sphere(GRAVITY);
    scene.start.q = vec![0.6, -0.8, -3.0_f64.sqrt()];
    let state = find_steady(setting(&scene)).expect("the lowest point");
    let radius = state.q.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!(state.q[0].abs() < 1e-9 && state.q[1].abs() < 1e-9 && (radius - 2.0).abs() < 1e-9, "{state:?}");
    let found = linearize(Setting { start: &state, ..setting(&scene) }, &choice(&scene, CHETAEV));
    assert!(found.is_ok(), "{found:?}");
    // a sleigh stands still where it is, without anything that moves it there
    let sleigh = scene::catalogue::find("sleigh", &[]).expect("built in");
    let state = find_steady(setting(&sleigh)).expect("at rest");
    assert!(state.v.iter().all(|v| v.abs() < 1e-9), "{state:?}");
    // nothing stands still on a slope
    let slope =
        self::scene(&[("x", 0.0), ("y", 0.0)], "(x'^2 + y'^2)/2 - x^3 - x - y^2", &[], "\"x'\" = 0, \"y'\" = 0");
    let error = find_steady(setting(&slope)).expect_err("falls");
    assert!(
        matches!(error, LinearError::NotFound { .. } | LinearError::Evaluation { .. } | LinearError::NotFinite { .. }),
        "{error}"
    );
}

#[test]
fn eigenvalues_over_a_parameter() {
    let scene = oscillator(0.0);
    let found = sweep(&scene, &choice(&scene, CHETAEV), &[], ("k", &[-4.0, 1.0, 9.0]), false).expect("all are steady");
    let first: Vec<f64> = found.points.iter().map(|p| p.part.eigenvalues[0].value.norm()).collect();
    assert!(first.iter().zip([2.0, 1.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-14), "{first:?}");
    let [change] = &found.changes[..] else { panic!("{:?}", found.changes) };
    assert!(change.value.abs() < 1e-10 && change.unstable == [1, 0], "{change:?}");
    let error = sweep(&scene, &choice(&scene, CHETAEV), &[], ("x", &[0.0, 1.0]), false).expect_err("1 is not steady");
    assert!(matches!(error, LinearError::At { value: 1.0, .. }), "{error}");
    let error = sweep(&scene, &choice(&scene, CHETAEV), &[], ("q", &[0.0]), false).expect_err("there is no q");
    assert!(matches!(error, LinearError::Solve(SolveError::Scene(_))), "{error}");
    let error = sweep(&scene, &choice(&scene, CHETAEV), &[], ("k", &[f64::NAN]), false).expect_err("no number");
    assert!(matches!(&error, LinearError::At { error, .. } if matches!(**error, LinearError::Scene(_))), "{error}");
}

/// ω² = 5/2 where w rests, (5 + 5/9)/(2 + 1/9) where w' = y'/3 has begun: the derivation at k = 4 has to
/// keep what is zero to the last digit there.
#[test]
fn a_sweep_keeps_what_begins_at_another_value() {
    let place = [("x", 0.0), ("y", 0.0), ("z", 0.0), ("w", 0.0)];
    let lagrangian = "(x'^2 + y'^2 + z'^2 + w'^2)/2 - (x^2 + 2*y^2 + 3*z^2 + 5*w^2)/2";
    let constraints = ["z' - y'", "(2 + cos(x))*w' - z' + y' - y'*(1 + tanh(50*(k - 9)))/2"];
    let scene = scene(&place, lagrangian, &constraints, "\"x'\" = 0, \"y'\" = 0");
    let mut swept = 0;
    for choice in choices(&scene) {
        for find in [false, true] {
            let found = sweep(&scene, &choice, &[], ("k", &[4.0, 14.0, 30.0]), find).expect("all are steady");
            for (point, square) in found.points.iter().zip([2.5, 50.0 / 19.0, 50.0 / 19.0]) {
                let all: Vec<f64> = point.part.eigenvalues.iter().map(|e| e.value.im.powi(2)).collect();
                let near = |square: f64| all.iter().filter(|x| (*x - square).abs() < 1e-7).count();
                assert!(near(square) == 2 && near(1.0) == 2, "{}, k = {}: {all:?}", choice.label, point.value);
            }
            swept += 1;
        }
    }
    assert!(swept >= 8, "{swept}");
}

#[test]
fn what_moves_is_said_with_its_rate_and_the_limit() {
    let error = steady(&oscillator(0.5), CHETAEV).expect_err("it swings");
    let LinearError::NotSteady { state, rate, limit, .. } = &error else { panic!("{error}") };
    assert_eq!((&state[..], *rate), ("x'", -2.0));
    assert!((1e-9..1e-8).contains(limit), "{limit}");
    assert!(error.to_string().contains("x'' = -2"), "{error}");
    // at an instant: the same matrix, for the equations are linear
    // and one after the end of the run is reached, too
    let swings = oscillator(0.5);
    for t in [0.7_f64, 3.0] {
        let frozen = linearize_at(setting(&swings), &choice(&swings, CHETAEV), t, &Settings::default());
        let frozen = frozen.expect("runs");
        assert!(!frozen.is_steady && (frozen.values[0] - 0.5 * (2.0 * t).cos()).abs() < 1e-9, "{frozen:?}");
        assert_eq!(frozen.matrix, DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -4.0, 0.0]));
    }
}

#[test]
fn what_is_refused() {
    let driven = scene(&[("x", 0.0)], "x'^2/2 - k*x^2*cos(t)/2", &[], "\"x'\" = 0");
    assert!(matches!(steady(&driven, CHETAEV), Err(LinearError::TimeDependent { .. })));
    let early = linearize_at(setting(&driven), &choice(&driven, CHETAEV), -1.0, &Settings::default());
    assert!(matches!(early, Err(LinearError::BeforeStart { .. })));
    let found =
        steady(&scene(&[("x", 0.0), ("y", 0.0)], "(x'^2 + y'^2)/2 - x^2", &[], "\"x'\" = 0, \"y'\" = 1"), CHETAEV);
    let found = found.expect("y is carried");
    assert!(matches!(found.part(&["y"]), Err(LinearError::CarriedFree { .. })));
    assert!(matches!(found.part(&["z"]), Err(LinearError::UnknownFree { .. })));
    let wall = scene(&[("x", 1.0)], "x'^2/2 + 1/x", &[], "\"x'\" = 0");
    let late = linearize_at(setting(&wall), &choice(&wall, CHETAEV), 10.0, &Settings::default());
    assert!(matches!(late, Err(LinearError::NotReached { .. })), "{late:?}");
    let cone = [("x", 0.0), ("y", 0.0), ("z", 0.0)];
    let cone = scene(&cone, "(x'^2 + y'^2 + z'^2)/2", &["z'^2 - x'^2 - y'^2"], "\"x'\" = 1, \"y'\" = 0, \"z'\" = 1");
    assert!(matches!(find_steady(setting(&cone)), Err(LinearError::NotLinear)));
    assert!(linearize(setting(&cone), &choice(&cone, CHETAEV)).is_ok());
}

#[test]
fn what_crosses_has_the_frequency_and_not_what_grows_all_along() {
    // x falls like e^t at any k, and y has (k ± √(k² − 16))/2
    let text = "title = \"fed\"\n[parameters]\nk = 0.3\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n\
                [system]\nlagrangian = \"(x'^2 + x^2 + y'^2 - 4*y^2)/2\"\nforces = { y = \"k*y'\" }\n\
                [start.velocities]\n\"x'\" = 0\n\"y'\" = 0\n[run]\nduration = 1\n";
    let scene = Scene::parse("fed", text).unwrap_or_else(|error| panic!("{error}"));
    let found = sweep(&scene, &choices(&scene)[0], &[], ("k", &[-0.5, 0.7]), false).expect("a sweep");
    let [change] = &found.changes[..] else { panic!("{:?}", found.changes) };
    assert_eq!(change.unstable, [1, 3]);
    assert!(change.value.abs() < 1e-7 && (change.frequency - 2.0).abs() < 1e-6, "{change:?}");
}

#[test]
fn one_number_is_an_eigenvalue_where_it_is_over_its_error() {
    for (number, values) in [(2e-3, vec![2e-3]), (-2e-3, vec![-2e-3]), (0.5e-3, vec![])] {
        let [block, noise] = [number, 1e-3].map(|x| DMatrix::from_element(1, 1, x));
        let found = Core::of(block, noise).expect("a core").values;
        assert_eq!(found, values.into_iter().map(Complex::from).collect::<Vec<_>>(), "{number}");
    }
}
