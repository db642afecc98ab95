//! `deltaq judge`.

use std::fmt::Write;
use std::fs::read_to_string;

use anyhow::{Context, Result};
use judge::{Constraint, Film, Judgement, Law, Number, judge, orders};
use program::{TextOrJson, pretty};
use serde_json::{Value, json};

use crate::cli::JudgeArguments;

/// Standard errors that a number has to be over.
const SEEN: f64 = 5.0;

/// Runs the command.
///
/// # Errors
/// Bad input, with file and line.
pub fn run(arguments: &JudgeArguments) -> Result<String> {
    let scene = arguments.scene.find()?;
    let mut films = Vec::new();
    let mut found = Vec::new();
    for path in &arguments.films {
        let text = read_to_string(path).with_context(|| format!("{}", path.display()))?;
        let film = Film::read(&text, &scene.system).with_context(|| format!("{}", path.display()))?;
        found.push(judge(&scene.system, &film).with_context(|| format!("{}", path.display()))?);
        films.push(film);
    }
    let (orders, names) = (orders(&films), scene.multiplier_names());
    let paths = arguments.films.iter().map(|path| path.display().to_string());
    Ok(match arguments.format {
        TextOrJson::Json => {
            let films = paths.zip(&films).zip(&found).map(|((path, film), found)| value(&path, film, found));
            pretty("judge", &json!({ "scene": scene.name, "films": films.collect::<Vec<_>>(), "orders": orders }))
        }
        TextOrJson::Text => {
            let mut text = String::new();
            for ((path, film), found) in paths.zip(&films).zip(&found) {
                text += &report(&path, film, found, &names);
            }
            if !orders.is_empty() {
                let orders: Vec<String> = orders.iter().map(|order| format!("{order:.2}")).collect();
                let _ = writeln!(text, "order in the step, each half of the one before: {}", orders.join(", "));
            }
            text
        }
    })
}

/// The word on the reaction.
fn sentence(found: &Judgement, names: &[String]) -> String {
    match &found.law {
        Law::Chetaev => "Chetaev: the reaction is along the rows of ∂f/∂v".into(),
        Law::FirstOrder => "Chetaev, and forces −ε C λ − c M v".into(),
        Law::Vakonomic(mu) => {
            let mu: Vec<String> = names.iter().zip(mu).map(|(name, mu)| format!("{name} = {mu:.6}")).collect();
            format!("vakonomic, with {}", mu.join(", "))
        }
        Law::Substitution(velocities) => format!("the constraint put into L, without {}", velocities.join(", ")),
        Law::None => "none of these laws".into(),
    }
}

fn name(law: &Law) -> String {
    match law {
        Law::Chetaev => "Chetaev".into(),
        Law::FirstOrder => "Chetaev, ε and drag".into(),
        Law::Vakonomic(_) => "vakonomic".into(),
        Law::Substitution(velocities) => format!("put into L without {}", velocities.join(", ")),
        Law::None => "none".into(),
    }
}

fn report(path: &str, film: &Film, found: &Judgement, names: &[String]) -> String {
    let times = film.times();
    let mut text = format!(
        "{path}: {} samples from t = {} to {}\n\n  law         {}\n",
        times.len(),
        times[0],
        times[times.len() - 1],
        sentence(found, names)
    );
    let [residual, size] = found.residual;
    let constraint = match found.constraint {
        Constraint::Kept => "kept".into(),
        Constraint::Creeps => format!("creeps: f = −λ/N with 1/N = {}", number(&found.slip)),
        Constraint::LeftOut => "moves by f_q v + f_t: the program lets A a = 0".into(),
        Constraint::NotKept => "not kept".to_string(),
    };
    let _ = writeln!(text, "  constraint  {constraint}; f is {residual:.1e} beside {size:.1e}\n");
    let seen = |what: &str, own: &Number| {
        let word = if own.is_seen(SEEN) { "" } else { "   not seen" };
        format!("  {what:<32} {}{word}\n", number(own))
    };
    text += &seen("ε, first trace (time)", &found.epsilon);
    text += &seen("c, drag (1/time)", &found.drag);
    text += &seen("1/N, slip", &found.slip);
    text += &seen("b, in df/dt = b (f_q v + f_t) − α f", &found.moved[0]);
    text += &seen("α", &found.moved[1]);
    text += "\n  law                              rest, of forces and inertia\n";
    for rest in &found.rests {
        let _ = writeln!(text, "  {:<32} {:.1e}", name(&rest.law), rest.rest);
    }
    let _ = writeln!(text, "  {:<32} {:.1e}\n", "noise of the film", found.noise);
    text
}

fn number(own: &Number) -> String {
    format!("{:.6e} ± {:.1e}", own.value, own.error)
}

fn value(path: &str, film: &Film, found: &Judgement) -> Value {
    let number = |own: &Number| json!({ "value": own.value, "error": own.error, "seen": own.is_seen(SEEN) });
    let word = match found.constraint {
        Constraint::Kept => "kept",
        Constraint::Creeps => "creeps",
        Constraint::LeftOut => "left out",
        Constraint::NotKept => "not kept",
    };
    let rests = found.rests.iter().map(|rest| {
        let mu = if let Law::Vakonomic(mu) = &rest.law { Some(mu) } else { None };
        json!({ "law": name(&rest.law), "rest": rest.rest, "mu0": mu })
    });
    json!({
        "film": path,
        "samples": film.times().len(),
        "law": name(&found.law),
        "constraint": word,
        "residual": found.residual[0],
        "size": found.residual[1],
        "epsilon": number(&found.epsilon),
        "drag": number(&found.drag),
        "slip": number(&found.slip),
        "moved": found.moved.iter().map(number).collect::<Vec<_>>(),
        "rests": rests.collect::<Vec<_>>(),
        "noise": found.noise,
    })
}
