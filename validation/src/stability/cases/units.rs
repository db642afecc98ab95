//! The sledge in units that are far too large or far too small.

use equations::Formulation;
use mechanics::ConstantsRule;

use super::sledge::Sledge;
use super::{FORMULATIONS, choice};
use crate::stability::question::{Question, Subject};
use crate::stability::reference::Reference;
use random::{Scaling, equations};

/// Powers of the unit by which lengths, times, the action and the constraint are scaled.
pub(super) fn questions(unit: f64, [length, time, action, constraint]: [i32; 4]) -> Vec<Question> {
    let [length, time, action, constraint] = [length, time, action, constraint].map(|power| unit.powi(power));
    let scaling = Scaling { lengths: vec![length, length, 1.0], time, action, constraint };
    let one = |formulation: &'static Formulation| {
        let (scaling, reference) = (scaling.clone(), in_time_unit(Sledge { k: 0.7 }.reference(formulation), time));
        Question::new(unit, formulation.title, move || subject(&scaling, formulation), reference)
    };
    FORMULATIONS.into_iter().map(one).collect()
}

fn subject(scaling: &Scaling, formulation: &'static Formulation) -> Result<Subject, String> {
    let scene = scene::catalogue::find("sledge", &[]).map_err(|error| error.to_string())?;
    let system = scaling.system(&scene.system);
    let removal = choice(&scene, formulation)?.removal.map(|removal| scaling.removal(&system, &removal));
    let equations = equations(&system, formulation, removal.as_ref()).map_err(|error| error.to_string())?;
    Ok(Subject {
        start: scaling.state(&scene.start),
        end: scene.duration / scaling.time,
        equations: scaling.outputs(equations),
        constants: ConstantsRule::Zero,
        choice: None,
        measured: scene.system,
        system,
    })
}

/// The same motion by a clock that shows `t/unit`.
fn in_time_unit(reference: Reference, unit: f64) -> Reference {
    match reference {
        Reference::Closed(road) => Reference::Closed(Box::new(move |t| road(t * unit))),
        // these are in the coordinates and the time of what they judge
        same @ (Reference::Maggi(_) | Reference::Equivalent { .. }) => same,
        Reference::Ode { y, rates, read } => Reference::Ode {
            y,
            rates: Box::new(move |t, y, out| {
                rates(t * unit, y, out);
                out.iter_mut().for_each(|rate| *rate *= unit);
            }),
            read: Box::new(move |t, y| read(t * unit, y)),
        },
    }
}
