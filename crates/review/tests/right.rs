//! Right equations in other coordinates, frames, factors, orders and multipliers are never called wrong.

use std::collections::HashMap;

use mechanics::System;
use review::{Asked, Numbers, Verdict, review};
use scene::Scene;
use symbolic::SplitMix;

use crate::support::{SYSTEMS, below, derive, text};

/// Cases of the usual run; `REVIEW_RIGHT` sets another number.
const CASES: u64 = 50;

fn asked(wheres: &[&str]) -> Asked {
    Asked { wheres: wheres.iter().map(|text| (*text).to_string()).collect(), ..Asked::default() }
}

/// Formulas of the scene's coordinates in new ones, `q_0`, `q_1`, …
fn formulas(scene: &Scene, random: &mut SplitMix) -> Vec<String> {
    let count = scene.system.dimension();
    let single = |i: usize, kind: usize| match kind {
        0 => format!("q_{i}"),
        1 => format!("q_{i} + 2"),
        2 => format!("-q_{i}"),
        3 => format!("3*q_{i} - t"),
        _ => format!("q_{i}/2 + t^2"),
    };
    let mut formulas: Vec<String> = (0..count).map(|i| single(i, below(random, 5))).collect();
    let (i, j) = (below(random, count), below(random, count));
    if i != j {
        (formulas[i], formulas[j]) = match below(random, 4) {
            0 => (format!("3/5*q_{i} - 4/5*q_{j}"), format!("4/5*q_{i} + 3/5*q_{j}")),
            1 => (format!("q_{i} + 2*q_{j}"), format!("q_{j}")),
            2 => (format!("cos(t)*q_{i} - sin(t)*q_{j}"), format!("sin(t)*q_{i} + cos(t)*q_{j}")),
            _ => (format!("q_{i}*cos(q_{j})"), format!("q_{i}*sin(q_{j})")),
        };
    }
    formulas
}

/// The system in these coordinates.
fn transformed(scene: &Scene, formulas: &[String]) -> System {
    let own = &scene.system;
    let names: Vec<String> = (0..own.dimension()).map(|i| format!("q_{i}")).collect();
    let named: Vec<(&str, &str)> = names.iter().map(|name| (&name[..], "")).collect();
    let mut system = System::new(own.graph.clone(), &named);
    system.parameters = own.parameters.clone();
    let places: Vec<_> = formulas.iter().map(|text| system.expression(text).unwrap()).collect();
    let (g, flow) = (&system.graph, system.flow());
    let rates = g.total_derivatives(&places, &flow);
    let map: HashMap<_, _> =
        own.positions().into_iter().zip(places.clone()).chain(own.velocities().into_iter().zip(rates)).collect();
    let lagrangian = g.substitute(own.lagrangian, &map);
    let constraints = g.substitute_all(&own.constraints, &map);
    let forces = g.transpose_vec(&g.jacobian(&places, &system.positions()), &g.substitute_all(&own.forces, &map));
    System { lagrangian, constraints, forces, ..system }
}

#[test]
fn right_equations_are_called_right_in_any_coordinates() {
    let cases = std::env::var("REVIEW_RIGHT").ok().and_then(|n| n.parse().ok()).unwrap_or(CASES);
    let (mut right, mut undecided) = (0, 0);
    for k in 0..cases {
        let mut random = SplitMix::new(77 + k);
        (0..4).for_each(|_| _ = random.bits());
        let scene = scene::catalogue::find(SYSTEMS[(k % SYSTEMS.len() as u64) as usize], &[]).unwrap();
        let formulas = formulas(&scene, &mut random);
        let system = transformed(&scene, &formulas);
        let theirs = text(&system, &derive(&system), &mut random);
        let pairs = scene.system.coordinates.iter().zip(&formulas);
        let wheres: Vec<String> = pairs.map(|(c, formula)| format!("{} = {formula}", c.name)).collect();
        let found = review(&scene, "right", &theirs, &Asked { wheres: wheres.clone(), ..Asked::default() }).unwrap();
        assert_ne!(found.verdict, Verdict::Wrong, "{k} {}: {wheres:?}\n{theirs}\n{found:?}", scene.name);
        right += usize::from(found.verdict == Verdict::Right);
        undecided += usize::from(found.verdict == Verdict::Undecided);
        if found.verdict == Verdict::Undecided {
            println!("{k} {}: {wheres:?} {:?}", scene.name, found.notes);
        }
    }
    println!("{right} right, {undecided} undecided of {cases}");
    assert!(20 * right >= 19 * cases as usize, "{right}");
}

/// Every scene as the program itself writes its equations: text, LaTeX, C.
#[test]
fn every_scene_is_right_as_it_is_shown() {
    for (name, _) in scene::catalogue::built_in() {
        let scene = scene::catalogue::find(name, &[]).unwrap();
        let choices = motion::choices(&scene);
        let choice = choices.iter().find(|c| c.formulation == motion::CHETAEV).unwrap();
        let equations = motion::derive(&scene.system, choice).unwrap();
        let g = &equations.graph;
        let lines = |print: &dyn Fn(symbolic::Expr) -> String| {
            let lines = equations.statements.iter().map(|s| format!("{} = {}\n", print(s.left), print(s.right)));
            lines.collect::<String>()
        };
        let settings = motion::Settings::default();
        let prepared =
            motion::prepare(motion::setting(&scene), equations.clone(), &choice.constants, &settings).unwrap();
        let code = motion::code(&scene, &prepared, motion::Language::C).unwrap();
        for (file, text) in [("a.txt", lines(&|e| g.plain(e))), ("a.tex", lines(&|e| g.latex(e))), ("a.c", code)] {
            let found = review(&scene, file, &text, &Asked::default()).unwrap();
            assert_eq!(found.verdict, Verdict::Right, "{name}, {file}: {found:?}");
        }
    }
}

#[test]
fn latex_of_papers_is_read() {
    let theirs = r"\documentclass{article}
\begin{document} Its equations are
\begin{align}
 m \ddot{x} &= m a \left(\ddot\phi \sin\phi + \dot\phi^2 \cos\phi\right) - N_1 \sin\phi, \\
 m\,\ddot y &= -ma(\ddot{\varphi}\cos{\varphi} - \dot{\varphi}^{2}\sin\varphi) + N_{1}\cos\varphi, \label{eq:y}\\
 \frac{I + ma^2}{2}\,\ddot\phi &= \tfrac12 m a\,(\ddot x\sin\phi - \ddot y\cos\phi),\\
 \dot y\cos\phi &= \dot x \sin\phi .
\end{align}
\end{document}";
    let sleigh = scene::catalogue::find("sleigh", &[]).unwrap();
    let found = review(&sleigh, "a.tex", theirs, &Asked::default()).unwrap();
    assert_eq!((found.verdict, &found.unknowns[..]), (Verdict::Right, &["N_1".to_string()][..]), "{found:?}");
}

#[test]
fn quasi_velocities_leaves_and_logarithms() {
    let sleigh = scene::catalogue::find("sleigh", &[]).unwrap();
    let kane = "phi' = w\nx' = u*cos(phi)\ny' = u*sin(phi)\nu' = a*w^2\nw' = -m*a*u*w/(I + m*a^2)";
    let found = review(&sleigh, "kane", kane, &Asked::default()).unwrap();
    assert_eq!((found.verdict, found.numbers), (Verdict::Right, Some(Numbers::Field)), "{found:?}");
    // by hand: a pendulum whose string is a constraint on velocities, on the leaf of its string's length
    let pendulum = scene::catalogue::find("velocity-pendulum", &[]).unwrap();
    for (theirs, wheres, numbers, verdict) in [
        ("a'' = -g*sin(a)/b", &["x = b*sin(a)", "y = -b*cos(a)"][..], Numbers::Floats, Verdict::Right),
        ("a'' = g*sin(a)/b", &["x = b*sin(a)", "y = -b*cos(a)"][..], Numbers::Floats, Verdict::Wrong),
        ("m*x'' = T*x\nm*y'' = -m*g + T*y\nx^2 + y^2 = 1.7", &[][..], Numbers::Floats, Verdict::Right),
        ("m*x'' = T*x\nm*y'' = m*g + T*y\nx^2 + y^2 = 1.7", &[][..], Numbers::Floats, Verdict::Wrong),
        ("m*x'' = T*x\nm*y'' = -m*g + T*y\nx*x' + y*y' = 0", &[][..], Numbers::Field, Verdict::Right),
    ] {
        let found = review(&pendulum, "pendulum", theirs, &asked(wheres)).unwrap();
        assert_eq!(found.verdict, verdict, "{theirs}: {found:?}");
        assert!(found.numbers == Some(numbers) || wheres.len() == 2, "{theirs}: {found:?}");
    }
    let text = "title = \"log\"\n[coordinates]\nx = { start = 2 }\ny = { start = 1 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2 - log(x^2 + y^2) - sqrt(1 + x^2)\"\n[start.velocities]\n\"x'\" = 1\n\"y'\" = 0\n[run]\nduration = 1\n";
    let scene = Scene::parse("log", text).unwrap();
    let right = "x'' = -2*x/(x^2 + y^2) - x/sqrt(1 + x^2)\ny'' = -2*y/(x^2 + y^2)";
    let found = review(&scene, "log", right, &Asked::default()).unwrap();
    assert_eq!(found.verdict, Verdict::Right, "{found:?}");
    let wrong = right.replace("- x/sqrt", "+ x/sqrt");
    let found = review(&scene, "log", &wrong, &Asked::default()).unwrap();
    assert_eq!(found.verdict, Verdict::Wrong, "{found:?}");
    assert!(
        found.explanations.iter().any(|words| words[0].contains("sqrt") && words[0].contains("wrong sign")),
        "{found:?}"
    );
}
