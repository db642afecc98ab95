//! The library as its user meets it: one program, one module a subject.

mod charts;
mod contradictions;
mod errors;
mod estimates;
mod examples;
mod fits;
mod gaps;
mod long;
mod round_off;
mod steep;
mod switches;
mod walls;
