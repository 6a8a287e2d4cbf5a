//! What the machine has: cores, memory and room on a disk that are left; and work that gives way to
//! other work.
//!
//! In: nothing, or a path. Out: bytes, or none where the system does not say.

use crate::files::read_whole;
use std::path::Path;

/// Threads that the machine runs at once.
pub fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

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

/// Memory of this program that the system holds for it now [bytes]. Pages of files that are only
/// read, such as the program itself, do not count: the system takes them and reads them again as it
/// likes.
pub fn resident_memory() -> Option<u64> {
    let bytes = read_whole(Path::new("/proc/self/status"), 1 << 20).ok()?;
    let text = String::from_utf8(bytes).ok()?;
    let kilobytes = |name: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(name))?;
        line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()
    };
    Some(1024 * (kilobytes("RssAnon:")? + kilobytes("RssShmem:")?))
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

/// Niceness of work that others are not to wait for: a thread that draws gets thirty times as much of
/// a core that both want.
#[cfg(target_os = "linux")]
const NICE: i32 = 15;

/// Lets the calling thread, and those that it begins from now on, have of a core what others leave,
/// on Linux; elsewhere they share it with them.
pub fn give_way() {
    #[cfg(target_os = "linux")]
    {
        // Linux counts niceness by threads. Where it refuses, they share the core, too.
        let _ = rustix::process::setpriority_process(None, NICE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn threads_that_give_way_hand_it_on_and_others_do_not() {
        let niceness = || rustix::process::getpriority_process(None).unwrap();
        let before = niceness();
        let inherited = std::thread::spawn(move || {
            give_way();
            std::thread::spawn(niceness).join().unwrap()
        });
        assert_eq!(inherited.join().unwrap(), NICE.max(before));
        assert_eq!(niceness(), before);
    }

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
