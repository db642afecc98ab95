//! A tool as a process: asked a line at a time, with a limit on how long it may think.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use serde_json::Value;

/// Why there is no answer. All of these are results.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The limit passed; the process was ended.
    #[error("over the limit of {seconds} s")]
    OverLimit {
        /// The limit.
        seconds: u64,
    },
    /// The tool says why.
    #[error("{words}")]
    Failed {
        /// Its words.
        words: String,
    },
    /// The process ended, or said what nobody understands.
    #[error("the process {words}")]
    Broken {
        /// What happened.
        words: String,
    },
}

/// A process that answers. It is ended when this is dropped.
pub struct Worker {
    child: Child,
    questions: ChildStdin,
    answers: Receiver<String>,
}

impl Worker {
    /// Starts `command`.
    ///
    /// # Errors
    /// [`Refusal::Broken`] where it cannot be started.
    pub fn start(command: &mut Command) -> Result<Worker, Refusal> {
        let broken = |error: std::io::Error| Refusal::Broken { words: format!("cannot be started: {}", error.kind()) };
        let mut child =
            command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().map_err(broken)?;
        let (Some(questions), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(Refusal::Broken { words: "has no pipes".into() });
        };
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Worker { child, questions, answers })
    }

    /// One question and its answer.
    ///
    /// # Errors
    /// [`Refusal`]. After [`Refusal::OverLimit`] and [`Refusal::Broken`] there is no process any more.
    pub fn ask(&mut self, question: &Value, limit: Duration) -> Result<Value, Refusal> {
        if writeln!(self.questions, "{question}").and_then(|()| self.questions.flush()).is_err() {
            return Err(Refusal::Broken { words: "hears nothing any more".into() });
        }
        let line = self.answers.recv_timeout(limit).map_err(|error| match error {
            RecvTimeoutError::Timeout => {
                self.end();
                Refusal::OverLimit { seconds: limit.as_secs() }
            }
            RecvTimeoutError::Disconnected => {
                let status = self.child.wait().map_or_else(|e| e.to_string(), |status| status.to_string());
                Refusal::Broken { words: format!("ended with {status}") }
            }
        })?;
        let answer: Value = serde_json::from_str(&line)
            .map_err(|error| Refusal::Broken { words: format!("answered what is no JSON: {error}") })?;
        match answer.get("failure").and_then(Value::as_str) {
            Some(words) => Err(Refusal::Failed { words: words.into() }),
            None => Ok(answer),
        }
    }

    fn end(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.end();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_comes_back_and_a_silent_process_is_ended() {
        let mut echo = Worker::start(&mut Command::new("cat")).unwrap();
        let question = serde_json::json!({ "do": "version" });
        assert_eq!(echo.ask(&question, Duration::from_secs(5)), Ok(question));
        let failure = echo.ask(&serde_json::json!({ "failure": "no" }), Duration::from_secs(5));
        assert_eq!(failure, Err(Refusal::Failed { words: "no".into() }));
        let mut silent = Worker::start(Command::new("sleep").arg("60")).unwrap();
        let question = serde_json::json!({});
        let limit = Duration::from_millis(50);
        assert_eq!(silent.ask(&question, limit), Err(Refusal::OverLimit { seconds: 0 }));
        assert!(matches!(silent.ask(&question, limit), Err(Refusal::Broken { .. })));
    }
}
