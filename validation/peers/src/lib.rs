//! The same problems in the tools that a researcher would otherwise pick, timed beside ours.
//!
//! A tool is a process ([`Worker`]) that is asked in JSON, a line at a time, so that tools take turns and one that is too slow can be ended: the
//! peers run `validation/peers/worker.py`, ours is this program itself ([`serve`]). All errors are computed here, by one piece of code, in the
//! kinetic metric against one reference.
//!
//! [`problems`] says what is solved, [`race`] does it, [`page`] tells of it.

mod figures;
mod ours;
mod page;
mod problem;
mod race;
mod reference;
mod rounds;
mod rows;
mod tools;
mod trailer;
mod worker;

pub use figures::figures;
pub use ours::serve;
pub use page::{Provenance, page};
pub use problem::{Case, Entrant, Problem, problems};
pub use race::{Effort, Failure, Outcome, Rung, Task, race};
pub use tools::Tools;
pub use trailer::{trailer, train_of_bodies};
pub use worker::{Refusal, Worker};
