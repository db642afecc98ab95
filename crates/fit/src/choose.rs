//! The search for the best film.

use std::sync::{Mutex, PoisonError};

use motion::over_threads;
use motion::shooting::spread;
use schemars::JsonSchema;
use serde::Serialize;

use crate::{Design, EXCLUDED, FitError, Point};

/// Points of the scan from which the search goes on.
const FOLLOWED: usize = 3;
/// The first step along an axis, and the last one, as parts of the way between the bounds.
const FIRST_STEP: f64 = 0.25;
const LAST_STEP: f64 = 1.0 / 64.0;

/// Result of a search for the best film.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Best {
    /// Films of the scene's own numbers, which may lie outside the bounds.
    #[serde(serialize_with = "crate::json::found")]
    #[schemars(with = "Option<Point>")]
    pub own: Result<Point, FitError>,
    /// The best one, verified from twice as many starts.
    pub best: Point,
    /// Other ends of the search, the best first; by fewer starts.
    pub others: Vec<Point>,
    /// The length of the shortest film of the best motion that excludes the other formulation, if the whole
    /// film does.
    pub shortest: Option<f64>,
    /// Number of points that were tried.
    pub tried: usize,
    /// Number of these without a motion through the whole film; they are ignored.
    pub without_motion: usize,
}

impl Design {
    /// The best films that were found, from a scan of `points` beside the corners; the scene's own where
    /// nothing can be chosen: without points as [`Design::point`] has it. Over this many threads (0: as many
    /// as there are processors), on which no result depends.
    ///
    /// # Errors
    /// The first reason where no point has motions.
    pub fn best(&self, points: usize, threads: usize) -> Result<Best, FitError> {
        let mut seen = Seen { design: self, threads, points: Vec::new(), without_motion: 0, reason: None };
        let at: Vec<f64> = self.chosen().iter().map(|chosen| chosen.own).collect();
        if at.is_empty() {
            let best = if points == 0 { self.point(&at)? } else { self.point_again(&at)? };
            let shortest = if points == 0 { None } else { self.shortest_where_it_tells(&best) };
            let own = Ok(best.clone());
            return Ok(Best { own, best, others: Vec::new(), shortest, tried: 1, without_motion: 0 });
        }
        let own = self.point(&at);
        let width = self.chosen().len();
        let corners = if width < 8 && 1 << width <= points { 1 << width } else { 0 };
        let corner = |number: usize| (0..width).map(|i| f64::from(number >> i & 1 == 1)).collect::<Vec<_>>();
        let mut scan: Vec<Vec<f64>> = (0..corners).map(corner).collect();
        let inside = |number| spread(number, width).into_iter().map(|x| 0.5 * (1.0 + x)).collect();
        scan.extend((0..points).map(inside));
        seen.look_at(scan);
        let mut starts: Vec<usize> = (0..seen.points.len()).collect();
        starts.sort_by(|a, b| seen.order(*a, *b));
        let mut ends: Vec<usize> = Vec::new();
        for start in starts.into_iter().take(FOLLOWED) {
            let end = seen.follow(start);
            if !ends.contains(&end) {
                ends.push(end);
            }
        }
        ends.sort_by(|a, b| seen.order(*a, *b));
        let (tried, without_motion) = (seen.points.len() + seen.without_motion, seen.without_motion);
        let mut found: Vec<Point> = ends.into_iter().map(|end| seen.points[end].1.clone()).collect();
        let Some(first) = found.first() else {
            return Err(seen.reason.unwrap_or(FitError::NoUnknown));
        };
        // a value that more starts make worse was none
        let mut best = self.point_again(&first.at)?;
        for other in found.iter_mut().skip(1) {
            if self.is_better(other, &best) {
                let again = self.point_again(&other.at)?;
                if self.is_better(&again, &best) {
                    *other = std::mem::replace(&mut best, again);
                } else {
                    *other = again;
                }
            }
        }
        let others = found.into_iter().skip(1).collect();
        let shortest = self.shortest_where_it_tells(&best);
        Ok(Best { own, best, others, shortest, tried, without_motion })
    }

    fn shortest_where_it_tells(&self, best: &Point) -> Option<f64> {
        if best.value >= EXCLUDED { self.shortest(&best.at).map(|(length, _)| length) } else { None }
    }
}

/// Points that were looked at, in parts of the way between the bounds.
struct Seen<'a> {
    design: &'a Design,
    threads: usize,
    points: Vec<(Vec<f64>, Point)>,
    without_motion: usize,
    reason: Option<FitError>,
}

impl Seen<'_> {
    /// Adds those of these points that are new and have a motion.
    fn look_at(&mut self, parts: Vec<Vec<f64>>) {
        let new: Vec<Vec<f64>> =
            parts.into_iter().filter(|part| self.points.iter().all(|(known, _)| known != part)).collect();
        let ends: Vec<[f64; 2]> = self.design.chosen().iter().map(|chosen| chosen.ends).collect();
        let number = |(part, [low, high]): (&f64, &[f64; 2])| low + part * (high - low);
        // a scene is no one's at the same time
        let design = Mutex::new(self.design.clone());
        let found = over_threads(self.threads, new.len(), |i| {
            let own = design.lock().unwrap_or_else(PoisonError::into_inner).clone();
            own.point(&new[i].iter().zip(&ends).map(number).collect::<Vec<_>>())
        });
        for (part, found) in new.into_iter().zip(found) {
            match found {
                Ok(point) => self.points.push((part, point)),
                Err(reason) => {
                    self.without_motion += 1;
                    self.reason.get_or_insert(reason);
                }
            }
        }
    }

    /// The better one first.
    fn order(&self, a: usize, b: usize) -> std::cmp::Ordering {
        let [a, b] = [a, b].map(|i| &self.points[i].1);
        if self.design.is_better(a, b) {
            std::cmp::Ordering::Less
        } else if self.design.is_better(b, a) {
            std::cmp::Ordering::Greater
        } else {
            std::cmp::Ordering::Equal
        }
    }

    /// Along the axes to better points, until none is better at the shortest step.
    fn follow(&mut self, start: usize) -> usize {
        let (mut at, mut step) = (start, FIRST_STEP);
        while step >= LAST_STEP {
            let here = self.points[at].0.clone();
            let mut around = Vec::new();
            for i in 0..here.len() {
                for side in [-step, step] {
                    let mut part = here.clone();
                    part[i] = (part[i] + side).clamp(0.0, 1.0);
                    around.push(part);
                }
            }
            self.look_at(around.clone());
            let near = (0..self.points.len()).filter(|&i| around.contains(&self.points[i].0));
            match near.min_by(|a, b| self.order(*a, *b)).filter(|&i| self.order(i, at).is_lt()) {
                Some(better) => at = better,
                None => step *= 0.5,
            }
        }
        at
    }
}
