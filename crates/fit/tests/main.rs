//! Films with known numbers, made by code that shares nothing with the fit; tables that cannot be read.

mod bounds;
mod design;
mod films;
mod laws;
mod noise;
mod search;
mod shown;
mod statistics;
mod tables;
mod trust;
mod verdicts;

// a search allocates in all threads at once
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;
