//! What is said of the control on scenes, and what Maggi's equations say of that.

use comparison::words::{enumerate, short};
use comparison::{Comparison, Verdict};
use motion::{CHETAEV, Metric, Setting, setting};
use random::{FoundOut, Unjudged, Word, found_out, referee};
use review::substitution::SUBSTITUTION;

/// The control on one scene.
pub struct Control {
    /// Name of the scene, as it is written on the page.
    pub name: String,
    /// Whether the program calls it Chetaev's motion.
    pub is_same: bool,
    /// What Maggi's equations say, if they could be asked.
    pub found: Option<FoundOut>,
}

impl Control {
    /// Where both Chetaev's and the control's motion are there.
    pub fn on(comparison: &Comparison) -> Option<Control> {
        let (chetaev, control) = (comparison.run(CHETAEV)?, comparison.run(&SUBSTITUTION)?);
        let gap = &comparison.pair(chetaev, control)?.gap;
        let judged = || -> Result<FoundOut, Unjudged> {
            let scene = &comparison.scene;
            let mut metric = Metric::new(&scene.system).map_err(motion::SolveError::from)?;
            let setting = Setting { end: gap.end, ..setting(scene) };
            let mut motion = comparison.runs[control].outcome.clone()?;
            found_out(setting, &mut motion, gap, &mut referee(setting)?, &mut metric, 0.0)
        };
        let name = format!("`{}`", comparison.scene.name);
        Some(Control { name, is_same: gap.verdict == Verdict::Same, found: judged().ok() })
    }

    /// A word for the table.
    pub fn word(&self) -> &'static str {
        let Some(found) = &self.found else { return "undecided" };
        match (found.word, found.flagged) {
            (Some(Word::Fails), true) => "flagged, though right",
            (Some(Word::Fails), false) => "wrong, and not flagged",
            (Some(Word::Holds), true) => FLAGGED,
            (Some(Word::Holds) | None, false) if self.is_same => RIGHT,
            _ => "undecided",
        }
    }
}

const FLAGGED: &str = "flagged";
const RIGHT: &str = "right here";

/// The finding on all scenes.
pub fn sentence(controls: &[Control]) -> String {
    let names = |wanted: &dyn Fn(&&Control) -> bool| {
        controls.iter().filter(wanted).map(|control| control.name.clone()).collect::<Vec<_>>()
    };
    let called = |word: &'static str| names(&move |control: &&Control| control.word() == word);
    let fails = names(&|control| control.found.as_ref().is_some_and(|found| found.word == Some(Word::Fails)));
    let (title, otherwise) = match &fails[..] {
        [] => ("The negative control is detected.", String::new()),
        some => (
            "The negative control is not detected.",
            format!(" On {} Maggi's equations disagree, which is a fault of deltaq.", enumerate(some)),
        ),
    };
    let wrong = names(&|control| control.found.as_ref().is_some_and(FoundOut::is_wrong)).len();
    let right = controls.iter().filter(|control| control.word() == RIGHT).filter_map(|control| control.found.as_ref());
    let residual = right.fold(0.0_f64, |largest, found| largest.max(found.residual));
    let scenes = |count: usize| format!("{count} scene{}", if count == 1 { "" } else { "s" });
    format!(
        "**{title}** Substituting the constraint into $L$ violates Maggi's equations on \
         {} and is flagged on {}. It is called right on {}, with a residual of at most {}.{otherwise}",
        scenes(wrong),
        called(FLAGGED).len(),
        enumerate(&called(RIGHT)),
        short(residual)
    )
}
