//! Derivatives of samples, and the balance of forces at one of them.

use judge::{Balance, Instant, JudgeError, derivative, halfway};
use scene::Scene;

#[test]
fn polynomials_are_differentiated_exactly() {
    let t = [0.0, 0.1, 0.25, 0.3, 0.5, 0.55, 0.7];
    let rows: Vec<Vec<f64>> = t.iter().map(|t: &f64| vec![t.powi(5)]).collect();
    assert!((derivative(&t, &rows, 3, 3, 1)[0] - 5.0 * 0.3f64.powi(4)).abs() < 1e-12);
    assert!((derivative(&t, &rows, 3, 3, 2)[0] - 20.0 * 0.3f64.powi(3)).abs() < 1e-11);
    assert!((halfway(&t, &rows, 4)[0] - 0.525f64.powi(5)).abs() < 1e-13);
}

/// What is said of a sample at rest at this x, of a particle from x = 1 under a force and two constraints
/// that are parallel but for x: the least length over the largest is x/2.
fn at(x: f64, force: &str) -> Result<Instant, JudgeError> {
    let text = format!(
        "title = \"parallel\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 0 }}\nz = {{ start = 0 }}\n\
         [system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"1e3*y'\", \"1e3*(y' + x*z')\"]\n\
         forces = {{ x = \"{force}\" }}\n[start.velocities]\n\"x'\" = 0\n[run]\nduration = 1\n"
    );
    let scene = Scene::parse("parallel", &text).unwrap_or_else(|e| panic!("{text}: {e}"));
    let state = [vec![x, 0.0, 0.0], vec![0.0; 3], vec![0.0; 3]];
    Balance::new(&scene.system).expect("compiled").at(0.25, state)
}

#[test]
fn constraints_that_are_parallel_to_a_million_millionth_are_refused_and_so_is_what_is_not_finite() {
    assert!(matches!(at(1e-12, "0"), Err(JudgeError::Dependent { t: 0.25 })));
    assert!(at(1e-11, "0").is_ok() && at(1e-3, "1/x").is_ok());
    assert!(matches!(at(1e-3, "1/(x - 1e-3)"), Err(JudgeError::NotFinite { t: 0.25 })));
    // lengths are squared
    assert!(at(1e-3, "1e150").is_ok());
    assert!(matches!(at(1e-3, "1e160"), Err(JudgeError::NotFinite { t: 0.25 })));
    assert!(matches!(at(1e199, "0"), Err(JudgeError::NotFinite { t: 0.25 })));
}
