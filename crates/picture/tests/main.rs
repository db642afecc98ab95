//! Pictures and their parts: one program, one module per subject.

mod axes;
mod bodies;
mod colours;
mod pictures;
mod plain;
mod solids;
mod texts;
mod traces;
