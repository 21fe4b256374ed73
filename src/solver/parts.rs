//! Where the time of a solve goes.

use serde::{Deserialize, Serialize};
use std::ops::AddAssign;
use std::time::Instant;

/// Seconds of wall-clock time, but for `rays`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Parts {
    /// Adding up what is unshot, choosing what shoots, and telling the observer.
    pub selecting: f64,
    /// Form factors and rays of shots or waves.
    pub shooting: f64,
    /// Testing and splitting elements, with the form factors and rays at new vertices.
    pub refining: f64,
    /// All light once more, at the vertices that there are.
    pub gathering: f64,
    /// The estimate of the error.
    pub estimating: f64,
    /// Rays of all kinds in all parts: seconds of processors, those of different threads added up.
    pub rays: f64,
}

impl AddAssign for Parts {
    fn add_assign(&mut self, other: Self) {
        self.selecting += other.selecting;
        self.shooting += other.shooting;
        self.refining += other.refining;
        self.gathering += other.gathering;
        self.estimating += other.estimating;
        self.rays += other.rays;
    }
}

/// A stop-watch that is read after each part.
#[derive(Debug, Clone, Copy)]
pub(super) struct Laps {
    last: Instant,
    pub parts: Parts,
}

impl Laps {
    pub fn new() -> Self {
        Self {
            last: Instant::now(),
            parts: Parts::default(),
        }
    }

    /// What has passed since the last time was this part.
    pub fn lap(&mut self, part: impl FnOnce(&mut Parts) -> &mut f64) {
        let now = Instant::now();
        *part(&mut self.parts) += (now - self.last).as_secs_f64();
        self.last = now;
    }
}
