//! How much of what a point sees is a given polygon: Eq. (1), Eq. (2), the rule that chooses between them, and the
//! adaptively sampled source.
//!
//! F(x, s) is the cosine-weighted fraction of the hemisphere above x that the polygon s fills, so that the
//! irradiance is E(x) = Σ F(x, s) B(s). Imports `geometry`, `radiometry`, `simd` and the visibility trait.

mod cell;
mod cluster;
mod disagreement;
mod disk;
mod division;
mod edge;
mod hybrid;
mod neighbours;
mod partition;
mod polygon;
mod sampling;
mod siblings;
mod source;

pub use cell::{Cell, SourceShape};
pub use cluster::{ClusterScratch, Clusters, Tile};
pub use disk::point_to_disk;
pub use division::Division;
pub use hybrid::{Formula, Receiver};
pub use partition::{SourceThresholds, ToleranceScale};
pub use polygon::{point_to_polygon, point_to_polygon_from, point_to_visible_polygon};
pub use sampling::{Gather, Sampler, Scratch};
pub use source::{DEEPEST, Source};
