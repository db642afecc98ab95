//! From the text of a scene to the scene.

use std::cell::RefCell;
use std::io::Read;
use std::path::Path;

use mechanics::{State, View};
use symbolic::work_on;
use toml::de::DeTable;

use super::context::Context;
use super::overrides::Overrides;
use super::section::{Entry, Section, Source};
use super::{constants, film, formulas, machine, redundant, removal, review, start, system, view};
use crate::{Meant, Number, Scene, SceneError, SceneErrorKind, format};

/// Size of the largest scene file that is read, in bytes.
pub const SIZE_LIMIT: u64 = 1 << 20;

impl Scene {
    /// Reads a scene from text. `name` is its name and stands for the file in errors.
    ///
    /// # Errors
    /// [`SceneError`] with the place of the first fault and what is expected there. No text makes it panic.
    ///
    /// ```
    /// let text = r#"
    /// title = "Particle on a twisted plane field"
    /// [coordinates]
    /// x = { start = 0 }
    /// y = { start = -1 }
    /// z = { start = 0 }
    /// [system]
    /// lagrangian = "(x'^2 + y'^2 + z'^2)/2"
    /// constraints = ["z' - y*x'"]
    /// [start.velocities]
    /// "x'" = 1.0
    /// "y'" = 0.5
    /// [run]
    /// duration = 6
    /// "#;
    /// let scene = scene::Scene::parse("particle", text)?;
    /// assert_eq!(scene.start.v, [1.0, 0.5, -1.0]);
    /// assert_eq!(scene.completion.supplied, ["z'"]);
    ///
    /// let error = scene::Scene::parse("particle", &text.replace("y*x'", "w*x'")).unwrap_err();
    /// assert!(error.to_string().starts_with("particle:9:22: undefined name `w`"), "{error}");
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    pub fn parse(name: &str, text: &str) -> Result<Scene, SceneError> {
        Scene::parse_with::<f64>(name, text, &[])
    }

    /// Like [`Scene::parse`], with numbers ([`Number`], `f64`) that override those of the text before
    /// anything is evaluated: a parameter (`g`), the start of a coordinate (`x`), a start velocity (`x'`) or
    /// rate, `time`, `duration`, or a multiplier (`mu0_1`, `mu0_2`, … in the order of the constraints).
    /// Parameters and coordinates of these names come first; the last override of a name counts.
    ///
    /// # Errors
    /// As [`Scene::parse`]; a fault of an override has line 0.
    pub fn parse_with<N: Clone + Into<Number>>(
        name: &str,
        text: &str,
        overrides: &[(String, N)],
    ) -> Result<Scene, SceneError> {
        load(name, name, text, overrides)
    }

    /// [`Scene::parse_with`], and what a reviewer would ask about the scene, each with its place: names that
    /// nothing uses, masses below zero, moments that no body has, weights with the wrong sign, forces that
    /// drive whichever way the system moves, constraints that contradict the picture. `file` as in errors.
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn remarks<N: Clone + Into<Number>>(
        file: &str,
        text: &str,
        overrides: &[(String, N)],
    ) -> Result<(Scene, Vec<SceneError>), SceneError> {
        loaded(&name_of(file), file, text, overrides, review::remarks)
    }

    /// Reads a scene file of at most [`SIZE_LIMIT`] bytes.
    ///
    /// # Errors
    /// As [`Scene::parse`]; [`SceneErrorKind`]s `Unreadable`, `TooLarge` and `NotUtf8`.
    pub fn load(path: &Path) -> Result<Scene, SceneError> {
        Scene::load_with::<f64>(path, &[])
    }

    /// [`Scene::load`] with overrides as in [`Scene::parse_with`].
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn load_with<N: Clone + Into<Number>>(path: &Path, overrides: &[(String, N)]) -> Result<Scene, SceneError> {
        Scene::parse_file(path, &Scene::read(path)?, overrides)
    }

    /// The text of a scene file.
    ///
    /// # Errors
    /// [`SceneErrorKind::Unreadable`], [`SceneErrorKind::TooLarge`] and [`SceneErrorKind::NotUtf8`].
    pub fn read(path: &Path) -> Result<String, SceneError> {
        let file = &path.display().to_string();
        let handle = std::fs::File::open(path).map_err(|error| unreadable(file, error))?;
        let size = handle.metadata().map_err(|error| unreadable(file, error))?.len();
        if size > SIZE_LIMIT {
            return Err(too_large(file, size));
        }
        // what is no regular file has no size beforehand
        Scene::read_from(file, handle)
    }

    /// The text that comes in; `file` stands for it in errors.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn read_from(file: &str, input: impl Read) -> Result<String, SceneError> {
        let mut bytes = Vec::new();
        input.take(SIZE_LIMIT + 1).read_to_end(&mut bytes).map_err(|error| unreadable(file, error))?;
        if bytes.len() as u64 > SIZE_LIMIT {
            return Err(too_large(file, bytes.len() as u64));
        }
        String::from_utf8(bytes).map_err(|error| {
            let offset = error.utf8_error().valid_up_to();
            let byte = error.as_bytes()[offset];
            let text = String::from_utf8_lossy(error.as_bytes());
            SceneError::at(file, &text, offset..offset + 1, SceneErrorKind::NotUtf8 { byte, offset })
        })
    }

    /// [`Scene::load_with`] for who has read the file already.
    ///
    /// # Errors
    /// As [`Scene::parse_with`].
    pub fn parse_file<N: Clone + Into<Number>>(
        path: &Path,
        text: &str,
        overrides: &[(String, N)],
    ) -> Result<Scene, SceneError> {
        let file = path.display().to_string();
        load(&name_of(&file), &file, text, overrides)
    }
}

fn load<N: Clone + Into<Number>>(
    name: &str,
    file: &str,
    text: &str,
    overrides: &[(String, N)],
) -> Result<Scene, SceneError> {
    loaded(name, file, text, overrides, |_, _, _| ()).map(|(scene, ())| scene)
}

/// What the scene of a file is called.
fn name_of(file: &str) -> String {
    Path::new(file).file_stem().map_or_else(|| file.into(), |stem| stem.to_string_lossy().into_owned())
}

/// The scene, and what `look` sees in it while it is read.
fn loaded<N: Clone + Into<Number>, T>(
    name: &str,
    file: &str,
    text: &str,
    overrides: &[(String, N)],
    look: impl FnOnce(&Context, &View, &State) -> T,
) -> Result<(Scene, T), SceneError> {
    work_on(format!("scene {name}, digest {:016x}", digest(text, overrides)));
    let faults = RefCell::default();
    let source = Source { file, text, faults: &faults };
    let scene = Overrides::new(source, overrides).and_then(|overrides| read(name, source, overrides, look));
    let mut faults = faults.into_inner();
    let scene = scene.map_err(|fault| faults.push(fault));
    match (scene, SceneError::together(faults)) {
        (Ok(scene), None) => Ok(scene),
        (_, Some(error)) => Err(error),
        (Err(()), None) => unreachable!("what is not a scene has a fault"),
    }
}

/// By which a scene is known again (FNV-1a, 64 bits).
fn digest<N: Clone + Into<Number>>(text: &str, overrides: &[(String, N)]) -> u64 {
    let number = |x: &N| Into::<Number>::into(x.clone()).to_string();
    let given = overrides.iter().map(|(name, x)| format!("{name}={}\n", number(x))).collect::<String>();
    let bytes = text.bytes().chain(given.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |digest, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Looks at as much as can be looked at: faults that leave the rest readable are noted.
fn read<T>(
    name: &str,
    source: Source,
    overrides: Overrides,
    look: impl FnOnce(&Context, &View, &State) -> T,
) -> Result<(Scene, T), SceneError> {
    let Source { file, text, .. } = source;
    let size = text.len() as u64;
    if size > SIZE_LIMIT {
        return Err(too_large(file, size));
    }
    let table = DeTable::parse(text).map_err(|error| {
        let kind = SceneErrorKind::Syntax { message: error.message().trim().replace('\n', "; ") };
        source.error(&error.span().unwrap_or(0..0), kind)
    })?;
    if table.get_ref().is_empty() {
        return Err(source.error(&(0..0), SceneErrorKind::Empty));
    }
    let root = Section::root(source, table.get_ref());
    // what a newer format means is not guessed
    root.get(format::SCENE[0].name).map_or(Ok(()), |format| format.check_format())?;
    root.check_keys(format::SCENE);
    let follows = machine::read(source, &root)?;
    let has_bodies = follows.is_some();
    let table = match &follows {
        Some(follows) => &formulas::with(table.get_ref(), &follows.made),
        None => table.get_ref(),
    };
    let root = Section::root(source, table);
    let text = |key| source.note(root.text_or_empty(key)).unwrap_or_default();
    let (origin, notes) = (text("source"), text("notes"));
    let title = source.note(root.require("title", "a string").and_then(|title| title.text("a string")));
    let run = root.require("run", "a table with the duration").and_then(|run| run.section());
    let run = source.note(run);
    let mut context = system::build(source, root, overrides, follows.unwrap_or_default())?;
    let duration = run.and_then(|run| {
        run.check_keys(format::RUN);
        if let Some(times) = run.get("breakpoints").and_then(|entry| source.note(breakpoints(&entry))) {
            context.system.breakpoints = times;
        }
        source.note(duration(&context, &run))
    });
    let view = source.note(view::read(&context)).unwrap_or_default();
    let film = source.note(film::read(&context)).unwrap_or_default();
    if !faults_so_far(source) {
        source.note(redundant::leave_out(&mut context));
    }
    // constraints that could not be read would be missed
    let multipliers =
        if faults_so_far(source) { Some(Vec::new()) } else { source.note(constants::multipliers(&context)) };
    source.no_fault()?;
    start::check_positions(&context)?;
    let removals = removal::read_all(&context)?;
    let (state, completion) = start::complete(&context, &removals)?;
    source.note(view::check(&context, &view, &state));
    context.overrides.check_used(source)?;
    let (Some(title), Some(duration), Some(multipliers)) = (title, duration, multipliers) else {
        unreachable!("what could not be read was noted")
    };
    source.no_fault()?;
    let seen = look(&context, &view, &state);
    let meant = has_bodies.then(|| Meant {
        formulas: formulas::written(table, &context.found),
        constraints: context.found.says,
        slips: context.found.slips,
        left_out: context.found.left_out,
    });
    let scene = Scene {
        name: name.into(),
        title: title.text,
        source: origin,
        notes,
        system: context.system,
        start: state,
        completion,
        removals,
        multipliers,
        duration,
        film,
        view,
        meant,
    };
    Ok((scene, seen))
}

fn faults_so_far(source: Source) -> bool {
    !source.faults.borrow().is_empty()
}

fn breakpoints(entry: &Entry) -> Result<Vec<f64>, SceneError> {
    entry.elements("a list of times")?.iter().map(Entry::number).collect()
}

fn duration(context: &Context, run: &Section) -> Result<f64, SceneError> {
    let entry = run.require("duration", "a positive number")?;
    let given = context.constant(&entry)?;
    let out_of_range = |value| SceneErrorKind::OutOfRange { what: "the duration", value, limit: 0.0 };
    match context.overrides.get("duration") {
        Some(value) if value > 0.0 => Ok(value),
        Some(value) => Err(SceneError::outside(context.source.file, out_of_range(value))),
        None if given > 0.0 => Ok(given),
        None => Err(entry.error(out_of_range(given))),
    }
}

fn unreadable(file: &str, error: std::io::Error) -> SceneError {
    SceneError::outside(file, SceneErrorKind::Unreadable { reason: error.kind() })
}

fn too_large(file: &str, size: u64) -> SceneError {
    SceneError::outside(file, SceneErrorKind::TooLarge { size, limit: SIZE_LIMIT })
}
