//! Motions with secret numbers, made by code that shares nothing with the regression.

mod by_hand;
mod made;
