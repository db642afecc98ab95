//! `deltaq prove`.

use anyhow::Result;
use comparison::{certificate, holds_beside_numbers, membership};
use mechanics::Domain;
use serde_json::json;

use crate::cli::ProveArguments;
use pages::{membership::value as membership_value, membership_sentence};
use program::{Answer, TextOrJson, file, keep, pretty};

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
            let text = pretty("certificate", &certificate.value(&given.set.written()));
            let domain = match almost_every {
                true => Domain::of(&scene.system).almost_every("start"),
                false => "this start".into(),
            };
            let told = |file: &str| match format {
                TextOrJson::Text => {
                    let what = "no μ₀ makes the vakonomic motion Chetaev's";
                    let from = if *almost_every { format!(" from {domain}") } else { String::new() };
                    format!("{}: {what}{from}: proved (order {order}); the certificate is in {file}\n", scene.name)
                }
                TextOrJson::Json => {
                    let found = json!({
                        "answer": "none", "proved": true, "domain": domain, "order": order, "certificate": file,
                    });
                    pretty("prove", &found)
                }
            };
            return Ok(keep(Some(out), text, told)?.into());
        }
    };
    let found = membership(&scene, scene.start.t + scene.duration).transpose();
    let text = match (format, file(Some(out))) {
        (TextOrJson::Json, Some(_)) => {
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
    Ok(Answer {
        text,
        complaint: Some(format!("no certificate for {}: {reason}. {sentence}", scene.name)),
        ..Answer::default()
    })
}
