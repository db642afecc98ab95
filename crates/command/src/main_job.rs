//! The main job: every scene in every formulation, reports; and the check that committed reports still hold.

use std::panic::resume_unwind;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::thread::ScopedJoinHandle;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::{CommandFactory, ValueEnum};
use deltaq::{Comparison, Fits, Settings, choices, compare_unfitted};
use scene::{Number, Scene};
use serde_json::{Value, json};

use crate::answer::{Answer, pretty};
use crate::cli::{Cli, JobArguments, ReportsArguments, Section, TextOrJson};
use random::{Batch, Kind, parallel, substitution};
use validation::bench::{self, Bench, Effort};
use validation::casadi_job::{self, Outcome};
use validation::report::{
    AuditReport, BicycleReport, EquivalenceReport, File, Headline, LiteratureReport, RealizationReport,
    StabilityReport, bench_files, bench_headline, bodies, difference_of_verdicts, overview, pictures, random_files,
    random_headline, random_verdicts, referees_section, scene_page, verdicts, write_all, write_own,
};

/// A compared scene with its page and pictures.
pub struct SceneReport {
    /// What was found.
    pub comparison: Comparison,
    /// Page and pictures.
    pub files: Vec<File>,
}

/// Compares all formulations of a scene, the control among them; nothing is fitted.
fn compared(scene: Scene, settings: &Settings) -> Result<Comparison> {
    let name = scene.name.clone();
    let choices = choices(&scene);
    let control = substitution::run(&scene, &choices, settings).into_iter().collect();
    compare_unfitted(scene, choices, control, settings).with_context(|| format!("scene `{name}`"))
}

/// The page of a scene and its pictures.
pub(crate) fn scene_files(comparison: &mut Comparison) -> Result<Vec<File>> {
    let name = comparison.scene.name.clone();
    let moving = bodies(comparison).with_context(|| format!("bodies of scene `{name}`"))?;
    let still = pictures(comparison).with_context(|| format!("pictures of scene `{name}`"))?;
    let mut files: Vec<File> = moving.into_iter().chain(still).collect();
    files.push(File { path: format!("scenes/{name}.md").into(), text: scene_page(comparison, &files)? });
    Ok(files)
}

/// Random systems of the main job.
const RANDOM_SYSTEMS: u64 = 1_000;

/// Tolerance of the ensembles of the main job, and repeats of every way to integrate them.
const ENSEMBLE_TOLERANCE: f64 = 1e-10;
const ENSEMBLE_REPEATS: usize = 2;

/// What a section besides the scenes has to say.
struct Part {
    page: &'static str,
    headline: String,
    /// For machines, under a name.
    verdicts: Option<(&'static str, Value)>,
    /// Its page and its pictures.
    files: Vec<File>,
}

/// What the main job computed.
struct Results {
    comparisons: Vec<Comparison>,
    scene_files: Vec<File>,
    parts: Vec<Part>,
    /// Times, which no two machines share.
    measured: Option<Part>,
}

impl Results {
    fn of(sections: &[Section], names: &[&str], quiet: bool) -> Result<Results> {
        // the referee is mostly another process: it works beside what follows, up to where times are measured
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
        let asked = |section| sections.contains(&section);
        let mut scenes = if asked(Section::Scenes) { compare_all(names, quiet)? } else { Vec::new() };
        let mut parts = Vec::new();
        if asked(Section::Random) {
            let batch = Batch { seed: 1, kinds: Kind::ALL.to_vec() };
            let records = batch.run(0..RANDOM_SYSTEMS, None, quiet)?;
            let verdicts = Some(("random", random_verdicts(&batch, &records)));
            let (headline, files) = (random_headline(&records), random_files(&batch, &records)?);
            parts.push(Part { page: "random.md", headline, verdicts, files });
        }
        if asked(Section::Realization) {
            let report = RealizationReport::new(quiet)?;
            let (headline, verdicts) = (report.headline(), Some(("realization", report.verdicts())));
            parts.push(Part { page: "realization.md", headline, verdicts, files: report.files()? });
        }
        if asked(Section::PaperAudit) {
            let report = AuditReport::new()?;
            let (headline, verdicts) = (report.headline(), Some(("paper audit", report.verdicts())));
            parts.push(Part { page: "paper-audit.md", headline, verdicts, files: report.files() });
        }
        if asked(Section::Equivalence) {
            let report = EquivalenceReport::new(quiet)?;
            let (headline, verdicts) = (report.headline(), Some(("equivalence", report.verdicts())));
            parts.push(Part { page: "equivalence.md", headline, verdicts, files: report.files() });
            let report = LiteratureReport::new(quiet)?;
            let (headline, verdicts) = (report.headline(), Some(("literature", report.verdicts())));
            parts.push(Part { page: "literature.md", headline, verdicts, files: report.files() });
        }
        if asked(Section::Bicycle) {
            let report = BicycleReport::new()?;
            let (headline, verdicts) = (report.headline(), Some(("bicycle", report.verdicts())));
            parts.push(Part { page: "bicycle.md", headline, verdicts, files: report.files()? });
        }
        if asked(Section::Stability) {
            let report = StabilityReport::new(|_| true, quiet)?;
            let (headline, verdicts) = (report.headline(), Some(("stability", report.verdicts())));
            parts.push(Part { page: "stability.md", headline, verdicts, files: report.files()? });
        }
        let finished = |referee: ScopedJoinHandle<'_, _>| referee.join().unwrap_or_else(|panic| resume_unwind(panic));
        let casadi = referee.map(finished).transpose()?;
        if let Some(outcome) = &casadi {
            let headline = casadi_job::headline(outcome);
            let headline = format!("Referees that share no derivation with this program: {headline}.");
            let verdicts = casadi_job::verdict_words(outcome).map(|words| ("casadi", words));
            parts.insert(0, Part { page: "scenes/sledge.md#referees", headline, verdicts, files: Vec::new() });
        }
        let mut scene_files = Vec::new();
        for report in &mut scenes {
            let section = referees_section(&mut report.comparison, casadi.as_ref())?;
            if let Some(page) = report.files.iter_mut().find(|f| f.path.extension().is_some_and(|e| e == "md")) {
                page.text += &section;
                let name = &report.comparison.scene.name;
                page.text += &format!("\nWith sliders, in a browser: [this scene](../explore.html#scene={name}).\n");
                if asked(Section::ErrorVsTime) {
                    page.text += "\nWhich method reaches which error in which time: [error against run time](../measured/error-vs-time.md).\n";
                }
            }
            scene_files.extend(report.files.clone());
        }
        // last, and one after the other: nothing else is to run beside what is timed
        let mut measured = None;
        if asked(Section::ErrorVsTime) {
            let benches = bench_all(names, &[], &Effort::brief(), quiet)?;
            let mut ensembles = Vec::new();
            if names.contains(&bench::ENSEMBLE_SCENE) {
                ensembles = bench::ensemble_throughput(bench::FEW_MEMBERS, ENSEMBLE_TOLERANCE, ENSEMBLE_REPEATS)?;
            }
            let (headline, files) = (bench_headline(&benches), bench_files(&benches, &ensembles)?);
            measured = Some(Part { page: "error-vs-time.md", headline, verdicts: None, files });
        }
        let comparisons = scenes.into_iter().map(|report| report.comparison).collect();
        Ok(Results { comparisons, scene_files, parts, measured })
    }

    fn verdicts(&self) -> Value {
        let mut verdicts = verdicts(&self.comparisons);
        for (name, words) in self.parts.iter().filter_map(|part| part.verdicts.clone()) {
            verdicts[name] = words;
        }
        verdicts
    }

    /// Pages and pictures of every section that ran, but for those of times.
    fn files(&self) -> Vec<File> {
        self.scene_files.iter().chain(self.parts.iter().flat_map(|part| &part.files)).cloned().collect()
    }
}

/// What is said to somebody who starts the program somewhere without saying what to do.
const ELSEWHERE: &str = "say what to do: without a command the main job runs, which writes every report of the project, \
    and this folder does not belong to its sources; --out DIR runs it here";

/// Whether the current folder belongs to the sources of this program.
fn in_the_sources() -> bool {
    let here = std::env::current_dir().unwrap_or_default();
    here.ancestors()
        .any(|folder| folder.join("crates/catalogue/scenes").is_dir() && folder.join("crates/command").is_dir())
}

/// Runs the main job and returns what to tell the user. Where it fails, nothing is written.
pub(crate) fn run(arguments: &JobArguments, quiet: bool) -> Result<String> {
    let clock = Instant::now();
    // an answer for machines is one object
    let quiet = quiet || arguments.format == TextOrJson::Json;
    let out = match &arguments.out {
        Some(folder) => folder.clone(),
        None if in_the_sources() => "reports".into(),
        None => bail!("{ELSEWHERE}\n\n{}", Cli::command().render_help()),
    };
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
    let results = Results::of(sections, &names, quiet)?;
    results.comparisons.iter().try_for_each(Comparison::is_sound)?;
    let mut files = results.files();
    let further: Vec<(&str, &str)> = results.parts.iter().map(|part| (&part.headline[..], part.page)).collect();
    if complete {
        let text = overview(&results.comparisons, &further);
        files.push(File { path: "README.md".into(), text });
        let text = pretty("verdicts", &results.verdicts());
        files.push(File { path: "verdicts.json".into(), text });
    }
    // folders that nobody named are the project's own
    let write = |named: &Option<PathBuf>| if named.is_some() { write_all } else { write_own };
    write(&arguments.out)(&out, &files)?;
    let folder = match &arguments.measured {
        Some(folder) => folder.clone(),
        None if in_the_sources() => "target/measured".into(),
        None => out.join("measured"),
    };
    let mut measured = results.measured;
    if let Some(part) = &mut measured {
        let pages = part.files.iter_mut().filter(|file| file.path.extension().is_some_and(|e| e == "md"));
        pages.for_each(|page| page.text += &provenance(clock.elapsed().as_secs_f64()));
        write(&arguments.measured)(&folder, &part.files)?;
    }
    let untold = if quiet { &results.comparisons[..] } else { &[] };
    let scenes = untold.iter().map(first_sentence);
    let pages = further.into_iter().map(|(line, page)| (page.to_owned(), line.to_owned()));
    let measured = measured.map(|part| (folder.join(part.page).display().to_string(), part.headline));
    let answers: Vec<(String, String)> = scenes.chain(pages).chain(measured).collect();
    let (count, seconds) = (files.len(), clock.elapsed().as_secs_f64());
    Ok(match arguments.format {
        TextOrJson::Text => {
            let lines: String = answers.iter().map(|(of, line)| told(of, line)).collect();
            lines + &format!("\n{count} files in {} after {seconds:.1} s\n", out.display())
        }
        TextOrJson::Json => {
            let answers: Vec<Value> =
                answers.iter().map(|(of, answer)| json!({ "of": of, "answer": answer })).collect();
            pretty("job", &json!({ "answers": answers, "files": count, "folder": out, "seconds": seconds }))
        }
    })
}

/// Computes the verdicts again and compares them with the committed ones.
pub(crate) fn check(arguments: &ReportsArguments) -> Result<String> {
    const MEND: &str = "`cargo run --release` writes the reports anew";
    let path = arguments.out.join("verdicts.json");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}; {MEND}", path.display()))?;
    let mut old: Value = serde_json::from_str(&text).with_context(|| format!("{}; {MEND}", path.display()))?;
    let names: Vec<&str> = catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    let sections: Vec<Section> =
        Section::value_variants().iter().copied().filter(|s| *s != Section::ErrorVsTime).collect();
    let results = Results::of(&sections, &names, true)?;
    for file in results.files() {
        let path = arguments.out.join(&file.path);
        if !path.exists() {
            bail!("{} is missing; {MEND}", path.display());
        }
    }
    let mut new: Value = serde_json::from_str(&pretty("verdicts", &results.verdicts()))?;
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

/// Of what, and the first sentence of its answer.
fn first_sentence(comparison: &Comparison) -> (String, String) {
    let answer = Headline::of(comparison).verdict;
    (comparison.scene.name.clone(), answer.split_inclusive(". ").next().unwrap_or_default().to_owned())
}

fn told(of: &str, line: &str) -> String {
    format!("{of:<24} {line}\n")
}

/// All scenes, over all processors, in the order of `names`; answers are told at once, before fits, unless
/// `quiet`.
fn compare_all(names: &[&str], quiet: bool) -> Result<Vec<SceneReport>> {
    let settings = protocol();
    let bar = parallel::progress(2 * names.len(), quiet);
    let found = parallel::map(names, |name| {
        bar.set_message(name.to_string());
        let comparison = compared(catalogue::find(name, &[])?, &settings)?;
        if !quiet {
            let (of, line) = first_sentence(&comparison);
            bar.suspend(|| Answer::from(told(&of, &line)).print())?;
        }
        bar.inc(1);
        Ok(Mutex::new(comparison))
    });
    let found = found.into_iter().collect::<Result<Vec<_>>>()?;
    let files = parallel::map(&found, |comparison| {
        let mut comparison = comparison.lock().unwrap_or_else(PoisonError::into_inner);
        bar.set_message(format!("{}, fits", comparison.scene.name));
        let name = comparison.scene.name.clone();
        comparison.fit(Fits::All, &settings).with_context(|| format!("scene `{name}`"))?;
        let files = scene_files(&mut comparison);
        bar.inc(1);
        files
    });
    bar.finish_and_clear();
    let whole = |(comparison, files): (Mutex<Comparison>, _)| {
        let comparison = comparison.into_inner().unwrap_or_else(PoisonError::into_inner);
        Ok(SceneReport { comparison, files: files? })
    };
    found.into_iter().zip(files).map(whole).collect()
}

/// References of all scenes over all processors, then measurements one after the other.
pub(crate) fn bench_all(
    names: &[&str],
    overrides: &[(String, Number)],
    effort: &Effort,
    quiet: bool,
) -> Result<Vec<Bench>> {
    let prepared = parallel::try_map(names, quiet, |_| "references".into(), |name| bench::prepare(name, overrides))?;
    let bar = parallel::progress(names.len(), quiet);
    let benches = prepared.into_iter().map(|prepared| {
        let measured = bench::measure(prepared, effort, |words| bar.set_message(words.to_string()));
        bar.inc(1);
        measured
    });
    let benches = benches.collect();
    bar.finish_and_clear();
    benches
}

/// Version and commit of the program, the machine, and how long the job took until then.
fn provenance(seconds: f64) -> String {
    let describe = || Command::new("git").args(["describe", "--always", "--dirty"]).output().ok();
    let commit = in_the_sources()
        .then(describe)
        .flatten()
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
