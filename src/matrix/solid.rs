//! Solids of any shape: closed sets of surfaces, and whether a point lies in what one of them is made of.
//!
//! A closed set winds once around what it encloses (its triangles make a whole sphere as seen from there), be it dented, pierced or cut
//! into by others. What it encloses may be hollow: a room with walls of some thickness is a solid with another, turned inwards,
//! in it, and that may have holes.

use crate::geometry::polygon::solid_angle;
use crate::geometry::{Sets, bounds};
use crate::scene::{Scene, Sides, Surface};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// A set with a hole winds around a point less than once; with less than half of it missing it counts as closed.
const HALF: f64 = 0.5;

/// The surfaces of a scene by what hangs together.
pub(super) struct Solids {
    skins: Vec<Skin>,
    /// For each triangle its skin.
    of_triangle: Vec<u32>,
}

impl Solids {
    /// `positions` are the vertices of the scene in any frame.
    pub fn new(scene: &Scene, positions: &[DVec3]) -> Self {
        let (roots, is_open) = hang_together(scene);
        let mut order: Vec<u32> = (0..roots.len() as u32).collect();
        order.par_sort_by_key(|surface| (roots[*surface as usize], *surface));
        let mut skin_of = vec![0; roots.len()];
        let sets = order.chunk_by(|a, b| roots[*a as usize] == roots[*b as usize]);
        let skin = |(number, set): (u32, &[u32])| {
            set.iter().for_each(|k| skin_of[*k as usize] = number);
            let surfaces = set.iter().map(|k| &scene.surfaces[*k as usize]);
            Skin::new(surfaces, positions, !is_open[set[0] as usize])
        };
        let skins = (0..).zip(sets).map(skin).collect();
        let surfaces = scene.surfaces.iter().zip(&skin_of);
        let of_triangle = surfaces
            .flat_map(|(it, skin)| std::iter::repeat_n(*skin, it.corners.triangles().count()));
        Self {
            skins,
            of_triangle: of_triangle.collect(),
        }
    }

    /// The solid that a triangle bounds, if it is closed and does not radiate inwards.
    pub fn of_triangle(&self, triangle: u32) -> Option<u32> {
        let number = self.of_triangle[triangle as usize];
        let skin = &self.skins[number as usize];
        (skin.is_closed && !skin.is_two_sided).then_some(number)
    }

    /// Whether a point lies in what a solid is made of.
    pub fn hold(&self, solid: u32, point: DVec3) -> bool {
        let solid = &self.skins[solid as usize];
        solid.turns(point) > HALF && !self.is_hollow([solid.low, solid.high], point)
    }

    /// Whether a point lies in a hollow of a solid within the given box: in a room, or a sheet that radiates inwards.
    pub fn is_hollow(&self, [low, high]: [DVec3; 2], point: DVec3) -> bool {
        let mut within = self.skins.iter().filter(|it| it.is_within(low, high));
        within.any(|it| match it.is_two_sided {
            true => it.turns(point).abs() > HALF,
            false => it.turns(point) < -HALF,
        })
    }
}

/// Surfaces that hang together by edges.
struct Skin {
    triangles: Vec<[DVec3; 3]>,
    low: DVec3,
    high: DVec3,
    is_closed: bool,
    /// Whether any of it radiates from both sides.
    is_two_sided: bool,
}

impl Skin {
    fn new<'a>(
        surfaces: impl Iterator<Item = &'a Surface> + Clone,
        positions: &[DVec3],
        is_closed: bool,
    ) -> Self {
        let triangles = surfaces.clone().flat_map(|it| it.corners.triangles());
        let triangles: Vec<[DVec3; 3]> = triangles
            .map(|triangle| triangle.map(|v| positions[v as usize]))
            .collect();
        let (low, high) = bounds(triangles.iter().flatten().copied());
        Self {
            triangles,
            low,
            high,
            is_closed,
            is_two_sided: { surfaces }.any(|it| it.sides == Sides::Both),
        }
    }

    fn is_around(&self, point: DVec3) -> bool {
        point.cmpgt(self.low).all() && point.cmplt(self.high).all()
    }

    fn is_within(&self, low: DVec3, high: DVec3) -> bool {
        self.low.cmpge(low).all() && self.high.cmple(high).all()
    }

    /// How often the skin winds around a point, its fronts outside.
    fn turns(&self, point: DVec3) -> f64 {
        if self.is_closed && !self.is_around(point) {
            return 0.0;
        }
        let angles = self.triangles.iter().map(|it| solid_angle(*it, point));
        angles.sum::<f64>() / (2.0 * TAU)
    }
}

/// For each surface the first of its set, and for each of these whether the set is open: some edge is not run through as often in one
/// direction as in the other.
fn hang_together(scene: &Scene) -> (Vec<u32>, Vec<bool>) {
    let mut uses: Vec<([u32; 2], u32, bool)> = Vec::with_capacity(4 * scene.surfaces.len());
    for (number, surface) in (0..).zip(&scene.surfaces) {
        let corners = surface.corners.indices();
        let ends = corners.iter().zip(corners.iter().cycle().skip(1));
        uses.extend(ends.map(|(a, b)| ([*a.min(b), *a.max(b)], number, a < b)));
    }
    uses.par_sort_unstable();
    let mut sets = Sets::new(scene.surfaces.len());
    let mut open = Vec::new();
    for uses in uses.chunk_by(|(a, ..), (b, ..)| a == b) {
        let first = uses[0].1;
        uses.iter()
            .for_each(|(_, other, _)| sets.join(first, *other));
        if 2 * uses.iter().filter(|(.., forward)| *forward).count() != uses.len() {
            open.push(first);
        }
    }
    let mut is_open = vec![false; scene.surfaces.len()];
    for surface in open {
        is_open[sets.root(surface) as usize] = true;
    }
    let roots = (0..scene.surfaces.len() as u32).map(|surface| sets.root(surface));
    (roots.collect(), is_open)
}
