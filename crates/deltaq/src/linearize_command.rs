//! `deltaq linearize`: steady motions to first order, and their eigenvalues.

use anyhow::{Result, bail};
use linear::{Sweep, SweepPoint, find_steady, linearize, linearize_at, sweep};
use mechanics::State;
use motion::{Settings, setting};
use scene::Scene;
use serde_json::{Map, Value, json};

use crate::cli::{LinearizeArguments, TableFormat};
use crate::columns::header;
use crate::solve_command::choice;
use pages::{sweep_picture, sweep_text, with_unit};
use program::pretty;
use program::{File, write_all};

/// Runs the command.
pub(crate) fn run(arguments: &LinearizeArguments) -> Result<String> {
    let mut scene = arguments.scene.find()?;
    let choice = choice(&scene, (arguments.formulation, "auto"), &arguments.free_constants)?;
    let free: Vec<&str> = arguments.free.iter().map(String::as_str).collect();
    let sweep = match &arguments.sweep {
        Some(range) => {
            let name = &range.name;
            if arguments.scene.set.overrides.iter().any(|(set, _)| set == name) {
                bail!("--sweep: `{name}` varies, and --set fixes it");
            }
            let values: Vec<f64> = motion::equidistant(range.from, range.to, range.count).collect();
            sweep(&scene, &choice, &free, (name, &values), arguments.find)?
        }
        None => {
            if arguments.find {
                scene.start = find_steady(setting(&scene))?;
            }
            let linearization = match arguments.at {
                None => linearize(setting(&scene), &choice)?,
                Some(t) => linearize_at(setting(&scene), &choice, t, &Settings::default())?,
            };
            let part = linearization.part(&free)?;
            let (t, state) = (linearization.t, scene.start.clone());
            let point = SweepPoint { value: t, asked: t, state, linearization, part };
            Sweep { name: "t".into(), points: vec![point], changes: Vec::new() }
        }
    };
    let page = || sweep_text(&scene, &sweep, arguments.find);
    if let Some(folder) = &arguments.out {
        let picture = format!("{}-eigenvalues.svg", scene.name);
        let text = format!("{}\n![Eigenvalues over {}]({picture})\n", page(), sweep.name);
        let files = [
            File { path: format!("{}-eigenvalues.md", scene.name).into(), text },
            File { path: picture.into(), text: sweep_picture(&scene.title, &with_unit(&scene, &sweep.name), &sweep)? },
        ];
        write_all(folder, &files)?;
    }
    Ok(match arguments.format {
        TableFormat::Table => page(),
        TableFormat::Csv => csv(&sweep)?,
        TableFormat::Json => {
            let mut object = json_of(&scene, &sweep);
            (object["scene"], object["formulation"]) = (json!(scene.name), json!(choice.formulation.name));
            object["free"] = json!(free);
            pretty("linearize", &object)
        }
    })
}

/// One line an eigenvalue other than zero.
fn csv(sweep: &Sweep) -> Result<String> {
    let mut text = header(&[&sweep.name, "real", "imaginary", "error"].map(String::from))?;
    for point in &sweep.points {
        let x = point.value;
        let lines =
            point.part.eigenvalues.iter().map(|e| format!("{x:?},{:?},{:?},{:?}\n", e.value.re, e.value.im, e.error));
        text.extend(lines);
    }
    Ok(text)
}

fn json_of(scene: &Scene, sweep: &Sweep) -> Value {
    let state = |state: &State| {
        let names = scene.system.coordinates.iter().map(|c| &c.name);
        let places = names.clone().cloned().zip(&state.q);
        let all = places.chain(names.map(|name| format!("{name}'")).zip(&state.v));
        all.map(|(name, x)| (name, json!(x))).collect::<Map<String, Value>>()
    };
    let point = |SweepPoint { value, asked, state: found, linearization, part }: &SweepPoint| {
        let carried: Map<String, Value> =
            linearization.carried.iter().map(|c| (c.name.clone(), json!(c.rate))).collect();
        let eigenvalues = part.eigenvalues.iter();
        let eigenvalues = eigenvalues.map(|e| json!({ "real": e.value.re, "imaginary": e.value.im, "error": e.error }));
        let chains = part.chains.iter().map(|c| {
            json!({
                "real": c.value.re, "imaginary": c.value.im, "size": c.size, "radius": c.radius, "power": c.power,
                "exact": c.is_exact,
            })
        });
        let states = part.states.iter().map(|&i| &linearization.states[i]);
        json!({
            "value": value, "asked": asked, "state": state(found), "t": linearization.t, "form": linearization.form, "steady": linearization.is_steady,
            "states": linearization.states, "values": linearization.values, "carried": carried,
            "matrix": linearization.matrix.row_iter().map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
            "of": states.collect::<Vec<_>>(), "eigenvalues": eigenvalues.collect::<Vec<_>>(),
            "zeros": part.zeros, "zero_error": part.zero_error, "zero_vectors": linearization.spectrum.zero_vectors,
            "unstable": part.unstable(), "growing": part.growth().to_string(), "chains": chains.collect::<Vec<_>>(),
        })
    };
    let changes = sweep.changes.iter().map(|change| {
        json!({
            "value": change.value, "width": change.width, "asked": change.asked, "state": state(&change.state),
            "unstable": change.unstable, "frequency": change.frequency,
        })
    });
    json!({
        "sweep": sweep.name, "points": sweep.points.iter().map(point).collect::<Vec<_>>(),
        "changes": changes.collect::<Vec<_>>(),
    })
}
