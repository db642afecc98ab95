//! Instants at which members of an ensemble are looked at.

use mechanics::{ConstantsRule, State};
use motion::parts::{WATCHED, instants};
use motion::{Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, Settings, choices};

use crate::ends::built_in;

/// A member from one time to another.
fn member(t: f64, end: f64) -> EnsembleMember {
    let scene = built_in("sledge");
    let mut ensemble = Ensemble::new(&scene, &choices(&scene)[0], &[], &Settings::default()).unwrap();
    let start = EnsembleStart::of(&scene, &[], ConstantsRule::Zero);
    let state = State { t, ..start.state };
    ensemble.member_at(&EnsembleStart { state, end, ..start }).unwrap()
}

/// From the last start to the first end: from 0.5 to 2, or back.
#[test]
fn constraints_are_looked_at_between_the_times_asked_for() {
    let options = EnsembleOptions::default();
    for (members, times) in
        [([member(0.0, 2.0), member(0.5, 3.0)], [1.05, 1.6]), ([member(2.0, 0.0), member(3.0, 0.5)], [1.6, 1.05])]
    {
        let found = instants(&members, &times, &options);
        let asked: Vec<f64> = found.iter().filter(|(_, asked)| *asked).map(|(t, _)| *t).collect();
        assert_eq!(asked, times);
        let back = times[0] > times[1];
        for (i, (t, _)) in found.iter().filter(|(_, asked)| !asked).enumerate() {
            let part = (i + 1) as f64 / (WATCHED + 1) as f64;
            let known = if back { 2.0 - 1.5 * part } else { 0.5 + 1.5 * part };
            assert!((t - known).abs() < 1e-14, "{i}: {t} {known}");
        }
        assert_eq!(found.len(), WATCHED + 2);
        assert!(found.windows(2).all(|pair| (pair[0].0 < pair[1].0) != back), "{found:?}");
        assert_eq!(instants(&members, &times, &EnsembleOptions { estimate: false, ..options }).len(), 2);
    }
}
