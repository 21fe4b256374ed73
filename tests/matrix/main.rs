//! Matrices of form factors: closed forms, independent quadrature, invariants, agreement with the solver, and what they become.

#[path = "../common/mod.rs"]
mod common;

mod accidents;
mod balance;
mod closed_forms;
mod covered;
mod grouping;
mod invariants;
mod obstructed;
mod published;
mod setup;
mod slits;
