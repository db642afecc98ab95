//! Whole pictures.

use picture::{Axis, Curve, Panel, Picture, PictureError, Scale, Style};

fn curve(style: Style, points: impl IntoIterator<Item = (f64, f64)>) -> Curve {
    Curve { label: format!("{style:?}"), style, points: points.into_iter().collect() }
}

fn picture(curves: Vec<Curve>) -> Picture {
    Picture::new("Knife edge", Axis::linear("t (s)"), Axis::linear("x (m)"), curves)
}

fn sine(frequency: f64) -> impl Iterator<Item = (f64, f64)> {
    (0..20_000).map(f64::from).map(move |i| (i * 1e-3, (i * 1e-3 * frequency).sin()))
}

fn gap() -> Picture {
    let times = (0..2000).map(|i| 10f64.powf(-3.0 + f64::from(i) / 500.0));
    let limit = Curve { label: "limit".into(), ..curve(Style::Threshold, [(1e-3, 1e-13), (10.0, 1e-12)]) };
    let curves = vec![curve(Style::ChetaevVakonomic, times.map(|t| (t, 0.1 * t.powi(3)))), limit];
    Picture::new("Knife edge", Axis::log("t (s)"), Axis::log("gap (m)"), curves)
}

/// Text of every `text` element of a well-formed document.
fn texts(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).unwrap();
    document
        .descendants()
        .filter(|node| node.has_tag_name("text"))
        .filter_map(|node| node.text())
        .map(str::to_owned)
        .collect()
}

fn has(texts: &[String], wanted: &str) -> bool {
    texts.iter().any(|text| text == wanted)
}

#[test]
fn same_input_gives_the_same_bytes() {
    assert_eq!(gap().to_svg(), gap().to_svg());
}

#[test]
fn names_everything_once() {
    let svg = gap().to_svg().unwrap();
    let texts = texts(&svg);
    for wanted in ["Knife edge", "t (s)", "gap (m)", "ChetaevVakonomic", "limit", "10⁻⁸", "10¹"] {
        assert_eq!(texts.iter().filter(|text| *text == wanted).count(), 1, "{wanted} in {texts:?}");
    }
    let document = roxmltree::Document::parse(&svg).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("role"), Some("img"));
    assert!(root.children().any(|node| node.has_tag_name("title") && node.text() == Some("Knife edge")));
    assert!(svg.contains("prefers-color-scheme:dark") && root.attribute("color").is_some());
}

#[test]
fn every_style_is_drawn_and_told_apart() {
    use Style::*;
    let styles = [
        Chetaev,
        Vakonomic,
        RemovedConstraint,
        Substituted,
        ChetaevVakonomic,
        ChetaevRemovedConstraint,
        VakonomicRemovedConstraint,
        Threshold,
    ];
    let looks: std::collections::HashSet<String> =
        styles.iter().map(|style| format!("{:?}", style.strokes())).collect();
    assert_eq!(looks.len(), styles.len());
    let svg = picture(styles.map(|style| curve(style, sine(1.0))).to_vec()).to_svg().unwrap();
    for stroke in styles.iter().flat_map(|style| style.strokes()) {
        assert!(svg.contains(&format!("stroke=\"{}\" stroke-width=\"{}\"", stroke.colour, stroke.width)));
    }
}

#[test]
fn files_stay_small() {
    let fast = |style| curve(style, sine(3000.0));
    let fast = || [Style::Chetaev, Style::Vakonomic, Style::RemovedConstraint].map(fast).to_vec();
    let panel = || Panel::new(Axis::linear("x (m)"), fast());
    let panels = Picture::panels("Fast", Axis::linear("t (s)"), vec![panel(), panel(), panel(), panel()], 1);
    let size = panels.to_svg().unwrap().len();
    assert!(size <= 60_000, "{size} bytes");
    let size = picture(vec![curve(Style::Chetaev, sine(1.0))]).to_svg().unwrap().len();
    assert!(size <= 6_000, "{size} bytes");
}

#[test]
fn equal_aspect_makes_circles_round() {
    let circle = sine(1.0).map(|(t, _)| (3.0 + t.cos(), 1e3 + t.sin()));
    let svg = Picture::plane("Circle", ["x (m)", "y (m)"], vec![curve(Style::Chetaev, circle)], 0).to_svg().unwrap();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let line = document.descendants().rfind(|node| node.attribute("stroke-width") == Some("5.4")).unwrap();
    let data = line.attribute("d").unwrap().replace('-', " -").replace(['M', 'l'], " ");
    let numbers: Vec<f64> = data.split_whitespace().map(|number| number.parse().unwrap()).collect();
    let (mut place, mut low, mut high) = ([0.0; 2], [f64::MAX; 2], [f64::MIN; 2]);
    for step in numbers.chunks(2) {
        for axis in 0..2 {
            place[axis] += step[axis];
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    let [wide, tall] = [high[0] - low[0], high[1] - low[1]];
    assert!(wide > 100.0 && (wide - tall).abs() < 1.0, "{wide} by {tall}");
}

#[test]
fn a_runaway_is_cut_and_marked() {
    let line = |style, end: f64| curve(style, (0..=40).map(|i| f64::from(i) / 40.0).map(|s| (end * s, s)));
    let near = [line(Style::Chetaev, 1.0), line(Style::Vakonomic, -2.0)];
    let with =
        |end| Picture::plane("Plane", ["x (m)", "y (m)"], [&near[..], &[line(Style::Substituted, end)]].concat(), 10);
    let svg = with(178.25).to_svg().unwrap();
    assert!(has(&texts(&svg), "to 178") && !has(&texts(&svg), "50"), "{:?}", texts(&svg));
    // five dots on each of the near ones, that of the start on the runaway, and the ring
    assert_eq!(svg.matches("<circle").count(), 12);
    assert!(!texts(&with(10.0).to_svg().unwrap()).iter().any(|text| text.starts_with("to ")));
}

#[test]
fn a_family_is_a_fan_of_lines_and_sets_no_range() {
    let member = |i: u32| curve(Style::Family, [(0.0, 0.0), (f64::from(i), 50.0)]);
    let near = curve(Style::Chetaev, [(0.0, 0.0), (1.0, 1.0)]);
    let svg = picture((0..30).map(member).chain([near]).collect()).to_svg().unwrap();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let stroked = |node: &roxmltree::Node| node.attribute("stroke-width") == Some("1.1") && node.has_tag_name("g");
    let fan = document.descendants().find(stroked).unwrap();
    let shades: Vec<f64> = fan.children().filter_map(|node| node.attribute("stroke-opacity")?.parse().ok()).collect();
    // every member is a line, the later the stronger
    assert!(shades.len() == 30 && shades.is_sorted() && shades[0] < shades[29], "{shades:?}");
    assert!(has(&texts(&svg), "1.0") && !has(&texts(&svg), "50"), "{:?}", texts(&svg));
}

#[test]
fn a_second_label_of_one_style_gets_marks() {
    let mut second = curve(Style::Vakonomic, sine(2.0));
    second.label = "best fit".into();
    let one = picture(vec![curve(Style::Vakonomic, sine(1.0))]).to_svg().unwrap();
    let two = picture(vec![curve(Style::Vakonomic, sine(1.0)), second]).to_svg().unwrap();
    assert!(!one.contains("a5 5") && two.contains("a5 5"));
    assert!(has(&texts(&two), "best fit"));
}

#[test]
fn what_cannot_be_drawn_is_counted() {
    let points = [(0.0, 1.0), (1.0, f64::NAN), (2.0, -1.0), (3.0, 0.0), (f64::INFINITY, 1.0), (5.0, 2.0), (6.0, 3.0)];
    let curves = vec![curve(Style::Chetaev, points), curve(Style::Vakonomic, [])];
    let svg = Picture::new("Gap", Axis::linear("t (s)"), Axis::log("gap (m)"), curves).to_svg().unwrap();
    let texts = texts(&svg);
    assert!(has(&texts, "Chetaev (left out: 2 ≤ 0, 2 not finite)"), "{texts:?}");
    assert!(has(&texts, "Vakonomic (no points)"), "{texts:?}");
    assert_eq!(svg.matches("<circle").count(), 1, "the point that stands alone");
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn nothing_to_draw_is_an_error() {
    for points in [vec![], vec![(0.0, f64::NAN)]] {
        let error = picture(vec![curve(Style::Chetaev, points)]).to_svg().unwrap_err();
        assert!(matches!(error, PictureError::NothingToDraw { .. }), "{error}");
    }
    let points = vec![curve(Style::Chetaev, [(0.0, 1.0), (-1.0, 1.0)])];
    let log = Picture::new("Knife edge", Axis::log("t (s)"), Axis::linear("x (m)"), points);
    match log.to_svg().unwrap_err() {
        PictureError::NothingToDraw { not_positive, not_finite, axis, .. } => {
            assert_eq!((not_positive, not_finite, axis.as_str()), (2, 0, "t (s)"));
        }
        other => panic!("{other}"),
    }
    let none = Picture::panels("None", Axis::linear("t (s)"), vec![], 2);
    assert!(matches!(none.to_svg(), Err(PictureError::NothingToDraw { .. })));
}

#[test]
fn given_ranges_stand_in_for_points() {
    let empty = |ends: (f64, f64)| {
        let x = Axis { range: Some((0.0, 10.0)), ..Axis::linear("t (s)") };
        let y = Axis { range: Some(ends), ..Axis::linear("x (m)") };
        Picture::new("Knife edge", x, y, vec![])
    };
    let texts = texts(&empty((-1.0, 1.0)).to_svg().unwrap());
    assert!(has(&texts, "10") && has(&texts, "−1.0"), "{texts:?}");
    assert!(matches!(empty((1.0, -1.0)).to_svg(), Err(PictureError::Range { .. })));
}

#[test]
fn hard_numbers_make_sound_documents() {
    let extremes = [1e300, -1e300, 1e-300, 5e-324, 0.0, -0.0, f64::MAX, f64::NAN, 1.0, 1.0 + 1e-15, 3e8];
    for scale_x in [Scale::Linear, Scale::Log] {
        for scale_y in [Scale::Linear, Scale::Log] {
            for &a in &extremes {
                for &b in &extremes {
                    for range in [None, Some((1.0, 2.0))] {
                        let x = Axis { scale: scale_x, label: "<x> & \"\u{1}".into(), range };
                        let y = Axis { scale: scale_y, ..Axis::linear("y") };
                        let curves = vec![
                            curve(Style::Chetaev, [(a, b), (b, a), (1.0, 1.0)]),
                            curve(Style::Threshold, [(a, b)]),
                        ];
                        let hard = Picture::new("Hard", x, y, curves);
                        let svg = hard.to_svg().unwrap();
                        roxmltree::Document::parse(&svg).unwrap();
                        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{a} {b}: {svg}");
                    }
                }
            }
        }
    }
}

#[test]
fn panels_share_the_legend_and_the_horizontal_axis() {
    let curves = || vec![curve(Style::Chetaev, sine(1.0))];
    let panel = |label: &str| Panel { title: format!("of {label}"), ..Panel::new(Axis::linear(label), curves()) };
    let panels = vec![panel("x (m)"), panel("y (m)"), panel("θ (rad)")];
    let panels = Picture::panels("Disk", Axis::linear("t (s)"), panels, 2);
    let texts = texts(&panels.to_svg().unwrap());
    assert!(has(&texts, "of y (m)"), "{texts:?}");
    assert_eq!(texts.iter().filter(|text| *text == "Chetaev").count(), 1);
    assert_eq!(texts.iter().filter(|text| *text == "t (s)").count(), 3, "one per panel");
}
