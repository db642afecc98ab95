//! Random systems: what must hold between the formulations, on systems that nobody chose.
//!
//! A [`Recipe`] is plain data that proptest draws and shrinks; [`Recipe::scene`] makes a scene of it, of
//! which [`Recipe::truth`] knows by construction whether its constraints are integrable. A [`Case`] adds the
//! motions of all formulations; [`CHECKS`] are the claims, each put to the test on a case.

mod build;
mod bulk;
mod case;
mod claims;
mod class;
mod derived;
mod fault;
mod feature;
mod finding;
mod found_out;
mod kind;
pub mod realization;
mod recipe;
mod record;
mod sentences;
mod transform;
pub mod writings;

pub use build::{DURATION, REMOVAL};
pub use bulk::{Batch, first_failures, shrink};
pub use case::{Case, NEAREST, Removed, Which};
pub use claims::{
    CHECKS, Check, DIVERGES, Divergence, NullTest, VISIBLE, broken_null_test, integrals_put_in, make, null_test,
    theorem_title,
};
pub use class::{Classes, Force, Sudden, Surface, Units};
pub use derived::{equations, free_constants};
pub use fault::Fault;
pub use feature::{Edge, FORMS, Far, Features, Form, Part, Root, Switch};
pub use finding::{Finding, Findings, Observation, Word};
pub use found_out::{FoundOut, Unjudged, found_out, referee};
pub use kind::{Kind, Truth};
pub use recipe::{LARGEST, MOST, Recipe, draw, draw_recipe, recipes, recipes_of};
pub use record::{Count, Open, Record, Summary, THOROUGH, milliseconds};
pub use sentences::{Said, sentences};
pub use transform::{Rewritten, Scaling, augmented, recombined};

/// The judgements behind the claims: when measured figures hold, when they fail, and when they say nothing.
pub mod judged {
    pub use crate::case::{floor, tolerances};
    pub use crate::claims::{denied, judge_growth, judge_rate, shows_two_terms, solution, visible};
}
