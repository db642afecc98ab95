//! Expressions as straight-line code in other languages: the program that is compiled, line by line.

use super::lower;
use crate::limits::LINE;
use crate::programs::program::{Id, Value};
use crate::programs::tape::order_of_need;
use crate::store::number::Number;
use crate::text::print::Binds::{self, Atom, Product, Sum};
use crate::text::print_plain::number_text;
use crate::{CompileError, Expr, Function, Graph, Symbol};

/// A language that expressions are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// C99, in `double`.
    C,
    /// Python, on arrays of NumPy, which is called `np`.
    Numpy,
    /// Python, on arrays of JAX, whose `jax.numpy` is called `np`.
    Jax,
    /// Python, on numbers, for Numba; NumPy is called `np`.
    Numba,
    /// Python, on expressions of SymPy, which is called `sp`.
    Sympy,
}

/// Expressions as lines of code.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Code {
    /// Inputs that occur, in their order.
    pub inputs: Vec<Symbol>,
    /// Names with their values, each in inputs and earlier names.
    pub lines: Vec<(String, String)>,
    /// The outputs, in inputs and names.
    pub outputs: Vec<String>,
}

impl Graph {
    /// `outputs` by way of `definitions`, as in [`Graph::compile_with`], with a name for what is shared or
    /// long: `s1`, `s2`, …, except those that an input has. Inputs stand under the names given.
    ///
    /// ```
    /// use symbolic::{Graph, Language};
    /// let g = Graph::new();
    /// let (x, v) = (g.symbol("x"), g.symbol("x'"));
    /// let sine = g.call(symbolic::Function::Asin, g.variable(x));
    /// let outputs = [g.div(sine, g.integer(3)), g.mul(sine, g.variable(v))];
    /// let names = [(x, "x".into()), (v, "x_dot".into())];
    /// let code = g.code(Language::C, &names, &[], &outputs)?;
    /// assert_eq!(code.lines, [("s1".into(), "asin(x)".into())]);
    /// assert_eq!(code.outputs, ["1.0/3.0*s1", "x_dot*s1"]);
    /// let code = g.code(Language::Numpy, &names, &[], &outputs)?;
    /// assert_eq!(code.lines[0].1, "np.arcsin(x)");
    /// let code = g.code(Language::Sympy, &names, &[], &outputs)?;
    /// assert_eq!(code.outputs[0], "sp.Rational(1, 3)*s1");
    /// # Ok::<(), symbolic::CompileError>(())
    /// ```
    ///
    /// # Errors
    /// [`CompileError`] where a symbol is neither input nor earlier definition.
    pub fn code(
        &self,
        language: Language,
        inputs: &[(Symbol, String)],
        definitions: &[(Symbol, Expr)],
        outputs: &[Expr],
    ) -> Result<Code, CompileError> {
        let symbols: Vec<Symbol> = inputs.iter().map(|(symbol, _)| *symbol).collect();
        let mut bound = symbols.clone();
        for (symbol, e) in definitions {
            self.check_bound(&[*e], |s| bound.contains(&s))?;
            bound.push(*symbol);
        }
        self.check_bound(outputs, |s| bound.contains(&s))?;
        let (program, results) = lower::lower(&self.arena.borrow(), &symbols, definitions, outputs);
        let order = order_of_need(&program, &results);
        let mut uses = vec![0_usize; program.len()];
        for &id in &order {
            let (operands, count) = program.value(id).operands();
            operands[..count].iter().for_each(|&o| uses[o as usize] += 1);
            if let Value::Square(a) = program.value(id) {
                uses[a as usize] += 1; // written a*a
            }
        }
        results.iter().for_each(|&id| uses[id as usize] += 1);
        let mut texts = vec![(String::new(), Atom); program.len()];
        let (mut code, mut number) = (Code::default(), 0);
        for id in order {
            let value = match program.value(id) {
                Value::Mul(a, b) if program.is_constant(b) => Value::Mul(b, a),
                other => other,
            };
            let mut written = match value {
                Value::Input(i) => {
                    code.inputs.push(symbols[i as usize]);
                    (inputs[i as usize].1.clone(), Atom)
                }
                Value::Constant(n) => language.number(n),
                _ => language.operation(value, &texts),
            };
            let shared = uses[id as usize] > 1 || written.0.len() > LINE && !results.contains(&id);
            if shared && !matches!(value, Value::Input(_) | Value::Constant(_)) {
                let name = loop {
                    number += 1;
                    let name = format!("s{number}");
                    if inputs.iter().all(|(_, taken)| *taken != name) {
                        break name;
                    }
                };
                code.lines.push((name.clone(), written.0));
                written = (name, Atom);
            }
            texts[id as usize] = written;
        }
        code.inputs.sort_by_key(|symbol| symbols.iter().position(|s| s == symbol));
        code.outputs = results.iter().map(|&id| texts[id as usize].0.clone()).collect();
        Ok(code)
    }
}

impl Language {
    /// An operation on what is written already, with how tightly it binds. Nothing is associated anew, so
    /// that the result is rounded as ours is.
    fn operation(self, value: Value, texts: &[(String, Binds)]) -> (String, Binds) {
        let at = |id: Id, level: Binds| {
            let (text, binds) = &texts[id as usize];
            if *binds < level { format!("({text})") } else { text.clone() }
        };
        let call = |name: &str, arguments: &[Id]| {
            let arguments: Vec<String> = arguments.iter().map(|&a| at(a, Sum)).collect();
            (format!("{}({})", self.function(name), arguments.join(", ")), Atom)
        };
        match value {
            Value::Neg(a) => (format!("-{}", at(a, Atom)), Sum),
            Value::Square(a) => (format!("{0}*{0}", at(a, Atom)), Product),
            Value::Recip(a) => (format!("{}/{}", self.number(Number::ONE).0, at(a, Atom)), Product),
            Value::Add(a, b) => (format!("{} + {}", at(a, Sum), at(b, Product)), Sum),
            Value::Sub(a, b) => (format!("{} - {}", at(a, Sum), at(b, Product)), Sum),
            Value::Mul(a, b) => (format!("{}*{}", at(a, Product), at(b, Atom)), Product),
            Value::Div(a, b) => (format!("{}/{}", at(a, Product), at(b, Atom)), Product),
            Value::Sqrt(a) => call("sqrt", &[a]),
            Value::Call(function, a) => call(function.name(), &[a]),
            Value::Logistic(a) => {
                let one = self.number(Number::ONE).0;
                (format!("{one}/({one} + {}(-{}))", self.function("exp"), at(a, Atom)), Product)
            }
            Value::Sech(a) => (format!("{}/{}", self.number(Number::ONE).0, call("cosh", &[a]).0), Product),
            Value::Pow(a, b) => call("pow", &[a, b]),
            Value::Atan2(a, b) => call("atan2", &[a, b]),
            Value::Input(_) | Value::Constant(_) => unreachable!("these are written where they stand"),
            Value::MulAdd(..) | Value::MulSub(..) | Value::NegMulAdd(..) | Value::Mul3(..) => {
                unreachable!("the program is not fused")
            }
        }
    }

    /// The name of a function, by its name in C.
    fn function(self, name: &str) -> String {
        let inverse = Function::ALL.iter().any(|f| f.name() == name) && name.starts_with('a');
        match (self, name) {
            (Language::C, _) => name.into(),
            (Language::Sympy, "pow") => "sp.Pow".into(),
            (Language::Sympy, _) => format!("sp.{name}"),
            (_, "pow") => "np.power".into(),
            (_, _) if inverse || name == "atan2" => format!("np.arc{}", &name[1..]),
            (_, _) => format!("np.{name}"),
        }
    }

    /// A number; as exact as the language has it.
    fn number(self, n: Number) -> (String, Binds) {
        if n.is_negative() {
            return (format!("-{}", self.number(n.neg()).0), Sum);
        }
        let (above, below) = number_text(n);
        let decimal = format!("{:?}", n.to_f64());
        match (self, above.strip_suffix("pi"), n) {
            (Language::Sympy, Some(factor), _) => {
                (format!("{factor}sp.pi{}", below.map_or(String::new(), |d| format!("/{d}"))), Product)
            }
            (_, _, Number::Exact(r)) if self != Language::C && r.denominator() == 1 => (above, Atom),
            (Language::Sympy, _, Number::Exact(r)) => {
                (format!("sp.Rational({}, {})", r.numerator(), r.denominator()), Atom)
            }
            (_, None, Number::Exact(r)) if r.denominator() != 1 && Number::from_decimal(&decimal) != Some(n) => {
                let part = |n: i64| self.number(Number::integer(n)).0;
                (format!("{}/{}", part(r.numerator()), part(r.denominator())), Product)
            }
            _ => (decimal, Atom),
        }
    }
}
