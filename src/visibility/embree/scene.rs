//! Triangles into Embree: an open `Scene`, then a `CommittedScene` that can be traced.

use super::device::Device;
use crate::visibility::{Triangles, VisibilityError};
use embree4_sys as sys;
use std::ptr::NonNull;

/// A scene that still takes geometry.
#[derive(Debug)]
pub struct Scene(Handle);

/// A scene whose structure is built; nothing changes it any more.
#[derive(Debug)]
pub struct CommittedScene(Handle);

/// One reference to an Embree scene, and the device it belongs to.
#[derive(Debug)]
struct Handle {
    raw: NonNull<sys::RTCSceneTy>,
    device: Device,
}

// SAFETY: Embree traces one committed scene from any number of threads at a time, and scenes may be
// released from any thread; no method of `CommittedScene` changes the scene.
unsafe impl Send for CommittedScene {}
// SAFETY: as above.
unsafe impl Sync for CommittedScene {}

impl Scene {
    /// An empty scene on `device`.
    ///
    /// ROBUST always: without it the answer changes with the width of the packet, and rays slip
    /// through shared edges. MEDIUM quality: HIGH gains nothing here and is not deterministic. Never
    /// COMPACT: together with ROBUST it hangs in Embree 3.13.5.
    pub fn new(device: Device) -> Result<Self, VisibilityError> {
        let step = "create a scene";
        // SAFETY: the device is valid.
        let raw = device.step(step, || unsafe { sys::rtcNewScene(device.raw()) })?;
        let raw = NonNull::new(raw).ok_or(VisibilityError::Embree {
            step,
            reason: "it gave no handle".into(),
        })?;
        let handle = Handle { raw, device };
        // SAFETY: the scene is valid and not committed.
        handle.device.step("set up a scene", || unsafe {
            sys::rtcSetSceneFlags(handle.raw(), sys::RTCSceneFlags::RTC_SCENE_FLAG_ROBUST);
            sys::rtcSetSceneBuildQuality(
                handle.raw(),
                sys::RTCBuildQuality::RTC_BUILD_QUALITY_MEDIUM,
            );
        })?;
        Ok(Self(handle))
    }

    /// Adds `triangles`, which must be valid; primitive IDs are their indices. To be called once.
    pub fn add(&mut self, triangles: &Triangles) -> Result<(), VisibilityError> {
        if triangles.indices.is_empty() {
            return Ok(());
        }
        let geometry = Geometry::new(&self.0.device)?;
        geometry.copy(
            sys::RTCBufferType::RTC_BUFFER_TYPE_VERTEX,
            sys::RTCFormat::RTC_FORMAT_FLOAT3,
            triangles.vertices.iter().map(|v| v.to_array()),
        )?;
        geometry.copy(
            sys::RTCBufferType::RTC_BUFFER_TYPE_INDEX,
            sys::RTCFormat::RTC_FORMAT_UINT3,
            triangles.indices.iter().copied(),
        )?;
        // SAFETY: scene and geometry are valid; the scene takes its own reference.
        self.0.device.step("attach triangles", || unsafe {
            sys::rtcCommitGeometry(geometry.raw());
            sys::rtcAttachGeometry(self.0.raw(), geometry.raw());
        })
    }

    /// Builds the structure.
    pub fn commit(self) -> Result<CommittedScene, VisibilityError> {
        // SAFETY: the scene is valid and nobody else knows it.
        self.0.device.step("build its structure", || unsafe {
            sys::rtcCommitScene(self.0.raw());
        })?;
        Ok(CommittedScene(self.0))
    }
}

impl CommittedScene {
    /// The handle, to trace with; valid as long as `self`.
    pub fn raw(&self) -> sys::RTCScene {
        self.0.raw()
    }

    /// The device it lives on.
    pub fn device(&self) -> &Device {
        &self.0.device
    }
}

impl Handle {
    fn raw(&self) -> sys::RTCScene {
        self.raw.as_ptr()
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: we own one reference, released once; the device goes after it.
        unsafe { sys::rtcReleaseScene(self.raw()) }
    }
}

/// One reference to a geometry, released also when a step fails.
struct Geometry<'a> {
    raw: NonNull<sys::RTCGeometryTy>,
    device: &'a Device,
}

impl<'a> Geometry<'a> {
    fn new(device: &'a Device) -> Result<Self, VisibilityError> {
        let step = "create a geometry";
        let kind = sys::RTCGeometryType::RTC_GEOMETRY_TYPE_TRIANGLE;
        // SAFETY: the device is valid.
        let raw = device.step(step, || unsafe { sys::rtcNewGeometry(device.raw(), kind) })?;
        let raw = NonNull::new(raw).ok_or(VisibilityError::Embree {
            step,
            reason: "it gave no handle".into(),
        })?;
        Ok(Self { raw, device })
    }

    fn raw(&self) -> sys::RTCGeometry {
        self.raw.as_ptr()
    }

    /// Copies `items` of three 4-byte numbers into a new buffer of Embree's (which pads it).
    fn copy<T: Copy>(
        &self,
        kind: sys::RTCBufferType,
        format: sys::RTCFormat,
        items: impl ExactSizeIterator<Item = [T; 3]>,
    ) -> Result<(), VisibilityError> {
        const { assert!(size_of::<[T; 3]>() == 12) };
        let (step, stride, count) = ("allocate a buffer", size_of::<[T; 3]>(), items.len());
        // SAFETY: the geometry is valid; slot 0 exists for both kinds of buffer.
        let buffer = self.device.step(step, || unsafe {
            sys::rtcSetNewGeometryBuffer(self.raw(), kind, 0, format, stride, count)
        })?;
        let buffer = NonNull::new(buffer.cast::<[T; 3]>()).ok_or(VisibilityError::Embree {
            step,
            reason: "out of memory".into(),
        })?;
        for (i, item) in items.take(count).enumerate() {
            // SAFETY: the buffer has room for `count` items of this size, is aligned to 16 bytes,
            // and nobody else writes to it.
            unsafe { buffer.add(i).write(item) };
        }
        Ok(())
    }
}

impl Drop for Geometry<'_> {
    fn drop(&mut self) {
        // SAFETY: we own one reference, released once.
        unsafe { sys::rtcReleaseGeometry(self.raw()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_device_takes_and_gives_back_is_counted() {
        let device = Device::new(1, None).expect("Embree is installed");
        let before = device.used();
        let geometry = Geometry::new(&device).expect("can be made");
        let corners = std::iter::repeat_n([0f32; 3], 5_000);
        let (kind, format) = (
            sys::RTCBufferType::RTC_BUFFER_TYPE_VERTEX,
            sys::RTCFormat::RTC_FORMAT_FLOAT3,
        );
        geometry
            .copy(kind, format, corners)
            .expect("there is memory");
        assert!(device.used() >= before + 5_000 * 12);
        drop(geometry);
        assert!(device.used() < before + 5_000 * 12);
    }
}
