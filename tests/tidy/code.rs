//! Rust without what is not code: comments and the contents of literals become blanks, so lines keep their numbers.

/// Blanks comments and the contents of string and character literals.
pub fn code_of(text: &str) -> String {
    let characters: Vec<char> = text.chars().collect();
    let mut code = String::with_capacity(text.len());
    let mut at = 0;
    while at < characters.len() {
        let rest = &characters[at..];
        let before = if at == 0 { ' ' } else { characters[at - 1] };
        let skip = not_code(rest, before);
        if skip == 0 {
            code.push(rest[0]);
            at += 1;
        } else {
            code.extend(
                rest[..skip]
                    .iter()
                    .map(|c| if *c == '\n' { '\n' } else { ' ' }),
            );
            at += skip;
        }
    }
    code
}

/// Length of the comment or literal that `rest` begins with, or 0.
fn not_code(rest: &[char], before: char) -> usize {
    match rest {
        ['/', '/', ..] => rest.iter().position(|c| *c == '\n').unwrap_or(rest.len()),
        ['/', '*', ..] => block_comment(rest),
        ['"', ..] => quoted(rest, '"'),
        ['\'', '\\', ..] | ['\'', _, '\'', ..] => quoted(rest, '\''),
        ['r', '"' | '#', ..] if before == 'b' || !is_word(before) => raw_string(rest),
        _ => 0,
    }
}

fn block_comment(rest: &[char]) -> usize {
    let (mut depth, mut at) = (0, 0);
    loop {
        match rest.get(at..at + 2) {
            Some(['/', '*']) => (depth, at) = (depth + 1, at + 2),
            Some(['*', '/']) => (depth, at) = (depth - 1, at + 2),
            Some(_) => at += 1,
            None => return rest.len(),
        }
        if depth == 0 {
            return at;
        }
    }
}

fn quoted(rest: &[char], quote: char) -> usize {
    let mut at = 1;
    while at < rest.len() && rest[at] != quote {
        at += if rest[at] == '\\' { 2 } else { 1 };
    }
    (at + 1).min(rest.len())
}

/// `r"…"` with any number of `#`; 0 for a raw identifier.
fn raw_string(rest: &[char]) -> usize {
    let hashes = rest[1..].iter().take_while(|c| **c == '#').count();
    if rest.get(1 + hashes) != Some(&'"') {
        return 0;
    }
    let closes = |at: &usize| {
        rest[*at] == '"'
            && rest[at + 1..]
                .iter()
                .take(hashes)
                .filter(|c| **c == '#')
                .count()
                == hashes
    };
    let end = (2 + hashes..rest.len()).find(closes);
    end.map_or(rest.len(), |at| at + 1 + hashes)
}

/// Blanks what is compiled for tests only: `#[cfg(test)]` and the item that follows.
pub fn without_tests(code: &str) -> String {
    let mut left = code.to_owned();
    while let Some(start) = left.find("#[cfg(test)]") {
        let length = item_length(&left[start..]);
        let blank: String = left[start..start + length]
            .chars()
            .map(|c| if c == '\n' { '\n' } else { ' ' })
            .collect();
        left.replace_range(start..start + length, &blank);
    }
    left
}

/// Bytes to the end of the first item: its closing brace, or a semicolon outside braces.
fn item_length(code: &str) -> usize {
    let mut depth = 0;
    for (at, c) in code.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 1 => return at + 1,
            '}' => depth -= 1,
            ';' if depth == 0 => return at + 1,
            _ => {}
        }
    }
    code.len()
}

/// Byte offsets of `word` where it stands alone.
pub fn word_places<'a>(code: &'a str, word: &'a str) -> impl Iterator<Item = usize> + 'a {
    code.match_indices(word)
        .map(|(at, _)| at)
        .filter(move |&at| {
            let before = code[..at].chars().next_back().unwrap_or(' ');
            let after = code[at + word.len()..].chars().next().unwrap_or(' ');
            !is_word(before) && !is_word(after)
        })
}

/// The identifier that `code` begins with.
pub fn identifier(code: &str) -> &str {
    let end = code.find(|c: char| !is_word(c)).unwrap_or(code.len());
    &code[..end]
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}
