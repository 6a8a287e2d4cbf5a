//! VTK's XML files: a head that describes arrays of numbers, and behind it the numbers themselves.
//!
//! In: the arrays of a data set. Out: a `.vtp` or `.vtu` file as the VTK file formats' chapter on
//! XML has it, with its numbers appended raw, little endian, each array behind its length in bytes.
//! Number by number: a file is larger than the world it shows, and is never held whole. Not here:
//! reading, compression, other kinds of data sets.

use crate::run::Provenance;
use glam::DVec3;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Bytes that are gathered before they are written.
const BUFFER: usize = 1 << 16;

/// What a file holds: one piece of a data set.
pub struct DataSet<'a> {
    /// VTK's name of its kind: `PolyData`, `UnstructuredGrid`.
    pub kind: &'static str,
    /// How many of what the piece has: attributes of its element.
    pub counts: Vec<(&'static str, usize)>,
    /// The elements of the piece in their order, each with its arrays.
    pub elements: Vec<(&'static str, Vec<Array<'a>>)>,
}

impl DataSet<'_> {
    /// Writes it to `file`, with a comment that says where it comes `from`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
        let head = self.head().map_err(io::Error::other)?;
        file.write_all(from.in_xml(&head).as_bytes())?;
        for array in self.arrays() {
            file.write_all(&(array.size as u64).to_le_bytes())?;
            (array.write)(file)?;
        }
        file.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }

    fn arrays(&self) -> impl Iterator<Item = &Array<'_>> {
        self.elements.iter().flat_map(|(_, arrays)| arrays)
    }

    /// All that stands before the numbers.
    fn head(&self) -> Result<String, std::fmt::Error> {
        let kind = self.kind;
        let mut head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<{kind}>\n<Piece"
        );
        for (name, count) in &self.counts {
            write!(head, " {name}=\"{count}\"")?;
        }
        head.push_str(">\n");
        let mut offset = 0;
        for (element, arrays) in &self.elements {
            writeln!(head, "<{element}>")?;
            for array in arrays {
                writeln!(head, "{}", array.element(offset))?;
                offset += size_of::<u64>() + array.size;
            }
            writeln!(head, "</{element}>")?;
        }
        writeln!(head, "</Piece>\n</{kind}>\n<AppendedData encoding=\"raw\">")?;
        head.push('_');
        Ok(head)
    }
}

/// Writes the numbers of an array.
type Writing<'a> = dyn Fn(&mut dyn Write) -> io::Result<()> + 'a;

/// One array of numbers, as it stands in the file behind its length.
pub struct Array<'a> {
    name: &'static str,
    kind: &'static str,
    components: usize,
    /// Bytes that its numbers take.
    size: usize,
    write: Box<Writing<'a>>,
}

impl<'a> Array<'a> {
    /// `count` numbers of `N` bytes each, made anew whenever they are written.
    fn new<const N: usize, I: Iterator<Item = [u8; N]>>(
        name: &'static str,
        kind: &'static str,
        count: usize,
        numbers: impl Fn() -> I + 'a,
    ) -> Self {
        Self {
            name,
            kind,
            components: 1,
            size: N * count,
            write: Box::new(move |file| {
                let mut buffer = Vec::with_capacity(BUFFER + N);
                for number in numbers() {
                    buffer.extend_from_slice(&number);
                    if buffer.len() >= BUFFER {
                        file.write_all(&buffer)?;
                        buffer.clear();
                    }
                }
                file.write_all(&buffer)
            }),
        }
    }

    /// An array called `name` of `count` numbers in 64 bits.
    pub fn scalars<I: Iterator<Item = f64>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(f64::to_le_bytes);
        Self::new(name, "Float64", count, numbers)
    }

    /// An array called `name` of `count` vectors of three numbers in 64 bits.
    pub fn vectors<I: Iterator<Item = DVec3>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().flat_map(|v| v.to_array());
        Self {
            components: 3,
            ..Self::scalars(name, 3 * count, numbers)
        }
    }

    /// An array called `name` of `count` whole numbers in 64 bits.
    pub fn integers<I: Iterator<Item = i64>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(i64::to_le_bytes);
        Self::new(name, "Int64", count, numbers)
    }

    /// An array called `name` of `count` bytes.
    pub fn bytes<I: Iterator<Item = u8>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(u8::to_le_bytes);
        Self::new(name, "UInt8", count, numbers)
    }

    /// The element that describes it, its numbers beginning `offset` bytes behind the mark `_`.
    fn element(&self, offset: usize) -> String {
        let Self {
            name,
            kind,
            components,
            ..
        } = self;
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{offset}\"/>"
        )
    }
}
