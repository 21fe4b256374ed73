//! A solve under way, for the tests of its parts.

use super::shoot::Shooter;
use super::tiling::Tiling;
use super::{Course, Light, Options, Preset, Silent, Solver, occluders};
use crate::mesh::Mesh;
use crate::radiometry::Spectrum;
use crate::scene::Scene;
use crate::visibility::{EngineChoice, Visibility, build};
use std::path::Path;
use std::time::Duration;

/// The Cornell box after some shots.
pub(super) struct Trial {
    scene: Scene,
    engine: Box<dyn Visibility>,
    mesh: Mesh,
    light: Light,
    options: Options,
}

impl Trial {
    pub fn after(shots: u64, options: Options) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box");
        let scene = Scene::load(&folder).expect("it is there");
        let mesh = Mesh::new(&scene, options.limits);
        let engine = build(EngineChoice::Obvhs, &occluders(&scene, &mesh), 0).expect("it can");
        let some = Options {
            max_shots: Some(shots),
            audit_points: 0,
            ..options.clone()
        };
        let lit = Solver::new(&scene, mesh, &*engine, some).run(&mut Silent);
        Self {
            scene,
            engine,
            mesh: lit.mesh,
            light: lit.light,
            options,
        }
    }

    /// The solver, about to shoot.
    pub fn solver(&self) -> Solver<'_> {
        let state = (self.mesh.clone(), self.light.clone(), Course::default());
        let options = self.options.clone();
        Solver::resume(&self.scene, state, &*self.engine, options, Duration::ZERO)
    }
}

/// The options of a preset, with which any patches shoot as clusters.
pub(super) fn as_clusters(preset: Preset) -> Options {
    Options {
        cluster_from: 1,
        ..preset.options()
    }
}

/// All light of a solve, as clusters.
pub(super) fn all_light(of: &Solver) -> Shooter {
    let whole = of.whole(Spectrum::ONE);
    let scale = of.sampler().thresholds.scale;
    let tiling = Tiling::even(&of.mesh, &whole, (&of.options, scale));
    tiling.radiating(&of.mesh, &whole)
}
