//! Drawn systems: a yes is none where floating point says no, and other words for a system get the same
//! words. `DRAWN=N` draws N; `DRAWN_TO=FILE` keeps the systems and what was said, for a referee.

use std::io::Write;

use decision::{Finding, Proof, Section, Verdict};
use symbolic::SplitMix;

use crate::questions::{is_vakonomic, proved, written};

fn count(usual: u64) -> u64 {
    std::env::var("DRAWN").ok().and_then(|n| n.parse().ok()).unwrap_or(usual)
}

/// A system as text, in parts.
#[derive(Clone)]
struct Drawn {
    coordinates: Vec<(&'static str, String)>,
    parameters: Vec<(&'static str, String)>,
    lagrangian: String,
    constraints: Vec<String>,
    rates: Vec<(&'static str, String)>,
}

impl Drawn {
    fn text(&self) -> String {
        let lines = |of: &[(&str, String)], line: fn(&str, &str) -> String| -> String {
            of.iter().map(|(name, value)| line(name, value)).collect()
        };
        let constraints: Vec<String> = self.constraints.iter().map(|f| format!("\"{f}\"")).collect();
        format!(
            "title = \"Drawn\"\n[parameters]\n{}[coordinates]\n{}[system]\nlagrangian = \"{}\"\nconstraints = [{}]\n\
             [start.velocities]\n{}[run]\nduration = 2\n",
            lines(&self.parameters, |name, value| format!("{name} = {value}\n")),
            lines(&self.coordinates, |name, value| format!("{name} = {{ start = {value} }}\n")),
            self.lagrangian,
            constraints.join(", "),
            lines(&self.rates, |name, value| format!("\"{name}'\" = {value}\n")),
        )
    }

    /// With these made of every formula and of the names of the start.
    fn rewritten(&self, change: impl Fn(&str) -> String) -> Drawn {
        let constraints = self.constraints.iter().map(|f| change(f)).collect();
        Drawn { lagrangian: change(&self.lagrangian), constraints, ..self.clone() }
    }
}

struct Draw(SplitMix);

impl Draw {
    fn below(&mut self, n: u64) -> u64 {
        (self.0.bits() >> 11) % n
    }

    fn of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u64) as usize].clone()
    }

    /// A decimal from −1.9 to 1.9.
    fn decimal(&mut self) -> String {
        format!("{:.1}", (1 + self.below(19)) as f64 * if self.below(2) == 0 { 0.1 } else { -0.1 })
    }

    /// A term with `t` in it.
    fn driven(&mut self) -> String {
        let power = 3 + self.below(10);
        let (decimal, of) = (self.decimal(), self.of(&["x", "y", "x*y", "z", "x^2"]));
        format!("{}*{of}*t^{power}", decimal.trim_start_matches('-'))
    }

    /// `x`, `y`, `z` with one constraint, or with `w` and two; `timed`: with powers of time somewhere.
    fn system(&mut self, timed: bool) -> Drawn {
        let two = self.below(3) == 0;
        let forms = ["0.4*x'", "y*x'", "x*y'", "-0.3*y'", "x*x'", "y*x' + x*y'", "z*x'", "y^2*y'", "0.7*x*x' - y*y'"];
        let form = |draw: &mut Draw| {
            let (one, c) = (draw.of(&forms), draw.decimal());
            match draw.below(3) {
                0 => one.to_owned(),
                1 => format!("{one} + {c}*x'"),
                _ => format!("{one} + ({c})*({})", draw.of(&forms)),
            }
        };
        let mut constraints = vec![format!("z' - ({})", form(self))];
        let mut lagrangian = format!("(x'^2 + {}*y'^2 + z'^2)/2", self.of(&["1", "2", "m"]));
        let mut coordinates: Vec<(&str, String)> = ["x", "y", "z"].map(|q| (q, self.decimal())).into();
        if two {
            let f = format!("w' - ({})", form(self).replace("z*", "w*"));
            constraints.push(f);
            lagrangian += " + w'^2/2";
            coordinates.push(("w", self.decimal()));
        }
        for _ in 0..self.below(3) {
            let (c, of) = (self.decimal(), self.of(&["x", "y", "z", "x^2/2", "y^2/2", "x*y"]));
            lagrangian += &format!(" + ({c})*{of}");
        }
        if timed {
            let term = self.driven();
            match self.below(3) {
                0 => lagrangian += &format!(" + {term}"),
                1 => constraints[0] += &format!(" - {term}*{}", self.of(&["x'", "y'"])),
                _ => constraints[0] += &format!(" - {term}"),
            }
        }
        let rates = ["x", "y"].map(|q| (q, self.decimal())).into();
        Drawn { coordinates, parameters: vec![("m", "1.5".into())], lagrangian, constraints, rates }
    }
}

/// One of the systems whose motions are in the family at every start, driven by a power of time.
fn driven_classic(draw: &mut Draw) -> String {
    let term = draw.driven();
    let classic = draw.of(&[
        include_str!("../../scene/scenes/disc.toml"),
        include_str!("../../scene/scenes/heisenberg.toml"),
        include_str!("../../scene/scenes/appell-hamel.toml"),
        include_str!("../../scene/classics/generalized-heisenberg.toml"),
    ]);
    let term = if classic.contains("x1 ") { term.replace('x', "x1").replace('y', "y1") } else { term };
    let term = if classic.contains("psi") { term.replace('z', "x") } else { term };
    let Some(line) = classic.lines().find(|line| line.trim_start().starts_with("lagrangian")) else {
        return format!("{classic}\n[system]\nlagrangian = \"{term}\"\n");
    };
    let end = line.rfind('"').expect("a quote");
    classic.replace(line, &format!("{} + {term}{}", &line[..end], &line[end..]))
}

fn says_yes((proof, section): &(Proof, Option<Section>)) -> bool {
    matches!(proof.this_start, Finding::Contained { .. }) || section.as_ref().is_some_and(|section| section.proved)
}

#[test]
fn nothing_driven_by_time_gets_a_false_yes() {
    let mut kept = std::env::var("DRAWN_TO").ok().map(|path| std::fs::File::create(path).expect("a file"));
    let (mut yes, mut no, mut open, mut unlike) = (0, 0, 0, 0);
    for seed in 0..count(60) {
        let mut draw = Draw(SplitMix::new(seed));
        let text = if seed % 3 == 0 { driven_classic(&mut draw) } else { draw.system(true).text() };
        let scene = written(&text, &[]);
        let found = proved(&scene);
        let decision = is_vakonomic(&scene);
        let refuted = matches!(&found.0.this_start, Finding::None(none) if none.full_rank);
        let said = if says_yes(&found) {
            "yes"
        } else if refuted {
            "no"
        } else {
            "open"
        };
        if let Some(file) = &mut kept {
            let finding = format!("{:?}", found.0.this_start);
            writeln!(file, "{{\"scene\": {text:?}, \"said\": \"{said}\", \"finding\": {finding:?}}}").expect("written");
        }
        match said {
            "yes" => yes += 1,
            "no" => no += 1,
            _ => open += 1,
        }
        assert!(
            !(said == "yes" && decision.verdict == Verdict::NotContained),
            "{seed}: rho {:.1e}, noise {:.1e}; {found:?}\n{text}",
            decision.least,
            decision.noise
        );
        if said == "no" && decision.verdict == Verdict::Contained {
            unlike += 1;
            println!("{seed}: proved no, rho {:.1e}, noise {:.1e}; {:?}", decision.least, decision.noise, found.0);
        }
    }
    println!("{yes} yes, {no} no, {open} open; {unlike} no with a mismatch that is noise");
}

/// What was said, without what depends on the words.
fn said(text: &str) -> [String; 2] {
    let (proof, _) = proved(&written(text, &[]));
    let words = |finding: &Finding| match finding {
        Finding::NotApplicable(_) => "not applicable".into(),
        Finding::Contained { rank, .. } => format!("contained, rank {rank}"),
        // whether integrable combinations are found depends on the words
        Finding::None(none) => format!("none, order {}, minor of size {}", none.order, none.size),
        other => format!("{other:?}"),
    };
    [words(&proof.this_start), words(&proof.almost_every_start)]
}

#[test]
fn other_words_for_a_system_get_the_same_words() {
    for seed in 0..count(30) {
        let mut draw = Draw(SplitMix::new(0xface ^ seed));
        let system = draw.system(seed % 4 == 0);
        let expected = said(&system.text());
        let check = |what: &str, other: &Drawn| {
            let text = other.text();
            assert_eq!(said(&text), expected, "{seed}, {what}:\n{}\n{text}", system.text());
        };
        for factor in ["(-7/3)", "(1 + x^2)", "exp(y/2)", "(2 + sin(x))", "(1 + t^2)/(3 + x^2)"] {
            let mut other = system.clone();
            other.constraints.iter_mut().for_each(|f| *f = format!("{factor}*({f})"));
            check(factor, &other);
        }
        let mut other = system.clone();
        if let [first, second] = &mut other.constraints[..] {
            (*first, *second) = (format!("{first} + 2*({second})"), format!("{second} - x^2*({first})"));
            check("recombined", &other);
        }
        let mut other = system.clone();
        other.lagrangian += " + 2*x*x'*y + x^2*y' + t*z' + z + cos(y)*y'";
        check("a total derivative", &other);
        // x = X + Y/2, y = Y/3
        let turned = |text: &str| {
            let text = text.replace("x'", "(_' + ~'/2)").replace("y'", "(~'/3)").replace('x', "(_ + ~/2)");
            text.replace('y', "(~/3)").replace('_', "x").replace('~', "y")
        };
        let value = |name: &str, of: &[(&str, String)]| {
            of.iter().find(|(known, _)| *known == name).map_or("0".into(), |(_, x)| x.clone())
        };
        let mut other = system.rewritten(turned);
        for of in [&mut other.coordinates, &mut other.rates] {
            let (x, y) = (value("x", of), value("y", of));
            of[0].1 = format!("\"({x}) - 3/2*({y})\"");
            of[1].1 = format!("\"3*({y})\"");
        }
        check("other coordinates", &other);
        // 1.5 as 3/2, and the masses in thirds
        let mut other = system.clone();
        for (_, value) in other.parameters.iter_mut().chain(&mut other.coordinates).chain(&mut other.rates) {
            *value = format!("\"10*({value})/(3*10) + 2*({value})*cos(pi/3)*2/3\"");
        }
        check("numbers as formulas", &other);
        let mut thirds = [system.clone(), system.clone()];
        for (system, third) in thirds.iter_mut().zip(["\"1/3\"", "\"(1 - 1/2)*tan(pi/4)*2/3\""]) {
            system.parameters[0].1 = third.into();
        }
        assert_eq!(said(&thirds[0].text()), said(&thirds[1].text()), "{seed}, thirds");
    }
}
