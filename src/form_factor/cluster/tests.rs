//! Clusters against the sum over their tiles.

use super::{ClusterScratch, Clusters, Tile};
use crate::form_factor::{
    Formula, Gather, Receiver, Sampler, SourceThresholds, ToleranceScale, point_to_visible_polygon,
};
use crate::geometry::jitter;
use crate::radiometry::Spectrum;
use crate::visibility::{BruteForce, Triangles};
use glam::DVec3;

/// A ball of many triangles, or several, each with a radiosity of its own.
fn balls(count: u32) -> Vec<Tile> {
    let mut tiles = Vec::new();
    for ball in 0..count {
        let [x, y] = jitter(ball, 7);
        let [z, r] = jitter(ball, 8);
        let centre = DVec3::new(x, y, z) * 4.0;
        let radius = 0.1 + 0.3 * r;
        let at = |u: u32, v: u32| {
            let (a, b) = (
                f64::from(u) * std::f64::consts::TAU / 24.0,
                f64::from(v) * std::f64::consts::PI / 12.0,
            );
            centre + DVec3::new(b.sin() * a.cos(), b.sin() * a.sin(), b.cos()) * radius
        };
        for (u, v) in (0..24).flat_map(|u| (0..12).map(move |v| (u, v))) {
            let corners = [at(u, v), at(u, v + 1), at(u + 1, v + 1), at(u + 1, v)];
            for half in [[0, 1, 2], [0, 2, 3]] {
                let [a, b, c] = half.map(|i| corners[i]);
                let area = (b - a).cross(c - a);
                if area.length() > 1e-9 {
                    tiles.push(Tile::new(&[a, b, c], area.normalize()));
                }
            }
        }
    }
    tiles
}

fn radiosities(tiles: &[Tile]) -> Vec<Spectrum> {
    let of = |tile: usize| {
        let [a, b] = jitter(tile as u32, 3);
        Spectrum::new(a as f32, b as f32, 0.5)
    };
    (0..tiles.len()).map(of).collect()
}

fn receivers(count: u32) -> Vec<(Receiver, u32)> {
    let receiver = |number: u32| {
        let [x, y] = jitter(number, 11);
        let [z, a] = jitter(number, 12);
        let [b, c] = jitter(number, 13);
        let receiver = Receiver {
            point: DVec3::new(x, y, z) * 4.0,
            normal: (DVec3::new(a, b, c) - 0.5).normalize(),
            irradiance: 0.0,
        };
        (receiver, number)
    };
    (0..count).map(receiver).collect()
}

fn gathered(tiles: &[Tile], receivers: &[(Receiver, u32)], threshold: f64) -> Vec<Gather> {
    let nothing = BruteForce::new(&Triangles::default()).expect("no triangle is a sound scene");
    let sampler = Sampler {
        visibility: &nothing,
        extent: 5.0,
        formula: Formula::Hybrid(5.0),
        thresholds: SourceThresholds {
            difference: 0.2 * threshold,
            estimate: threshold,
            raw: false,
            scale: ToleranceScale {
                reference: 0.5,
                local_share: 0.6,
            },
        },
    };
    let mut clusters = Clusters::new(tiles.to_vec(), 5.0);
    clusters.radiate(radiosities(tiles), 1);
    let mut gathers = Vec::new();
    sampler.gather_clusters(
        &clusters,
        receivers,
        false,
        &mut ClusterScratch::default(),
        &mut gathers,
    );
    gathers
}

/// Eq. (2) over all tiles.
fn exact(tiles: &[Tile], receiver: &Receiver) -> DVec3 {
    let radiosities = radiosities(tiles);
    let from = |(tile, radiosity): (&Tile, &Spectrum)| {
        let corners = tile.corners.map(|c| c.as_dvec3() - receiver.point);
        if tile.normal.as_dvec3().dot(-corners[0]) <= 0.0 {
            return DVec3::ZERO;
        }
        let factor = point_to_visible_polygon(receiver.normal, &corners[..tile.corner_count()]).0;
        radiosity.as_dvec3() * factor
    };
    tiles.iter().zip(&radiosities).map(from).sum()
}

#[test]
fn what_clusters_give_tends_to_what_their_tiles_give() {
    let tiles = balls(12);
    let receivers = receivers(200);
    let exact: Vec<DVec3> = receivers.iter().map(|(r, _)| exact(&tiles, r)).collect();
    let mean = exact.iter().map(|e| e.element_sum()).sum::<f64>() / exact.len() as f64;
    let error = |threshold: f64| {
        let found = gathered(&tiles, &receivers, threshold);
        let square = |(found, exact): (&Gather, &DVec3)| {
            (found.unoccluded.as_dvec3() - *exact).element_sum().powi(2)
        };
        let sum: f64 = found.iter().zip(&exact).map(square).sum();
        (sum / exact.len() as f64).sqrt() / mean
    };
    let errors = [0.1, 0.02, 0.004, 0.0].map(error);
    println!("{errors:?}");
    assert!(
        errors[0] < 0.05 && errors[1] < 0.02 && errors[2] < 0.01,
        "{errors:?}"
    );
    assert!(errors[3] < 2e-3, "single tiles: {errors:?}");
}
