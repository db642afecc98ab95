//! `deltaq prove`.

use anyhow::Result;
use comparison::{certificate, holds_beside_numbers, membership};
use integrals::NoMultipliers;
use mechanics::Domain;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::ProveArguments;
use pages::membership::{Decision, Word};
use pages::membership_sentence;
use program::{Answer, TextOrJson, file, keep, typed};

/// What came of `deltaq prove --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "prove/1")]
pub(crate) struct Proved {
    /// Whether some multipliers make the vakonomic motion Chetaev's.
    #[serde(flatten)]
    decision: Decision,
    /// Of which starts this is certified: this one, or almost every one, of its leaf and branch where that
    /// has to be said.
    #[serde(skip_serializing_if = "Option::is_none")]
    domain: Option<String>,
    /// The file that was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<String>,
}

/// Writes the certificate; where there is none, says what is known instead.
///
/// # Errors
/// Bad input, with its place, and a file that cannot be written.
pub fn run(arguments: &ProveArguments) -> Result<Answer> {
    let ProveArguments { scene: given, out, almost_every, format } = arguments;
    let scene = given.find()?;
    let reason = match certificate(&scene, *almost_every)? {
        Err(reason) => reason,
        Ok(certificate) => {
            holds_beside_numbers(&scene)?;
            let order = certificate.order;
            let text = typed(&NoMultipliers::of(&certificate, &given.set.written()))?;
            let domain = match almost_every {
                true => Domain::of(&scene.system).almost_every("start"),
                false => "this start".into(),
            };
            let file = out.display();
            let told = match format {
                TextOrJson::Text => {
                    let what = "no μ₀ makes the vakonomic motion Chetaev's";
                    let from = if *almost_every { format!(" from {domain}") } else { String::new() };
                    format!("{}: {what}{from}: proved (order {order}); the certificate is in {file}\n", scene.name)
                }
                TextOrJson::Json => {
                    let certificate = Some(file.to_string());
                    typed(&Proved { decision: Decision::none(order), domain: Some(domain), certificate })?
                }
            };
            return Ok(keep(Some(out), text, |_| told)?.into());
        }
    };
    let found = membership(&scene, scene.start.t + scene.duration).transpose();
    let text = match (format, file(Some(out))) {
        (TextOrJson::Json, Some(_)) => {
            let decision = found.as_ref().map_or(Decision::word(Word::Unconstrained), Decision::of);
            typed(&Proved { decision, domain: None, certificate: None })?
        }
        _ => String::new(),
    };
    let sentence = match &found {
        None => "Every motion is Chetaev's and vakonomic.".into(),
        Some(Ok(membership)) => membership_sentence(membership),
        Some(Err(error)) => format!("Whether some μ₀ gives Chetaev's motion is undecided: {error}."),
    };
    Ok(Answer {
        text,
        complaint: Some(format!("no certificate for {}: {reason}. {sentence}", scene.name)),
        ..Answer::default()
    })
}
