//! Integration as a user of the crate meets it: one program, one module per subject.

mod boundary;
mod dense;
mod dop853;
mod dop853_order_conditions;
mod events;
mod methods;
mod options;
mod problems;
mod radau5;
mod stall_detector;
mod stops;
mod suspicions;
mod taylor;
