//! Faults of bodies, each with its place.

use scene::Scene;

const ARM: &str = r#"title = "Arm on a cart"
gravity = [0, 0, -9.81]
[coordinates]
x = { start = 0 }
a = { start = 0.3 }
r = { start = 0 }
[body.cart]
joint = { slider = [1, 0, 0], shift = "x" }
mass = 3
[body.arm]
on = "cart"
joint = { hinge = [0, 1, 0], angle = "a", at = [0, 0, 0.3] }
shape = "rod"
size = [1.2]
mass = 0.5
[body.wheel]
on = "cart"
joint = { hinge = [0, 1, 0], angle = "r", at = [0, 0, 0.1] }
shape = "wheel"
size = [0.1]
mass = 0.1
[contact.wheel]
of = "wheel"
law = "rolls"
[spring.wall]
joint = "cart"
stiffness = 2
[damper.arm]
joint = "arm"
damping = 0.1
[motor.wheel]
joint = "wheel"
force = "cos(t)"
[start.velocities]
"a'" = 0
"r'" = 1
[run]
duration = 1
"#;

const SLIDER: &str = "joint = { slider = [1, 0, 0], shift = \"x\" }";

/// What `right` is replaced by, and the beginning of the message that follows.
const FAULTS: &[(&str, &str, &str)] = &[
    ("gravity = [0, 0, -9.81]", "gravity = -9.81", "2:11: expected a vector"),
    ("gravity = [0, 0, -9.81]", "gravity = [1]", "2:11: 1 numbers where 3 are needed"),
    ("gravity = [0, 0, -9.81]", "gravity = [0, 0, \"-G\"]", "2:20: undefined name `G`"),
    ("[body.cart]\n", "[body.cart]\nmas = 1\n", "8:1: unknown key `mas` in [body.cart], did you mean `mass`?"),
    (
        "slider = [1, 0, 0], shift",
        "slider = [1, 0, 0], shft",
        "8:31: unknown key `shft` in [body.cart.joint], did you mean `shift`?",
    ),
    (
        "slider = [1, 0, 0]",
        "slider = [1, 0, 0], hinge = [1, 0, 0]",
        "8:9: a joint is one of hinge, slider, plane, ball, surface and fixed; found hinge and slider",
    ),
    (
        "joint = { slider = [1, 0, 0], shift = \"x\" }",
        "joint = {}",
        "8:9: a joint is one of hinge, slider, plane, ball, surface and fixed; found none",
    ),
    (", shift = \"x\"", "", "8:1: `shift` is missing in [body.cart.joint]"),
    ("shift = \"x\"", "shift = \"y\"", "8:40: undefined name `y`"),
    ("mass = 3", "mass = \"[1, 2]\"", "9:8: expected a number, found a vector of 2"),
    ("mass = 3", "mass = true", "9:8: expected a number or an expression in quotes, found true or false"),
    ("mass = 3", "mass = 3\nat = [0, 0, 0]", "10:1: `at` places a body that has no `joint`"),
    ("mass = 3", "mass = 3\ninertia = [1, 2]", "10:11: 2 numbers where 3 are needed"),
    ("mass = 3", "mass = 3\ninertia = [[1, 0, 0], [0, 1]]", "10:23: 2 numbers where 3 are needed"),
    ("mass = 3", "mass = 3\ninertia = [[1, 0, 0], [0, 1, 0]]", "10:11: 2 rows where 3 are needed"),
    ("mass = 3", "mass = 3\nmass-centre = \"3\"", "10:15: expected a vector of 2 or 3, found a number"),
    ("mass = 3", "mass = 3\nsize = [1]", "7:7: `shape` is missing in [body.cart]"),
    (
        "on = \"cart\"\njoint = { hinge = [0, 1, 0], angle = \"a\"",
        "on = \"car\"\njoint = { hinge = [0, 1, 0], angle = \"a\"",
        "11:6: there is no body `car`, did you mean `cart`?",
    ),
    (
        "[body.cart]\n",
        "[body.cart]\non = \"arm\"\n",
        "7:7: these bodies stand on one another in a circle: cart → arm → cart",
    ),
    ("angle = \"a\"", "axes = \"a\", angle = \"a\"", "12:37: expected a rotation that bodies can be built on"),
    ("shape = \"rod\"", "shape = \"stick\"", "10:7: expected one of point, rod"),
    ("size = [1.2]", "size = [1.2, 1]", "10:7: the size of a rod is [length], found 2 numbers"),
    ("of = \"wheel\"", "of = \"whel\"", "23:6: there is no body `whel`, did you mean `wheel`?"),
    ("of = \"wheel\"\n", "", "22:10: `of` is missing in [contact.wheel]"),
    ("law = \"rolls\"", "law = \"roll\"", "24:7: expected one of rolls, blade, slides, rubber, found \"roll\""),
    (
        "law = \"rolls\"",
        "law = \"rolls\"\non = \"arm\"",
        "25:6: nothing can stand on `arm`: contacts are on planes and tables, in cones",
    ),
    ("law = \"rolls\"", "law = \"rolls\"\nat = [0, 0, 1]", "22:10: a wheel touches where its shape says"),
    ("at = [0, 0, 0.1]", "at = [0, 0, 0.2]", "22:10: contact wheel: height is 1.000e-1 off, wherever the bodies are"),
    ("joint = \"cart\"", "joint = \"cat\"", "26:9: there is no body `cat`, did you mean `cart`?"),
    ("joint = \"cart\"\n", "", "25:9: expected `joint = \"BODY\"` or `between`"),
    ("joint = \"cart\"", "between = { arm = [1, 0, 0] }", "25:9: expected `joint = \"BODY\"` or `between`"),
    ("stiffness = 2", "stiffness = 2\nlenght = 1", "28:1: unknown key `lenght` in [spring.wall]"),
    ("stiffness = 2\n", "", "25:9: `stiffness` is missing in [spring.wall]"),
    ("damping = 0.1\n", "", "28:9: `damping` is missing in [damper.arm]"),
    ("force = \"cos(t)\"", "force = \"cos(u)\"", "33:14: undefined name `u`"),
    ("[motor.wheel]\njoint", "[loop.wheel]\njoint", "31:7: `between` is missing in [loop.wheel]"),
    (SLIDER, "joint = { plane = [\"x\", 0] }", "8:19: 2 numbers where 3 are needed"),
    (SLIDER, "joint = { ball = \"x\" }", "8:18: expected a rotation that bodies can be built on"),
    ("shift = \"x\"", "shift = \"x\", angle = \"a\"", "8:44: `angle` goes with `hinge`"),
    (SLIDER, "joint = { fixed = false }", "8:19: expected true, found \"false\""),
    (SLIDER, "rotation = \"rotation(z)\"", "8:12: expected a rotation that bodies can be built on"),
    (SLIDER, "at = [1, 2, 3, 4]", "8:6: 4 numbers where 3 are needed"),
    (
        SLIDER,
        "joint = { surface = [\"x\", 0] }",
        "8:9: `cart` has a joint `surface`: it is a ball or a point, on a cone",
    ),
    (SLIDER, "joint = { surface = [\"x\"] }", "8:21: 1 numbers where 2 are needed"),
    (SLIDER, "joint = { fixed = true, rotation = \"rotation(z, x)\" }", "8:25: `rotation` goes with `surface`"),
    ("at = [0, 0, 0.3]", "at = [0, 0, \"h\"]", "12:56: undefined name `h`"),
    ("at = [0, 0, 0.3]", "own = 0.3", "12:49: expected a vector"),
    ("law = \"rolls\"", "law = \"rolls\"\nalong = \"x\"", "25:9: expected a vector of 2 or 3, found a number"),
    ("stiffness = 2", "stiffness = 2\nrest = \"l\"", "28:9: undefined name `l`"),
    ("stiffness = 2", "stiffness = 0\nrest = [1]", "28:8: expected a number or an expression in quotes"),
    ("joint = \"cart\"", "between = { arm = [1, 0, 0], wal = [0, 0, 0] }", "26:30: there is no body `wal`"),
    ("\"r'\" = 1", "\"R'\" = 1", "36:1: `R'` is no"),
];

#[test]
fn every_fault_of_bodies_has_its_place() {
    Scene::parse("arm", ARM).unwrap_or_else(|e| panic!("{e}"));
    let mut missed = Vec::new();
    for (right, wrong, message) in FAULTS {
        assert!(ARM.contains(right), "{right}");
        let text = ARM.replacen(right, wrong, 1);
        let error = match Scene::parse("arm", &text) {
            Ok(_) => panic!("{wrong} is read"),
            Err(error) => error.to_string(),
        };
        if !error.starts_with(&format!("arm:{message}")) {
            missed.push(format!("{wrong}: {error}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

/// The height of a wheel that is a coordinate follows from the contact; its guess is a number.
#[test]
fn a_guess_is_a_number() {
    let text = ARM.replace("r = {", "z = { guess = 0.3 }\nr = {").replace("at = [0, 0, 0.1]", "at = [0, 0, \"z\"]");
    let scene = Scene::parse("arm", &text).unwrap_or_else(|e| panic!("{e}"));
    assert!((scene.start.q[2] - 0.1).abs() < 1e-14, "{:?}", scene.start);
    let error = Scene::parse("arm", &text.replace("guess = 0.3", "guess = \"0.3\"")).map(drop).unwrap_err().to_string();
    assert!(error.starts_with("arm:6:15: expected a number"), "{error}");
    let error = Scene::parse("arm", &ARM.replace("r = { start", "r = { guess")).map(drop).unwrap_err().to_string();
    assert!(error.starts_with("arm:6:1: `start` is missing in [coordinates.r]"), "{error}");
}

#[test]
fn names_of_bodies_take_none_from_the_user() {
    let text = ARM.replace("[body.cart]", "[definitions]\ncart_at = 3\n\"arm_L\" = 2\n[body.cart]");
    let scene = Scene::parse("arm", &text).unwrap_or_else(|e| panic!("{e}"));
    let formulas = scene.meant.map(|meant| meant.formulas).unwrap_or_default();
    assert!(formulas.contains("cart_at_ = \"[x, 0, 0]\"") && formulas.contains("arm_L_ = "), "{formulas}");
}

#[test]
fn formulas_and_bodies_mix() {
    let own = "[system]\nlagrangian = \"5*a\"\nconstraints = [\"a' - x'\"]\nforces = { a = \"2\" }\n";
    let text = ARM.replace("[start.velocities]\n\"a'\" = 0\n", &format!("{own}[start.velocities]\n"));
    let [scene, alone] = [&text, ARM].map(|text| Scene::parse("arm", text).unwrap_or_else(|e| panic!("{e}")));
    let [(g, l), (h, k)] = [&scene, &alone].map(|s| (&s.system.graph, s.system.lagrangian));
    let a = g.find_symbol("a").expect("a coordinate");
    let more = g.sub(l, g.mul(g.integer(5), g.variable(a)));
    assert_eq!(g.plain(more), h.plain(k));
    let plain: Vec<String> = scene.system.constraints.iter().map(|&f| g.plain(f)).collect();
    assert_eq!(plain, ["a' - x'", "x' - 0.1*r'"]);
    assert_eq!(g.plain(scene.system.forces[1]), "2 - 0.1*a'");
}

/// Texts that are hard on a reader of brackets, chains and names.
#[test]
fn no_text_of_bodies_panics() {
    let deep = format!("{}x{}", "(".repeat(10_000), ")".repeat(10_000));
    let chain: String =
        (0..300).map(|i| format!("[body.b{}]\non = \"b{i}\"\njoint = {{ fixed = true }}\n", i + 1)).collect();
    let texts = [
        ARM.replace("shift = \"x\"", &format!("shift = \"{deep}\"")),
        ARM.replace("angle = \"a\"", "angle = \"+-+-\""),
        ARM.replace("angle = \"a\"", "angle = \"1e-\""),
        ARM.replace("angle = \"a\"", "angle = \")(\""),
        ARM.replace("[0, 1, 0], angle = \"a\"", "\"][\", angle = \"a\""),
        ARM.replace("[body.arm]", "[body.\"ä rm'\"]"),
        ARM.replace("[body.cart]", "[body.\"\"]"),
        ARM.replace("of = \"wheel\"", "of = \"\""),
        ARM.replace("[spring.wall]", &format!("[body.b0]\n{chain}[spring.wall]")),
        "body = 1".into(),
        "title = \"x\"\nbody.a = 2\n[coordinates]\nx = { start = 0 }\n[run]\nduration = 1".into(),
        "title = \"x\"\n[body]\n[coordinates]\nx = { start = 0 }\n[run]\nduration = 1".into(),
    ];
    for text in texts {
        drop(Scene::parse("arm", &text));
    }
}

/// A body of that name comes before space itself.
#[test]
fn a_body_may_be_called_space() {
    let named = |name: &str| {
        let text = ARM.replace("[body.wheel]", &format!("[body.{name}]")).replace("\"wheel\"", &format!("\"{name}\""));
        let between = format!("between = {{ arm = [1, 0, 0], {name} = [0, 0, 1] }}");
        let text = text.replace(&format!("shape = \"{name}\""), "shape = \"wheel\"");
        let scene = Scene::parse("arm", &text.replace("joint = \"cart\"", &between)).unwrap_or_else(|e| panic!("{e}"));
        scene.system.graph.plain(scene.system.lagrangian)
    };
    assert_eq!(named("space"), named("spare"));
}
