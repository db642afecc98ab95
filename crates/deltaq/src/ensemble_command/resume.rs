//! Continuation of an interrupted table of members.

use anyhow::Result;
use program::ResumableFile;

use super::output::Answers;

/// Keeps and counts the members whose rows are there, except the last one, whose rows may be incomplete.
/// `first` gives the rows of the first member.
pub(super) fn resume(
    answers: &mut Answers,
    lines: &mut ResumableFile,
    is_ours: &dyn Fn(bool) -> Result<()>,
    first: impl FnOnce(&Answers) -> String,
) -> Result<()> {
    let columns = answers.names().len();
    let (mut before, mut of_first) = (lines.at(), String::new());
    let mut under_way: Option<(String, String)> = None;
    while let Some(line) = lines.next_line()? {
        let begin = answers.begin(answers.done);
        if !begin.is_some_and(|begin| line.starts_with(&begin)) {
            is_ours(under_way.is_some())?;
            if let Some((status, cause)) = under_way.take() {
                let cause = cause.trim_matches('"').replace("\"\"", "\"");
                answers.count(&status, Some(cause.as_str()).filter(|cause| !cause.is_empty()));
            }
            let begin = answers.begin(answers.done);
            is_ours(begin.is_some_and(|begin| line.starts_with(&begin)))?;
            lines.keep(before);
        }
        let mut cells = line.trim_end_matches('\n').splitn(columns, ',').skip(columns - 2).map(String::from);
        under_way = cells.next().zip(cells.next());
        is_ours(under_way.is_some())?;
        before = lines.at();
        if answers.done == 0 {
            of_first += &line;
        }
    }
    is_ours(answers.done == 0 || of_first == first(answers))
}
