//! Instructions that the kernels take: unlike seconds the same in every run, those of a whole solve to one in a thousand, so that a small
//! change is seen on any machine.
//!
//! `cargo bench --bench instructions`, with valgrind installed, counts them with its tool callgrind, one process a kernel, and compares with
//! the run before. A name, or a part of one, counts only those kernels. Valgrind knows AVX2, not AVX-512, and Embree is not counted: it is
//! not ours.

mod fans;
mod hall;
mod pairs;
#[path = "../tests/visibility/random.rs"]
#[allow(dead_code)]
mod random;
#[path = "../tests/visibility/scenes.rs"]
#[allow(dead_code)]
mod scenes;

use glam::DVec3;
use pairs::{Pair, across, clipped, pairs};
use radiosity::form_factor::{point_to_disk, point_to_polygon};
use radiosity::mesh::Mesh;
use radiosity::scene::Scene;
use radiosity::solver::{Options, Preset, Silent, Solver, occluders};
use radiosity::visibility::{Isa, Obvhs, Visibility};
use std::collections::BTreeMap;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// A kernel is prepared, which is not counted, and then run, which gives the number of its operations.
struct Kernel {
    name: &'static str,
    /// What one operation is.
    of: &'static str,
    prepare: fn() -> Work,
}

type Work = Box<dyn FnOnce() -> usize>;

const KERNELS: [Kernel; 10] = [
    Kernel {
        name: "Eq. (1)",
        of: "form factor",
        prepare: || form_factors(|p| point_to_disk(DVec3::Z, p.to, p.normal, p.area)),
    },
    Kernel {
        name: "Eq. (2)",
        of: "form factor",
        prepare: || form_factors(|p| point_to_polygon(DVec3::Z, &p.corners)),
    },
    Kernel {
        name: "Eq. (2), clipped, above the horizon",
        of: "form factor",
        prepare: || form_factors(|p| clipped(DVec3::Z, p)),
    },
    Kernel {
        name: "Eq. (2), clipped, across the horizon",
        of: "form factor",
        prepare: || form_factors(|p| clipped(across(p), p)),
    },
    Kernel {
        name: "occlusion by obvhs, portable",
        of: "ray",
        prepare: || occlusion(Isa::Portable),
    },
    Kernel {
        name: "occlusion by obvhs, widest",
        of: "ray",
        prepare: || occlusion(Isa::widest()),
    },
    Kernel {
        name: "mesh of a hall",
        of: "vertex",
        prepare: mesh,
    },
    Kernel {
        name: "Cornell box, draft",
        of: "vertex",
        prepare: || solve(cornell_box(), Preset::Draft),
    },
    Kernel {
        name: "Cornell box, standard",
        of: "vertex",
        prepare: || solve(cornell_box(), Preset::Standard),
    },
    Kernel {
        name: "hall, draft",
        of: "vertex",
        prepare: || solve(hall(2000), Preset::Draft),
    },
];

const COUNT: &str = "--count";

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).filter(|a| a != "--bench");
    let result = match (arguments.next(), arguments.next()) {
        (Some(flag), Some(name)) if flag == COUNT => {
            count(&name);
            return ExitCode::SUCCESS;
        }
        (part, _) => compare(&part.unwrap_or_default()),
    };
    if let Err(error) = result {
        eprintln!("error: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

/// In the process that valgrind watches. The threads of a solve are this one.
fn count(name: &str) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build()
        .expect("this thread");
    let kernel = KERNELS.iter().find(|k| k.name == name).expect("its name");
    pool.install(|| println!("{}", counted((kernel.prepare)())));
}

/// What callgrind counts, by its name.
#[inline(never)]
fn counted(work: Work) -> usize {
    black_box(work())
}

fn compare(part: &str) -> Result<(), String> {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("instructions.json");
    let mut last: BTreeMap<String, f64> = std::fs::read(&file)
        .ok()
        .and_then(|bytes| serde_json::from_slice(&bytes).ok())
        .unwrap_or_default();
    println!(
        "{:38}{:>14}{:>16}{:>12}  of the run before",
        "instructions", "of one", "all, millions", "operations"
    );
    for kernel in KERNELS.iter().filter(|k| k.name.contains(part)) {
        let (instructions, operations) = under_callgrind(kernel.name)?;
        let change = last
            .insert(kernel.name.to_string(), instructions)
            .map_or(String::new(), |before| {
                format!("{:+.2} %", 100.0 * (instructions / before - 1.0))
            });
        println!(
            "{:38}{:>14.1}{:>16.3}{operations:>12}  {change:10} {}",
            kernel.name,
            instructions / operations,
            instructions / 1e6,
            kernel.of
        );
    }
    let text = serde_json::to_string_pretty(&last).expect("numbers by name");
    std::fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))
}

/// Instructions that callgrind counts in [`counted`], and operations.
fn under_callgrind(name: &str) -> Result<(f64, f64), String> {
    let counts: PathBuf = Path::new(env!("CARGO_TARGET_TMPDIR")).join("callgrind.out");
    let own = std::env::current_exe().map_err(|e| e.to_string())?;
    let output = Command::new("valgrind")
        .args([
            "--tool=callgrind",
            "--toggle-collect=*instructions*counted*",
        ])
        .arg(format!("--callgrind-out-file={}", counts.display()))
        .arg(own)
        .args([COUNT, name])
        .output()
        .map_err(|e| format!("valgrind, of the package of that name: {e}"))?;
    let says = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if !output.status.success() {
        return Err(format!("{name}: {}", says(&output.stderr)));
    }
    let text = std::fs::read_to_string(&counts).map_err(|e| e.to_string())?;
    let total = text.lines().find_map(|line| line.strip_prefix("totals: "));
    let number = |text: Option<&str>| text.and_then(|t| t.trim().parse::<f64>().ok());
    match (number(total), number(Some(&says(&output.stdout)))) {
        (Some(instructions), Some(operations)) if instructions > 0.0 => {
            Ok((instructions, operations))
        }
        _ => Err(format!("{name}: callgrind has counted nothing")),
    }
}

fn form_factors(of: impl Fn(&Pair) -> f64 + 'static) -> Work {
    let pairs = pairs();
    Box::new(move || {
        for pair in &pairs {
            black_box(of(black_box(pair)));
        }
        pairs.len()
    })
}

fn occlusion(isa: Isa) -> Work {
    let triangles = scenes::Scene::hall(3, 8).triangles();
    let fans = fans::to_ceiling(&triangles, 400);
    let engine = Obvhs::with_isa(&triangles, isa).expect("it takes these triangles");
    let mut masks = Vec::new();
    Box::new(move || {
        engine.occluded(&fans, &mut masks);
        fans.segments()
    })
}

fn mesh() -> Work {
    let scene = hall(10_000);
    let limits = Preset::Draft.options().limits;
    Box::new(move || Mesh::new(&scene, limits).vertices.len())
}

fn solve(scene: Scene, preset: Preset) -> Work {
    let options = Options {
        audit_points: 0,
        ..preset.options()
    };
    let mesh = Mesh::new(&scene, options.limits);
    let engine = Obvhs::new(&occluders(&scene, &mesh)).expect("it takes these triangles");
    Box::new(move || {
        let outcome = Solver::new(&scene, mesh, &engine, options).run(&mut Silent);
        outcome.mesh.vertices.len()
    })
}

fn cornell_box() -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box");
    Scene::load(&file).expect("the scenes of this repository load")
}

fn hall(triangles: usize) -> Scene {
    let folder = tempfile::tempdir().expect("there is room for a file");
    let file = folder.path().join("hall.obj");
    hall::write(&file, triangles);
    Scene::load(&file).expect("what was written can be read")
}
