//! Base64: bytes as text, four characters for three of them (RFC 4648, section 4).
//!
//! In: bytes, in parts. Out: their text, in parts. Not here: reading it.

use std::io::{self, Write};

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Writes the text of the bytes that are written to it.
pub struct Base64Writer<'a> {
    file: &'a mut dyn Write,
    /// Bytes that do not make three yet.
    left: Vec<u8>,
}

impl<'a> Base64Writer<'a> {
    /// Text for `file`.
    pub fn new(file: &'a mut dyn Write) -> Self {
        let left = Vec::with_capacity(3);
        Self { file, left }
    }

    /// Writes what is left, filled up with `=`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn finish(self) -> io::Result<()> {
        match self.left[..] {
            [a] => {
                let [w, x, ..] = characters([a, 0, 0]);
                self.file.write_all(&[w, x, b'=', b'='])
            }
            [a, b] => {
                let [w, x, y, _] = characters([a, b, 0]);
                self.file.write_all(&[w, x, y, b'='])
            }
            _ => Ok(()),
        }
    }
}

impl Write for Base64Writer<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.left.extend_from_slice(bytes);
        let (triples, rest) = self.left.as_chunks::<3>();
        let text: Vec<u8> = triples.iter().flat_map(|t| characters(*t)).collect();
        self.file.write_all(&text)?;
        self.left = rest.to_vec();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Four characters of six bits each.
fn characters([a, b, c]: [u8; 3]) -> [u8; 4] {
    let bits = u32::from_be_bytes([0, a, b, c]);
    [18, 12, 6, 0].map(|shift| ALPHABET[(bits >> shift & 0x3f) as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Section 10 of RFC 4648.
    #[test]
    fn text_is_that_of_the_standard_however_the_bytes_come() {
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (bytes, text) in pairs {
            for part in 1..4 {
                let mut written = Vec::new();
                let mut writer = Base64Writer::new(&mut written);
                for bytes in bytes.as_bytes().chunks(part) {
                    writer.write_all(bytes).unwrap();
                }
                writer.finish().unwrap();
                assert_eq!(String::from_utf8(written).unwrap(), text);
            }
        }
    }
}
