//! Limits that several crates ask for, each with the reason for its value.

/// What is this part of that with which it is compared is nothing: rounded decimals, as users write them,
/// leave so much of sums that are zero, and of singular values of dependent rows.
pub const NOTHING: f64 = 1e-9;

/// Two numbers that differ by less than this part of them are the same: solvers at their default tolerances
/// leave less, and other solutions differ by more.
pub const SAME: f64 = 1e-6;

/// Round-off of a sum of few terms, as a part of these: some hundred roundings.
pub const OF_TERMS: f64 = 1e-13;

/// Half of the digits: what derivatives by differences have, and roots of what is right to the last digit.
pub const HALF_THE_DIGITS: f64 = 1e-8;

/// The last digits: round-off of a number that follows from some others, as a part of it.
pub const LAST_DIGITS: f64 = 1e-14;

/// Rows and columns are dependent where singular values, or pivots, are under this part of the largest: four
/// more digits would be left of what is divided by, of fourteen.
pub const DEPENDENT: f64 = 1e-10;

/// What is under this part of its neighbours is not divided by where another can be: it may come to nothing
/// along the way.
pub const PIVOT: f64 = 1e-4;

/// Steps of an iteration that halves an interval or squares an error: so many halvings take a number to its
/// last digit, and what has not ended by then does not end.
pub const ITERATIONS: usize = 60;

/// A second step of Newton's method over this part of the first may lead to another root.
pub const CONTRACTION: f64 = 0.5;

/// Nodes of an expression that gets no name of its own.
pub const SHORT: usize = 8;

/// Nodes over which an expression is not multiplied out: what cancels does so in shorter ones.
pub const LONG: usize = 100;

/// Numbers are moved by this part, so that nothing cancels by accident.
pub const BESIDE: f64 = 1e-2;

/// Points of a finite field at which an identity is tried: one that is none has a chance of its degree over
/// the field's order at each.
pub const IN_FIELD: u64 = 2;

/// Points at which an expression is tried where nothing is proved.
pub const POINTS: usize = 32;

/// Terms over which an expression is not taken apart.
pub const TERMS: usize = 400;

/// Prime factors under this are looked for under roots of numbers.
pub const PRIMES: i64 = 4096;

/// Larger numerators and denominators come from measured numbers.
pub const FRACTION: i64 = 1_000_000;

/// Nodes or terms over which algebra is given up: it would take seconds.
pub const TOO_LONG: usize = 10_000;

/// Numbers that are written one after the other in a message.
pub const SHOWN: usize = 8;

/// Definitions and brackets within one another that are looked into.
pub const DEPTH: usize = 64;

/// Characters that are read at a glance: of a line, of an expression without named parts.
pub const LINE: usize = 60;
