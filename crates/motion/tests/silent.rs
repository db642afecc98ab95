//! Constraints with a factor: where it vanishes they say nothing, and no motion goes through. And roots that
//! end a motion are named.

use integrate::Method;
use motion::{Choice, Ending, Form, Motion, Settings, choices, solve_choice};
use scene::Scene;

fn scene(lagrangian: &str, constraint: &str, masses: f64) -> Scene {
    let text = format!(
        "title = \"factor\"\n[parameters]\nm = {masses:?}\n[coordinates]\nx = {{ start = -1 }}\ny = {{ start = 0 }}\n\
         [system]\nlagrangian = \"{lagrangian}\"\nconstraints = [\"{constraint}\"]\n[start.velocities]\n\
         \"x'\" = 1\n[removal.own]\nparameters = [\"u\"]\n[removal.own.rates]\nx = \"u'/2\"\ny = \"u'\"\n\
         [removal.own.start]\nu = \"0\"\n\"u'\" = \"y'\"\n[run]\nduration = 3\n"
    );
    Scene::parse("factor", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

const SILENT: &str = "says nothing of the velocities at x =";

const FREE: &str = "m*(x'^2 + y'^2)/2 - m*y/3";

#[test]
fn no_motion_goes_where_a_constraint_says_nothing() {
    for masses in [1.0, 1e9, 1e-9] {
        // x = -1 + t - t²/15, which is 0 first at t0
        let t0 = 7.5 * (1.0 - (1.0_f64 - 4.0 / 15.0).sqrt());
        for constraint in ["x*(x' - y'/2)", "x^2*(2*x' - y')", "x*x' - x*y'/2", "sin(x)*(x' - y'/2)/1e6"] {
            let scene = scene(FREE, constraint, masses);
            let all = choices(&scene);
            assert!(all.len() > 2, "{}", all.len());
            for choice in all {
                let motion = solve_choice(&scene, &choice, &Settings::default()).expect("a motion");
                let Ending::Stopped { t, cause } = &motion.ending else {
                    panic!("{constraint}, {}, m = {masses:e}: goes through", choice.label)
                };
                assert!((t - t0).abs() < 1e-6, "{constraint}, {}: {t}, not {t0}: {cause}", choice.label);
                let said = cause.contains(SILENT);
                assert!(said && cause.contains("x"), "{constraint}, {}: {cause}", choice.label);
            }
        }
    }
}

/// A particle in four dimensions with these two constraints, from x = -1 at speed 1.
fn two(first: &str, second: &str) -> Scene {
    let text = format!(
        "title = \"two\"\n[parameters]\nkappa = 0.5\n[coordinates]\nx = {{ start = -1 }}\ny = {{ start = 0.5 }}\n\
         z = {{ start = 0 }}\nw = {{ start = 0 }}\n[system]\n\
         lagrangian = \"(x'^2 + y'^2 + z'^2 + w'^2)/2 - z/3 - w/5\"\nconstraints = [\"{first}\", \"{second}\"]\n\
         [start.velocities]\n\"x'\" = 1\n\"y'\" = 0\n[run]\nduration = 2\n"
    );
    Scene::parse("two", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

#[test]
fn no_motion_goes_where_constraints_become_dependent_by_a_factor() {
    // at x = 0 the second says of w' nothing that the first does not say
    for (first, second) in
        [("z'", "z' + x*w'"), ("z' - y*w'", "z' - y*w' + x*(w' + z')"), ("z' + w'", "(1 + x)*z' + (1 - x)*w'")]
    {
        let scene = two(first, second);
        for choice in choices(&scene) {
            for method in [None, Some(Method::Dop853), Some(Method::Radau5)] {
                for form in [Form::Suited, Form::Named] {
                    let settings = Settings { method, form, ..Settings::default() };
                    let motion = solve_choice(&scene, &choice, &settings).expect("a motion");
                    let of = format!("{second}, {}, {method:?}, {form:?}", choice.label);
                    let Ending::Stopped { t, cause } = &motion.ending else { panic!("{of}: goes through") };
                    // equations that divide by it may come to that first
                    let said = cause.contains(SILENT) || cause.contains("by which the equations divide");
                    assert!((t - 1.0).abs() < 1e-3 && said, "{of}: {t}, {cause}");
                }
            }
        }
    }
    // and of what never vanishes none is stopped
    for (first, second) in [("z'", "z' + (x^2 + 1e-3)*w'"), ("z' + w'", "z' + (3 + x)*w'"), ("z' - y*w'", "x*z' + w'")]
    {
        let scene = two(first, second);
        for choice in choices(&scene) {
            let motion = solve_choice(&scene, &choice, &Settings::default()).expect("a motion");
            assert_eq!(motion.ending, Ending::Completed, "{second}, {}", choice.label);
        }
    }
}

#[test]
fn motions_that_come_near_go_on_and_a_factor_without_zero_changes_nothing() {
    let end = |constraint: &str| -> Vec<Vec<f64>> {
        let scene = scene(FREE, constraint, 1.0);
        let of = |choice| {
            let mut motion = solve_choice(&scene, &choice, &Settings::default()).expect("a motion");
            assert_eq!(motion.ending, Ending::Completed, "{constraint}, {}", choice.label);
            motion.at(3.0).expect("the end").coordinates
        };
        choices(&scene).into_iter().map(of).collect()
    };
    let plain = end("x' - y'/2");
    // the largest x is 1.4
    for factor in ["exp(x)", "(x^2 + 1e-6)", "(x - 1.5)", "cosh(7*x)", "1e-9"] {
        for (found, known) in end(&format!("{factor}*(x' - y'/2)")).iter().zip(&plain) {
            let apart = found.iter().zip(known).fold(0.0_f64, |a, (x, y)| a.max((x - y).abs()));
            assert!(apart < 1e-7, "{factor}: {found:?}, {known:?}");
        }
    }
}

#[test]
fn a_root_without_a_value_is_named() {
    for (potential, root) in [("x^1.5", "sqrt(x)"), ("(x + y)^2.5", "x + y"), ("x^(4/3)", "x^(1/3)")] {
        let text = format!(
            "title = \"root\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 0 }}\n[system]\n\
             lagrangian = \"x'^2/2 + y'^2/2 - {potential} - 2*x\"\n[start.velocities]\n\"x'\" = -0.5\n\"y'\" = 0\n[run]\nduration = 3\n"
        );
        let scene = Scene::parse("root", &text).unwrap_or_else(|e| panic!("{text}: {e}"));
        let motion = solve_choice(&scene, &choices(&scene)[0], &Settings::default()).expect("a motion");
        let Ending::Stopped { cause, .. } = &motion.ending else { panic!("{potential}: goes through") };
        assert!(cause.contains(root) && cause.contains("has no value where x"), "{potential}: {cause}");
        println!("{potential}: {cause}");
    }
}

/// An angle of a point that passes behind the origin at t = 1/2: where momenta or constraints jump with it
/// every form stops there, where only a force has it in its potential none does.
#[test]
fn velocities_do_not_pass_where_momenta_or_constraints_jump() {
    let scene = |lagrangian: &str, constraint: &str| {
        let text = format!(
            "title = \"jump\"\n[parameters]\nb = 0\n[coordinates]\nx = {{ start = 0.5 }}\ny = {{ start = 0.5 }}\n\
             z = {{ start = 0 }}\n[system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2 + {lagrangian}\"\n\
             constraints = [\"{constraint}\"]\n[start]\nproject = true\nvelocities = {{ \"x'\" = -1, \"y'\" = -1 }}\n\
             [run]\nduration = 1\n"
        );
        Scene::parse("jump", &text).unwrap_or_else(|error| panic!("{error}"))
    };
    let ends = |scene: &Scene| {
        let motion = |choice: &Choice| solve_choice(scene, choice, &Settings::default()).expect("a motion");
        choices(scene).iter().map(motion).collect::<Vec<_>>()
    };
    for jumps in [
        scene("atan2(b, x)*z'^2/10", "z' - x*y'"),
        scene("0", "z' - atan2(b, x)*y'/10"),
        scene("atan2(y, x - 1)*x'*y'/10", "z' - x*y'"),
    ] {
        for motion in ends(&jumps) {
            let Ending::Stopped { cause, .. } = &motion.ending else { panic!("{:?}", motion.ending) };
            assert!(cause.contains("an angle jumps") && motion.end() < 0.9, "{cause}");
        }
    }
    for passes in [scene("atan2(y, x - 1)/100", "z' - x*y'"), scene("atan2(y, x + 3)*z'^2/10", "z' - x*y'")] {
        assert!(ends(&passes).iter().all(Motion::is_complete));
    }
}
