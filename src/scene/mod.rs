//! What the file says: surfaces, materials and cameras, validated; nothing is subdivided.
//!
//! One file a format reads into [`Scene`]. Imports `geometry` and `radiometry` only.
//!
//! # The scene file
//!
//! A scene is a geometry file (Wavefront OBJ with its MTL files, glTF 2.0 or PLY) and a `scene.toml` for what that cannot
//! say. All keys but `geometry` may be left out.
//!
//! ```toml
//! name = "Cornell box"          # for reports; else the stem of the geometry's file
//! geometry = "cornell-box.obj"  # in the folder of this file, or below
//! unit = "mm"                   # m (default), cm, mm, in or ft; or metres_per_unit = 0.001
//! up = "y"                      # the axis of the file that points up: y (default) or z
//! point_light_radius = 0.05     # in that unit, for glTF's lights without a surface: see below
//! sides = "auto"                # front, both, or auto (default): see below
//!
//! [material.white]              # overrides what the MTL file says
//! reflectance = [0.725, 0.71, 0.68]  # or one number for all channels; 0 <= reflectance <= 1
//! emitted_radiance = 0               # W m⁻² sr⁻¹
//! sides = "both"
//!
//! [[camera]]                    # any number; without one there is a view of the whole scene
//! name = "front"                # becomes part of the pictures' file names
//! eye = [278, 273, -800]        # in the scene's unit
//! look_at = [278, 273, 0]
//! up = [0, 1, 0]                # default
//! horizontal_fov = 39.3         # degrees, default 45
//! width = 1024                  # default
//! height = 768                  # default
//! exposure = 0.5                # stops; else chosen from the picture
//! ```
//!
//! In MTL files `Kd` is the reflectance and `Ke` the emitted radiance; nothing else is used. A reflectance of 1
//! becomes 0.999 with a warning, so that light dies out; more than 1 is refused. Polygons without
//! a material get the one named `default`.
//!
//! # glTF and PLY
//!
//! By the standard glTF is in metres with y up; emission is luminance in cd/m², which becomes radiance at 179 lm/W
//! ([`WHITE_EFFICACY`](crate::radiometry::WHITE_EFFICACY)). The base colour (the diffuse one of
//! `KHR_materials_pbrSpecularGlossiness`) is the reflectance; under a texture, its mean over each
//! polygon; colours of vertices are left out, with a warning. `doubleSided` materials radiate from both sides, others from the front; double-sided emitters (of the file or of the
//! `scene.toml`) that are not the skin of a solid shine from both sides unless `sides = "front"`: each becomes two surfaces back
//! to back. Perspective cameras are taken over unless the scene file has some. Lights without a surface (`KHR_lights_punctual`) are refused, unless `point_light_radius` (in scene units) asks for spheres of the same
//! flux in the place of points, and squares of the same intensity along the axis in that of spots; 0 leaves them out.
//! Consecutive triangles that make a flat, convex quad are one polygon, as exporters cut quads in two. Metals are taken as
//! diffuse (those of that extension have no diffuse colour, and are black), transparent materials as opaque.
//!
//! PLY has no unit, no up axis and no materials: metres and y unless the scene file says otherwise, and the material `default`.
//!
//! # Sides
//!
//! `auto` goes by what the file says of a material, as glTF does (`doubleSided`). Where the file says nothing it makes closed,
//! consistently oriented sets of polygons radiate from the front, all others from both sides; so do, with a warning,
//! closed sets that face inwards although nothing stands in them, nor do they shine, nor are they all there is: solids that are inside
//! out. Emitted light leaves the front, but for glTF's double-sided emitters.
//!
//! # Polygons
//!
//! Triangles and convex planar quads stay as they are. A quad whose corners miss their plane by more than 1e-5
//! of its size, or that is concave, becomes two triangles; a polygon with more corners becomes a constrained
//! Delaunay triangulation in which well-shaped neighbours are joined to quads. Left out with a warning are
//! repetitions (of polygons with the same corners the first that emits stays, or else the first), polygons without area and polygons whose boundary crosses itself.

mod backs;
mod cameras;
mod compare;
mod duplicates;
mod ears;
mod error;
mod geometry;
mod gltf;
mod inside_out;
mod limits;
mod load;
mod materials;
mod mtl;
mod names;
mod obj;
mod obj_guard;
mod ply;
mod polygon;
mod polygons;
mod settings;
mod sides;
mod split;
mod summary;
mod text;
mod triangulate;
mod warnings;
mod weld;

pub(crate) use backs::back_to_back;
pub(crate) use compare::check_unit;
pub use error::SceneError;
pub(crate) use load::geometry_of;
pub use names::{NamedScene, Names};
pub use summary::{MaterialSummary, Summary};
pub(crate) use weld::Welder;

use crate::geometry::Frame;
use crate::radiometry::Spectrum;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A polygonal scene with diffuse materials. Lengths are in the scene's own unit, right-handed, y up.
///
/// Those that are loaded keep all that is said of the fields. One may be built in code as well: [`Scene::check`] tells what does not
/// fit, and a solve begins with it. A quad that is not flat and convex is for two triangles; a surface without area receives nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The name shown in reports: the scene file's `name`, or the file's stem.
    pub name: String,
    /// Length of one scene unit in metres.
    pub metres_per_unit: f64,
    /// Positions in scene units; surfaces index into it. All finite, no two equal.
    pub vertices: Vec<DVec3>,
    /// Triangles and convex, planar quads.
    pub surfaces: Vec<Surface>,
    /// Indexed by [`Surface::material`].
    pub materials: Vec<Material>,
    /// For pictures; the reader adds a view of the whole scene where the file names none.
    pub cameras: Vec<Camera>,
    /// Polygons as read from the file, before any was split or dropped.
    pub input_polygons: usize,
    /// Usable but suspicious input: what was found, how often and what was done about it.
    pub warnings: Vec<String>,
}

/// A planar convex polygon with three or four corners.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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

    /// Where they are, if vertices lie at these positions.
    pub fn places<'a>(&'a self, positions: &'a [DVec3]) -> impl Iterator<Item = DVec3> + 'a {
        self.indices().iter().map(|v| positions[*v as usize])
    }

    /// As triangles with the same front: one, or the two that the diagonal from the first corner leaves.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let corners = self.indices();
        (1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]])
    }
}

impl Scene {
    /// The frame around all surfaces.
    pub fn frame(&self) -> Frame {
        let corners = self.surfaces.iter().flat_map(|s| s.corners.indices());
        Frame::of(corners.map(|v| self.vertices[*v as usize]))
    }

    /// All vertices in a frame.
    pub fn positions_in(&self, frame: &Frame) -> Vec<DVec3> {
        self.vertices.iter().map(|v| frame.enter(*v)).collect()
    }
}

/// The sides from which a surface radiates (reflects, and receives).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sides {
    /// The front only; the back absorbs everything and stays black.
    Front,
    /// Front and back; emission leaves the front only.
    Both,
}

/// An ideal diffuse material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
