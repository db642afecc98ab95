//! Integrals by Gauss's rule, and their inverses.

/// Nodes and weights of Legendre's polynomial of degree 8 on [−1, 1], those > 0.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
];

/// `∫ f` from the first of some points.
pub(super) struct Integral<F> {
    f: F,
    points: Vec<f64>,
    sums: Vec<f64>,
}

impl<F: Fn(f64) -> f64> Integral<F> {
    /// With `f` as good as a polynomial between neighbours of the rising `points`.
    pub(super) fn new(f: F, points: Vec<f64>) -> Self {
        let mut sum = 0.0;
        let parts = points.windows(2).map(|ends| {
            sum += gauss(&f, ends[0], ends[1]);
            sum
        });
        let sums = std::iter::once(0.0).chain(parts).collect();
        Integral { f, points, sums }
    }

    /// Up to `x`, which is between the first and the last point.
    pub(super) fn at(&self, x: f64) -> f64 {
        let i = self.before(&self.points, x);
        self.sums[i] + gauss(&self.f, self.points[i], x)
    }

    /// Where an `f > 0` has this integral.
    pub(super) fn inverse(&self, integral: f64) -> f64 {
        let i = self.before(&self.sums, integral);
        let (from, to) = (self.points[i], self.points[i + 1]);
        let mut off = |x: f64| self.sums[i] + gauss(&self.f, from, x) - integral;
        integrate::find_root(&mut off, from, to, 0.0).unwrap_or(f64::NAN)
    }

    fn before(&self, of: &[f64], x: f64) -> usize {
        of.partition_point(|&y| y <= x).clamp(1, self.points.len() - 1) - 1
    }
}

fn gauss(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    if from == to {
        return 0.0;
    }
    let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
    half * GAUSS.map(|[x, weight]| weight * (f(middle - half * x) + f(middle + half * x))).iter().sum::<f64>()
}

/// Distances from 0 to `far`: a quarter of `scale` apart up to 25 times it, then a tenth of themselves.
pub(super) fn distances(scale: f64, far: f64) -> Vec<f64> {
    let near = (0..100).map(|i| 0.25 * scale * f64::from(i));
    let beyond = std::iter::successors(Some(25.0 * scale), |d| Some(1.1 * d));
    near.chain(beyond).take_while(|d| *d < far).chain([far]).collect()
}
