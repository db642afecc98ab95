//! Work–precision measurements: error against run time of every formulation, method and tolerance.
//!
//! A measurement is one run of the time loop (not the two of [`motion::solve`]) with dense output, from
//! compiled equations. Its time is the least of several; its error is the largest kinetic distance from the
//! reference over [`SAMPLES`] times. A run that fails is listed with its cause.

mod ensemble;
mod exponent;
mod of_scene;
mod page;

pub use ensemble::{ENSEMBLE_SCENE, FEW_MEMBERS, MEMBERS, Throughput, Time, ensemble_throughput};
pub use exponent::{Exponent, exponent};
pub use of_scene::{
    Bench, Effort, Entry, Fastest, KeptMotion, KeptReferences, Measured, Measurements, Point, Prepared, SAMPLES,
    Series, TARGETS, Truth, Usual, bench_all, measure, prepare, references,
};
pub use page::{bench_files, bench_headline, bench_json, bench_table, ensemble_json, ensemble_text};
