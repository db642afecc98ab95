//! The methods of diffsol and Radau5: orders against cost, stiff problems, projection.

use crate::problems::*;
use diffsol_methods::{BDF, ESDIRK34, EVERY, TR_BDF2, TSIT45};
use integrate::{Method, Options, Projection, Solution};

#[test]
fn errors_fall_with_the_order_of_the_method() {
    let tolerances = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
    let everywhere = |solution: &Solution| largest_error(solution, 500, |t| [t.sin().exp()]);
    let at_steps = |solution: &Solution| {
        let error = |&t: &f64| (state::<1>(solution, t)[0] - t.sin().exp()).abs();
        solution.dense.step_times().iter().map(error).fold(0.0, f64::max)
    };
    // Radau5 has order 5 at the ends of its steps, and its dense output order 3
    type Error<'a> = &'a dyn Fn(&Solution) -> f64;
    let cases: [(Method, f64, f64, Error, &[f64]); 6] = [
        (TSIT45, 5.0, 0.6, &everywhere, &tolerances),
        (BDF, 5.0, 0.6, &everywhere, &tolerances),
        (TR_BDF2, 2.0, 0.6, &everywhere, &tolerances),
        (ESDIRK34, 3.0, 0.6, &everywhere, &tolerances),
        (Method::Radau5, 4.0, 0.6, &everywhere, &tolerances),
        (Method::Radau5, 5.0, 0.4, &at_steps, &tolerances[1..]),
    ];
    for (method, order, off, error, tolerances) in cases {
        let point = |&tolerance: &f64| {
            let options = Options { method, ..Options::with_tolerance(tolerance) };
            let solution = run(&mut nonautonomous(), 0.0, &[1.0], 10.0, &options);
            (solution.work.steps as f64, error(&solution))
        };
        let points: Vec<(f64, f64)> = tolerances.iter().map(point).collect();
        let measured = -slope(&points);
        assert!((measured - order).abs() < off, "{method:?}: order {measured} from {points:?}");
    }
}

#[test]
fn stiff_problems_agree_with_their_references() {
    // Robertson at t = 40 and van der Pol (μ = 1000) at t = 2: Hairer and Wanner, Solving Ordinary
    // Differential Equations II, IV.10, and the Test Set for IVP Solvers.
    let robertson_40 = [0.715_827_068_719_4, 9.185_534_764_557_3e-6, 0.284_163_745_745_8];
    let van_der_pol_2 = [1.706_167_732_170_483, -0.892_809_701_024_797_5];
    // Radau5 keeps its dense output, of order 3, under the tolerance; the ends are better by orders
    for (method, limit, steps, share) in
        [(BDF, 2e-6, 1000, 5), (TR_BDF2, 3e-5, 1000, 5), (ESDIRK34, 1e-5, 1000, 5), (Method::Radau5, 1e-9, 2000, 2)]
    {
        let options = Options { method, absolute_tolerance: 1e-13, ..Options::with_tolerance(1e-7) };
        let solution = run(&mut robertson(), 0.0, &[1.0, 0.0, 0.0], 40.0, &options);
        for (i, (y, reference)) in solution.dense.end_state().iter().zip(robertson_40).enumerate() {
            let error = (y / reference - 1.0).abs();
            assert!(error < limit, "{method:?}: Robertson's y{i} has the relative error {error:e}");
        }
        assert!(solution.work.steps < steps, "{method:?} {:?}", solution.work);
        let options = Options { method, ..Options::with_tolerance(1e-7) };
        let solution = run(&mut van_der_pol(), 0.0, &[2.0, 0.0], 2.0, &options);
        let error = distance(solution.dense.end_state(), &van_der_pol_2);
        assert!(error < limit, "{method:?}: van der Pol has the error {error:e}");
        assert!(solution.work.steps < 7000, "{method:?} {:?}", solution.work);
        assert!(solution.work.jacobians < solution.work.steps / share, "{method:?} {:?}", solution.work);
    }
}

#[test]
fn projection_keeps_the_radius_and_does_no_harm() {
    for method in EVERY {
        let tolerance = 1e-7;
        let off = Options { method, projection: Projection::Off, ..Options::with_tolerance(tolerance) };
        let on = Options { projection: Projection::EveryStep, ..off.clone() };
        let mut case = oscillator().with_projection(onto_circle);
        let [free, kept] = [&off, &on].map(|options| run(&mut case, 0.0, &[1.0, 0.0], 100.0, options));
        let [error, error_kept] = [&free, &kept].map(|run| distance(run.dense.end_state(), &circle(100.0)));
        let off_circle = |solution: &Solution, t: f64| {
            let [x, y] = state(solution, t);
            (x.hypot(y) - 1.0).abs()
        };
        let [radius, radius_kept] =
            [&free, &kept].map(|run| (0..=10_000).map(|i| off_circle(run, f64::from(i) * 0.01)).fold(0.0, f64::max));
        assert!(error_kept < 1.05 * error, "{method:?}: {error:e} and {error_kept:e}");
        assert!(radius_kept < radius, "{method:?}: {radius:e} and {radius_kept:e}");
        // Between the steps the radius is off by the error of the interpolation within one step only.
        assert!(radius_kept < 10.0 * tolerance, "{method:?}: {radius_kept:e}");
        assert!(off_circle(&kept, 100.0) < 4e-16);
        assert!(kept.work.steps as f64 <= 1.1 * free.work.steps as f64, "{method:?}");
        let report = kept.projection;
        assert_eq!(report.projections, kept.work.steps);
        assert!(report.largest > 0.0 && report.largest <= report.total, "{method:?} {report:?}");
        assert_eq!(free.projection, Default::default());
    }
}

#[test]
fn projection_holds_what_would_run_away() {
    // A turn with radial instability, (r − 1)' = 2 (r − 1): without projection an error grows like exp(2t),
    // e⁴⁰ at t = 20. Bdf, too, then has to restart from projected states.
    let case = Case::new(2, |_, y| {
        let radius = (&(&y[0] * &y[0]) + &(&y[1] * &y[1])).powf(-0.5);
        let push = &(&radius.number(1.0) - &radius) * 2.0;
        vec![&y[1] + &(&push * &y[0]), &(&push * &y[1]) - &y[0]]
    })
    .with_projection(onto_circle);
    for method in EVERY {
        let options = Options { method, ..Options::with_tolerance(1e-7) };
        let solution = run(&mut case.clone(), 0.0, &[1.0, 0.0], 20.0, &options);
        let error = distance(solution.dense.end_state(), &circle(20.0));
        assert!(error < 1e-3, "{method:?}: {error:e}");
        assert!(solution.projection.largest < 1e-2, "{method:?} {:?}", solution.projection);
    }
}

#[test]
fn radau_is_exact_where_the_slow_manifold_is_not_left() {
    // Prothero and Robinson: y' = λ (y − cos t) − sin t, from 1: cos t. Order reduction is below 1/|λ|
    for stiffness in [1e2, 1e6, 1e10] {
        let mut case = Case::new(1, move |t, y| vec![&(&(&y[0] - &t.cos()) * -stiffness) - &t.sin()]);
        let options = Options { method: Method::Radau5, ..Options::with_tolerance(1e-8) };
        let solution = run(&mut case, 0.0, &[1.0], 10.0, &options);
        let error = (solution.dense.end_state()[0] - 10f64.cos()).abs();
        assert!(error < 1e-8, "λ = -{stiffness:e}: {error:e}");
        // the method does not estimate what is stiff: between the steps the polynomial has to be good enough
        let between = largest_error(&solution, 10_000, |t| [t.cos()]);
        assert!(between < 1e-7, "λ = -{stiffness:e}: {between:e}");
        assert!(solution.work.steps < 2000, "λ = -{stiffness:e}: {:?}", solution.work);
    }
}

/// A velocity `(v₁, v₂)` with strong friction across a direction that turns with the state's own angle `θ`:
///
/// ```text
/// θ' = 1,   v' = d/dθ (r d) − N n (n·v),   d = (cos θ, sin θ),   n = (−sin θ, cos θ),   r = 1 + ½ sin 2θ
/// ```
///
/// from `d` at `θ = 0`, whatever `N`: `v = r d`.
fn turning(strength: f64) -> Case {
    Case::new(3, move |_, y| {
        let (s, c) = y[0].sin_cos();
        let (sine, slope) = (&y[0] * 2.0).sin_cos();
        let r = &s.number(1.0) + &(&sine * 0.5);
        let push = &(&(&c * &y[2]) - &(&s * &y[1])) * strength;
        let along = |a: &Jet, b: &Jet| &(&slope * a) + &(&r * b);
        vec![s.number(1.0), &along(&c, &-&s) + &(&push * &s), &along(&s, &c) - &(&push * &c)]
    })
}

#[test]
fn a_stiff_direction_that_turns_is_stepped_over() {
    // with one Jacobian for all stages, at 1e-7: 826 steps at N = 1e4, 33 000 at 1e10, and more failed tries
    for (tolerance, most) in [(1e-5, 150), (1e-7, 350), (1e-9, 1000)] {
        for strength in [1e2, 1e4, 1e6, 1e8, 1e10] {
            let options = Options { method: Method::Radau5, ..Options::with_tolerance(tolerance) };
            let solution = run(&mut turning(strength), 0.0, &[0.0, 1.0, 0.0], 10.0, &options);
            let error = largest_error(&solution, 1000, |t| {
                let r = 1.0 + 0.5 * (2.0 * t).sin();
                [t, r * t.cos(), r * t.sin()]
            });
            let work = solution.work;
            assert!(error < 10.0 * tolerance, "N = {strength:e}, tolerance {tolerance:e}: error {error:e}");
            assert!(work.steps + work.rejected < most, "N = {strength:e}, tolerance {tolerance:e}: {work:?}");
        }
    }
}
