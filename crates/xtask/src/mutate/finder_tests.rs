use super::finder::{find, one_line};

/// Mutants of the body of a function, as `original -> replacement`.
fn mutants(body: &str) -> Vec<String> {
    let source = format!("fn derive(g: &Graph) {{ {body} }}");
    let found = find("a.rs", &source).unwrap();
    for mutant in &found {
        assert_eq!(one_line(&source[mutant.range.clone()]), mutant.original);
        let mutated = [&source[..mutant.range.start], &mutant.text, &source[mutant.range.end..]].concat();
        assert!(syn::parse_file(&mutated).is_ok(), "{mutated}");
    }
    found.iter().map(|mutant| format!("{} -> {}", mutant.original, mutant.replacement)).collect()
}

#[test]
fn a_small_derivation_has_exactly_these_mutants() {
    let source = "\
//! Not looked at: g.sub(a, b).

/// Not looked at: g.neg(a).
fn derive(g: &Graph) -> Expr {
    let mut flow = system.flow();
    flow.push((u, g.variable(rate)));
    let inertia = g.total_derivative(momentum, &flow);
    g.sub(inertia, g.sum(&[force, g.neg(reaction)]))
}

#[cfg(test)]
mod tests {
    fn unseen(g: &Graph) -> Expr {
        g.sub(a, b)
    }
}
";
    let found = find("crates/a/src/lib.rs", source).unwrap();
    let lines: Vec<String> =
        found.iter().map(|m| format!("{} {}: {} -> {}", m.line, m.what, m.original, m.replacement)).collect();
    assert_eq!(
        lines,
        [
            "6 statement left out: flow.push((u, g.variable(rate))); -> ",
            "6 sign of a rate turned: g.variable(rate) -> g.neg(g.variable(rate))",
            "7 sign turned: g.total_derivative(momentum, &flow) -> g.neg(g.total_derivative(momentum, &flow))",
            "7 made zero: g.total_derivative(momentum, &flow) -> g.zero()",
            "8 sign turned: g.sub(inertia, g.sum(&[force, g.neg(reaction)])) -> \
             g.add(inertia, g.sum(&[force, g.neg(reaction)]))",
            "8 term dropped: g.sub(inertia, g.sum(&[force, g.neg(reaction)])) -> \
             g.neg(g.sum(&[force, g.neg(reaction)]))",
            "8 term dropped: g.sub(inertia, g.sum(&[force, g.neg(reaction)])) -> inertia",
            "8 term dropped: g.sum(&[force, g.neg(reaction)]) -> g.sum(&[force])",
            "8 term dropped: g.sum(&[force, g.neg(reaction)]) -> g.sum(&[g.neg(reaction)])",
            "8 sign turned: force -> g.neg(force)",
            "8 sign turned: g.neg(reaction) -> reaction",
        ]
    );
    assert!(found.iter().all(|m| m.file == "crates/a/src/lib.rs" && m.function == "derive"));
}

#[test]
fn graphs_go_by_several_names() {
    assert_eq!(mutants("graph.neg(a)"), ["graph.neg(a) -> a"]);
    assert_eq!(
        mutants("system.graph.div(a, b)"),
        ["system.graph.div(a, b) -> a", "system.graph.div(a, b) -> system.graph.mul(a, b)",]
    );
    assert_eq!(mutants("other.neg(a)"), [""; 0]);
}

#[test]
fn vectors_and_matrices_are_negated_entry_by_entry() {
    assert_eq!(
        mutants("g.gradient(e, &q)"),
        ["g.gradient(e, &q) -> g.gradient(e, &q).into_iter().map(|e| g.neg(e)).collect::<Vec<_>>()",]
    );
    assert_eq!(
        mutants("g.jacobian(&f, &v)"),
        ["g.jacobian(&f, &v) -> { let m = g.jacobian(&f, &v); \
         symbolic::Matrix::from_fn(m.rows(), m.columns(), |i, j| g.neg(m[(i, j)])) }",]
    );
}

#[test]
fn conditions_are_turned_once() {
    assert_eq!(mutants("if !g.is_zero(e) {}"), ["!g.is_zero(e) -> g.is_zero(e)"]);
    assert_eq!(mutants("if free {}"), ["free -> !free"]);
    assert_eq!(mutants("rank == 2"), ["rank == 2 -> (rank != 2)"]);
    assert_eq!(mutants("a && b"), ["a && b -> (a || b)", "a && b -> a", "a && b -> b"]);
    assert_eq!(mutants("x.all(|e| e)"), ["x.all(|e| e) -> x.any(|e| e)"]);
}

#[test]
fn states_ranges_and_lists_are_looked_into() {
    assert_eq!(mutants("state(g, q, role, rate, start)"), ["rate -> g.neg(rate)"]);
    assert_eq!(
        mutants("StateVariable { symbol, rate, start: s }"),
        ["rate -> rate: g.neg(rate)", "start: s -> start: g.neg(s)",]
    );
    assert_eq!(mutants("FreeConstant { symbol, natural: Some(p) }"), ["natural: Some(p) -> natural: None"]);
    assert_eq!(mutants("(0..n)"), ["0..n -> 1..n"]);
    assert_eq!(mutants("vec![g.neg(a)]"), ["g.neg(a) -> a"]);
    assert_eq!(mutants("format!(\"{}\", g.neg(a))"), [""; 0]);
}

#[test]
fn a_source_that_does_not_parse_is_an_error() {
    assert!(find("a.rs", "fn (").unwrap_err().to_string().starts_with("a.rs does not parse"));
}
