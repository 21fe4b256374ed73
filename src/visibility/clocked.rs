//! An engine with a clock beside it.

use super::{EngineInfo, Fans, Hit, Ray, Visibility};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Answers as another engine does, and measures how long that takes.
pub struct Clocked<'a> {
    engine: &'a dyn Visibility,
    nanoseconds: AtomicU64,
}

impl<'a> Clocked<'a> {
    /// Nothing asked yet.
    pub fn new(engine: &'a dyn Visibility) -> Self {
        Self {
            engine,
            nanoseconds: AtomicU64::new(0),
        }
    }

    /// What all queries took, those of different threads added up.
    pub fn spent(&self) -> Duration {
        Duration::from_nanos(self.nanoseconds.load(Ordering::Relaxed))
    }

    fn clock(&self, ask: impl FnOnce()) {
        let started = Instant::now();
        ask();
        let spent = started.elapsed().as_nanos() as u64;
        self.nanoseconds.fetch_add(spent, Ordering::Relaxed);
    }
}

impl Visibility for Clocked<'_> {
    fn info(&self) -> EngineInfo {
        self.engine.info()
    }

    fn occluded(&self, fans: &Fans, masks: &mut Vec<u64>) {
        self.clock(|| self.engine.occluded(fans, masks));
    }

    fn nearest(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        self.clock(|| self.engine.nearest(rays, hits));
    }
}
