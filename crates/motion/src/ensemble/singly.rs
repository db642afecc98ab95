//! Members that the equations of the others do not suit, as motions of their own.

use equations::Named;
use integrate::Interrupt;

use super::{Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, MemberMotion, MemberRun};
use crate::{Choice, Setting, Settings, error_estimates, solve_from};

impl Ensemble {
    /// `member`, which stopped at this time, derived and integrated for itself, in the form and by the method
    /// that suit it and from chart to chart; multipliers and invariants are those of the ensemble, by name.
    /// None where it comes no farther.
    pub(super) fn singly(
        &self,
        member: &EnsembleMember,
        stopped: f64,
        times: &[f64],
        options: &EnsembleOptions,
    ) -> Option<MemberMotion> {
        if self.settings.interrupt.as_ref().is_some_and(Interrupt::is_raised) {
            return None;
        }
        let EnsembleStart { state, end, parameters, constants } = &member.given;
        let (mut system, varied) = (self.system.clone(), self.by_name.parameters());
        for p in &mut system.parameters {
            p.value = varied.iter().position(|s| *s == p.symbol).map_or(p.value, |i| parameters[i]);
        }
        let setting = Setting { system: &system, start: state, end: *end };
        let choice = Choice { constants: constants.clone(), ..self.by_name.choice().clone() };
        let settings = Settings { method: None, times: Some(times.to_vec()), ..self.settings.clone() };
        let mut motion = solve_from(setting, &choice, &settings).ok()?;
        let direction = (end - state.t).signum();
        if !motion.is_complete() && direction * (motion.end() - stopped) <= 1e-6 * (stopped - state.t).abs() {
            return None;
        }
        let reached = |t: &&f64| direction * (**t - motion.end()) <= 0.0;
        let reached: Vec<f64> = times.iter().take_while(reached).copied().collect();
        let (_, estimate) = error_estimates(&mut motion, setting, &reached).ok()?;
        let (wanted, found) = (self.equations(), &motion.equations);
        let places = |wanted: &[Named], found: &[Named]| -> Option<Vec<usize>> {
            wanted.iter().map(|named| found.iter().position(|other| other.name == named.name)).collect()
        };
        let multipliers = places(&wanted.multipliers, &found.multipliers)?;
        let invariants = places(&wanted.invariants, &found.invariants)?;
        let (mut outputs, mut states) = (Vec::new(), Vec::new());
        // it may end earlier by now
        let end = motion.end();
        for &t in reached.iter().filter(|t| direction * (**t - end) <= 0.0) {
            let mut now = motion.at(t).ok()?;
            now.multipliers = multipliers.iter().map(|&i| now.multipliers[i]).collect();
            now.invariants = invariants.iter().map(|&i| now.invariants[i]).collect();
            outputs.push(now);
            states.push(motion.states_at(t).ok()?);
        }
        let run = MemberRun {
            states,
            ending: motion.ending.clone(),
            work: motion.work,
            projection: motion.projection,
            alone: Some("the pivots of the others vanish here: a motion of its own".into()),
            ..MemberRun::default()
        };
        let (estimate, doubt, breaches) = match options.estimate {
            true => (Some(estimate), motion.doubt, motion.breaches),
            false => (None, None, Vec::new()),
        };
        Some(MemberMotion { outputs, estimate, doubt, breaches, run })
    }
}
