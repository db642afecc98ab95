//! Quasi-velocities in a frame: against Maggi's equations and the costate form on bodies that turn, roll and slide, and up to where the frame ends.

use std::cell::Cell;

use equations::Role;
use integrate::Method;
use proptest::prelude::*;
use reduction::Frame;
use scene::Scene;

use super::support::{derived, equations, known_gap, motion_of, must, scene, some_multipliers, tight};
use super::{reduced_form, reduced_vakonomic};

/// A body of revolution in Euler angles, and a plane in polar coordinates; numbers `x` from −1 to 1.
fn text(kind: usize, x: &[f64]) -> String {
    let top = "A/2*(theta'^2 + phi'^2*sin(theta)^2) + C/2*(psi' + phi'*cos(theta))^2";
    let angles = format!(
        "psi = {{ start = {} }}\ntheta = {{ start = {} }}\nphi = {{ start = {} }}\n",
        2.0 * x[0],
        1.5 + x[1],
        x[2]
    );
    let polar = format!("r = {{ start = {} }}\ngamma = {{ start = {} }}\n", 1.5 + 0.5 * x[3], x[4]);
    let level = "m/2*(r'^2 + r^2*gamma'^2)";
    let ball = "C/2*(theta'^2 + phi'^2 + psi'^2 + 2*phi'*psi'*cos(theta))";
    let (lagrangian, constraints, coordinates, velocities) = match kind {
        // a heavy top
        0 => (format!("{top} - m*k*cos(theta) + k*sin(psi)"), vec![], angles, vec!["psi'", "theta'", "phi'"]),
        // a ball rolling on a table that turns faster and faster, pulled aside
        1 => (
            format!("m/2*(x'^2 + y'^2) + {ball} - k*x"),
            vec![
                "x' - a*(theta'*sin(psi) - phi'*sin(theta)*cos(psi)) + t*k*y",
                "y' + a*(theta'*cos(psi) + phi'*sin(theta)*sin(psi)) - t*k*x",
            ],
            format!("x = {{ start = {} }}\ny = {{ start = 1 }}\n{angles}", x[5]),
            vec!["psi'", "theta'", "phi'"],
        ),
        // a wheel on an axle, spinning as it moves outwards
        2 => (
            format!("{level} + {top} + k*r"),
            vec!["r' - a*(psi' + phi'*cos(theta))"],
            format!("{polar}{angles}"),
            vec!["psi'", "theta'", "phi'", "gamma'"],
        ),
        // a coefficient that moves with the point, in a magnetic field that changes
        3 => (
            format!("{level} + m/2*z'^2 + k*sin(t)*r^2*gamma' - k*z*cos(r)"),
            vec!["z' - a*r^2*gamma' - k*sin(t + r)"],
            format!("{polar}z = {{ start = 0.3 }}\n"),
            vec!["r'", "gamma'"],
        ),
        // the same without a constraint
        _ => (format!("{level} + k*t*r*gamma' + k*r^2"), vec![], polar, vec!["r'", "gamma'"]),
    };
    let constraints: Vec<String> = constraints.iter().map(|f| format!("\"{f}\"")).collect();
    let velocities: String = velocities.iter().zip(&x[6..]).map(|(v, x)| format!("\"{v}\" = {}\n", 2.0 * x)).collect();
    format!(
        "title = \"frame {kind}\"\n[parameters]\nm = {}\na = {}\nA = {}\nC = {}\nk = {}\n[coordinates]\n{coordinates}[system]\n\
         lagrangian = \"{lagrangian}\"\nconstraints = [{}]\n[start.velocities]\n{velocities}[run]\nduration = 1\n",
        1.5 + x[10],
        0.7 + 0.5 * x[11],
        1.2 + x[12],
        1.2 + x[13],
        x[14],
        constraints.join(", ")
    )
}

#[test]
fn rates_in_a_frame_are_those_by_maggi_and_those_of_the_costate_form() {
    let (framed, worst) = (Cell::new([0_usize; 2]), Cell::new(0.0_f64));
    let config = ProptestConfig {
        cases: 200,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1904),
        ..ProptestConfig::default()
    };
    let strategy = (0_usize..5, proptest::collection::vec(-1.0_f64..1.0, 15));
    let outcome = proptest::test_runner::TestRunner::new(config).run(&strategy, |(kind, x)| {
        let text = text(kind, &x);
        let scene = Scene::parse("frame", &text).map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
        let reduced = derived(&scene, "chetaev-reduced", None, Some(&scene.start));
        let reduced = reduced.map_err(|e| TestCaseError::fail(e.to_string()))?;
        let (rates, velocities) = reduced_form::differences(&scene, &reduced, &scene.start);
        let others = reduced_vakonomic::differences(&scene, &some_multipliers(&scene));
        let [mut chetaev, mut any] = framed.get();
        chetaev += usize::from(reduced.chosen.iter().any(|words| words.contains("frame")));
        any += usize::from(Frame::new(&scene.system.clone(), Some(&scene.start)).is_some());
        framed.set([chetaev, any]);
        let found = [rates, velocities, others[0], others[1], others[2]].into_iter().fold(0.0, f64::max);
        worst.set(worst.get().max(found));
        prop_assert!(found < 1e-9, "{rates:e}, {velocities:e}, {others:?}\n{text}");
        Ok(())
    });
    if let Err(error) = outcome {
        panic!("{error}");
    }
    let [chetaev, any] = framed.get();
    println!("largest difference {:.1e}; {any} frames, {chetaev} of them taken by Chetaev's equations", worst.get());
    assert!(any > 150 && chetaev > 60 && worst.get() > 0.0, "{any} frames, {chetaev} taken");
}

#[test]
fn balls_are_written_in_a_frame() {
    for name in ["ball-in-cone", "turntable"] {
        let scene = scene(name, &[]);
        for form in ["chetaev-reduced", "vakonomic-reduced"] {
            let equations = equations(&scene.system, form, None);
            assert!(
                equations.chosen.iter().any(|words| words.contains("sin(theta)")),
                "{name}: {:?}",
                equations.chosen
            );
            assert!(equations.states.iter().any(|y| matches!(y.role, Role::QuasiVelocity | Role::Costate)));
        }
    }
    // the constraint as printed contains 1/rho in the frame: at rho = 0 only the frame would end
    let printed = equations(&scene("ball-in-cone-as-printed", &[]).system, "chetaev-reduced", None);
    assert!(printed.chosen.is_empty(), "{:?}", printed.chosen);
}

/// Near the pole of the Euler angles and near the apex, where frame and mass matrix end, motions in a frame are those of the multiplier forms.
#[test]
fn motions_near_the_ends_of_the_frame_are_those_of_the_multiplier_form() {
    let near: [(&str, &[(&str, f64)]); 5] = [
        ("ball-in-cone", &[("theta", 0.05)]),
        ("ball-in-cone", &[("theta", 3.1)]),
        ("ball-in-cone", &[("r", 0.2), ("gamma'", 0.5), ("r'", -0.8)]),
        ("turntable", &[("theta", 0.02)]),
        ("turntable", &[("theta", 3.13)]),
    ];
    for (name, overrides) in near {
        let scene = scene(name, overrides);
        for form in ["chetaev", "vakonomic"] {
            let mu = if form == "vakonomic" { some_multipliers(&scene) } else { Vec::new() };
            let whole = equations(&scene.system, form, None);
            let mut multiplier = motion_of(&scene, whole, &mu, &tight());
            for method in [Method::Dop853, Method::Taylor] {
                let settings = deltaq::Settings { method, ..tight() };
                let reduced = equations(&scene.system, &format!("{form}-reduced"), None);
                let mut framed = motion_of(&scene, reduced, &mu, &settings);
                let (gap, end) = known_gap(&mut multiplier, &mut framed);
                println!(
                    "{name} {overrides:?} {form} {method:?}: {gap:.1e} to {end:.2}; {:?}, {:?}",
                    framed.ending, multiplier.ending
                );
                must(&format!("{name} {overrides:?}: {form} in a frame by {method:?}, to {end:.2} s"), gap, 1e-7);
                assert!(end > 0.0);
            }
        }
    }
}
