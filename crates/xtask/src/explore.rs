//! The page `reports/explore.html`: built, tried in a browser, compared with the committed one.
//!
//! A page has the digest of its own sources and the scenes in it, and the committed one has to have that of
//! the sources here. It has not to be built anew for every change of what computes: the numbers of both, the
//! committed page and one that is built from the sources, are held against the native program.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};

use crate::tools::{Outcome, build, cargo, outside, own, succeed, target};

/// The sources of the page, and of what answers it.
const PAGE: &str = "crates/explore/page";
const SOURCES: [&str; 4] = [PAGE, "crates/explore/src", "crates/scene/scenes", "crates/scene/classics"];
/// Endings of sources.
const ENDINGS: [&str; 7] = ["js", "mjs", "css", "html", "json", "rs", "toml"];
/// The committed page.
const COMMITTED: &str = "reports/explore.html";
/// The same in the package of the program.
const PACKED: &str = "crates/deltaq/explore.html";
const WASM: &str = "wasm32-unknown-unknown";
/// Where a browser is looked for, and a second one.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
const FIREFOX: [&str; 2] = ["firefox", "firefox-esr"];

/// The committed page is that of the sources, and works; so does a fresh one, where it can be built.
pub(crate) fn check() -> Result<Outcome> {
    let digest = digest()?;
    let committed = std::fs::read_to_string(COMMITTED).context(COMMITTED)?;
    let named = format!("<meta name=\"sources\" content=\"{digest}\">");
    ensure!(committed.contains(&named), "{COMMITTED} is not that of its sources, whose digest is {digest}");
    Ok(match tools()? {
        Err(lacking) => Outcome::NotRun(lacking),
        Ok(browser) => {
            let (page, size) = fresh(&digest)?;
            let found = tried(&browser, &page, "all")?;
            // to the byte the same page was tried already
            if std::fs::read(&page)? != committed.as_bytes() {
                tried(&browser, Path::new(COMMITTED), "numbers")?;
            }
            Outcome::Passed(format!(", {size}; {found}"))
        }
    })
}

/// Tries the committed page in Firefox.
pub(crate) fn firefox() -> Result<Outcome> {
    let Some(browser) = installed(&FIREFOX) else {
        return Ok(Outcome::NotRun(format!("there is none of {}", FIREFOX.join(", "))));
    };
    build()?;
    Ok(Outcome::Passed(format!(", {}", tried(&browser, Path::new(COMMITTED), "elsewhere")?)))
}

/// Builds the page and puts it in its place.
pub(crate) fn write() -> Result<Outcome> {
    if let Err(lacking) = tools()? {
        bail!("the page cannot be built: {lacking}");
    }
    let (page, size) = fresh(&digest()?)?;
    std::fs::copy(&page, COMMITTED).context(COMMITTED)?;
    // what the program is built from is packed with it
    std::fs::copy(&page, PACKED).context(PACKED)?;
    println!("{COMMITTED}: {size}");
    Ok(Outcome::Passed(String::new()))
}

/// Rounds, each of every slider up and down: some five minutes.
const ROUNDS: u32 = 100;

/// Moves the sliders of a fresh page in the number of rounds given, or [`ROUNDS`], then times frames for five
/// minutes; an error if the page grows or becomes slower.
pub(crate) fn growth(words: &[&str]) -> Result<Outcome> {
    let rounds = match words.first() {
        Some(rounds) => rounds.parse().context("growth takes a number of rounds")?,
        None => ROUNDS,
    };
    match tools()? {
        Err(lacking) => bail!("the page cannot be tried: {lacking}"),
        Ok(browser) => {
            let (page, _) = fresh(&digest()?)?;
            Ok(Outcome::Passed(format!(", {}", tried(&browser, &page, &rounds.max(1).to_string())?)))
        }
    }
}

/// Looks at the pages of a site in a browser, if there is one; what was seen.
pub(crate) fn look_at(site: &Path) -> Result<Outcome> {
    Ok(Outcome::Passed(match tools()? {
        Err(lacking) => format!(", its pages were not looked at: {lacking}"),
        Ok(browser) => {
            let mut look = outside("node");
            look.arg(workshop()?.join("site.test.mjs")).arg(browser).arg(site);
            format!(", {}", said(look.arg(target()?.join("explore").join("site")))?)
        }
    }))
}

/// How the names end of what only tries a page and is not part of it.
const TEST: &str = "test.mjs";

/// A digest of the sources (FNV-1a, 64 bits), with their names in order.
fn digest() -> Result<String> {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut feed =
        |bytes: &[u8]| bytes.iter().for_each(|b| hash = (hash ^ u64::from(*b)).wrapping_mul(0x100_0000_01b3));
    for folder in SOURCES {
        for file in files(Path::new(folder))?.into_iter().filter(|file| !file.to_string_lossy().ends_with(TEST)) {
            feed(file.to_string_lossy().replace('\\', "/").as_bytes());
            feed(&std::fs::read(&file).with_context(|| file.display().to_string())?);
        }
    }
    Ok(format!("{hash:016x}"))
}

/// The sources in a folder, in order.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut files = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
    let known = |file: &Path| file.extension().and_then(|e| e.to_str()).is_some_and(|e| ENDINGS.contains(&e));
    files.retain(|file| file.is_file() && known(file));
    files.sort();
    Ok(files)
}

/// Outside the folder of build results nothing is installed unless this variable asks for it.
const INSTALL: &str = "DELTAQ_INSTALL";

/// A browser, if everything else is there as well; or what is lacking.
fn tools() -> Result<Result<PathBuf, String>> {
    if answer(outside("node").arg("--version")).is_none() || answer(npm().arg("--version")).is_none() {
        return Ok(Err("there is no node with npm".into()));
    }
    let library = |sysroot: &str| Path::new(sysroot.trim()).join("lib/rustlib").join(WASM).exists();
    let there = || answer(outside("rustc").args(["--print", "sysroot"])).is_some_and(|sysroot| library(&sysroot));
    let asked = std::env::var_os(INSTALL).is_some_and(|value| !value.is_empty());
    if !there() && asked {
        answer(outside("rustup").args(["target", "add", WASM]));
    }
    if !there() {
        return Ok(Err(format!("rustc has no target {WASM}; {INSTALL}=1 adds it")));
    }
    if let Some(browser) = installed(&BROWSERS) {
        return Ok(Ok(browser));
    }
    if asked {
        answer(outside("apt-get").args(["install", "--yes", "--no-install-recommends", "chromium"]));
    }
    let lacking = || format!("there is no browser, none of {}; {INSTALL}=1 installs one (apt)", BROWSERS.join(", "));
    Ok(installed(&BROWSERS).ok_or_else(lacking))
}

fn npm() -> Command {
    outside(if cfg!(windows) { "npm.cmd" } else { "npm" })
}

/// What a program says, if it succeeds.
fn answer(command: &mut Command) -> Option<String> {
    let output = command.stdin(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The first of these programs that there is.
fn installed(names: &[&str]) -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let places = names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    { places }.find(|place| place.is_file())
}

/// Builds a page into the folder of build results; how large it is.
fn fresh(digest: &str) -> Result<(PathBuf, String)> {
    build()?;
    let (target, folder) = (target()?, workshop()?);
    let mut compile = cargo();
    compile.args(["rustc", "--profile", "page", "--target", WASM, "--package", "deltaq-explore"]);
    compile.args(["--crate-type", "cdylib"]);
    succeed(compile.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", flags()))?;
    let (program, page) = (target.join(WASM).join("page").join("explore.wasm"), target.join("explore/explore.html"));
    let mut bundle = outside("node");
    bundle.arg(folder.join("build.mjs")).arg(program).arg(own("deltaq")?).arg(&page).arg(digest);
    Ok((page, said(&mut bundle)?))
}

/// A stack of 8 MB, as programs have elsewhere: deep expressions are walked on it. The page must not contain
/// paths of the machine that built it.
fn flags() -> String {
    let home = || std::env::home_dir().map(|home| home.join(".cargo"));
    let packages = std::env::var_os("CARGO_HOME").map(PathBuf::from).or_else(home).unwrap_or_default();
    format!("-C link-arg=-zstack-size=8388608 --remap-path-prefix={}=cargo", packages.display())
}

/// The sources of the page with the packages that they ask for.
fn workshop() -> Result<PathBuf> {
    let folder = target()?.join("explore").join("page");
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let lock = folder.join("package-lock.json");
    let before = std::fs::read(&lock).ok();
    for file in files(Path::new(PAGE))? {
        std::fs::copy(&file, folder.join(file.file_name().unwrap_or_default()))
            .with_context(|| file.display().to_string())?;
    }
    if before != std::fs::read(&lock).ok() || !folder.join("node_modules").exists() {
        let options = ["ci", "--ignore-scripts", "--no-audit", "--no-fund", "--silent"];
        succeed(npm().args(options).current_dir(&folder))?;
    }
    Ok(folder)
}

/// Tries a page in a browser; what was measured.
fn tried(browser: &Path, page: &Path, what: &str) -> Result<String> {
    let folder = workshop()?;
    let pictures = target()?.join("explore").join("pictures");
    let mut test = outside("node");
    test.arg(folder.join(TEST)).arg(browser).arg(own("deltaq")?).arg(page).arg(pictures).arg(what);
    said(&mut test)
}

/// The last line that a program says; it has to succeed.
fn said(command: &mut Command) -> Result<String> {
    let output = command.stderr(Stdio::inherit()).output().context("node")?;
    let text = String::from_utf8_lossy(&output.stdout);
    print!("{}", if output.status.success() { "" } else { &text });
    ensure!(output.status.success(), "the page is not as it has to be: see above");
    Ok(text.trim().lines().last().unwrap_or_default().to_owned())
}
