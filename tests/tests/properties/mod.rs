//! The claims T1–T18 on random systems that nobody chose, drawn and shrunk by proptest.
//!
//! Systems are those of `evidence random`, other seeds. `PROPTEST_RNG_SEED=N` draws others still,
//! `PROPTEST_CASES=N` more. Failures are shrunk and printed as scene files, seeds kept in `properties.seeds`.

mod claims;
mod contradictions;
mod estimates;
mod falsified;
mod forms;
mod generator;
mod invariants;
mod limits;
mod once_wrong;
mod support;
