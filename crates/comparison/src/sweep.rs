//! One point of a sweep: where two motions of a scene part, and whether they have to.

use equations::Formulation;
use mechanics::ConstantsRule;
use scene::{Number, Scene};
use symbolic::caught;

use crate::{Answer, Comparison, Extent, Membership, THRESHOLDS, Verdict};
use motion::{
    CHETAEV, Choice, Costates, FORMULATIONS, REMOVED_CONSTRAINT, Settings, SolveError, VAKONOMIC, choices,
    choices_among, is_costate,
};

/// The comparison of two motions at one point of a sweep.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweepPoint {
    /// `same`, `different` or `undecided`; empty where one has no motion.
    pub verdict: &'static str,
    /// First time at which the gap passes 1e-3, over the start time.
    pub apart: Option<f64>,
    /// Largest gap, in the kinetic metric.
    pub largest: Option<f64>,
    /// Limit above which a gap is certain, at the end.
    pub limit: Option<f64>,
    /// Whether some constants make the second motion the first, `μ₀` the vakonomic one Chetaev's: `some`,
    /// `none` or `undecided`, with ` proved`. Empty where the table asks nothing of the two.
    pub answer: &'static str,
    /// The order of the Taylor coefficient that proves there is none.
    pub order: Option<usize>,
    /// Dimension of the set of such constants.
    pub dimension: Option<usize>,
    /// Least mismatch of accelerations over the motion's own, ρ.
    pub mismatch: Option<f64>,
    /// Why there is no verdict or no answer.
    pub cause: String,
}

/// One scene with other numbers in some places: two of its motions, compared at each choice of them.
///
/// ```
/// # let text = include_str!("../../scene/sledge.toml");
/// use comparison::Sweep;
/// use motion::Settings;
/// let names = ["phi".to_string()];
/// let sweep = Sweep::new::<f64>("sledge", text, &[], &names, None, &Settings::default())?;
/// assert_eq!(sweep.point(&[0.5]).answer, "none proved");
/// # Ok::<(), motion::SolveError>(())
/// ```
#[derive(Clone)]
pub struct Sweep {
    name: String,
    text: String,
    overrides: Vec<(String, Number)>,
    names: Vec<String>,
    /// In the order of the table.
    formulations: [&'static Formulation; 2],
    extent: Extent,
    settings: Settings,
}

impl Sweep {
    /// A sweep over `names`: parameters, start values, multipliers `mu0_1`, …, as in [`Scene::parse_with`],
    /// and costates `P0_w` of the first removal. What is compared are two `formulations`; if none are named
    /// Chetaev's and the vakonomic one or, where costates vary, the one without constraints.
    ///
    /// # Errors
    /// [`SolveError::Scene`], [`SolveError::Member`] where a name means nothing, as far as the scene tells.
    pub fn new<N: Clone + Into<Number>>(
        name: &str,
        text: &str,
        overrides: &[(String, N)],
        names: &[String],
        formulations: Option<[&'static Formulation; 2]>,
        settings: &Settings,
    ) -> Result<Sweep, SolveError> {
        settings.check()?;
        let usual = || {
            let costates = names.iter().any(|name| is_costate(name));
            [CHETAEV, if costates { REMOVED_CONSTRAINT } else { VAKONOMIC }]
        };
        let overrides = overrides.iter().map(|(name, x)| (name.clone(), x.clone().into())).collect();
        let (name, text, names) = (name.into(), text.into(), names.to_vec());
        let mut formulations = formulations.unwrap_or_else(usual);
        formulations.sort_by_key(|own| FORMULATIONS.iter().position(|entry| entry == own));
        let sweep = Sweep {
            name,
            text,
            overrides,
            names,
            formulations,
            extent: Extent::Everything,
            settings: settings.clone(),
        };
        let scene = sweep.read(&[])?;
        let (costates, others): (Vec<&str>, Vec<&str>) =
            sweep.names.iter().map(String::as_str).partition(|name| is_costate(name));
        let twice = (1..others.len()).find(|&i| others[..i].contains(&others[i]));
        if let Some(i) = twice {
            return Err(refused(format!("`{}` varies twice", others[i])));
        }
        scene.starts(&others).map_err(|error| SolveError::Scene(Box::new(error)))?;
        let zero: Vec<(String, f64)> = costates.iter().map(|name| (name.to_string(), 0.0)).collect();
        sweep.choices(&scene, &zero)?;
        Ok(sweep)
    }

    /// The same with gaps and verdicts alone: [`SweepPoint::answer`] and what belongs to it stay empty, and
    /// no verdict is proved.
    pub fn without_decision(self) -> Sweep {
        Sweep { extent: Extent::Gaps, ..self }
    }

    /// The comparison for these numbers, one per name; it depends on nothing else.
    ///
    /// # Panics
    /// If there are not as many numbers as names.
    pub fn point(&self, values: &[f64]) -> SweepPoint {
        assert_eq!(values.len(), self.names.len(), "numbers of a point");
        let mut point = SweepPoint::default();
        let given = self.names.iter().cloned().zip(values.iter().copied());
        let (costates, others): (Vec<_>, Vec<_>) = given.partition(|(name, _)| is_costate(name));
        let work = || self.read(&others).and_then(|scene| self.fill(&mut point, scene, &costates));
        if let Err(error) = caught("row", work).unwrap_or_else(|broken| Err(broken.into())) {
            // a fault of the text stands on several lines
            point.cause = error.to_string().lines().next().unwrap_or_default().into();
        }
        point
    }

    /// Titles of the two formulations, in the order in which they are compared.
    pub fn titles(&self) -> [&'static str; 2] {
        self.formulations.map(|own| own.title)
    }

    fn read(&self, others: &[(String, f64)]) -> Result<Scene, SolveError> {
        let others = others.iter().map(|(name, x)| (name.clone(), Number::from(*x)));
        let all: Vec<_> = self.overrides.iter().cloned().chain(others).collect();
        let scene = Scene::parse_with(&self.name, &self.text, &all);
        scene.map_err(|error| SolveError::Scene(Box::new(error)))
    }

    /// The two choices for a scene; of several removals the first.
    fn choices(&self, scene: &Scene, costates: &[(String, f64)]) -> Result<[Choice; 2], SolveError> {
        let [first, second] = self.formulations;
        let of = |own: &Formulation| choices_among(scene, |known| known == own).into_iter().next();
        let (Some(one), Some(two), true) = (of(first), of(second), first != second) else {
            let mut known: Vec<_> = choices(scene).iter().map(|choice| choice.formulation.name).collect();
            known.dedup();
            return Err(refused(format!(
                "{}, {}: two of {} can be compared",
                first.name,
                second.name,
                known.join(", ")
            )));
        };
        let mut choices = [one, two];
        if !costates.is_empty() {
            let names: Vec<&str> = costates.iter().map(|(name, _)| name.as_str()).collect();
            let values: Vec<f64> = costates.iter().map(|(_, value)| *value).collect();
            let Some(choice) = choices.iter_mut().find(|choice| choice.removal.is_some()) else {
                return Err(refused(format!("{} vary, and no removal is compared", names.join(", "))));
            };
            let (costates, _) = Costates::among(&names, scene, choice).map_err(refused)?;
            choice.constants = ConstantsRule::Given(costates.split(&values).0.unwrap_or_default());
        }
        Ok(choices)
    }

    fn fill(&self, point: &mut SweepPoint, scene: Scene, costates: &[(String, f64)]) -> Result<(), SolveError> {
        let start = scene.start.t;
        let choices = self.choices(&scene, costates)?;
        let mut comparison = Comparison::new(scene, self.extent, &self.settings)?;
        for choice in choices {
            comparison.solve(choice, &self.settings)?;
        }
        if let Some(Err(error)) = comparison.runs.iter().map(|run| &run.outcome).find(|outcome| outcome.is_err()) {
            point.cause = error.to_string();
        }
        if let Some(pair) = comparison.pairs.first() {
            let gap = &pair.gap;
            point.verdict = gap.verdict.word();
            if let Verdict::Undecided { because } = &gap.verdict {
                point.cause.clone_from(because);
            }
            point.apart = THRESHOLDS.iter().position(|&at| at == 1e-3).and_then(|i| gap.passes[i]).map(|t| t - start);
            point.largest = Some(gap.largest);
            point.limit = gap.points.last().map(|last| last.limit);
        }
        match comparison.decide_next().map(|decided| &decided.outcome) {
            None => {}
            Some(Err(error)) => point.cause = error.to_string(),
            Some(Ok(membership)) => decided(point, membership),
        }
        Ok(())
    }
}

fn refused(reason: String) -> SolveError {
    SolveError::Member { reason }
}

fn decided(point: &mut SweepPoint, membership: &Membership) {
    let decision = &membership.decision;
    point.answer = match membership.answer() {
        Answer::NoneProved { order } => {
            point.order = Some(order);
            "none proved"
        }
        Answer::None { .. } => "none",
        Answer::SomeProved => "some proved",
        Answer::Some { .. } => "some",
        Answer::Undecided => "undecided",
    };
    point.dimension = point.answer.starts_with("some").then(|| membership.dimension());
    point.mismatch = Some(decision.least / decision.acceleration).filter(|mismatch| mismatch.is_finite());
}
