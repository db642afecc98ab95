//! What became of the members, for machines.

use anyhow::Result;
use equations::{Equations, Outputs};
use motion::{Choice, MemberMotion};
use scene::Scene;
use serde_json::{Map, Value, json};

use super::members::Members;
use crate::cli::Format;
use crate::columns::{Columns, header, print, quoted, row};
use program::pretty;

/// Members that a complaint describes.
const DESCRIBED: usize = 3;

/// Wall-clock seconds spent.
#[derive(Default)]
pub(super) struct Seconds {
    pub(super) derive: f64,
    pub(super) start: f64,
    pub(super) integrate: f64,
}

/// What became of a member: `completed`, `untrusted`, `stopped` or `refused`.
pub(super) struct Outcome {
    status: &'static str,
    cause: Option<String>,
    motion: Option<MemberMotion>,
}

impl Outcome {
    pub(super) fn of(motion: Result<MemberMotion, String>) -> Outcome {
        match motion {
            Err(cause) => Outcome { status: "refused", cause: Some(cause), motion: None },
            Ok(motion) => {
                let (status, cause) = motion.status();
                let advice = if status == "untrusted" { "; ask for a smaller --tolerance" } else { "" };
                let cause = cause.map(|words| words + advice);
                Outcome { status, cause, motion: Some(motion) }
            }
        }
    }

    fn outputs(&self) -> &[Outputs] {
        self.motion.as_ref().map_or(&[], |motion| &motion.outputs)
    }

    fn error_estimate(&self) -> Option<f64> {
        self.motion.as_ref()?.estimate.as_ref().map(|estimate| estimate.absolute)
    }
}

/// The output of the command in pieces: a head, one piece per member, an end.
pub(super) struct Answers<'a> {
    format: Format,
    scene: &'a Scene,
    choice: &'a Choice,
    columns: Columns,
    members: &'a Members,
    times: &'a [f64],
    /// Members so far.
    pub(super) done: usize,
    statuses: [usize; STATUSES.len()],
    described: Vec<String>,
}

const STATUSES: [&str; 4] = ["completed", "untrusted", "stopped", "refused"];

impl<'a> Answers<'a> {
    pub(super) fn new(
        format: Format,
        scene: &'a Scene,
        choice: &'a Choice,
        equations: &Equations,
        members: &'a Members,
        times: &'a [f64],
    ) -> Self {
        let columns = Columns::of(scene, equations);
        Answers {
            format,
            scene,
            choice,
            columns,
            members,
            times,
            done: 0,
            statuses: [0; STATUSES.len()],
            described: Vec::new(),
        }
    }

    /// Names of the columns of a table.
    pub(super) fn names(&self) -> Vec<String> {
        let set = self.members.names.iter().map(|name| format!("set {name}"));
        let end = ["error_estimate", "status", "cause"].map(String::from);
        std::iter::once("member".into()).chain(set).chain(self.columns.names()).chain(end).collect()
    }

    /// What stands before the members.
    pub(super) fn head(&self) -> Result<String> {
        if self.format == Format::Csv {
            return header(&self.names());
        }
        let value = json!({
            "scene": self.scene.name,
            "formulation": self.choice.formulation.name,
            "removal": self.choice.removal.as_ref().map(|r| &r.name),
        });
        Ok(pretty("ensemble", &value).trim_end_matches("\n}\n").to_string() + ",\n  \"members\": [")
    }

    /// The next member.
    pub(super) fn add(&mut self, outcome: &Outcome) -> String {
        let text = match self.format {
            Format::Csv => self.rows(self.done, outcome),
            Format::Json => {
                let comma = if self.done == 0 { "" } else { "," };
                format!("{comma}\n{:#}", self.object(outcome)).replace('\n', "\n    ")
            }
        };
        self.count(outcome.status, outcome.cause.as_deref());
        text
    }

    /// Counts the next member.
    pub(super) fn count(&mut self, status: &str, cause: Option<&str>) {
        for (count, known) in self.statuses.iter_mut().zip(STATUSES) {
            *count += usize::from(status == known);
        }
        if let Some(cause) = cause.filter(|_| self.described.len() < DESCRIBED) {
            let row = self.members.row(self.done);
            let names = self.members.names.iter().zip(row);
            let values: Vec<String> = names.map(|(name, value)| format!("{name} = {value}")).collect();
            self.described.push(format!("member {} ({}): {cause}", self.done + 1, values.join(", ")));
        }
        self.done += 1;
    }

    /// How the rows of a member begin, if there is one of this number.
    pub(super) fn begin(&self, member: usize) -> Option<String> {
        (member < self.members.count()).then(|| format!("{},{},", member + 1, print(&self.members.row(member))))
    }

    /// One row per time; one without numbers where nothing was reached.
    pub(super) fn rows(&self, member: usize, outcome: &Outcome) -> String {
        let begin = self.begin(member).unwrap_or_default();
        let cause = quoted(outcome.cause.as_deref().unwrap_or_default());
        let estimate = outcome.error_estimate().map_or(String::new(), |e| format!("{e:?}"));
        let end = format!("{estimate},{},{cause}\n", outcome.status);
        if outcome.outputs().is_empty() {
            return begin + &",".repeat(self.columns.names().len()) + &end;
        }
        self.times.iter().zip(outcome.outputs()).map(|(&t, now)| format!("{begin}{},{end}", row(t, now))).collect()
    }

    fn object(&self, outcome: &Outcome) -> Value {
        let rows = outcome.outputs();
        let values = self.members.names.iter().cloned().zip(self.members.row(self.done).into_iter().map(|x| json!(x)));
        let run = outcome.motion.as_ref().map(|motion| &motion.run);
        let mut value = json!({
            "set": values.collect::<Map<_, _>>(),
            "status": outcome.status,
            "cause": outcome.cause,
            "times": &self.times[..rows.len()],
            "error_estimate": outcome.error_estimate(),
            "steps": run.map(|run| run.work.steps),
            "alone": run.and_then(|run| run.alone.as_ref()),
        });
        self.columns.write(&mut value, rows);
        value
    }

    /// Which members are not to be trusted to the end.
    pub(super) fn complaint(&self) -> Option<String> {
        let failed = self.done - self.statuses[0];
        if failed == 0 {
            return None;
        }
        let mut text = format!("{failed} of {} members are not to be trusted to the end", self.done);
        for words in &self.described {
            text += &format!("\n  {words}");
        }
        if failed > self.described.len() {
            text += &format!("\n  and {} more, each with its cause in the answer", failed - self.described.len());
        }
        Some(text)
    }

    /// What stands behind the members.
    pub(super) fn end(&self, seconds: &Seconds) -> String {
        if self.format == Format::Csv {
            return String::new();
        }
        let counts: Map<String, Value> =
            STATUSES.iter().zip(self.statuses).map(|(name, count)| (name.to_string(), json!(count))).collect();
        let Seconds { start, derive, integrate } = seconds;
        let value = json!({
            "count": counts,
            "seconds": { "start": start, "derive": derive, "integrate": integrate },
        });
        format!("\n  ],{:#}\n", value).replacen("],{", "],", 1)
    }
}
