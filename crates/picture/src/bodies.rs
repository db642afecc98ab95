//! Bodies that move: an SVG that plays by itself, and is legible where it does not.

use super::draw::{BUDGET, clipped, headline, opening, swatch};
use super::frame::{BOLD, LEGEND_ROW, TITLE_SIZE};
use super::layout::{self, Entry, LABEL_SIZE, WIDTH};
use super::solid::{Camera, Solid, Space};
use super::style::{INK, Style};
use super::text::{px, width, wrap};
use super::trace::{Coarseness, Extent, Place, Trace};

/// What belongs to one motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Bodies {
    /// Label in the legend.
    pub label: String,
    /// Colour, and how the path is dashed.
    pub style: Style,
    /// What moves; the first lies on top.
    pub solids: Vec<Solid>,
    /// A path in space, drawn as a thin line.
    pub path: Vec<Space>,
}

/// Several motions of the same bodies over one another, in a loop of 6 s and a pause. Between poses points
/// run straight. Of the poses every second is kept, or fewer, down to every 20th, as 60 kB allow.
///
/// Seen from above where everything lies in the plane z = 0, else from an oblique direction. The frame shows
/// the ground and all of the first motion; another one that runs far away leaves it, and the legend says
/// when. Who asks for reduced motion, or does not animate, sees bodies on their paths at half time, or
/// earlier if one would have left the frame. Below the frame stand a scale and an arrow; paths have their
/// names if these do not meet.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingPicture {
    /// Headline of the picture.
    pub title: String,
    /// Times of the first and the last step, and their unit.
    pub time: (f64, f64, String),
    /// What belongs to all motions, below them.
    pub ground: Vec<Solid>,
    /// The motions: their solids have as many poses each.
    pub motions: Vec<Bodies>,
    /// Unit of length, for the scale.
    pub unit: String,
    /// A direction in space with its name, for an arrow: `downhill`.
    pub down: (Space, String),
}

/// Widths of paths in parts of those of curves.
const PATH: f64 = 0.65;

/// Seconds that a loop takes.
const PLAY: f64 = 6.0;
/// All begin at once, and anew after a pause; `t` is the clock.
const BEGIN: &str = "0s;t.end+1.5s";

/// A motion widens the frame at most this many times.
const WIDENED: f64 = 2.0;

/// Azimuth and elevation of the eye where bodies are not in a plane, in radians.
const OBLIQUE: [f64; 2] = [0.4, 0.5];

/// Height of the strip of the scale, and length of the arrow in it.
const STRIP: f64 = 30.0;
const ARROW: f64 = 24.0;

/// Between a name and the path that it names, in pixels.
const BESIDE: f64 = 10.0;

const MARGIN: f64 = 16.0;
/// Within the frame, for the widths of lines.
const EDGE: f64 = 4.0;
const TALLEST: f64 = 440.0;

/// The lowest and the highest of what is seen.
#[derive(Clone, Copy)]
struct Window {
    low: Place,
    high: Place,
}

impl Window {
    const EMPTY: Window = Window { low: (f64::INFINITY, f64::INFINITY), high: (f64::NEG_INFINITY, f64::NEG_INFINITY) };

    fn with(self, place: Place) -> Window {
        self.and(Window { low: place, high: place })
    }

    fn and(self, Window { low, high }: Window) -> Window {
        let (lowest, highest) = (self.low, self.high);
        Window { low: (lowest.0.min(low.0), lowest.1.min(low.1)), high: (highest.0.max(high.0), highest.1.max(high.1)) }
    }

    fn size(self) -> Place {
        (self.high.0 - self.low.0, self.high.1 - self.low.1)
    }

    fn diagonal(self) -> f64 {
        self.size().0.hypot(self.size().1)
    }

    /// Widened to all of a frame, at this number of pixels per unit.
    fn filling(self, extent: Extent, scale: f64) -> Window {
        let (w, h) = self.size();
        let (x, y) = ((extent.width / scale - w) / 2.0, (extent.height / scale - h) / 2.0);
        self.with((self.low.0 - x, self.low.1 - y)).with((self.high.0 + x, self.high.1 + y))
    }

    fn meets(self, other: Window) -> bool {
        let apart = |low: Place, high: Place| low.0 > high.0 || low.1 > high.1;
        !apart(self.low, other.high) && !apart(other.low, self.high)
    }

    /// Whether another one lies in it.
    fn holds(self, other: Window) -> bool {
        self.low.0 <= other.low.0
            && self.low.1 <= other.low.1
            && other.high.0 <= self.high.0
            && other.high.1 <= self.high.1
    }

    /// Of a solid at a step.
    fn of(solid: &Solid, camera: &Camera, step: usize) -> Window {
        let seen = solid.seen(camera, step);
        let window = seen.lines.into_iter().flatten().fold(Window::EMPTY, Window::with);
        seen.circle.map_or(window, |((x, y), r)| window.with((x - r, y - r)).with((x + r, y + r)))
    }
}

/// From units of length to pixels.
struct Sheet {
    camera: Camera,
    window: Window,
    scale: f64,
    extent: Extent,
}

impl MovingPicture {
    /// The picture as a complete SVG document; none where nothing moves.
    pub fn to_svg(&self) -> Option<String> {
        let steps = self.motions.iter().flat_map(|m| &m.solids).map(|s| s.poses.len()).max()?;
        let sheet = self.sheet(steps)?;
        let entries = self.legend(&sheet, steps);
        let mut svg = String::new();
        for stride in [2, 3, 4, 5, 6, 8, 10, 12, 15, 20] {
            svg = self.document(&sheet, &entries, steps, stride);
            if svg.len() <= BUDGET {
                break;
            }
        }
        Some(svg)
    }

    fn sheet(&self, steps: usize) -> Option<Sheet> {
        let solids = || self.ground.iter().chain(self.motions.iter().flat_map(|m| &m.solids));
        let flat = |s: &Solid| {
            let heights = s.poses.iter().flat_map(|pose| s.lines.iter().flatten().map(|&p| pose.place(p)[2]));
            heights.chain(s.poses.iter().map(|pose| pose.at[2])).all(|z| z.abs() < 1e-9)
        };
        let [azimuth, elevation] = OBLIQUE;
        let camera = if solids().all(flat) { Camera::ABOVE } else { Camera::oblique(azimuth, elevation) };
        let of = |solids: &[Solid]| {
            let each = solids.iter().flat_map(|s| (0..s.poses.len()).map(move |step| Window::of(s, &camera, step)));
            each.fold(Window::EMPTY, Window::and)
        };
        let windows: Vec<Window> = self.motions.iter().map(|m| of(&m.solids)).collect();
        let first = windows.first()?.and(of(&self.ground));
        let widened = windows.iter().map(|w| w.and(first)).filter(|w| w.diagonal() <= WIDENED * first.diagonal());
        let window = widened.fold(first, Window::and);
        let (w, h) = window.size();
        let room = WIDTH - 2.0 * MARGIN;
        let scale = ((room - 2.0 * EDGE) / w).min((TALLEST - 2.0 * EDGE) / h);
        let extent = Extent { width: room, height: h * scale + 2.0 * EDGE };
        let enough = scale.is_finite() && scale > 0.0 && steps > 1;
        enough.then(|| Sheet { camera, window: window.filling(extent, scale), scale, extent })
    }

    fn legend(&self, sheet: &Sheet, steps: usize) -> Vec<Entry> {
        let (from, to, unit) = &self.time;
        let time = |step: usize| from + (to - from) * step as f64 / (steps - 1) as f64;
        let leaves = |motion: &Bodies| {
            let seen = |s: &Solid, step| sheet.window.meets(Window::of(s, &sheet.camera, step));
            (0..steps).find(|&step| !motion.solids.iter().any(|s| seen(s, step)))
        };
        let label = |motion: &Bodies| match leaves(motion) {
            Some(step) => format!("{}; leaves the picture at {:.1} {unit}", motion.label, time(step)),
            None => motion.label.clone(),
        };
        self.motions.iter().map(|motion| Entry::plain(label(motion), motion.style)).collect()
    }

    fn document(&self, sheet: &Sheet, entries: &[Entry], steps: usize, stride: usize) -> String {
        let title = wrap(&self.title, BOLD * TITLE_SIZE, WIDTH - 2.0 * MARGIN);
        let (placed, rows) = layout::place_legend(entries, WIDTH - 2.0 * MARGIN);
        let legend_top = 8.0 + 20.0 * title.len() as f64;
        let top = legend_top + f64::from(rows) * LEGEND_ROW + 8.0;
        let frame = top + sheet.extent.height;
        let bottom = frame + STRIP;
        let labels: Vec<String> = placed.iter().map(|place| place.text.clone()).collect();
        let mut out =
            opening(&self.title, &format!("Bodies in motion: {}.", labels.join("; ")), (WIDTH, bottom + 34.0));
        // who animates and is not asked to be still sees the moving ones
        out += "<style>.still{display:none}@media (prefers-reduced-motion:reduce){.moving{display:none}.still{display:inline}}</style>\n";
        headline(&mut out, &title, MARGIN);
        placed.iter().for_each(|place| swatch(&mut out, place, (MARGIN, legend_top)));
        clipped(&mut out, (MARGIN, top), sheet.extent, " fill=\"none\" stroke-linejoin=\"round\"");
        let shown: Vec<usize> = (0..steps).step_by(stride).collect();
        let (fixed, turning): (Vec<&Solid>, Vec<&Solid>) = self.ground.iter().partition(|s| s.poses.len() == 1);
        out += &format!("<g stroke=\"{INK}\" stroke-opacity=\".6\">\n");
        sheet.draw(&mut out, &fixed, &[0], 0);
        sheet.draw(&mut out, &turning, &shown, self.still(sheet, steps));
        out += "</g>\n";
        let still = self.still(sheet, steps);
        let mut named = Vec::new();
        for motion in &self.motions {
            let (colour, _) = motion.style.outline();
            let pixels = |run: &[Space]| run.iter().map(|&p| sheet.pixels(sheet.camera.project(p))).collect();
            let is_nowhere = |p: &Space| p.iter().any(|x| !x.is_finite());
            let runs: Vec<Vec<Place>> = motion.path.split(is_nowhere).map(pixels).collect();
            let path = Trace::new(&runs, sheet.extent, Coarseness::steps()[2]).path();
            let (dash, width) = motion.style.strokes().last().map_or(("", 1.0), |stroke| (stroke.dash, stroke.width));
            out += &format!(
                "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-dasharray=\"{dash}\"/>\n",
                px(PATH * width)
            );
            named.push((motion, runs.concat()));
        }
        sheet.names(&mut out, &named);
        for motion in &self.motions {
            let (colour, wide) = motion.style.outline();
            out += &format!("<g stroke=\"{colour}\" stroke-width=\"{wide}\">\n");
            sheet.draw(&mut out, &motion.solids.iter().rev().collect::<Vec<_>>(), &shown, still);
            out += "</g>\n";
        }
        out += "</svg>\n";
        self.scale(&mut out, sheet, frame + STRIP / 2.0);
        self.clock(&mut out, bottom + 20.0, still as f64 / (steps - 1) as f64);
        out + "</svg>\n"
    }

    /// The step of the still picture: the last one, up to half of them, at which all motions are seen.
    fn still(&self, sheet: &Sheet, steps: usize) -> usize {
        let inside = |motion: &Bodies, step: usize| {
            let within = |s: &Solid| sheet.window.holds(Window::of(s, &sheet.camera, step.min(s.poses.len() - 1)));
            motion.solids.iter().all(within)
        };
        let all = |step: usize| self.motions.iter().all(|motion| inside(motion, step));
        (1..=steps / 2).rev().find(|&step| all(step)).unwrap_or(steps / 2)
    }

    /// A bar of a round length, and the arrow; from above, that it is so.
    fn scale(&self, out: &mut String, sheet: &Sheet, y: f64) {
        let wanted = 110.0 / sheet.scale;
        let power = 10_f64.powf(wanted.log10().floor());
        let length = [1.0, 2.0, 5.0].map(|digit| digit * power).into_iter().rfind(|l| *l <= wanted).unwrap_or(power);
        let end = MARGIN + length * sheet.scale;
        let decimals = (-length.log10().floor()).max(0.0) as usize;
        let [l, a, r, beside, below] = [MARGIN, y - 4.0, end, end + 8.0, y + 4.5].map(px);
        *out += &format!(
            "<g font-size=\"{LABEL_SIZE}\" fill=\"{INK}\"><path d=\"M{l} {a}v8m0-4H{r}m0-4v8\" stroke=\"{INK}\" stroke-width=\"1.6\" fill=\"none\"/>\
             <text x=\"{beside}\" y=\"{below}\">{length:.decimals$} {}</text>",
            self.unit,
        );
        let (direction, name) = &self.down;
        let (x, up) = sheet.camera.project(*direction);
        let (size, right) = (x.hypot(up), WIDTH - MARGIN);
        if size < 0.05 {
            let [x, y] = [right, y + 4.5].map(px);
            *out += &format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"end\">seen from above</text></g>\n");
            return;
        }
        let (x, down) = (ARROW * x / size, -ARROW * up / size);
        let (from, angle) = ((right - ARROW / 2.0 - x / 2.0, y - down / 2.0), down.atan2(x).to_degrees());
        let [x, down, angle, beside, below] = [from.0, from.1, angle, right - ARROW - 8.0, y + 4.5].map(px);
        let line = ARROW - 6.0;
        *out += &format!(
            "<g transform=\"translate({x} {down}) rotate({angle})\"><path d=\"M0 0h{line}\" stroke=\"{INK}\" stroke-width=\"2\"/>\
             <path d=\"M{ARROW} 0l-9-5v10z\"/></g><text x=\"{beside}\" y=\"{below}\" text-anchor=\"end\">{name}</text></g>\n"
        );
    }

    /// A point that runs along a line: the time of the motion. All else begins with it.
    fn clock(&self, out: &mut String, y: f64, still: f64) {
        let (from, to, unit) = &self.time;
        let [from, to] = [from, to].map(|t| format!("{t} {unit}"));
        let left = MARGIN + width(&from, LABEL_SIZE) + 8.0;
        let right = WIDTH - MARGIN - width(&to, LABEL_SIZE) - 8.0;
        let [y, below, l, r, m] = [y, y + 4.5, left, right, left + still * (right - left)].map(px);
        let [first, last] = [MARGIN, WIDTH - MARGIN].map(px);
        *out += &format!(
            "<g font-size=\"{LABEL_SIZE}\" fill=\"{INK}\"><text x=\"{first}\" y=\"{below}\">{from}</text>\
             <text x=\"{last}\" y=\"{below}\" text-anchor=\"end\">{to}</text>\
             <path d=\"M{l} {y}H{r}\" stroke=\"{INK}\"/><circle class=\"moving\" cx=\"{m}\" cy=\"{y}\" r=\"4\">\
             <animate id=\"t\" attributeName=\"cx\" values=\"{l};{r}\" dur=\"{PLAY}s\" begin=\"{BEGIN}\" fill=\"freeze\"/></circle>\
             <circle class=\"still\" cx=\"{m}\" cy=\"{y}\" r=\"4\"/></g>\n"
        );
    }
}

impl Sheet {
    /// Pixels from the top left corner of the frame.
    fn pixels(&self, (x, y): Place) -> Place {
        ((x - self.window.low.0) * self.scale, (self.window.high.1 - y) * self.scale)
    }

    /// What is seen of solids at a step, as path data of the same commands at every step.
    fn path(&self, solids: &[&Solid], step: usize) -> String {
        // what is far outside, or nowhere, may lie anywhere outside
        let near = |(x, y): Place| {
            let Extent { width: w, height: h } = self.extent;
            let [x, y] = if x.is_nan() || y.is_nan() { [-w, -h] } else { [x, y] };
            (x.clamp(-w, 2.0 * w), y.clamp(-h, 2.0 * h))
        };
        let seen: Vec<_> = solids.iter().map(|s| s.seen(&self.camera, step)).collect();
        let lines = seen.iter().flat_map(|s| &s.lines);
        let lines = lines.map(|line| line.iter().map(|&p| near(self.pixels(p))).collect()).collect();
        let circle = |&((x, y), r): &(Place, f64)| {
            let ((x, y), r) = (near(self.pixels((x, y))), r * self.scale);
            let (left, y, r, d) = (px(x - r), px(y), px(r), px(2.0 * r));
            format!("M{left} {y}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0-{d} 0")
        };
        let circles: String = seen.iter().filter_map(|s| s.circle.as_ref()).map(circle).collect();
        Trace { lines, dots: Vec::new() }.path() + &circles
    }

    /// Each name beside its path, where it covers the least of all paths and names and is far from other
    /// paths.
    fn names(&self, out: &mut String, named: &[(&Bodies, Vec<Place>)]) {
        let Extent { width: right, height } = self.extent;
        let mut covered: Vec<Place> = named.iter().flat_map(|(_, path)| path).copied().collect();
        for (i, (motion, path)) in named.iter().enumerate() {
            let name = motion.label.split([';', '(']).next().unwrap_or_default().trim();
            let wide = BOLD * width(name, LABEL_SIZE);
            let beside = |(x, y): Place| {
                let heights = [-BESIDE, LABEL_SIZE / 3.0, LABEL_SIZE + BESIDE];
                [-wide - BESIDE, -wide / 2.0, BESIDE].map(|dx| heights.map(|dy| (x + dx, y + dy))).concat()
            };
            let inside = |(x, y): &Place| *x >= 0.0 && x + wide <= right && *y >= LABEL_SIZE && *y <= height;
            let cost = |(x, y): Place| {
                let margin = BESIDE / 2.0;
                let under = |(px, py): &Place| {
                    (x - margin..=x + wide + margin).contains(px) && (y - LABEL_SIZE..=y + margin).contains(py)
                };
                let others = named.iter().enumerate().filter(|(j, _)| *j != i).flat_map(|(_, (_, path))| path);
                let apart = |(px, py): &Place| (px - x - wide / 2.0).hypot(py - y);
                covered.iter().filter(|place| under(place)).count() as f64
                    - others.map(apart).fold(WIDTH, f64::min) / WIDTH
            };
            let places = path.iter().step_by(path.len() / 64 + 1).flat_map(|&place| beside(place)).filter(inside);
            let priced = places.map(|place| (cost(place), place));
            let Some((_, (x, y))) = priced.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            covered.extend((0..=8).map(|k| (x + wide * f64::from(k) / 8.0, y - LABEL_SIZE / 2.0)));
            let ([x, y], (colour, _)) = ([x, y].map(px), motion.style.outline());
            *out += &format!(
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{LABEL_SIZE}\" font-weight=\"600\" fill=\"{colour}\">{name}</text>\n"
            );
        }
    }

    /// The solids at the steps, or still if there is one only.
    fn draw(&self, out: &mut String, solids: &[&Solid], steps: &[usize], still: usize) {
        if solids.is_empty() {
            return;
        }
        let still = self.path(solids, still);
        if steps.len() == 1 {
            *out += &format!("<path d=\"{still}\"/>\n");
            return;
        }
        let values: Vec<String> = steps.iter().map(|&step| self.path(solids, step)).collect();
        *out += &format!(
            "<path class=\"still\" d=\"{still}\"/>\n<path class=\"moving\" d=\"{still}\">\
             <animate attributeName=\"d\" values=\"{}\" dur=\"{PLAY}s\" begin=\"{BEGIN}\" fill=\"freeze\"/></path>\n",
            values.join(";")
        );
    }
}
