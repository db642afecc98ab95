//! The main job: every scene in every formulation, and reports.

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::thread::ScopedJoinHandle;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::{CommandFactory, ValueEnum};
use comparison::{Comparison, Fits, compare_unfitted};
use diffsol_methods::EVERY;
use motion::{Settings, choices};
use scene::Scene;
use serde_json::{Value, json};

use crate::cli::{Cli, JobArguments, Section};
use crate::sections::{JOBS, Part, rank};
use bench::{Effort, bench_all, bench_files, bench_headline, references};
use pages::{Headline, scene_files, verdicts};
use program::{Answer, File, TextOrJson, parallel, pretty, write_all, write_own};
use validation::casadi_job::{self, Outcome};
use validation::kept_references;
use validation::report::{CASADI, folder_of, overview, referees_files, summary};

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
    let control = review::substitution::run(&scene, &choices, settings).into_iter().collect();
    compare_unfitted(scene, choices, control, settings).with_context(|| format!("scene `{name}`"))
}

/// Repeats of every way to integrate the ensembles of the main job.
const ENSEMBLE_REPEATS: usize = 2;

fn finished<T>(job: ScopedJoinHandle<'_, T>) -> T {
    job.join().unwrap_or_else(|panic| resume_unwind(panic))
}

/// What the main job computed.
pub(crate) struct Results {
    pub(crate) comparisons: Vec<Comparison>,
    scene_files: Vec<File>,
    parts: Vec<Part>,
    /// Times, which no two machines share.
    measured: Option<Part>,
    /// Why CasADi was asked and did not answer.
    pub(crate) casadi_not_run: Option<String>,
}

impl Results {
    /// What works at the same time shares the threads: so none is idle while a section comes to its end.
    /// Errors are set against run times where `timed`: at every so many powers of ten.
    pub(crate) fn of(sections: &[Section], names: &[&str], timed: Option<usize>, quiet: bool) -> Result<Results> {
        let asked = |section: &Section| sections.contains(section);
        let (scenes, prepared, parts, casadi) = std::thread::scope(|scope| {
            // mostly another process
            let referee = asked(&Section::Casadi).then(|| scope.spawn(|| casadi_job::section(names)));
            let scenes = || parallel::in_turn(rank(&Section::Scenes), || compare_all(names, quiet));
            let scenes = asked(&Section::Scenes).then(|| scope.spawn(scenes));
            let prepared =
                || parallel::in_turn(rank(&Section::ErrorVsTime), || references(names, &kept_references()?, quiet));
            let prepared = (timed.is_some() && asked(&Section::ErrorVsTime)).then(|| scope.spawn(prepared));
            let jobs = JOBS.iter().filter(|(section, ..)| asked(section));
            let jobs: Vec<_> =
                jobs.map(|(section, job)| scope.spawn(|| parallel::in_turn(rank(section), || job(quiet)))).collect();
            let scenes = scenes.map(finished).transpose()?.unwrap_or_default();
            let prepared = prepared.map(finished).transpose()?;
            let mut parts = Vec::new();
            for job in jobs {
                parts.extend(finished(job)?);
            }
            Ok::<_, anyhow::Error>((scenes, prepared, parts, referee.map(finished).transpose()?))
        })?;
        // last, and one after the other: nothing else is to run beside what is timed
        let measured =
            prepared.map(|prepared| Results::measured(prepared, timed.unwrap_or(1), names, quiet)).transpose()?;
        let casadi_not_run = match &casadi {
            Some(Outcome::NotRun(reason)) => Some(reason.to_string()),
            _ => None,
        };
        let mut results = Results { comparisons: Vec::new(), scene_files: Vec::new(), parts, measured, casadi_not_run };
        for report in scenes {
            let name = &report.comparison.scene.name;
            results.scene_files.extend(report.files.into_iter().map(|file| in_its_folder(file, name)));
            results.comparisons.push(report.comparison);
        }
        if let Some(outcome) = &casadi {
            let headline = format!("Independent implementations: {}.", casadi_job::headline(outcome));
            let verdicts = casadi_job::verdict_words(outcome).map(|words| ("casadi", words));
            let files = referees_files(results.comparisons.iter_mut(), outcome)?;
            results.parts.insert(0, Part { page: CASADI, headline, verdicts, files });
        }
        Ok(results)
    }

    fn measured(prepared: Vec<bench::Prepared>, every: usize, names: &[&str], quiet: bool) -> Result<Part> {
        let benches = bench_all(prepared, &Effort::brief(&EVERY, every), quiet)?;
        let mut ensembles = Vec::new();
        if names.contains(&bench::ENSEMBLE_SCENE) {
            ensembles =
                bench::ensemble_throughput(bench::FEW_MEMBERS, Settings::default().tolerance, ENSEMBLE_REPEATS)?;
        }
        let (headline, files) = (bench_headline(&benches), bench_files(&benches, &ensembles)?);
        Ok(Part { page: "error-vs-time.md", headline, verdicts: None, files })
    }

    pub(crate) fn verdicts(&self) -> Value {
        let mut verdicts = json!(verdicts(&self.comparisons, false));
        for (name, words) in self.parts.iter().filter_map(|part| part.verdicts.clone()) {
            verdicts[name] = words;
        }
        verdicts
    }

    /// Pages and pictures of every section that ran, but for those of times.
    pub(crate) fn files(&self) -> Vec<File> {
        self.scene_files.iter().chain(self.parts.iter().flat_map(|part| &part.files)).cloned().collect()
    }

    /// What other programs say is on no page.
    pub(crate) fn leave_out_referees(&mut self) {
        self.parts.retain(|part| part.page != CASADI);
    }

    /// What sections besides the scenes say, and on which page.
    fn further(&self) -> Vec<(&str, &str)> {
        self.parts.iter().map(|part| (&part.headline[..], part.page)).collect()
    }

    /// The page that every other one is reached from, and the page to cite.
    pub(crate) fn overview(&self) -> [File; 2] {
        let (scenes, further) = (&self.comparisons, self.further());
        let pages = [("README.md", overview(scenes, &further)), ("SUMMARY.md", summary(scenes, &further))];
        pages.map(|(path, text)| File { path: path.into(), text })
    }
}

/// A file of a scene in the folder of its page, which says where else to look.
fn in_its_folder(mut file: File, scene: &str) -> File {
    if file.path.extension().is_some_and(|e| e == "md") {
        file.text += &format!("- With sliders, in a browser: [explore](../explore.html#scene={scene})\n");
        file.text += &format!("- Independent implementations: [referees](../{CASADI})\n");
    }
    if let Ok(rest) = file.path.strip_prefix("scenes") {
        file.path = Path::new(folder_of(scene)).join(rest);
    }
    file
}

/// What is said to somebody who starts the program somewhere without saying what to do.
const ELSEWHERE: &str = "say what to do: without a command the main job runs, which writes every report of the project, \
    and this folder does not belong to its sources; --out DIR runs it here";

/// The root of the sources of this program, if the current folder belongs to them.
pub(crate) fn sources() -> Option<PathBuf> {
    let here = std::env::current_dir().unwrap_or_default();
    let is_root = |folder: &&Path| folder.join("crates/scene/scenes").is_dir() && folder.join("validation").is_dir();
    here.ancestors().find(is_root).map(Path::to_owned)
}

/// Runs the main job and returns what to tell the user. Where it fails, nothing is written.
pub(crate) fn run(arguments: &JobArguments, quiet: bool) -> Result<String> {
    let clock = Instant::now();
    // an answer for machines is one object
    let quiet = quiet || arguments.format == TextOrJson::Json;
    let out = match &arguments.out {
        Some(folder) => folder.clone(),
        None if sources().is_some() => "reports".into(),
        None => bail!("{ELSEWHERE}\n\n{}", Cli::command().render_help()),
    };
    let known: Vec<&str> = scene::catalogue::SCENES.iter().map(|(name, _)| *name).collect();
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
    // pages that are kept have every power of ten
    let every = if arguments.measured.is_some() { 1 } else { 3 };
    let mut results = Results::of(sections, &names, Some(every), quiet)?;
    results.comparisons.iter().try_for_each(Comparison::is_sound)?;
    let mut files = results.files();
    if complete {
        files.extend(results.overview());
        let text = pretty("verdicts", &results.verdicts());
        files.push(File { path: "verdicts.json".into(), text });
    }
    // folders that nobody named are the project's own
    let write = |named: &Option<PathBuf>| if named.is_some() { write_all } else { write_own };
    write(&arguments.out)(&out, &files)?;
    let folder = match &arguments.measured {
        Some(folder) => folder.clone(),
        None if sources().is_some() => "target/measured".into(),
        None => out.join("measured"),
    };
    let mut measured = results.measured.take();
    if let Some(part) = &mut measured {
        let pages = part.files.iter_mut().filter(|file| file.path.extension().is_some_and(|e| e == "md"));
        pages.for_each(|page| page.text += &(thinned(every) + &provenance(clock.elapsed().as_secs_f64())));
        write(&arguments.measured)(&folder, &part.files)?;
    }
    let untold = if quiet { &results.comparisons[..] } else { &[] };
    let scenes = untold.iter().map(first_sentence);
    let pages = results.further().into_iter().map(|(line, page)| (page.to_owned(), line.to_owned()));
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

/// Of what, and the first sentence of its answer.
fn first_sentence(comparison: &Comparison) -> (String, String) {
    let answer = Headline::of(comparison).verdict;
    (comparison.scene.name.clone(), answer.split_inclusive(". ").next().unwrap_or_default().to_owned())
}

fn told(of: &str, line: &str) -> String {
    format!("{of:<24} {line}\n")
}

/// Compares all scenes on all processors; results are in the order of `names`. Unless `quiet`, each answer is
/// printed at once, before fits.
fn compare_all(names: &[&str], quiet: bool) -> Result<Vec<SceneReport>> {
    let settings = Settings::protocol();
    let bar = parallel::progress(2 * names.len(), quiet);
    let found = parallel::map(names, |name| {
        bar.set_message(name.to_string());
        let comparison = compared(scene::catalogue::find(name, &[])?, &settings)?;
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

/// Version and commit of the program, the machine, and how long the job took until then.
/// What is said of tolerances that were left out.
fn thinned(every: usize) -> String {
    if every == 1 {
        return String::new();
    }
    "\nMeasured at every third power of ten as tolerance; `--measured FOLDER` takes every one.\n".into()
}

fn provenance(seconds: f64) -> String {
    let describe = || Command::new("git").args(["describe", "--always", "--dirty"]).output().ok();
    let commit = sources()
        .is_some()
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
