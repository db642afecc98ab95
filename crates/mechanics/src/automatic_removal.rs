//! Removals that nobody had to write: for constraints linear in the velocities.
//!
//! With `f = A v + b` and dependent velocities `v_d`, pivoted so that `A_d` (h×h) is regular at the start,
//!
//! ```text
//! v_d = K v_i + c ,      K = −A_d⁻¹ A_i ,   c = −A_d⁻¹ b .
//! ```
//!
//! Coefficients of different velocities are compared as if all had the same kinetic energy, `a_ij
//! |M_jj|^(−1/2)`, so that the choice does not depend on units.

use std::collections::BTreeMap;

use symbolic::Expr;

use crate::solved_constraints::{SolvedConstraints, cleared};
use crate::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal, RemovalError, State, System};

impl Removal {
    /// Names of the removals that need no hand.
    pub const AUTOMATIC: [&str; 2] = ["coordinates", "quasi-velocities"];

    /// *Coordinate removal.* `u` are `n − h` of the coordinates, the others are memory with `ẇ = K u̇ + c`.
    ///
    /// # Errors
    /// [`RemovalError::NotLinear`] where a constraint is not linear in `v`; [`RemovalError::Dependent`] where
    /// `A` at `state` has no full row rank.
    ///
    /// ```
    /// # let mut system = mechanics::System::new(<_>::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
    /// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
    /// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
    /// # let start = mechanics::State { t: 0.0, q: vec![0., 0., 0.3], v: vec![0.5, 0.5 * 0.3f64.tan(), 1.] };
    /// // the ice sledge: y'*cos(phi) - x'*sin(phi)
    /// let removal = mechanics::Removal::by_coordinates(&system, &start)?;
    /// let names: Vec<String> = removal.parameters.iter().map(|u| system.graph.name(u.symbol)).collect();
    /// assert_eq!(names, ["x", "phi"]);
    /// assert_eq!(system.graph.plain(removal.memory[0].rate), "x'*sin(phi)/cos(phi)");
    /// removal.verify(&system)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn by_coordinates(system: &System, state: &State) -> Result<Removal, RemovalError> {
        Ok(Removal::of_coordinates(system, &SolvedConstraints::new(system, state)?))
    }

    /// [`Removal::by_coordinates`] and [`Removal::by_quasi_velocities`] from one elimination.
    ///
    /// # Errors
    /// As [`Removal::by_coordinates`].
    pub fn automatic(system: &System, state: &State) -> Result<[Removal; 2], RemovalError> {
        let split = SolvedConstraints::new(system, state)?;
        Ok([Removal::of_coordinates(system, &split), Removal::of_quasi_velocities(system, &split)])
    }

    fn of_coordinates(system: &System, split: &SolvedConstraints) -> Removal {
        let memory = split.dependent.iter().enumerate().map(|(row, &i)| MemoryVariable {
            symbol: system.coordinates[i].position,
            rate: split.rate(system, row, &system.graph.variables(&split.independent_rates(system))),
            coordinate: Some(i),
        });
        Removal {
            name: Removal::AUTOMATIC[0].into(),
            parameters: split.independent.iter().map(|&i| coordinate_parameter(system, i)).collect(),
            memory: memory.collect(),
            coordinates: system.graph.variables(&system.positions()),
            start: BTreeMap::new(),
            constants: ConstantsRule::Zero,
            chart: split.quotients.clone(),
        }
    }

    /// *Quasi-velocity removal.* `q̇ = N(q) u̇ + c(q)`, `N` a basis of ker `A`, cleared of denominators.
    ///
    /// A column with one entry is a coordinate and stays one; so does one that gets far longer by clearing.
    /// Every other coordinate is memory. Knife edge: `u̇` is the speed along the blade.
    ///
    /// # Errors
    /// As [`Removal::by_coordinates`].
    ///
    /// ```
    /// # let mut system = mechanics::System::new(<_>::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
    /// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
    /// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
    /// # let start = mechanics::State { t: 0.0, q: vec![0., 0., 0.3], v: vec![0.5, 0.5 * 0.3f64.tan(), 1.] };
    /// // the ice sledge: y'*cos(phi) - x'*sin(phi)
    /// let removal = mechanics::Removal::by_quasi_velocities(&system, &start)?;
    /// let rates: Vec<String> = removal.memory.iter().map(|w| system.graph.plain(w.rate)).collect();
    /// assert_eq!(rates, ["u_x'*cos(phi)", "u_x'*sin(phi)"]);
    /// removal.verify(&system)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn by_quasi_velocities(system: &System, state: &State) -> Result<Removal, RemovalError> {
        Ok(Removal::of_quasi_velocities(system, &SolvedConstraints::new(system, state)?))
    }

    fn of_quasi_velocities(system: &System, split: &SolvedConstraints) -> Removal {
        let g = &system.graph;
        let mut parameters = Vec::new();
        let mut memory = Vec::new();
        let mut start = BTreeMap::new();
        let mut columns = Vec::new();
        for (column, &i) in split.independent.iter().enumerate() {
            let entries = split.solution.column(column);
            let denominator = g.product(&g.denominators(&entries));
            let clear: Vec<Expr> = entries.iter().map(|&e| cleared(g, g.mul(e, denominator))).collect();
            if entries.iter().all(|&e| g.is_zero(e)) || g.size(&clear) > LONGER * g.size(&entries) {
                parameters.push(coordinate_parameter(system, i));
                columns.push((entries, g.variable(system.coordinates[i].velocity)));
                continue;
            }
            let name = parameter_name(system, i);
            let u = DisplacementParameter {
                symbol: g.symbol(&name),
                rate: g.symbol(&format!("{name}'")),
                second_rate: g.symbol(&format!("{name}''")),
                coordinate: None,
            };
            columns.push((clear, g.variable(u.rate)));
            let rate = g.mul(cleared(g, denominator), g.variable(u.rate));
            start.insert(u.symbol, g.zero());
            start.insert(u.rate, g.div(g.variable(system.coordinates[i].velocity), denominator));
            memory.push(MemoryVariable { symbol: system.coordinates[i].position, rate, coordinate: Some(i) });
            parameters.push(u);
        }
        for (row, &i) in split.dependent.iter().enumerate() {
            let terms = columns.iter().map(|(entries, u)| g.mul(entries[row], *u));
            let rate = g.sum(&terms.chain([split.offset[row]]).collect::<Vec<Expr>>());
            memory.push(MemoryVariable { symbol: system.coordinates[i].position, rate, coordinate: Some(i) });
        }
        memory.sort_by_key(|w| w.coordinate);
        Removal {
            name: Removal::AUTOMATIC[1].into(),
            parameters,
            memory,
            coordinates: g.variables(&system.positions()),
            chart: columns.into_iter().flat_map(|(entries, _)| entries).collect(),
            start,
            constants: ConstantsRule::Zero,
        }
    }
}

/// Entries without denominators may be this much longer than with them.
const LONGER: usize = 4;

/// `u_x` for the coordinate `x`, with underscores until it is a new name. Removals may share symbols.
fn parameter_name(system: &System, i: usize) -> String {
    let g = &system.graph;
    let taken = |name: &str| {
        system.coordinates.iter().any(|c| c.name == name) || system.parameters.iter().any(|p| g.name(p.symbol) == name)
    };
    let mut name = format!("u_{}", system.coordinates[i].name);
    while taken(&name) {
        name.push('_');
    }
    name
}

fn coordinate_parameter(system: &System, i: usize) -> DisplacementParameter {
    let c = &system.coordinates[i];
    DisplacementParameter { symbol: c.position, rate: c.velocity, second_rate: c.acceleration, coordinate: Some(i) }
}
