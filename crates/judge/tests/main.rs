//! Motions with secret numbers, made by code that shares nothing with the regression; tables and orders.

mod balance;
mod by_hand;
mod made;
mod tables;
