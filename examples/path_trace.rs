//! The irradiance at points of a scene by path tracing: the independent answer that the tables in `tests/data` hold.
//!
//! ```text
//! cargo run --release --example path_trace -- SCENE [--points N | --at TABLE.csv] [--paths N] [--seed S] > points.csv
//! ```
//!
//! Without `--at` the points are spread at random over all radiating sides, less those that another surface touches or that
//! lie in a solid or see nothing. Every path samples an emitter at each of its ends and goes on by the cosine; its length is unbounded
//! (Russian roulette). The direct part is stratified over each emitter's area. Nothing here knows of meshes, form factors or
//! thresholds; it shares with the solver the reader of scenes and the engine that traces rays.
//!
//! `--at` traces at the points of a table, and says on standard error how the two agree: the mean square of the difference in
//! units of both standard errors is 1 where both are right.

#[path = "../tests/common/mod.rs"]
mod common;

use clap::Parser;
use common::reference::{self, Sample};
use fastrand::Rng;
use glam::{DVec3, Vec3};
use radiosity::scene::{Scene, Sides};
use radiosity::visibility::{EngineChoice, Fans, Hit, Ray, Triangles, Visibility, build};
use rayon::prelude::*;
use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::path::PathBuf;

/// Rays start this far from their surface, over the scene's extent.
const OFFSET: f64 = 1e-6;

/// Paths that go together.
const BATCH: usize = 1024;

/// Strata of the direct part, along each side of an emitter, and how often it is sampled.
const STRATA: usize = 24;
const ROUNDS: usize = 8;

#[derive(Parser)]
struct Request {
    scene: PathBuf,
    /// How many random points
    #[arg(long, default_value_t = 300)]
    points: usize,
    /// A table with the points instead
    #[arg(long)]
    at: Option<PathBuf>,
    /// Paths a point
    #[arg(long, default_value_t = 1 << 16)]
    paths: usize,
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Request {
        scene,
        points,
        at: table,
        paths,
        seed,
    } = Request::parse();
    let scene = Scene::load(&scene)?;
    let tracer = Tracer::new(&scene)?;
    let places = match &table {
        Some(table) => reference::read(table)?,
        None => tracer.places(points, seed),
    };
    println!(
        "# Irradiance E (W/m²) at points of the scene {}, with its standard error: path_trace, {paths} paths a point, seed {seed}.",
        scene.name
    );
    println!("x,y,z,nx,ny,nz,E_r,E_g,E_b,se_r,se_g,se_b");
    let mut agreement = 0.0;
    let traced: Vec<(DVec3, DVec3)> = (places.par_iter().enumerate())
        .map(|(i, place)| {
            let mut rng = Rng::with_seed(seed ^ (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
            tracer.irradiance(place.point, place.normal, paths, &mut rng)
        })
        .collect();
    for (place, (mean, error)) in places.iter().zip(traced) {
        let numbers = [place.point, place.normal, mean, error]
            .map(|v| v.to_array())
            .concat();
        let fields: Vec<String> = numbers.iter().map(|x| format!("{x:.7e}")).collect();
        println!("{}", fields.join(","));
        let both = error * error + place.standard_error * place.standard_error;
        agreement +=
            ((mean - place.irradiance).powf(2.0) / both.max(DVec3::splat(1e-300))).element_sum();
    }
    if table.is_some() {
        eprintln!(
            "mean square difference in standard errors: {:.3}",
            agreement / (3 * places.len()) as f64
        );
    }
    Ok(())
}

/// A triangle of the scene and what its two sides do.
struct Facet {
    corners: [DVec3; 3],
    normal: DVec3,
    area: f64,
    reflectance: DVec3,
    exitance: DVec3,
    both_sides: bool,
    surface: usize,
}

/// A random point of a triangle, of equal density.
fn point_of(corners: [DVec3; 3], s: f64, t: f64) -> DVec3 {
    let [a, b, c] = corners;
    let root = s.sqrt();
    a * (1.0 - root) + b * (root * (1.0 - t)) + c * (root * t)
}

struct Tracer {
    facets: Vec<Facet>,
    emitters: Vec<usize>,
    engine: Box<dyn Visibility>,
    /// Rays are traced about this point, where single precision is best.
    middle: DVec3,
    offset: f64,
}

impl Tracer {
    fn new(scene: &Scene) -> Result<Self, Box<dyn Error>> {
        let mut facets = Vec::new();
        for (number, surface) in scene.surfaces.iter().enumerate() {
            let material = &scene.materials[surface.material as usize];
            for triangle in surface.corners.triangles() {
                let corners = triangle.map(|i| scene.vertices[i as usize]);
                let cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                facets.push(Facet {
                    corners,
                    normal: cross.normalize(),
                    area: 0.5 * cross.length(),
                    reflectance: material.reflectance.as_dvec3(),
                    exitance: PI * material.emitted_radiance.as_dvec3(),
                    both_sides: surface.sides == Sides::Both,
                    surface: number,
                });
            }
        }
        let (low, high) = scene
            .vertices
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), v| {
                (low.min(*v), high.max(*v))
            });
        let middle = 0.5 * (low + high);
        let triangles = Triangles {
            vertices: facets
                .iter()
                .flat_map(|f| f.corners.map(|c| (c - middle).as_vec3()))
                .collect(),
            indices: (0..facets.len() as u32)
                .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
                .collect(),
        };
        Ok(Self {
            emitters: (0..facets.len())
                .filter(|f| facets[*f].exitance != DVec3::ZERO)
                .collect(),
            facets,
            engine: build(EngineChoice::Auto, &triangles, 0)?,
            middle,
            offset: OFFSET * (high - low).max_element(),
        })
    }

    /// Random points, evenly over the area of all radiating sides.
    fn places(&self, count: usize, seed: u64) -> Vec<Sample> {
        let mut rng = Rng::with_seed(seed);
        let area: f64 = self.facets.iter().map(|f| f.area).sum();
        let mut places = Vec::with_capacity(count);
        while places.len() < count {
            let mut left = rng.f64() * area;
            let facet = (self.facets.iter())
                .find(|f| {
                    left -= f.area;
                    left < 0.0
                })
                .unwrap_or(&self.facets[0]);
            let point = point_of(facet.corners, rng.f64(), rng.f64());
            let back = facet.both_sides && rng.bool();
            let normal = if back { -facet.normal } else { facet.normal };
            if facet.reflectance != DVec3::ZERO
                && self.is_open(point, normal, facet.surface, &mut rng)
            {
                places.push(Sample {
                    point,
                    normal,
                    irradiance: DVec3::ZERO,
                    standard_error: DVec3::ZERO,
                });
            }
        }
        places
    }

    /// Whether no other surface lies on the point, and it sees something, mostly not the black backs of a solid that it is in.
    fn is_open(&self, point: DVec3, normal: DVec3, surface: usize, rng: &mut Rng) -> bool {
        let touches = |facet: &Facet| {
            let [a, b, c] = facet.corners;
            let inside = [(a, b), (b, c), (c, a)]
                .iter()
                .all(|(p, q)| (*q - *p).cross(point - *p).dot(facet.normal) >= 0.0);
            facet.surface != surface
                && inside
                && (point - a).dot(facet.normal).abs() < 100.0 * self.offset
        };
        if self.facets.iter().any(touches) {
            return false;
        }
        let rays: Vec<Ray> = (0..64)
            .map(|_| self.ray(point, normal, cosine(normal, rng)))
            .collect();
        let mut hits = Vec::new();
        self.engine.nearest(&rays, &mut hits);
        let black = |(hit, ray): (&Option<Hit>, &Ray)| {
            hit.map(|hit| self.side(hit, ray.direction.as_dvec3()).is_none())
        };
        let seen: Vec<bool> = hits.iter().zip(&rays).filter_map(black).collect();
        !seen.is_empty() && seen.iter().filter(|b| **b).count() < rays.len() / 2
    }

    /// The normal of the side that was hit; `None` for a black back.
    fn side(&self, hit: Hit, direction: DVec3) -> Option<DVec3> {
        let facet = &self.facets[hit.triangle as usize];
        let front = direction.dot(facet.normal) < 0.0;
        (front || facet.both_sides).then_some(if front { facet.normal } else { -facet.normal })
    }

    fn inner(&self, point: DVec3, normal: DVec3) -> Vec3 {
        (point + normal * self.offset - self.middle).as_vec3()
    }

    fn ray(&self, point: DVec3, normal: DVec3, direction: DVec3) -> Ray {
        Ray {
            origin: self.inner(point, normal),
            direction: direction.as_vec3(),
        }
    }

    /// Mean irradiance and its standard error.
    fn irradiance(
        &self,
        point: DVec3,
        normal: DVec3,
        paths: usize,
        rng: &mut Rng,
    ) -> (DVec3, DVec3) {
        let (direct, direct_error) = self.direct(point, normal, rng);
        let mut batches = Moments::default();
        for _ in 0..paths.div_ceil(BATCH).max(2) {
            batches.add(self.reflected(point, normal, rng));
        }
        let (reflected, error) = batches.mean_and_error();
        (
            direct + reflected,
            (error * error + direct_error * direct_error).powf(0.5),
        )
    }

    /// The light of all emitters, a random point in each stratum of each; mean of all rounds and its standard error.
    fn direct(&self, point: DVec3, normal: DVec3, rng: &mut Rng) -> (DVec3, DVec3) {
        let at = |k: usize, rng: &mut Rng| (k as f64 + rng.f64()) / STRATA as f64;
        let mut rounds = Moments::default();
        for _ in 0..ROUNDS {
            let mut fans = Fans::default();
            let mut values = Vec::new();
            for emitter in &self.emitters {
                for stratum in 0..STRATA * STRATA {
                    let (s, t) = (at(stratum / STRATA, rng), at(stratum % STRATA, rng));
                    let light = self.unhindered(point, normal, *emitter, s, t, &mut fans);
                    values.push(light / (STRATA * STRATA) as f64);
                }
            }
            rounds.add(self.seen(&fans, &values).iter().sum());
        }
        rounds.mean_and_error()
    }

    /// Light from a point of an emitter, per unit density, if nothing is in the way; adds the segment to ask about.
    fn unhindered(
        &self,
        point: DVec3,
        normal: DVec3,
        emitter: usize,
        s: f64,
        t: f64,
        fans: &mut Fans,
    ) -> DVec3 {
        let facet = &self.facets[emitter];
        let to = point_of(facet.corners, s, t);
        let way = to - point;
        let square = way.length_squared();
        let cosines = normal.dot(way).max(0.0) * facet.normal.dot(-way).max(0.0) / square;
        fans.begin(self.inner(point, normal));
        fans.push(self.inner(to, facet.normal));
        facet.exitance * (cosines * facet.area / (PI * square))
    }

    /// The values whose segment is free.
    fn seen(&self, fans: &Fans, values: &[DVec3]) -> Vec<DVec3> {
        let mut masks = Vec::new();
        self.engine.occluded(fans, &mut masks);
        masks
            .iter()
            .zip(values)
            .map(|(mask, value)| if *mask == 0 { *value } else { DVec3::ZERO })
            .collect()
    }

    /// The mean over a batch of paths of what arrives after one reflection or more.
    fn reflected(&self, point: DVec3, normal: DVec3, rng: &mut Rng) -> DVec3 {
        let mut ends = vec![(point, normal, DVec3::ONE); BATCH];
        let mut total = DVec3::ZERO;
        let (mut rays, mut hits) = (Vec::new(), Vec::new());
        for bounce in 0.. {
            rays.clear();
            rays.extend(
                ends.iter()
                    .map(|(p, n, _)| self.ray(*p, *n, cosine(*n, rng))),
            );
            self.engine.nearest(&rays, &mut hits);
            let mut next = Vec::with_capacity(ends.len());
            for ((ray, hit), (from, side, throughput)) in rays.iter().zip(&hits).zip(&ends) {
                let Some(hit) = hit else { continue };
                let direction = ray.direction.as_dvec3();
                let Some(normal) = self.side(*hit, direction) else {
                    continue;
                };
                let facet = &self.facets[hit.triangle as usize];
                let start = *from + *side * self.offset;
                let distance = (facet.corners[0] - start).dot(normal) / direction.dot(normal);
                let mut throughput = *throughput * facet.reflectance;
                let survival = if bounce < 2 {
                    1.0
                } else {
                    throughput.max_element().min(1.0)
                };
                if rng.f64() < survival {
                    throughput /= survival;
                    next.push((start + direction * distance, normal, throughput));
                }
            }
            if next.is_empty() {
                return total / BATCH as f64;
            }
            let mut fans = Fans::default();
            let values: Vec<DVec3> = next
                .iter()
                .map(|(point, normal, throughput)| {
                    let emitter = self.emitters[rng.usize(..self.emitters.len())];
                    let light =
                        self.unhindered(*point, *normal, emitter, rng.f64(), rng.f64(), &mut fans);
                    *throughput * light * self.emitters.len() as f64
                })
                .collect();
            total += self.seen(&fans, &values).iter().sum::<DVec3>();
            ends = next;
        }
        unreachable!("the last path has ended")
    }
}

/// Independent estimates of one value.
#[derive(Default)]
struct Moments {
    count: f64,
    sum: DVec3,
    squares: DVec3,
}

impl Moments {
    fn add(&mut self, value: DVec3) {
        self.count += 1.0;
        self.sum += value;
        self.squares += value * value;
    }

    fn mean_and_error(&self) -> (DVec3, DVec3) {
        let mean = self.sum / self.count;
        let variance = (self.squares / self.count - mean * mean).max(DVec3::ZERO);
        (mean, (variance / (self.count - 1.0)).powf(0.5))
    }
}

/// A direction about `normal`, in proportion to its cosine.
fn cosine(normal: DVec3, rng: &mut Rng) -> DVec3 {
    let (s, angle) = (rng.f64(), TAU * rng.f64());
    let (u, v) = normal.any_orthonormal_pair();
    let radius = s.sqrt();
    u * (radius * angle.cos()) + v * (radius * angle.sin()) + normal * (1.0 - s).sqrt()
}
