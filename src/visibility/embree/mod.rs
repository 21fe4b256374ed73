//! Intel Embree behind a safe face.
//!
//! `device` opens the library and translates its errors, `watch` hears what it calls back about, `scene` builds the acceleration structure as
//! a typestate (`Scene`, then `CommittedScene`), `packet` fills packets of rays and traces them. These
//! files and `sys/` hold the only unsafe code that talks to C. What Embree must not be handed (a NaN
//! aborts some builds of it, an index out of range is read) is refused or masked before.

mod device;
mod packet;
mod scene;
mod watch;

use super::{EngineInfo, Fans, Hit, Ray, Triangles, Visibility, VisibilityError};
use device::{Device, PacketWidth};
use scene::{CommittedScene, Scene};

/// A scene committed to Embree.
#[derive(Debug)]
pub struct Embree {
    scene: CommittedScene,
    width: PacketWidth,
}

impl Embree {
    /// Builds Embree's structure over `triangles` with at most `threads` threads (0: all there are) and, if `memory` is given, in
    /// no more than so many bytes. Blocks; to be called outside of rayon's pool, because the threads are Embree's own.
    pub fn new(
        triangles: &Triangles,
        threads: usize,
        memory: Option<u64>,
    ) -> Result<Self, VisibilityError> {
        triangles.validate()?;
        let device = Device::new(threads, memory)?;
        let width = device.packet_width();
        let mut scene = Scene::new(device)?;
        scene.add(triangles)?;
        Ok(Self {
            scene: scene.commit()?,
            width,
        })
    }

    /// Whether the library can be used on this machine.
    pub fn is_available(threads: usize) -> bool {
        Device::new(threads, None).is_ok()
    }
}

impl Visibility for Embree {
    fn info(&self) -> EngineInfo {
        EngineInfo {
            name: "embree",
            version: self.scene.device().version(),
            isa: self.width.isa().to_owned(),
            packet_width: self.width as u32,
            bytes: self.scene.device().used(),
        }
    }

    fn occluded(&self, fans: &Fans, masks: &mut Vec<u64>) {
        masks.clear();
        masks.resize(fans.len(), 0);
        match self.width {
            PacketWidth::Sixteen => packet::occluded::<16>(&self.scene, fans, masks),
            PacketWidth::Eight => packet::occluded::<8>(&self.scene, fans, masks),
            PacketWidth::Four => packet::occluded::<4>(&self.scene, fans, masks),
            PacketWidth::One => packet::occluded::<1>(&self.scene, fans, masks),
        }
    }

    fn nearest(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        hits.clear();
        hits.extend(rays.iter().map(|ray| packet::nearest(&self.scene, ray)));
    }
}

#[cfg(test)]
mod tests;
