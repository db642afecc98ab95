//! The limits of trust, each with its reason: the only place where they stand.

/// How many times the sum of both errors a difference has to be to count.
pub use decision::CERTAINTY;

/// Relative error above which neither a motion nor a coordinate nor a multiplier is trusted: three digits are
/// the least that a reader of a table expects. Two runs that stop within this part of the way stop at the
/// same place.
pub const TRUSTED: f64 = 1e-3;

/// Relative error below which two motions may be called the same: what the default tolerance leaves on
/// motions that do not lose digits.
pub const SAME_ESTIMATE: f64 = 1e-8;

/// Round-off of any number of a motion, as a part of its size: some
/// thousand steps lose that much, and rates that lose more are found ([`super::accumulated_round_off`]).
pub(crate) const ROUND_OFF: f64 = 256.0 * f64::EPSILON;

/// Units in the last place by which a start is moved: fewer may vanish in the first sum, and more would be an
/// error of the start. Round-off may be so many times what a sample of it shows, and what the difference of
/// the runs does: sums of it are upper bounds.
pub(crate) const UNITS: f64 = 4.0;

/// Sums of terms may be so many times as large between the instants of a first look as at these, as may be
/// round-off beside a sample of it: a pulse between them may be.
pub(crate) const BETWEEN: f64 = 8.0;

/// The part of a stopped motion that is judged: just before a singularity steps are short and terms large at
/// any tolerance.
pub const BEFORE_THE_END: f64 = 0.9;

/// A quantity is nearly zero under this part of the largest that it was, or than it is beside.
pub const NEARLY_ZERO: f64 = 1e-2;

/// Residual of a boundary value that is accepted, over the tolerance of the kept run and its size.
pub const RESIDUAL: f64 = 1e3;

/// Fewer steps than this may be those of the start, or of a motion that is a polynomial.
pub(crate) const FEW_STEPS: usize = 200;

/// A hundredth of the tolerance takes at least this power of the steps that the order of the method asks for.
pub(crate) const MORE_STEPS: f64 = 1.0 / 3.0;

/// Stretches of a motion at whose ends both runs are compared; at whose ends rates and constraints are looked
/// at; and the same in a first look. A long run is kept at these times.
pub const STRETCHES: [usize; 3] = [SAMPLES, LOOKS, FEW];
/// Of these, the stretches at whose ends both runs are compared.
pub const SAMPLES: usize = 200;
/// The second of these, also the instants by which the growth of a gap is measured.
pub const LOOKS: usize = 32;
pub(crate) const FEW: usize = 4;

/// Instants at which something is looked at that passes between two samples: ends of steps (all, or half of
/// so many a like number of steps apart and those of the shortest, which are where rates are large), the
/// last half of a run that ends early, Legendre's condition.
pub const INSTANTS: usize = 64;

/// Number of instants at which sums of terms behind multipliers, and in members behind rates, are computed:
/// they are evaluated in numbers that carry their magnitude, which takes longer than rates. At so many,
/// curves are compared; and so many steps of the looser run, where a doubt begins, are enough for a ratio.
pub const SOME: usize = 16;

/// Instants within the time of all members of an ensemble at which their constraints are looked at.
pub const WATCHED: usize = 8;

/// Steps that a run of a search for unknowns may take: more are those of a singularity.
pub const SEARCH_STEPS: usize = 5_000;

/// Members of an ensemble that are integrated before they are handed on: all lanes of all processors are busy
/// for a moment, and little memory is.
pub const CHUNK: usize = 4096;
