//! What Embree calls back about: the memory that it takes, and what it has to say of its errors.

use crate::words::size;
use embree4_sys as sys;
use std::ffi::{CStr, c_char, c_void};
use std::ptr::NonNull;
use std::sync::Mutex;
use std::sync::atomic::{AtomicI64, Ordering};

/// Hears of a device's memory and errors; lives longer than the device, at one place.
#[derive(Debug)]
pub struct Watch {
    used: AtomicI64,
    /// Bytes that the device may hold.
    limit: i64,
    message: Mutex<Option<String>>,
}

impl Watch {
    /// A watch that refuses to let the device hold more than `limit` bytes.
    pub fn new(limit: Option<u64>) -> Self {
        let most = |limit: u64| i64::try_from(limit).unwrap_or(i64::MAX);
        Self {
            used: AtomicI64::new(0),
            limit: limit.map_or(i64::MAX, most),
            message: Mutex::default(),
        }
    }

    /// Bytes that the device holds.
    pub fn used(&self) -> u64 {
        self.used.load(Ordering::Relaxed).max(0) as u64
    }

    /// The message of the last error since this was asked, if there was one.
    pub fn take_message(&self) -> Option<String> {
        self.message.lock().ok()?.take()
    }

    /// Registers one with a device.
    ///
    /// # Safety
    /// `device` must be valid, and `watch` must point to a watch that lives, and to which nobody has other than shared access, until the device
    /// is gone.
    pub unsafe fn register(watch: NonNull<Self>, device: sys::RTCDevice) {
        let this = watch.as_ptr().cast::<c_void>();
        // SAFETY: by the caller's promise the pointer that both callbacks get is good as long as they can be called; they use
        // it for shared access only.
        unsafe {
            sys::rtcSetDeviceErrorFunction(device, Some(on_error), this);
            sys::rtcSetDeviceMemoryMonitorFunction(device, Some(on_memory), this);
        }
    }

    fn account(&self, bytes: i64) -> bool {
        let used = self.used.fetch_add(bytes, Ordering::Relaxed) + bytes;
        if bytes <= 0 || used <= self.limit {
            return true;
        }
        self.note(format!(
            "more than the {} that it may hold would be needed (--memory-limit)",
            size(self.limit.unsigned_abs(), self.limit.unsigned_abs())
        ));
        false
    }

    /// Keeps the first message: what follows is its consequence.
    fn note(&self, message: String) {
        if let Ok(mut known) = self.message.lock() {
            known.get_or_insert(message);
        }
    }
}

/// Embree asks before it takes memory (`post` is false, or true after the fact) and says what it gives back. What it asks for
/// after a refusal it gives back as well, so the count stays right.
extern "C" fn on_memory(watch: *mut c_void, bytes: isize, _post: bool) -> bool {
    // SAFETY: the pointer is the one that `register` got, to a living `Watch` that is shared.
    let watch = unsafe { &*watch.cast::<Watch>() };
    watch.account(bytes as i64)
}

extern "C" fn on_error(watch: *mut c_void, _code: sys::RTCError, text: *const c_char) {
    // SAFETY: as above.
    let watch = unsafe { &*watch.cast::<Watch>() };
    if !text.is_null() {
        // SAFETY: Embree passes a string that ends in NUL and lives during the call.
        let text = unsafe { CStr::from_ptr(text) };
        watch.note(text.to_string_lossy().into_owned());
    }
}
