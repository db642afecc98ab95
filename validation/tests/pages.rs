//! Numbers on pages against what they were taken from, cell by cell, and sentences against their tables.

use std::collections::BTreeMap;

use comparison::{Comparison, Finding, Fit, Fits, FittedMotion, Membership, Verdict, compare_unfitted};
use integrate::{Method, Projection};
use motion::{CHETAEV, Ending, Form, Metric, Settings, SolveError, VAKONOMIC, choices, solve_choice};
use pages::{membership::Decision, scene_files, summary, verdicts};
use program::File;
use review::substitution::SUBSTITUTION;
use serde_json::{Value, json};
use validation::casadi_job::Outcome;
use validation::report::{AuditReport, overview, referees_files, summary as page_to_cite};

/// A scene in all formulations, the control among them.
fn compared(name: &str, duration: f64, settings: &Settings) -> Comparison {
    let scene = scene::catalogue::find(name, &[("duration".into(), duration.into())]).expect("built in");
    let choices = choices(&scene);
    let control = review::substitution::run(&scene, &choices, settings).into_iter().collect();
    compare_unfitted(scene, choices, control, settings).expect("compared")
}

/// The rows of the first table behind these words: cells by the name of their column.
pub(crate) fn table(page: &str, behind: &str) -> Vec<BTreeMap<String, String>> {
    let rest = page.split_once(behind).unwrap_or_else(|| panic!("{behind}")).1;
    let lines: Vec<&str> = rest.lines().skip_while(|line| !line.starts_with('|')).collect();
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().replace('\u{2212}', "-")).collect()
    };
    let names = cells(lines[0]);
    let rows = lines[2..].iter().take_while(|line| line.starts_with('|'));
    rows.map(|row| names.iter().cloned().zip(cells(row)).collect()).collect()
}

/// The cells of a line of CSV.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().expect("a cell").push(c),
        }
    }
    cells
}

/// The rows of a CSV of this name: cells by the name of their column.
fn csv(files: &[File], name: &str) -> Vec<BTreeMap<String, String>> {
    let file = files.iter().find(|file| file.path.ends_with(format!("{name}.csv"))).unwrap_or_else(|| panic!("{name}"));
    let mut lines = file.text.lines().map(cells);
    let names = lines.next().expect("a head");
    lines.map(|row| names.iter().cloned().zip(row).collect()).collect()
}

/// Whether a cell says this number, or is empty or a dash for none.
#[track_caller]
fn says(cell: &str, value: Option<f64>) {
    let told = cell.parse::<f64>().ok();
    let near = |(told, value): (f64, f64)| (told - value).abs() <= 0.06 * value.abs();
    assert!(
        if ["–", ""].contains(&cell) { value.is_none() } else { told.zip(value).is_some_and(near) },
        "`{cell}` for {value:?}"
    );
}

#[test]
fn the_tables_of_a_scene_say_what_its_rows_are() {
    // errors, residuals and drifts that are no round-off
    let settings = Settings {
        tolerance: 1e-6,
        method: Some(Method::Dop853),
        projection: Projection::Off,
        form: Form::Named,
        ..Settings::default()
    };
    let mut sledge = compared("sledge", 1.5, &settings);
    let gap = sledge.pairs[0].gap.clone();
    let fitted = FittedMotion {
        constants: vec![("mu0_1".into(), 0.25)],
        gap: comparison::Gap { largest: 0.125, ..gap },
        starts: 7,
        by_half: 0.126,
    };
    let vakonomic = sledge.run(VAKONOMIC).expect("a run");
    sledge.fits.push(Fit { run: vakonomic, target: 0, fitted: Some(fitted), by_identity: false });
    let files = scene_files(&mut sledge).expect("files");
    let label = |i: usize| sledge.runs[i].choice.label.clone();

    let rows = csv(&files, "pairs");
    assert_eq!(rows.len(), sledge.pairs.len());
    for (row, pair) in rows.iter().zip(&sledge.pairs) {
        assert_eq!(row["pair"], format!("{} – {}", label(pair.first), label(pair.second)));
        assert_eq!(row["verdict"].trim_matches('*').split(':').next(), Some(pair.gap.verdict.word()));
        for (name, passes) in ["1e-6 after (s)", "1e-3 after (s)", "0.1 after (s)"].into_iter().zip(pair.gap.passes) {
            says(&row[name], passes);
        }
        says(&row["largest gap"], Some(pair.gap.largest));
        says(&row["errors, both"], Some(pair.gap.estimates.iter().sum()));
        for (c, d) in sledge.scene.system.coordinates.iter().zip(&pair.gap.largest_by_coordinate) {
            says(&row[&format!("largest in {} ({})", c.name, c.unit)], Some(*d));
        }
    }
    let rows = csv(&files, "growth");
    let grown: Vec<_> = sledge.pairs.iter().filter(|p| p.growth.is_some()).collect();
    assert!(rows.len() == grown.len() && grown.iter().any(|p| p.predicted.is_some()));
    for (row, pair) in rows.iter().zip(grown) {
        let growth = pair.growth.as_ref().expect("a growth");
        says(&row["exponent"], Some(growth.exponent));
        says(&row["leading coefficient"], Some(growth.length));
        let Some(predicted) = &pair.predicted else { continue };
        says(&row["predicted coefficient"], Some(predicted.length));
        let length = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>().sqrt();
        let both = growth.coefficient.iter().zip(&predicted.coefficient);
        let off = length(&mut both.map(|(a, b)| a - b)) / length(&mut predicted.coefficient.iter().copied());
        says(&row["off by (%)"], Some(100.0 * off));
        assert_eq!(row["proved"] == "yes", predicted.proved);
    }
    let rows = csv(&files, "fits");
    says(&rows[0]["largest gap before"], Some(sledge.pairs[0].gap.largest));
    says(&rows[0]["largest gap, best found"], Some(0.125));
    says(&rows[0]["half of the guesses"], Some(0.126));
    assert_eq!((&rows[0]["by"][..], &rows[0]["starting guesses"][..], rows.len()), ("search", "7", 1));

    let mut metric = Metric::new(&sledge.scene.system).expect("a metric");
    let (rows, constant) = (csv(&files, "residuals"), csv(&files, "constant"));
    let mut judged = 0;
    for run in &mut sledge.runs {
        let Ok(motion) = &mut run.outcome else { continue };
        let Some(row) = rows.iter().find(|row| row["motion"] == run.choice.label) else { continue };
        let times = motion.grid(motion::band::SAMPLES);
        let mut residuals = Vec::new();
        let mut values: Vec<Vec<f64>> = Vec::new();
        for &t in &times {
            let now = motion.at(t).expect("in range");
            residuals.push(metric.constraint_residual(t, &now.coordinates, &now.velocities));
            values.push(now.invariants);
        }
        let largest = residuals.iter().fold(0.0_f64, |a, r| a.max(*r));
        says(&row["largest constraint residual"], Some(largest));
        for (i, named) in motion.equations.invariants.iter().enumerate() {
            let drift = values.iter().map(|now| (now[i] - values[0][i]).abs()).fold(0.0, f64::max);
            let is_this = |told: &&BTreeMap<String, String>| {
                (&told["motion"], &told["constant by theory"]) == (&run.choice.label, &named.name)
            };
            says(&constant.iter().find(is_this).expect("an invariant")["largest deviation"], Some(drift));
            judged += usize::from(drift > 0.0);
        }
        // the printed value is not that of the end
        judged += usize::from(residuals.last().is_some_and(|last| *last < 0.5 * largest));
    }
    assert!(judged >= 2, "{judged}");
}

#[test]
fn the_summary_and_the_verdicts_say_what_the_rows_are() {
    let mut sledge = compared("sledge", 1.5, &Settings::default());
    let told = json!(verdicts(std::slice::from_ref(&sledge), false));
    let told = &told["scenes"]["sledge"];
    let number = |x: &Value| x.as_f64();
    for (told, pair) in told["pairs"].as_array().expect("pairs").iter().zip(&sledge.pairs) {
        assert_eq!(
            (told["verdict"].as_str(), &told["proved"]),
            (Some(pair.gap.verdict.word()), &pair.gap.proved.into())
        );
        for (told, passes) in told["passes"].as_array().expect("times").iter().zip(pair.gap.passes) {
            let near = number(told).zip(passes).is_some_and(|(a, b)| (a - b).abs() < 1e-3 * b);
            assert!(near || number(told).is_none() && passes.is_none(), "{told}, {passes:?}");
        }
    }
    assert!(sledge.pairs.iter().any(|p| !p.gap.proved) && sledge.pairs.iter().any(|p| p.gap.proved));
    for run in &sledge.runs {
        let end = run.outcome.as_ref().map(|motion| (motion.end(), motion.ending == Ending::Completed));
        assert_eq!(
            end.ok().filter(|(_, whole)| *whole).map(|(end, _)| end),
            number(&told["runs"][&run.choice.label]["end"])
        );
    }
    let text = summary(&mut sledge, 80).expect("a summary");
    let line = text.lines().find(|line| line.starts_with("a  Chetaev – vakonomic ")).expect("a row");
    let cells: Vec<&str> = line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    let gap = &sledge.pairs[0].gap;
    assert_eq!(cells[2], "different");
    says(cells[3], gap.passes[0]);
    says(cells[4], gap.passes[1]);
    says(cells[5], Some(gap.largest));
    // pairs that are not shown are counted by their verdicts
    let principal = |i: usize| [CHETAEV, VAKONOMIC].contains(&sledge.runs[i].choice.formulation);
    let others = comparison::words::rows(&sledge).filter(|p| !principal(p.first));
    let mut counts = BTreeMap::new();
    others.for_each(|p| *counts.entry(p.gap.verdict.word()).or_insert(0) += 1);
    let counted = ["different", "undecided"].map(|word| {
        let named = text.lines().filter(|line| line.starts_with(&format!("   {word}: removed ("))).count();
        (word, named)
    });
    let counted: BTreeMap<&str, usize> = counted.into_iter().filter(|(_, count)| *count > 0).collect();
    assert_eq!(counted, counts);
}

#[test]
fn the_overview_counts_its_own_table() {
    let settings = Settings::default();
    let scenes: Vec<Comparison> = [("sledge", 1.0), ("bowl", 1.0), ("disc", 0.5), ("heisenberg", 1.0)]
        .into_iter()
        .map(|(name, duration)| {
            let mut comparison = compared(name, duration, &settings);
            comparison.fit(Fits::None, &settings).expect("no fits");
            comparison
        })
        .collect();
    let page = overview(&scenes, &[("A line.", "page.md")]);
    let rows = table(&page, "# ");
    assert_eq!(rows.len(), scenes.len());
    let cell = |row: &BTreeMap<String, String>, name: &str| row[name].trim_matches('*').to_owned();
    let pairs = ["Chetaev, vakonomic", "Chetaev, removed", "vakonomic, removed"];
    let same = rows.iter().filter(|row| pairs.iter().all(|pair| cell(row, pair) == "=")).count();
    let part: Vec<_> = rows.iter().filter(|row| row[pairs[0]] == "**≠**").collect();
    let answer = |words: &[&str]| part.iter().filter(|row| words.contains(&&row["$\\mu_0$"][..])).count();
    let (proved, some) = (answer(&["none"]), answer(&["one", "*one*", "every", "*every*"]));
    assert!(same > 0 && part.len() > 1 && proved > 0 && some > 0, "{rows:?}");
    let headline = format!(
        "The d'Alembert–Lagrange (Chetaev) and the vakonomic motion differ on {} of {} scenes. On {proved} of these it is \
         proved that no initial multipliers reconcile them; for {some} we give multipliers that do. On {same} scenes no \
         difference between the three formulations exceeds the error estimates.",
        part.len(),
        rows.len()
    );
    assert!(page.contains(&headline), "{headline}\n{page}");
    // the page to cite says the same, and what further pages say
    let cited = page_to_cite(&scenes, &[("So many systems.", "evidence/equivalence.md")]);
    assert!(cited.contains(&headline) && cited.contains("So many systems.") && cited.split_whitespace().count() < 900);
    let named = |word: &str| -> Vec<String> {
        let name =
            |row: &BTreeMap<String, String>| format!("`{}`", row["scene"][1..].split_once(']').expect("a link").0);
        rows.iter().filter(|row| row["control"] == word).map(name).collect()
    };
    let control = format!(
        " and is flagged on {}. It is called right on {}, with",
        named("flagged").len(),
        comparison::words::enumerate(&named("right here"))
    );
    assert!(page.contains(&control), "{control}\n{page}");
    for (row, scene) in rows.iter().zip(&scenes) {
        let judged =
            scene.pairs.iter().find(|p| scene.runs[p.second].choice.formulation == &SUBSTITUTION && p.first == 0);
        let word = judged.map_or("–", |p| match p.gap.verdict {
            Verdict::Same => "right here",
            Verdict::Different => "flagged",
            Verdict::Undecided { .. } => "undecided",
        });
        assert_eq!(row["control"], word);
        let sign = match scene.pairs[0].gap.verdict {
            Verdict::Same => "=",
            Verdict::Different => "**≠**",
            Verdict::Undecided { .. } => "?",
        };
        assert_eq!(row[pairs[0]], sign);
    }
    let growths = scenes.iter().flat_map(|c| &c.pairs).filter_map(|p| p.growth.as_ref().zip(p.predicted.as_ref()));
    let off: Vec<f64> = growths.map(|(measured, predicted)| measured.deviation_from(predicted)).collect();
    let told = page.split_once("leading term of the gap for ").expect("a count").1;
    assert!(told.starts_with(&format!("{} pairs, within ", off.len())) && off.len() > 2, "{told}");
    let told = told.split_once("within ").expect("a part").1.split_once(" %").expect("a part").0;
    says(told, Some(100.0 * off.iter().fold(0.0_f64, |a, x| a.max(*x))));
    let findings = page.split_once("## Findings").expect("findings").1.split_once("## Evidence").expect("an end").0;
    for finding in findings.lines().filter(|line| !line.is_empty()) {
        assert!(finding.split_whitespace().count() <= 41, "more than a number and 40 words: {finding}");
    }
}

/// Removals that lack the vakonomic motion are named; here one whose membership is made unknown.
#[test]
fn the_overview_names_the_removals_that_lack_the_vakonomic_motion() {
    let mut scenes = vec![compared("sledge", 0.5, &Settings::default()), compared("disc", 0.5, &Settings::default())];
    let told = |scenes: &[Comparison]| -> (Vec<String>, String) {
        let page = overview(scenes, &[]);
        let asked = |c: &Comparison| -> Vec<(String, bool)> {
            let run = |i: usize| &c.runs[i].choice;
            let of = |i: usize| Some((c.scene.name.clone(), run(i).removal.as_ref()?.name.clone()));
            let asked = c.decided.iter().filter(|d| run(d.curve).formulation == VAKONOMIC);
            let asked = asked.filter_map(|d| of(d.family).map(|of| (of, &d.outcome)));
            asked.map(|((scene, name), found)| (format!("`{scene}` ({name})"), dimension(found).is_some())).collect()
        };
        let all: Vec<(String, bool)> = scenes.iter().flat_map(asked).collect();
        let lacks: Vec<String> = all.iter().filter(|(_, has)| !has).map(|(name, _)| name.clone()).collect();
        let (has, count) = (all.len() - lacks.len(), all.len());
        let not = if lacks.is_empty() {
            String::new()
        } else {
            format!(" (not those of {})", comparison::words::enumerate(&lacks))
        };
        let said = format!(
            "{has} of {count} removals with variables of their own and all costates contain the vakonomic motion{not}. "
        );
        assert!(page.contains(&said), "{said}\n{page}");
        (lacks, said)
    };
    let (before, _) = told(&scenes);
    let c = &mut scenes[1];
    let removed = |i: usize| c.runs[i].choice.removal.is_some();
    let found = c.decided.iter_mut().filter(|d| removed(d.family) && c.runs[d.curve].choice.formulation == VAKONOMIC);
    let mut found = found.filter(|d| dimension(&d.outcome).is_some());
    found.next().expect("one has").outcome = Err(SolveError::Member { reason: "unknown".into() });
    drop(found);
    let (after, _) = told(&scenes);
    assert_eq!(after.len(), before.len() + 1);
    assert!(after.iter().any(|name| name.starts_with("`disc` (")), "{after:?}");
}

/// How many constants of a family give a motion freely; `None` where none does, or it is not known.
fn dimension(found: &Result<Membership, SolveError>) -> Option<i64> {
    json!(Decision::of(found))["dimension"].as_i64()
}

#[test]
fn what_is_not_proved_is_not_called_so_in_json() {
    let found = |name: &str| -> Membership {
        let comparison = compared(name, 0.5, &Settings::default());
        comparison.membership().and_then(|found| found.as_ref().ok()).expect("decided").clone()
    };
    let value = |found: &Membership| json!(Decision::of(&Ok(found.clone())));
    let mut sledge = found("sledge");
    let Finding::None(none) = &mut sledge.proof.this_start else { panic!("{:?}", sledge.proof) };
    let order = none.order;
    none.full_rank = false;
    let because = format!("no minor of full size shows it: ranks modulo two primes do (order {order})");
    assert_eq!(value(&sledge), json!({ "answer": "none", "proved": false, "because": because }));
    assert_eq!(value(&found("sledge")), json!({ "answer": "none", "proved": true, "order": order }));
    let mut disc = found("disc");
    assert_eq!(value(&disc), json!({ "answer": "some", "proved": true, "dimension": 0 }));
    (disc.section, disc.proof.this_start) = (None, Finding::ThroughOrder { rank: 1, order: 7 });
    assert_eq!(value(&disc), json!({ "answer": "some", "proved": false, "order": 7, "dimension": 0 }));
}

#[test]
fn maggis_equations_agree_with_a_motion_that_is_right_and_with_no_other() {
    let duration = 2.0;
    let mut sledge = compared("sledge", duration, &Settings::default());
    let verdict = |sledge: &mut Comparison| {
        let files = referees_files([sledge].into_iter(), &Outcome::Ran(Vec::new())).expect("files");
        csv(&files, "comparisons").into_iter().find(|row| row["who"].contains("Maggi")).expect("a row")["verdict"]
            .clone()
    };
    assert_eq!(verdict(&mut sledge), "agrees");
    // gravity off by a millionth
    let set = [("duration".into(), duration.into()), ("g".into(), (9.81 * (1.0 + 1e-6)).into())];
    let other = scene::catalogue::find("sledge", &set).expect("built in");
    let chetaev = sledge.run(CHETAEV).expect("a run");
    sledge.runs[chetaev].outcome = solve_choice(&other, &sledge.runs[chetaev].choice, &Settings::default());
    assert_eq!(verdict(&mut sledge), "disagrees");
}

#[test]
fn the_audit_counts_its_equations() {
    let report = AuditReport::new().expect("the paper");
    let verdicts = report.verdicts();
    let words: Vec<&str> =
        verdicts["equations"].as_object().into_iter().flatten().filter_map(|(_, word)| word.as_str()).collect();
    let count = |word: &str| words.iter().filter(|said| said.contains(word)).count();
    let [holds, misprint, incomplete] = ["holds", "misprint", "incomplete"].map(count);
    let headline = report.headline();
    let all = holds + misprint + incomplete + count("open");
    let expected = format!(
        "Of {all} equations of the paper {holds} hold as printed, {misprint} after a misprint is corrected, {incomplete} are incomplete."
    );
    assert!(
        headline == expected && holds > 10 && misprint > 0 && words.len() >= all,
        "{headline}\n{expected}\n{words:?}"
    );
}

#[test]
fn the_page_of_the_bicycle_says_what_its_table_has() {
    // the committed page is that of a fresh run: `cargo xtask reports` compares it
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../reports/evidence/bicycle.md");
    let page = std::fs::read_to_string(page).expect("a page");
    let rows = table(&page, "# ");
    // a pair is one cell
    let eigenvalues = |cell: &String| if cell.contains('±') { 2 } else { usize::from(!cell.is_empty()) };
    let count: usize = rows.iter().flat_map(|row| (1..=4).map(|i| eigenvalues(&row[&format!("s{i}")]))).sum();
    assert_eq!((rows.len(), count), (11, 44));
    let differences = rows.iter().map(|row| row["difference"].parse::<f64>().expect("a number"));
    let largest = differences.fold(0.0, f64::max);
    let told: f64 = page
        .split_once("speeds to ")
        .expect("a bound")
        .1
        .split_once(',')
        .expect("a bound")
        .0
        .parse()
        .expect("a number");
    assert!((0.6..1.7).contains(&(told / largest)) && largest < 1e-9, "{told:e}, {largest:e}");
}
