//! Films as they are read, unknowns as they are written, and what is refused.

use fit::{Deviations, Film, FitError, Problem, Unknown, fit};
use motion::{Settings, choices};
use scene::Scene;

use crate::films::built_in;

fn read(table: &str, sigma: f64) -> Result<Film, FitError> {
    Film::read(&built_in("sledge"), "film", table, &Deviations { others: Some(sigma), ..Deviations::default() })
}

#[test]
fn columns_are_expressions_with_units_and_gaps() {
    let film = read("\u{feff}\"t\" ,x [mm],k*phi\n0.1,5,\n\n0.2,,nan\n0.4,\"6\",0.2\n", 1e-3).unwrap();
    assert_eq!(film.t, [0.1, 0.4]);
    assert_eq!(film.rows, [vec![Some(5e-3), None], vec![Some(6e-3), Some(0.2)]]);
    assert_eq!((film.gaps(), film.lines, film.columns.len()), (1, vec![2, 5], 2));
}

/// `[film]` says what a column is, a name on the command line counts more, all others less.
#[test]
fn a_scene_says_what_columns_show() {
    let film = "[film.right]\nis = \"100*x\"\nsigma = \"k/10\"\n[film.up]\nis = \"y\"\n";
    let text = format!("{}\n{film}", built_in("sledge").to_toml());
    let scene = Scene::parse("sledge", &text).unwrap_or_else(|error| panic!("{error}"));
    let again = Scene::parse("sledge", &scene.to_toml()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again.film.iter().map(|f| f.sigma).collect::<Vec<_>>(), [Some(0.7 / 10.0), None]);
    let read = |by_name: &[(String, f64)]| {
        let deviations = Deviations { by_name: by_name.to_vec(), others: Some(3.0), ..Deviations::default() };
        Film::read(&scene, "film", "t,right,up\n0.1,1,2\n", &deviations).unwrap()
    };
    let sigmas = |film: &Film| film.columns.iter().map(|c| c.sigma).collect::<Vec<_>>();
    assert_eq!(scene.system.graph.plain(scene.film[0].expression), "100*x");
    assert_eq!(sigmas(&read(&[])), [0.7 / 10.0, 3.0]);
    assert_eq!(sigmas(&read(&[("right".into(), 2.0)])), [2.0, 3.0]);
    let refused = |text: &str| Scene::parse("sledge", text).unwrap_err().to_string();
    assert!(refused(&text.replace("k/10", "0*k")).contains("a standard deviation must be greater than 0, found 0"));
    assert!(refused(&text.replace("100*x", "100*w")).contains("undefined name `w`"));
}

#[test]
fn what_is_no_film_is_refused_with_its_place() {
    for (table, sigma, said) in [
        ("", 1.0, "film:1:1: there is no column `t`"),
        ("t\n0\n", 1.0, "film:1:1: there is no column but `t`"),
        ("t,z\n0,1\n", 1.0, "film:1:3: no expression belongs to the column `z`"),
        ("t,x [inch]\n0,1\n", 1.0, "film:1:3: `inch` is not a number with a unit"),
        ("t,x\n0,1\n1\n", 1.0, "film:3:1: 1 cells, and the header has 2"),
        ("t,x\n0,one\n", 1.0, "film:2:3: column `x`: `one` is not a finite number"),
        ("t,x\n,1\n", 1.0, "film:2:1: column `t`: the cell is empty, and a number is needed"),
        ("t,x\n1,1\n\n0.5,2\n", 1.0, "film:4:1: t = 0.5 is not later than t = 1"),
        ("t,x\n-1,1\n", 1.0, "film:2:1: t = -1 is before the start of the scene, t = 0"),
        ("t,x\n0,1\n", 0.0, "film:1:3: the standard deviation of `x` is 0"),
        ("t,x\n0,1\n", f64::NAN, "film:1:3: the standard deviation of `x` is NaN"),
        ("t,x\n0,1\n", 1e-300, "it must be from 1e-100 to 1e100"),
    ] {
        let error = read(table, sigma).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    let none = Film::read(&built_in("sledge"), "film", "t,x\n0,1\n", &Deviations::default()).unwrap_err();
    assert_eq!(none, FitError::At { place: "film:1:3".into(), error: FitError::NoDeviation("x".into()).into() });
}

#[test]
fn unknowns_are_read_or_refused() {
    let read = |text: &str| text.parse::<Unknown>();
    let unknown = read("x'@2~3 mm+-1mm").unwrap();
    let prior = unknown.prior.unwrap();
    assert_eq!((unknown.label().as_str(), unknown.start), ("x'@2", Some(3e-3)));
    assert_eq!((prior.mean, prior.deviation), (3e-3, 1e-3));
    assert_eq!(read("epsilon>=0").unwrap().bound, Some(0.0));
    for (text, said) in [
        ("", "it has no name"),
        ("x@0", "`0` is not a number of a film"),
        ("x@one", "`one` is not a number of a film"),
        ("g~9±0", "the standard deviation of `g` is 0"),
        ("g~nine", "`nine` is not a number with a unit"),
    ] {
        let error = read(text).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}

fn problem(scene: &Scene, films: &[Film], unknowns: &[&str]) -> Result<Problem, FitError> {
    let unknowns: Vec<Unknown> = unknowns.iter().map(|text| text.parse().unwrap()).collect();
    Problem::new(scene, &choices(scene)[0], films, &unknowns, &Settings::default())
}

#[test]
fn films_share_parameters_and_have_starts_of_their_own() {
    let scene = built_in("sledge");
    let film = read("t,x\n0.1,0\n0.2,0\n0.3,0\n0.4,0\n0.5,0\n", 1.0).unwrap();
    let two = [film.clone(), film.clone()];
    let labels = |unknowns: &[&str]| -> Vec<String> {
        problem(&scene, &two, unknowns).unwrap().unknowns().iter().map(Unknown::label).collect()
    };
    assert_eq!(labels(&["x", "g", "alpha@2"]), ["x@1", "x@2", "g", "alpha@2"]);
    assert_eq!(labels(&["x@1", "x", "g", "g@2"]), ["x@1", "x@2", "g", "g@2"]);
    let refused =
        |films: &[Film], unknowns: &[&str]| problem(&scene, films, unknowns).map(|_| ()).unwrap_err().to_string();
    assert!(refused(&two, &["x@3"]).contains("there is no film 3, there are 2"));
    assert!(refused(&two, &["g", "g"]).contains("`g` is unknown twice"));
    assert!(refused(&two, &[]).contains("no number is unknown"));
    assert!(
        refused(std::slice::from_ref(&film), &["x", "y", "phi", "x'", "phi'"])
            .contains("the films have 5 numbers, and there are 5")
    );
    assert!(refused(&two, &["mass"]).contains("mass"));
}

#[test]
fn films_that_show_nothing_and_motions_that_end_early_are_refused() {
    let deviations = Deviations { others: Some(1e-3), ..Deviations::default() };
    let read = |scene: &Scene, table: &str| Film::read(scene, "film", table, &deviations).unwrap();
    // the acceleration is no number of a motion's state
    let sledge = built_in("sledge");
    let acceleration = read(&sledge, "t,x''\n0.1,0\n0.2,0\n");
    let error = problem(&sledge, &[acceleration], &["x"]).map(|_| ()).unwrap_err().to_string();
    assert!(error.starts_with("the column `x''`: `x''` has no value"), "{error}");
    // the circle of Chetaev's ball is the same whatever its spin
    let table = built_in("turntable");
    let film = read(&table, "t,x,y\n0.1,0.65,0\n0.2,0.65,0\n0.3,0.65,0\n");
    let spin = problem(&table, &[film], &["psi'"]).unwrap();
    assert_eq!(fit(&spin, &|_| false, 1, false).unwrap_err(), FitError::ShowsNothing);
    let film = read(&sledge, "t,x\n0.5,0\n1,0\n1.5,0\n2,0\n");
    let unknowns = ["x".parse::<Unknown>().unwrap(), "phi'".parse().unwrap()];
    let settings = Settings { max_steps: 1, ..Settings::default() };
    let short = Problem::new(&sledge, &choices(&sledge)[0], &[film], &unknowns, &settings).unwrap();
    let error = fit(&short, &|_| false, 2, false).unwrap_err().to_string();
    assert!(
        error.starts_with("of 2 starts of the search none leads to a motion") && error.contains("steps"),
        "{error}"
    );
}

/// Central differences of the residuals are their derivatives, in another reading of the scene, for a column
/// that contains a parameter, and two films.
#[test]
fn derivatives_are_those_of_differences() {
    let scene = built_in("sledge");
    let film = read("t,x,g*phi',y'\n0.1,0,0,1\n0.7,0,,1\n1.5,0,0,1\n", 0.5).unwrap();
    let mut problem = problem(&scene, &[film.clone(), film], &["x", "g", "phi'@2", "alpha~0.3±0.2"]).unwrap();
    let start = problem.start().to_vec();
    let (_, jacobian) = problem.weighed(&start, true).unwrap();
    for j in 0..start.len() {
        let mut at = |h: f64| {
            let mut moved = start.clone();
            moved[j] += h;
            problem.weighed(&moved, false).unwrap().0
        };
        let h = 1e-3;
        let difference = ((at(h) - at(-h)) * 8.0 - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
        let off = (&difference - jacobian.column(j)).amax();
        assert!(off < 1e-8 * (1.0 + difference.amax()), "{j}: {off:e}");
    }
}
