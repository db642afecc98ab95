//! Questions, and the answers of every method.

use anyhow::{Context, Result};
use diffsol_methods::{BDF, ESDIRK34, EVERY, TR_BDF2, TSIT45};
use discrete::Composition;
use equations::Equations;
use integrate::Method;
use mechanics::{ConstantsRule, State, System};
use motion::{CERTAINTY, Choice, Metric, Motion, Setting, Settings, TIGHTER, solve, solve_from};
use serde::{Deserialize, Serialize, Serializer};

use super::judge::{Allowance, FLOOR, Verdict, judge};
use super::reference::{Known, Reference};
use program::parallel;

/// Limit on the steps of one run: what needs more is refused.
pub const MAX_STEPS: usize = 8_000;

/// Tolerance of the looser run, as the order of the method allows within [`MAX_STEPS`].
pub fn tolerance(method: Option<Method>) -> f64 {
    const LOOSER: [(Method, f64); 5] =
        [(TSIT45, 1e-8), (BDF, 1e-8), (ESDIRK34, 1e-7), (Method::Radau5, 1e-7), (TR_BDF2, 1e-5)];
    LOOSER.iter().find(|(own, _)| Some(*own) == method).map_or(1e-10, |(_, tolerance)| *tolerance)
}

/// Who answers a question.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answering {
    /// A method that chooses its steps, or `None`: the one that suits the motion.
    Method(Option<Method>),
    /// Structure-preserving steps of equal length.
    Steps(Composition),
}

impl Answering {
    /// The method that is chosen, and every other one.
    pub fn methods() -> impl Iterator<Item = Answering> {
        [None].into_iter().chain(EVERY.into_iter().map(Some)).map(Answering::Method)
    }

    /// Its name, on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Answering::Method(method) => method.map_or("auto", Method::name),
            Answering::Steps(Composition::Second) => "leapfrog, order 2",
            Answering::Steps(Composition::Fourth) => "order 4",
            Answering::Steps(Composition::Sixth) => "order 6",
            Answering::Steps(Composition::Eighth) => "order 8",
        }
    }

    /// Errors that are passed over whatever the estimate says.
    fn allowance(self, compared: usize, each: bool, end: f64) -> Allowance {
        match self {
            Answering::Method(method) => {
                let asked = tolerance(method);
                Allowance { floor: FLOOR.max(CERTAINTY * asked * TIGHTER), asked, end, compared, each }
            }
            Answering::Steps(_) => Allowance { floor: FLOOR, asked: 0.0, end, compared, each },
        }
    }
}

/// A case: one way of making things hard, by degrees.
pub struct Case {
    /// Name for the command line and the page.
    pub name: &'static str,
    /// For the page.
    pub texts: Texts,
    /// The questions, point by point.
    pub questions: fn() -> Vec<Question>,
}

/// Texts of a case on the page.
#[derive(Deserialize)]
pub struct Texts {
    /// The difficulty, and the possible failure.
    pub about: String,
    /// The reference of the answers.
    pub reference: String,
    /// The quantity that differs from point to point.
    pub variable: String,
}

/// A system with its start, ready for a formulation.
pub struct Subject {
    /// The system that is integrated.
    pub system: System,
    /// Its start.
    pub start: State,
    /// Time at which the motion is to end.
    pub end: f64,
    /// Its equations; the coordinates they hand out are those of `measured`.
    pub equations: Equations,
    /// Free constants.
    pub constants: ConstantsRule,
    /// The choice behind them, where they are its equations as derived: `auto` is then free to choose their
    /// form, too.
    pub choice: Option<Choice>,
    /// The system in whose kinetic metric errors are measured.
    pub measured: System,
}

/// One system at one point in one formulation.
pub struct Question {
    /// The point, for example `1e6`.
    pub point: f64,
    /// The formulation, and the removal where there are several.
    pub formulation: String,
    /// The system and its equations, or why there are none.
    pub subject: Box<dyn Fn() -> Result<Subject, String> + Send + Sync>,
    /// The reference of the motion.
    pub reference: Reference,
    /// Number of coordinates that are compared, from the first on.
    pub compared: usize,
    /// [`Allowance::each`]; the reference has multipliers then, after all coordinates.
    pub each: bool,
    /// Its motion in equal steps, of these compositions; without this the methods answer.
    pub stepped: Option<Stepped>,
}

/// A motion in equal steps.
pub type Stepped = Box<dyn Fn(Composition) -> Result<Motion, String> + Send + Sync>;

/// An answer.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    /// Name of the case.
    pub case: &'static str,
    /// Point of the case.
    pub point: f64,
    /// Formulation.
    pub formulation: String,
    /// Who answered.
    #[serde(serialize_with = "name")]
    pub method: Answering,
    /// What came of it.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Steps of the kept run.
    pub steps: usize,
}

fn name<S: Serializer>(method: &Answering, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(method.name())
}

/// Every method on every question of `cases`.
///
/// # Errors
/// Where a reference does not reach as far as what it is to judge.
pub fn run(cases: &[&Case], quiet: bool) -> Result<Vec<Cell>> {
    let questions: Vec<(&'static str, Question)> =
        cases.iter().flat_map(|case| (case.questions)().into_iter().map(|q| (case.name, q))).collect();
    let name = |(case, _): &(&str, Question)| case.to_string();
    let cells = parallel::try_map(&questions, quiet, name, |(case, question)| question.cells(case))?;
    Ok(cells.into_iter().flatten().collect())
}

impl Question {
    /// All coordinates are compared.
    pub(super) fn new(
        point: f64,
        formulation: &str,
        subject: impl Fn() -> Result<Subject, String> + Send + Sync + 'static,
        reference: Reference,
    ) -> Question {
        Question {
            point,
            formulation: formulation.into(),
            subject: Box::new(subject),
            reference,
            compared: usize::MAX,
            each: false,
            stepped: None,
        }
    }

    /// The answers of all methods, or of steps of all orders.
    ///
    /// # Errors
    /// Where the reference does not reach as far as what it is to judge.
    pub fn cells(&self, case: &'static str) -> Result<Vec<Cell>> {
        let subject = (self.subject)();
        let mut motions: Vec<(Answering, Result<Motion, String>)> = match &self.stepped {
            None => Answering::methods().map(|by| (by, motion(&subject, by))).collect(),
            Some(step) => Composition::ALL.into_iter().map(|c| (Answering::Steps(c), step(c))).collect(),
        };
        let reached = motions.iter().filter_map(|(_, motion)| motion.as_ref().ok());
        // one reference for all, as far as the one that comes furthest
        let furthest = reached.map(|motion| (motion.start(), motion.end())).max_by(|a, b| a.1.total_cmp(&b.1));
        let mut known = match furthest {
            Some((start, end)) => Some(
                self.reference
                    .up_to(start, end)
                    .map_err(anyhow::Error::msg)
                    .with_context(|| format!("{case}, {}", self.point))?,
            ),
            None => None,
        };
        let mut cells = Vec::with_capacity(motions.len());
        for (method, motion) in &mut motions {
            let steps = motion.as_ref().map_or(0, |motion| motion.work.steps);
            let verdict = match (motion, &subject, &mut known) {
                (Ok(motion), Ok(subject), Some(known)) => self.judged(motion, subject, known, *method)?,
                (Err(cause), ..) => Verdict::Refused { t: None, cause: cause.clone() },
                (_, Err(cause), _) => Verdict::Refused { t: None, cause: cause.clone() },
                (Ok(_), Ok(_), None) => unreachable!("there is a reference where there is a motion"),
            };
            let (point, formulation) = (self.point, self.formulation.clone());
            cells.push(Cell { case, point, formulation, method: *method, verdict, steps });
        }
        Ok(cells)
    }

    fn judged(&self, motion: &mut Motion, subject: &Subject, known: &mut Known, by: Answering) -> Result<Verdict> {
        let allowance = by.allowance(self.compared, self.each, subject.end);
        let refused = |error: motion::SolveError| Verdict::Refused { t: None, cause: error.to_string() };
        Ok(judge(motion, &mut Metric::new(&subject.measured)?, known, allowance).unwrap_or_else(refused))
    }
}

fn motion(subject: &Result<Subject, String>, by: Answering) -> Result<Motion, String> {
    let Answering::Method(method) = by else { return Err("equal steps are not asked for by a method".into()) };
    let Subject { system, start, end, equations, constants, choice, .. } = subject.as_ref().map_err(Clone::clone)?;
    let settings = Settings { tolerance: tolerance(method), method, max_steps: MAX_STEPS, ..Settings::default() };
    let setting = Setting { system, start, end: *end };
    let motion = match (choice, method) {
        (Some(choice), None) => solve_from(setting, choice, &settings),
        _ => solve(setting, equations.clone(), constants, &settings),
    };
    motion.map_err(|error| error.to_string())
}
