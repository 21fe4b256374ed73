//! The solution as conforming triangles: what is exported, probed and drawn.

use crate::radiometry::Spectrum;
use glam::{DVec3, Vec3};

/// Triangles on which irradiance is linear. Each element of the mesh is a fan of triangles around its centre; vertices
/// that neighbours have on its edges are corners of the fan, so there are neither T-junctions nor cracks.
/// Positions are shared wherever surfaces touch; the light on them is not: a vertex belongs to one patch.
#[derive(Debug, Clone, Default)]
pub struct LitMesh {
    /// Positions in scene units.
    pub positions: Vec<DVec3>,
    /// Light at a position, as one patch receives it.
    pub vertices: Vec<LitVertex>,
    /// Counter-clockwise seen from the radiating side.
    pub triangles: Vec<LitTriangle>,
}

/// A vertex of one patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LitVertex {
    /// Index into [`LitMesh::positions`].
    pub position: u32,
    /// Unit normal of the radiating side.
    pub normal: Vec3,
    /// Irradiance E, W/m².
    pub irradiance: Spectrum,
    /// Radiosity B = M + ρE, W/m².
    pub radiosity: Spectrum,
}

/// One triangle of an element's fan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LitTriangle {
    /// Indices into [`LitMesh::vertices`]. The first is the element's centre, so the side between the second
    /// and the third lies on the element's boundary and the other two inside.
    pub vertices: [u32; 3],
    /// The element it is a part of.
    pub element: u32,
    /// The input polygon it lies on.
    pub polygon: u32,
    /// Whether the side between the second and third corner lies on the border of the input polygon.
    pub on_border: bool,
}
