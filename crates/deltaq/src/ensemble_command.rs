//! `deltaq ensemble`: many starts or parameters of one scene, in one formulation.

mod members;
mod output;
mod resume;

use std::time::Instant;

use anyhow::{Result, bail, ensure};
use integrate::Method;
use motion::band::CHUNK;
use motion::{Choice, Ensemble, EnsembleOptions, Settings, setting};

use crate::cli::{EnsembleArguments, Format, MotionArguments};
use crate::columns::MOST_NUMBERS;
use crate::solve_command::{choice, settings, times};
use members::Members;
pub(crate) use output::Ensemble as AllMembers;
use output::{Answers, Outcome, Seconds};
use program::{Answer, AtomicWriter, ResumableFile, parallel};
use resume::resume;
use scene::Scene;

/// Runs the command.
pub(crate) fn run(arguments: &EnsembleArguments, quiet: bool) -> Result<Answer> {
    let settings = Settings { method: Some(Method::Taylor), ..settings(&arguments.motion)? };
    let base = arguments.motion.scene.find()?;
    let MotionArguments { formulation, form, free, .. } = &arguments.motion;
    let choice = choice(&base, (formulation, form), free)?;
    let members = Members::of(arguments, &base, &choice)?;
    check_multipliers(&base, &members, &choice, arguments)?;
    let end = setting(&base).end;
    let asked = arguments.motion.times.as_deref();
    let times = asked.map_or(Ok(vec![end]), |text| times(text, &base))?;
    if times.windows(2).any(|pair| pair[1] < pair[0]) {
        bail!("--times {} has to be in ascending order", asked.unwrap_or_default());
    }

    let clock = Instant::now();
    let names: Vec<&str> = members.names.iter().map(String::as_str).collect();
    let mut ensemble = Ensemble::new(&base, &choice, &names, &settings)?;
    let mut seconds = Seconds { derive: clock.elapsed().as_secs_f64(), ..Seconds::default() };
    let mut causes = (0..members.count()).map(|i| ensemble.member(&members.row(i)).err());
    if let Some(Some(cause)) = causes.next()
        && causes.all(|cause| cause.is_some())
    {
        bail!("none of {} members can be started; the first: {cause}", members.count());
    }

    let options = EnsembleOptions { threads: parallel::threads(), estimate: true };
    let mut answers = Answers::new(arguments.motion.format, &base, &choice, ensemble.equations(), &members, &times);
    let mut outcomes = |range: std::ops::Range<usize>| {
        let rows: Vec<Vec<f64>> = range.map(|i| members.row(i)).collect();
        let clock = Instant::now();
        let started = ensemble.members(&rows, options.threads);
        seconds.start += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        let motions = ensemble.answers(started, &times, &options);
        seconds.integrate += clock.elapsed().as_secs_f64();
        motions.into_iter().map(Outcome::of).collect::<Vec<_>>()
    };
    let head = answers.head()?;
    let most = MOST_NUMBERS / answers.names().len();
    ensure!(times.len() <= most, "--times: of this scene at most {most} times are possible");
    let chunk = CHUNK.min(most / times.len().max(1));
    // an answer in one piece begins anew
    let resume = (arguments.motion.format == Format::Csv).then_some(
        |lines: &mut ResumableFile, is_ours: &dyn Fn(bool) -> Result<()>| {
            let first = |answers: &Answers| outcomes(0..1).iter().map(|first| answers.rows(0, first)).collect();
            resume(&mut answers, lines, is_ours, first)
        },
    );
    let (mut sink, mut reads_on) = AtomicWriter::open(arguments.out.as_deref(), &head, "ensemble", resume)?;
    let bar = parallel::progress(members.count(), quiet);
    while reads_on && answers.done < members.count() {
        bar.set_position(answers.done as u64);
        let next = (answers.done + chunk).min(members.count());
        let text =
            outcomes(answers.done..next).iter().map(|outcome| answers.add(outcome)).collect::<Result<String>>()?;
        reads_on = sink.write(&text)?;
    }
    bar.finish_and_clear();
    let complaint = answers.complaint();
    reads_on = reads_on && sink.write(&answers.end(&seconds)?)?;
    let file = if reads_on { sink.close()? } else { None };
    let text = file.map_or(String::new(), |path| format!("{} members in {}\n", members.count(), path.display()));
    Ok(Answer { text, complaint, ..Answer::default() })
}

/// Multipliers vary only where a motion starts from those of the scene.
fn check_multipliers(scene: &Scene, members: &Members, choice: &Choice, arguments: &EnsembleArguments) -> Result<()> {
    let multipliers = scene.multiplier_names();
    let Some(name) = members.names.iter().find(|name| multipliers.contains(name)) else { return Ok(()) };
    let place = members.place(name);
    if !choice.formulation.starts_multipliers {
        bail!("{place}: `{name}` belongs to the vakonomic formulation, not to {}", choice.formulation.name);
    }
    if arguments.motion.free.mu0.is_some() {
        bail!("{place}: `{name}` varies, and --mu0 fixes it");
    }
    Ok(())
}
