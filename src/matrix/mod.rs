//! Form factors as a product: the matrix of an enclosure, with occlusion, its certificate, and what can be done with it.
//!
//! F_ij is the share of the diffuse flux leaving i that arrives at j without being reflected in between; A_i F_ij = A_j F_ji, and a
//! row sums up to 1 in a closed scene. An [`Enclosure`] is a scene made ready: its [`Row`]s are radiating sides, or groups of them. It
//! hands out the matrix row by row ([`Enclosure::each_row`]), or whole ([`Enclosure::matrix`]).
//!
//! 1. `rows`: sides of surfaces, divided (`divide`), split where others meet them, become flat `facet`s; those that are `covered`, as what lies in
//!    a `solid` is, do not count.
//! 2. `join`: neighbours in one plane become one `occluder`, and convex `body`s hide by their `silhouette`; `tree` finds for a pair of facets those that may come between.
//! 3. `pair`: facets that face away, or are hidden by one surface, exchange exactly nothing; where nothing lies between, the exchange is
//!    analytic (`unhindered`, `contour`); else shadows are cut out (`visible`, `look`) and the rest is integrated over both sides until they
//!    agree (`hidden`), in the end over the `zones` between the lines where what points see has kinks (`integral`, by the rule of `genz_malik`), or rays are traced where there is too much to cut (`rays`).
//! 4. `work` does so for all pairs of rows, and `again` once more for the rows whose sums tell that an entry is off.
//! 5. `enforce` closes the balance on demand, `balance` solves for radiosity.
//!
//! Imports `geometry`, `radiometry`, `scene`, `threads`, `visibility`, `form_factor`, and from `mesh` the splitting along lines of contact.

mod again;
mod balance;
mod body;
mod certificate;
mod contour;
mod convex;
mod covered;
mod dense;
mod divide;
mod effect;
mod enclosure;
mod enforce;
mod error;
mod facet;
mod gauss;
mod genz_malik;
mod hidden;
mod integral;
mod join;
mod linear;
mod look;
mod occluder;
mod options;
mod overlap;
mod pair;
mod rays;
mod refined;
mod rows;
mod silhouette;
mod solid;
mod space;
mod tree;
mod unhindered;
mod visible;
mod work;
mod zones;

pub use balance::Balance;
pub use certificate::{Certificate, Tally};
pub use dense::Matrix;
pub use enclosure::{Enclosure, FormFactors};
pub use enforce::{Correction, EnforceError};
pub use error::MatrixError;
pub use options::{By, Options};
pub use rows::Row;
