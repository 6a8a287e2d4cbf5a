//! VTK's XML files as tests read them: arrays by name.

use glam::DVec3;

/// A `.vtp` or `.vtu` file: its text up to the numbers that are appended, and these where there are
/// any.
pub struct File {
    pub header: String,
    data: Vec<u8>,
}

impl File {
    pub fn parse(bytes: &[u8]) -> Self {
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(mark.len()).position(|w| w == mark);
        let at = at.map_or(bytes.len(), |at| at + mark.len());
        Self {
            header: String::from_utf8(bytes[..at].to_vec()).unwrap(),
            data: bytes[at..].to_vec(),
        }
    }

    /// The arrays within `<element> … </element>`, by name and in their order.
    pub fn names(&self, element: &str) -> Vec<&str> {
        let start = self.header.find(&format!("<{element}>")).unwrap();
        let end = self.header.find(&format!("</{element}>")).unwrap();
        let arrays = self.header[start..end].split("Name=\"").skip(1);
        arrays.map(|rest| rest.split('"').next().unwrap()).collect()
    }

    /// The element of the array called `name`, behind its name.
    fn element(&self, name: &str) -> &str {
        let start = self.header.find(&format!("Name=\"{name}\"")).unwrap();
        self.header[start..].split("<DataArray").next().unwrap()
    }

    /// The bytes of the numbers of the array called `name`.
    pub fn bytes(&self, name: &str) -> Vec<u8> {
        let element = self.element(name);
        let bytes = match element.split("offset=\"").nth(1) {
            Some(offset) => {
                let offset: usize = offset.split('"').next().unwrap().parse().unwrap();
                self.data[offset..].to_vec()
            }
            None => decoded(element.split(['>', '<']).nth(1).unwrap()),
        };
        let length = u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
        bytes[8..8 + length].to_vec()
    }

    pub fn integers(&self, name: &str) -> Vec<i32> {
        let element = self.element(name);
        if element.contains("format=\"ascii\"") {
            let text = element.split(['>', '<']).nth(1).unwrap();
            return text
                .split_whitespace()
                .map(|n| n.parse().unwrap())
                .collect();
        }
        let bytes = self.bytes(name);
        let (numbers, _) = bytes.as_chunks();
        numbers.iter().map(|n| i32::from_le_bytes(*n)).collect()
    }

    pub fn floats(&self, name: &str) -> Vec<f32> {
        let bytes = self.bytes(name);
        let (numbers, _) = bytes.as_chunks();
        numbers.iter().map(|n| f32::from_le_bytes(*n)).collect()
    }

    pub fn vectors(&self, name: &str) -> Vec<DVec3> {
        let numbers: Vec<f64> = self.floats(name).into_iter().map(f64::from).collect();
        numbers.chunks(3).map(DVec3::from_slice).collect()
    }
}

/// What base64 `text` stands for.
fn decoded(text: &str) -> Vec<u8> {
    let alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let text = text.trim_end_matches('=');
    let mut bits = text.chars().map(|c| alphabet.find(c).unwrap() as u32);
    let mut bytes = Vec::new();
    while let Some(first) = bits.next() {
        let rest = [bits.next(), bits.next(), bits.next()];
        let known = rest.iter().flatten().count();
        let word = rest
            .iter()
            .fold(first, |word, six| word << 6 | six.unwrap_or(0));
        bytes.extend_from_slice(&word.to_be_bytes()[1..=known]);
    }
    bytes
}
