//! An expression of another graph is found, wherever it is used.

use std::panic::{AssertUnwindSafe, catch_unwind};

use symbolic::{Expr, Graph, Symbol};

fn squares(g: &Graph, names: &[&str]) -> Vec<Expr> {
    names.iter().map(|name| g.powi(g.variable(g.symbol(name)), 2)).collect()
}

fn is_refused<T>(work: impl FnOnce() -> T) -> bool {
    catch_unwind(AssertUnwindSafe(work)).is_err()
}

#[test]
fn what_was_there_before_belongs_to_both_and_what_comes_later_to_one() {
    let g = Graph::new();
    let old = squares(&g, &["x", "y"]);
    let (first, second) = (g.clone(), g.clone());
    // the same place in three graphs, three meanings
    let [own, one, two] = [(&g, "a"), (&first, "b"), (&second, "c")].map(|(g, name)| squares(g, &[name])[0]);
    for (graph, theirs, name) in [(&g, own, "a"), (&first, one, "b"), (&second, two, "c")] {
        let sum = graph.sum(&[old[0], old[1], theirs]);
        assert_eq!(graph.plain(sum), format!("x^2 + y^2 + {name}^2"));
        for foreign in [own, one, two].into_iter().filter(|e| *e != theirs) {
            assert!(is_refused(|| graph.plain(foreign)) && is_refused(|| graph.add(old[0], foreign)));
            assert!(is_refused(|| graph.symbols_of(foreign)) && is_refused(|| graph.size(&[foreign])));
        }
    }
    // a clone of a clone knows what both knew, and its own
    let third = first.clone();
    let late = squares(&third, &["d"])[0];
    assert_eq!(third.plain(third.add(one, late)), "b^2 + d^2");
    assert!(is_refused(|| first.plain(late)) && is_refused(|| third.plain(two)) && is_refused(|| third.plain(own)));
}

#[test]
fn symbols_are_those_of_their_graph() {
    let g = Graph::new();
    let x = g.symbol("x");
    let clone = g.clone();
    let [later, other]: [Symbol; 2] = [g.symbol("y"), clone.symbol("z")];
    assert_eq!((clone.name(x), clone.name(other), g.name(later)), ("x".into(), "z".into(), "y".into()));
    assert!(is_refused(|| g.name(other)) && is_refused(|| clone.name(later)));
    assert!(is_refused(|| clone.variable(later)));
}

/// Marks come round after 63; neighbours in time differ.
#[test]
fn of_many_graphs_nearly_all_are_told_apart() {
    let graphs: Vec<Graph> = (0..80).map(|_| Graph::new()).collect();
    let squares: Vec<Expr> = graphs.iter().map(|g| squares(g, &["x"])[0]).collect();
    let is_told = |i: usize, j: usize| is_refused(|| graphs[i].plain(squares[j]));
    let pairs = (0..80).flat_map(|i| (0..80).map(move |j| (i, j))).filter(|(i, j)| i != j);
    let missed = pairs.filter(|&(i, j)| !is_told(i, j)).count();
    assert!(missed <= 80 * 79 / 40, "{missed} of {} are missed", 80 * 79);
    assert!((1..80).all(|i| is_told(i, i - 1)));
}
