//! Scenes: a system, its start and its hand-written parametrizations as data, one TOML file each.
//!
//! ```toml
//! title = "Ice sledge on an incline"
//!
//! [parameters]
//! g = 9.81
//! alpha = 0.4
//! k = 0.7
//!
//! [coordinates]
//! x   = { unit = "m", start = 0 }
//! y   = { unit = "m", start = 0 }
//! phi = { unit = "rad", start = 0.3 }
//!
//! [system]
//! lagrangian  = "(x'^2 + y'^2)/2 + k^2*phi'^2/2 + g*x*sin(alpha)"
//! constraints = ["y'*cos(phi) - x'*sin(phi)"]
//!
//! [start.velocities]
//! "phi'" = 1.1
//! "x'"   = "0.5*cos(phi)"
//!
//! [removal.arc-length]
//! parameters = ["u", "phi"]
//! rates = { x = "u'*cos(phi)", y = "u'*sin(phi)" }
//! constants = { horizon = 10 }
//!
//! [run]
//! duration = 10
//! ```

use std::fmt;
use std::io::Read;
use std::path::Path;

use crate::{Completion, Removal, SceneError, SceneErrorKind, State, System};

mod constants;
mod loader;
mod names;
mod overrides;
mod removal;
mod section;
mod start;
mod system;
mod write;

/// Size of the largest scene file that is read, in bytes.
pub const SIZE_LIMIT: u64 = 1 << 20;

/// A system together with a consistent start and everything else a scene file says.
#[derive(Clone)]
pub struct Scene {
    /// Name by which the scene is called: that of the file, without its ending.
    pub name: String,
    /// One line.
    pub title: String,
    /// Where the example is from, empty if the file does not say.
    pub source: String,
    /// Remarks, empty if there are none.
    pub notes: String,
    /// `L`, `f`, `Q`, coordinates and parameters.
    pub system: System,
    /// `(t₀, q₀, v₀)` with `f(q₀, v₀, t₀) = 0`.
    pub start: State,
    /// How the start velocities came about.
    pub completion: Completion,
    /// Hand-written parametrizations, verified, in the order of the file.
    pub removals: Vec<Removal>,
    /// `μ₀`, length h; zero where the file does not say.
    pub multipliers: Vec<f64>,
    /// Length of the run, in units of `t`; positive.
    pub duration: f64,
}

impl Scene {
    /// Reads a scene from text. `name` is its name and stands for the file in errors.
    ///
    /// # Errors
    /// [`SceneError`] with the place of the first fault and what was expected there. Nothing panics, whatever the text.
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
    /// let scene = mechanics::Scene::parse("particle", text)?;
    /// assert_eq!(scene.start.v, [1.0, 0.5, -1.0]);
    /// assert_eq!(scene.completion.supplied, ["z'"]);
    ///
    /// let error = mechanics::Scene::parse("particle", &text.replace("y*x'", "w*x'")).unwrap_err();
    /// assert!(error.to_string().starts_with("particle:9:22: undefined name `w`"), "{error}");
    /// # Ok::<(), mechanics::SceneError>(())
    /// ```
    pub fn parse(name: &str, text: &str) -> Result<Scene, SceneError> {
        Scene::parse_with(name, text, &[])
    }

    /// Like [`Scene::parse`], with numbers that override those of the text before anything is evaluated: a parameter
    /// (`g`), the start of a coordinate (`x`), a start velocity (`x'`) or rate, `time`, `duration`, or a
    /// multiplier (`mu1`, `mu2`, … in the order of the constraints). Parameters and coordinates of these names come first; the last
    /// override of a name counts.
    ///
    /// # Errors
    /// As [`Scene::parse`]; a fault of an override has line 0.
    pub fn parse_with(name: &str, text: &str, overrides: &[(String, f64)]) -> Result<Scene, SceneError> {
        loader::load(name, name, text, overrides)
    }

    /// Reads a scene file of at most [`SIZE_LIMIT`] bytes.
    ///
    /// # Errors
    /// As [`Scene::parse`]; also [`SceneErrorKind::Unreadable`], [`SceneErrorKind::TooLarge`] and [`SceneErrorKind::NotUtf8`].
    pub fn load(path: &Path) -> Result<Scene, SceneError> {
        Scene::load_with(path, &[])
    }

    /// [`Scene::load`] with overrides as in [`Scene::parse_with`].
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn load_with(path: &Path, overrides: &[(String, f64)]) -> Result<Scene, SceneError> {
        Scene::parse_file(path, &Scene::read(path)?, overrides)
    }

    /// The text of a scene file.
    ///
    /// # Errors
    /// [`SceneErrorKind::Unreadable`], [`SceneErrorKind::TooLarge`] and [`SceneErrorKind::NotUtf8`].
    pub fn read(path: &Path) -> Result<String, SceneError> {
        read(&path.display().to_string(), path)
    }

    /// [`Scene::load_with`] for who has read the file already.
    ///
    /// # Errors
    /// As [`Scene::parse_with`].
    pub fn parse_file(path: &Path, text: &str, overrides: &[(String, f64)]) -> Result<Scene, SceneError> {
        let file = path.display().to_string();
        let name = path.file_stem().map_or_else(|| file.clone(), |stem| stem.to_string_lossy().into_owned());
        loader::load(&name, &file, text, overrides)
    }

    /// The scene as a file, with every start value as a number: [`Scene::parse`] of it gives the same system, start and
    /// removals.
    pub fn to_toml(&self) -> String {
        write::scene(self)
    }
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene").field("name", &self.name).field("text", &self.to_toml()).finish()
    }
}

/// The text of a file, its size checked before it is read.
fn read(file: &str, path: &Path) -> Result<String, SceneError> {
    let unreadable = |e: std::io::Error| SceneError::outside(file, SceneErrorKind::Unreadable { reason: e.kind() });
    let too_large = |size| SceneError::outside(file, SceneErrorKind::TooLarge { size, limit: SIZE_LIMIT });
    let handle = std::fs::File::open(path).map_err(unreadable)?;
    let size = handle.metadata().map_err(unreadable)?.len();
    if size > SIZE_LIMIT {
        return Err(too_large(size));
    }
    // What is no regular file has no size beforehand.
    let mut bytes = Vec::new();
    handle.take(SIZE_LIMIT + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > SIZE_LIMIT {
        return Err(too_large(bytes.len() as u64));
    }
    String::from_utf8(bytes).map_err(|error| {
        let offset = error.utf8_error().valid_up_to();
        let byte = error.as_bytes()[offset];
        let text = String::from_utf8_lossy(error.as_bytes());
        SceneError::at(file, &text, offset..offset + 1, SceneErrorKind::NotUtf8 { byte, offset })
    })
}
