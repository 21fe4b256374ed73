//! Where the power goes: emitted = absorbed + escaped + unshot + residual, and the residual is small.

use super::common::closed_form::between_opposite_squares;
use super::common::shapes::{add_cuboid, add_grey, add_level, empty};
use super::{bundled, draft, engines, solved, solved_by};
use glam::DVec3;
use radiosity::scene::{Scene, Sides};
use radiosity::solver::{Options, Preset};

/// A unit square that emits 1 W/m² and, 1 m above it, a black one that faces it.
fn two_squares() -> Scene {
    let mut scene = empty();
    let light = add_grey(&mut scene, 0.0, 1.0);
    let black = add_grey(&mut scene, 0.0, 0.0);
    add_level(&mut scene, light, [[0.0, 0.0], [1.0, 1.0]], 0.0, true);
    add_level(&mut scene, black, [[0.0, 0.0], [1.0, 1.0]], 1.0, false);
    scene
}

/// What arrives is the form factor between the squares, 0.1998; the rest is lost to the open.
#[test]
fn a_square_receives_its_form_factor_of_the_power_of_another() {
    let exact = between_opposite_squares();
    assert!((exact - 0.199_824_9).abs() < 1e-7, "{exact}");
    for engine in engines() {
        for (preset, bound) in [(Preset::Draft, 0.01), (Preset::Standard, 0.004)] {
            let report = solved_by(&two_squares(), preset.options(), engine, 0).report;
            let [emitted, absorbed, escaped] = [
                report.power.emitted,
                report.power.absorbed,
                report.power.escaped,
            ];
            assert!(
                (emitted - 3.0).abs() < 1e-6,
                "1 W in each of three channels: {emitted}"
            );
            assert!(
                (absorbed / emitted / exact - 1.0).abs() <= bound,
                "{preset:?} by {engine}: {absorbed}"
            );
            // Twice the standard error of 16384 independent rays.
            assert!(
                (escaped / emitted - (1.0 - exact)).abs() <= 0.006,
                "{preset:?} by {engine}: {escaped}"
            );
        }
    }
}

#[test]
fn the_ledger_closes_on_the_scenes() {
    // A draft's error of discretisation; integrated linearly it would be up to 0.9 %.
    for (name, bound) in [
        ("cornell-box", 0.003),
        ("shadow", 0.003),
        ("secondary", 0.003),
        ("geometry", 0.002),
        ("huge", 0.002),
        ("emission", 0.004),
    ] {
        let report = solved(&bundled(name), draft()).report;
        let power = &report.power;
        let sum = power.absorbed + power.escaped + power.unshot + power.residual;
        assert!((sum / power.emitted - 1.0).abs() < 1e-9, "{name}");
        assert!(
            power.residual.abs() <= bound * power.emitted,
            "{name}: {power:?}"
        );
        assert!(
            power.unshot <= report.options.tolerance * power.emitted,
            "{name}: {power:?}"
        );
        for channel in 0..3 {
            let rgb = &report.power_rgb;
            assert!(
                rgb.residual[channel].abs() <= bound * rgb.emitted[channel],
                "{name}: {rgb:?}"
            );
        }
    }
}

/// The rays that measure what escapes find no way out between walls that meet.
#[test]
fn nothing_escapes_from_a_closed_room() {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 1.0);
    add_cuboid(&mut scene, grey, [DVec3::ZERO, DVec3::ONE], true);
    let options = Options {
        tolerance: 1e-4,
        ..draft()
    };
    for engine in engines() {
        let power = solved_by(&scene, options.clone(), engine, 0).report.power;
        assert_eq!(power.escaped, 0.0, "a ray found its way out, by {engine}");
        assert!(power.residual.abs() <= 0.005 * power.emitted, "{power:?}");
    }
}

/// A ray that ends on both of two sheets is named any of them, also the one that looks away.
#[test]
fn nothing_is_lost_on_sheets_that_lie_back_to_back() {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 1.0);
    let sheet = add_grey(&mut scene, 0.5, 0.0);
    add_cuboid(&mut scene, grey, [DVec3::ZERO, DVec3::ONE], true);
    for upwards in [true, false] {
        add_level(&mut scene, sheet, [[0.2, 0.2], [0.8, 0.8]], 0.5, upwards);
    }
    for engine in engines() {
        for cluster_from in [usize::MAX, 0] {
            let options = Options {
                cluster_from,
                ..draft()
            };
            let power = solved_by(&scene, options, engine, 0).report.power;
            assert_eq!(power.escaped, 0.0, "by {engine}");
            assert!(power.residual.abs() <= 0.02 * power.emitted, "{power:?}");
        }
    }
}

/// A two-sided column stands from floor to ceiling: inside, its ends are where floor and ceiling are, and see what these see.
#[test]
fn light_is_reflected_once_where_surfaces_lie_in_one_another() {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.7, 0.0);
    let lamp = add_grey(&mut scene, 0.5, 1.0);
    add_cuboid(
        &mut scene,
        grey,
        [DVec3::ZERO, DVec3::new(4.0, 3.0, 4.0)],
        true,
    );
    let column = scene.surfaces.len();
    let ends = [DVec3::new(2.0, 0.0, 0.5), DVec3::new(3.0, 3.0, 1.5)];
    add_cuboid(&mut scene, grey, ends, false);
    for surface in &mut scene.surfaces[column..] {
        surface.sides = Sides::Both;
    }
    // Half of it shines into the column.
    add_level(&mut scene, lamp, [[1.5, 0.7], [2.5, 1.3]], 2.9, false);
    for cluster_from in [usize::MAX, 0] {
        let options = Options {
            cluster_from,
            ..draft()
        };
        let report = solved(&scene, options).report;
        let power = &report.power;
        assert!(power.residual.abs() <= 0.02 * power.emitted, "{power:?}");
        let warning = "2 sides in the plane of another that faces the same way left out";
        assert!(
            report.warnings.iter().any(|w| w.contains(warning)),
            "{:?}",
            report.warnings
        );
    }
}
