//! The methods of diffsol: orders against cost, stiff problems, projection.

use crate::problems::*;
use integrate::{Method, Options, Projection, Solution, Start, Status, integrate};

fn run(case: &mut Case, y: &[f64], end: f64, options: &Options) -> Solution {
    let solution = integrate(case, &Start { t: 0.0, y: y.to_vec() }, end, options).unwrap();
    assert_eq!(solution.status, Status::Completed, "{options:?}");
    solution
}

#[test]
fn errors_fall_with_the_order_of_the_method() {
    for (method, order) in [
        (Method::Tsit45, 5.0),
        (Method::Bdf, 5.0),
        (Method::TrBdf2, 2.0),
        (Method::Esdirk34, 3.0),
        (Method::Radau5, 4.0),
    ] {
        // Radau5: the error of its dense output, of order 3, and not that of the ends of its steps
        let points: Vec<(f64, f64)> = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10]
            .iter()
            .map(|&tolerance| {
                let options = Options { method, ..Options::with_tolerance(tolerance) };
                let solution = run(&mut nonautonomous(), &[1.0], 10.0, &options);
                let dense = &solution.dense;
                let error = (0..=500).map(|i| {
                    let mut y = [0.0];
                    let t = f64::from(i) * 0.02;
                    dense.evaluate(t, &mut y);
                    (y[0] - t.sin().exp()).abs()
                });
                (solution.work.steps as f64, error.fold(0.0, f64::max))
            })
            .collect();
        let measured = -slope(&points);
        println!("{method:?} {measured} {points:?}");
        assert!((measured - order).abs() < 0.6, "{method:?}: order {measured} from {points:?}");
    }
}

#[test]
fn stiff_problems_agree_with_their_references() {
    // Robertson at t = 40 and van der Pol (μ = 1000) at t = 2: Hairer and Wanner, Solving Ordinary Differential
    // Equations II, IV.10, and the Test Set for IVP Solvers.
    let robertson_40 = [0.715_827_068_719_4, 9.185_534_764_557_3e-6, 0.284_163_745_745_8];
    let van_der_pol_2 = [1.706_167_732_170_483, -0.892_809_701_024_797_5];
    // Radau5 keeps the error of its dense output, of order 3, under the tolerance; at the ends it is better by orders
    for (method, limit, steps, share) in [
        (Method::Bdf, 2e-6, 1000, 5),
        (Method::TrBdf2, 3e-5, 1000, 5),
        (Method::Esdirk34, 1e-5, 1000, 5),
        (Method::Radau5, 1e-9, 2000, 2),
    ] {
        let options = Options { method, absolute_tolerance: 1e-13, ..Options::with_tolerance(1e-7) };
        let solution = run(&mut robertson(), &[1.0, 0.0, 0.0], 40.0, &options);
        let y = solution.dense.end_state();
        for i in 0..3 {
            let error = (y[i] / robertson_40[i] - 1.0).abs();
            println!("{method:?} {error:e} {:?}", solution.work);
            assert!(error < limit, "{method:?}: Robertson's y{i} has the relative error {error:e}");
        }
        assert!(solution.work.steps < steps, "{method:?} {:?}", solution.work);
        let options = Options { method, ..Options::with_tolerance(1e-7) };
        let solution = run(&mut van_der_pol(), &[2.0, 0.0], 2.0, &options);
        let error = distance(solution.dense.end_state(), &van_der_pol_2);
        println!("{method:?} {error:e} {:?}", solution.work);
        assert!(error < limit, "{method:?}: van der Pol has the error {error:e}");
        assert!(solution.work.steps < 7000, "{method:?} {:?}", solution.work);
        assert!(solution.work.jacobians < solution.work.steps / share, "{method:?} {:?}", solution.work);
    }
}

#[test]
fn projection_keeps_the_radius_and_does_no_harm() {
    for method in Method::ALL {
        let tolerance = 1e-7;
        let off = Options { method, projection: Projection::Off, ..Options::with_tolerance(tolerance) };
        let on = Options { projection: Projection::EveryStep, ..off.clone() };
        let mut case = oscillator().with_projection(onto_circle);
        let (free, kept) = (run(&mut case, &[1.0, 0.0], 100.0, &off), run(&mut case, &[1.0, 0.0], 100.0, &on));
        let error = |solution: &Solution| distance(solution.dense.end_state(), &[100f64.cos(), -100f64.sin()]);
        let radius = |solution: &Solution| {
            let error = (0..=10_000).map(|i| {
                let mut y = [0.0; 2];
                solution.dense.evaluate(f64::from(i) * 0.01, &mut y);
                (y[0].hypot(y[1]) - 1.0).abs()
            });
            error.fold(0.0, f64::max)
        };
        println!(
            "{method:?} errors {:e} {:e} radii {:e} {:e} {:?} {:?} {:?}",
            error(&free),
            error(&kept),
            radius(&free),
            radius(&kept),
            free.work,
            kept.work,
            kept.projection
        );
        assert!(error(&kept) < 1.05 * error(&free), "{method:?}: {:e} and {:e}", error(&free), error(&kept));
        assert!(radius(&kept) < radius(&free), "{method:?}: {:e} and {:e}", radius(&free), radius(&kept));
        // Between the steps the radius is off by the error of the interpolation within one step only.
        assert!(radius(&kept) < 10.0 * tolerance, "{method:?}: {:e}", radius(&kept));
        let end = kept.dense.end_state();
        assert!((end[0].hypot(end[1]) - 1.0).abs() < 4e-16);
        assert!(kept.work.steps as f64 <= 1.1 * free.work.steps as f64, "{method:?}");
        let report = kept.projection;
        assert_eq!(report.projections, kept.work.steps);
        assert!(report.largest > 0.0 && report.largest <= report.total, "{method:?} {report:?}");
        assert_eq!(free.projection, Default::default());
    }
}

#[test]
fn projection_holds_what_would_run_away() {
    // A turn with radial instability, (r − 1)' = 2 (r − 1): without projection an error grows like exp(2t), e⁴⁰ at t = 20.
    // Bdf, too, has to be told of the projections then.
    let case = Case::new(
        2,
        |_, y, r| {
            let push = 2.0 * (1.0 - 1.0 / y[0].hypot(y[1]));
            (r[0], r[1]) = (y[1] + push * y[0], -y[0] + push * y[1]);
            Ok(())
        },
        |_, y, j| {
            let radius = y[0].hypot(y[1]);
            let (push, cubed) = (2.0 * (1.0 - 1.0 / radius), radius.powi(3));
            j[0] = push + 2.0 * y[0] * y[0] / cubed;
            j[1] = 1.0 + 2.0 * y[0] * y[1] / cubed;
            j[2] = -1.0 + 2.0 * y[0] * y[1] / cubed;
            j[3] = push + 2.0 * y[1] * y[1] / cubed;
        },
    )
    .with_series(|_, y| {
        let radius = (&(&y[0] * &y[0]) + &(&y[1] * &y[1])).powf(-0.5);
        let push = &(&radius.number(1.0) - &radius) * 2.0;
        vec![&y[1] + &(&push * &y[0]), &(&push * &y[1]) - &y[0]]
    })
    .with_projection(onto_circle);
    for method in Method::ALL {
        let options = Options { method, ..Options::with_tolerance(1e-7) };
        let start = Start { t: 0.0, y: vec![1.0, 0.0] };
        let solution = integrate(&mut case.clone(), &start, 20.0, &options).unwrap();
        assert_eq!(solution.status, Status::Completed, "{method:?}");
        let error = distance(solution.dense.end_state(), &[20f64.cos(), -20f64.sin()]);
        println!("{method:?} {error:e} {:?} {:?}", solution.work, solution.projection);
        assert!(error < 1e-3, "{method:?}: {error:e}");
        assert!(solution.projection.largest < 1e-2, "{method:?} {:?}", solution.projection);
    }
}

#[test]
fn radau_has_order_five_at_the_ends_of_its_steps() {
    let points: Vec<(f64, f64)> = [1e-7, 1e-8, 1e-9, 1e-10]
        .iter()
        .map(|&tolerance| {
            let options = Options { method: Method::Radau5, ..Options::with_tolerance(tolerance) };
            let solution = run(&mut nonautonomous(), &[1.0], 10.0, &options);
            let mut y = [0.0];
            let times = solution.dense.step_times();
            let errors = times.iter().map(|&t| {
                solution.dense.evaluate(t, &mut y);
                (y[0] - t.sin().exp()).abs()
            });
            (solution.work.steps as f64, errors.fold(0.0, f64::max))
        })
        .collect();
    let measured = -slope(&points);
    println!("{measured} {points:?}");
    assert!((measured - 5.0).abs() < 0.4, "order {measured} from {points:?}");
}

#[test]
fn radau_is_exact_where_the_slow_manifold_is_not_left() {
    // Prothero and Robinson: y' = λ (y − cos t) − sin t, whose solution from 1 is cos t however stiff. Order reduction is bounded by 1/|λ|
    for stiffness in [1e2, 1e6, 1e10] {
        let mut case = ProtheroRobinson { stiffness };
        let options = Options { method: Method::Radau5, ..Options::with_tolerance(1e-8) };
        let solution = integrate(&mut case, &Start { t: 0.0, y: vec![1.0] }, 10.0, &options).unwrap();
        assert_eq!(solution.status, Status::Completed);
        let error = (solution.dense.end_state()[0] - 10f64.cos()).abs();
        let between = (0..=10_000).map(|i| {
            let (t, mut y) = (f64::from(i) * 1e-3, [0.0]);
            solution.dense.evaluate(t, &mut y);
            (y[0] - t.cos()).abs()
        });
        let between = between.fold(0.0, f64::max);
        println!("λ = -{stiffness:e}: {error:e}, between {between:e}, {:?}", solution.work);
        assert!(error < 1e-8, "{error:e}");
        // what is stiff is not estimated by the method itself: between the steps it is the polynomial that has to be good enough
        assert!(between < 1e-7, "{between:e}");
        assert!(solution.work.steps < 2000, "{:?}", solution.work);
    }
}

struct ProtheroRobinson {
    stiffness: f64,
}

impl integrate::Problem for ProtheroRobinson {
    fn dimension(&self) -> usize {
        1
    }
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        rates[0] = -self.stiffness * (y[0] - t.cos()) - t.sin();
        Ok(())
    }
    fn jacobian(&mut self, _: f64, _: &[f64], jacobian: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        jacobian[0] = -self.stiffness;
        Ok(())
    }
}
