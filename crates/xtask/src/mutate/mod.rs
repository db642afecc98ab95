//! Do the tests notice when a sign or a term of a derivation is wrong? `cargo xtask mutate` tries.
//!
//! Ready-made tools mutate the operators of Rust. Ours stand in method calls on an expression graph, so the mutations are
//! our own: see [`finder`].

mod bench;
mod explained;
mod finder;
#[cfg(test)]
mod finder_tests;
mod results;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use clap::Parser;

use bench::Bench;
use finder::Mutant;
use results::{Outcome, Results, Verdict};

/// What the chore is for, in one line.
pub(crate) const ABOUT: &str = "do the tests notice a wrong sign or a missing term in a derivation? (long)";

/// Where the copy of the workspace, its build and the verdicts stand.
const FOLDER: &str = "target/mutate";

#[derive(Parser)]
#[command(
    name = "cargo xtask mutate",
    about = "Make derivations wrong, one place at a time, and see whether tests notice"
)]
struct Options {
    /// Only this crate
    #[arg(long = "crate", value_name = "NAME")]
    package: Option<String>,
    /// Only the mutant with this number in the list, also if it has a verdict
    #[arg(long, value_name = "N")]
    only: Option<usize>,
    /// Show the mutants with their numbers, and run none
    #[arg(long)]
    list: bool,
    /// Copies of the workspace that are built and tested at a time
    #[arg(long, value_name = "N", default_value_t = 1)]
    jobs: usize,
}

/// The chore with its arguments, from the root of the workspace.
pub(crate) fn run(arguments: &[&str]) -> ExitCode {
    let options = match Options::try_parse_from(["cargo xtask mutate"].iter().chain(arguments)) {
        Ok(options) => options,
        Err(error) => {
            print!("{error}");
            return if error.use_stderr() { ExitCode::FAILURE } else { ExitCode::SUCCESS };
        }
    };
    match mutate(&options) {
        Ok(Ending::Fine) => ExitCode::SUCCESS,
        Ok(Ending::Found) => ExitCode::FAILURE,
        Err(error) => {
            println!("mutate stopped: {error:#}");
            ExitCode::FAILURE
        }
    }
}

enum Ending {
    Fine,
    /// Survivors without a reason, or reasons without a survivor.
    Found,
}

/// A mutant, its number in the list, its crate and the source that it changes.
struct Task {
    number: usize,
    package: String,
    source: String,
    mutant: Mutant,
}

fn mutate(options: &Options) -> Result<Ending> {
    ensure!(options.jobs > 0, "`--jobs` must be at least 1");
    let tasks = tasks(options.package.as_deref())?;
    if options.list {
        for task in &tasks {
            println!("{}", line(task));
        }
        return Ok(Ending::Fine);
    }
    let explanations = std::fs::read_to_string(explained::FILE).context(explained::FILE)?;
    let explanations = explained::parse(&explanations)?;
    if let Some(only) = options.only {
        ensure!((1..=tasks.len()).contains(&only), "there are mutants 1 to {}, and none is {only}", tasks.len());
    }
    let folder = std::env::current_dir()?.join(FOLDER);
    std::fs::create_dir_all(&folder).with_context(|| FOLDER.to_owned())?;
    let results = Results::read(&folder.join("results.json"))?;
    let (outcomes, complete) = run_all(options, &tasks, results, &folder)?;
    table(&tasks, &outcomes);

    let verdicts: Vec<(&Mutant, Option<Verdict>)> = tasks
        .iter()
        .zip(&outcomes)
        .map(|(task, outcome)| (&task.mutant, outcome.as_ref().map(|o| o.verdict)))
        .collect();
    let judged = explained::judge(&verdicts, &explanations);
    println!("\n{} survivors are explained in {}", judged.explained.len(), explained::FILE);
    for (mutant, explanation) in &judged.explained {
        println!("   {}:{} {}: {}", mutant.file, mutant.line, mutant.what, explanation.reason);
    }
    println!("\n{} survivors are not explained", judged.unexplained.len());
    for mutant in &judged.unexplained {
        println!("   {}", place(mutant));
    }
    for (fault, explanations) in [("stale", &judged.stale), ("of several places, needs a `context`", &judged.ambiguous)]
    {
        for e in explanations {
            println!("\n{fault}: in {}, `{}` -> `{}` of {}", explained::FILE, e.original, e.replacement, e.file);
        }
    }
    if !complete {
        bail!("not every mutant was run");
    }
    let sound = judged.unexplained.is_empty() && judged.stale.is_empty() && judged.ambiguous.is_empty();
    Ok(if sound { Ending::Fine } else { Ending::Found })
}

/// Runs what has no verdict yet. An outcome for each task, and whether none failed to run.
fn run_all(options: &Options, tasks: &[Task], results: Results, folder: &Path) -> Result<(Vec<Option<Outcome>>, bool)> {
    let mut benches = Vec::new();
    for number in 1..=options.jobs {
        println!("── copy {number} of the workspace: built and tested as it is");
        benches.push(Bench::prepare(folder, number)?);
    }
    let sources = benches.iter().map(|bench| bench.sources).next().unwrap_or_default();
    let known = |task: &Task| results.get(&task.mutant, &task.source, sources);
    let mut outcomes: Vec<Option<Outcome>> = tasks.iter().map(known).collect();
    let chosen = |at: usize| options.only.map_or(outcomes[at].is_none(), |only| tasks[at].number == only);
    let mut queue: Vec<usize> = (0..tasks.len()).filter(|at| chosen(*at)).collect();
    println!("── {} mutants, {} to run", tasks.len(), queue.len());
    queue.reverse();

    let start = Instant::now();
    let shared = Mutex::new((queue, results, Vec::new()));
    let work = |bench: &Bench| -> Result<()> {
        let next = || shared.lock().ok()?.0.pop();
        while let Some(at) = next() {
            let task = &tasks[at];
            let outcome = bench.judge(&task.mutant, &task.source)?;
            println!("{:<8} {:>5.1} s  {}  {}", outcome.verdict.name(), outcome.seconds, line(task), outcome.note);
            let Ok(mut shared) = shared.lock() else { bail!("another job has panicked") };
            shared.1.add(&task.mutant, &task.source, sources, &outcome)?;
            shared.2.push((at, outcome));
        }
        Ok(())
    };
    let mut complete = true;
    std::thread::scope(|scope| {
        let jobs: Vec<_> = benches.iter().map(|bench| scope.spawn(|| work(bench))).collect();
        for job in jobs {
            match job.join() {
                Ok(Ok(())) => {}
                Ok(Err(error)) => {
                    println!("a job stopped: {error:#}");
                    complete = false;
                }
                Err(_) => complete = false,
            }
        }
    });
    let Ok((_, _, fresh)) = shared.into_inner() else { bail!("a job has panicked") };
    println!("── {} mutants run in {:.0} s", fresh.len(), start.elapsed().as_secs_f64());
    for (at, outcome) in fresh {
        outcomes[at] = Some(outcome);
    }
    Ok((outcomes, complete))
}

/// Every mutant of the formulations, or of one crate.
fn tasks(package: Option<&str>) -> Result<Vec<Task>> {
    let formulations = formulations()?;
    if let Some(name) = package {
        let names: Vec<&str> = formulations.keys().map(String::as_str).collect();
        ensure!(formulations.contains_key(name), "no formulation is called `{name}`: there are {}", names.join(", "));
    }
    let mut tasks = Vec::new();
    for (name, folder) in formulations.into_iter().filter(|(name, _)| package.is_none_or(|only| only == name)) {
        for path in rust_files(&folder)? {
            let file = path.to_str().context("a file name is not UTF-8")?.replace('\\', "/");
            let source = std::fs::read_to_string(&path).with_context(|| file.clone())?;
            for mutant in finder::find(&file, &source)? {
                let number = tasks.len() + 1;
                tasks.push(Task { number, package: name.clone(), source: source.clone(), mutant });
            }
        }
    }
    Ok(tasks)
}

/// Crates that hold a formulation, by name: the folders of their sources.
fn formulations() -> Result<BTreeMap<String, PathBuf>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir("crates").context("crates")? {
        let entry = entry?;
        let folder = Path::new("crates").join(entry.file_name()).join("src");
        let front = std::fs::read_to_string(folder.join("lib.rs")).unwrap_or_default();
        if front.lines().any(|line| line.starts_with("pub const FORMULATION: Formulation")) {
            found.insert(entry.file_name().to_string_lossy().into_owned(), folder);
        }
    }
    Ok(found)
}

fn rust_files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(rust_files(&path)?);
        } else if path.extension().is_some_and(|end| end == "rs") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn line(task: &Task) -> String {
    format!("{:>3} {}", task.number, place(&task.mutant))
}

fn place(mutant: &Mutant) -> String {
    let Mutant { file, line, function, what, original, replacement, .. } = mutant;
    format!("{file}:{line} {function}, {what}: `{original}` -> `{replacement}`")
}

/// How many of each crate ended how.
fn table(tasks: &[Task], outcomes: &[Option<Outcome>]) {
    let mut rows: BTreeMap<&str, BTreeMap<Option<Verdict>, usize>> = BTreeMap::new();
    let (mut run, mut seconds) = (0.0, 0.0);
    for (task, outcome) in tasks.iter().zip(outcomes) {
        *rows.entry(&task.package).or_default().entry(outcome.as_ref().map(|o| o.verdict)).or_default() += 1;
        if let Some(outcome) = outcome {
            run += 1.0;
            seconds += outcome.seconds;
        }
    }
    println!(
        "\n{:<20} {:>7} {:>8} {:>8} {:>8} {:>8} {:>7}",
        "crate", "mutants", "killed", "survived", "unviable", "timeout", "not run"
    );
    for (package, counts) in rows {
        let of = |verdict| counts.get(&verdict).copied().unwrap_or(0);
        let [killed, survived, unviable, timeout] = Verdict::ALL.map(|verdict| of(Some(verdict)));
        let all: usize = counts.values().sum();
        println!("{package:<20} {all:>7} {killed:>8} {survived:>8} {unviable:>8} {timeout:>8} {:>7}", of(None));
    }
    if run > 0.0 {
        println!("{:.1} s a mutant", seconds / run);
    }
}
