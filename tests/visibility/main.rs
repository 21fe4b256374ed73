//! Do the engines agree? Millions of segments, the same for all.

mod random;
mod scenes;
mod segments;

use glam::{DVec3, dvec3};
use radiosity::visibility::{EngineChoice, Fans, Triangles, Visibility, build};
use scenes::Scene;
use segments::{Family, Segments};

fn engine(choice: EngineChoice, triangles: &Triangles) -> Box<dyn Visibility> {
    build(choice, triangles, 2).expect("valid triangles")
}

fn ask(engine: &dyn Visibility, fans: &Fans) -> Vec<u64> {
    let mut masks = Vec::new();
    engine.occluded(fans, &mut masks);
    masks
}

fn different(a: &[u64], b: &[u64]) -> u32 {
    a.iter().zip(b).map(|(a, b)| (a ^ b).count_ones()).sum()
}

#[test]
fn explore() {
    let frames = [
        ("home", 1.0, DVec3::ZERO),
        ("far", 1.0, dvec3(3e6, -7e5, 1e6)),
        ("tiny", 1e-6, DVec3::ONE),
        ("huge", 3e7, dvec3(1e9, 0.0, 0.0)),
    ];
    for scene in [
        Scene::soup(3000),
        Scene::room(20, 8),
        Scene::terrain(150),
        Scene::sphere(40),
    ] {
        for (frame, scale, offset) in frames {
            let triangles = scene.moved(scale, offset).triangles();
            let t0 = std::time::Instant::now();
            let obvhs = engine(EngineChoice::Obvhs, &triangles);
            let tb = t0.elapsed();
            let embree = engine(EngineChoice::Embree, &triangles);
            let brute = engine(EngineChoice::BruteForce, &triangles);
            let mut segments = Segments::new(&triangles, 7);
            for family in Family::ALL {
                let fans = segments.fans(family, 200_000);
                let t0 = std::time::Instant::now();
                let a = ask(&*obvhs, &fans);
                let t1 = t0.elapsed();
                let b = ask(&*embree, &fans);
                let t2 = t0.elapsed() - t1;
                let small = segments.fans(family, 10_000_000 / triangles.indices.len());
                let t0 = std::time::Instant::now();
                let c = ask(&*brute, &small);
                let t3 = t0.elapsed();
                let d = ask(&*obvhs, &small);
                let e = ask(&*embree, &small);
                let n = fans.segments();
                let occ: u32 = a.iter().map(|m| m.count_ones()).sum();
                println!(
                    "{:8} {frame:5} {:9} n {n} occ {:.3} diff {} | brute n {} obvhs {} embree {}  build {tb:.1?} obvhs {t1:.0?} embree {t2:.0?} brute {t3:.0?}",
                    scene.name,
                    format!("{family:?}"),
                    f64::from(occ) / n as f64,
                    different(&a, &b),
                    small.segments(),
                    different(&c, &d),
                    different(&c, &e)
                );
            }
        }
    }
}
