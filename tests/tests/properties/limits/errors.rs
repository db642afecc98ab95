//! Limits of claims on motions: their error estimates, or the distance below which two motions cannot be
//! distinguished.

use comparison::{Gap, compare_motions, growth};
use motion::{CHETAEV, Metric, Motion, Settings, VAKONOMIC};
use random::{CHECKS, Finding, FoundOut, Which, Word, found_out, make, referee};
use scene::Scene;

use super::{SIDES, case, exact, found, loose, motion, observed, on_both_sides, particle, ten_times};

/// What is said of a control whose gap to Chetaev's motion is this.
fn judged(scene: &Scene, control: &mut Motion, gap: &Gap, floor: f64) -> FoundOut {
    let (setting, mut metric) = (motion::setting(scene), Metric::new(&scene.system).expect("a metric"));
    let mut referee = referee(setting).unwrap_or_else(|e| panic!("{e}"));
    found_out(setting, control, gap, &mut referee, &mut metric, floor).unwrap_or_else(|e| panic!("{e}"))
}

/// A push `p` leaves `p/√2` of Maggi's equations, whose masses are 1 and 1.
#[test]
fn the_control_is_right_or_wrong_by_maggis_residual() {
    let scene = particle(0.0, "", 0.0);
    let mut metric = Metric::new(&scene.system).expect("a metric");
    for (limit, is_right) in [(1e-12, true), (1e-6, false)] {
        for (part, _) in SIDES {
            let residual = part * limit;
            let pushed = particle(0.0, &format!(" + {:?}*x", residual * 2_f64.sqrt()), 0.0);
            let (mut chetaev, mut control) = (motion(&scene, CHETAEV, &exact()), motion(&pushed, CHETAEV, &exact()));
            let gap = compare_motions(&mut chetaev, &mut control, &mut metric).expect("a gap");
            let found = judged(&scene, &mut control, &gap, 0.0);
            assert!((found.residual / residual - 1.0).abs() < 0.3, "{residual:e}: {found:?}");
            let said = if is_right { found.is_right() } else { !found.is_wrong() };
            assert_eq!(said, part < 1.0, "{found:?}");
        }
    }
}

/// A control that is neither right nor wrong by its residual is open once it is off from Maggi's motion by
/// ten times what its runs differ by, where no gap would flag it. The push comes late: errors come first.
#[test]
fn the_control_is_apart_by_ten_times_its_error() {
    for (power, floor, tolerance) in [(8, 0.0, 1e-10), (0, 1e-7, 1e-12)] {
        let pushed = |push: f64| particle(1.0, &format!(" + {push:?}*x*t^{power}"), 0.0);
        let (scene, settings) = (pushed(0.0), Settings { tolerance, ..loose() });
        let mut metric = Metric::new(&scene.system).expect("a metric");
        let [mut chetaev, mut far] = [0.0, 1.0].map(|push| motion(&pushed(push), CHETAEV, &exact()));
        let [near, far] = [&mut chetaev, &mut far].map(|motion| motion.at(2.0).expect("the end").coordinates[0]);
        let mut unseen = compare_motions(&mut chetaev.clone(), &mut chetaev, &mut metric).expect("a gap");
        unseen.points.iter_mut().for_each(|p| p.limit = 1.0);
        let apart = ten_times(&mut motion(&scene, CHETAEV, &settings), 40, |x, _| x);
        for (part, _) in SIDES {
            let push = part * (apart + floor) / (far - near);
            let found = judged(&scene, &mut motion(&pushed(push), CHETAEV, &settings), &unseen, floor);
            assert!(!found.is_right() && !found.is_wrong(), "{found:?}");
            assert_eq!(found.word, (part > 1.0).then_some(Word::Undecided), "{part}, {floor}: {found:?}");
        }
    }
}

/// `x'' = −4 x'`, with a push more or none: what is off in `x'` at the end of the run moves `x` by 745 times
/// of it on the way back.
#[test]
fn the_way_back_is_off_by_ten_times_what_both_runs_come_back_with() {
    let rubbed = |push: f64| {
        let text = format!(
            "title = \"rubbed\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\n\
             lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'\"]\nforces = {{ x = \"{push:?} - 4*x'\" }}\n\
             [start.velocities]\n\"x'\" = 1\n[run]\nduration = 2\n"
        );
        Scene::parse("rubbed", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
    };
    let scene = rubbed(0.0);
    let (kept, looser) = motion(&scene, CHETAEV, &loose()).at_in_both_runs(2.0).expect("the end");
    let grown = 8_f64.exp();
    let back = (kept.coordinates[0] - looser.coordinates[0])
        + (kept.velocities[0] - looser.velocities[0]) * (grown - 1.0) / 4.0;
    let claim = "Chetaev runs back the way it came";
    on_both_sides(claim, 10.0 * back.abs(), |off| {
        let mut case = case(&scene);
        case.chetaev = motion(&rubbed(off * 16.0 / (grown - 9.0)), CHETAEV, &loose());
        found(case, 10, claim)
    });
}

/// `y' = a + (1 − a) (t − 1)²`, as the square that it is of: half-way `∂f/∂y'` is a part `a` of what it was.
#[test]
fn constraints_are_compared_until_a_thousandth_of_their_rank_is_left() {
    for (part, _) in SIDES {
        let least = part * 1e-3;
        let text = format!(
            "title = \"slow\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\n\
             lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'^2 - ({least:?} + {:?}*(t - 1)^2)^2\"]\n\
             [start.velocities]\n\"x'\" = 1\n\"y'\" = 1\n[run]\nduration = 2\n",
            1.0 - least
        );
        let mut case = case(&Scene::parse("slow", &text).unwrap_or_else(|e| panic!("{text}: {e}")));
        CHECKS.iter().filter(|check| check.theorem == 0).for_each(|check| make(check, &mut case));
        let claim = "Chetaev: multipliers and Maggi's equations";
        let found: Vec<&Finding> = case.found.findings.iter().filter(|f| f.claim == claim).collect();
        assert_eq!(found[0].word, Word::Holds, "{part}: {found:?}");
        let ended = found.iter().any(|f| f.note == "from t = 1.0000 on, the constraints nearly lose rank");
        assert_eq!(ended, part < 1.0, "{part}: {found:?}");
    }
}

/// Of a push that changes within the range of the fit the exponent is uncertain, the more so where it turns
/// back.
#[test]
fn exponents_are_counted_that_are_certain_to_a_tenth() {
    let scene = particle(0.0, "", 0.0);
    let mut seen = [0, 0];
    for bend in [-2.0, -10.0, -60.0] {
        let mut case = case(&scene);
        case.vakonomic = motion(&particle(0.0, &format!(" + 1e-8*(1 + ({bend:?})*t^2)*x"), 0.0), VAKONOMIC, &exact());
        let gap = case.gap(Which::Chetaev, Which::Vakonomic).expect("a gap");
        let limit = |t: f64| gap.limit_at(t);
        let grown = growth(&mut case.vakonomic.clone(), &mut case.chetaev, &mut case.metric, &limit).expect("a fit");
        let uncertain = grown.expect("stands out").uncertainty;
        let counted = observed(case, 1, "growth exponent, vakonomic and Chetaev").is_some();
        assert_eq!(counted, uncertain < 0.1, "{bend}: {uncertain}");
        seen[usize::from(counted)] += usize::from((0.01..1.0).contains(&uncertain));
    }
    assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
}
