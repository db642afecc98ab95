//! Sums of many small terms.

/// A vector summed with what each addition loses (T. J. Dekker, D. E. Knuth: the error of a sum is a number).
#[derive(Clone, Debug)]
pub(crate) struct Compensated {
    pub(crate) value: Vec<f64>,
    rest: Vec<f64>,
    /// For a test: what is lost stays lost.
    #[cfg(test)]
    pub(crate) plain: bool,
}

impl Compensated {
    pub(crate) fn new(value: Vec<f64>) -> Self {
        Compensated {
            rest: vec![0.0; value.len()],
            value,
            #[cfg(test)]
            plain: false,
        }
    }

    #[inline]
    pub(crate) fn add(&mut self, i: usize, change: f64) {
        #[cfg(test)]
        if self.plain {
            self.value[i] += change;
            return;
        }
        let (old, change) = (self.value[i], change + self.rest[i]);
        let new = old + change;
        let taken = new - old;
        self.rest[i] = (old - (new - taken)) + (change - taken);
        self.value[i] = new;
    }
}
