//! Which values get a series of their own.

use super::{Builder, Decision};
use crate::programs::program::{Id, Value};

impl Builder<'_> {
    /// Decides from the last value to the first, so that all users of a value come before it.
    pub(super) fn decide(&mut self) {
        let n = self.program.len();
        let (mut linear, mut factor) = (vec![0_usize; n], vec![0_usize; n]);
        self.decisions = vec![Decision::None; n];
        for o in self.outputs {
            linear[*o as usize] += 2;
        }
        let (mut integrated, mut kept) = (vec![false; n], vec![false; n]);
        for (id, i) in &self.integrated {
            integrated[*id as usize] = true;
            linear[i.rate as usize] += 2;
        }
        for id in (0..n).rev() {
            let (terms, factors) = (linear[id], factor[id]);
            if terms + factors == 0 || !self.varies(id as Id) {
                continue;
            }
            if let Some(of) = self.derivatives.get(&(id as Id)) {
                self.decisions[id] = Decision::Row;
                linear[*of as usize] += 2;
                kept[*of as usize] = true;
                continue;
            }
            let value = self.program.value(id as Id);
            let multiple = self.multiple(id as Id);
            let bilinear = multiple.is_some()
                || matches!(value, Value::Add(..) | Value::Sub(..) | Value::Mul(..) | Value::Square(_));
            self.decisions[id] = if bilinear && terms == 1 && factors == 0 {
                Decision::Absorbed
            } else if multiple.is_some() && !kept[id] {
                Decision::Peeled
            } else {
                Decision::Row
            };
            if let Some((_, a)) = multiple {
                match self.decisions[id] {
                    Decision::Peeled => {
                        factor[a as usize] += factors;
                        linear[a as usize] += terms;
                    }
                    _ => linear[a as usize] += 1,
                }
                continue;
            }
            match value {
                Value::Add(a, b) | Value::Sub(a, b) => {
                    linear[a as usize] += 1;
                    linear[b as usize] += 1;
                }
                Value::Div(a, b) => {
                    linear[a as usize] += 1;
                    factor[b as usize] += usize::from(!self.is_line(b));
                }
                Value::Recip(b) if self.is_line(b) => {}
                Value::Mul(a, b) if self.is_line(a) => factor[b as usize] += 1,
                Value::Mul(a, b) if self.is_line(b) => factor[a as usize] += 1,
                Value::Call(..) | Value::Logistic(_) | Value::Sech(_) if integrated[id] => {}
                _ => {
                    let (operands, count) = value.operands();
                    for o in &operands[..count] {
                        factor[*o as usize] += 1;
                    }
                }
            }
        }
    }
}
