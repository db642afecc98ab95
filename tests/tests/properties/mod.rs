//! The claims T1–T14 on random systems that nobody chose, drawn and shrunk by proptest.
//!
//! The systems are those of `deltaq random`, with other seeds. `PROPTEST_RNG_SEED=N` draws others still, `PROPTEST_CASES=N` more of them.
//! What fails is shrunk to the smallest system that still fails and printed as a scene file, and its seed is kept in `properties.seeds`.

mod claims;
mod forms;
mod generator;
mod invariants;
mod support;
