//! Eigenvalues of a matrix with errors of its entries, block by block.

use mechanics::SingularValues;
use nalgebra::DMatrix;
use num_complex::Complex;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use symbolic::limits::HALF_THE_DIGITS;

use crate::core::{Core, allowed, nullity, structural_rank};
use crate::discs::Discs;
use crate::matrix::{balanced, part};

/// A complex number as JSON has it.
#[derive(Serialize, JsonSchema)]
struct Parts {
    real: f64,
    imaginary: f64,
}

fn parts<S: Serializer>(value: &Complex<f64>, to: S) -> Result<S::Ok, S::Error> {
    Parts { real: value.re, imaginary: value.im }.serialize(to)
}

/// One eigenvalue.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Eigenvalue {
    /// `s` of `e^(s t)`, in 1 over the unit of time.
    #[serde(flatten, serialize_with = "parts")]
    #[schemars(with = "Parts")]
    pub value: Complex<f64>,
    /// Change of the eigenvalue when the matrix changes by its error: see [`Spectrum`].
    pub error: f64,
}

impl Eigenvalue {
    /// Whether deviations along it grow, beyond what the error leaves open.
    pub fn is_unstable(&self) -> bool {
        self.value.re > self.error
    }
}

/// A strongly connected set of places of a matrix: each depends on every other.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The places.
    pub places: Vec<usize>,
    /// Eigenvalues other than zero, by falling real part.
    pub eigenvalues: Vec<Eigenvalue>,
    /// Number of zero eigenvalues.
    pub zeros: usize,
    /// Error of these zeros.
    pub zero_error: f64,
}

/// Eigenvalues that equal, within errors, a multiple one on the imaginary axis with too few eigenvectors:
/// deviations grow as powers of time, at least at first.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Chain {
    /// Their mean; its imaginary part is that of those above the real axis.
    #[serde(flatten, serialize_with = "parts")]
    #[schemars(with = "Parts")]
    pub value: Complex<f64>,
    /// How many there are.
    pub size: usize,
    /// They are this close to `value`.
    pub radius: f64,
    /// Deviations grow like this power of time until about 1/`radius`; 0 where none is shown, either.
    pub power: usize,
    /// Whether they are equal and do so for ever: they are exact zeros, or belong to equal blocks without an
    /// error, coupled in one direction only. Otherwise it is undecided how deviations go on.
    #[serde(rename = "exact")]
    pub is_exact: bool,
    /// Places in [`Spectrum::blocks`].
    #[serde(skip)]
    pub blocks: Vec<usize>,
}

/// All eigenvalues of a matrix.
///
/// Entries below their error count as zero. The rest splits into blocks that are coupled in one direction
/// only; the eigenvalues are those of the blocks. The null space of a block is split off repeatedly until
/// none is left: this counts zeros, including chains of them.
///
/// Errors: the error of an entry is the given one, its own value if it was left out, and within a balanced
/// block also ε of its norm and the residual of the QR algorithm. The error of an eigenvalue is the radius of
/// a circle round it that no eigenvalue crosses while all entries change by up to their errors, and at least
/// 4 ε of the largest eigenvalue. For `k` eigenvalues close to a multiple one it is about the `k`-th root of
/// the error of the matrix. Only structural zeros, which every matrix with the same pattern of entries has,
/// are exact.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Spectrum {
    /// Blocks, by their first places.
    #[serde(skip)]
    pub blocks: Vec<Block>,
    /// Independent eigenvectors of the eigenvalue zero; less than the zeros where deviations grow as powers
    /// of time.
    pub zero_vectors: usize,
    /// Groups of eigenvalues for which deviations grow as powers of time, or may do so.
    #[serde(skip)]
    pub chains: Vec<Chain>,
}

/// Eigenvalues closer than this number of errors are one cluster.
const CLUSTER: f64 = 4.0;

impl Spectrum {
    /// Of a square matrix, and of the same shape the errors of its entries, each ≥ 0. `None` where the QR
    /// algorithm does not converge.
    ///
    /// ```
    /// use linear::Spectrum;
    /// use nalgebra::DMatrix;
    /// // a free particle, and an oscillator of 2 rad/s
    /// let matrix = [0., 1., 0., 0., 0., 0., 0., 0., 0., 0., 0., 1., 0., 0., -4., 0.];
    /// let matrix = DMatrix::from_row_slice(4, 4, &matrix);
    /// let spectrum = Spectrum::of(&matrix, &DMatrix::zeros(4, 4)).unwrap();
    /// let zeros: usize = spectrum.blocks.iter().map(|block| block.zeros).sum();
    /// assert_eq!((zeros, spectrum.zero_vectors), (2, 1));
    /// assert_eq!((spectrum.chains[0].power, spectrum.chains[0].is_exact), (1, true));
    /// assert!((spectrum.blocks[2].eigenvalues[0].value.im - 2.0).abs() < 1e-14);
    /// ```
    pub fn of(matrix: &DMatrix<f64>, noise: &DMatrix<f64>) -> Option<Spectrum> {
        let n = matrix.nrows();
        let coupled = coupled(matrix, noise);
        let clean = DMatrix::from_fn(n, n, |i, j| if coupled[(i, j)] { matrix[(i, j)] } else { 0.0 });
        let mut error = noise + (matrix - &clean).abs();
        let given = matrix.zip_map(noise, |a, e| a != 0.0 || e != 0.0);
        let whole = components(&reached(&given));
        let reached = reached(&coupled);
        let sets = components(&reached);
        let (mut blocks, mut own) = (Vec::new(), Vec::new());
        for places in sets.iter().cloned() {
            let core = Core::of(part(&clean, &places), part(noise, &places))?;
            for (i, j) in (0..places.len()).flat_map(|i| (0..places.len()).map(move |j| (i, j))) {
                error[(places[i], places[j])] += core.arithmetic[(i, j)];
            }
            let rank = structural_rank(&part(&given, &places));
            // zeros that all matrices with these entries have, and nothing from outside
            let is_sure = rank == core.values.len() && whole.contains(&places);
            let eigenvalues: Vec<_> = core.values.iter().map(|&value| Eigenvalue { value, error: 0.0 }).collect();
            blocks.push(Block { zeros: places.len() - eigenvalues.len(), places, eigenvalues, zero_error: 0.0 });
            own.push(is_sure.then(|| core.discs()));
        }
        let all = || blocks.iter().flat_map(|block| block.eigenvalues.iter().map(|e| e.value));
        let fastest = all().fold(0.0_f64, |fastest, z| fastest.max(z.norm()));
        let zeros = std::iter::repeat_n(Complex::default(), n - all().count());
        let (balanced, error, _) = balanced(clean, error);
        let (zero_vectors, size) =
            (nullity(&SingularValues::of(&balanced), allowed(&balanced, &error)), balanced.norm());
        let mut order = sets;
        order.sort_by_key(|set| (0..n).filter(|&j| j == set[0] || reached[(set[0], j)]).count());
        let discs = Discs::new(&balanced, error, all().chain(zeros).collect(), order);
        for (block, own) in blocks.iter_mut().zip(&own) {
            block.enclose(own.as_ref(), &discs, 4.0 * f64::EPSILON * fastest);
        }
        let mut spectrum = Spectrum { blocks, zero_vectors, chains: Vec::new() };
        let equal = |one: &Block, other: &Block| {
            let alone = |block: &Block| whole.contains(&block.places) && part(noise, &block.places).amax() == 0.0;
            alone(one) && alone(other) && part(matrix, &one.places) == part(matrix, &other.places)
        };
        spectrum.chains = spectrum.chains_on_the_axis(&discs, HALF_THE_DIGITS * size, equal);
        Some(spectrum)
    }

    /// Clusters on the imaginary axis that are not semisimple, as far as errors decide it.
    fn chains_on_the_axis(&self, discs: &Discs, wide: f64, equal: impl Fn(&Block, &Block) -> bool) -> Vec<Chain> {
        let mut left: Vec<(usize, Eigenvalue)> = Vec::new();
        for (i, block) in self.blocks.iter().enumerate() {
            let zero = Eigenvalue { value: Complex::default(), error: block.zero_error };
            let zeros = std::iter::repeat_n(zero, block.zeros);
            left.extend(block.eigenvalues.iter().copied().chain(zeros).map(|e| (i, e)));
        }
        let mut chains = Vec::new();
        while let Some(first) = left.pop() {
            let mut cluster = vec![first];
            let close = |a: &Eigenvalue, b: &Eigenvalue| (a.value - b.value).norm() <= CLUSTER * a.error.max(b.error);
            while let Some(next) = left.iter().position(|(_, e)| cluster.iter().any(|(_, other)| close(e, other))) {
                cluster.push(left.swap_remove(next));
            }
            let size = cluster.len();
            let value = cluster.iter().map(|(_, e)| e.value).sum::<Complex<f64>>() / size as f64;
            let radius = cluster.iter().fold(0.0_f64, |a, (_, e)| a.max((e.value - value).norm() + e.error));
            // of conjugates one is enough
            if cluster.iter().all(|(_, e)| e.value.re.abs() > e.error) || value.im < -radius {
                continue;
            }
            let found = discs.power(value, radius, size);
            let power = found.unwrap_or(0);
            if power == 0 && (radius == 0.0 || found.is_some() && radius <= wide) {
                continue;
            }
            let mut blocks: Vec<usize> = cluster.iter().map(|(i, _)| *i).collect();
            blocks.sort_unstable();
            blocks.dedup();
            let same = |i: &usize| equal(&self.blocks[blocks[0]], &self.blocks[*i]);
            let is_exact = power > 0 && (radius == 0.0 || blocks.len() == size && blocks.iter().all(same));
            chains.push(Chain { value, size, radius, power, is_exact, blocks });
        }
        chains.sort_by(|a, b| b.value.im.total_cmp(&a.value.im));
        chains
    }
}

impl Block {
    /// Finds the errors; no error is below `least`, and what is not above its error is zero. `own` are the
    /// discs of this block, where it has just these zeros.
    fn enclose(&mut self, own: Option<&Discs>, all: &Discs, least: f64) {
        let discs = own.unwrap_or(all);
        let of = |value: Complex<f64>| discs.radius(Complex::new(value.re, value.im.abs()), least);
        sort(&mut self.eigenvalues);
        let mut last = (Complex::default(), f64::NAN);
        for e in &mut self.eigenvalues {
            // conjugates stand side by side
            e.error = if last.0 == e.value.conj() { last.1 } else { of(e.value) };
            last = (e.value, e.error);
        }
        let lost = self.eigenvalues.iter().filter(|e| e.value.norm() <= e.error);
        let lost = lost.map(|e| e.value.norm() + e.error).reduce(f64::max);
        self.eigenvalues.retain(|e| e.value.norm() > e.error);
        self.zeros = self.places.len() - self.eigenvalues.len();
        self.zero_error = match (lost, own) {
            (None, Some(_)) => 0.0,
            (None, None) if self.zeros == 0 => 0.0,
            (lost, _) => all.radius(Complex::default(), lost.unwrap_or(least)),
        };
    }
}

/// Which places a place depends on, beyond errors.
pub(crate) fn coupled(matrix: &DMatrix<f64>, noise: &DMatrix<f64>) -> DMatrix<bool> {
    matrix.zip_map(noise, |entry, noise| entry.abs() > 8.0 * noise)
}

/// Which places a place depends on, by way of others as well.
pub(crate) fn reached(coupled: &DMatrix<bool>) -> DMatrix<bool> {
    let n = coupled.nrows();
    let mut reached = coupled.clone();
    for k in 0..n {
        for i in (0..n).filter(|&i| coupled[(i, k)] || reached[(i, k)]).collect::<Vec<_>>() {
            for j in 0..n {
                reached[(i, j)] |= reached[(k, j)];
            }
        }
    }
    reached
}

/// Sets of places that reach each other, by their first ones.
pub(crate) fn components(reached: &DMatrix<bool>) -> Vec<Vec<usize>> {
    let mut found: Vec<Vec<usize>> = Vec::new();
    for i in 0..reached.nrows() {
        match found.iter_mut().find(|set| reached[(i, set[0])] && reached[(set[0], i)]) {
            Some(set) => set.push(i),
            None => found.push(vec![i]),
        }
    }
    found
}

/// By falling real part, then imaginary part: conjugates have the same real part to the last digit.
pub(crate) fn sort(eigenvalues: &mut [Eigenvalue]) {
    let order = |a: Complex<f64>, b: Complex<f64>| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im));
    eigenvalues.sort_by(|a, b| order(a.value, b.value));
}
