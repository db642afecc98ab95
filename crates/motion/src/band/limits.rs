//! The limits of trust, each with its reason: the only place where they stand.

/// How many times the sum of both errors a difference has to be to count.
pub use decision::CERTAINTY;

/// The difference of a single coordinate has to be this many times as large again, because the errors of
/// single coordinates are estimated less well than the length of all.
pub(crate) const ALONE: f64 = 10.0;

/// Relative error above which neither a motion nor a coordinate nor a multiplier is trusted: three digits are
/// the least that a reader of a table expects.
pub const TRUSTED: f64 = 1e-3;

/// Relative error below which two motions may be called the same: what the default tolerance leaves on
/// motions that do not lose digits.
pub const SAME_ESTIMATE: f64 = 1e-8;

/// Round-off of any number of a motion, as a part of its size: some
/// thousand steps lose that much, and rates that lose more are found ([`super::accumulated_round_off`]).
pub(crate) const ROUND_OFF: f64 = 256.0 * f64::EPSILON;

/// The error of a sum over what is added up to it: numbers are rounded to the nearest.
pub(crate) const ROUNDED: f64 = 0.5 * f64::EPSILON;

/// Units in the last place by which a start is moved: fewer may vanish in the first sum, and more would be an
/// error of the start.
pub(crate) const UNITS: f64 = 4.0;

/// Accumulated round-off above this part of a state raises a doubt: less of it can be put into a run, which
/// shows how it grows; more would make another motion.
pub(crate) const TOLD: f64 = 1e-6;

/// Accumulated round-off up to this many times the difference of the runs counts as no more than that
/// difference: it is an upper bound.
pub(crate) const NEARLY: f64 = 4.0;

/// Sums of terms may be so many times as large between the instants of a first look as at these:
/// a pulse between them may be.
pub(crate) const BETWEEN: f64 = 8.0;

/// The part of a stopped motion that is judged: just before a singularity steps are short and terms large at
/// any tolerance.
pub(crate) const BEFORE_THE_END: f64 = 0.9;

/// Fewer steps than this may be those of the start, or of a motion that is a polynomial.
pub(crate) const FEW_STEPS: usize = 200;

/// A hundredth of the tolerance takes at least this power of the steps that the order of the method asks for.
pub(crate) const MORE_STEPS: f64 = 1.0 / 3.0;

/// Steps of a hundredth of the tolerance over what the method's order asks for; beyond, it is round-off.
pub(crate) const TOO_MANY: f64 = 10.0;

/// Number of steps of the looser run per stretch, in the search for where a doubt begins: enough for a ratio.
pub(crate) const TOGETHER: usize = 20;

/// Stretches of a motion at whose ends both runs are compared; at whose ends rates and constraints are looked
/// at; and the same in a first look. A long run is kept at these times.
pub const STRETCHES: [usize; 3] = [SAMPLES, LOOKS, FEW];
pub(crate) const SAMPLES: usize = 200;
pub(crate) const LOOKS: usize = 32;
pub(crate) const FEW: usize = 4;

/// So many ends of steps are looked at in addition, or all: half of them a like number of steps apart, and
/// those of the shortest, which are where rates are large.
pub(crate) const ENDS: usize = 64;

/// Number of instants at which sums of terms behind multipliers, and in members behind rates, are computed:
/// they are evaluated in numbers that carry their magnitude, which takes longer than rates.
pub(crate) const SUMS: usize = 16;

/// Instants within the time of all members of an ensemble at which their constraints are looked at.
pub const WATCHED: usize = 8;
