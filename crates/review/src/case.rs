//! Their accelerations at several points, held against rows of derivations.

use decision::exact::Exact;
use symbolic::{Evaluator, Symbol};

use crate::atoms::{Atom, Called};
use crate::base::{Base, Residuals};
use crate::frame::{Frame, Point, Trouble};
use crate::number::{Number, constants, eliminate, values};

/// Draws until as many are found.
const DRAWS: u64 = 60;
/// Sizes of the integers that are drawn in a field, as powers of two: exact sines of large ones may not fit.
/// Beside, at how many points equations are compared.
const BITS: [(u32, usize); 3] = [(20, 4), (8, 10), (3, 24)];
/// Explanations of the same equations that are told.
const TOLD: usize = 6;

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
    residual: Vec<C>,
    columns: Vec<Vec<C>>,
    /// The same at the shifted points, and how many these are.
    slopes: Residuals<C>,
    unknowns: usize,
}

impl<C: Number> Stack<C> {
    /// Whether accelerations are determined with these multiples of columns: `0 = 0` explains everything.
    fn determines(&self, of: &[(usize, C)]) -> bool {
        let add = |i: usize, x: C| of.iter().fold(x, |sum, &(k, kappa)| sum + kappa * self.slopes.columns[k][i]);
        let slopes: Vec<C> = self.slopes.residual.iter().enumerate().map(|(i, &x)| add(i, x)).collect();
        let rows = slopes.len() / self.unknowns.max(1);
        let mut slopes: Vec<Vec<C>> = slopes.chunks(rows.max(1)).map(<[C]>::to_vec).collect();
        eliminate(&mut slopes, rows).len() == self.unknowns
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
            for seed in 1..=DRAWS {
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
        let Residuals { residual, columns } = over(&self.points, at_points)?;
        Some(Stack { residual, columns, slopes: over(&self.shifted, at_shifted)?, unknowns: self.shifted.len() })
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
            if pairs { two(&stack, called, &mut found) } else { one(&stack, called, &mut found) }
        }
        found.sort_by_key(|(odd, _)| *odd);
        found.truncate(TOLD);
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

fn one<C: Number>(stack: &Stack<C>, called: &[&Called], found: &mut Vec<(usize, Vec<String>)>) {
    for (k, (column, called)) in stack.columns.iter().zip(called).enumerate() {
        let open = (0..column.len()).filter(|&i| !column[i].vanishes());
        let Some(place) = open.max_by(|&a, &b| column[a].weight().total_cmp(&column[b].weight())) else { continue };
        // in proportion; quotients are dear in a field
        let (r, u) = (stack.residual[place], column[place]);
        if stack.residual.iter().zip(column).any(|(&own, &x)| !(own * u - r * x).vanishes()) {
            continue;
        }
        let Some(over) = u.inverse() else { continue };
        let kappa = -(r * over);
        if let Some((odd, words)) = named(called, kappa).filter(|_| stack.determines(&[(k, kappa)])) {
            found.push((odd, vec![words]));
        }
    }
}

/// Pairs: the determinants of the residual and two columns in three sums of rows tell which are looked at.
fn two<C: Number>(stack: &Stack<C>, called: &[&Called], found: &mut Vec<(usize, Vec<String>)>) {
    let mut random = symbolic::SplitMix::new(7);
    let weights: Vec<Vec<C>> = (0..3)
        .map(|_| (0..stack.residual.len()).map(|_| C::draw(&mut random, 8, 1.0).coefficient(0)).collect())
        .collect();
    let sums = |column: &[C]| -> Vec<C> {
        let sum = |w: &Vec<C>| w.iter().zip(column).fold(C::ZERO, |sum, (&w, &x)| sum + w * x);
        weights.iter().map(sum).collect()
    };
    let cross = |a: &[C], b: &[C]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let residual = sums(&stack.residual);
    let columns: Vec<Vec<C>> = stack.columns.iter().map(|column| sums(column)).collect();
    for (i, a) in columns.iter().enumerate() {
        let normal = cross(&residual, a);
        for (j, b) in columns.iter().enumerate().skip(i + 1) {
            let determinant = normal.iter().zip(b).fold(C::ZERO, |sum, (&x, &y)| sum + x * y);
            if !determinant.vanishes() {
                continue;
            }
            // κ_a a + κ_b b = −r, by the largest minor
            let minors = cross(a, b);
            let largest = (0..3).max_by(|&x, &y| minors[x].weight().total_cmp(&minors[y].weight()));
            let Some((k, over)) = largest.and_then(|k| Some((k, minors[k].inverse()?))) else { continue };
            if minors[k].vanishes() {
                continue;
            }
            let kappas = [-(cross(&residual, b)[k] * over), cross(&residual, a)[k] * over];
            let all = stack.residual.iter().zip(&stack.columns[i]).zip(&stack.columns[j]);
            if all.into_iter().any(|((&r, &a), &b)| !(r + kappas[0] * a + kappas[1] * b).vanishes()) {
                continue;
            }
            if let (Some((x, one)), Some((y, two))) = (named(called[i], kappas[0]), named(called[j], kappas[1]))
                && stack.determines(&[(i, kappas[0]), (j, kappas[1])])
            {
                found.push((x + y, vec![one, two]));
            }
        }
    }
}

/// Names and columns of mistakes.
pub(crate) fn split(atoms: &[Atom]) -> (Vec<&Called>, Vec<Vec<symbolic::Expr>>) {
    atoms.iter().map(|atom| (&atom.called, atom.column.clone())).unzip()
}
