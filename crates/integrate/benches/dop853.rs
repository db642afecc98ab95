//! What the time loop costs besides the evaluations: DOP853 on the Arenstorf orbit, and on rates that cost nothing.
#![allow(missing_docs)]

#[path = "../tests/problems/mod.rs"]
mod problems;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use integrate::{Dense, EvaluationError, Options, Problem, Start, integrate};
use problems::{ARENSTORF_PERIOD, ARENSTORF_START, arenstorf};

/// y' = 0 in n unknowns, evaluated for the price of a copy; the steps are kept short by the first component's t¹⁰.
struct Free {
    dimension: usize,
}

impl Problem for Free {
    fn dimension(&self) -> usize {
        self.dimension
    }
    fn rates(&mut self, t: f64, _y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        rates.fill(0.0);
        rates[0] = t.powi(10);
        Ok(())
    }
    fn jacobian(&mut self, _t: f64, _y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        jacobian.fill(0.0);
        Ok(())
    }
}

fn runs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("dop853");
    for dense in [Dense::Everywhere, Dense::EndOnly] {
        let options = Options { dense, ..Options::with_tolerance(1e-12) };
        let start = Start { t: 0.0, y: ARENSTORF_START.to_vec() };
        let mut orbit = || integrate(&mut arenstorf(), &start, ARENSTORF_PERIOD, &options).unwrap();
        group.throughput(Throughput::Elements(orbit().work.evaluations as u64));
        group.bench_function(format!("arenstorf, {dense:?}"), |bencher| bencher.iter(&mut orbit));
        for dimension in [4, 16] {
            let start = Start { t: 1.0, y: vec![0.0; dimension] };
            let mut free = || integrate(&mut Free { dimension }, &start, 10.0, &options).unwrap();
            group.throughput(Throughput::Elements(free().work.evaluations as u64));
            group.bench_function(format!("loop alone, n = {dimension}, {dense:?}"), |bencher| bencher.iter(&mut free));
        }
    }
    group.finish();
}

criterion_group!(benches, runs);
criterion_main!(benches);
