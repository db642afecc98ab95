//! `deltaq explore`: the page in which scenes are explored.

use anyhow::{Context, Result, ensure};
use serde_json::json;
use validation::catalogue;

use crate::cli::ExploreArguments;

/// The page, a link to that in the reports: `cargo xtask explore` builds it.
const PAGE: &str = include_str!("../explore.html");

/// Where the page has the scene that it opens with.
const CHOSEN: &str = "<script type=\"application/json\" id=\"chosen\">null</script>";

/// Writes the page, with a scene chosen; the text of a file goes into the page.
///
/// # Errors
/// No such scene; a file that cannot be written. A faulty text is none: the page shows its faults.
pub(crate) fn run(arguments: &ExploreArguments) -> Result<String> {
    let mut page = PAGE.to_owned();
    if let Some(name) = &arguments.scene {
        let text = catalogue::source(name)?;
        let is_built_in = catalogue::built_in().any(|(known, _)| known == name);
        let chosen = json!({ "name": name, "text": if is_built_in { None } else { Some(text) } });
        // the text of a scene cannot end the element that it is in
        let chosen = chosen.to_string().replace('<', "\\u003c");
        ensure!(page.contains(CHOSEN), "the page has no place for a scene; cargo xtask explore builds it anew");
        page = page.replacen(CHOSEN, &CHOSEN.replace("null", &chosen), 1);
    }
    let out = &arguments.out;
    std::fs::write(out, page).with_context(|| format!("cannot write `{}`", out.display()))?;
    Ok(format!("{}: open it in a browser\n", out.display()))
}
