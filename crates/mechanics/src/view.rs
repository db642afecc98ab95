//! The drawing of a system: bodies, each a shape with a place and a rotation.

use symbolic::{CompileError, Evaluator, Expr, Graph, Matrix, Symbol};

use crate::System;
use crate::shape::{Place, Shape};

/// One body of a [`View`]: the point `p` of its shape is at `c + R p`.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// What it looks like, in its own axes.
    pub shape: Shape,
    /// `c(q, t)`, along the axes of space.
    pub at: [Expr; 3],
    /// `R(q, t)`, 3×3: from the axes of the body to those of space.
    pub rotation: Matrix,
    /// Where it touches other bodies, along the axes of space. Blades and carts slide there along their own x
    /// axis only; what is round rolls: its point and that of the other body have one velocity.
    pub touches: Vec<Touch>,
}

/// A contact.
#[derive(Clone, Debug)]
pub struct Touch {
    /// Place of the other body in [`View::bodies`].
    pub body: usize,
    /// Where, as a function of `(q, t)`.
    pub at: [Expr; 3],
}

/// The drawing of a system. No equation depends on it.
#[derive(Clone, Debug, Default)]
pub struct View {
    /// The expressions, in a graph of their own that knows the symbols of the system's.
    pub graph: Graph,
    /// The bodies. The first that moves with the coordinates is the one whose path is of interest.
    pub bodies: Vec<Body>,
}

/// Where a body is.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// `c`.
    pub at: Place,
    /// Rows of `R`.
    pub rotation: [Place; 3],
    /// Its contacts.
    pub touches: Vec<Place>,
}

impl Pose {
    /// The point whose path is drawn: where the body touches first, or else its place.
    pub fn marked(&self) -> Place {
        self.touches.first().copied().unwrap_or(self.at)
    }
}

impl Body {
    /// All its expressions: `c`, the rows of `R`, the contacts.
    pub fn expressions(&self) -> Vec<Expr> {
        let touches = self.touches.iter().flat_map(|touch| touch.at);
        self.at.into_iter().chain(self.rotation.entries().iter().copied()).chain(touches).collect()
    }
}

impl View {
    /// Whether `body` moves with the coordinates, and not as time alone says or not at all.
    pub fn is_moved(&self, system: &System, body: &Body) -> bool {
        let q = system.positions();
        body.expressions().iter().any(|&e| q.iter().any(|&q| self.graph.depends_on(e, q)))
    }

    /// The poses as a function of `(t, q)`, with the values of the system's parameters.
    ///
    /// # Errors
    /// [`CompileError`] where an expression contains another symbol.
    pub fn poses(&self, system: &System) -> Result<Poses, CompileError> {
        let inputs: Vec<Symbol> = [&[system.time], &system.positions()[..]].concat();
        let outputs: Vec<Expr> = self.bodies.iter().flat_map(Body::expressions).collect();
        let tape = self.graph.compile(&inputs, &outputs, &system.parameter_values())?;
        let touches = self.bodies.iter().map(|body| body.touches.len()).collect();
        Ok(Poses { touches, program: Evaluator::new(tape) })
    }
}

/// The poses of all bodies of a [`View`], compiled.
#[derive(Clone, Debug)]
pub struct Poses {
    /// Contacts of each body.
    touches: Vec<usize>,
    program: Evaluator<f64>,
}

impl Poses {
    /// The poses at `(t, q)`, in the order of the bodies.
    ///
    /// # Panics
    /// If `q` has another length than the system has coordinates.
    pub fn at(&mut self, t: f64, q: &[f64]) -> Vec<Pose> {
        let mut places = self.program.evaluate(&[&[t], q].concat()).chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
        let mut next = || places.next().unwrap_or([f64::NAN; 3]);
        let pose = |&touches: &usize| {
            let (at, rotation) = (next(), [next(), next(), next()]);
            Pose { at, rotation, touches: (0..touches).map(|_| next()).collect() }
        };
        self.touches.iter().map(pose).collect()
    }
}
