//! # Bodies
//!
//! From bodies with mass, inertia, joints, contacts, springs, dampers and motors to the formulas of a
//! mechanical system: definitions, terms of the Lagrangian, constraints, generalized forces and the picture,
//! each as text with the place of what it follows from.
//!
//! With `c` the place of a body's origin, `R` its rotation, `s` its mass centre, `J` its moments about it and
//! `ω` its turning rate in its own axes,
//!
//! ```text
//! L = Σ m |ċ_G|²/2 + ω·Jω/2 + m g·c_G,      c_G = c + R s
//! R = R_p A T Aᵀ,   c = c_p + R_p (at + A d) − R own      a joint: T its turn, d its shift, A its axes
//! s = ċ + ω × r − (velocity of the support there)         the slip at a contact, r from c to it
//! ```
//!
//! Where the surface of a convex body with support function `h` touches a plane with normal `n`,
//! `r = R ∇h(−Rᵀn)`; the row `s·n` is the rate of the height `n·c − h(−Rᵀn)` and is given as that height, a
//! constraint on positions. A body of revolution is carried by axes that do not turn with it: its own turn is
//! in `ω` only. Formulas are those that scenes are written in.

mod chain;
mod contact;
mod curved;
mod energy;
mod fault;
mod link;
mod machine;
mod text;
mod turn;

pub use fault::{Fault, FaultKind};
pub use machine::{
    Between, Body, Contact, Formulas, Inertia, Joint, Law, Link, LinkKind, Machine, Made, Motion, Picture, Row, Work,
    Written,
};
