//! Ours, asked as the peers are: see `validation/peers/worker.py`.

use std::collections::HashMap;
use std::hint::black_box;
use std::io::{BufRead, Write};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use deltaq::{Choice, Prepared, Settings, derive, derive_at, formulation, prepare, setting, solve};
use equations::Derivation;
use integrate::{Dense, Method, Options, Status};
use mechanics::ConstantsRule;
use scene::Scene;
use serde_json::{Value, json};
use validation::casadi_job::tags;

use crate::Case;
use crate::trailer::{place_among_bodies, train_of_bodies};

/// The method that stands for [`deltaq::solve`]: two runs, the second at a hundredth of the tolerance, and the difference as an error estimate.
const SOLVE: &str = "solve: two runs of Dop853";

/// Steps of one run at most, as [`Settings`] has it.
const MAX_STEPS: usize = 1_000_000;

/// A case that was read.
struct Loaded {
    case: Case,
    scene: Scene,
    choice: Choice,
    runs: HashMap<String, Prepared>,
}

/// Answers on standard output what is asked on standard input, until that ends.
///
/// # Errors
/// Where the pipes break.
pub fn serve() -> Result<()> {
    let mut loaded = None;
    let mut output = std::io::stdout();
    for line in std::io::stdin().lock().lines() {
        let answer = serde_json::from_str(&line?)
            .context("no JSON")
            .and_then(|question: Value| answer(&question, &mut loaded))
            .unwrap_or_else(|error| json!({ "failure": format!("{error:#}") }));
        writeln!(output, "{answer}")?;
        output.flush()?;
    }
    Ok(())
}

fn answer(question: &Value, loaded: &mut Option<Loaded>) -> Result<Value> {
    let text = |key: &str| question[key].as_str().with_context(|| format!("`{key}` is missing"));
    let number = |key: &str| question[key].as_f64().with_context(|| format!("`{key}` is missing"));
    match text("do")? {
        "version" => return Ok(json!({ "versions": { "deltaq": env!("CARGO_PKG_VERSION") } })),
        "setup" => {
            let case: Case = serde_json::from_value(question["case"].clone())?;
            let clock = Instant::now();
            let (scene, choice) = read(&case)?;
            let runs = compile(&scene, &choice, &Settings::default())?;
            let seconds = clock.elapsed().as_secs_f64();
            let runs = HashMap::from([(format!("{:?}", Method::Dop853), runs)]);
            let forms = forms(&case);
            let names =
                |form: &&str| methods_of(&case).iter().map(|method| format!("{method:?}{form}")).collect::<Vec<_>>();
            let mut methods: Vec<String> = forms.iter().flat_map(names).collect();
            methods.push(SOLVE.into());
            *loaded = Some(Loaded { case, scene, choice, runs });
            return Ok(json!({ "seconds": seconds, "methods": methods }));
        }
        _ => {}
    }
    let loaded = loaded.as_mut().context("nothing was set up")?;
    match text("do")? {
        "rates" => loaded.rates(),
        "prepare" => {
            let clock = Instant::now();
            loaded.prepared(text("method")?)?;
            Ok(json!({ "seconds": clock.elapsed().as_secs_f64() }))
        }
        "run" => loaded.run(text("method")?, number("tolerance")?, text("task")? == "end", number("repeat")?),
        "total" => loaded.total(text("method")?, number("tolerance")?),
        other => bail!("nobody knows how to `{other}`"),
    }
}

/// The scene of a case, and the choice of its formulation. Constants that are given with the case are not computed again.
fn read(case: &Case) -> Result<(Scene, Choice)> {
    let mut scene = Scene::parse(&case.name, &case.toml)?;
    let last = case.times.last().context("a case without times")?;
    scene.duration = last - scene.start.t;
    let entry = formulation(&case.formulation).context("no such formulation")?;
    let removal = match &case.removal {
        Some(name) => Some(scene.removals.iter().find(|r| r.name == *name).context("no such removal")?.clone()),
        None => None,
    };
    let costates: Vec<f64> =
        case.tags.iter().zip(&case.start).filter(|((kind, _), _)| kind == "P").map(|(_, &x)| x).collect();
    let constants = match &removal {
        Some(removal) if case.start.is_empty() => removal.constants.clone(),
        Some(_) => ConstantsRule::Given(costates),
        None => deltaq::default_constants(entry, &scene),
    };
    let choice = Choice { label: entry.title.into(), formulation: entry.name, removal, constants };
    Ok((scene, choice))
}

fn compile(scene: &Scene, choice: &Choice, settings: &Settings) -> Result<Prepared> {
    let equations = derive_at(&scene.system, &scene.start, choice)?;
    Ok(prepare(setting(scene), equations, &choice.constants, settings)?)
}

/// Forms of a formulation's equations, as they are added to the name of a method.
fn forms(case: &Case) -> &'static [&'static str] {
    match &case.formulation[..] {
        "chetaev" if trailers(case).is_some() => &["", ", quasi-velocities", BODIES],
        "chetaev" => &["", ", quasi-velocities"],
        "vakonomic" => &["", ", costate form", ", quasi-velocities"],
        _ => &[""],
    }
}

/// The methods that are timed: on the car with trailers, which is not stiff and may be long, the explicit ones.
fn methods_of(case: &Case) -> &'static [Method] {
    match trailers(case) {
        None => &Method::ALL,
        Some(_) => &[Method::Taylor, Method::Dop853, Method::Tsit45],
    }
}

/// The form in which the car with trailers has a place for every body.
const BODIES: &str = ", quasi-velocities, a place for every body";

fn trailers(case: &Case) -> Option<usize> {
    case.name.strip_prefix("trailers-")?.parse().ok()
}

/// The scene in which a method takes the case: the given one, or the one with a place for every body.
fn restated(case: &Case, name: &str) -> Case {
    let mut case = case.clone();
    if let (true, Some(n), [start, .., end]) = (name.ends_with(BODIES), trailers(&case), &case.times[..]) {
        case.toml = train_of_bodies(n, end - start);
    }
    case
}

/// The method of that name, and what is added to the formulation's name where it is for another form.
fn method(name: &str) -> Result<(Method, Option<&'static str>)> {
    if name == SOLVE {
        return Ok((Method::Dop853, None));
    }
    let (method, form) = match name.split_once(", ") {
        None => (name, None),
        Some((method, "quasi-velocities" | "quasi-velocities, a place for every body")) => (method, Some("reduced")),
        Some((method, "costate form")) => (method, Some("costate")),
        Some((_, form)) => bail!("no form {form}"),
    };
    let method = Method::ALL.into_iter().find(|known| format!("{known:?}") == method);
    Ok((method.with_context(|| format!("no method {name}"))?, form))
}

/// The choice in another form of its formulation.
fn in_form(choice: &Choice, form: Option<&'static str>) -> Choice {
    let name = |form| format!("{}-{form}", choice.formulation);
    let formulation = form.and_then(|form| formulation(&name(form))).map_or(choice.formulation, |f| f.name);
    Choice { formulation, ..choice.clone() }
}

impl Loaded {
    /// What each state is, where it starts and its rate there, by the equations as derived, nothing left out of them.
    fn rates(&mut self) -> Result<Value> {
        let entry = formulation(self.choice.formulation).context("no such formulation")?;
        let removal = self.choice.removal.as_ref();
        let equations = (entry.derive)(&self.scene.system, &Derivation { removal, start: Some(&self.scene.start) })?;
        let tags = tags(&equations);
        let mut ready = prepare(setting(&self.scene), equations, &self.choice.constants, &Settings::default())?;
        let mut rates = vec![0.0; ready.start.len()];
        ready.compiled.rates(ready.t, &ready.start, &mut rates).map_err(deltaq::SolveError::AtStart)?;
        Ok(json!({ "tags": tags, "start": ready.start, "rates": rates }))
    }

    fn prepared(&mut self, name: &str) -> Result<&mut Prepared> {
        if !self.runs.contains_key(name) {
            let (method, form) = method(name)?;
            let settings = Settings { method, ..Settings::default() };
            let ready = if name.ends_with(BODIES) {
                let (scene, choice) = read(&restated(&self.case, name))?;
                compile(&scene, &in_form(&choice, form), &settings)?
            } else {
                compile(&self.scene, &in_form(&self.choice, form), &settings)?
            };
            self.runs.insert(name.into(), ready);
        }
        self.runs.get_mut(name).context("no runs")
    }

    fn run(&mut self, name: &str, tolerance: f64, end: bool, repeat: f64) -> Result<Value> {
        if name == SOLVE {
            return self.solve(tolerance, repeat);
        }
        let times = if end {
            vec![self.case.times[0], self.case.times[self.case.times.len() - 1]]
        } else {
            self.case.times.clone()
        };
        let dense = if end { Dense::EndOnly } else { Dense::Everywhere };
        let method = method(name)?.0;
        let options = Options { method, dense, max_steps: MAX_STEPS, ..Options::with_tolerance(tolerance) };
        let until = times[times.len() - 1];
        let all = 0..self.scene.system.dimension();
        let places: Vec<usize> =
            if name.ends_with(BODIES) { all.map(place_among_bodies).collect() } else { all.collect() };
        let runs = self.prepared(name)?;
        let (mut best, mut total, mut repeats) = (f64::INFINITY, 0.0, 0);
        let mut states = vec![0.0; runs.start.len()];
        let run = loop {
            let clock = Instant::now();
            let run = runs.integrate(until, &options)?;
            for &t in &times {
                run.states_at(&mut runs.compiled, t, &mut states);
                black_box(&states);
            }
            let seconds = clock.elapsed().as_secs_f64();
            (best, total, repeats) = (f64::min(best, seconds), total + seconds, repeats + 1);
            if total >= repeat {
                break run;
            }
        };
        if let Status::Stopped { t, cause } = &run.solution.status {
            bail!("stopped at {t}: {cause}");
        }
        let coordinates: Vec<Vec<f64>> = times
            .iter()
            .map(|&t| {
                let q = run.at(&mut runs.compiled, t)?.coordinates;
                Ok(places.iter().map(|&place| q[place]).collect())
            })
            .collect::<Result<_>>()?;
        let evaluations = run.solution.work.evaluations;
        Ok(json!({ "seconds": best, "repeats": repeats, "coordinates": coordinates, "evaluations": evaluations }))
    }

    /// [`deltaq::solve`] on compiled equations, as it says itself; for a trajectory and for its end alike.
    fn solve(&mut self, tolerance: f64, repeat: f64) -> Result<Value> {
        let equations = derive(&self.scene.system, &self.choice)?;
        let constants = ConstantsRule::Given(self.prepared(&format!("{:?}", Method::Dop853))?.constants.clone());
        let settings = Settings { tolerance, ..Settings::default() };
        let (mut best, mut total, mut repeats) = (f64::INFINITY, 0.0, 0);
        let mut motion = loop {
            let motion = solve(setting(&self.scene), equations.clone(), &constants, &settings)?;
            let seconds = motion.seconds.integrate;
            (best, total, repeats) = (f64::min(best, seconds), total + seconds, repeats + 1);
            if total >= repeat {
                break motion;
            }
        };
        if !motion.is_complete() {
            bail!("stopped: {:?}", motion.ending);
        }
        let coordinates: Vec<Vec<f64>> =
            self.case.times.iter().map(|&t| Ok(motion.at(t)?.coordinates)).collect::<Result<_>>()?;
        Ok(json!({ "seconds": best, "repeats": repeats, "coordinates": coordinates }))
    }

    /// Seconds from the text of the scene to the states at all times, everything done once.
    fn total(&mut self, name: &str, tolerance: f64) -> Result<Value> {
        if name == SOLVE {
            let clock = Instant::now();
            let (scene, choice) = read(&self.case)?;
            let equations = derive_at(&scene.system, &scene.start, &choice)?;
            let settings = Settings { tolerance, ..Settings::default() };
            let mut motion = solve(setting(&scene), equations, &choice.constants, &settings)?;
            for &t in &self.case.times {
                black_box(motion.at(t)?);
            }
            return Ok(json!({ "seconds": clock.elapsed().as_secs_f64() }));
        }
        let (method, form) = method(name)?;
        let options = Options { method, max_steps: MAX_STEPS, ..Options::with_tolerance(tolerance) };
        let clock = Instant::now();
        let (scene, choice) = read(&restated(&self.case, name))?;
        let choice = in_form(&choice, form);
        let mut runs = compile(&scene, &choice, &Settings { method, ..Settings::default() })?;
        let run = runs.integrate(scene.start.t + scene.duration, &options)?;
        let mut states = vec![0.0; runs.start.len()];
        for &t in &self.case.times {
            run.states_at(&mut runs.compiled, t, &mut states);
            black_box(&states);
        }
        Ok(json!({ "seconds": clock.elapsed().as_secs_f64() }))
    }
}
