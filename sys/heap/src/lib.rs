//! How the heap of the process gives memory back to the system.
//!
//! glibc takes large blocks from the system one by one and gives each back when it is freed, but raises what it calls large, up to
//! 32 MiB, to the largest that was freed so far. A program that has freed one large list keeps all later ones in its heaps, with the
//! holes that they leave.

/// Blocks of so many bytes or more are taken from the system one by one from now on, whatever has been freed. Each costs a call and
/// pages that are new. Returns whether the heap could be told: that of glibc can.
pub fn give_back_blocks_of(bytes: u32) -> bool {
    set(bytes)
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn set(bytes: u32) -> bool {
    let Ok(bytes) = bytes.try_into() else {
        return false;
    };
    // SAFETY: `mallopt` takes two numbers, holds the lock of the heap while it changes a parameter, and refuses what it does not know.
    unsafe { libc::mallopt(libc::M_MMAP_THRESHOLD, bytes) == 1 }
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn set(_: u32) -> bool {
    false
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_heap_can_be_told_where_it_is_glibcs() {
        let is_glibc = cfg!(all(target_os = "linux", target_env = "gnu"));
        assert_eq!(super::give_back_blocks_of(4 << 20), is_glibc);
        assert!(!super::give_back_blocks_of(u32::MAX));
    }
}
