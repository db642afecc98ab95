//! `deltaq compare`: formulations of the user's scenes, compared.

use anyhow::{Context, Result, ensure};
use comparison::{Comparison, Extent, Fits};
use console::Term;
use motion::{Settings, choices_among};
use scene::Scene;

use crate::cli::CompareArguments;
use crate::solve_command::limited;
use crate::sweep_command;
use crate::watch::Watch;
use pages::scene_files;
use pages::{summary, verdicts};
use program::TextOrJson;
use program::write_all;
use program::{print, typed};

/// Prints a summary of each scene as soon as it is compared; or returns pages or verdicts, or writes pages
/// and pictures to a folder and says so. Nothing is computed before every scene has been read.
pub(crate) fn run(arguments: &CompareArguments, quiet: bool) -> Result<String> {
    if !arguments.sweep.is_empty() {
        return sweep_command::run(arguments, quiet);
    }
    let settings = limited(Settings { tolerance: arguments.tolerance, ..Settings::protocol() }, &arguments.limits)?;
    let mut scenes: Vec<Scene> = Vec::new();
    for name in &arguments.scenes {
        let scene = scene::catalogue::find(name, &arguments.set.overrides)?;
        let names = std::iter::once(scene.name.clone()).chain((2..).map(|i| format!("{}-{i}", scene.name)));
        let name = { names }.find(|name| scenes.iter().all(|other| other.name != *name)).unwrap_or_default();
        scenes.push(Scene { name, ..scene });
    }
    let width = usize::from(Term::stdout().size_checked().map_or(80, |(_, columns)| columns));
    let as_json = arguments.output.format == TextOrJson::Json;
    let as_pages = arguments.output.out.is_some() || arguments.markdown;
    let watch = Watch::begin(quiet)?;
    let (mut files, mut all, mut before) = (Vec::new(), verdicts(&[], true), String::new());
    let mut sound = Ok(());
    for scene in scenes {
        let mut answer = |comparison: &mut Comparison| -> Result<String> {
            if as_json {
                all.scenes.extend(verdicts(std::slice::from_ref(comparison), true).scenes);
                return typed(&all);
            }
            Ok(before.clone() + &summary(comparison, width)?)
        };
        let name = scene.name.clone();
        let mut comparison = compared(scene, arguments, &settings, |doing, comparison| {
            watch.tell(&format!("{name}: {doing}"), answer(comparison)?);
            Ok(())
        })
        .with_context(|| format!("scene `{name}`"))?;
        let text = answer(&mut comparison)?;
        sound = sound.and_then(|()| comparison.is_sound());
        if as_pages {
            watch.tell(&format!("{name}: page and pictures"), text.clone());
            files.extend(scene_files(&mut comparison)?);
        }
        if as_json || as_pages {
            before = text + "\n";
        } else if !watch.suspended(|| print(&text))? {
            break;
        }
    }
    watch.end();
    if let Some(folder) = &arguments.output.out {
        write_all(folder, &files)?;
    }
    let pages = files.iter().filter(|file| file.path.extension().is_some_and(|e| e == "md"));
    let text = match &arguments.output.out {
        _ if as_json => typed(&all)?,
        Some(folder) => format!("{} files in {}\n", files.len(), folder.display()),
        None => pages.map(|page| page.text.clone() + "\n").collect(),
    };
    if sound.is_err() {
        print(&text)?;
    }
    sound?;
    Ok(text)
}

/// Compares a scene, and tells what is done next and what there is so far.
fn compared(
    scene: Scene,
    arguments: &CompareArguments,
    settings: &Settings,
    mut tell: impl FnMut(&str, &mut Comparison) -> Result<()>,
) -> Result<Comparison> {
    let only = &arguments.formulation;
    let choices = choices_among(&scene, |own| only.is_empty() || only.contains(&own));
    ensure!(
        !choices.is_empty(),
        "{} needs a parameter that the scene does not have",
        only.iter().map(|own| own.name).collect::<Vec<_>>().join(", ")
    );
    // the control judges the harness, which is for pages and machines
    let wanted = arguments.output.format == TextOrJson::Json || arguments.output.out.is_some() || arguments.markdown;
    let control = if wanted && only.is_empty() { review::substitution::run(&scene, &choices, settings) } else { None };
    let extent = if wanted { Extent::Everything } else { Extent::Answer };
    let mut comparison = Comparison::new(scene, extent, settings)?;
    for choice in choices {
        tell(&choice.label, &mut comparison)?;
        comparison.solve(choice, settings)?;
    }
    control.into_iter().try_for_each(|run| comparison.add(run))?;
    while let Some((family, curve)) = comparison.undecided() {
        let label = |i: usize| &comparison.runs[i].choice.label;
        let doing = format!("is {} in the family of {}?", label(curve), label(family));
        tell(&doing, &mut comparison)?;
        comparison.decide_next();
    }
    if arguments.fits() != Fits::None {
        tell("fits of free constants", &mut comparison)?;
    }
    comparison.fit(arguments.fits(), settings)?;
    Ok(comparison)
}
