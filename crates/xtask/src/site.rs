//! The site: documents, reports and references as pages that need no server but one of files.

use std::path::Path;

use anyhow::Result;

use crate::tools::{ALL, Outcome, cargo, output_of, outside, own, succeed, target};
use crate::{explore, python};

/// What builds the pages.
const SCRIPTS: &str = "docs/site";

/// Packages whose reference is not for users.
const EVIDENCE: [&str; 9] = [
    "deltaq-bench",
    "deltaq-random",
    "deltaq-reference",
    "deltaq-referees",
    "deltaq-validation",
    "engine",
    "python",
    "tests",
    "xtask",
];

/// Measured pages that are older than their code, a line each: they do not belong to the site.
fn older_pages() -> Result<String> {
    succeed(cargo().arg("build").args(ALL).args(["--bin", "evidence", "--quiet"]))?;
    output_of(outside(own("evidence")?).args(["reports", "--ages"]))
}

/// Builds it into `target/site`: the reference of Rust by `cargo doc`, all else by Sphinx. Then its pages are
/// looked at in a browser, if there is one.
pub(crate) fn build() -> Result<Outcome> {
    let target = target()?;
    let left_out = EVIDENCE.iter().flat_map(|package| ["--exclude", package]);
    succeed(cargo().args(["doc", "--no-deps", "--workspace", "--lib", "--quiet"]).args(left_out))?;
    let python = python::make(&target, "site", &Path::new(SCRIPTS).join("requirements.txt"))?;
    let mut run = outside(&python);
    run.arg("-B").arg(Path::new(SCRIPTS).join("build.py")).arg(target.join("site"));
    succeed(run.arg(target.join("doc")).arg(older_pages()?))?;
    explore::look_at(&target.join("site"))
}
