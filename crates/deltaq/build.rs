//! Says which commit the program is built from, where it is built in its repository.

use std::path::Path;
use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let mut version = env!("CARGO_PKG_VERSION").to_owned();
    println!("cargo::rerun-if-changed=build.rs");
    // a packaged crate may lie in the repository of somebody else
    if Path::new("../../crates/scene/scenes").is_dir()
        && let Some(commit) = git(&["rev-parse", "--short", "HEAD"])
    {
        version += &format!(" ({commit})");
        for log in git(&["rev-parse", "--git-path", "logs/HEAD"]).iter().filter(|log| Path::new(log).exists()) {
            println!("cargo::rerun-if-changed={log}");
        }
    }
    println!("cargo::rustc-env=DELTAQ_VERSION={version}");
}
