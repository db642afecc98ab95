//! What was killed at any time goes on to what a run in one piece gives: tables of points and members, logs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Instant;

use crate::support::{answer, command};

/// Calls of each kind that are killed before their end. `KILLS=100 cargo test --release --package deltaq-cli
/// kills:: -- --nocapture` kills more of them, and prints how many.
fn kills() -> u32 {
    std::env::var("KILLS").map_or(6, |text| text.parse().expect("KILLS is a number"))
}

/// Runs a call in one piece and measures how long that takes; then kills it (SIGKILL) again and again at
/// times spread over that, and lets every third come to its end. A file that is there is the whole one.
fn killed(what: &str, arguments: &[&str], out: &Path, check: impl Fn(&[u8], &[u8]), is_whole: bool) {
    let clock = Instant::now();
    answer(arguments, 0);
    let whole_run = clock.elapsed();
    let whole = fs::read(out).expect("the file");
    let (mut broken_off, mut ended) = (0, 0);
    for attempt in 0.. {
        if broken_off == kills() {
            println!(
                "{what}: {broken_off} of {attempt} calls killed before their end, 0 broken; {ended} went on to it"
            );
            break;
        }
        assert!(attempt < 10 * (kills() + 1), "{broken_off} of {attempt} calls were killed before their end");
        if attempt % 3 == 0 {
            fs::remove_file(out).expect("there");
        }
        let mut child = command(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it runs");
        // parts of the golden section are spread evenly, however many there are
        sleep(whole_run.mul_f64(0.95 * (f64::from(attempt) * 0.618_033_988_749_895).fract()));
        child.kill().expect("a signal");
        broken_off += u32::from(!child.wait().expect("an end").success());
        if is_whole && let Ok(there) = fs::read(out) {
            check(&there, &whole);
        }
        if attempt % 3 == 2 {
            answer(arguments, 0);
            check(&fs::read(out).expect("the file"), &whole);
            ended += 1;
        }
    }
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
    killed("sweep", &call, &folder.path().join("turntable-sweep.csv"), same, true);
}

#[test]
fn an_ensemble_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("members.csv");
    let call = ["ensemble", "sledge", "-f", "vakonomic", "--vary", "mu0_1=-0.3..0.3:60", "--vary", "k=0.5..1:100"];
    let out = ["--times", "0:1:3", "--set", "duration=1", "--quiet", "--threads", "2", "--out"];
    let call = [&call[..], &out, &[file.to_str().expect("UTF-8")]].concat();
    killed("ensemble", &call, &file, same, true);
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
