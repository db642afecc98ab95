//! Scenes on the command line, and what only reads or shows them.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use equations::Formulation;
use scene::{Number, Scene};

use program::TextOrJson;
use scene::catalogue::NotFound;

/// A scene with changes.
#[derive(Args, Debug)]
pub struct SceneArguments {
    /// Built-in name (`n-trailer-5` for a car with 5 trailers), scene file path, or `-` for standard input.
    pub scene: String,
    #[command(flatten)]
    pub set: Overrides,
}

impl SceneArguments {
    pub(crate) fn find(&self) -> Result<Scene, NotFound> {
        scene::catalogue::find(&self.scene, &self.set.overrides)
    }
}

/// What is changed in a scene.
#[derive(Args, Debug)]
pub struct Overrides {
    /// Replace a parameter (`g=1.6`), a start value (`x=pi/3`, `x'=2`) or `duration`.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    pub overrides: Vec<(String, Number)>,
}

impl Overrides {
    /// Names, and numbers as they were written.
    pub(crate) fn written(&self) -> Vec<(String, String)> {
        self.overrides.iter().map(|(name, x)| (name.clone(), x.to_string())).collect()
    }
}

/// `deltaq new`.
#[derive(Args, Debug)]
pub struct NewArguments {
    /// File to write; to standard output if left out or `-`. What deltaq did not write is not replaced, nor
    /// is a scene.
    pub file: Option<PathBuf>,
    /// Built-in scene to begin with, instead of the template.
    #[arg(long, value_name = "SCENE")]
    pub from: Option<String>,
    /// The JSON schema of scene files, for editors, instead of the template.
    #[arg(long, conflicts_with_all = ["from", "bodies"])]
    pub schema: bool,
    /// A robot from bodies, instead of the template.
    #[arg(long, conflicts_with = "from")]
    pub bodies: bool,
}

/// `deltaq check`.
#[derive(Args, Debug)]
pub struct CheckArguments {
    /// Scene files, `-` for standard input, or built-in names.
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<String>,
    #[command(flatten)]
    pub set: Overrides,
    /// Treat notes as faults: exit code 2.
    #[arg(long)]
    pub strict: bool,
}

/// `deltaq show`.
#[derive(Args, Debug)]
pub struct ShowArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Formulations and forms to show, by name; all if left out, and of equations over 30 kB the size only.
    #[arg(short, long, value_name = "NAME,…", value_delimiter = ',', value_parser = motion::formulation)]
    pub formulation: Vec<&'static Formulation>,
    /// Formulas in LaTeX.
    #[arg(long)]
    pub latex: bool,
    /// The text of the scene file, and nothing else.
    #[arg(long, conflicts_with_all = ["latex", "format", "overrides"])]
    pub source: bool,
    /// The scene of formulas that a scene of bodies means, and nothing else.
    #[arg(long, conflicts_with_all = ["latex", "source", "format"])]
    pub formulas: bool,
    /// The equations as a source file in a language, and nothing else; by default those of Chetaev.
    #[arg(long, value_enum, value_name = "LANGUAGE", conflicts_with_all = ["latex", "source", "format"])]
    pub code: Option<CodeLanguage>,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}

/// Languages that equations are written in.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeLanguage {
    /// C99: functions without allocation.
    C,
    /// Python: functions of arrays of NumPy.
    Numpy,
    /// Python: matrices of SymPy.
    Sympy,
}

impl From<CodeLanguage> for motion::Language {
    fn from(language: CodeLanguage) -> Self {
        match language {
            CodeLanguage::C => motion::Language::C,
            CodeLanguage::Numpy => motion::Language::Numpy,
            CodeLanguage::Sympy => motion::Language::Sympy,
        }
    }
}

/// `NAME=VALUE`.
pub(super) fn assignment(text: &str) -> Result<(String, Number), String> {
    let (name, value) = text.split_once('=').ok_or_else(|| format!("`{text}` is not NAME=VALUE"))?;
    let number = value.parse().map_err(|error| format!("`{value}` in `{text}`: {error}"))?;
    Ok((name.trim().to_string(), number))
}
