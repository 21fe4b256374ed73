//! Amounts in words: counts, and sizes of memory. Imports nothing of ours.

/// So many of them, in the singular where it is one.
pub(crate) fn counted(count: impl TryInto<u64>, one: &str, more: &str) -> String {
    let count = count.try_into().unwrap_or(u64::MAX);
    format!("{count} {}", if count == 1 { one } else { more })
}

/// A number with so many decimals, and no zero that is negative.
pub(crate) fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.bytes().all(|b| b"-0.".contains(&b));
    text[usize::from(is_zero && text.starts_with('-'))..].to_owned()
}

/// `bytes` in the units that somebody chose for `like`: powers of 1024 if that is a whole number of them, else of 1000.
pub(crate) fn size(bytes: u64, like: u64) -> String {
    let whole = |unit: u64| like > 0 && like.is_multiple_of(unit);
    let is_binary = whole(1 << 20) || (like < 1_000_000 && whole(1 << 10));
    let units = match is_binary {
        true => [
            (1u64 << 40, "TiB"),
            (1 << 30, "GiB"),
            (1 << 20, "MiB"),
            (1 << 10, "KiB"),
        ],
        false => [
            (1_000_000_000_000, "TB"),
            (1_000_000_000, "GB"),
            (1_000_000, "MB"),
            (1000, "KB"),
        ],
    };
    let Some((unit, name)) = units.into_iter().find(|(unit, _)| bytes >= *unit) else {
        return counted(bytes, "byte", "bytes");
    };
    match bytes.is_multiple_of(unit) {
        true => format!("{} {name}", bytes / unit),
        false => format!("{:.1} {name}", bytes as f64 / unit as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::{rounded, size};

    #[test]
    fn no_zero_is_negative() {
        assert_eq!(rounded(-1e-9, 6), "0.000000");
        assert_eq!(rounded(-0.0, 2), "0.00");
        assert_eq!(rounded(-0.25, 2), "-0.25");
        assert_eq!(rounded(1.5, 1), "1.5");
    }

    #[test]
    fn sizes_are_told_in_the_units_of_the_limit() {
        assert_eq!(size(1_560_000_000, 100_000_000), "1.6 GB");
        assert_eq!(size(100_000_000, 100_000_000), "100 MB");
        assert_eq!(size(4_000_000_000, 4_000_000_000), "4 GB");
        assert_eq!(size(3 << 20, 1 << 20), "3 MiB");
        assert_eq!(size(1 << 40, 1 << 40), "1 TiB");
        assert_eq!(size(600 << 10, 512 << 10), "600 KiB");
        assert_eq!(size(1, 1000), "1 byte");
        assert_eq!(size(999, 4096), "999 bytes");
    }
}
