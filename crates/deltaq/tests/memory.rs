//! What long runs take of memory.

use std::fs::read_to_string;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

use crate::support::{command, text};

/// The largest memory in MB that the program is seen to take, and what it prints.
fn measured(arguments: &[&str]) -> (f64, String) {
    let mut running = command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("runs");
    let status = format!("/proc/{}/status", running.id());
    let mut most = 0.0_f64;
    while running.try_wait().expect("runs").is_none() {
        let lines = read_to_string(&status).unwrap_or_default();
        let kilobytes = lines.lines().find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next());
        most = most.max(kilobytes.and_then(|text| text.parse().ok()).unwrap_or(0.0) / 1024.0);
        sleep(Duration::from_millis(2));
    }
    let output = running.wait_with_output().expect("runs");
    (most, text(&output.stdout))
}

#[cfg(target_os = "linux")]
#[test]
fn two_hundred_thousand_seconds_with_two_times_take_under_25_megabytes() {
    // the program alone has 15 MB: what would keep 50 bytes a second is seen
    let solve = ["solve", "sledge", "-f", "chetaev", "--quiet", "--times", "0,2e5", "--set", "duration=2e5"];
    let (most, printed) = measured(&solve);
    println!("200,000 seconds: {most:.1} MB");
    assert!(most > 1.0 && most < 25.0, "{most} MB");
    // phi = 0.3 + t
    let turned: f64 = printed.lines().last().and_then(|line| line.split(',').nth(3)?.parse().ok()).expect("a row");
    assert!((turned - 200_000.3).abs() < 1e-5 || (turned - 220_000.3).abs() < 1e-5, "{turned}");
}

/// What asks for more than memory holds is told its limit; the largest that is answered fits into 2 GB.
/// Memory goes with rows and members, so a third of these fits into a third of it; `ROWS=1000000` takes all.
#[cfg(target_os = "linux")]
#[test]
fn a_million_rows_are_answered_or_refused_in_two_gigabytes() {
    let rows: usize = std::env::var("ROWS").map_or(320_000, |rows| rows.parse().expect("a number"));
    let (kilobytes, members) = (2 * rows, rows / 400);
    let folder = tempfile::tempdir().expect("a folder");
    let motion = folder.path().join("motion.csv");
    let program = env!("CARGO_BIN_EXE_deltaq");
    let limited_to = |kilobytes: usize, call: &str| {
        let call = format!("ulimit -v {kilobytes}; exec '{program}' {call}");
        let output = std::process::Command::new("sh").args(["-c", &call]).current_dir(&folder).output();
        let output = output.expect("a shell");
        (output.status.code(), output.stdout.len(), text(&output.stderr))
    };
    let limited = |call: &str| limited_to(kilobytes, call);
    let solve = format!("solve sledge -f chetaev --times 0:1:{rows} --format");
    for format in ["csv", "json"] {
        let (code, written, stderr) = limited_to(150_000, &format!("{solve} {format}"));
        assert!((code, written) == (Some(5), 0) && stderr.contains("memory allocation of"), "{code:?}: {stderr}");
    }
    let (code, written, stderr) = limited(&format!("{solve} csv > motion.csv"));
    assert_eq!((code, written), (Some(0), 0), "{stderr}");
    assert!(std::fs::metadata(&motion).expect("a table").len() > 200 * rows as u64);
    let (code, written, stderr) = limited(&format!("{solve} json"));
    assert!(code == Some(0) && written > 300 * rows, "{code:?}, {written}: {stderr}");
    let (code, _, stderr) = limited("judge sledge motion.csv");
    assert!(
        code == Some(2) && stderr.contains(&format!("there are {rows} samples, and of this scene at most")),
        "{stderr}"
    );
    let (code, _, stderr) = limited("fit sledge motion.csv --free x,y --sigma 1e-3");
    let said = format!("the films have {} numbers; deltaq fits at most 300000", 6 * rows);
    assert!(code == Some(2) && stderr.contains(&said), "{stderr}");
    let ensemble = "ensemble sledge -f chetaev --quiet --set duration=0.01 --times 0:0.01:1000 --vary g=1:2:";
    let (code, written, stderr) = limited(&format!("{ensemble}{members} > members.csv"));
    assert_eq!((code, written), (Some(0), 0), "{stderr}");
    let (code, _, stderr) = limited("solve disc -f chetaev --times 0:1:1000000");
    assert!(code == Some(2) && stderr.contains("columns at most "), "{stderr}");
}
