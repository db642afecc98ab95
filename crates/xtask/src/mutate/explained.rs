//! Mutants that no test can notice, each with the reason: `crates/xtask/mutants.toml`.

use anyhow::{Context, Result, ensure};
use toml::de::{DeTable, DeValue};

use super::finder::{Mutant, one_line};
use super::results::Verdict;

/// Where the explanations stand.
pub(crate) const FILE: &str = "crates/xtask/mutants.toml";

/// Why one mutant changes nothing that a test could see.
#[derive(Debug, PartialEq)]
pub(crate) struct Explanation {
    pub(crate) file: String,
    pub(crate) function: String,
    pub(crate) original: String,
    pub(crate) replacement: String,
    /// Part of the line where the change begins; empty where the rest is enough to find the one place.
    pub(crate) context: String,
    pub(crate) reason: String,
}

/// Survivors and explanations, against each other.
pub(crate) struct Judged<'a> {
    pub(crate) explained: Vec<(&'a Mutant, &'a Explanation)>,
    pub(crate) unexplained: Vec<&'a Mutant>,
    /// Explanations of what does not survive, or is not a mutant any more.
    pub(crate) stale: Vec<&'a Explanation>,
    /// Explanations that fit several places: one of them may matter.
    pub(crate) ambiguous: Vec<&'a Explanation>,
}

/// Reads explanations. Each has `file`, `function`, `original`, `replacement` and `reason`; `context`, a part of the line, is
/// needed where the same text stands at several places of a function.
pub(crate) fn parse(text: &str) -> Result<Vec<Explanation>> {
    let table = DeTable::parse(text).context(FILE)?;
    let Some(list) = table.get_ref().get("explained") else { return Ok(Vec::new()) };
    let list = list.get_ref().as_array().with_context(|| format!("{FILE}: `explained` is no list of tables"))?;
    (1..)
        .zip(list.iter())
        .map(|(number, entry)| explanation(entry.get_ref()).with_context(|| format!("{FILE}: explanation {number}")))
        .collect()
}

fn explanation(entry: &DeValue) -> Result<Explanation> {
    let table = entry.as_table().context("is no table")?;
    let text = |key: &str| -> Result<String> {
        let value = table.get(key).and_then(|value| value.get_ref().as_str());
        Ok(one_line(value.with_context(|| format!("has no text `{key}`"))?))
    };
    let explanation = Explanation {
        file: text("file")?,
        function: text("function")?,
        original: text("original")?,
        replacement: text("replacement")?,
        context: if table.contains_key("context") { text("context")? } else { String::new() },
        reason: text("reason")?,
    };
    ensure!(!explanation.reason.is_empty(), "has an empty `reason`");
    Ok(explanation)
}

/// Sorts survivors into explained and unexplained, and finds stale explanations. A mutant without a verdict has not been
/// run: its explanation is not stale. Nor is one for a file that was not looked at.
pub(crate) fn judge<'a>(outcomes: &[(&'a Mutant, Option<Verdict>)], explanations: &'a [Explanation]) -> Judged<'a> {
    let mut judged =
        Judged { explained: Vec::new(), unexplained: Vec::new(), stale: Vec::new(), ambiguous: Vec::new() };
    for (mutant, _) in outcomes.iter().filter(|(_, verdict)| *verdict == Some(Verdict::Survived)) {
        match explanations.iter().find(|explanation| matches(explanation, mutant)) {
            Some(explanation) => judged.explained.push((mutant, explanation)),
            None => judged.unexplained.push(mutant),
        }
    }
    let looked_at = |e: &Explanation| outcomes.iter().any(|(mutant, _)| mutant.file == e.file);
    let needed = |e: &Explanation| {
        let open = |verdict: Option<Verdict>| verdict.is_none_or(|verdict| verdict == Verdict::Survived);
        outcomes.iter().any(|(mutant, verdict)| open(*verdict) && matches(e, mutant))
    };
    judged.stale = explanations.iter().filter(|e| looked_at(e) && !needed(e)).collect();
    let places = |e: &Explanation| outcomes.iter().filter(|(mutant, _)| matches(e, mutant)).count();
    judged.ambiguous = explanations.iter().filter(|e| places(e) > 1).collect();
    judged
}

fn matches(explanation: &Explanation, mutant: &Mutant) -> bool {
    explanation.file == mutant.file
        && explanation.function == mutant.function
        && explanation.original == mutant.original
        && explanation.replacement == mutant.replacement
        && mutant.context.contains(&explanation.context)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutate::finder::find;

    const SOURCE: &str = "fn derive(g: &Graph) { one(g.neg(a)); two(g.neg(b)); three(g.neg(c)); }";

    fn text(original: &str, replacement: &str) -> String {
        format!(
            "[[explained]]\nfile = \"a.rs\"\nfunction = \"derive\"\noriginal = \"{original}\"\n\
             replacement = \"{replacement}\"\nreason = \"because\"\n"
        )
    }

    #[test]
    fn survivors_are_matched_and_stale_explanations_found() {
        let mutants = find("a.rs", SOURCE).unwrap();
        let verdicts = [Some(Verdict::Survived), Some(Verdict::Survived), Some(Verdict::Killed)];
        let outcomes: Vec<_> = mutants.iter().zip(verdicts).collect();
        let file = [("g.neg(a)", "a"), ("g.neg(c)", "c"), ("g.neg(d)", "d")].map(|(o, r)| text(o, r)).concat();
        let explanations = parse(&file).unwrap();
        let judged = judge(&outcomes, &explanations);
        assert_eq!(judged.explained.len(), 1);
        assert_eq!(judged.explained[0].0.original, "g.neg(a)");
        assert_eq!(judged.unexplained.iter().map(|m| m.original.as_str()).collect::<Vec<_>>(), ["g.neg(b)"]);
        // c is killed now, d is gone
        let stale: Vec<&str> = judged.stale.iter().map(|e| e.original.as_str()).collect();
        assert_eq!(stale, ["g.neg(c)", "g.neg(d)"]);
    }

    #[test]
    fn an_explanation_is_of_one_place() {
        let mutants = find("a.rs", "fn derive(g: &Graph) {\n    one(g.neg(a));\n    two(g.neg(a));\n}").unwrap();
        let outcomes: Vec<_> = mutants.iter().map(|mutant| (mutant, Some(Verdict::Survived))).collect();
        let both = parse(&text("g.neg(a)", "a")).unwrap();
        assert_eq!(judge(&outcomes, &both).ambiguous.len(), 1);
        let first = parse(&(text("g.neg(a)", "a") + "context = \"one(\"\n")).unwrap();
        let judged = judge(&outcomes, &first);
        assert!(judged.ambiguous.is_empty() && judged.stale.is_empty());
        assert_eq!(judged.unexplained.iter().map(|m| m.line).collect::<Vec<_>>(), [3]);
    }

    #[test]
    fn what_was_not_run_makes_no_explanation_stale() {
        let mutants = find("a.rs", SOURCE).unwrap();
        let outcomes: Vec<_> = mutants.iter().map(|mutant| (mutant, None)).collect();
        let explanations = parse(&text("g.neg(c)", "c")).unwrap();
        assert!(judge(&outcomes, &explanations).stale.is_empty());
        let elsewhere = parse(&text("g.neg(c)", "c").replace("a.rs", "b.rs")).unwrap();
        assert!(judge(&outcomes, &elsewhere).stale.is_empty());
    }

    #[test]
    fn an_explanation_needs_all_its_parts() {
        assert_eq!(parse("").unwrap(), Vec::new());
        let whole = text("g.neg(c)", "c");
        for key in ["file", "function", "original", "replacement", "reason"] {
            let error = format!("{:#}", parse(&whole.replace(&format!("{key} ="), "other =")).unwrap_err());
            assert!(error.contains("explanation 1") && error.contains(key), "{error}");
        }
        assert!(parse(&whole.replace("because", " ")).is_err());
    }
}
