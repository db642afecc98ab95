//! The page on measures and integrals: the catalogue, what is known from the literature, maps.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use equations::Formulation;
use integrals::{Found, Integrals, Measure, Multiplier, Open, Reduction, Reversed, reversible_scene};
use motion::{CHETAEV, Choice, VAKONOMIC, default_constants};
use pages::{DataPackage, Table};
use picture::{Axis, HeatMap};
use program::{File, parallel};
use scene::{Number, Scene};
use serde::Deserialize;

/// Coordinates up to which quadratic integrals are asked for: of more they take long.
const QUADRATIC: usize = 4;

/// What is known of a system.
#[derive(Clone, Debug, Deserialize)]
pub struct Entry {
    /// What it is called here.
    pub name: String,
    /// A built-in scene, or a file beside the table.
    pub scene: String,
    /// Numbers that are set.
    #[serde(default)]
    pub set: BTreeMap<String, f64>,
    /// What is known.
    pub claim: String,
    /// From where.
    pub source: String,
    /// Whether there is a measure: some, none, or open where the program does not decide.
    pub measure: String,
    /// Chaplygin's multiplier over the coordinates whose velocities the constraints leave free: some or none.
    pub multiplier: Option<String>,
    /// Independent integrals linear in the velocities.
    pub linear: Option<usize>,
}

#[derive(Deserialize)]
struct Literature {
    entry: Vec<Entry>,
}

/// `validation/integrals`.
pub fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/integrals"))
}

/// The table of the literature.
///
/// # Errors
/// A file that is not as it should be.
pub fn literature() -> Result<Vec<Entry>> {
    let path = folder().join("literature.toml");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    Ok(toml::from_str::<Literature>(&text).with_context(|| path.display().to_string())?.entry)
}

impl Entry {
    /// Its scene, with its numbers.
    ///
    /// # Errors
    /// A scene that is not there, or a number that is none.
    pub fn scene(&self) -> Result<Scene> {
        with_numbers(&self.scene, &self.set)
    }

    /// What the program says, and whether it is what is known; `None`: it leaves a question open.
    ///
    /// # Errors
    /// As [`Entry::scene`].
    pub fn compared(&self) -> Result<(Reversed, Option<bool>)> {
        let found = reversible_scene(&self.scene()?, 1)?;
        let measure = match &found.measure {
            Measure::None { .. } => "none",
            Measure::Local { .. } => "some",
            Measure::Open(_) => "open",
        };
        let linear = found.integrals.first().and_then(|found| found.as_ref().ok()).filter(|found| settled(found));
        let counts = self.linear.zip(linear).is_none_or(|(known, found)| known == found.count);
        let multipliers = match (&self.multiplier, &found.reductions) {
            (None, _) => true,
            (Some(known), Ok(found)) => {
                let has_one = |found: &Reduction| found.multiplier != Multiplier::None;
                !found.is_empty() && found.iter().any(has_one) == (known == "some")
            }
            (Some(_), Err(_)) => false,
        };
        let agrees = match (measure, &self.measure[..]) {
            ("open", _) => None,
            (one, other) => Some(one == other && counts && multipliers),
        };
        Ok((found, agrees))
    }
}

fn settled(found: &Found) -> bool {
    found.settled || found.none_proved()
}

/// A built-in scene, or a file beside the table, with these numbers.
fn with_numbers(scene: &str, set: &BTreeMap<String, f64>) -> Result<Scene> {
    let set: Vec<(String, Number)> = set.iter().map(|(name, &x)| (name.clone(), Number::from(x))).collect();
    let file = folder().join(scene).display().to_string();
    Ok(scene::catalogue::find(if scene.ends_with(".toml") { &file } else { scene }, &set)?)
}

/// A map over two numbers of a scene: how many integrals are linear, and where there is a measure.
struct Map {
    name: &'static str,
    scene: &'static str,
    set: &'static [(&'static str, f64)],
    x: (&'static str, f64, f64),
    y: (&'static str, f64, f64),
    says: &'static str,
}

/// Values of each of the two numbers of a map.
const VALUES: usize = 13;

const MAPS: [Map; 5] = [
    Map {
        name: "suslov",
        scene: "suslov",
        set: &[],
        x: ("K", -0.05, 0.05),
        y: ("I1", 0.05, 0.15),
        says: "Suslov's body: a measure where the axis is a principal one, K = 0, and nowhere else; three linear integrals where K² = I1 (I2 - I1), as λ = 0 there",
    },
    Map {
        name: "chaplygin-sphere",
        scene: "chaplygin-sphere",
        set: &[],
        x: ("I2", 0.05, 0.15),
        y: ("I3", 0.05, 0.15),
        says: "Chaplygin's sphere, I1 = 0.1: three linear integrals, five where two moments are equal, seven where three are",
    },
    Map {
        name: "chaplygin-top",
        scene: "scenes/chaplygin-top.toml",
        set: &[("c1", 0.0), ("c2", 0.0)],
        x: ("c3", -0.1, 0.1),
        y: ("I1", 0.08, 0.18),
        says: "Ball whose mass centre is on a principal axis at c3, I2 = 0.13: a measure where c3 = 0 or I1 = I2",
    },
    Map {
        name: "rubber-ball",
        scene: "scenes/rubber-ball-off-centre.toml",
        set: &[("c1", 0.0), ("c2", 0.0)],
        x: ("c3", -0.1, 0.1),
        y: ("I1", 0.08, 0.18),
        says: "The same ball, rolling without spinning: a measure at the same places",
    },
    Map {
        name: "ellipsoid-of-revolution",
        scene: "rattleback",
        set: &[("K", 0.0), ("a1", 0.2), ("a2", 0.2), ("a3", 0.1), ("I3", 0.016)],
        x: ("I1", 0.004, 0.016),
        y: ("I2", 0.004, 0.016),
        says: "Ellipsoid of revolution, moments of inertia about its axes: a measure where I1 = I2, and at no other point",
    },
];

impl Map {
    /// The picture, and how many points have a measure, how many none, and how many are open.
    fn drawn(&self) -> Result<(String, [usize; 3])> {
        let value = |(_, from, to): (&str, f64, f64), i: usize| -> f64 {
            let x = from + (to - from) * i as f64 / (VALUES - 1) as f64;
            format!("{x:.6}").parse().unwrap_or(x)
        };
        let points: Vec<(usize, usize)> = (0..VALUES).flat_map(|j| (0..VALUES).map(move |i| (i, j))).collect();
        let decided = |&(i, j): &(usize, usize)| -> Result<Reversed> {
            let mut set: BTreeMap<String, f64> = self.set.iter().map(|&(name, x)| (name.into(), x)).collect();
            set.extend([(self.x, i), (self.y, j)].map(|(of, i)| (of.0.into(), value(of, i))));
            Ok(reversible_scene(&with_numbers(self.scene, &set)?, 1)?)
        };
        let found = parallel::map(&points, decided);
        let found: Vec<Reversed> = found.into_iter().collect::<Result<_>>()?;
        let linear = |found: &Reversed| {
            let found = found.integrals.first()?.as_ref().ok().filter(|found| settled(found))?;
            Some(found.count as f64)
        };
        let is = |wanted: fn(&Measure) -> bool| found.iter().filter(|found| wanted(&found.measure)).count();
        let counts = [
            is(|measure| matches!(measure, Measure::Local { .. })),
            is(|measure| matches!(measure, Measure::None { .. })),
            is(|measure| matches!(measure, Measure::Open(_))),
        ];
        let unit = |name: &str| if name.starts_with('c') { "m" } else { "kg m²" };
        let axis = |(name, from, to): (&str, f64, f64)| Axis {
            range: Some((from, to)),
            ..Axis::linear(format!("{name} ({})", unit(name)))
        };
        let map = HeatMap {
            title: self.says.into(),
            x: axis(self.x),
            y: axis(self.y),
            columns: VALUES,
            value: Axis::linear("integrals linear in the velocities"),
            cells: found.iter().map(linear).collect(),
            empty: "not decided".into(),
            marked: found.iter().map(|found| matches!(found.measure, Measure::Local { .. })).collect(),
            mark: "an invariant measure".into(),
        };
        Ok((map.to_svg(), counts))
    }
}

/// What a scene says of a formulation; reasons are collected.
fn asked(scene: &Scene, formulation: &'static Formulation) -> Result<Integrals> {
    let constants = default_constants(formulation, scene);
    let choice = Choice { label: formulation.title.into(), formulation, removal: None, constants };
    let degree = if scene.system.dimension() <= QUADRATIC { 2 } else { 1 };
    Ok(Integrals::find(scene, &choice, degree, &[])?)
}

/// The page and its pictures, of the parts that are asked for; `done` is called with the name of each piece.
///
/// # Errors
/// Answers that contradict each other, and files that cannot be read.
pub fn files(scenes: &[&str], has: &dyn Fn(&str) -> bool, done: impl Fn(&str) + Sync) -> Result<Vec<File>> {
    let (mut text, mut files) = (head(), Vec::new());
    let mut data = DataPackage::new("data/integrals", "Invariant measures and first integrals");
    if has("scenes") {
        let begun = Instant::now();
        let answers = parallel::map(scenes, |&name| -> Result<_> {
            let scene = scene::catalogue::find(name, &[])?;
            let of = |formulation| asked(&scene, formulation).with_context(|| name.to_owned());
            let both = (of(CHETAEV)?, of(VAKONOMIC)?);
            done(name);
            Ok(both)
        });
        let answers = answers.into_iter().collect::<Result<Vec<_>>>()?;
        data.table("catalogue", "Measures and integrals of every scene", &catalogue_table(&answers));
        data.table("open", "Why a question is open, and for which scenes", &reasons(&answers));
        let _ = write!(
            text,
            "\n## The catalogue\n\n{} Both formulations of {} scenes took {:.0} s on {} threads. {COLUMNS}\n",
            counted(&answers),
            answers.len(),
            begun.elapsed().as_secs_f64(),
            parallel::threads(),
        );
    }
    if has("literature") {
        let (sentence, table) = of_literature()?;
        data.table("literature", "What is known from the literature, and what was found", &table);
        let _ = write!(text, "\n## The literature\n\n{sentence}\n");
    }
    if has("maps") {
        text += MAPS_HEAD;
        for map in &MAPS {
            let begun = Instant::now();
            let (svg, [some, none, open]) = map.drawn().context(map.name)?;
            done(map.name);
            let per_thousand = begun.elapsed().as_secs_f64() * 1000.0 / (VALUES * VALUES) as f64;
            let path = format!("{}.svg", map.name);
            let _ = writeln!(
                text,
                "\n![{}]({path})\n\nOf {} points {some} have a measure, {none} have none, {open} are open; {per_thousand:.0} s per thousand points.",
                map.says,
                VALUES * VALUES
            );
            files.push(File { path: path.into(), text: svg });
        }
    }
    let _ = write!(text, "\n## Data\n\n{}", data.list(0));
    files.insert(0, File { path: "integrals.md".into(), text });
    Ok(files.into_iter().chain(data.files()).collect())
}

const MAPS_HEAD: &str = "\n## Maps\n\nColour: the number of independent integrals linear in the velocities. Grey: not decided. A dot: there is an invariant measure.\n";

fn head() -> String {
    "# Invariant measures and integrals\n\n\
     Is there an invariant measure e^σ(q) dq dp, and how many integrals are linear or quadratic in the velocities? `deltaq integrals SCENE` \
     answers for the parameters of a scene. **Near a generic point q:** σ is smooth there, and \
     integrals have analytic coefficients; both may be multivalued around angles and singular elsewhere. \
     Without a potential every measure that is smooth and positive near rest is of this kind; with one, densities may depend on p. Weaker \
     measures may exist ([García-Naranjo, Ortega & Ureña 2024](../../docs/references.bib#GarciaNaranjoEtAl2024)).\n\n\
     *None* is proved by a nonzero minor and has a certificate (`--certificates`) that `validation/proof/verify.py` reads. \
     Counts are computed by ranks at random points and are proved upper bounds.\n"
        .into()
}

fn measure(found: &Measure) -> String {
    match found {
        Measure::None { proved: true } => "none".into(),
        Measure::None { proved: false } => "none, by ranks".into(),
        Measure::Local { density: Some(_), .. } => "written".into(),
        Measure::Local { cyclic: Some(_), .. } => "some, none reduced".into(),
        Measure::Local { .. } => "some".into(),
        Measure::Open(_) => "open".into(),
    }
}

fn printed(found: &Integrals) -> String {
    match &found.ansatz {
        Ok(ansatz) => format!("{} of {}", ansatz.printed.len(), ansatz.functions),
        Err(_) => "open".into(),
    }
}

fn catalogue_table(answers: &[(Integrals, Integrals)]) -> Table {
    let mut table = Table::new(["scene", "measure", "multiplier", "linear", "quadratic", ">printed", ">vakonomic"]);
    for (chetaev, vakonomic) in answers {
        let reversed = chetaev.reversed.as_ref();
        let (mut cells, _) = reversed.map(Reversed::cells).unwrap_or_default();
        cells.resize(4, String::new());
        let measure = reversed.map_or(String::new(), |found| measure(&found.measure));
        let (printed, of_vakonomic) = (printed(chetaev), printed(vakonomic));
        let [_, multiplier, linear, quadratic] = [0, 1, 2, 3].map(|i| &cells[i]);
        table.row(&[&chetaev.scene.name, &measure, multiplier, linear, quadratic, &printed, &of_vakonomic]);
    }
    table
}

/// What the columns of the catalogue mean.
const COLUMNS: &str = "In `catalogue.csv`, *multiplier* says whether dτ = f dt makes the motion over some of the coordinates Hamiltonian (Chaplygin); empty if none \
    of these have a motion of their own. *Linear* and *quadratic* count integrals of Chetaev's motion, without those that the energy, constants and products make; \
    quadratic ones are counted for at most 4 coordinates. *Printed*: how many constant combinations were found of how many functions (monomials in velocities times \
    monomials in coordinates or their sines and cosines); *vakonomic*: the same in (q, v, μ).";

/// How many scenes have a measure, and how many have none.
fn counted(answers: &[(Integrals, Integrals)]) -> String {
    let is = |wanted: fn(&Measure) -> bool| {
        let found = answers.iter().filter_map(|(chetaev, _)| chetaev.reversed.as_ref());
        found.filter(|found| wanted(&found.measure)).count()
    };
    format!(
        "**Of {} scenes {} have an invariant measure under Chetaev's equations, and {} have none, which is proved; the others are open.**",
        answers.len(),
        is(|measure| matches!(measure, Measure::Local { .. })),
        is(|measure| matches!(measure, Measure::None { proved: true })),
    )
}

/// Why anything is open, reason by reason.
fn reasons(answers: &[(Integrals, Integrals)]) -> Table {
    let mut known: Vec<(String, Vec<&str>)> = Vec::new();
    for (chetaev, vakonomic) in answers {
        let reversed = chetaev.reversed.iter();
        let of_measure = reversed.clone().filter_map(|found| match &found.measure {
            Measure::Open(open) => Some(open),
            _ => None,
        });
        let of_counts = reversed.flat_map(|found| &found.integrals).filter_map(|found| found.as_ref().err());
        let of_ansatz = chetaev.ansatz.as_ref().err().into_iter().chain(vakonomic.ansatz.as_ref().err());
        let mut seen: Vec<String> = of_measure.chain(of_counts).chain(of_ansatz).map(Open::to_string).collect();
        seen.dedup();
        for reason in seen {
            match known.iter_mut().find(|(other, _)| *other == reason) {
                Some((_, names)) => names.push(&chetaev.scene.name),
                None => known.push((reason, vec![&chetaev.scene.name])),
            }
        }
    }
    let mut table = Table::new(["open because", "scenes"]);
    for (reason, mut names) in known {
        names.dedup();
        table.row(&[&reason, &names.join(", ")]);
    }
    table
}

fn of_literature() -> Result<(String, Table)> {
    let entries = literature()?;
    let mut table = Table::new(["system", "known", "source", "found", "multiplier", "linear"]);
    let found = parallel::map(&entries, Entry::compared);
    let (mut agree, mut contradict) = (0, 0);
    for (entry, found) in entries.iter().zip(found) {
        let (found, agrees) = found.with_context(|| entry.name.clone())?;
        agree += usize::from(agrees == Some(true));
        contradict += usize::from(agrees == Some(false));
        let (cells, _) = found.cells();
        let word = if agrees == Some(false) { ", CONTRADICTS" } else { "" };
        let measure = measure(&found.measure) + word;
        table.row(&[&entry.name, &entry.claim, &entry.source, &measure, &cells[1], &cells[2]]);
    }
    let sentence = format!(
        "**{agree} of {} entries agree, {contradict} contradict.** The others are affine or have integrable constraints and are not decided without an ansatz; \
         `validation/integrals/referee.py`, which shares no code with deltaq, tests what is printed of them.",
        entries.len()
    );
    Ok((sentence, table))
}
