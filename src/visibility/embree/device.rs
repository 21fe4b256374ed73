//! The library handle: what it can do, and what went wrong.

use super::watch::Watch;
use crate::visibility::VisibilityError;
use embree4_sys as sys;
use std::ffi::CString;
use std::ptr::{self, NonNull};

/// How many rays the library traces together natively. Other widths work, but Embree 4 takes such
/// packets apart into single rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PacketWidth {
    /// Single rays.
    One = 1,
    /// SSE, NEON.
    Four = 4,
    /// AVX, AVX2.
    Eight = 8,
    /// AVX-512.
    Sixteen = 16,
}

impl PacketWidth {
    /// The instruction set that goes with it. Embree does not tell which it uses, but builds its
    /// kernels so that one width belongs to one family.
    pub fn isa(self) -> &'static str {
        match self {
            Self::Sixteen => "AVX-512",
            Self::Eight => "AVX/AVX2",
            Self::Four if cfg!(target_arch = "aarch64") => "NEON",
            Self::Four => "SSE",
            Self::One => "single rays",
        }
    }
}

/// An Embree device: settings, thread pool, error slots (one for each thread).
#[derive(Debug)]
pub struct Device {
    raw: NonNull<sys::RTCDeviceTy>,
    /// From a box, freed when the device is gone. Embree has this pointer too, and a box that moves would claim that nobody else does.
    watch: NonNull<Watch>,
}

// SAFETY: a device is reference-counted and thread-safe by Embree's documentation ("API functions of
// different objects, and of a device, can be called from several threads"); `&Device` only reads
// properties and the error slot, which belongs to the calling thread.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    /// Opens a device that builds with at most `threads` threads (0: all there are) and holds at most `memory` bytes.
    pub fn new(threads: usize, memory: Option<u64>) -> Result<Self, VisibilityError> {
        match threads {
            0 => Self::open("", memory),
            n => Self::open(&format!("threads={n}"), memory),
        }
    }

    /// Opens a device with Embree's own configuration string.
    pub(super) fn open(config: &str, memory: Option<u64>) -> Result<Self, VisibilityError> {
        let step = "open a device";
        let config = CString::new(config).map_err(|_| VisibilityError::Embree {
            step,
            reason: "its configuration holds a NUL".into(),
        })?;
        // SAFETY: the null device names the slot of this thread for errors without a device; the
        // string ends in NUL and is copied by the callee.
        let raw = unsafe {
            sys::rtcGetDeviceError(ptr::null_mut());
            sys::rtcNewDevice(config.as_ptr())
        };
        let raw = NonNull::new(raw).ok_or_else(|| {
            // SAFETY: as above.
            let code = unsafe { sys::rtcGetDeviceError(ptr::null_mut()) };
            let reason = reason(code).into();
            VisibilityError::Embree { step, reason }
        })?;
        let watch = NonNull::from(Box::leak(Box::new(Watch::new(memory))));
        let device = Self { raw, watch };
        // SAFETY: the device is valid; the watch is freed by `drop` alone, after the device is released, and no one has it for himself until then.
        unsafe { Watch::register(watch, device.raw()) };
        Ok(device)
    }

    /// Bytes that it holds.
    pub fn used(&self) -> u64 {
        self.watch().used()
    }

    fn watch(&self) -> &Watch {
        // SAFETY: it lives as long as `self`, and nobody has other than shared access to it.
        unsafe { self.watch.as_ref() }
    }

    /// The handle, valid as long as `self`.
    pub fn raw(&self) -> sys::RTCDevice {
        self.raw.as_ptr()
    }

    /// Does one step of Embree calls: the error slot is emptied before and read after.
    pub fn step<T>(
        &self,
        step: &'static str,
        calls: impl FnOnce() -> T,
    ) -> Result<T, VisibilityError> {
        // SAFETY: the handle is valid; reading the slot empties it.
        unsafe { sys::rtcGetDeviceError(self.raw()) };
        self.watch().take_message();
        let value = calls();
        // SAFETY: as above.
        match unsafe { sys::rtcGetDeviceError(self.raw()) } {
            sys::RTCError::RTC_ERROR_NONE => Ok(value),
            code => {
                let message = self.watch().take_message();
                let reason = message.map_or_else(
                    || reason(code).to_owned(),
                    |message| format!("{} ({message})", reason(code)),
                );
                Err(VisibilityError::Embree { step, reason })
            }
        }
    }

    /// Version of the library that was loaded, e.g. `4.3.3`.
    pub fn version(&self) -> String {
        let [major, minor, patch] = [
            sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_VERSION_MAJOR,
            sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_VERSION_MINOR,
            sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_VERSION_PATCH,
        ]
        .map(|property| self.property(property));
        format!("{major}.{minor}.{patch}")
    }

    /// The widest native packets.
    pub fn packet_width(&self) -> PacketWidth {
        [
            (
                sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED,
                PacketWidth::Sixteen,
            ),
            (
                sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED,
                PacketWidth::Eight,
            ),
            (
                sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED,
                PacketWidth::Four,
            ),
        ]
        .into_iter()
        .find(|&(property, _)| self.property(property) != 0)
        .map_or(PacketWidth::One, |(_, width)| width)
    }

    fn property(&self, property: sys::RTCDeviceProperty) -> isize {
        // SAFETY: the handle is valid.
        unsafe { sys::rtcGetDeviceProperty(self.raw(), property) }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: we own the only reference that is left, as all that is made on the device holds or borrows it and is released before; it is
        // released once. Embree calls back no more after that, so the box that the watch came from is ours alone, and freed once.
        unsafe {
            sys::rtcReleaseDevice(self.raw());
            drop(Box::from_raw(self.watch.as_ptr()));
        }
    }
}

fn reason(code: sys::RTCError) -> &'static str {
    match code {
        sys::RTCError::RTC_ERROR_INVALID_ARGUMENT => "invalid argument",
        sys::RTCError::RTC_ERROR_INVALID_OPERATION => "invalid operation",
        sys::RTCError::RTC_ERROR_OUT_OF_MEMORY => "out of memory",
        sys::RTCError::RTC_ERROR_UNSUPPORTED_CPU => "this processor is not supported",
        sys::RTCError::RTC_ERROR_CANCELLED => "cancelled",
        _ => "unknown error",
    }
}
