//! What programs share: one program, one module per subject.

mod answers;
mod files;
mod lines;
mod turns;
