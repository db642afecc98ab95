//! Eigenvalues of a matrix whose entries are known up to some error, block by block.

use mechanics::SingularValues;
use nalgebra::{Complex, DMatrix, DVector, Schur, linalg::balancing::balance_parlett_reinsch};

use crate::discs::Discs;

/// One eigenvalue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigenvalue {
    /// `s` of `e^(s t)`, in 1 over the unit of time.
    pub value: Complex<f64>,
    /// How far it moves where the matrix moves by its error: see [`Spectrum`].
    pub error: f64,
}

impl Eigenvalue {
    /// Whether deviations along it grow, beyond what the error leaves open.
    pub fn is_unstable(&self) -> bool {
        self.value.re > self.error
    }
}

/// Places of a matrix that depend on one another, all of them on each.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The places.
    pub places: Vec<usize>,
    /// Eigenvalues other than zero, by falling real part.
    pub eigenvalues: Vec<Eigenvalue>,
    /// How many more there are, all zero.
    pub zeros: usize,
}

/// Eigenvalues that no error tells from a multiple one on the imaginary axis, with fewer eigenvectors than
/// eigenvalues: deviations grow as powers of time, at first at least.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Their mean; its imaginary part is that of those above the real axis.
    pub value: Complex<f64>,
    /// How many there are.
    pub size: usize,
    /// They are this close to `value`.
    pub radius: f64,
    /// Deviations grow like this power of time until about 1/`radius`; 0 where none is shown, either.
    pub power: usize,
    /// Whether they are equal and do so for ever: they belong to equal blocks without an error, coupled
    /// in one direction only. Otherwise it is undecided how deviations go on.
    pub is_exact: bool,
    /// Places in [`Spectrum::blocks`].
    pub blocks: Vec<usize>,
}

/// All eigenvalues of a matrix.
///
/// Entries below their error are none. What is left falls apart into blocks that are coupled in one direction
/// only; the eigenvalues are those of the blocks. Of a block the null space is split off, again and again
/// until there is none: so zeros are counted, chains among them as well.
///
/// Errors: entries are off by what is given, by themselves where they were left out, and within a block,
/// balanced, by 4 ε of its norm. The error of an eigenvalue is the radius of a circle round it that none
/// crosses while all entries of the matrix move so far, and at least 4 ε of the largest eigenvalue. Of `k`
/// eigenvalues close to a multiple one it is the `k`-th root of that.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Blocks, by their first places.
    pub blocks: Vec<Block>,
    /// Independent eigenvectors of the eigenvalue zero; less than the zeros where deviations grow as powers
    /// of time.
    pub zero_vectors: usize,
    /// How far what is counted as zero may be from zero.
    pub zero_error: f64,
    /// What lets deviations grow as powers of time, or leaves that open.
    pub chains: Vec<Chain>,
}

/// Entries up to this part of the largest in their row or column are round-off.
const ROUND_OFF: f64 = 64.0 * f64::EPSILON;
/// Iterations of the QR algorithm for each eigenvalue.
const ITERATIONS: usize = 200;
/// Axes in which it is tried.
const TURNS: usize = 5;
/// Discs of more than this part of the fastest eigenvalue, half of the digits, decide nothing on the axis.
const WIDE: f64 = 1e-8;
/// Eigenvalues closer than so many errors are one cluster.
const CLUSTER: f64 = 4.0;

impl Spectrum {
    /// Of a square matrix, and of the same shape the errors of its entries, each ≥ 0. `None` where the QR
    /// algorithm does not converge.
    ///
    /// ```
    /// use linear::Spectrum;
    /// use nalgebra::{DMatrix, dmatrix};
    /// // a free particle, and an oscillator of 2 rad/s
    /// let matrix = dmatrix![0., 1., 0., 0.; 0., 0., 0., 0.; 0., 0., 0., 1.; 0., 0., -4., 0.];
    /// let spectrum = Spectrum::of(&matrix, &DMatrix::zeros(4, 4)).unwrap();
    /// let zeros: usize = spectrum.blocks.iter().map(|block| block.zeros).sum();
    /// assert_eq!((zeros, spectrum.zero_vectors), (2, 1));
    /// assert_eq!((spectrum.chains[0].power, spectrum.chains[0].is_exact), (1, true));
    /// assert!((spectrum.blocks[2].eigenvalues[0].value.im - 2.0).abs() < 1e-14);
    /// ```
    pub fn of(matrix: &DMatrix<f64>, noise: &DMatrix<f64>) -> Option<Spectrum> {
        let n = matrix.nrows();
        let largest = |i: usize, j: usize| matrix.row(i).amax().max(matrix.column(j).amax());
        let coupled =
            DMatrix::from_fn(n, n, |i, j| matrix[(i, j)].abs() > (8.0 * noise[(i, j)]).max(ROUND_OFF * largest(i, j)));
        let clean = DMatrix::from_fn(n, n, |i, j| if coupled[(i, j)] { matrix[(i, j)] } else { 0.0 });
        let mut error = noise + (matrix - &clean).abs();
        let part = |m: &DMatrix<f64>, places: &[usize]| {
            DMatrix::from_fn(places.len(), places.len(), |i, j| m[(places[i], places[j])])
        };
        let mut blocks = Vec::new();
        for places in components(&coupled) {
            let (values, arithmetic) = of_block(part(&clean, &places), part(noise, &places))?;
            for (i, j) in (0..places.len()).flat_map(|i| (0..places.len()).map(move |j| (i, j))) {
                error[(places[i], places[j])] += arithmetic[(i, j)];
            }
            let eigenvalues: Vec<_> = values.into_iter().map(|value| Eigenvalue { value, error: 0.0 }).collect();
            blocks.push(Block { zeros: places.len() - eigenvalues.len(), places, eigenvalues });
        }
        let all = || blocks.iter().flat_map(|block| block.eigenvalues.iter().map(|e| e.value));
        let fastest = all().fold(0.0_f64, |fastest, z| fastest.max(z.norm()));
        let least = 4.0 * f64::EPSILON * fastest;
        let zeros = std::iter::repeat_n(Complex::default(), n - all().count());
        let (balanced, error) = balanced(clean, error);
        let zero_vectors = nullity(&SingularValues::of(&balanced), allowed(&balanced, &error));
        let discs = Discs::new(&balanced, error, all().chain(zeros).collect());
        let mut zero_error = 0.0_f64;
        for block in &mut blocks {
            for e in block.eigenvalues.iter_mut().filter(|e| e.value.im >= 0.0) {
                e.error = discs.radius(e.value, least);
            }
            for i in (0..block.eigenvalues.len()).filter(|&i| block.eigenvalues[i].value.im < 0.0).collect::<Vec<_>>() {
                let other = block.eigenvalues.iter().find(|e| e.value == block.eigenvalues[i].value.conj());
                block.eigenvalues[i].error =
                    other.map_or_else(|| discs.radius(block.eigenvalues[i].value, least), |e| e.error);
            }
            // what is not above its error is zero
            let lost = block.eigenvalues.iter().filter(|e| e.value.norm() <= e.error);
            zero_error = lost.fold(zero_error, |a, e| a.max(e.value.norm() + e.error));
            block.eigenvalues.retain(|e| e.value.norm() > e.error);
            block.zeros = block.places.len() - block.eigenvalues.len();
        }
        if blocks.iter().any(|block| block.zeros > 0) {
            zero_error = discs.radius(Complex::default(), least.max(zero_error));
        }
        let mut spectrum = Spectrum { blocks, zero_vectors, zero_error, chains: Vec::new() };
        let whole = components(&matrix.zip_map(noise, |a, e| a != 0.0 || e != 0.0));
        let equal = |one: &Block, other: &Block| {
            let alone = |block: &Block| whole.contains(&block.places) && part(noise, &block.places).amax() == 0.0;
            alone(one) && alone(other) && part(matrix, &one.places) == part(matrix, &other.places)
        };
        spectrum.chains = spectrum.chains_on_the_axis(&discs, WIDE * fastest, equal);
        Some(spectrum)
    }

    /// Clusters on the imaginary axis that are not semisimple as far as errors let that be told.
    fn chains_on_the_axis(&self, discs: &Discs, wide: f64, equal: impl Fn(&Block, &Block) -> bool) -> Vec<Chain> {
        let mut left: Vec<(usize, Eigenvalue)> = Vec::new();
        for (i, block) in self.blocks.iter().enumerate() {
            let zero = Eigenvalue { value: Complex::default(), error: self.zero_error };
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
            let found = discs.restriction(value, radius, size);
            let power = found.as_ref().map_or(0, |found| found.power);
            if found.is_some() && power == 0 && radius <= wide {
                continue;
            }
            let mut blocks: Vec<usize> = cluster.iter().map(|(i, _)| *i).collect();
            blocks.sort_unstable();
            blocks.dedup();
            let is_exact = power > 0
                && blocks.len() == size
                && blocks.iter().all(|&i| equal(&self.blocks[blocks[0]], &self.blocks[i]));
            chains.push(Chain { value, size, radius, power, is_exact, blocks });
        }
        chains.sort_by(|a, b| b.value.im.total_cmp(&a.value.im));
        chains
    }
}

/// A matrix in units in which its rows are about as large as its columns, and its errors in the same.
fn balanced(mut matrix: DMatrix<f64>, noise: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let units = balance_parlett_reinsch(&mut matrix);
    let noise = in_units(noise, &units);
    (matrix, noise)
}

fn in_units(matrix: DMatrix<f64>, units: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.nrows(), |i, j| matrix[(i, j)] * units[j] / units[i])
}

/// The error of a matrix as a length: its own, and that of arithmetic.
fn allowed(matrix: &DMatrix<f64>, noise: &DMatrix<f64>) -> f64 {
    4.0 * f64::EPSILON * matrix.norm() + noise.norm()
}

/// How many singular values count as zero.
fn nullity(svd: &SingularValues, error: f64) -> usize {
    let limit = svd.values.len() as f64 * error;
    svd.values.iter().filter(|&&s| s <= limit).count()
}

/// Sets of places that reach each other, by their first ones.
fn components(coupled: &DMatrix<bool>) -> Vec<Vec<usize>> {
    let n = coupled.nrows();
    let mut reached = coupled.clone();
    for k in 0..n {
        for i in (0..n).filter(|&i| coupled[(i, k)] || reached[(i, k)]).collect::<Vec<_>>() {
            for j in 0..n {
                reached[(i, j)] |= reached[(k, j)];
            }
        }
    }
    let mut found: Vec<Vec<usize>> = Vec::new();
    for i in 0..n {
        match found.iter_mut().find(|set| reached[(i, set[0])] && reached[(set[0], i)]) {
            Some(set) => set.push(i),
            None => found.push(vec![i]),
        }
    }
    found
}

/// Eigenvalues of one block, without those of its null space, and how far off arithmetic lets its entries be.
fn of_block(block: DMatrix<f64>, noise: DMatrix<f64>) -> Option<(Vec<Complex<f64>>, DMatrix<f64>)> {
    let n = block.nrows();
    if n == 1 {
        // exact
        let value = block[(0, 0)];
        let values = (value.abs() > noise[(0, 0)]).then_some(value.into()).into_iter().collect();
        return Some((values, DMatrix::zeros(1, 1)));
    }
    let mut own = block;
    let units = balance_parlett_reinsch(&mut own);
    let error = 4.0 * f64::EPSILON * own.norm();
    let (values, left) = eigenvalues(without_null_space(own, error + in_units(noise, &units).norm()))?;
    Some((values, DMatrix::from_fn(n, n, |i, j| (error + left) * units[i] / units[j])))
}

/// By falling real part, then imaginary part: conjugates have the same real part to the last digit.
pub(crate) fn sort(eigenvalues: &mut [Eigenvalue]) {
    let order = |a: Complex<f64>, b: Complex<f64>| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im));
    eigenvalues.sort_by(|a, b| order(a.value, b.value));
}

/// `Q₁ᵀ B Q₁` with `Q₁` orthogonal to the null space of `B`, until there is none: one zero less a vector.
fn without_null_space(mut block: DMatrix<f64>, error: f64) -> DMatrix<f64> {
    loop {
        let svd = SingularValues::of(&block);
        let rank = block.nrows() - nullity(&svd, error);
        if rank == block.nrows() {
            return block;
        }
        let kept = svd.right.rows(0, rank);
        block = kept * &block * kept.transpose();
    }
}

/// Eigenvalues, and how far from the matrix that has them exactly the given one is: the QR algorithm in its own
/// axes, or, where it does not converge, in turned ones.
fn eigenvalues(matrix: DMatrix<f64>) -> Option<(Vec<Complex<f64>>, f64)> {
    let n = matrix.nrows();
    if n == 0 {
        return Some((Vec::new(), 0.0));
    }
    let mut random = Weyl::default();
    (0..TURNS).find_map(|turn| {
        let normal = DVector::from_fn(n, |_, _| if turn == 0 { 0.0 } else { random.number() });
        let turned = reflected(&reflected(&matrix, &normal).transpose(), &normal).transpose();
        let schur = Schur::try_new(turned.clone(), f64::EPSILON, ITERATIONS * n)?;
        let values = schur.complex_eigenvalues().iter().copied().collect();
        let (axes, triangle) = schur.unpack();
        Some((values, (turned - &axes * triangle * axes.transpose()).norm()))
    })
}

/// `(1 − 2 n nᵀ/|n|²) A`; `A` where `n` is zero.
fn reflected(matrix: &DMatrix<f64>, normal: &DVector<f64>) -> DMatrix<f64> {
    let square = normal.norm_squared();
    if square == 0.0 { matrix.clone() } else { matrix - normal * (normal.transpose() * matrix) * (2.0 / square) }
}

/// Numbers without a pattern, the same in every run: Weyl's sequence.
#[derive(Default)]
pub(crate) struct Weyl(f64);

impl Weyl {
    /// Within −1 … 1.
    pub(crate) fn number(&mut self) -> f64 {
        self.0 = (self.0 + 0.618_033_988_749_894_9).fract();
        2.0 * (1e4 * (1.0 + self.0).ln()).fract() - 1.0
    }
}
