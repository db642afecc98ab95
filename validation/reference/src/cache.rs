//! A reference as text, for what is measured more often than its equations change.

use std::fmt::Write;

use equations::Equations;
use symbolic::{Expr, Graph, Scalar};

use crate::{DoubleDouble, Entry, Question, Reference};

/// Where a motion is at some times, without how that was found: what errors are taken against.
#[derive(Clone, Debug, PartialEq)]
pub struct CachedReference {
    /// Largest of [`Reference::errors`].
    pub error: f64,
    places: Vec<Place>,
}

/// At one time: `q`, and the kinetic metric there, row-major.
#[derive(Clone, Debug, PartialEq)]
struct Place {
    coordinates: Vec<DoubleDouble>,
    metric: Vec<f64>,
}

impl From<&Reference> for CachedReference {
    fn from(found: &Reference) -> CachedReference {
        let places = found.points.iter().zip(&found.metric);
        let place = |(point, metric): (&crate::Point<DoubleDouble>, &Vec<f64>)| Place {
            coordinates: point.coordinates.clone(),
            metric: metric.clone(),
        };
        CachedReference { error: found.error(), places: places.map(place).collect() }
    }
}

impl CachedReference {
    /// Number of times.
    pub fn times(&self) -> usize {
        self.places.len()
    }

    /// Number of coordinates.
    pub fn dimension(&self) -> usize {
        self.places.first().map_or(0, |place| place.coordinates.len())
    }

    /// As [`Reference::distance`].
    ///
    /// # Panics
    /// If there is no such time, or `q` has another length than the coordinates.
    pub fn distance(&self, i: usize, q: &[f64]) -> f64 {
        let Place { coordinates, metric } = &self.places[i];
        assert_eq!(q.len(), coordinates.len(), "coordinates");
        let difference: Vec<f64> =
            q.iter().zip(coordinates).map(|(&x, &r)| (DoubleDouble::from_f64(x) - r).to_f64()).collect();
        crate::metric::length(metric, &difference)
    }

    /// Largest distance from another one at the same times.
    ///
    /// # Panics
    /// If they have other times or coordinates.
    pub fn gap(&self, other: &CachedReference) -> f64 {
        assert_eq!(self.times(), other.times(), "times");
        let apart = |(here, there): (&Place, &Place)| {
            assert_eq!(here.coordinates.len(), there.coordinates.len(), "coordinates");
            let pairs = here.coordinates.iter().zip(&there.coordinates);
            let difference: Vec<f64> = pairs.map(|(&a, &b)| (a - b).to_f64()).collect();
            crate::metric::length(&here.metric, &difference)
        };
        self.places.iter().zip(&other.places).map(apart).fold(0.0, f64::max)
    }

    /// A line with the error, and one for each time: both parts of each coordinate, then the metric. All
    /// digits: [`CachedReference::read`] has the same numbers.
    pub fn text(&self) -> String {
        let mut text = format!("{:?}\n", self.error);
        for Place { coordinates, metric } in &self.places {
            let parts = coordinates.iter().map(|x| x.parts()).flat_map(|(high, low)| [high, low]);
            let numbers: Vec<String> = parts.chain(metric.iter().copied()).map(short).collect();
            let _ = writeln!(text, "{}", numbers.join(" "));
        }
        text
    }

    /// What [`CachedReference::text`] wrote of a motion of `dimension` coordinates; `None` if it did not.
    pub fn read(text: &str, dimension: usize) -> Option<CachedReference> {
        let mut lines = text.lines();
        let error = lines.next()?.parse().ok()?;
        let place = |line: &str| {
            let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().ok()).collect::<Option<_>>()?;
            let (coordinates, metric) = numbers.split_at_checked(2 * dimension)?;
            (metric.len() == dimension * dimension).then(|| Place {
                coordinates: coordinates.chunks_exact(2).map(|x| DoubleDouble::sum(x[0], x[1])).collect(),
                metric: metric.to_vec(),
            })
        };
        Some(CachedReference { error, places: lines.map(place).collect::<Option<_>>()? })
    }
}

/// The shortest text that is read back as this number.
fn short(x: f64) -> String {
    let (plain, power) = (format!("{x}"), format!("{x:e}"));
    if plain.len() <= power.len() { plain } else { power }
}

impl Question<'_> {
    /// Two digests (FNV-1a): of the system and the equations of motion, as they are printed; and of the
    /// numbers that the motion starts from, its constants, times and the accuracy asked for, bit by bit.
    ///
    /// Who has kept a reference asks for it again by both. Formulas are the same on every machine, the last
    /// bits of a start need not be.
    pub fn digests(&self, times: &[f64], accuracy: f64) -> [u64; 2] {
        let Question { system, start, equations, constants } = *self;
        let mut formulas = Digest::new();
        formulas.expressions(&system.graph, [&[system.lagrangian], &system.constraints[..]].concat());
        formulas.equations(equations);
        let mut numbers = Digest::new();
        let all = [&[start.t], &start.q[..], &start.v, constants, times, &[accuracy]];
        for list in all {
            numbers.add(&list.len().to_le_bytes());
            list.iter().for_each(|x| numbers.add(&x.to_bits().to_le_bytes()));
        }
        [formulas.0, numbers.0]
    }
}

/// A digest of a text (FNV-1a, 64 bits).
pub fn digest(text: &str) -> u64 {
    let mut digest = Digest::new();
    digest.add(text.as_bytes());
    digest.0
}

struct Digest(u64);

impl Digest {
    fn new() -> Digest {
        Digest(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn words(&mut self, words: &str) {
        self.add(words.as_bytes());
        self.add(&[0]);
    }

    /// What they share by name first, so that none is long.
    fn expressions(&mut self, g: &Graph, list: Vec<Expr>) {
        let g = g.clone();
        let (shared, rest) = g.abbreviate(&list, "shared_");
        for (symbol, e) in shared {
            self.words(&g.name(symbol));
            self.words(&g.plain(e));
        }
        rest.into_iter().for_each(|e| self.words(&g.plain(e)));
        self.add(&[1]);
    }

    fn equations(&mut self, equations: &Equations) {
        let g = &equations.graph;
        self.words(equations.formulation);
        let mut known: Vec<(String, f64)> = equations.parameters.iter().map(|(&s, &x)| (g.name(s), x)).collect();
        known.sort_by(|a, b| a.0.cmp(&b.0));
        for (name, value) in known {
            self.words(&name);
            self.add(&value.to_bits().to_le_bytes());
        }
        let constants = equations.constant_symbols();
        let names = equations.state_symbols().into_iter().chain(equations.unknowns()).chain(constants);
        names.for_each(|symbol| self.words(&g.name(symbol)));
        let states = equations.states.iter().flat_map(|y| [y.rate, y.start]);
        let blocks = equations.blocks.iter().flat_map(|block| block.residuals.iter().chain(&block.guess).copied());
        let definitions = equations.definitions.iter().flat_map(|(s, e)| [g.variable(*s), *e]);
        let read_off = equations.coordinates.iter().chain(&equations.velocities).copied();
        self.expressions(g, states.chain(blocks).chain(definitions).chain(read_off).collect());
    }
}
