//! The threads that work is shared out to. Imports nothing of ours.

use rayon::{ThreadPool, ThreadPoolBuilder};
use thiserror::Error;

/// Threads that could not be started.
#[derive(Debug, Error)]
#[error("cannot start {threads} threads: {reason}")]
pub struct ThreadsError {
    /// How many were asked for.
    pub threads: usize,
    /// The system's reason.
    pub reason: String,
}

/// More threads than this are a mistake: the system would be busy with nothing else than starting them.
pub(crate) const MOST_THREADS: usize = 1024;

/// A pool of so many threads; 0 for as many as the machine has.
pub(crate) fn pool(threads: usize) -> Result<ThreadPool, ThreadsError> {
    if threads > MOST_THREADS {
        return Err(ThreadsError {
            threads,
            reason: format!("expected {MOST_THREADS} at most"),
        });
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|e| ThreadsError {
        threads,
        reason: e.to_string(),
    })
}
