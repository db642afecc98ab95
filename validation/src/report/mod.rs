//! Reports: Markdown that reads well on a code host, SVG by relative link, one JSON file for machines.

mod audit_page;
mod bench_page;
mod equivalence;
mod files;
mod fill;
mod literature;
mod membership;
mod numbers;
mod overview;
mod pictures;
mod random_page;
mod realization_page;
mod referees_section;
mod scaling_page;
mod scene_page;
mod stability_page;
mod table;
mod tables;
mod verdicts;

pub use audit_page::AuditReport;
pub use bench_page::{bench_files, bench_headline, bench_json, bench_table, ensemble_text};
pub use equivalence::EquivalenceReport;
pub use files::{File, write_all};
pub use fill::fill;
pub use literature::LiteratureReport;
pub use membership::{sentence as membership_sentence, value as membership_value};
pub use overview::overview;
pub use pictures::pictures;
pub use random_page::{random_files, random_headline, random_verdicts};
pub use realization_page::RealizationReport;
pub use referees_section::referees_section;
pub use scaling_page::{scaling_files, scaling_text};
pub use scene_page::{answer, scene_page};
pub use stability_page::StabilityReport;
pub use table::Table;
pub use verdicts::{difference_of_verdicts, verdicts};
