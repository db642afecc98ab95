//! The rounds of a race: what may be the fastest is timed again, everybody in turns.

use serde_json::json;

use crate::race::{Race, TARGETS};
use crate::{Rung, Task};

/// What is slower than the fastest by this factor at the first try is not timed again.
const NOISE: f64 = 1.4;

impl Race<'_> {
    /// Times once more whatever may be the fastest of its row for some target.
    pub(crate) fn turn(&mut self) {
        for i in self.candidates() {
            let rung = self.outcome.rungs[i].clone();
            let question = json!({
                "do": "run", "method": rung.method, "tolerance": rung.tolerance, "task": rung.task.name(), "repeat": self.effort.repeat
            });
            match self.ask(&rung.entrant, &question) {
                Ok(answer) => {
                    let seconds = answer["seconds"].as_f64().unwrap_or(f64::INFINITY);
                    let rung = &mut self.outcome.rungs[i];
                    rung.seconds = rung.seconds.min(seconds);
                    rung.total = rung.total.min(rung.setup + rung.prepare + rung.seconds);
                }
                Err(refusal) => {
                    let what = format!("{} at {:.0e}, again", rung.method, rung.tolerance);
                    self.fail(rung.row, what, refusal.to_string());
                }
            }
        }
    }

    fn candidates(&self) -> Vec<usize> {
        let rungs = &self.outcome.rungs;
        let fastest = |like: &Rung, target: f64| {
            let same = rungs.iter().filter(|r| r.row == like.row && r.task == like.task && r.error <= target);
            same.map(|r| r.seconds).fold(f64::INFINITY, f64::min)
        };
        let may = |rung: &Rung| {
            TARGETS.iter().any(|&target| rung.error <= target && rung.seconds <= NOISE * fastest(rung, target))
        };
        (0..rungs.len()).filter(|&i| may(&rungs[i])).collect()
    }

    /// Ours from the text of the scene, measured as a whole: whatever may be the fastest, and every method in every form, for one that takes longer to
    /// integrate may be derived sooner.
    pub(crate) fn totals(&mut self) {
        for i in self.to_be_totalled() {
            let rung = self.outcome.rungs[i].clone();
            let question = json!({ "do": "total", "method": rung.method, "tolerance": rung.tolerance });
            let seconds =
                (0..self.effort.rounds).filter_map(|_| self.ask(&rung.entrant, &question).ok()?["seconds"].as_f64());
            self.outcome.rungs[i].total = seconds.fold(f64::INFINITY, f64::min);
        }
    }

    fn to_be_totalled(&self) -> Vec<usize> {
        let rungs = &self.outcome.rungs;
        let mut chosen = self.candidates();
        // the derivation of a long train takes seconds
        if self.outcome.problem.trailers.is_none() {
            let precise = |i: &usize| {
                let Rung { entrant, task, error, .. } = &rungs[*i];
                entrant.tool == "ours" && *task == Task::Trajectory && *error <= TARGETS[2]
            };
            let mut fastest: Vec<usize> = (0..rungs.len()).filter(precise).collect();
            fastest.sort_by(|&a, &b| {
                rungs[a].method.cmp(&rungs[b].method).then(rungs[a].seconds.total_cmp(&rungs[b].seconds))
            });
            fastest.dedup_by(|b, a| rungs[*a].method == rungs[*b].method);
            chosen.extend(fastest);
        }
        chosen.retain(|&i| rungs[i].entrant.tool == "ours");
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }
}
