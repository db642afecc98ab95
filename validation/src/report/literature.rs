//! The page about published claims and questions: what was computed, and the word that follows for a claim.

use equations::Formulation;
use std::collections::{BTreeMap, HashMap};

use anyhow::{Context, Result, ensure};
use motion::band::SAMPLES;
use motion::{CHETAEV, Settings, choices, formulation, solve_choice};
use program::parallel;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::Value;

use crate::report::equivalence::{Asked, Found, Written};
use comparison::words::short;
use pages::{DataPackage, Table};
use program::File;

const DATA: &str = include_str!("../../equivalence/pages/claims.toml");

/// The word for a question, which has no verdict.
const ANSWERED: &str = "answered";

#[derive(Deserialize)]
struct Data {
    /// The paragraphs before the claims.
    #[serde(default)]
    about: String,
    claim: Vec<Claim>,
}

#[derive(Deserialize)]
struct Claim {
    source: String,
    /// Its key in `docs/references.bib`, if its entry was confirmed.
    key: Option<String>,
    /// What was read of it.
    read: String,
    about: String,
    /// What the source says. Of a source that was not read there is a question instead, which has no word.
    #[serde(default)]
    says: String,
    question: Option<String>,
    /// The full statement was read, not an abstract or what is remembered.
    #[serde(default)]
    in_full: bool,
    /// The word that the computation is expected to lead to.
    word: String,
    /// The condition under which the claim holds, where it does not hold throughout.
    condition: Option<String>,
    /// Why nothing was computed, or what else is to be said.
    #[serde(default)]
    remark: String,
    #[serde(default)]
    case: Vec<Case>,
}

/// A prediction of the claim.
#[derive(Deserialize)]
struct Case {
    #[serde(flatten)]
    asked: Asked,
    /// Asked of almost every start, instead of the scene's.
    #[serde(default)]
    almost_every_start: bool,
    /// What the claim says of it; of a quantity, that it stays between the bounds.
    #[serde(default = "yes")]
    claimed: String,
    along: Option<Along>,
    /// Asked is whether Lagrange's equations of `L` with the constraint put into it have Chetaev's motion.
    #[serde(default)]
    put_in: bool,
    /// The condition of the claim does not hold here.
    #[serde(default)]
    outside: bool,
}

fn named<'de, D: Deserializer<'de>>(from: D) -> Result<&'static Formulation, D::Error> {
    formulation(&String::deserialize(from)?).map_err(D::Error::custom)
}

/// A quantity along a motion.
#[derive(Deserialize)]
struct Along {
    #[serde(deserialize_with = "named")]
    formulation: &'static Formulation,
    /// An expression in coordinates, velocities, parameters and `t`.
    quantity: String,
    during: [f64; 2],
    between: [f64; 2],
}

fn yes() -> String {
    "yes".into()
}

impl Case {
    fn found(&self) -> Result<Found> {
        if self.put_in {
            return self.found_put_in();
        }
        let Some(along) = &self.along else {
            let [here, almost_everywhere] = self.asked.found(&BTreeMap::new())?;
            return Ok(if self.almost_every_start { almost_everywhere } else { here });
        };
        let [from, to] = along.during;
        let scene = self.asked.scene(&BTreeMap::from([("duration".into(), Written(to.into()))]))?;
        let choice = choices(&scene).into_iter().find(|choice| choice.formulation == along.formulation);
        let mut motion = solve_choice(&scene, &choice.context("no such formulation")?, &Settings::default())?;
        let (system, g) = (&scene.system, &scene.system.graph);
        let inputs: Vec<_> = [&[system.time][..], &system.positions(), &system.velocities()].concat();
        let names: HashMap<String, _> =
            system.parameters.iter().map(|p| p.symbol).chain(inputs.clone()).map(|s| (g.name(s), s)).collect();
        let quantity = g.parse(&along.quantity, &|name: &str| names.get(name).map(|&s| g.variable(s)))?;
        let mut evaluator = system.evaluator::<f64>(&inputs, &[quantity])?;
        let mut inside = motion.is_complete();
        for i in 0..=SAMPLES {
            let t = scene.start.t + from + (to - from) * i as f64 / SAMPLES as f64;
            let at = motion.at(t.min(motion.end()))?;
            let value = evaluator.evaluate(&[&[t][..], &at.coordinates, &at.velocities].concat())[0];
            inside &= (along.between[0]..=along.between[1]).contains(&value);
        }
        Ok(Found::new(if inside { "yes" } else { "no" }, "integrated"))
    }

    /// Whether the control has Chetaev's motion, up to the end.
    fn found_put_in(&self) -> Result<Found> {
        let scene = self.asked.scene(&BTreeMap::new())?;
        let (choices, settings) = (choices(&scene), Settings::default());
        let chetaev = choices.iter().find(|choice| choice.formulation == CHETAEV).context("no such formulation")?;
        let control = review::substitution::run(&scene, &choices, &settings).context("no control")?;
        let [mut one, mut other] = [solve_choice(&scene, chetaev, &settings)?, control.outcome?];
        let end = scene.start.t + scene.duration;
        ensure!(one.end() >= end && other.end() >= end, "a motion ends before {end}");
        let mut apart = 0.0_f64;
        for i in 0..=SAMPLES {
            let t = scene.start.t + scene.duration * i as f64 / SAMPLES as f64;
            let [one, other] = [one.at(t.min(end))?, other.at(t.min(end))?].map(|at| at.coordinates);
            let size = one.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
            apart = one.iter().zip(&other).fold(apart, |a, (x, y)| a.max((x - y).abs() / size));
        }
        let how = format!("integrated, {} apart", if apart < 1e-7 { "under 1e-7".into() } else { short(apart) });
        Ok(Found::new(if apart < 1e-7 { "yes" } else { "no" }, how))
    }

    /// What is asked.
    fn question(&self) -> String {
        let link = self.asked.link();
        match &self.along {
            None if self.put_in => {
                format!("{link}: does $L$ give Chetaev's motion after the constraint is substituted into it?")
            }
            None if self.almost_every_start => format!("{link}: almost every start"),
            None => format!("{link}: this start"),
            Some(Along { formulation: Formulation { name, .. }, quantity, during: [from, to], between }) => {
                let [low, high] = between.map(short);
                format!("{link}, {name}: from {from} s to {to} s {low} ≤ `{quantity}` ≤ {high}")
            }
        }
    }
}

impl Claim {
    /// *confirmed*: found as claimed throughout; *qualified*: just where the condition holds; *contradicted*:
    /// not throughout, in the reading given; *refuted*: not so, and the full statement was read; *open*:
    /// nothing to compute.
    fn follows(&self, found: &[Found]) -> &'static str {
        let as_claimed: Vec<bool> = self.case.iter().zip(found).map(|(case, found)| found.is(&case.claimed)).collect();
        let by_condition = || self.case.iter().zip(&as_claimed).all(|(case, yes)| *yes != case.outside);
        if as_claimed.is_empty() {
            "open"
        } else if as_claimed.iter().all(|yes| *yes) {
            "confirmed"
        } else if self.condition.is_some() && by_condition() {
            "qualified"
        } else if self.in_full {
            "refuted"
        } else {
            "contradicted"
        }
    }

    /// What the page says of it.
    fn word(&self) -> &str {
        if self.question.is_some() { ANSWERED } else { &self.word }
    }

    /// What was computed, which leads to the word.
    fn found(&self) -> Result<Vec<Found>> {
        let found = self.case.iter().map(Case::found).collect::<Result<Vec<_>>>();
        let found = found.with_context(|| format!("claim of {}", self.source))?;
        let (word, source) = (self.follows(&found), &self.source);
        // a remark says of how it is known what is computed
        for said in ["identity", "proved"] {
            let is_so = !self.remark.contains(said) || found.iter().any(|found| found.to_string().contains(said));
            ensure!(is_so, "claim of {source}: `{said}` in the remark, which is found of none of its cases: {found:?}");
        }
        ensure!(word == self.word, "claim of {source}: {} was expected, it is {word}: {found:?}", self.word);
        Ok(found)
    }
}

/// Published claims with what was computed about them.
pub struct LiteratureReport {
    about: String,
    claims: Vec<Claim>,
    found: Vec<Vec<Found>>,
}

impl LiteratureReport {
    /// Computes what every claim predicts.
    ///
    /// # Errors
    /// Where something cannot be computed, or does not lead to the word that the claim's data expect.
    pub fn new(quiet: bool) -> Result<LiteratureReport> {
        LiteratureReport::of(DATA, quiet)
    }

    /// The same for other claims, in TOML.
    ///
    /// # Errors
    /// As [`LiteratureReport::new`], and for data that cannot be read.
    pub fn of(data: &str, quiet: bool) -> Result<LiteratureReport> {
        let Data { about, claim: claims } = toml::from_str(data).context("equivalence/pages/claims.toml")?;
        let found = parallel::try_map(&claims, quiet, |claim| claim.source.clone(), Claim::found)?;
        Ok(LiteratureReport { about, claims, found })
    }

    /// The first line of the page.
    pub fn headline(&self) -> String {
        let count = |word: &str| self.claims.iter().filter(|claim| claim.word() == word).count();
        let words = ["confirmed", "qualified", "contradicted", "refuted"].map(|word| (word, count(word)));
        let found: Vec<String> = words.iter().filter(|(_, n)| *n > 0).map(|(word, n)| format!("{n} {word}")).collect();
        let (claims, questions, open) = (words.iter().map(|(_, n)| n).sum::<usize>(), count(ANSWERED), count("open"));
        let all = self.claims.len();
        format!(
            "Of {all} entries from the literature, {claims} are claims that were computed after their abstract was read: {}. For {questions} \
             entries a question is answered for the systems named, without a verdict on the source. {open} entries were not computed.",
            found.join(", ")
        )
    }

    /// The words for machines.
    pub fn verdicts(&self) -> Value {
        let word = |claim: &Claim| (format!("{}: {}", claim.source, claim.about), claim.word().into());
        Value::Object(self.claims.iter().map(word).collect())
    }

    /// The page and its tables.
    pub fn files(&self) -> Vec<File> {
        let mut shown = Table::new([">", "source", "about", "word"]);
        let columns = [">claim", "source", "what was read", "about", "says", "word", "condition", "remark"];
        let (mut all, mut cases) = (Table::new(columns), Table::new([">claim", "asked", "the claim says", "found"]));
        for ((claim, found), i) in self.claims.iter().zip(&self.found).zip(1..) {
            let Claim { source, read, about, remark, condition, .. } = claim;
            let (says, word) = (claim.question.as_ref().unwrap_or(&claim.says), claim.word());
            let cited = claim.key.as_ref().map(|key| format!("[{source}](../../docs/references.bib#{key})"));
            shown.row(&[&i, cited.as_ref().unwrap_or(source), about, &format!("**{word}**")]);
            let condition = condition.as_deref().unwrap_or_default();
            let read = read.trim_matches(['*', '(', ')']);
            all.row(&[&i, source, &read, about, says, &word, &condition, remark]);
            for (case, found) in claim.case.iter().zip(found) {
                cases.row(&[&i, &case.question(), &case.claimed, found]);
            }
        }
        let mut data = DataPackage::new("data/literature", "Published claims and what was computed about them");
        data.table("claims", "What each source says, the word that follows and why", &all);
        data.table("cases", "What was computed for each claim", &cases);
        let text = format!(
            "# Published claims, computed\n\n**{}**\n\n{}\n{shown}\n## Data\n\n{}",
            self.headline(),
            self.about,
            data.list(1)
        );
        [File { path: "evidence/literature.md".into(), text }].into_iter().chain(data.files()).collect()
    }
}
