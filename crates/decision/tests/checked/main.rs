//! Decisions whose answers are known: of scenes, and of systems with closed forms.

mod floating;
mod questions;
