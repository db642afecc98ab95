//! `cargo xtask peers`: times ours and the peers, writes `reports/peers.md` with its pictures, and everything that was measured as JSON.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Parser;
use peers::{Effort, Provenance, Tools, figures, page, problems, race, serve};
use validation::report::{File, write_all};

/// The same problems in the tools that a researcher would otherwise pick, timed beside ours.
#[derive(Parser)]
struct Arguments {
    /// Few tolerances and few repeats: for a look, not for figures that are kept.
    #[arg(long)]
    quick: bool,
    /// Only problems whose file names contain one of these.
    #[arg(long, value_name = "TEXT,…", value_delimiter = ',')]
    only: Vec<String>,
    /// Folder of the page; `reports` for a full run, the folder of build results for any other.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Answers questions on standard input instead, as the peers do.
    #[arg(long, hide = true)]
    serve: bool,
}

// as in the command
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    if arguments.serve {
        return serve();
    }
    let clock = Instant::now();
    let effort = if arguments.quick { Effort::QUICK } else { Effort::FULL };
    let mut tools = Tools::new()?;
    let versions = tools.versions()?;
    let mut outcomes = Vec::new();
    let wanted = |slug: &str| arguments.only.is_empty() || arguments.only.iter().any(|text| slug.contains(text));
    for problem in problems()?.iter().filter(|problem| wanted(&problem.slug)) {
        let begin = Instant::now();
        let outcome = race(problem, &mut tools, effort).with_context(|| problem.title.clone())?;
        let (rungs, failures) = (outcome.rungs.len(), outcome.failures.len());
        println!("{:<24} {rungs} timed, {failures} failures, {:.0} s", problem.title, begin.elapsed().as_secs_f64());
        outcomes.push(outcome);
    }
    let target = validation::python_environment::target().join("peers");
    let whole = !arguments.quick && arguments.only.is_empty();
    let folder = arguments.out.unwrap_or_else(|| if whole { "reports".into() } else { target.clone() });
    let provenance = Provenance::new(versions, effort, clock.elapsed().as_secs_f64());
    let mut files = vec![File { path: "peers.md".into(), text: page(&outcomes, &provenance) }];
    files.extend(figures(&outcomes)?);
    write_all(&folder, &files)?;
    let json = File { path: "peers.json".into(), text: provenance.json(&outcomes)? };
    write_all(&target, &[json])?;
    println!("{} and {}", folder.join("peers.md").display(), target.join("peers.json").display());
    Ok(())
}
