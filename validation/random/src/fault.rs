//! Something that is made wrong on purpose, so that claims are seen to fail.

use motion::SolveError;
use scene::Scene;

use super::Case;

/// What is made wrong before claims are put to the test.
#[derive(Clone, Copy)]
pub struct Fault {
    /// With a case: one of its motions, or what is said of the system by construction.
    pub case: fn(&mut Case) -> Result<(), SolveError>,
    /// With the scene of a null test.
    pub null: fn(&mut Scene),
}

impl Fault {
    /// Nothing is wrong.
    pub const NONE: Fault = Fault { case: |_| Ok(()), null: |_| {} };
}
