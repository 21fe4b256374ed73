//! JPEG, as textures come.

use super::{LARGEST, Pixels};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Decodes a JPEG picture; the error says what is wrong with it.
pub fn decode_jpeg(bytes: &[u8]) -> Result<Pixels, String> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(LARGEST as usize)
        .set_max_height(LARGEST as usize);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    let samples = decoder.decode().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions().ok_or("it has no size")?;
    let sizes = u32::try_from(width).ok().zip(u32::try_from(height).ok());
    let (width, height) = sizes.ok_or("it is too large")?;
    Pixels::from_samples(width, height, 3, &samples)
        .ok_or_else(|| "its size does not fit its contents".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_memory_is_taken_for_a_picture_that_only_says_it_is_huge() {
        let start_of_frame = [
            0xFF, 0xC0, 0, 17, 8, 0xFF, 0xFF, 0xFF, 0xFF, 3, 1, 0x11, 0, 2, 0x11, 0, 3, 0x11, 0,
        ];
        let bytes = [&[0xFF, 0xD8], &start_of_frame[..], &[0xFF, 0xD9]].concat();
        let error = decode_jpeg(&bytes).expect_err("is too large");
        assert!(
            error.contains("65535") && error.contains("16384"),
            "{error}"
        );
    }
}
