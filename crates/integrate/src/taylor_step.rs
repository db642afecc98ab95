//! Order and step of a Taylor series, and whether to trust it: for one motion or several, one per lane.

/// Tolerances below are for the order as this one.
const TIGHTEST: f64 = 1e-18;
const LEAST_ORDER: f64 = 4.0;
/// The last term, in tolerances: e⁻².
const LAST: f64 = 0.135;
/// Allowed factor by which a term before the last two exceeds geometric decay.
const SLACK: f64 = 1e3;
/// Allowed difference between the polynomial's slope, times the step, and the rates, in tolerances; at the
/// end of a step also this many times the move of the projection, which itself may be this many tolerances.
/// A relative tolerance below round-off counts as round-off.
pub(crate) const DEFECT: f64 = 100.0;
pub(crate) const LEAST_RELATIVE: f64 = 1e-14;
/// A step that is this many times shorter than its terms allow is checked at many places inside, as these do
/// not tell how much happens in it: at multiples of the golden section of it, modulo 1.
pub(crate) const MANY: usize = 16;
pub(crate) const UNLIMITED: f64 = 100.0;

/// The order for a relative tolerance: one more per factor e.
pub(crate) fn order(relative_tolerance: f64) -> usize {
    (1.0 - relative_tolerance.max(TIGHTEST).ln()).ceil().max(LEAST_ORDER) as usize
}

/// The longest step, in the unit of the coefficients (component after component), whose last terms are below
/// the tolerance; infinite for a constant. `sizes` is room for each order's largest one, in tolerances.
#[inline(always)]
pub(crate) fn longest_step<const N: usize>(
    coefficients: &[[f64; N]],
    absolute_tolerances: &[[f64; N]],
    relative_tolerance: f64,
    sizes: &mut [[f64; N]],
) -> [f64; N] {
    sizes.fill([0.0; N]);
    for (row, absolute) in coefficients.chunks_exact(sizes.len()).zip(absolute_tolerances) {
        let scale: [f64; N] = each(|l| 1.0 / (absolute[l] + relative_tolerance * row[0][l].abs()));
        // a vector holds lanes: in pairs, orders are not gathered into one
        let part = if N == 1 { sizes.len() } else { 2 };
        for (sizes, row) in sizes.chunks_mut(part).zip(row.chunks(part)) {
            for (size, c) in sizes.iter_mut().zip(row) {
                for l in 0..N {
                    let scaled = c[l].abs() * scale[l];
                    size[l] = if scaled > size[l] { scaled } else { size[l] };
                }
            }
        }
    }
    let p = sizes.len() - 1;
    let fall = (-1.0_f64).exp();
    let root = |size: f64, k: usize| (-size.ln() / k as f64).exp();
    let shorter = (-0.7 / (p - 1) as f64).exp();
    let last = |l: usize| root(sizes[p][l] / LAST, p).min(root(sizes[p - 1][l] * fall / LAST, p - 1));
    let mut theta: [f64; N] = each(|l| last(l) * shorter);
    // Terms may be so large: size · (theta/fall)^k ≤ bound. It is rare that one is over.
    let bound = SLACK * LAST / fall.powi(p as i32);
    if !any_over(&sizes[1..p - 1], each(|l| theta[l] / fall), bound) {
        return theta;
    }
    let mut allowed = bound * fall;
    let mut power = theta;
    for (k, size) in sizes.iter().enumerate().take(p - 1).skip(1) {
        for l in 0..N {
            if size[l] * power[l] > allowed {
                theta[l] = root(size[l] / allowed, k);
                power[l] = theta[l].powi(k as i32);
            }
            power[l] *= theta[l];
        }
        allowed *= fall;
    }
    theta
}

/// A number for every lane, by a loop: closures of the library's array functions are not always inlined, and
/// then take no vector instructions.
#[inline(always)]
pub(crate) fn each<T: Copy + Default, const N: usize>(of_lane: impl Fn(usize) -> T) -> [T; N] {
    let mut all = [T::default(); N];
    for (l, x) in all.iter_mut().enumerate() {
        *x = of_lane(l);
    }
    all
}

/// Number of independent products at a time.
pub(crate) const GROUP: usize = 8;

/// The first powers `x⁰ … x⁷`, and `x⁸`.
#[inline(always)]
pub(crate) fn first_powers<const N: usize>(x: [f64; N]) -> ([[f64; N]; GROUP], [f64; N]) {
    let times = |a: [f64; N], b: [f64; N]| -> [f64; N] { each(|l| a[l] * b[l]) };
    let (x2, one) = (times(x, x), [1.0; N]);
    let (x3, x4) = (times(x2, x), times(x2, x2));
    ([one, x, x2, x3, x4, times(x4, x), times(x4, x2), times(x4, x3)], times(x4, x4))
}

/// Whether `sizes[i] x^(i+1)` is over the bound for any `i`, in any lane.
#[inline(always)]
fn any_over<const N: usize>(sizes: &[[f64; N]], x: [f64; N], bound: f64) -> bool {
    let (powers, step) = first_powers(x);
    let (mut scale, mut over) = (x, false);
    let mut look = |group: &[[f64; N]], scale: &[f64; N]| {
        for (size, power) in group.iter().zip(&powers) {
            for l in 0..N {
                over |= size[l] * (power[l] * scale[l]) > bound;
            }
        }
    };
    let (groups, rest) = sizes.as_chunks::<GROUP>();
    for group in groups {
        look(group, &scale);
        scale = each(|l| scale[l] * step[l]);
    }
    look(rest, &scale);
    over
}

/// The end of a step, component after component.
pub(crate) struct Ends<'a, const N: usize> {
    /// The end of the polynomial, the same after projection, and the polynomial's slope times the step.
    pub(crate) reached: &'a [[f64; N]],
    pub(crate) candidate: &'a [[f64; N]],
    pub(crate) slope: &'a [[f64; N]],
    /// The coefficients there, and the step over their unit.
    pub(crate) next_coefficients: &'a [[f64; N]],
    pub(crate) share: [f64; N],
}

/// Largest difference of slope and rates, with its component, and largest projection, over what is allowed.
pub(crate) struct Defect<const N: usize> {
    worst: [f64; N],
    component: [usize; N],
    moved: [f64; N],
}

impl<const N: usize> Defect<N> {
    /// Whether a projection moved the end farther than errors of steps are.
    pub(crate) fn is_far(&self, lane: usize) -> bool {
        self.moved[lane] > 1.0
    }

    /// The component whose rates are not those of the polynomial, if there is one.
    pub(crate) fn component(&self, lane: usize) -> Option<usize> {
        (self.worst[lane] > 1.0 + DEFECT * self.moved[lane]).then_some(self.component[lane])
    }
}

impl<const N: usize> Ends<'_, N> {
    /// Difference between the slope of the polynomial and the rates.
    #[inline(always)]
    pub(crate) fn defect(&self, absolute_tolerances: &[[f64; N]], relative_tolerance: f64) -> Defect<N> {
        let orders = self.next_coefficients.len() / self.candidate.len();
        let relative = relative_tolerance.max(LEAST_RELATIVE);
        let mut found = Defect { worst: [0.0; N], component: [0; N], moved: [0.0; N] };
        for (i, absolute) in absolute_tolerances.iter().enumerate() {
            let (y, slope, rates) = (self.candidate[i], self.slope[i], self.next_coefficients[i * orders + 1]);
            for l in 0..N {
                let allowed = DEFECT * (absolute[l] + relative * y[l].abs().max(slope[l].abs()));
                found.moved[l] = found.moved[l].max((y[l] - self.reached[i][l]).abs() / allowed);
                let defect = (slope[l] - rates[l] * self.share[l]).abs() / allowed;
                let larger = defect > found.worst[l];
                found.worst[l] = if larger { defect } else { found.worst[l] };
                found.component[l] = if larger { i } else { found.component[l] };
            }
        }
        found
    }
}

/// Takes what a closure has captured: called once only, it is inlined as a whole where it is dispatched.
#[inline(always)]
pub(crate) fn once<T>(captured: T) -> T {
    captured
}
