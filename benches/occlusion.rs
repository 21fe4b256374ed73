//! Throughput of occlusion: Embree's own calls on packets that are ready, our wrapper around them, and
//! obvhs with our traversal, on the same fans of 64 segments, interleaved, on one thread.
//!
//! `cargo bench --bench occlusion`; rates are medians, ratios are to the first line of each scene.

#[path = "../tests/visibility/random.rs"]
#[allow(dead_code)]
mod random;
#[path = "../tests/visibility/scenes.rs"]
#[allow(dead_code)]
mod scenes;

use glam::{DVec3, dvec3};
use radiosity::visibility::{EngineChoice, Fans, MAX_FAN, Triangles, Visibility, build};
use random::Random;
use scenes::{EXTENT, Scene};
use std::time::Instant;

const ROUNDS: usize = 15;
const FANS: usize = 4000;
/// Neighbouring vertices that follow each other, as they do in a patch.
const NEIGHBOURS: usize = 40;

fn main() {
    println!("{FANS} fans of {MAX_FAN} segments, median of {ROUNDS} interleaved rounds");
    for scene in [Scene::room(2, 1), Scene::hall(8, 20), Scene::hall(8, 63)] {
        let triangles = scene.triangles();
        println!("\n{} triangles", triangles.indices.len());
        compare(&triangles, &fans_to_ceiling(&triangles));
    }
}

/// From points on the triangles, in the order of the triangles, to one rectangle below the ceiling.
fn fans_to_ceiling(triangles: &Triangles) -> Fans {
    let mut random = Random::new(3);
    let ceiling = triangles.vertices.iter().fold(f32::MIN, |y, v| y.max(v.y));
    let samples: Vec<DVec3> = (0..MAX_FAN)
        .map(|k| {
            let (row, column) = ((k / 8) as f64, (k % 8) as f64);
            let (x, z) = (row + random.unit(), column + random.unit());
            dvec3((x - 4.0) * 0.04, 0.0, (z - 4.0) * 0.04) * EXTENT
                + DVec3::Y * f64::from(ceiling) * 0.999
        })
        .collect();
    let mut fans = Fans::default();
    while fans.len() < FANS {
        let first = random.below(triangles.indices.len());
        for i in (first..triangles.indices.len()).cycle().take(NEIGHBOURS) {
            let [a, b, c] = triangles.indices[i].map(|k| triangles.vertices[k as usize].as_dvec3());
            let (centre, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize());
            fans.begin((centre + 1e-5 * EXTENT * normal).as_vec3());
            samples
                .iter()
                .for_each(|sample| fans.push(sample.as_vec3()));
        }
    }
    fans
}

/// Something that answers all fans and says how many segments are occluded.
type Contender<'a> = (String, Box<dyn FnMut() -> u32 + 'a>);

fn compare(triangles: &Triangles, fans: &Fans) {
    let mut contenders: Vec<Contender> = Vec::new();
    #[cfg(embree)]
    contenders.push(raw::contender(triangles, fans));
    for choice in [EngineChoice::Embree, EngineChoice::Obvhs] {
        match build(choice, triangles, 1) {
            Ok(engine) => contenders.push(contender(engine, fans)),
            Err(error) => println!("  {choice}: {error}"),
        }
    }
    let mut seconds = vec![Vec::new(); contenders.len()];
    for _ in 0..ROUNDS {
        for ((_, answer), seconds) in contenders.iter_mut().zip(&mut seconds) {
            let start = Instant::now();
            std::hint::black_box(answer());
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    let reference = median(&mut seconds[0]);
    for ((name, answer), seconds) in contenders.iter_mut().zip(&mut seconds) {
        let (time, occluded) = (median(seconds), f64::from(answer()));
        let rate = fans.segments() as f64 / time / 1e6;
        let share = 100.0 * occluded / fans.segments() as f64;
        println!(
            "  {name:32} {rate:8.2} Mrays/s   {:5.2} x the time   {share:.2} % occluded",
            time / reference
        );
    }
}

fn contender<'a>(engine: Box<dyn Visibility>, fans: &'a Fans) -> Contender<'a> {
    let info = engine.info();
    let name = format!(
        "{} {} ({}, {})",
        info.name, info.version, info.isa, info.packet_width
    );
    let mut masks = Vec::new();
    let answer = move || {
        engine.occluded(fans, &mut masks);
        masks.iter().map(|mask| mask.count_ones()).sum()
    };
    (name, Box::new(answer))
}

fn median(seconds: &mut [f64]) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

/// Embree without us: packets of 16 that are ready, only `tfar` is written anew.
#[cfg(embree)]
mod raw {
    use super::Contender;
    use embree4_sys as sys;
    use radiosity::visibility::{Fans, T_FAR, T_NEAR, Triangles};

    const WIDTH: usize = 16;

    #[repr(align(64))]
    struct Valid([i32; WIDTH]);

    pub fn contender<'a>(triangles: &Triangles, fans: &'a Fans) -> Contender<'a> {
        let scene = commit(triangles);
        let mut packets = packets(fans);
        let answer = move || trace(&mut packets, scene);
        (
            "rtcOccluded16 on ready packets".to_owned(),
            Box::new(answer),
        )
    }

    fn trace(packets: &mut [sys::RTCRay16], scene: sys::RTCScene) -> u32 {
        let valid = Valid([-1; WIDTH]);
        let mut occluded = 0;
        for packet in packets {
            packet.tfar = [T_FAR; WIDTH];
            // SAFETY: mask and packet are aligned by their types; the scene is committed.
            unsafe { sys::shim_occluded16(valid.0.as_ptr(), scene, packet, true) };
            occluded += packet.tfar.iter().filter(|&&t| t < 0.0).count() as u32;
        }
        occluded
    }

    fn packets(fans: &Fans) -> Vec<sys::RTCRay16> {
        let mut segments = (0..fans.len()).flat_map(|fan| {
            let (origin, targets) = fans.fan(fan);
            targets.map(move |target| (origin, target))
        });
        let mut packets = Vec::new();
        for _ in 0..fans.segments() / WIDTH {
            let mut packet = sys::RTCRay16 {
                tnear: [T_NEAR; WIDTH],
                mask: [u32::MAX; WIDTH],
                ..Default::default()
            };
            for lane in 0..WIDTH {
                let (origin, target) = segments.next().expect("whole packets");
                let direction = target - origin;
                packet.org_x[lane] = origin.x;
                packet.org_y[lane] = origin.y;
                packet.org_z[lane] = origin.z;
                packet.dir_x[lane] = direction.x;
                packet.dir_y[lane] = direction.y;
                packet.dir_z[lane] = direction.z;
            }
            packets.push(packet);
        }
        packets
    }

    /// A scene as `visibility::embree` makes it; it lives as long as the program.
    fn commit(triangles: &Triangles) -> sys::RTCScene {
        let (vertices, indices) = (&triangles.vertices, &triangles.indices);
        // SAFETY: straight calls in the documented order; Embree's buffers have room for what is
        // copied into them.
        unsafe {
            let device = sys::rtcNewDevice(c"threads=2".as_ptr());
            let scene = sys::rtcNewScene(device);
            sys::rtcSetSceneFlags(scene, sys::RTCSceneFlags::RTC_SCENE_FLAG_ROBUST);
            let kind = sys::RTCGeometryType::RTC_GEOMETRY_TYPE_TRIANGLE;
            let geometry = sys::rtcNewGeometry(device, kind);
            let buffer = |kind, format, count| {
                sys::rtcSetNewGeometryBuffer(geometry, kind, 0, format, 12, count)
            };
            let kind = sys::RTCBufferType::RTC_BUFFER_TYPE_VERTEX;
            buffer(kind, sys::RTCFormat::RTC_FORMAT_FLOAT3, vertices.len())
                .cast::<glam::Vec3>()
                .copy_from_nonoverlapping(vertices.as_ptr(), vertices.len());
            let kind = sys::RTCBufferType::RTC_BUFFER_TYPE_INDEX;
            buffer(kind, sys::RTCFormat::RTC_FORMAT_UINT3, indices.len())
                .cast::<[u32; 3]>()
                .copy_from_nonoverlapping(indices.as_ptr(), indices.len());
            sys::rtcCommitGeometry(geometry);
            sys::rtcAttachGeometry(scene, geometry);
            sys::rtcCommitScene(scene);
            scene
        }
    }
}
