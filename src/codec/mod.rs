//! Encodings of bytes that others defined: base64, PNG, JPEG. In memory only; imports nothing of ours.

mod base64;
mod jpeg;
mod png;

pub use base64::{base64, from_base64};
pub use jpeg::decode_jpeg;
pub use png::{decode_png, encode_png};

/// The most pixels along a side of a picture that is decoded: a file of a hundred bytes may say that it is a million wide and high, and
/// memory is taken before it is seen that it is not.
const LARGEST: u32 = 16384;

/// A picture of 8-bit colours, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels in a row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// `width * height` of them: red, green, blue.
    pub colours: Vec<[u8; 3]>,
}

impl Pixels {
    /// From samples of which each `channels` make a pixel: grey, grey and alpha, colour, or colour and alpha.
    fn from_samples(width: u32, height: u32, channels: usize, samples: &[u8]) -> Option<Self> {
        let colour = |pixel: &[u8]| match *pixel {
            [grey] | [grey, _] => [grey; 3],
            [r, g, b] | [r, g, b, _] => [r, g, b],
            _ => [0; 3],
        };
        let colours: Vec<_> = samples.chunks_exact(channels.max(1)).map(colour).collect();
        let fits = colours.len() as u64 == u64::from(width) * u64::from(height);
        (fits && !colours.is_empty() && channels <= 4).then_some(Self {
            width,
            height,
            colours,
        })
    }
}
