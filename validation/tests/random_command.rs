//! `evidence random`, run as a user runs it.

use std::collections::BTreeSet;
use std::fs;

use motion::Settings;
use random::Count;
use serde_json::Value;
use validation::report::{random_complaint, theorem_word};

use crate::killed::killed;
use crate::support::{answer, refused};

#[track_caller]
fn random(arguments: &[&str], code: i32) -> (String, String) {
    answer(&[&["random"], arguments].concat(), code)
}

#[track_caller]
fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&random(&[arguments, &["--format", "json"]].concat(), 0).0).expect("JSON")
}

#[test]
fn verdicts_are_counted_by_theorem() {
    let value = json(&["--count", "20", "--seed", "5"]);
    assert_eq!(value["summary"]["systems"], 20);
    assert_eq!(value["summary"]["kinds"]["near-rank-loss"], 2);
    for theorem in ["0", "1", "2", "3", "4", "10", "11", "12"] {
        let count = &value["summary"]["theorems"][theorem];
        assert!(count["holds"].as_u64() >= Some(6), "T{theorem}: {count}");
        assert_eq!(count["fails"], 0, "T{theorem}: {count}");
    }
    let (shown, _) = random(&["--count", "2"], 0);
    assert!(shown.contains("T11") && shown.contains("per second"), "{shown}");
}

#[test]
fn a_run_that_was_cut_off_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("log.jsonl");
    let path = log.display().to_string();
    let whole = json(&["--count", "8", "--seed", "2", "--log", &path]);
    let lines = fs::read_to_string(&log).expect("a log");
    assert_eq!(lines.lines().count(), 9, "a header and one line per system");
    // cut off in the middle of a line
    let cut = lines.match_indices('\n').nth(4).expect("lines").0 + 40;
    fs::write(&log, &lines[..cut]).expect("written");
    let again = json(&["--count", "8", "--seed", "2", "--log", &path]);
    assert_eq!(whole["summary"], again["summary"]);
    assert_eq!(fs::read_to_string(&log).expect("a log").lines().count(), 9);
    // nothing is left to do
    assert_eq!(json(&["--count", "8", "--seed", "2", "--log", &path])["summary"], whole["summary"]);
}

#[test]
fn parts_of_a_batch_are_merged_to_what_the_whole_gives() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let part = |from: &str, count: &str, name: &str| {
        random(&["--from", from, "--count", count, "--seed", "2", "--log", &path(name)], 0);
    };
    part("0", "6", "a");
    // the parts overlap
    part("4", "6", "b");
    let merged = json(&["--merge", &path("a"), &path("b")]);
    let whole = json(&["--count", "10", "--seed", "2"]);
    assert_eq!(merged["summary"], whole["summary"]);
    assert_eq!(merged["batch"], whole["batch"]);
    random(&["--count", "1", "--seed", "3", "--log", &path("c")], 0);
    refused(&["random", "--merge", &path("a"), &path("c")], &["is of seed 3"]);
    refused(&["random", "--merge", &path("none")], &["none"]);
    // another run writes
    let file = fs::File::open(path("a")).expect("a log");
    file.lock().expect("locked");
    refused(&["random", "--count", "1", "--seed", "2", "--log", &path("a")], &["is being written by another run"]);
}

#[test]
fn a_log_of_something_else_is_refused_and_left_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("log.jsonl");
    let path = log.display().to_string();
    for (content, words) in [
        ("dear diary\n", "not a log of random systems"),
        ("dear diary", "not a log of random systems"),
        ("{\"seed\":7,\"kinds\":[\"free\"]}\n", "is of seed 7"),
    ] {
        fs::write(&log, content).expect("written");
        refused(&["random", "--count", "3", "--log", &path], &[words]);
        assert_eq!(fs::read_to_string(&log).expect("a log"), content);
    }
}

#[test]
fn one_system_is_shown_and_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().display().to_string();
    let (shown, _) = random(&["--seed", "3", "--index", "15", "--out", &path], 0);
    assert!(shown.contains("random-3-15: Random system, linear") && shown.contains("T12"), "{shown}");
    let scene = folder.path().join("random-3-15.toml");
    let scene = scene::catalogue::find(&scene.display().to_string(), &[]).expect("a scene");
    let choices = motion::choices(&scene);
    let compared = comparison::compare_unfitted(scene, choices, Vec::new(), &Settings::protocol()).expect("compared");
    assert!(!compared.pairs.is_empty());
    // the same as in a bulk run
    let one = json(&["--seed", "3", "--index", "15"]);
    let bulk = json(&["--seed", "3", "--from", "14", "--count", "2"]);
    assert_eq!(one["record"]["kind"], "linear");
    assert!(bulk["open"].as_array().expect("a list").iter().all(|r| r["index"] != 15));
    assert!(one["record"]["open"].as_array().expect("a list").is_empty());
}

#[test]
fn a_log_that_is_killed_goes_on_with_every_system_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("log");
    let log = file.to_str().expect("UTF-8");
    let indices = |log: &[u8]| -> (String, BTreeSet<u64>) {
        let mut lines = std::str::from_utf8(log).expect("UTF-8").lines();
        let head = lines.next().expect("a header").to_owned();
        let index = |line| serde_json::from_str::<serde_json::Value>(line).expect("JSON")["index"].as_u64();
        let all: Vec<u64> = lines.map(|line| index(line).expect("an index")).collect();
        let once: BTreeSet<u64> = all.iter().copied().collect();
        assert_eq!(once.len(), all.len(), "a system twice");
        (head, once)
    };
    let call = ["random", "--count", "12", "--kind", "free", "--quiet", "--threads", "2", "--log", log];
    // what is killed leaves a log that is not whole, and goes on
    killed("random log", &call, &file, |now, whole| assert_eq!(indices(now), indices(whole)), false);
}

#[test]
fn one_in_fifty_verdicts_may_be_undecided_and_none_may_fail() {
    for ([holds, fails, undecided], expected) in [
        ([98, 0, 2], "holds"),
        ([97, 0, 3], "undecided"),
        ([99, 1, 0], "fails"),
        ([0, 1, 99], "fails"),
        ([0, 0, 0], "holds"),
    ] {
        assert_eq!(theorem_word(Count { holds, fails, undecided }), expected, "{holds}, {fails}, {undecided}");
    }
}

#[test]
fn a_claim_that_fails_is_a_complaint_and_one_that_is_undecided_is_none() {
    let count = |holds, fails, undecided| random_complaint(Count { holds, fails, undecided });
    assert_eq!(count(3, 0, 2), None);
    assert_eq!(count(3, 1, 2), Some("1 of 6 verdicts on theorems: a claim fails".into()));
}
