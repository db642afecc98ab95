//! The library as its user meets it: one program, one module a subject.

mod answers;
mod beginnings;
mod charts;
mod collocation;
mod cones;
mod connect;
mod contradictions;
mod endings;
mod errors;
mod estimates;
mod examples;
mod fits;
mod gaps;
mod known_members;
mod known_round_off;
mod known_values;
mod long;
mod model;
mod round_off;
mod sensitivities;
mod sentences;
mod silent;
mod steep;
mod switches;
mod walls;
