//! The referee in Python: it must run, agree where we are right, and disagree where we are not.

use motion::{CHETAEV, VAKONOMIC};
use random::{Batch, Kind, draw_recipe};
use scene::Scene;
use validation::casadi_job::{Amount, Outcome, Question, Row, Word, ask, built_in, forced, pushed, random};

const FEW: Amount = Amount { states: 50, times: 5 };

#[track_caller]
fn rows(questions: &[Question]) -> Vec<Row> {
    match ask(questions).expect("an answer that can be read") {
        Outcome::Ran(rows) => rows,
        Outcome::NotRun(reason) => panic!("the referee has to run here: {reason}"),
    }
}

#[test]
fn the_referee_agrees() {
    let scenes = ["sledge", "particle", "appell-hamel"];
    let mut questions: Vec<Question> = scenes.iter().map(|name| built_in(name, FEW).expect(name)).collect();
    questions.extend((0..5).map(|index| random(index, Amount { states: 20, times: 0 }).expect("a random system")));
    let rows = rows(&questions);
    for row in &rows {
        assert_eq!(row.verdict, Word::Agrees, "{row:?}");
    }
    let of = |who: &str| rows.iter().filter(|row| row.who == who).count();
    assert!(of("CasADi") >= 14 && of("CVODES") >= 9 && of("transcription") >= 6 && of("SymPy") == 3, "{rows:?}");
    for scene in scenes.map(String::from).into_iter().chain((0..5).map(|i| format!("random-1-{i}"))) {
        assert!(rows.iter().any(|row| row.scene == scene && row.who == "CasADi"), "{scene}");
    }
}

#[test]
fn the_referee_agrees_where_forces_act_in_every_formulation() {
    let scenes: Vec<(Scene, String)> =
        forced().into_iter().map(|(name, text)| (Scene::parse(&name, &text).expect("a scene"), text)).collect();
    let questions = scenes.iter().map(|(scene, text)| pushed(&scene.name, text, FEW.states).expect("questions"));
    let rows = rows(&questions.collect::<Vec<_>>());
    for row in &rows {
        assert_eq!(row.verdict, Word::Agrees, "{row:?}");
    }
    let derived = || rows.iter().filter(|row| row.who == "CasADi");
    let worst = derived().filter_map(|row| row.largest).fold(0.0, f64::max);
    println!("{} comparisons of rates, largest difference {worst:.1e}", derived().count());
    assert!(worst < 1e-12, "{worst:.1e}");
    // four vakonomic curves with their multipliers, and those of removals
    let transcribed = rows.iter().filter(|row| row.who == "transcription").count();
    assert!(transcribed >= 14, "{rows:?}");
    for (scene, _) in &scenes {
        for formulation in ["Chetaev", "vakonomic", "removed constraint"] {
            let named = |row: &&Row| row.scene == scene.name && row.what.starts_with(formulation);
            assert!(derived().any(|row| named(&row)), "{}, {formulation}", scene.name);
        }
    }
}

#[test]
fn a_force_that_does_no_virtual_work_is_found() {
    let (name, text) = forced().swap_remove(0);
    let scene = Scene::parse(&name, &text).expect("a scene");
    let mut question = Question::new(&scene, &scene.without_bodies(&text), FEW).expect("questions");
    let forgotten = |equations: &mut equations::Equations| {
        for (residual, &force) in equations.blocks[0].residuals.iter_mut().zip(&scene.system.forces) {
            *residual = equations.graph.add(*residual, force);
        }
    };
    question.corrupt(&scene, VAKONOMIC, FEW.states, forgotten).expect("rates");
    let rows = rows(&[question]);
    assert!(rows.iter().any(|row| row.verdict == Word::Disagrees && row.largest > Some(1e-2)), "{rows:?}");
}

/// `d/dt L_v + L_q = Aᵀ λ` is no equation of motion, and `λ` with the other sign is not ours.
#[test]
fn a_wrong_sign_is_found() {
    let (name, text) = scene::catalogue::SCENES[0];
    let scene = Scene::parse(name, text).expect("a scene");
    let mut questions = Vec::new();
    for flip in [true, false] {
        let mut question = Question::new(&scene, &scene.without_bodies(text), FEW).expect("questions");
        let change = |equations: &mut equations::Equations| {
            let g = &equations.graph;
            for (residual, q) in equations.blocks[0].residuals.iter_mut().zip(scene.system.positions()) {
                let gradient = g.derivative(scene.system.lagrangian, q);
                let factor = if flip { 2 } else { 0 };
                *residual = g.add(*residual, g.mul(g.integer(factor), gradient));
            }
        };
        question.corrupt(&scene, CHETAEV, FEW.states, change).expect("rates");
        questions.push(question);
    }
    let rows = rows(&questions);
    let words: Vec<Word> = rows.iter().map(|row| row.verdict).collect();
    assert_eq!(words, [Word::Disagrees, Word::Agrees], "{rows:?}");
    assert!(rows[0].largest > Some(0.1), "{rows:?}");
}

#[test]
fn a_wrong_text_is_found() {
    let (name, text) = scene::catalogue::SCENES[0];
    let scene = Scene::parse(name, text).expect("a scene");
    let text = scene.without_bodies(text);
    let other = text.replace("g*x*sin(alpha) +", "-g*x*sin(alpha) +");
    assert_ne!(text, other);
    let question = Question::new(&scene, &other, Amount { states: 10, times: 0 }).expect("questions");
    let rows = rows(&[question]);
    for formulation in ["Chetaev", "vakonomic", "removed constraint (arc-length)"] {
        let row = rows.iter().find(|row| row.what.starts_with(formulation)).expect(formulation);
        assert_eq!(row.verdict, Word::Disagrees, "{row:?}");
    }
}

/// What is asked about the multipliers of a scene, whose text is `text`.
fn about_multipliers(scene: &Scene, text: &str) -> Question {
    let question = Question::new(scene, text, Amount { states: 0, times: 0 }).expect("questions");
    question.with_decision(scene).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

#[test]
fn the_multipliers_are_those_of_power_series() {
    let batch = Batch { seed: 20_261, kinds: Kind::ALL.to_vec() };
    let scene = |(name, text): &(&str, &str)| {
        let scene = Scene::parse(name, text).expect(name);
        about_multipliers(&scene, &scene.without_bodies(text))
    };
    let classics = ["coin-on-incline", "generalized-heisenberg", "martinet", "mobile-robot", "nonholonomic-oscillator"];
    let classics = scene::catalogue::CLASSICS.iter().filter(|(name, _)| classics.contains(name));
    let mut questions: Vec<Question> = scene::catalogue::SCENES.iter().chain(classics).map(scene).collect();
    // a decision refuses where M is not positive on what constraints allow
    let is_decided = |index: &u64| !draw_recipe(batch.seed, *index, &batch.kinds).drawn.indefinite;
    let drawn: Vec<Scene> = (0..).filter(is_decided).take(50).map(|index| batch.scene(index)).collect();
    let constrained = drawn.iter().filter(|scene| !scene.system.constraints.is_empty()).count();
    questions.extend(drawn.iter().map(|scene| about_multipliers(scene, &scene.to_toml())));
    let rows = rows(&questions);
    for row in &rows {
        assert_eq!(row.verdict, Word::Agrees, "{row:?}");
    }
    // all but those without a constraint
    assert!(constrained >= 40, "{constrained}");
    assert_eq!(rows.iter().filter(|row| row.who == "power series").count(), 13 + 5 + constrained);
    assert_eq!(rows.iter().filter(|row| row.what == "all starts with a multiplier").count(), 10);
    let of = |note: &str| rows.iter().filter(|row| row.note == note).count();
    assert!(of("empty") >= 28 && of("dimension 0") >= 2 && of("dimension 1") >= 8, "{rows:?}");
}

#[test]
fn wrong_multipliers_are_found() {
    // half of the mass, half of the multipliers; and a particle that runs straight ahead has some
    let changes = [("disc", "m = 1.0", "m = 0.5"), ("particle", "\"y'\" = 0.5", "\"y'\" = 0.0")];
    let questions = changes.map(|(name, from, to)| {
        let (_, text) = scene::catalogue::SCENES.iter().find(|scene| scene.0 == name).expect(name);
        let other = text.replace(from, to);
        assert_ne!(*text, other);
        let changed = Scene::parse(name, &other).expect(name).without_bodies(&other);
        about_multipliers(&Scene::parse(name, text).expect(name), &changed)
    });
    let rows = rows(&questions);
    let words: Vec<Word> = rows.iter().map(|row| row.verdict).collect();
    // the disc's are algebra for all starts, and so for one mass; the particle's do not depend on the start
    assert_eq!(words, [Word::Disagrees, Word::Disagrees, Word::Disagrees, Word::Agrees], "{rows:?}");
}
