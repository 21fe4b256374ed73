//! The signal that a process gets when its terminal ends, and whether who started the process wants it ignored.
//!
//! `nohup` starts a command with that signal ignored, so that the command outlives the terminal. Whoever installs handlers for all
//! signals that end a process would undo that.

/// Installs handlers of signals by `install`; but the end of the terminal stays ignored if it was before.
pub fn keep_hangup_ignored<T>(install: impl FnOnce() -> T) -> T {
    let was_ignored = is_ignored();
    let installed = install();
    if was_ignored {
        ignore();
    }
    installed
}

#[cfg(unix)]
fn is_ignored() -> bool {
    let mut known = std::mem::MaybeUninit::<libc::sigaction>::zeroed();
    // SAFETY: no new action is given, and the old one is written to memory that has room for it.
    let found = unsafe { libc::sigaction(libc::SIGHUP, std::ptr::null(), known.as_mut_ptr()) };
    // SAFETY: all zeros are an action too, so this is one whether it was written or not.
    found == 0 && unsafe { known.assume_init() }.sa_sigaction == libc::SIG_IGN
}

#[cfg(unix)]
fn ignore() {
    // SAFETY: ignoring a signal runs no code of ours.
    unsafe { libc::signal(libc::SIGHUP, libc::SIG_IGN) };
}

#[cfg(not(unix))]
fn is_ignored() -> bool {
    false
}

#[cfg(not(unix))]
fn ignore() {}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn what_was_ignored_stays_ignored_and_what_was_not_does_not() {
        // SAFETY: the default action is no code of ours, and nobody sends the signal here.
        let by_default = || unsafe { libc::signal(libc::SIGHUP, libc::SIG_DFL) };
        by_default();
        keep_hangup_ignored(|| ());
        assert!(!is_ignored());
        ignore();
        assert_eq!(
            keep_hangup_ignored(|| {
                by_default();
                7
            }),
            7
        );
        assert!(is_ignored());
        by_default();
    }
}
