//! What round-off of rates adds up to in states.

use equations::Compiled;
use motion::parts::{Looked, RoundOff, is_small, largest, look, round_off};
use motion::{choices, derive_at};
use scene::Scene;

const EPS: f64 = f64::EPSILON;

/// Two instants a time 1 apart at which a state is 1, with this much added up to its rate at both.
fn looked(terms: f64) -> [Looked; 2] {
    [0.0, 1.0].map(|t| (t, vec![1.0], vec![terms]))
}

#[test]
fn round_off_is_small_up_to_256_last_digits_and_to_four_times_what_the_runs_differ_by() {
    for (apart, size, between, limit) in
        [(0.0, 1.0, 1.0, 256.0), (0.0, 3.0, 1.0, 768.0), (0.0, 1.0, 8.0, 32.0), (100.0, 1.0, 1.0, 400.0)]
    {
        let looser = [vec![1.0], vec![1.0 + apart * EPS]];
        let small = |terms: f64| is_small(&looked(terms), &looser, &[size], between);
        assert!(small(0.98 * limit) && !small(1.02 * limit), "{apart}, {size}, {between}");
    }
}

#[test]
fn a_state_is_as_large_as_it_was_at_any_instant() {
    let looked = [(0.0, vec![-3.0, 0.5]), (1.0, vec![2.0, 0.25])].map(|(t, y)| (t, y, vec![0.0; 2]));
    assert_eq!(largest(&looked, vec![1.0; 2]), [3.0, 1.0]);
}

/// `x'' = √(x − 1)` at x = 1: the sum of terms behind the velocity's rate is not finite.
#[test]
fn an_infinite_slope_tells_nothing() {
    let text = "title = \"free\"\n[coordinates]\nx = { start = 1 }\n[system]\nlagrangian = \"x'^2/2\"\n\
                forces = { x = \"sqrt(x - 1)\" }\n[start.velocities]\n\"x'\" = 2\n[run]\nduration = 2\n";
    let scene = Scene::parse("free", text).unwrap_or_else(|e| panic!("{e}"));
    let equations = derive_at(&scene.system, &scene.start, &choices(&scene)[0]).expect("equations");
    let mut compiled = Compiled::new(&equations).expect("compiled");
    let raw = compiled.terms_of_rates(0.0, &[1.0, 2.0]).expect("terms");
    assert!(raw[0] == 2.0 && !raw[1].is_finite(), "{raw:?}");
    let (_, y, terms) = look(&mut compiled, 0.0, &[1.0, 2.0]).expect("a look");
    assert_eq!((y, terms), (vec![1.0, 2.0], vec![2.0, 0.0]));
}

/// A particle at speed 2 under this force, at these times and places, with this sum of terms behind a
/// rate; the looser run differs by `apart` from the second instant on.
fn of_a_motion(force: &str, looked: [[f64; 3]; 3], apart: f64) -> RoundOff {
    let text = format!(
        "title = \"free\"\n[coordinates]\nx = {{ start = 0 }}\n[system]\nlagrangian = \"x'^2/2\"\n\
         forces = {{ x = \"{force}\" }}\n[start.velocities]\n\"x'\" = 2\n[run]\nduration = 2\n"
    );
    let scene = Scene::parse("free", &text).unwrap_or_else(|e| panic!("{e}"));
    let equations = derive_at(&scene.system, &scene.start, &choices(&scene)[0]).expect("equations");
    let mut compiled = Compiled::new(&equations).expect("compiled");
    let own = usize::from(force != "0");
    let terms = |terms: f64| if own == 0 { vec![terms, 0.0] } else { vec![0.0, terms] };
    let states: Vec<Looked> = looked.map(|[t, x, added]| (t, vec![x, 2.0], terms(added))).into();
    let mut looser: Vec<Vec<f64>> = states.iter().map(|(_, y, _)| y.clone()).collect();
    looser.iter_mut().skip(1).for_each(|y| y[own] += apart);
    let names = || equations.states.iter().map(|state| equations.graph.name(state.symbol)).collect();
    let mut rates = |t: f64, y: &[f64], rates: &mut [f64]| compiled.rates(t, y, rates).is_ok();
    round_off(&mut rates, &names, &states, &looser, &[1.0, 2.0])
}

/// A free particle at speed 2, where this much is added up to the rate of its place in each of two times
/// 1, and the looser run is this much apart at the end of both.
fn of_a_particle(terms: f64, apart: f64) -> RoundOff {
    of_a_motion("0", [0.0, 1.0, 2.0].map(|t| [t, 2.0 * t, terms]), apart)
}

/// `d` and `η` of the place.
fn of_the_place(looked: [[f64; 3]; 3], apart: f64) -> [f64; 2] {
    let RoundOff::Counts(found) = of_a_motion("0", looked, apart) else { panic!("{looked:?}") };
    [found[0], found[2]]
}

fn assert_near(found: [f64; 2], known: [f64; 2]) {
    let near = found.iter().zip(known).all(|(found, known)| (found - known).abs() <= 1e-12 * known.abs());
    assert!(near, "{found:?}, {known:?}");
}

#[test]
fn round_off_is_doubted_over_a_millionth_of_a_state_and_ten_times_what_the_runs_differ_by() {
    // 2 ε terms within a time of 2
    let of = |sum: f64| 0.5 * sum / EPS;
    for (apart, limit) in [(0.0, 1e-6), (9e-7, 9e-6), (-9e-7, 9e-6)] {
        let RoundOff::Doubted(doubt) = of_a_particle(of(1.02 * limit), apart) else { panic!("over {limit:e}") };
        assert_eq!(doubt.from, 1.0);
        assert!(doubt.because.contains("the rate of x is a difference of larger terms"), "{}", doubt.because);
        assert!(matches!(of_a_particle(of(0.98 * limit), apart), RoundOff::Counts(_)), "{limit:e}");
    }
}

/// `d = ± ε/2` of what is added up to the rate, and `η` its part of the rate, to that side where the
/// looser run is.
#[test]
fn what_counts_is_half_a_last_digit_of_what_is_added_up() {
    for (apart, sign) in [(1e-9, 1.0), (-1e-9, -1.0)] {
        let RoundOff::Counts(found) = of_a_particle(1e8, apart) else { panic!("{apart}") };
        let d = sign * 0.5 * EPS * 1e8;
        for (found, known) in found.iter().zip([d, 0.0, 0.5 * d, 0.0]) {
            assert!((found - known).abs() <= 1e-12 * known.abs(), "{found:e}, {known:e}");
        }
    }
}

/// Backwards, a rate of 2 goes to the other side, and the looser run is where a rate of `−d` brings it.
#[test]
fn what_counts_backwards_goes_to_the_side_of_the_looser_run() {
    let d = 0.5 * EPS * 1e8;
    let found = of_the_place([2.0, 1.0, 0.0].map(|t| [t, 2.0 * t, 1e8]), 1e-9);
    assert_near(found, [-d, -0.5 * d]);
}

#[test]
fn what_counts_is_the_largest_mean_and_a_part_of_the_largest_rate() {
    let d = 0.5 * EPS * 1e8;
    // nothing is added up at last
    let found = of_the_place([[0.0, 0.0, 1e8], [1.0, 2.0, 1e8], [2.0, 4.0, 0.0]], 1e-9);
    assert_near(found, [d, 0.5 * d]);
    // a pulse of 6 between two instants
    let found = of_the_place([[0.0, 0.0, 1e8], [1.0, 6.0, 1e8], [2.0, 8.0, 1e8]], 1e-9);
    assert_near(found, [d, d / 6.0]);
}

/// `v' = −λ v` holds `ε s/λ` of what is added up, and backwards all of it: `2 ε s`.
#[test]
fn what_decays_is_held_for_a_while_and_only_forwards() {
    const RATE: f64 = 50.0;
    let drag = format!("-{RATE}*x'");
    let of = |times: [f64; 3], terms: f64| of_a_motion(&drag, times.map(|t| [t, 0.0, terms]), 0.0);
    let forwards = |terms: f64| of([0.0, 1.0, 2.0], terms);
    let limit = 2.0 * 256.0 * RATE;
    assert!(matches!(forwards(0.98 * limit), RoundOff::Small) && matches!(forwards(1.02 * limit), RoundOff::Counts(_)));
    assert!(matches!(of([2.0, 1.0, 0.0], 0.1 * limit), RoundOff::Counts(_)));
    // a slope that is lost in round-off is no decay: 2 ε s is over a millionth of 2
    assert!(matches!(forwards(5e9), RoundOff::Doubted(_)));
}
