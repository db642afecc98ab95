//! `deltaq integrals`: invariant measures and first integrals, printed, counted, or proved not to exist.

use std::fmt::Write;

use anyhow::Result;
use decision::ExactStart;
use deltaq::{CHETAEV, Contradicted, Settings, derive, solve_choice};
use integrals::{Ansatz, Density, Found, Measure, Open, Printed, Reversed, ansatz, constants, reversible};
use mechanics::{System, Watched};
use program::{Answer, TextOrJson, pretty, write_one};
use scene::Scene;
use serde_json::{Value, json};

use crate::cli::IntegralsArguments;
use crate::solve_command::choice;

/// Tolerance of the motion along which what is printed is looked at, and times at which it is.
const TOLERANCE: f64 = 1e-12;
const TIMES: u32 = 50;

/// What was found, all together.
struct Findings {
    scene: Scene,
    formulation: &'static str,
    /// `None` for a formulation other than Chetaev's.
    reversed: Option<Reversed>,
    ansatz: Result<Ansatz, Open>,
    /// Largest relative change of what is printed along the scene's own motion.
    drifts: Vec<f64>,
    /// Names of the scene's invariants, with whether they are constant on almost every motion.
    invariants: Vec<(String, bool)>,
}

/// Decides and writes.
///
/// # Errors
/// Bad input, with its place; results that contradict each other; a file that cannot be written.
pub fn run(arguments: &IntegralsArguments) -> Result<Answer> {
    let findings = find(arguments)?;
    let contradictions = contradictions(&findings);
    if !contradictions.is_empty() {
        return Err(Contradicted(contradictions).into());
    }
    let text = match arguments.format {
        TextOrJson::Text => words(&findings),
        TextOrJson::Json => pretty("integrals", &value(&findings)),
    };
    match &arguments.out {
        None => Ok(text.into()),
        Some(file) => {
            write_one(file, &text)?;
            Ok(format!("{}: the answers are in {}\n", findings.scene.name, file.display()).into())
        }
    }
}

fn find(arguments: &IntegralsArguments) -> Result<Findings> {
    let mut scene = arguments.scene.find()?;
    let choice = choice(&scene, (arguments.formulation, "auto"), &crate::cli::FreeArguments::default())?;
    let degree = usize::from(arguments.degree);
    let removal = choice.removal.as_ref();
    let start = ExactStart::new(&scene.system, &scene.start, &scene.completion, removal)?;
    let reversed = (choice.formulation.name == CHETAEV.name).then(|| reversible(&scene.system, &start, degree));
    let equations = derive(&scene.system, &choice)?;
    let ansatz = ansatz(&scene.system, &equations, &start, degree, &arguments.names);
    if let Err(fault @ Open::Name { .. }) = &ansatz {
        return Err(fault.clone().into());
    }
    let own: Vec<&Watched> = scene.system.watched.iter().filter(|watched| watched.constant).collect();
    let expressions: Vec<_> = own.iter().map(|watched| watched.expression).collect();
    let names = own.iter().map(|watched| watched.name.clone());
    let held = constants(&scene.system, &equations, &start, &expressions).unwrap_or_default();
    let invariants = names.zip(held).collect();
    let printed = ansatz.as_ref().map_or(&[][..], |found| &found.printed);
    let drifts = drifts(&mut scene, &choice, printed)?;
    let formulation = choice.formulation.name;
    Ok(Findings { scene, formulation, reversed, ansatz, drifts, invariants })
}

/// Along the scene's motion, in parts of what was largest.
fn drifts(scene: &mut Scene, choice: &deltaq::Choice, printed: &[Printed]) -> Result<Vec<f64>> {
    let own = std::mem::take(&mut scene.system.watched);
    for (i, integral) in printed.iter().enumerate() {
        let expression = scene.system.expression(&integral.text)?;
        scene.system.watched.push(Watched { name: format!("integral {i}"), expression, constant: true });
    }
    let settings = Settings { tolerance: TOLERANCE, ..Settings::default() };
    let mut motion = solve_choice(scene, choice, &settings)?;
    let (from, to) = (motion.start(), motion.end());
    let times: Vec<f64> = (0..=TIMES).map(|i| from + (to - from) * f64::from(i) / f64::from(TIMES)).collect();
    let drifts = motion.invariant_drift(&times)?;
    scene.system.watched = own;
    let of = |i: usize| drifts.iter().find(|(name, ..)| *name == format!("integral {i}"));
    let relative = |(_, start, drift): &(String, f64, f64)| drift / start.abs().max(1.0);
    Ok((0..printed.len()).filter_map(of).map(relative).collect())
}

/// What cannot be true beside each other.
fn contradictions(findings: &Findings) -> Vec<String> {
    let name = &findings.scene.name;
    let mut all: Vec<String> = Vec::new();
    let linear = findings.reversed.as_ref().and_then(|found| found.integrals.first()?.as_ref().ok());
    if let (Some(linear), Ok(found)) = (linear, &findings.ansatz) {
        let printed = found.printed.iter().filter(|p| p.is_linear).count();
        if printed > linear.count {
            all.push(format!("{name}: at most {} linear integrals, but {printed} are printed", linear.count));
        }
    }
    let open = findings.reversed.iter().flat_map(|found| &found.integrals).filter_map(|found| found.as_ref().err());
    let faults = open.chain(findings.ansatz.as_ref().err()).filter(|open| matches!(open, Open::Contradiction(_)));
    all.extend(faults.map(|fault| format!("{name}: {fault}")));
    if linear.is_some_and(|found| found.count == 0) {
        let system = &findings.scene.system;
        let own = findings.invariants.iter().filter(|(own, held)| *held && is_linear(system, own));
        all.extend(own.map(|(own, _)| format!("{name}: no linear integral, but `{own}` is one")));
    }
    all
}

/// Whether an invariant of the scene is linear in the velocities, and not zero.
fn is_linear(system: &System, name: &str) -> bool {
    let (g, v) = (&system.graph, system.velocities());
    let at_rest = |e| g.substitute(e, &v.iter().map(|&v| (v, g.zero())).collect());
    system.watched.iter().filter(|watched| watched.name == name).any(|watched| {
        let slopes = g.gradient(watched.expression, &v);
        slopes.iter().all(|&e| v.iter().all(|&v| !g.depends_on(e, v)))
            && g.vanishes_exactly(at_rest(watched.expression))
    })
}

fn words(findings: &Findings) -> String {
    let mut text = format!("{}: {}\n", findings.scene.name, findings.formulation);
    if let Some(found) = &findings.reversed {
        let system = &findings.scene.system;
        text +=
            "near almost every point; a measure is smooth and positive there, periods of angles are not asked for\n";
        let _ = writeln!(text, "{:<13}{}", "measure", measure_words(system, &found.measure));
        for (i, found) in found.integrals.iter().enumerate() {
            let name = ["linear", "quadratic", "cubic"].get(i).copied().unwrap_or("higher");
            let _ = writeln!(text, "{name:<13}{}", count_words(found));
        }
    }
    match &findings.ansatz {
        Err(open) => {
            let _ = writeln!(text, "{:<13}open ({open})", "ansatz");
        }
        Ok(found) => {
            let names = if found.names.is_empty() { "no coordinate".into() } else { found.names.join(", ") };
            let _ = writeln!(
                text,
                "{:<13}{} functions, in {names} to degree {}: {} constant combinations, {} without the products",
                "ansatz",
                found.functions,
                found.spatial,
                found.dimension,
                found.printed.len() + found.unprinted,
            );
            for (integral, drift) in found.printed.iter().zip(&findings.drifts) {
                let _ = writeln!(text, "{:<13}{} = const (drift {drift:.0e})", kind(integral), integral.text);
            }
            if found.unprinted > 0 {
                let _ =
                    writeln!(text, "{:<13}{} with coefficients that are no moderate fractions", "", found.unprinted);
            }
        }
    }
    for (name, held) in &findings.invariants {
        let words = if *held { "constant, at random points of two fields" } else { "not constant: proved" };
        let _ = writeln!(text, "{:<13}`{name}` of the scene: {words}", "invariant");
    }
    text
}

fn kind(integral: &Printed) -> &'static str {
    match integral {
        _ if integral.is_energy => "energy",
        _ if integral.is_moving_energy => "moving energy",
        _ => "integral",
    }
}

fn measure_words(system: &System, measure: &Measure) -> String {
    match measure {
        Measure::None { proved: true } => "none: proved".into(),
        Measure::None { proved: false } => "none, by ranks modulo two primes: no proof".into(),
        Measure::Local { density: None } => "one, locally, not printed in this ansatz".into(),
        Measure::Local { density: Some(density) } => format!("{}, verified", density_words(system, density)),
        Measure::Open(open) => format!("open ({open})"),
    }
}

/// The density in the names of the scene.
fn density_words(system: &System, density: &Density) -> String {
    let power = |base: String, exponent: String| match &exponent[..] {
        "0" => None,
        "1" => Some(base),
        _ => Some(format!("{base}^({exponent})")),
    };
    let mut factors: Vec<String> = power("det(g)".into(), density.of_metric.to_string()).into_iter().collect();
    for (i, exponents) in &density.of_angles {
        for (function, exponent) in ["sin", "cos"].into_iter().zip(exponents) {
            factors.extend(power(format!("|{function}({})|", system.coordinates[*i].name), exponent.to_string()));
        }
    }
    let free: Vec<String> = density.free.iter().map(|&i| format!("{}'", system.coordinates[i].name)).collect();
    let volume = "dq ds";
    let product = if factors.is_empty() { volume.into() } else { format!("{} {volume}", factors.join(" ")) };
    format!("{product}, s = ({}), T = g_ab s^a s^b/2 on the constraints", free.join(", "))
}

fn count_words(found: &Result<Found, Open>) -> String {
    match found {
        Err(open) => format!("open ({open})"),
        Ok(found) if found.none_proved() && found.trivial == 0 => "none: proved".into(),
        Ok(found) if found.none_proved() => {
            format!("none but {} of energy, constants and products: proved", found.trivial)
        }
        Ok(found) if found.settled => format!("{} local ones{}", found.further(), beside(found)),
        Ok(found) => format!(
            "open (at most {} local ones{}: proved; not settled at order {})",
            found.further(),
            beside(found),
            found.order
        ),
    }
}

fn beside(found: &Found) -> String {
    if found.trivial == 0 {
        String::new()
    } else {
        format!(" beside {} of energy, constants and products", found.trivial)
    }
}

fn value(findings: &Findings) -> Value {
    let system = &findings.scene.system;
    let measure = findings.reversed.as_ref().map(|found| match &found.measure {
        Measure::None { proved } => json!({ "answer": "none", "proved": proved }),
        Measure::Local { density } => {
            json!({ "answer": "local", "density": density.as_ref().map(|density| density_words(system, density)) })
        }
        Measure::Open(open) => json!({ "answer": "open", "reason": open.to_string() }),
    });
    let count = |(i, found): (usize, &Result<Found, Open>)| match found {
        Err(open) => json!({ "degree": i + 1, "answer": "open", "reason": open.to_string() }),
        Ok(found) => json!({
            "degree": found.degree,
            "answer": if found.none_proved() { "none" } else if found.settled { "local" } else { "open" },
            "at_most": found.count,
            "trivial": found.trivial,
            "order": found.order,
        }),
    };
    let counts =
        findings.reversed.as_ref().map(|found| found.integrals.iter().enumerate().map(count).collect::<Vec<_>>());
    let ansatz = match &findings.ansatz {
        Err(open) => json!({ "reason": open.to_string() }),
        Ok(found) => {
            let printed = found.printed.iter().zip(&findings.drifts).map(|(integral, drift)| {
                json!({ "kind": kind(integral), "degree": integral.degree, "expression": integral.text, "drift": drift })
            });
            json!({
                "functions": found.functions,
                "coordinates": found.names,
                "spatial_degree": found.spatial,
                "dimension": found.dimension,
                "printed": printed.collect::<Vec<_>>(),
                "unprinted": found.unprinted,
            })
        }
    };
    let invariants = findings.invariants.iter().map(|(name, held)| json!({ "name": name, "constant": held }));
    json!({
        "scene": findings.scene.name,
        "formulation": findings.formulation,
        "measure": measure,
        "polynomials": counts,
        "ansatz": ansatz,
        "invariants": invariants.collect::<Vec<_>>(),
    })
}
