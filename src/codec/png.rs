//! PNG: pictures to look at, and textures.

use super::{LARGEST, Pixels};
use ::png::{
    BitDepth, ColorType, Decoder, Encoder, EncodingError, SrgbRenderingIntent, Transformations,
};
use std::io::{self, Cursor, Write};

/// Encodes `pixels` (rows from the top, 8-bit sRGB), marked as sRGB so that every viewer shows the same.
///
/// # Errors
/// When `out` cannot be written to, or the number of pixels is 0 or not `width` x `height`.
pub fn encode_png(out: impl Write, width: u32, height: u32, pixels: &[[u8; 3]]) -> io::Result<()> {
    encode(out, width, height, pixels).map_err(|error| match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
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

/// Decodes a PNG picture of any kind to 8 bits a channel; the error says what is wrong with it.
pub fn decode_png(bytes: &[u8]) -> Result<Pixels, String> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let (width, height) = reader.info().size();
    if width.max(height) > LARGEST {
        return Err(format!(
            "it has {width} x {height} pixels, more than {LARGEST} along a side"
        ));
    }
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut samples = vec![0; size];
    let frame = reader
        .next_frame(&mut samples)
        .map_err(|error| error.to_string())?;
    let channels = frame.color_type.samples();
    Pixels::from_samples(
        frame.width,
        frame.height,
        channels,
        &samples[..frame.buffer_size()],
    )
    .ok_or_else(|| "its size does not fit its contents".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_memory_is_taken_for_a_picture_that_only_says_it_is_huge() {
        for (width, height) in [(1 << 20, 1 << 20), (LARGEST + 1, 1), (1, i32::MAX as u32)] {
            let mut bytes = Vec::new();
            let mut encoder = Encoder::new(&mut bytes, width, height);
            encoder.set_color(ColorType::Rgb);
            let mut writer = encoder.write_header().expect("memory can be written to");
            let data = writer.write_chunk(::png::chunk::IDAT, b"nothing");
            data.expect("memory can be written to");
            drop(writer);
            let error = decode_png(&bytes).expect_err("is too large");
            assert!(error.contains("more than 16384 along a side"), "{error}");
        }
    }
}
