//! Automatic removals, judged by whether they lead to every admissible velocity and to no other.

use equations::Formulation;
use mechanics::Removal;
use scene::Scene;
use symbolic::faults;

use super::judge::{Findings, distance};
use super::reading::{noise, samples};
use super::removed::Parametrized;
use super::road::{STATES, Stage, Trial};
use super::truth::{Point, Truth, slope, slopes};

/// Finds a removal anew, with faults.
pub fn trial(scene: &Scene, removal: &Removal, formulation: &'static Formulation) -> Option<Trial<'static>> {
    let find = match removal.name.as_str() {
        "coordinates" => Removal::by_coordinates,
        "quasi-velocities" => Removal::by_quasi_velocities,
        _ => return None,
    };
    let truth = Truth::new(&scene.system);
    // a removal writes into the graph of its system
    let (scene, own) = (scene.clone(), scene.clone());
    let (removal, chances) = faults::chances(|| find(&own.system, &own.start));
    let (sound, numbers) = judge(&own, &truth, &removal.ok()?).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    let (name, count) = (format!("{}, removal", scene.name), chances.len());
    let with_fault = move |which: usize| {
        let scene = scene.clone();
        let removal = faults::spoiled(which, count, || find(&scene.system, &scene.start)).map_err(|e| e.to_string())?;
        let (findings, found) = judge(&scene, &truth, &removal)?;
        let change = if found.len() == numbers.len() { distance(&found, &numbers) } else { f64::INFINITY };
        Ok((findings, change))
    };
    Some(Trial { name, formulation, stage: Stage::Remove, chances, sound, with_fault: Box::new(with_fault) })
}

/// What is found, and `q, q̇, B` in states that have nothing to do with the start.
///
/// Every `(q, v)` on the constraints has to have parameters, and `n − h` of them reach no more than that.
fn judge(scene: &Scene, truth: &Truth, removal: &Removal) -> Result<(Findings, Vec<f64>), String> {
    let parametrized = Parametrized::new(&scene.system, removal)?;
    let (mut findings, mut numbers, mut values) = (Findings::new(), Vec::new(), Vec::new());
    let m = removal.parameters.len();
    findings.must("n - h parameters", m + truth.h == truth.n);
    let samples = samples(scene, truth, Some(removal), STATES);
    findings.must("a start for every admissible state", samples.len() == STATES);
    for (number, sample) in samples.iter().enumerate() {
        let value = |symbol| sample.known.iter().find(|known| known.0 == symbol).map_or(0.0, |known| known.1);
        let x: Vec<f64> = parametrized.variables.iter().map(|symbol| value(*symbol)).collect();
        let [q, v, _] = parametrized.at(truth, &mut values, sample.point.t, &x);
        findings.same("coordinates", q, &sample.point.q);
        findings.same("velocities", v, &sample.point.v);
        // anywhere else: f vanishes, and velocities are rates
        let x: Vec<f64> = x.iter().enumerate().map(|(i, x)| x + 0.3 * noise(i, number + 4)).collect();
        let [q, v, b] = parametrized.at(truth, &mut values, sample.point.t, &x).map(<[f64]>::to_vec);
        let rates = [&x[m..3 * m], &vec![0.0; m], &b].concat();
        let along = slope(|s| {
            let moved: Vec<f64> = x.iter().zip(&rates).map(|(x, rate)| x + s * rate).collect();
            parametrized.at(truth, &mut Vec::new(), sample.point.t + s, &moved)[0].to_vec()
        });
        findings.same("velocities are rates", &along, &v);
        let at = Point { q: q.clone(), v: v.clone(), ..sample.point.clone() };
        findings.zero("the constraints", &truth.constraints(&at), 0.0);
        numbers.extend([&q[..], &v, &b].concat());
        if removal.name == "quasi-velocities" {
            // a coordinate stays where it is itself the only one that its velocity moves
            let moved = slopes(&x, |x| parametrized.at(truth, &mut Vec::new(), sample.point.t, x)[1].to_vec());
            for (u, column) in removal.parameters.iter().zip(&moved[m..]) {
                let alone = column.iter().filter(|x| x.abs() > 1e-9).count() == 1;
                findings.must("coordinates that stay", u.coordinate.is_some() == alone);
            }
        }
    }
    Ok((findings, numbers))
}
