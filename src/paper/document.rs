//! Tables between the markers of a document: `<!-- table: kasper2021/dry -->` … `<!-- end -->`.
//!
//! In: the text of a document, and the tables of a paper. Out: the text with each table of that
//! paper in its place; what stands outside markers, and tables of other papers, stay as they are.

use super::plan::PaperTable;

/// What a marker begins and ends with.
const BEGIN: &str = "<!-- table: ";
const CLOSE: &str = " -->";
/// The line behind a table.
const END: &str = "<!-- end -->";

/// What is wrong with the markers of a document.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum DocumentError {
    /// A table's end is missing.
    #[error("line {line}: the table {name} has no end: expected a line `<!-- end -->` behind it")]
    NoEnd {
        /// Line of its marker, from 1 on.
        line: usize,
        /// What it names.
        name: String,
    },
    /// No such table.
    #[error("line {line}: {paper} has no table {name}; expected one of {known}")]
    Unknown {
        /// Line of the marker, from 1 on.
        line: usize,
        /// The paper.
        paper: String,
        /// What the marker names.
        name: String,
        /// The tables that there are.
        known: String,
    },
    /// Nothing to replace.
    #[error("it has no marker of {0}, such as `<!-- table: {0}/runs -->`")]
    NoMarker(String),
}

/// A table that stands in a document.
#[derive(Debug, PartialEq, Eq)]
pub struct Marked<'a> {
    /// What its marker names: `kasper2021/dry`.
    pub name: &'a str,
    /// What stands between marker and end.
    pub text: &'a str,
    /// Line of its marker, from 1 on.
    line: usize,
    /// Where the text begins in the document.
    start: usize,
}

/// The tables that stand in the document `text`.
///
/// # Errors
/// When one has no end.
pub fn marked(text: &str) -> Result<Vec<Marked<'_>>, DocumentError> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some((name, start)) = next_marker(text, at) {
        let line = 1 + text[..start].matches('\n').count() - 1;
        let rest = &text[start..];
        let length = rest.find(END);
        let is_inside = |length: usize| !rest[..length].contains(BEGIN);
        let Some(length) = length.filter(|length| is_inside(*length)) else {
            return Err(DocumentError::NoEnd {
                line,
                name: name.to_owned(),
            });
        };
        found.push(Marked {
            name,
            text: &rest[..length],
            line,
            start,
        });
        at = start + length;
    }
    Ok(found)
}

/// The next marker in `text` from `at` on: what it names, and where the line behind it begins.
fn next_marker(text: &str, at: usize) -> Option<(&str, usize)> {
    let name = at + text[at..].find(BEGIN)? + BEGIN.len();
    let length = text[name..].find(CLOSE)?;
    let end = name + length + CLOSE.len();
    let start = text[end..]
        .find('\n')
        .map_or(text.len(), |line| end + line + 1);
    Some((&text[name..name + length], start))
}

/// The document `text` with the `tables` of `paper` between its markers.
///
/// # Errors
/// When a marker of the paper names no table, a table has no end, or there is no such marker.
pub fn replace(text: &str, paper: &str, tables: &[PaperTable]) -> Result<String, DocumentError> {
    let mut written = String::with_capacity(text.len());
    let mut kept_from = 0;
    let mut is_any = false;
    for place in marked(text)? {
        let Some(name) = (place.name.strip_prefix(paper)).and_then(|name| name.strip_prefix('/'))
        else {
            continue;
        };
        let Some(table) = tables.iter().find(|table| table.name == name) else {
            let known: Vec<&str> = tables.iter().map(|table| table.name).collect();
            return Err(DocumentError::Unknown {
                line: place.line,
                paper: paper.to_owned(),
                name: name.to_owned(),
                known: known.join(", "),
            });
        };
        written.push_str(&text[kept_from..place.start]);
        written.push('\n');
        written.push_str(&table.text);
        written.push('\n');
        kept_from = place.start + place.text.len();
        is_any = true;
    }
    written.push_str(&text[kept_from..]);
    if is_any {
        Ok(written)
    } else {
        Err(DocumentError::NoMarker(paper.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(name: &'static str, text: &str) -> PaperTable {
        PaperTable {
            name,
            title: "",
            text: text.to_owned(),
        }
    }

    const TEXT: &str = "# Title\n<!-- table: any/one -->\nold\n<!-- end -->\nours\n\
                        <!-- table: other/one -->\nkept\n<!-- end -->\n";

    #[test]
    fn tables_take_the_places_of_their_markers_and_all_else_stays() {
        let tables = [table("one", "| a |\n"), table("two", "| b |\n")];
        let written = replace(TEXT, "any", &tables).unwrap();
        assert_eq!(
            written,
            TEXT.replace("old\n", "\n| a |\n\n"),
            "with a blank line on either side, as Markdown wants it"
        );
        // It can be done again.
        assert_eq!(replace(&written, "any", &tables).unwrap(), written);
        let names: Vec<&str> = marked(TEXT).unwrap().iter().map(|own| own.name).collect();
        assert_eq!(names, ["any/one", "other/one"]);
    }

    #[test]
    fn wrong_markers_are_told_with_their_lines() {
        let refused = |text: &str, tables: &[PaperTable]| {
            replace(text, "any", tables).unwrap_err().to_string()
        };
        assert_eq!(
            refused(TEXT, &[table("two", ""), table("three", "")]),
            "line 2: any has no table one; expected one of two, three"
        );
        let open = TEXT.replacen("<!-- end -->\n", "", 1);
        let message = refused(&open, &[table("one", "")]);
        assert!(
            message.starts_with("line 2: the table any/one has no end"),
            "{message}"
        );
        assert!(refused("nothing", &[]).contains("no marker of any"));
    }
}
