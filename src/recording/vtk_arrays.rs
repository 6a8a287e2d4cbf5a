//! Arrays out of VTK's XML files, as `output` writes them: little endian, not compressed, in base64,
//! as text, or as bytes behind the elements.
//!
//! In: the bytes of a file. Out: the arrays that are wanted, by element and name, as numbers. No
//! array is larger than the file that it is in.

use super::RecordingError;
use super::own_files::OwnFile;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use glam::DVec3;
use roxmltree::{Document, Node, ParsingOptions};
use std::path::PathBuf;

/// Largest file of a state that is read [bytes]: one of a million grains has a fifth of it.
pub const LARGEST_FILE: u64 = 1 << 30;
/// What stands before bytes behind the elements.
const APPENDED: &[u8] = b"<AppendedData";
/// Most elements and texts of a file with a few arrays.
const MOST_NODES: u32 = 4096;

/// The arrays of a data set of one piece.
pub struct VtkArrays {
    path: PathBuf,
    counts: Vec<(String, usize)>,
    arrays: Vec<VtkArray>,
}

/// One of them.
struct VtkArray {
    element: String,
    name: String,
    components: usize,
    values: Vec<f64>,
}

impl VtkArrays {
    /// Those called `wanted` in `file`, a data set of this `kind`.
    ///
    /// # Errors
    /// When it is no such file.
    pub fn of(file: &OwnFile, kind: &str, wanted: &[&str]) -> Result<Self, RecordingError> {
        let refuse = |reason: String| RecordingError::of(&file.path, reason);
        let (text, appended) = split(&file.bytes).map_err(refuse)?;
        let document = parse(&text, MOST_NODES).map_err(refuse)?;
        let root = document.root_element();
        check_layout(root, kind).map_err(refuse)?;
        let mut pieces = root.descendants().filter(|node| node.has_tag_name("Piece"));
        let (Some(piece), None) = (pieces.next(), pieces.next()) else {
            return Err(refuse("does not have one `Piece`".into()));
        };
        let counts = piece.attributes().filter_map(|attribute| {
            let count = attribute.value().parse().ok()?;
            Some((attribute.name().to_owned(), count))
        });
        let mut arrays = Vec::new();
        for element in piece.children().filter(Node::is_element) {
            for node in element.children().filter(|n| n.has_tag_name("DataArray")) {
                let name = node.attribute("Name").unwrap_or_default();
                if wanted.contains(&name) {
                    let array = VtkArray::of(element.tag_name().name(), name, node, appended);
                    arrays.push(array.map_err(|why| refuse(format!("array `{name}` {why}")))?);
                }
            }
        }
        Ok(Self {
            path: file.path.clone(),
            counts: counts.collect(),
            arrays,
        })
    }

    /// How many of what it says it has: `NumberOfPoints` …
    ///
    /// # Errors
    /// When it does not say.
    pub fn count(&self, name: &str) -> Result<usize, RecordingError> {
        let mut counts = self.counts.iter();
        let found = counts.find(|(own, _)| own == name);
        found
            .map(|(_, count)| *count)
            .ok_or_else(|| self.refuse(format!("states no `{name}`")))
    }

    /// That something is wrong with the file.
    pub fn refuse(&self, reason: impl Into<String>) -> RecordingError {
        RecordingError::of(&self.path, reason)
    }

    /// Whether `element` has an array called `name`.
    pub fn has(&self, element: &str, name: &str) -> bool {
        self.find(element, name).is_some()
    }

    fn find(&self, element: &str, name: &str) -> Option<&VtkArray> {
        let mut arrays = self.arrays.iter();
        arrays.find(|array| array.element == element && array.name == name)
    }

    /// The numbers of an array of this many `components`, `count` times; any number of times of
    /// none.
    ///
    /// # Errors
    /// When it is missing or of another length.
    pub fn numbers(
        &self,
        element: &str,
        name: &str,
        components: usize,
        count: Option<usize>,
    ) -> Result<&[f64], RecordingError> {
        let array = self.find(element, name);
        let array =
            array.ok_or_else(|| self.refuse(format!("has no array `{name}` in `{element}`")))?;
        let found = array.values.len();
        let expected = count.and_then(|count| count.checked_mul(components));
        let fits = count.is_none() || expected == Some(found);
        if array.components == components && fits {
            return Ok(&array.values);
        }
        Err(self.refuse(format!(
            "array `{name}` has {found} numbers in vectors of {}; expected {} in vectors of {components}",
            array.components,
            expected.map_or_else(|| "some".to_owned(), |count| count.to_string())
        )))
    }

    /// The same as vectors.
    ///
    /// # Errors
    /// As [`VtkArrays::numbers`].
    pub fn vectors(
        &self,
        element: &str,
        name: &str,
        count: usize,
    ) -> Result<Vec<DVec3>, RecordingError> {
        let numbers = self.numbers(element, name, 3, Some(count))?;
        let (triples, _) = numbers.as_chunks::<3>();
        Ok(triples.iter().copied().map(DVec3::from_array).collect())
    }
}

/// The elements of `text`, `most` of them at most.
///
/// # Errors
/// When it is no XML.
pub fn parse(text: &str, most: u32) -> Result<Document<'_>, String> {
    let options = ParsingOptions {
        nodes_limit: most,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options)
        .map_err(|error| format!("is no XML as Grainfall writes it: {error}"))
}

/// The elements as text, and what is appended behind them.
fn split(bytes: &[u8]) -> Result<(String, &[u8]), String> {
    let at = bytes.windows(APPENDED.len()).position(|w| w == APPENDED);
    let (head, rest) = bytes.split_at(at.unwrap_or(bytes.len()));
    let mut text = String::from_utf8(head.to_vec()).map_err(|_| "is no text".to_owned())?;
    let mark = rest.iter().position(|byte| *byte == b'_');
    if at.is_some() {
        text.push_str("</VTKFile>");
    }
    Ok((text, mark.map_or(&[], |mark| &rest[mark + 1..])))
}

fn check_layout(root: Node, kind: &str) -> Result<(), String> {
    let is = |name: &str, value: &str| root.attribute(name) == Some(value);
    if !root.has_tag_name("VTKFile") || !is("type", kind) {
        return Err(format!("is no VTK file of type `{kind}`"));
    }
    let is_ours = is("byte_order", "LittleEndian")
        && is("header_type", "UInt64")
        && root.attribute("compressor").is_none();
    if is_ours {
        return Ok(());
    }
    Err(
        "is another kind of VTK file than Grainfall writes: compressed, or of another order of bytes"
            .into(),
    )
}

impl VtkArray {
    /// That of `node`, called `name` within `element`.
    fn of(element: &str, name: &str, node: Node, appended: &[u8]) -> Result<Self, String> {
        let components = node.attribute("NumberOfComponents").unwrap_or("1");
        let components = components.parse().map_err(|_| "has no components")?;
        let text = node.text().unwrap_or_default().trim();
        let kind = node.attribute("type").unwrap_or_default();
        let values = match node.attribute("format") {
            Some("ascii") => text
                .split_ascii_whitespace()
                .map(|word| word.parse().map_err(|_| "holds what is no number"))
                .collect::<Result<_, _>>()?,
            Some("binary") => {
                let bytes = BASE64_STANDARD.decode(text);
                let bytes = bytes.map_err(|error| format!("is no base64: {error}"))?;
                numbers(kind, block(&bytes)?)?
            }
            Some("appended") => {
                let offset = node.attribute("offset").and_then(|text| text.parse().ok());
                let rest = offset.and_then(|offset: usize| appended.get(offset..));
                numbers(kind, block(rest.ok_or("begins behind the file's end")?)?)?
            }
            _ => return Err("is of no format that is read".into()),
        };
        Ok(Self {
            element: element.to_owned(),
            name: name.to_owned(),
            components,
            values,
        })
    }
}

/// The bytes of a block, behind their number.
fn block(bytes: &[u8]) -> Result<&[u8], String> {
    let cut = || "is cut off".to_owned();
    let (length, rest) = bytes.split_first_chunk::<8>().ok_or_else(cut)?;
    let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| cut())?;
    rest.get(..length).ok_or_else(cut)
}

/// The numbers of this VTK type in `bytes`.
fn numbers(kind: &str, bytes: &[u8]) -> Result<Vec<f64>, String> {
    fn each<const N: usize>(bytes: &[u8], number: fn([u8; N]) -> f64) -> Result<Vec<f64>, String> {
        match bytes.as_chunks::<N>() {
            (chunks, []) => Ok(chunks.iter().copied().map(number).collect()),
            _ => Err("ends within a number".into()),
        }
    }
    match kind {
        "Float32" => each(bytes, |bytes| f64::from(f32::from_le_bytes(bytes))),
        "Float64" => each(bytes, f64::from_le_bytes),
        "Int32" => each(bytes, |bytes| f64::from(i32::from_le_bytes(bytes))),
        "UInt8" => each(bytes, |bytes: [u8; 1]| f64::from(bytes[0])),
        _ => Err(format!("is of type `{kind}`, which is not read")),
    }
}
