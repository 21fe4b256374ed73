//! Numbers and units in dots, for legends.

/// From one character to the next.
pub(super) const WIDTH: usize = 7;
/// Of a character.
pub(super) const HEIGHT: usize = 9;

/// Rows of 5 dots, the highest bit to the left.
const GLYPHS: [(char, [u8; 9]); 18] = [
    ('0', [14, 17, 17, 17, 17, 17, 17, 17, 14]),
    ('1', [4, 12, 4, 4, 4, 4, 4, 4, 14]),
    ('2', [14, 17, 1, 1, 2, 4, 8, 16, 31]),
    ('3', [14, 17, 1, 1, 6, 1, 1, 17, 14]),
    ('4', [2, 6, 6, 10, 10, 18, 31, 2, 2]),
    ('5', [31, 16, 16, 30, 17, 1, 1, 17, 14]),
    ('6', [14, 17, 16, 16, 30, 17, 17, 17, 14]),
    ('7', [31, 1, 2, 2, 4, 4, 8, 8, 8]),
    ('8', [14, 17, 17, 17, 14, 17, 17, 17, 14]),
    ('9', [14, 17, 17, 17, 15, 1, 1, 17, 14]),
    ('.', [0, 0, 0, 0, 0, 0, 0, 12, 12]),
    ('-', [0, 0, 0, 0, 14, 0, 0, 0, 0]),
    ('e', [0, 0, 0, 14, 17, 31, 16, 17, 14]),
    // Without the flag and the foot of a 1, from which it could not be told otherwise.
    ('l', [8, 8, 8, 8, 8, 8, 8, 9, 6]),
    ('x', [0, 0, 0, 17, 10, 4, 4, 10, 17]),
    ('m', [0, 0, 0, 26, 21, 21, 21, 21, 21]),
    ('W', [17, 17, 17, 17, 21, 21, 21, 21, 10]),
    ('/', [1, 1, 2, 2, 4, 8, 8, 16, 16]),
];

/// The dots of a character, from its upper left corner; none of one that is not known.
pub(super) fn dots(character: char) -> impl Iterator<Item = (usize, usize)> {
    let rows = GLYPHS.iter().find(|(known, _)| *known == character);
    let rows = rows.map_or([0; HEIGHT], |(_, rows)| *rows);
    (0..HEIGHT)
        .flat_map(|y| (0..5).map(move |x| (x, y)))
        .filter(move |(x, y)| rows[*y] >> (4 - x) & 1 == 1)
}
