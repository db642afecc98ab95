//! What is known from the literature, and what the program says: `LITERATURE=all` for all of it.

use std::collections::BTreeSet;

use integrals::Measure;
use validation::integrals::literature;

/// Entries whose answer takes a second or less.
const QUICK: [&str; 12] = [
    "sleigh",
    "suslov",
    "suslov-principal",
    "veselova",
    "suslov-kharlamova",
    "suslov-klebsh-tisserand",
    "heisenberg-skew",
    "roller-racer",
    "turntable",
    "ball-with-gyrostat",
    "two-wheeled-carriage-balanced",
    "ellipsoid-three-axes",
];

#[test]
fn nothing_contradicts_the_literature() {
    let all = std::env::var("LITERATURE").is_ok_and(|word| word == "all");
    let entries = literature().unwrap_or_else(|e| panic!("{e:#}"));
    let names: BTreeSet<&str> = entries.iter().map(|entry| &entry.name[..]).collect();
    assert!(names.len() == entries.len() && QUICK.iter().all(|name| names.contains(name)));
    let (mut agree, mut open) = (0, 0);
    for entry in entries.iter().filter(|entry| all || QUICK.contains(&&entry.name[..])) {
        let (found, agrees) = entry.compared().unwrap_or_else(|e| panic!("{}: {e:#}", entry.name));
        println!("{}: {:?} {agrees:?}", entry.name, found.measure);
        assert_ne!(agrees, Some(false), "{}: {found:?}", entry.name);
        // what the table calls open is open, and nothing else
        assert_eq!(agrees.is_none(), entry.measure == "open", "{}: {found:?}", entry.name);
        assert_eq!(matches!(found.measure, Measure::Open(_)), agrees.is_none());
        agree += usize::from(agrees == Some(true));
        open += usize::from(agrees.is_none());
    }
    println!("{agree} agree, {open} open");
    assert!(agree > 8 && open > 1);
}
