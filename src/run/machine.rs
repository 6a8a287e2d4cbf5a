//! What the machine has left: memory, and room on a disk.
//!
//! In: nothing, or a path. Out: bytes, or none where the system does not say.

use crate::files::read_whole;
use std::path::Path;

/// Memory that a program can have now [bytes].
pub fn free_memory() -> Option<f64> {
    let read = |path: &str| {
        // A system without such a file says nothing.
        let bytes = read_whole(Path::new(path), 1 << 20).ok()?;
        String::from_utf8(bytes).ok()
    };
    let available = available(&read("/proc/meminfo")?)?;
    let of_group = read("/sys/fs/cgroup/memory.max").and_then(|text| text.trim().parse().ok());
    Some(of_group.map_or(available, |most: f64| available.min(most)))
}

/// What `/proc/meminfo` says is available [bytes].
fn available(text: &str) -> Option<f64> {
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kilobytes)
}

/// What files at `path`, or in the folder that will be there, can take of their disk [bytes].
pub fn free_disk(path: &Path) -> Option<f64> {
    let absolute = std::path::absolute(path).ok()?;
    let there = absolute.ancestors().find(|above| above.exists())?;
    of_disk(there)
}

#[cfg(unix)]
fn of_disk(path: &Path) -> Option<f64> {
    let disk = rustix::fs::statvfs(path).ok()?;
    Some(disk.f_bavail as f64 * disk.f_frsize as f64)
}

#[cfg(not(unix))]
fn of_disk(_path: &Path) -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_says_is_read() {
        let text = "MemTotal:       24103000 kB\nMemAvailable:    1000000 kB\nBuffers: 1 kB\n";
        assert_eq!(available(text), Some(1.024e9));
        assert_eq!(available("nothing"), None);
    }

    #[cfg(unix)]
    #[test]
    fn folder_that_is_still_to_be_made_lies_on_the_disk_of_those_above() {
        let folder = tempfile::tempdir().unwrap();
        let below = free_disk(&folder.path().join("a/b")).unwrap();
        assert!(below > 1e3 && below < 1e18, "{below}");
    }
}
