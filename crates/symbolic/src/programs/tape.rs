//! Flat programs for evaluating expressions many times.

use crate::programs::program::{Id, Program, Value};
use crate::store::number::Number;
use crate::{Function, Scalar};
use rustc_hash::FxHashMap;

mod adjoint;

pub use adjoint::Recorded;

/// Index of a register.
type Register = u32;

/// One step; the first register is where the result goes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Instruction {
    Copy(Register, Register),
    Neg(Register, Register),
    Square(Register, Register),
    Recip(Register, Register),
    Sqrt(Register, Register),
    Call(Function, Register, Register),
    Logistic(Register, Register),
    Sech(Register, Register),
    /// (sine, cosine, angle)
    SinCos(Register, Register, Register),
    Add(Register, Register, Register),
    Sub(Register, Register, Register),
    Mul(Register, Register, Register),
    Div(Register, Register, Register),
    Pow(Register, Register, Register),
    Atan2(Register, Register, Register),
    MulAdd(Register, Register, Register, Register),
    MulSub(Register, Register, Register, Register),
    NegMulAdd(Register, Register, Register, Register),
    Mul3(Register, Register, Register, Register),
}

/// A flat program from values of symbols to values of expressions, in any number type; `Send + Sync`.
///
/// ```
/// use std::collections::HashMap;
/// use symbolic::Graph;
/// let g = Graph::new();
/// let (x, k) = (g.symbol("x"), g.symbol("k"));
/// let e = g.mul(g.variable(k), g.powi(g.variable(x), 2));
/// let tape = g.compile(&[x], &[e], &HashMap::from([(k, 0.5)]))?;
/// let mut workspace = tape.workspace::<f64>();
/// let mut y = [0.0];
/// tape.evaluate(&[3.0], &mut workspace, &mut y);
/// assert_eq!(y, [4.5]);
/// # Ok::<(), symbolic::CompileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tape {
    inputs: usize,
    outputs: usize,
    registers: usize,
    constants: Vec<(Register, Number)>,
    /// What depends on no input: done once for a workspace.
    setup: Vec<Instruction>,
    body: Vec<Instruction>,
}

/// The registers of one thread that evaluates one [`Tape`].
#[derive(Clone, Debug)]
pub struct Workspace<T> {
    registers: Vec<T>,
}

impl Tape {
    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Number of instructions in one evaluation.
    pub fn len(&self) -> usize {
        self.body.len()
    }

    /// Does one evaluation compute nothing, because every output is a constant?
    pub fn is_empty(&self) -> bool {
        self.body.is_empty()
    }

    /// Registers for one thread of evaluation; they hold the constants as well.
    pub fn workspace<T: Scalar>(&self) -> Workspace<T> {
        let mut registers = vec![T::from_f64(0.0); self.registers];
        for (register, n) in &self.constants {
            registers[*register as usize] = match (n, n.fraction()) {
                (Number::Exact(r), _) => T::from_ratio(r.numerator(), r.denominator()),
                (_, Some(x)) => T::from_fraction(x),
                _ => T::rounded(n.to_f64()),
            };
        }
        run(&self.setup, &mut registers);
        Workspace { registers }
    }

    /// Evaluates all outputs; allocates nothing. A singular formula has singular output (∞ or NaN): look.
    ///
    /// # Panics
    /// If the slices are not as long as the inputs and outputs, or the workspace is another tape's.
    pub fn evaluate<T: Scalar>(&self, inputs: &[T], workspace: &mut Workspace<T>, outputs: &mut [T]) {
        let registers = &mut workspace.registers[..];
        assert_eq!(inputs.len(), self.inputs, "inputs of a tape");
        assert_eq!(outputs.len(), self.outputs, "outputs of a tape");
        assert_eq!(registers.len(), self.registers, "the workspace of another tape");
        registers[..self.inputs].copy_from_slice(inputs);
        let all = &mut *registers;
        T::vectorize(
            #[inline(always)]
            move || {
                let moved = all; // a closure that can be called once only is inlined as a whole
                run(&self.body, moved);
            },
        );
        outputs.copy_from_slice(&registers[self.inputs..self.inputs + self.outputs]);
    }

    /// Gives out registers: inputs first, then outputs, constants, and reused ones for the rest.
    pub(crate) fn assemble(program: &Program, inputs: usize, outputs: &[Id]) -> Self {
        let order = order_of_need(program, outputs);
        let mut assembly = Assembly {
            program,
            place: vec![None; program.len()],
            next: 0,
            free: Vec::new(),
            tape: Tape {
                inputs,
                outputs: outputs.len(),
                registers: 0,
                constants: Vec::new(),
                setup: Vec::new(),
                body: Vec::new(),
            },
        };
        assembly.next = register(inputs + outputs.len());
        assembly.assemble(&order, outputs);
        assembly.tape.registers = assembly.next as usize;
        assembly.tape
    }
}

fn register(index: usize) -> Register {
    Register::try_from(index).expect("fewer than 2^32 registers")
}

/// Values that outputs need, operands first, each as late as its first user.
pub(crate) fn order_of_need(program: &Program, outputs: &[Id]) -> Vec<Id> {
    let mut done = vec![false; program.len()];
    let mut order = Vec::new();
    let mut stack: Vec<(Id, bool)> = outputs.iter().rev().map(|o| (*o, false)).collect();
    while let Some((id, ready)) = stack.pop() {
        if done[id as usize] {
            continue;
        }
        if ready {
            done[id as usize] = true;
            order.push(id);
            continue;
        }
        stack.push((id, true));
        let (operands, count) = program.value(id).operands();
        stack.extend(operands[..count].iter().rev().map(|o| (*o, false)));
    }
    order
}

struct Assembly<'a> {
    program: &'a Program,
    place: Vec<Option<Register>>,
    next: Register,
    free: Vec<Register>,
    tape: Tape,
}

impl Assembly<'_> {
    fn fresh(&mut self) -> Register {
        self.next += 1;
        self.next - 1
    }

    fn assemble(&mut self, order: &[Id], outputs: &[Id]) {
        let program = self.program;
        let mut last_use = vec![0_usize; program.len()];
        for (step, id) in order.iter().enumerate() {
            let (operands, count) = program.value(*id).operands();
            for o in &operands[..count] {
                last_use[*o as usize] = step;
            }
        }
        let mut home: FxHashMap<Id, Register> = FxHashMap::default();
        for (slot, id) in outputs.iter().enumerate() {
            if !program.is_constant(*id) && !matches!(program.value(*id), Value::Input(_)) {
                home.entry(*id).or_insert(register(self.tape.inputs + slot));
            }
        }
        let calls = order.iter().map(|id| (program.value(*id), *id)).filter(|(v, _)| matches!(v, Value::Call(..)));
        let needed: FxHashMap<Value, Id> = calls.collect();
        let mut busy = vec![false; program.len()];
        for (step, id) in order.iter().copied().enumerate() {
            if self.place[id as usize].is_some() {
                self.release(&mut busy, id, step, &last_use);
                continue;
            }
            let value = program.value(id);
            if let Value::Input(i) = value {
                self.place[id as usize] = Some(i);
                continue;
            }
            if program.is_constant(id) {
                let to = self.fresh();
                self.place[id as usize] = Some(to);
                match value {
                    Value::Constant(n) => self.tape.constants.push((to, n)),
                    _ => {
                        let instruction = self.instruction(value, to);
                        self.tape.setup.push(instruction);
                    }
                }
                continue;
            }
            if let Some((sine, cosine, angle)) = self.sine_and_cosine(value, &needed) {
                let angle = self.at(angle);
                let to = [sine, cosine].map(|v| self.take(v, &home));
                self.tape.body.push(Instruction::SinCos(to[0], to[1], angle));
                self.release(&mut busy, id, step, &last_use);
                for v in [sine, cosine] {
                    busy[v as usize] = !home.contains_key(&v);
                }
                continue;
            }
            // The instruction reads before it writes, so the result may take an operand's place.
            let (operands, count) = value.operands();
            let at = operands.map(|o| self.place[o as usize]);
            self.release(&mut busy, id, step, &last_use);
            let to = self.take(id, &home);
            debug_assert!(at[..count].iter().all(Option::is_some));
            let instruction = self.instruction(value, to);
            self.tape.body.push(instruction);
            busy[id as usize] = !home.contains_key(&id);
        }
        for (slot, id) in outputs.iter().enumerate() {
            let to = register(self.tape.inputs + slot);
            let from = self.at(*id);
            if from != to {
                let constant = program.is_constant(*id);
                let part = if constant { &mut self.tape.setup } else { &mut self.tape.body };
                part.push(Instruction::Copy(to, from));
            }
        }
    }

    fn at(&self, id: Id) -> Register {
        self.place[id as usize].expect("operands come first")
    }

    fn take(&mut self, id: Id, home: &FxHashMap<Id, Register>) -> Register {
        let to = match home.get(&id) {
            Some(home) => *home,
            None => self.free.pop().unwrap_or_else(|| self.fresh()),
        };
        self.place[id as usize] = Some(to);
        to
    }

    /// Frees the registers of those operands of `id` that nothing needs after `step`.
    fn release(&mut self, busy: &mut [bool], id: Id, step: usize, last_use: &[usize]) {
        let (operands, count) = self.program.value(id).operands();
        for o in &operands[..count] {
            if last_use[*o as usize] == step && busy[*o as usize] {
                busy[*o as usize] = false;
                self.free.push(self.at(*o));
            }
        }
    }

    /// The sine, the cosine and the angle, if `value` is one of the two and both are needed.
    fn sine_and_cosine(&self, value: Value, needed: &FxHashMap<Value, Id>) -> Option<(Id, Id, Id)> {
        let Value::Call(Function::Sin | Function::Cos, angle) = value else {
            return None;
        };
        let sine = needed.get(&Value::Call(Function::Sin, angle))?;
        let cosine = needed.get(&Value::Call(Function::Cos, angle))?;
        Some((*sine, *cosine, angle))
    }

    fn instruction(&self, value: Value, to: Register) -> Instruction {
        let at = |id: Id| self.at(id);
        match value {
            Value::Input(_) | Value::Constant(_) => unreachable!("these are places, not steps"),
            Value::Neg(a) => Instruction::Neg(to, at(a)),
            Value::Square(a) => Instruction::Square(to, at(a)),
            Value::Recip(a) => Instruction::Recip(to, at(a)),
            Value::Sqrt(a) => Instruction::Sqrt(to, at(a)),
            Value::Call(f, a) => Instruction::Call(f, to, at(a)),
            Value::Logistic(a) => Instruction::Logistic(to, at(a)),
            Value::Sech(a) => Instruction::Sech(to, at(a)),
            Value::Add(a, b) => Instruction::Add(to, at(a), at(b)),
            Value::Sub(a, b) => Instruction::Sub(to, at(a), at(b)),
            Value::Mul(a, b) => Instruction::Mul(to, at(a), at(b)),
            Value::Div(a, b) => Instruction::Div(to, at(a), at(b)),
            Value::Pow(a, b) => Instruction::Pow(to, at(a), at(b)),
            Value::Atan2(a, b) => Instruction::Atan2(to, at(a), at(b)),
            Value::MulAdd(a, b, c) => Instruction::MulAdd(to, at(a), at(b), at(c)),
            Value::MulSub(a, b, c) => Instruction::MulSub(to, at(a), at(b), at(c)),
            Value::NegMulAdd(a, b, c) => Instruction::NegMulAdd(to, at(a), at(b), at(c)),
            Value::Mul3(a, b, c) => Instruction::Mul3(to, at(a), at(b), at(c)),
        }
    }
}

#[inline(always)]
fn run<T: Scalar>(instructions: &[Instruction], r: &mut [T]) {
    for instruction in instructions {
        match *instruction {
            Instruction::Copy(to, a) => r[to as usize] = r[a as usize],
            Instruction::Neg(to, a) => r[to as usize] = -r[a as usize],
            Instruction::Square(to, a) => r[to as usize] = r[a as usize] * r[a as usize],
            Instruction::Recip(to, a) => r[to as usize] = T::from_f64(1.0) / r[a as usize],
            Instruction::Sqrt(to, a) => r[to as usize] = r[a as usize].sqrt(),
            Instruction::Call(f, to, a) => r[to as usize] = f.apply(r[a as usize]),
            Instruction::Logistic(to, a) => r[to as usize] = r[a as usize].logistic(),
            Instruction::Sech(to, a) => r[to as usize] = r[a as usize].sech(),
            Instruction::SinCos(sine, cosine, a) => {
                (r[sine as usize], r[cosine as usize]) = r[a as usize].sin_cos();
            }
            Instruction::Add(to, a, b) => r[to as usize] = r[a as usize] + r[b as usize],
            Instruction::Sub(to, a, b) => r[to as usize] = r[a as usize] - r[b as usize],
            Instruction::Mul(to, a, b) => r[to as usize] = r[a as usize] * r[b as usize],
            Instruction::Div(to, a, b) => r[to as usize] = r[a as usize] / r[b as usize],
            Instruction::Pow(to, a, b) => r[to as usize] = r[a as usize].powf(r[b as usize]),
            Instruction::Atan2(to, a, b) => r[to as usize] = r[a as usize].atan2(r[b as usize]),
            Instruction::MulAdd(to, a, b, c) => {
                r[to as usize] = r[a as usize] * r[b as usize] + r[c as usize];
            }
            Instruction::MulSub(to, a, b, c) => {
                r[to as usize] = r[a as usize] * r[b as usize] - r[c as usize];
            }
            Instruction::NegMulAdd(to, a, b, c) => {
                r[to as usize] = r[c as usize] - r[a as usize] * r[b as usize];
            }
            Instruction::Mul3(to, a, b, c) => {
                r[to as usize] = r[a as usize] * r[b as usize] * r[c as usize];
            }
        }
    }
}

impl Workspace<f64> {
    pub(crate) fn is_finite(&self) -> bool {
        self.registers.iter().all(|x| x.is_finite())
    }
}
