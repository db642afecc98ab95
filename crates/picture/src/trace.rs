//! From points to the path that is drawn: clipped, thinned, rounded.

use super::text::{push_tenths, tenths};

/// A place in pixels, from the top left corner of a plot.
pub type Place = (f64, f64);

/// Width and height of a plot in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    pub width: f64,
    pub height: f64,
}

/// How far a drawn line may lie from the true one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coarseness {
    /// Points closer than this to the line through their neighbours are left out, in pixels.
    pub tolerance: f64,
    /// Width of a column, of whose points the first, last, highest and lowest are kept.
    pub column: f64,
}

impl Coarseness {
    /// From what the eye cannot see to what it forgives.
    pub fn steps() -> [Self; 5] {
        [1.0, 2.0, 4.0, 8.0, 16.0].map(|times| Self { tolerance: 0.1 * times, column: 0.5 * times })
    }
}

/// One curve, ready to draw.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Lines of at least two points.
    pub lines: Vec<Vec<Place>>,
    /// Points that stand alone.
    pub dots: Vec<Place>,
}

impl Trace {
    /// Clip and thin unbroken runs of points.
    pub fn new(runs: &[Vec<Place>], extent: Extent, coarseness: Coarseness) -> Self {
        let mut trace = Self::default();
        for run in runs {
            if let [dot] = run.as_slice() {
                trace.dots.push(*dot);
            }
            for piece in clip(run, extent) {
                let rising = piece.is_sorted_by(|a, b| a.0 <= b.0);
                let piece = if rising { extremes_by_column(&piece, coarseness.column) } else { piece };
                let mut line = within_tolerance(&piece, coarseness.tolerance);
                line.dedup_by_key(|&mut (x, y)| (tenths(x), tenths(y)));
                match line.as_slice() {
                    [dot] => trace.dots.push(*dot),
                    _ => trace.lines.push(line),
                }
            }
        }
        trace
    }

    /// The lines as SVG path data.
    pub fn path(&self) -> String {
        let mut out = String::new();
        for line in &self.lines {
            let mut last = (0, 0);
            for (i, &(x, y)) in line.iter().enumerate() {
                let here = (tenths(x), tenths(y));
                out.push_str(match i {
                    0 => "M",
                    1 => "l",
                    _ if here.0 < last.0 => "",
                    _ => " ",
                });
                push_tenths(&mut out, here.0 - last.0);
                if here.1 >= last.1 {
                    out.push(' ');
                }
                push_tenths(&mut out, here.1 - last.1);
                last = here;
            }
        }
        out
    }

    /// `count` places at equal distances along the curve, moved along by the fraction `phase` of it.
    pub fn marks(&self, count: u32, phase: f64) -> Vec<Place> {
        let distance = |pair: &[Place]| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
        let segments = || self.lines.iter().flat_map(|line| line.windows(2));
        let total: f64 = segments().map(distance).sum();
        let mut wanted = (0..count).map(|i| (f64::from(i) + phase) * total / f64::from(count)).peekable();
        let mut passed = 0.0;
        let mut marks = Vec::new();
        for pair in segments() {
            let length = distance(pair);
            while let Some(at) = wanted.next_if(|&at| at <= passed + length) {
                let part = ((at - passed) / length).clamp(0.0, 1.0);
                let along = |from: f64, to: f64| from + part * (to - from);
                marks.push((along(pair[0].0, pair[1].0), along(pair[0].1, pair[1].1)));
            }
            passed += length;
        }
        marks
    }
}

/// The pieces of a line within the plot and as much again on every side.
pub fn clip(run: &[Place], extent: Extent) -> Vec<Vec<Place>> {
    let mut pieces: Vec<Vec<Place>> = Vec::new();
    let mut joined = false;
    for pair in run.windows(2) {
        match clip_segment(pair[0], pair[1], extent) {
            None => joined = false,
            Some((from, to, whole)) => {
                match pieces.last_mut() {
                    Some(piece) if joined => piece.push(to),
                    _ => pieces.push(vec![from, to]),
                }
                joined = whole;
            }
        }
    }
    pieces
}

/// The part of a segment within the clipping frame (Liang and Barsky), and whether it keeps its far end.
fn clip_segment(from: Place, to: Place, extent: Extent) -> Option<(Place, Place, bool)> {
    // Far enough out for the direction of what is seen, and finite.
    let tame = |(x, y): Place| (x.clamp(-1e9, 1e9), y.clamp(-1e9, 1e9));
    let (from, to) = (tame(from), tame(to));
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (direction, room) in [
        (-dx, from.0 + extent.width),
        (dx, 2.0 * extent.width - from.0),
        (-dy, from.1 + extent.height),
        (dy, 2.0 * extent.height - from.1),
    ] {
        if direction == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if direction < 0.0 {
            enter = enter.max(room / direction);
        } else {
            leave = leave.min(room / direction);
        }
    }
    if enter > leave {
        return None;
    }
    let at = |part: f64| (from.0 + part * dx, from.1 + part * dy);
    let start = if enter > 0.0 { at(enter) } else { from };
    let end = if leave < 1.0 { at(leave) } else { to };
    Some((start, end, leave >= 1.0))
}

/// Of consecutive points in one column: first, lowest, highest, last, in their order.
fn extremes_by_column(line: &[Place], column: f64) -> Vec<Place> {
    let mut kept = Vec::new();
    let mut rest = line;
    while let Some(first) = rest.first() {
        let cell = (first.0 / column).floor();
        let count = rest.iter().take_while(|point| (point.0 / column).floor() == cell).count();
        let (run, tail) = rest.split_at(count);
        let by_height = |&a: &usize, &b: &usize| run[a].1.total_cmp(&run[b].1);
        let mut indices =
            [0, (0..count).min_by(by_height).unwrap_or(0), (0..count).max_by(by_height).unwrap_or(0), count - 1];
        indices.sort_unstable();
        let mut last = None;
        for i in indices {
            if last != Some(i) {
                kept.push(run[i]);
            }
            last = Some(i);
        }
        rest = tail;
    }
    kept
}

/// The points that a line within `tolerance` of the given one needs (Ramer, Douglas and Peucker).
fn within_tolerance(line: &[Place], tolerance: f64) -> Vec<Place> {
    let Some(end) = line.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut keep = vec![false; line.len()];
    keep[0] = true;
    keep[end] = true;
    let mut open = vec![(0, end)];
    while let Some((from, to)) = open.pop() {
        let farthest = (from + 1..to)
            .map(|i| (i, distance_to_segment(line[i], line[from], line[to])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, distance)) = farthest
            && distance > tolerance
        {
            keep[i] = true;
            open.push((from, i));
            open.push((i, to));
        }
    }
    line.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

pub fn distance_to_segment(point: Place, from: Place, to: Place) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (px, py) = (point.0 - from.0, point.1 - from.1);
    let square = dx * dx + dy * dy;
    let part = if square > 0.0 { ((px * dx + py * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (px - part * dx).hypot(py - part * dy)
}
