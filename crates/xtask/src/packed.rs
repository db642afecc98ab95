//! What is given away, as somebody gets it who has no repository: the program and the library from packed
//! crates, the Python module from its source distribution and from the wheel that this becomes.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, ensure};

use crate::tools::{Outcome, cargo, output_of, outside, succeed, target};
use crate::{dependencies, python};

/// What the example of the readme prints of the disc.
const SAID: &str = "Chetaev: x(2) = 1.405317";

/// What is asked of the Python module.
const ASKED: &str = "import deltaq; print(deltaq.built_in('sledge').compare().verdict('chetaev', 'vakonomic'))";

/// Packs everything and uses it in an empty folder: an index that has just these crates stands in for the one
/// of the world. Third parties come from where cargo and pip get them.
pub(crate) fn used() -> Result<Outcome> {
    python::empty(target()?.join("package"))?;
    dependencies::package()?;
    let folder = &python::empty(std::env::temp_dir().join(format!("deltaq-packed-{}", std::process::id())))?;
    let mut told = String::new();
    let (packages, size) = unpacked(folder)?;
    let _ = write!(told, ", {packages} crates of {:.1} MB", size as f64 / 1e6);
    let readme = fs::read_to_string(folder.join("deltaq/README.md"))?;
    let [scene, example] = ["toml", "rust"].map(|language| block(&readme, language));
    fs::write(folder.join("disc-on-slope.toml"), scene.context("the readme shows no scene")?)?;
    let mut timed = |what: &str, work: &mut dyn FnMut() -> Result<PathBuf>| -> Result<()> {
        let clock = Instant::now();
        let made = work()?;
        let size = fs::metadata(&made).with_context(|| made.display().to_string())?.len();
        let _ = write!(told, "; {what}: {:.0} s, {:.1} MB", clock.elapsed().as_secs_f64(), size as f64 / 1e6);
        Ok(())
    };
    let build = || {
        let mut cargo = cargo();
        cargo.current_dir(folder).env("CARGO_TARGET_DIR", folder.join("target"));
        cargo
    };
    timed("program", &mut || {
        succeed(build().args(["install", "--quiet", "--path", "deltaq", "--root", "installed"]))?;
        let program = folder.join("installed/bin").join(format!("deltaq{}", std::env::consts::EXE_SUFFIX));
        let answer = output_of(outside(&program).args(["compare", "disc-on-slope.toml"]).current_dir(folder))?;
        ensure!(answer.starts_with("disc-on-slope: Different"), "{answer}");
        Ok(program)
    })?;
    timed("library, beside it", &mut || {
        succeed(build().args(["init", "--quiet", "--vcs", "none", "own"]))?;
        let own = folder.join("own");
        // by its folder: only an index finds a name
        succeed(build().args(["add", "--quiet", "--path", "../deltaq"]).current_dir(&own))?;
        fs::write(own.join("src/main.rs"), example.context("the readme shows no example")?)?;
        succeed(build().args(["build", "--quiet", "--release"]).current_dir(&own))?;
        let program = folder.join("target/release").join(format!("own{}", std::env::consts::EXE_SUFFIX));
        let answer = output_of(outside(&program).current_dir(folder))?;
        ensure!(answer.contains(SAID), "{answer}");
        Ok(program)
    })?;
    let environment = folder.join("environment");
    let fresh = environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    timed("source distribution", &mut || python::source_distribution(folder).and_then(|_| only(folder, "gz")))?;
    timed("module from it", &mut || {
        let distribution = only(folder, "gz")?;
        succeed(outside(python::interpreter()?.0).args(["-m", "venv"]).arg(&environment))?;
        let mut pip = outside(&fresh);
        pip.args(["-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-deps"]).arg(distribution);
        succeed(pip.current_dir(folder))?;
        only(folder, "whl")
    })?;
    timed("module from the wheel", &mut || {
        let wheel = only(folder, "whl")?;
        let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
        succeed(outside(&fresh).args(pip).arg(&wheel).current_dir(folder))?;
        let answer = output_of(outside(&fresh).args(["-c", ASKED]).current_dir(folder))?;
        ensure!(answer.trim() == "different", "{answer}");
        Ok(wheel)
    })?;
    fs::remove_dir_all(folder)?;
    Ok(Outcome::Passed(told))
}

/// Unpacks what was packed, each package in a folder of its name, and tells cargo that the index has these:
/// how many, and their size in bytes.
fn unpacked(folder: &Path) -> Result<(usize, u64)> {
    let (mut count, mut size, mut index) = (0, 0, String::from("[patch.crates-io]\n"));
    let ending = format!("-{}.crate", env!("CARGO_PKG_VERSION"));
    for file in fs::read_dir(target()?.join("package"))? {
        let file = file?;
        let name = file.file_name().to_string_lossy().into_owned();
        let Some(package) = name.strip_suffix(&ending) else { continue };
        succeed(outside("tar").arg("-xzf").arg(file.path()).arg("-C").arg(folder))?;
        fs::rename(folder.join(name.trim_end_matches(".crate")), folder.join(package))?;
        let _ = writeln!(index, "{package} = {{ path = \"{package}\" }}");
        (count, size) = (count + 1, size + file.metadata()?.len());
    }
    fs::create_dir(folder.join(".cargo"))?;
    // paths are those beside the folder of this file
    fs::write(folder.join(".cargo/config.toml"), index)?;
    Ok((count, size))
}

/// The first block of code of a language in Markdown.
fn block<'a>(text: &'a str, language: &str) -> Option<&'a str> {
    text.split_once(&format!("```{language}\n"))?.1.split_once("```").map(|(code, _)| code)
}

/// The file with this ending.
fn only(folder: &Path, ending: &str) -> Result<PathBuf> {
    let files = fs::read_dir(folder)?.filter_map(|file| file.ok().map(|file| file.path()));
    let found = files.into_iter().find(|path| path.extension().is_some_and(|e| e == ending));
    found.with_context(|| format!("no file ends in .{ending}"))
}
