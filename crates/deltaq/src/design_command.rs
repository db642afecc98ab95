//! `deltaq design`: the film that would tell two formulations apart best, or show a number best.

use std::fmt::Write;

use anyhow::{Context, Result, bail};
use fit::{Aim, Best, Design, Designed, Deviations, EXCLUDED, Film, Point, Question, significance};
use motion::Settings;
use program::{Answer, TextOrJson, parallel, typed};
use scene::Scene;
use symbolic::limits::SHOWN;

use crate::cli::DesignArguments;

/// Chooses films.
///
/// # Errors
/// A scene, column or number that makes no sense; films without motions.
pub fn run(arguments: &DesignArguments) -> Result<Answer> {
    let scene = arguments.scene.find()?;
    let deviations = Deviations::written(&arguments.sigma).context("--sigma")?;
    let film = Film::planned(&scene, &arguments.columns, arguments.film, &deviations)?;
    let films = vec![film; usize::from(arguments.films)];
    let question = Question {
        unknowns: &arguments.free,
        law: &arguments.law,
        starts: arguments.starts,
        robust: None,
        settings: Settings { tolerance: arguments.tolerance, max_steps: arguments.max_steps, ..Settings::default() },
        threads: parallel::threads(),
    };
    question.settings.check()?;
    let aim = match (&arguments.estimate, &arguments.tell[..]) {
        (Some(name), _) => Aim::Estimate(name.clone()),
        (None, &[truth, rival]) => Aim::Tell(truth, rival),
        _ => bail!("--tell asks for two formulations"),
    };
    let design = Design::new(&scene, &films, &question, &arguments.over, &aim)?;
    let best = design.best(arguments.points as usize, parallel::threads())?;
    let found = Found { scene: &scene, films: &films, design: &design, best };
    Ok(match arguments.format {
        TextOrJson::Text => found.text(),
        TextOrJson::Json => typed(&Designed::of(&scene, &films, &design, &found.best))?,
    }
    .into())
}

struct Found<'a> {
    scene: &'a Scene,
    films: &'a [Film],
    design: &'a Design,
    best: Best,
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
        let Best { own, best, others, shortest, tried, without_motion } = &self.best;
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
        if let Some(seconds) = shortest {
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
        for other in others.iter().take(SHOWN) {
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
        match self.design.aim() {
            Aim::Estimate(name) if point.value.is_infinite() => format!("{name} is not shown"),
            Aim::Estimate(name) => format!("standard error of {name} {:.4e}", point.value),
            Aim::Tell(..) => {
                let sigmas = point.value.sqrt();
                let tells = match point.value >= EXCLUDED {
                    true => format!("excluded at {}", significance(sigmas)),
                    false => format!("cannot tell, {sigmas:.0} σ"),
                };
                let [truth, rival] = [0, 1].map(|i| self.design.labels()[i]);
                let minima = if point.minima == 1 {
                    "one minimum".into()
                } else {
                    format!("the least of {} minima", point.minima)
                };
                let by_starts: Vec<String> =
                    point.by_starts.iter().map(|(starts, value)| format!("{value:.2} from {starts}")).collect();
                format!(
                    "where {truth} is right, {rival}: {tells} (chi squared {:.2} above that of noise, {minima}; \
                     by number of starts {})",
                    point.value,
                    by_starts.join(", ")
                )
            }
        }
    }
}
