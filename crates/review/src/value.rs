//! A review as JSON.

use serde_json::{Map, Value, json};

use crate::{Coefficient, Numbers, Review, Verdict};

impl Review {
    /// As JSON: the fields of `docs/schemas/review.json`, except for the schema.
    pub fn value(&self, scene: &str, file: &str) -> Value {
        let verdict = match self.verdict {
            Verdict::Right => "right",
            Verdict::Wrong => "wrong",
            Verdict::Undecided => "undecided",
        };
        let numbers = self.numbers.map(|numbers| if numbers == Numbers::Field { "field" } else { "floats" });
        let differences = self.differences.iter();
        let differences = differences.map(|d| json!({ "name": d.name, "theirs": d.theirs, "right": d.right }));
        let coefficient =
            |c: &Coefficient| json!({ "name": c.name, "monomial": c.monomial, "theirs": c.theirs, "right": c.right });
        let coefficients = self.coefficients.iter().map(coefficient);
        let state: Map<String, Value> = self.state.iter().map(|(name, x)| (name.clone(), json!(x))).collect();
        json!({
            "scene": scene, "file": file, "formulation": self.asked, "verdict": verdict, "numbers": numbers,
            "explanations": self.explanations, "broken": self.broken, "state": state, "at_start": self.at_start,
            "differences": differences.collect::<Vec<_>>(), "coefficients": coefficients.collect::<Vec<_>>(),
            "unknowns": self.unknowns, "notes": self.notes,
        })
    }
}
