//! Questions that would take minutes, or all of the memory, stay open and say why; what else is asked is
//! answered.

use std::fmt::Write;

use crate::support::answer;

/// `n` bodies in a row: as a chain of pendulums, in whose energy every velocity meets every other one, or
/// each coupled with the next one only.
fn row(n: usize, is_chain: bool) -> String {
    let mut text = "title = \"Row\"\n[parameters]\nm = 1\ng = 9.8\n[coordinates]\n".to_owned();
    (0..n).for_each(|i| _ = writeln!(text, "q{i} = {{ unit = \"rad\", start = {} }}", 0.1 + 0.01 * i as f64));
    let sum = |i: usize, function: &str, rate: &str| {
        (0..=i).map(|j| format!("q{j}{rate}*{function}(q{j})")).collect::<Vec<_>>().join(" + ")
    };
    let chained = |i: usize| {
        let heights = (0..=i).map(|j| format!("cos(q{j})")).collect::<Vec<_>>().join(" + ");
        format!("m*(({})^2 + ({})^2)/2 + m*g*({heights})", sum(i, "cos", "'"), sum(i, "sin", "'"))
    };
    let coupled = |i: usize| format!("m*q{i}'^2/2 + m*g*cos(q{i} - q{})", (i + 1) % n);
    let terms: Vec<String> = (0..n).map(|i| if is_chain { chained(i) } else { coupled(i) }).collect();
    let velocities: Vec<String> = (1..n).map(|i| format!("\"q{i}'\" = 0.1")).collect();
    let (terms, velocities) = (terms.join(" + "), velocities.join(", "));
    text + &format!(
        "[system]\nlagrangian = \"{terms}\"\nconstraints = [\"q0' - q1'*q2\"]\n[start]\nvelocities = {{ {velocities} }}\n[run]\nduration = 1\n"
    )
}

#[test]
fn what_takes_too_long_or_too_much_memory_stays_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = |n, is_chain| {
        let path = folder.path().join(format!("{n}.toml"));
        std::fs::write(&path, row(n, is_chain)).expect("written");
        path.display().to_string()
    };
    let (chain, long) = (scene(25, true), scene(200, false));
    let (told, _) = answer(&["integrals", &chain, "--patience", "1"], 0);
    assert!(told.contains("stopped after 1 s; --patience gives it more"), "{told}");
    assert!(
        told.contains("not asked: no coordinates") || told.contains("ansatz"),
        "what else is asked is answered: {told}"
    );
    let (told, _) = answer(&["integrals", &long, "--patience", "1"], 0);
    assert!(told.contains("series to order 3 have more than 1200 coefficients"), "{told}");
    assert!(told.contains("monomials in the velocities, and at most 2000 are taken"), "{told}");
    let (told, _) = answer(&["show", &long, "--patience", "1"], 0);
    // brackets are left; ranks over a finite field tell, if there is time for them, but not how deep they are
    // at the start
    let constraint = told.lines().find(|line| line.starts_with("Constraint: ")).expect("a line");
    let said = ["Constraint: undecided: stopped after 1 s", "Constraint: nonholonomic, bracket-generating of step 2"];
    assert!(said.iter().any(|said| constraint.starts_with(said)), "{constraint}");
    let (_, complaint) = answer(&["linearize", &long, "--patience", "1"], 2);
    assert!(complaint.contains("not a steady motion"), "{complaint}");
}
