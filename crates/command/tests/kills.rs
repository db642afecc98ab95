//! What was killed at any time goes on to what a run in one piece gives: tables of points and members, logs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::support::{answer, command};

/// Times a call is killed.
const KILLS: u32 = 14;

/// Runs a call in one piece and tells how long that takes; then kills it again and again (SIGKILL), each time
/// later than before or at once, and lets it come to its end.
fn killed(arguments: &[&str], out: &Path, check: impl Fn(&[u8], &[u8])) {
    let clock = Instant::now();
    answer(arguments, 0);
    let whole_run = clock.elapsed();
    let whole = fs::read(out).expect("the file");
    let mut broken_off = 0;
    for kill in 0..KILLS {
        if kill % 3 == 0 {
            fs::remove_file(out).expect("there");
        }
        let mut child = command(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it runs");
        // 7 and 14 have no factor in common with most parts of the work
        sleep(whole_run * (kill * 5 % KILLS) / KILLS + Duration::from_millis(u64::from(kill % 7)));
        child.kill().expect("a signal");
        broken_off += u32::from(!child.wait().expect("an end").success());
        if kill % 3 == 2 {
            answer(arguments, 0);
            check(&fs::read(out).expect("the file"), &whole);
        }
    }
    assert!(broken_off > KILLS / 3, "{broken_off} of {KILLS} were killed before their end");
    answer(arguments, 0);
    check(&fs::read(out).expect("the file"), &whole);
}

fn same(now: &[u8], whole: &[u8]) {
    assert_eq!(String::from_utf8_lossy(now), String::from_utf8_lossy(whole));
}

#[test]
fn a_sweep_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let call = ["compare", "turntable", "--sweep", "psi'=0.3:0.9:40", "--quiet", "--threads", "2", "--out", out];
    killed(&call, &folder.path().join("turntable-sweep.csv"), same);
}

#[test]
fn an_ensemble_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("members.csv");
    let call = ["ensemble", "sledge", "-f", "vakonomic", "--vary", "mu1=-0.3..0.3:60", "--vary", "k=0.5..1:100"];
    let out = ["--times", "0:1:3", "--set", "duration=1", "--quiet", "--threads", "2", "--out"];
    killed(&[&call[..], &out, &[file.to_str().expect("UTF-8")]].concat(), &file, same);
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
    killed(&call, &file, |now, whole| assert_eq!(indices(now), indices(whole)));
}
