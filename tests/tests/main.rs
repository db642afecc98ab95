//! What must hold between the crates: one program, one module per subject.

mod acceptance;
mod architecture;
mod counts;
mod discrete;
mod faults;
mod formulas;
mod narrow;
mod own_systems;
mod properties;
mod pulses;
mod reference_motions;
mod references;
mod scales;
mod stability;
mod units;
mod zero;

// derivations allocate much, and this program derives all the time
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;
