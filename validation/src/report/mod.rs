//! Reports: Markdown that reads well on a code host, SVG pictures by relative link, one JSON file for machines.

mod equations;
mod files;
mod numbers;
mod overview;
mod pictures;
mod random_page;
mod referees_section;
mod scene_page;
mod tables;
mod verdicts;

pub use equations::{EquationStyle, equations_text};
pub use files::{File, write_all};
pub use overview::{Provenance, overview};
pub use pictures::pictures;
pub use random_page::{random_files, random_headline, random_verdicts};
pub use referees_section::referees_section;
pub use scene_page::{answer, scene_page};
pub use verdicts::{difference_of_verdicts, verdicts};
