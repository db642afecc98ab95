//! Is the constraint integrable? Decided by brackets, and where these leave it open, by ranks over a finite
//! field.

use decision::{ExactStart, Family, Finding, Question};
use equations::Derivation;
use mechanics::{Completion, Domain, Integrability, State, System, integrability_with};
use scene::Scene;
use symbolic::{Expr, Graph};

use motion::SolveError;

/// Frobenius' test ([`integrability_by_brackets`]), with [`integrals_by_ranks`] where brackets cannot
/// tell: of what [`System::without_exact_constraints`] leaves.
///
/// # Errors
/// [`SolveError`] for dependent constraints.
pub fn integrability(scene: &Scene) -> Result<Integrability, SolveError> {
    let (system, state, verdict) = (&scene.system, &scene.start, integrability_by_brackets(scene)?);
    let Integrability::Undecided { at_most, constraints, .. } = verdict else { return Ok(verdict) };
    // what ranks find on the branch of the start, a motion may leave
    if Domain::of(system).branch {
        return Ok(verdict);
    }
    let (rest, state) = system.without_exact_constraints(state)?;
    let exact = constraints - rest.constraints.len();
    let Some((left, depth)) = integrals_by_ranks(&rest, &state)? else { return Ok(verdict) };
    Ok(match exact + left {
        more if more > at_most => verdict,
        0 => Integrability::Nonintegrable { depth, growth: None },
        all if all == constraints => Integrability::Integrable { exact: false },
        integrals => Integrability::PartlyIntegrable { integrals, constraints, exact: false },
    })
}

/// [`mechanics::integrability`], with growth vectors at the start in exact numbers.
///
/// # Errors
/// [`SolveError`] for dependent constraints.
pub fn integrability_by_brackets(scene: &Scene) -> Result<Integrability, SolveError> {
    // in a graph of its own: brackets are long
    let (system, state) = (&scene.system.clone(), &scene.start);
    let rank = |g: &Graph, rows: &[Vec<Expr>]| {
        // positions that were found are rounded
        let is_written = scene.completion.configured.is_empty();
        let start = is_written.then(|| ExactStart::new(system, state, &scene.completion, None).ok()).flatten()?;
        start.rank(g, rows)
    };
    Ok(integrability_with(system, state, state.t + scene.duration, &rank)?)
}

/// The number of integrable combinations of the constraints, and how deep brackets nest to reach all other
/// directions; none is written. `None` if numbers have no image in the field, or ranks still grow.
///
/// A multiplier with `Aᵀ μ̇ = C μ` along a curve is one that every force leaves free. Along a curve driven by
/// forces of many frequencies, only the multipliers of integrals are: the linearization along almost every
/// such curve reaches what brackets reach (Sontag 1992). So the curve is a vakonomic motion with `L = ½
/// |v|² + Σ b_i q_i / (1 − a_i (t − t₀))`, from a random start: h minus the rank of the conditions on `μ₀`.
///
/// # Errors
/// [`SolveError`] for constraints that the vakonomic formulation refuses.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", include_str!("../../scene/sledge.toml"))?;
/// assert_eq!(comparison::integrals_by_ranks(&scene.system, &scene.start)?, Some((0, 1)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn integrals_by_ranks(system: &System, state: &State) -> Result<Option<(usize, usize)>, SolveError> {
    let (g, h) = (&system.graph, system.constraints.len());
    let clock = g.sub(g.variable(system.time), g.number(state.t));
    let term = |(i, c): (usize, &mechanics::Coordinate)| {
        let driven = g.sub(g.one(), g.mul(g.ratio(2 * i as i64 + 3, 1), clock));
        let potential = g.div(g.mul(g.ratio(i as i64 + 2, 1), g.variable(c.position)), driven);
        g.add(g.mul(g.ratio(1, 2), g.powi(g.variable(c.velocity), 2)), potential)
    };
    let lagrangian = g.sum(&system.coordinates.iter().enumerate().map(term).collect::<Vec<_>>());
    let driven = System { lagrangian, forces: vec![g.zero(); system.dimension()], ..system.clone() };
    let equations = vakonomic::derive(&driven, &Derivation::default())?;
    let family = Family::new(&driven, &equations)?;
    let multipliers: Vec<f64> = (0..h).map(|j| (2 * j + 3) as f64).collect();
    let question = Question::new(&driven, &equations, &multipliers, &family)?;
    let start = ExactStart::new(&driven, state, &Completion::default(), None)?;
    Ok(match question.prove_almost_every(&start) {
        Finding::Contained { rank, order } => Some((h - rank, order)),
        _ => None,
    })
}
