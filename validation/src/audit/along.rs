//! Equations along a computed motion.

use std::collections::HashMap;

use anyhow::{Context as _, Result};
use mechanics::ConstantsRule;
use motion::band::SOME;
use motion::{REMOVED_CONSTRAINT, Settings, setting, solve};

use super::context::Context;
use random::equations;

/// Half the distance of the velocities whose difference is an acceleration.
const STEP: f64 = 2.5e-4;

/// Each formula's largest residual along the removed-constraint motion of a scene by its first removal.
/// Names: coordinates with primes (second ones by differences of velocities), parameters, `t`, horizon `t1`.
pub(super) fn along(context: &Context, scene: &str, lines: &[String]) -> Result<Vec<f64>> {
    let scene = scene::catalogue::find(scene, &[])?;
    let removal = scene.removals.first().context("no removal")?;
    let derived = equations(&scene.system, REMOVED_CONSTRAINT, Some(removal))?;
    let ConstantsRule::Natural { horizon } = removal.constants else { anyhow::bail!("no horizon") };
    let mut motion = solve(setting(&scene), derived, &removal.constants, &Settings::default())?;
    let g = &context.graph;
    let mut residuals = Vec::new();
    for line in lines {
        let [left, right] = context.sides(line)?;
        residuals.push((g.sub(left, right), 0.0_f64));
    }
    let mut values: HashMap<symbolic::Symbol, f64> = HashMap::from([(g.symbol("t1"), horizon)]);
    for p in &scene.system.parameters {
        values.insert(g.symbol(&scene.system.graph.name(p.symbol)), p.value);
    }
    let (start, end) = (motion.start(), motion.end());
    for k in 1..SOME {
        let t = start + (end - start) * k as f64 / SOME as f64;
        let now = motion.at(t)?;
        let mut around = Vec::new();
        for steps in [-2.0, -1.0, 1.0, 2.0] {
            around.push(motion.at(t + steps * STEP)?.velocities);
        }
        values.insert(g.symbol("t"), t);
        for (i, c) in scene.system.coordinates.iter().enumerate() {
            // five points, order 4
            let [a, b, d, e] = [0, 1, 2, 3].map(|k: usize| around[k][i]);
            let second = (a - 8.0 * b + 8.0 * d - e) / (12.0 * STEP);
            values.insert(g.symbol(&c.name), now.coordinates[i]);
            values.insert(g.symbol(&format!("{}'", c.name)), now.velocities[i]);
            values.insert(g.symbol(&format!("{}''", c.name)), second);
        }
        for (residual, largest) in &mut residuals {
            *largest = largest.max(g.evaluate(*residual, &values)?.abs());
        }
    }
    Ok(residuals.into_iter().map(|(_, largest)| largest).collect())
}
