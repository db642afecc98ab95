//! Answers in words.

use std::fmt::{self, Display, Formatter};

use mechanics::{Domain, System};
use motion::numbers::at_most;

use crate::{Density, Found, Integrals, Measure, Multiplier, Open, Printed, Reduction, Reversed};

/// What integrals of degree `below + 1` are called.
pub(crate) fn degree(below: usize) -> &'static str {
    ["linear", "quadratic", "cubic"].get(below).unwrap_or(&"higher")
}

impl Display for Integrals {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.scene.name, self.formulation)?;
        if let Some(domain) = self.where_it_holds() {
            writeln!(f, "{domain}")?;
        }
        self.lines().into_iter().try_for_each(|(about, words)| writeln!(f, "{about:<14}{words}"))
    }
}

impl Integrals {
    /// Where answers hold, where that has to be said, and what a measure is.
    pub fn where_it_holds(&self) -> Option<String> {
        let domain = Domain::of(&self.scene.system);
        let measure = "a measure is e^sigma(q) dq dp, sigma smooth there, its periods not asked for";
        match &self.reversed {
            Some(_) => Some(format!("near {}; {measure}", domain.almost_every("place q"))),
            None if domain == Domain::default() => None,
            None => Some(format!("at {}", domain.almost_every("place q"))),
        }
    }

    /// What each answer is about, and the answer in words.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = Vec::new();
        if let Some(found) = &self.reversed {
            lines.push(("measure", measure_words(&self.scene.system, &found.measure)));
            let multipliers = multiplier_lines(&self.scene.system, &found.reductions);
            lines.extend(multipliers.into_iter().map(|line| ("multiplier", line)));
            lines.extend(found.integrals.iter().enumerate().map(|(i, found)| (degree(i), count_words(found))));
        }
        match &self.ansatz {
            Err(open) => lines.push(("ansatz", format!("open ({open})"))),
            Ok(found) => {
                let names = if found.names.is_empty() { "no coordinate".into() } else { found.names.join(", ") };
                let words = format!(
                    "{} functions, in {names} to degree {}: {}, {} without the products",
                    found.functions,
                    found.spatial,
                    number(found.dimension, "constant combination"),
                    found.printed.len() + found.unprinted,
                );
                lines.push(("ansatz", words));
                for (i, integral) in found.printed.iter().enumerate() {
                    let (part, drift) = match &self.drifts {
                        Ok(drifts) if drifts[i].is_certain() => (
                            " on the branch of this start",
                            format!("drift {:.0e}: the motion leaves it", drifts[i].of_terms()),
                        ),
                        Ok(drifts) => ("", format!("drift below {:.0e}", at_most(drifts[i].with_digits()))),
                        Err(why) => ("", format!("no motion to try it on: {why}")),
                    };
                    lines.push((kind(integral), format!("{} = const{part} ({drift})", integral.text)));
                }
                if found.unprinted > 0 {
                    let words = format!("{} with coefficients that are not moderate fractions", found.unprinted);
                    lines.push(("", words));
                }
            }
        }
        match &self.invariants {
            Err(open) => lines.push(("invariants", format!("of the scene: open ({open})"))),
            Ok(invariants) => lines.extend(invariants.iter().map(|(name, held)| {
                let words = if *held { "constant, at random points of two fields" } else { "not constant: proved" };
                ("invariant", format!("`{name}` of the scene: {words}"))
            })),
        }
        lines
    }
}

pub(crate) fn kind(integral: &Printed) -> &'static str {
    match integral {
        _ if integral.is_energy => "energy",
        _ if integral.is_moving_energy => "moving energy",
        _ => "integral",
    }
}

fn measure_words(system: &System, measure: &Measure) -> String {
    match measure {
        Measure::None { proved: true } => "none: proved".into(),
        Measure::None { proved: false } => "none, by ranks modulo two primes: no proof".into(),
        Measure::Local { density: Some(density), .. } => format!("{}, verified", density_words(system, density)),
        Measure::Local { density: None, cyclic: None } => "one, locally, not printed in this ansatz".into(),
        Measure::Local { density: None, cyclic: Some(cyclic) } => format!(
            "one, locally, not printed in this ansatz; none is free of {}: {}",
            names(system, &cyclic.places).join(", "),
            if cyclic.proved { "proved" } else { "by ranks modulo two primes" },
        ),
        Measure::Open(open) => format!("open ({open})"),
    }
}

/// A line for each multiplier, and one for the motions that have none.
fn multiplier_lines(system: &System, reductions: &Result<Vec<Reduction>, Open>) -> Vec<String> {
    let over = |found: &Reduction| format!("({})", names(system, &found.over).join(", "));
    let found = match reductions {
        Err(open) => return vec![format!("open ({open})")],
        Ok(found) if found.is_empty() => return vec!["not asked: no coordinates have a motion of their own".into()],
        Ok(found) => found,
    };
    let mut lines: Vec<String> = Vec::new();
    for found in found {
        if let Multiplier::Local(factor) = &found.multiplier {
            lines.push(match factor {
                Some(factor) => format!(
                    "f = {}, verified: with dtau = f dt the motion over {} is Hamilton's, T = g_ab r_a' r_b'/2 there",
                    factor_words(system, factor),
                    over(found)
                ),
                None => format!("one over {}, locally, not printed in this ansatz", over(found)),
            });
        }
    }
    let none: Vec<String> = found.iter().filter(|found| found.multiplier == Multiplier::None).map(over).collect();
    if !none.is_empty() {
        lines.push(format!("none over {}: proved", none.join(" or ")));
    }
    lines
}

pub(crate) fn names(system: &System, places: &[usize]) -> Vec<String> {
    places.iter().map(|&i| system.coordinates[i].name.clone()).collect()
}

/// The product in the names of the scene.
pub(crate) fn factor_words(system: &System, density: &Density) -> String {
    let power = |base: String, exponent: String| match &exponent[..] {
        "0" => None,
        "1" => Some(base),
        _ => Some(format!("{base}^({exponent})")),
    };
    let mut factors: Vec<String> = power("|det(g)|".into(), density.of_metric.to_string()).into_iter().collect();
    for (i, exponents) in &density.of_angles {
        for (function, exponent) in ["sin", "cos"].into_iter().zip(exponents) {
            factors.extend(power(format!("|{function}({})|", system.coordinates[*i].name), exponent.to_string()));
        }
    }
    if factors.is_empty() { "1".into() } else { factors.join(" ") }
}

pub(crate) fn density_words(system: &System, density: &Density) -> String {
    let free: Vec<String> = density.free.iter().map(|&i| format!("{}'", system.coordinates[i].name)).collect();
    let factor = factor_words(system, density);
    let product = if factor == "1" { "dq ds".into() } else { format!("{factor} dq ds") };
    format!("{product}, s = ({}), T = g_ab s^a s^b/2 on the constraints", free.join(", "))
}

fn count_words(found: &Result<Found, Open>) -> String {
    match found {
        Err(open) => format!("open ({open})"),
        Ok(found) if found.none_proved() && found.trivial == 0 => "none: proved".into(),
        Ok(found) if found.none_proved() => {
            format!("none but {} of energy, constants and products: proved", found.trivial)
        }
        Ok(found) if found.settled => format!("{}{}", number(found.further(), "local one"), beside(found)),
        Ok(found) => format!(
            "open (at most {}{}: proved; not settled at order {})",
            number(found.further(), "local one"),
            beside(found),
            found.order
        ),
    }
}

fn number(count: usize, of: &str) -> String {
    format!("{count} {of}{}", if count == 1 { "" } else { "s" })
}

fn beside(found: &Found) -> String {
    if found.trivial == 0 {
        String::new()
    } else {
        format!(" beside {} of energy, constants and products", found.trivial)
    }
}

impl Reversed {
    /// A word on measures, one on multipliers, one per degree on integrals (`none`, their number, `<=` a
    /// bound of it, `open`), and why anything is open.
    pub fn cells(&self) -> (Vec<String>, String) {
        let mut why = Vec::new();
        let mut open = |open: &Open| {
            why.push(open.to_string());
            "open".to_owned()
        };
        let mut cells = vec![match &self.measure {
            Measure::None { proved: true } => "none".into(),
            Measure::None { proved: false } => "none by ranks".into(),
            Measure::Local { .. } => "some".into(),
            Measure::Open(reason) => open(reason),
        }];
        cells.push(match &self.reductions {
            Err(reason) => open(reason),
            Ok(found) if found.is_empty() => "-".into(),
            Ok(found) if found.iter().all(|found| found.multiplier == Multiplier::None) => "none".into(),
            Ok(_) => "some".into(),
        });
        cells.extend(self.integrals.iter().map(|found| match found {
            Ok(found) if found.none_proved() => "none".into(),
            Ok(found) if found.settled => found.further().to_string(),
            Ok(found) => format!("<={}", found.further()),
            Err(reason) => open(reason),
        }));
        why.dedup();
        (cells, why.join("; "))
    }
}
