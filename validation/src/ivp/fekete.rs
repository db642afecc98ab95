//! The scene of twenty particles on the unit sphere: too many pairs to be written by hand.

use std::fmt::Write;

/// Rings: particles, number of the first, turn of the ring, height above the equator.
const RINGS: [(usize, usize, &str, &str); 4] =
    [(3, 1, "pi/13", "3*pi/8"), (7, 1, "pi/29", "pi/8"), (6, 1, "pi/7", "-2*pi/15"), (4, 0, "pi/17", "-3*pi/10")];

/// The scene as a file.
///
/// ```text
/// L = Σ ṗᵢ²/2 + Σ_{i<j} log |pᵢ − pⱼ|,   |pᵢ|² = 1,   Qᵢ = −α ṗᵢ
/// ```
pub(super) fn text() -> String {
    let particles: usize = RINGS.iter().map(|ring| ring.0).sum();
    let mut text = String::from(
        "format = 1\ntitle = \"Elliptic Fekete points\"\n\
         source = \"Test Set for Initial Value Problem Solvers, II.17: Fekete\"\n\n[parameters]\nalpha = 0.5\n\n[coordinates]\n",
    );
    let mut i = 0;
    // writing to a string cannot fail
    for (count, first, turn, height) in RINGS {
        for k in first..first + count {
            i += 1;
            let angle = format!("2*pi*{k}/{count} + {turn}");
            let _ = writeln!(text, "x{i} = {{ start = \"cos({angle})*cos({height})\" }}");
            let _ = writeln!(text, "y{i} = {{ start = \"sin({angle})*cos({height})\" }}");
            let _ = writeln!(text, "z{i} = {{ start = \"sin({height})\" }}");
        }
    }
    let each = |of: &dyn Fn(usize) -> String, between: &str| (1..=particles).map(of).collect::<Vec<_>>().join(between);
    let pairs = |i: usize| {
        let others = (i + 1..=particles).map(|j| format!("log(dot(p{i} - p{j}, p{i} - p{j}))/2"));
        others.map(|term| format!(" + {term}")).collect::<String>()
    };
    let _ = writeln!(text, "\n[definitions]\n{}", each(&|i| format!("p{i} = \"[x{i}, y{i}, z{i}]\""), "\n"));
    let kinetic = each(&|i| format!("dot(p{i}', p{i}')/2"), " + ");
    let _ = writeln!(text, "\n[system]\nlagrangian = \"{kinetic}{}\"", each(&pairs, ""));
    let _ = writeln!(text, "constraints = [{}]", each(&|i| format!("\"dot(p{i}, p{i}) - 1\""), ", "));
    let along = |line: &dyn Fn(&str) -> String| {
        each(&|i| ["x", "y", "z"].map(|axis| line(&format!("{axis}{i}"))).join("\n"), "\n")
    };
    let _ = writeln!(text, "\n[system.forces]\n{}", along(&|q| format!("{q} = \"-alpha*{q}'\"")));
    let _ = writeln!(text, "\n[start.velocities]\n{}", along(&|q| format!("\"{q}'\" = 0")));
    text + "\n[run]\nduration = 1000\n"
}
