//! Whether committed reports still hold: every page, written again and compared.

use std::path::Path;

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use pages::difference_of_verdicts;
use serde_json::Value;
use validation::report::stamp::{self, Age};
use validation::report::{Compared, without_referees};

use crate::cli::{ReportsArguments, Section};
use crate::main_job::{Results, sources};
use program::pretty;

const MEND: &str = "`cargo run --release` writes the reports anew";

/// Runs the main job in memory, but for times, and compares its pages and verdicts with those in the folder:
/// words to the letter, numbers to the digits that are sure ([`Compared`]). Where CasADi cannot run, what it
/// says is left out, and the answer says so.
fn check(arguments: &ReportsArguments) -> Result<String> {
    let folder = &arguments.out;
    let read = |name: &Path| {
        let path = folder.join(name);
        std::fs::read_to_string(&path).with_context(|| format!("cannot read {}; {MEND}", path.display()))
    };
    let text = read("verdicts.json".as_ref())?;
    let mut old: Value = serde_json::from_str(&text).with_context(|| format!("verdicts.json; {MEND}"))?;
    let names: Vec<&str> = scene::catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    let mut results = Results::of(Section::value_variants(), &names, None, true)?;
    let mut new: Value = serde_json::from_str(&pretty("verdicts", &results.verdicts()))?;
    let left_out = results.casadi_not_run.is_some();
    if left_out {
        for verdicts in [&mut old, &mut new] {
            verdicts.as_object_mut().and_then(|all| all.remove("casadi"));
        }
    }
    if left_out {
        results.leave_out_referees();
    }
    if let Some(difference) = difference_of_verdicts(&old, &new) {
        bail!("{} is out of date at {difference}; {MEND}", folder.join("verdicts.json").display());
    }
    let mut compared = Compared::default();
    for file in results.files().into_iter().chain(results.overview()) {
        let mut both = [read(&file.path)?, file.text];
        if left_out {
            both = both.map(|text| without_referees(&text));
        }
        if let Err(difference) = compared.page(&both[0], &both[1]) {
            bail!("{} is out of date: {difference}; {MEND}", folder.join(&file.path).display());
        }
    }
    let folder = folder.display();
    let Compared { pages, same, last_digit, round_off } = compared;
    let told = format!(
        "{pages} pages and pictures, {same} numbers to the last digit, {last_digit} but for the last one, \
         {round_off} of round-off to a factor of ten"
    );
    let agrees = match results.casadi_not_run {
        None => format!("{folder} agrees with a fresh run: {told}; pages of times are not compared\n"),
        Some(reason) => format!("{folder}: what CasADi says is not compared: {reason}; the rest holds: {told}\n"),
    };
    Ok(agrees + &ages(&arguments.out)?)
}

/// Which pages that the main job does not write are older than the code they speak of, a line each: not a
/// fault, but the site leaves them out.
fn ages(folder: &Path) -> Result<String> {
    let Some(root) = sources() else { return Ok(String::new()) };
    let line = |(page, age): (&str, Age)| match age {
        Age::Current => String::new(),
        Age::Older(date) => format!("{page}\tmeasured on {date} with older code\n"),
        Age::Unknown => format!("{page}\tdoes not say when it was measured, and with which code\n"),
        Age::Missing => format!("{page}\tis not there\n"),
    };
    Ok(stamp::ages(&root, folder)?.into_iter().map(line).collect())
}

/// Writes under these pages when they were measured, which is now, and with which code, which is that of the
/// sources.
fn stamp(arguments: &ReportsArguments) -> Result<String> {
    let root =
        sources().context("only pages of the project's own reports have such a line: this is not a folder of it")?;
    for page in &arguments.stamp {
        stamp::write(&root, &arguments.out, page)?;
    }
    Ok(format!("{} of {}\n", arguments.stamp.len(), arguments.out.display()))
}

/// Runs the command.
pub(crate) fn run(arguments: &ReportsArguments) -> Result<String> {
    match (arguments.check, arguments.ages) {
        (true, _) => check(arguments),
        (_, true) => ages(&arguments.out),
        _ => stamp(arguments),
    }
}
