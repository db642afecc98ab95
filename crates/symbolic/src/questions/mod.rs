//! Questions about expressions: identically zero, in which range, of which symbols, with which divisors.

pub(crate) mod divisors;
pub(crate) mod identity;
pub(crate) mod made_of;
pub(crate) mod normal_form;
pub(crate) mod random;
pub(crate) mod range;
pub(crate) mod rational_identity;
pub(crate) mod steep;
