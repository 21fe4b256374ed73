//! Camera pictures of a solution.
//!
//! A [`View`] looks once through a pinhole camera and keeps, per pixel, what its pictures need: the radiance as it
//! is, the same tone-mapped, a line drawing of the input polygons, and the boundaries of the elements. [`Tone`] maps
//! radiance to what a screen shows. Who looks around more than once from where it stands does so from a [`Place`].
//!
//! A side that does not radiate is see-through: a room can be looked at from outside through the back of its walls.
//! All pixels are computed in parallel and none depends on another, so a picture is the same for any number of
//! threads. Imports `geometry`, `radiometry`, `solution`, `scene` and the trait of `visibility`.

mod cells;
mod digits;
mod false_colour;
mod frame;
mod lens;
mod lines;
mod options;
mod paint;
mod picture;
mod place;
mod sight;
mod tone;
mod trace;
mod view;

pub use false_colour::{colour as false_colour, false_colours, legend, round_above};
pub use options::RenderOptions;
pub use picture::Picture;
pub use place::{Place, Sighting};
pub use tone::Tone;
pub use view::View;
