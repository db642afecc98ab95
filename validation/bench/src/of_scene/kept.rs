//! References that are kept as text from one day to the next.

use std::collections::HashMap;
use std::fmt::Write;

use anyhow::{Context, Result, ensure};
use reference::{CachedReference, digest};

use super::Prepared;

/// References by the digests of what they are references of: what is asked for otherwise is not among them.
#[derive(Clone, Debug, Default)]
pub struct KeptReferences {
    /// In the order of the text.
    motions: Vec<KeptMotion>,
    places: HashMap<[u64; 2], usize>,
}

/// One of them.
#[derive(Clone, Debug)]
pub struct KeptMotion {
    /// Scene and motion, for the reader.
    pub name: String,
    /// [`reference::Question::digests`]: formulas and numbers.
    pub digests: [u64; 2],
    /// Where the motion is.
    pub reference: CachedReference,
}

/// What stands before each motion: its name, digests of formulas, of numbers and of the lines that follow,
/// the number of coordinates.
const BEGINS: &str = "# ";

impl KeptReferences {
    fn of(motions: Vec<KeptMotion>) -> KeptReferences {
        let places = motions.iter().enumerate().map(|(i, motion)| (motion.digests, i)).collect();
        KeptReferences { motions, places }
    }

    /// What [`KeptReferences::text`] wrote.
    ///
    /// # Errors
    /// Where it did not, or a digit was changed since.
    pub fn read(text: &str) -> Result<KeptReferences> {
        let motion = |part: &str| {
            let (head, lines) = part.split_once('\n').context("a motion without numbers")?;
            let words: Vec<&str> = head.rsplitn(5, ' ').collect();
            let [dimension, own, numbers, formulas, name] = words[..] else {
                anyhow::bail!("`{head}` is not a heading")
            };
            let number = |word: &str| u64::from_str_radix(word, 16).with_context(|| format!("{name}: digest `{word}`"));
            ensure!(number(own)? == digest(lines), "{name}: not the numbers that were written");
            let reference = dimension.parse().ok().and_then(|n| CachedReference::read(lines, n));
            let reference = reference.with_context(|| format!("{name}: no reference"))?;
            Ok(KeptMotion { name: name.into(), digests: [number(formulas)?, number(numbers)?], reference })
        };
        let parts = text.strip_prefix(BEGINS).context("no heading")?.split("\n# ").map(|part| part.trim_end());
        Ok(KeptReferences::of(parts.map(motion).collect::<Result<_>>()?))
    }

    /// Those behind what was prepared.
    pub fn behind(prepared: &[Prepared]) -> KeptReferences {
        let motions = prepared.iter().flat_map(|scene| {
            scene.truths.iter().filter_map(|(motion, truth)| {
                let truth = truth.as_ref().ok()?;
                let (name, reference) = (format!("{}: {motion}", scene.name), truth.wide()?.clone());
                Some(KeptMotion { name, digests: truth.digests, reference })
            })
        });
        KeptReferences::of(motions.collect())
    }

    /// Those of these for which that holds of their place among all.
    pub fn only(&self, wanted: impl Fn(usize) -> bool) -> KeptReferences {
        let motions = self.motions.iter().enumerate().filter(|(i, _)| wanted(*i));
        KeptReferences::of(motions.map(|(_, motion)| motion.clone()).collect())
    }

    /// All of them.
    pub fn motions(&self) -> &[KeptMotion] {
        &self.motions
    }

    /// The reference with these digests.
    pub fn find(&self, digests: [u64; 2]) -> Option<&CachedReference> {
        self.places.get(&digests).map(|&i| &self.motions[i].reference)
    }

    /// For [`KeptReferences::read`].
    pub fn text(&self) -> String {
        let mut text = String::new();
        for KeptMotion { name, digests: [formulas, numbers], reference } in &self.motions {
            let lines = reference.text();
            let lines = lines.trim_end();
            let (own, dimension) = (digest(lines), reference.dimension());
            let _ = writeln!(text, "{BEGINS}{name} {formulas:016x} {numbers:016x} {own:016x} {dimension}\n{lines}");
        }
        text
    }
}
