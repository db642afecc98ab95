//! The natural end of a removed motion: `P₀` such that `P_N = 0`.

use nalgebra::{DMatrix, DVector};

use crate::DiscreteError;
use crate::newton::largest;
use crate::step::Node;
use crate::sum::Compensated;

/// `|P_N|` relative to `1 + |P₀|` under which the end counts as natural.
const NATURAL: f64 = 1e-14;

/// What round-off may leave of `P_N` where it has stopped to shrink.
const ROUND_OFF: f64 = 1e-9;

/// Marches with another `P₀` than before, those for the differences not counted.
const ATTEMPTS: usize = 30;

/// Relative change of `P₀` for the differences.
const DIFFERENCE: f64 = 1e-6;

/// How the momenta at the start depend on `P₀`.
#[derive(Clone, Debug)]
pub(super) struct Natural {
    /// The `P₀` (k) to which the node at the start belongs.
    pub(super) first: Vec<f64>,
    /// `∂p₀/∂P₀`, (m + k)×k: `B_u̇ᵀ` over `−1`. Does not depend on `P₀`.
    pub(super) slopes: DMatrix<f64>,
}

impl Natural {
    /// Nodes of the `march` from `start` to `end` with `P_N = 0`: Newton on `P₀`, Jacobian by differences.
    ///
    /// `P_N` is the momentum of the free `w_N`: `D₂S(N−1,N) = −P_N`.
    pub(super) fn shoot(
        &self,
        start: &Node,
        end_time: f64,
        mut march: impl FnMut(Node) -> Result<Vec<Node>, DiscreteError>,
    ) -> Result<Vec<Node>, DiscreteError> {
        let (count, mut costates, mut before) = (self.first.len(), self.first.clone(), f64::INFINITY);
        for _ in 0..ATTEMPTS {
            let nodes = march(self.node(start, &costates))?;
            let end = self.end(&nodes);
            let scale = 1.0 + largest(&costates);
            let found = largest(end.as_slice()) / scale;
            if found <= NATURAL || (found <= ROUND_OFF && found >= 0.5 * before) {
                return Ok(nodes);
            }
            before = found;
            let mut jacobian = DMatrix::zeros(count, count);
            for i in 0..count {
                let mut moved = costates.clone();
                moved[i] += DIFFERENCE * scale;
                let other = self.end(&march(self.node(start, &moved))?);
                jacobian.set_column(i, &((other - &end) / (DIFFERENCE * scale)));
            }
            let correction = jacobian.full_piv_lu().solve(&end).ok_or(DiscreteError::Singular { t: end_time })?;
            costates.iter_mut().zip(correction.iter()).for_each(|(p, dp)| *p -= dp);
        }
        Err(DiscreteError::NoNaturalEnd { t: end_time, attempts: ATTEMPTS, found: before, limit: NATURAL })
    }

    /// The start with other costates.
    fn node(&self, start: &Node, costates: &[f64]) -> Node {
        let change =
            DVector::from_iterator(costates.len(), costates.iter().zip(&self.first).map(|(p, first)| p - first));
        let moved = &self.slopes * change;
        let p = start.p.value.iter().zip(moved.iter()).map(|(p, dp)| p + dp).collect();
        Node { p: Compensated::new(p), multipliers: costates.to_vec(), ..start.clone() }
    }

    /// `P_N`.
    fn end(&self, nodes: &[Node]) -> DVector<f64> {
        let p = &nodes[nodes.len() - 1].p.value;
        DVector::from_iterator(self.first.len(), p[p.len() - self.first.len()..].iter().map(|p| -p))
    }
}
