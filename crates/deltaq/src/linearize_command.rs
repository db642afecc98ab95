//! `deltaq linearize`: steady motions to first order, and their eigenvalues.

use anyhow::{Result, bail};
use linear::{Sweep, SweepPoint, find_steady, linearize, linearize_at, sweep};
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
            typed(&Linearized {
                scene: &scene.name,
                formulation,
                free,
                sweep: &sweep.name,
                points: sweep.points.iter().map(|point| Point::of(&scene, point)).collect(),
                changes: sweep.changes.iter().map(|change| Change::of(&scene, change)).collect(),
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
    changes: Vec<Change>,
}

#[derive(Serialize, JsonSchema)]
struct Point<'a> {
    /// Of what varies, in the state that was linearized.
    value: f64,
    /// Of what varies, in the start; another one than value where a steady motion was looked for.
    asked: f64,
    /// Coordinates and velocities of the steady motion, or of the start.
    state: Numbers,
    t: f64,
    /// The form of the formulation whose states these are.
    form: &'a str,
    /// Whether the motion is steady; the eigenvalues are frozen otherwise.
    steady: bool,
    states: &'a [String],
    /// Of the states.
    values: &'a [f64],
    /// Rates of coordinates on which no rate depends.
    carried: Numbers,
    /// Rates of deviations of the states, row by row.
    matrix: Vec<Vec<f64>>,
    /// States whose eigenvalues these are.
    of: Vec<&'a str>,
    /// Other than zero, by falling real part.
    eigenvalues: Vec<Eigenvalue>,
    /// Further eigenvalues, all zero.
    zeros: usize,
    /// How far these may be from zero.
    zero_error: f64,
    /// Independent eigenvectors of all zeros; fewer where deviations grow as powers of time.
    zero_vectors: usize,
    /// Eigenvalues with a real part above their error.
    unstable: usize,
    /// The same number, 'or more' where errors leave others open; 'like t^j' where an eigenvalue on the
    /// imaginary axis has too few eigenvectors; 'undecided' where errors leave it open or all eigenvalues
    /// are zero.
    growing: String,
    /// Eigenvalues on the imaginary axis that cannot be told from a multiple one with too few eigenvectors.
    chains: Vec<Chain>,
}

#[derive(Serialize, JsonSchema)]
struct Eigenvalue {
    real: f64,
    imaginary: f64,
    error: f64,
}

#[derive(Serialize, JsonSchema)]
struct Chain {
    real: f64,
    imaginary: f64,
    /// How many they are.
    size: usize,
    /// They are so close to this value.
    radius: f64,
    /// Deviations grow like this power of time until about 1/radius; 0 where none is shown.
    power: usize,
    /// Whether they do so for ever; otherwise it is undecided how deviations go on.
    exact: bool,
}

#[derive(Serialize, JsonSchema)]
struct Change {
    /// In the steady motion there.
    value: f64,
    /// Of the interval in which it changes.
    width: f64,
    /// In the start from which that motion was found.
    asked: f64,
    /// Coordinates and velocities of a steady motion just behind.
    state: Numbers,
    /// Below and above.
    unstable: [usize; 2],
    /// Imaginary part of the eigenvalue that crosses.
    frequency: f64,
}

impl<'a> Point<'a> {
    fn of(scene: &Scene, SweepPoint { value, asked, state, linearization: l, part }: &'a SweepPoint) -> Self {
        let eigenvalue =
            |e: &linear::Eigenvalue| Eigenvalue { real: e.value.re, imaginary: e.value.im, error: e.error };
        let chain = |c: &linear::Chain| Chain {
            real: c.value.re,
            imaginary: c.value.im,
            size: c.size,
            radius: c.radius,
            power: c.power,
            exact: c.is_exact,
        };
        Point {
            value: *value,
            asked: *asked,
            state: named_state(scene, state),
            t: l.t,
            form: l.form,
            steady: l.is_steady,
            states: &l.states,
            values: &l.values,
            carried: l.carried.iter().map(|c| (c.name.clone(), c.rate)).collect(),
            matrix: l.matrix.row_iter().map(|row| row.iter().copied().collect()).collect(),
            of: part.states.iter().map(|&i| &l.states[i][..]).collect(),
            eigenvalues: part.eigenvalues.iter().map(eigenvalue).collect(),
            zeros: part.zeros,
            zero_error: part.zero_error,
            zero_vectors: l.spectrum.zero_vectors,
            unstable: part.unstable(),
            growing: part.growth().to_string(),
            chains: part.chains.iter().map(chain).collect(),
        }
    }
}

impl Change {
    fn of(scene: &Scene, change: &linear::Change) -> Self {
        Change {
            value: change.value,
            width: change.width,
            asked: change.asked,
            state: named_state(scene, &change.state),
            unstable: change.unstable,
            frequency: change.frequency,
        }
    }
}
