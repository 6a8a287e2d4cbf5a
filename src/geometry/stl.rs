//! STL files, in text or binary.
//!
//! In: the bytes of a file. Out: its triangles, in the file's unit of length. Numbers are those of
//! single precision, which is what the format holds. The facets' normals are passed over: which side
//! grains are on, no facet needs to say.

use super::surface_mesh::MOST_TRIANGLES;
use glam::DVec3;
use std::io::Cursor;

/// Largest file that is read [bytes]: text takes some 250 a triangle.
pub const LARGEST_STL: u64 = 16 << 20;
/// Bytes of a binary file before its triangles, and of each of them.
const HEAD: usize = 84;
const EACH: usize = 50;

/// The triangles in `bytes`.
///
/// # Errors
/// What is wrong with it, in words.
pub fn read_stl(bytes: &[u8]) -> Result<Vec<[DVec3; 3]>, String> {
    let mut bytes = bytes.to_vec();
    if let Some(count) = binary_count(&bytes) {
        let expected = HEAD + EACH * count;
        if bytes.len() != expected {
            return Err(format!(
                "{} bytes; expected {expected} for the {count} triangles that it states: it is cut, or no STL",
                bytes.len()
            ));
        }
        // Some programs begin binary files as those in text do.
        bytes[0] = b' ';
    }
    let mut file = Cursor::new(bytes);
    let refuse = |error: std::io::Error| format!("no STL: {error}");
    let mut triangles = Vec::new();
    for triangle in stl_io::create_stl_reader(&mut file).map_err(refuse)? {
        if triangles.len() == MOST_TRIANGLES {
            return Err(format!("more than {MOST_TRIANGLES} triangles"));
        }
        let corners = triangle.map_err(refuse)?.vertices;
        triangles.push(corners.map(|corner| {
            let [x, y, z] = <[f32; 3]>::from(corner);
            DVec3::new(f64::from(x), f64::from(y), f64::from(z))
        }));
    }
    if triangles.is_empty() {
        return Err("no STL: it has no triangles".to_owned());
    }
    Ok(triangles)
}

/// How many triangles a binary file states; none of text.
fn binary_count(bytes: &[u8]) -> Option<usize> {
    let stated = bytes.get(HEAD - 4..HEAD)?.try_into().ok()?;
    let count = u32::from_le_bytes(stated) as usize;
    let fits = bytes.len() as u64 == HEAD as u64 + EACH as u64 * count as u64;
    (fits || !bytes.starts_with(b"solid")).then_some(count.min(u32::MAX as usize))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid a\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0.5\n  vertex 0 1e-1 0\n \
                        endloop\nendfacet\nendsolid a\n";

    fn binary(head: &[u8]) -> Vec<u8> {
        let mut bytes = head.to_vec();
        bytes.resize(80, 0);
        bytes.extend(1_u32.to_le_bytes());
        for x in [
            0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.0, 0.1, 0.0,
        ] {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend([0, 0]);
        bytes
    }

    #[test]
    fn text_and_binary_say_the_same() {
        let text = read_stl(TEXT.as_bytes()).unwrap();
        assert_eq!(
            text,
            [[
                DVec3::ZERO,
                DVec3::new(1.0, 0.0, 0.5),
                DVec3::Y * f64::from(0.1_f32)
            ]]
        );
        assert_eq!(read_stl(&binary(b"made by hand")).unwrap(), text);
        assert_eq!(read_stl(&binary(b"solid made by hand")).unwrap(), text);
    }

    #[test]
    fn what_is_no_stl_is_refused() {
        let whole = binary(b"");
        let cases: [(&[u8], &str); 7] = [
            (b"", "no STL"),
            (b"hello", "no STL"),
            (&whole[..100], "expected 134"),
            (&TEXT.as_bytes()[..60], "no STL"),
            (
                b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n",
                "finite",
            ),
            (
                &[b"solid \xff\xfe".as_slice(), &[0; 200]].concat(),
                "no STL",
            ),
            (
                &[&whole[..80], &[255; 4], &whole[84..]].concat(),
                "expected 2147",
            ),
        ];
        for (bytes, expected) in cases {
            let error = read_stl(bytes).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
    }
}
