//! # Checks equations of motion, and names their mistakes
//!
//! Given: a scene, `L(q, v, t)`, `f(q, v, t) = 0`, `Q`, and somebody's equations, with any multipliers, in
//! any order, scaled and combined, perhaps in other coordinates.
//!
//! **Right** are equations with the accelerations of the scene, `q̈(q, v, t, p)` on `f = 0`. Multipliers are
//! eliminated on both sides, constraints differentiated. Where everything is rational in variables, sines,
//! cosines and exponentials, this is compared at random points of a field of `p ≈ 2^60` residues, parameters
//! `p` being random as well: a difference is proved, equality at all of them would else be an accident.
//! Roots, logarithms, constraints that are not linear in `v`, and states on a leaf of a position constraint
//! have no such points: there, floats with bands of round-off decide ([`Numbers::Floats`]).
//!
//! **Wrong.** Let `R = (E − Q − Aᵀλ, ḟ)` be the rows of the right derivation at *their* accelerations, `Z R`
//! what is left of rows when `λ` is eliminated. A mistake in one term adds `κ` times a known column `u`:
//!
//! ```text
//! Z R = −κ Z u            κ = −1: dropped, −2: wrong sign, 1: twice, −½: half
//! ```
//!
//! with the same `κ` at every point. So single mistakes, and pairs by determinants, are found without
//! deriving anything again: terms of `L` and of the balances, factors and powers in them, `∂L/∂q` or the
//! rate of the mass matrix left out, forces on other coordinates, the rate of the constraint's rows. Other
//! rows are those of other formulations, of the constraint put into `L` ([`substitution`]), and of
//! constraints with one mistake in them. What is found reproduces their equations at every point. Several
//! mistakes may give the same ones: such readings are told, up to six of a kind.
//!
//! **What is not told.** Three mistakes; mistakes in `L` itself, which the scene has as well.

mod atoms;
mod base;
mod c_code;
mod case;
mod error;
mod frame;
mod latex;
mod laws;
mod mend;
mod monomials;
mod number;
mod reading;
mod review;
pub mod substitution;
mod table;
mod text;
mod theirs;
mod value;

use scene::Scene;

pub use error::ReviewError;
pub use laws::Law;
pub use mend::{Mend, mends};
pub use monomials::Coefficient;
pub use review::{Asked, Difference, Numbers, Review, Verdict, states};
pub use substitution::SUBSTITUTION;
pub use value::Reviewed;

/// How equations are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notation {
    /// One per line, in the notation of scenes.
    Text,
    /// LaTeX.
    Latex,
    /// A C function of state and rates.
    C,
    /// CSV of states with accelerations.
    Table,
}

impl Notation {
    /// That of a file, by the end of its name, or else by its text.
    pub fn of(file: &str, text: &str) -> Notation {
        let end = file.rsplit('.').next().unwrap_or_default();
        let says = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
        let header = text.lines().find(says).unwrap_or_default();
        match end {
            "csv" => Notation::Table,
            "c" | "h" | "cpp" => Notation::C,
            "tex" => Notation::Latex,
            _ if text.contains("double ") && text.contains('{') => Notation::C,
            _ if text.contains('\\') => Notation::Latex,
            _ if header.contains(',') && !header.contains('=') => Notation::Table,
            _ => Notation::Text,
        }
    }
}

/// Reviews `text`, read from `file`.
///
/// # Errors
/// [`ReviewError`], with the place.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let sleigh = scene::catalogue::find("sleigh", &[])?;
/// let theirs = "m*x'' - m*a*(phi''*sin(phi) + phi'^2*cos(phi)) = -k*sin(phi)
///               m*y'' + m*a*(phi''*cos(phi) - phi'^2*sin(phi)) = k*cos(phi)
///               (I + m*a)*phi'' = m*a*(x''*sin(phi) - y''*cos(phi))
///               y'*cos(phi) = x'*sin(phi)";
/// let review = review::review(&sleigh, "theirs.txt", theirs, &review::Asked::default())?;
/// assert_eq!(review.verdict, review::Verdict::Wrong);
/// assert_eq!(review.explanations[0], ["power of a is dropped in `m*a^2*phi'^2/2` of L"]);
/// # Ok(())
/// # }
/// ```
pub fn review(scene: &Scene, file: &str, text: &str, asked: &Asked) -> Result<Review, ReviewError> {
    read(scene, file, text, asked, true)
}

/// The review, with explanations or with the verdict only.
fn read(scene: &Scene, file: &str, text: &str, asked: &Asked, explains: bool) -> Result<Review, ReviewError> {
    let system = &scene.system;
    let lines = match Notation::of(file, text) {
        Notation::Table => return review::review(scene, &[], Some(&table::rows(system, file, text)?), asked, explains),
        Notation::Text => text::lines(file, text),
        Notation::Latex => latex::lines(&system.graph, &names(scene, asked), file, text)?,
        Notation::C => {
            let order: Vec<String> = system.coordinates.iter().map(|c| c.name.clone()).collect();
            c_code::lines(&order, file, text)?
        }
    };
    if lines.is_empty() {
        return Err(ReviewError::Unreadable { place: file.into(), what: "there are no equations in it".into() });
    }
    review::review(scene, &lines, None, asked, explains)
}

/// Names of the scene, and those in which its names are given.
fn names(scene: &Scene, asked: &Asked) -> Vec<String> {
    let system = &scene.system;
    let own = system.coordinates.iter().map(|c| c.name.clone());
    let parameters = system.parameters.iter().map(|p| system.graph.name(p.symbol));
    let formulas = asked.wheres.iter().filter_map(|text| text.split_once('='));
    let theirs = formulas.flat_map(|(_, formula)| symbolic::names_in(formula)).map(|(name, _)| name.to_owned());
    own.chain(parameters).chain(theirs).collect()
}
