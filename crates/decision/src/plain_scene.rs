//! The system and start of a proof as plain scalar formulas, which a small reader can parse.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use crate::exact::Modular;
use crate::series::SeriesStart;
use crate::start::ExactStart;

/// Formulas by name.
pub type Formulas = BTreeMap<String, String>;

/// The system, and the start or a point that was drawn, in scalar formulas: every number as it was taken.
///
/// No vectors, rotations or definitions; in names of coordinates (with a prime: of velocities), parameters
/// and t. Fields are in the order of the alphabet, in which the digest of a certificate is taken.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "Scene")]
pub struct PlainScene {
    /// f(q, v, t).
    pub constraints: Vec<String>,
    /// Names, in the order of q.
    pub coordinates: Vec<String>,
    /// Generalized forces Q(q, v, t) other than zero, by coordinate; in every formulation they act by virtual
    /// work.
    pub forces: Formulas,
    /// L(q, v, t).
    pub lagrangian: String,
    /// Those that stand in the other formulas, and are not functions of others.
    pub parameters: Formulas,
    /// At the start.
    pub positions: Formulas,
    /// Of the start.
    pub time: String,
    /// Those that the constraints do not supply.
    pub velocities: Formulas,
}

impl PlainScene {
    /// `exact` is what `start` is in numbers, or one drawn `at_random`; velocities with places in `open` are
    /// supplied by the constraints.
    ///
    /// # Errors
    /// What cannot be written, in words.
    pub(crate) fn new(
        start: &ExactStart,
        exact: &SeriesStart<Modular>,
        open: &[usize],
        at_random: bool,
    ) -> Result<Self, String> {
        let system = &start.system;
        let (g, n, parameters) = (&system.graph, system.dimension(), system.parameters.len());
        let values = [&exact.parameters[..], &[exact.time], &exact.positions, &exact.velocities].concat();
        // what was drawn, and decimals in the place of velocities that are not determined, are written
        // nowhere
        let is_written = |i: usize| match i.checked_sub(parameters) {
            None => true,
            Some(i) => !at_random && i.checked_sub(n + 1).is_none_or(|i| !start.supplied.contains(&i)),
        };
        let place = parameters + 1;
        let drawn = if at_random { parameters..place + n } else { 0..0 };
        if drawn.into_iter().any(|i| values[i].exact().is_none()) {
            return Err("the start that was drawn has numbers that are not fractions".into());
        }
        let text = |i: usize| match values[i].exact() {
            Some(x) if !is_written(i) || mixes_pi(&g.plain(start.written[i])) => x.to_string(),
            _ => g.plain(start.written[i]),
        };
        let name = |i: usize| system.coordinates[i].name.clone();
        let forces = system.forces.iter().enumerate().filter(|(_, force)| !g.is_zero(**force));
        let given = (0..n).filter(|i| !open.contains(i));
        let formulas = [&[system.lagrangian][..], &system.constraints, &system.forces, &start.written].concat();
        let stands = |i: &usize| formulas.iter().any(|&e| g.depends_on(e, system.parameters[*i].symbol));
        let parameter = |i: usize| (g.name(system.parameters[i].symbol), text(i));
        let scene = PlainScene {
            coordinates: (0..n).map(name).collect(),
            parameters: (0..parameters).filter(stands).map(parameter).collect(),
            lagrangian: g.plain(system.lagrangian),
            constraints: system.constraints.iter().map(|&f| g.plain(f)).collect(),
            forces: forces.map(|(i, &force)| (name(i), g.plain(force))).collect(),
            time: text(parameters),
            positions: (0..n).map(|i| (name(i), text(place + i))).collect(),
            velocities: given.map(|i| (format!("{}'", name(i)), text(place + n + i))).collect(),
        };
        let named = [&scene.parameters, &scene.forces, &scene.positions, &scene.velocities];
        let texts = named.into_iter().flatten().map(|(_, text)| text).chain(&scene.constraints);
        if texts.chain([&scene.lagrangian, &scene.time]).any(|text| mixes_pi(text)) {
            return Err("a sum of a fraction and a multiple of pi stands in a formula, which has no text".into());
        }
        Ok(scene)
    }

    /// The system at a point that was drawn at random, its velocities left out.
    ///
    /// # Errors
    /// What cannot be written, in words.
    pub fn at_random_point(start: &ExactStart, point: &SeriesStart<Modular>) -> Result<Self, String> {
        Ok(PlainScene { velocities: Formulas::new(), ..PlainScene::new(start, point, &[], true)? })
    }
}

/// Whether a number in it is a quotient with the denominator of π, and no multiple of π.
fn mixes_pi(text: &str) -> bool {
    let mut integers = text.split(|c: char| !c.is_ascii_digit()).filter_map(|digits| digits.parse::<i128>().ok());
    integers.any(|n| n != 0 && n % i128::from(symbolic::PI.1) == 0)
}
