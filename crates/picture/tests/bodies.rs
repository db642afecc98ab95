//! Bodies that move.

use picture::{BUDGET, Bodies, MovingPicture, Placement, Solid, Space, Style};

/// A wheel that rolls along x at some pace, upright or lying.
fn wheel(style: Style, pace: f64, upright: bool) -> Bodies {
    let rim: Vec<Space> = (0..=24)
        .map(|i| (f64::from(i) / 24.0 * std::f64::consts::TAU).sin_cos())
        .map(|(s, c)| if upright { [s, 0.0, c] } else { [s, c, 0.0] })
        .collect();
    let at = |i: i32| [pace * f64::from(i) / 240.0, 0.0, if upright { 1.0 } else { 0.0 }];
    let turned = |angle: f64| {
        let (s, c) = angle.sin_cos();
        [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]
    };
    let pose = |i: i32| Placement { at: at(i), rotation: turned(if upright { at(i)[0] } else { 0.0 }) };
    let solid = Solid { lines: vec![rim], sphere: None, poses: (0..=240).map(pose).collect() };
    let ball = Solid { sphere: Some(0.3), ..solid.clone() };
    Bodies { label: format!("{style:?}"), style, solids: vec![solid, ball], path: (0..=240).map(at).collect() }
}

fn picture(motions: Vec<Bodies>) -> MovingPicture {
    MovingPicture {
        title: "Wheels".into(),
        time: (0.0, 10.0, "s".into()),
        ground: Vec::new(),
        motions,
        unit: "m".into(),
        down: ([0.0, 0.0, -1.0], "down".into()),
    }
}

/// Values of every animated path.
fn animated(svg: &str) -> Vec<Vec<String>> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let paths = document.descendants().filter(|node| node.attribute("attributeName") == Some("d"));
    paths.map(|node| node.attribute("values").unwrap().split(';').map(String::from).collect()).collect()
}

#[test]
fn every_pose_has_the_same_commands_within_the_budget() {
    let styles = [Style::Chetaev, Style::Vakonomic, Style::RemovedConstraint];
    let motions: Vec<Bodies> = styles.into_iter().map(|style| wheel(style, 5.0, true)).collect();
    let svg = picture(motions.clone()).to_svg().unwrap();
    assert!(svg.len() <= BUDGET && !svg.contains("script"), "{} bytes", svg.len());
    let animated = animated(&svg);
    assert_eq!(animated.len(), 3);
    for values in &animated {
        // lines between poses are straight, which is to be seen where there are few
        assert!(values.len() > 40, "{} poses", values.len());
        let commands = |value: &String| value.chars().filter(|c| c.is_alphabetic()).collect::<String>();
        let numbers = |value: &String| {
            let separate = value.replace(|c: char| c.is_alphabetic(), " ").replace('-', " -");
            separate.split_whitespace().count()
        };
        assert!(values.iter().all(|v| commands(v) == commands(&values[0]) && numbers(v) == numbers(&values[0])));
    }
    // more than fits leaves fewer poses
    let many = picture(motions.iter().flat_map(|m| vec![m.clone(); 2]).collect()).to_svg().unwrap();
    assert!(many.len() <= BUDGET, "{} bytes", many.len());
}

#[test]
fn who_runs_away_leaves_the_picture_and_the_legend_says_when() {
    let slow = wheel(Style::Chetaev, 10.0, false);
    let fast = wheel(Style::Vakonomic, 100.0, false);
    let svg = picture(vec![slow.clone(), fast]).to_svg().unwrap();
    // seen from above the frame is from -1 to 11; the centre is at 12 after 1.2 s
    assert!(svg.contains("Vakonomic; leaves the picture at 1.2 s"), "{:?}", &svg[..1200]);
    assert!(svg.contains(">Chetaev<"));
    let near = picture(vec![slow, wheel(Style::Vakonomic, 15.0, false)]).to_svg().unwrap();
    assert!(!near.contains("leaves"));
}

#[test]
fn still_where_nothing_is_to_move() {
    let svg = picture(vec![wheel(Style::Chetaev, 5.0, true)]).to_svg().unwrap();
    assert!(svg.contains("prefers-reduced-motion:reduce"));
    let document = roxmltree::Document::parse(&svg).unwrap();
    let of = |class| document.descendants().filter(|node| node.attribute("class") == Some(class)).count();
    // the wheel and the clock
    assert_eq!((of("still"), of("moving")), (2, 2));
    assert_eq!(picture(Vec::new()).to_svg(), None);
}

/// A body that is nowhere from some time on leaves the picture then, and its path ends before.
#[test]
fn what_is_not_finite_leaves_the_picture() {
    let mut gone = wheel(Style::Vakonomic, 5.0, false);
    gone.solids.iter_mut().for_each(|solid| solid.poses[120..].iter_mut().for_each(|pose| pose.at[0] = f64::NAN));
    gone.path[120..].iter_mut().for_each(|place| place[0] = f64::NAN);
    let svg = picture(vec![wheel(Style::Chetaev, 5.0, false), gone]).to_svg().unwrap();
    assert!(svg.contains("Vakonomic; leaves the picture at 5.0 s") && !svg.contains("NaN"), "{svg}");
    let document = roxmltree::Document::parse(&svg).unwrap();
    let paths = document.descendants().filter(|node| {
        node.attribute("stroke-dasharray").is_some() && node.attribute("stroke-linecap") == Some("round")
    });
    let paths: Vec<&str> = paths.filter_map(|node| node.attribute("d")).collect();
    assert_eq!(paths.len(), 2);
    // the second path goes half as far as the first, and not to a corner
    let length = |path: &str| path[1..].split(['l', ' ']).nth(2).and_then(|dx| dx.parse::<f64>().ok()).unwrap();
    let [whole, half] = [paths[0], paths[1]].map(length);
    assert!((half / whole - 0.5).abs() < 0.01, "{paths:?}");
}
