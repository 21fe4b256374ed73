//! A text file in memory and its logical lines, with their numbers kept for messages.

use super::SceneError;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// A UTF-8 text file, without its byte order mark.
pub(super) struct TextFile {
    pub path: PathBuf,
    pub text: String,
}

impl TextFile {
    /// Reads `path`; `expected` says what should have been there.
    pub fn read(path: &Path, expected: &str) -> Result<Self, SceneError> {
        let bytes = std::fs::read(path).map_err(|error| {
            SceneError::new(
                path,
                None,
                format!("an unreadable file ({error})"),
                expected,
            )
        })?;
        Self::from_bytes(path, bytes)
    }

    fn from_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, SceneError> {
        let mut text = String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            let bytes = error.as_bytes();
            let line = Lines::count(&bytes[..valid]) + 1;
            let found = format!("the byte 0x{:02X}", bytes[valid]);
            SceneError::new(path, line, found, "text in UTF-8")
        })?;
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        Ok(TextFile {
            path: path.to_path_buf(),
            text,
        })
    }

    /// The file's lines, each with its number.
    ///
    /// Lines end with LF, CRLF or CR. A line that ends with a backslash, spaces after it or not, continues on the next one and
    /// keeps the number of its first part; a comment ends with its line.
    pub fn lines(&self) -> Lines<'_> {
        Lines {
            rest: &self.text,
            number: 0,
        }
    }

    /// The number of the line in which the byte at `offset` lies.
    pub fn line_at(&self, offset: usize) -> usize {
        Lines::count(&self.text.as_bytes()[..offset.min(self.text.len())]) + 1
    }

    /// An error at a line of this file.
    pub fn error(
        &self,
        line: impl Into<Option<usize>>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> SceneError {
        SceneError::new(&self.path, line, found, expected)
    }
}

/// Iterator over the logical lines of a [`TextFile`].
pub(super) struct Lines<'a> {
    rest: &'a str,
    number: usize,
}

impl<'a> Lines<'a> {
    /// The number of line ends in `bytes`.
    fn count(bytes: &[u8]) -> usize {
        let feeds = bytes.iter().filter(|b| **b == b'\n').count();
        let lone_returns = bytes
            .windows(2)
            .filter(|w| w[0] == b'\r' && w[1] != b'\n')
            .count();
        feeds + lone_returns
    }

    fn physical_line(&mut self) -> Option<&'a str> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let bytes = self.rest.as_bytes();
        let end = bytes
            .iter()
            .position(|b| matches!(b, b'\n' | b'\r'))
            .unwrap_or(bytes.len());
        let after = end
            + if bytes[end..].starts_with(b"\r\n") {
                2
            } else {
                1
            };
        let line = &self.rest[..end];
        self.rest = self.rest.get(after..).unwrap_or("");
        Some(line)
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, Cow<'a, str>);

    fn next(&mut self) -> Option<Self::Item> {
        let first = self.physical_line()?;
        let number = self.number;
        let Some(begun) = continued(first) else {
            return Some((number, Cow::Borrowed(first)));
        };
        let mut joined = begun.to_owned();
        while let Some(next) = self.physical_line() {
            joined.push(' ');
            match continued(next) {
                Some(part) => joined.push_str(part),
                None => {
                    joined.push_str(next);
                    break;
                }
            }
        }
        Some((number, Cow::Owned(joined)))
    }
}

/// The line without the backslash by which it continues, if it does: that of a folder at the end of a comment is none.
fn continued(line: &str) -> Option<&str> {
    let begun = line.trim_end().strip_suffix('\\')?;
    let is_comment = |word: &str| word.starts_with('#');
    let commented = line.split_ascii_whitespace().any(is_comment);
    (!commented).then_some(begun)
}

/// Quotes what a file says for a message: on one line, at most 60 characters.
pub(super) fn quote(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if text.chars().nth(60).is_some() {
        short.push('…');
    }
    format!("`{}`", short.escape_debug())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<(usize, String)> {
        let file = TextFile::from_bytes(Path::new("t"), bytes.to_vec()).expect("is UTF-8");
        file.lines().map(|(n, l)| (n, l.into_owned())).collect()
    }

    #[test]
    fn every_kind_of_line_end_counts_once() {
        let want = vec![
            (1, "a".into()),
            (2, "b".into()),
            (3, String::new()),
            (4, "c".into()),
        ];
        assert_eq!(lines(b"a\nb\n\nc\n"), want);
        assert_eq!(lines(b"a\r\nb\r\n\r\nc"), want);
        assert_eq!(lines(b"a\rb\r\rc"), want);
    }

    #[test]
    fn a_backslash_joins_lines_under_the_first_number() {
        let want = vec![(1, "f 1  2 3".into()), (4, "v".into())];
        assert_eq!(lines(b"f 1 \\\r\n2\\\n3\nv\\"), want);
    }

    #[test]
    fn a_comment_ends_with_its_line_whatever_it_ends_with() {
        let text = b"# from C:\\models\\\nv 1 # in D:\\\nf 1 \\\n2 # or E:\\\nv";
        let want = vec![
            (1, "# from C:\\models\\".into()),
            (2, "v 1 # in D:\\".into()),
            (3, "f 1  2 # or E:\\".into()),
            (5, "v".into()),
        ];
        assert_eq!(lines(text), want);
    }

    #[test]
    fn spaces_after_a_backslash_do_not_matter() {
        assert_eq!(
            lines(b"f 1 2 \\ \t\n3\nv"),
            vec![(1, "f 1 2  3".into()), (3, "v".into())]
        );
    }

    #[test]
    fn a_byte_order_mark_is_not_text() {
        assert_eq!(lines(b"\xEF\xBB\xBFv 1"), vec![(1, "v 1".into())]);
    }

    #[test]
    fn a_wrong_byte_is_reported_with_its_line() {
        let error = TextFile::from_bytes(Path::new("x.obj"), b"a\r\nb\xE9".to_vec()).err();
        let message = error.expect("is not UTF-8").to_string();
        assert_eq!(
            message,
            "x.obj:2: found the byte 0xE9; expected text in UTF-8"
        );
    }
}
