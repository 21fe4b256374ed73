//! The library handle: what it can do, and what went wrong.

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
}

// SAFETY: a device is reference-counted and thread-safe by Embree's documentation ("API functions of
// different objects, and of a device, can be called from several threads"); `&Device` only reads
// properties and the error slot, which belongs to the calling thread.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    /// Opens a device that builds with at most `threads` threads (0: all there are).
    pub fn new(threads: usize) -> Result<Self, VisibilityError> {
        let config = match threads {
            0 => String::new(),
            n => format!("threads={n}"),
        };
        let config = CString::new(config).expect("no NUL in a number");
        // SAFETY: the null device names the slot of this thread for errors without a device; the
        // string ends in NUL and is copied by the callee.
        let raw = unsafe {
            sys::rtcGetDeviceError(ptr::null_mut());
            sys::rtcNewDevice(config.as_ptr())
        };
        NonNull::new(raw).map(|raw| Self { raw }).ok_or_else(|| {
            // SAFETY: as above.
            let code = unsafe { sys::rtcGetDeviceError(ptr::null_mut()) };
            VisibilityError::Embree {
                step: "open a device",
                reason: reason(code),
            }
        })
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
        let value = calls();
        // SAFETY: as above.
        match unsafe { sys::rtcGetDeviceError(self.raw()) } {
            sys::RTCError::RTC_ERROR_NONE => Ok(value),
            code => Err(VisibilityError::Embree {
                step,
                reason: reason(code),
            }),
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
        // SAFETY: we own one reference, released once.
        unsafe { sys::rtcReleaseDevice(self.raw()) }
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
