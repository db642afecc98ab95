use symbolic::*;
#[test]
fn smoke() {
    let g = Graph::new();
    let names = ["x", "y", "phi", "x'", "y'", "phi'", "g", "alpha", "k", "mu", "r"];
    for n in names {
        g.symbol(n);
    }
    let known: Vec<String> = names.iter().map(|s| s.to_string()).collect();
    let scope = |n: &str| g.find_symbol(n).map(|s| g.variable(s));
    for t in [
        "(x'^2+y'^2)/2 + k^2*phi'^2/2 + g*x*sin(alpha) + mu*(y'*cos(phi) - x'*sin(phi))",
        "-2^2",
        "2^3^2",
        "2^-1",
        "sqrt(x^2)",
        "sin(phi)^2*x+x*cos(phi)^2",
        "1/(x*y)+3*x/(2*r)",
        "sin(phi-alpha)^2/cos(phi)",
        "exp(x)^2*ln(x+y)",
        "(x+y)*(x-y)/sqrt(2*x)",
        "0.05*x^(2/3) - 1e-7*y",
        "x^y^2",
        "(x-y)*sin(x)",
    ] {
        let e = g.parse(t, &scope, &known).unwrap();
        println!("{t}\n   {}\n   {}", g.plain(e), g.latex(e));
        assert_eq!(g.parse(&g.plain(e), &scope, &known).unwrap(), e);
    }
    let e = g.parse("x/cos(phi)+atan(y*x)", &scope, &known).unwrap();
    for s in ["x", "y", "phi"] {
        println!("{}", g.plain(g.derivative(e, g.symbol(s))));
    }
    for t in [
        "", "1+", "2 x", "phy", "sin", "x(3)", "abs(x)", "((x)", "x)", "1/0", "0^-1", "1/(x-x)", "sin(x,y)", "x = 3",
        "x'+ φ", "1e999", "sni(x)",
    ] {
        println!("{}", g.parse(t, &scope, &known).unwrap_err());
    }
}
