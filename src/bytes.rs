//! Amounts of memory in words. Imports nothing of ours.

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
        let plural = if bytes == 1 { "" } else { "s" };
        return format!("{bytes} byte{plural}");
    };
    match bytes.is_multiple_of(unit) {
        true => format!("{} {name}", bytes / unit),
        false => format!("{:.1} {name}", bytes as f64 / unit as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::size;

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
