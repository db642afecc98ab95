//! `deltaq linearize`: steady motions to first order, and their eigenvalues.

use anyhow::{Result, bail};
use linear::{Change, Linearization, Part, Sweep, SweepPoint, find_steady, linearize, linearize_at, sweep};
use mechanics::State;
use motion::{Settings, setting};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::{LinearizeArguments, TableFormat};
use crate::columns::{Numbers, header, named};
use crate::solve_command::choice;
use pages::{sweep_picture, sweep_text, with_unit};
use program::{File, typed, write_all};

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
            let formulation = choice.formulation.name;
            let changed = |change| Changed { change, state: named_state(&scene, &change.state) };
            typed(&Linearized {
                scene: &scene.name,
                formulation,
                free,
                sweep: &sweep.name,
                points: sweep.points.iter().map(|point| Point::of(&scene, point)).collect(),
                changes: sweep.changes.iter().map(changed).collect(),
            })?
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

fn named_state(scene: &Scene, state: &State) -> Numbers {
    let names = scene.system.coordinates.iter().map(|c| &c.name);
    let mut all = named(names.clone(), &state.q);
    all.extend(named(names.map(|name| format!("{name}'")), &state.v));
    all
}

/// Steady motions to first order: `deltaq linearize --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "linearize/2")]
pub(crate) struct Linearized<'a> {
    scene: &'a str,
    formulation: &'a str,
    /// Coordinates whose eigenvalues were asked for; empty for all.
    free: Vec<&'a str>,
    /// What varies; t where nothing does.
    sweep: &'a str,
    points: Vec<Point<'a>>,
    /// Where the number of eigenvalues with a positive real part changes.
    changes: Vec<Changed<'a>>,
}

#[derive(Serialize, JsonSchema)]
struct Point<'a> {
    /// Of what varies, in the state that was linearized.
    value: f64,
    /// Of what varies, in the start; another one than value where a steady motion was looked for.
    asked: f64,
    /// Coordinates and velocities of the steady motion, or of the start.
    state: Numbers,
    #[serde(flatten)]
    linearization: &'a Linearization,
    /// States whose eigenvalues these are.
    of: Vec<&'a str>,
    #[serde(flatten)]
    part: &'a Part,
    /// Eigenvalues with a real part above their error.
    unstable: usize,
    /// The same number, 'or more' where errors leave others open; 'like t^j' where an eigenvalue on the
    /// imaginary axis has too few eigenvectors; 'undecided' where errors leave it open or all eigenvalues
    /// are zero.
    growing: String,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Change")]
struct Changed<'a> {
    #[serde(flatten)]
    change: &'a Change,
    /// Coordinates and velocities of a steady motion just behind.
    state: Numbers,
}

impl<'a> Point<'a> {
    fn of(scene: &Scene, SweepPoint { value, asked, state, linearization, part }: &'a SweepPoint) -> Self {
        Point {
            value: *value,
            asked: *asked,
            state: named_state(scene, state),
            linearization,
            of: part.states.iter().map(|&i| &linearization.states[i][..]).collect(),
            part,
            unstable: part.unstable(),
            growing: part.growth().to_string(),
        }
    }
}
