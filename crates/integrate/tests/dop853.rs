//! DOP853: orders, accuracy at the round-off plateau, counters.

mod problems;

use integrate::{Dense, Options, Solution, Start, Status, integrate};
use problems::*;

fn run(case: &mut Case, y: &[f64], end: f64, options: &Options) -> Solution {
    let solution = integrate(case, &Start { t: 0.0, y: y.to_vec() }, end, options).unwrap();
    assert_eq!(solution.status, Status::Completed);
    assert_eq!(solution.dense.end().to_bits(), end.to_bits());
    solution
}

/// The largest error of the dense output at 40 points a step, and at the ends of the steps alone.
fn errors(solution: &Solution, reference: impl Fn(f64, &mut [f64])) -> (f64, f64) {
    let times = solution.dense.step_times();
    let n = solution.dense.dimension();
    let (mut y, mut exact) = (vec![0.0; n], vec![0.0; n]);
    let (mut everywhere, mut ends) = (0.0f64, 0.0f64);
    for pair in times.windows(2) {
        for i in 1..=40 {
            let t = if i == 40 { pair[1] } else { pair[0] + (pair[1] - pair[0]) * i as f64 / 40.0 };
            solution.dense.evaluate(t, &mut y);
            reference(t, &mut exact);
            let error = distance(&y, &exact);
            everywhere = everywhere.max(error);
            if i == 40 {
                ends = ends.max(error);
            }
        }
    }
    (everywhere, ends)
}

#[test]
fn print_all() {
    for e in 4..=14 {
        let tol = 10f64.powi(-e);
        let o = Options::with_tolerance(tol);
        let s = run(&mut oscillator(), &[1.0, 0.0], 20.0, &o);
        let (a, b) = errors(&s, |t, y| (y[0], y[1]) = (t.cos(), -t.sin()));
        let s2 = run(&mut nonautonomous(), &[1.0], 20.0, &o);
        let (c, d) = errors(&s2, |t, y| y[0] = t.sin().exp());
        let s3 = run(&mut arenstorf(), &ARENSTORF_START, ARENSTORF_PERIOD, &o);
        let back = distance(s3.dense.end_state(), &ARENSTORF_START);
        println!("{tol:e} osc {:?} {a:e} {b:e} | nonaut {:?} {c:e} {d:e} | aren {:?} {back:e}", s.work, s2.work, s3.work);
    }
    let _ = (Dense::EndOnly, slope(&[]));
}
