//! Eigenvalues of a matrix whose entries are known up to some error, block by block.

use mechanics::SingularValues;
use nalgebra::{Complex, DMatrix, Schur, linalg::balancing::balance_parlett_reinsch};

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

/// All eigenvalues of a matrix.
///
/// Entries below their error are none. What is left falls apart into blocks that are coupled in one direction
/// only; the eigenvalues are those of the blocks. Of a block the null space is split off, again and again
/// until there is none: so zeros are counted and not computed, chains among them as well.
///
/// Errors: the balanced block is moved four times, in random directions, by its own error and 4 ε of its norm
/// an entry; the largest change of an eigenvalue is its error, and at least 4 ε of the largest eigenvalue. A
/// double eigenvalue that splits says so.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Blocks, by their first places.
    pub blocks: Vec<Block>,
    /// Independent eigenvectors of the eigenvalue zero; less than the zeros where deviations grow as powers
    /// of time.
    pub zero_vectors: usize,
}

/// Entries up to this part of the largest in their row or column are round-off.
const ROUND_OFF: f64 = 64.0 * f64::EPSILON;
/// How often a block is moved.
const MOVES: usize = 4;
/// Iterations of the QR algorithm for each eigenvalue.
const ITERATIONS: usize = 1000;

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
    /// assert!((spectrum.blocks[2].eigenvalues[0].value.im - 2.0).abs() < 1e-14);
    /// ```
    pub fn of(matrix: &DMatrix<f64>, noise: &DMatrix<f64>) -> Option<Spectrum> {
        let n = matrix.nrows();
        let largest = |i: usize, j: usize| matrix.row(i).amax().max(matrix.column(j).amax());
        let coupled =
            DMatrix::from_fn(n, n, |i, j| matrix[(i, j)].abs() > (8.0 * noise[(i, j)]).max(ROUND_OFF * largest(i, j)));
        let clean = DMatrix::from_fn(n, n, |i, j| if coupled[(i, j)] { matrix[(i, j)] } else { 0.0 });
        let part = |m: &DMatrix<f64>, places: &[usize]| {
            DMatrix::from_fn(places.len(), places.len(), |i, j| m[(places[i], places[j])])
        };
        let blocks = components(&coupled).into_iter().map(|places| {
            let eigenvalues = of_block(part(&clean, &places), part(noise, &places))?;
            Some(Block { zeros: places.len() - eigenvalues.len(), places, eigenvalues })
        });
        let mut blocks = blocks.collect::<Option<Vec<Block>>>()?;
        let all = blocks.iter().flat_map(|block| &block.eigenvalues);
        let fastest = all.fold(0.0_f64, |fastest, e| fastest.max(e.value.norm()));
        blocks.iter_mut().for_each(|block| block.resolve(4.0 * f64::EPSILON * fastest));
        let (balanced, noise) = balanced(clean, noise.clone());
        let zero_vectors = nullity(&SingularValues::of(&balanced), allowed(&balanced, &noise));
        Some(Spectrum { blocks, zero_vectors })
    }
}

impl Block {
    /// No error is below this one; what is not above its error is zero.
    fn resolve(&mut self, least: f64) {
        self.eigenvalues.iter_mut().for_each(|e| e.error = e.error.max(least));
        self.eigenvalues.retain(|e| e.value.norm() > e.error);
        self.zeros = self.places.len() - self.eigenvalues.len();
    }
}

/// A matrix in units in which its rows are about as large as its columns, and its errors in the same.
fn balanced(mut matrix: DMatrix<f64>, noise: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let units = balance_parlett_reinsch(&mut matrix);
    let noise = DMatrix::from_fn(noise.nrows(), noise.ncols(), |i, j| noise[(i, j)] * units[j] / units[i]);
    (matrix, noise)
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

/// Eigenvalues of one block, without those of its null space.
fn of_block(block: DMatrix<f64>, noise: DMatrix<f64>) -> Option<Vec<Eigenvalue>> {
    let (block, noise) = balanced(block, noise);
    let error = allowed(&block, &noise);
    let core = without_null_space(block, error);
    let values = eigenvalues(core.clone())?;
    let mut found: Vec<Eigenvalue> = values.iter().map(|&value| Eigenvalue { value, error: 0.0 }).collect();
    let mut random = Weyl::default();
    for _ in 0..MOVES {
        let mut moved = eigenvalues(core.map(|x| x + error * random.sign()))?;
        for eigenvalue in &mut found {
            let away = |z: &Complex<f64>| (z - eigenvalue.value).norm();
            let nearest = (0..moved.len()).min_by(|&a, &b| away(&moved[a]).total_cmp(&away(&moved[b])))?;
            eigenvalue.error = eigenvalue.error.max(away(&moved[nearest]));
            moved.swap_remove(nearest);
        }
    }
    sort(&mut found);
    Some(found)
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

fn eigenvalues(matrix: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let n = matrix.nrows();
    if n == 0 {
        return Some(Vec::new());
    }
    let schur = Schur::try_new(matrix, f64::EPSILON, ITERATIONS * n)?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
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

    fn sign(&mut self) -> f64 {
        self.number().signum()
    }
}
