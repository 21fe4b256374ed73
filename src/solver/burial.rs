//! Which vertices are buried: those from which every ray ends on a side that does not radiate.

use super::behind::Behind;
use crate::geometry::{cosine_direction, jitter, lift};
use crate::mesh::Mesh;
use crate::visibility::{Ray, Visibility};
use rayon::prelude::*;

/// Rays that must all end on dark backs, spread by the cosine …
const RAYS: u32 = 16;

/// … and as many that graze: above a lamp that hangs below a ceiling nearly all there is to see is its dark back, but it is no solid.
const GRAZING: u32 = 16;

/// Tangents of their heights above the horizon: the first, and each next one over the one before.
const HEIGHT: f64 = 0.15;
const LOWER: f64 = 0.8;

/// Vertices that are looked at together. Those below one solid follow one another, and take many times longer than the others.
const BLOCK: usize = 64;

/// Whether each vertex from `first` on is buried. One ray each; the rest only for those whose first ray ends on a dark back.
pub(super) fn buried(
    mesh: &Mesh,
    visibility: &dyn Visibility,
    backing: &dyn Behind,
    first: u32,
) -> Vec<bool> {
    let count = mesh.vertices.len() - first as usize;
    if backing.is_two_sided() {
        return vec![false; count];
    }
    let receiving: Vec<u32> = (first..mesh.vertices.len() as u32)
        .filter(|v| mesh.receives(*v))
        .collect();
    let blocks: Vec<Vec<bool>> = receiving
        .par_chunks(BLOCK)
        .map(|block| {
            let mut dark = sees_dark(mesh, visibility, backing, block, 0..1);
            let suspects: Vec<u32> = block
                .iter()
                .zip(&dark)
                .filter(|(_, dark)| **dark)
                .map(|(v, _)| *v)
                .collect();
            let mut confirmed =
                sees_dark(mesh, visibility, backing, &suspects, 1..RAYS + GRAZING).into_iter();
            dark.iter_mut()
                .filter(|dark| **dark)
                .for_each(|dark| *dark = confirmed.next() == Some(true));
            dark
        })
        .collect();
    let mut buried = vec![false; count];
    for (vertex, is_buried) in receiving.iter().zip(blocks.concat()) {
        buried[(*vertex - first) as usize] = is_buried;
    }
    if first == 0 {
        mesh.share(&mut buried, |corners| corners.iter().all(|buried| *buried));
    }
    buried
}

/// How far a ray is from the normal.
fn squared_sine(ray: u32) -> f64 {
    if ray < RAYS {
        return (f64::from(ray) + 0.5) / f64::from(RAYS);
    }
    let tangent = HEIGHT * LOWER.powi((ray - RAYS) as i32);
    1.0 / (1.0 + tangent * tangent)
}

/// For each vertex, whether all of its rays with the given numbers end on sides that do not radiate.
fn sees_dark(
    mesh: &Mesh,
    visibility: &dyn Visibility,
    backing: &dyn Behind,
    vertices: &[u32],
    rays: std::ops::Range<u32>,
) -> Vec<bool> {
    let extent = mesh.frame.extent();
    let queries: Vec<Ray> = vertices
        .iter()
        .flat_map(|vertex| {
            let (point, normal) = mesh.receiver(*vertex);
            let origin = lift(point, normal, extent).as_vec3();
            rays.clone().map(move |ray| {
                // Even in azimuth and height, turned at random from vertex to vertex.
                let [s, t] = jitter(*vertex, 0x6275_7269);
                let spread = [
                    squared_sine(ray),
                    (f64::from(ray) * 0.618_034 + s + t).fract(),
                ];
                Ray {
                    origin,
                    direction: cosine_direction(normal, spread).as_vec3(),
                }
            })
        })
        .collect();
    let mut hits = Vec::new();
    visibility.nearest(&queries, &mut hits);
    let is_dark = |(hit, ray): (&Option<_>, &Ray)| {
        hit.as_ref()
            .is_some_and(|hit| super::escape::is_dark(hit, ray, backing))
    };
    let per_vertex = rays.len().max(1);
    hits.chunks(per_vertex)
        .zip(queries.chunks(per_vertex))
        .map(|(h, r)| h.iter().zip(r).all(is_dark))
        .collect()
}
