//! The common part of the programs of this workspace: threads and progress, files that are written whole,
//! answers on the terminal, options and exit codes.
//!
//! [`finish`] has the exit codes: 1 where the answer cannot be written, 2 for bad input, 3 for an answer that
//! cannot be trusted, 4 where results contradict each other and 5 where a computation breaks off: both are
//! faults of the program.

mod answer;
mod atomic_writer;
mod ending;
mod files;
mod options;
pub mod parallel;
pub mod priority_queue;
mod resumable_file;

pub use answer::{Answer, Unwritten, complain, plain, pretty, print, schema_of, sorted, typed};
pub use atomic_writer::{AtomicWriter, file, keep, may_replace};
pub use ending::{exit_code, finish, parse};
pub use files::{File, is_own, write_all, write_own};
pub use options::{Common, Output, TextOrJson, by_name, folder};
pub use resumable_file::ResumableFile;
