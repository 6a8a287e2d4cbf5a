//! Files that appear whole or not at all, files that are read whole or not at all, files that grow
//! at their end, and folders that one program at a time writes to.
//!
//! In: paths and bytes. Out: files that a stop at any moment leaves whole: a file is written under
//! a name of its own, made durable and then renamed; what grows is cut back where an addition
//! fails. Not here: what the files hold, and who asks for them.
//!
//! Each row of the table uses only rows below it.
//!
//! | file | holds |
//! |---|---|
//! | `made_beside` | folders, and files by other programs, that appear whole or not at all |
//! | `growing` | files that grow at their end |
//! | `whole` | files that appear whole or not at all |
//! | `lock` | one program at a time in a folder |
//! | `reading` | regular files of bounded size |
//! | `target` | what is never written over |
//! | `attempt` | where tests let a call to the operating system fail |
//! | `power_cut` | what is left where the program or the power stops; for tests |

mod attempt;
mod growing;
mod lock;
mod made_beside;
#[cfg(all(test, unix))]
mod power_cut;
mod reading;
mod target;
mod whole;

#[cfg(test)]
pub(crate) use attempt::FailingCalls;
pub use growing::GrowingFile;
pub use lock::{FolderLock, LOCK, LockError};
pub use made_beside::{make_whole_file, make_whole_folder};
#[cfg(all(test, unix))]
pub(crate) use power_cut::{PowerCuts, Stop};
pub use reading::{open_regular, read_whole};
pub use target::check_target;
pub use whole::{
    folder_beside, holds_files, is_temporary, make_folder, remove_file, sync_file, sync_folder,
    write_whole, write_whole_unsynced,
};
