//! Integer coordinates on a patch.

/// Steps along each side of a patch: three times a power of two, so that every midpoint down to level 28 and the centroid of
/// every triangle down to that level is a lattice point.
pub const UNIT: u32 = 3 << 28;

/// A point of a patch: (u, v) in steps of 1/[`UNIT`]. On a quad, the bilinear coordinates of its four corners; on a triangle
/// a, b, c the weights of b and c.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub struct Lattice {
    /// Along the first side.
    pub u: u32,
    /// Along the last side.
    pub v: u32,
}

impl Lattice {
    /// A lattice point.
    pub const fn new(u: u32, v: u32) -> Self {
        Self { u, v }
    }

    /// Halfway to another point.
    pub fn midpoint(self, other: Self) -> Self {
        Self::new((self.u + other.u) / 2, (self.v + other.v) / 2)
    }

    /// The coordinates in [0, 1].
    pub fn unit(self) -> (f64, f64) {
        (
            f64::from(self.u) / f64::from(UNIT),
            f64::from(self.v) / f64::from(UNIT),
        )
    }
}
