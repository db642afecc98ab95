//! What an earlier call has left of a table of members.

use std::fs::File;
use std::io::{BufRead, BufReader};

use anyhow::{Context, Result, ensure};

use super::output::Answers;

/// Counts the members whose rows a file has already, but for the last one, of which rows may be missing; the
/// bytes of these rows and of the names above. `first` gives the rows of the first member.
pub(super) fn resume(
    answers: &mut Answers,
    file: &File,
    told: &str,
    first: impl FnOnce(&Answers) -> String,
) -> Result<u64> {
    let is_ours = |yes: bool| {
        ensure!(yes, "{told} is of another ensemble, or of another version: remove it, or take another --out");
        Ok(())
    };
    let (mut reader, columns) = (BufReader::new(file), answers.names().len());
    let mut next = || -> Result<Option<String>> {
        let mut line = String::new();
        reader.read_line(&mut line).with_context(|| format!("cannot read {told}"))?;
        Ok(Some(line).filter(|line| line.ends_with('\n')))
    };
    let Some(head) = next()? else { return Ok(0) };
    is_ours(head == answers.head())?;
    let (mut whole, mut end, mut of_first) = (head.len(), head.len(), String::new());
    let mut under_way: Option<(String, String)> = None;
    while let Some(line) = next()? {
        let begin = answers.begin(answers.done);
        if !begin.is_some_and(|begin| line.starts_with(&begin)) {
            is_ours(under_way.is_some())?;
            if let Some((status, cause)) = under_way.take() {
                let cause = cause.trim_matches('"').replace("\"\"", "\"");
                answers.count(&status, Some(cause.as_str()).filter(|cause| !cause.is_empty()));
            }
            let begin = answers.begin(answers.done);
            is_ours(begin.is_some_and(|begin| line.starts_with(&begin)))?;
            whole = end;
        }
        let mut cells = line.trim_end_matches('\n').splitn(columns, ',').skip(columns - 2).map(String::from);
        under_way = cells.next().zip(cells.next());
        is_ours(under_way.is_some())?;
        end += line.len();
        if answers.done == 0 {
            of_first += &line;
        }
    }
    if answers.done == 0 {
        return Ok(0);
    }
    is_ours(of_first == first(answers))?;
    Ok(whole as u64)
}
