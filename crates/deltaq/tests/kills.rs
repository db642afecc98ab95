//! What was killed at any time goes on to what a run in one piece gives: tables of points and members.

use crate::killed::killed;

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
