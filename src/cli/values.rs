//! The values of flags: numbers within bounds, names, errors, durations, sizes.

use serde::de::DeserializeOwned;
use std::ffi::OsStr;
use std::path::PathBuf;
use std::time::Duration;

/// A value by the name under which reports show it.
pub(super) fn named<T: DeserializeOwned>(name: &str) -> Result<T, String> {
    serde_json::from_value(name.into()).map_err(|e| e.to_string())
}

/// A fraction, or a percentage with its sign. A number of 1 or more without it is most often a forgotten one.
pub(super) fn error(text: &str) -> Result<f64, String> {
    let expected = "an error such as 1% or 0.01";
    let allowed = |x: f64| x > 0.0;
    if let Some(percent) = text.strip_suffix('%') {
        return number(percent.trim_end(), allowed, expected).map(|x| x / 100.0);
    }
    match number(text, allowed, expected)? {
        fraction if fraction < 1.0 => Ok(fraction),
        _ => Err(format!("expected {expected}; did you mean {text}%?")),
    }
}

/// Seconds, or a number with the unit s, m or h.
pub(super) fn duration(text: &str) -> Result<Duration, String> {
    let units = [("s", 1.0), ("m", 60.0), ("h", 3600.0)];
    let seconds = with_unit(text, &units, "a duration such as 90, 90s, 15m or 2h")?;
    Ok(Duration::from_secs_f64(seconds))
}

/// A duration after a flag that may stand alone: what follows it may have been meant for something else.
pub(super) fn interval(text: &str) -> Result<Duration, String> {
    duration(text).map_err(|expected| {
        format!("{expected}; if it is the scene or folder, name it before the flag, or write --checkpoint=60s")
    })
}

/// A number of threads. More than this are a slip of the hand, and starting them may fail halfway.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    count(text, 1024, "threads")
}

/// A number of points. More than this tell no more of an error, and may not fit into memory when all else is solved.
pub(super) fn points(text: &str) -> Result<usize, String> {
    count(text, 1_000_000, "points")
}

fn count(text: &str, most: usize, of: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| *count <= most);
    count.ok_or_else(|| format!("expected a number of {of} from 0 to {most}"))
}

/// A file that is to become a PNG.
pub(super) fn png(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_png = |end: &OsStr| end.eq_ignore_ascii_case("png");
    match path.extension() {
        Some(end) if !is_png(end) => Err("expected a name that ends in .png".into()),
        _ => Ok(path),
    }
}

/// Bytes, or a number with a unit.
pub(super) fn bytes(text: &str) -> Result<u64, String> {
    let units = [
        ("TiB", 1099511627776.0),
        ("TB", 1e12),
        ("KiB", 1024.0),
        ("MiB", 1048576.0),
        ("GiB", 1073741824.0),
        ("KB", 1e3),
        ("MB", 1e6),
        ("GB", 1e9),
    ];
    let bytes = with_unit(text, &units, "a size such as 500MB or 2GiB")?;
    Ok(bytes as u64)
}

fn with_unit(text: &str, units: &[(&str, f64)], expected: &str) -> Result<f64, String> {
    let split = |(unit, scale): &(&str, f64)| {
        let (number, end) = text.split_at_checked(text.len().checked_sub(unit.len())?)?;
        end.eq_ignore_ascii_case(unit).then_some((number, *scale))
    };
    let (digits, scale) = units.iter().find_map(split).unwrap_or((text, 1.0));
    number(digits.trim_end(), |x| x > 0.0 && x < 1e12, expected).map(|x| x * scale)
}

fn number(text: &str, allowed: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("expected {expected}"))?;
    if value.is_finite() && allowed(value) {
        Ok(value)
    } else {
        Err(format!("expected {expected}"))
    }
}

pub(super) fn finite(text: &str) -> Result<f64, String> {
    number(text, f64::is_finite, "a number")
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, |v| v > 0.0 && v < 1e9, "a positive number below 1e9")
}

/// A field of view.
pub(super) fn degrees(text: &str) -> Result<f64, String> {
    let expected = "an angle between 0 and 180 degrees";
    number(text, |v| v > 0.0 && v < 180.0, expected)
}

pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    number(text, |v| v >= 0.0, "a number, 0 or more")
}

/// A difference of visibility indices that is one.
pub(super) fn index(text: &str) -> Result<f64, String> {
    let expected = "a number above 0, up to 1";
    number(text, |v| v > 0.0 && v <= 1.0, expected)
}

/// Below which form factors are left out. None is above 1.
pub(super) fn cut_off(text: &str) -> Result<f64, String> {
    let expected = "a number from 0 to less than 1";
    number(text, |v| (0.0..1.0).contains(&v), expected)
}

pub(super) fn fraction(text: &str) -> Result<f64, String> {
    number(text, |v| (0.0..=1.0).contains(&v), "a number from 0 to 1")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_beyond_its_bound_is_told_the_bound() {
        assert_eq!(threads("1024"), Ok(1024));
        assert_eq!(points("1000000"), Ok(1_000_000));
        for wrong in ["1000001", "18446744073709551616", "-1", "1e3"] {
            let bound = "expected a number of points from 0 to 1000000";
            assert_eq!(points(wrong), Err(bound.into()), "{wrong}");
        }
    }

    #[test]
    fn an_error_of_one_or_more_needs_its_sign() {
        assert_eq!(error("1%"), Ok(0.01));
        assert_eq!(error("0.5"), Ok(0.5));
        assert_eq!(error("150 %"), Ok(1.5));
        let refused = error("1").expect_err("is 100 %");
        assert!(refused.ends_with("did you mean 1%?"), "{refused}");
        for wrong in ["0", "0%", "-1%", "%", "inf"] {
            assert!(error(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn durations_and_sizes_have_units() {
        let seconds = |text| duration(text).map(|d| d.as_secs_f64());
        assert_eq!(seconds("90"), Ok(90.0));
        assert_eq!(seconds("1.5m"), Ok(90.0));
        assert_eq!(seconds("2 h"), Ok(7200.0));
        assert_eq!(bytes("2GiB"), Ok(2 << 30));
        assert_eq!(bytes("500mb"), Ok(500_000_000));
        assert_eq!(bytes("1.5TB"), Ok(1_500_000_000_000));
        assert_eq!(bytes("1TiB"), Ok(1 << 40));
        assert_eq!(bytes("4096"), Ok(4096));
        for wrong in ["", "s", "-1s", "0", "1d", "inf", "1 e", "é"] {
            assert!(duration(wrong).is_err() && bytes(wrong).is_err(), "{wrong}");
        }
    }
}
