//! PNG: pictures to look at.

use super::{WriteError, check_picture, write_atomically};
use ::png::{BitDepth, ColorType, Encoder, EncodingError, SrgbRenderingIntent};
use std::io::{self, Write};
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
        encode(out, width, height, pixels).map_err(into_io)
    })
}

fn encode(
    out: impl Write,
    width: u32,
    height: u32,
    pixels: &[[u8; 3]],
) -> Result<(), EncodingError> {
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.as_flattened())?;
    writer.finish()
}

fn into_io(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
