//! Vectors, matrices and rotations in formulas, held against numbers worked out apart.

use std::collections::HashMap;

use symbolic::{Expr, Graph, ParseErrorKind as Kind, Scope, Symbol, Value};

/// Angles `a, b, c` with their rates, a number `s`, vectors `u = (1, 2, 3)` and `v = (a, b, c)`.
struct Names {
    graph: Graph,
    known: Vec<String>,
}

const ANGLES: [(&str, f64, f64); 3] = [("a", 0.3, 0.7), ("b", 1.1, -0.4), ("c", -0.6, 1.3)];

impl Names {
    fn new() -> Self {
        Names { graph: Graph::new(), known: Vec::new() }
    }

    fn symbol(&self, name: &str) -> Symbol {
        self.graph.symbol(name)
    }

    fn angles(&self) -> Vec<Expr> {
        ANGLES.iter().map(|(name, ..)| self.graph.variable(self.symbol(name))).collect()
    }

    fn flow(&self) -> Vec<(Symbol, Expr)> {
        let rate = |name: &str| self.graph.variable(self.symbol(&format!("{name}'")));
        ANGLES.iter().map(|(name, ..)| (self.symbol(name), rate(name))).collect()
    }

    fn read(&self, text: &str) -> Value {
        self.graph.parse_value(text, self).unwrap_or_else(|e| panic!("{e}"))
    }

    /// Its numbers after `time`, the angles turning at their rates.
    fn numbers(&self, text: &str, time: f64) -> Vec<f64> {
        let mut values = HashMap::from([(self.symbol("s"), 0.5)]);
        for (name, angle, rate) in ANGLES {
            values.insert(self.symbol(name), angle + rate * time);
            values.insert(self.symbol(&format!("{name}'")), rate);
        }
        self.read(text).entries().iter().map(|&e| self.graph.evaluate(e, &values).expect(text)).collect()
    }

    fn refused(&self, text: &str, piece: &str) -> Kind {
        let error = self.graph.parse_value(text, self).expect_err(text);
        assert_eq!(&error.text[error.offset..error.offset + error.length], piece, "{error}");
        error.kind
    }
}

impl Scope for Names {
    fn value(&self, name: &str) -> Option<Value> {
        let g = &self.graph;
        match name {
            "u" => Some(Value::Vector((1..=3).map(|i| g.integer(i)).collect())),
            "v" => Some(Value::Vector(self.angles())),
            "s" | "a" | "b" | "c" | "a'" | "b'" | "c'" => Some(Value::Scalar(g.variable(g.symbol(name)))),
            _ => None,
        }
    }

    fn rate(&self, e: Expr) -> Option<Expr> {
        let rates = self.graph.symbols_of(e).iter().any(|&s| self.graph.name(s).contains('\''));
        (!rates).then(|| self.graph.total_derivative(e, &self.flow()))
    }

    fn known(&self) -> &[String] {
        &self.known
    }
}

#[track_caller]
fn near(found: &[f64], expected: &[f64], limit: f64) {
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() <= limit), "{found:?}\n{expected:?}");
}

#[test]
fn arithmetic() {
    let names = Names::new();
    near(&names.numbers("u + 2*[1, 0, -1] - u/2", 0.0), &[2.5, 1.0, -0.5], 0.0);
    near(&names.numbers("dot(u, [4, 5, 6])", 0.0), &[32.0], 0.0);
    near(&names.numbers("cross(u, [4, 5, 6])", 0.0), &[-3.0, 6.0, -3.0], 0.0);
    near(&names.numbers("norm([3, 4]) + u.z", 0.0), &[8.0], 0.0);
    near(&names.numbers("[[1, 2, 3], [4, 5, 6]]*u", 0.0), &[14.0, 32.0], 0.0);
    near(&names.numbers("[[1, 2], [3, 4]]*[[0, 1], [1, 0]]", 0.0), &[2.0, 1.0, 4.0, 3.0], 0.0);
    near(&names.numbers("transpose([[1, 2], [3, 4]])", 0.0), &[1.0, 3.0, 2.0, 4.0], 0.0);
    near(&names.numbers("diag(1, s, 3)*u", 0.0), &[1.0, 1.0, 9.0], 0.0);
    near(&names.numbers("-[[1, 2], [3, 4]].yx", 0.0), &[-3.0], 0.0);
    near(
        &names.numbers("(a*v)' + (v)'", 0.0),
        &{
            let (a, rate) = (ANGLES[0].1, ANGLES[0].2);
            ANGLES.map(|(_, x, x_rate)| rate * x + a * x_rate + x_rate)
        },
        1e-15,
    );
    // halfway up both edges, and in between
    near(
        &names.numbers("[step(1, 1, 3, 0.01), step(2, 1, 3, 0.01), step(4, 1, 3, 0.01)]", 0.0),
        &[0.5, 1.0, 0.0],
        1e-15,
    );
}

/// `R = R_z(a) R_x(b) R_z(c)` by its nine entries (any textbook), and `R(n, α)` by Rodrigues on a vector.
#[test]
fn rotations() {
    let names = Names::new();
    let [(_, a, _), (_, b, _), (_, c, _)] = ANGLES;
    let ((sa, ca), (sb, cb), (sc, cc)) = (a.sin_cos(), b.sin_cos(), c.sin_cos());
    let expected = [
        ca * cc - sa * cb * sc,
        -ca * sc - sa * cb * cc,
        sa * sb,
        sa * cc + ca * cb * sc,
        -sa * sc + ca * cb * cc,
        -ca * sb,
        sb * sc,
        sb * cc,
        cb,
    ];
    near(&names.numbers("rotation(zxz, a, b, c)", 0.0), &expected, 1e-15);
    near(&names.numbers("rotation(\"zxz\", a, b, c)", 0.0), &expected, 1e-15);
    near(&names.numbers("rotation(z, a)*rotation([1, 0, 0], b)*rotation([0, 0, 2], c)", 0.0), &expected, 1e-15);
    let turned = names.numbers("rotation([2, 0, 0], pi/2)*[0, 1, 0]", 0.0);
    near(&turned, &[0.0, 0.0, 1.0], 1e-15);
    let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    near(&names.numbers("rotation(u, a)*transpose(rotation(u, a))", 0.0), &identity, 1e-15);
    near(&names.numbers("rotation(u, a)*u", 0.0), &[1.0, 2.0, 3.0], 1e-14);
}

/// `Ṙ = [ω]× R`, by differences in time; in the body `Rᵀ ω`. The axis of the last one moves.
#[test]
fn angular_velocities_are_those_of_the_moving_matrix() {
    let names = Names::new();
    for rotation in [
        "rotation(zxz, a, b, c)",
        "rotation(xyz, a, b, c)",
        "rotation(u, a)*transpose(rotation(y, b))*rotation(xz, c, s)",
        "rotation(v, b)*rotation(z, c)",
    ] {
        let h = 1e-3;
        let at = |time: f64| names.numbers(rotation, time);
        let weights = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)];
        let rate: Vec<f64> =
            (0..9).map(|i| weights.iter().map(|(k, w)| w * (at(k * h)[i] - at(-k * h)[i]) / h).sum()).collect();
        let now = at(0.0);
        let spin = |i: usize, j: usize| (0..3).map(|k| rate[3 * i + k] * now[3 * j + k]).sum::<f64>();
        let omega = [spin(2, 1), spin(0, 2), spin(1, 0)];
        near(&names.numbers(&format!("angular_velocity({rotation})"), 0.0), &omega, 1e-11);
        let in_body: Vec<f64> = (0..3).map(|j| (0..3).map(|i| now[3 * i + j] * omega[i]).sum()).collect();
        near(&names.numbers(&format!("body_angular_velocity({rotation})"), 0.0), &in_body, 1e-11);
    }
}

#[test]
fn what_means_nothing_is_refused_at_its_place() {
    let names = Names::new();
    assert!(matches!(names.refused("u*v", "*"), Kind::Shapes { verb: "multiplied", .. }));
    assert!(matches!(names.refused("u + 1", "+"), Kind::Shapes { verb: "added", .. }));
    assert!(matches!(names.refused("u - [1, 2]", "-"), Kind::Shapes { .. }));
    assert!(matches!(names.refused("sin(2 + a*u)", "+"), Kind::Shapes { .. }));
    assert!(matches!(names.refused("sin(u)", "u"), Kind::NotANumber { .. }));
    assert!(matches!(names.refused("1/u", "u"), Kind::NotANumber { .. }));
    assert!(matches!(names.refused("u^2", "u"), Kind::NotANumber { .. }));
    assert!(matches!(names.refused("[1]", "[1]"), Kind::NoList));
    assert!(matches!(names.refused("[1, u]", "[1, u]"), Kind::NoList));
    assert!(matches!(names.refused("[1, 2", "["), Kind::UnclosedParenthesis));
    assert!(matches!(names.refused("u[1]", "["), Kind::NoComponent { .. }));
    assert!(matches!(names.refused("a[1, 2]", "["), Kind::ImplicitMultiplication { .. }));
    assert!(matches!(names.refused("u.w", ".w"), Kind::NoComponent { .. }));
    assert!(matches!(names.refused("a.x", ".x"), Kind::NoComponent { .. }));
    assert!(matches!(names.refused("cross(u, [1, 2])", "cross(u, [1, 2])"), Kind::WrongShape { .. }));
    assert!(matches!(names.refused("norm(a)", "norm(a)"), Kind::WrongShape { .. }));
    assert!(matches!(names.refused("rotation(zxz, a, b)", "zxz"), Kind::Axes { found: 2, .. }));
    assert!(matches!(names.refused("rotation(a, b)", "rotation(a, b)"), Kind::WrongShape { .. }));
    assert!(matches!(names.refused("rotation(z a)", "a"), Kind::UnexpectedToken { .. }));
    assert!(matches!(
        names.refused("angular_velocity(diag(1, 1, 1))", "angular_velocity(diag(1, 1, 1))"),
        Kind::WrongShape { .. }
    ));
    assert!(matches!(names.refused("(a*b')'", "'"), Kind::NoRate));
    assert!(matches!(
        names.refused("angular_velocity(rotation(z, b'))", "angular_velocity(rotation(z, b'))"),
        Kind::NoRate
    ));
    assert!(matches!(
        names.refused("step(a, b)", "step(a, b)"),
        Kind::WrongArgumentCount { expected: 4, found: 2, .. }
    ));
    let number = names.graph.parse("u", &names).unwrap_err();
    assert!(matches!(number.kind, Kind::NotANumber { .. }), "{number}");
}
