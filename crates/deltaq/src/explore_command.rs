//! `deltaq explore`: the page in which scenes are explored.

use std::collections::BTreeMap;

use anyhow::{Result, ensure};
use program::keep;
use serde_json::json;

use crate::cli::ExploreArguments;

/// The page, a link to that in the reports: `cargo xtask explore` builds it.
const PAGE: &str = include_str!("../explore.html");

/// Where the page has the scene that it opens with.
const CHOSEN: &str = "<script type=\"application/json\" id=\"chosen\">null</script>";

/// Writes the page, with a scene chosen and numbers set in it; the text of a file goes into the page.
///
/// # Errors
/// No such scene, faults of it, no such number in it; a file that cannot be written.
pub(crate) fn run(arguments: &ExploreArguments) -> Result<String> {
    let mut page = PAGE.to_owned();
    ensure!(arguments.scene.is_some() || arguments.set.overrides.is_empty(), "--set needs a scene in which to set it");
    if let Some(name) = &arguments.scene {
        let text = scene::catalogue::source(name)?;
        let is_built_in = scene::catalogue::built_in().any(|(known, _)| known == name);
        let set = &arguments.set.overrides;
        scene::catalogue::read(name, &text, set)?;
        let numbers: BTreeMap<_, _> = set.iter().map(|(name, number)| (name, number.value())).collect();
        let text = if is_built_in { None } else { Some(text) };
        let chosen = json!({ "name": name, "text": text, "set": numbers });
        // the text of a scene cannot end the element that it is in
        let chosen = chosen.to_string().replace('<', "\\u003c");
        ensure!(page.contains(CHOSEN), "the page has no place for a scene; cargo xtask explore builds it anew");
        page = page.replacen(CHOSEN, &CHOSEN.replace("null", &chosen), 1);
    }
    keep(Some(&arguments.out), page, |file| format!("{file}: open it in a browser\n"))
}
