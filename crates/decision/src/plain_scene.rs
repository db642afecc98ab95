//! What a proof is about, in a form that little is needed to read.

use crate::exact::Modular;
use crate::series::SeriesStart;
use crate::start::ExactStart;

/// A system and a start as scalar formulas: no vectors, rotations or definitions, every number as it was
/// proved, in names of coordinates (with a prime: of velocities), parameters and `t`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlainScene {
    /// Names, in the order of `q`.
    pub coordinates: Vec<String>,
    /// Parameters that are no functions of others.
    pub parameters: Vec<(String, String)>,
    /// `L(q, v, t)`.
    pub lagrangian: String,
    /// `f(q, v, t)`.
    pub constraints: Vec<String>,
    /// `Q(q, v, t)`, where it is not zero.
    pub forces: Vec<(String, String)>,
    /// `t₀`.
    pub time: String,
    /// `q₀`.
    pub positions: Vec<(String, String)>,
    /// `v₀`, but for what the constraints supply.
    pub velocities: Vec<(String, String)>,
}

impl PlainScene {
    /// `exact` is what `start` is in numbers, or a start drawn at random; velocities with places in `open` are
    /// supplied by the constraints. `None` where a parameter is no number that was followed.
    pub(crate) fn new(start: &ExactStart, exact: &SeriesStart<Modular>, open: &[usize]) -> Option<Self> {
        let system = &start.system;
        let (g, n) = (&system.graph, system.dimension());
        let values = exact.positions.iter().chain(&exact.velocities).zip(&start.written);
        let texts: Vec<String> =
            values.map(|(value, &e)| value.exact().map_or_else(|| g.plain(e), |x| x.to_string())).collect();
        let name = |i: usize| system.coordinates[i].name.clone();
        let parameters = system.parameters.iter().zip(&exact.parameters);
        let forces = system.forces.iter().enumerate().filter(|(_, force)| !g.is_zero(**force));
        let given = (0..n).filter(|i| !open.contains(i));
        Some(PlainScene {
            coordinates: (0..n).map(name).collect(),
            parameters: parameters
                .map(|(p, x)| Some((g.name(p.symbol), x.exact()?.to_string())))
                .collect::<Option<_>>()?,
            lagrangian: g.plain(system.lagrangian),
            constraints: system.constraints.iter().map(|&f| g.plain(f)).collect(),
            forces: forces.map(|(i, &force)| (name(i), g.plain(force))).collect(),
            time: exact.time.exact()?.to_string(),
            positions: (0..n).map(|i| (name(i), texts[i].clone())).collect(),
            velocities: given.map(|i| (format!("{}'", name(i)), texts[n + i].clone())).collect(),
        })
    }
}
