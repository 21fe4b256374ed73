//! Any payload of a solution file is a solution that can be shown and continued, or an error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use radiosity::solution::{Prober, Solution};

fuzz_target!(|data: &[u8]| {
    let _ = Solution::decode(data);
    let Ok(solution) = Solution::from_payload(data) else {
        return;
    };
    let lit = solution.lit_mesh();
    let _ = solution.triangle_errors(&lit);
    if let Some(vertex) = lit.vertices.first() {
        let at = lit.positions[vertex.position as usize];
        let _ = Prober::new(&solution).probe(at, vertex.normal.as_dvec3());
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    solution.write(&mut bytes).expect("memory can be written to");
    Solution::decode(bytes.get_ref()).expect("was just written");
});
