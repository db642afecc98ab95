//! By which velocities others are told.

use symbolic::Expr;

/// Which velocities the others are combinations of, where other ones would do as well.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Names of the velocities, or of the coordinates whose velocities they are.
    pub independent: Vec<String>,
    /// The coefficients of the combinations, in `(t, y)`: they grow where a pivot becomes small beside them.
    pub coefficients: Vec<Expr>,
    /// Whether pivots may vanish.
    pub may_vanish: bool,
}
