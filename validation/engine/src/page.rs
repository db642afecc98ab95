//! The page and its pictures.

use std::fmt::Write;

use pages::{Table, fill};
use picture::{Axis, Curve, Picture, PictureError, Style};
use program::File;
use rapier3d_f64::VERSION;

use crate::study::{FAR, Level, NEAR, ORDER, SAMPLES, Study, Target};

/// The page `evidence/engine.md` and one picture for each study.
///
/// # Errors
/// Where a picture cannot be drawn.
pub fn files(studies: &[Study]) -> Result<Vec<File>, PictureError> {
    let mut files = vec![File { path: "evidence/engine.md".into(), text: page(studies) }];
    for study in studies {
        files.push(File { path: format!("evidence/{}", picture_name(study)).into(), text: picture(study)? });
    }
    Ok(files)
}

fn picture_name(study: &Study) -> String {
    format!("engine-{}.svg", study.name)
}

fn page(studies: &[Study]) -> String {
    let columns = ["hard contacts", ">order in dt", ">to Chetaev, smallest dt", "floor, extrapolated"];
    let more = [">other formulations", "holds", ">1 MHz: floor, extrapolated", ">as shipped, smallest"];
    let mut table = Table::new(columns.into_iter().chain(more));
    for study in studies {
        let finding = study.finding();
        let floor =
            format!("{} {:.1e}", if finding.falling { "none met above" } else { "met at" }, finding.extrapolated);
        let (others, holds) = match study.targets.len() {
            1 => ("the same here".to_string(), "–"),
            _ => (format!("{:.1e} times as far", finding.others), if finding.holds() { "yes" } else { "**no**" }),
        };
        let (name, order) = (format!("[{0}](#{0})", study.name), format!("{:.2}", finding.order));
        let [nearest, yielding, shipped] =
            [finding.nearest, finding.yielding, finding.shipped].map(|distance| format!("{distance:.1e}"));
        table.row(&[&name, &order, &nearest, &floor, &others, &holds, &yielding, &shipped]);
    }
    fill(
        include_str!("engine.md"),
        &[
            ("headline", &headline(studies)),
            ("version", &VERSION),
            ("samples", &SAMPLES),
            ("order", &ORDER.0),
            ("order_within", &ORDER.1),
            ("near", &format!("{NEAR:.0e}")),
            ("far", &FAR),
            ("table", &table),
            ("sections", &studies.iter().map(section).collect::<String>()),
        ],
    )
}

fn headline(studies: &[Study]) -> String {
    let judged: Vec<&Study> = studies.iter().filter(|study| study.targets.len() > 1).collect();
    let names = |holds: bool| {
        let names = judged.iter().filter(|study| study.finding().holds() == holds).map(|study| study.name.as_str());
        names.collect::<Vec<&str>>().join(" and ")
    };
    match (names(true).as_str(), names(false).as_str()) {
        (all, "") => format!(
            "On {all} the engine's motion converges to Chetaev's, and to no other, at first order in the time step."
        ),
        ("", none) => format!("On {none} it was not shown that the engine's motion converges to Chetaev's."),
        (some, rest) => {
            format!(
                "On {some} the engine's motion converges to Chetaev's at first order; on {rest} that was not shown."
            )
        }
    }
}

fn section(study: &Study) -> String {
    let mut text = format!("\n## {}\n\n{}, {} s.", study.name, study.title, study.duration);
    let _ =
        write!(text, " Slip of the contact point at the start, as the engine gets it: {} m/s.", short(study.residual));
    if let Some(target) = study.targets.first() {
        let _ = write!(text, " Chetaev's motion gets {} m from its start.", short(study.scale));
        if study.targets.len() == 1 {
            let _ = write!(text, " Closed solution: {}; {}.", target.label, target.remark.clone().unwrap_or_default());
        }
    }
    let _ = writeln!(text, "\n\n![Distance over time step]({})\n", picture_name(study));
    if study.targets.len() > 1 {
        let mut table = Table::new(["formulation", ">distance from Chetaev", "remark"]);
        for (target, apart) in study.targets.iter().zip(&study.apart) {
            let remark = target.remark.as_deref().unwrap_or("reaches the end");
            let apart = if *apart == 0.0 { "0".into() } else { short(*apart) };
            table.row(&[&target.label, &apart, &remark]);
        }
        let _ = writeln!(text, "{table}");
    }
    let nearest = &study.targets[0].label;
    let distances = [">dt (s)".into(), format!(">to {nearest}"), ">order".into(), ">extrapolated".into()];
    let shipped = [">at 1 MHz", ">as shipped", ">off the surface, hard (m)", ">as shipped (m)"].map(String::from);
    let mut table = Table::new(distances.into_iter().chain(shipped));
    let first = |distances: &Option<Vec<f64>>| distances.as_ref().map_or("–".into(), |distances| short(distances[0]));
    for (at, hard) in study.hard.iter().enumerate() {
        let (yielding, shipped) = (&study.yielding[at], &study.shipped[at]);
        let order = at.checked_sub(1).map(|before| (study.hard[before].distances[0] / hard.distances[0]).log2());
        let order = order.map_or("–".into(), |order| format!("{order:.2}"));
        let distances = [format!("{:.1e}", hard.dt), short(hard.distances[0])];
        let extrapolated = [order, first(&hard.extrapolated), first(&yielding.extrapolated)];
        let shipped = [shipped.distances[0], hard.off_surface, shipped.off_surface].map(short);
        table.cells(distances.into_iter().chain(extrapolated).chain(shipped));
    }
    text + &table.to_string()
}

/// Two significant digits; a dash for what is not there, a bound for what is round-off.
fn short(x: f64) -> String {
    match x.abs() {
        size if size < 1e-14 => "< 1e-14".into(),
        size if !size.is_finite() => "–".into(),
        size if (0.995..99.5).contains(&size) => format!("{x:.*}", usize::from(size < 9.95)),
        size if (0.095..1.0).contains(&size) => format!("{x:.2}"),
        _ => format!("{x:.1e}"),
    }
}

fn picture(study: &Study) -> Result<String, PictureError> {
    let style = |formulation: &str| Style::of_formulation(formulation).unwrap_or(Style::RemovedConstraint);
    let curve = |label: String, style: Style, levels: &[Level], read: &dyn Fn(&Level) -> Option<f64>| Curve {
        label,
        style,
        points: levels.iter().filter_map(|level| Some((level.dt, read(level)?))).collect(),
    };
    // of a formulation with several motions the first: they lie on one another, and the table has them all
    let first = |(at, target): &(usize, &Target)| {
        let same = |other: &&Target| other.formulation == target.formulation && !other.poses.is_empty();
        *at == 0 || study.targets.iter().position(|other| same(&other)) == Some(*at)
    };
    let mut curves: Vec<Curve> = study
        .targets
        .iter()
        .enumerate()
        .filter(first)
        .map(|(at, target)| {
            let label = format!("to {}", target.label);
            curve(label, style(&target.formulation), &study.hard, &|level: &Level| Some(level.distances[at]))
        })
        .collect();
    let first = &study.targets[0].label;
    let extrapolated = |level: &Level| level.extrapolated.as_ref().map(|distances| distances[0]);
    let as_shipped = |level: &Level| Some(level.distances[0]);
    curves.push(curve(format!("to {first}, extrapolated"), Style::Chetaev, &study.hard, &extrapolated));
    // narrow lines, which do not hide what is below them
    curves.push(curve(format!("to {first}, extrapolated, 1 MHz"), Style::Member(3), &study.yielding, &extrapolated));
    curves.push(curve(format!("to {first}, contacts as shipped"), Style::Member(2), &study.shipped, &as_shipped));
    // a line of first order below the others
    let guide = study
        .hard
        .first()
        .map(|from| study.hard.iter().map(|l| (l.dt, 0.1 * from.distances[0] * l.dt / from.dt)).collect());
    curves.extend(guide.map(|points| Curve { label: "∝ dt".into(), style: Style::Threshold, points }));
    let finding = study.finding();
    let title = match study.targets.len() > 1 && finding.holds() {
        true => format!("{}: the engine converges to Chetaev's motion and to no other", study.title),
        false => format!("{}: the engine's distance from the closed solution", study.title),
    };
    Picture::new(title, Axis::log("dt (s)"), Axis::log("relative distance"), curves).to_svg()
}
