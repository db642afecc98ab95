//! Fields of `p` elements, and the field of the current computation.

use std::cell::Cell;

/// A prime `p = 1 + 2 · 720720 r`, under 2^61, in whose field all primes up to 47 have roots.
#[derive(Debug)]
pub struct Field {
    pub(super) number: usize,
    pub(super) prime: u64,
    /// The prime order `r` of the images of `e^{i a}` and `e^a`.
    pub(super) order: u64,
    /// Image of `e^i`; that of `e` is a power of it.
    pub(super) circle: u64,
    /// Image of `e^{iπ/720720}`.
    pub(super) root: u64,
    /// A number without a square root.
    pub(super) no_square: u64,
    /// `−1/p` modulo 2^64, and `2^128` modulo `p`.
    pub(super) inverse: u64,
    pub(super) square: u64,
    /// `2^64` modulo `p`: the image of 1.
    pub(super) one: u64,
}

impl Field {
    const fn new(number: usize, [prime, order, circle, root, no_square]: [u64; 5]) -> Field {
        let mut inverse = 1_u64;
        let mut step = 0;
        while step < 6 {
            inverse = inverse.wrapping_mul(2_u64.wrapping_sub(prime.wrapping_mul(inverse)));
            step += 1;
        }
        let (mut square, mut bit) = (1_u64, 0);
        while bit < 128 {
            square = square * 2 % prime;
            bit += 1;
        }
        let one = ((1_u128 << 64) % prime as u128) as u64;
        Field { number, prime, order, circle, root, no_square, inverse: inverse.wrapping_neg(), square, one }
    }
}

/// The fields, in the order in which they are tried.
pub static FIELDS: [Field; 4] = [
    Field::new(0, [1_564_665_937_272_678_241, 1_085_488_079_471, 975_884_136_587_877_671, 526_195_852_125_278_733, 59]),
    Field::new(1, [2_001_148_671_957_795_361, 1_388_298_279_469, 461_914_068_013_983_121, 202_331_662_873_999_217, 53]),
    Field::new(2, [1_338_093_198_693_931_681, 928_303_084_897, 1_221_517_435_739_604_024, 203_386_488_316_749_660, 59]),
    Field::new(
        3,
        [1_600_630_950_478_079_521, 1_110_438_832_333, 1_414_060_028_229_214_018, 578_905_345_920_477_889, 53],
    ),
];

thread_local! {
    static FIELD: Cell<&'static Field> = const { Cell::new(&FIELDS[0]) };
}

/// That of the computation.
pub(super) fn field() -> &'static Field {
    FIELD.get()
}

/// `compute`, all elements being of this field; none of them may leave it.
pub fn in_field<T>(field: &'static Field, compute: impl FnOnce() -> T) -> T {
    struct Back(&'static Field);
    impl Drop for Back {
        fn drop(&mut self) {
            FIELD.set(self.0);
        }
    }
    let _back = Back(FIELD.replace(field));
    compute()
}

/// What `compute` finds alike in two fields, in each with one of the `seeds`; what is `enough` needs one
/// only.
///
/// # Errors
/// The first fault of `compute`; `None` where it has none, and no two fields agree.
pub fn agreed<T: PartialEq, E>(
    seeds: [u64; FIELDS.len()],
    mut compute: impl FnMut(u64) -> Result<T, E>,
    enough: impl Fn(&T) -> bool,
) -> Result<T, Option<E>> {
    let mut found: Vec<T> = Vec::new();
    let mut fault = None;
    for (field, seed) in FIELDS.iter().zip(seeds) {
        match in_field(field, || compute(seed)) {
            Ok(x) if enough(&x) || found.contains(&x) => return Ok(x),
            Ok(x) => found.push(x),
            Err(error) => fault = fault.or(Some(error)),
        }
    }
    Err(fault)
}

/// What comes of `compute` in the first field where it succeeds.
///
/// # Errors
/// That of the first field, where it succeeds in none.
pub fn in_any_field<T, E>(mut compute: impl FnMut() -> Result<T, E>) -> Result<T, E> {
    let first = in_field(&FIELDS[0], &mut compute);
    first.or_else(|error| FIELDS[1..].iter().find_map(|field| in_field(field, &mut compute).ok()).ok_or(error))
}
