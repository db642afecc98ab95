//! A point of a motion.

use stubs::{answer, stubbed};

#[answer]
pub(crate) struct State;

#[stubbed]
impl State {
    fn __repr__(&self) -> String {
        format!("<deltaq.State t={}, q={}, v={}>", self.t, self.q, self.v)
    }
}
