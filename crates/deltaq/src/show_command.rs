//! `deltaq list` and `deltaq show`.

use std::fmt::Write;

use anyhow::{Result, bail};
use comparison::integrability;
use equations::{Cost, Equations, Formulation};
use integrate::Method;
use mechanics::{ConstantsRule, Integrability};
use motion::{
    Choice, Chosen, ChosenForm, EquationStyle, FORMS, FORMULATIONS, Form, Prepared, Settings, SolveError,
    choices_among, code, derive_at, derive_in_form, equations_text, forms, prepare, setting, shared_text, system_text,
};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::ShowArguments;
use program::{TextOrJson, typed};

/// The built-in scenes, then those of the pages about the literature, a line each.
pub(crate) fn list(format: TextOrJson) -> Result<String> {
    let of = |(title, group): (&'static str, &'static [(&str, &str)])| {
        group.iter().map(move |(name, text)| Ok((title, Scene::parse(name, text)?)))
    };
    let scenes = scene::catalogue::GROUPS.into_iter().flat_map(of).collect::<Result<Vec<_>>>()?;
    let line = |(_, scene): &(_, Scene)| format!("{:<24} {} ({})\n", scene.name, scene.title, scene.source);
    Ok(match format {
        TextOrJson::Text => scenes.iter().map(line).collect(),
        TextOrJson::Json => {
            let of = |(group, s): (_, Scene)| Listed { name: s.name, title: s.title, source: s.source, group };
            typed(&List { scenes: scenes.into_iter().map(of).collect() })?
        }
    })
}

/// The built-in scenes: `deltaq list --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "list/1")]
pub(crate) struct List {
    scenes: Vec<Listed>,
}

#[derive(Serialize, JsonSchema)]
struct Listed {
    name: String,
    title: String,
    source: String,
    group: &'static str,
}

/// Equations of a scene: `deltaq show --format json`; formulas are plain text, or LaTeX with --latex.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "show/1")]
pub(crate) struct Shown<'a> {
    scene: &'a str,
    title: &'a str,
    source: &'a str,
    lagrangian: String,
    /// Each is zero.
    constraints: Vec<String>,
    /// Names in the Lagrangian and the constraints, with what they stand for: parts that are shared, where
    /// these would be long without. Later ones may contain earlier ones.
    shared: Vec<[String; 2]>,
    integrability: String,
    /// Times at which every method ends a step.
    breakpoints: &'a [f64],
    formulations: Vec<ShownFormulation<'a>>,
}

#[derive(Serialize, JsonSchema)]
struct ShownFormulation<'a> {
    label: &'a str,
    formulation: &'static str,
    /// Name of the removal, of removed-constraint equations.
    removal: Option<&'a str>,
    /// What `deltaq show` prints; null where the formulation refuses the scene.
    equations: Option<&'a str>,
    refused: Option<&'a str>,
    /// The form that is integrated unless another one is asked for, and why; null where there is none.
    form: Option<ShownForm<'a>>,
}

impl<'a> ShownFormulation<'a> {
    fn of((choice, derived, integrated): &'a (Choice, Result<String, String>, Option<ChosenForm>)) -> Self {
        ShownFormulation {
            label: &choice.label,
            formulation: choice.formulation.name,
            removal: choice.removal.as_ref().map(|removal| &removal.name[..]),
            equations: derived.as_deref().ok(),
            refused: derived.as_ref().err().map(String::as_str),
            form: integrated.as_ref().map(|form| ShownForm { name: form.name, because: &form.why }),
        }
    }
}

#[derive(Serialize, JsonSchema)]
struct ShownForm<'a> {
    name: &'static str,
    because: &'a str,
}

/// Equations of more bytes than this are printed only where they are asked for.
const LONG: usize = 30_000;

/// Equations of every formulation and form, what was left out, and whether constraints are integrable.
pub(crate) fn run(arguments: &ShowArguments) -> Result<String> {
    if arguments.source {
        return Ok(scene::catalogue::source(&arguments.scene.scene)?);
    }
    let scene = arguments.scene.find()?;
    if arguments.formulas {
        return match scene.meant {
            Some(meant) => Ok(meant.formulas),
            None => Ok(scene::catalogue::source(&arguments.scene.scene)?),
        };
    }
    let style = if arguments.latex { EquationStyle::Latex } else { EquationStyle::Plain };
    let mut equations = Vec::new();
    let asked = &arguments.formulation;
    let suits = |own: &&Formulation| own.needs.are_met_by(&scene.system);
    let known: Vec<&Formulation> = FORMULATIONS.iter().chain(FORMS).copied().filter(suits).collect();
    if let Some(other) = asked.iter().find(|own| !known.contains(own)) {
        let known: Vec<&str> = known.iter().map(|own| own.name).collect();
        bail!("--formulation {}: this scene has {}", other.name, known.join(", "));
    }
    let wanted = |own: &Formulation| asked.is_empty() || asked.iter().any(|one| one.name == own.name);
    let forms = forms(&scene).into_iter().filter(|choice| wanted(choice.formulation));
    let all: Vec<Choice> = choices_among(&scene, wanted).into_iter().chain(forms).collect();
    if let Some(language) = arguments.code {
        if asked.len() > 1 {
            bail!(
                "--code takes one formulation, and --formulation names {}",
                asked.iter().map(|own| own.name).collect::<Vec<_>>().join(", ")
            );
        }
        let equations = derive_at(&scene.system, &scene.start, &all[0])?;
        return Ok(code(&scene, &started(&scene, equations, &all[0])?, language.into())?);
    }
    for choice in all {
        let (derived, integrated) = match derive_in_form(&scene.system, &scene.start, &choice, Form::Suited) {
            Ok((equations, form)) if form.name == choice.formulation.name => (Ok(equations), Some(form)),
            suited => (derive_at(&scene.system, &scene.start, &choice), suited.ok().map(|(_, form)| form)),
        };
        let derived = match derived {
            Ok(equations) => {
                let text = equations_text(&equations, style);
                if asked.is_empty() && text.len() > LONG {
                    let (size, name) = (text.len() / 1000, choice.formulation.name);
                    Ok(format!(
                        "Equations of {size} kB; `deltaq show {} -f {name}` prints them.\n",
                        arguments.scene.scene
                    ))
                } else {
                    Ok(text + &form(&scene, equations, &choice)?)
                }
            }
            Err(error) => Err(error.to_string()),
        };
        equations.push((choice, derived, integrated));
    }
    let integrability = about_integrability(&scene, asked.is_empty())?;
    if arguments.format == TextOrJson::Json {
        let g = &scene.system.graph;
        let given = [&[scene.system.lagrangian], &scene.system.constraints[..]].concat();
        let (shared, mut constraints) = shared_text(g, &given, arguments.latex);
        let lagrangian = constraints.remove(0);
        return typed(&Shown {
            scene: &scene.name,
            title: &scene.title,
            source: &scene.source,
            lagrangian,
            constraints,
            shared,
            integrability,
            breakpoints: &scene.system.breakpoints,
            formulations: equations.iter().map(ShownFormulation::of).collect(),
        });
    }
    let source = if scene.source.is_empty() { String::new() } else { format!("{}\n", scene.source) };
    let mut text = format!("{}\n{source}\n{}", scene.title, system_text(&scene.system, style));
    let _ = writeln!(text, "\nConstraint: {integrability}");
    text += &of_contacts(&scene);
    for (choice, derived, integrated) in equations {
        let mut derived = derived.unwrap_or_else(|error| format!("refused: {error}\n"));
        if let Some(ChosenForm { name, why }) = integrated.filter(|form| form.name != choice.formulation.name) {
            let _ = writeln!(derived, "- integrated as {name}, unless another form is asked for: {why}");
        }
        let by_hand = scene.removals.iter().find(|own| choice.removal.as_ref().is_some_and(|r| r.name == own.name));
        if by_hand.is_some_and(|removal| removal.verify(&scene.system) == Ok(false)) {
            derived += "- by hand: it satisfies the constraints at random points, and that is not a proof for all\n";
        }
        let _ = write!(text, "\n## {}\n\n{derived}", choice.label);
    }
    Ok(text)
}

/// What the constraints of bodies say, each with its multiplier.
pub(crate) fn of_contacts(scene: &Scene) -> String {
    let Some(meant) = &scene.meant else { return String::new() };
    let kept = meant.constraints.iter().enumerate().map(|(i, says)| format!("  lambda_{}: {says}\n", i + 1));
    let left_out = meant.left_out.iter().map(|says| format!("  left out: {says}\n"));
    kept.chain(left_out).collect()
}

/// Whether the constraints are integrable. Ranks take far longer than brackets, and users who ask for the
/// equations of some formulations do not wait for them.
fn about_integrability(scene: &Scene, by_ranks: bool) -> Result<String> {
    if by_ranks {
        return Ok(integrability(scene)?.to_string());
    }
    let verdict = mechanics::integrability(&scene.system.clone(), &scene.start, scene.start.t + scene.duration)?;
    let hint =
        if matches!(verdict, Integrability::Undecided { .. }) { "; without --formulation ranks decide" } else { "" };
    Ok(format!("{verdict}{hint}"))
}

/// In which form the equations are evaluated, why, and what that costs.
fn form(scene: &Scene, equations: Equations, choice: &Choice) -> Result<String> {
    let mut ready = match started(scene, equations, choice) {
        Ok(ready) => ready,
        Err(error) => return Ok(format!("\nNot started: {error}\n")),
    };
    if ready.method.method == Method::Taylor {
        ready.complete(Method::Taylor)?;
    }
    let mut text = "\nEvaluated:\n\n".to_string();
    for words in ready.equations.chosen.iter().chain(&ready.form.why) {
        let _ = writeln!(text, "- {words}");
    }
    let Chosen { method, why } = &ready.method;
    let _ = writeln!(text, "- steps by {}, unless the motion asks for another method: {why}", method.name());
    let [plain, chosen] = ready.compiled.cost();
    let Cost { instructions, factorization } = chosen;
    let _ = write!(text, "- rates in {instructions} instructions");
    if factorization > 0 {
        let _ = write!(text, " and LU factorizations of {factorization} multiplications");
    }
    if plain != chosen {
        let Cost { instructions, factorization } = plain;
        let _ = write!(
            text,
            "; the plain form takes {instructions} and LU factorizations of {factorization} multiplications"
        );
    }
    text.push('\n');
    if let Some((products, terms)) = ready.compiled.cost_of_series() {
        let _ =
            writeln!(text, "- each order of a Taylor series in {products} products of series and {terms} linear terms");
    }
    Ok(text)
}

/// The start is needed, not the constants that are natural at a horizon: zero stands for them.
fn started(scene: &Scene, equations: Equations, choice: &Choice) -> Result<Prepared, SolveError> {
    let constants = match &choice.constants {
        ConstantsRule::Natural { .. } => &ConstantsRule::Zero,
        given => given,
    };
    prepare(setting(scene), equations, constants, &Settings::default())
}
