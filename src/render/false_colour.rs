//! Values of a grid as a picture: false colours, with a legend.

use super::digits;
use super::picture::Picture;

/// The map `viridis` (Smith and van der Walt, CC0) at equal steps: as bright as the value is large, in print and to the
/// colour-blind too.
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

const PAPER: [u8; 3] = [255; 3];
const INK: [u8; 3] = [0; 3];
/// Where there is no value.
const NONE: [u8; 3] = [200; 3];
/// Pixels of the longer side of the grid, about.
const SIZE: usize = 512;
/// Steps between the numbers of the legend.
const STEPS: usize = 5;
/// Pixels between things.
const GAP: usize = 16;
/// Width of the legend's bar.
const BAR: usize = 24;
/// Room for the legend's numbers.
const ROOM: usize = 120;

/// Draws `values`, row after row of `columns`, the first row at the top, in colours from 0 (dark) to the round number at or above
/// the largest, with a bar that tells which colour is which value in `unit`.
pub fn false_colours(columns: usize, values: &[Option<f64>], unit: &str) -> Picture<[u8; 3]> {
    let (columns, rows) = (columns.max(1), values.len().div_ceil(columns.max(1)).max(1));
    let cell = (SIZE / columns.max(rows)).clamp(1, 64);
    let (width, height) = (columns * cell, (rows * cell).max(8 * digits::HEIGHT));
    let top = round_above(values.iter().flatten().copied().fold(0.0, f64::max));
    let mut canvas = Canvas::new(width + 3 * GAP + BAR + ROOM, height + 2 * GAP);
    for (number, value) in values.iter().enumerate() {
        let colour = value.map_or(NONE, |value| colour(value / top));
        let at = (GAP + number % columns * cell, GAP + number / columns * cell);
        canvas.fill(at, (cell, cell), colour);
    }
    canvas.legend(2 * GAP + width, height, top, unit);
    canvas.picture
}

/// The colour of a share from 0 to 1.
pub fn colour(share: f64) -> [u8; 3] {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (place as usize).min(VIRIDIS.len() - 2);
    let way = place - below as f64;
    std::array::from_fn(|c| {
        let [a, b] = [VIRIDIS[below][c], VIRIDIS[below + 1][c]].map(f64::from);
        (a + (b - a) * way).round() as u8
    })
}

/// The bar that tells which colour is which value in `unit`, from 0 to `top`, `height` pixels high or a little more.
pub fn legend(top: f64, unit: &str, height: u32) -> Picture<[u8; 3]> {
    let height = (height as usize)
        .saturating_sub(2 * GAP)
        .max(8 * digits::HEIGHT);
    let mut canvas = Canvas::new(GAP + BAR + ROOM, height + 2 * GAP);
    canvas.legend(GAP, height, top, unit);
    canvas.picture
}

/// The least round number that is not below the value: 1, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten.
pub fn round_above(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = 10f64.powf(value.log10().floor());
    let factors = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let factor = factors
        .into_iter()
        .find(|f| f * power >= value * (1.0 - 1e-12));
    factor.unwrap_or(10.0) * power
}

/// A picture that is drawn on.
struct Canvas {
    picture: Picture<[u8; 3]>,
}

impl Canvas {
    fn new(width: usize, height: usize) -> Self {
        Self {
            picture: Picture {
                width: width as u32,
                height: height as u32,
                pixels: vec![PAPER; width * height],
            },
        }
    }

    fn fill(&mut self, (left, top): (usize, usize), (width, height): (usize, usize), ink: [u8; 3]) {
        let all = self.picture.width as usize;
        for y in top..top + height {
            self.picture.pixels[y * all + left..y * all + left + width].fill(ink);
        }
    }

    fn legend(&mut self, left: usize, height: usize, top: f64, unit: &str) {
        for y in 0..height {
            let share = 1.0 - (y as f64 + 0.5) / height as f64;
            self.fill((left, GAP + y), (BAR, 1), colour(share));
        }
        for step in 0..=STEPS {
            let share = step as f64 / STEPS as f64;
            let y = GAP + ((1.0 - share) * (height - 1) as f64).round() as usize;
            self.fill((left + BAR, y), (4, 1), INK);
            let text = format!("{} {unit}", short(share * top));
            self.text(left + BAR + 8, y.saturating_sub(digits::HEIGHT / 2), &text);
        }
    }

    fn text(&mut self, left: usize, top: usize, text: &str) {
        for (place, character) in text.chars().enumerate() {
            for (x, y) in digits::dots(character) {
                let at = (left + place * digits::WIDTH + x, top + y);
                self.fill(at, (1, 1), INK);
            }
        }
    }
}

/// A number with no more digits than a legend needs.
fn short(value: f64) -> String {
    match value {
        0.0 => "0".into(),
        middle if (1e-3..1e6).contains(&middle) => {
            let decimals = (2 - middle.log10().floor() as i32).clamp(0, 6) as usize;
            without_zeros(&format!("{middle:.decimals$}")).to_owned()
        }
        other => {
            let text = format!("{other:.2e}");
            let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
            format!("{}e{power}", without_zeros(digits))
        }
    }
}

/// A number without zeros at the end of its decimals.
fn without_zeros(text: &str) -> &str {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_ends_at_a_round_number() {
        for (value, round) in [
            (0.0, 1.0),
            (1.0, 1.0),
            (104.2, 150.0),
            (0.31, 0.4),
            (999.0, 1000.0),
        ] {
            assert!((round_above(value) / round - 1.0).abs() < 1e-9, "{value}");
        }
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (500.0, "500"),
            (0.25, "0.25"),
            (1e7, "1e7"),
            (1.5e6, "1.5e6"),
            (0.6 * 8e9, "4.8e9"),
            (2.5e-4, "2.5e-4"),
            (1234.0, "1234"),
        ] {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn a_cell_has_the_colour_of_its_value_and_the_legend_both_ends() {
        let picture = false_colours(2, &[Some(0.0), Some(10.0), None, Some(5.0)], "lx");
        let at = |x: usize, y: usize| *picture.at((GAP + x) as u32, (GAP + y) as u32);
        assert_eq!(
            [at(0, 0), at(64, 0), at(0, 64)],
            [VIRIDIS[0], VIRIDIS[8], NONE]
        );
        assert_eq!(at(64, 64), VIRIDIS[4]);
        let legend = |y: usize| at(2 * 64 + GAP, y);
        assert_eq!(
            (legend(0), legend(127)),
            (colour(1.0 - 0.5 / 128.0), colour(0.5 / 128.0))
        );
        assert!(picture.pixels.contains(&INK));
    }
}
