//! Tables of samples as they are read, and the order of motions by three steps.

use judge::{JudgeError, Samples, order};
use scene::Scene;

fn read(table: &str) -> Result<Samples, JudgeError> {
    let text = "title = \"two\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'\"]\n[start.velocities]\n\"x'\" = 1\n[run]\n\
                duration = 1\n";
    Samples::read(&Scene::parse("two", text).expect("a scene").system, "m", table)
}

#[test]
fn columns_are_found_by_name() {
    let samples = read("\u{feff}y, \"t\" ,note,x\n2,0,a,1\n\n4,0.5,b,3\n").expect("samples");
    let known = Samples { t: vec![0.0, 0.5], q: vec![vec![1.0, 2.0], vec![3.0, 4.0]], v: None };
    assert_eq!((&samples.t, &samples.q, &samples.v), (&known.t, &known.q, &known.v));
    assert_eq!(samples.step(), 0.5);
    let samples = read("t,x,y,y',x'\n0,1,2,5,6\n").expect("samples");
    assert_eq!(samples.v, Some(vec![vec![6.0, 5.0]]));
}

#[test]
fn what_is_no_table_is_refused_with_its_place() {
    let refused = |table: &str| read(table).unwrap_err().to_string();
    for (table, said) in [
        ("", "m:1:1: there is no column `t`"),
        ("t,x\n0,1\n", "m:1:1: there is no column `y`"),
        ("t,x,y,x'\n0,1,2,3\n", "m:1:5: there are rates of 1 of 2 coordinates: column `y'` is missing"),
        ("t,x,y\n0,1,2\n1,1\n", "m:3:3: 2 cells, and the header has 3"),
        ("t,x,y\n0,1,2\n1,one,2\n", "m:3:3: column `x`: `one` is not a finite number"),
        ("t,x,y\n0,1,inf\n", "m:2:5: column `y`: `inf` is not a finite number"),
        ("t,x,y\n0,1,2\n0,1,2\n", "m:3:1: t = 0 is not later than t = 0 of the row before"),
    ] {
        assert_eq!(refused(table), said);
    }
}

/// `q = hᵖ` at the last time that all have, for steps h of 1, ½, ¼.
#[test]
fn an_order_is_that_of_the_distances_and_between_a_tenth_and_twelve() {
    let steps = [0.25, 1.0, 0.5];
    let of = |p: f64| {
        let motions = steps.map(|h: f64| Samples { t: vec![0.0, 1.0], q: vec![vec![0.0], vec![h.powf(p)]], v: None });
        order(&motions, &steps)
    };
    for p in [0.2, 1.0, 3.0, 11.5] {
        let found = of(p).unwrap_or_else(|| panic!("{p}"));
        assert!((found.order - p).abs() < 1e-6 && found.t == 1.0, "{p}: {found:?}");
        let known = [1.0 - 0.5_f64.powf(p), 0.5_f64.powf(p) - 0.25_f64.powf(p)];
        assert!((0..2).all(|i| (found.distances[i] - known[i]).abs() < 1e-12), "{p}: {found:?}");
    }
    assert!([0.05, 12.5].into_iter().all(|p| of(p).is_none()));
    assert!(order(&[], &steps).is_none());
}
