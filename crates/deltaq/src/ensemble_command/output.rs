//! What became of the members, for machines.

use anyhow::{Context, Result};
use equations::{Equations, Outputs};
use indexmap::IndexMap;
use motion::{Choice, ErrorEstimate, MemberMotion};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;
use symbolic::limits::SHOWN;

use super::members::Members;
use crate::cli::Format;
use crate::columns::{Columns, Numbers, Table, header, named, print, quoted, row};
use program::typed;

/// Wall-clock seconds spent.
#[derive(Default, Serialize, JsonSchema)]
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

    fn estimate(&self) -> Option<&ErrorEstimate> {
        self.motion.as_ref()?.estimate.as_ref()
    }

    fn error_estimate(&self) -> Option<f64> {
        self.estimate().map(|estimate| estimate.absolute)
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
        Ok(self.around(&Seconds::default())?[0].clone())
    }

    /// What stands before the members and behind them; they are written one by one.
    fn around(&self, seconds: &Seconds) -> Result<[String; 2]> {
        const BETWEEN: &str = "\"members\": [";
        let whole = typed(&Ensemble {
            scene: &self.scene.name,
            formulation: self.choice.formulation.name,
            removal: self.choice.removal.as_ref().map(|removal| &removal.name[..]),
            members: Vec::new(),
            count: STATUSES.into_iter().zip(self.statuses).collect(),
            seconds,
        })?;
        let (head, end) = whole.split_once(BETWEEN).context("an ensemble without members")?;
        Ok([format!("{head}{BETWEEN}"), format!("\n  {end}")])
    }

    /// The next member.
    pub(super) fn add(&mut self, outcome: &Outcome) -> Result<String> {
        let text = match self.format {
            Format::Csv => self.rows(self.done, outcome),
            Format::Json => {
                let comma = if self.done == 0 { "" } else { "," };
                let member = serde_json::to_string_pretty(&self.object(outcome))?;
                format!("{comma}\n{member}").replace('\n', "\n    ")
            }
        };
        self.count(outcome.status, outcome.cause.as_deref());
        Ok(text)
    }

    /// Counts the next member.
    pub(super) fn count(&mut self, status: &str, cause: Option<&str>) {
        for (count, known) in self.statuses.iter_mut().zip(STATUSES) {
            *count += usize::from(status == known);
        }
        if let Some(cause) = cause.filter(|_| self.described.len() < SHOWN) {
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

    fn object<'b>(&'b self, outcome: &'b Outcome) -> Member<'b> {
        let rows = outcome.outputs();
        let run = outcome.motion.as_ref().map(|motion| &motion.run);
        Member {
            set: named(&self.members.names, &self.members.row(self.done)),
            status: outcome.status,
            cause: outcome.cause.as_deref(),
            times: &self.times[..rows.len()],
            error_estimate: outcome.error_estimate(),
            error_estimates: outcome.estimate().map(|estimate| self.columns.whole_errors(estimate)),
            steps: run.map(|run| run.work.steps),
            alone: run.and_then(|run| run.alone.as_deref()),
            columns: self.columns.table(rows),
        }
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
    pub(super) fn end(&self, seconds: &Seconds) -> Result<String> {
        if self.format == Format::Csv { Ok(String::new()) } else { Ok(self.around(seconds)?[1].clone()) }
    }
}

/// Many motions: `deltaq ensemble --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "ensemble/1")]
pub(crate) struct Ensemble<'a> {
    scene: &'a str,
    formulation: &'a str,
    /// Name of the removal, of removed-constraint equations.
    removal: Option<&'a str>,
    members: Vec<Member<'a>>,
    /// Members by status.
    count: IndexMap<&'static str, usize>,
    /// Seconds of the clock.
    seconds: &'a Seconds,
}

#[derive(Serialize, JsonSchema)]
struct Member<'a> {
    /// What this member differs by.
    set: Numbers,
    #[schemars(extend("enum" = STATUSES))]
    status: &'static str,
    cause: Option<&'a str>,
    /// Times, s; ascending as asked for.
    times: &'a [f64],
    /// Of the coordinates, in the kinetic metric; null where there is no motion.
    error_estimate: Option<f64>,
    /// Of each coordinate, velocity and multiplier, in its unit; null where there is no motion.
    error_estimates: Option<Table<f64>>,
    steps: Option<usize>,
    /// Why it was integrated alone, if it was.
    alone: Option<&'a str>,
    #[serde(flatten)]
    columns: Table<Vec<f64>>,
}
