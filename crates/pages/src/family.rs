//! The vakonomic motions of a scene over a line of `μ₀`, for pictures.

use anyhow::Result;
use comparison::{Answer, Comparison, Verdict};
use motion::{CHETAEV, Ensemble, EnsembleOptions, MemberMotion, Settings, VAKONOMIC};
use picture::{Curve, Style};

use comparison::words::short;

/// The last `s`, and members up to there after the first.
const END: f64 = 1.5;
const MEMBERS: u32 = 24;

/// The vakonomic family about Chetaev's motion, read off at these times: motions with `μ₀ = a + s (b − a)`,
/// `s` from 0 to [`END`], `a` of the run that is drawn and `b` of the motion nearest to Chetaev's; then this
/// one. None where the two do not differ, or neither a decision nor a fit tells what is nearest.
///
/// # Errors
/// Where the family has no equations.
pub(crate) fn family(
    comparison: &Comparison,
    times: &[f64],
    read: impl Fn(&[f64]) -> (f64, f64),
) -> Result<Vec<Curve>> {
    let Some((run, target)) = comparison.run(VAKONOMIC).zip(comparison.run(CHETAEV)) else { return Ok(Vec::new()) };
    let different = comparison.pair(run, target).is_some_and(|pair| pair.gap.verdict == Verdict::Different);
    let decided = comparison.membership().and_then(|found| found.as_ref().ok());
    let decided = decided.filter(|found| matches!(found.answer(), Answer::SomeProved | Answer::Some { .. }));
    let fit = comparison.fits.iter().find(|fit| (fit.run, fit.target) == (run, target));
    let fitted = fit.and_then(|fit| fit.fitted.as_ref());
    let fitted = fitted.map(|fitted| fitted.constants.iter().map(|(_, mu)| *mu).collect::<Vec<f64>>());
    let nearest = decided.map(|found| found.decision.set.point.clone()).or(fitted);
    let (Some(b), Ok(motion), true) = (nearest, &comparison.runs[run].outcome, different) else {
        return Ok(Vec::new());
    };
    let at = |i: u32| {
        let s = END * f64::from(i) / f64::from(MEMBERS);
        motion.constants.iter().zip(&b).map(|(a, b)| a + s * (b - a)).collect::<Vec<f64>>()
    };
    let mut rows: Vec<Vec<f64>> = (0..=MEMBERS).map(at).collect();
    rows.push(b.clone());
    let names = comparison.scene.multiplier_names();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let ensemble = Ensemble::new(&comparison.scene, &comparison.runs[run].choice, &names, &Settings::default())?;
    let options = EnsembleOptions { threads: 1, estimate: false };
    let motions = ensemble.answers(ensemble.members(&rows, options.threads), times, &options);
    let words = |mu: &[f64]| match mu {
        [mu] => short(*mu),
        _ => format!("b = ({})", mu.iter().map(|mu| short(*mu)).collect::<Vec<_>>().join(", ")),
    };
    let failed = motions.iter().filter(|motion| motion.is_err()).count();
    let failed = if failed > 0 { format!(", {failed} of them without a motion") } else { String::new() };
    let which = match (&motion.constants[..], &b[..]) {
        ([a], [b]) => format!("from {} to {}", short(*a), short(a + END * (b - a))),
        (a, _) if a.iter().all(|a| *a == 0.0) => format!("= s b, s from 0 to {END}"),
        _ => format!("= a + s (b − a), s from 0 to {END}"),
    };
    let band = format!("vakonomic, μ₀ {which}{failed}");
    let met = if decided.is_some() { "equal to Chetaev's" } else { "nearest found" };
    let point = format!("vakonomic, {met}: μ₀ = {}", words(&b));
    let curve = |(i, motion): (usize, Result<MemberMotion, String>)| {
        let (label, style) = if i + 1 < rows.len() { (&band, Style::Family) } else { (&point, Style::Member(1)) };
        let outputs = motion.map_or(Vec::new(), |motion| motion.outputs);
        Curve { label: label.clone(), style, points: outputs.iter().map(|now| read(&now.coordinates)).collect() }
    };
    Ok(motions.into_iter().enumerate().map(curve).collect())
}
