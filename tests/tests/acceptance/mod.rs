//! What the formulations must do, scene by scene: each test can fail, and prints the figure that it measured.

mod between;
mod closed_forms;
mod control;
mod derivations;
mod ensembles;
mod formulations_agree;
mod frames;
mod invariants;
mod leading_term;
mod matching;
mod numerics;
mod planar_body;
mod reduced_form;
mod reduced_vakonomic;
mod references;
mod second_rates;
mod support;
mod taylor;
