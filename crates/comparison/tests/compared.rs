//! Comparisons of scenes given as text.

use comparison::{Comparison, compare_unfitted};
use motion::{Settings, choices};

use crate::support::read;

/// In all formulations, without fits.
pub(crate) fn compared(name: &str, text: &str) -> Comparison {
    let scene = read(name, text);
    let choices = choices(&scene);
    compare_unfitted(scene, choices, Vec::new(), &Settings::default()).expect("a comparison")
}
