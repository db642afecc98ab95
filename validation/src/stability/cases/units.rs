//! The sledge in units that are far too large or far too small.

use deltaq::formulation;
use mechanics::ConstantsRule;

use super::sledge::Sledge;
use super::{FORMULATIONS, choice, powers};
use crate::catalogue;
use crate::stability::question::{Case, Question, Subject};
use crate::stability::reference::Reference;
use random::{Scaling, equations};

const REFERENCE: &str = "that of the sledge in metres and seconds, its times and coordinates converted";

pub(super) const LENGTH: Case = Case {
    name: "unit-of-length",
    about: "The sledge over 10 s, lengths in a unit of so many metres.",
    reference: REFERENCE,
    variable: "unit (m)",
    questions: || {
        points(|unit| Scaling {
            lengths: vec![unit, unit, 1.0],
            time: 1.0,
            action: unit.powi(-2),
            constraint: 1.0 / unit,
        })
    },
};

pub(super) const TIME: Case = Case {
    name: "unit-of-time",
    about: "The sledge over 10 s, times in a unit of so many seconds.",
    reference: REFERENCE,
    variable: "unit (s)",
    questions: || points(|unit| Scaling { lengths: vec![1.0; 3], time: unit, action: unit * unit, constraint: unit }),
};

pub(super) const MASS: Case = Case {
    name: "unit-of-mass",
    about: "The sledge over 10 s, masses in a unit of so many times its own.",
    reference: REFERENCE,
    variable: "unit",
    questions: || points(|unit| Scaling { lengths: vec![1.0; 3], time: 1.0, action: 1.0 / unit, constraint: 1.0 }),
};

fn points(scaling: impl Fn(f64) -> Scaling) -> Vec<Question> {
    powers(-12, 12, 4).flat_map(|unit| questions(unit, &scaling(unit))).collect()
}

fn questions(unit: f64, scaling: &Scaling) -> Vec<Question> {
    let one = |name: &'static str| Question {
        point: unit,
        formulation: formulation(name).map_or(name, |f| f.title).into(),
        subject: {
            let scaling = scaling.clone();
            Box::new(move || subject(&scaling, name))
        },
        reference: in_time_unit(Sledge { k: 0.7 }.reference(name), scaling.time),
        compared: usize::MAX,
    };
    FORMULATIONS.into_iter().map(one).collect()
}

fn subject(scaling: &Scaling, name: &str) -> Result<Subject, String> {
    let scene = catalogue::find("sledge", &[]).map_err(|error| error.to_string())?;
    let system = scaling.system(&scene.system);
    let removal = choice(&scene, name)?.removal.map(|removal| scaling.removal(&system, &removal));
    let equations = equations(&system, name, removal.as_ref()).map_err(|error| error.to_string())?;
    Ok(Subject {
        start: scaling.state(&scene.start),
        end: scene.duration / scaling.time,
        equations: scaling.outputs(equations),
        constants: ConstantsRule::Zero,
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
