//! A strip, along which light falls off over its width: its cells must be as short as that.

use crate::setup::{HYBRID, close, engines, eq_2, gather_one};
use glam::{DVec3, dvec3};
use radiosity::form_factor::{DEEPEST, Receiver, Source};
use radiosity::radiometry::Spectrum;

/// Its width is 1; one unit above the origin, radiating down.
const LENGTH: f64 = 32.0;

fn piece(from: f64, to: f64) -> [DVec3; 4] {
    [(from, -0.5), (from, 0.5), (to, 0.5), (to, -0.5)].map(|(x, y)| dvec3(x, y, 1.0))
}

/// Radiosity e⁻ˣ: its mean between two places.
fn mean(from: f64, to: f64) -> f64 {
    ((-from).exp() - (-to).exp()) / (to - from)
}

fn strip(corners: [DVec3; 4]) -> Source {
    let even = [Spectrum::ONE; 1 << (2 * DEEPEST)];
    let cells = Source::new(&corners, DVec3::NEG_Z, DEEPEST, &even);
    let of_cell = |[a, b]: [DVec3; 2]| mean(a.x.min(b.x), a.x.max(b.x)) as f32;
    let finest: Vec<Spectrum> = cells
        .finest()
        .map(|(cell, _)| Spectrum::splat(of_cell([cell.at(0.0, 0.0), cell.at(1.0, 1.0)])))
        .collect();
    Source::new(&corners, DVec3::NEG_Z, DEEPEST, &finest)
}

fn integral(receiver: Receiver) -> f64 {
    let ends = |i: u32| [f64::from(i) / 64.0, f64::from(i + 1) / 64.0];
    let pieces = (0..64 * LENGTH as u32).map(ends);
    pieces
        .map(|[from, to]| mean(from, to) * eq_2(receiver, &piece(from, to)))
        .sum()
}

#[test]
fn a_strip_gives_what_its_short_pieces_give() {
    let [a, b, c, d] = piece(0.0, LENGTH);
    for corners in [[a, b, c, d], [b, c, d, a]] {
        let source = strip(corners);
        for (x, towards) in [(0.3, 0.0), (1.2, 0.0), (1.2, -1.0), (3.1, -1.0), (3.1, 0.5)] {
            let receiver = Receiver {
                point: dvec3(x, 0.2, 0.0),
                normal: dvec3(towards, 0.0, 1.0).normalize(),
                irradiance: 0.0,
            };
            let expected = integral(receiver);
            for engine in engines(&[]) {
                let gather = gather_one(&*engine, HYBRID, 1e-4, &source, receiver);
                close(gather.irradiance, expected, 3e-3 * expected, "a strip");
            }
        }
    }
}
