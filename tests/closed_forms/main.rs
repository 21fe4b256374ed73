//! The form factors of a point against closed forms, published values and what must hold for any polygons.

#[path = "../common/mod.rs"]
mod common;

mod catalogue;
mod precision;
mod quadrature;
mod shapes;
mod traps;
