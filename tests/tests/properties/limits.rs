//! Each limit of a claim from both sides: what is off by three tenths of it is let pass, by three times not.
//!
//! A particle whose `x` is free, or on a spring, and whose `y` is held is off by what is put into its
//! motions, in closed form. Limits are written out here; those of an integrated motion are ten times what
//! its two runs differ by.

mod errors;

use std::cell::Cell;

use equations::Formulation;
use integrate::Method;
use mechanics::ConstantsRule;
use motion::{CHETAEV, Choice, Metric, Motion, REMOVED_CONSTRAINT, Settings, VAKONOMIC, choices, solve_choice};
use random::{CHECKS, Case, Classes, Fault, Finding, Kind, NullTest, Removed, Word, draw_recipe, make, null_test};
use scene::Scene;

/// Parts of a limit, and what is said there.
const SIDES: [(f64, Word); 2] = [(0.3, Word::Holds), (3.0, Word::Fails)];

/// `L = (x'² − spring x² + y'²)/2 + more` and `y' = slip`, from x = 0 and x' = 1 up to t = 2.
fn particle(spring: f64, more: &str, slip: f64) -> Scene {
    let text = format!(
        "title = \"held\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\n\
         lagrangian = \"(x'^2 + y'^2)/2{}{more}\"\nconstraints = [\"y'{}\"]\n[start.velocities]\n\"x'\" = 1\n\
         [run]\nduration = 2\n",
        if spring > 0.0 { format!(" - {spring:?}*x^2/2") } else { String::new() },
        if slip > 0.0 { format!(" - {slip:?}") } else { String::new() },
    );
    Scene::parse("held", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// Runs that are exact but for round-off, and runs that differ by 10⁻⁷ or so.
fn exact() -> Settings {
    Settings::default()
}

fn loose() -> Settings {
    Settings { tolerance: 1e-6, method: Some(Method::Dop853), ..Settings::default() }
}

fn choice(scene: &Scene, formulation: &'static Formulation) -> Choice {
    choices(scene).into_iter().find(|choice| choice.formulation == formulation).expect("a choice")
}

fn motion(scene: &Scene, formulation: &'static Formulation, settings: &Settings) -> Motion {
    solve_choice(scene, &choice(scene, formulation), settings).unwrap_or_else(|e| panic!("{e}"))
}

/// A case of this scene with nothing but what is put into it.
fn case(scene: &Scene) -> Case {
    let mut case = Case::new(draw_recipe(1, 0, &[Kind::Linear]), "limits").unwrap_or_else(|e| panic!("{e}"));
    case.recipe.drawn = Classes::default();
    (case.removed, case.control, case.floor) = (Vec::new(), None, 0.0);
    case.metric = Metric::new(&scene.system).expect("a metric");
    (case.chetaev, case.vakonomic) = (motion(scene, CHETAEV, &exact()), motion(scene, VAKONOMIC, &exact()));
    case.scene = scene.clone();
    case
}

/// What is said of a claim.
fn found(mut case: Case, theorem: u8, claim: &str) -> Finding {
    CHECKS.iter().filter(|check| check.theorem == theorem).for_each(|check| make(check, &mut case));
    let found = case.found.findings.iter().find(|f| f.claim == claim);
    found.unwrap_or_else(|| panic!("T{theorem} {claim}: not made: {:?}", case.found.findings)).clone()
}

/// What is counted or measured beside a claim.
fn observed(mut case: Case, theorem: u8, what: &str) -> Option<f64> {
    CHECKS.iter().filter(|check| check.theorem == theorem).for_each(|check| make(check, &mut case));
    case.found.observations.iter().find(|o| o.what == what).map(|o| o.value)
}

/// Compares findings for errors below and above `limit` with the expected words.
fn on_both_sides(what: &str, limit: f64, found: impl Fn(f64) -> Finding) {
    for (part, word) in SIDES {
        let f = found(part * limit);
        println!("{what}: {:.2e}, limit {:.2e}, known {limit:.2e}", f.figure, f.limit);
        assert_eq!(f.word, word, "{what}, {part} of {limit:e}: {f:?}");
        assert!(f.figure.is_nan() || (f.figure / (part * limit) - 1.0).abs() < 0.15, "{what}, {part}: {f:?}");
    }
}

/// Ten times what the two runs of a motion differ by in something, at most.
fn ten_times(motion: &mut Motion, instants: usize, value: impl Fn(f64, f64) -> f64) -> f64 {
    let times = motion.grid(instants);
    let apart = times.into_iter().map(|t| {
        let (kept, looser) = motion.at_in_both_runs(t).expect("in range");
        let of = |o: &equations::Outputs| value(o.coordinates[0], o.velocities[0]);
        (of(&kept) - of(&looser)).abs()
    });
    10.0 * apart.fold(0.0, f64::max)
}

#[test]
fn chetaevs_motion_and_maggis() {
    let claim = "Chetaev: multipliers and Maggi's equations";
    // a push p moves a free particle by p t²/2, one on a spring by p (1 − cos t)
    for (spring, moved, settings) in [(0.0, 2.0, exact()), (1.0, 1.0 - 2_f64.cos(), loose())] {
        for floor in [0.0, 1e-5] {
            let scene = particle(spring, "", 0.0);
            let apart = ten_times(&mut motion(&scene, CHETAEV, &settings), 12, |x, _| x);
            let size = if spring > 0.0 { 1.0 } else { 2.0 };
            on_both_sides(claim, apart + 1e-12 * size + floor, |off| {
                let mut case = case(&scene);
                case.floor = floor;
                let pushed = particle(spring, &format!(" + {:?}*x", off / moved), 0.0);
                case.chetaev = motion(&pushed, CHETAEV, &settings);
                found(case, 0, claim)
            });
        }
    }
}

#[test]
fn the_constraint_is_kept() {
    let claim = "the constraint is kept";
    for (spring, settings) in [(0.0, exact()), (1.0, loose())] {
        let scene = particle(spring, "", 0.0);
        let apart = ten_times(&mut motion(&scene, CHETAEV, &settings), 12, |_, v| v);
        on_both_sides(claim, apart + 1e-13, |off| {
            let mut case = case(&scene);
            case.chetaev = motion(&particle(spring, "", off), CHETAEV, &settings);
            found(case, 0, claim)
        });
    }
}

/// Of a push `p`, energy changes by `p x`.
#[test]
fn energy_and_momentum() {
    let pushed = |spring: f64, push: f64| particle(spring, &format!(" + {push:?}*x"), 0.0);
    for (spring, way, settings) in [(0.0, 2.0, exact()), (1.0, 1.0, loose())] {
        let scene = particle(spring, "", 0.0);
        let energy = |x: f64, v: f64| 0.5 * (v * v + spring * x * x);
        let apart = ten_times(&mut motion(&scene, CHETAEV, &settings), 24, energy);
        on_both_sides("Chetaev: energy", apart + 1e-12, |off| {
            let mut case = case(&scene);
            case.floor = 1e-3;
            case.chetaev = motion(&pushed(spring, off / way), CHETAEV, &settings);
            found(case, 6, "Chetaev: energy")
        });
        for floor in [0.0, 1e-5] {
            on_both_sides("vakonomic: energy", apart + 1e-12 + floor, |off| {
                let mut case = case(&scene);
                case.floor = floor;
                case.vakonomic = motion(&pushed(spring, off / way), VAKONOMIC, &settings);
                found(case, 6, "vakonomic: energy")
            });
            on_both_sides("removed constraint: energy", apart + 1e-12 + floor, |off| {
                let mut case = case(&scene);
                case.floor = floor;
                let removal = choice(&scene, REMOVED_CONSTRAINT).removal.expect("a removal");
                let costates = vec![0.0; removal.memory.len()];
                let motion = motion(&pushed(spring, off / way), REMOVED_CONSTRAINT, &settings);
                case.removed.push(Removed { removal, costates, motion });
                found(case, 6, "removed constraint: energy")
            });
        }
    }
    // and the momentum by p t
    let (scene, claim) = (particle(0.0, "", 0.0), "vakonomic: momentum of a cyclic coordinate");
    on_both_sides(claim, 1e-12, |off| {
        let mut case = case(&scene);
        case.vakonomic = motion(&pushed(0.0, off / 2.0), VAKONOMIC, &exact());
        found(case, 7, claim)
    });
}

/// The natural costate at the start.
fn natural(scene: &Scene) -> f64 {
    let rule = ConstantsRule::Natural { horizon: 2.0 };
    let choice = Choice { constants: rule, ..choice(scene, REMOVED_CONSTRAINT) };
    let [natural] = solve_choice(scene, &choice, &exact()).expect("a motion").constants[..] else { panic!("not one") };
    natural
}

/// A case whose natural costate is said to be this one at the start, in a motion integrated like that.
fn said_natural(scene: &Scene, costate: f64, settings: &Settings) -> Case {
    let mut case = case(scene);
    case.recipe.drawn.natural = true;
    let choice = Choice { constants: ConstantsRule::Given(vec![costate]), ..choice(scene, REMOVED_CONSTRAINT) };
    let motion = solve_choice(scene, &choice, settings).expect("a motion");
    case.natural = Some(motion.clone());
    case.removed.push(Removed { removal: choice.removal.expect("a removal"), costates: vec![0.0], motion });
    case
}

/// `P' = 1` in a run of 2: the natural start is −2, and a start that is off by a part leaves that part. Of
/// `P' = cos t` it is −sin 2, and runs are not exact.
#[test]
fn natural_costates_vanish() {
    let claim = "natural costates vanish at the horizon";
    let even = particle(0.0, " - y", 0.0);
    let costate = natural(&even);
    assert!((costate.abs() - 2.0).abs() < 1e-9, "{costate}");
    on_both_sides(claim, 1e-9, |off| found(said_natural(&even, costate * (1.0 + off), &exact()), 0, claim));
    let bent = particle(0.0, " - y*cos(x)", 0.0);
    let costate = natural(&bent);
    assert!((costate.abs() - 2_f64.sin()).abs() < 1e-9, "{costate}");
    let mut motion = said_natural(&bent, costate, &loose()).natural.expect("a motion");
    let (kept, looser) = motion.at_in_both_runs(2.0).expect("the end");
    let apart = kept.multipliers.iter().zip(&looser.multipliers).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    on_both_sides(claim, 10.0 * (1e-10 + apart), |off| found(said_natural(&bent, costate + off, &loose()), 0, claim));
    // one that is 10⁻¹³ of what momentum there is, twice what is natural: `4 w` in a run of 2
    for (part, word) in [(0.3, Word::Holds), (3.0, Word::Fails)] {
        let rate = part * 1e-13 / 4.0;
        let faint = particle(0.0, &format!(" - {rate:e}*y"), 0.0);
        let found = found(said_natural(&faint, 2.0 * rate * natural(&even), &exact()), 0, claim);
        assert_eq!(found.word, word, "{part}: {found:?}");
    }
}

#[test]
fn natural_constants_are_the_same_up_to_a_millionth() {
    let scene = particle(0.0, " - y", 0.0);
    for (part, _) in SIDES {
        let case = said_natural(&scene, natural(&scene) * (1.0 + part * 1e-6), &exact());
        let alike = observed(case, 0, "natural constants in other units are the same");
        assert_eq!(alike, Some(if part < 1.0 { 1.0 } else { 0.0 }), "{part}");
    }
}

/// The multiplier of Heisenberg's system, with `y' = 0` and `x = ½` at the start.
const MULTIPLIER: f64 = 0.75;

fn heisenberg(more: &str) -> Scene {
    let text = format!(
        "title = \"Heisenberg\"\ncoordinates = {{ x = {{ start = 0.5 }}, y = {{ start = 0 }}, z = {{ start = 0 }} }}\n\
         system.lagrangian = \"(x'^2 + y'^2)/2{more}\"\nsystem.constraints = [\"z' - (x*y' - y*x')/2\"]\n\
         start.velocities = {{ \"x'\" = 1, \"y'\" = 0 }}\nvakonomic.multipliers = [{MULTIPLIER}]\nrun.duration = 2\n"
    );
    Scene::parse("heisenberg", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// The leading term is the multiplier times something; `c t^δ` in the place of a force makes `t^{2+δ}`.
#[test]
fn the_leading_divergence() {
    let scene = heisenberg("");
    let claim = "coefficient of the leading divergence";
    on_both_sides(claim, 1e-2, |off| {
        let mut case = case(&scene);
        case.scene.multipliers = vec![MULTIPLIER / (1.0 - off)];
        found(case, 5, claim)
    });
    // a multiplier μ makes μ t²/2, which is looked at from 10⁻⁵ on
    for (part, _) in SIDES {
        let mut case = case(&scene);
        case.scene.multipliers = vec![part * 1e-5 / 2.0];
        CHECKS.iter().filter(|check| check.theorem == 5).for_each(|check| make(check, &mut case));
        assert_eq!(case.found.findings.is_empty(), part < 1.0, "{part}: {:?}", case.found.findings);
    }
    let claim = "exponent of the leading divergence";
    on_both_sides(claim, 1e-2, |off| {
        let mut case = case(&scene);
        case.vakonomic = motion(&heisenberg(&format!(" + x*(t + 1e-7)^{off:?}")), CHETAEV, &exact());
        found(case, 5, claim)
    });
}

thread_local! {
    /// How much is put into the null tests.
    static PULL: Cell<f64> = const { Cell::new(0.0) };
}

fn pulled(scene: &mut Scene) {
    let system = &mut scene.system;
    let (g, q) = (&system.graph, system.positions());
    let pull: Vec<_> = q.iter().map(|&q| g.mul(g.number(PULL.get()), g.variable(q))).collect();
    system.lagrangian = g.add(system.lagrangian, g.sum(&pull));
}

/// Distances from a closed form, by a pull to which they are proportional.
#[test]
fn null_tests_are_held_to_a_thousand_millionth_of_the_way() {
    let numbers =
        NullTest { appell: [1.0, 9.81, 0.5, 0.3, 4.0, 0.5], heisenberg: [0.6, 0.8, 1.5], disc: [0.4, 2.0, 0.75] };
    let findings = |pull: f64| {
        PULL.set(pull);
        null_test(&numbers, &Fault { null: pulled, ..Fault::NONE }).unwrap_or_else(|e| panic!("{e}")).findings
    };
    let slopes = findings(1e-6).into_iter().filter(|f| f.figure.is_finite()).map(|f| (f.claim, f.figure / 1e-6));
    let slopes: Vec<(&str, f64)> = slopes.collect();
    assert_eq!(slopes.len(), 6);
    for (claim, slope) in slopes {
        let of_claim = |f: &Finding| f.claim == claim;
        on_both_sides(claim, 1e-9, |off| findings(off / slope).into_iter().find(of_claim).expect("the claim"));
    }
}

/// Without multipliers the disc does not roll uniformly, by as much as its centre has inertia.
#[test]
fn a_disc_is_off_from_a_millionth_of_the_way_on() {
    fn light(scene: &mut Scene) {
        let system = &mut scene.system;
        // of the other two nothing is asked here, and without inertia they would turn ever faster
        if system.dimension() != 4 {
            return;
        }
        let (g, v) = (&system.graph, system.velocities());
        let square = g.dot(&g.variables(&v[..2]), &g.variables(&v[..2]));
        system.lagrangian = g.sub(system.lagrangian, g.mul(g.number(0.5 * (1.0 - PULL.get())), square));
    }
    let numbers =
        NullTest { appell: [1.0, 9.81, 0.5, 0.3, 4.0, 0.5], heisenberg: [0.6, 0.8, 1.5], disc: [0.4, 2.0, 0.75] };
    let found = |inertia: f64| {
        PULL.set(inertia);
        let all = null_test(&numbers, &Fault { null: light, ..Fault::NONE }).unwrap_or_else(|e| panic!("{e}"));
        all.findings.into_iter().find(|f| f.claim == "disc: zero multipliers do not").expect("the claim")
    };
    let distance = |f: &Finding| f.note.trim_start_matches("distance ").parse::<f64>().expect("a number");
    let slope = distance(&found(1e-3)) / 1e-3;
    for (part, word) in [(0.3, Word::Fails), (3.0, Word::Holds)] {
        let f = found(part * 1e-6 / slope);
        assert!(f.word == word && (distance(&f) / (part * 1e-6) - 1.0).abs() < 0.15, "{part}: {f:?}");
    }
}
