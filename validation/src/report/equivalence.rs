//! The page of classic systems: is Chetaev's motion vakonomic, at almost every and at exceptional starts?

use std::collections::BTreeMap;
use std::fmt;

use anyhow::{Context, Result, ensure};
use comparison::{Answer, Contradicted, Finding, Membership, Pairing, Section, membership};
use mechanics::Removal;
use motion::{VAKONOMIC, choices};
use program::parallel;
use scene::{Number, Scene};
use serde::Deserialize;
use serde_json::Value;

use crate::report::folder_of;
use comparison::words::short;
use pages::{DataPackage, Table};
use program::File;
use scene::catalogue::CLASSICS;

const DATA: &str = include_str!("../../equivalence/pages/systems.toml");

/// A decimal, or a formula.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "toml::Value")]
pub(super) struct Written(pub(super) Number);

impl TryFrom<toml::Value> for Written {
    type Error = String;

    fn try_from(value: toml::Value) -> Result<Self, String> {
        match value {
            toml::Value::Integer(n) => Ok(Written((n as f64).into())),
            toml::Value::Float(x) => Ok(Written(x.into())),
            toml::Value::String(text) => text.parse().map(Written).map_err(|error| format!("`{text}`: {error}")),
            other => Err(format!("{other:?} is no number")),
        }
    }
}

/// Whose motion is asked about: a scene with other numbers.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Asked {
    pub(super) scene: String,
    #[serde(default)]
    set: BTreeMap<String, Written>,
    /// The motion with the constraint put into `L`, instead of Chetaev's.
    #[serde(default)]
    control: bool,
}

impl Asked {
    /// The scene with what `set` adds.
    pub(super) fn scene(&self, set: &BTreeMap<String, Written>) -> Result<Scene> {
        let numbers: Vec<_> = self.set.iter().chain(set).map(|(name, value)| (name.clone(), value.0.clone())).collect();
        scene::catalogue::find(&self.scene, &numbers).with_context(|| format!("scene `{}`", self.scene))
    }

    /// What is found at this start, and at almost every one.
    pub(super) fn found(&self, set: &BTreeMap<String, Written>) -> Result<[Found; 2]> {
        let scene = self.scene(set)?;
        let end = scene.start.t + scene.duration;
        let found = if self.control {
            let removal = Removal::by_coordinates(&scene.system, &scene.start)?;
            let curve = review::substitution::derive(&scene.system, &removal);
            let constants = vec![0.0; curve.free_constants.len()];
            let vakonomic = choices(&scene).into_iter().find(|choice| choice.formulation == VAKONOMIC);
            let family = vakonomic.context("no vakonomic formulation")?;
            Pairing::with_curve(&scene, curve, constants, &family).and_then(|pairing| pairing.decide(end)).map(Some)
        } else {
            membership(&scene, end)
        };
        let what = || format!("scene `{}` with {:?} {set:?}", self.scene, self.set);
        let membership = found.with_context(what)?.with_context(what)?;
        membership.contradiction().map_or(Ok(()), |found| Err(Contradicted(vec![format!("{}: {found}", what())])))?;
        Ok([Found::here(&membership), Found::almost_everywhere(&membership)])
    }

    /// The scene as a link from the pages of evidence, with its numbers.
    pub(super) fn link(&self) -> String {
        let name = &self.scene;
        let classic = CLASSICS.iter().any(|(known, _)| known == name);
        let page = if classic {
            format!("../../crates/scene/classics/{name}.toml")
        } else {
            format!("../{}/{name}.md", folder_of(name))
        };
        let numbers = if self.set.is_empty() { String::new() } else { format!(", {}", numbers(&self.set)) };
        let control = if self.control { ", the constraint put into $L$" } else { "" };
        format!("[{name}]({page}){numbers}{control}")
    }
}

/// `phi = 0, phi' = 1`.
fn numbers(set: &BTreeMap<String, Written>) -> String {
    set.iter().map(|(name, value)| format!("`{name} = {}`", value.0)).collect::<Vec<_>>().join(", ")
}

/// The set of multipliers in a word, and how it is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Found {
    pub(super) what: String,
    how: String,
}

impl Found {
    pub(super) fn new(what: &str, how: impl Into<String>) -> Found {
        Found { what: what.into(), how: how.into() }
    }

    fn here(membership: &Membership) -> Found {
        let set = &membership.decision.set;
        let (rank, how) = match (&membership.proof.this_start, membership.answer()) {
            (Finding::None(found), _) => return none(found.order, found.full_rank),
            (_, Answer::None { unproved }) => return Found::new("none", format!("in floating point: {unproved}")),
            (_, Answer::Undecided) => return Found::new("undecided", "round-off"),
            (Finding::Contained { rank, .. } | Finding::ThroughOrder { rank, .. }, Answer::SomeProved) => {
                (*rank, membership.theorem.unwrap_or("identity").into())
            }
            (Finding::Contained { rank, .. }, _) => (*rank, SETTLED.into()),
            (Finding::ThroughOrder { rank, order }, _) => (*rank, format!("through order {order}")),
            (Finding::NotApplicable(_), _) => (set.point.len() - set.dimension(), "in floating point".into()),
        };
        // round-off is not printed
        let point = set.point.iter().map(|&c| short(if c.abs() < 1e-6 { 0.0 } else { c })).collect();
        let what = of_rank(rank, set.point.len());
        let how = how + regular(&what, membership);
        let point = if what == "one" { format!(", $\\mu_0 = {}$", vector(point)) } else { String::new() };
        Found { what, how: how + &point }
    }

    fn almost_everywhere(membership: &Membership) -> Found {
        let proof = &membership.proof;
        match (&proof.almost_every_start, &proof.this_start, &membership.section) {
            // a minor that is not zero at one start is zero almost nowhere
            (Finding::None(found), ..) | (Finding::NotApplicable(_), Finding::None(found), _) => {
                none(found.order, found.full_rank)
            }
            (Finding::Contained { rank, .. }, _, section) => {
                let identity = |section: &Section| {
                    let how = if section.proved { "identity" } else { "at random starts modulo two primes" };
                    format!("{how}, `{}`", vector(section.expressions.clone()))
                };
                let how = section.as_ref().map_or_else(|| membership.theorem.unwrap_or(SETTLED).into(), identity);
                let what = of_rank(*rank, membership.decision.constants.len());
                Found { how: how + regular(&what, membership), what }
            }
            (Finding::NotApplicable(reason), ..) => Found::new("open", reason.clone()),
            (Finding::ThroughOrder { .. }, ..) => Found::new("open", "ranks did not settle"),
        }
    }

    /// Whether this is what was said: `none`, `some`, `one`, `every one`, `dimension 1`.
    pub(super) fn is(&self, said: &str) -> bool {
        self.what == said || (said == "some" && !["none", "undecided", "open"].contains(&&self.what[..]))
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "**{}**: {}", self.what, self.how)
    }
}

fn none(order: usize, minor: bool) -> Found {
    Found::new("none", format!("{} (order {order})", if minor { "proved" } else { "ranks mod p" }))
}

/// `(a, b)`, `a`, or `0` for a vector of zeros.
fn vector(entries: Vec<String>) -> String {
    match &entries[..] {
        all if all.iter().all(|x| x == "0") => "0".into(),
        [one] => one.clone(),
        _ => format!("({})", entries.join(", ")),
    }
}

/// Why later coefficients need not be looked at.
const SETTLED: &str = "ranks mod p grow no more";

fn of_rank(rank: usize, constants: usize) -> String {
    match constants - rank {
        0 => "one".into(),
        d if d == constants => "every one".into(),
        d => format!("dimension {d}"),
    }
}

/// What has to be said of *every one*.
fn regular(what: &str, membership: &Membership) -> &'static str {
    if membership.where_regular && what == "every one" { ", with regular equations" } else { "" }
}

#[derive(Deserialize)]
struct Data {
    /// The paragraphs before the table.
    #[serde(default)]
    about: String,
    system: Vec<System>,
}

#[derive(Deserialize)]
struct System {
    #[serde(flatten)]
    asked: Asked,
    title: Option<String>,
    /// All that is known of exceptional starts.
    exceptions: String,
    /// What was published, where, and whether that was read.
    literature: Option<String>,
    start: Vec<Start>,
}

/// A start, and what is expected of it.
#[derive(Deserialize)]
struct Start {
    at: String,
    set: BTreeMap<String, Written>,
    is: String,
}

/// What was found about one system: at almost every start, at that of the scene, and at further ones.
struct Row {
    title: String,
    size: [usize; 2],
    almost_everywhere: Found,
    starts: Vec<Found>,
}

impl Row {
    fn new(system: &System) -> Result<Row> {
        let scene = system.asked.scene(&BTreeMap::new())?;
        let [here, almost_everywhere] = system.asked.found(&BTreeMap::new())?;
        let mut starts = vec![here];
        for Start { set, is, .. } in &system.start {
            let [found, _] = system.asked.found(set)?;
            ensure!(found.is(is), "scene `{}`, {set:?}: {is} was expected, {found} was found", scene.name);
            starts.push(found);
        }
        let title = system.title.clone().unwrap_or(scene.title);
        let size = [scene.system.dimension(), scene.system.constraints.len()];
        Ok(Row { title, size, almost_everywhere, starts })
    }
}

/// Decisions about classic systems.
pub struct EquivalenceReport {
    data: Data,
    rows: Vec<Row>,
}

impl EquivalenceReport {
    /// Decides every system at every start.
    ///
    /// # Errors
    /// Where a scene cannot be decided, or the finding is not what the page's data say about a start.
    pub fn new(quiet: bool) -> Result<EquivalenceReport> {
        EquivalenceReport::of(DATA, quiet)
    }

    /// The same for other data, in TOML.
    ///
    /// # Errors
    /// As [`EquivalenceReport::new`], and for data that cannot be read.
    pub fn of(data: &str, quiet: bool) -> Result<EquivalenceReport> {
        let data: Data = toml::from_str(data).context("equivalence/pages/systems.toml")?;
        let name = |system: &System| system.asked.scene.clone();
        let rows = parallel::try_map(&data.system, quiet, name, Row::new)?;
        Ok(EquivalenceReport { data, rows })
    }

    /// The first line of the page.
    pub fn headline(&self) -> String {
        let [none, one, every, some, open] = ["none", "one", "every one", "some", "open"]
            .map(|what| self.rows.iter().filter(|row| row.almost_everywhere.is(what)).count());
        let more = some - one - every;
        let starts: usize = self.data.system.iter().map(|system| system.start.len()).sum();
        let open = if open == 0 { String::new() } else { format!("; {open} open") };
        format!(
            "For {none} of {} classic systems and variants no initial multipliers $\\mu_0$ make the vakonomic motion Chetaev's, at almost \
             every start; for {one} one $\\mu_0$ does, for {more} a set of dimension 1 or more, for {every} every $\\mu_0${open}. In addition \
             {starts} starts on and next to the exceptional ones are decided.",
            self.rows.len()
        )
    }

    /// The findings for machines.
    pub fn verdicts(&self) -> Value {
        let words = |found: &Found| Value::from(format!("{}: {}", found.what, found.how));
        let value = |(system, row): (&System, &Row)| {
            let names = system.start.iter().map(|start| numbers(&start.set).replace('`', ""));
            let names = ["almost every start".into(), "start of the scene".into()].into_iter().chain(names);
            let found = [&row.almost_everywhere].into_iter().chain(&row.starts).map(words);
            (row.title.clone(), names.zip(found).collect())
        };
        Value::Object(self.data.system.iter().zip(&self.rows).map(value).collect())
    }

    /// The page and its tables.
    pub fn files(&self) -> Vec<File> {
        let systems = || self.data.system.iter().zip(&self.rows);
        let columns = ["system", "scene", ">n", ">h", "almost every start", "start of the scene", "exceptional starts"];
        let mut all = Table::new(columns.into_iter().chain(["published"]));
        let mut shown = Table::new(["system", ">n", ">h", "$\\mu_0$, almost every start", "how this is known"]);
        let mut starts = Table::new(["system", "start", "numbers", "found"]);
        for (system, row) in systems() {
            let ([n, h], (everywhere, here)) = (row.size, (&row.almost_everywhere, &row.starts[0]));
            let published = system.literature.as_deref().unwrap_or_default();
            all.row(&[&row.title, &system.asked.link(), &n, &h, everywhere, here, &system.exceptions, &published]);
            // formulas stand in the table of all
            let how = everywhere.how.split(", `").next().unwrap_or_default();
            shown.row(&[&row.title, &n, &h, &everywhere.what, &how]);
            for (start, found) in system.start.iter().zip(&row.starts[1..]) {
                starts.row(&[&row.title, &start.at, &numbers(&start.set), found]);
            }
        }
        let mut data = DataPackage::new("data/equivalence", "Which motions of classic systems are vakonomic");
        data.table("systems", "All systems, with exceptional starts and what was published", &all);
        data.table("starts", "Starts decided one by one", &starts);
        let text = format!(
            "# Which motions of classic systems are vakonomic?\n\n**{}**\n\n{}\n{shown}\n## Data\n\n{}",
            self.headline(),
            self.data.about,
            data.list(1)
        );
        [File { path: "evidence/equivalence.md".into(), text }].into_iter().chain(data.files()).collect()
    }
}
