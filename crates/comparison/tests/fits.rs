//! Fits minimize what is printed: where a number has settled, no sweep over the constants finds a gap that is
//! less by more than 5 %.

use std::path::Path;

use comparison::{Comparison, Fit, Fits, FittedMotion, Verdict, compare_unfitted};
use mechanics::ConstantsRule;
use motion::{Choice, Ensemble, EnsembleOptions, Metric, Motion, Settings, VAKONOMIC, choices};
use scene::Scene;
use symbolic::SplitMix;

/// Values per constant on a line through the fit, half of them equidistant, half dense near it; and as many
/// drawn ones around it. Where `FITS_OF` asks for scenes, four times as many.
const VALUES: usize = 100;

/// Scenes of the ordinary test, with what their vakonomic fits have to stay under; `FITS_OF=all` takes every
/// scene, `FITS_OF=NAME,…` these.
const FEW: [(&str, f64); 4] = [("sleigh", 3.94), ("particle", 4.6), ("turntable", 0.62), ("three-cylinders", 2e-8)];

/// The largest gaps of a family to a motion, as functions of its constants.
struct Family<'a> {
    ensemble: Ensemble,
    target: &'a mut Motion,
    metric: Metric,
}

impl Family<'_> {
    fn gaps(&mut self, rows: &[Vec<f64>], times: &[f64]) -> Vec<f64> {
        let goal: Vec<_> = times.iter().map(|&t| self.target.at(t).expect("in range")).collect();
        let options = EnsembleOptions { threads: 1, estimate: false };
        let answers = self.ensemble.answers(self.ensemble.members(rows, 1), times, &options);
        let mut largest = |outputs: Vec<equations::Outputs>| {
            let each = times.iter().zip(goal.iter().zip(&outputs));
            let gap =
                each.map(|(t, (to, now))| self.metric.distance(*t, &to.coordinates, &to.velocities, &now.coordinates));
            let gap = gap.fold(0.0, f64::max);
            if outputs.len() < times.len() { f64::INFINITY } else { gap }
        };
        answers.into_iter().map(|answer| answer.map_or(f64::INFINITY, |motion| largest(motion.outputs))).collect()
    }
}

/// Values on lines through `center`, and drawn ones around it.
fn values(center: &[f64]) -> Vec<Vec<f64>> {
    let size = center.iter().fold(1.0, |a: f64, c| a.max(c.abs()));
    let values = if std::env::var_os("FITS_OF").is_some() { 4 * VALUES } else { VALUES };
    let half = values / 2;
    let part = |i: usize| (i as f64 + 0.5) / half as f64;
    let sign = |i: usize| if i.is_multiple_of(2) { size } else { -size };
    let near = |i: usize| sign(i) * 10f64.powf(5.0 * part(i) - 4.0);
    let moved = |j: usize, by: f64| {
        let mut row = center.to_vec();
        row[j] += by;
        row
    };
    let line = |j: usize| (0..half).flat_map(move |i| [5.0 * size * (2.0 * part(i) - 1.0), near(i)].map(|by| (j, by)));
    let mut rows: Vec<Vec<f64>> = (0..center.len()).flat_map(line).map(|(j, by)| moved(j, by)).collect();
    let mut random = SplitMix::new(7);
    let drawn = if center.len() > 1 { values * center.len() } else { 0 };
    rows.extend((0..drawn).map(|_| {
        let radius = size * 10f64.powf(5.0 * random.unit() - 4.0);
        center.iter().map(|c| c + radius * (2.0 * random.unit() - 1.0)).collect()
    }));
    rows
}

/// Sweeps round one fit: the least gap, and how many values were tried.
fn swept(scene: &Scene, runs: &mut [comparison::Run], fit: &Fit, fitted: &FittedMotion) -> (f64, Vec<f64>, usize) {
    /// Instants of the first look: what is less there by 1 % is looked at wherever the fit was.
    const FEW_INSTANTS: usize = 60;
    const LOOKED_AT: usize = 40;
    let settings = Settings::default();
    let center: Vec<f64> = fitted.constants.iter().map(|(_, c)| *c).collect();
    let choice = Choice { constants: ConstantsRule::Zero, ..runs[fit.run].choice.clone() };
    let names: Vec<&str> = fitted.constants.iter().map(|(name, _)| name.as_str()).collect();
    let target = runs[fit.target].outcome.as_mut().expect("it was met");
    let ensemble = Ensemble::new(scene, &choice, &names, &settings).expect("an ensemble").until(target.end());
    let mut family = Family { ensemble, target, metric: Metric::new(&scene.system).expect("a metric") };
    let all: Vec<f64> = fitted.gap.points.iter().map(|p| p.t).filter(|&t| t > family.target.start()).collect();
    let few: Vec<f64> = family.target.grid(FEW_INSTANTS)[1..].to_vec();
    let rows = values(&center);
    let count = rows.len();
    let mut found: Vec<(f64, Vec<f64>)> = family.gaps(&rows, &few).into_iter().zip(rows).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.truncate(LOOKED_AT);
    let rows: Vec<Vec<f64>> = found.into_iter().map(|(_, row)| row).collect();
    let gaps = family.gaps(&rows, &all);
    let (least, at) = gaps.into_iter().zip(rows).min_by(|a, b| a.0.total_cmp(&b.0)).expect("values");
    (least, at, count)
}

/// A sweep may find a gap that is less by this part, in percent.
const LESS: f64 = 5.0;

/// Fits whatever can be fitted in a scene and sweeps: what is less although the number has settled, and gaps
/// that a search has made larger.
fn failures(name: &str, at_most: f64) -> Vec<String> {
    let path = ["scenes", "classics"].map(|folder| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scene").join(folder);
        folder.join(format!("{name}.toml"))
    });
    let path = path.iter().find(|path| path.exists()).expect("a scene");
    let scene = Scene::parse(name, &std::fs::read_to_string(path).expect("readable")).expect("built in");
    let choices = choices(&scene);
    let mut comparison: Comparison =
        compare_unfitted(scene.clone(), choices, Vec::new(), &Settings::default()).expect("compared");
    comparison.fit(Fits::All, &Settings::default()).expect("fitted");
    let own = |fit: &Fit| comparison.pair(fit.run, fit.target).map_or(0.0, |pair| pair.gap.largest);
    let own: Vec<f64> = comparison.fits.iter().map(own).collect();
    let Comparison { runs, fits, .. } = &mut comparison;
    let mut failures = Vec::new();
    for (fit, own) in fits.iter().zip(own) {
        let pair = format!("{name}: {} to {}", runs[fit.run].choice.label, runs[fit.target].choice.label);
        let Some(fitted) = &fit.fitted else {
            println!("{pair}: no motion");
            continue;
        };
        if fitted.gap.largest > own {
            failures.push(format!("{pair}: {:.6e}, and {own:.6e} before the search", fitted.gap.largest));
        }
        if fitted.gap.verdict != Verdict::Different {
            println!("{pair}: nothing left, {:.1e}", fitted.gap.largest);
            continue;
        }
        // taken over from the same family in other constants, which is swept; `FITS_OF` sweeps both
        if fitted.starts == 0 && std::env::var_os("FITS_OF").is_none() {
            println!("{pair}: {:.6e}, taken over", fitted.gap.largest);
            continue;
        }
        let gap = fitted.gap.largest;
        let (least, at, count) = swept(&scene, runs, fit, fitted);
        let gain = 100.0 * (1.0 - least / gap);
        let line = format!(
            "{pair}: {gap:.6e} from {} starts, least of {count} values {least:.6e}, {gain:.4} %",
            fitted.starts
        );
        println!("{line}");
        let is_principal = runs[fit.run].choice.formulation == VAKONOMIC;
        if gain > LESS && fitted.is_settled() || is_principal && gap > at_most {
            println!("    at {at:?}, the fit at {:?}", fitted.constants);
            failures.push(line);
        }
    }
    failures
}

#[test]
fn no_sweep_finds_less() {
    let asked = std::env::var("FITS_OF").unwrap_or_default();
    let all = ["scenes", "classics"].map(|folder| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scene").join(folder);
        std::fs::read_dir(folder).expect("scenes").map(|entry| entry.expect("a file").path())
    });
    let all = all.into_iter().flatten().filter(|path| path.extension().is_some_and(|e| e == "toml"));
    let name = |path: std::path::PathBuf| path.file_stem().expect("a name").to_string_lossy().into_owned();
    let mut names: Vec<String> = match &asked[..] {
        "" => FEW.iter().map(|(name, _)| name.to_string()).collect(),
        "all" => all.map(name).collect(),
        some => some.split(',').map(String::from).collect(),
    };
    names.sort();
    let bound = |name: &str| FEW.iter().find(|(few, _)| *few == name).map_or(f64::INFINITY, |(_, bound)| *bound);
    let failures: Vec<String> = names.iter().flat_map(|name| failures(name, bound(name))).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
