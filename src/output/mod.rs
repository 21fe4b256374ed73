//! Results as files, one writer a format, and the summary table as text.
//!
//! Every file appears whole or not at all ([`write_atomically`]), and every failure names the file and the reason
//! ([`WriteError`]). Imports `codec`, `radiometry`, `scene`, `matrix`, `solution` and `words`: pictures come in as plain rows of pixels.

mod atomic;
mod blocks;
mod exr;
mod glb;
mod html;
mod markup;
mod matrix;
mod obj;
mod picture;
mod plot;
mod ply;
mod table;
mod vtu;

pub use atomic::{WriteError, abandon_drafts, check_writable, remove_abandoned, write_atomically};
pub use exr::write_exr;
pub use glb::{GlbFacts, write_glb};
pub use html::{Estimated, History, Moment, Page, write_html};
pub use matrix::{
    Dropped, Feed, MatrixTable, Sink, write_matrix_csv, write_matrix_market, write_npz,
};
pub use obj::write_obj;
pub use picture::write_png;
pub use ply::write_ply;
pub use table::{SummaryRow, summary_table};
pub use vtu::{VtuFacts, write_vtu};

use std::io;

/// Checks that a picture has at least one pixel and as many as its size says.
fn check_picture(width: u32, height: u32, pixels: usize) -> io::Result<()> {
    if pixels == 0 || pixels as u64 != u64::from(width) * u64::from(height) {
        let reason = format!("a picture of {width} x {height} cannot have {pixels} pixels");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
    }
    Ok(())
}
