//! Solutions bit by bit, and solves that are left and taken up again.

use radiosity::solution::{Seconds, Solution};
use radiosity::solver::{Control, Observer, Progress};
use std::io::Cursor;

/// The bytes of the solution file.
pub fn file(solution: &Solution) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    solution
        .write(&mut bytes)
        .expect("memory can be written to");
    bytes.into_inner()
}

/// The same without what may differ from run to run: times.
pub fn bits(mut solution: Solution) -> Vec<u8> {
    solution.report.seconds = Seconds::default();
    file(&solution)
}

/// Lets some batches of work be done, then stops.
pub struct Batches(pub usize);

impl Observer for Batches {
    fn progress(&mut self, _: &Progress) -> Control {
        if self.0 == 0 {
            return Control::Stop;
        }
        self.0 -= 1;
        Control::Continue
    }
}
