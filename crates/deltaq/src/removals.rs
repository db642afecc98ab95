//! The removals of a scene.

use mechanics::{Removal, RemovalError, System};
use scene::Scene;

type Automatic = fn(&System, &mechanics::State) -> Result<Removal, RemovalError>;

/// The removals that need no hand, by name.
const AUTOMATIC: [(&str, Automatic); 2] =
    [("coordinates", Removal::by_coordinates), ("quasi-velocities", Removal::by_quasi_velocities)];

/// The removals of a scene: those written by hand, then the automatic ones that apply and are not the same again.
///
/// # Errors
/// [`RemovalError`] where no removal was written by hand and none can be found automatically.
pub fn removals(scene: &Scene) -> Result<Vec<Removal>, RemovalError> {
    let mut removals = scene.removals.clone();
    for (_, automatic) in AUTOMATIC {
        match automatic(&scene.system, &scene.start) {
            Ok(removal) => {
                let known = removals.iter().any(|r| same_parameters(&scene.system, r, &removal));
                if !known {
                    removals.push(removal);
                }
            }
            Err(error) if removals.is_empty() => return Err(error),
            Err(_) => {}
        }
    }
    Ok(removals)
}

/// Whether two removals use the same coordinates as parameters, and nothing else.
fn same_parameters(system: &System, a: &Removal, b: &Removal) -> bool {
    let coordinates = |r: &Removal| r.parameters.iter().map(|u| u.coordinate).collect::<Option<Vec<usize>>>();
    let plain = |r: &Removal| {
        let memory: usize = r.memory.iter().filter(|w| w.coordinate.is_some()).count();
        memory + r.parameters.len() == system.dimension()
    };
    coordinates(a).is_some() && coordinates(a) == coordinates(b) && plain(a) && plain(b)
}

/// The removal of this name, written by hand or automatic; `None` where there is none of this name ([`removal_names`]).
///
/// # Errors
/// [`RemovalError`] where the automatic removal asked for does not apply.
pub fn removal(scene: &Scene, name: &str) -> Result<Option<Removal>, RemovalError> {
    if let Some(removal) = scene.removals.iter().find(|removal| removal.name == name) {
        return Ok(Some(removal.clone()));
    }
    let automatic = AUTOMATIC.iter().find(|(known, _)| *known == name);
    automatic.map(|(_, automatic)| automatic(&scene.system, &scene.start)).transpose()
}

/// What [`removal`] can be asked for.
pub fn removal_names(scene: &Scene) -> Vec<&str> {
    scene.removals.iter().map(|removal| &removal.name[..]).chain(AUTOMATIC.map(|(name, _)| name)).collect()
}
