//! Whatever bytes the files hold, loading them ends with a scene or an error, and a scene is sound.

use super::Files;
use radiosity::scene::Scene;

/// Steele and Vigna's SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}

const OBJ: &str = "\
# A room with odd polygons
mtllib it.mtl
o room
v 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\nv 0 2.5 0\nv 4 2.5 0\nv 4 2.5 3\nv 0 2.5 3\nv 1.5 0.5e-1 1.5
vt 0 0\nvn 0 1 0
usemtl wall
f 4 3 2 1\nf 5/1 6/1 7/1 8/1\nf 1//1 2//1 6//1 5//1
g more
usemtl lamp
f -7 -8 -4 -3\nf 2 3 9 7 6\nf 1/1/1 5/1/1 8/1/1 4/1/1
f 1 9 \\\n 3\nf 1 2 3 9 4 8
";
const MTL: &str =
    "newmtl wall\nKd 0.5 0.5 0.5\nmap_Kd a.png\nnewmtl lamp\nKd 0 0 0\nKe 1 2 3\nd 0.5\n";
const TOML: &str = "\
name = \"it\"
geometry = \"it.obj\"
unit = \"cm\"
sides = \"auto\"
[material.wall]
reflectance = [0.1, 0.2, 0.3]
sides = \"front\"
[[camera]]
name = \"a\"
eye = [1, 1, 1]
look_at = [2, 1, 2]
width = 640
";

/// What replaces pieces of the files: words that mean something, at the limits or against the rules.
const WORDS: [&[u8]; 30] = [
    b"f",
    b"v",
    b"vn",
    b"usemtl",
    b"mtllib",
    b"newmtl",
    b"Kd",
    b"Ke",
    b"map_Kd",
    b"\n",
    b"\r",
    b"\\\n",
    b"#",
    b" ",
    b"/",
    b"-",
    b"0",
    b"1",
    b"-1",
    b"9",
    b"nan",
    b"inf",
    b"1e308",
    b"1e-320",
    b"-9223372036854775808",
    b"9223372036854775807",
    b"4294967296",
    b"\xFF",
    b"\xEF\xBB\xBF",
    b"\0",
];

fn mutate(text: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for _ in 0..1 + random.below(6) {
        let begin = random.below(bytes.len() + 1);
        let end = (begin + random.below(8)).min(bytes.len());
        let inserted = match random.below(4) {
            0 => Vec::new(),
            1 => vec![random.below(256) as u8],
            _ => WORDS[random.below(WORDS.len())].to_vec(),
        };
        bytes.splice(begin..end, inserted);
    }
    if random.below(20) == 0 {
        bytes.truncate(random.below(bytes.len() + 1));
    }
    bytes
}

pub fn assert_sound(scene: &Scene) {
    assert!(scene.vertices.iter().all(|position| position.is_finite()));
    assert!(!scene.surfaces.is_empty() && !scene.cameras.is_empty());
    for surface in &scene.surfaces {
        assert!(
            surface
                .corners
                .indices()
                .iter()
                .all(|index| (*index as usize) < scene.vertices.len())
        );
        assert!((surface.material as usize) < scene.materials.len());
        assert!((surface.polygon as usize) < scene.input_polygons);
        let area = scene.area(surface);
        assert!(area > 0.0 && area.is_finite(), "{area}");
        let normal = scene.normal(surface);
        assert!((normal.length() - 1.0).abs() < 1e-9);
        let p: Vec<_> = scene.positions(surface).collect();
        let n = p.len();
        let turn = |i: usize| (p[(i + 1) % n] - p[i]).cross(p[(i + 2) % n] - p[(i + 1) % n]);
        assert!((0..n).all(|i| normal.dot(turn(i)) > 0.0), "{p:?} is convex");
    }
    for material in &scene.materials {
        assert!(
            material.reflectance.min_element() >= 0.0 && material.reflectance.max_element() < 1.0
        );
        assert!(
            material.emitted_radiance.min_element() >= 0.0 && material.emitted_radiance.is_finite()
        );
    }
    let (low, high) = scene.bounds();
    assert!(low.is_finite() && high.is_finite());
}

/// Loads the scene with its file `name` mutated, so many times; tells how often that was accepted.
pub fn damage(files: &Files, name: &str, content: &[u8], rounds: usize) -> usize {
    let mut random = Random(2004);
    let path = files.0.path().join(name);
    let once = |_: &usize| {
        std::fs::write(&path, mutate(content, &mut random)).expect("can be written");
        match files.load("") {
            Ok(scene) => {
                assert_sound(&scene);
                true
            }
            Err(error) => {
                assert!(error.to_string().contains("; expected "), "{error}");
                false
            }
        }
    };
    (0..rounds).filter(once).count()
}

#[test]
fn mutated_files_never_panic() {
    let files = Files::new(&[("it.obj", OBJ), ("it.mtl", MTL), ("scene.toml", TOML)]);
    assert_sound(&files.accepted("").0);
    let mut random = Random(2004);
    let mut accepted = 0;
    const ROUNDS: usize = 2000;
    for round in 0..ROUNDS {
        // Mostly the geometry, which has the most ways to be wrong.
        let (name, text) = [
            ("it.obj", OBJ),
            ("it.obj", OBJ),
            ("it.mtl", MTL),
            ("scene.toml", TOML),
        ][round % 4];
        let path = files.0.path().join(name);
        std::fs::write(&path, mutate(text.as_bytes(), &mut random)).expect("can be written");
        match files.load("") {
            Ok(scene) => {
                assert_sound(&scene);
                accepted += 1;
            }
            Err(error) => assert!(error.to_string().contains("; expected "), "{error}"),
        }
        std::fs::write(&path, text).expect("can be written");
    }
    assert!(
        (ROUNDS / 10..ROUNDS).contains(&accepted),
        "{accepted} of {ROUNDS}: the mutations test both ways"
    );
}
