//! Text and rows of tables as pages have them.

/// A row of headings; all but the first are of numbers.
pub(super) fn header(cells: &[&str]) -> String {
    let cell = |(place, text): (usize, &&str)| {
        let class = if place == 0 { "" } else { " class=\"n\"" };
        format!("<th{class}>{}</th>", escaped(text))
    };
    let cells: String = cells.iter().enumerate().map(cell).collect();
    format!("<tr>{cells}</tr>\n")
}

/// A row of which some cells are numbers.
pub(super) fn row(cells: &[&str], numbers: &[usize]) -> String {
    let cell = |(place, text): (usize, &&str)| {
        let class = if numbers.contains(&place) {
            " class=\"n\""
        } else {
            ""
        };
        format!("<td{class}>{}</td>", escaped(text))
    };
    let cells: String = cells.iter().enumerate().map(cell).collect();
    format!("<tr>{cells}</tr>\n")
}

/// Text as HTML and XML want it; what XML has not, control characters and two that are none, as spaces.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\u{FFFE}' | '\u{FFFF}' => escaped.push(' '),
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_xml_has_no_characters_for_becomes_spaces() {
        let text = "a\u{0}b\u{1B}c\u{FFFE}d\u{FFFF}e\u{FFFD}<\u{1F600}>";
        let page = format!("<p>{}</p>", escaped(text));
        let page = roxmltree::Document::parse(&page).expect("is well-formed");
        let shown = page.root_element().text();
        assert_eq!(shown, Some("a b c d e\u{FFFD}<\u{1F600}>"));
    }
}
