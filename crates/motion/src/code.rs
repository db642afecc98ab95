//! Equations of motion as source code in other languages, for other integrators.

mod c;
mod python;

use std::collections::{BTreeMap, HashSet};
use std::fmt::Write;

use equations::{Block, Role};
use scene::Scene;
use symbolic::{Code, Expr, Language, Matrix, Symbol};

use crate::{EquationStyle, Prepared, SolveError, equations_text};

/// The equations as a source file: `ẏ = F(t, y)`, outputs at `(t, y)` (coordinates, velocities, multipliers,
/// invariants), the start, and every parameter and free constant as a value to be changed.
///
/// C99: functions without allocation, which solve the blocks as we do. NumPy: functions of one state or of
/// any number, shape `(…, m)`. SymPy: matrices in symbols, with the unknowns `z` of the instant, `A z = b`.
///
/// # Errors
/// [`SolveError::NotLinear`] where a block is not linear in its unknowns.
pub fn code(scene: &Scene, prepared: &Prepared, language: Language) -> Result<String, SolveError> {
    let listing = Listing::new(scene, prepared, language)?;
    match language {
        Language::C => c::file(&listing),
        Language::Numpy => python::numpy(&listing),
        Language::Sympy => python::sympy(&listing),
    }
}

/// Where the value of an input is found.
#[derive(Clone, Copy)]
enum Place {
    Time,
    State(usize),
    Unknown(usize),
    Constant(usize),
}

/// `A z = b` of some unknowns.
struct LinearSystem<'a> {
    block: &'a Block,
    matrix: Matrix,
    right: Vec<Expr>,
}

/// What stands in a file of any language.
struct Listing<'a> {
    scene: &'a Scene,
    prepared: &'a Prepared,
    language: Language,
    /// What expressions contain, with the names that they have in the file.
    inputs: Vec<(Symbol, String)>,
    places: Vec<Place>,
    /// Parameters and free constants: the name in the file, the name, the value.
    constants: Vec<(String, String, f64)>,
    systems: Vec<LinearSystem<'a>>,
    rates: Vec<Expr>,
    /// Outputs: names and expressions.
    outputs: Vec<(String, Expr)>,
}

impl<'a> Listing<'a> {
    fn new(scene: &'a Scene, prepared: &'a Prepared, language: Language) -> Result<Self, SolveError> {
        let equations = &prepared.equations;
        let g = &equations.graph;
        let mut systems = Vec::new();
        for block in &equations.blocks {
            let (matrix, Some(rest)) = equations.linear_system(block) else {
                let formulation = equations.formulation.into();
                let unknowns: Vec<String> = block.unknowns.iter().map(|&z| g.name(z)).collect();
                return Err(SolveError::NotLinear { formulation, unknowns: unknowns.join(", ") });
            };
            systems.push(LinearSystem { block, matrix, right: rest.into_iter().map(|e| g.neg(e)).collect() });
        }
        let rates: Vec<Expr> = equations.states.iter().map(|y| y.rate).collect();
        let coordinates = || scene.system.coordinates.iter().map(|c| c.name.clone());
        let positions = coordinates().zip(equations.coordinates.iter().copied());
        let velocities = coordinates().map(|name| name + "'").zip(equations.velocities.iter().copied());
        let named = equations.multipliers.iter().chain(&equations.invariants).map(|n| (n.name.clone(), n.expression));
        let outputs: Vec<(String, Expr)> = positions.chain(velocities).chain(named).collect();

        let residuals = equations.blocks.iter().flat_map(|block| block.residuals.iter().copied());
        let all = residuals.chain(rates.iter().copied()).chain(outputs.iter().map(|(_, e)| *e));
        let occurring = equations.symbols_behind(all);
        let mut constants: Vec<(Symbol, f64)> = equations.parameters.iter().map(|(&s, &x)| (s, x)).collect();
        constants.sort_by_key(|(symbol, _)| *symbol);
        constants.extend(equations.constant_symbols().into_iter().zip(prepared.constants.iter().copied()));
        constants.retain(|(symbol, _)| occurring.contains(symbol));

        let states = equations.states.iter().enumerate().map(|(i, y)| (y.symbol, Place::State(i)));
        let unknowns = equations.unknowns().into_iter().enumerate().map(|(i, z)| (z, Place::Unknown(i)));
        let given = constants.iter().enumerate().map(|(i, (symbol, _))| (*symbol, Place::Constant(i)));
        let known = [(equations.time, Place::Time)].into_iter().chain(states).chain(unknowns).chain(given);
        let (symbols, places): (Vec<Symbol>, Vec<Place>) = known.unzip();
        let names = identifiers(symbols.iter().map(|&s| g.name(s)));
        let first = names.len() - constants.len();
        let value = |(name, (symbol, value)): (&String, &(Symbol, f64))| (name.clone(), g.name(*symbol), *value);
        Ok(Listing {
            constants: names[first..].iter().zip(&constants).map(value).collect(),
            inputs: symbols.into_iter().zip(names).collect(),
            scene,
            prepared,
            language,
            places,
            systems,
            rates,
            outputs,
        })
    }

    /// Some expressions as lines of code.
    fn code(&self, outputs: &[Expr]) -> Result<Code, SolveError> {
        Ok(self.prepared.equations.code(self.language, &self.inputs, outputs)?)
    }

    /// `A` and `b` of all blocks, one after the other.
    fn instant(&self) -> Result<Code, SolveError> {
        let entries = self.systems.iter().flat_map(|s| s.matrix.entries().iter().chain(&s.right));
        self.code(&entries.copied().collect::<Vec<Expr>>())
    }

    /// The entries of [`Listing::instant`] again: rows of `A`, and `b`, of each block.
    fn instant_of<'c>(&self, code: &'c Code) -> Vec<(Vec<&'c [String]>, &'c [String])> {
        let mut rest = &code.outputs[..];
        let mut take = |count: usize| {
            let (front, back) = rest.split_at(count);
            rest = back;
            front
        };
        let sizes = self.systems.iter().map(|s| s.right.len());
        sizes.map(|n| (take(n * n).chunks(n).collect(), take(n))).collect()
    }

    fn state_names(&self) -> Vec<String> {
        let equations = &self.prepared.equations;
        equations.states.iter().map(|y| equations.graph.name(y.symbol)).collect()
    }

    fn output_names(&self) -> Vec<&str> {
        self.outputs.iter().map(|(name, _)| name.as_str()).collect()
    }

    fn output_expressions(&self) -> Vec<Expr> {
        self.outputs.iter().map(|(_, e)| *e).collect()
    }

    /// The name and the place of each input that occurs in `code`.
    fn used(&self, code: &Code) -> impl Iterator<Item = (&str, Place)> {
        let named = self.inputs.iter().zip(&self.places);
        named.filter(|((symbol, _), _)| code.inputs.contains(symbol)).map(|((_, name), &place)| (name.as_str(), place))
    }

    fn uses_unknowns(&self, code: &Code) -> bool {
        self.used(code).any(|(_, place)| matches!(place, Place::Unknown(_)))
    }

    fn name(&self, symbol: Symbol) -> &str {
        self.inputs.iter().find(|(s, _)| *s == symbol).map_or("", |(_, name)| name)
    }

    /// What the file is about; `usage` says how its functions are called.
    fn about(&self, usage: &str) -> String {
        let equations = &self.prepared.equations;
        let g = &equations.graph;
        let mut text = format!(
            "{}\n\nEquations of motion y' = F(t, y), formulation {}, written by deltaq {}.\n\n{usage}\n\nStates y, \
             started at t0 = {:?}:\n",
            self.scene.title,
            equations.formulation,
            env!("CARGO_PKG_VERSION"),
            self.prepared.t
        );
        let units: BTreeMap<Symbol, &str> =
            self.scene.system.coordinates.iter().map(|c| (c.position, c.unit.as_str())).collect();
        for (i, (y, start)) in equations.states.iter().zip(&self.prepared.start).enumerate() {
            let unit = match (y.role, units.get(&y.symbol)) {
                (Role::Position, Some(unit)) if !unit.is_empty() => format!("  [{unit}]"),
                _ => String::new(),
            };
            let _ = writeln!(text, "  {i}  {} = {start:?}{unit}", g.name(y.symbol));
        }
        let _ = writeln!(text, "\nOutputs:");
        for (i, name) in self.output_names().into_iter().enumerate() {
            let _ = writeln!(text, "  {i}  {name}");
        }
        let _ = write!(text, "\nEquations:\n\n{}", equations_text(equations, EquationStyle::Plain));
        text
    }

    /// Where the equations cannot be solved, in the field's words; none where they always can.
    fn singular(&self) -> Option<String> {
        let mut words: Vec<&str> = self.systems.iter().map(|s| s.block.regular).collect();
        words.dedup();
        (!words.is_empty()).then(|| words.join(", "))
    }
}

/// Names that files use themselves, and that C99 or Python keep for themselves; a symbol gets another one.
const TAKEN: &str = "state parameters unknowns rates outputs matrix solve pow INFINITY NAN np sp _rows _unknowns \
    STATES OUTPUTS PARAMETERS TIME START UNKNOWNS MATRIX RIGHT RATES \
    auto break case char const continue default do double else enum extern float for goto if inline int long register \
    restrict return short signed sizeof static struct switch typedef union unsigned void volatile while \
    False None True and as assert async await class def del elif except finally from global import in is lambda \
    nonlocal not or pass raise try with yield";

/// Names as identifiers of C and Python: primes as `_dot`, `_ddot`, …; each only once.
fn identifiers(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut taken: HashSet<String> = TAKEN.split_whitespace().map(str::to_owned).collect();
    let identifier = |name: String| {
        let primes = name.chars().filter(|&c| c == '\'').count();
        let mut name = name.replace('\'', "");
        if primes > 0 {
            name += &format!("_{}ot", "d".repeat(primes));
        }
        while !taken.insert(name.clone()) {
            name.push('_');
        }
        name
    };
    names.map(identifier).collect()
}
