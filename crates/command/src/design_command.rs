//! `deltaq design`: the film that would tell two formulations apart best, or show a number best.

use std::fmt::Write;

use anyhow::{Context, Result, bail};
use deltaq::{CHETAEV, Choice, FIRST_ORDER, Settings, choices_among};
use equations::Formulation;
use fit::{Aim, Best, Design, Deviations, EXCLUDED, Film, Point, Question, Unknown, design_value, with_law};
use program::{Answer, TextOrJson, parallel, pretty};
use scene::Scene;

use crate::cli::DesignArguments;

/// Other ends of the search that are printed in text.
const PRINTED: usize = 2;

/// Chooses films.
///
/// # Errors
/// A scene, column or number that makes no sense; films without motions.
pub fn run(arguments: &DesignArguments) -> Result<Answer> {
    let scene = arguments.scene.find()?;
    let deviations = Deviations::written(&arguments.sigma).context("--sigma")?;
    let film = Film::planned(&scene, &arguments.columns, arguments.film, &deviations)?;
    let films = vec![film; usize::from(arguments.films)];
    let mut law: Vec<Unknown> = arguments.law.iter().map(Unknown::of_law).collect();
    let estimated = arguments.estimate.as_ref().map(|name| Unknown::named(name).of_law());
    law.extend(estimated.clone().filter(|u| ["epsilon", "slip"].contains(&u.name.as_str())));
    law.dedup_by(|b, a| a.name == b.name);
    let scene = with_law(&scene, &law);
    let question = Question {
        unknowns: &arguments.free,
        law: &law,
        starts: arguments.starts,
        robust: None,
        settings: Settings { tolerance: arguments.tolerance, max_steps: arguments.max_steps, ..Settings::default() },
        threads: parallel::threads(),
    };
    question.settings.check()?;
    let choices: Vec<Choice> = match (&estimated, &arguments.tell[..]) {
        (Some(_), _) => vec![first(&scene, if law.is_empty() { CHETAEV } else { FIRST_ORDER })?],
        (None, wanted) => wanted.iter().map(|own| first(&scene, own)).collect::<Result<_>>()?,
    };
    let aim = match (&estimated, &choices[..]) {
        (Some(unknown), [choice]) => Aim::Estimate(choice, &unknown.name),
        (None, [truth, rival]) if truth.formulation != rival.formulation => Aim::Tell(truth, rival),
        _ => bail!("--tell asks for two formulations"),
    };
    let design = Design::new(&scene, &films, &question, &arguments.over, aim)?;
    let best = design.best(arguments.points as usize, parallel::threads())?;
    let shortest = (best.best.value >= EXCLUDED).then(|| design.shortest(&best.best.at)).flatten();
    let found = Found { scene: &scene, films: &films, design: &design, aim, best, shortest };
    Ok(match arguments.format {
        TextOrJson::Text => found.text(),
        TextOrJson::Json => pretty("design", &design_value(&scene, &films, (&design, aim), &found.best, shortest)),
    }
    .into())
}

/// The first choice of a formulation.
fn first(scene: &Scene, wanted: &Formulation) -> Result<Choice> {
    match choices_among(scene, |f| *f == *wanted).into_iter().next() {
        Some(choice) => Ok(choice),
        None => bail!("the scene has no {} motion", wanted.name),
    }
}

struct Found<'a> {
    scene: &'a Scene,
    films: &'a [Film],
    design: &'a Design,
    aim: Aim<'a>,
    best: Best,
    shortest: Option<f64>,
}

impl Found<'_> {
    fn text(&self) -> String {
        let mut text = String::new();
        let film = &self.films[0];
        let columns: Vec<String> = film.columns.iter().map(|c| format!("{} ± {}", c.name, c.sigma)).collect();
        let count = match self.films.len() {
            1 => "a film".into(),
            n => format!("{n} films, each"),
        };
        let _ = writeln!(text, "{}: {count} of {} samples, {}", self.scene.name, film.t.len(), columns.join(", "));
        let Best { own, best, others, tried, without_motion } = &self.best;
        if !self.design.chosen().is_empty() {
            let _ = writeln!(text, "\n{:<12} {:>12} {:>12}   between", "chosen", "best", "the scene's");
            for (chosen, at) in self.design.chosen().iter().zip(&best.at) {
                let [low, high] = chosen.ends;
                let _ = writeln!(text, "{:<12} {at:>12.5} {:>12.5}   {low} and {high}", chosen.label, chosen.own);
            }
        }
        let head = if self.design.chosen().is_empty() { "" } else { "best: " };
        let _ = writeln!(text, "\n{head}{}", self.words(best));
        for hidden in &best.hidden {
            let _ = writeln!(text, "  such films do not show a change of {hidden}");
        }
        if let Some(seconds) = self.shortest {
            let _ = writeln!(text, "  the shortest film of this motion that tells them apart: {seconds:.3} s");
        }
        if self.design.chosen().is_empty() {
            return text;
        }
        match own {
            Ok(own) => {
                let _ = writeln!(text, "the scene's own numbers: {}", self.words(own));
                for hidden in &own.hidden {
                    let _ = writeln!(text, "  such films do not show a change of {hidden}");
                }
            }
            Err(error) => {
                let _ = writeln!(text, "the scene's own numbers: {error}");
            }
        }
        for other in others.iter().take(PRINTED) {
            let chosen = self.design.chosen().iter().zip(&other.at);
            let at: Vec<String> = chosen.map(|(chosen, at)| format!("{} = {at:.5}", chosen.label)).collect();
            let _ = writeln!(text, "another end of the search, {}: {}", at.join(", "), self.words(other));
        }
        let _ = write!(text, "{tried} choices looked at");
        if *without_motion > 0 {
            let _ = write!(text, ", {without_motion} of them without a motion through the film");
        }
        text + "\n"
    }

    fn words(&self, point: &Point) -> String {
        match self.aim {
            Aim::Estimate(_, name) if point.value.is_infinite() => format!("{name} is not shown"),
            Aim::Estimate(_, name) => format!("standard error of {name} {:.4e}", point.value),
            Aim::Tell(truth, rival) => {
                let tells = if point.value >= EXCLUDED { "excluded at" } else { "cannot tell," };
                let (truth, rival) = (&truth.label, &rival.label);
                let minima = if point.minima == 1 { "one minimum".into() } else { format!("{} minima", point.minima) };
                format!(
                    "where {truth} is right, {rival}: {tells} {:.1} σ (chi squared {:.2} above that of noise, the least of {minima})",
                    point.value.sqrt(),
                    point.value,
                )
            }
        }
    }
}
