//! Progressive radiosity: choose a patch, shoot its unshot radiosity, refine where it falls, until little is left.
//!
//! The solver does no I/O and prints nothing; it speaks to an [`Observer`]. Imports `geometry`, `radiometry`, `mesh`,
//! `form_factor` and the visibility trait.

mod burial;
mod escape;
mod feelers;
mod ledger;
mod observer;
mod options;
mod refine;
mod regather;
mod run;
mod shoot;
mod source;
mod state;

pub use ledger::Ledger;
pub use observer::{Control, Observer, Progress, Silent};
pub use options::{FormFactorRule, Options, Preset, Quantity, Shooting};
pub use run::{Outcome, Solver, StopReason, occluders};
pub use state::Light;
