//! PNG: pictures to look at.

use super::{WriteError, check_picture, write_atomically};
use crate::codec::encode_png;
use std::path::Path;

/// Writes `pixels` (rows from the top, 8-bit sRGB), marked as sRGB so that every viewer shows the same.
///
/// # Errors
/// When the number of pixels is 0 or not `width` x `height`, or the file cannot be written.
pub fn write_png(
    path: &Path,
    width: u32,
    height: u32,
    pixels: &[[u8; 3]],
) -> Result<(), WriteError> {
    write_atomically(path, |out| {
        check_picture(width, height, pixels.len())?;
        encode_png(out, width, height, pixels)
    })
}
