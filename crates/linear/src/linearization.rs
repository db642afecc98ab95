//! Equations of motion to first order about a motion.

use std::collections::BTreeMap;
use std::fmt;

use equations::Role;
use motion::{Choice, Ending, Form, Setting, Settings, solve_from};
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use symbolic::limits::NOTHING;
use symbolic::question;

use crate::matrix::part;
use crate::point::{COORDINATES, Point, VELOCITIES, in_quasi_velocities};
use crate::spectrum::sort;
use crate::{Block, Chain, Eigenvalue, LinearError, Spectrum};

/// A coordinate on which no rate depends.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// Its name.
    pub name: String,
    /// Its rate.
    pub rate: f64,
}

fn by_name<S: Serializer>(carried: &[Carried], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(carried.iter().map(|c| (&c.name, c.rate)))
}

fn by_rows<S: Serializer>(matrix: &DMatrix<f64>, to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(matrix.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>()))
}

/// `δ̇ = J δ` about a steady motion, or about an instant of any other.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Linearization {
    /// Name of the form of the formulation whose states they are.
    pub form: &'static str,
    /// Time.
    pub t: f64,
    /// Whether `J` is that of a steady motion; frozen otherwise.
    #[serde(rename = "steady")]
    pub is_steady: bool,
    /// Names of the states, length N.
    pub states: Vec<String>,
    /// Their values.
    pub values: Vec<f64>,
    /// The other states: rates of coordinates that are carried along.
    #[serde(serialize_with = "by_name")]
    #[schemars(with = "BTreeMap<String, f64>")]
    pub carried: Vec<Carried>,
    /// `J`, N×N, row by row.
    #[serde(serialize_with = "by_rows")]
    #[schemars(with = "Vec<Vec<f64>>")]
    pub matrix: DMatrix<f64>,
    /// The eigenvalues, with their errors.
    #[serde(flatten)]
    pub spectrum: Spectrum,
    /// Places in `states` of coordinates, and of velocities or what replaces them.
    #[serde(skip)]
    coordinates: Vec<usize>,
    #[serde(skip)]
    velocities: Vec<usize>,
}

/// The equations of `choice` to first order about the start of `setting`, which has to be a steady motion.
///
/// A rate counts as zero up to 1e-9 of `Σ |J_ij| s_j` plus the sum of terms behind it. For states that are
/// coupled in both directions, `s` is how far they can be displaced before their part of `J` changes; for
/// others `s_j = |y_j|`.
///
/// # Errors
/// [`LinearError::NotSteady`], [`LinearError::TimeDependent`]; [`LinearError::Solve`] where the formulation
/// refuses the system.
pub fn linearize(setting: Setting, choice: &Choice) -> Result<Linearization, LinearError> {
    Linearization::at(&mut Point::start(setting, choice)?, true)
}

/// The equations of `choice` to first order about its motion from the start of `setting`, at time `t`.
///
/// # Errors
/// [`LinearError::NotReached`], [`LinearError::BeforeStart`] and [`LinearError::Solve`].
pub fn linearize_at(
    setting: Setting,
    choice: &Choice,
    t: f64,
    settings: &Settings,
) -> Result<Linearization, LinearError> {
    let start = setting.start.t;
    if t.is_nan() || t < start {
        return Err(LinearError::BeforeStart { t, start });
    }
    if t == start {
        return Linearization::at(&mut Point::start(setting, choice)?, false);
    }
    let settings = Settings { form: Form::Named, ..settings.clone() };
    let mut motion = solve_from(Setting { end: t, ..setting }, &in_quasi_velocities(setting, choice), &settings)?;
    if motion.end() < t {
        let cause = match &motion.ending {
            Ending::Stopped { cause, .. } => cause.clone(),
            Ending::Completed => "it cannot be read off there".into(),
        };
        return Err(LinearError::NotReached { t, end: motion.end(), cause });
    }
    let y = motion.states_at(t)?;
    let mut point = Point::of(motion.equations.clone(), t, y)?;
    point.compiled.set_constants(&motion.constants);
    Linearization::at(&mut point, false)
}

fn depends_on_time(point: &Point) -> bool {
    let equations = &point.equations;
    let residuals = equations.blocks.iter().flat_map(|block| block.residuals.iter().copied());
    let all = equations.states.iter().map(|y| y.rate).chain(residuals);
    equations.symbols_behind(all).contains(&equations.time)
}

impl Linearization {
    /// About a point, which has to be one of a steady motion where `is_steady` says so.
    pub(crate) fn at(point: &mut Point, is_steady: bool) -> Result<Linearization, LinearError> {
        if is_steady && depends_on_time(point) {
            return Err(LinearError::TimeDependent { formulation: point.equations.formulation.into() });
        }
        let y = point.y.clone();
        let jacobian = point.jacobian(&y)?;
        let noise = point.noise(&y, &jacobian)?;
        let carried = point.carried()?;
        let rates = point.rates(&y)?;
        let kept: Vec<usize> = (0..y.len()).filter(|i| !carried.contains(i)).collect();
        let name = |point: &Point, i: usize| point.equations.graph.name(point.equations.states[i].symbol);
        let (matrix, form) = (part(&jacobian, &kept), point.equations.formulation);
        // before its eigenvalues are asked for, which takes longest
        if is_steady && let Some(Moving { place, rate, limit }) = moving(point, &kept, &matrix)?.1 {
            let carried = carried.iter().map(|&i| name(point, i)).collect::<Vec<_>>().join(", ");
            let carried = if carried.is_empty() { "nothing here".into() } else { carried };
            let state = name(point, kept[place]);
            return Err(LinearError::NotSteady { formulation: form.into(), state, rate, limit, carried });
        }
        let spectrum = question(|| Spectrum::of(&matrix, &part(&noise, &kept)))?;
        let places = |roles: &[Role]| {
            let all = point.places(roles);
            (0..kept.len()).filter(|&k| all.contains(&kept[k])).collect::<Vec<usize>>()
        };
        Ok(Linearization {
            form,
            t: point.t,
            is_steady,
            states: kept.iter().map(|&i| name(point, i)).collect(),
            values: kept.iter().map(|&i| y[i]).collect(),
            carried: carried.iter().map(|&i| Carried { name: name(point, i), rate: rates[i] }).collect(),
            spectrum: spectrum.ok_or(LinearError::NoEigenvalues { size: kept.len() })?,
            matrix,
            coordinates: places(&COORDINATES),
            velocities: places(&VELOCITIES),
        })
    }

    /// The eigenvalues that belong to these coordinates and their velocities, and to what is coupled with
    /// them both ways; all of them where no coordinate is named.
    ///
    /// # Errors
    /// [`LinearError::UnknownFree`], [`LinearError::CarriedFree`].
    pub fn part(&self, free: &[&str]) -> Result<Part, LinearError> {
        let mut wanted = vec![free.is_empty(); self.states.len()];
        for &name in free {
            if self.carried.iter().any(|c| c.name == name) {
                return Err(LinearError::CarriedFree { name: name.into() });
            }
            let Some(&i) = self.coordinates.iter().find(|&&i| self.states[i] == name) else {
                let known: Vec<&str> = self.coordinates.iter().map(|&i| &self.states[i][..]).collect();
                let (name, formulation) = (name.into(), self.form.into());
                return Err(LinearError::UnknownFree { name, formulation, known: known.join(", ") });
            };
            wanted[i] = true;
            for &w in self.velocities.iter().filter(|&&w| self.matrix[(i, w)] != 0.0) {
                wanted[w] = true;
            }
        }
        let Spectrum { blocks, chains, .. } = &self.spectrum;
        let asked = |block: &Block| block.places.iter().any(|&i| wanted[i]);
        let mut part =
            Part { states: Vec::new(), eigenvalues: Vec::new(), zeros: 0, zero_error: 0.0, chains: Vec::new() };
        part.chains.extend(chains.iter().filter(|chain| chain.blocks.iter().any(|&i| asked(&blocks[i]))).cloned());
        for block in blocks.iter().filter(|block| asked(block)) {
            part.states.extend(&block.places);
            part.eigenvalues.extend(&block.eigenvalues);
            part.zeros += block.zeros;
            part.zero_error = part.zero_error.max(block.zero_error);
        }
        part.states.sort_unstable();
        sort(&mut part.eigenvalues);
        Ok(part)
    }
}

/// A state that is not steady.
pub(crate) struct Moving {
    pub(crate) place: usize,
    pub(crate) rate: f64,
    /// What counts as none.
    pub(crate) limit: f64,
}

/// [`Point::scales`] of the states `kept`, whose Jacobian is `matrix`; and the one whose rate is most over
/// its limit, if any is.
pub(crate) fn moving(
    point: &mut Point,
    kept: &[usize],
    matrix: &DMatrix<f64>,
) -> Result<(Vec<f64>, Option<Moving>), LinearError> {
    let y = point.y.clone();
    let (rates, terms, scales) = (point.rates(&y)?, point.terms()?, point.scales(kept, matrix)?);
    let over = kept.iter().zip(matrix.row_iter()).enumerate().filter_map(|(place, (&i, row))| {
        let size: f64 = row.iter().zip(&scales).map(|(a, s)| a.abs() * s).sum();
        let (rate, limit) = (rates[i], NOTHING * (size + terms[i]));
        (rate.abs() > limit).then_some(Moving { place, rate, limit })
    });
    let most = over.max_by(|a, b| (a.rate.abs() / a.limit).total_cmp(&(b.rate.abs() / b.limit)));
    Ok((scales, most))
}

/// Eigenvalues of some of the states.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Part {
    /// Places in [`Linearization::states`].
    #[serde(skip)]
    pub states: Vec<usize>,
    /// Eigenvalues other than zero, by falling real part.
    pub eigenvalues: Vec<Eigenvalue>,
    /// Number of zero eigenvalues: of integrals, symmetries and families of steady motions.
    pub zeros: usize,
    /// Error of these zeros.
    pub zero_error: f64,
    /// Groups of these for which deviations grow as powers of time, or may do so.
    pub chains: Vec<Chain>,
}

/// How deviations grow, as far as the equations to first order and the errors decide it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// This number of eigenvalues have a positive real part, beyond their errors.
    Exponential(usize),
    /// At least this number: errors leave the others open.
    AtLeast(usize),
    /// Like this power of time, or faster: an eigenvalue on the imaginary axis has too few eigenvectors.
    Power(usize),
    /// Every eigenvalue is zero, or errors leave open how deviations of eigenvalues on the imaginary axis
    /// grow.
    Undecided,
    /// No faster than `e^(error t)`: no disc is right of the axis, and what is on it has its eigenvectors.
    None,
}

impl Part {
    /// How many eigenvalues have a positive real part, beyond their errors.
    pub fn unstable(&self) -> usize {
        self.eigenvalues.iter().filter(|eigenvalue| eigenvalue.is_unstable()).count()
    }

    /// How deviations grow.
    pub fn growth(&self) -> Growth {
        let is_open = self.chains.iter().any(|chain| !chain.is_exact);
        match (self.unstable(), self.chains.iter().map(|chain| chain.power).max()) {
            (0, _) if is_open => Growth::Undecided,
            (0, Some(power)) => Growth::Power(power),
            (0, None) if self.eigenvalues.is_empty() => Growth::Undecided,
            (0, None) => Growth::None,
            (count, _) if is_open => Growth::AtLeast(count),
            (count, _) => Growth::Exponential(count),
        }
    }
}

impl fmt::Display for Growth {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Growth::Exponential(count) => write!(f, "{count}"),
            Growth::AtLeast(count) => write!(f, "{count} or more"),
            Growth::Power(1) => write!(f, "like t"),
            Growth::Power(power) => write!(f, "like t^{power}"),
            Growth::Undecided => write!(f, "undecided"),
            Growth::None => write!(f, "0"),
        }
    }
}
