//! Progressive radiosity: choose a patch, shoot its unshot radiosity, refine where it falls, until little is left.
//!
//! The solver does no I/O and prints nothing; it speaks to an [`Observer`]. Imports `geometry`, `radiometry`, `scene`,
//! `mesh`, `form_factor` and the visibility trait.

mod arrived;
mod audit;
mod behind;
mod bounce;
mod burial;
mod cells;
mod check;
mod conserve;
mod course;
mod descent;
mod error;
mod escape;
mod feelers;
mod fineness;
mod groups;
mod ledger;
mod light;
mod neighbourhoods;
mod observer;
mod open;
mod options;
mod outcome;
mod parts;
mod refine;
mod regather;
mod room;
mod run;
mod settle;
mod sheets;
mod shoot;
mod shot;
mod source;
mod sums;
mod tiling;
#[cfg(test)]
mod trial;
mod volley;
mod wave;

pub use audit::{Audit, Span};
pub use course::{Course, MeshingEnd};
pub use error::ErrorModel;
pub use ledger::Ledger;
pub use light::{Light, Sign};
pub use observer::{Control, Estimate, Observer, Phase, Progress, Silent};
pub use open::OpenLight;
pub use options::{Changes, FormFactorRule, Options, Preset, Quantity, Shooting};
pub use outcome::{Outcome, StopReason};
pub use parts::Parts;
pub use room::memory_for;
pub use run::{Solver, occluders};
