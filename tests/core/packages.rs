//! Claims about the packages: what the code takes in from other files is packed with it.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// The root folder of each package.
const PACKAGES: [&str; 2] = ["", "app"];

/// Source files below `folder`.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    let below = |path: PathBuf| match path.extension() {
        _ if path.is_dir() => sources(&path),
        Some(end) if end == "rs" => vec![path],
        _ => Vec::new(),
    };
    entries
        .flat_map(|entry| below(entry.unwrap().path()))
        .collect()
}

/// The beginnings of file names in `include_str!` and `include_bytes!` of `text`, up to the first
/// part that a macro fills in.
fn included(text: &str) -> Vec<String> {
    let calls = ["include_str!(", "include_bytes!("].into_iter();
    let found = calls.flat_map(|call| text.split(call).skip(1));
    let names = found.filter_map(|rest| rest.trim_start_matches("concat!(").strip_prefix('"'));
    names
        .filter_map(|rest| Some(rest.split_once('"')?.0.to_owned()))
        .collect()
}

/// `path` without `..`.
fn plain(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut plain, part| {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
        plain
    })
}

/// The names that `include` in the `manifest` packs.
fn packed(manifest: &str) -> Vec<String> {
    let line = manifest.lines().find(|line| line.starts_with("include = "));
    let names = line.unwrap().split('"').skip(1).step_by(2);
    names
        .map(|name| name.trim_start_matches('/').to_owned())
        .collect()
}

#[test]
fn files_that_the_code_includes_are_packed_with_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for package in PACKAGES {
        let folder = root.join(package);
        let packed = packed(&fs::read_to_string(folder.join("Cargo.toml")).unwrap());
        for file in sources(&folder.join("src")) {
            let text = fs::read_to_string(&file).unwrap();
            for name in included(&text) {
                let path = plain(&file.with_file_name("").join(&name));
                let below = path
                    .strip_prefix(&folder)
                    .unwrap()
                    .to_str()
                    .unwrap()
                    .to_owned();
                let is_packed = packed
                    .iter()
                    .any(|packed| below.starts_with(packed.as_str()));
                assert!(
                    is_packed,
                    "{} includes {below}, which is not packed",
                    file.display()
                );
                count += 1;
            }
        }
    }
    assert!(count > 5, "{count}");
}
