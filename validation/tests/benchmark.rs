//! The reference motions for other programs are those that this code computes.

use std::fs;
use std::path::Path;

use scene::catalogue::find;
use validation::benchmark::{FORMULATIONS, STARTS, SYSTEMS, csv, motions};

#[test]
fn motions_are_what_is_written_down() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benchmark");
    for (i, name) in SYSTEMS.iter().enumerate() {
        let rows = motions(name, [1 + i % STARTS]).unwrap();
        assert!(rows.len() >= 2 * FORMULATIONS.len() && rows.iter().all(|row| row.error < 1e-18), "{name}");
        let written = fs::read_to_string(folder.join(format!("{name}.csv"))).unwrap();
        let computed = csv(&find(name, &[]).unwrap(), &rows);
        let numbers = |line: &str| line.rsplit_once(',').unwrap().0.to_string(); // doubts are of this run
        let written: Vec<String> = written.lines().map(numbers).collect();
        for line in computed.lines().map(numbers) {
            assert!(written.contains(&line), "{name}: not written down: {line}");
        }
    }
}
