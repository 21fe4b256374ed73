//! Rows of pixels.

/// A picture, of `[f32; 4]` (linear, with alpha) or `[u8; 3]` (sRGB).
#[derive(Debug, Clone, PartialEq)]
pub struct Picture<P> {
    /// Pixels in a row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Row by row from the top, `width * height` of them.
    pub pixels: Vec<P>,
}

impl<P> Picture<P> {
    /// The pixel in column `x` from the left and row `y` from the top.
    ///
    /// # Panics
    /// If there is no such pixel.
    pub fn at(&self, x: u32, y: u32) -> &P {
        assert!(
            x < self.width && y < self.height,
            "no pixel ({x}, {y}) in {} x {}",
            self.width,
            self.height
        );
        &self.pixels[y as usize * self.width as usize + x as usize]
    }
}
