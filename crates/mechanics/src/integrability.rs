//! Is the constraint integrable? Frobenius' test by the Lie flag of the admissible directions.

use symbolic::limits::TOO_LONG;
use symbolic::{Expr, Graph, Matrix, Stopped, Symbol, Vanishing, question};

use crate::rank::{Surroundings, generic_rank};
use crate::solved_constraints::SolvedConstraints;
use crate::{Domain, RemovalError, State, System};

/// Verdict of [`integrability`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Integrability {
    /// There is no constraint.
    Unconstrained,
    /// Every constraint is (a combination of) total time derivatives: `f = 0` confines the configuration.
    Integrable {
        /// Whether derivatives and brackets vanish identically; else ranks over a finite field say so.
        exact: bool,
    },
    /// Some independent combinations of the constraints are total time derivatives, and no more are.
    PartlyIntegrable {
        /// Number of integrable combinations.
        integrals: usize,
        /// Number of constraints.
        constraints: usize,
        /// Whether simplification and ranks at points say so; else ranks over a finite field do.
        exact: bool,
    },
    /// No combination of the constraints is integrable: every configuration can be reached.
    Nonintegrable {
        /// Brackets that had to be nested until all directions were reached, at almost every place.
        depth: usize,
        /// Ranks on the way, and those at the start; `None` where ranks over a finite field tell the depth.
        growth: Option<Growth>,
    },
    /// A constraint is not linear in the velocities; Frobenius' test is about those that are.
    NonlinearInVelocity,
    /// This test cannot tell.
    Undecided {
        /// Why not.
        why: Undecided,
        /// Brackets that were nested.
        depth: usize,
        /// Integrable combinations that these leave at most.
        at_most: usize,
        /// Number of constraints.
        constraints: usize,
    },
}

/// Growth vectors: how many directions are reached by admissible ones, by these and their brackets, by these
/// and brackets nested twice, …
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Growth {
    /// Where the generic one holds.
    pub domain: Domain,
    /// At almost every place.
    pub generic: Vec<usize>,
    /// At the start, as long as brackets are short: all directions are reached at its end, if that of the
    /// generic one is there.
    pub start: Vec<usize>,
    /// Whether these are as many as there can be, or are counted in exact numbers; else round-off may hide
    /// more.
    pub exact: bool,
}

impl std::fmt::Display for Growth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let vector = |ranks: &[usize]| ranks.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
        let place = self.domain.almost_every("place");
        write!(f, "at {place}, growth vector ({}); ", vector(&self.generic))?;
        let start = format!("at this start{}", if self.exact { "" } else { ", as far as round-off tells" });
        match (self.start == self.generic, self.start.last() == self.generic.last()) {
            (true, _) => write!(f, "the same at this start"),
            (_, true) => write!(f, "step {} {start}, ({})", self.start.len(), vector(&self.start)),
            _ => write!(f, "a step above {} {start}, ({}, ...)", self.start.len(), vector(&self.start)),
        }
    }
}

/// Why Frobenius' test cannot tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Undecided {
    /// The next brackets are too long for it.
    TooLong,
    /// They vanish at the points that were tried, and are not zero identically: they may begin elsewhere.
    AtPoints,
    /// They have no value at any point that was tried.
    NoPoint,
    /// They take longer than a question may.
    Stopped(Stopped),
}

/// Brackets of which ranks at the start are looked at.
const MANY: usize = 500;

/// How many rows of expressions in parameters, time and positions are independent at the start, in exact
/// numbers; `None` where that is not known.
pub type ExactRank<'a> = &'a dyn Fn(&Graph, &[Vec<Expr>]) -> Option<usize>;

impl Integrability {
    /// Whether the verdict predicts that all formulations agree (T1).
    pub fn is_integrable(&self) -> bool {
        matches!(self, Integrability::Unconstrained | Integrability::Integrable { .. })
    }
}

impl std::fmt::Display for Integrability {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Integrability::Unconstrained => write!(f, "no constraint"),
            Integrability::Integrable { exact: true } => write!(f, "holonomic (identically)"),
            Integrability::Integrable { exact: false } => write!(f, "holonomic (by ranks over a finite field)"),
            Integrability::PartlyIntegrable { integrals, constraints, exact } => {
                let by = if *exact { "exactly" } else { "by ranks over a finite field" };
                write!(
                    f,
                    "nonholonomic, partly integrable: {integrals} of {constraints} constraints are integrable combinations ({by})"
                )
            }
            Integrability::Nonintegrable { depth, growth } => {
                write!(f, "nonholonomic, bracket-generating of step {}", depth + 1)?;
                growth.as_ref().map_or(Ok(()), |growth| write!(f, " {growth}"))
            }
            Integrability::Undecided { why, depth, at_most, constraints } => {
                let next = match why {
                    Undecided::TooLong => "are too long",
                    Undecided::NoPoint => "have no value at the points tried",
                    Undecided::AtPoints => "vanish at the points tried, but not identically",
                    Undecided::Stopped(stopped) => return write!(f, "undecided: {stopped}"),
                };
                write!(
                    f,
                    "undecided: brackets nested {depth} deep leave at most {at_most} of {constraints} integrable \
                     combinations, and the next {next}"
                )
            }
            Integrability::NonlinearInVelocity => {
                write!(f, "not linear in the velocities: Frobenius' test does not apply")
            }
        }
    }
}

/// Frobenius' test for constraints `A(q,t) v + b(q,t) = 0`.
///
/// Fields `X₁ … X_m` span the admissible directions in `(q, t)` (with `T = c ∂_q + ∂_t` where anything
/// depends on time or `b ≠ 0`), after [`System::without_exact_constraints`]. Brackets
/// `[X, Y] = Y_x X − X_x Y` are added until the rank stays; what it lacks is the number of integrals. Fields
/// are differentiated exactly. Ranks are taken at points round `state` and the way up to `end`, in the
/// scene's own sizes, on the branch of `state` where something varies under a root: a rank there is certain,
/// and what adds none may do so elsewhere, or be lost in round-off. So *integrable*, and *partly*, are said
/// only where every further bracket vanishes identically, or none is needed, or `ω ∧ dω = 0` identically for
/// as many of the constraints as are left. [`Growth`] has the ranks at
/// `state` itself beside those round it.
///
/// # Errors
/// [`RemovalError::Dependent`] where `A` has no full row rank at `state`.
///
/// ```
/// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
/// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// # let start = mechanics::State { t: 0.0, q: vec![0., 0., 0.3], v: vec![0.5, 0.5 * 0.3f64.tan(), 1.] };
/// use mechanics::{Integrability, integrability};
/// // the ice sledge: y'*cos(phi) - x'*sin(phi)
/// let verdict = integrability(&system, &start, 1.0)?;
/// assert!(matches!(&verdict, Integrability::Nonintegrable { depth: 1, .. }));
/// assert!(verdict.to_string().ends_with("growth vector (2, 3); the same at this start"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn integrability(system: &System, state: &State, end: f64) -> Result<Integrability, RemovalError> {
    integrability_with(system, state, end, &|_, _| None)
}

/// [`integrability`] where ranks at the start that are smaller than elsewhere are counted by `exact`.
///
/// # Errors
/// As [`integrability`].
pub fn integrability_with(
    system: &System,
    state: &State,
    end: f64,
    exact: ExactRank,
) -> Result<Integrability, RemovalError> {
    question(|| by_brackets(system, state, end, exact)).unwrap_or_else(|stopped| {
        let constraints = system.constraints.len();
        Ok(Integrability::Undecided { why: Undecided::Stopped(stopped), depth: 0, at_most: constraints, constraints })
    })
}

fn by_brackets(system: &System, state: &State, end: f64, ranks: ExactRank) -> Result<Integrability, RemovalError> {
    let (h, domain) = (system.constraints.len(), Domain::of_constraints(system));
    if h == 0 {
        return Ok(Integrability::Unconstrained);
    }
    if !system.constraints_linear_in_velocity() {
        return Ok(Integrability::NonlinearInVelocity);
    }
    let surroundings = Surroundings::of_start(system, state, end);
    let (system, state) = &system.without_exact_constraints(state)?;
    let g = &system.graph;
    let exact = h - system.constraints.len();
    if exact == h {
        return Ok(Integrability::Integrable { exact: true });
    }
    let solved = SolvedConstraints::new(system, state)?;
    let with_time = solved.offset.iter().any(|&e| !g.is_zero(e))
        || system.constraints.iter().any(|&f| g.depends_on(f, system.time));
    let mut space: Vec<Symbol> = system.positions();
    if with_time {
        space.push(system.time);
    }
    let admissible = solved.fields(system, with_time);
    let mut depth = 0;
    // as many as are known are no fewer, and no more are left
    let undecided = |why, depth, left| {
        Ok(match exact + left {
            all if system.integrable_alone()? < left => {
                Integrability::Undecided { why, depth, at_most: all, constraints: h }
            }
            all if all == h => Integrability::Integrable { exact: true },
            integrals => Integrability::PartlyIntegrable { integrals, constraints: h, exact: true },
        })
    };
    if g.size(&admissible.concat()) > TOO_LONG {
        return undecided(Undecided::TooLong, depth, system.constraints.len());
    }
    let rank_of =
        |fields: &[Vec<Expr>]| generic_rank(g, &Matrix::new(fields.len(), space.len(), fields.concat()), &surroundings);
    let mut fields = admissible.clone();
    // what is certain in rounded numbers is no more than there is
    let rank_at_start = |fields: &[Vec<Expr>], most: usize| match surroundings.rank_at_centre(g, fields) {
        all if all == most => (all, true),
        some => ranks(g, fields).map_or((some, false), |exact| (exact, true)),
    };
    // each field adds a direction
    let (mut generic, mut newest) = (vec![fields.len()], admissible.clone());
    // rounded numbers may cancel, and differ in digits that they have not got
    let mut open = (!g.are_exact(&system.constraints)).then_some(Undecided::AtPoints);
    while fields.len() < space.len() {
        for z in brackets(g, &space, &admissible, &newest, depth == 0) {
            let rank = fields.len();
            if rank == space.len() {
                break;
            }
            if g.size(&z) > TOO_LONG {
                return undecided(Undecided::TooLong, depth, space.len() - rank);
            }
            if z.iter().all(|&e| g.is_zero(e)) {
                continue;
            }
            fields.push(z.clone());
            let found = rank_of(&fields);
            // as long as there are no others, what is not zero adds a direction
            let alone = rank == admissible.len() && found <= Some(rank);
            let verdicts: Vec<Vanishing> = z.iter().filter(|_| alone).map(|&e| system.vanishes(e)).collect();
            // where pieces end, it may be another one on which it is not zero
            let is_seen = verdicts.iter().any(|v| matches!(v, Vanishing::No { .. }));
            if found > Some(rank) || is_seen && g.ends_of_pieces(&z).is_empty() {
                continue;
            }
            fields.pop();
            if !alone || !verdicts.iter().all(|v| matches!(v, Vanishing::Exactly)) {
                open = open.max(Some(if found.is_none() { Undecided::NoPoint } else { Undecided::AtPoints }));
            }
        }
        newest = fields[generic[depth]..].to_vec();
        if newest.is_empty() {
            break;
        }
        depth += 1;
        generic.push(fields.len());
    }
    let left = space.len() - fields.len();
    let integrals = exact + left;
    Ok(match open {
        _ if integrals == 0 => {
            // fields that add a direction at almost every place need not be those that do at the start
            let mut at_start: Vec<_> = generic.iter().map(|&rank| rank_at_start(&fields[..rank], rank)).collect();
            if at_start.iter().map(|(rank, _)| rank).ne(&generic) {
                at_start = growth_at_start(g, &space, &admissible, rank_at_start);
            }
            let (start, certain): (Vec<usize>, Vec<bool>) = at_start.into_iter().unzip();
            let exact = certain.into_iter().all(|certain| certain);
            Integrability::Nonintegrable { depth, growth: Some(Growth { domain, generic, start, exact }) }
        }
        Some(why) if left > 0 => return undecided(why, depth, left),
        _ if integrals == h => Integrability::Integrable { exact: true },
        _ => Integrability::PartlyIntegrable { integrals, constraints: h, exact: true },
    })
}

/// `[X, Y] = Y_x X − X_x Y` of the admissible fields with the newest ones; with one another, each pair once.
fn brackets(
    g: &Graph,
    space: &[Symbol],
    admissible: &[Vec<Expr>],
    newest: &[Vec<Expr>],
    are_the_first: bool,
) -> impl Iterator<Item = Vec<Expr>> {
    let along = |field: Expr, by: &[Expr]| g.dot(&g.gradient(field, space), by);
    let first = move |i: usize| if are_the_first { i + 1 } else { 0 };
    let pairs = admissible.iter().enumerate().flat_map(move |(i, x)| newest.iter().skip(first(i)).map(move |y| (x, y)));
    pairs.map(move |(x, y)| (0..space.len()).map(|i| g.sub(along(y[i], x), along(x[i], y))).collect())
}

/// Ranks at the start of the fields and of all their brackets, until all directions are reached or there are
/// too many.
fn growth_at_start(
    g: &Graph,
    space: &[Symbol],
    admissible: &[Vec<Expr>],
    rank_at_start: impl Fn(&[Vec<Expr>], usize) -> (usize, bool),
) -> Vec<(usize, bool)> {
    let mut ranks = vec![rank_at_start(admissible, admissible.len())];
    let (mut all, mut newest) = (admissible.to_vec(), admissible.to_vec());
    while ranks.last().is_some_and(|&(rank, _)| rank < space.len()) && !newest.is_empty() {
        let next: Vec<Vec<Expr>> = brackets(g, space, admissible, &newest, ranks.len() == 1).collect();
        newest = next.into_iter().filter(|z| !all.contains(z)).collect();
        all.extend(newest.iter().cloned());
        if all.len() > MANY || g.size(&all.concat()) > TOO_LONG {
            break;
        }
        let rank = rank_at_start(&all, space.len());
        // more fields span less only where their numbers overflow
        if ranks.last().is_some_and(|last| rank.0 < last.0) {
            break;
        }
        ranks.push(rank);
    }
    ranks
}
