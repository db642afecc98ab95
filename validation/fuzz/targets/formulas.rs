//! A formula: what is read is printed so that it is read back as the same value, differentiated and compiled.
#![no_main]

use std::collections::HashMap;

use libfuzzer_sys::fuzz_target;
use symbolic::Graph;

/// Numbers at which two readings are compared.
const AT: [f64; 4] = [0.3, -1.7, 2.9, 0.0];

fuzz_target!(|text: &str| {
    let g = Graph::new();
    let symbols = ["x", "y", "x'", "t"].map(|name| g.symbol(name));
    let scope = |name: &str| {
        let symbol = g.find_symbol(name).filter(|symbol| symbols.contains(symbol));
        symbol.map(|symbol| g.variable(symbol))
    };
    let Ok(read) = g.parse(text, &scope) else { return };
    let (plain, _) = (g.plain(read), g.latex(read));
    // what is printed is longer, and may be too deep to be read
    let again = g.parse(&plain, &scope).unwrap_or(read);
    let slope = g.derivative(read, symbols[0]);
    let Ok(tape) = g.compile(&symbols, &[read, again, slope], &HashMap::new()) else { return };
    let mut values = [0.0; 3];
    tape.evaluate(&AT, &mut tape.workspace::<f64>(), &mut values);
    let [one, two, _] = values;
    let near = (one - two).abs() <= 1e-6 * one.abs().max(two.abs()).max(1e-9);
    assert!(near || !(one - two).is_finite(), "{text} is {one}, and {plain} is {two}");
});
