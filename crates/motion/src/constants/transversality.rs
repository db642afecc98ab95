//! Constants that are natural at a horizon: a boundary value.

use equations::Equations;
use integrate::{AT_ONCE, BoundaryError, Dense, Interrupt, Options, Residuals, ShootOptions, Shot, Status, shoot};

use nalgebra::{DMatrix, DVector};

use crate::band::{CERTAINTY, RESIDUAL};
use crate::charts::{self, Course};
use crate::direction::Chord;
use crate::numbers::precise;
use crate::shooting::{CHORDS, LONGER};
use crate::variational::{PLAIN_RUNS, VariationalRun, Which};
use crate::{Ending, Prepared, Setting, Settings, SolveError, TIGHTER};

/// Finds the constants `C` that make every [`equations::FreeConstant::natural`] vanish at `horizon`.
///
/// Single shooting from `near`, or zero: unknowns are the constants, residuals the quantities at the horizon,
/// both over the sizes that the quantities have on the motion from there. Derivatives are carried with the
/// motion where a method carries them, one chart leads to the horizon, and differences take longer.
/// Without `near`, and with a [`Chord`], that is tried first.
/// All runs together may take [`LONGER`] times the first one's steps, for each run that the search may make.
pub(super) fn natural_constants(
    prepared: &mut Prepared,
    horizon: f64,
    settings: &Settings,
    setting: Option<Setting>,
    near: Option<&[f64]>,
) -> Result<Vec<f64>, SolveError> {
    if prepared.own_constants().is_empty() {
        return Ok(Vec::new());
    }
    if let (None, Some(chord)) = (near, prepared.chord.clone()) {
        let mut search = Search::new(prepared, horizon, settings, setting, Some(&chord.constants))?;
        if let Some(found) = search.by_chord(&chord) {
            return Ok(found);
        }
    }
    let mut search = Search::new(prepared, horizon, settings, setting, near)?;
    let shot = search.shoot()?;
    Ok(search.in_units(&shot.unknowns))
}

/// The chord of this motion; `None` where its constants are not found, or derivatives are not carried.
pub(crate) fn chord(prepared: &mut Prepared, horizon: f64, settings: &Settings) -> Option<Chord> {
    let mut search = Search::new(prepared, horizon, settings, None, None).ok()?;
    let count = search.guess.len();
    if count == 0 {
        return None;
    }
    let found = search.shoot().ok()?.unknowns;
    search.carries = true;
    let mut jacobian = vec![0.0; count * count];
    if !search.jacobian(&found, &mut jacobian).ok()? {
        return None;
    }
    // both over the same sizes
    let in_units = |i: usize, j: usize| jacobian[i * count + j] * search.sizes[i] / search.sizes[j];
    let inverse = DMatrix::from_fn(count, count, in_units).try_inverse()?;
    Some(Chord { constants: search.in_units(&found), inverse })
}

/// The quantities at the horizon as functions of the constants, both over their sizes.
struct Search<'a> {
    prepared: &'a mut Prepared,
    horizon: f64,
    settings: &'a Settings,
    setting: Option<Setting<'a>>,
    /// Places of the quantities among the states.
    places: Vec<usize>,
    sizes: Vec<f64>,
    guess: Vec<f64>,
    options: ShootOptions,
    of_all: Options,
    /// Whether derivatives are carried where they can be.
    carries: bool,
    taken: usize,
    limit: Option<usize>,
    failure: Option<SolveError>,
}

impl<'a> Search<'a> {
    fn new(
        prepared: &'a mut Prepared,
        horizon: f64,
        settings: &'a Settings,
        setting: Option<Setting<'a>>,
        near: Option<&[f64]>,
    ) -> Result<Self, SolveError> {
        let start = prepared.t;
        if horizon.is_nan() || horizon <= start {
            return Err(SolveError::Horizon { horizon, start });
        }
        let count = prepared.own_constants().len();
        let places = places(&prepared.equations, count);
        let formulation = || prepared.equations.formulation.to_string();
        let places = places.ok_or_else(|| SolveError::NoNaturalCondition { formulation: formulation() })?;
        let guess = near.map_or(vec![0.0; count], <[f64]>::to_vec);
        prepared.set_constants(&guess);
        let of_states = prepared.sizes(horizon);
        let sizes: Vec<f64> = places.iter().map(|&place| of_states[place]).collect();
        let guess: Vec<f64> = guess.iter().zip(&sizes).map(|(c, size)| c / size).collect();
        let tolerance = settings.tolerance * TIGHTER;
        let method = Some(prepared.method.method);
        let of_all = Settings { method, ..settings.clone() }.options(tolerance);
        let options = ShootOptions::with_tolerance(RESIDUAL * tolerance);
        Ok(Search {
            prepared,
            horizon,
            settings,
            setting,
            places,
            sizes,
            guess,
            options,
            of_all,
            carries: 2 * count > PLAIN_RUNS,
            taken: 0,
            limit: None,
            failure: None,
        })
    }

    fn shoot(&mut self) -> Result<Shot, SolveError> {
        let (guess, options, horizon) = (self.guess.clone(), self.options.clone(), self.horizon);
        let shot = shoot(self, &guess, &options);
        match (shot, self.failure.take()) {
            (Ok(shot), _) => Ok(shot),
            (Err(_), Some(error)) => Err(error),
            (Err(error), None) => Err(SolveError::Boundary { horizon, error }),
        }
    }

    /// Constants in their own units, found by steps of the chord method, each of which has to lessen the
    /// residual; `None` where these do not end.
    fn by_chord(&mut self, chord: &Chord) -> Option<Vec<f64>> {
        let (mut at, mut before) = (self.guess.clone(), f64::INFINITY);
        let mut best = None;
        for _ in 0..CHORDS {
            let mut values = vec![0.0; at.len()];
            if self.residual(&at, &mut values).is_err() {
                break;
            }
            let norm = values.iter().map(|r| r * r).sum::<f64>().sqrt();
            if norm <= self.options.tolerance && norm < before {
                best = Some(self.in_units(&at));
            }
            if norm <= AT_ONCE * self.options.tolerance || norm.is_nan() || CERTAINTY * norm > before {
                break;
            }
            before = norm;
            let step = &chord.inverse * DVector::from_vec(self.in_units(&values));
            at.iter_mut().zip(&step).zip(&self.sizes).for_each(|((c, step), size)| *c -= step / size);
        }
        self.failure = None;
        best
    }

    fn in_units(&self, scaled: &[f64]) -> Vec<f64> {
        scaled.iter().zip(&self.sizes).map(|(c, size)| c * size).collect()
    }

    fn refuse(&mut self, error: SolveError) -> BoundaryError {
        let reason = error.to_string();
        self.failure = Some(error);
        BoundaryError::Residual { reason }
    }

    /// Sets the constants; how a run may be done now.
    fn begin(&mut self, constants: &[f64]) -> Result<Options, BoundaryError> {
        let (horizon, most) = (self.horizon, self.settings.max_steps);
        let left = self.limit.map_or(most, |limit| most.min(limit.saturating_sub(self.taken)));
        if left == 0 {
            return Err(self.refuse(SolveError::Search { horizon, steps: self.taken }));
        }
        let constants = self.in_units(constants);
        self.prepared.set_constants(&constants);
        if let Some(cause) = self.of_all.interrupt.as_ref().and_then(Interrupt::cause) {
            return Err(self.refuse(SolveError::Ended { horizon, cause }));
        }
        Ok(Options { max_steps: left, dense: Dense::EndOnly, ..self.of_all.clone() })
    }

    fn took(&mut self, steps: usize) {
        self.taken += steps;
        let runs = self.options.max_iterations * (2 * self.guess.len() + 2);
        self.limit.get_or_insert(LONGER * runs * steps);
    }
}

impl Residuals for Search<'_> {
    fn residual(&mut self, constants: &[f64], residual: &mut [f64]) -> Result<(), BoundaryError> {
        let options = self.begin(constants)?;
        let reached = at_horizon(self.prepared, self.horizon, &options, self.settings, self.setting);
        let AtHorizon { ending, states: end, steps } = reached.map_err(|error| self.refuse(error))?;
        self.took(steps);
        if let Ending::Stopped { t, cause } = ending {
            return Err(BoundaryError::Residual { reason: format!("the motion stops at t = {}: {cause}", precise(t)) });
        }
        for ((r, &place), size) in residual.iter_mut().zip(&self.places).zip(&self.sizes) {
            *r = end[place] / size;
        }
        Ok(())
    }

    fn jacobian(&mut self, constants: &[f64], jacobian: &mut [f64]) -> Result<bool, BoundaryError> {
        if !self.carries || !VariationalRun::is_by(self.of_all.method) {
            return Ok(false);
        }
        let options = self.begin(constants)?;
        let along: Vec<_> = (0..constants.len()).map(|i| self.prepared.along_constant(i, self.sizes[i])).collect();
        let carried = VariationalRun::run(self.prepared, &along, self.horizon, &options, Which::Kept);
        let carried = carried.map_err(|error| self.refuse(error))?;
        self.took(carried.steps());
        if *carried.status() != Status::Completed {
            return Ok(false);
        }
        for (j, moves) in carried.end_moves().enumerate() {
            for ((i, &place), size) in self.places.iter().enumerate().zip(&self.sizes) {
                jacobian[i * constants.len() + j] = moves[place] / size;
            }
        }
        Ok(true)
    }
}

/// What a search from zero finds, and that in its own units; with derivatives that are carried, or without.
///
/// # Errors
/// A horizon before the start, no natural condition, and what a search ends with.
pub fn searched(
    prepared: &mut Prepared,
    horizon: f64,
    settings: &Settings,
    setting: Setting,
    carries: bool,
) -> Result<(Shot, Vec<f64>), SolveError> {
    let mut search = Search::new(prepared, horizon, settings, Some(setting), None)?;
    search.carries = carries;
    let shot = search.shoot()?;
    let constants = search.in_units(&shot.unknowns);
    Ok((shot, constants))
}

/// The states that are natural with the first constants: costates of memory variables.
pub(crate) fn places(equations: &Equations, count: usize) -> Option<Vec<usize>> {
    let constants = equations.free_constants[..count].iter();
    constants
        .map(|c| {
            let symbol = equations.graph.as_symbol(c.natural?)?;
            equations.states.iter().position(|y| y.symbol == symbol)
        })
        .collect()
}

/// How a run to the horizon ended.
struct AtHorizon {
    ending: Ending,
    /// In the first chart; zero where it was not reached.
    states: Vec<f64>,
    steps: usize,
}

/// One run to the horizon; where that leaves its chart and a `setting` is known, both runs of the motion from
/// chart to chart.
fn at_horizon(
    prepared: &mut Prepared,
    horizon: f64,
    options: &Options,
    settings: &Settings,
    setting: Option<Setting>,
) -> Result<AtHorizon, SolveError> {
    let run = prepared.integrate(horizon, options)?;
    let steps = run.solution.work.steps + run.solution.work.rejected;
    let ending = Ending::of(&prepared.equations, &mut prepared.compiled, &run.solution, &[]);
    let mut states = vec![0.0; prepared.start.len()];
    if ending == Ending::Completed {
        run.solution.dense.evaluate(horizon, &mut states);
    } else if let Some(setting) = setting.filter(|_| prepared.compiled.has_chart()) {
        let within =
            Settings { method: Some(options.method), max_steps: options.max_steps, times: None, ..settings.clone() };
        let course = charts::run(Setting { end: horizon, ..setting }, prepared, &within, f64::INFINITY)?;
        if let Course::Run(mut runs) = course {
            if runs.ending == Ending::Completed {
                states = runs.trajectories[0].state(&mut prepared.compiled, horizon)?;
            }
            let steps = steps + 2 * (runs.work.steps + runs.work.rejected);
            return Ok(AtHorizon { ending: runs.ending, states, steps });
        }
    }
    Ok(AtHorizon { ending, states, steps })
}
