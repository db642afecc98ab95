//! Mistakes drawn at random are named, with their terms.

use mechanics::System;
use review::{Asked, Review, Verdict, review, states};
use scene::Scene;
use symbolic::{Expr, SplitMix, faults};

use crate::support::{Derivation, SYSTEMS, accelerations, below, derive, text};

/// Cases of the usual run; `REVIEW_CASES` sets another number.
const CASES: u64 = 40;

/// A mistake with a term, dropped, turned, doubled or halved.
fn changed(system: &System, e: Expr, random: &mut SplitMix) -> (Expr, String) {
    let g = &system.graph;
    let terms = g.terms(g.expand(e));
    let term = terms[below(random, terms.len())];
    let factor = [g.integer(-1), g.integer(-2), g.one(), g.ratio(-1, 2)][below(random, 4)];
    (g.add(e, g.mul(factor, term)), g.plain(term))
}

/// Makes a mistake; what it is about. `None` where there is nothing for it.
fn spoil(system: &mut System, late: &mut Option<Derivation>, random: &mut SplitMix) -> Option<String> {
    let g = system.graph.clone();
    let (n, h) = (system.dimension(), system.constraints.len());
    let kind = below(random, 9);
    // what concerns L and f comes before what is done with the equations
    if late.is_some() && kind < 4 {
        return None;
    }
    match kind {
        0 => {
            let (wrong, term) = changed(system, system.lagrangian, random);
            system.lagrangian = wrong;
            Some(term)
        }
        1 => {
            let still: Vec<Expr> = system.graph.terms(system.graph.expand(system.lagrangian));
            let moves = |e: &Expr| system.velocities().iter().any(|&v| system.graph.depends_on(*e, v));
            let potential = system.graph.sum(&still.into_iter().filter(|e| !moves(e)).collect::<Vec<Expr>>());
            (!g.is_zero(potential)).then(|| {
                let twice = system.graph.mul(system.graph.integer(2), potential);
                system.lagrangian = system.graph.sub(system.lagrangian, twice);
                "gravity upwards".to_owned()
            })
        }
        2 if h > 0 => {
            let j = below(random, h);
            let (wrong, term) = changed(system, system.constraints[j], random);
            system.constraints[j] = wrong;
            Some(term)
        }
        3 => {
            // a factor of a term of L, a parameter
            let g = &system.graph;
            let terms = g.terms(g.expand(system.lagrangian));
            let term = terms[below(random, terms.len())];
            let parameter = system.parameters.iter().find(|p| g.depends_on(term, p.symbol))?;
            let other = g.div(term, g.variable(parameter.symbol));
            let name = g.plain(term);
            system.lagrangian = g.add(system.lagrangian, g.sub(other, term));
            Some(name)
        }
        4.. => {
            let derivation = late.get_or_insert_with(|| derive(system));
            let g = &system.graph;
            match kind {
                4 | 5 => {
                    let i = below(random, n);
                    (!g.is_zero(derivation.rows[i])).then(|| {
                        let (wrong, term) = changed(system, derivation.rows[i], random);
                        derivation.rows[i] = wrong;
                        term
                    })
                }
                6 if h > 0 => {
                    let a = g.variables(&system.accelerations());
                    derivation.rates = derivation.reactions.iter().map(|row| g.dot(row, &a)).collect();
                    Some("rate of the constraint's coefficients".into())
                }
                7 if h > 0 => {
                    let j = below(random, h);
                    let (wrong, term) = changed(system, derivation.rates[j], random);
                    derivation.rates[j] = wrong;
                    Some(term)
                }
                8 => {
                    let i = below(random, n);
                    let slope = g.derivative(system.lagrangian, system.coordinates[i].position);
                    derivation.rows[i] = g.add(derivation.rows[i], slope);
                    (!g.is_zero(slope)).then(|| format!("∂L/∂{}", system.coordinates[i].name))
                }
                _ => None,
            }
        }
        _ => None,
    }
}

/// A derivation with one or two mistakes: its text, what they are about, and whether accelerations differ in
/// doubles, where these are determined.
fn case(scene: &Scene, seed: u64) -> (String, Vec<String>, Option<bool>) {
    let mut random = SplitMix::new(seed);
    (0..4).for_each(|_| _ = random.bits());
    let mut system = scene.system.clone();
    let mut late = None;
    let count = 1 + below(&mut random, 2);
    let mut made = Vec::new();
    for _ in 0..20 {
        if made.len() < count {
            made.extend(spoil(&mut system, &mut late, &mut random));
        }
    }
    let derivation = late.unwrap_or_else(|| derive(&system));
    let right = derive(&scene.system);
    let differ = |state: &mechanics::State| {
        let (a, b) = (accelerations(&system, &derivation, state)?, accelerations(&scene.system, &right, state)?);
        Some(a.iter().zip(&b).any(|(a, b)| (a - b).abs() > 1e-7 * (1.0 + b.abs())))
    };
    let differ: Option<Vec<bool>> = states(scene).iter().map(differ).collect();
    (text(&system, &derivation, &mut random), made, differ.map(|all| all.contains(&true)))
}

/// Whether an explanation speaks of each mistake.
fn names(found: &Review, made: &[String]) -> bool {
    let speaks =
        |words: &[String]| made.iter().all(|term| words.iter().any(|own| own.contains(term.trim_start_matches('-'))));
    found.explanations.iter().any(|words| speaks(words))
}

#[test]
fn mistakes_drawn_at_random_are_named() {
    let cases = std::env::var("REVIEW_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(CASES);
    let (mut wrong, mut explained, mut named, mut without, mut judged) = (0, 0, 0, 0, 0);
    let mut slowest = std::time::Duration::ZERO;
    let first = std::env::var("REVIEW_FIRST").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    for k in first..first + cases {
        let scene = scene::catalogue::find(SYSTEMS[(k % SYSTEMS.len() as u64) as usize], &[]).unwrap();
        let (text, made, differ) = case(&scene, 1000 + k);
        let clock = std::time::Instant::now();
        let found = review(&scene, "drawn", &text, &Asked::default()).unwrap();
        slowest = slowest.max(clock.elapsed());
        if let Some(differ) = differ.filter(|_| !found.notes.iter().any(|note| note.contains("not for others"))) {
            judged += 1;
            assert_eq!(found.verdict == Verdict::Wrong, differ, "{k} {} {made:?}\n{text}\n{found:?}", scene.name);
        }
        if found.verdict != Verdict::Wrong {
            without += 1;
            println!("{k} {} {:?} {:?}: {made:?}", scene.name, found.verdict, found.notes);
            continue;
        }
        wrong += 1;
        explained += usize::from(!found.explanations.is_empty());
        // two mistakes may be one, or one of them none
        let simpler = found.explanations.iter().any(|words| words.len() < made.len());
        named += usize::from(names(&found, &made) || simpler);
        if !names(&found, &made) && !simpler {
            println!("{k} {} {made:?} -> {:?} {:?} {:?}", scene.name, found.explanations, found.notes, clock.elapsed());
        }
    }
    println!(
        "{judged} judged in doubles, {wrong} wrong, {explained} explained, {named} with the drawn terms or fewer, {without} without effect; slowest {slowest:?}"
    );
    assert!(20 * named >= 19 * wrong && wrong > 0, "{named} of {wrong}");
}

/// One operation of a derivation goes wrong, wherever: what comes of it is explained nearly always, and never
/// called right where doubles say that it is not.
#[test]
fn what_the_injector_spoils_is_explained() {
    let (mut wrong, mut explained) = (0, 0);
    let cases = std::env::var("REVIEW_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(CASES);
    for k in 0..cases {
        let scene = scene::catalogue::find(SYSTEMS[(k % SYSTEMS.len() as u64) as usize], &[]).unwrap();
        let mut random = SplitMix::new(9 + k);
        let fresh = || scene.system.clone();
        let (_, chances) = faults::chances(|| derive(&fresh()));
        let which = below(&mut random, chances.len());
        let system = fresh();
        let derivation = faults::spoiled(which, chances.len(), || derive(&system));
        let theirs = text(&system, &derivation, &mut random);
        let found = review(&scene, "spoiled", &theirs, &Asked::default()).unwrap();
        if found.verdict == Verdict::Wrong {
            wrong += 1;
            explained += usize::from(!found.explanations.is_empty());
        }
    }
    println!("{wrong} wrong, {explained} explained");
    assert!(wrong > 0 && 100 * explained >= 85 * wrong, "{explained} of {wrong}");
}
