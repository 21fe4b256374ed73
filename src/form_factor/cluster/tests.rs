//! Clusters against the sum over their tiles.

use super::{Cluster, ClusterScratch, Clusters, FEW, Tile};
use crate::form_factor::{
    Formula, Gather, Receiver, Sampler, SourceThresholds, ToleranceScale, point_to_visible_polygon,
};
use crate::geometry::jitter;
use crate::radiometry::Spectrum;
use crate::simd::Isa;
use crate::visibility::{BruteForce, Triangles};
use glam::{DVec3, Vec3};

/// What thresholds are multiples of: of the order of the light at [`receivers`], 0.04 in the mean, as it is in an enclosure.
const REFERENCE: f64 = 0.1;

/// A ball of many triangles, or several, each with a radiosity of its own.
fn balls(count: u32) -> Vec<Tile> {
    let mut tiles = Vec::new();
    for number in 0..count {
        let [x, y] = jitter(number, 7);
        let [z, r] = jitter(number, 8);
        let centre = DVec3::new(x, y, z) * 4.0;
        tiles.extend(ball(12, |way| centre + way * (0.1 + 0.3 * r)));
    }
    tiles
}

/// A ball of so many rings of triangles, from where it has its points in each direction.
fn ball(rings: u32, point: impl Fn(DVec3) -> DVec3) -> Vec<Tile> {
    let mut tiles = Vec::new();
    let at = |u: u32, v: u32| {
        let [a, b] = [u, v].map(|i| f64::from(i) * std::f64::consts::PI / f64::from(rings));
        point(DVec3::new(b.sin() * a.cos(), b.sin() * a.sin(), b.cos()))
    };
    for (u, v) in (0..2 * rings).flat_map(|u| (0..rings).map(move |v| (u, v))) {
        let corners = [at(u, v), at(u, v + 1), at(u + 1, v + 1), at(u + 1, v)];
        for half in [[0, 1, 2], [0, 2, 3]] {
            let [a, b, c] = half.map(|i| corners[i]);
            let area = (b - a).cross(c - a);
            if area.length() > 1e-9 {
                tiles.push(Tile::new(&[a, b, c], area.normalize(), false));
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

fn gathered(
    tiles: &[Tile],
    radiosities: Vec<Spectrum>,
    receivers: &[(Receiver, u32)],
    threshold: f64,
    settled: bool,
) -> Vec<Gather> {
    let all = (tiles, radiosities);
    gathered_with(Isa::widest(), all, receivers, threshold, settled)
}

fn gathered_with(
    isa: Isa,
    sending: (&[Tile], Vec<Spectrum>),
    receivers: &[(Receiver, u32)],
    threshold: f64,
    settled: bool,
) -> Vec<Gather> {
    let nothing = Triangles::default();
    gathered_behind(&nothing, isa, sending, receivers, threshold, settled)
}

fn gathered_behind(
    occluders: &Triangles,
    isa: Isa,
    (tiles, radiosities): (&[Tile], Vec<Spectrum>),
    receivers: &[(Receiver, u32)],
    threshold: f64,
    settled: bool,
) -> Vec<Gather> {
    let visibility = BruteForce::new(occluders).expect("a sound scene");
    let sampler = Sampler {
        visibility: &visibility,
        extent: 5.0,
        formula: Formula::Hybrid(5.0),
        thresholds: SourceThresholds {
            difference: 0.2 * threshold,
            estimate: threshold,
            raw: false,
            scale: ToleranceScale {
                reference: REFERENCE,
                local_share: 0.6,
            },
        },
    };
    let mut clusters = Clusters::new(tiles.to_vec(), 5.0);
    clusters.radiate(radiosities, 1);
    let mut scratch = ClusterScratch::default();
    scratch.isa = isa;
    let mut gathers = vec![Gather::default(); receivers.len()];
    sampler.gather_clusters(&clusters, receivers, settled, &mut scratch, &mut gathers);
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
fn each_tile_is_below_one_chain_of_nodes_that_hold_it_and_send_what_it_sends() {
    // As many balls as make trees that are built on several threads, and as few tiles as make one node, or none.
    for tiles in [balls(40), balls(1), balls(1)[..3].to_vec()] {
        let mut clusters = Clusters::new(tiles.clone(), 5.0);
        clusters.radiate(radiosities(&tiles), 1);
        let (mut pending, mut found) = (clusters.roots.clone(), Vec::new());
        pending.reverse();
        while let Some(cluster) = pending.pop() {
            let number = match cluster {
                Cluster::Node(number) => number,
                Cluster::Tile(place) => {
                    found.push(place);
                    continue;
                }
            };
            let (node, sends) = (clusters.node(cluster), clusters.sends(cluster));
            let of = node.first..node.end;
            let slack = 1e-5 + node.radius;
            for tile in of.clone().map(|place| clusters.tile(place).0) {
                let is_within = |corner: &Vec3| corner.distance(node.centre) <= slack;
                assert!(tile.corners.iter().all(is_within), "{cluster:?}");
            }
            let sent = of.clone().map(|place| clusters.sent_by(place).weight);
            let sent: f32 = sent.sum();
            assert!((sends.weight - sent).abs() <= 1e-4 * sent, "{cluster:?}");
            if node.is_over_few() {
                assert!((2..=FEW as usize).contains(&of.len()));
                pending.extend(of.rev().map(Cluster::Tile));
            } else {
                pending.extend(node.children(number).into_iter().rev());
            }
        }
        assert!(found.into_iter().eq(0..tiles.len() as u32));
        assert!(
            clusters.nodes.len() <= tiles.len() / 2,
            "more than there is room for"
        );
    }
}

#[test]
fn what_clusters_give_tends_to_what_their_tiles_give() {
    let tiles = balls(12);
    let receivers = receivers(200);
    let exact: Vec<DVec3> = receivers.iter().map(|(r, _)| exact(&tiles, r)).collect();
    let mean = exact.iter().map(|e| e.element_sum()).sum::<f64>() / exact.len() as f64;
    let deviation = |threshold: f64, settled: bool| {
        let found = gathered(&tiles, radiosities(&tiles), &receivers, threshold, settled);
        let pairs = found.iter().zip(&exact);
        let errors = pairs.map(|(f, e)| (f.unoccluded.as_dvec3() - *e).element_sum() / mean);
        let (sum, square) = errors.fold((0.0, 0.0), |(s, q), e| (s + e, q + e * e));
        let count = exact.len() as f64;
        ((square / count).sqrt(), sum / count)
    };
    let thresholds = [0.1, 0.02, 0.004, 0.0];
    for settled in [true, false] {
        let found = thresholds.map(|threshold| deviation(threshold, settled));
        let [coarse, middle, fine, tiles] = found.map(|(rms, _)| rms);
        let is_bounded = coarse < 0.06 && middle < 0.02 && fine < 0.006;
        assert!(is_bounded, "settled {settled}: {found:?}");
        assert!(tiles < 1e-5, "single tiles, settled {settled}: {found:?}");
    }
    // What is left to chance is right in the mean: within three standard errors.
    let standard_error = |rms: f64| rms / (exact.len() as f64).sqrt();
    let found = thresholds.map(|threshold| deviation(threshold, false));
    let is_fair = |(rms, bias): &(f64, f64)| bias.abs() <= 3.0 * standard_error(*rms);
    assert!(found.iter().all(is_fair), "{found:?}");
}

#[test]
fn all_instruction_sets_give_the_same_bits() {
    let (tiles, receivers) = (balls(12), receivers(100));
    for settled in [false, true] {
        let with = |isa: Isa| {
            let all = (tiles.as_slice(), radiosities(&tiles));
            gathered_with(isa, all, &receivers, 0.02, settled)
        };
        let expected = with(Isa::Portable);
        assert!(expected.iter().any(|g| g.irradiance != Spectrum::ZERO));
        for isa in Isa::available() {
            assert!(with(isa) == expected, "{isa:?}, settled {settled}");
        }
    }
}

/// The inside of a unit cube, each side in 32 by 32 tiles, and points on it.
fn box_from_inside() -> (Vec<Tile>, Vec<(Receiver, u32)>) {
    let (mut tiles, mut receivers) = (Vec::new(), Vec::new());
    for side in 0..6_u32 {
        let [u, v, w] = [0, 1, 2].map(|i| DVec3::AXES[(side as usize + i) % 3]);
        let (foot, normal) = if side < 3 { (DVec3::ZERO, w) } else { (w, -w) };
        let at = |s: f64, t: f64| {
            foot + if side < 3 {
                u * s + v * t
            } else {
                v * s + u * t
            }
        };
        for (i, j) in (0..32).flat_map(|i| (0..32).map(move |j| (i, j))) {
            let [s, t] = [i, j].map(f64::from);
            let corner = |ds: f64, dt: f64| at((s + ds) / 32.0, (t + dt) / 32.0);
            let corners = [
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(1.0, 1.0),
                corner(0.0, 1.0),
            ];
            tiles.push(Tile::new(&corners, normal, false));
        }
        for number in 0..200 {
            let [s, t] = jitter(number, side);
            let receiver = Receiver {
                point: at(s, t),
                normal,
                irradiance: 1.0,
            };
            receivers.push((receiver, receivers.len() as u32));
        }
    }
    (tiles, receivers)
}

/// The inside of a ball, and points on it.
fn ball_from_inside() -> (Vec<Tile>, Vec<(Receiver, u32)>) {
    // Mirrored, its triangles face inwards.
    let tiles = ball(48, |way| way * DVec3::new(-1.0, 1.0, 1.0) + 2.0);
    let receiver = |number: u32| {
        let tile = &tiles[number as usize * 7];
        let receiver = Receiver {
            point: tile.at(0.4, 0.3).as_dvec3(),
            normal: tile.normal.as_dvec3(),
            irradiance: 1.0,
        };
        (receiver, number)
    };
    let receivers = (0..1200).map(receiver).collect();
    (tiles, receivers)
}

#[test]
fn in_a_closed_box_the_parts_of_all_clusters_add_up_to_one() {
    assert_closed(box_from_inside());
}

/// Here all tiles of a cluster face what is inside more than their mean normal from their mean place does.
#[test]
fn in_a_closed_ball_they_do_too() {
    assert_closed(ball_from_inside());
}

fn assert_closed((tiles, receivers): (Vec<Tile>, Vec<(Receiver, u32)>)) {
    for settled in [false, true] {
        let ones = vec![Spectrum::ONE; tiles.len()];
        let found = gathered(&tiles, ones, &receivers, 0.02, settled);
        let sums = || found.iter().map(|g| f64::from(g.unoccluded.x));
        let mean = sums().sum::<f64>() / found.len() as f64;
        assert!((mean - 1.0).abs() < 0.005, "settled {settled}: {mean}");
        for (sum, (receiver, _)) in sums().zip(&receivers) {
            assert!(
                (sum - 1.0).abs() < 0.05,
                "settled {settled}: {sum} at {receiver:?}"
            );
        }
    }
}

/// Of a tile whose far half is covered a near point sees more than half.
#[test]
fn what_is_hidden_of_a_tile_counts_by_how_it_is_seen() {
    let square = |low: f64| {
        let [a, b] = [low, 1.0].map(|x| [0.0, 1.0].map(|y| DVec3::new(x, y, 0.0)));
        [a[0], b[0], b[1], a[1]]
    };
    let tile = Tile::new(&square(0.0), DVec3::Z, false);
    let cover = square(0.5).map(|corner| corner.as_vec3() + 0.001 * Vec3::Z);
    let cover = Triangles {
        vertices: cover.to_vec(),
        indices: vec![[0, 1, 2], [0, 2, 3]],
    };
    let point = DVec3::new(0.1, 0.5, 0.4);
    let receiver = Receiver {
        point,
        normal: -DVec3::Z,
        irradiance: 1.0,
    };
    let seen = [0.0, 0.5].map(|x| square(x).map(|corner| corner - point));
    let [all, covered] = seen.map(|of| point_to_visible_polygon(receiver.normal, &of).0);
    let sending = (&[tile][..], vec![Spectrum::ONE]);
    let receivers: Vec<_> = (0..100).map(|key| (receiver, key)).collect();
    let isa = Isa::widest();
    let gathers = gathered_behind(&cover, isa, sending, &receivers, 1e-3, true);
    let found = gathers.iter().map(|g| f64::from(g.irradiance.x));
    let found = found.sum::<f64>() / gathers.len() as f64;
    assert!(all - covered > 0.85 * all, "{covered} of {all}");
    let off = found / (all - covered) - 1.0;
    assert!(off.abs() < 0.02, "{found} instead of {}", all - covered);
}
