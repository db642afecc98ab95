//! # Scenes
//!
//! A system, its start and its hand-written removals as data, one TOML file each. A file says `q ∈ Rⁿ`,
//! `L(q, v, t)`, `f(q, v, t) = 0 ∈ Rʰ`, `Q(q, v, t)`, parameters, `(t₀, q₀)`, those entries of `v₀` that
//! the constraints leave open, and how long to run. Reading it gives a [`Scene`]: a
//! [`System`](mechanics::System), a [`State`](mechanics::State) with `f(q₀, v₀, t₀) = 0`, and removals that
//! were verified. Signs are those of `mechanics`; units are labels.
//!
//! ```
//! let text = r#"
//! title = "Ice sledge on an incline"
//! [parameters]
//! g = 9.81
//! alpha = 0.4
//! k = 0.7
//! [coordinates]
//! x   = { unit = "m", start = 0 }
//! y   = { unit = "m", start = 0 }
//! phi = { unit = "rad", start = 0.3 }
//! [system]
//! lagrangian  = "(x'^2 + y'^2)/2 + k^2*phi'^2/2 + g*x*sin(alpha)"
//! constraints = ["y'*cos(phi) - x'*sin(phi)"]
//! [start.velocities]
//! "phi'" = 1.1
//! "x'"   = "0.5*cos(phi)"
//! [removal.arc-length]
//! parameters = ["u", "phi"]
//! rates = { x = "u'*cos(phi)", y = "u'*sin(phi)" }
//! constants = { horizon = 10 }
//! [run]
//! duration = 10
//! "#;
//! // the speed along the blade is 0.5, so the constraint supplies y' = 0.5 sin(0.3)
//! let scene = scene::Scene::parse("sledge", text)?;
//! assert!((scene.start.v[1] - 0.5 * f64::sin(0.3)).abs() < 1e-15);
//!
//! let error = scene::Scene::parse("sledge", &text.replace("alpha = 0.4", "")).unwrap_err();
//! assert_eq!(error.line, 12);
//! # Ok::<(), scene::SceneError>(())
//! ```
//!
//! **What it refuses.** Whatever cannot be read or has no start, as a [`SceneError`] with its place in the
//! text and what was expected there. Nothing panics, whatever the text. [`Scene::to_toml`] writes a file that
//! reads back as the same scene. It knows no formulation and no equation of motion; all mathematics is that
//! of `mechanics`.

pub mod catalogue;
mod constants;
mod context;
mod error;
mod film;
mod followed;
pub mod format;
mod formulas;
mod load;
mod machine;
mod names;
mod number;
mod order;
mod overrides;
mod reasons;
mod redundant;
mod removal;
mod review;
mod scene;
pub mod scenery;
mod section;
mod start;
mod start_equations;
mod starts;
mod system;
mod table;
mod view;
mod write;

pub use error::{SceneError, SceneErrorKind};
pub use load::SIZE_LIMIT;
pub use names::find_name;
pub use number::Number;
pub use reasons::{NameFault, Remark, Unavailable};
pub use scene::{Filmed, Meant, Scene};
pub use starts::{Start, Starts};
pub use table::{MOST_ROWS, TABLE_SIZE, Table, TableError, TableFault, table_cell, table_text};
pub use write::quoted;
