//! The elementary functions.

use crate::Scalar;
use crate::store::number::Number;

/// An elementary function of one argument.
///
/// ```
/// use symbolic::Function;
/// assert_eq!(Function::Asinh.name(), "asinh");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Function {
    /// sin u
    Sin,
    /// cos u
    Cos,
    /// tan u
    Tan,
    /// sinh u
    Sinh,
    /// cosh u
    Cosh,
    /// tanh u
    Tanh,
    /// arcsin u, in [−π/2, π/2]
    Asin,
    /// arccos u, in [0, π]
    Acos,
    /// arctan u, in (−π/2, π/2)
    Atan,
    /// arsinh u
    Asinh,
    /// arcosh u, for u ≥ 1
    Acosh,
    /// artanh u, for |u| < 1
    Atanh,
    /// eᵘ
    Exp,
    /// the natural logarithm of u, for u > 0
    Log,
}

impl Function {
    /// All of them.
    pub const ALL: [Function; 14] = {
        use Function::*;
        [Sin, Cos, Tan, Sinh, Cosh, Tanh, Asin, Acos, Atan, Asinh, Acosh, Atanh, Exp, Log]
    };

    /// Their names, in the same order.
    pub(crate) const NAMES: [&str; 14] =
        ["sin", "cos", "tan", "sinh", "cosh", "tanh", "asin", "acos", "atan", "asinh", "acosh", "atanh", "exp", "log"];

    /// The name under which [`Graph::parse`](crate::Graph::parse) knows it.
    pub fn name(self) -> &'static str {
        Function::NAMES[self as usize]
    }

    /// −1 for an odd function, 1 for an even one, 0 for neither.
    pub(crate) fn parity(self) -> i8 {
        match self {
            Function::Cos | Function::Cosh => 1,
            Function::Acos | Function::Acosh | Function::Exp | Function::Log => 0,
            _ => -1,
        }
    }

    /// The value at 0, where that is rational.
    pub(crate) fn at_zero(self) -> Option<Number> {
        match self {
            Function::Cos | Function::Cosh | Function::Exp => Some(Number::ONE),
            Function::Acos | Function::Acosh | Function::Log => None,
            _ => Some(Number::ZERO),
        }
    }

    /// Its value at `x`, in any numbers.
    ///
    /// ```
    /// assert_eq!(symbolic::Function::Exp.apply(0.0), 1.0);
    /// ```
    pub fn apply<T: Scalar>(self, x: T) -> T {
        match self {
            Function::Sin => x.sin(),
            Function::Cos => x.cos(),
            Function::Tan => x.tan(),
            Function::Sinh => x.sinh(),
            Function::Cosh => x.cosh(),
            Function::Tanh => x.tanh(),
            Function::Asin => x.asin(),
            Function::Acos => x.acos(),
            Function::Atan => x.atan(),
            Function::Asinh => x.asinh(),
            Function::Acosh => x.acosh(),
            Function::Atanh => x.atanh(),
            Function::Exp => x.exp(),
            Function::Log => x.log(),
        }
    }
}
