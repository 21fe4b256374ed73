//! What the file says: surfaces, materials and cameras, validated; nothing is subdivided.
//!
//! One file a format reads into [`Scene`]. Imports `geometry` and `radiometry` only.

mod cameras;
mod duplicates;
mod error;
mod limits;
mod load;
mod materials;
mod mtl;
mod obj;
mod obj_guard;
mod polygon;
mod settings;
mod sides;
mod split;
mod summary;
mod text;
mod triangulate;
mod warnings;
mod weld;

pub use error::SceneError;
pub use summary::{MaterialSummary, Summary};

use crate::radiometry::Spectrum;
use glam::DVec3;

/// A polygonal scene with diffuse materials. Lengths are in the scene's own unit, right-handed, y up.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The name shown in reports: the scene file's `name`, or the file's stem.
    pub name: String,
    /// Length of one scene unit in metres.
    pub metres_per_unit: f64,
    /// Positions in scene units; surfaces index into it. All finite.
    pub vertices: Vec<DVec3>,
    /// Triangles and convex, planar quads.
    pub surfaces: Vec<Surface>,
    /// Indexed by [`Surface::material`].
    pub materials: Vec<Material>,
    /// At least one: the reader adds a view of the whole scene where the file names none.
    pub cameras: Vec<Camera>,
    /// Polygons as read from the file, before any was split or dropped.
    pub input_polygons: usize,
    /// Usable but suspicious input: what was found, how often and what was done about it.
    pub warnings: Vec<String>,
}

/// A planar convex polygon with three or four corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Vertex indices, counter-clockwise seen from the front.
    pub corners: Corners,
    /// Index into [`Scene::materials`].
    pub material: u32,
    /// Number of the input polygon that this surface is, or is a piece of (0-based, file order).
    pub polygon: u32,
    /// The sides from which it radiates.
    pub sides: Sides,
}

/// The three or four corners of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corners {
    /// A triangle.
    Triangle([u32; 3]),
    /// A convex, planar quadrilateral.
    Quad([u32; 4]),
}

impl Corners {
    /// The vertex indices in order.
    pub fn indices(&self) -> &[u32] {
        match self {
            Corners::Triangle(t) => t,
            Corners::Quad(q) => q,
        }
    }
}

/// The sides from which a surface radiates (reflects, and receives).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// The front only; the back absorbs everything and stays black.
    Front,
    /// Front and back; emission leaves the front only.
    Both,
}

/// An ideal diffuse material.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Its name in the file.
    pub name: String,
    /// Reflectance ρ, per channel, 0 ≤ ρ < 1.
    pub reflectance: Spectrum,
    /// Emitted radiance L (W m⁻² sr⁻¹), leaving the front; 0 for a material that does not emit.
    pub emitted_radiance: Spectrum,
}

impl Material {
    /// Whether it gives light of its own.
    pub fn emits(&self) -> bool {
        self.emitted_radiance.max_element() > 0.0
    }
}

/// A pinhole camera.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Camera {
    /// Names the picture files.
    pub name: String,
    /// Position, in scene units.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub look_at: DVec3,
    /// Which way is up; not parallel to the line of sight.
    pub up: DVec3,
    /// Horizontal field of view, in degrees.
    pub horizontal_fov: f64,
    /// Picture width, in pixels.
    pub width: u32,
    /// Picture height, in pixels.
    pub height: u32,
    /// Radiance is multiplied by 2^exposure before tone mapping; `None` chooses it from the picture.
    pub exposure: Option<f64>,
}
