//! Numbers without a pattern.

/// Pseudorandom numbers, the same in every run: Weyl's sequence.
#[derive(Default)]
pub(crate) struct Weyl(f64);

impl Weyl {
    /// Within −1 … 1.
    pub(crate) fn number(&mut self) -> f64 {
        self.0 = (self.0 + 0.618_033_988_749_894_9).fract();
        2.0 * (1e4 * (1.0 + self.0).ln()).fract() - 1.0
    }
}
