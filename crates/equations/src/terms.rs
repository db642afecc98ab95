//! Programs in numbers that know what was added up to them.

use symbolic::{Bounded, Evaluator};

use crate::blocks::CompiledBlock;

/// Those of compiled equations.
#[derive(Clone)]
pub(crate) struct Terms {
    pub(crate) rates: Evaluator<Bounded>,
    pub(crate) outputs: Evaluator<Bounded>,
    pub(crate) steep: Evaluator<Bounded>,
    pub(crate) blocks: Vec<Evaluator<Bounded>>,
}

impl Terms {
    /// Of rates, outputs, arguments of steep functions, and blocks.
    pub(crate) fn new(programs: [&Evaluator<f64>; 3], blocks: &[CompiledBlock]) -> Terms {
        let again = |program: &Evaluator<f64>| Evaluator::new(program.tape().clone());
        let [rates, outputs, steep] = programs.map(again);
        Terms { rates, outputs, steep, blocks: blocks.iter().map(|block| again(&block.program)).collect() }
    }
}
