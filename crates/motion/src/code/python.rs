//! Modules of Python: functions of arrays, and expressions of SymPy.

use std::fmt::Write;

use symbolic::{Code, Expr};

use super::{Listing, Place};
use crate::SolveError;

pub(super) fn numpy(listing: &Listing) -> Result<String, SolveError> {
    let singular = listing.singular().map_or(String::new(), |regular| {
        format!("\nnumpy.linalg.LinAlgError where the equations are singular to the last digit; needed: {regular}.")
    });
    let mut text = about(
        listing,
        &format!(
            "rates(t, state, parameters) is F(t, y), outputs(t, state, parameters) what is read off; state has the shape \
             (..., {}),\nthe answer one like it, t is a number or of shape (...). parameters are PARAMETERS, or \
             PARAMETERS | {{name: value}}.{singular}",
            listing.rates.len()
        ),
    );
    let constants: Vec<String> = listing.constants.iter().map(|(_, name, x)| format!("{name:?}: {x:?}")).collect();
    let _ = write!(
        text,
        "import numpy as np\n\nSTATES = {:?}\nOUTPUTS = {:?}\nPARAMETERS = {{{}}}\nTIME = {:?}\nSTART = \
         np.array({:?})\n\n\ndef _rows(t, state, *entries):\n    return np.stack(np.broadcast_arrays(t, state[..., 0], \
         *entries)[2:], axis=-1)\n",
        listing.state_names(),
        listing.output_names(),
        constants.join(", "),
        listing.prepared.t,
        listing.prepared.start
    );
    if !listing.systems.is_empty() {
        let code = listing.instant()?;
        text += "\n\ndef _unknowns(t, state, parameters):\n";
        body(&mut text, listing, &code);
        text += "    blocks = [\n";
        for (rows, right) in listing.instant_of(&code) {
            let n = right.len();
            let matrix: Vec<String> = rows.into_iter().map(|row| row.join(", ")).collect();
            let matrix = matrix.join(",\n                ");
            let _ = writeln!(
                text,
                "        ({n}, _rows(t, state,\n                {matrix}),\n            _rows(t, state, {})),",
                right.join(", ")
            );
        }
        text += "    ]\n    solved = [np.linalg.solve(a.reshape(*a.shape[:-1], n, n), b[..., None]) for n, a, b in blocks]\n";
        text += "    return np.concatenate(solved, axis=-2)[..., 0]\n";
    }
    for (function, expressions) in [("rates", &listing.rates), ("outputs", &listing.output_expressions())] {
        let code = listing.code(expressions)?;
        let _ = write!(
            text,
            "\n\ndef {function}(t, state, parameters=PARAMETERS):\n    state = np.asarray(state, dtype=float)\n"
        );
        if listing.uses_unknowns(&code) {
            text += "    unknowns = _unknowns(t, state, parameters)\n";
        }
        body(&mut text, listing, &code);
        let _ = writeln!(text, "    return _rows(t, state,\n        {})", code.outputs.join(",\n        "));
    }
    Ok(text)
}

/// What a function takes, under the names of the system, and the lines of `code`.
fn body(text: &mut String, listing: &Listing, code: &Code) {
    for (name, place) in listing.used(code) {
        let _ = match place {
            Place::Time => Ok(()), // bears its name already
            Place::State(i) => writeln!(text, "    {name} = state[..., {i}]"),
            Place::Unknown(i) => writeln!(text, "    {name} = unknowns[..., {i}]"),
            Place::Constant(i) => writeln!(text, "    {name} = parameters[{:?}]", listing.constants[i].1),
        };
    }
    for (name, value) in &code.lines {
        let _ = writeln!(text, "    {name} = {value}");
    }
}

pub(super) fn sympy(listing: &Listing) -> Result<String, SolveError> {
    let mut text = about(
        listing,
        "RATES is F(t, y) and OUTPUTS what is read off, both in the states, the parameters and the UNKNOWNS z of the \
         instant,\nfor which MATRIX*z = RIGHT. With z put in: RATES.subs(dict(zip(UNKNOWNS, MATRIX.LUsolve(RIGHT)))).",
    );
    text += "import sympy as sp\n\n";
    for (_, name) in &listing.inputs {
        let _ = writeln!(text, "{name} = sp.Symbol(\"{name}\")");
    }
    let instant = listing.systems.iter().flat_map(|s| s.matrix.entries().iter().chain(&s.right));
    let expressions = listing.output_expressions();
    let all: Vec<Expr> = instant.chain(&listing.rates).chain(&expressions).copied().collect();
    let code = listing.code(&all)?;
    text.push('\n');
    for (name, value) in &code.lines {
        let _ = writeln!(text, "{name} = {value}");
    }
    let systems = listing.instant_of(&code);
    let matrices: Vec<String> = systems
        .iter()
        .map(|(rows, _)| {
            let rows: Vec<String> = rows.iter().map(|row| format!("[{}]", row.join(", "))).collect();
            format!("sp.Matrix([\n    {},\n])", rows.join(",\n    "))
        })
        .collect();
    let right: Vec<&String> = systems.iter().flat_map(|(_, right)| right.iter()).collect();
    let rest = &code.outputs[code.outputs.len() - listing.rates.len() - expressions.len()..];
    let (rates, outputs) = rest.split_at(listing.rates.len());
    let unknowns: Vec<&str> =
        listing.systems.iter().flat_map(|s| &s.block.unknowns).map(|&z| listing.name(z)).collect();
    let states: Vec<&str> = listing.prepared.equations.states.iter().map(|y| listing.name(y.symbol)).collect();
    let column = |entries: &[String]| format!("sp.Matrix([\n    {},\n])", entries.join(",\n    "));
    let constants: Vec<String> = listing.constants.iter().map(|(name, _, x)| format!("{name}: {x:?}")).collect();
    let _ = write!(
        text,
        "\nSTATES = sp.Matrix([{}])\nUNKNOWNS = sp.Matrix({}, 1, [{}])\nPARAMETERS = {{{}}}\nTIME = {:?}\nSTART = sp.Matrix({:?})\n\
         MATRIX = sp.diag({})\nRIGHT = sp.Matrix({}, 1, [{}])\nRATES = {}\nOUTPUTS = {}\n",
        states.join(", "),
        unknowns.len(),
        unknowns.join(", "),
        constants.join(", "),
        listing.prepared.t,
        listing.prepared.start,
        matrices.join(", "),
        right.len(),
        right.into_iter().map(String::as_str).collect::<Vec<_>>().join(", "),
        column(rates),
        column(outputs)
    );
    Ok(text)
}

fn about(listing: &Listing, usage: &str) -> String {
    let lines = listing.about(usage);
    let lines = lines.lines().map(|line| format!("# {line}").trim_end().to_string() + "\n");
    lines.collect::<String>() + "\n"
}
