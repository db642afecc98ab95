//! A number over two others, by colour.

use super::axis::{Direction, Interval, TICK_SIZE, measure, ticks};
use super::draw::{headline, opening, text};
use super::frame::{BOLD, TITLE_SIZE};
use super::plot::{Axis, Scale};
use super::style::INK;
use super::text::{escape, px, wrap};

/// Width and height of the cells together, in pixels; what stands around them.
const SIDE: f64 = 360.0;
const LEFT: f64 = 76.0;
const BAR: f64 = 16.0;
const WIDTH: f64 = 640.0;

/// At most so many counts have a colour each instead of a scale.
const MOST_CLASSES: usize = 8;

/// Low to high, each brighter than the one before: also legible without colours.
const COLOURS: [(f64, f64, f64); 5] =
    [(68.0, 1.0, 84.0), (59.0, 82.0, 139.0), (33.0, 145.0, 140.0), (94.0, 201.0, 98.0), (253.0, 231.0, 37.0)];

/// A number over a grid of two others. A few counts have a colour each; cells without a number are grey; some
/// may be marked.
///
/// ```
/// use picture::{Axis, HeatMap};
/// let map = HeatMap {
///     title: "Product".into(),
///     x: Axis { range: Some((0.0, 2.0)), ..Axis::linear("a") },
///     y: Axis { range: Some((0.0, 1.0)), ..Axis::linear("b") },
///     columns: 3,
///     value: Axis::linear("a b"),
///     cells: vec![Some(0.0), Some(0.0), Some(0.0), Some(0.0), Some(1.0), None],
///     empty: "not decided".into(),
///     marked: vec![false, false, true, false, false, false],
///     mark: "chosen".into(),
/// };
/// let svg = map.to_svg();
/// assert!(svg.matches("<rect").count() > 5 && svg.contains("<title>Product</title>"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// Headline.
    pub title: String,
    /// What changes from left to right, with the values of the first and of the last column.
    pub x: Axis,
    /// What changes upwards, with the values of the lowest and of the highest row.
    pub y: Axis,
    /// Cells in a row.
    pub columns: usize,
    /// Quantity of the colour scale, whose range is that of the cells.
    pub value: Axis,
    /// Row by row, the lowest first.
    pub cells: Vec<Option<f64>>,
    /// Meaning of a cell without a number, which is grey.
    pub empty: String,
    /// Cells with a dot, in the same order.
    pub marked: Vec<bool>,
    /// Meaning of a dot.
    pub mark: String,
}

impl HeatMap {
    /// The picture.
    pub fn to_svg(&self) -> String {
        let title = wrap(&self.title, BOLD * TITLE_SIZE, WIDTH - LEFT - 10.0);
        let marks = self.marked.iter().any(|marked| *marked);
        let top = 20.0 * title.len() as f64 + if marks { 34.0 } else { 14.0 };
        let height = top + SIDE + 52.0;
        let described = format!("{} by colour, over {} and {}.", self.value.label, self.x.label, self.y.label);
        let mut out = opening(&self.title, &described, (WIDTH, height));
        headline(&mut out, &title, LEFT);
        out += &format!("<g font-size=\"{TICK_SIZE}\" fill=\"{INK}\">\n");
        if marks {
            let y = top - 14.0;
            dot(&mut out, (LEFT + 5.0, y - 4.0), 3.0);
            text(&mut out, (LEFT + 16.0, y), "start", &self.mark);
        }
        let measured: Vec<Option<f64>> =
            self.cells.iter().map(|cell| cell.and_then(|value| measure(self.value.scale, value).ok())).collect();
        let finite = || measured.iter().flatten().copied();
        let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        let scale = if low < high { Interval { low, high } } else { Interval { low: low - 0.5, high: low + 0.5 } };
        let classes = self.classes();
        let shade = |value: f64| match classes.iter().position(|class| *class == value) {
            Some(i) => (i as f64 + 0.5) / classes.len() as f64,
            None => scale.fraction(value),
        };
        let rows = self.cells.len().div_ceil(self.columns.max(1));
        let (w, h) = (SIDE / self.columns.max(1) as f64, SIDE / rows.max(1) as f64);
        for (i, value) in measured.iter().enumerate() {
            let (x, y) = (LEFT + w * (i % self.columns) as f64, top + SIDE - h * (i / self.columns + 1) as f64);
            // a hair more than the cell: no seams between them
            match value {
                Some(value) => rectangle(&mut out, (x, y, w + 0.3, h + 0.3), &colour(shade(*value))),
                None => empty(&mut out, (x, y, w, h)),
            }
            if self.marked.get(i) == Some(&true) {
                dot(&mut out, (x + w / 2.0, y + h / 2.0), (w.min(h) / 4.0).clamp(1.0, 3.0));
            }
        }
        let [left, top_edge, side] = [LEFT, top, SIDE].map(px);
        out += &format!(
            "<rect x=\"{left}\" y=\"{top_edge}\" width=\"{side}\" height=\"{side}\" fill=\"none\" stroke=\"{INK}\"/>\n"
        );
        self.axis(&mut out, &self.x, w, top, Direction::Horizontal);
        self.axis(&mut out, &self.y, h, top, Direction::Vertical);
        let none = measured.iter().any(Option::is_none);
        match finite().next() {
            Some(_) if classes.is_empty() => self.bar(&mut out, scale, top, none),
            _ => self.boxes(&mut out, &classes, top, none),
        }
        out + "</g>\n</svg>\n"
    }

    /// The values, if they are a few counts: each has a colour of its own then.
    fn classes(&self) -> Vec<f64> {
        let mut values: Vec<f64> = self.cells.iter().flatten().copied().collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let counts = self.value.scale == Scale::Linear && values.iter().all(|x| x.fract() == 0.0);
        if counts && values.len() <= MOST_CLASSES { values } else { Vec::new() }
    }

    /// A box for each class, with its count, and one for cells without a number.
    fn boxes(&self, out: &mut String, classes: &[f64], top: f64, none: bool) {
        let x = LEFT + SIDE + 28.0;
        for (row, line) in wrap(&self.value.label, TICK_SIZE, WIDTH - x - 4.0).iter().enumerate() {
            text(out, (x, top + 10.0 + 15.0 * row as f64), "start", line);
        }
        let first = top + 50.0;
        let entries = classes
            .iter()
            .enumerate()
            .map(|(i, class)| (Some((i as f64 + 0.5) / classes.len() as f64), class.to_string()));
        let entries = entries.chain(none.then(|| (None, self.empty.clone())));
        for (row, (shade, label)) in entries.enumerate() {
            let y = first + 24.0 * row as f64;
            match shade {
                Some(shade) => rectangle(out, (x, y, BAR, BAR), &colour(shade)),
                None => empty(out, (x, y, BAR, BAR)),
            }
            text(out, (x + BAR + 8.0, y + 12.5), "start", &label);
        }
    }

    /// Ticks in the middle of the cells; `cell` is the length of one.
    fn axis(&self, out: &mut String, axis: &Axis, cell: f64, top: f64, direction: Direction) {
        let (first, last) = axis.range.unwrap_or((0.0, 1.0));
        let interval = Interval { low: first.min(last), high: first.max(last) };
        let across = direction == Direction::Horizontal;
        let middle = LEFT + SIDE / 2.0;
        if interval.span() > 0.0 {
            for tick in ticks(Scale::Linear, interval, SIDE, direction).labelled {
                let along = cell / 2.0 + (tick.at - first) / (last - first) * (SIDE - cell);
                match across {
                    true => text(out, (LEFT + along, top + SIDE + 16.0), "middle", &tick.label),
                    false => text(out, (LEFT - 6.0, top + SIDE - along + 4.0), "end", &tick.label),
                }
            }
        }
        match across {
            true => text(out, (middle, top + SIDE + 38.0), "middle", &axis.label),
            false => {
                let (y, label) = (px(top + SIDE / 2.0), escape(&axis.label));
                *out += &format!(
                    "<text transform=\"translate(16 {y}) rotate(-90)\" text-anchor=\"middle\">{label}</text>\n"
                );
            }
        }
    }

    /// The colours with their values.
    fn bar(&self, out: &mut String, scale: Interval, top: f64, none: bool) {
        const PARTS: usize = 48;
        let x = LEFT + SIDE + 28.0;
        let part = SIDE / PARTS as f64;
        for i in 0..PARTS {
            let fraction = (i as f64 + 0.5) / PARTS as f64;
            let y = top + SIDE - part * (i + 1) as f64;
            rectangle(out, (x, y, BAR, part + 0.3), &colour(fraction));
        }
        let ticks = ticks(self.value.scale, scale, SIDE, Direction::Vertical);
        for tick in ticks.labelled {
            let y = top + SIDE - scale.fraction(tick.at) * SIDE + 4.0;
            text(out, (x + BAR + 6.0, y), "start", &tick.label);
        }
        let label = match ticks.factor {
            Some(factor) => format!("{} {factor}", self.value.label),
            None => self.value.label.clone(),
        };
        text(out, (x, top + SIDE + 38.0), "start", &label);
        if none {
            empty(out, (x + 70.0, top, BAR, BAR));
            text(out, (x + 78.0 + BAR, top + 12.5), "start", &self.empty);
        }
    }
}

/// A cell without a number.
fn empty(out: &mut String, (x, y, w, h): (f64, f64, f64, f64)) {
    let [x, y, w, h] = [x, y, w, h].map(px);
    *out += &format!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"{INK}\" fill-opacity=\".25\"/>\n");
}

fn dot(out: &mut String, (x, y): (f64, f64), r: f64) {
    let [x, y, r] = [x, y, r].map(px);
    *out += &format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"#fff\" stroke=\"#000\" stroke-width=\".5\"/>\n");
}

fn colour(fraction: f64) -> String {
    let place = fraction.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let below = (place as usize).min(COLOURS.len() - 2);
    let part = place - below as f64;
    let (a, b) = (COLOURS[below], COLOURS[below + 1]);
    let mix = |x: f64, y: f64| (x + part * (y - x)).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

fn rectangle(out: &mut String, (x, y, w, h): (f64, f64, f64, f64), fill: &str) {
    let [x, y, w, h] = [x, y, w, h].map(px);
    *out += &format!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"{fill}\"/>\n");
}
