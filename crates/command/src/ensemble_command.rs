//! `deltaq ensemble`: many starts or parameters of one scene, in one formulation.

mod members;
mod output;

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use deltaq::{Choice, Ensemble, EnsembleOptions, EnsembleStart, Settings, constants_of, formulation, setting};
use integrate::Method;
use scene::{Scene, SceneErrorKind};

use crate::answer::Answer;
use crate::cli::EnsembleArguments;
use crate::solve_command::{choice, settings, times};
use members::Members;
use output::{Answers, Outcome, Seconds};
use random::parallel;
use validation::catalogue::{self, NotFound};
use validation::report::{File, write_all};

/// Members integrated before they are written down.
const CHUNK: usize = 4096;

/// Runs the command.
pub(crate) fn run(arguments: &EnsembleArguments) -> Result<Answer> {
    let settings = Settings { method: Some(Method::Taylor), ..settings(&arguments.motion)? };
    let base = arguments.motion.scene.find()?;
    let members = Members::of(arguments, &base)?;
    let choice = choice(&base, &arguments.motion)?;
    check_multipliers(&members, &choice, arguments)?;
    let end = setting(&base).end;
    let asked = arguments.motion.times.as_deref();
    let times = asked.map_or(Ok(vec![end]), |text| times(text, &base))?;
    if times.windows(2).any(|pair| pair[1] < pair[0]) {
        bail!("--times {} has to be in ascending order", asked.unwrap_or_default());
    }

    let clock = Instant::now();
    let parameters: Vec<&str> = members.names.iter().map(String::as_str).filter(|n| is_parameter(&base, n)).collect();
    let starts = starts(arguments, &members, &parameters, &choice)?;
    let start = clock.elapsed().as_secs_f64();
    if starts.iter().all(Result::is_err) {
        let cause = starts.iter().find_map(|start| start.as_ref().err()).map_or("", String::as_str);
        bail!("none of {} members can be started; the first: {cause}", starts.len());
    }
    let clock = Instant::now();
    let ensemble = Ensemble::new(&base, &choice, &parameters, &settings)?;
    let derive = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let options = EnsembleOptions { threads: parallel::threads(), estimate: true };
    let mut answers = Answers::new(arguments.motion.format, &base, &choice, ensemble.equations(), &members, &times);
    for chunk in starts.chunks(CHUNK) {
        for motion in ensemble.answers(chunk, &times, &options) {
            answers.add(Outcome::of(motion));
        }
    }
    let seconds = Seconds { derive, start, integrate: clock.elapsed().as_secs_f64() };
    let complaint = answers.complaint();
    let text = answers.finish(seconds);
    let text = match &arguments.out {
        None => text,
        Some(path) => write(path, text, members.rows.len())?,
    };
    Ok(Answer { text, complaint })
}

fn is_parameter(scene: &Scene, name: &str) -> bool {
    scene.system.parameters.iter().any(|p| scene.system.graph.name(p.symbol) == name)
}

fn overrides(arguments: &EnsembleArguments, members: &Members, row: &[f64]) -> Vec<(String, f64)> {
    arguments
        .motion
        .scene
        .set
        .overrides
        .iter()
        .cloned()
        .chain(members.names.iter().cloned().zip(row.iter().copied()))
        .collect()
}

/// Multipliers vary only where a motion starts from those of the scene.
fn check_multipliers(members: &Members, choice: &Choice, arguments: &EnsembleArguments) -> Result<()> {
    let is_multiplier = |name: &&String| name.strip_prefix("mu").is_some_and(|i| i.parse::<usize>().is_ok());
    let Some(name) = members.names.iter().find(is_multiplier) else { return Ok(()) };
    let place = members.place(name);
    if !formulation(choice.formulation).is_some_and(|entry| entry.starts_multipliers) {
        bail!("{place}: `{name}` belongs to the vakonomic formulation, not to {}", choice.formulation);
    }
    if arguments.motion.mu0.is_some() {
        bail!("{place}: `{name}` varies, and --mu0 fixes it");
    }
    Ok(())
}

/// What each member starts from, or why it cannot be started.
fn starts(
    arguments: &EnsembleArguments,
    members: &Members,
    parameters: &[&str],
    choice: &Choice,
) -> Result<Vec<Result<EnsembleStart, String>>> {
    let given = arguments.motion.mu0.is_some();
    let start =
        |row: &Vec<f64>| match catalogue::find(&arguments.motion.scene.scene, &overrides(arguments, members, row)) {
            Ok(scene) => {
                let constants = if given { choice.constants.clone() } else { constants_of(choice, &scene) };
                Ok(Ok(EnsembleStart::of(&scene, parameters, constants)))
            }
            Err(NotFound::Fault(fault)) => match &*fault.kind {
                SceneErrorKind::UnknownName { name, .. } if fault.line == 0 => {
                    bail!("{}: {}", members.place(name), fault.kind)
                }
                kind => Ok(Err(kind.to_string())),
            },
            Err(error) => Err(error.into()),
        };
    parallel::map(&members.rows, start).into_iter().collect()
}

fn write(path: &Path, text: String, members: usize) -> Result<String> {
    let name = path.file_name().with_context(|| format!("--out {} names no file", path.display()))?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    write_all(folder, &[File { path: name.into(), text }])?;
    Ok(format!("{members} members in {}\n", path.display()))
}
