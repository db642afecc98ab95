//! The headline of a comparison: the same or different, why, and how sure that is.
//!
//! Every sentence follows from the rows of the table of pairs, without those of the control, and covers only
//! the motions in these rows.

use equations::Role;

use super::decision;
use crate::contradiction::FAULT;
use crate::{Beyond, Comparison, Gap, Pair, Verdict};
use motion::is_in_table;
use motion::numbers::{enumerate, precise, short};
use motion::{CERTAINTY, CHETAEV, REMOVED_CONSTRAINT, VAKONOMIC, VAKONOMIC_COSTATE};

/// Which of several motions is the user's: said where formulations differ.
const WHICH: &str = "Wheels, skates and rolling bodies follow Chetaev (d'Alembert–Lagrange): friction holds their \
                     constraints. Vakonomic motions solve constrained variational problems, such as optimal control.";

/// Which of them is the user's, in a few words.
const MINE: &str = "Wheels, skates and rolling bodies follow Chetaev (d'Alembert–Lagrange).";

/// Same or different, and which is the user's: one line; `None` without a Chetaev and a vakonomic motion.
pub fn answer(comparison: &Comparison) -> Option<String> {
    if !comparison.contradictions().is_empty() {
        return None;
    }
    let chetaev = comparison.run(CHETAEV)?;
    let pair = comparison.pair(chetaev, comparison.run(VAKONOMIC)?)?;
    let [different, same] = decision::in_brief(comparison);
    Some(match &pair.gap.verdict {
        Verdict::Different => format!("Different: Chetaev and vakonomic{different}. {MINE}"),
        Verdict::Undecided { because } if decision::proved_same(comparison) => {
            format!("Same: Chetaev and vakonomic{same}. Not seen in numbers: {because}.")
        }
        Verdict::Undecided { .. } => format!("Undecided: Chetaev and vakonomic{same}. {MINE}"),
        Verdict::Same => {
            let other = |p: &&Pair| p.gap.verdict == Verdict::Different && [p.first, p.second].contains(&chetaev);
            let rest = if rows(comparison).any(|p| other(&p)) { " Other formulations differ." } else { "" };
            format!("Same: Chetaev and vakonomic{same}, within the error estimates.{rest}")
        }
    })
}

/// Four answers, a few sentences each.
pub struct Headline {
    /// The same or different, and from when.
    pub verdict: String,
    /// Why.
    pub why: String,
    /// How sure that is; whether free constants could bring the motions together.
    pub sure: String,
    /// Which of them a real system follows; empty where none was seen to differ from Chetaev's.
    pub which: &'static str,
}

impl Headline {
    /// Of what has been compared so far.
    pub fn of(comparison: &Comparison) -> Headline {
        let contradictions = comparison.contradictions();
        if !contradictions.is_empty() {
            let found: Vec<String> = contradictions.iter().map(|found| format!("{found}.")).collect();
            let verdict = format!("No verdict: results contradict each other. {FAULT}");
            return Headline { verdict, why: found.join(" "), sure: String::new(), which: "" };
        }
        let verdict = [verdicts(comparison), without_motion(comparison)].concat().join(" ");
        let sure: Vec<String> = decision::sentences(comparison).into_iter().chain(errors(comparison)).collect();
        let newton = comparison.run(CHETAEV);
        let parts = |p: &Pair| p.gap.verdict == Verdict::Different && [p.first, p.second].map(Some).contains(&newton);
        let which = if rows(comparison).any(parts) { WHICH } else { "" };
        Headline { verdict, why: why(comparison).join(" "), sure: sure.join(" "), which }
    }
}

fn label(comparison: &Comparison, run: usize) -> &str {
    &comparison.runs[run].choice.label
}

/// Whether a run is of the table of formulations, not the control.
fn is_listed(comparison: &Comparison, run: usize) -> bool {
    is_in_table(comparison.runs[run].choice.formulation)
}

/// The pairs without the control.
pub fn rows(comparison: &Comparison) -> impl Iterator<Item = &Pair> {
    comparison.pairs.iter().filter(|p| is_listed(comparison, p.first) && is_listed(comparison, p.second))
}

/// Motions in classes: all rows between two of a class say the same, and each is in one of them.
fn classes(comparison: &Comparison) -> Vec<Vec<usize>> {
    let verdict = |a: usize, b: usize| comparison.pair(a, b).map(|p| p.gap.verdict == Verdict::Same);
    let mut classes: Vec<Vec<usize>> = Vec::new();
    for run in 0..comparison.runs.len() {
        if comparison.runs[run].outcome.is_err() || !is_listed(comparison, run) {
            continue;
        }
        let joins = |class: &&mut Vec<usize>| {
            let found: Vec<bool> = class.iter().filter_map(|&other| verdict(run, other)).collect();
            !found.is_empty() && found.iter().all(|same| *same)
        };
        match classes.iter_mut().find(joins) {
            Some(class) => class.push(run),
            None => classes.push(vec![run]),
        }
    }
    classes
}

/// Labels of a class; that a formulation agrees with a second form of itself goes without saying.
fn names(comparison: &Comparison, class: &[usize]) -> Vec<String> {
    let second = |i: &usize| class.len() > 1 && comparison.runs[*i].choice.formulation == VAKONOMIC_COSTATE;
    class.iter().filter(|i| !second(i)).map(|&i| label(comparison, i).to_owned()).collect()
}

fn verdicts(comparison: &Comparison) -> Vec<String> {
    let classes = classes(comparison);
    let names = |class: &[usize]| names(comparison, class);
    let across = |p: &&Pair| !classes.iter().any(|class| class.contains(&p.first) && class.contains(&p.second));
    let refused = comparison.runs.iter().any(|run| run.outcome.is_err());
    let (mut sentences, mut undecided) = (Vec::new(), Vec::new());
    match &classes[..] {
        [] => {}
        [class] if names(class).len() == 1 => sentences.push(alone(comparison, class[0])),
        [_] if !refused && rows(comparison).all(|p| p.gap.verdict == Verdict::Same) => {
            return vec![format!(
                "No formulation's motion differs from another's by more than the error estimates{}.",
                until(comparison)
            )];
        }
        [_, _, ..] if rows(comparison).filter(across).all(|p| p.gap.verdict == Verdict::Different) => {
            let each: Vec<String> = classes.iter().map(|class| names(class).join(" ≈ ")).collect();
            sentences.push(format!("{} different motions: {}.", classes.len(), each.join("; ")));
            if each.iter().any(|names| names.contains(" ≈ ")) {
                sentences.push(format!("≈: no difference above the error estimates{}.", until(comparison)));
            }
        }
        several => {
            let shared = several.iter().map(|class| names(class)).filter(|names| names.len() > 1);
            let none = |names: Vec<String>| {
                format!("{}: no difference above the error estimates{}.", enumerate(&names), until(comparison))
            };
            sentences.extend(shared.map(none));
        }
    }
    let main = [CHETAEV, VAKONOMIC, REMOVED_CONSTRAINT].map(|own| comparison.run(own));
    for p in rows(comparison) {
        let both = format!("{} and {}", label(comparison, p.first), label(comparison, p.second));
        match &p.gap.verdict {
            Verdict::Different if [p.first, p.second].iter().all(|i| main.contains(&Some(*i))) => {
                sentences.push(format!("{both} {}.", how_different(comparison, &p.gap)));
            }
            Verdict::Undecided { because } => undecided.push((because.clone(), both)),
            _ => {}
        }
    }
    sentences.extend(by_reason(undecided).iter().map(|(why, of)| format!("{}: undecided, {why}.", of.join("; "))));
    sentences
}

/// From when, by how much, in what.
fn how_different(comparison: &Comparison, gap: &Gap) -> String {
    if gap.certain_from.is_none() {
        return format!("differ, which is proved; {}", unseen(gap));
    }
    let largest = short(gap.largest);
    if let Some(t) = gap.passes[1] {
        return format!("differ by 1e-3 after {} s and by up to {largest}", short(gap.after(t)));
    }
    if gap.shows() {
        return format!("differ by less than 1e-3, by up to {largest}");
    }
    let coordinates = comparison.scene.system.coordinates.iter().zip(&gap.largest_by_coordinate);
    let certain = coordinates.zip(&gap.certain_by_coordinate).filter(|(_, from)| from.is_some());
    let certain: Vec<String> = certain.map(|((c, by), _)| format!("{} by up to {}", c.name, short(*by))).collect();
    format!("differ in {}, which the kinetic metric does not show", enumerate(&certain))
}

/// The measured bound for two motions that are proved to differ, but differ by no more than their errors.
pub fn unseen(gap: &Gap) -> String {
    match gap.bound() {
        bound if bound.is_finite() => {
            format!("by less than {} up to {} s: measured", short(bound), short(gap.after(gap.end)))
        }
        _ => "no difference was measured".into(),
    }
}

/// Up to when pairs without a difference were compared: the earliest end.
fn until(comparison: &Comparison) -> String {
    let same = rows(comparison).filter(|p| p.gap.verdict == Verdict::Same).map(|p| p.gap.after(p.gap.end));
    same.min_by(f64::total_cmp).map_or(String::new(), |t| format!(" up to {} s", short(t)))
}

/// Groups labels by reason, in the order of first occurrence.
fn by_reason(all: Vec<(String, String)>) -> Vec<(String, Vec<String>)> {
    let mut reasons: Vec<(String, Vec<String>)> = Vec::new();
    for (reason, of) in all {
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, named)) => named.push(of),
            None => reasons.push((reason, vec![of])),
        }
    }
    reasons
}

/// One motion, with nothing to compare it with.
fn alone(comparison: &Comparison, run: usize) -> String {
    let label = label(comparison, run);
    let Ok(motion) = &comparison.runs[run].outcome else { return String::new() };
    let what = if comparison.runs.len() > 1 { "Only this formulation has a motion" } else { "One motion" };
    format!("{what}: {label}, to {} s.", precise(motion.end() - motion.start()))
}

/// Which formulations have no motion, and why.
fn without_motion(comparison: &Comparison) -> Vec<String> {
    let in_table = comparison.runs.iter().filter(|run| is_in_table(run.choice.formulation));
    let refused = in_table.filter_map(|run| {
        // a reason may begin with the name of the formulation
        let (reason, name) = (run.outcome.as_ref().err()?.to_string(), format!("{}: ", run.choice.formulation.name));
        Some((reason.strip_prefix(&name).unwrap_or(&reason).to_owned(), run.choice.label.clone()))
    });
    let told = by_reason(refused.collect()).into_iter();
    told.map(|(reason, labels)| format!("{}: no motion, {reason}.", enumerate(&labels))).collect()
}

/// Why the motions part, or do not.
fn why(comparison: &Comparison) -> Vec<String> {
    let mut sentences = vec![format!("Constraint: {}.", comparison.integrability)];
    let pair = comparison.run(CHETAEV).zip(comparison.run(VAKONOMIC)).and_then(|(a, b)| comparison.pair(a, b));
    let growth = pair.and_then(|p| p.predicted.as_ref().zip(p.growth.as_ref()));
    // what is seen where another term is the larger one is not fitted to this one
    if let Some((predicted, measured)) = growth.filter(|(predicted, measured)| measured.is_of(predicted)) {
        sentences.push(format!(
            "Predicted growth of the gap between Chetaev and vakonomic: {} t^{}; fitted: {} t^{:.2}.",
            precise(predicted.length),
            predicted.exponent,
            precise(measured.length),
            measured.exponent
        ));
    }
    sentences.extend(comparison.beyond.as_ref().map(|beyond| contacts(comparison, beyond.as_ref())));
    let substituted: Vec<String> = substituted(comparison).map(|i| label(comparison, i).to_owned()).collect();
    if !substituted.is_empty() {
        sentences.push(format!(
            "No memory variable has a costate (P = 0) in {}: this is substitution of the constraint into L.",
            enumerate(&substituted)
        ));
    }
    sentences.extend(breaches(comparison));
    sentences
}

/// What the vakonomic motion asks of contacts.
fn contacts(comparison: &Comparison, beyond: Option<&Beyond>) -> String {
    let Some(Beyond { coordinate, force, t }) = beyond else {
        return "Contact forces can also produce the vakonomic motion.".into();
    };
    let angle = comparison.scene.system.coordinates.iter().any(|c| c.name == *coordinate && c.unit == "rad");
    let what = if angle { "torque" } else { "generalized force" };
    format!(
        "The vakonomic motion needs a {what} of {} along {coordinate} (at t = {}) that no contact can exert.",
        precise(force.abs()),
        short(*t)
    )
}

/// For each quantity that the user expects to be constant and some formulation changes: which do.
fn breaches(comparison: &Comparison) -> Vec<String> {
    let motions = || {
        let runs = comparison.runs.iter().enumerate().filter(|(i, _)| is_listed(comparison, *i));
        runs.filter_map(|(i, run)| Some((label(comparison, i), run.outcome.as_ref().ok()?)))
    };
    let mut names: Vec<&str> = motions().flat_map(|(_, motion)| &motion.breaches).map(|b| &b.name[..]).collect();
    names.sort_unstable();
    names.dedup();
    let of = |name: &str| {
        let breaches = || motions().flat_map(|(label, m)| m.breaches.iter().map(move |breach| (label, breach)));
        let of_name = || breaches().filter(|(_, breach)| breach.name == name);
        let changed: Vec<_> = of_name().map(|(label, b)| format!("{label} (by {})", short(b.largest))).collect();
        let kept = motions().filter(|(_, motion)| of_name().all(|(_, breach)| motion.keeps(breach)));
        let kept: Vec<_> = kept.map(|(label, _)| label.to_owned()).collect();
        let kept = if kept.is_empty() { String::new() } else { format!("; constant for {}", enumerate(&kept)) };
        format!("{name} is not constant for {}{kept}.", enumerate(&changed))
    };
    names.into_iter().map(of).collect()
}

/// The runs of the removed constraint whose equations are Lagrange's of the substituted `L`: with `P ≡ 0`,
/// `G = L + P·B` is `L`.
fn substituted(comparison: &Comparison) -> impl Iterator<Item = usize> {
    let constrained = !comparison.scene.system.constraints.is_empty();
    comparison.runs.iter().enumerate().filter_map(move |(i, run)| {
        let motion = run.outcome.as_ref().ok().filter(|_| constrained && run.choice.removal.is_some())?;
        let costate = motion.equations.states.iter().any(|y| y.role == Role::MemoryCostate);
        (!costate && is_listed(comparison, i)).then_some(i)
    })
}

/// The size of the error estimates behind the verdicts.
fn errors(comparison: &Comparison) -> Option<String> {
    let estimates = rows(comparison).flat_map(|p| p.gap.estimates);
    let largest =
        estimates.fold(None, |a: Option<f64>, b| Some(a.map_or(b, |a| if b > a || b.is_nan() { b } else { a })))?;
    let indefinite = if rows(comparison).any(|p| p.gap.indefinite) {
        " M is not positive definite: gaps are lengths by |M|, whose eigenvalues have no signs. Each coordinate is also \
         judged by its own estimates."
    } else {
        ""
    };
    Some(format!(
        "Error estimates: at most {}; a gap counts from {CERTAINTY} times the sum of two.{indefinite}",
        short(largest)
    ))
}
