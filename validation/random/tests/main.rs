//! Judgements on random systems: one program, one module per subject.

mod agreement;
mod bulk;
mod case;
mod fairness;
mod findings;
mod growth;
mod rates;
