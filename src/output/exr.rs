//! OpenEXR: radiance as it is, for measuring and for other programs.

use super::{WriteError, check_picture, write_atomically};
use ::exr::error::Error;
use ::exr::meta::attribute::{Chromaticities, Text};
use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, Vec2,
    WritableImage,
};
use std::io;
use std::path::Path;

/// Rec. 709 primaries and the D65 white point.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Writes `pixels` (rows from the top, linear Rec. 709 radiance in W m⁻² sr⁻¹ and the covered fraction of the pixel
/// as alpha, colour premultiplied) as 32-bit floats, losslessly compressed.
///
/// # Errors
/// When the number of pixels is 0 or not `width` x `height`, or the file cannot be written.
pub fn write_exr(
    path: &Path,
    width: u32,
    height: u32,
    pixels: &[[f32; 4]],
) -> Result<(), WriteError> {
    write_atomically(path, |out| {
        check_picture(width, height, pixels.len())?;
        let size = Vec2(width as usize, height as usize);
        let channel = |(name, i): (&str, usize)| {
            let samples = pixels.iter().map(|pixel| pixel[i]).collect();
            AnyChannel::new(name, FlatSamples::F32(samples))
        };
        // Flat samples rather than typed pixels: the crate's typed writer takes longer to compile than all else here.
        let list: SmallVec<_> = [("A", 3), ("B", 2), ("G", 1), ("R", 0)]
            .into_iter()
            .map(channel)
            .collect();
        let channels = AnyChannels::sort(list);
        let attributes = LayerAttributes {
            comments: Some(Text::from(
                "Radiance, W m^-2 sr^-1, linear Rec. 709, premultiplied alpha",
            )),
            software_name: Some(Text::from(concat!("radiosity ", env!("CARGO_PKG_VERSION")))),
            ..LayerAttributes::default()
        };
        let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
        let mut image = Image::from_layer(layer);
        image.attributes.chromaticities = Some(REC_709);
        image.write().to_buffered(out).map_err(into_io)
    })
}

fn into_io(error: Error) -> io::Error {
    match error {
        Error::Io(error) => error,
        other => io::Error::other(other),
    }
}
