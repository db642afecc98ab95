//! The page `peers.md`, and everything that was measured for machines.

use std::fmt::Write;
use std::process::Command;

use serde_json::json;

use crate::race::TARGETS;
use crate::rows::{OURS, demanded};
use crate::{Effort, Outcome, Rung, Task};

/// The error that verdicts are about.
const TARGET: f64 = 1e-10;
/// How much less time ours needs from the text of a scene to a trajectory.
const TOTAL: f64 = 50.0;

/// Where and with what the figures were measured.
#[derive(Clone, Debug)]
pub struct Provenance {
    versions: Vec<String>,
    commit: String,
    machine: String,
    date: String,
    effort: Effort,
    seconds: f64,
}

fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_string())
}

impl Provenance {
    /// What this machine says of itself, and this folder of its commit.
    pub fn new(versions: Vec<String>, effort: Effort, seconds: f64) -> Provenance {
        let unknown = || "unknown".to_string();
        let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
        let model = model.map_or_else(unknown, |(_, name)| name.trim().to_string());
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        let changed =
            said("git", &["status", "--porcelain", "--untracked-files=no"]).is_some_and(|text| !text.is_empty());
        let commit = said("git", &["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(unknown);
        Provenance {
            versions,
            commit: if changed { format!("{commit} with changes") } else { commit },
            machine: format!("{model}, {processors} processors, {} {}", std::env::consts::OS, std::env::consts::ARCH),
            date: said("date", &["-u", "+%Y-%m-%d"]).unwrap_or_else(unknown),
            effort,
            seconds,
        }
    }

    /// Everything that was measured.
    ///
    /// # Errors
    /// Where it cannot be written as JSON.
    pub fn json(&self, outcomes: &[Outcome]) -> Result<String, serde_json::Error> {
        let rung = |r: &Rung| {
            json!({
                "row": r.row, "tool": r.entrant.tool, "form": r.entrant.form, "method": r.method, "tolerance": r.tolerance,
                "task": format!("{:?}", r.task), "seconds": r.seconds, "error": r.error, "setup": r.setup,
                "prepare": r.prepare, "total": r.total
            })
        };
        let outcome = |o: &Outcome| {
            json!({
                "problem": o.problem.title,
                "reference": o.reference.as_ref().ok(),
                "setups": o.setups,
                "checks": o.checks,
                "rungs": o.rungs.iter().map(rung).collect::<Vec<_>>(),
                "failures": o.failures.iter().map(|f| json!([f.row, f.what, f.words])).collect::<Vec<_>>()
            })
        };
        let all = json!({
            "versions": self.versions, "commit": self.commit, "machine": self.machine, "date": self.date,
            "effort": format!("{:?}", self.effort), "problems": outcomes.iter().map(outcome).collect::<Vec<_>>()
        });
        Ok(serde_json::to_string_pretty(&all)? + "\n")
    }
}

/// The rung of a row that needs least of something at an error of at most `target`.
fn least<'a>(outcome: &'a Outcome, row: &str, task: Task, target: f64, of: fn(&Rung) -> f64) -> Option<&'a Rung> {
    let fit = outcome.rungs.iter().filter(|r| r.row == row && r.task == task && r.error <= target && of(r).is_finite());
    fit.min_by(|a, b| of(a).total_cmp(&of(b)))
}

fn rows<'a>(outcomes: &[&'a Outcome]) -> Vec<&'a str> {
    let mut rows = Vec::new();
    for rung in outcomes.iter().flat_map(|outcome| &outcome.rungs) {
        if !rows.contains(&rung.row.as_str()) {
            rows.push(&rung.row);
        }
    }
    rows
}

/// Three significant digits at most.
fn short(x: f64) -> String {
    match x {
        x if !x.is_finite() => "–".into(),
        x if x >= 99.5 => format!("{x:.0}"),
        x if x >= 9.95 => format!("{x:.1}"),
        x if x >= 0.995 => format!("{x:.2}"),
        x if x >= 0.0995 => format!("{x:.3}"),
        x => format!("{x:.2e}"),
    }
}

fn ms(rung: Option<&Rung>, of: fn(&Rung) -> f64) -> String {
    rung.map_or("–".into(), |rung| short(1e3 * of(rung)))
}

fn head(outcomes: &[&Outcome]) -> String {
    let names: Vec<&str> = outcomes.iter().map(|o| o.problem.title.as_str()).collect();
    format!("| | {} |\n|---|{}\n", names.join(" | "), "---:|".repeat(names.len()))
}

/// Milliseconds of every row, how many times those of ours, and whether that is what was wanted.
fn table(outcomes: &[&Outcome], of: fn(&Rung) -> f64, wanted: impl Fn(&str) -> f64) -> String {
    let mut text = head(outcomes);
    for row in rows(outcomes) {
        let _ = write!(text, "| {row} |");
        for outcome in outcomes {
            let rung = |row: &str| least(outcome, row, Task::Trajectory, TARGET, of);
            let cell = match (rung(row), rung(OURS)) {
                (Some(theirs), Some(ours)) if !row.starts_with(OURS) => {
                    let ratio = of(theirs) / of(ours);
                    let verdict = if ratio >= wanted(row) { "met" } else { "**missed**" };
                    format!("{} (× {}, {verdict})", short(1e3 * of(theirs)), short(ratio))
                }
                (Some(rung), _) => short(1e3 * of(rung)),
                (None, _) => "not reached".into(),
            };
            let _ = write!(text, " {cell} |");
        }
        text += "\n";
    }
    text
}

/// `1e-9 / 1e-10 / 1e-11` in every cell.
fn three(outcomes: &[&Outcome], task: Task) -> String {
    let mut text = head(outcomes);
    for row in rows(outcomes) {
        let _ = write!(text, "| {row} |");
        for outcome in outcomes {
            let cells = TARGETS.map(|target| ms(least(outcome, row, task, target, |r| r.seconds), |r| r.seconds));
            let _ = write!(text, " {} |", cells.join(" / "));
        }
        text += "\n";
    }
    text
}

fn settings(outcomes: &[&Outcome]) -> String {
    let mut text = head(outcomes).replace("---:", "---");
    for row in rows(outcomes) {
        let _ = write!(text, "| {row} |");
        for outcome in outcomes {
            let rung = least(outcome, row, Task::Trajectory, TARGET, |r| r.seconds);
            let cell = rung.map_or("–".into(), |r| format!("{}, {:.0e}: {:.0e}", r.method, r.tolerance, r.error));
            let _ = write!(text, " {cell} |");
        }
        text += "\n";
    }
    text
}

/// Milliseconds of set-up (derivation, then compilation and what else comes before the first run) of the fastest setting.
fn set_up(outcomes: &[&Outcome]) -> String {
    let mut text = head(outcomes);
    for row in rows(outcomes) {
        let _ = write!(text, "| {row} |");
        for outcome in outcomes {
            let rung = least(outcome, row, Task::Trajectory, TARGET, |r| r.seconds);
            let cell = rung.map_or("–".into(), |r| match row.starts_with(OURS) {
                true => short(1e3 * (r.total - r.seconds)),
                false => format!("{} + {}", short(1e3 * r.setup), short(1e3 * r.prepare)),
            });
            let _ = write!(text, " {cell} |");
        }
        text += "\n";
    }
    text
}

/// Derivations that end without a motion: SymPy's.
fn derivations(outcomes: &[Outcome]) -> String {
    let mut text =
        String::from("| | SymPy, `LagrangesMethod` | deltaq, derivation and compilation |\n|---|---:|---:|\n");
    for outcome in outcomes.iter().filter(|o| o.problem.entrants.iter().any(|e| e.tool == "sympy")) {
        let seconds = |row: &str| outcome.setups.iter().find(|(name, _)| name == row).map(|(_, seconds)| *seconds);
        let failed = outcome.failures.iter().find(|f| f.row == "SymPy").map(|f| f.words.clone());
        let sympy = seconds("SymPy").map(|s| format!("{} ms", short(1e3 * s)));
        let ours = seconds(OURS).map_or("–".into(), |s| format!("{} ms", short(1e3 * s)));
        let _ = writeln!(text, "| {} | {} | {ours} |", outcome.problem.title, sympy.or(failed).unwrap_or("–".into()));
    }
    text
}

fn count(text: &str) -> (usize, usize) {
    (text.matches(", met)").count(), text.matches("**missed**").count())
}

/// The page.
pub fn page(outcomes: &[Outcome], provenance: &Provenance) -> String {
    let scenes: Vec<&Outcome> = outcomes.iter().filter(|o| o.problem.trailers.is_none()).collect();
    let trailers: Vec<&Outcome> =
        outcomes.iter().filter(|o| o.problem.trailers.is_some() && !o.rungs.is_empty()).collect();
    let solve = table(&scenes, |r| r.seconds, demanded);
    let total = table(&scenes, |r| r.total, |_| TOTAL);
    let ((met, missed), (met_total, missed_total)) = (count(&solve), count(&total));
    let mut page = String::from("# The same problems in other tools\n\n");
    let _ = writeln!(
        page,
        "**Solve time: {met} of {} comparisons meet what was wanted; from scene file to trajectory: {met_total} of {}.**\n",
        met + missed,
        met_total + missed_total
    );
    page += INTRODUCTION;
    let _ = writeln!(
        page,
        "\n## Solve time to an error of {TARGET:.0e}\n\nMilliseconds of one run (times those of ours; wanted: at least 1 for heyoka, 3 for any other).\n"
    );
    page += &solve;
    page += "\nMethod, tolerance and error of these:\n\n";
    page += &settings(&scenes);
    page += "\nTo errors of 1e-9 / 1e-10 / 1e-11:\n\n";
    page += &three(&scenes, Task::Trajectory);
    page += "\nThe same where only the end is wanted, with the error there:\n\n";
    page += &three(&scenes, Task::End);
    page += "\n## Set-up\n\nMilliseconds for the settings above: derivation + compilation.\n\n";
    page += &set_up(&scenes);
    page += "\nThe derivation alone, by the tool that has a class for it (nothing is integrated):\n\n";
    page += &derivations(outcomes);
    let _ = writeln!(
        page,
        "\n## From scene file to trajectory\n\nMilliseconds for derivation, compilation and one run, of the setting for which the sum is least (times those of ours; wanted: at least {TOTAL:.0}).\n"
    );
    page += &total;
    page += "\n## Car with n trailers\n\n";
    if trailers.is_empty() {
        page += "Not timed in this run: `cargo xtask peers --only trailers`.\n";
    } else {
        page += "Milliseconds of one run to an error of 1e-10.\n\n";
        page += &table(&trailers, |r| r.seconds, demanded);
        page += "\nDerivation + compilation, milliseconds:\n\n";
        page += &set_up(&trailers);
        page += "\nMethod, tolerance and error:\n\n";
        page += &settings(&trailers);
    }
    page += "\n## Error over time\n\n";
    for outcome in outcomes.iter().filter(|o| !o.rungs.is_empty()) {
        let _ = writeln!(page, "![{}]({})\n", outcome.problem.title, crate::figures::name(outcome));
    }
    page += "## What did not come off\n\n| problem | who | what | what became of it |\n|---|---|---|---|\n";
    for outcome in outcomes {
        for failure in &outcome.failures {
            let words = failure.words.replace('|', "\\|").replace('\n', " ");
            let _ = writeln!(page, "| {} | {} | {} | {words} |", outcome.problem.title, failure.row, failure.what);
        }
        if let Err(words) = &outcome.reference
            && words != "not timed"
        {
            let _ = writeln!(page, "| {} | all | reference | {words} |", outcome.problem.title);
        }
    }
    page += "\n## Checks\n\n| problem | our DOP853 at 1e-14 from the reference | right-hand sides at the start, largest relative difference from ours |\n|---|---:|---:|\n";
    for outcome in outcomes {
        let Ok(confirmed) = outcome.reference else { continue };
        let apart = outcome.checks.iter().map(|(_, apart)| *apart).fold(0.0, f64::max);
        let _ = writeln!(page, "| {} | {confirmed:.1e} | {apart:.1e} |", outcome.problem.title);
    }
    let _ = writeln!(
        page,
        "\n## How this was made\n\n`cargo xtask peers` on {}, commit {}, in {:.0} s; {}. {} turns of at least {} s for each time that counts, a limit of {} s on \
         each step of each tool, one thread.\n\nDeltaq {}; {}. Licences: {LICENCES}",
        provenance.date,
        provenance.commit,
        provenance.seconds,
        provenance.machine,
        provenance.effort.rounds,
        provenance.effort.repeat,
        provenance.effort.limit,
        env!("CARGO_PKG_VERSION"),
        provenance.versions.join(", ")
    );
    page
}

const LICENCES: &str = "heyoka MPL-2.0; CasADi LGPL-3.0, with SUNDIALS BSD-3-Clause; NumPy, SciPy, SymPy and mpmath BSD-3-Clause; numba and llvmlite \
    BSD-2-Clause. They are run, and nothing of ours is linked with them.";

const INTRODUCTION: &str = "Every tool gets the text of the scene (of the car with trailers the others also equations reduced by hand, ours also a text with a place for every body), derives and compiles in its own way, in the \
    best form that we know for it, and must have our right-hand side at the start to 1e-12, or it is not timed. A trajectory is the coordinates at 21 \
    equidistant times. Its error is the largest of them in the kinetic metric $\\sqrt{\\Delta q^{\\mathsf T} M \\Delta q}$ against heyoka's \
    Taylor method in 113 bits at 1e-28, which our own integration confirms. A time is the least of repeated runs, tools taking turns; a tolerance is \
    relative and absolute alike, and the fastest setting that reaches the error counts. Free constants of the removed-constraint motion are given to all, \
    ours too. Imports and process starts are not counted. Our set-up is measured as part of a whole; for the others the parts are added up.\n\n\
    - **deltaq**: one run of the time loop with projection onto the constraint, dense output everywhere; `solve` is what users call, with a second run at a hundredth of \
    the tolerance as error estimate.\n\
    - **heyoka**: its own differentiation, elimination in expressions, one function a step or compact mode; or closed forms simplified by SymPy, whose time counts as \
    set-up. It compiles anew for every tolerance.\n\
    - **SciPy**: `solve_ivp` (DOP853, LSODA, Radau), SymPy's derivation, straight-line code for the right-hand side as Python or by numba; *compiled whole*: DOP853 with \
    SciPy's tableau, step control and dense output as one numba function.\n\
    - **CasADi**: SX expressions; CVODES (Adams, BDF) with the unknowns eliminated, IDAS with the equations as they stand.\n";
