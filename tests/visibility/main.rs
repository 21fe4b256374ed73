//! Do the engines agree? Millions of segments, the same for all.
//!
//! Embree (if it is built in) and obvhs answer all of them, brute force in double precision a part.
//! The segments follow the rules of the solver: a scene of extent 100 around the origin, both ends 1e-5 of
//! the extent off their surfaces, vertices on a border moved inwards, samples off the lattice.

mod random;
mod scenes;
mod segments;

use glam::{DVec3, dvec3};
use radiosity::visibility::{EngineChoice, Fans, Hit, Ray, Triangles, Visibility, build};
use random::Random;
use scenes::{EXTENT, Scene};
use segments::{Family, Segments};

/// Segments of one family in one frame of one scene.
const SEGMENTS: usize = 60_000;
/// Pairs of a segment and a triangle that brute force is asked for, in the same place.
const BRUTE_FORCE_TESTS: usize = 3_000_000;
/// Of segments between surfaces, which keep their distance from all edges but by accident. In an
/// accident single precision decides: at most 5 in a million were seen, in the soup.
const MAX_DISAGREEMENT: f64 = 20e-6;
/// Of segments that aim at edges and corners. Across an edge inside of a surface all agree; a silhouette
/// is missed or hit by the last bit. 0.6 % were seen, and 1.2 % in the small sample of brute force.
const MAX_DISAGREEMENT_ON_EDGES: f64 = 0.02;

/// The engines to compare, the fast ones first; says so if one is missing.
fn engines(triangles: &Triangles, choices: &[EngineChoice]) -> Vec<Box<dyn Visibility>> {
    let wanted = choices
        .iter()
        .filter(|&&choice| choice != EngineChoice::Embree || embree());
    wanted
        .map(|&choice| build(choice, triangles, 2).expect("valid triangles"))
        .collect()
}

/// Whether Embree is built in.
fn embree() -> bool {
    build(EngineChoice::Embree, &Triangles::default(), 1).is_ok()
}

fn ask(engine: &dyn Visibility, fans: &Fans) -> Vec<u64> {
    let mut masks = Vec::new();
    engine.occluded(fans, &mut masks);
    masks
}

/// Scenes of all kinds, in several units and places; the seed differs, so no two are the same.
fn scenes() -> impl Iterator<Item = (Scene, u64)> {
    let frames = [
        (1.0, DVec3::ZERO),
        (1.0, dvec3(3e6, -7e5, 1e6)),
        (1e-6, DVec3::ONE),
        (3e7, dvec3(1e9, 0.0, 0.0)),
    ];
    let scenes = [
        Scene::soup(3000),
        Scene::room(20, 8),
        Scene::terrain(100),
        Scene::sphere(30),
    ];
    scenes.into_iter().enumerate().flat_map(move |(i, scene)| {
        let frames = frames.into_iter().enumerate();
        frames.map(move |(k, (scale, offset))| (scene.moved(scale, offset), (4 * i + k) as u64))
    })
}

/// Two engines compared: how many answers, how many of them differ.
#[derive(Default)]
struct Tally {
    segments: usize,
    occluded: u32,
    differences: u32,
}

impl Tally {
    fn count(&mut self, fans: &Fans, a: &dyn Visibility, b: &dyn Visibility) {
        let (a, b) = (ask(a, fans), ask(b, fans));
        self.segments += fans.segments();
        self.occluded += a.iter().map(|mask| mask.count_ones()).sum::<u32>();
        self.differences += a
            .iter()
            .zip(&b)
            .map(|(a, b)| (a ^ b).count_ones())
            .sum::<u32>();
    }

    #[track_caller]
    fn check(&self, family: Family, engines: &str) {
        let rate = f64::from(self.differences) / self.segments as f64;
        let share = 100.0 * f64::from(self.occluded) / self.segments as f64;
        println!(
            "{family:9?} {engines:22} {:8} segments, {share:5.1} % occluded, {:5} differ: {:.1} ppm",
            self.segments,
            self.differences,
            1e6 * rate
        );
        let limit = match family {
            Family::Edges => MAX_DISAGREEMENT_ON_EDGES,
            _ => MAX_DISAGREEMENT,
        };
        assert!(
            rate <= limit,
            "{engines} on {family:?}: {rate:e} > {limit:e}"
        );
    }
}

#[test]
fn engines_agree_on_occlusion() {
    if !embree() {
        println!("Embree is not built in: only obvhs and brute force are compared");
    }
    let mut tallies: Vec<[Tally; 3]> = Family::ALL.iter().map(|_| Default::default()).collect();
    for (scene, seed) in scenes() {
        let triangles = scene.triangles();
        let engines = engines(
            &triangles,
            &[
                EngineChoice::Obvhs,
                EngineChoice::BruteForce,
                EngineChoice::Embree,
            ],
        );
        let mut segments = Segments::new(&triangles, seed);
        for (family, [fast, obvhs, embree]) in Family::ALL.into_iter().zip(&mut tallies) {
            let many = segments.fans(family, SEGMENTS);
            let few = segments.fans(family, BRUTE_FORCE_TESTS / triangles.indices.len());
            obvhs.count(&few, &*engines[0], &*engines[1]);
            if let Some(engine) = engines.get(2) {
                fast.count(&many, &*engines[0], &**engine);
                embree.count(&few, &**engine, &*engines[1]);
            }
        }
    }
    for (family, [fast, obvhs, brute]) in Family::ALL.into_iter().zip(&tallies) {
        obvhs.check(family, "obvhs, brute force");
        if embree() {
            fast.check(family, "obvhs, Embree");
            brute.check(family, "Embree, brute force");
        }
    }
}

/// Rays into closed surfaces, aimed at the edges and corners of their triangles.
#[test]
fn closed_surfaces_do_not_leak() {
    let mut random = Random::new(11);
    for scene in [Scene::sphere(40), Scene::room(0, 16)] {
        let triangles = scene.triangles();
        let mut fans = Fans::default();
        while fans.segments() < 400_000 {
            // Any point on an edge, or every third time a corner.
            let corners = triangles.indices[random.below(triangles.indices.len())];
            let [a, b, _] = corners.map(|i| triangles.vertices[i as usize].as_dvec3());
            let aim = if random.unit() < 0.3 {
                a
            } else {
                a.lerp(b, random.unit())
            };
            let inside = 0.1 * EXTENT * random.in_cube();
            fans.begin(inside.as_vec3());
            fans.push((inside + random.between(1.2, 3.0) * (aim - inside)).as_vec3());
        }
        for engine in engines(&triangles, &[EngineChoice::Obvhs, EngineChoice::Embree]) {
            let occluded: u32 = ask(&*engine, &fans)
                .iter()
                .map(|mask| mask.count_ones())
                .sum();
            let leaks = fans.segments() as u32 - occluded;
            let name = engine.info().name;
            println!(
                "{:7} {name:7} {leaks} of {} segments leak",
                scene.name,
                fans.segments()
            );
            // Obvhs asks again in double precision where single precision is in doubt. Embree does
            // not: aimed exactly at a corner, the rounded signs of the edges around it may contradict
            // each other. 2 in 10 thousand were seen; among segments not aimed, none.
            let allowed = if name == "embree" {
                fans.segments() as u32 / 1000
            } else {
                0
            };
            assert!(leaks <= allowed, "{name} in {}", scene.name);
        }
    }
}

#[test]
fn companions_do_not_matter() {
    let triangles = Scene::room(20, 8).triangles();
    for family in Family::ALL {
        let fans = Segments::new(&triangles, 23).fans(family, 20_000);
        for engine in engines(&triangles, &[EngineChoice::Obvhs, EngineChoice::Embree]) {
            let together = ask(&*engine, &fans);
            let mut alone = Fans::default();
            let mut answers = Vec::new();
            // Every segment in a fan of its own, and those in reverse order.
            for (fan, mask) in together.iter().enumerate().rev() {
                let (origin, targets) = fans.fan(fan);
                for (k, target) in targets.enumerate() {
                    alone.begin(origin);
                    alone.push(target);
                    answers.push(mask >> k & 1);
                }
            }
            let name = engine.info().name;
            assert!(ask(&*engine, &alone) == answers, "{name} on {family:?}");
        }
    }
}

#[test]
fn threads_share_an_engine() {
    let triangles = Scene::room(20, 8).triangles();
    let fans = Segments::new(&triangles, 29).fans(Family::Surfaces, 100_000);
    for engine in engines(&triangles, &[EngineChoice::Obvhs, EngineChoice::Embree]) {
        let expected = ask(&*engine, &fans);
        std::thread::scope(|scope| {
            let threads: Vec<_> = (0..4)
                .map(|_| scope.spawn(|| ask(&*engine, &fans)))
                .collect();
            for thread in threads {
                assert!(thread.join().expect("no panic") == expected);
            }
        });
    }
}

/// A ray through the point that a hit names must end on the triangle that it names, and nearest means that
/// brute force finds nothing nearer.
#[test]
fn engines_agree_on_nearest_hits() {
    for (scene, seed) in scenes() {
        let triangles = scene.triangles();
        let mut random = Random::new(seed);
        let rays: Vec<Ray> = (0..BRUTE_FORCE_TESTS / triangles.indices.len())
            .map(|_| {
                let origin = (0.55 * EXTENT * random.in_cube()).as_vec3();
                Ray {
                    origin,
                    direction: random.in_cube().as_vec3(),
                }
            })
            .collect();
        let mut expected = Vec::new();
        let brute_force = engines(&triangles, &[EngineChoice::BruteForce]);
        brute_force[0].nearest(&rays, &mut expected);
        for engine in engines(&triangles, &[EngineChoice::Obvhs, EngineChoice::Embree]) {
            let mut hits = Vec::new();
            engine.nearest(&rays, &mut hits);
            let mut differences = 0;
            for ((ray, hit), expected) in rays.iter().zip(&hits).zip(&expected) {
                hit.iter()
                    .for_each(|hit| assert_on_triangle(&triangles, ray, hit));
                differences += u32::from(!same_place(hit, expected));
            }
            // Rays past a silhouette; the soup has a few.
            let rate = f64::from(differences) / rays.len() as f64;
            assert!(
                rate < 1e-3,
                "{} in {}: {rate}",
                engine.info().name,
                scene.name
            );
        }
    }
}

fn same_place(a: &Option<Hit>, b: &Option<Hit>) -> bool {
    match (a, b) {
        // A grazing ray loses the digits that it gains in length.
        (Some(a), Some(b)) => (a.t - b.t).abs() <= 1e-4 * b.t.max(1.0),
        (None, None) => true,
        _ => false,
    }
}

fn assert_on_triangle(triangles: &Triangles, ray: &Ray, hit: &Hit) {
    let corners = triangles.indices[hit.triangle as usize];
    let [a, b, c] = corners.map(|i| triangles.vertices[i as usize].as_dvec3());
    let (u, v) = (f64::from(hit.u), f64::from(hit.v));
    let on_triangle = (1.0 - u - v) * a + u * b + v * c;
    let on_ray = ray.origin.as_dvec3() + f64::from(hit.t) * ray.direction.as_dvec3();
    let distance = on_triangle.distance(on_ray);
    assert!(
        distance < 1e-4 * EXTENT,
        "{distance} apart: {ray:?} {hit:?}"
    );
}
