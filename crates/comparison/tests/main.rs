//! The library as its user meets it: one program, one module per subject.

mod answers;
mod beginnings;
mod charts;
mod compared;
mod contradictions;
mod errors;
mod estimates;
mod fits;
mod fitted;
mod gaps;
mod known_gaps;
mod known_growth;
mod known_members;
mod known_roots;
mod known_round_off;
mod known_stops;
mod known_values;
mod one_scene;
mod sentences;
#[path = "../../motion/tests/support.rs"]
mod support;
