//! A program that is killed at any time, and called again.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Instant;

use crate::support::{answer, command};

/// Calls of each kind that are killed before their end. `KILLS=100 cargo test --release --package deltaq
/// kills:: -- --nocapture` kills more of them, and prints how many.
fn kills() -> u32 {
    std::env::var("KILLS").map_or(6, |text| text.parse().expect("KILLS is a number"))
}

/// Runs a call in one piece and measures how long that takes; then kills it (SIGKILL) again and again at
/// times spread over that, and lets every third come to its end. A file that is there is the whole one.
pub fn killed(what: &str, arguments: &[&str], out: &Path, check: impl Fn(&[u8], &[u8]), is_whole: bool) {
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
