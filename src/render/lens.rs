//! The pinhole camera: from pixels to directions.

use crate::scene::Camera;
use glam::{DVec2, DVec3};

/// A camera with its axes. Distances on the screen are in pixels, and so is the focal length: a direction with
/// `focal` along `forward` ends on the screen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lens {
    pub(super) eye: DVec3,
    pub(super) forward: DVec3,
    pub(super) right: DVec3,
    pub(super) up: DVec3,
    pub(super) focal: f64,
    middle: DVec2,
}

impl Lens {
    pub(super) fn new(camera: &Camera) -> Self {
        let forward = (camera.look_at - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let middle = 0.5 * DVec2::new(f64::from(camera.width), f64::from(camera.height));
        Self {
            eye: camera.eye,
            forward,
            right,
            up: right.cross(forward),
            focal: middle.x / (0.5 * camera.horizontal_fov.to_radians()).tan(),
            middle,
        }
    }

    /// From the eye to a point on the screen; `(0, 0)` is its upper left corner.
    pub(super) fn direction(&self, at: DVec2) -> DVec3 {
        let from_middle = at - self.middle;
        self.focal * self.forward + from_middle.x * self.right - from_middle.y * self.up
    }

    /// Width and height of the screen.
    pub(super) fn size(&self) -> DVec2 {
        2.0 * self.middle
    }

    /// Where `point` is on the screen, and its depth: the distance from the plane through the eye and parallel to the
    /// screen. `None` behind it.
    pub(super) fn project(&self, point: DVec3) -> Option<(DVec2, f64)> {
        let direction = point - self.eye;
        let depth = direction.dot(self.forward);
        let at =
            DVec2::new(direction.dot(self.right), -direction.dot(self.up)) * (self.focal / depth);
        (depth > 0.0).then_some((self.middle + at, depth))
    }

    /// The piece of a straight line that is on the screen, or no more than `margin` pixels beside it.
    pub(super) fn clip(&self, a: DVec3, b: DVec3, margin: f64) -> Option<(DVec3, DVec3)> {
        let reach = self.middle + margin;
        let (mut start, mut end) = (0.0_f64, 1.0_f64);
        for (axis, reach) in [
            (self.right, reach.x),
            (-self.right, reach.x),
            (self.up, reach.y),
            (-self.up, reach.y),
        ] {
            // A plane through the eye and a border of the screen; positive on the screen's side.
            let inwards = reach * self.forward + self.focal * axis;
            let (at_a, at_b) = (inwards.dot(a - self.eye), inwards.dot(b - self.eye));
            if at_a < 0.0 && at_b < 0.0 {
                return None;
            }
            let crossing = at_a / (at_a - at_b);
            start = if at_a < 0.0 {
                start.max(crossing)
            } else {
                start
            };
            end = if at_b < 0.0 { end.min(crossing) } else { end };
        }
        (start < end).then(|| (a.lerp(b, start), a.lerp(b, end)))
    }

    /// The picture of the straight line through `a` and `b`: a vector whose product with a direction that ends on the
    /// screen is the distance there, in pixels. Right for lines that pass behind the eye, too: the plane through eye
    /// and line meets the screen in the line's picture. `None` if that is a point or infinitely far.
    pub(super) fn line(&self, a: DVec3, b: DVec3) -> Option<DVec3> {
        let normal = (a - self.eye).cross(b - self.eye);
        let line = normal / normal.dot(self.right).hypot(normal.dot(self.up));
        line.is_finite().then_some(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lens() -> Lens {
        Lens::new(&Camera {
            name: String::new(),
            eye: DVec3::new(1.0, 2.0, 3.0),
            look_at: DVec3::new(1.0, 2.0, -7.0),
            up: DVec3::new(0.0, 3.0, 1.0),
            horizontal_fov: 90.0,
            width: 200,
            height: 100,
            exposure: None,
        })
    }

    #[test]
    fn the_corners_of_the_screen_span_the_field_of_view() {
        let upper_left = lens().direction(DVec2::ZERO);
        assert!((upper_left - DVec3::new(-100.0, 50.0, -100.0)).length() < 1e-12);
        let lower_right = lens().direction(DVec2::new(200.0, 100.0));
        assert!((lower_right - DVec3::new(100.0, -50.0, -100.0)).length() < 1e-12);
    }

    #[test]
    fn distances_on_the_screen_are_in_pixels() {
        let lens = lens();
        let project = |at: DVec2, depth: f64| lens.eye + depth * lens.direction(at);
        let line = (
            project(DVec2::new(10.0, 0.0), 0.5),
            project(DVec2::new(10.0, 90.0), 2.0),
        );
        let behind = line.1 + 100.0 * (line.0 - line.1);
        for end in [line.0, behind] {
            let line = lens.line(end, line.1).expect("its picture is a line");
            let distance = line.dot(lens.direction(DVec2::new(13.0, 40.0))).abs();
            assert!((distance - 3.0).abs() < 1e-9, "{distance}");
        }
        assert_eq!(lens.line(lens.eye, line.0), None);
    }

    #[test]
    fn projecting_undoes_a_direction() {
        let at = DVec2::new(13.0, 40.0);
        let (projected, depth) = lens()
            .project(lens().eye + 0.25 * lens().direction(at))
            .expect("in front of the eye");
        assert!(projected.distance(at) < 1e-9);
        assert!((depth - 25.0).abs() < 1e-9);
        assert_eq!(lens().project(lens().eye - lens().direction(at)), None);
    }

    #[test]
    fn lines_are_clipped_to_the_screen_and_its_margin() {
        let lens = lens();
        let project =
            |x: f64, y: f64, depth: f64| lens.eye + depth * lens.direction(DVec2::new(x, y));
        let (a, b) = lens
            .clip(
                project(50.0, 50.0, 1.0),
                project(50.0, 50.0, -3.0) + 9.0 * lens.up,
                2.0,
            )
            .expect("seen");
        let (a, b) = (
            lens.project(a).expect("seen").0,
            lens.project(b).expect("seen").0,
        );
        assert!(a.distance(DVec2::new(50.0, 50.0)) < 1e-9);
        assert!(b.distance(DVec2::new(50.0, -2.0)) < 1e-9, "{b}");
        assert_eq!(
            lens.clip(project(-3.0, 0.0, 1.0), project(-9.0, 90.0, 5.0), 2.0),
            None
        );
        assert_eq!(
            lens.clip(project(50.0, 50.0, -1.0), project(60.0, 50.0, -1.0), 2.0),
            None
        );
    }
}
