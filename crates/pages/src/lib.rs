//! Pages and pictures of a comparison: Markdown with SVG by relative link, CSV tables, and one JSON value.

mod bodies;
mod data;
mod family;
mod fill;
mod linear_page;
pub mod markdown;
pub mod membership;
mod pictures;
mod scene_page;
mod summary;
mod sweep_page;
mod table;
mod tables;
mod tex;
mod verdicts;

pub use bodies::bodies;
pub use comparison::words::Headline;
pub use comparison::words::sentence as membership_sentence;
pub use data::DataPackage;
pub use fill::fill;
pub use linear_page::{pairs, sweep_picture, sweep_text};
pub use pictures::pictures;
pub use scene_page::scene_files;
pub use summary::summary;
pub use sweep_page::{Swept, sweep_files, with_unit};
pub use table::Table;
pub use tables::verdict_words;
pub use verdicts::{SceneVerdicts, Verdicts, difference_of_verdicts, verdicts};
