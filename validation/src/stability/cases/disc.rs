//! A disc that rolls: what pushes, holds or brakes it.

use motion::CHETAEV;
use std::sync::Arc;

use scene::{Scene, SceneError};

use super::FORMULATIONS;
use crate::stability::question::Question;
use crate::stability::reference::Reference;

/// Inertia of rolling straight on, and of turning: by Chetaev `M ä = Q_a`, `J b̈ = Q_b`.
pub(super) const INERTIA: [f64; 2] = [1.5, 0.25];

/// Heading at the start.
pub(super) const HEADING: f64 = 0.3;

/// A disc in coordinates `(a, b, x, y)`: roll, heading, place.
#[derive(Clone)]
pub(super) struct Disc {
    /// A term of `L`.
    pub(super) term: String,
    /// Forces on `a` and `b`.
    pub(super) forces: [String; 2],
    /// `a` at the start.
    pub(super) roll: f64,
    /// `ȧ` and `ḃ` at the start.
    pub(super) speeds: [f64; 2],
    pub(super) duration: f64,
}

impl Disc {
    pub(super) fn scene(&self) -> Result<Scene, SceneError> {
        let ([push, turn], [speed, rate]) = (&self.forces, self.speeds);
        let text = include_str!("disc.toml").replace("TERM", &self.term).replace("ROLL", push).replace("TURN", turn);
        let start = [("a", self.roll), ("b", HEADING), ("a'", speed), ("b'", rate), ("duration", self.duration)];
        Scene::parse_with("disc", &text, &start.map(|(name, x)| (name.to_string(), x)))
    }

    /// Without forces and turning it rolls straight on, in every formulation: `a` over time is given.
    pub(super) fn straight(self, point: f64, roll: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Vec<Question> {
        let (roll, start, (sin, cos)) = (Arc::new(roll), self.roll, HEADING.sin_cos());
        let road = move |_| {
            let roll = roll.clone();
            Reference::Closed(Box::new(move |t| {
                let a = roll(t);
                vec![a, HEADING, (a - start) * cos, (a - start) * sin]
            }))
        };
        super::questions(point, move || self.scene(), &FORMULATIONS, road)
    }

    /// Chetaev's motion: roll and heading are compared.
    pub(super) fn turning(
        self,
        point: f64,
        kind: &str,
        road: impl Fn(f64) -> [f64; 2] + Send + Sync + 'static,
    ) -> Question {
        let road = Arc::new(road);
        let reference = move |_| {
            let road = road.clone();
            Reference::Closed(Box::new(move |t| road(t).to_vec()))
        };
        let mut question = super::questions(point, move || self.scene(), &[CHETAEV], reference).remove(0);
        question.formulation += &format!(", {kind}");
        question.compared = 2;
        question
    }
}
