//! What the window shows, and how it follows the hand.

use super::look::{Look, Quantity};
use super::rig::Rig;
use crate::scene::Camera;
use glam::{DVec2, DVec3};

/// Radians of orbit or turn for a drag across the whole width of the window.
const SWEEP: f64 = std::f64::consts::PI;
/// By how much a notch of the wheel changes the distance.
const NOTCH: f64 = 0.88;
/// A step, as a fraction of the extent of what is shown.
const STEP: f64 = 0.02;
/// The eye comes no closer to what it circles, as a fraction of the extent.
const CLOSEST: f64 = 1e-3;
/// The most pixels on a side: what 16-bit coordinates of displays can name.
const LARGEST: u32 = 16384;

/// What somebody at the window may want.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Circle the point in the middle: the mouse was dragged by so many pixels.
    Orbit(DVec2),
    /// Turn the head: the mouse was dragged by so many pixels.
    Turn(DVec2),
    /// Closer by so many notches of the wheel; farther if negative.
    Zoom(f64),
    /// So many steps to the right, up, and forward.
    Walk(DVec3),
    /// Brighter by so many stops; in false colours the scale ends at a smaller value.
    Expose(f64),
    /// The exposure that the program chooses.
    AutoExpose,
    /// The next of light, illuminance and radiosity.
    NextQuantity,
    /// Show the elements, or no longer.
    Elements,
    /// Stand where the next camera of the scene does.
    NextCamera,
    /// Back to where the camera stands.
    Home,
    /// The window has this many pixels now.
    Resize(u32, u32),
}

/// The state of a window, which needs no display.
#[derive(Debug, Clone)]
pub struct Viewer {
    cameras: Vec<Camera>,
    current: usize,
    rig: Rig,
    size: (u32, u32),
    extent: f64,
    quantity: Quantity,
    elements: bool,
    /// What was asked for; otherwise the camera's, or what suits the picture.
    exposure: Option<f64>,
    /// That of the last picture.
    seen_exposure: f64,
    /// By how many stops the scale of false colours is shortened.
    shorter: f64,
}

impl Viewer {
    /// Stands where the camera with the number `first` does; `extent` is the size of what is shown, in scene units.
    ///
    /// # Panics
    /// If there is no such camera.
    pub fn new(cameras: Vec<Camera>, first: usize, extent: f64) -> Self {
        let camera = &cameras[first];
        Self {
            rig: Rig::of(camera),
            size: (camera.width, camera.height),
            current: first,
            extent,
            quantity: Quantity::Light,
            elements: false,
            exposure: None,
            seen_exposure: 0.0,
            shorter: 0.0,
            cameras,
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Takes in what somebody wants; the next [`Viewer::look`] shows it.
    pub fn act(&mut self, action: Action) {
        let (width, _) = self.size;
        let angles = |drag: DVec2| DVec2::new(-drag.x, drag.y) * SWEEP / f64::from(width);
        match action {
            Action::Orbit(drag) => self.rig.orbit(angles(drag)),
            // What is under the hand stays there: the head turns the other way.
            Action::Turn(drag) => self.rig.turn(-angles(drag) * 0.5),
            Action::Zoom(notches) => {
                let least = CLOSEST * self.extent;
                self.rig.zoom(NOTCH.powf(notches.clamp(-50.0, 50.0)), least);
            }
            Action::Walk(steps) => self.rig.walk(steps * STEP * self.extent),
            Action::Expose(stops) if self.quantity == Quantity::Light => {
                let now = self.exposure.unwrap_or(self.seen_exposure);
                self.exposure = Some(now + stops);
            }
            Action::Expose(stops) => self.shorter += stops,
            Action::AutoExpose => (self.exposure, self.shorter) = (None, 0.0),
            Action::NextQuantity => self.quantity = self.quantity.next(),
            Action::Elements => self.elements ^= true,
            Action::NextCamera => {
                self.current = (self.current + 1) % self.cameras.len();
                self.act(Action::Home);
            }
            Action::Home => self.rig = Rig::of(&self.cameras[self.current]),
            Action::Resize(width, height) => {
                self.size = (width.clamp(1, LARGEST), height.clamp(1, LARGEST));
            }
        }
    }

    /// Takes note of the exposure of a picture that was drawn: brighter means brighter than that.
    pub fn seen(&mut self, exposure: f64) {
        self.seen_exposure = exposure;
    }

    /// What is to be drawn.
    pub fn look(&self) -> Look {
        let standing = &self.cameras[self.current];
        Look {
            camera: Camera {
                eye: self.rig.eye,
                look_at: self.rig.target,
                up: self.rig.up(),
                width: self.size.0,
                height: self.size.1,
                exposure: self.exposure.or(standing.exposure),
                ..standing.clone()
            },
            quantity: self.quantity,
            elements: self.elements,
            shorter: self.shorter,
        }
    }
}
