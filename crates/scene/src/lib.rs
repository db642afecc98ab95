//! # Scenes
//!
//! A system with velocity constraints, its start and its hand-written removals as data, one TOML file each. A
//! file says `q`, `L(q, v, t)`, `f(q, v, t) = 0`, `Q(q, v, t)`, parameters, `(t₀, q₀)`, as many entries of
//! `v₀` as the constraints leave open, and how long to run; reading it gives a [`Scene`]: a
//! [`System`](mechanics::System), a [`State`](mechanics::State) with `f(q₀, v₀, t₀) = 0`, and removals that
//! were verified.
//!
//! ```toml
//! title = "Ice sledge on an incline"
//!
//! [parameters]
//! g = 9.81
//! alpha = 0.4
//! k = 0.7
//!
//! [coordinates]
//! x   = { unit = "m", start = 0 }
//! y   = { unit = "m", start = 0 }
//! phi = { unit = "rad", start = 0.3 }
//!
//! [system]
//! lagrangian  = "(x'^2 + y'^2)/2 + k^2*phi'^2/2 + g*x*sin(alpha)"
//! constraints = ["y'*cos(phi) - x'*sin(phi)"]
//!
//! [start.velocities]
//! "phi'" = 1.1
//! "x'"   = "0.5*cos(phi)"
//!
//! [removal.arc-length]
//! parameters = ["u", "phi"]
//! rates = { x = "u'*cos(phi)", y = "u'*sin(phi)" }
//! constants = { horizon = 10 }
//!
//! [run]
//! duration = 10
//! ```
//!
//! Every fault is a [`SceneError`] with its place in the text and what was expected there; nothing panics,
//! whatever the text. [`Scene::to_toml`] writes a file that reads back as the same scene.
//!
//! What it does not know: any formulation, any equation of motion. All mathematics is that of `mechanics`.

mod constants;
mod context;
mod error;
mod load;
mod names;
mod overrides;
mod removal;
mod scene;
mod section;
mod start;
mod system;
mod write;

pub use error::{NameFault, SceneError, SceneErrorKind, Unavailable};
pub use load::SIZE_LIMIT;
pub use scene::Scene;
pub use write::quoted;
