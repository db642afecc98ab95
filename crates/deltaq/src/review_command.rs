//! `deltaq review`: are these equations of motion right, and if not, whose are they?

use std::fmt::Write;
use std::io::Read;

use anyhow::{Context, Result};
use program::{Answer, TextOrJson, typed};
use review::{Asked, Numbers, Review, Reviewed, Verdict, review};
use scene::table_text;

use crate::cli::ReviewArguments;

/// Reviews the equations of a file.
///
/// # Errors
/// A scene or equations that cannot be read, with their place.
pub fn run(arguments: &ReviewArguments) -> Result<Answer> {
    let scene = arguments.scene.find()?;
    let file = arguments.theirs.display().to_string();
    let text = match &file[..] {
        "-" => {
            let mut text = String::new();
            std::io::stdin().read_to_string(&mut text).context("standard input")?;
            text
        }
        _ => table_text(&arguments.theirs)?,
    };
    let (wheres, formulation) = (arguments.wheres.clone(), arguments.formulation);
    anyhow::ensure!(
        arguments.tolerance > 0.0 && arguments.tolerance < 1.0,
        "--tolerance: {} is not between 0 and 1",
        arguments.tolerance
    );
    let found = review(&scene, &file, &text, &Asked { formulation, wheres, tolerance: arguments.tolerance })?;
    let text = match arguments.format {
        TextOrJson::Text => words(&scene.name, &file, &found, formulation.title),
        TextOrJson::Json => typed(&Reviewed { scene: &scene.name, file: &file, found: &found })?,
    };
    let undecided = || format!("nothing can be told: {}", found.notes.join("; "));
    let complaint = (found.verdict == Verdict::Undecided).then(undecided);
    Ok(Answer { text, complaint, is_no: found.verdict == Verdict::Wrong })
}

fn numbers(found: &Review) -> &'static str {
    match found.numbers {
        Some(Numbers::Field) => "at random points of a finite field",
        Some(Numbers::Floats) => "in floating point, at random states, within bands of round-off",
        None => "not at all",
    }
}

fn words(scene: &str, file: &str, found: &Review, title: &str) -> String {
    let mut text = match found.verdict {
        Verdict::Right => format!("right: {file} has the {title} motions of {scene} from every start\n"),
        Verdict::Wrong => format!("wrong: {file} does not have the {title} motions of {scene}\n"),
        Verdict::Undecided => String::from("cannot tell\n"),
    };
    let mut line = |words: String| _ = writeln!(text, "  {words}");
    if let Some((first, others)) = found.explanations.split_first() {
        line(format!("These are exactly the equations of: {}.", first.join(", ")));
        for other in others {
            line(format!("The same equations come of: {}.", other.join(", ")));
        }
    } else if found.verdict == Verdict::Wrong {
        line("No mistake that is known, nor two, makes these equations of the right ones.".into());
    }
    for constraint in &found.broken {
        line(format!("The constraint `{constraint}` is not that of the scene."));
    }
    if !found.differences.is_empty() {
        let numbers: Vec<String> = found.state.iter().map(|(name, x)| format!("{name} = {x:.6}")).collect();
        let from = if found.at_start { "From the start of the scene on" } else { "At this state" };
        line(format!("{from}, {}:", numbers.join(", ")));
        for d in &found.differences {
            line(format!("  {:<10} {:>14.6e} instead of {:>14.6e}", d.name, d.theirs, d.right));
        }
    }
    for c in &found.coefficients {
        let (name, monomial) = (&c.name, &c.monomial);
        line(format!("  in {name}, before {monomial}: {:.6e} instead of {:.6e}", c.theirs, c.right));
    }
    if !found.unknowns.is_empty() {
        line(format!("Taken for multipliers and other unknowns: {}.", found.unknowns.join(", ")));
    }
    for note in &found.notes {
        line(format!("Note: {note}."));
    }
    line(format!("Compared {}.", numbers(found)));
    text
}
