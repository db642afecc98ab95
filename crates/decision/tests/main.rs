//! Decisions whose answers are known: of scenes, and of systems with closed forms.

mod classics;
mod closed_forms;
mod drawn;
mod exact;
mod floating;
mod hypotheses;
mod leaves;
mod numbers;
mod proofs;
mod questions;
mod rest;
mod signs;
