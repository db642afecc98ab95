//! Many systems: which are put to the thorough checks, and which are shrunk.

use std::collections::BTreeMap;

use random::{Batch, Kind, Open, Word, first_failures};

#[test]
fn of_each_theorem_the_first_failure_is_shrunk() {
    let batch = Batch { seed: 1, kinds: vec![Kind::Linear] };
    let mut records = [4, 5, 6].map(|index| batch.record(index));
    assert!(first_failures(&records).is_empty());
    for (record, theorems) in records.iter_mut().zip([&[7][..], &[3, 7], &[3]]) {
        let open =
            |&theorem| Open { theorem, claim: String::new(), word: Word::Fails, figure: None, note: String::new() };
        record.open = theorems.iter().map(open).collect();
    }
    assert_eq!(first_failures(&records), BTreeMap::from([(3, 5), (7, 4)]));
}

/// Two kinds take turns, so both of the first pair are thorough, and then both of the eleventh.
#[test]
fn a_tenth_of_each_kind_is_thorough() {
    let batch = Batch { seed: 1, kinds: vec![Kind::Free, Kind::Linear] };
    let thorough: Vec<u64> = (0..60).filter(|&index| batch.is_thorough(index)).collect();
    assert_eq!(thorough, [0, 1, 20, 21, 40, 41]);
    assert_eq!([0, 1, 2].map(|i| batch.thorough(i)), [0, 20, 40]);
}

/// Two growth vectors that round-off hid, a decision on the first moments only, errors of a way back that
/// add up.
#[test]
fn systems_that_failed_once_fail_no_more() {
    let batch = Batch { seed: 72, kinds: Kind::ALL.to_vec() };
    for index in [916, 5126, 1739, 5916] {
        let failed: Vec<u8> = batch.record(index).failures().into_iter().collect();
        assert!(failed.is_empty(), "{index}: {failed:?}");
    }
}
