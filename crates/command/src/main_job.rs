//! The main job: every scene in every formulation, reports written; and the check that committed reports are still true.

use std::fmt::Write;
use std::panic::resume_unwind;
use std::process::Command;
use std::thread::ScopedJoinHandle;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use deltaq::{Comparison, Settings, choices, compare};
use scene::Scene;
use serde_json::Value;

use crate::cli::{JobArguments, ReportsArguments, Section};
use random::{Batch, Kind, Record};
use random::{parallel, substitution};
use validation::bench::{self, Bench, Effort, Throughput};
use validation::casadi_job::{self, Outcome};
use validation::catalogue;
use validation::report::{
    AuditReport, File, RealizationReport, StabilityReport, answer, bench_files, bench_headline, difference_of_verdicts,
    overview, pictures, random_files, random_headline, random_verdicts, referees_section, scene_page, verdicts,
    write_all,
};

/// A compared scene with its page and pictures.
pub struct SceneReport {
    /// What was found.
    pub comparison: Comparison,
    /// Page and pictures.
    pub files: Vec<File>,
}

/// Compares all formulations of a scene, the control among them, and writes its page and pictures.
///
/// # Errors
/// Where the scene cannot be compared.
pub fn scene_files(scene: Scene, settings: &Settings) -> Result<SceneReport> {
    let name = scene.name.clone();
    let choices = choices(&scene);
    let control = substitution::run(&scene, &choices, settings).into_iter().collect();
    let mut comparison = compare(scene, choices, control, settings).with_context(|| format!("scene `{name}`"))?;
    let mut files = pictures(&mut comparison).with_context(|| format!("pictures of scene `{name}`"))?;
    let links: Vec<String> =
        files.iter().filter_map(|f| Some(f.path.file_name()?.to_string_lossy().into_owned())).collect();
    let page = scene_page(&mut comparison, &links)?;
    files.push(File { path: format!("scenes/{name}.md").into(), text: page });
    Ok(SceneReport { comparison, files })
}

/// Random systems of the main job.
const RANDOM_SYSTEMS: u64 = 1_000;

/// Tolerance of the ensembles of the main job, and repeats of every way to integrate them.
const ENSEMBLE_TOLERANCE: f64 = 1e-10;
const ENSEMBLE_REPEATS: usize = 2;

/// What the main job computed.
struct Results {
    comparisons: Vec<Comparison>,
    scene_files: Vec<File>,
    casadi: Option<Outcome>,
    batch: Batch,
    records: Vec<Record>,
    realization: Option<RealizationReport>,
    audit: Option<AuditReport>,
    benches: Vec<Bench>,
    ensembles: Vec<Throughput>,
    stability: Option<StabilityReport>,
}

impl Results {
    fn of(sections: &[Section], names: &[&str], quiet: bool) -> Result<Results> {
        // the referee is another process for most of its time: it works beside what follows, up to where times are measured
        std::thread::scope(|scope| {
            let asked = sections.contains(&Section::Casadi);
            let referee = asked.then(|| scope.spawn(|| casadi_job::section(names)));
            Results::beside(referee, sections, names, quiet)
        })
    }

    fn beside(
        referee: Option<ScopedJoinHandle<'_, Result<Outcome>>>,
        sections: &[Section],
        names: &[&str],
        quiet: bool,
    ) -> Result<Results> {
        let mut scenes = if sections.contains(&Section::Scenes) { compare_all(names, quiet)? } else { Vec::new() };
        let batch = Batch { seed: 1, kinds: Kind::ALL.to_vec() };
        let random = sections.contains(&Section::Random);
        let records = if random { batch.run(RANDOM_SYSTEMS, None, quiet)? } else { Vec::new() };
        let realization =
            sections.contains(&Section::Realization).then(|| RealizationReport::new(quiet)).transpose()?;
        let audit = sections.contains(&Section::PaperAudit).then(AuditReport::new).transpose()?;
        let stability = sections.contains(&Section::Stability).then(|| StabilityReport::new(quiet)).transpose()?;
        let finished = |referee: ScopedJoinHandle<'_, _>| referee.join().unwrap_or_else(|panic| resume_unwind(panic));
        let casadi = referee.map(finished).transpose()?;
        let mut scene_files = Vec::new();
        for report in &mut scenes {
            let section = referees_section(&mut report.comparison, casadi.as_ref())?;
            if let Some(page) = report.files.iter_mut().find(|f| f.path.extension().is_some_and(|e| e == "md")) {
                page.text += &section;
                if sections.contains(&Section::ErrorVsTime) {
                    page.text += "\nWhich method reaches which error in which time: [error against run time](../measured/error-vs-time.md).\n";
                }
            }
            scene_files.extend(report.files.clone());
        }
        // last, and one after the other: nothing else is to run beside what is timed
        let (mut benches, mut ensembles) = (Vec::new(), Vec::new());
        if sections.contains(&Section::ErrorVsTime) {
            benches = bench_all(names, &[], &Effort::brief(), quiet)?;
            if names.contains(&bench::ENSEMBLE_SCENE) {
                ensembles = bench::ensemble_throughput(bench::FEW_MEMBERS, ENSEMBLE_TOLERANCE, ENSEMBLE_REPEATS)?;
            }
        }
        let comparisons = scenes.into_iter().map(|report| report.comparison).collect();
        Ok(Results {
            comparisons,
            scene_files,
            casadi,
            batch,
            records,
            realization,
            audit,
            stability,
            benches,
            ensembles,
        })
    }

    fn verdicts(&self) -> Value {
        let mut verdicts = verdicts(&self.comparisons);
        verdicts["random"] = random_verdicts(&self.batch, &self.records);
        if let Some(realization) = &self.realization {
            verdicts["realization"] = realization.verdicts();
        }
        if let Some(audit) = &self.audit {
            verdicts["paper audit"] = audit.verdicts();
        }
        if let Some(stability) = &self.stability {
            verdicts["stability"] = stability.verdicts();
        }
        if let Some(words) = self.casadi.as_ref().and_then(casadi_job::verdict_words) {
            verdicts["casadi"] = words;
        }
        verdicts
    }

    /// What the other sections say in a line, each with its page.
    fn further(&self) -> Vec<(String, &'static str)> {
        let casadi = self.casadi.as_ref().map(|outcome| {
            let line =
                format!("Referees that share no derivation with this program: {}.", casadi_job::headline(outcome));
            (line, "scenes/sledge.md#referees")
        });
        let random = (!self.records.is_empty()).then(|| (random_headline(&self.records), "random.md"));
        let realization = self.realization.as_ref().map(|report| (report.headline(), "realization.md"));
        let audit = self.audit.as_ref().map(|report| (report.headline(), "paper-audit.md"));
        let stability = self.stability.as_ref().map(|report| (report.headline(), "stability.md"));
        casadi.into_iter().chain(random).chain(realization).chain(audit).chain(stability).collect()
    }

    /// Pages and pictures of every section that ran.
    fn files(&self) -> Result<Vec<File>> {
        let mut files = self.scene_files.clone();
        if !self.records.is_empty() {
            files.extend(random_files(&self.batch, &self.records)?);
        }
        if let Some(realization) = &self.realization {
            files.extend(realization.files()?);
        }
        files.extend(self.audit.iter().flat_map(AuditReport::files));
        if let Some(stability) = &self.stability {
            files.extend(stability.files()?);
        }
        Ok(files)
    }

    /// Pages and pictures of times, which no two machines share, with what says whose they are.
    fn measured(&self, provenance: &str) -> Result<Vec<File>> {
        if self.benches.is_empty() {
            return Ok(Vec::new());
        }
        let mut files = bench_files(&self.benches, &self.ensembles)?;
        for page in files.iter_mut().filter(|file| file.path.extension().is_some_and(|e| e == "md")) {
            page.text += provenance;
        }
        Ok(files)
    }
}

/// Runs the main job and returns what to tell the user.
///
/// # Errors
/// Where a scene is unknown or cannot be compared, or a report cannot be written. Nothing is written then.
pub fn run(arguments: &JobArguments) -> Result<String> {
    let clock = Instant::now();
    let known: Vec<&str> = catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    if let Some(unknown) = arguments.scenes.iter().find(|s| !known.contains(&s.as_str())) {
        bail!("unknown scene `{unknown}`; known: {}", known.join(", "));
    }
    let all_scenes = arguments.scenes.is_empty();
    let sections = match (&arguments.sections[..], all_scenes) {
        ([], true) => Section::value_variants(),
        ([], false) => &[Section::Scenes],
        (some, _) => some,
    };
    let sections: Vec<Section> = sections.iter().copied().filter(|s| !arguments.without.contains(s)).collect();
    let sections = &sections[..];
    let complete = all_scenes && Section::value_variants().iter().all(|s| sections.contains(s));
    let names: Vec<&str> =
        known.into_iter().filter(|n| all_scenes || arguments.scenes.iter().any(|s| s == n)).collect();
    let results = Results::of(sections, &names, arguments.quiet)?;
    let mut files = results.files()?;
    if complete {
        let text = overview(&results.comparisons, &results.further());
        files.push(File { path: "README.md".into(), text });
        let text = serde_json::to_string_pretty(&results.verdicts())? + "\n";
        files.push(File { path: "verdicts.json".into(), text });
    }
    write_all(&arguments.out, &files)?;
    let measured = results.measured(&provenance(clock.elapsed().as_secs_f64()))?;
    write_all(&arguments.measured, &measured)?;
    let mut told = String::new();
    for comparison in &results.comparisons {
        let answer = answer(comparison);
        let first = answer.split_inclusive(". ").next().unwrap_or_default();
        let _ = writeln!(told, "{:<24} {first}", comparison.scene.name);
    }
    for (line, page) in results.further() {
        let _ = writeln!(told, "{page:<24} {line}");
    }
    if !measured.is_empty() {
        let page = arguments.measured.join("error-vs-time.md");
        let _ = writeln!(told, "{:<24} {}", page.display(), bench_headline(&results.benches));
    }
    let seconds = clock.elapsed().as_secs_f64();
    let _ = writeln!(told, "\n{} files in {} after {seconds:.1} s", files.len(), arguments.out.display());
    Ok(told)
}

/// Computes the verdicts again and compares them with the committed ones.
///
/// # Errors
/// Where they differ, with the place and the command that mends it.
pub fn check(arguments: &ReportsArguments) -> Result<String> {
    const MEND: &str = "`cargo run --release` writes the reports anew";
    let path = arguments.out.join("verdicts.json");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}; {MEND}", path.display()))?;
    let mut old: Value = serde_json::from_str(&text).with_context(|| format!("{}; {MEND}", path.display()))?;
    let names: Vec<&str> = catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    let sections: Vec<Section> =
        Section::value_variants().iter().copied().filter(|s| *s != Section::ErrorVsTime).collect();
    let results = Results::of(&sections, &names, true)?;
    for file in results.files()? {
        let path = arguments.out.join(&file.path);
        if !path.exists() {
            bail!("{} is missing; {MEND}", path.display());
        }
    }
    let mut new = results.verdicts();
    // the referee is not everywhere: its verdicts are compared where there are two to compare
    if old.get("casadi").is_none() || new.get("casadi").is_none() {
        for verdicts in [&mut old, &mut new] {
            verdicts.as_object_mut().and_then(|all| all.remove("casadi"));
        }
    }
    if let Some(difference) = difference_of_verdicts(&old, &new) {
        bail!("{} is out of date at {difference}; {MEND}", path.display());
    }
    Ok(format!("{} agrees with a fresh run\n", path.display()))
}

/// How motions that are compared are integrated.
pub(crate) fn protocol() -> Settings {
    // twice what any motion of the catalogue takes that does not run into a singularity
    const MAX_STEPS: usize = 200_000;
    Settings { max_steps: MAX_STEPS, ..Settings::default() }
}

/// All scenes, over all processors, in the order of `names`.
fn compare_all(names: &[&str], quiet: bool) -> Result<Vec<SceneReport>> {
    let bar = parallel::progress(names.len(), quiet);
    let settings = protocol();
    let results = parallel::map(names, |name| {
        bar.set_message(name.to_string());
        let scene = catalogue::find(name, &[]).map_err(anyhow::Error::from);
        let result = scene.and_then(|scene| scene_files(scene, &settings));
        bar.inc(1);
        result
    });
    bar.finish_and_clear();
    results.into_iter().collect()
}

/// References of all scenes over all processors, then measurements one after the other.
///
/// # Errors
/// Where a scene cannot be read.
pub fn bench_all(names: &[&str], overrides: &[(String, f64)], effort: &Effort, quiet: bool) -> Result<Vec<Bench>> {
    let bar = parallel::progress(2 * names.len(), quiet);
    bar.set_message("references");
    let prepared = parallel::map(names, |name| {
        let prepared = bench::prepare(name, overrides);
        bar.inc(1);
        prepared
    });
    let benches = prepared.into_iter().map(|prepared| {
        let measured = bench::measure(prepared?, effort, |words| bar.set_message(words.to_string()));
        bar.inc(1);
        measured
    });
    let benches = benches.collect();
    bar.finish_and_clear();
    benches
}

/// Version and commit of the program, the machine, and how long the job took until then.
fn provenance(seconds: f64) -> String {
    let commit = Command::new("git")
        .args(["describe", "--always", "--dirty"])
        .output()
        .ok()
        .filter(|output| output.status.success())
        .map(|output| String::from_utf8_lossy(&output.stdout).trim().to_string());
    let commit = commit.map_or(String::new(), |c| format!(" at commit {c}"));
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let (system, architecture) = (std::env::consts::OS, std::env::consts::ARCH);
    format!(
        "\ndeltaq {}{commit}, {system} on {architecture}, {processors} processors, {seconds:.0} s for everything.\n",
        env!("CARGO_PKG_VERSION")
    )
}
