//! A point of a motion.

use stubs::answer;

#[answer("<deltaq.State t={t}, q={q}, v={v}>")]
pub(crate) struct State;
