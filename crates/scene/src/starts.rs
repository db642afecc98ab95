//! Starts of a scene with other numbers: its own expressions, compiled once.

use mechanics::{Completion, Configurations, StartError, StartNumbers, StartProgram, StartShape, State, System};
use symbolic::{Evaluator, Expr, Symbol};

use super::section::suggestion;
use super::start::{on_position, rate_names};
use crate::{Scene, SceneError, SceneErrorKind};

/// Starts of a scene with some numbers replaced.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// `(t₀, q₀, v₀)`, on the constraint.
    pub state: State,
    /// Values of [`Starts::parameters`].
    pub parameters: Vec<f64>,
    /// `μ₀`, length h.
    pub multipliers: Vec<f64>,
}

/// Starts of a scene that differ by the numbers in some places: the same as of the text with these overrides
/// ([`Scene::parse_with`]), to the last digits, and a hundred times faster.
///
/// ```
/// # let text = include_str!("../sledge.toml");
/// let mut starts = scene::Scene::parse("sledge", text)?.starts(&["phi"])?;
/// let start = starts.at(&[0.5])?;
/// let read = scene::Scene::parse_with("sledge", text, &[("phi".into(), 0.5)])?;
/// assert!((start.state.v[1] - read.start.v[1]).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Starts {
    names: Vec<String>,
    /// Parameters that vary, and where their values are in a row.
    parameters: Vec<(Symbol, usize)>,
    positions: Vec<Quantity>,
    /// Constraints on positions, by their numbers.
    on_positions: Vec<(usize, Evaluator<f64>)>,
    /// Coordinates that they supply.
    configured: Option<Configurations>,
    given: Vec<Quantity>,
    guess: Vec<Quantity>,
    /// The scene's multipliers, and which of them a row has, and where.
    multipliers: Vec<f64>,
    varied_multipliers: Vec<(usize, usize)>,
    program: StartProgram,
    numbers: StartNumbers,
    /// The parameters that vary, `t` and the positions.
    values: Vec<f64>,
    /// The start of the row before: rows that differ by multipliers alone have one start.
    known: Option<(StartNumbers, State)>,
}

#[derive(Clone)]
struct Quantity {
    symbol: Symbol,
    name: String,
    source: Source,
}

#[derive(Clone)]
enum Source {
    /// The number of this place in a row.
    Row(usize),
    Expression(Evaluator<f64>),
}

impl Scene {
    /// Starts with other numbers in the places of these: parameters, coordinates, start velocities or rates,
    /// multipliers (`mu0_1`, …).
    ///
    /// # Errors
    /// With line 0: [`SceneErrorKind::UnknownName`]; [`SceneErrorKind::Removal`] where a removal written by
    /// hand removes the constraints for the scene's own value of such a parameter only.
    pub fn starts(&self, names: &[&str]) -> Result<Starts, SceneError> {
        Starts::new(self, names).map_err(|kind| SceneError::outside(&self.name, kind))
    }
}

impl Starts {
    fn new(scene: &Scene, names: &[&str]) -> Result<Starts, SceneErrorKind> {
        let (system, removal) = (&scene.system, scene.removals.first());
        let g = &system.graph;
        let rates = rate_names(system, removal);
        let parameters = system.parameters.iter().map(|p| g.name(p.symbol));
        let multipliers = scene.multiplier_names();
        let coordinates = system.coordinates.iter().map(|c| c.name.clone());
        let own = parameters.chain(coordinates).chain(rates.iter().map(|(name, _)| name.clone()));
        let known: Vec<String> = own.chain(multipliers).collect();
        let mut varied_multipliers = Vec::new();
        for (i, name) in names.iter().enumerate() {
            let Some(place) = known.iter().position(|known| known == name) else {
                let expected = "parameter, coordinate, start velocity or multiplier (mu0_1, …) that could vary";
                let suggestion = suggestion(name, &known);
                return Err(SceneErrorKind::UnknownName { name: name.to_string(), expected, suggestion });
            };
            varied_multipliers.extend(place.checked_sub(known.len() - scene.multipliers.len()).map(|place| (place, i)));
        }
        let place = |s: Symbol| names.iter().position(|name| *name == g.name(s));
        let parameters: Vec<(Symbol, usize)> =
            system.parameters.iter().filter_map(|p| Some((p.symbol, place(p.symbol)?))).collect();
        let varied: Vec<Symbol> = parameters.iter().map(|(s, _)| *s).collect();
        let fixed = system.parameters.iter().filter(|p| !varied.contains(&p.symbol)).cloned().collect();
        let general = System { parameters: fixed, ..system.clone() };
        scene.removals.iter().try_for_each(|r| r.verify(&general).map(|_| ())).map_err(SceneErrorKind::Removal)?;

        let Completion { written, guessed, equations, projected, configured, .. } = &scene.completion;
        let inputs = [&varied[..], &[system.time], &system.positions()].concat();
        let compiled = |(s, e): (Symbol, Expr)| -> Result<Quantity, StartError> {
            let source = match place(s) {
                Some(place) => Source::Row(place),
                None => Source::Expression(system.evaluator(&inputs, &[e])?),
            };
            Ok(Quantity { symbol: s, name: g.name(s), source })
        };
        let compile = |list: Vec<(Symbol, Expr)>| {
            list.into_iter().map(compiled).collect::<Result<Vec<_>, _>>().map_err(SceneErrorKind::Start)
        };
        // a scene that was not read has numbers only, and all of them
        let numbers = |symbols: Vec<Symbol>, values: &[f64]| {
            symbols.into_iter().zip(values.iter().map(|&x| g.number(x))).collect::<Vec<_>>()
        };
        let all = [numbers(system.positions(), &scene.start.q), numbers(system.velocities(), &scene.start.v)].concat();
        let written = if written.is_empty() { &all } else { written };
        let coordinate = |s: Symbol| system.positions().iter().position(|q| *q == s);
        let (mut positions, mut given): (Vec<_>, Vec<_>) =
            written.iter().copied().partition(|(s, _)| coordinate(*s).is_some());
        // a coordinate that constraints supply was written last
        positions.sort_by_key(|(s, _)| coordinate(*s));
        for (_, s) in rates.into_iter().filter(|(_, s)| place(*s).is_some()) {
            given.retain(|(known, _)| *known != s);
            given.push((s, g.zero()));
        }
        let (positions, given, guess) = (compile(positions)?, compile(given)?, compile(guessed.clone())?);
        // what is given is not supplied
        let free: Vec<usize> = configured.iter().copied().filter(|&i| place(system.positions()[i]).is_none()).collect();
        let configured = (!free.is_empty()).then(|| Configurations::new(system, &varied, &free)).transpose();
        let configured = configured.map_err(|fault| SceneErrorKind::Start(fault.into()))?;
        let numbers_of = system.constraint_numbers();
        let constraint = |&(row, g): &(usize, Expr)| Ok((numbers_of[row], system.evaluator(&inputs, &[g])?));
        let on_positions: Result<Vec<_>, StartError> = system.on_positions.iter().map(constraint).collect();
        let symbols = |list: &[Quantity]| list.iter().map(|quantity| quantity.symbol).collect::<Vec<_>>();
        let shape = StartShape {
            given: &symbols(&given),
            guessed: &symbols(&guess),
            equations,
            project: projected.is_some(),
            removal,
            varied: &varied,
        };
        Ok(Starts {
            names: names.iter().map(|name| name.to_string()).collect(),
            program: StartProgram::new(system, &shape),
            numbers: StartNumbers { time: scene.start.t, ..StartNumbers::default() },
            values: vec![0.0; inputs.len()],
            multipliers: scene.multipliers.clone(),
            parameters,
            positions,
            on_positions: on_positions.map_err(SceneErrorKind::Start)?,
            configured,
            given,
            guess,
            varied_multipliers,
            known: None,
        })
    }

    /// The start with the numbers of a row, one per name.
    ///
    /// # Errors
    /// [`SceneErrorKind::NotFinite`], [`SceneErrorKind::Start`]: why there is none.
    ///
    /// # Panics
    /// If there are not as many numbers as names.
    pub fn at(&mut self, row: &[f64]) -> Result<Start, SceneErrorKind> {
        assert_eq!(row.len(), self.names.len(), "numbers of a row");
        if let Some(i) = row.iter().position(|x| !x.is_finite()) {
            let what = format!("the override of `{}`", self.names[i]);
            return Err(SceneErrorKind::NotFinite { what, value: row[i] });
        }
        let (numbers, values) = (&mut self.numbers, &mut self.values);
        numbers.varied.clear();
        numbers.varied.extend(self.parameters.iter().map(|(_, place)| row[*place]));
        let first = numbers.varied.len();
        values[..first].copy_from_slice(&numbers.varied);
        values[first] = numbers.time;
        numbers.positions.clear();
        for (i, quantity) in self.positions.iter_mut().enumerate() {
            let x = quantity.value(row, values)?;
            values[first + 1 + i] = x;
            numbers.positions.push(x);
        }
        if let Some(configured) = &mut self.configured {
            configured.supply(&values[..=first], &mut numbers.positions);
            values[first + 1..].copy_from_slice(&numbers.positions);
        }
        for (number, constraint) in &mut self.on_positions {
            on_position(*number, constraint.evaluate(values)[0], &numbers.positions)?;
        }
        for (list, into) in [(&mut self.given, &mut numbers.given), (&mut self.guess, &mut numbers.guess)] {
            into.clear();
            for quantity in list {
                into.push(quantity.value(row, values)?);
            }
        }
        let state = match &self.known {
            Some((known, state)) if same(known, numbers) => state.clone(),
            _ => self.program.complete(numbers).map_err(SceneErrorKind::Start)?.0,
        };
        self.known = Some((numbers.clone(), state.clone()));
        let mut multipliers = self.multipliers.clone();
        for (multiplier, place) in &self.varied_multipliers {
            multipliers[*multiplier] = row[*place];
        }
        Ok(Start { state, parameters: numbers.varied.clone(), multipliers })
    }

    /// The parameters that vary, in the order of the scene.
    pub fn parameters(&self) -> Vec<Symbol> {
        self.parameters.iter().map(|(s, _)| *s).collect()
    }

    /// Whether multipliers vary.
    pub fn vary_multipliers(&self) -> bool {
        !self.varied_multipliers.is_empty()
    }
}

/// Whether two starts have the same numbers, bit by bit.
fn same(a: &StartNumbers, b: &StartNumbers) -> bool {
    let numbers = |x: &StartNumbers| -> Vec<u64> {
        let lists = [&x.positions, &x.given, &x.guess, &x.varied];
        std::iter::once(&x.time).chain(lists.into_iter().flatten()).map(|x| x.to_bits()).collect()
    };
    numbers(a) == numbers(b)
}

impl Quantity {
    fn value(&mut self, row: &[f64], known: &[f64]) -> Result<f64, SceneErrorKind> {
        let value = match &mut self.source {
            Source::Row(place) => row[*place],
            Source::Expression(program) => program.evaluate(known)[0],
        };
        match value.is_finite() {
            true => Ok(value),
            false => Err(SceneErrorKind::NotFinite { what: format!("the start of `{}`", self.name), value }),
        }
    }
}
