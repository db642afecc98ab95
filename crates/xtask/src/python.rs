//! The Python module, as a wheel, installed and tested; the Python environment that checks share.

use std::collections::hash_map::DefaultHasher;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};

use crate::tools::{Outcome, build, output_of, outside, succeed, target};

/// The crate, from the root of the project.
const CRATE: &str = "crates/python";
/// What of the module is written in Python.
const SOURCES: &str = "crates/python/python/deltaq";
/// What the checks take from Python's package index.
const REQUIREMENTS: &str = "crates/xtask/requirements.txt";
/// What builds the wheel that is given away.
const WHEEL_REQUIREMENTS: &str = "crates/xtask/wheel.txt";
/// The oldest glibc on which that wheel installs is 2.28, of 2018.
const GLIBC: u32 = 28;
/// What of stubs the module itself cannot have.
const STUBTEST: &str = "stubtest.txt";
/// The oldest Python for which the module is built.
const OLDEST: (u32, u32) = (3, 11);
/// Where a Python is looked for.
const NAMES: [&str; 3] = ["python3.11", "python3", "python"];

pub(crate) fn check() -> Result<Outcome> {
    let python = environment()?;
    let Module { site, size } = module(&python)?;
    // types are looked at beside the tests
    let mut types = typed(&python, &site)?;
    let fresh = installed(&python, &packed(&python, &site)?)?;
    let tested = tested(&fresh);
    for (words, types) in &mut types {
        ensure!(types.wait()?.success(), "{words}: see above");
    }
    tested?;
    Ok(Outcome::Passed(format!(", a module of {:.1} MB", size as f64 / 1e6)))
}

/// Starts mypy on what of the module is Python, and stubtest on its stubs.
fn typed(python: &Path, site: &Path) -> Result<[(&'static str, Child); 2]> {
    let settings = std::path::absolute(Path::new(CRATE).join("pyproject.toml"))?;
    let start = |words, arguments: &[&str], settings_option: &str| -> Result<_> {
        let mut command = outside(python);
        command.args(["-B", "-m"]).args(arguments).arg(settings_option).arg(&settings).current_dir(site);
        Ok((words, command.env("MYPY_CACHE_DIR", target()?.join("mypy")).spawn().context(words)?))
    };
    let allowed = std::path::absolute(Path::new(CRATE).join(STUBTEST))?;
    let allowed = allowed.to_str().context("the path of the project is not text")?;
    Ok([
        start("types are wrong", &["mypy", "--no-error-summary", "--package", "deltaq"], "--config-file")?,
        start(
            "stubs do not say what is there",
            &["mypy.stubtest", "deltaq", "--concise", "--allowlist", allowed],
            "--mypy-config-file",
        )?,
    ])
}

/// Runs the tests with an interpreter that has the module.
fn tested(python: &Path) -> Result<Outcome> {
    succeed(outside(python).args(["-B", "-m", "pytest", "--quiet"]).current_dir(CRATE))
}

/// Builds the wheel and the source distribution that are given away, in `target/wheels`, and tests the wheel.
/// On Linux zig links it against the symbols of [`GLIBC`], whatever the glibc of this machine.
pub(crate) fn wheel() -> Result<Outcome> {
    const IS_GLIBC: bool = cfg!(all(target_os = "linux", target_env = "gnu"));
    let (clock, target) = (Instant::now(), target()?);
    let python = make(&target, "wheel", Path::new(WHEEL_REQUIREMENTS))?;
    let wheels = empty(target.join("wheels"))?;
    let mut maturin = maturin(&python);
    maturin.args(["build", "--release", "--sdist", "--quiet", "--out"]).arg(&wheels);
    if IS_GLIBC {
        maturin.args(["--zig", "--compatibility", &format!("manylinux_2_{GLIBC}")]);
        // maturin asks the first `python3` for zig
        let others = std::env::var_os("PATH").unwrap_or_default();
        let folders = python.parent().map(PathBuf::from).into_iter().chain(std::env::split_paths(&others));
        maturin.env("PATH", std::env::join_paths(folders)?);
    }
    succeed(maturin.arg("--interpreter").arg(&python))?;
    let mut made = Vec::new();
    for file in std::fs::read_dir(&wheels).with_context(|| wheels.display().to_string())? {
        let file = file?;
        made.push(format!("{} of {:.1} MB", file.path().display(), file.metadata()?.len() as f64 / 1e6));
        if file.path().extension().is_some_and(|ending| ending == "whl") {
            if IS_GLIBC {
                audited(&python, &file.path())?;
            }
            tested(&installed(&environment()?, &file.path())?)?;
        }
    }
    Ok(Outcome::Passed(format!(", {}, in {:.0} s", made.join(", "), clock.elapsed().as_secs_f64())))
}

/// The source distribution, in this folder.
pub(crate) fn source_distribution(folder: &Path) -> Result<Outcome> {
    succeed(maturin(&environment()?).args(["sdist", "--out"]).arg(folder))
}

/// maturin in the folder of the crate. It would warn that it is not the backend: the one that is asks it.
fn maturin(python: &Path) -> Command {
    let mut maturin = outside(python);
    maturin.args(["-m", "maturin"]).current_dir(CRATE).env("MATURIN_NO_MISSING_BUILD_BACKEND_WARNING", "1");
    maturin
}

/// Prints what auditwheel finds in a wheel: it has to be symbols of [`GLIBC`] or of an older one.
fn audited(python: &Path, wheel: &Path) -> Result<()> {
    let output = outside(python).args(["-m", "auditwheel", "show"]).arg(wheel).output().context("auditwheel")?;
    let text = String::from_utf8_lossy(&output.stdout);
    print!("{text}{}", String::from_utf8_lossy(&output.stderr));
    let glibc = glibc(&text).context("auditwheel names no manylinux tag")?;
    ensure!(glibc <= GLIBC, "the wheel needs glibc 2.{glibc}; 2.{GLIBC} has to do");
    Ok(())
}

/// Of a platform tag `manylinux_2_N`, that auditwheel prints, N.
fn glibc(text: &str) -> Option<u32> {
    // its lines end anywhere between words
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let tag = text.split("platform tag: \"").nth(1)?.strip_prefix("manylinux_2_")?;
    tag.split('_').next()?.parse().ok()
}

/// The folder, with nothing in it.
pub(crate) fn empty(folder: PathBuf) -> Result<PathBuf> {
    if folder.exists() {
        std::fs::remove_dir_all(&folder).with_context(|| folder.display().to_string())?;
    }
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    Ok(folder)
}

/// A wheel of the module that was laid out.
fn packed(python: &Path, site: &Path) -> Result<PathBuf> {
    let wheels = empty(target()?.join("python-wheel"))?;
    succeed(outside(python).args(["-m", "wheel", "pack", "--dest-dir"]).arg(&wheels).arg(site).stdout(Stdio::null()))?;
    Ok(std::fs::read_dir(&wheels)?.next().context("no wheel was packed")??.path())
}

/// A new environment with the module from a wheel, and what the other one has.
fn installed(python: &Path, wheel: &Path) -> Result<PathBuf> {
    let place = empty(target()?.join("python-fresh"))?;
    succeed(outside(python).args(["-m", "venv", "--without-pip"]).arg(&place))?;
    let fresh = interpreter_of(&place);
    let mut install = outside(python);
    install.args(["-m", "pip", "--quiet", "--disable-pip-version-check", "--python"]).arg(&fresh);
    succeed(install.args(["install", "--no-deps", "--no-index"]).arg(wheel))?;
    let folder = |python: &Path| -> Result<String> {
        let ask = ["-c", "import sysconfig; print(sysconfig.get_path('purelib'))"];
        Ok(output_of(outside(python).args(ask))?.trim().into())
    };
    let link = Path::new(&folder(&fresh)?).join("others.pth");
    std::fs::write(&link, folder(python)?).with_context(|| link.display().to_string())?;
    Ok(fresh)
}

/// Times other tools beside the module, each in Python, and writes `reports/evidence/peers.md`.
pub(crate) fn peers(arguments: &[&str]) -> Result<Outcome> {
    let target = target()?;
    let scripts = Path::new("validation").join("peers");
    let python = make(&target, "peers", &scripts.join("requirements.txt"))?;
    let Module { site, .. } = module(&environment()?)?;
    let mut run = outside(&python);
    run.arg("-B").arg(scripts.join("peers.py")).arg("--target").arg(target.join("peers"));
    succeed(run.args(arguments).env("PYTHONPATH", &site))
}

/// The module as a wheel would install it.
struct Module {
    /// The folder that Python has to look into.
    site: PathBuf,
    /// The library in bytes.
    size: u64,
}

/// Lays out what `pip install` asks maturin for, except for the library, which the build has made.
fn module(python: &Path) -> Result<Module> {
    build()?;
    let target = target()?;
    let site = empty(target.join("python-module"))?;
    let folder = site.join("deltaq");
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let arguments = ["pep517", "write-dist-info", "--interpreter"];
    succeed(maturin(python).args(arguments).arg(python).arg("--metadata-directory").arg(&site).stdout(Stdio::null()))?;
    for file in std::fs::read_dir(SOURCES).context(SOURCES)? {
        let file = file.context(SOURCES)?;
        if file.path().is_file() {
            std::fs::copy(file.path(), folder.join(file.file_name()))
                .with_context(|| file.path().display().to_string())?;
        }
    }
    let library = target.join("release").join(format!("{DLL_PREFIX}deltaq_python{DLL_SUFFIX}"));
    let module = if cfg!(windows) { "_native.pyd" } else { "_native.abi3.so" };
    let size = std::fs::copy(&library, folder.join(module)).with_context(|| library.display().to_string())?;
    Ok(Module { site, size })
}

/// The Python of an environment with what the checks need.
pub(crate) fn environment() -> Result<PathBuf> {
    static MADE: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    let made = || target().and_then(|target| make(&target, "python", Path::new(REQUIREMENTS)));
    MADE.get_or_init(|| made().map_err(|error| format!("{error:#}"))).clone().map_err(anyhow::Error::msg)
}

/// The Python of an environment with what a file of requirements pins. It is built once for each content of
/// that file: in a folder beside its place, and then moved, so that half an environment is never used.
pub(crate) fn make(target: &Path, name: &str, requirements: &Path) -> Result<PathBuf> {
    let text = std::fs::read_to_string(requirements).with_context(|| requirements.display().to_string())?;
    let (program, version) = interpreter()?;
    let mut hasher = DefaultHasher::new();
    (text, version).hash(&mut hasher);
    let place = target.join(format!("{name}-venv-{:016x}", hasher.finish()));
    if !place.exists() {
        let draft = target.join(format!("{name}-venv-draft-{}", std::process::id()));
        succeed(outside(program).args(["-m", "venv"]).arg(&draft))?;
        let mut install = outside(interpreter_of(&draft));
        let options = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
        succeed(install.args(options).arg(requirements))?;
        // Another run may have been faster; its environment is as good.
        if std::fs::rename(&draft, &place).is_err() {
            std::fs::remove_dir_all(&draft).with_context(|| draft.display().to_string())?;
        }
    }
    Ok(interpreter_of(&place))
}

fn interpreter_of(environment: &Path) -> PathBuf {
    environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

/// Name and version of the first Python that is new enough.
pub(crate) fn interpreter() -> Result<(&'static str, (u32, u32))> {
    let mut found = Vec::new();
    for name in NAMES {
        let ask = outside(name).args(["-c", "import sys; print(*sys.version_info[:2])"]).output();
        let Ok(output) = ask else { continue };
        match version(&String::from_utf8_lossy(&output.stdout)) {
            Some(version) if version >= OLDEST => return Ok((name, version)),
            Some((major, minor)) => found.push(format!("`{name}` is {major}.{minor}")),
            None => found.push(format!("`{name}` does not say its version")),
        }
    }
    let found = if found.is_empty() { "there is none".into() } else { found.join(", ") };
    bail!("Python {}.{} or newer is needed: {found}", OLDEST.0, OLDEST.1)
}

fn version(text: &str) -> Option<(u32, u32)> {
    let (major, minor) = text.trim().split_once(' ')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tag_of_a_wheel_is_read() {
        let said = "is consistent with\nthe following platform\ntag: \"manylinux_2_35_x86_64\".\n\nThe wheel";
        assert_eq!(glibc(said), Some(35));
        assert_eq!(glibc("is consistent with\nthe following platform tag: \"linux_x86_64\"."), None);
    }

    #[test]
    fn versions_are_compared_as_numbers() {
        assert!(version("3 11\n").is_some_and(|v| v >= OLDEST));
        assert!(version("3 9").is_some_and(|v| v < OLDEST));
        assert!(version("4 0").is_some_and(|v| v >= OLDEST));
        assert_eq!(version(""), None);
    }
}
