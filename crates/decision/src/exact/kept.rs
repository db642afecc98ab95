//! Images in the fields that are asked for again and again.

use std::sync::LazyLock;

use super::Modular;
use super::field::{FIELDS, field, in_field};
use super::modular::NEPER;
use super::rational::PARTS;

/// Small numbers whose images and inverses are kept.
pub(super) const KEPT: usize = 64;

/// Images that are asked for again and again, of one field.
pub(super) struct Kept {
    pub(super) whole: [Modular; KEPT],
    pub(super) over: [Modular; KEPT],
    pub(super) half_over_i: Modular,
    pub(super) circle: Powers,
    pub(super) neper: Powers,
    pub(super) root: Powers,
}

static KEPT_IMAGES: LazyLock<[Kept; FIELDS.len()]> = LazyLock::new(|| {
    FIELDS.each_ref().map(|field| {
        in_field(field, || {
            let whole: [Modular; KEPT] = std::array::from_fn(|x| Modular::new(x as u64));
            let over = whole.map(|x| x.inverse().unwrap_or(Modular::ZERO));
            let (circle, root) = (Modular::new(field.circle), Modular::new(field.root));
            // 1/i = −i
            let half_over_i = -(over[2] * root.power(PARTS as u64 / 2));
            let powers = Powers::new;
            Kept {
                whole,
                over,
                half_over_i,
                circle: powers(circle),
                neper: powers(circle.power(NEPER)),
                root: powers(root),
            }
        })
    })
});

pub(super) fn kept() -> &'static Kept {
    &KEPT_IMAGES[field().number]
}

/// `b^{j 256^i}`, by which a power of `b` takes one product per byte of its exponent.
pub(super) struct Powers(Vec<[Modular; 256]>);

impl Powers {
    /// For exponents under `2^48`.
    fn new(base: Modular) -> Self {
        let mut base = base;
        let table = |_| {
            let mut table = [Modular::one(); 256];
            (1..256).for_each(|j| table[j] = table[j - 1] * base);
            base = table[255] * base;
            table
        };
        Powers((0..6).map(table).collect())
    }

    pub(super) fn power(&self, exponent: u64) -> Modular {
        let bytes = exponent.to_le_bytes();
        let factors = self.0.iter().zip(bytes).filter(|(_, byte)| *byte != 0);
        factors.fold(Modular::one(), |product, (table, byte)| product * table[usize::from(byte)])
    }
}
