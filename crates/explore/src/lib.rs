//! # Answers for the browser page
//!
//! The page `reports/explore.html` asks questions as text and gets text and numbers, so that this crate can
//! run as WebAssembly in a browser, without files, threads and a clock. Nothing is derived, integrated
//! or decided here; that is `deltaq`'s.
//!
//! A [`Question`] is about the text of a scene, with numbers `set` instead of those of the text:
//! whatever `--set` takes, `P0_w` (the costate of the memory variable `w` at the start) and `kappa`, which a
//! scene need not have. There are nine:
//!
//! - `scene`: what can be varied, and which motions there are;
//! - `motions`: these, sampled at equal times, with the bodies that are drawn, and the gaps between them;
//!   where they are asked for, arrows and what a hand takes hold of at the start;
//! - `equations`: in LaTeX;
//! - `decision`: the comparison in words, as `deltaq compare` says it, and pair by pair;
//! - `integrals`: those of the first motion, as `deltaq integrals` says it;
//! - `derivatives`: of where every motion ends, by the numbers that can be set;
//! - `text`: the scene with the numbers that are set;
//! - `check`: notes on the text, as `deltaq check` says them;
//! - `review`: whether equations are right, as `deltaq review` says it, and which term is wrong.
//!
//! ```
//! let text = include_str!("../../scene/sledge.toml");
//! let question = serde_json::json!({
//!     "ask": "motions", "name": "sledge", "text": text, "motions": ["Chetaev"], "steps": 10,
//! });
//! let explore::Answer { text, numbers } = explore::Explorer::default().answer(&question.to_string());
//! let answer: serde_json::Value = serde_json::from_str(&text)?;
//! let motion = &answer["motions"][0];
//! let [from, width] = ["from", "width"].map(|name| motion[name].as_u64().unwrap() as usize);
//! // the sledge turns at a constant rate: phi = 0.3 + t; the last of eleven rows is at t = 1
//! assert!((numbers[from + 10 * width + 3] - 1.3).abs() < 1e-12);
//! # Ok::<(), serde_json::Error>(())
//! ```
//!
//! **What it refuses.** A faulty text is answered with all its faults and their places, a motion that cannot
//! be started with the reason.

mod answering;
mod arrows;
mod bodies;
mod cache;
mod controls;
mod drag_handles;
#[cfg(target_family = "wasm")]
mod exports;
mod further;
mod motions;
mod question;
mod run;
mod subject;
mod words;

pub use answering::Explorer;
pub use question::{Answer, Ask, Question};
