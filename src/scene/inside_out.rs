//! Solids that are inside out: closed sets of polygons whose stated front is on their inside, where there is nothing.
//!
//! A room seen from inside is closed and faces inwards too, but something stands in it, or it shines, or it is all there is. Of
//! a solid whose polygons were written the wrong way round only the back shows, which would be black.

use super::polygons::Polygons;
use super::sides::Bodies;
use crate::geometry::{self, polygon::solid_angle};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// For each polygon whether it is part of a solid that is inside out; `shines` says which polygons emit.
pub(super) fn find(
    polygons: &Polygons,
    bodies: &Bodies,
    shines: impl Fn(usize) -> bool,
) -> Vec<bool> {
    let of_set = bodies.members();
    let mut is_inside_out = vec![false; polygons.len()];
    if of_set.len() < 2 {
        return is_inside_out;
    }
    // In the order of x, so that a set looks at those alone that begin between its ends.
    let mut by_place: Vec<(DVec3, &Vec<u32>)> = of_set
        .iter()
        .map(|set| (corner(polygons, set[0]), set))
        .collect();
    by_place.par_sort_by(|(a, _), (b, _)| a.x.total_cmp(&b.x));
    for set in &of_set {
        let faces_inwards = bodies.is_closed(set[0]) && volume(polygons, set) < 0.0;
        if !faces_inwards || set.iter().any(|polygon| shines(*polygon as usize)) {
            continue;
        }
        let (low, high) = bounds(polygons, set);
        let is_near = |p: &DVec3| p.cmpgt(low).all() && p.cmplt(high).all();
        // What is only let into a solid, as a pane into its frame, has no middle there.
        let holds = |(point, other): &(DVec3, &Vec<u32>)| {
            let is_inside = |point: DVec3| is_near(&point) && surrounds(polygons, set, point);
            other[0] != set[0] && is_inside(*point) && is_inside(middle(polygons, other))
        };
        let from = by_place.partition_point(|(point, _)| point.x <= low.x);
        let to = by_place.partition_point(|(point, _)| point.x < high.x);
        let mut near = by_place[from..to].iter();
        if !near.any(holds) {
            set.iter()
                .for_each(|polygon| is_inside_out[*polygon as usize] = true);
        }
    }
    is_inside_out
}

fn corner(polygons: &Polygons, polygon: u32) -> DVec3 {
    polygons.positions[polygons.corners(polygon as usize)[0] as usize]
}

/// The triangles of a set, fan by fan.
fn triangles<'a>(polygons: &'a Polygons, set: &'a [u32]) -> impl Iterator<Item = [DVec3; 3]> + 'a {
    set.iter().flat_map(|polygon| {
        let corners = polygons.corners(*polygon as usize);
        let at = |i: usize| polygons.positions[corners[i] as usize];
        (2..corners.len()).map(move |i| [at(0), at(i - 1), at(i)])
    })
}

/// What a closed set encloses; negative if its front is inside.
fn volume(polygons: &Polygons, set: &[u32]) -> f64 {
    let origin = corner(polygons, set[0]);
    triangles(polygons, set)
        .map(|triangle| {
            let [a, b, c] = triangle.map(|p| p - origin);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

/// Whether a point is inside a closed set: the solid angles of its triangles make a whole sphere.
fn surrounds(polygons: &Polygons, set: &[u32], point: DVec3) -> bool {
    let triangles = triangles(polygons, set);
    let all: f64 = triangles.map(|it| solid_angle(it, point)).sum();
    all.abs() > TAU
}

/// The middle of the box around a set.
fn middle(polygons: &Polygons, set: &[u32]) -> DVec3 {
    let (low, high) = bounds(polygons, set);
    0.5 * (low + high)
}

fn bounds(polygons: &Polygons, set: &[u32]) -> (DVec3, DVec3) {
    let corners = set
        .iter()
        .flat_map(|polygon| polygons.corners(*polygon as usize));
    geometry::bounds(corners.map(|corner| polygons.positions[*corner as usize]))
}
