//! Where in a scene file each key stands.
//!
//! In: the text of a file, sound or not. Out: for each key and list element its path
//! (`grains.species[0].radius`), its place and its value as written. Errors alone need it, so it is
//! made only when there is one. It does not judge the text: the RON reader has done that or will.

use std::ops::Range;

/// How deep brackets are followed. No scene nests so deep, and the RON reader refuses to.
const DEEPEST: usize = 64;
/// Bytes of a name that paths hold at most: a path is kept for each entry.
const LONGEST_NAME: usize = 200;

/// The keys of a file and their places.
pub(super) struct Outline<'a> {
    text: &'a str,
    entries: Vec<OutlineEntry>,
}

/// A key, or an element of a list, with its value.
pub(super) struct OutlineEntry {
    /// Names of the keys that lead here, joined by dots; elements of lists as `[0]`.
    pub path: String,
    /// Where the key begins [byte].
    pub start: usize,
    /// The value [bytes].
    pub value: Range<usize>,
}

impl<'a> Outline<'a> {
    pub fn new(text: &'a str) -> Self {
        let mut scan = Scan::new(text);
        scan.run();
        Self {
            text,
            entries: scan.entries,
        }
    }

    pub fn text(&self) -> &'a str {
        self.text
    }

    /// The last entry called `path`; where there is none, the one that says it in another unit
    /// (`radius_mm` for `radius`), or else the nearest entry that would hold it.
    pub fn find(&self, path: &str) -> Option<&OutlineEntry> {
        let named = |wanted: &dyn Fn(&str) -> bool| self.entries.iter().rfind(|e| wanted(&e.path));
        named(&|p| p == path)
            .or_else(|| {
                named(&|p| {
                    p.strip_prefix(path).is_some_and(|unit| {
                        matches!(unit, "_mm" | "_rpm" | "_deg" | "_mpas" | "_ml")
                    })
                })
            })
            .or_else(|| self.find(path.rsplit_once(['.', '['])?.0))
    }

    /// The innermost entry whose value goes on after the byte `at`.
    pub fn holding(&self, at: usize) -> Option<&OutlineEntry> {
        self.entries
            .iter()
            .rfind(|e| e.start <= at && at < e.value.end)
    }

    /// The innermost entry around the byte `at`, or that ends there.
    pub fn around(&self, at: usize) -> Option<&OutlineEntry> {
        self.entries
            .iter()
            .rfind(|e| e.start <= at && at <= e.value.end)
    }

    /// The value of `entry` as written, on one line and not too long.
    pub fn value(&self, entry: &OutlineEntry) -> String {
        let written = self.text.get(entry.value.clone()).unwrap_or_default();
        shorten(written, 60)
    }
}

/// `text` on one line, cut after `longest` characters.
pub(super) fn shorten(text: &str, longest: usize) -> String {
    let mut line = String::new();
    for word in text.split_whitespace() {
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
        if line.chars().count() > longest {
            let mut cut: String = line.chars().take(longest).collect();
            cut.push('…');
            return cut;
        }
    }
    line
}

/// The first word of `text` after white space, comments and attributes: in a file of RON the name of
/// what it states, if it gives one.
pub(crate) fn first_word(text: &str) -> Option<&str> {
    let mut scan = Scan::new(text);
    scan.skip_attributes();
    match scan.token()? {
        (Token::Word, range) => text.get(range),
        _ => None,
    }
}

/// Line, counted from 1, in which the byte `at` stands.
pub(super) fn line_of(text: &str, at: usize) -> usize {
    let before = &text.as_bytes()[..at.min(text.len())];
    before.split(|&byte| byte == b'\n').count()
}

/// Byte at `line` and `column`, both counted from 1 in characters.
pub(super) fn byte_at(text: &str, line: usize, column: usize) -> usize {
    let start: usize = text
        .split_inclusive('\n')
        .take(line.saturating_sub(1))
        .map(str::len)
        .sum();
    let rest = text.get(start..).unwrap_or_default();
    start
        + rest
            .char_indices()
            .nth(column.saturating_sub(1))
            .map_or(rest.len(), |(offset, _)| offset)
}

#[derive(Clone, Copy, PartialEq)]
enum Token {
    Open(u8),
    Close,
    Colon,
    Comma,
    Word,
    Text,
}

/// What is open at some depth of the scan.
struct OpenLevel {
    path: String,
    /// The entry whose value is being read.
    current: Option<usize>,
    /// Elements passed.
    element: usize,
    /// Whether it is the `(…)` after the name of a variant.
    variant: bool,
}

struct Scan<'a> {
    text: &'a str,
    at: usize,
    entries: Vec<OutlineEntry>,
    frames: Vec<OpenLevel>,
}

impl<'a> Scan<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            text,
            at: 0,
            entries: Vec::new(),
            frames: Vec::new(),
        }
    }

    fn run(&mut self) {
        self.skip_attributes();
        let mut previous = None;
        let mut end = 0;
        let mut next = self.token();
        while let Some((token, range)) = next
            && self.frames.len() < DEEPEST
        {
            next = self.token();
            let is_key = matches!(next, Some((Token::Colon, _)));
            match token {
                Token::Word | Token::Text if is_key => self.open_key(&range),
                Token::Word | Token::Text => self.open_element(range.start),
                Token::Open(bracket) => {
                    self.open_frame(bracket, range.start, previous == Some(Token::Word));
                }
                Token::Close => {
                    self.close_entry(end);
                    self.frames.pop();
                }
                Token::Comma => {
                    self.close_entry(end);
                    if let Some(frame) = self.frames.last_mut() {
                        frame.element += 1;
                    }
                }
                Token::Colon => self.begin_value(next.as_ref().map_or(range.end, |n| n.1.start)),
            }
            end = range.end;
            previous = Some(token);
        }
        while !self.frames.is_empty() {
            self.close_entry(self.text.len());
            self.frames.pop();
        }
    }

    fn open_key(&mut self, range: &Range<usize>) {
        let name = self.text[range.clone()].trim_matches('"');
        let Some(frame) = self.frames.last() else {
            return;
        };
        let name = &name[..name.floor_char_boundary(LONGEST_NAME)];
        let path = match frame.path.as_str() {
            "" => name.to_owned(),
            parent => format!("{parent}.{name}"),
        };
        self.open_entry(path, range.start);
    }

    fn open_element(&mut self, start: usize) {
        if let Some(frame) = self.frames.last()
            && frame.current.is_none()
            && !frame.path.is_empty()
        {
            self.open_entry(format!("{}[{}]", frame.path, frame.element), start);
        }
    }

    fn open_entry(&mut self, path: String, start: usize) {
        let index = self.entries.len();
        let value = start..self.text.len();
        self.entries.push(OutlineEntry { path, start, value });
        if let Some(frame) = self.frames.last_mut() {
            frame.current = Some(index);
        }
    }

    fn open_frame(&mut self, bracket: u8, start: usize, variant: bool) {
        // The list of `List([…])` is the value itself, not its first element.
        let transparent = bracket == b'['
            && self
                .frames
                .last()
                .is_some_and(|frame| frame.variant && frame.current.is_none());
        if !transparent {
            self.open_element(start);
        }
        let path = self.frames.last().map_or_else(String::new, |frame| {
            frame
                .current
                .map_or_else(|| frame.path.clone(), |i| self.entries[i].path.clone())
        });
        self.frames.push(OpenLevel {
            path,
            current: None,
            element: 0,
            variant: variant && bracket == b'(',
        });
    }

    fn begin_value(&mut self, start: usize) {
        if let Some(index) = self.frames.last().and_then(|frame| frame.current) {
            self.entries[index].value.start = start;
        }
    }

    fn close_entry(&mut self, end: usize) {
        if let Some(index) = self
            .frames
            .last_mut()
            .and_then(|frame| frame.current.take())
        {
            let value = &mut self.entries[index].value;
            value.end = end.max(value.start);
        }
    }

    /// Passes `#![enable(…)]`.
    fn skip_attributes(&mut self) {
        self.skip_blank();
        while self.text[self.at..].starts_with('#') {
            let rest = &self.text[self.at..];
            self.at += rest.find(']').map_or(rest.len(), |close| close + 1);
            self.skip_blank();
        }
    }

    /// Passes white space and comments.
    fn skip_blank(&mut self) {
        loop {
            let rest = &self.text[self.at..];
            let blank = rest.len() - rest.trim_start().len();
            let comment = if rest[blank..].starts_with("//") {
                rest[blank..].find('\n').unwrap_or(rest.len() - blank)
            } else if rest[blank..].starts_with("/*") {
                block_comment(&rest[blank..])
            } else {
                0
            };
            self.at += blank + comment;
            if comment == 0 {
                return;
            }
        }
    }

    fn token(&mut self) -> Option<(Token, Range<usize>)> {
        self.skip_blank();
        let start = self.at;
        let rest = &self.text[start..];
        let first = *rest.as_bytes().first()?;
        let (token, length) = match first {
            b'(' | b'[' | b'{' => (Token::Open(first), 1),
            b')' | b']' | b'}' => (Token::Close, 1),
            b':' => (Token::Colon, 1),
            b',' => (Token::Comma, 1),
            b'"' => (Token::Text, quoted(rest)),
            b'r' | b'b' if let Some(length) = raw_string(rest) => (Token::Text, length),
            _ => (Token::Word, word(rest)),
        };
        self.at = start + length;
        Some((token, start..self.at))
    }
}

/// Length of the nested comment with which `text` begins.
fn block_comment(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0, 0);
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return at;
        }
    }
    bytes.len()
}

/// Length of the string in quotes with which `text` begins.
fn quoted(text: &str) -> usize {
    let mut escaped = false;
    for (at, byte) in text.bytes().enumerate().skip(1) {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// Length of the raw string (`r#"…"#`) or byte string with which `text` begins, if it does.
fn raw_string(text: &str) -> Option<usize> {
    let body = text.trim_start_matches(['b', 'r']);
    let prefix = text.len() - body.len();
    if prefix > 2 {
        return None;
    }
    let hashes = body.len() - body.trim_start_matches('#').len();
    let inside = body[hashes..].strip_prefix('"')?;
    if !text[..prefix].contains('r') {
        return Some(prefix + quoted(body));
    }
    let end = format!("\"{}", "#".repeat(hashes));
    let opening = prefix + hashes + 1;
    Some(
        inside
            .find(&end)
            .map_or(text.len(), |at| opening + at + end.len()),
    )
}

/// Length of the name or number with which `text` begins: at least one character.
fn word(text: &str) -> usize {
    let first = text.chars().next().map_or(0, char::len_utf8);
    let rest = &text[first..];
    first
        + rest
            .find(|c: char| c.is_whitespace() || "()[]{}:,\"/".contains(c))
            .unwrap_or(rest.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"// a comment with (brackets: 1)
Scene(
    title: "a, \"quoted\" (title: 2)", /* nested /* comment */ x: 3 */
    materials: { "glass": (density: 2500) },
    container: Drum(radius_mm: 60.5),
    grains: Fill(species: [(radius: 3), (radius: 4)]),
    gravity: (0, -9.81, 0),
    list: List([(radius: 7)]),
)"#;

    fn value(path: &str) -> String {
        let outline = Outline::new(TEXT);
        let entry = outline.find(path).unwrap();
        outline.value(entry)
    }

    #[test]
    fn keys_are_found_by_their_path() {
        assert_eq!(value("title"), r#""a, \"quoted\" (title: 2)""#);
        assert_eq!(value("materials.glass.density"), "2500");
        assert_eq!(value("grains.species[1].radius"), "4");
        assert_eq!(value("gravity"), "(0, -9.81, 0)");
        assert_eq!(value("list[0].radius"), "7");
    }

    #[test]
    fn a_key_in_another_unit_and_the_holder_of_a_missing_key_stand_in() {
        assert_eq!(value("container.radius"), "60.5");
        assert_eq!(value("materials.glass.friction"), "(density: 2500)");
    }

    #[test]
    fn brackets_without_end_and_endless_names_take_no_memory() {
        let brackets = format!("(title: {}", "[".repeat(400_000));
        assert!(Outline::new(&brackets).entries.len() <= 2 * DEEPEST);
        let name = "n".repeat(1 << 20);
        let names = format!("({name}: ({}))", "a: 1, ".repeat(1000));
        let paths = Outline::new(&names).entries;
        assert_eq!(paths.len(), 1001);
        assert!(paths.iter().all(|entry| entry.path.len() < 1000));
    }

    #[test]
    fn places_lead_back_to_keys() {
        let outline = Outline::new(TEXT);
        let at = TEXT.find("60.5").unwrap();
        assert_eq!(outline.around(at).unwrap().path, "container.radius_mm");
        assert_eq!(line_of(TEXT, at), 5);
        assert_eq!(&TEXT[byte_at(TEXT, 5, 5)..][..9], "container");
    }
}
