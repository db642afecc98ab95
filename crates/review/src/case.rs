//! Their accelerations at several points, held against rows of derivations.

use decision::exact::Exact;
use symbolic::limits::{ITERATIONS, SHOWN};
use symbolic::{Evaluator, Symbol};

use crate::atoms::Called;
use crate::base::{Base, Residuals};
use crate::frame::{Frame, Point, Trouble};
use crate::number::{Number, constants, eliminate, values};

/// Sizes of the integers that are drawn in a field, as powers of two: exact sines of large ones may not fit.
/// Beside, at how many points equations are compared.
const BITS: [(u32, usize); 3] = [(20, 4), (8, 10), (3, 24)];

pub(crate) struct Case<'f, C> {
    pub(crate) frame: &'f Frame<'f>,
    pub(crate) points: Vec<Point<C>>,
    /// The first of them with one acceleration larger by 1, for each: slopes by accelerations.
    shifted: Vec<Point<C>>,
}

/// Columns of mistakes at each point.
pub(crate) type Columns<C> = Vec<Vec<Vec<C>>>;

/// A residual over all points, and columns as long.
struct Stack<C> {
    at: Residuals<C>,
    /// The same at the shifted points, and how many these are.
    slopes: Residuals<C>,
    unknowns: usize,
}

impl<C: Number> Stack<C> {
    /// The multiples `κ` of these columns that make up for the residual, where accelerations are determined
    /// with them: `0 = 0` explains everything.
    fn multiples(&self, of: &[usize]) -> Option<Vec<C>> {
        let row =
            |all: &Residuals<C>, i: usize| of.iter().map(|&k| all.columns[k][i]).chain([all.residual[i]]).collect();
        let mut rows: Vec<Vec<C>> = (0..self.at.residual.len()).map(|i| row(&self.at, i)).collect();
        let pivots = eliminate(&mut rows, of.len());
        if pivots.len() < of.len() || rows[of.len()..].iter().any(|row| !row[of.len()].vanishes()) {
            return None;
        }
        let mut kappas = vec![C::ZERO; of.len()];
        pivots.iter().zip(&rows).for_each(|(&k, row)| kappas[k] = -row[of.len()]);
        let count = self.slopes.residual.len();
        let sum = |row: Vec<C>| row.iter().zip(&kappas).fold(row[of.len()], |sum, (&x, &kappa)| sum + kappa * x);
        let slopes: Vec<C> = (0..count).map(|i| sum(row(&self.slopes, i))).collect();
        let width = (count / self.unknowns.max(1)).max(1);
        let mut slopes: Vec<Vec<C>> = slopes.chunks(width).map(<[C]>::to_vec).collect();
        (eliminate(&mut slopes, width).len() == self.unknowns).then_some(kappas)
    }
}

impl<'f, C: Number> Case<'f, C> {
    /// Draws the points, with parameters of any values or those of the scene.
    ///
    /// # Errors
    /// The [`Trouble`] of the first point, where there are not enough without.
    pub(crate) fn new(frame: &'f Frame<'f>, own: bool) -> Result<Self, Trouble> {
        let mut trouble = None;
        for &(bits, count) in if C::PROVES { &BITS[..] } else { &BITS[..1] } {
            let mut points = Vec::new();
            for seed in 1..=ITERATIONS as u64 {
                match frame.draw(seed, bits, own).and_then(|inputs| frame.at(inputs)) {
                    Ok(point) => points.push(point),
                    Err(found @ Trouble::NoPoint(_)) if C::PROVES => {
                        trouble.get_or_insert(found);
                        break;
                    }
                    Err(Trouble::NoPoint(found)) => _ = trouble.get_or_insert(Trouble::NoPoint(found)),
                    Err(other) => return Err(other),
                }
                if points.len() == count {
                    return Ok(Case::at(frame, points));
                }
            }
        }
        Err(trouble.unwrap_or(Trouble::NoPoint("no point was found".into())))
    }

    /// With these points.
    pub(crate) fn at(frame: &'f Frame<'f>, points: Vec<Point<C>>) -> Self {
        let shifted = points.first().map_or(Vec::new(), |point| {
            let with = |k: usize| {
                let mut accelerations = point.accelerations.clone();
                accelerations[k] = accelerations[k] + C::of(Exact::ONE).unwrap_or(C::ZERO);
                Point { inputs: point.inputs.clone(), accelerations, broken: Vec::new() }
            };
            (0..point.accelerations.len()).map(with).collect()
        });
        Case { frame, points, shifted }
    }

    /// Texts of their constraints that fail somewhere.
    pub(crate) fn broken(&self) -> Vec<String> {
        let mut broken: Vec<String> = self.points.iter().flat_map(|point| point.broken.clone()).collect();
        broken.sort();
        broken.dedup();
        broken
    }

    /// Columns that are expressions, at every point; none where one has no value.
    pub(crate) fn columns(&self, columns: &[Vec<symbolic::Expr>]) -> Option<Columns<C>> {
        let g = &self.frame.reading.system.graph;
        let accelerations = self.frame.reading.coordinates.iter().map(|c| c[2]);
        let inputs: Vec<Symbol> = self.frame.inputs.iter().copied().chain(accelerations).collect();
        let outputs = columns.concat();
        let mut program = Evaluator::new(g.compile(&inputs, &outputs, &<_>::default()).ok()?);
        let at = |point: &Point<C>| {
            let inputs = [&point.inputs[..], &constants(&point.accelerations)].concat();
            let outputs = values(&mut program, &inputs).ok()?;
            let rows = columns.first().map_or(1, Vec::len).max(1);
            Some(outputs.chunks(rows).map(<[C]>::to_vec).collect())
        };
        self.points.iter().chain(&self.shifted).map(at).collect()
    }

    /// The residual of `base` and of the columns in it, with these signs of unknowns.
    fn stack(&self, base: &Base, signs: &[bool], columns: &Columns<C>) -> Option<Stack<C>> {
        let mut program = base.program(self.frame).ok()?;
        let (at_points, at_shifted) = columns.split_at(self.points.len());
        let mut over = |points: &[Point<C>], columns: &[Vec<Vec<C>>]| {
            let mut all = Residuals { residual: Vec::new(), columns: vec![Vec::new(); columns[0].len()] };
            for (point, columns) in points.iter().zip(columns) {
                let found = base.residuals(&mut program, point, &point.accelerations, signs, columns).ok()?;
                all.residual.extend(found.residual);
                all.columns.iter_mut().zip(found.columns).for_each(|(all, own)| all.extend(own));
            }
            Some(all)
        };
        let at = over(&self.points, at_points)?;
        Some(Stack { at, slopes: over(&self.shifted, at_shifted)?, unknowns: self.shifted.len() })
    }

    /// Whether theirs are these equations.
    ///
    /// # Errors
    /// The [`Trouble`] of a point at which these have no value, or determine no accelerations.
    pub(crate) fn is(&self, base: &Base) -> Result<bool, Trouble> {
        let mut program = base.program::<C>(self.frame).map_err(|fault| Trouble::NoPoint(fault.to_string()))?;
        let mut agrees = |point: &Point<C>, signs: &[bool]| {
            let left = base.residuals(&mut program, point, &point.accelerations, signs, &[])?;
            if left.residual.iter().any(|r| !r.vanishes()) {
                return Ok(false);
            }
            let open = || Trouble::NoPoint(format!("{} determine no accelerations", base.words.join(", ")));
            let right = base.accelerations(&mut program, point, signs).ok_or_else(open)?;
            Ok(right.iter().zip(&point.accelerations).all(|(&a, &b)| (a - b).vanishes()))
        };
        for signs in base.signs(self.frame) {
            let found = self.points.iter().map(|point| agrees(point, &signs)).find(|found| found != &Ok(true));
            match found {
                None => return Ok(true),
                Some(Err(trouble)) => return Err(trouble),
                Some(Ok(_)) => {}
            }
        }
        Ok(false)
    }

    /// The single mistakes, or pairs, with which `base` becomes theirs.
    pub(crate) fn explain(
        &self,
        base: &Base,
        called: &[&Called],
        columns: &Columns<C>,
        pairs: bool,
    ) -> Vec<Vec<String>> {
        let stacks = base.signs(self.frame).into_iter().filter_map(|signs| self.stack(base, &signs, columns));
        let mut found: Vec<(usize, Vec<String>)> = Vec::new();
        for stack in stacks {
            found.extend(explained(&stack, called, pairs));
        }
        found.sort_by_key(|(odd, _)| *odd);
        found.truncate(SHOWN);
        found.into_iter().map(|(_, words)| [&base.words[..], &words].concat()).collect()
    }
}

/// What a factor `κ` is called, and how unusual it is.
fn named<C: Number>(called: &Called, kappa: C) -> Option<(usize, String)> {
    let kappa = kappa.fraction().filter(|&kappa| kappa != 0.0)?;
    let usual = [-1.0, -2.0, 1.0, -0.5].contains(&kappa);
    let odd = usize::from(!usual) + usize::from(matches!(called, Called::Part(..)));
    called.words(kappa).map(|words| (odd, words))
}

/// The columns, or pairs, of which multiples with a name make up for the residual. Determinants with it in
/// three sums of rows tell which are looked at.
fn explained<C: Number>(stack: &Stack<C>, called: &[&Called], pairs: bool) -> Vec<(usize, Vec<String>)> {
    let mut random = symbolic::SplitMix::new(7);
    let count = stack.at.residual.len();
    let weights: [Vec<C>; 3] =
        std::array::from_fn(|_| (0..count).map(|_| C::draw(&mut random, 8, 1.0).coefficient(0)).collect());
    let sums = |column: &Vec<C>| -> [C; 3] {
        std::array::from_fn(|k| weights[k].iter().zip(column).fold(C::ZERO, |sum, (&w, &x)| sum + w * x))
    };
    let cross =
        |a: [C; 3], b: [C; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let words = |of: &[usize]| {
        let kappas = stack.multiples(of)?;
        let names: Option<Vec<_>> = of.iter().zip(kappas).map(|(&k, kappa)| named(called[k], kappa)).collect();
        names.map(|names| (names.iter().map(|(odd, _)| odd).sum(), names.into_iter().map(|(_, words)| words).collect()))
    };
    let residual = sums(&stack.at.residual);
    let columns: Vec<[C; 3]> = stack.at.columns.iter().map(sums).collect();
    let mut found = Vec::new();
    for (i, &a) in columns.iter().enumerate() {
        let normal = cross(residual, a);
        let parallel = |b: &[C; 3]| normal.iter().zip(b).fold(C::ZERO, |sum, (&x, &y)| sum + x * y).vanishes();
        if pairs {
            let others = (i + 1..columns.len()).filter(|&j| parallel(&columns[j]));
            found.extend(others.filter_map(|j| words(&[i, j])));
        } else if normal.iter().all(|x| x.vanishes()) {
            found.extend(words(&[i]));
        }
    }
    found
}
