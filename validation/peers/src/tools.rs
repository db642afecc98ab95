//! The tools as processes that are there when they are needed.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, Result};
use serde_json::{Value, json};
use validation::python_environment;

use crate::{Case, Refusal, Worker};

/// What the environment holds.
const REQUIREMENTS: &str = include_str!("../requirements.txt");

/// Every peer.
const PEERS: [&str; 4] = ["heyoka", "scipy", "casadi", "sympy"];

/// Whether a process of its own is started, or which one goes on.
pub struct Tools {
    python: PathBuf,
    /// Home of the peers: empty, so that no compiled code of an earlier run is found there.
    home: tempfile::TempDir,
    running: HashMap<String, Worker>,
}

impl Tools {
    /// Makes the environment where there is none yet. The current folder has to be the root of the project, where the scripts are.
    ///
    /// # Errors
    /// Where there is no Python or no package index.
    pub fn new() -> Result<Tools> {
        let python = python_environment::interpreter("peers", REQUIREMENTS)?;
        let home = tempfile::tempdir().context("a home for the peers")?;
        Ok(Tools { python, home, running: HashMap::new() })
    }

    fn command(&self, tool: &str) -> Result<Command, Refusal> {
        if tool == "ours" {
            let own = std::env::current_exe()
                .map_err(|error| Refusal::Broken { words: format!("has no place: {}", error.kind()) })?;
            let mut command = Command::new(own);
            command.arg("--serve");
            return Ok(command);
        }
        let mut command = Command::new(&self.python);
        command.arg(Path::new("validation").join("peers").join("worker.py")).arg(tool);
        command.env("PYTHONPATH", Path::new("validation").join("casadi")).env("PYTHONDONTWRITEBYTECODE", "1");
        command.env("HOME", self.home.path());
        for threads in ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"] {
            command.env(threads, "1");
        }
        Ok(command)
    }

    /// Asks the process `name` of `tool`; starts it where there is none. A process that has been set up is forgotten when it ends.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn ask(&mut self, tool: &str, name: &str, question: &Value, limit: Duration) -> Result<Value, Refusal> {
        if !self.running.contains_key(name) {
            let mut worker = Worker::start(&mut self.command(tool)?)?;
            // libraries are loaded here, not in the first time that is taken
            worker.ask(&json!({ "do": "version" }), Duration::from_secs(120))?;
            self.running.insert(name.into(), worker);
        }
        let Some(worker) = self.running.get_mut(name) else {
            return Err(Refusal::Broken { words: "is not there".into() });
        };
        let answer = worker.ask(question, limit);
        if matches!(answer, Err(Refusal::OverLimit { .. } | Refusal::Broken { .. })) {
            self.running.remove(name);
        }
        answer
    }

    /// Whether the process `name` still runs.
    pub fn is_running(&self, name: &str) -> bool {
        self.running.contains_key(name)
    }

    /// Ends the processes.
    pub fn end_all(&mut self) {
        self.running.clear();
    }

    /// `package version` of everything that the peers are made of.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn versions(&mut self) -> Result<Vec<String>, Refusal> {
        let mut versions = Vec::new();
        for tool in PEERS {
            let answer = self.ask(tool, tool, &json!({ "do": "version" }), Duration::from_secs(120))?;
            let packages = answer["versions"].as_object().into_iter().flatten();
            versions.extend(packages.map(|(name, version)| format!("{name} {}", version.as_str().unwrap_or("?"))));
        }
        self.end_all();
        versions.sort();
        versions.dedup();
        Ok(versions)
    }

    /// The question that sets a process up.
    pub fn set_up(case: &Case) -> Value {
        json!({ "do": "setup", "case": case })
    }
}
