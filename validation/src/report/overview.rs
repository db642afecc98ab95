//! The first page of the reports.

use comparison::{Answer, Comparison, Fit, Membership, Verdict};
use equations::Formulation;
use mechanics::Integrability;
use motion::{CHETAEV, REMOVED_CONSTRAINT, VAKONOMIC};

use crate::report::control::{self, Control};
use crate::report::{AS_PRINTED, CASADI};
use comparison::words::{enumerate, reached, short};
use pages::{Table, fill, membership};

/// One page: verdict matrix, findings, further pages (`further`: a line and a path), how to regenerate. The
/// scene that belongs to the paper's audit is left out.
pub fn overview(comparisons: &[Comparison], further: &[(&str, &str)]) -> String {
    let comparisons = &of_scenes(comparisons)[..];
    let controls: Vec<Option<Control>> = comparisons.iter().map(|c| Control::on(c)).collect();
    let matrix = matrix(comparisons, &controls);
    let controls: Vec<Control> = controls.into_iter().flatten().collect();
    let findings =
        findings(comparisons, &controls).into_iter().zip(1..).map(|(finding, i)| format!("{i}. {finding}\n"));
    fill(
        include_str!("pages/overview.md"),
        &[
            ("headline", &headline(comparisons)),
            ("matrix", &matrix),
            ("findings", &findings.collect::<String>()),
            ("further", &further.iter().map(|(line, path)| format!("- {line} [More]({path}).\n")).collect::<String>()),
        ],
    )
}

/// A page to cite: question, method, six results, each with its condition and how it is known, limits.
pub fn summary(comparisons: &[Comparison], further: &[(&str, &str)]) -> String {
    let comparisons = &of_scenes(comparisons)[..];
    let controls: Vec<Control> = comparisons.iter().filter_map(|c| Control::on(c)).collect();
    let of = |page: &str| further.iter().find(|(_, path)| path.ends_with(page)).map_or("*Not run.*", |(line, _)| line);
    let pairs = comparisons.iter().flat_map(|c| &c.pairs).filter_map(|p| p.predicted.as_ref());
    let (predicted, proved) = pairs.fold((0, 0), |(all, proved), p| (all + 1, proved + usize::from(p.proved)));
    fill(
        include_str!("pages/summary.md"),
        &[
            ("scenes", &headline(comparisons)),
            ("classics", &of("equivalence.md")),
            ("realization", &of("realization.md")),
            ("growth", &predictions(comparisons).unwrap_or_default()),
            ("predicted", &predicted),
            ("proved", &proved),
            ("random", &of("random.md")),
            ("audit", &of("audit.md")),
            ("stability", &of("stability.md")),
            ("referees", &of(CASADI)),
            ("control", &control::sentence(&controls)),
            ("version", &env!("CARGO_PKG_VERSION")),
        ],
    )
}

/// All but the scene of the paper's audit.
fn of_scenes(comparisons: &[Comparison]) -> Vec<&Comparison> {
    comparisons.iter().filter(|c| c.scene.name != AS_PRINTED).collect()
}

/// A sign for a pair of motions.
fn sign(comparison: &Comparison, a: &Formulation, b: &Formulation) -> &'static str {
    match verdict_of(comparison, a, b) {
        Some(Verdict::Same) => "=",
        Some(Verdict::Different) => "**≠**",
        Some(Verdict::Undecided { .. }) => "?",
        None => "–",
    }
}

fn verdict_of<'a>(comparison: &'a Comparison, a: &Formulation, b: &Formulation) -> Option<&'a Verdict> {
    comparison.pair(comparison.run(a)?, comparison.run(b)?).map(|p| &p.gap.verdict)
}

fn fit_of<'a>(comparison: &'a Comparison, run: &Formulation, target: &Formulation) -> Option<&'a Fit> {
    let (run, target) = (comparison.run(run)?, comparison.run(target)?);
    comparison.fits.iter().find(|f| f.run == run && f.target == target)
}

fn matrix(comparisons: &[&Comparison], controls: &[Option<Control>]) -> Table {
    let columns = ["scene", "holonomic", "Chetaev, vakonomic", "Chetaev, removed", "vakonomic, removed"];
    let mut table = Table::new(columns.into_iter().chain(["$\\mu_0$", ">closest", "control"]));
    for (c, control) in comparisons.iter().zip(controls) {
        let closest = match fit_of(c, VAKONOMIC, CHETAEV).map(|f| &f.fitted) {
            None => "–".into(),
            Some(None) => "no fit".into(),
            Some(Some(fitted)) if fitted.gap.verdict == Verdict::Same => "=".to_string(),
            Some(Some(fitted)) => reached(fitted),
        };
        let control = control.as_ref().map_or("–", Control::word);
        let integrable = match &c.integrability {
            Integrability::Unconstrained => "no constraint",
            Integrability::Integrable { .. } => "yes",
            Integrability::PartlyIntegrable { .. } => "partly",
            Integrability::Nonintegrable { .. } => "no",
            Integrability::NonlinearInVelocity => "not linear in $\\dot q$",
            Integrability::Undecided { .. } => "?",
        };
        let [first, second, third] = PAIRS.map(|(a, b)| sign(c, a, b));
        let name = format!("[{0}](scenes/{0}.md)", c.scene.name);
        table.row(&[&name, &integrable, &first, &second, &third, &membership::word(c), &closest, &control]);
    }
    table
}

/// The pairs of the matrix.
const PAIRS: [(&Formulation, &Formulation); 3] =
    [(CHETAEV, VAKONOMIC), (CHETAEV, REMOVED_CONSTRAINT), (VAKONOMIC, REMOVED_CONSTRAINT)];

fn all_same(c: &Comparison) -> bool {
    PAIRS.iter().all(|(a, b)| verdict_of(c, a, b) == Some(&Verdict::Same))
}

fn names<'a>(comparisons: impl Iterator<Item = &'a Comparison>) -> Vec<String> {
    comparisons.map(|c| format!("`{}`", c.scene.name)).collect()
}

fn headline(comparisons: &[&Comparison]) -> String {
    let same = comparisons.iter().filter(|c| all_same(c)).count();
    let apart =
        names(comparisons.iter().copied().filter(|c| verdict_of(c, CHETAEV, VAKONOMIC) == Some(&Verdict::Different)));
    let count = |wanted: fn(&Answer) -> bool| {
        comparisons
            .iter()
            .filter(|c| apart.contains(&format!("`{}`", c.scene.name)) && membership::is(c, wanted))
            .count()
    };
    format!(
        "The d'Alembert–Lagrange (Chetaev) and the vakonomic motion differ on {} of {} scenes. On {} of these it is proved that \
         no initial multipliers reconcile them; for {} we give multipliers that do. On {same} scenes no difference between \
         the three formulations exceeds the error estimates.",
        apart.len(),
        comparisons.len(),
        count(|answer| matches!(answer, Answer::NoneProved { .. })),
        count(|answer| matches!(answer, Answer::SomeProved | Answer::Some { .. })),
    )
}

/// At most 40 words each.
fn findings(comparisons: &[&Comparison], controls: &[Control]) -> Vec<String> {
    let mut findings = Vec::new();
    let is_holonomic = |c: &&Comparison| c.integrability.is_integrable();
    let integrable: Vec<&Comparison> = comparisons.iter().copied().filter(is_holonomic).collect();
    let agreeing = names(integrable.iter().copied().filter(|c| all_same(c)));
    findings.push(format!(
        "**Holonomic constraints: the formulations agree.** Frobenius' test finds {} scenes holonomic or unconstrained; all \
         formulations agree on {}.",
        integrable.len(),
        enumerate(&agreeing)
    ));
    let nonintegrable: Vec<&Comparison> = comparisons.iter().copied().filter(|c| !is_holonomic(c)).collect();
    let decided =
        |wanted: fn(&Answer) -> bool| names(nonintegrable.iter().copied().filter(|c| membership::is(c, wanted)));
    findings.extend(constants_of_removal(&integrable));
    findings.push(format!(
        "**The vakonomic equations have a family of motions, Chetaev's equations one.** If the constraint is nonholonomic, some \
         $\\mu_0$ gives Chetaev's motion on {}; none does on {} scenes, proved for their start and almost every other.",
        enumerate(&decided(|answer| matches!(answer, Answer::SomeProved | Answer::Some { .. }))),
        decided(|answer| matches!(answer, Answer::NoneProved { .. })).len(),
    ));
    findings.push(parametrizations(comparisons));
    findings.push(control::sentence(controls));
    findings.extend(predictions(comparisons));
    findings
}

/// What the free constants of removal do where Newton's motion is beyond dispute, on the scene with the
/// largest gap.
fn constants_of_removal(integrable: &[&Comparison]) -> Option<String> {
    let fitted = integrable.iter().filter_map(|c| {
        let fit = fit_of(c, REMOVED_CONSTRAINT, CHETAEV)?;
        Some((c.scene.name.as_str(), fit.fitted.as_ref()?, c.pair(fit.run, fit.target)?.gap.largest))
    });
    let (scene, fitted, gap) = fitted.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let constants: Vec<String> = fitted.constants.iter().map(|(name, x)| format!("{name} = {}", short(*x))).collect();
    let left = match fitted.gap.verdict {
        Verdict::Same => "it is Newton's".to_string(),
        _ => format!("a gap of {} remains", reached(fitted)),
    };
    Some(format!(
        "**Removal needs its constants fixed even there.** On `{scene}`, whose parameters are not coordinates, the motion with \
         the default constants differs from Newton's by up to {} m √kg; with {} {left}.",
        short(gap),
        enumerate(&constants)
    ))
}

fn parametrizations(comparisons: &[&Comparison]) -> String {
    let (mut has, mut lacks, mut apart) = (0, Vec::new(), 0);
    for c in comparisons {
        let run = |i: usize| &c.runs[i].choice;
        let removal = |i: usize| run(i).removal.as_ref().map_or("", |r| r.name.as_str());
        let removed = |i: usize| run(i).formulation == REMOVED_CONSTRAINT;
        for d in c.decided.iter().filter(|d| removed(d.family) && run(d.curve).formulation == VAKONOMIC) {
            match d.outcome.as_ref().map(Membership::answer) {
                Ok(Answer::SomeProved | Answer::Some { .. }) => has += 1,
                _ => lacks.push(format!("`{}` ({})", c.scene.name, removal(d.family))),
            }
        }
        let pairs = c.pairs.iter().filter(|p| removed(p.first) && removed(p.second));
        apart += pairs.filter(|p| p.gap.verdict == Verdict::Different).count();
    }
    let otherwise = match &lacks[..] {
        [] => String::new(),
        lacks => format!(" (not those of {})", enumerate(lacks)),
    };
    format!(
        "**Removal by coordinates yields exactly the vakonomic family.** {has} of {} removals with variables of their own \
         and all costates contain the vakonomic motion{otherwise}. In {apart} cases two removals of one constraint disagree.",
        has + lacks.len(),
    )
}

fn predictions(comparisons: &[&Comparison]) -> Option<String> {
    let mut worst: Option<(f64, &str)> = None;
    let mut count = 0;
    for c in comparisons {
        for p in &c.pairs {
            if let (Some(measured), Some(predicted)) = (&p.growth, &p.predicted) {
                count += 1;
                let off = measured.deviation_from(predicted);
                if worst.is_none_or(|w| off > w.0) {
                    worst = Some((off, &c.scene.name));
                }
            }
        }
    }
    worst.map(|(off, name)| {
        format!(
            "**The initial growth of the gap is predicted.** Taylor coefficients of the accelerations at the start give the \
             leading term of the gap for {count} pairs, within {} % of the measured one (worst: `{name}`).",
            short(100.0 * off)
        )
    })
}
