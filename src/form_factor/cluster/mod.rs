//! Many patches that shoot as one: a tree of clusters.
//!
//! What a scene of many small polygons radiates is cut into flat [`Tile`]s, and these are grouped by the way they face and then by
//! where they are (`build.rs`). A cluster knows how large it is, into which cone its tiles face, and what it sends (`light.rs`):
//! the sum w of area × radiosity, and the same sum with each tile's normal, P. Seen from far away it gives what all its tiles
//! give together, `P·(-d) cosθ_r / π r²` with a term of second order for its size and its curvature (`view.rs`), of which Eq. (1) is the case of a
//! disk on the axis.
//!
//! A point gathers from the coarsest clusters that its thresholds allow, and by Eq. (2) from single tiles where they do not
//! (`walk.rs`); one ray goes to what is large enough for it (`found.rs`).

mod build;
mod draw;
mod found;
mod gather;
mod light;
#[cfg(test)]
mod tests;
mod view;
mod walk;

pub use gather::ClusterScratch;

use crate::radiometry::Spectrum;
use glam::{DVec3, Mat3, Vec3};

/// The children of a node over no more tiles than this are these. With 4, `staircase2` takes as long and a sixth more memory; with 16 it takes a
/// thirtieth longer, and a tenth less memory.
const FEW: u32 = 8;

/// Subtrees over more tiles than this are worth a thread.
const APART: u32 = 1 << 10;

/// A flat triangle or quad that shoots, in one line of the cache.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Tile {
    /// Counter-clockwise seen from the radiating side; a triangle repeats its first corner.
    pub corners: [Vec3; 4],
    /// Unit normal of the radiating side.
    pub normal: Vec3,
    /// Whether this is the back of a surface: backs are grouped apart, as many are the dark insides of things.
    pub back: bool,
}

impl Tile {
    /// A tile with three or four corners.
    pub fn new(corners: &[DVec3], normal: DVec3, back: bool) -> Self {
        let fourth = *corners.get(3).unwrap_or(&corners[0]);
        let corners = [corners[0], corners[1], corners[2], fourth];
        Self {
            corners: corners.map(|corner| corner.as_vec3()),
            normal: normal.as_vec3(),
            back,
        }
    }

    /// Three or four.
    pub fn corner_count(&self) -> usize {
        if self.corners[3] == self.corners[0] {
            3
        } else {
            4
        }
    }

    /// Its area.
    pub fn area(&self) -> f32 {
        let [a, b, c, d] = self.corners;
        0.5 * (c - a).cross(d - b).length()
    }

    /// Its centre of mass, taken for the mean of its corners.
    fn centre(&self) -> Vec3 {
        let count = self.corner_count();
        self.corners[..count].iter().sum::<Vec3>() / count as f32
    }

    /// The point at (s, t) of the unit square, mapped evenly in area for triangles and parallelograms.
    pub fn at(&self, s: f32, t: f32) -> Vec3 {
        let [a, b, c, d] = self.corners;
        if self.corner_count() == 4 {
            return a.lerp(b, s).lerp(d.lerp(c, s), t);
        }
        let (s, t) = if s + t > 1.0 {
            (1.0 - s, 1.0 - t)
        } else {
            (s, t)
        };
        a + (b - a) * s + (c - a) * t
    }
}

/// The tree over all tiles of a scene, with what they radiate.
#[derive(Debug, Clone)]
pub struct Clusters {
    /// In the order of the leaves, one each.
    tiles: Vec<Tile>,
    /// Where each is in it, in the order in which they were given.
    places: Vec<u32>,
    /// Radiosity of each tile.
    radiosity: Vec<Spectrum>,
    /// In depth-first order: the first child of a node follows it. Those over few tiles have the tiles themselves for children: with nodes over
    /// pairs and single ones, nodes would take five times the memory of the tiles.
    nodes: Vec<Node>,
    /// What each of them sends.
    sends: Vec<Sends>,
    roots: Vec<Cluster>,
    /// Σ area × mean radiosity of the tiles before each, and of all.
    sums: Vec<f64>,
    /// Every few of them, to look at first.
    steps: Vec<f64>,
    /// By how much the targets of rays are lifted off their tiles.
    offset: f32,
    /// Of the points that rays are aimed at.
    seed: u32,
}

/// A part of the tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cluster {
    /// A node, by its number.
    Node(u32),
    /// One tile, by its place in the order of the leaves.
    Tile(u32),
}

/// What it takes to decide whether a cluster is to be opened, in one line of the cache.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct Node {
    centre: Vec3,
    /// All tiles are within this distance from the centre.
    radius: f32,
    /// Cosine and sine of the angle between the axis of the cone and the normal that differs most from it.
    cone: (f32, f32),
    axis: Vec3,
    /// No tile is farther than this from the plane through the centre across the axis.
    thickness: f32,
    /// Σ area × radiosity, and the largest radiosity, of the strongest channel.
    strength: f32,
    peak: f32,
    /// Its tiles are `tiles[first..end]`, those of its second child begin at `middle`.
    first: u32,
    middle: u32,
    end: u32,
    /// How many nodes after it the second child is.
    second: u32,
}

/// What a cluster sends, in two lines of the cache.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct Sends {
    /// Σ area × mean radiosity of the channels × normal.
    flux: Vec3,
    /// Σ area × mean radiosity of the channels.
    weight: f32,
    /// Where it comes from: the mean of its points, weighted by what they send …
    centre: Vec3,
    /// … and their covariance, m²: xx, yy, zz and yz, zx, xy.
    spread: [Vec3; 2],
    /// How their normals turn from place to place: Σ area × mean radiosity × normal × (place - centre), a column for each axis of the place. What
    /// is hollow sends more to where it opens than a flat disk would.
    turn: Mat3,
    /// The radiosity by channel over its mean.
    colour: Spectrum,
    aim: Aim,
}

/// Where a ray to a cluster is aimed: a point of one of its tiles, drawn in proportion to what they send.
#[derive(Debug, Clone, Copy, Default)]
struct Aim {
    target: Vec3,
    /// The normal there.
    normal: Vec3,
}

impl Clusters {
    /// The tiles with the radiosity of each, in the order in which they were given.
    pub fn tiles(&self) -> impl ExactSizeIterator<Item = (&Tile, Spectrum)> + Clone {
        let places = self.places.iter().map(|place| *place as usize);
        places.map(|place| (&self.tiles[place], self.radiosity[place]))
    }

    /// Memory that a tree over so many tiles holds, bytes, were there a node for each two: there are fewer.
    pub const fn bytes_for(tiles: usize) -> u64 {
        let node = size_of::<Node>() + size_of::<Sends>();
        let tile = size_of::<Tile>() + size_of::<Spectrum>() + size_of::<u32>() + size_of::<f64>();
        (tiles * tile + tiles / 2 * node) as u64
    }

    /// What it takes to decide about a cluster.
    #[inline(always)]
    fn node(&self, cluster: Cluster) -> Node {
        match cluster {
            Cluster::Node(number) => self.nodes[number as usize],
            Cluster::Tile(place) => Node::over_one(self.tile(place)),
        }
    }

    /// What a cluster sends.
    #[inline(always)]
    fn sends(&self, cluster: Cluster) -> Sends {
        match cluster {
            Cluster::Node(number) => self.sends[number as usize],
            Cluster::Tile(place) => self.sent_by(place),
        }
    }

    /// The tile at a place, with its radiosity.
    fn tile(&self, place: u32) -> (&Tile, Spectrum) {
        (&self.tiles[place as usize], self.radiosity[place as usize])
    }
}

impl Cluster {
    /// That over the tiles `first..end`, which has `number` if it is a node.
    const fn over(first: u32, end: u32, number: u32) -> Self {
        if end - first == 1 {
            Self::Tile(first)
        } else {
            Self::Node(number)
        }
    }

    /// What tells it from others when something is drawn for it.
    const fn key(self) -> u32 {
        match self {
            Self::Node(number) => number,
            Self::Tile(place) => !place,
        }
    }
}

impl Node {
    /// Over one tile: all that it takes to decide about that.
    #[inline(always)]
    fn over_one((tile, radiosity): (&Tile, Spectrum)) -> Self {
        let centre = tile.centre();
        let from_centre = tile.corners.map(|corner| corner - centre);
        let most = |of: [f32; 4]| of.into_iter().fold(0.0, f32::max);
        let peak = radiosity.max_element();
        Self {
            centre,
            radius: most(from_centre.map(Vec3::length_squared)).sqrt(),
            cone: (1.0, 0.0),
            axis: tile.normal,
            thickness: most(from_centre.map(|corner| corner.dot(tile.normal).abs())),
            strength: tile.area() * peak,
            peak,
            ..Self::default()
        }
    }

    /// Whether its children are tiles.
    #[inline(always)]
    const fn is_over_few(&self) -> bool {
        self.end - self.first <= FEW
    }

    /// Both children of the node with this number, which is not over few tiles.
    #[inline(always)]
    const fn children(&self, number: u32) -> [Cluster; 2] {
        [
            Cluster::over(self.first, self.middle, number + 1),
            Cluster::over(self.middle, self.end, number + self.second),
        ]
    }

    /// Whether both subtrees are worth a thread.
    fn is_worth_two_threads(&self) -> bool {
        self.middle - self.first > APART && self.end - self.middle > APART
    }
}
