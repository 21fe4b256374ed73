//! Looking at a solution: the window of `radiosity view` and `radiosity solve --watch` (feature `viewer`).
//!
//! A [`Viewer`] is what the window shows and how it follows the hand: it turns [`Action`]s into a [`Look`]. A [`Studio`] draws
//! looks in a thread of its own, at first coarsely, then as `radiosity render` does. A [`Reading`] is the light at a point. None of
//! them needs a display; [`Window`] alone does. Imports `radiometry`, `scene`, `visibility`, `solution` and `render`.

mod exhibit;
mod keys;
mod look;
mod ply;
mod reading;
mod rig;
mod state;
mod studio;
#[cfg(test)]
mod tests;
mod window;

pub use exhibit::{Exhibit, Labels};
pub use look::{Fineness, Frame, Look, Quantity};
pub use ply::read_ply;
pub use reading::Reading;
pub use state::{Action, Viewer};
pub use studio::Studio;
pub use window::{Hooks, Screen, Window, WindowError};
