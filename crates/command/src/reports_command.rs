//! Whether committed reports still hold: every page, written again and compared.

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use serde_json::Value;
use validation::report::{Compared, difference_of_verdicts};

use crate::answer::pretty;
use crate::cli::{ReportsArguments, Section};
use crate::main_job::Results;

const MEND: &str = "`cargo run --release` writes the reports anew";

/// Runs the main job in memory, but for times, and compares its pages and verdicts with those in the folder:
/// words to the letter, numbers to the digits that are sure ([`Compared`]). Where CasADi cannot run, what it
/// says is left out, and the answer says so.
pub(crate) fn check(arguments: &ReportsArguments) -> Result<String> {
    let folder = &arguments.out;
    let read = |name: &std::path::Path| {
        let path = folder.join(name);
        std::fs::read_to_string(&path).with_context(|| format!("cannot read {}; {MEND}", path.display()))
    };
    let text = read("verdicts.json".as_ref())?;
    let mut old: Value = serde_json::from_str(&text).with_context(|| format!("verdicts.json; {MEND}"))?;
    let names: Vec<&str> = catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    let results = Results::of(Section::value_variants(), &names, false, true)?;
    let mut new: Value = serde_json::from_str(&pretty("verdicts", &results.verdicts()))?;
    let left_out = results.casadi_not_run.is_some();
    if left_out {
        for verdicts in [&mut old, &mut new] {
            verdicts.as_object_mut().and_then(|all| all.remove("casadi"));
        }
    }
    if let Some(difference) = difference_of_verdicts(&old, &new) {
        bail!("{} is out of date at {difference}; {MEND}", folder.join("verdicts.json").display());
    }
    let mut compared = Compared::default();
    for file in results.files().into_iter().chain([results.overview()]) {
        let (mut old, mut new) = (read(&file.path)?, file.text);
        if left_out {
            [old, new] = [old, new].map(|text| without_referees(&text));
        }
        if let Err(difference) = compared.page(&old, &new) {
            bail!("{} is out of date: {difference}; {MEND}", folder.join(&file.path).display());
        }
    }
    let folder = folder.display();
    let Compared { pages, same, last_digit, round_off } = compared;
    let told = format!(
        "{pages} pages and pictures, {same} numbers to the last digit, {last_digit} but for the last one, \
         {round_off} of round-off to a factor of ten"
    );
    Ok(match results.casadi_not_run {
        None => format!("{folder} agrees with a fresh run: {told}; pages of times are not compared\n"),
        Some(reason) => format!("{folder}: what CasADi says is not compared: {reason}; the rest holds: {told}\n"),
    })
}

/// A page without what referees say that are other programs.
fn without_referees(text: &str) -> String {
    let mut inside = false;
    let lines = text.lines().filter(|line| {
        inside = *line == "## Referees" || inside && !line.starts_with("With sliders");
        !inside && !line.starts_with("- Referees that share")
    });
    lines.map(|line| format!("{line}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_referees_say_is_left_out() {
        let page = "a\n## Referees\n\n| CasADi |\n\nWith sliders, here.\n- Referees that share no\nb\n";
        assert_eq!(without_referees(page), "a\nWith sliders, here.\nb\n");
    }
}
