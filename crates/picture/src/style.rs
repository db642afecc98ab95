//! Colours, dashes and widths.

/// The role of a curve, which determines its style.
///
/// Okabe's and Ito's colours of contrast 3 on white and on black; dash and width tell curves apart without
/// colour. Narrow lines stand on wide ones. A gap between two formulations alternates their colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Style {
    /// One of a row of motions of the vakonomic family (vermilion, thin, the later in the row the stronger).
    Family,
    /// A limit or threshold (grey, thin, dashed; named at its right end).
    Threshold,
    /// Motion of the d'Alembert–Lagrange equations (blue, wide, solid).
    Chetaev,
    /// Gap between the Chetaev and the vakonomic motion.
    ChetaevVakonomic,
    /// Motion of the vakonomic equations (vermilion, long dashes).
    Vakonomic,
    /// Gap between the Chetaev and the removed-constraint motion.
    ChetaevRemovedConstraint,
    /// The deliberately wrong one: the constraint put into the Lagrangian (purple, dash and dot).
    Substituted,
    /// Gap between the vakonomic and the removed-constraint motion.
    VakonomicRemovedConstraint,
    /// Motion of the removed-constraint equations (green, dots).
    RemovedConstraint,
    /// One of several of a kind, such as methods: four colours, and four dashes after them.
    Member(u8),
    /// A measurement: a dot per point (grey).
    Samples,
    /// What everything else is compared with (ink, solid).
    Ink,
    /// Points at which something ends: a cross per point (ink).
    Stops,
}

/// One pass of the pen along a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub colour: &'static str,
    /// Its width in pixels.
    pub width: f64,
    /// Lengths of dashes and spaces; empty for a solid line.
    pub dash: &'static str,
    /// Whether the ends of the line and of its dashes are round.
    pub round: bool,
    /// How much of it is seen, up to 1.
    pub opacity: f64,
}

/// Shapes along a curve whose style is taken, as paths about the origin: circle, square, triangle, diamond.
pub(super) const MARKS: [&str; 4] = [
    "m-5 0a5 5 0 1 0 10 0a5 5 0 1 0-10 0z",
    "m-4.6-4.6h9.2v9.2h-9.2z",
    "m0-6.2l5.8 10h-11.6z",
    "m0-6.4l6.4 6.4l-6.4 6.4l-6.4-6.4z",
];

/// The same for [`Style::Stops`]: a cross.
pub(super) const CROSS: &str = "m-5-5l10 10m0-10l-10 10";

pub(super) const INK: &str = "currentColor";
/// Chetaev.
pub const BLUE: &str = "#0072B2";
/// Vakonomic.
pub const VERMILION: &str = "#D55E00";
/// Removed constraint.
pub const GREEN: &str = "#009E73";
/// The deliberately wrong one.
pub const PURPLE: &str = "#CC79A7";

/// Ink for a viewer that says nothing, a light page and a dark one.
pub const INKS: [&str; 3] = ["#7a7f86", "#505860", "#a9b1ba"];

const fn stroke(colour: &'static str, width: f64, dash: &'static str) -> Stroke {
    Stroke { colour, width, dash, round: false, opacity: 1.0 }
}

impl Style {
    /// The style of a formulation, the same in every picture; none for a name that is no formulation's.
    ///
    /// ```
    /// use picture::Style;
    /// assert_eq!(Style::of_formulation("vakonomic-costate"), Some(Style::Vakonomic));
    /// ```
    pub fn of_formulation(name: &str) -> Option<Style> {
        let styles = [
            ("chetaev", Style::Chetaev),
            ("vakonomic", Style::Vakonomic),
            ("removed-constraint", Style::RemovedConstraint),
            ("substitution", Style::Substituted),
            ("kappa", Style::Member(7)),
            ("first-order", Style::Member(11)),
            ("prescribed", Style::Member(3)),
        ];
        styles.into_iter().find(|(start, _)| name.starts_with(start)).map(|(_, style)| style)
    }

    /// Colour and width of the outlines of bodies; narrow ones lie on wide ones.
    pub(super) fn outline(self) -> (&'static str, f64) {
        let colour = self.strokes()[0].colour;
        match self {
            Self::Chetaev => (colour, 5.0),
            Self::Vakonomic => (colour, 2.8),
            _ => (colour, 1.2),
        }
    }

    /// The passes of the pen, lowest first.
    pub fn strokes(self) -> Vec<Stroke> {
        match self {
            Self::Family => vec![Stroke { opacity: 0.75, ..stroke(VERMILION, 1.1, "") }],
            Self::Chetaev => vec![stroke(BLUE, 5.4, "")],
            Self::Vakonomic => vec![stroke(VERMILION, 3.0, "12 7")],
            Self::Substituted => vec![stroke(PURPLE, 2.2, "9 4 2 4")],
            Self::RemovedConstraint => vec![Stroke { round: true, ..stroke(GREEN, 3.4, "0.1 7") }],
            Self::ChetaevVakonomic => vec![stroke(BLUE, 4.8, ""), stroke(VERMILION, 4.8, "14 14")],
            Self::ChetaevRemovedConstraint => vec![stroke(BLUE, 3.2, ""), stroke(GREEN, 3.2, "8 8")],
            Self::VakonomicRemovedConstraint => vec![stroke(VERMILION, 1.8, ""), stroke(GREEN, 1.8, "4 4")],
            Self::Member(n) => {
                let colour = [BLUE, VERMILION, GREEN, PURPLE][usize::from(n) % 4];
                let dash = ["", "7 3", "2 2.5", "9 3 2 3"][usize::from(n) / 4 % 4];
                vec![stroke(colour, 2.2, dash)]
            }
            Self::Threshold => vec![stroke(INK, 1.0, "7 4")],
            Self::Ink => vec![stroke(INK, 2.8, "")],
            Self::Stops => vec![stroke(INK, 1.8, "")],
            Self::Samples => vec![Stroke { round: true, ..stroke(INK, 2.6, "0.1 6") }],
        }
    }
}
