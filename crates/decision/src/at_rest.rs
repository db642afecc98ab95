//! Starts from which nothing moves, exactly.

use symbolic::{Evaluator, Expr, Symbol};

use crate::exact::{Exact, Jet, Modular};
use crate::start::ExactStart;

impl ExactStart {
    /// Whether nothing moves from here on, exactly: all velocities are zero, neither time nor a term without
    /// velocities stands in linear constraints, and reactions `λ` balance `∂L/∂q + Q + Aᵀ λ = 0`. Then
    /// `C = 0`, and every `μ₀` gives this motion (theorem 3, iv). `false` where fractions do not tell.
    pub fn is_at_rest(&self) -> bool {
        let (system, g) = (&self.system, &self.system.graph);
        let is_linear =
            system.linear_constraints().is_ok_and(|forms| forms.offsets.iter().all(|&e| g.vanishes_exactly(e)));
        let suits = is_linear && system.is_autonomous() && system.virtual_conditions.is_empty();
        suits && self.balance().is_some_and(is_solvable)
    }

    /// Rows `A_1i … A_hi` and `∂L/∂q_i + Q_i`; none where nothing acts, `None` where something moves or
    /// `A` is not known in fractions.
    fn balance(&self) -> Option<Vec<Row>> {
        let (system, g, n) = (&self.system, &self.system.graph, self.system.dimension());
        let forces = g.gradient(system.lagrangian, &system.positions()).into_iter().zip(&system.forces);
        let forces: Vec<Expr> = forces.map(|(by_q, &force)| g.add(by_q, force)).collect();
        let mut inputs: Vec<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        inputs.push(system.time);
        inputs.extend(system.positions().into_iter().chain(system.velocities()));
        let outputs = [&forces[..], system.constraint_jacobian().entries()].concat();
        let program = g.tape(&inputs, &outputs).ok()?;
        let (parameters, time) = self.given::<Modular>();
        let [q, v] = self.written_state(&parameters, time, &[]).ok()?;
        let is_zero = |x: &Jet<Modular>| x.exact().is_some_and(|x| x.is_zero());
        if !v.iter().all(is_zero) {
            return None;
        }
        let values = Evaluator::<Jet<Modular>>::new(program.clone())
            .evaluate(&[&parameters[..], &[time], &q, &v].concat())
            .to_vec();
        if values.iter().any(|x| x.own_flaw().is_some()) {
            return None;
        }
        let (forces, slopes) = values.split_at(n);
        if forces.iter().all(is_zero) {
            return Some(Vec::new());
        }
        let row = |i: usize| {
            let slopes: Option<Vec<Exact>> = slopes.iter().skip(i).step_by(n).map(Jet::exact).collect();
            slopes.map(|slopes| (slopes, forces[i].exact()))
        };
        (0..n).map(row).collect()
    }
}

/// A row of `A`, and of `b` where that is a fraction.
type Row = (Vec<Exact>, Option<Exact>);

/// Whether some `λ` make `A λ + b = 0`; `false` where fractions do not tell.
fn is_solvable(mut rows: Vec<Row>) -> bool {
    for column in 0..rows.first().map_or(0, |row| row.0.len()) {
        let Some(pivot) = rows.iter().position(|row| !row.0[column].is_zero()) else { continue };
        let (row, b) = rows.swap_remove(pivot);
        for (other, own) in rows.iter_mut().filter(|other| !other.0[column].is_zero()) {
            let factor = row[column].recip().and_then(|over| other[column].checked_mul(over));
            let less = |x: Exact, y: Exact| x.add(y.checked_mul(factor?)?.neg());
            *own = own.zip(b).and_then(|(own, b)| less(own, b));
            let cleared: Option<Vec<Exact>> = other.iter().zip(&row).map(|(&x, &y)| less(x, y)).collect();
            let Some(cleared) = cleared else { return false };
            *other = cleared;
        }
    }
    rows.iter().all(|(_, b)| b.is_some_and(Exact::is_zero))
}
