//! What is known of a formulation before its fit: where its search may begin, and which family contains
//! which.

use comparison::{Answer, Pairing, costates_of, membership, multipliers_of};
use motion::{Choice, VAKONOMIC};
use scene::Scene;

use crate::question::is_constant;
use crate::unknown::{CLOCK, constant_names};
use crate::{Film, Fit, Problem};

/// Parts of a film over which constants of least mismatch are taken.
const PARTS: [f64; 3] = [1.0, 0.5, 0.2];

/// Numbers by the labels of their unknowns.
pub(crate) type Numbers = Vec<(String, f64)>;

/// Those of a fit.
pub(crate) fn numbers(fit: &Fit) -> Numbers {
    fit.estimates.iter().map(|e| (e.name.clone(), e.value)).collect()
}

fn value(numbers: &Numbers, label: &str) -> Option<f64> {
    numbers.iter().find(|(own, _)| own == label).map(|(_, x)| *x)
}

/// The scene of film `number` with these numbers, as far as `problem` has them.
fn scene_of(scene: &Scene, film: &Film, number: usize, problem: &Problem, numbers: &Numbers) -> Option<Scene> {
    let own = |u: &&crate::Unknown| u.film.is_none_or(|own| own == number) && !is_constant(&u.name);
    let is_clock = |name: &str| name == CLOCK && scene.system.graph.find_symbol(CLOCK).is_none();
    let (mut names, mut values): (Vec<&str>, Vec<f64>) = (Vec::new(), Vec::new());
    for unknown in problem.unknowns().iter().filter(own).filter(|u| !is_clock(&u.name)) {
        names.push(&unknown.name);
        values.push(value(numbers, &unknown.label())?);
    }
    for (name, value) in film.known.iter().filter(|(name, _)| !is_constant(name)) {
        if !names.contains(&name.as_str()) {
            names.push(name);
            values.push(*value);
        }
    }
    let mut starts = scene.starts(&names).ok()?;
    let start = starts.at(&values).ok()?;
    let mut at = scene.clone();
    at.start = start.state;
    for (symbol, value) in starts.parameters().into_iter().zip(start.parameters) {
        at.system.parameters.iter_mut().filter(|p| p.symbol == symbol).for_each(|p| p.value = value);
    }
    Some(at)
}

/// The start of a search with these numbers, and these constants for each film.
fn begun(
    problem: &Problem,
    numbers: &Numbers,
    names: &[String],
    of_film: &mut dyn FnMut(usize) -> Option<Vec<f64>>,
) -> Option<Vec<f64>> {
    let mut start = problem.start().to_vec();
    for (x, unknown) in start.iter_mut().zip(problem.unknowns()).filter(|(_, u)| !is_constant(&u.name)) {
        *x = value(numbers, &unknown.label()).unwrap_or(*x);
    }
    for film in 0..problem.films().count() {
        let values = of_film(film).filter(|values| values.len() == names.len())?;
        for (name, value) in names.iter().zip(values) {
            let of = |u: &crate::Unknown| u.name == *name && u.film.is_none_or(|own| own == film);
            problem.unknowns().iter().position(of).into_iter().for_each(|i| start[i] = value);
        }
    }
    Some(start)
}

/// Starts for `family` with the numbers of Chetaev's motion and the constants of least mismatch beside its
/// motion ([`Pairing::nearest`]) over parts of each film: those of a family that contains Chetaev's motion
/// give it.
pub(crate) fn beside_chetaev(
    scene: &Scene,
    family: &Choice,
    problem: &Problem,
    (own, chetaev, numbers): (&Problem, &Choice, &Numbers),
) -> Vec<Vec<f64>> {
    let names = constant_names(scene, family);
    let films: Vec<&Film> = problem.films().collect();
    let part = |part: f64| {
        begun(problem, numbers, &names, &mut |number| {
            let film = films[number];
            let at = scene_of(scene, film, number, own, numbers)?;
            let end = at.start.t + part * (film.t.last()? - at.start.t);
            Pairing::new(&at, chetaev, family).ok()?.nearest(end).ok()
        })
    };
    let mut starts: Vec<Vec<f64>> = PARTS.into_iter().filter_map(part).collect();
    starts.retain(|start| start.iter().all(|x| x.is_finite()));
    starts.dedup();
    starts
}

/// The start for `to` that is the motion of the vakonomic fit, or of that of a removal by coordinates,
/// `from`: the two families are one.
pub(crate) fn same_motion(
    scene: &Scene,
    (from, of, fit): (&Choice, &Problem, &Fit),
    (to, problem): (&Choice, &Problem),
) -> Option<Vec<f64>> {
    let films: Vec<&Film> = problem.films().collect();
    let numbers = numbers(fit);
    begun(problem, &numbers, &constant_names(scene, to), &mut |number| {
        let at = scene_of(scene, films[number], number, of, &numbers)?;
        let value = |name: &String| {
            let label = |u: &&crate::Unknown| u.name == *name && u.film.is_none_or(|own| own == number);
            let label = of.unknowns().iter().find(label)?.label();
            self::value(&numbers, &label)
        };
        let values = constant_names(scene, from).iter().map(value).collect::<Option<Vec<f64>>>()?;
        match (&from.removal, &to.removal) {
            (None, Some(removal)) => costates_of(&at, removal, &values).ok()?,
            (Some(removal), None) => multipliers_of(&at, removal, &values).ok()?,
            _ => None,
        }
    })
}

/// Whether it is proved that every motion of Chetaev's is vakonomic, each for some `μ₀`.
pub(crate) fn contains_chetaev(scene: &Scene, family: &Choice) -> bool {
    let end = scene.start.t + scene.duration;
    *family.formulation == *VAKONOMIC
        && membership(scene, end).is_ok_and(|found| found.is_some_and(|found| found.answer() == Answer::SomeProved))
}
