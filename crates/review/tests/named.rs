//! Classic mistakes by name, other formulations, tables, and what cannot be read.

use std::fmt::Write;
use std::time::{Duration, Instant};

use review::{Asked, Numbers, Review, Verdict, review, states};
use scene::Scene;

fn asked(wheres: &[&str]) -> Asked {
    Asked { wheres: wheres.iter().map(|text| (*text).to_string()).collect(), ..Asked::default() }
}

fn of(scene: &str, theirs: &str) -> Review {
    review(&scene::catalogue::find(scene, &[]).unwrap(), "theirs", theirs, &Asked::default()).unwrap()
}

/// The rolling disc of the documentation of SymPy, for Lagrange's equations, derived anew by hand: three
/// angles, the velocity of the centre taken from rolling, `V = -m g r cos q2`.
#[test]
fn the_documented_disc_has_the_constraint_in_l_and_gravity_upwards() {
    let theirs = "w = q1'*sin(q2) + q3'     # spin about the axle
        a = 3/2*m*r^2
        b = 5/4*m*r^2
        c = m*r^2/4
        a*w'*sin(q2) + a*w*cos(q2)*q2' + c*cos(q2)^2*q1'' - 2*c*cos(q2)*sin(q2)*q1'*q2' = 0
        b*q2'' - a*w*q1'*cos(q2) + c*cos(q2)*sin(q2)*q1'^2 + m*g*r*sin(q2) = 0
        a*w' = 0";
    let wheres = ["phi = q1", "theta = -q2", "psi = q3", "R = r", "I = m*r^2/2", "J = m*r^2/4"];
    let scene = scene::catalogue::find("falling-disc", &[]).unwrap();
    let clock = Instant::now();
    let found = review(&scene, "disc", theirs, &asked(&wheres)).unwrap();
    assert!(clock.elapsed() < Duration::from_secs(1), "{:?}", clock.elapsed());
    assert_eq!((found.verdict, found.numbers), (Verdict::Wrong, Some(Numbers::Field)));
    let words = ["constraint put into L", "gravity upwards (T + V instead of T − V)"];
    assert_eq!(found.explanations[0], words, "{found:?}");
    // with gravity downwards only the first is left
    let downwards = theirs.replace("+ m*g*r*sin(q2)", "- m*g*r*sin(q2)");
    let found = review(&scene, "disc", &downwards, &asked(&wheres)).unwrap();
    assert_eq!(found.explanations[0], ["constraint put into L"]);
}

#[test]
fn other_formulations_are_named_whatever_their_multipliers_are_called() {
    let vakonomic = "m*x'' - m*a*phi''*sin(phi) - phi'*(m*a*phi'*cos(phi) + k*cos(phi)) - k'*sin(phi) = 0
        m*a*phi''*cos(phi) + m*y'' - phi'*(m*a*phi'*sin(phi) + k*sin(phi)) + k'*cos(phi) = 0
        m*a*y''*cos(phi) - m*a*x''*sin(phi) + phi''*(m*a^2 + I) + k*(x'*cos(phi) + y'*sin(phi)) = 0
        y'*cos(phi) - x'*sin(phi) = 0";
    let turned = vakonomic.replace("k'", "(-mu')").replace("k*", "(-mu)*");
    let sleigh = scene::catalogue::find("sleigh", &[]).unwrap();
    for theirs in [vakonomic, &turned] {
        let found = of("sleigh", theirs);
        assert_eq!(found.verdict, Verdict::Wrong);
        assert_eq!(found.explanations[0], ["vakonomic equations"]);
        let to_be = Asked { formulation: motion::VAKONOMIC, ..Asked::default() };
        assert_eq!(review(&sleigh, "theirs", theirs, &to_be).unwrap().verdict, Verdict::Right);
    }
    // uniform motion along the blade and about it: m u'' = 0, phi'' = 0
    let found = of("sleigh", "u = x'*cos(phi) + y'*sin(phi)\nx'' = -u*phi'*sin(phi)\ny'' = u*phi'*cos(phi)\nphi'' = 0");
    assert_eq!(found.explanations[0], ["removed constraint equations (quasi-velocities)"]);
}

#[test]
fn mistakes_about_bodies_are_named() {
    let disc = "m*x'' = X\nm*y'' = Y\nI*psi'' = -R*(X*cos(phi) + Y*sin(phi))\nJ*phi'' = 0\n\
                x' = R*psi'*cos(phi)\ny' = R*psi'*sin(phi)";
    assert_eq!(of("disc", disc).verdict, Verdict::Right);
    let sleigh = "m*x'' - m*a*(phi''*sin(phi) + phi'^2*cos(phi)) = -N*sin(phi)
        m*y'' + m*a*(phi''*cos(phi) - phi'^2*sin(phi)) = N*cos(phi)
        I*phi'' = m*a*(x''*sin(phi) - y''*cos(phi))\ny'*cos(phi) = x'*sin(phi)";
    for (scene, theirs, said) in [
        (
            "disc",
            &disc.replace("R*", "(-R)*"),
            "R has the wrong sign in the constraints, as for a contact on the other side",
        ),
        ("disc", &disc.replace("sin(phi)", "sin(-phi)"), "phi turns the other way in the constraints"),
        // the moment of inertia about the mass centre, for rates about the blade
        ("sleigh", &sleigh.to_string(), "`m*a^2*phi'^2/2` is missing in L"),
    ] {
        let found = of(scene, theirs);
        assert_eq!(found.verdict, Verdict::Wrong, "{theirs}");
        assert!(found.explanations[0][0].starts_with(said), "{said}: {found:?}");
    }
}

#[test]
fn numbers_of_the_scene_are_enough_where_theirs_have_no_names() {
    let scene = scene::catalogue::find("planar-body", &[]).unwrap();
    let text = "title = \"fall\"\n[parameters]\nm = 2\ng = 9.81\nr = 1\n[coordinates]\nz = { start = 0 }\n[system]\n\
                lagrangian = \"m*r^2*z'^2/2 - m*g*r*z\"\n[start.velocities]\n\"z'\" = 0\n[run]\nduration = 1\n";
    let fall = Scene::parse("fall", text).unwrap();
    let by = |theirs: &str| review(&fall, "theirs", theirs, &Asked::default()).unwrap();
    let found = by("z'' = -9.81");
    assert_eq!((found.verdict, found.notes.len()), (Verdict::Right, 1), "{found:?}");
    assert_eq!(by("z'' = -9.82").verdict, Verdict::Wrong);
    // r = 1 hides a factor r; their names are those of the scene
    let found = by("m*r*z'' = -m*g*r");
    assert_eq!(found.verdict, Verdict::Wrong);
    assert!(found.explanations[0][0].starts_with("power of r is dropped in `m*r^2*z'^2/2` of L"), "{found:?}");
    assert_eq!(states(&scene).len(), 8);
}

#[test]
fn tables_of_accelerations_are_reviewed_in_floats() {
    let scene = scene::catalogue::find("sleigh", &[]).unwrap();
    // by hand: u' = a w², w' = −m a u w/(I + m a²) along the blade
    let value = |name: &str| {
        scene
            .system
            .expression(name)
            .ok()
            .and_then(|e| scene.system.graph.evaluate(e, &scene.system.parameter_values()).ok())
            .unwrap()
    };
    let (m, a, i) = (value("m"), value("a"), value("I"));
    for (sign, verdict) in [(1.0, Verdict::Right), (-1.0, Verdict::Wrong)] {
        let mut table = String::from("t,x,y,phi,x',y',phi',x'',y'',phi''\n");
        for s in states(&scene) {
            let (sine, cosine) = s.q[2].sin_cos();
            let (u, w) = (s.v[0] * cosine + s.v[1] * sine, s.v[2]);
            let (du, dw) = (sign * a * w * w, -m * a * u * w / (i + m * a * a));
            let (ax, ay) = (du * cosine - u * w * sine, du * sine + u * w * cosine);
            let numbers = [s.t, s.q[0], s.q[1], s.q[2], s.v[0], s.v[1], s.v[2], ax, ay, dw];
            let _ = writeln!(table, "{}", numbers.map(|x| format!("{x:.12}")).join(","));
        }
        let found = review(&scene, "motion.csv", &table, &Asked::default()).unwrap();
        assert_eq!((found.verdict, found.numbers), (verdict, Some(Numbers::Floats)), "{found:?}");
        assert_eq!(found.differences.is_empty(), verdict == Verdict::Right);
    }
}

#[test]
fn functions_of_c_by_hand_are_read() {
    let scene = scene::catalogue::find("sleigh", &[]).unwrap();
    let body = "double u = X[3]*cos(X[2]) + X[4]*sin(X[2]), w = X[5], s = a*w*w;
        D[0] = s*cos(X[2]) - u*sin(X[2])*w; /* forwards */
        D[1] = s*sin(X[2]); D[1] += u*w*cos(X[2]);
        D[2] = -m*a*u*w/(I + m*pow(a, 2));";
    let whole =
        format!("void f(double t, const double *y, double *acc) {{ {} }}", body.replace('X', "y").replace('D', "acc"));
    let apart = body
        .replace("X[3]", "v[0]")
        .replace("X[4]", "v[1]")
        .replace("X[5]", "v[2]")
        .replace('X', "q")
        .replace('D', "out");
    let apart = format!("void f(const double q[3], const double v[3], double out[3])\n{{ {apart} }}");
    for code in [&whole, &apart] {
        let found = review(&scene, "f.c", code, &Asked::default()).unwrap();
        assert_eq!(found.verdict, Verdict::Right, "{code}: {found:?}");
    }
    let found = review(&scene, "f.c", &whole.replace("+= u*w", "-= u*w"), &Asked::default()).unwrap();
    assert_eq!(found.verdict, Verdict::Wrong);
}

#[test]
fn where_nothing_explains_them_coefficients_are_told() {
    let found = of("sleigh", "phi'' = x'*phi'\nx'' = 3*x'*phi'\ny'' = x'^2");
    assert_eq!((found.verdict, found.explanations.len()), (Verdict::Wrong, 0));
    let in_y: Vec<(&str, f64)> =
        found.coefficients.iter().filter(|c| c.name == "y''").map(|c| (&c.monomial[..], c.theirs)).collect();
    assert!(in_y.contains(&("x'*x'", 1.0)) && in_y.contains(&("x'*phi'", 0.0)), "{found:?}");
}

#[test]
fn what_cannot_be_read_is_refused_with_its_place() {
    let scene = scene::catalogue::find("sleigh", &[]).unwrap();
    for (file, text, said) in [
        ("a.txt", "phi'' = 0\nx'' = 3 + * x", "a.txt:2:11: expected a number, a name or `(`, found `*`"),
        ("a.txt", "x''' = 0", "a.txt:1:1: undefined name `x'''`"),
        ("a.txt", "x'' = y'' = 0", "a.txt:1: more than one `=` stands in the line"),
        ("a.tex", "\\ddot{x} = \\frac{1}{2 x", "a.tex:1: `}` is missing"),
        ("a.tex", &format!("x = {}", "(".repeat(10_000)), "a.tex:1: more than 200 operands"),
        ("a.tex", &format!("x = {}", "\\sin".repeat(10_000)), "a.tex:1: more than 200 operands"),
        ("a.tex", "\\ddot{x} = \\int x", "a.tex:1: `\\int` is not read"),
        ("a.c", "void rates(double t, double *y, double *d)\n{\n for (;;) d[0] = 1;\n}", "a.c:3: `for ("),
        ("a.c", "double x = 1;", "a.c:1: there is no function that assigns to the entries of an array"),
        ("a.csv", "x,y,phi,x',y',phi'\n1,2,3,4,5,6\n", "there is no column `x''`"),
    ] {
        let error = review(&scene, file, text, &Asked::default()).unwrap_err().to_string();
        assert!(error.contains(said), "{file}: {error}");
    }
    let error = review(&scene, "a", "x'' = 0", &asked(&["z = q"])).unwrap_err().to_string();
    assert!(error.contains("`z` is neither a coordinate nor a parameter of the scene"), "{error}");
    for (text, said) in [
        ("x''^2 = 1", "`x''^2 = 1` is not linear in accelerations and multipliers"),
        ("x'' = 0", "these equations do not determine phi''"),
    ] {
        let found = review(&scene, "a", text, &Asked::default()).unwrap();
        assert_eq!((found.verdict, &found.notes[0][..]), (Verdict::Undecided, said), "{found:?}");
    }
}

/// Texts with letters lost, doubled and exchanged: read or refused, in time, and no panic.
#[test]
fn nonsense_is_read_or_refused() {
    let scene = scene::catalogue::find("sleigh", &[]).unwrap();
    let latex = "\\begin{aligned} m \\ddot{x} &= -N_{1} \\sin \\varphi \\\\ m\\ddot y &= \\frac{N_1}{1}\\cos{\\varphi}, \\\\ \
                 I \\ddot{\\varphi} &= \\left(a^{2} - \\dot\\varphi\\right) N_1 \\sqrt{2} \\end{aligned}";
    let c = "#define N 3\nint f_rates(double t, const double y[6], const par *p, double d[6])\n{\n  const double s = sin(y[2]), c = cos(y[2]);\n  \
             double m[4] = {p->m, 1.0e-3, s, 2.5f};\n  d[0] = y[3]; d[1] = y[4]; d[2] = y[5]; /* é */\n  d[3] = (double)s*c; d[4] = m[0]; d[5] = pow(s, 2); \n  \
             if (solve(2, m, &d[3])) return 1;\n  return 0;\n}\n";
    let text = "w = x'*cos(phi) # é\nm*x'' - N*sin(phi) = 0; m*y'' == N*cos(phi)\nphi'' = w^2\n";
    let csv = "t,x,y,phi,x',y',phi',x'',y'',phi''\n0,1,2,3,4,5,6,7,8,9\n0,1,2,3,4,5,6,7,8,9\n";
    let mut random = symbolic::SplitMix::new(4);
    for (file, whole) in [("a.tex", latex), ("a.c", c), ("a.txt", text), ("a.csv", csv)] {
        let _ = review(&scene, file, whole, &Asked::default());
        for _ in 0..200 {
            let mut letters: Vec<char> = whole.chars().collect();
            for _ in 0..1 + crate::support::below(&mut random, 4) {
                let (i, j) = (
                    crate::support::below(&mut random, letters.len()),
                    crate::support::below(&mut random, letters.len()),
                );
                match crate::support::below(&mut random, 4) {
                    0 => _ = letters.remove(i),
                    1 => letters.swap(i, j),
                    2 => letters.insert(i, letters[j]),
                    _ => letters.truncate(i.max(9)),
                }
            }
            let spoiled: String = letters.into_iter().collect();
            let _ = review(&scene, file, &spoiled, &Asked::default());
        }
    }
}

#[test]
fn a_text_without_equations_is_refused() {
    let sleigh = scene::catalogue::find("sleigh", &[]).expect("a scene");
    for text in ["", "\n  # nothing yet\n"] {
        let refused =
            review::review(&sleigh, "theirs.txt", text, &review::Asked::default()).expect_err("nothing to read");
        assert_eq!(refused.to_string(), "theirs.txt: there are no equations in it");
    }
}
