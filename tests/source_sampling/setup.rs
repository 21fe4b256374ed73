//! Sources, engines, and reference values by Eq. (2) on parts so small that the radiosity hardly varies.

use glam::{DVec3, Vec3, dvec3};
use radiosity::form_factor::{
    DEEPEST, Formula, Gather, Receiver, Sampler, Scratch, Source, SourceThresholds, ToleranceScale,
    point_to_visible_polygon,
};
use radiosity::radiometry::Spectrum;
use radiosity::visibility::{EngineChoice, Triangles, Visibility, VisibilityError, build};

/// Everything here lies within a few units; the frame of a solve would not be larger.
const EXTENT: f64 = 8.0;
pub const HYBRID: Formula = Formula::Hybrid(5.0);

/// 1 x 1, one unit above the origin, radiating down.
pub const QUAD: [DVec3; 4] = [
    dvec3(-0.5, -0.5, 1.0),
    dvec3(-0.5, 0.5, 1.0),
    dvec3(0.5, 0.5, 1.0),
    dvec3(0.5, -0.5, 1.0),
];
/// The same for a triangle that has no symmetry.
pub const TRIANGLE: [DVec3; 3] = [
    dvec3(-0.5, -0.4, 1.0),
    dvec3(-0.3, 0.6, 1.0),
    dvec3(0.5, -0.1, 1.0),
];

pub fn constant(corners: &[DVec3]) -> Source {
    Source::new(
        corners,
        -DVec3::Z,
        DEEPEST,
        &[Spectrum::ONE; 1 << (2 * DEEPEST)],
    )
}

/// A radiosity that rises eightfold over the source.
fn radiosity(point: DVec3) -> f64 {
    0.9 + 1.4 * point.x + 0.2 * point.y
}

/// A source with [`radiosity`] on its finest cells.
pub fn linear(corners: &[DVec3]) -> Source {
    let third = if corners.len() == 3 { 1.0 / 3.0 } else { 0.5 };
    let cells = constant(corners);
    let finest: Vec<Spectrum> = cells
        .finest()
        .map(|(cell, _)| Spectrum::splat(radiosity(cell.at(third, third)) as f32))
        .collect();
    Source::new(corners, -DVec3::Z, DEEPEST, &finest)
}

/// The irradiance from radiosity 1, which is the form factor.
pub fn eq_2(receiver: Receiver, corners: &[DVec3]) -> f64 {
    fan(corners)
        .map(|triangle| eq_2_of(receiver, triangle))
        .sum()
}

/// The irradiance from [`radiosity`]: Eq. (2) for each of 4096 parts of each triangle.
pub fn integral(receiver: Receiver, corners: &[DVec3]) -> f64 {
    fan(corners)
        .map(|triangle| integral_of(receiver, triangle, 6))
        .sum()
}

fn integral_of(receiver: Receiver, [a, b, c]: [DVec3; 3], levels: u32) -> f64 {
    if levels == 0 {
        return radiosity((a + b + c) / 3.0) * eq_2_of(receiver, [a, b, c]);
    }
    let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
    let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]];
    parts
        .into_iter()
        .map(|part| integral_of(receiver, part, levels - 1))
        .sum()
}

fn eq_2_of(receiver: Receiver, triangle: [DVec3; 3]) -> f64 {
    point_to_visible_polygon(receiver.normal, &triangle.map(|c| c - receiver.point)).0
}

/// The triangles of a convex polygon.
fn fan(corners: &[DVec3]) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]])
}

/// All engines that were built in, over the two triangles of `blocker` (or none).
pub fn engines(blocker: &[DVec3]) -> Vec<Box<dyn Visibility>> {
    let indices = if blocker.is_empty() {
        vec![]
    } else {
        vec![[0, 1, 2], [0, 2, 3]]
    };
    let vertices: Vec<Vec3> = blocker.iter().map(|v| v.as_vec3()).collect();
    let triangles = Triangles { vertices, indices };
    let built = [
        EngineChoice::BruteForce,
        EngineChoice::Obvhs,
        EngineChoice::Embree,
    ]
    .map(|choice| match build(choice, &triangles, 1) {
        Err(VisibilityError::EmbreeNotBuilt) => None,
        other => Some(other.expect("an engine")),
    });
    built.into_iter().flatten().collect()
}

pub fn gather_one(
    visibility: &dyn Visibility,
    formula: Formula,
    threshold: f64,
    source: &Source,
    receiver: Receiver,
) -> Gather {
    let sampler = sampler(visibility, formula, threshold);
    let mut gather = [Gather::default()];
    sampler.gather(
        source,
        &[(receiver, 7)],
        &mut Scratch::default(),
        &mut gather,
    );
    gather[0]
}

/// Gathers in blocks of the given size with one scratch memory.
pub fn gather(
    visibility: &dyn Visibility,
    threshold: f64,
    source: &Source,
    receivers: &[(Receiver, u32)],
    block: usize,
) -> Vec<Gather> {
    let mut scratch = Scratch::default();
    let mut gathers = vec![Gather::default(); receivers.len()];
    let sampler = sampler(visibility, HYBRID, threshold);
    for (receivers, gathers) in receivers.chunks(block).zip(gathers.chunks_mut(block)) {
        sampler.gather(source, receivers, &mut scratch, gathers);
    }
    gathers
}

/// Splits where the irradiance of a cell is off by `threshold`, or is ten times that.
fn sampler(visibility: &dyn Visibility, formula: Formula, threshold: f64) -> Sampler<'_> {
    let thresholds = SourceThresholds {
        difference: threshold,
        estimate: 10.0 * threshold,
        raw: false,
        scale: ToleranceScale {
            reference: 1.0,
            local_share: 0.0,
        },
    };
    Sampler {
        visibility,
        extent: EXTENT,
        formula,
        thresholds,
    }
}

#[track_caller]
pub fn close(computed: Spectrum, expected: f64, tolerance: f64, what: &str) {
    let error = (f64::from(computed.x) - expected).abs();
    assert!(
        error <= tolerance,
        "{what}: {computed} for {expected}, off by {error:e}"
    );
}
