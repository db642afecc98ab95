//! Removals that nobody had to write: for constraints linear in the velocities.
//!
//! With `f = A v + b` and dependent velocities `v_d`, chosen by pivoting so that `A_d` (h×h) is regular at the start,
//!
//! ```text
//! v_d = K v_i + c ,      K = −A_d⁻¹ A_i ,   c = −A_d⁻¹ b .
//! ```

use std::collections::{BTreeMap, HashMap};

use symbolic::{Expr, Graph, Matrix, Symbol};

use crate::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal, RemovalError, State, System};

/// A pivot may be this much smaller than the largest one if it makes shorter expressions.
const PIVOT_CHOICE: f64 = 0.2;

/// Pivots under this size, rows scaled to 1, are zero: the constraints are dependent.
const PIVOT_LIMIT: f64 = 1e-10;

impl Removal {
    /// *Coordinate removal.* `u` are `n − h` of the coordinates, the others are memory with `ẇ = K u̇ + c`.
    ///
    /// # Errors
    /// [`RemovalError::NotLinear`] where a constraint is not linear in `v`; [`RemovalError::Dependent`] where `A` at `state` has
    /// no full row rank.
    ///
    /// ```
    /// # let mut system = mechanics::System::new(symbolic::Graph::new(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
    /// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
    /// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
    /// # let start = mechanics::State { t: 0.0, q: vec![0.0, 0.0, 0.3], v: vec![0.5, 0.5 * f64::tan(0.3), 1.0] };
    /// // the ice sledge: y'*cos(phi) - x'*sin(phi)
    /// let removal = mechanics::Removal::by_coordinates(&system, &start)?;
    /// let names: Vec<String> = removal.parameters.iter().map(|u| system.graph.name(u.symbol)).collect();
    /// assert_eq!(names, ["x", "phi"]);
    /// assert_eq!(system.graph.plain(removal.memory[0].rate), "x'*sin(phi)/cos(phi)");
    /// removal.verify(&system)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn by_coordinates(system: &System, state: &State) -> Result<Removal, RemovalError> {
        let split = Split::new(system, state)?;
        let memory = split.dependent.iter().enumerate().map(|(row, &i)| MemoryVariable {
            symbol: system.coordinates[i].position,
            rate: split.rate(system, row, &system.graph.variables(&split.independent_rates(system))),
            coordinate: Some(i),
        });
        Ok(Removal {
            name: "coordinates".into(),
            parameters: split.independent.iter().map(|&i| coordinate_parameter(system, i)).collect(),
            memory: memory.collect(),
            coordinates: system.graph.variables(&system.positions()),
            start: BTreeMap::new(),
            constants: ConstantsRule::Zero,
        })
    }

    /// *Quasi-velocity removal.* `q̇ = N(q) u̇ + c(q)`, the columns of `N` a basis of the kernel of `A`, cleared of denominators.
    ///
    /// A column with one entry is a coordinate and stays one; every other coordinate is memory. Knife edge: `u̇` is the
    /// speed along the blade.
    ///
    /// # Errors
    /// As [`Removal::by_coordinates`].
    ///
    /// ```
    /// # let mut system = mechanics::System::new(symbolic::Graph::new(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
    /// # system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x")?;
    /// # system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
    /// # let start = mechanics::State { t: 0.0, q: vec![0.0, 0.0, 0.3], v: vec![0.5, 0.5 * f64::tan(0.3), 1.0] };
    /// // the ice sledge: y'*cos(phi) - x'*sin(phi)
    /// let removal = mechanics::Removal::by_quasi_velocities(&system, &start)?;
    /// let rates: Vec<String> = removal.memory.iter().map(|w| system.graph.plain(w.rate)).collect();
    /// assert_eq!(rates, ["u_x'*cos(phi)", "u_x'*sin(phi)"]);
    /// removal.verify(&system)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn by_quasi_velocities(system: &System, state: &State) -> Result<Removal, RemovalError> {
        let g = &system.graph;
        let split = Split::new(system, state)?;
        let mut parameters = Vec::new();
        let mut memory = Vec::new();
        let mut start = BTreeMap::new();
        let mut rates = Vec::new();
        for (column, &i) in split.independent.iter().enumerate() {
            let entries = split.solution.column(column);
            if entries.iter().all(|&e| g.is_zero(e)) {
                parameters.push(coordinate_parameter(system, i));
                rates.push(g.variable(system.coordinates[i].velocity));
                continue;
            }
            let name = parameter_name(system, i);
            let u = DisplacementParameter {
                symbol: g.symbol(&name),
                rate: g.symbol(&format!("{name}'")),
                second_rate: g.symbol(&format!("{name}''")),
                coordinate: None,
            };
            let denominator = g.product(&g.denominators(&entries));
            let rate = g.mul(denominator, g.variable(u.rate));
            start.insert(u.symbol, g.zero());
            start.insert(u.rate, g.div(g.variable(system.coordinates[i].velocity), denominator));
            memory.push(MemoryVariable { symbol: system.coordinates[i].position, rate, coordinate: Some(i) });
            parameters.push(u);
            rates.push(rate);
        }
        for (row, &i) in split.dependent.iter().enumerate() {
            let rate = split.rate(system, row, &rates);
            memory.push(MemoryVariable { symbol: system.coordinates[i].position, rate, coordinate: Some(i) });
        }
        memory.sort_by_key(|w| w.coordinate);
        Ok(Removal {
            name: "quasi-velocities".into(),
            parameters,
            memory,
            coordinates: g.variables(&system.positions()),
            start,
            constants: ConstantsRule::Zero,
        })
    }
}

/// `u_x` for the coordinate `x`, with underscores until it is no name of the system. Removals may share symbols.
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

/// `v_d = K v_i + c`.
pub(crate) struct Split {
    dependent: Vec<usize>,
    independent: Vec<usize>,
    /// K, h×m.
    solution: Matrix,
    /// c, h.
    pub(crate) offset: Vec<Expr>,
}

impl Split {
    pub(crate) fn new(system: &System, state: &State) -> Result<Split, RemovalError> {
        let g = &system.graph;
        let (n, h) = (system.dimension(), system.constraints.len());
        if let Some(index) = first_nonlinear(system) {
            let text = g.plain(system.constraints[index]);
            return Err(RemovalError::NotLinear { constraint: index + 1, text });
        }
        let mut values = system.parameter_values();
        values.extend(system.values_at(state));
        let at_rest: HashMap<Symbol, Expr> = system.velocities().into_iter().map(|v| (v, g.zero())).collect();
        let jacobian = system.constraint_jacobian();
        // rows of the working matrix: [A | b]
        let mut rows: Vec<Vec<Expr>> = (0..h)
            .map(|i| {
                let mut row = jacobian.row(i).to_vec();
                row.push(g.substitute(system.constraints[i], &at_rest));
                row
            })
            .collect();
        let constants = system.parameter_values();
        let mut pivots: Vec<(usize, usize)> = Vec::new();
        for _ in 0..h {
            let (row, column) = choose_pivot(g, &rows, &pivots, n, &values)?;
            let pivot = rows[row][column];
            for e in &mut rows[row] {
                *e = g.div(*e, pivot);
            }
            let pivot_row = rows[row].clone();
            for (i, other) in rows.iter_mut().enumerate() {
                let factor = other[column];
                if i == row || g.is_zero(factor) {
                    continue;
                }
                for (e, &p) in other.iter_mut().zip(&pivot_row) {
                    let rest = g.sub(*e, g.mul(factor, p));
                    // what cancels without simplifying would be taken for a pivot, or for a dependence that is not there
                    *e = if g.vanishes(rest, &constants).is_zero() { g.zero() } else { rest };
                }
            }
            pivots.push((row, column));
        }
        pivots.sort_by_key(|&(_, column)| column);
        let dependent: Vec<usize> = pivots.iter().map(|&(_, column)| column).collect();
        let independent: Vec<usize> = (0..n).filter(|j| !dependent.contains(j)).collect();
        let entry = |i: usize, j: usize| g.neg(rows[pivots[i].0][independent[j]]);
        let solution = Matrix::from_fn(h, independent.len(), entry);
        let offset = pivots.iter().map(|&(row, _)| g.neg(rows[row][n])).collect();
        Ok(Split { dependent, independent, solution, offset })
    }

    /// Fields that span the admissible directions in the space of `q`, or of `(q, t)`.
    pub(crate) fn fields(&self, system: &System, with_time: bool) -> Vec<Vec<Expr>> {
        let g = &system.graph;
        let size = system.dimension() + usize::from(with_time);
        let field = |own: usize, of_dependent: &dyn Fn(usize) -> Expr| {
            let mut x = vec![g.zero(); size];
            x[own] = g.one();
            for (row, &i) in self.dependent.iter().enumerate() {
                x[i] = of_dependent(row);
            }
            x
        };
        let mut fields: Vec<Vec<Expr>> = (0..self.independent.len())
            .map(|column| field(self.independent[column], &|row| self.solution[(row, column)]))
            .collect();
        if with_time {
            fields.push(field(size - 1, &|row| self.offset[row]));
        }
        fields
    }

    fn independent_rates(&self, system: &System) -> Vec<Symbol> {
        self.independent.iter().map(|&i| system.coordinates[i].velocity).collect()
    }

    /// Row of `K v_i + c`.
    fn rate(&self, system: &System, row: usize, independent: &[Expr]) -> Expr {
        let g = &system.graph;
        g.add(g.dot(self.solution.row(row), independent), self.offset[row])
    }
}

fn first_nonlinear(system: &System) -> Option<usize> {
    let (g, v) = (&system.graph, system.velocities());
    let jacobian = system.constraint_jacobian();
    (0..system.constraints.len()).find(|&i| jacobian.row(i).iter().any(|&e| v.iter().any(|&s| g.depends_on(e, s))))
}

/// Among the pivots that are large enough at the start, the one with the shortest expression.
fn choose_pivot(
    g: &Graph,
    rows: &[Vec<Expr>],
    taken: &[(usize, usize)],
    columns: usize,
    values: &HashMap<Symbol, f64>,
) -> Result<(usize, usize), RemovalError> {
    let mut candidates: Vec<(f64, usize, (usize, usize))> = Vec::new();
    for (i, row) in rows.iter().enumerate().filter(|(i, _)| !taken.iter().any(|t| t.0 == *i)) {
        let numbers: Vec<f64> = row[..columns].iter().map(|&e| g.evaluate(e, values).unwrap_or(f64::NAN)).collect();
        let scale = numbers.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        for (j, x) in numbers.iter().enumerate() {
            let size = if scale > 0.0 { x.abs() / scale } else { 0.0 };
            if size.is_finite() && size > 0.0 {
                candidates.push((size, g.size(&[row[j]]), (i, j)));
            }
        }
    }
    let largest = candidates.iter().fold(0.0_f64, |a, c| a.max(c.0));
    if largest < PIVOT_LIMIT {
        return Err(RemovalError::Dependent { pivot: largest, limit: PIVOT_LIMIT });
    }
    candidates.retain(|c| c.0 >= PIVOT_CHOICE * largest);
    candidates.sort_by(|a, b| a.1.cmp(&b.1).then(b.0.total_cmp(&a.0)).then(a.2.cmp(&b.2)));
    Ok(candidates[0].2)
}
