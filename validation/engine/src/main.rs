//! Writes `engine.md` and its pictures into the folder given, or into `reports`.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Result, bail};
use engine::{Ladder, Study, files};
use program::write_all;
use scene::catalogue::find;

fn main() -> Result<()> {
    let folder = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "reports".into()));
    let clock = Instant::now();
    // the ball in the cone spins fast: it needs 16 times the steps before its errors fall with dt
    let studies = [
        Study::of_incline(Ladder { coarsest: 500, runs: 9 })?,
        Study::of_scene(&find("turntable", &[])?, Ladder { coarsest: 1000, runs: 9 })?,
        Study::of_scene(&find("ball-in-cone", &[])?, Ladder { coarsest: 16_000, runs: 8 })?,
    ];
    write_all(&folder, &files(&studies)?)?;
    for study in &studies {
        let finding = study.finding();
        println!(
            "{:<13} order {:.2}, to Chetaev {:.1e}, extrapolated {:.1e}",
            study.name, finding.order, finding.nearest, finding.extrapolated
        );
    }
    println!("engine.md in {} after {:.1} s", folder.display(), clock.elapsed().as_secs_f64());
    if let Some(study) = studies.iter().find(|study| !study.finding().holds()) {
        bail!(
            "{}: it was not shown that the engine tends to Chetaev's motion; the page says what was found",
            study.name
        );
    }
    Ok(())
}
