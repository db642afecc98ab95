//! The first page of the reports.

use deltaq::{Answer, CHETAEV, Comparison, Fit, Membership, REMOVED_CONSTRAINT, VAKONOMIC, Verdict};
use equations::Formulation;

use crate::report::control::{self, Control};
use deltaq::words::{enumerate, precise, short};
use pages::verdict_words;
use pages::{Table, fill, membership};

/// One page: verdict matrix, findings, further pages (`further`: a line and a path), how to regenerate.
pub fn overview(comparisons: &[Comparison], further: &[(&str, &str)]) -> String {
    let controls: Vec<Option<Control>> = comparisons.iter().map(Control::on).collect();
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

fn gap_words(comparison: &Comparison, a: &Formulation, b: &Formulation) -> String {
    let (Some(a), Some(b)) = (comparison.run(a), comparison.run(b)) else { return "–".into() };
    match comparison.pair(a, b) {
        Some(pair) => match &pair.gap.verdict {
            Verdict::Undecided { .. } => "undecided".into(),
            _ => verdict_words(&pair.gap),
        },
        None => "refused".into(),
    }
}

fn verdict_of<'a>(comparison: &'a Comparison, a: &Formulation, b: &Formulation) -> Option<&'a Verdict> {
    comparison.pair(comparison.run(a)?, comparison.run(b)?).map(|p| &p.gap.verdict)
}

fn fit_of<'a>(comparison: &'a Comparison, run: &Formulation, target: &Formulation) -> Option<&'a Fit> {
    let (run, target) = (comparison.run(run)?, comparison.run(target)?);
    comparison.fits.iter().find(|f| f.run == run && f.target == target)
}

fn matrix(comparisons: &[Comparison], controls: &[Option<Control>]) -> Table {
    let columns = ["scene", "constraint", "Chetaev – vakonomic", "any $\\mu_0$?", "gap reached", "Chetaev – removed"];
    let mut table = Table::new(columns.into_iter().chain(["vakonomic – removed", "control"]));
    for (c, control) in comparisons.iter().zip(controls) {
        let after = match fit_of(c, VAKONOMIC, CHETAEV).map(|f| &f.fitted) {
            None => "–".into(),
            Some(None) => "no fit".into(),
            Some(Some(fitted)) if fitted.gap.verdict == Verdict::Same => "same".to_string(),
            Some(Some(fitted)) => format!("gap {}", short(fitted.gap.largest)),
        };
        let control = control.as_ref().map_or("–", Control::word);
        let constraint = c.integrability.to_string();
        let constraint = constraint.split([':', '(']).next().unwrap_or("").trim();
        let pairs = [(CHETAEV, VAKONOMIC), (CHETAEV, REMOVED_CONSTRAINT), (VAKONOMIC, REMOVED_CONSTRAINT)];
        let [first, second, third] = pairs.map(|(a, b)| gap_words(c, a, b));
        let name = format!("[{0}](scenes/{0}.md)", c.scene.name);
        let decided = membership::words(c);
        table.row(&[&name, &constraint, &first, &decided, &after, &second, &third, &control]);
    }
    table
}

fn all_same(c: &Comparison) -> bool {
    [(CHETAEV, VAKONOMIC), (CHETAEV, REMOVED_CONSTRAINT), (VAKONOMIC, REMOVED_CONSTRAINT)]
        .iter()
        .all(|(a, b)| verdict_of(c, a, b) == Some(&Verdict::Same))
}

fn names<'a>(comparisons: impl Iterator<Item = &'a Comparison>) -> Vec<String> {
    comparisons.map(|c| format!("`{}`", c.scene.name)).collect()
}

fn headline(comparisons: &[Comparison]) -> String {
    let same = comparisons.iter().filter(|c| all_same(c)).count();
    let apart = names(comparisons.iter().filter(|c| verdict_of(c, CHETAEV, VAKONOMIC) == Some(&Verdict::Different)));
    let count = |wanted: fn(&Answer) -> bool| {
        comparisons
            .iter()
            .filter(|c| apart.contains(&format!("`{}`", c.scene.name)) && membership::is(c, wanted))
            .count()
    };
    format!(
        "On {same} of {} scenes no difference between the three formulations is above the error estimates. Chetaev's and the vakonomic motion part on {}; \
         on {} of these it is proved that no choice of the free multipliers brings them together, on {} a choice that does is known.",
        comparisons.len(),
        apart.len(),
        count(|answer| matches!(answer, Answer::NoneProved { .. })),
        count(|answer| matches!(answer, Answer::SomeProved | Answer::Some { .. })),
    )
}

fn findings(comparisons: &[Comparison], controls: &[Control]) -> Vec<String> {
    let mut findings = Vec::new();
    let integrable: Vec<&Comparison> = comparisons.iter().filter(|c| c.integrability.is_integrable()).collect();
    let agreeing = names(integrable.iter().copied().filter(|c| all_same(c)));
    findings.push(format!(
        "**Where the constraint can be integrated, the formulations agree on the scenes tried.** Frobenius' test finds {} integrable or free of constraints; all formulations agree on {}.",
        enumerate(&names(integrable.iter().copied())),
        enumerate(&agreeing)
    ));
    let decided = |wanted: fn(&Answer) -> bool| {
        let nonintegrable = comparisons.iter().filter(|c| !c.integrability.is_integrable());
        enumerate(&names(nonintegrable.filter(|c| membership::is(c, wanted))))
    };
    findings.extend(constants_of_removal(&integrable));
    findings.push(format!(
        "**Vakonomic is a family, Chetaev one motion.** Where the constraint cannot be integrated, some $\\mu_0$ gives the Chetaev motion on {}; \
         on {} none does, and that is proved for the start of the scene and for almost every other.",
        decided(|answer| matches!(answer, Answer::SomeProved | Answer::Some { .. })),
        decided(|answer| matches!(answer, Answer::NoneProved { .. })),
    ));
    findings.push(parametrizations(comparisons));
    findings.push(control::sentence(controls));
    findings.extend(predictions(comparisons));
    findings
}

/// What the free constants of removal do where Newton's motion is beyond dispute.
fn constants_of_removal(integrable: &[&Comparison]) -> Option<String> {
    let mut examples = Vec::new();
    for c in integrable {
        let Some(fit) = fit_of(c, REMOVED_CONSTRAINT, CHETAEV) else { continue };
        let (Some(fitted), Some(pair)) = (&fit.fitted, c.pair(fit.run, fit.target)) else { continue };
        let constants: Vec<String> =
            fitted.constants.iter().map(|(name, x)| format!("{name} = {}", precise(*x))).collect();
        let left = match fitted.gap.verdict {
            Verdict::Same => "it is Newton's motion".to_string(),
            _ => format!("a gap of {} remains", short(fitted.gap.largest)),
        };
        examples.push(format!(
            "on `{}` the scene's constants give a gap of {} to Newton's motion; with {} {left}",
            c.scene.name,
            short(pair.gap.largest),
            constants.join(", ")
        ));
    }
    (!examples.is_empty()).then(|| {
        format!(
            "**Removal needs its constants fixed even there.** Where the parameters are not coordinates, {}.",
            examples.join("; ")
        )
    })
}

fn parametrizations(comparisons: &[Comparison]) -> String {
    let (mut has, mut lacks, mut apart) = (Vec::new(), Vec::new(), Vec::new());
    for c in comparisons {
        let run = |i: usize| &c.runs[i].choice;
        let removal = |i: usize| run(i).removal.as_ref().map_or("", |r| r.name.as_str());
        let removed = |i: usize| run(i).formulation == REMOVED_CONSTRAINT;
        for d in c.decided.iter().filter(|d| removed(d.family) && run(d.curve).formulation == VAKONOMIC) {
            let words = format!("`{}` ({})", c.scene.name, removal(d.family));
            match d.outcome.as_ref().map(Membership::answer) {
                Ok(Answer::SomeProved | Answer::Some { .. }) => has.push(words),
                _ => lacks.push(words),
            }
        }
        for p in c.pairs.iter().filter(|p| removed(p.first) && removed(p.second)) {
            if p.gap.verdict == Verdict::Different {
                apart.push(format!("`{}`, {} and {}", c.scene.name, removal(p.first), removal(p.second)));
            }
        }
    }
    let none_found = match &lacks[..] {
        [] => "that is on each of them".to_string(),
        lacks => format!("on {} none was found", enumerate(lacks)),
    };
    format!(
        "**Removal by coordinates has the vakonomic motions and no others; other parameters may have more.** Of removals with variables of their own \
         and all costates kept, some $P(t_0)$ gives the vakonomic motion on {}; {none_found}. With the constants that their rules \
         give, two removals of one constraint have different motions on {}.",
        enumerate(&has),
        enumerate(&apart)
    )
}

fn predictions(comparisons: &[Comparison]) -> Option<String> {
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
            "**How motions begin to part is predictable.** For {count} pairs of motions the leading term of the gap follows from the Taylor coefficients of their accelerations at the start; \
             the measured one is off by at most {} % (`{name}`).",
            short(100.0 * off)
        )
    })
}
