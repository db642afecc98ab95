//! The common part of the programs of this workspace: threads and progress, files that are written whole,
//! answers on the terminal, options and exit codes.
//!
//! [`finish`] has the exit codes: 1 where the answer cannot be written, 2 for bad input, 3 for an answer that
//! cannot be trusted, 4 where results contradict each other and 5 where a computation breaks off: both are
//! faults of the program.

mod answer;
mod ending;
mod files;
mod lines;
mod options;
pub mod parallel;
mod sink;
pub mod turns;

pub use answer::{Answer, Unwritten, complain, plain, pretty, print, sorted};
pub use ending::{exit_code, finish, parse};
pub use files::{File, is_own, write_all, write_own};
pub use lines::Lines;
pub use options::{Common, Output, TextOrJson, by_name, folder};
pub use sink::{Sink, file, keep, may_replace};
