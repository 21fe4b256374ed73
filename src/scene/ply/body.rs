//! The numbers of a PLY file, one after the other.

use super::header::{Format, Kind, Shape};
use crate::scene::text::quote;

/// What is left to read.
pub(super) struct Body<'a> {
    rest: &'a [u8],
    format: Format,
}

impl<'a> Body<'a> {
    pub fn new(bytes: &'a [u8], format: Format) -> Self {
        Self {
            rest: bytes,
            format,
        }
    }

    /// The next number.
    pub fn number(&mut self, kind: Kind) -> Result<f64, String> {
        if self.format == Format::Text {
            let word = self.word()?;
            return word.parse().map_err(|_| quote(word));
        }
        Ok(match kind {
            Kind::I8 => f64::from(i8::from_le_bytes(self.bytes()?)),
            Kind::U8 => f64::from(u8::from_le_bytes(self.bytes()?)),
            Kind::I16 => f64::from(i16::from_le_bytes(self.bytes()?)),
            Kind::U16 => f64::from(u16::from_le_bytes(self.bytes()?)),
            Kind::I32 => f64::from(i32::from_le_bytes(self.bytes()?)),
            Kind::U32 => f64::from(u32::from_le_bytes(self.bytes()?)),
            Kind::F32 => f64::from(f32::from_le_bytes(self.bytes()?)),
            Kind::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    /// The next number, which has to be a count or an index.
    pub fn whole(&mut self, kind: Kind) -> Result<usize, String> {
        let number = self.number(kind)?;
        let whole = number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number);
        match whole {
            true => Ok(number as usize),
            false => Err(format!("the index or count {number}")),
        }
    }

    /// Passes over a property.
    pub fn skip(&mut self, shape: Shape) -> Result<(), String> {
        match shape {
            Shape::Number(kind) => self.number(kind).map(drop),
            Shape::List(count, item) => {
                let count = self.whole(count)?;
                (0..count).try_for_each(|_| self.number(item).map(drop))
            }
        }
    }

    fn word(&mut self) -> Result<&'a str, String> {
        self.rest = self.rest.trim_ascii_start();
        let end = self.rest.iter().position(u8::is_ascii_whitespace);
        let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        match word.is_empty() {
            true => Err("the end of the file".into()),
            false => std::str::from_utf8(word).map_err(|_| "a byte that is no text".into()),
        }
    }

    /// The next bytes, turned to little-endian order.
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (first, rest) = self
            .rest
            .split_first_chunk::<N>()
            .ok_or("the end of the file")?;
        self.rest = rest;
        let mut bytes = *first;
        if self.format == Format::BigEndian {
            bytes.reverse();
        }
        Ok(bytes)
    }
}
