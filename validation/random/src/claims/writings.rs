//! T4: the sentences on a system are those on another writing of it, or open.

use scene::Scene;
use toml::Table;

use super::CheckError;
use crate::sentences::sentences;
use crate::writings::{plain, written};
use crate::{Case, Said};

const CLAIM: &str = "other writings have the same sentences";

/// Coordinates up to which measures and integrals are asked for: of more they take seconds.
const FEW: usize = 3;

/// Signs of coordinates, roots of squares, coordinates that follow, unit vectors, formulas for numbers, time.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let Some(writing) = case.writing.or_else(|| case.recipe.features.writing()) else { return Ok(()) };
    let text: Result<Table, _> = case.scene.to_toml().parse();
    let Ok(own) = text.map(|table| plain(&table)) else { return Ok(()) };
    let Some(other) = (writing.of)(&own) else { return Ok(()) };
    let with_integrals = case.recipe.n() <= FEW;
    let of = |table: &Table| {
        let scene = Scene::parse("writing", &written(table)).map_err(|fault| fault.to_string())?;
        sentences(&scene, with_integrals)
    };
    let (mut open, mut wrong) = (0, Vec::new());
    match (of(&own), of(&other)) {
        (Ok(own), Ok(other)) => {
            for (about, said) in own.iter().filter(|(about, _)| writing.keeps(about)) {
                let now = other.get(about).unwrap_or(&Said::Open);
                match said.beside(now, writing.adds) {
                    Some("open") => open += 1,
                    Some(_) => case.found.count(4, "other writings: a sentence is the same", true),
                    None => wrong.push(format!("{about}: {said:?} is {now:?}")),
                }
            }
        }
        (own, other) => wrong.extend([own.err(), other.err()].into_iter().flatten()),
    }
    (0..open).for_each(|_| case.found.count(4, "other writings: a sentence is the same", false));
    case.found.require(4, CLAIM, wrong.is_empty(), format!("{}: {}", writing.name, wrong.join("; ")));
    Ok(())
}
