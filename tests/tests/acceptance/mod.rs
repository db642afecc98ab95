//! What the formulations must do, scene by scene: each test can fail, and prints the figure that it measured.

mod bodies;
mod chains;
mod charts;
mod closed_forms;
mod constraint_law;
mod declared;
mod derivations;
mod ensembles;
mod forces;
mod frames;
mod leading_term;
mod linearization;
mod machines;
mod matching;
mod numerics;
mod reactions;
mod reduced_form;
mod reduced_vakonomic;
mod references;
mod second_rates;
mod sensitivities;
mod support;
mod taylor;
mod textbook_machines;
mod theory;
mod vectors;
