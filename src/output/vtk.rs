//! VTK's XML files: arrays of numbers, and what each is of.
//!
//! In: the arrays of a data set. Out: a `.vtp` or `.vtu` file as the VTK file formats' chapter on
//! XML has it, little endian and not compressed, with where it comes from as a comment and its time
//! as field data. Number by number: a file is larger than the world it shows, and is never held
//! whole. Not here: reading, compression, other kinds of data sets.
//!
//! OVITO finds out what a file is by its first elements, and reads numbers of 32 or 64 bits where
//! they stand in base64 or as text; bytes behind the elements break it even where it needs none of
//! them. So arrays are kept that way and field data stand last. What it does not read may have its
//! numbers behind the elements, raw, which takes three quarters of that.

use super::base64::Base64Writer;
use crate::run::Provenance;
use glam::DVec3;
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
    /// Writes it to `file`, with where it comes `from`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
        let kind = self.kind;
        let opening = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        );
        write!(file, "{}<{kind}>\n<Piece", from.in_xml(&opening))?;
        for (name, count) in &self.counts {
            write!(file, " {name}=\"{count}\"")?;
        }
        file.write_all(b">\n")?;
        self.write_elements(file)?;
        file.write_all(b"</Piece>\n")?;
        write_field_data(from, file)?;
        writeln!(file, "</{kind}>")?;
        if self.arrays().any(Array::is_appended) {
            file.write_all(b"<AppendedData encoding=\"raw\">\n_")?;
            for array in self.arrays().filter(|array| array.is_appended()) {
                array.write_numbers(file)?;
            }
            file.write_all(b"\n</AppendedData>\n")?;
        }
        file.write_all(b"</VTKFile>\n")
    }

    fn arrays(&self) -> impl Iterator<Item = &Array<'_>> {
        self.elements.iter().flat_map(|(_, arrays)| arrays)
    }

    fn write_elements(&self, file: &mut dyn Write) -> io::Result<()> {
        let mut offset = 0;
        for (element, arrays) in &self.elements {
            writeln!(file, "<{element}>")?;
            for array in arrays {
                array.write_element(offset, file)?;
                if array.is_appended() {
                    offset += size_of::<u64>() + array.size();
                }
            }
            writeln!(file, "</{element}>")?;
        }
        Ok(())
    }
}

/// Says at which time the data set stands that comes `from` there: readers order files by it.
fn write_field_data(from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
    let Some(time) = from.time() else {
        return Ok(());
    };
    writeln!(
        file,
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" \
         format=\"ascii\">{time:?}</DataArray>\n</FieldData>"
    )
}

/// Where the numbers of an array stand, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    /// In the array's element, in base64 behind their length in bytes.
    Base64,
    /// In the array's element, as decimal numbers: shortest where these have a digit or two.
    Text,
    /// Behind all elements, as they stand in memory, behind their length in bytes.
    Appended,
}

/// Writes the numbers of an array.
type Writing<'a> = dyn Fn(&mut dyn Write) -> io::Result<()> + 'a;

/// One array of numbers.
pub struct Array<'a> {
    name: &'static str,
    kind: &'static str,
    components: usize,
    /// How many numbers there are.
    count: usize,
    /// Bytes of each.
    width: usize,
    encoding: Encoding,
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
            count,
            width: N,
            encoding: Encoding::Base64,
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

    /// An array called `name` of `count` numbers, in 32 bits.
    pub fn scalars<I: Iterator<Item = f64>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(|value| (value as f32).to_le_bytes());
        Self::new(name, "Float32", count, numbers)
    }

    /// An array called `name` of `count` vectors of three numbers, in 32 bits.
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

    /// An array called `name` of `count` tensors of nine numbers, row by row, in 32 bits.
    pub fn tensors<I: Iterator<Item = [DVec3; 3]>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let rows = move || values().flatten();
        Self {
            components: 9,
            ..Self::vectors(name, 3 * count, rows)
        }
    }

    /// An array called `name` of `count` whole numbers, in 32 bits.
    pub fn integers<I: Iterator<Item = i32>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(i32::to_le_bytes);
        Self::new(name, "Int32", count, numbers)
    }

    /// The same of numbers that have few digits.
    pub fn small_integers<I: Iterator<Item = i32>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        Self {
            name,
            kind: "Int32",
            components: 1,
            count,
            width: size_of::<i32>(),
            encoding: Encoding::Text,
            write: Box::new(move |file| values().try_for_each(|number| write!(file, "{number} "))),
        }
    }

    /// An array called `name` of `count` bytes, behind the elements.
    pub fn bytes<I: Iterator<Item = u8>>(
        name: &'static str,
        count: usize,
        values: impl Fn() -> I + 'a,
    ) -> Self {
        let numbers = move || values().map(u8::to_le_bytes);
        Self::new(name, "UInt8", count, numbers).appended()
    }

    /// The same array with its numbers behind the elements: shorter, and nothing for OVITO.
    #[must_use]
    pub fn appended(self) -> Self {
        Self {
            encoding: Encoding::Appended,
            ..self
        }
    }

    fn is_appended(&self) -> bool {
        self.encoding == Encoding::Appended
    }

    /// Bytes that its numbers take in memory.
    fn size(&self) -> usize {
        self.width * self.count
    }

    /// Writes the element that describes it; appended numbers begin `offset` bytes behind the mark
    /// `_`.
    fn write_element(&self, offset: usize, file: &mut dyn Write) -> io::Result<()> {
        let Self {
            name,
            kind,
            components,
            ..
        } = self;
        write!(file, "<DataArray type=\"{kind}\" Name=\"{name}\" ")?;
        // Of one component meshio would make columns.
        if *components > 1 {
            write!(file, "NumberOfComponents=\"{components}\" ")?;
        }
        match self.encoding {
            Encoding::Appended => {
                return writeln!(file, "format=\"appended\" offset=\"{offset}\"/>");
            }
            Encoding::Text => {
                file.write_all(b"format=\"ascii\">")?;
                (self.write)(file)?;
            }
            Encoding::Base64 => {
                file.write_all(b"format=\"binary\">")?;
                let mut encoder = Base64Writer::new(&mut *file);
                self.write_numbers(&mut encoder)?;
                encoder.finish()?;
            }
        }
        file.write_all(b"</DataArray>\n")
    }

    /// Writes its numbers behind their length in bytes.
    fn write_numbers(&self, file: &mut dyn Write) -> io::Result<()> {
        file.write_all(&(self.size() as u64).to_le_bytes())?;
        (self.write)(file)
    }
}
