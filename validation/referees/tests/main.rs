//! Referees held against closed forms and differences: one program, one module per subject.

mod closed_forms;
mod maggi;
