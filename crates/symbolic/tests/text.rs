//! Formulas as text: what is refused and how, and what is printed.

use crate::read;
use symbolic::{Expr, Graph, ParseError, ParseErrorKind, Scope, Value};

const NAMES: [&str; 9] = ["x", "y", "phi", "x'", "phi'", "alpha", "lambda_1", "omega", "sinus"];

fn parse(g: &Graph, text: &str) -> Result<Expr, ParseError> {
    g.parse(text, &Names(g, NAMES.map(str::to_owned)))
}

struct Names<'a>(&'a Graph, [String; 9]);

impl Scope for Names<'_> {
    fn value(&self, name: &str) -> Option<Value> {
        NAMES.contains(&name).then(|| Value::Scalar(self.0.variable(self.0.symbol(name))))
    }

    fn known(&self) -> &[String] {
        &self.1
    }
}

/// The text is refused at the given piece.
#[track_caller]
fn refused(text: &str, piece: &str) -> ParseErrorKind {
    let error = parse(&Graph::new(), text).expect_err(text);
    assert_eq!(&error.text[error.offset..error.offset + error.length], piece, "{error}");
    error.kind
}

#[test]
fn every_error_names_its_place() {
    use ParseErrorKind as Kind;
    assert_eq!(refused("", ""), Kind::Empty);
    assert_eq!(refused("  \n", "  \n"), Kind::Empty);
    assert!(matches!(refused("x + $", "$"), Kind::UnexpectedCharacter { found: '$', hint: None }));
    assert!(matches!(refused("x = y", "="), Kind::UnexpectedCharacter { hint: Some(_), .. }));
    assert!(matches!(refused("2*φ", "φ"), Kind::UnexpectedCharacter { hint: Some(h), .. } if h.contains("phi")));
    assert!(matches!(refused("x − y", "−"), Kind::UnexpectedCharacter { hint: Some(_), .. }));
    assert!(matches!(refused("|x|", "|"), Kind::UnexpectedCharacter { hint: Some(_), .. }));
    assert!(matches!(refused("x + * y", "*"), Kind::UnexpectedToken { .. }));
    assert!(matches!(refused("x, y", ","), Kind::UnexpectedToken { .. }));
    assert!(matches!(refused("sin(x, )", ")"), Kind::UnexpectedToken { .. }));
    assert!(matches!(refused("x +", ""), Kind::UnexpectedEnd { .. }));
    assert!(matches!(refused("2^", ""), Kind::UnexpectedEnd { .. }));
    assert_eq!(refused("2*((x + y)", "("), Kind::UnclosedParenthesis);
    assert_eq!(refused("sin(x", "("), Kind::UnclosedParenthesis);
    assert_eq!(refused("x)", ")"), Kind::UnmatchedParenthesis);
    assert_eq!(refused(")", ")"), Kind::UnmatchedParenthesis);
    let suggested = |name: &str, meant: Option<&str>| Kind::Undefined {
        name: name.to_owned(),
        suggestion: meant.map(str::to_owned),
    };
    assert_eq!(refused("1 + lamda_1", "lamda_1"), suggested("lamda_1", Some("lambda_1")));
    assert_eq!(refused("Phi", "Phi"), suggested("Phi", Some("phi")));
    assert_eq!(refused("phi''", "phi''"), suggested("phi''", Some("phi'")));
    assert_eq!(refused("velocity", "velocity"), suggested("velocity", None));
    assert!(matches!(refused("sni(x)", "sni"), Kind::UnknownFunction { suggestion: Some(s), .. } if s == "sin"));
    assert!(matches!(refused("gamma(x)", "gamma"), Kind::UnknownFunction { suggestion: None, .. }));
    for name in ["abs", "sign", "sgn", "min", "max", "floor", "ceil", "round", "mod", "heaviside"] {
        assert!(matches!(refused(&format!("{name}(x)"), name), Kind::NotSmooth { .. }));
    }
    assert!(matches!(refused("1 + sin(x, y)", "sin(x, y)"), Kind::WrongArgumentCount { expected: 1, found: 2, .. }));
    assert!(matches!(refused("atan2(x)", "atan2(x)"), Kind::WrongArgumentCount { found: 1, .. }));
    assert!(matches!(refused("exp()", "exp()"), Kind::WrongArgumentCount { found: 0, .. }));
    assert!(matches!(refused("sin + 1", "sin"), Kind::FunctionWithoutArgument { .. }));
    assert!(matches!(refused("x(y + 1)", "x"), Kind::VariableCalled { .. }));
    assert!(matches!(refused("2 x", "x"), Kind::ImplicitMultiplication { .. }));
    assert!(matches!(refused("2(x + 1)", "("), Kind::ImplicitMultiplication { .. }));
    assert!(matches!(refused("(x)(y)", "("), Kind::ImplicitMultiplication { .. }));
    assert!(matches!(refused("x y", "y"), Kind::ImplicitMultiplication { .. }));
    assert!(matches!(refused("2e", "e"), Kind::ImplicitMultiplication { .. }));
    assert!(matches!(refused("1e999", "1e999"), Kind::NumberOutOfRange { .. }));
    assert!(matches!(refused("1e-999", "1e-999"), Kind::NumberOutOfRange { .. }));
    assert_eq!(refused("x/(y - y) + 1", "(y - y)"), Kind::DivisionByZero);
    assert_eq!(refused("1 + 0^-1", "0^-1"), Kind::DivisionByZero);
    assert_eq!(refused("csc(0)", "csc(0)"), Kind::DivisionByZero);
    assert_eq!(refused("2*log(0)", "log(0)"), Kind::NotFinite);
    assert_eq!(refused("1e308*1e308", "1e308*1e308"), Kind::NotFinite);
    assert_eq!(refused("x + (-2)^0.5", "(-2)^0.5"), Kind::NotFinite);
    // what is 1, or a number of it
    for text in [
        "12345678901234567890123 - 12345678901234567890122",
        "2*6172839450617283945061 - 12345678901234567890122",
        "12345678901234567890123*x - 12345678901234567890122*x",
    ] {
        assert_eq!(refused(text, text), Kind::NotExact);
    }
    let deep = "(".repeat(100_000) + "x" + &")".repeat(100_000);
    assert_eq!(refused(&deep, "("), Kind::TooDeep { limit: 200 });
    assert_eq!(refused(&"sin(".repeat(100_000), "("), Kind::TooDeep { limit: 200 });
    assert_eq!(refused(&"2^".repeat(100_000), "^"), Kind::TooDeep { limit: 200 });
}

#[test]
fn every_message_says_something() {
    for text in ["", "$", "x y", "x(1)", "phy", "1/0", "log(0)", "sin", "1e999", "abs(x)", ")"] {
        let message = parse(&Graph::new(), text).unwrap_err().to_string();
        assert!(message.starts_with("line 1, column 1: ") || !text.is_empty(), "{message}");
        assert!(message.contains('^'), "{message}");
    }
}

#[test]
fn errors_are_shown_with_a_caret() {
    let error = parse(&Graph::new(), "x +\n  2*ph' + 1").unwrap_err();
    assert_eq!((error.line(), error.column()), (2, 5));
    let expected = "line 2, column 5: undefined name `ph'`; did you mean `phi'`?
    2*ph' + 1
      ^^^";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn long_lines_are_cut_round_the_place() {
    let text = "x + ".repeat(1000) + "zz" + &" + y".repeat(1000);
    let message = parse(&Graph::new(), &text).unwrap_err().to_string();
    assert!(message.chars().count() < 320, "{message}");
    let lines: Vec<&str> = message.lines().collect();
    let caret = lines[2].find('^').unwrap();
    assert_eq!(lines[1].chars().skip(caret).take(2).collect::<String>(), "zz");
    let long_name = "q".repeat(10_000_000);
    assert!(parse(&Graph::new(), &long_name).unwrap_err().to_string().len() < 500);
}

#[test]
fn nonsense_of_any_size_is_refused_or_read_quickly() {
    let g = Graph::new();
    assert!(parse(&g, &"@".repeat(10_000_000)).is_err());
    assert!(parse(&g, &"x x ".repeat(2_500_000)).is_err());
    assert!(parse(&g, &("-".repeat(10_000_000) + "(")).is_err());
    let minus = parse(&g, &("-".repeat(1_000_001) + "x")).unwrap();
    assert_eq!(g.plain(minus), "-x");
    let sum = parse(&g, &("x".to_owned() + &"+x".repeat(500_000))).unwrap();
    assert_eq!(g.plain(sum), "500001*x");
    let product = parse(&g, &("x".to_owned() + &"*x".repeat(500_000))).unwrap();
    assert_eq!(g.plain(product), "x^500001");
}

#[test]
fn sugar_means_what_it_says() {
    let g = Graph::new();
    for (sugar, plain) in [
        ("sec(x)", "1/cos(x)"),
        ("csc(x)", "1/sin(x)"),
        ("cot(x)", "cos(x)/sin(x)"),
        ("ln(x)", "log(x)"),
        ("pow(x, y)", "x^y"),
        ("x**2", "x^2"),
        ("+x", "x"),
        ("x^-y", "x^(-y)"),
        ("-x^2", "-(x^2)"),
        ("2^-x^2", "2^(-(x^2))"),
        ("x/y/2", "x/(2*y)"),
        ("x - y - 1", "x - (y + 1)"),
        ("1e-3*2", "0.002"),
        ("x*-y", "-x*y"),
    ] {
        assert_eq!(parse(&g, sugar), parse(&g, plain), "{sugar}");
    }
    let pi = parse(&g, "pi").unwrap();
    assert_eq!(g.as_number(pi), Some(std::f64::consts::PI));
    let tau = |name: &str| (name == "pi").then(|| g.integer(4));
    assert_eq!(g.parse("pi", &tau), Ok(g.integer(4)), "a scope may define it");
}

#[track_caller]
fn prints(text: &str, plain: &str, latex: &str) {
    let g = Graph::new();
    for name in ["m", "g", "alpha", "x", "y", "phi", "x'", "y'", "phi'"] {
        g.symbol(name);
    }
    let e = read(&g, text);
    assert_eq!(g.plain(e), plain);
    assert_eq!(g.latex(e), latex);
}

#[test]
fn expressions_are_printed_readably() {
    prints("x*2", "2*x", "2 x");
    prints("-x*m", "-m*x", "-m x");
    prints("1*x", "x", "x");
    prints("x*1.5", "3*x/2", r"\frac{3}{2} x");
    prints("9.81*m", "9.81*m", "9.81 m");
    prints("m*x'^2/2 - m*g*y", "m*x'^2/2 - m*g*y", r"\frac{1}{2} m \dot{x}^{2} - m g y");
    prints("y'*cos(phi) - x'*sin(phi)", "y'*cos(phi) - x'*sin(phi)", r"\dot{y} \cos \varphi - \dot{x} \sin \varphi");
    prints("x/y", "x/y", r"\frac{x}{y}");
    prints("(x + y)/(2*y)", "(x + y)/(2*y)", r"\frac{x + y}{2 y}");
    prints("1/(x*y^2)", "1/(x*y^2)", r"\frac{1}{x y^{2}}");
    prints("sin(phi)^2", "sin(phi)^2", r"\sin^{2} \varphi");
    prints("sin(2*phi)", "sin(2*phi)", r"\sin\left(2 \varphi\right)");
    prints("-sin(alpha - phi)", "sin(phi - alpha)", r"\sin\left(\varphi - \alpha\right)");
    prints("x - 2*sin(alpha - phi)*y", "x + 2*y*sin(phi - alpha)", r"x + 2 y \sin\left(\varphi - \alpha\right)");
    prints("sqrt(x + y)", "sqrt(x + y)", r"\sqrt{x + y}");
    prints("1/sqrt(x)", "1/sqrt(x)", r"\frac{1}{\sqrt{x}}");
    prints("x^(2/3)", "x^(2/3)", "x^{2/3}");
    prints("(x + y)^2*m", "m*(x + y)^2", r"m \left(x + y\right)^{2}");
    prints("(-2)^x", "(-2)^x", r"\left(-2\right)^{x}");
    prints("exp(-x)", "exp(-x)", r"\mathrm{e}^{-x}");
    prints("exp(x)^2", "exp(x)^2", r"\left(\mathrm{e}^{x}\right)^{2}");
    prints("asin(x)^2", "asin(x)^2", r"\left(\arcsin x\right)^{2}");
    prints("atan2(y, x)", "atan2(y, x)", r"\operatorname{atan2}\left(y, x\right)");
    prints("1 - x", "1 - x", "1 - x");
    prints("-x - 1", "-x - 1", "-x - 1");
    prints("3*2^x", "3*2^x", r"3 \cdot 2^{x}");
    prints("3*sqrt(2)*x", "3*sqrt(2)*x", r"3 \sqrt{2} x");
    prints("2e-7*x", "2e-7*x", r"2 \cdot 10^{-7} x");
    prints("log(x)*(y - x)", "(y - x)*log(x)", r"\left(y - x\right) \ln x");
    prints("(y - x)^-1", "1/(y - x)", r"\frac{1}{y - x}");
    prints("(x - y)^3*m", "m*(x - y)^3", r"m \left(x - y\right)^{3}");
}

#[test]
fn names_are_printed_as_mathematics() {
    let g = Graph::new();
    for (name, latex) in [
        ("x", "x"),
        ("x'", r"\dot{x}"),
        ("x''", r"\ddot{x}"),
        ("x'''", r"\dddot{x}"),
        ("x''''", "{x}^{(4)}"),
        ("phi", r"\varphi"),
        ("phi1", r"\varphi_{1}"),
        ("phi_1'", r"\dot{\varphi}_{1}"),
        ("mu_1", r"\mu_{1}"),
        ("lambda_x", r"\lambda_{x}"),
        ("lambda_phi1", r"\lambda_{\varphi_{1}}"),
        ("lambda_phi1_2", r"\lambda_{\varphi_{1}, 2}"),
        ("Omega", r"\Omega"),
        ("chi", r"\chi"),
        ("psi''", r"\ddot{\psi}"),
        ("theta0", r"\theta_{0}"),
        ("horizon", r"\mathrm{horizon}"),
        ("x_start", r"x_{\mathrm{start}}"),
        ("J12", "J_{12}"),
        ("_", r"\mathrm{\_}"),
    ] {
        assert_eq!(g.latex_symbol(g.symbol(name)), latex, "{name}");
    }
}

#[test]
fn multiples_of_pi_are_printed_as_such() {
    let g = Graph::new();
    for text in ["pi", "pi/10", "2*pi", "3*pi/4", "pi*x/180", "2*pi*x/(3*y)", "sin(x + pi/7)"] {
        let e = parse(&g, text).unwrap();
        assert_eq!(g.plain(e), text);
        assert_eq!(parse(&g, &g.plain(e)).unwrap(), e);
    }
    assert_eq!(g.plain(parse(&g, "3.1415926535897").unwrap()), "3.1415926535897");
    assert_eq!(g.latex(parse(&g, "3*pi/4 - x").unwrap()), r"\frac{3 \pi}{4} - x");
}

#[test]
fn decimals_are_numbers_as_written_and_rounded_ones_stay_rounded() {
    let g = Graph::new();
    for text in ["1.5e0*x", "1.5e+0*x", "15e-1*x", "1.5*x"] {
        let e = parse(&g, text).unwrap();
        assert!(g.are_exact(&[e]) && g.plain(e) == "3*x/2", "{text}: {}", g.plain(e));
    }
    let rounded = g.mul(parse(&g, "x").unwrap(), parse(&g, "sqrt(2)").unwrap());
    let number = g.mul(parse(&g, "x").unwrap(), parse(&g, "1.4142135623730951e-0").unwrap());
    assert!(!g.are_exact(&[number]), "{}", g.plain(number));
    assert_eq!(parse(&g, &g.plain(number)).unwrap(), number);
    assert_ne!(rounded, number);
    // as many digits as are written, and no two that are written alike are one
    for (text, exact) in
        [("1/3-0.3333333333333333", "1/30000000000000000"), ("0.1234567890123456789-0.123456789012345678", "9e-19")]
    {
        let e = parse(&g, text).unwrap();
        assert!(g.are_exact(&[e]) && g.plain(e) == exact, "{text}: {}", g.plain(e));
    }
    assert_eq!(g.as_number(parse(&g, "0.57735026918962576451").unwrap()), "0.57735026918962576451".parse().ok());
}
