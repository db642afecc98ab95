//! What is solved, and by whom.

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use validation::casadi_job::Tag;
use validation::catalogue::SCENES;

use crate::trailer;

/// A problem as a tool gets it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Case {
    /// Name of the scene.
    pub name: String,
    /// Text of the scene.
    pub toml: String,
    /// `scene`: derived from the text; for the car with trailers also `reduced` and `multipliers`, both by hand.
    pub form: String,
    /// Name of the formulation.
    pub formulation: String,
    /// Name of the removal.
    pub removal: Option<String>,
    /// Times at which the coordinates are wanted; the first is the start.
    pub times: Vec<f64>,
    /// `time`, or `reference`.
    pub purpose: String,
    /// What the states of the start are.
    pub tags: Vec<Tag>,
    /// `y(t₀)`, free constants included.
    pub start: Vec<f64>,
}

/// A tool with the form in which it gets the problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entrant {
    /// `ours`, `heyoka`, `scipy`, `casadi`, `sympy`.
    pub tool: &'static str,
    /// [`Case::form`].
    pub form: &'static str,
}

/// A scene in a formulation, with those who solve it.
#[derive(Clone, Debug)]
pub struct Problem {
    /// What the page calls it.
    pub title: String,
    /// Short, for file names.
    pub slug: String,
    /// Trailers, where it is the car with trailers.
    pub trailers: Option<usize>,
    /// The case, with no start yet.
    pub case: Case,
    /// Who solves it; ours is the first.
    pub entrants: Vec<Entrant>,
}

/// Intervals between the times at which errors are taken.
const SAMPLES: usize = 20;

/// Trailers of the cars that are solved.
const TRAILERS: [usize; 3] = [5, 20, 80];

fn problem(title: &str, slug: &str, toml: String, formulation: &str, removal: Option<&str>, duration: f64) -> Problem {
    let times = (0..=SAMPLES).map(|i| duration * i as f64 / SAMPLES as f64).collect();
    let case = Case {
        name: slug.into(),
        toml,
        form: "scene".into(),
        formulation: formulation.into(),
        removal: removal.map(Into::into),
        times,
        purpose: "time".into(),
        tags: Vec::new(),
        start: Vec::new(),
    };
    let entrant = |tool| Entrant { tool, form: "scene" };
    let mut entrants = ["ours", "heyoka", "scipy", "casadi"].map(entrant).to_vec();
    if formulation == "chetaev" {
        entrants.push(entrant("sympy"));
    }
    Problem { title: title.into(), slug: slug.into(), trailers: None, case, entrants }
}

/// Every problem, in the order of the page.
///
/// # Errors
/// Where a scene is not in the catalogue.
pub fn problems() -> Result<Vec<Problem>> {
    let text = |name: &str| -> Result<String> {
        let found = SCENES.iter().find(|(scene, _)| *scene == name).with_context(|| format!("no scene {name}"))?;
        Ok(found.1.to_string())
    };
    let (sledge, cone) = (text("sledge")?, text("ball-in-cone")?);
    let mut all = vec![
        problem("sledge, Chetaev", "sledge-chetaev", sledge.clone(), "chetaev", None, 10.0),
        problem("sledge, vakonomic", "sledge-vakonomic", sledge.clone(), "vakonomic", None, 10.0),
        problem("sledge, removed", "sledge-removed", sledge, "removed-constraint", Some("arc-length"), 10.0),
        problem("cone, Chetaev", "cone-chetaev", cone.clone(), "chetaev", None, 5.0),
        problem("cone, vakonomic", "cone-vakonomic", cone, "vakonomic", None, 5.0),
    ];
    for n in TRAILERS {
        let mut car = problem(
            &format!("{n} trailers, Chetaev"),
            &format!("trailers-{n}"),
            trailer(n, 10.0),
            "chetaev",
            None,
            10.0,
        );
        car.trailers = Some(n);
        let by_hand = [("heyoka", "reduced"), ("scipy", "reduced"), ("casadi", "reduced"), ("scipy", "multipliers")];
        let derived = [("heyoka", "scene"), ("casadi", "scene"), ("sympy", "scene")];
        let others = by_hand.into_iter().chain(derived.into_iter().filter(|(tool, _)| *tool != "sympy" || n <= 20));
        car.entrants = vec![Entrant { tool: "ours", form: "scene" }];
        car.entrants.extend(others.map(|(tool, form)| Entrant { tool, form }));
        all.push(car);
    }
    // no motion: how long SymPy needs between the smallest and the largest of those it is asked for
    let mut ten = problem("10 trailers, Chetaev", "trailers-10", trailer(10, 10.0), "chetaev", None, 10.0);
    ten.trailers = Some(10);
    ten.entrants.retain(|entrant| ["ours", "sympy"].contains(&entrant.tool));
    all.push(ten);
    Ok(all)
}
