//! Throughput of occlusion: Embree's own calls on packets that are ready, our wrapper around them, and obvhs with our traversal, on the
//! same fans of 64 segments, interleaved, on one thread; first with the widest instruction set, then with both held to narrower ones.
//!
//! `cargo bench --bench occlusion`; rates are medians, ratios are to Embree's own calls of the same instruction set.

#[cfg(embree)]
mod raw;

mod fans;
mod median;
#[path = "../tests/visibility/random.rs"]
#[allow(dead_code)]
mod random;
#[path = "../tests/visibility/scenes.rs"]
#[allow(dead_code)]
mod scenes;

use median::median;
use radiosity::visibility::{
    EngineChoice, Fans, Isa, MAX_FAN, Obvhs, Triangles, Visibility, build,
};
use scenes::Scene;
use std::time::Instant;

const ROUNDS: usize = 15;
const FANS: usize = 4000;

fn main() {
    println!("{FANS} fans of {MAX_FAN} segments, median of {ROUNDS} interleaved rounds");
    for scene in [
        Scene::room(2, 1),
        Scene::hall(3, 8),
        Scene::hall(5, 15),
        Scene::hall(8, 20),
        Scene::hall(8, 63),
    ] {
        let triangles = scene.triangles();
        println!("\n{} triangles", triangles.indices.len());
        compare(&triangles, &fans::to_ceiling(&triangles, FANS));
    }
}

/// Something that answers all fans and says how many segments are occluded.
struct Contender<'a> {
    name: String,
    /// Whether those that follow are compared with it.
    is_reference: bool,
    answer: Box<dyn FnMut() -> u32 + 'a>,
}

fn compare(triangles: &Triangles, fans: &Fans) {
    let mut contenders = Vec::new();
    for isa in Isa::available().into_iter().rev() {
        #[cfg(embree)]
        contenders.push(raw_contender(isa, triangles, fans));
        if isa == Isa::widest() {
            match build(EngineChoice::Embree, triangles, 1) {
                Ok(engine) => contenders.push(contender(engine, fans)),
                Err(error) => println!("  {error}"),
            }
        }
        let obvhs = Obvhs::with_isa(triangles, isa).expect("it takes these triangles");
        contenders.push(contender(Box::new(obvhs), fans));
    }
    let mut seconds = vec![Vec::new(); contenders.len()];
    for _ in 0..ROUNDS {
        for (contender, seconds) in contenders.iter_mut().zip(&mut seconds) {
            let start = Instant::now();
            std::hint::black_box((contender.answer)());
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    let mut reference = f64::NAN;
    for (contender, seconds) in contenders.iter_mut().zip(seconds) {
        let (time, occluded) = (median(seconds), f64::from((contender.answer)()));
        if contender.is_reference {
            reference = time;
        }
        println!(
            "  {:32} {:8.2} Mrays/s   {:5.2} x the rate   {:.2} % occluded",
            contender.name,
            fans.segments() as f64 / time / 1e6,
            reference / time,
            100.0 * occluded / fans.segments() as f64
        );
    }
}

#[cfg(embree)]
fn raw_contender<'a>(isa: Isa, triangles: &Triangles, fans: &'a Fans) -> Contender<'a> {
    let (name, answer) = raw::contender(isa, triangles, std::slice::from_ref(fans));
    Contender {
        name: name.to_owned(),
        is_reference: true,
        answer,
    }
}

fn contender<'a>(engine: Box<dyn Visibility>, fans: &'a Fans) -> Contender<'a> {
    let info = engine.info();
    let mut masks = Vec::new();
    Contender {
        name: format!(
            "{} {} ({}, {})",
            info.name, info.version, info.isa, info.packet_width
        ),
        is_reference: false,
        answer: Box::new(move || {
            engine.occluded(fans, &mut masks);
            masks.iter().map(|mask| mask.count_ones()).sum()
        }),
    }
}
