//! What the main job does besides comparing scenes, section by section.

use anyhow::Result;
use serde_json::Value;

use crate::cli::Section;
use program::File;
use random::{Batch, Kind};
use validation::report::{
    AuditReport, BicycleReport, EquivalenceReport, LiteratureReport, RealizationReport, StabilityReport, random_files,
    random_headline, random_verdicts,
};

/// Random systems of the main job.
const RANDOM_SYSTEMS: u64 = 1_000;

/// What a section besides the scenes has to say.
pub(crate) struct Part {
    pub(crate) page: &'static str,
    pub(crate) headline: String,
    /// For machines, under a name.
    pub(crate) verdicts: Option<(&'static str, Value)>,
    /// Its page and its pictures.
    pub(crate) files: Vec<File>,
}

/// A section, and what makes its parts.
type Job = (Section, fn(bool) -> Result<Vec<Part>>);

/// Sections besides scenes, referee and times, in the order of the overview.
pub(crate) const JOBS: [Job; 6] = [
    (Section::Random, random_systems),
    (Section::Realization, realization),
    (Section::PaperAudit, paper_audit),
    (Section::Equivalence, equivalence),
    (Section::Bicycle, bicycle),
    (Section::Stability, stability),
];

/// The rank of a section among those that work at the same time: scenes are first to answer, then come the
/// references that errors are taken against, and of the others the longer their pieces the earlier.
pub(crate) fn rank(section: &Section) -> usize {
    let order = [
        Section::Scenes,
        Section::ErrorVsTime,
        Section::Stability,
        Section::Bicycle,
        Section::PaperAudit,
        Section::Realization,
        Section::Equivalence,
        Section::Random,
    ];
    order.iter().position(|other| other == section).unwrap_or(order.len())
}

fn random_systems(quiet: bool) -> Result<Vec<Part>> {
    let batch = Batch { seed: 1, kinds: Kind::ALL.to_vec() };
    let records = batch.run(0..RANDOM_SYSTEMS, None, quiet)?;
    let verdicts = Some(("random", random_verdicts(&batch, &records)));
    let (headline, files) = (random_headline(&records), random_files(&batch, &records)?);
    Ok(vec![Part { page: "evidence/random.md", headline, verdicts, files }])
}

fn realization(quiet: bool) -> Result<Vec<Part>> {
    let report = RealizationReport::new(quiet)?;
    let (headline, verdicts) = (report.headline(), Some(("realization", report.verdicts())));
    Ok(vec![Part { page: "evidence/realization.md", headline, verdicts, files: report.files()? }])
}

fn paper_audit(_: bool) -> Result<Vec<Part>> {
    let report = AuditReport::new()?;
    let (headline, verdicts) = (report.headline(), Some(("paper audit", report.verdicts())));
    Ok(vec![Part { page: "paper/audit.md", headline, verdicts, files: report.files() }])
}

fn equivalence(quiet: bool) -> Result<Vec<Part>> {
    let report = EquivalenceReport::new(quiet)?;
    let (headline, verdicts) = (report.headline(), Some(("equivalence", report.verdicts())));
    let systems = Part { page: "evidence/equivalence.md", headline, verdicts, files: report.files() };
    let report = LiteratureReport::new(quiet)?;
    let (headline, verdicts) = (report.headline(), Some(("literature", report.verdicts())));
    Ok(vec![systems, Part { page: "evidence/literature.md", headline, verdicts, files: report.files() }])
}

fn bicycle(_: bool) -> Result<Vec<Part>> {
    let report = BicycleReport::new()?;
    let (headline, verdicts) = (report.headline(), Some(("bicycle", report.verdicts())));
    Ok(vec![Part { page: "evidence/bicycle.md", headline, verdicts, files: report.files()? }])
}

fn stability(quiet: bool) -> Result<Vec<Part>> {
    let report = StabilityReport::new(|_| true, quiet)?;
    let (headline, verdicts) = (report.headline(), Some(("stability", report.verdicts())));
    Ok(vec![Part { page: "evidence/stability.md", headline, verdicts, files: report.files()? }])
}
