//! The same bits for any number of threads.

use super::{bits, bundled, draft, engines, solved_by};
use radiosity::scene::Scene;
use radiosity::visibility::EngineChoice;

fn bytes(scene: &Scene, engine: EngineChoice, threads: usize) -> Vec<u8> {
    let mut solution = solved_by(scene, draft(), engine, threads);
    assert_eq!(solution.report.threads, threads);
    solution.report.threads = 0;
    bits(solution)
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for name in ["cornell-box", "geometry"] {
        let scene = bundled(name);
        for engine in engines() {
            let alone = bytes(&scene, engine, 1);
            for threads in [2, 7, 64] {
                assert!(
                    bytes(&scene, engine, threads) == alone,
                    "{name} by {engine} on {threads} threads"
                );
            }
        }
    }
}
