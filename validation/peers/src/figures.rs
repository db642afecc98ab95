//! Error over time, one picture a problem.

use picture::{Aspect, Axis, Curve, Picture, PictureError, Style};
use validation::report::File;

use crate::{Outcome, Rung, Task};

/// Name of the picture of a problem.
pub(crate) fn name(outcome: &Outcome) -> String {
    format!("peers-{}.svg", outcome.problem.slug)
}

/// One picture for each problem that was timed.
///
/// # Errors
/// Where a picture cannot be drawn.
pub fn figures(outcomes: &[Outcome]) -> Result<Vec<File>, PictureError> {
    let timed = outcomes.iter().filter(|outcome| outcome.rungs.iter().any(drawable));
    timed.map(|outcome| Ok(File { path: name(outcome).into(), text: figure(outcome)? })).collect()
}

fn drawable(rung: &Rung) -> bool {
    rung.task == Task::Trajectory && rung.error > 0.0
}

fn style(rung: &Rung) -> Style {
    match rung.entrant.tool {
        "ours" => Style::Chetaev,
        "heyoka" => Style::Vakonomic,
        "scipy" => Style::RemovedConstraint,
        _ => Style::Substituted,
    }
}

fn figure(outcome: &Outcome) -> Result<String, PictureError> {
    let rungs: Vec<&Rung> = outcome.rungs.iter().filter(|rung| drawable(rung)).collect();
    let mut curves: Vec<Curve> = Vec::new();
    for rung in &rungs {
        if curves.iter().any(|curve| curve.label == rung.row) {
            continue;
        }
        let mut points: Vec<(f64, f64)> =
            rungs.iter().filter(|r| r.row == rung.row).map(|r| (1e3 * r.seconds, r.error)).collect();
        // of several methods in a row, what is not worse than another one in both
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut least = f64::INFINITY;
        points.retain(|&(_, error)| {
            let better = error < least;
            least = least.min(error);
            better
        });
        curves.push(Curve { label: rung.row.clone(), style: style(rung), points });
    }
    Picture {
        title: format!("{}: error over time", outcome.problem.title),
        x: Axis::log("ms of one run, trajectory"),
        y: Axis::log("largest error"),
        curves,
        aspect: Aspect::Fill,
    }
    .to_svg()
}
