//! `[film]`: what columns of films show.

use super::context::Context;
use crate::{Filmed, SceneError, SceneErrorKind, format};

/// The columns, in the order of the file.
pub(super) fn read(context: &Context) -> Result<Vec<Filmed>, SceneError> {
    let Some(film) = context.root.section("film")? else { return Ok(Vec::new()) };
    film.entries()
        .map(|entry| {
            let section = entry.section()?;
            section.check_keys(format::FILMED);
            let expression = context.written(&section.require("is", "an expression")?)?;
            let sigma = match section.get("sigma") {
                None => None,
                Some(entry) => match context.constant(&entry)? {
                    value if value > 0.0 => Some(value),
                    value => {
                        return Err(entry.error(SceneErrorKind::OutOfRange {
                            what: "a standard deviation",
                            value,
                            limit: 0.0,
                        }));
                    }
                },
            };
            Ok(Filmed { name: entry.key.into(), expression, sigma })
        })
        .collect()
}
