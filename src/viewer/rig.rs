//! Where the eye is and where it looks: around something, or walking.

use crate::scene::Camera;
use glam::{DQuat, DVec2, DVec3};

/// The eye looks straight up or down to no more than this angle, radians: beyond it left and right would change places.
const NEAREST_TO_UP: f64 = 0.02;

/// An eye and the point in the middle of its picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rig {
    pub eye: DVec3,
    pub target: DVec3,
    up: DVec3,
}

impl Rig {
    /// Stands where a camera does.
    pub fn of(camera: &Camera) -> Self {
        Self {
            eye: camera.eye,
            target: camera.look_at,
            up: camera.up.normalize_or(DVec3::Y),
        }
    }

    /// Moves the eye around the target: to the left and up by these angles, radians, as seen from the target.
    pub fn orbit(&mut self, angles: DVec2) {
        self.eye = self.target + self.swing(self.eye - self.target, angles);
    }

    /// Turns the head to the left and up.
    pub fn turn(&mut self, angles: DVec2) {
        self.target = self.eye + self.swing(self.target - self.eye, angles);
    }

    /// Changes the distance from the target by a factor, down to `least`.
    pub fn zoom(&mut self, factor: f64, least: f64) {
        let arm = self.eye - self.target;
        let length = (arm.length() * factor).max(least);
        self.eye = self.target + arm.normalize() * length;
    }

    /// Walks: to the right, up, and forward on the level, in scene units.
    pub fn walk(&mut self, way: DVec3) {
        let sight = self.target - self.eye;
        let right = sight.cross(self.up).normalize();
        let forward = self.up.cross(right);
        let moved = right * way.x + self.up * way.y + forward * way.z;
        self.eye += moved;
        self.target += moved;
    }

    /// Which way is up in the picture.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Turns an arm around the upright axis, then towards it as far as that goes.
    fn swing(&self, arm: DVec3, angles: DVec2) -> DVec3 {
        let around = DQuat::from_axis_angle(self.up, angles.x) * arm;
        let from_up = around.angle_between(self.up);
        let limits = (NEAREST_TO_UP, std::f64::consts::PI - NEAREST_TO_UP);
        let wanted = (from_up - angles.y).clamp(limits.0, limits.1);
        let axis = around.cross(self.up).normalize();
        DQuat::from_axis_angle(axis, from_up - wanted) * around
    }
}
