//! Numbers out of buffers, with nothing taken on trust.

use super::file::File;
use ::gltf::Accessor;
use ::gltf::accessor::DataType;
use ::gltf::accessor::sparse::{IndexType, Sparse};
use ::gltf::buffer::View;

/// The most items of an accessor that has no data but zeros.
const MOST_ZEROS: usize = 1 << 26;

/// Vectors of `N` numbers; integers that are normalised become 0 to 1, or -1 to 1. The error says what was found.
pub(super) fn vectors<const N: usize>(
    file: &File,
    accessor: &Accessor,
) -> Result<Vec<[f64; N]>, String> {
    let components = accessor.dimensions().multiplicity();
    if components != N {
        return Err(described(accessor, "of a wrong kind"));
    }
    let (kind, normalised) = (accessor.data_type(), accessor.normalized());
    let size = kind.size();
    let vector = |item: &[u8]| {
        std::array::from_fn(|i| number(&item[i * size..(i + 1) * size], kind, normalised))
    };
    let bytes = packed(file, accessor)?;
    Ok(bytes.chunks_exact(N * size).map(vector).collect())
}

/// Whole numbers.
pub(super) fn indices(file: &File, accessor: &Accessor) -> Result<Vec<u32>, String> {
    let kind = accessor.data_type();
    let whole = matches!(kind, DataType::U8 | DataType::U16 | DataType::U32);
    if !whole || accessor.dimensions().multiplicity() != 1 {
        return Err(described(accessor, "of a wrong kind"));
    }
    let bytes = packed(file, accessor)?;
    Ok(bytes.chunks_exact(kind.size()).map(whole_number).collect())
}

fn described(accessor: &Accessor, what: &str) -> String {
    format!("accessor {} {what}", accessor.index())
}

/// A little-endian number without a sign, of up to four bytes.
fn whole_number(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |n, b| n << 8 | u32::from(*b))
}

fn number(bytes: &[u8], kind: DataType, normalised: bool) -> f64 {
    let bits = whole_number(bytes);
    let (value, largest) = match kind {
        DataType::I8 => (f64::from(bits as u8 as i8), f64::from(i8::MAX)),
        DataType::U8 => (f64::from(bits), f64::from(u8::MAX)),
        DataType::I16 => (f64::from(bits as u16 as i16), f64::from(i16::MAX)),
        DataType::U16 => (f64::from(bits), f64::from(u16::MAX)),
        DataType::U32 => (f64::from(bits), f64::from(u32::MAX)),
        DataType::F32 => return f64::from(f32::from_bits(bits)),
    };
    match normalised {
        true => (value / largest).max(-1.0),
        false => value,
    }
}

/// The items of an accessor one after the other, without what may lie between them in the buffer.
fn packed(file: &File, accessor: &Accessor) -> Result<Vec<u8>, String> {
    let (count, size) = (accessor.count(), accessor.size());
    let mut bytes = match accessor.view() {
        Some(view) => items(file, &view, accessor.offset(), count, size)
            .map_err(|found| described(accessor, &found))?,
        None if count <= MOST_ZEROS => vec![0; count * size],
        None => return Err(described(accessor, "of many items without data")),
    };
    if let Some(sparse) = accessor.sparse() {
        replace(file, &sparse, size, &mut bytes).map_err(|found| described(accessor, &found))?;
    }
    Ok(bytes)
}

fn items(
    file: &File,
    view: &View,
    offset: usize,
    count: usize,
    size: usize,
) -> Result<Vec<u8>, String> {
    let bytes = file.view(view)?;
    let stride = view.stride().unwrap_or(size).max(size);
    let beyond = || "beyond the end of its buffer view".to_owned();
    let last = count.checked_sub(1).and_then(|n| n.checked_mul(stride));
    let end = last.and_then(|last| last.checked_add(size)?.checked_add(offset));
    let bytes = end
        .and_then(|end| bytes.get(offset..end))
        .ok_or_else(beyond)?;
    Ok(bytes
        .chunks(stride)
        .flat_map(|item| &item[..size])
        .copied()
        .collect())
}

/// Puts the values of a sparse accessor in their places.
fn replace(file: &File, sparse: &Sparse, size: usize, bytes: &mut [u8]) -> Result<(), String> {
    let (places, values, count) = (sparse.indices(), sparse.values(), sparse.count());
    let width = match places.index_type() {
        IndexType::U8 => 1,
        IndexType::U16 => 2,
        IndexType::U32 => 4,
    };
    let found = items(file, &places.view(), places.offset(), count, width)?;
    let values = items(file, &values.view(), values.offset(), count, size)?;
    for (place, value) in found.chunks_exact(width).zip(values.chunks_exact(size)) {
        let begin = (whole_number(place) as usize).checked_mul(size);
        let item = begin.and_then(|begin| bytes.get_mut(begin..begin.checked_add(size)?));
        let item = item.ok_or("with a sparse index that is out of range")?;
        item.copy_from_slice(value);
    }
    Ok(())
}
