//! The SVG document.

use super::axis::TICK_SIZE;
use super::error::PictureError;
use super::frame::{BOLD, Frame, Framed, LEGEND_ROW, TITLE_SIZE};
use super::layout::{self, Entry, LABEL_SIZE, Measured, SWATCH, WIDTH};
use super::plot::{Curve, Picture};
use super::style::{CROSS, INK, INKS, Stroke, Style};
use super::text::{decimal, escape, fit, px, width};
use super::trace::{Coarseness, Extent, Place, Trace};

/// Limit of the file size, in bytes.
pub const BUDGET: usize = 60_000;

impl Picture {
    /// The picture as a complete SVG document.
    ///
    /// # Errors
    /// [`PictureError`], where an axis cannot be drawn.
    pub fn to_svg(&self) -> Result<String, PictureError> {
        document(self)
    }
}

fn document(plots: &Picture) -> Result<String, PictureError> {
    let measured: Vec<Vec<Measured>> = plots
        .panels
        .iter()
        .map(|panel| {
            let measure = |curve| Measured::new(curve, &plots.x, &panel.y);
            panel.curves.iter().map(measure).collect()
        })
        .collect();
    let ranges = layout::ranges(plots, &measured)?;
    let legend = layout::legend(plots, &measured);
    let mut svg = String::new();
    for coarseness in Coarseness::steps() {
        svg = sheet(plots, &measured, &ranges, &legend, coarseness);
        if svg.len() <= BUDGET {
            break;
        }
    }
    Ok(svg)
}

/// The whole document at one coarseness.
fn sheet(
    plots: &Picture,
    measured: &[Vec<Measured>],
    ranges: &layout::Ranges,
    legend: &[Entry],
    coarseness: Coarseness,
) -> String {
    let frame = Frame::new(plots, ranges, legend);
    let framed = frame.plots(plots, measured, legend);
    let mut out = opening(&plots.title, &description(plots, legend), (WIDTH, frame.height));
    headline(&mut out, &frame.title, frame.left);
    let (placed, _) = layout::place_legend(legend, WIDTH - frame.left - 8.0);
    for place in &placed {
        swatch(&mut out, place, (frame.left, frame.legend_top));
    }
    for plot in &framed {
        axes(&mut out, plot);
        curves(&mut out, plot, coarseness);
    }
    out.push_str("</svg>\n");
    out
}

/// The beginning of a document of this width and height, with its inks.
pub(super) fn opening(title: &str, description: &str, (width, height): (f64, f64)) -> String {
    let title = escape(title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" role=\"img\" \
         aria-label=\"{title}\" class=\"picture\" color=\"{}\" \
         font-family=\"system-ui,-apple-system,'Segoe UI',Helvetica,Arial,sans-serif\">\n\
         <title>{title}</title>\n<desc>{}</desc>\n\
         <style>@media (prefers-color-scheme:light){{.picture{{color:{}}}}}\
         @media (prefers-color-scheme:dark){{.picture{{color:{}}}}}</style>\n",
        INKS[0],
        escape(description),
        INKS[1],
        INKS[2],
        w = px(width),
        h = px(height),
    )
}

/// The title, in lines.
pub(super) fn headline(out: &mut String, lines: &[String], left: f64) {
    for (row, line) in (1u32..).zip(lines) {
        let ([x, y], line) = ([left, f64::from(row) * 20.0].map(px), escape(line));
        *out += &format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{TITLE_SIZE}\" font-weight=\"600\" fill=\"{INK}\">{line}</text>\n"
        );
    }
}

/// Description of the picture, for readers who do not see it.
fn description(plots: &Picture, legend: &[Entry]) -> String {
    let vertical: Vec<&str> = plots.panels.iter().map(|panel| panel.y.label.as_str()).collect();
    let curves: Vec<String> = legend.iter().map(Entry::text).collect();
    format!("{} over {}. Curves: {}.", vertical.join(", "), plots.x.label, curves.join("; "))
}

/// An entry of the legend, whose top left corner is at `(left, top)`.
pub(super) fn swatch(out: &mut String, place: &layout::Placed, (left, top): Place) {
    let (x, y) = (left + place.x, top + (f64::from(place.row) + 0.5) * LEGEND_ROW);
    out.push_str(&format!("<g transform=\"translate({} {})\">", px(x), px(y)));
    let entry = place.entry;
    if entry.style == Style::Stops {
        crosses(out, &[(SWATCH / 2.0, 0.0)]);
    } else {
        let trace = Trace { lines: vec![vec![(0.0, 0.0), (SWATCH, 0.0)]], dots: Vec::new() };
        strokes(out, entry.style, &trace);
    }
    marks(out, entry, &[(SWATCH / 2.0, 0.0)]);
    let (x, label) = (px(SWATCH + 8.0), escape(&place.text));
    *out += &format!("<text x=\"{x}\" y=\"4.5\" font-size=\"{LABEL_SIZE}\" fill=\"{INK}\">{label}</text></g>\n");
}

/// Frame, grid, ticks and labels of one plot.
fn axes(out: &mut String, plot: &Framed) {
    let Extent { width: w, height: h } = plot.extent;
    let (x, y) = (px(plot.corner.0), px(plot.corner.1));
    *out += &format!("<g transform=\"translate({x} {y})\" font-size=\"{TICK_SIZE}\" fill=\"{INK}\">\n");
    let (mut grid, mut ticks) = (String::new(), String::new());
    for tick in &plot.x_ticks.labelled {
        let x = px(plot.across(tick.at));
        grid.push_str(&format!("M{x} 0v{}", px(h)));
        ticks.push_str(&format!("M{x} {}v5", px(h)));
    }
    for tick in &plot.y_ticks.labelled {
        let y = px(plot.down(tick.at));
        grid.push_str(&format!("M0 {y}h{}", px(w)));
        ticks.push_str(&format!("M0 {y}h-5"));
    }
    for &at in &plot.x_ticks.minor {
        ticks.push_str(&format!("M{} {}v3", px(plot.across(at)), px(h)));
    }
    for &at in &plot.y_ticks.minor {
        ticks.push_str(&format!("M0 {}h-3", px(plot.down(at))));
    }
    out.push_str(&format!(
        "<path d=\"{grid}\" fill=\"none\" stroke=\"{INK}\" stroke-opacity=\".2\"/>\n\
         <path d=\"{ticks}M0 0h{}v{}h-{0}z\" fill=\"none\" stroke=\"{INK}\"/>\n",
        px(w),
        px(h)
    ));
    for tick in &plot.y_ticks.labelled {
        text(out, (-9.0, plot.down(tick.at) + 4.3), "end", &tick.label);
    }
    if let Some(factor) = &plot.y_ticks.factor {
        text(out, (0.0, -7.0), "start", factor);
    }
    if !plot.plot.title.is_empty() {
        out.push_str("<g font-weight=\"600\">");
        text(out, (w / 2.0, -7.0), "middle", &fit(&plot.plot.title, BOLD * TICK_SIZE, w));
        out.push_str("</g>\n");
    }
    for tick in &plot.x_ticks.labelled {
        text(out, (plot.across(tick.at), h + 18.0), "middle", &tick.label);
    }
    if let Some(factor) = &plot.x_ticks.factor {
        text(out, (w, h + 37.0), "end", factor);
    }
    let ([x, y], label) = ([w / 2.0, h + 38.0].map(px), escape(&fit(plot.x_label, LABEL_SIZE, w)));
    *out += &format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\" font-size=\"{LABEL_SIZE}\">{label}</text>\n");
    let widest = plot.y_ticks.labelled.iter().map(|tick| width(&tick.label, TICK_SIZE));
    let [x, y] = [widest.fold(0.0, f64::max) + 18.0, h / 2.0].map(px);
    let label = escape(&fit(&plot.plot.y.label, LABEL_SIZE, h + 20.0));
    *out += &format!(
        "<text transform=\"translate(-{x} {y}) rotate(-90)\" text-anchor=\"middle\" font-size=\"{LABEL_SIZE}\">{label}</text>\n"
    );
    thresholds(out, plot);
    out.push_str("</g>\n");
}

/// Names of the thresholds, at their right ends.
fn thresholds(out: &mut String, plot: &Framed) {
    let threshold = |(curve, _): &(&Curve, &Measured)| curve.style == Style::Threshold;
    for (curve, measured) in plot.plot.curves.iter().zip(plot.measured).filter(threshold) {
        let end = measured.runs.last().and_then(|run| run.last()).filter(|point| plot.y.contains(point.1));
        if let Some(&(_, at)) = end {
            let y = plot.down(at).min(plot.extent.height);
            text(out, (plot.extent.width + 6.0, y + 4.3), "start", &fit(&curve.label, TICK_SIZE, 150.0));
        }
    }
}

/// A line of text, as large as what it stands in says.
pub(super) fn text(out: &mut String, (x, y): Place, anchor: &str, content: &str) {
    let ([x, y], content) = ([x, y].map(px), escape(content));
    *out += &format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{content}</text>\n");
}

/// The beginning of a part that is clipped to its frame, of which all has these attributes.
pub(super) fn clipped(out: &mut String, (x, y): Place, extent: Extent, attributes: &str) {
    let [x, y, width, height] = [x, y, extent.width, extent.height].map(px);
    *out +=
        &format!("<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" overflow=\"hidden\"{attributes}>\n");
}

/// The curves of one plot, clipped to its frame.
fn curves(out: &mut String, plot: &Framed, coarseness: Coarseness) {
    clipped(out, plot.corner, plot.extent, "");
    let mut order: Vec<(&Curve, &Measured)> = plot.plot.curves.iter().zip(plot.measured).collect();
    order.sort_by_key(|(curve, _)| curve.style);
    let place = |&(x, y): &(f64, f64)| (plot.across(x), plot.down(y));
    // members of a family are drawn together
    for curves in order.chunk_by(|a, b| [a.0.style, b.0.style] == [Style::Family; 2]) {
        let (curve, measured) = curves[0];
        let runs = curves.iter().flat_map(|(_, measured)| &measured.runs);
        let runs: Vec<Vec<Place>> = runs.map(|run| run.iter().map(place).collect()).collect();
        if curve.style == Style::Family {
            fan(out, &runs, plot.extent);
            continue;
        }
        if curve.style == Style::Samples {
            samples(out, &runs, plot.extent);
            continue;
        }
        if curve.style == Style::Stops {
            crosses(out, &runs.concat());
            continue;
        }
        let mut trace = Trace::new(&runs, plot.extent, coarseness);
        if plot.every > 0 {
            let Extent { width: w, height: h } = plot.extent;
            let seen = |&(x, y): &Place| (0.0..=w).contains(&x) && (0.0..=h).contains(&y);
            trace.dots.extend(runs.iter().flat_map(|run| run.iter().step_by(plot.every)).copied().filter(seen));
        }
        strokes(out, curve.style, &trace);
        if curve.style > Style::Threshold {
            leaving(out, plot, curve.style, measured);
        }
        if let Some(entry) = plot.legend.iter().find(|entry| entry.stands_for(curve)) {
            let phase = 0.25 + 0.5 * (entry.rank % 4) as f64 / 4.0;
            let points: Vec<Place> = measured.runs.iter().flatten().map(place).collect();
            let places = if points.len() <= 12 { points } else { trace.marks(7, phase) };
            marks(out, entry, &places);
        }
    }
    let first = plot.plot.curves.iter().zip(plot.measured).find(|(curve, _)| curve.style > Style::Threshold);
    if let Some(start) = first.and_then(|(_, measured)| measured.points().next()).filter(|_| plot.every > 0) {
        let (x, y) = place(&start);
        let [x, y] = [x, y].map(px);
        *out += &format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"9\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"2\"/>\n");
    }
    out.push_str("</svg>\n");
}

/// The members of a family as thin lines, the later the stronger.
fn fan(out: &mut String, runs: &[Vec<Place>], extent: Extent) {
    for Stroke { colour, width, opacity, .. } in Style::Family.strokes() {
        out.push_str(&format!("<g fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\">\n"));
        for (i, run) in runs.iter().enumerate() {
            let path = Trace::new(std::slice::from_ref(run), extent, Coarseness::steps()[3]).path();
            let shade = 0.15 + (opacity - 0.15) * i as f64 / runs.len() as f64;
            out.push_str(&format!("<path d=\"{path}\" stroke-opacity=\"{shade:.2}\"/>\n"));
        }
    }
    out.push_str("</g>\n");
}

/// An arrowhead where a runaway leaves for good, with the value that it gets to.
fn leaving(out: &mut String, plot: &Framed, style: Style, measured: &Measured) {
    let beyond_y = |(x, y): (f64, f64)| plot.plot.y.range.is_none() && plot.x.contains(x) && !plot.y.contains(y);
    let beyond = |(x, y): (f64, f64)| (plot.open && !plot.x.contains(x)) || beyond_y((x, y));
    let mut pairs = measured.runs.iter().flat_map(|run| run.windows(2));
    let Some(pair) = pairs.rfind(|pair| !beyond(pair[0]) && beyond(pair[1])) else { return };
    let (mut within, mut outside) = (pair[0], pair[1]);
    for _ in 0..30 {
        let middle = ((within.0 + outside.0) / 2.0, (within.1 + outside.1) / 2.0);
        *(if beyond(middle) { &mut outside } else { &mut within }) = middle;
    }
    let (x, y) = (plot.across(within.0), plot.down(within.1));
    let angle = (plot.down(pair[1].1) - plot.down(pair[0].1)).atan2(plot.across(pair[1].0) - plot.across(pair[0].0));
    let vertical = beyond_y(outside);
    let range = if vertical { plot.y } else { plot.x };
    let middle = range.low / 2.0 + range.high / 2.0;
    let far = |a: &f64, b: &f64| (a - middle).abs().total_cmp(&(b - middle).abs());
    let farthest = measured.points().map(|(x, y)| if vertical { y } else { x }).max_by(far).unwrap_or(middle);
    let exponent = farthest.abs().log10().floor();
    let far = match exponent {
        -3.0..5.0 => decimal(farthest, (2.0 - exponent).max(0.0) as usize),
        _ => format!("{farthest:.1e}"),
    };
    let Extent { width: w, height: h } = plot.extent;
    let (anchor, beside) = if x > w / 2.0 { ("end", -14.0) } else { ("start", 14.0) };
    let ([at_x, at_y, angle], colour) = ([x, y, angle.to_degrees()].map(px), style.strokes()[0].colour);
    *out += &format!(
        "<path transform=\"translate({at_x} {at_y}) rotate({angle})\" d=\"M0 0l-14-7v14z\" fill=\"{colour}\"/>\n\
         <g font-size=\"{TICK_SIZE}\" fill=\"{INK}\">"
    );
    text(out, (x + beside, (y - 10.0).clamp(14.0, h - 6.0)), anchor, &format!("to {far}"));
    out.push_str("</g>\n");
}

fn strokes(out: &mut String, style: Style, trace: &Trace) {
    let path = trace.path();
    for Stroke { colour, width, dash, round, opacity } in style.strokes() {
        if !path.is_empty() {
            out.push_str(&format!("<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\""));
            if !dash.is_empty() {
                out.push_str(&format!(" stroke-dasharray=\"{dash}\""));
            }
            if opacity < 1.0 {
                out.push_str(&format!(" stroke-opacity=\"{opacity}\""));
            }
            if round {
                out.push_str(" stroke-linecap=\"round\"");
            }
            out.push_str(" stroke-linejoin=\"round\"/>\n");
        }
        for &(x, y) in &trace.dots {
            let radius = px(2.0 + width / 2.0);
            out.push_str(&format!("<circle cx=\"{}\" cy=\"{}\" r=\"{radius}\" fill=\"{colour}\"/>\n", px(x), px(y)));
        }
    }
}

/// A cross per point.
fn crosses(out: &mut String, places: &[Place]) {
    let path: String = places.iter().map(|&(x, y)| format!("M{} {}{CROSS}", px(x), px(y))).collect();
    for Stroke { colour, width, .. } in Style::Stops.strokes() {
        out.push_str(&format!("<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>\n"));
    }
}

/// A dot per point, as lines without length.
fn samples(out: &mut String, runs: &[Vec<Place>], extent: Extent) {
    let seen = |&(x, y): &Place| (0.0..=extent.width).contains(&x) && (0.0..=extent.height).contains(&y);
    let dots = runs.iter().flatten().copied().filter(seen).map(|dot| vec![dot, dot]).collect();
    let path = Trace { lines: dots, dots: Vec::new() }.path();
    if let ([Stroke { colour, width, .. }], false) = (&Style::Samples.strokes()[..], path.is_empty()) {
        out.push_str(&format!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\"/>\n"
        ));
    }
}

fn marks(out: &mut String, entry: &Entry, places: &[Place]) {
    let (Some(mark), Some(stroke)) = (entry.mark, entry.style.strokes().pop()) else {
        return;
    };
    if places.is_empty() {
        return;
    }
    let path: String = places.iter().map(|&(x, y)| format!("M{} {}{}", px(x), px(y), mark)).collect();
    out.push_str(&format!("<path d=\"{path}\" fill=\"{}\"/>\n", stroke.colour));
}
