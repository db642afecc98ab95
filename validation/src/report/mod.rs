//! Reports: Markdown that reads well on a code host, SVG by relative link, one JSON file for machines.

mod audit_page;
mod bicycle_page;
pub mod control;
mod differences;
mod equivalence;
mod ivp_page;
pub mod law_rows;
mod literature;
mod overview;
mod random_page;
mod realization_page;
mod referees_section;
mod scaling_page;
mod stability_page;
pub mod stamp;

pub use audit_page::AuditReport;
pub use bicycle_page::BicycleReport;
pub use differences::Compared;
pub use equivalence::EquivalenceReport;
pub use ivp_page::ivp_files;
pub use literature::LiteratureReport;
pub use overview::{overview, summary};
pub use random_page::{random_complaint, random_files, random_headline, random_verdicts, word as theorem_word};
pub use realization_page::{ADDED_MASS, Approach, BOTH, FRICTION, RealizationReport};
pub use referees_section::{CASADI, referees_files, without_referees};
pub use scaling_page::{scaling_files, scaling_text};
pub use stability_page::StabilityReport;

/// The scene of the paper whose constraint is misprinted. It is not a rolling ball, so its page stands with
/// the audit of the paper and not among the scenes.
pub const AS_PRINTED: &str = "ball-in-cone-as-printed";

/// The folder of the page of a scene.
pub fn folder_of(scene: &str) -> &'static str {
    if scene == AS_PRINTED { "paper" } else { "scenes" }
}
