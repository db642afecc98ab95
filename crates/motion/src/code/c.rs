//! A file of C99.

use std::fmt::Write;

use symbolic::Code;

use super::{Listing, Place};
use crate::SolveError;

/// Gaussian elimination as `mechanics::linear` does it, so that the same instants are refused.
const SOLVE: &str = "
/* Solves a z = b, n equations, by LU factorization with scaling and partial pivoting: b becomes z.
 * Returns 1 where a pivot of the scaled matrix is below 1e-13 or no number, else 0. */
static int solve(int n, double *a, double *b)
{
    double scale[LARGEST];
    for (int j = 0; j < n; j++) {
        double largest = 0.0;
        for (int i = 0; i < n; i++) largest = fmax(largest, fabs(a[i*n + j]));
        if (!(largest > 0.0) || isinf(largest)) return 1;
        scale[j] = 1.0/largest;
    }
    for (int i = 0; i < n; i++) {
        double largest = 0.0;
        for (int j = 0; j < n; j++) {
            a[i*n + j] *= scale[j];
            largest = fmax(largest, fabs(a[i*n + j]));
        }
        if (!(largest > 0.0) || isinf(largest)) return 1;
        for (int j = 0; j < n; j++) a[i*n + j] *= 1.0/largest;
        b[i] *= 1.0/largest;
    }
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i*n + k]) > fabs(a[best*n + k])) best = i;
        if (!(fabs(a[best*n + k]) >= 1e-13)) return 1;
        for (int j = 0; j < n; j++) {
            const double x = a[k*n + j];
            a[k*n + j] = a[best*n + j];
            a[best*n + j] = x;
        }
        const double x = b[k];
        b[k] = b[best];
        b[best] = x;
        for (int i = k + 1; i < n; i++) {
            const double factor = a[i*n + k]/a[k*n + k];
            for (int j = k + 1; j < n; j++) a[i*n + j] -= factor*a[k*n + j];
            b[i] -= factor*b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) b[i] -= a[i*n + j]*b[j];
        b[i] /= a[i*n + i];
    }
    for (int i = 0; i < n; i++) b[i] *= scale[i];
    return 0;
}
";

pub(super) fn file(listing: &Listing) -> Result<String, SolveError> {
    let prepared = listing.prepared;
    let name = |text: &str| text.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
    // a letter first: names of files may begin with a digit
    let own = name(&listing.scene.name);
    let front = if own.starts_with(|c: char| c.is_ascii_alphabetic()) { "" } else { "scene_" };
    let prefix = format!("{front}{own}_{}", name(prepared.equations.formulation));
    let (states, outputs) = (prepared.start.len(), listing.outputs.len());
    let unknowns: usize = listing.systems.iter().map(|s| s.right.len()).sum();
    let takes = format!("double t, const double state[{states}], const {prefix}_parameters *parameters");
    let heads = [("rates", states), ("outputs", outputs)]
        .map(|(what, count)| format!("int {prefix}_{what}({takes}, double {what}[{count}])"));
    let singular = listing.singular().map_or("They return 0.".into(), |regular| {
        format!("They return 0, or 1 without an answer where the equations are singular; needed: {regular}.")
    });
    let about = listing.about(&format!(
        "{};\n    writes F(t, y).\n{};\n    writes what is read off at (t, y), see below.\n\n{singular}\n\
         {prefix}_defaults are the parameters, {prefix}_start is y({prefix}_time).",
        heads[0], heads[1]
    ));
    let mut text = "/*\n".to_string();
    for line in about.replace("*/", "* /").replace("/*", "/ *").lines() {
        let _ = writeln!(text, "{}", format!(" * {line}").trim_end());
    }
    let _ = write!(text, " */\n\n#include <math.h>\n\n/* Parameters and free constants. */\ntypedef struct {{\n");
    for (field, name, _) in &listing.constants {
        let called = if field == name { String::new() } else { format!(" /* {name} */") };
        let _ = writeln!(text, "    double {field};{called}");
    }
    let values = |list: &[f64]| format!("{list:?}").replace('[', "{ ").replace(']', " }");
    let mut defaults: Vec<f64> = listing.constants.iter().map(|(_, _, x)| *x).collect();
    if defaults.is_empty() {
        text += "    double none;\n"; // C has no structure without fields
        defaults.push(0.0);
    }
    let _ = write!(
        text,
        "}} {prefix}_parameters;\n\nconst {prefix}_parameters {prefix}_defaults = {};\nconst double {prefix}_time = \
         {:?};\nconst double {prefix}_start[{states}] = {};\n",
        values(&defaults),
        prepared.t,
        values(&prepared.start)
    );
    if unknowns > 0 {
        let largest = listing.systems.iter().map(|s| s.right.len()).max().unwrap_or(0);
        text += &SOLVE.replace("LARGEST", &largest.to_string());
        let code = listing.instant()?;
        let names: Vec<&str> =
            listing.systems.iter().flat_map(|s| &s.block.unknowns).map(|&z| listing.name(z)).collect();
        let _ = write!(text, "\n/* The unknowns of the instant: {}. */\n", names.join(", "));
        let _ = writeln!(text, "static int {prefix}_unknowns({takes}, double unknowns[{unknowns}])\n{{");
        body(&mut text, listing, &code);
        let mut first = 0;
        for (rows, right) in listing.instant_of(&code) {
            let n = right.len();
            let rows: Vec<String> = rows.into_iter().map(|row| row.join(", ")).collect();
            let _ = writeln!(
                text,
                "    {{\n        double matrix[{}] = {{\n            {}",
                n * n,
                rows.join(",\n            ")
            );
            text += "        };\n";
            for (i, b) in right.iter().enumerate() {
                let _ = writeln!(text, "        unknowns[{}] = {b};", first + i);
            }
            let _ = writeln!(text, "        if (solve({n}, matrix, &unknowns[{first}])) return 1;\n    }}");
            first += n;
        }
        text += "    return 0;\n}\n";
    }
    let expressions = listing.output_expressions();
    for ((head, what), expressions) in heads.iter().zip(["rates", "outputs"]).zip([&listing.rates, &expressions]) {
        let code = listing.code(expressions)?;
        let _ = writeln!(text, "\n{head}\n{{");
        if listing.uses_unknowns(&code) {
            let call = format!("{prefix}_unknowns(t, state, parameters, unknowns)");
            let _ = writeln!(text, "    double unknowns[{unknowns}];\n    if ({call}) return 1;");
        }
        body(&mut text, listing, &code);
        for (i, value) in code.outputs.iter().enumerate() {
            let _ = writeln!(text, "    {what}[{i}] = {value};");
        }
        text += "    return 0;\n}\n";
    }
    Ok(text)
}

/// What a function takes, under the names of the system, and the lines of `code`.
fn body(text: &mut String, listing: &Listing, code: &Code) {
    let places: Vec<Place> = listing.used(code).map(|(_, place)| place).collect();
    if !listing.uses_unknowns(code) {
        let has = |wanted: fn(&Place) -> bool| places.iter().any(wanted);
        let used = [
            ("t", has(|place| matches!(place, Place::Time))),
            ("state", has(|place| matches!(place, Place::State(_)))),
            ("parameters", has(|place| matches!(place, Place::Constant(_)))),
        ];
        for (name, _) in used.iter().filter(|(_, used)| !used) {
            let _ = writeln!(text, "    (void){name};");
        }
    }
    for (name, place) in listing.used(code) {
        let _ = match place {
            Place::Time => Ok(()), // bears its name already
            Place::State(i) => writeln!(text, "    const double {name} = state[{i}];"),
            Place::Unknown(i) => writeln!(text, "    const double {name} = unknowns[{i}];"),
            Place::Constant(_) => writeln!(text, "    const double {name} = parameters->{name};"),
        };
    }
    for (name, value) in &code.lines {
        let _ = writeln!(text, "    const double {name} = {value};");
    }
}
