//! What became of the members, for machines.

use deltaq::{Choice, MemberMotion};
use equations::{Equations, Outputs};
use scene::Scene;
use serde_json::{Map, Value, json};

use super::members::Members;
use crate::answer::pretty;
use crate::cli::Format;
use crate::columns::{Columns, print, row};

/// Members that a complaint describes.
const DESCRIBED: usize = 3;

/// Wall-clock seconds spent.
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

/// The answer of the command, written member by member.
pub(super) struct Answers<'a> {
    format: Format,
    scene: &'a Scene,
    choice: &'a Choice,
    columns: Columns,
    members: &'a Members,
    times: &'a [f64],
    text: String,
    values: Vec<Value>,
    done: usize,
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
        let set = members.names.iter().map(|name| format!("set {name}"));
        let end = ["error_estimate", "status", "cause"].map(String::from);
        let names: Vec<String> =
            std::iter::once("member".into()).chain(set).chain(columns.names()).chain(end).collect();
        Answers {
            format,
            scene,
            choice,
            columns,
            members,
            times,
            text: names.join(",") + "\n",
            values: Vec::new(),
            done: 0,
            statuses: [0; STATUSES.len()],
            described: Vec::new(),
        }
    }

    /// The next member.
    pub(super) fn add(&mut self, outcome: Outcome) {
        match self.format {
            Format::Csv => self.add_rows(&outcome),
            Format::Json => self.values.push(self.object(&outcome)),
        }
        for (count, status) in self.statuses.iter_mut().zip(STATUSES) {
            *count += usize::from(status == outcome.status);
        }
        if let Some(cause) = &outcome.cause
            && self.described.len() < DESCRIBED
        {
            let names = self.members.names.iter().zip(&self.members.rows[self.done]);
            let values: Vec<String> = names.map(|(name, value)| format!("{name} = {value}")).collect();
            self.described.push(format!("member {} ({}): {cause}", self.done + 1, values.join(", ")));
        }
        self.done += 1;
    }

    /// One row a time; one without numbers where nothing was reached.
    fn add_rows(&mut self, outcome: &Outcome) {
        let member = format!("{},{}", self.done + 1, print(&self.members.rows[self.done]));
        let cause = outcome.cause.as_ref().map_or(String::new(), |cause| format!("\"{}\"", cause.replace('"', "\"\"")));
        let estimate = outcome.error_estimate().map_or(String::new(), |e| format!("{e:?}"));
        let end = format!("{estimate},{},{}\n", outcome.status, cause.replace('\n', " "));
        for (&t, now) in self.times.iter().zip(outcome.outputs()) {
            self.text += &format!("{member},{},{end}", row(t, now));
        }
        if outcome.outputs().is_empty() {
            let empty = ",".repeat(self.columns.names().len() - 1);
            self.text += &format!("{member},{empty},{end}");
        }
    }

    fn object(&self, outcome: &Outcome) -> Value {
        let rows = outcome.outputs();
        let values = self.members.names.iter().cloned().zip(self.members.rows[self.done].iter().map(|&x| json!(x)));
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

    pub(super) fn finish(self, seconds: Seconds) -> String {
        if self.format == Format::Csv {
            return self.text;
        }
        let counts: Map<String, Value> =
            STATUSES.iter().zip(self.statuses).map(|(name, count)| (name.to_string(), json!(count))).collect();
        let value = json!({
            "scene": self.scene.name,
            "formulation": self.choice.formulation,
            "removal": self.choice.removal.as_ref().map(|r| &r.name),
            "count": counts,
            "members": self.values,
            "seconds": { "start": seconds.start, "derive": seconds.derive, "integrate": seconds.integrate },
        });
        pretty("ensemble", &value)
    }
}
