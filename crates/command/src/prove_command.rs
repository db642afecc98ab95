//! `deltaq prove`.

use anyhow::{Context, Result};
use deltaq::{certificate, membership};
use scene::Number;
use serde_json::{Map, Value, json};

use crate::answer::{Answer, pretty};
use crate::cli::{ProveArguments, TextOrJson};
use validation::report::{membership_sentence, membership_value};

/// Writes the certificate; where there is none, says what is known instead.
///
/// # Errors
/// Bad input, with its place, and a file that cannot be written.
pub fn run(arguments: &ProveArguments) -> Result<Answer> {
    let ProveArguments { scene: given, out, format } = arguments;
    let scene = given.find()?;
    let to_terminal = out.as_os_str() == "-";
    let reason = match certificate(&scene)? {
        Err(reason) => reason,
        Ok(certificate) => {
            let named = |pairs: Vec<(String, Value)>| pairs.into_iter().collect::<Map<_, _>>();
            let order = certificate.order;
            let value = json!({
                "prime": certificate.prime,
                "i": certificate.imaginary,
                "zeta": certificate.root,
                "N": certificate.parts,
                "tau": certificate.turn,
                "order": order,
                "rows": certificate.rows,
                "minor": certificate.minor,
                "divided_by": named(certificate.divided_by.into_iter().map(|(what, x)| (what, x.into())).collect()),
                "set": named(given.set.overrides.iter().map(|(name, x)| (name.clone(), written(x))).collect()),
                "completed": certificate.completed,
                "motion": named(certificate.motion.into_iter().map(|(name, jet)| (name, jet.into())).collect()),
                "reactions": certificate.reactions,
            });
            let text = pretty("certificate", &value);
            if to_terminal {
                return Ok(text.into());
            }
            std::fs::write(out, text).with_context(|| format!("cannot write `{}`", out.display()))?;
            return Ok(match format {
                TextOrJson::Text => {
                    let what = "no μ₀ makes the vakonomic motion Chetaev's: proved";
                    format!("{}: {what} (order {order}); the certificate is in {}\n", scene.name, out.display())
                }
                TextOrJson::Json => {
                    let value = json!({ "answer": "none", "proved": true, "order": order, "certificate": out });
                    pretty("prove", &value)
                }
            }
            .into());
        }
    };
    let found = membership(&scene, scene.start.t + scene.duration).transpose();
    let text = match (format, to_terminal) {
        (TextOrJson::Json, false) => {
            let unconstrained = json!({ "answer": "unconstrained" });
            pretty("prove", &found.as_ref().map_or(unconstrained, |found| membership_value(Some(found))))
        }
        _ => String::new(),
    };
    let sentence = match &found {
        None => "Every motion is Chetaev's and vakonomic.".into(),
        Some(Ok(membership)) => membership_sentence(membership),
        Some(Err(error)) => format!("Whether some μ₀ gives Chetaev's motion is undecided: {error}."),
    };
    Ok(Answer { text, complaint: Some(format!("no certificate for {}: {reason}. {sentence}", scene.name)) })
}

/// A number as a certificate has it: a formula stays text.
fn written(number: &Number) -> Value {
    number.formula().map_or_else(|| number.value().into(), Value::from)
}
