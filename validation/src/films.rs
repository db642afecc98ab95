//! The page on films: the shortest film that tells Chetaev's motion of a scene from every vakonomic one.

use std::fmt::Write;

use anyhow::Result;
use equations::Formulation;
use fit::{Aim, Design, Deviations, EXCLUDED, Film, Point, Question, Sampling, Unknown};
use motion::{CHETAEV, Settings, VAKONOMIC, choices_among};
use pages::Table;
use program::{File, parallel};
use scene::Scene;

/// Samples per second, standard deviation of all columns in m and rad, starts of each search.
const RATE: f64 = 60.0;
const SIGMA: f64 = 1e-3;
const STARTS: usize = 16;

/// What films of a scene tell.
struct Told {
    seconds: f64,
    point: Point,
    shortest: Option<f64>,
}

/// `films.md`; `done` hears of every scene.
///
/// # Errors
/// A scene that is not there.
pub fn files(scenes: &[&str], done: impl Fn(&str) + Sync) -> Result<Vec<File>> {
    let mut table = Table::new(["scene", "its own film", "shortest film"]);
    let found = parallel::map(scenes, |name| {
        let found = told(name);
        done(name);
        found
    });
    let mut short = 0;
    for (name, found) in scenes.iter().zip(found) {
        let (own, shortest) = match found {
            Ok(Some(Told { seconds, point, shortest })) => {
                short += usize::from(shortest.is_some_and(|length| length < 1.0));
                let tells = if point.value >= EXCLUDED { "excluded at" } else { "cannot tell," };
                let minima = if point.minima == 1 { "one minimum".into() } else { format!("{} minima", point.minima) };
                let own = format!("{seconds} s: {tells} {:.0} σ, {minima}", point.value.sqrt());
                (own, shortest.map_or("none found".into(), |length| format!("{length:.3} s")))
            }
            Ok(None) => continue,
            Err(reason) => (format!("{reason}"), String::new()),
        };
        table.row(&[name, &own, &shortest]);
    }
    let mut text = String::from("# The shortest recording that decides\n\n");
    let _ = writeln!(
        text,
        "**For {short} scenes less than a second of recording excludes every vakonomic motion that was found.**\n\n\
         The scene's own motion by Chetaev's equations, all coordinates at {RATE} Hz with errors of {SIGMA} m or rad, without \
         noise. Vakonomic motions are fitted to it with start and μ₀ free, parameters as in the scene, from {STARTS} \
         starting guesses. The recording decides if the least χ² found is {EXCLUDED} or more. *Its own film* has the duration of the \
         scene; shortest films are searched up to eight times that, to 2 %. *None found* is expected if some μ₀ \
         makes the motions equal. Each length was searched again from four times as many \
         guesses. A missed minimum makes a recording look too good, so lengths are lower bounds.\n\n\
         `deltaq design SCENE --tell chetaev,vakonomic --free start --film 60Hz,1e-3,10s` asks the same; `--over` looks for \
         motions that decide sooner.\n"
    );
    let _ = write!(text, "{table}");
    let others = catalogue::built_in().map(|(name, _)| *name).filter(|name| !scenes.contains(name));
    let others: Vec<&str> = others.collect();
    if !others.is_empty() {
        let _ = writeln!(
            text,
            "\nNot asked, as searches took more than a minute or there are not both motions: {}.",
            others.join(", ")
        );
    }
    Ok(vec![File { path: "evidence/films.md".into(), text }])
}

/// None for a scene without one of the two.
fn told(name: &str) -> Result<Option<Told>> {
    let scene: Scene = catalogue::find(name, &[])?;
    let lacks = |wanted: &Formulation| choices_among(&scene, |f| *f == *wanted).is_empty();
    if lacks(CHETAEV) || lacks(VAKONOMIC) {
        return Ok(None);
    }
    let sampling = Sampling { rate: RATE, seconds: scene.duration, sigma: Some(SIGMA) };
    let names: Vec<String> = scene.system.coordinates.iter().map(|c| c.name.clone()).collect();
    let film = Film::planned(&scene, &names, sampling, &Deviations::default())?;
    let unknowns = [Unknown::named("start")];
    let settings = Settings { tolerance: 1e-9, max_steps: 2_000, ..Settings::default() };
    let question = Question { unknowns: &unknowns, law: &[], starts: STARTS, robust: None, settings, threads: 0 };
    let design = Design::new(&scene, &[film], &question, &[], &Aim::Tell(CHETAEV, VAKONOMIC))?;
    let point = design.point_again(&[])?;
    Ok(Some(Told { seconds: scene.duration, point, shortest: design.shortest(&[]) }))
}
