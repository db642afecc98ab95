//! What films of a ball on a turning table can show: standard errors of ε against the closed form.
//!
//! A homogeneous ball, `k = m a²/I = 5/2`, on a table that turns at Ω, with spin `w`, in `Z = x + iy`, to
//! first order in ε, drag `−c m Z'` and tilt `m T`:
//!
//! ```text
//! Z'' = α Z' + 5T/7 ,   α = 2iΩ/7 + (10/49) Ω(Ω − w) ε − 5c/7 .
//! ```

use fit::{Deviations, Film, Problem, Shown, Unknown, standard_errors};
use motion::{FIRST_ORDER, Settings, choices};
use nalgebra::{Complex, DMatrix};
use scene::Scene;

const OMEGA: f64 = 3.0;
const RADIUS: f64 = 0.0667;
const SIGMA: f64 = 0.5e-3;

/// The built-in table as in a laboratory: a ball of 2 cm whose centre runs on a circle of [`RADIUS`].
pub fn laboratory() -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scene/scenes/turntable.toml");
    let forces =
        "[system]\nforces = { x = \"m*tilt_x - drag*m*x'\", y = \"m*tilt_y - drag*m*y'\" }\n\n[start.velocities]";
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replace("[coordinates]", "drag = 0\ntilt_x = 0\ntilt_y = 0\nepsilon = 0\n[coordinates]");
    let text = text.replace("[start.velocities]", forces);
    let numbers = [("a", 0.02), ("Omega", OMEGA), ("c", RADIUS), ("psi'", 0.0), ("x", RADIUS)];
    let numbers: Vec<(String, f64)> = numbers.into_iter().map(|(name, x)| (name.to_string(), x)).collect();
    Scene::parse_with("turntable", &text, &numbers).unwrap_or_else(|error| panic!("{error}"))
}

/// Ten seconds at 60 Hz of a ball with this spin.
fn film(scene: &Scene, spin: f64) -> Film {
    let mut table = String::from("t,x,y\n");
    (1..=600).for_each(|k| table += &format!("{},0,0\n", f64::from(k) / 60.0));
    let deviations = Deviations { others: Some(SIGMA), ..Deviations::default() };
    let film = Film::read(scene, "film", &table, &deviations).unwrap();
    Film { known: vec![("psi'".into(), spin)], ..film }
}

const STARTS: [&str; 4] = ["x", "y", "x'", "y'"];
const SHARED: [&str; 4] = ["Omega", "tilt_x", "tilt_y", "epsilon"];

/// The standard error of ε by films of these spins, and what they do not show; `drag` as it is written.
fn found(spins: &[f64], drag: Option<&str>) -> (f64, Vec<String>) {
    let scene = laboratory();
    let choice = choices(&scene).into_iter().find(|c| c.formulation == FIRST_ORDER).unwrap();
    let mut unknowns: Vec<Unknown> = STARTS.iter().chain(&SHARED).map(|name| Unknown::named(name)).collect();
    unknowns.extend(drag.map(|drag| drag.parse::<Unknown>().unwrap()));
    let films: Vec<Film> = spins.iter().map(|spin| film(&scene, *spin)).collect();
    let problem = Problem::new(&scene, &choice, &films, &unknowns, &Settings::default()).unwrap();
    let Shown { errors, hidden } = standard_errors(&problem, problem.start()).unwrap();
    (errors[problem.unknowns().iter().position(|u| u.name == "epsilon").unwrap()], hidden)
}

/// The same by the closed form; the deviation of what is known of the drag.
pub fn closed(spins: &[f64], drag: Option<f64>) -> f64 {
    type C = Complex<f64>;
    let alpha = C::new(0.0, 2.0 * OMEGA / 7.0);
    let start = C::new(0.0, 2.0 * OMEGA / 7.0 * RADIUS);
    let width = 5 + 4 * spins.len();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (film, spin) in spins.iter().enumerate() {
        for k in 1..=600 {
            let t = f64::from(k) / 60.0;
            let grown = (alpha * t).exp();
            // Z = Z₀ + Z₀'(e^{αt} − 1)/α and its derivatives
            let by_speed = (grown - 1.0) / alpha;
            let by_alpha = start * (grown * t / alpha - (grown - 1.0) / (alpha * alpha));
            let by_tilt = (by_speed - t) / alpha * (5.0 / 7.0);
            let growth = 10.0 / 49.0 * OMEGA * (OMEGA - spin);
            let i = C::new(0.0, 1.0);
            let shared = [by_alpha * i * (2.0 / 7.0), by_tilt, by_tilt * i, by_alpha * growth, by_alpha * (-5.0 / 7.0)];
            let own = [C::new(1.0, 0.0), i, by_speed, by_speed * i];
            for part in [|z: C| z.re, |z: C| z.im] {
                let mut row = vec![0.0; width];
                row[..5].iter_mut().zip(shared).for_each(|(x, z)| *x = part(z) / SIGMA);
                row[5 + 4 * film..9 + 4 * film].iter_mut().zip(own).for_each(|(x, z)| *x = part(z) / SIGMA);
                rows.push(row);
            }
        }
    }
    let mut prior = vec![0.0; width];
    prior[4] = 1.0 / drag.unwrap_or(1e-9);
    rows.push(prior);
    let jacobian = DMatrix::from_fn(rows.len(), width, |i, j| rows[i][j]);
    (jacobian.transpose() * jacobian).try_inverse().unwrap()[(3, 3)].sqrt()
}

#[test]
fn the_bounds_are_those_of_the_closed_form() {
    for (spins, drag, known) in [
        (&[0.0][..], None, Some(0.082e-3)),
        (&[0.0, 0.0], None, None),
        (&[0.0, 6.0], None, None),
        (&[0.0, 6.0], Some(("drag", 1e6)), Some(0.041e-3)),
        (&[0.0], Some(("drag~0±0.005", 0.005)), None),
        (&[0.0, 0.0], Some(("drag~0±0.005", 0.005)), None),
    ] {
        let (found, hidden) = found(spins, drag.map(|d| d.0));
        let closed = closed(spins, drag.map(|d| d.1));
        assert!(hidden.is_empty(), "{hidden:?}");
        assert!((found / closed - 1.0).abs() < 1e-4, "{spins:?}: {found:e} for {closed:e}");
        assert!(known.is_none_or(|known| (found / known - 1.0).abs() < 0.02), "{spins:?}: {found:e}");
    }
}

/// One spin shows the sum of ε and drag only; a spin of twice the table's rate tells them apart.
#[test]
fn what_no_film_shows_is_named() {
    for spins in [&[0.0][..], &[0.0, 0.0]] {
        let (error, hidden) = found(spins, Some("drag"));
        // 10/49 Ω² ε = 5/7 c
        let ratio = 10.0 / 49.0 * OMEGA * OMEGA * 7.0 / 5.0;
        assert_eq!(hidden, [format!("epsilon by 1.000e0 with drag by {ratio:.3e}")]);
        assert!(error.is_infinite(), "{error}");
    }
}
