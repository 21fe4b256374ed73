//! Why a solve ends, and that what it leaves is a solution in every case.

use super::common::shapes::{add_grey, add_level, empty};
use super::{bundled, draft, file, solved};
use radiosity::scene::{Corners, Scene};
use radiosity::solution::Solution;
use radiosity::solver::{Changes, Control, Observer, Options, Progress, Silent, StopReason};
use radiosity::{Settings, Target, solve};
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::time::Duration;

/// Everything that a solution promises, whatever the reason for its end.
fn assert_whole(solution: &Solution) {
    assert_eq!(
        solution.light.irradiance.len(),
        solution.mesh.vertices.len()
    );
    assert!(
        solution
            .light
            .irradiance
            .iter()
            .all(|e| e.is_finite() && e.min_element() >= 0.0)
    );
    let again = Solution::decode(&file(solution)).unwrap_or_else(|found| panic!("{found}"));
    assert_eq!(again.light, solution.light);
    assert_eq!(again.report.stop_reason, solution.report.stop_reason);
}

#[test]
fn converged_when_little_is_unshot() {
    let solution = solved(&bundled("geometry"), draft());
    assert_whole(&solution);
    assert_eq!(solution.report.stop_reason, StopReason::Converged);
    let power = &solution.report.power;
    assert!(
        power.unshot > 0.0 && power.unshot <= 0.005 * power.emitted,
        "{power:?}"
    );
}

#[test]
fn after_the_largest_number_of_shots() {
    for most in [0, 1, 4] {
        let solution = solved(
            &bundled("cornell-box"),
            Options {
                max_shots: Some(most),
                ..draft()
            },
        );
        assert_whole(&solution);
        assert_eq!(
            (solution.report.stop_reason, solution.report.shots),
            (StopReason::MaxShots, most)
        );
    }
}

#[test]
fn when_time_is_up() {
    let solution = solved(
        &bundled("cornell-box"),
        Options {
            time_limit: Some(Duration::from_nanos(1)),
            ..draft()
        },
    );
    assert_whole(&solution);
    assert_eq!(
        (solution.report.stop_reason, solution.report.shots),
        (StopReason::TimeLimit, 0)
    );
}

#[test]
fn at_once_where_nothing_emits() {
    let mut scene = empty();
    let grey = add_grey(&mut scene, 0.5, 0.0);
    add_level(&mut scene, grey, [[0.0, 0.0], [1.0, 1.0]], 0.0, true);
    let solution = solved(&scene, draft());
    assert_whole(&solution);
    assert_eq!(
        (solution.report.stop_reason, solution.report.shots),
        (StopReason::NoEmitter, 0)
    );
    assert!(
        solution
            .light
            .irradiance
            .iter()
            .all(|e| *e == glam::Vec3::ZERO)
    );
}

#[test]
fn a_scene_of_nothing_is_solved() {
    let solution = solved(&empty(), draft());
    assert_whole(&solution);
    assert_eq!(solution.report.stop_reason, StopReason::NoEmitter);
}

/// Says stop from a certain call on, and remembers the last it heard.
struct StopAt {
    call: usize,
    calls: usize,
    last: Option<Progress>,
}

impl Observer for StopAt {
    fn progress(&mut self, progress: &Progress) -> Control {
        self.calls += 1;
        self.last = Some(*progress);
        if self.calls >= self.call {
            Control::Stop
        } else {
            Control::Continue
        }
    }
}

/// Between shots or in the middle of a refinement.
#[test]
fn when_the_observer_says_so() {
    for call in [1, 2, 3, 7, 20] {
        let mut observer = StopAt {
            call,
            calls: 0,
            last: None,
        };
        let settings = Settings {
            options: draft(),
            ..Settings::default()
        };
        let solution = solve(&bundled("cornell-box"), &settings, &mut observer)
            .unwrap_or_else(|error| panic!("{error}"));
        assert_whole(&solution);
        assert_eq!(solution.report.stop_reason, StopReason::Interrupted);
        assert!(
            observer.calls <= call + 1,
            "asked {} times after a stop at {call}",
            observer.calls
        );
        let last = observer.last.expect("was called");
        // A stop within a shot lets the shot be accounted for.
        assert!((last.shots..=last.shots + 1).contains(&solution.report.shots));
        assert_eq!(last.elements, solution.report.elements);
        let power = &solution.report.power;
        assert!((last.unshot.element_sum() - power.unshot).abs() <= 1e-6 * power.emitted);
    }
}

/// Shots only ever take unshot power away, and progress never goes back.
#[test]
fn progress_goes_forward() {
    struct Watch(Vec<Progress>);
    impl Observer for Watch {
        fn progress(&mut self, progress: &Progress) -> Control {
            self.0.push(*progress);
            Control::Continue
        }
    }
    let mut watch = Watch(Vec::new());
    let settings = Settings {
        options: draft(),
        ..Settings::default()
    };
    let solution = solve(&bundled("cornell-box"), &settings, &mut watch)
        .unwrap_or_else(|error| panic!("{error}"));
    for pair in watch.0.windows(2) {
        assert!(
            pair[0].shots <= pair[1].shots
                && pair[0].rays <= pair[1].rays
                && pair[0].elements <= pair[1].elements
        );
    }
    let last = watch.0.last().expect("was called");
    assert_eq!(
        (last.shots, last.rays),
        (solution.report.shots, solution.report.rays)
    );
}

/// A file on a disk with room for so many bytes.
struct Disk {
    file: Cursor<Vec<u8>>,
    room: usize,
}

impl Disk {
    fn with(room: usize) -> Self {
        let file = Cursor::default();
        Self { file, room }
    }
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let left = self.room - self.file.position() as usize;
        if left == 0 {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.file.write(&bytes[..bytes.len().min(left)])
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Disk {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

#[test]
fn a_disk_that_fills_up_is_the_reason_wherever_it_does() {
    let solution = solved(&bundled("emission"), draft());
    let length = file(&solution).len();
    for room in [0, 10, 24, 25, length / 2, length - 1] {
        let error = solution
            .write(&mut Disk::with(room))
            .expect_err("there is no room");
        assert_eq!(
            error.kind(),
            io::ErrorKind::StorageFull,
            "after {room} bytes: {error}"
        );
    }
    solution
        .write(&mut Disk::with(length))
        .expect("there is room for all of it");
}

/// A floor below a lamp.
fn lamp() -> Scene {
    let mut scene = empty();
    let floor = add_grey(&mut scene, 0.5, 0.0);
    let lamp = add_grey(&mut scene, 0.5, 10.0);
    let square = [[0.0, 0.0], [1.0, 1.0]];
    add_level(&mut scene, floor, square, 0.0, true);
    add_level(&mut scene, lamp, square, 1.0, false);
    scene
}

#[test]
fn a_scene_or_an_option_that_no_solve_could_end_with_is_refused() {
    let refused = |spoil: &dyn Fn(&mut Scene, &mut Settings), words: &str| {
        let mut scene = lamp();
        let mut settings = Settings {
            options: draft(),
            ..Settings::default()
        };
        spoil(&mut scene, &mut settings);
        let error = solve(&scene, &settings, &mut Silent).expect_err(words);
        assert!(error.to_string().contains(words), "{error}");
    };
    let triangle = Corners::Triangle([0, 1, 99]);
    refused(&|of, _| of.surfaces[0].corners = triangle, "vertex 99 of 8");
    refused(&|of, _| of.surfaces[1].material = 7, "material 7 of 2");
    for x in [f64::NAN, f64::INFINITY, 1e300] {
        refused(
            &|of, _| of.vertices[3].x = x,
            "a vertex (number 3) that is nowhere",
        );
    }
    refused(
        &|of, _| of.materials[0].reflectance.x = f32::NAN,
        "reflectance",
    );
    refused(&|of, _| of.materials[0].reflectance.x = 1.0, "reflectance");
    refused(
        &|of, _| of.materials[1].emitted_radiance.x = f32::NAN,
        "radiance",
    );
    refused(&|of, _| of.metres_per_unit = 0.0, "a unit of 0 m");
    refused(
        &|_, how| how.options.tolerance = f64::NAN,
        "tolerance is NaN",
    );
    refused(&|_, how| how.options.epsilon_d = -1.0, "epsilon_d is -1");
    refused(&|_, how| how.threads = 1_000_000, "1000000 threads");
    let target = |n_rms| {
        Some(Target {
            n_rms,
            fixed: Changes::default(),
        })
    };
    for n_rms in [f64::NAN, 0.0, -0.01] {
        refused(&|_, how| how.target = target(n_rms), "expected more than 0");
    }
}
