//! What programs share: one program, one module per subject.

mod answers;
mod files;
mod priority_queue;
mod resumable_file;
