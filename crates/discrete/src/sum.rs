//! Sums of many small terms.

/// A vector summed with what each addition loses (T. J. Dekker, D. E. Knuth: the error of a sum is a number).
#[derive(Clone, Debug)]
pub struct Compensated {
    /// The sums.
    pub value: Vec<f64>,
    rest: Vec<f64>,
}

impl Compensated {
    /// With nothing lost so far.
    pub fn new(value: Vec<f64>) -> Self {
        Compensated { rest: vec![0.0; value.len()], value }
    }

    #[inline]
    pub(crate) fn add(&mut self, i: usize, change: f64) {
        let (old, change) = (self.value[i], change + self.rest[i]);
        let new = old + change;
        let taken = new - old;
        self.rest[i] = (old - (new - taken)) + (change - taken);
        self.value[i] = new;
    }
}
