//! A solve that is taken up again with other emitters: what they give more or less is shot, and nothing else.

use super::clusters::clustered;
use super::common::ENGINE;
use super::common::reference::{Deviation, Sample, table};
use super::common::sessions::Batches;
use super::common::shapes::{add_grey, add_level};
use super::furnace;
use super::resume::settings;
use super::{bundled, draft, solved};
use glam::DVec3;
use radiosity::radiometry::Spectrum;
use radiosity::scene::Scene;
use radiosity::solution::{Prober, Solution};
use radiosity::solver::{Options, Preset, Silent, StopReason};
use radiosity::{Run, SolveError};

/// Irradiance at points of the Cornell box, to hold other solutions against.
fn samples(of: &Solution) -> Vec<Sample> {
    let prober = Prober::new(of);
    let sample = |known: Sample| Sample {
        irradiance: prober
            .probe(known.point, known.normal)
            .expect("lies on a surface")
            .irradiance
            .as_dvec3(),
        standard_error: DVec3::ZERO,
        ..known
    };
    let points = table("cornell_irradiance.csv").into_iter();
    points.map(sample).collect()
}

/// The Cornell box; what its short box emits is told.
fn with_a_glowing_box(radiance: f32) -> Scene {
    let mut scene = bundled("cornell-box");
    let mut material = scene.materials[scene.surfaces[8].material as usize].clone();
    material.name = "glowing".into();
    material.emitted_radiance = Spectrum::splat(radiance);
    scene.materials.push(material);
    let last = scene.materials.len() as u32 - 1;
    for surface in &mut scene.surfaces[8..13] {
        surface.material = last;
    }
    scene
}

#[test]
fn other_emitters_are_shot_as_the_light_that_they_give_more_or_less() {
    let standard = Preset::Standard.options();
    for (before, after) in [(0.0, 0.4), (0.4, 0.1), (0.4, 0.0)] {
        let anew = samples(&solved(&with_a_glowing_box(after), standard.clone()));
        let solution = solved(&with_a_glowing_box(before), draft());
        let mut run = Run::resume(solution, settings(draft(), ENGINE, 0)).expect("can be resumed");
        run.relight(with_a_glowing_box(after))
            .expect("only the light is another");
        assert_eq!(run.go(&mut Silent).ok(), Some(StopReason::Converged));
        let relit = run.finish();
        let deviation = Deviation::of(&relit, &anew);
        // The error of a draft of this scene.
        assert!(deviation.n_rms < 0.04, "{before} to {after}: {deviation:?}");
        let power = &relit.report.power;
        assert!(power.residual.abs() < 0.03 * power.emitted, "{power:?}");
        assert!(power.unshot.abs() < 0.02 * power.emitted, "{power:?}");
    }
}

#[test]
fn with_all_emitters_off_it_is_dark() {
    let mut scene = bundled("cornell-box");
    let mut run =
        Run::resume(solved(&scene, draft()), settings(draft(), ENGINE, 0)).expect("can be resumed");
    for material in &mut scene.materials {
        material.emitted_radiance = Spectrum::ZERO;
    }
    run.relight(scene).expect("only the light is another");
    assert_eq!(run.go(&mut Silent).ok(), Some(StopReason::NoEmitter));
    let light = run.finish().light;
    assert!(light.irradiance.iter().all(|e| *e == Spectrum::ZERO));
}

#[test]
fn another_scene_is_refused() {
    let scene = bundled("cornell-box");
    let solution = solved(&scene, draft());
    let refusal = |change: &dyn Fn(&mut Scene)| {
        let mut other = scene.clone();
        change(&mut other);
        let how = settings(draft(), ENGINE, 0);
        let mut run = Run::resume(solution.clone(), how).expect("can be resumed");
        let error = run.relight(other).expect_err("is another scene");
        assert!(matches!(error, SolveError::OtherScene(_)), "{error}");
        error.to_string()
    };
    let moved = refusal(&|scene| scene.vertices[0].x += 1.0);
    assert!(moved.contains("corners"), "{moved}");
    let less = refusal(&|scene| scene.surfaces.truncate(3));
    assert!(less.contains("3 surfaces"), "{less}");
    let brighter = refusal(&|scene| scene.materials[0].reflectance *= 0.5);
    assert!(brighter.contains("reflectance"), "{brighter}");
}

/// The floor has the light there.
#[test]
fn a_lamp_in_a_floor_cannot_be_lit_later() {
    let mut scene = bundled("cornell-box");
    let lamp = add_grey(&mut scene, 0.5, 0.0);
    add_level(
        &mut scene,
        lamp,
        [[450.0, 100.0], [500.0, 150.0]],
        0.0,
        true,
    );
    let solution = solved(&scene, draft());
    scene.materials[lamp as usize].emitted_radiance = Spectrum::ONE;
    let mut run = Run::resume(solution, settings(draft(), ENGINE, 0)).expect("can be resumed");
    let error = run.relight(scene).expect_err("no patch").to_string();
    assert!(error.contains("1 of them lie"), "{error}");
}

/// A solve of `scene`, left after so many batches of work.
fn left(scene: Scene, options: Options, batches: usize) -> Run {
    let mut run = Run::new(scene, settings(options, ENGINE, 0)).expect("can be solved");
    let reason = run.go(&mut Batches(batches)).expect("can be solved");
    assert_eq!(reason, StopReason::Interrupted);
    run
}

/// Whatever was left of a solve when its light was doubled, in the furnace all is twice as bright.
#[test]
fn what_is_on_its_way_to_the_vertices_sets_out_anew() {
    let once = furnace::cuboid();
    let mut twice = once.clone();
    for material in &mut twice.materials {
        material.emitted_radiance *= 2.0;
    }
    let options = Options {
        tolerance: 1e-5,
        ..clustered(draft())
    };
    for batches in [1, 2, 3, 5] {
        let mut run = left(once.clone(), options.clone(), batches);
        run.relight(twice.clone())
            .expect("only the light is another");
        assert_eq!(run.go(&mut Silent).ok(), Some(StopReason::Converged));
        let mut relit = run.finish();
        for irradiance in &mut relit.light.irradiance {
            *irradiance *= 0.5;
        }
        let error = furnace::error(&relit);
        assert!(error < 0.03, "after {batches} batches: off by {error}");
    }
}

/// A lamp so weak that what it gave may stay unshot: the light of the others, and of it, is known by then.
#[test]
fn a_weak_lamp_that_goes_out_is_out() {
    let room = |lamp: f32| {
        let mut scene = furnace::cuboid();
        let [walls, strong] = [0.0, 20.0].map(|exitance| add_grey(&mut scene, 0.5, exitance));
        for surface in &mut scene.surfaces {
            surface.material = walls;
        }
        let weak = add_grey(&mut scene, 0.0, lamp);
        add_level(&mut scene, strong, [[0.6, 0.4], [1.4, 1.1]], 0.95, false);
        add_level(&mut scene, weak, [[0.1, 0.1], [0.2, 0.2]], 0.15, false);
        scene
    };
    let beneath = |solution: &Solution| {
        let prober = Prober::new(solution);
        let found = prober.probe(DVec3::new(0.15, 0.0, 0.15), DVec3::Y);
        f64::from(found.expect("lies on the floor").irradiance.x)
    };
    let options = clustered(draft());
    let [lit, dark] = [10.0, 0.0].map(|lamp| beneath(&solved(&room(lamp), options.clone())));
    assert!(lit > 1.5 * dark, "{lit} and {dark}");

    // As its light has arrived, and that of the other lamp, and nothing was reflected.
    let first = Options {
        max_shots: Some(1),
        ..options.clone()
    };
    let direct = solved(&room(10.0), first);
    let mut run = Run::resume(direct, settings(options, ENGINE, 0)).expect("can be resumed");
    run.relight(room(0.0)).expect("only the light is another");
    assert_eq!(run.go(&mut Silent).ok(), Some(StopReason::Converged));
    let out = beneath(&run.finish());
    assert!((out / dark - 1.0).abs() < 0.05, "{out}, without {dark}");
}

/// What has left an open scene left with the light that is gone.
#[test]
fn after_the_dark_nothing_is_lost_yet() {
    let open = |exitance: f32| {
        let mut scene = furnace::cuboid();
        scene.surfaces.truncate(2);
        for (surface, exitance) in [exitance, 0.0].into_iter().enumerate() {
            scene.surfaces[surface].material = add_grey(&mut scene, 0.5, exitance);
        }
        scene
    };
    let options = Options {
        regather: false,
        ..draft()
    };
    let once = solved(&open(1.0), options.clone());
    let escaped = once.report.power.escaped;
    let mut run = Run::resume(once, settings(options, ENGINE, 0)).expect("can be resumed");
    for (exitance, ends) in [(0.0, StopReason::NoEmitter), (1.0, StopReason::Converged)] {
        run.relight(open(exitance))
            .expect("only the light is another");
        assert_eq!(run.go(&mut Silent).ok(), Some(ends));
        let power = &run.solution().report.power;
        let expected = escaped * f64::from(exitance);
        assert!(
            (power.escaped - expected).abs() <= 0.02 * escaped,
            "{power:?}"
        );
    }
}
