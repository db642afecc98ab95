//! The decision in floating point.

use decision::Verdict;

use crate::questions::{built_in, is_vakonomic};

fn near(found: f64, expected: f64, part: f64) -> bool {
    (found - expected).abs() <= part * expected.abs()
}

/// Scene, duration, ρ, ρ at μ₀ = 0.
const NONE: [(&str, f64, f64, f64); 8] = [
    ("sledge", 10.0, 43.5, 65.3),
    ("sleigh", 8.0, 1.38, 622.0),
    ("particle", 6.0, 1.66, 3.47),
    ("turntable", 10.0, 0.204, 1.62),
    ("ball-in-cone", 1.0, 16.4, f64::NAN),
    ("ball-in-cone-as-printed", 1.0, 23.9, f64::NAN),
    ("three-cylinders", 1.0, 2.5e-6, 2.7e-3),
    ("trailer", 3.0, 0.495, 48.6),
];

#[test]
fn motions_that_no_multipliers_give() {
    for (name, duration, least, at_zero) in NONE {
        let decision = is_vakonomic(&built_in(name, &[("duration", duration)]));
        println!("{name}: {:?} rho {:.4e} ({:.4e}) noise {:.1e} a {:.3e}  mu* {:?}", decision.verdict, decision.least, decision.at_zero, decision.noise, decision.acceleration, decision.set);
        assert_eq!(decision.verdict, Verdict::NotContained, "{name}");
        assert!(near(decision.least, least, 0.02), "{name}");
        assert!(at_zero.is_nan() || near(decision.at_zero, at_zero, 0.02), "{name}");
    }
}
