//! The page of one scene, its pictures, tables and equations.

use std::fmt::Write;

use anyhow::{Context, Result};
use comparison::words::{Headline, rows, short};
use comparison::{Comparison, EpsilonTerm, Gap, Pair, Verdict};
use motion::band::INSTANTS;
use motion::{CHETAEV, REMOVED_CONSTRAINT, VAKONOMIC, VAKONOMIC_COSTATE};
use program::File;

use crate::bodies::bodies;
use crate::markdown::{image, inert, link};
use crate::pictures::pictures;
use crate::table::Table;
use crate::{DataPackage, membership, tables, tex};

/// Rows of the table of pairs, and equations, that a page shows.
pub(crate) const ROWS: usize = 5;
const EQUATIONS: usize = 3;

/// A formula of more letters than this stands in the file of equations only.
const LONG: usize = 700;

/// Everything about a scene, with paths in the folder of reports: the page, which fits a screen; the
/// pictures; all tables as CSV; the equations in LaTeX.
///
/// # Errors
/// Where a motion cannot be read off or a picture cannot be drawn.
pub fn scene_files(comparison: &mut Comparison) -> Result<Vec<File>> {
    let name = comparison.scene.name.clone();
    let moving = bodies(comparison).with_context(|| format!("bodies of scene `{name}`"))?;
    let still = pictures(comparison).with_context(|| format!("pictures of scene `{name}`"))?;
    let data = data(comparison)?;
    let page = page(comparison, moving.as_ref(), &still, &data);
    let mut files: Vec<File> = moving.into_iter().chain(still).collect();
    files.push(File { path: format!("scenes/{name}.md").into(), text: page });
    files.push(File { path: format!("equations/{name}.tex").into(), text: tex::equations(comparison) });
    files.extend(data.files());
    Ok(files)
}

/// The tables of a scene.
fn data(comparison: &mut Comparison) -> Result<DataPackage> {
    let mut data = DataPackage::new(format!("data/scenes/{}", comparison.scene.name), comparison.scene.title.clone());
    let [residuals, constant] = tables::invariants(comparison)?;
    let trace = epsilon_term(comparison)?;
    let comparison = &*comparison;
    data.table("pairs", "All pairs of motions", &tables::pairs(comparison, &comparison.pairs, false));
    data.table("growth", "How the gaps begin, measured and predicted", &tables::growth(comparison));
    data.table("fits", "What other free constants leave of a gap", &tables::fits(comparison));
    data.table("families", "Which family has which motion", &membership::table(comparison));
    data.table("runs", "How each motion was started, integrated and ended", &tables::runs(comparison));
    data.table("start", "Coordinates and velocities at the start", &tables::start(comparison));
    data.table("constant", "What theory says is constant, and its drift", &constant);
    data.table("residuals", "How far each motion left the constraint", &residuals);
    data.table("first-order", "Size of the first-order vakonomic correction along Chetaev's motion", &trace);
    Ok(data)
}

/// The whole page, in Markdown.
fn page(comparison: &Comparison, moving: Option<&File>, still: &[File], data: &DataPackage) -> String {
    let scene = &comparison.scene;
    let Headline { why, sure, .. } = Headline::of(comparison);
    let [title, message, why, sure] = [&scene.title, &message(comparison), &why, &sure].map(|text| inert(text));
    let mut page = format!("# {title}\n\n**{message}**\n");
    if let Some(picture) = moving {
        let _ = writeln!(page, "\n{}", image(picture));
    }
    if !scene.notes.is_empty() {
        let _ = writeln!(page, "\n{}", inert(&scene.notes));
    }
    let _ = writeln!(page, "\n{sure}\n\n{why}");
    let pairs = tables::pairs(comparison, principal(comparison), true).only(&tables::SHOWN);
    let (shown, all) = (pairs.first(ROWS), comparison.pairs.len());
    if !shown.is_empty() {
        let _ = writeln!(
            page,
            "\n## Pairs\n\n{shown}\nGaps are lengths in the kinetic metric $\\sqrt{{\\Delta q^T |M| \\Delta q}}$, in m √kg. \
             {} of {all} pairs are shown. [How to read verdicts](../../docs/verdicts.md).",
            shown.len()
        );
    }
    let figure = |kind: &str| still.iter().find(|file| file.path.to_string_lossy().ends_with(&format!("-{kind}.svg")));
    let shown = ["gap", "path", "coordinates"].iter().find_map(|kind| figure(kind));
    if let Some(picture) = shown {
        let _ = writeln!(page, "\n## Figure\n\n{}", image(picture));
    }
    page += &system(comparison);
    if !scene.source.is_empty() {
        let _ = writeln!(page, "\nSource: {}.", inert(scene.source.trim_end_matches('.')));
    }
    let name = &scene.name;
    let equations = link(&format!("{name}.tex"), &format!("../equations/{name}.tex"));
    let _ = write!(page, "\n## More\n\n- Equations of every formulation: {equations}\n");
    for picture in still.iter().filter(|file| shown.is_none_or(|shown| shown.path != file.path)) {
        let path = picture.path.file_name().unwrap_or_default().to_string_lossy();
        let kind = path.trim_start_matches(name).trim_start_matches('-').trim_end_matches(".svg");
        let _ = writeln!(page, "- Picture, {kind}: {}", link(&path, &path));
    }
    page + &data.list(1)
}

/// Pairs that a page shows: of the first run of each formulation, and of each removal with Chetaev's motion.
fn principal(comparison: &Comparison) -> impl Iterator<Item = &Pair> {
    let formulation = move |i: usize| comparison.runs[i].choice.formulation;
    let first = move |i: usize| comparison.run(formulation(i)) == Some(i);
    let listed = move |p: &&Pair| {
        let costate = [p.first, p.second].map(formulation).contains(&VAKONOMIC_COSTATE);
        !costate && (formulation(p.first) == CHETAEV || (first(p.first) && first(p.second)))
    };
    rows(comparison).filter(listed)
}

/// What the page says first: by how much the formulations differ, and from when.
pub(crate) fn message(comparison: &Comparison) -> String {
    let gap = |a, b| Some(&comparison.pair(comparison.run(a)?, comparison.run(b)?)?.gap);
    let until = |gap: &Gap| format!("within {} s", short(gap.after(gap.end)));
    let contradicted = !comparison.contradictions().is_empty();
    let all: Vec<&Pair> = rows(comparison).collect();
    match (gap(CHETAEV, VAKONOMIC), gap(CHETAEV, REMOVED_CONSTRAINT)) {
        _ if contradicted => "No verdict: results contradict each other.".into(),
        (Some(vakonomic), _) if !all.is_empty() && all.iter().all(|p| p.gap.verdict == Verdict::Same) => {
            format!(
                "All formulations give the same motion from this start: no difference above the error estimates {}.",
                until(vakonomic)
            )
        }
        (Some(vakonomic), removed) => {
            let first = differ("From this start the d'Alembert–Lagrange (Chetaev) and the vakonomic motion", vakonomic);
            let second = removed.map(|gap| differ(" The removed-constraint motion and Chetaev's", gap));
            first + &second.unwrap_or_default()
        }
        _ => Headline::of(comparison).verdict,
    }
}

/// That two motions differ, from when and by how much.
fn differ(who: &str, gap: &Gap) -> String {
    let until = format!("within {} s", short(gap.after(gap.end)));
    match (&gap.verdict, gap.passes[1]) {
        (Verdict::Same, _) => format!("{who} agree: no difference above the error estimates {until}."),
        (Verdict::Different, Some(t)) => {
            let (after, largest) = (short(gap.after(t)), short(gap.largest));
            format!("{who} differ by 1e-3 m √kg after {after} s, and by up to {largest} m √kg {until}.")
        }
        (Verdict::Different, None) if gap.certain_from.is_some() => {
            format!("{who} differ by up to {} m √kg {until}.", short(gap.largest))
        }
        (Verdict::Different, None) => format!("{who} differ, which is proved; no difference was measured {until}."),
        (Verdict::Undecided { because }, _) => format!("{who}: undecided, {because}."),
    }
}

/// Size of the first-order vakonomic term along Chetaev's motion.
fn epsilon_term(comparison: &mut Comparison) -> Result<Table> {
    let columns = [">change of acceleration per ms of epsilon (m √kg/s²)", ">part of the largest acceleration (%)"];
    let mut table = Table::new(columns);
    let Some(run) = comparison.run(CHETAEV) else { return Ok(table) };
    let Comparison { scene, runs, .. } = comparison;
    let Ok(motion) = &mut runs[run].outcome else { return Ok(table) };
    let Some(EpsilonTerm { slope, acceleration }) = comparison::epsilon_term(scene, motion, INSTANTS)? else {
        return Ok(table);
    };
    let part = slope / acceleration;
    // less is round-off
    let [slope, part] = if part > 1e-9 { [1e-3 * slope, 0.1 * part] } else { [0.0, 0.0] };
    table.row(&[&short(slope), &short(part)]);
    Ok(table)
}

/// `L` and constraints, as many as fit; parameters with their values.
fn system(comparison: &Comparison) -> String {
    let system = &comparison.scene.system;
    let g = &system.graph;
    let mut text = String::from("\n## Equations\n\n");
    let lagrangian = format!("L = {}", g.latex(system.lagrangian));
    let constraints = system.constraints.iter().map(|&f| format!("{} = 0", g.latex(f)));
    let forces = system.coordinates.iter().zip(&system.forces).filter(|(_, force)| !g.is_zero(**force));
    let forces = forces.map(|(c, &force)| format!("Q_{{{}}} = {}", g.latex_symbol(c.position), g.latex(force)));
    let conditions = system.virtual_conditions.iter().map(|&w| format!("w = {}", g.latex(w)));
    let all: Vec<String> = [lagrangian].into_iter().chain(constraints).chain(forces).chain(conditions).collect();
    let fits = |formula: &&String| formula.len() <= LONG;
    for formula in all.iter().filter(fits).take(EQUATIONS) {
        let _ = writeln!(text, "```math\n{formula}\n```");
    }
    let left = all.len() - all.iter().filter(fits).take(EQUATIONS).count();
    if left > 0 {
        let _ = writeln!(text, "{left} of {} formulas are left out here.", all.len());
    }
    let parameters: Vec<String> =
        system.parameters.iter().map(|p| format!("${} = {}$", g.latex_symbol(p.symbol), p.value)).collect();
    if !parameters.is_empty() {
        let _ = writeln!(text, "\nParameters: {}.", parameters.join(", "));
    }
    text
}
