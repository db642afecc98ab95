//! The referee's scripts, and how they are run.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::python_environment::{self, NotRun, files};

const REQUIREMENTS: &str = include_str!("../../casadi/requirements.txt");

/// Name and text of the referee's files.
const SCRIPTS: [(&str, &str); 8] = [
    ("reader.py", include_str!("../../casadi/reader.py")),
    ("formulations.py", include_str!("../../casadi/formulations.py")),
    ("trajectories.py", include_str!("../../casadi/trajectories.py")),
    ("transcription.py", include_str!("../../casadi/transcription.py")),
    ("lagranges_method.py", include_str!("../../casadi/lagranges_method.py")),
    ("decision.py", include_str!("../../casadi/decision.py")),
    ("exceptional.py", include_str!("../../casadi/exceptional.py")),
    ("check.py", include_str!("../../casadi/check.py")),
];

/// The interpreter of the referee's environment.
pub(super) fn interpreter() -> Result<PathBuf, NotRun> {
    python_environment::interpreter(REQUIREMENTS)
}

/// Runs the scripts on a job; the text of their answer.
pub(super) fn answer(interpreter: &Path, job: &str) -> Result<String, NotRun> {
    let folder = tempfile::tempdir().map_err(files("the scripts"))?;
    for (name, text) in SCRIPTS {
        std::fs::write(folder.path().join(name), text).map_err(files("the scripts"))?;
    }
    let (question, answer) = (folder.path().join("job.json"), folder.path().join("answer.json"));
    std::fs::write(&question, job).map_err(files("the job"))?;
    let output = Command::new(interpreter)
        .arg(folder.path().join("check.py"))
        .args([&question, &answer])
        .envs([("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1"), ("PYTHONDONTWRITEBYTECODE", "1")])
        .output()
        .map_err(|_| NotRun::NoPython)?;
    if !output.status.success() {
        let complaint = String::from_utf8_lossy(&output.stderr).lines().last().unwrap_or_default().to_string();
        return Err(NotRun::NoAnswer(output.status.to_string(), complaint));
    }
    std::fs::read_to_string(&answer).map_err(files("the answer"))
}
