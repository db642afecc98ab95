//! The program of docs/tutorials/fit.md.

use deltaq::scene::Scene;
use deltaq::{CHETAEV, Settings, VAKONOMIC};
use fit::{Deviations, Film, Question, Verdict, fit_formulations};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::load("disc-on-slope.toml".as_ref())?;
    let deviations = Deviations { others: Some(1e-3), ..Deviations::default() };
    let text = std::fs::read_to_string("disc-film.csv")?;
    let mut films = [Film::read(&scene, "disc-film.csv", &text, &deviations)?];
    let unknowns = ["g~1.4".parse()?, "psi'~0.5".parse()?];
    let settings = Settings { tolerance: 1e-9, ..Settings::default() };
    let question = Question { unknowns: &unknowns, law: &[], starts: 16, robust: None, settings, threads: 0 };
    let rows = fit_formulations(&scene, &mut films, &question, &[CHETAEV, VAKONOMIC])?;
    let g = &rows[0].fit.as_ref().map_err(Clone::clone)?.estimates[0];
    assert!(g.interval[0] < 1.5 && 1.5 < g.interval[1]);
    assert!(matches!(rows[1].verdict, Verdict::Excluded { .. }), "{:?}", rows[1].verdict);
    Ok(())
}
