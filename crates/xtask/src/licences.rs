//! Licences of all dependencies, against the list in `deny.toml`.

use std::collections::BTreeSet;

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;
use spdx::{Expression, LicenseReq, ParseMode};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::checks::{Outcome, cargo};

pub(crate) fn check() -> Result<Outcome> {
    let allowed = allowed(&std::fs::read_to_string("deny.toml").context("deny.toml")?)?;
    let output = cargo()
        .args(["metadata", "--format-version", "1", "--all-features"])
        .stderr(std::process::Stdio::inherit())
        .output()
        .context("cargo metadata")?;
    ensure!(output.status.success(), "`cargo metadata` ended with {}", output.status);
    let metadata: Value = serde_json::from_slice(&output.stdout).context("what `cargo metadata` wrote")?;
    let packages = metadata["packages"].as_array().context("`cargo metadata` names no packages")?;
    let refused: Vec<String> = packages.iter().filter_map(|package| refusal(package, &allowed)).collect();
    if !refused.is_empty() {
        bail!("{}", refused.join("; "));
    }
    Ok(Outcome::Passed(format!(", {} packages", packages.len())))
}

/// The licences that `deny.toml` allows.
fn allowed(text: &str) -> Result<BTreeSet<String>> {
    let table = DeTable::parse(text).context("deny.toml")?;
    let list = table.get_ref().get("licenses").and_then(|licenses| licenses.get_ref().get("allow"));
    let list = list.and_then(|list| list.get_ref().as_array()).context("deny.toml has no `licenses.allow`")?;
    let name = |name: &Spanned<DeValue>| name.get_ref().as_str().map(str::to_owned);
    list.iter().map(|entry| name(entry).context("an allowed licence is not a text")).collect()
}

/// Why a package may not be used, if so.
fn refusal(package: &Value, allowed: &BTreeSet<String>) -> Option<String> {
    let name = format!("{} {}", package["name"].as_str().unwrap_or("?"), package["version"].as_str().unwrap_or("?"));
    match package["license"].as_str() {
        None => Some(format!("{name} states no licence")),
        Some(expression) => match permits(expression, allowed) {
            Ok(true) => None,
            Ok(false) => Some(format!("{name} is under {expression}")),
            Err(error) => Some(format!("{name} has the licence `{expression}`, which does not parse: {error}")),
        },
    }
}

/// Does an SPDX expression leave a choice of allowed licences? The old form `MIT/Apache-2.0` counts as `OR`.
fn permits(expression: &str, allowed: &BTreeSet<String>) -> Result<bool> {
    let expression = Expression::parse_mode(expression, ParseMode::LAX)?;
    Ok(expression.evaluate(|requirement: &LicenseReq| allowed.contains(&requirement.to_string())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_are_read_as_choices_and_duties() {
        let allowed = allowed(include_str!("../../../deny.toml")).unwrap();
        for fine in [
            "MIT",
            "MIT/Apache-2.0",
            "MIT OR GPL-3.0-only",
            "(MIT OR Apache-2.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception OR MIT",
            "Zlib AND BSD-3-Clause",
        ] {
            assert!(permits(fine, &allowed).unwrap(), "{fine}");
        }
        for refused in ["GPL-3.0-or-later", "AGPL-3.0-only", "MIT AND GPL-2.0-only", "LGPL-2.1-only", "MPL-2.0"] {
            assert!(!permits(refused, &allowed).unwrap(), "{refused}");
        }
        assert!(permits("MIT OR", &allowed).is_err());
    }

    #[test]
    fn a_refusal_names_the_package() {
        let allowed = BTreeSet::from(["MIT".to_owned()]);
        let package = |licence: Value| serde_json::json!({ "name": "p", "version": "1.0.0", "license": licence });
        assert_eq!(refusal(&package("MIT".into()), &allowed), None);
        assert_eq!(refusal(&package("GPL-3.0".into()), &allowed).unwrap(), "p 1.0.0 is under GPL-3.0");
        assert_eq!(refusal(&package(Value::Null), &allowed).unwrap(), "p 1.0.0 states no licence");
    }
}
