//! One command a paper: its cases run or gone on with, and its tables and figures made from what is
//! there.
//!
//! In: a [`Paper`], which is data: a scene, what is varied about it, the cases in the order in which
//! they tell most. Out: the folder of a sweep with a folder for each case, tables and plots, and in
//! it `tables.md`, whose tables also stand between the markers of a document. The cases are run by
//! the loop of [`crate::sweep`]; only finished ones of one method count, and the others are named.
//! A file can keep the results of the cases beside their folders, which may be lost: what it holds
//! is done.
//!
//! Each row of the table uses only rows below it.
//!
//! | file | holds |
//! |---|---|
//! | `job` | running a paper, or setting beside each other what is there |
//! | `kept_file` | the file that keeps results, a line for each case |
//! | `kept_line` | what a line holds, and by what a case is known |
//! | `registry` | the papers by name |
//! | `man_readings` | what Man et al. 2023 leave open, read in several ways: cases and tables |
//! | `man2023` | Man et al. 2023: likewise |
//! | `kasper_readings` | what Kasper et al. 2021 leave open: likewise |
//! | `kasper2021` | Kasper et al. 2021: likewise |
//! | `readings` | tables of readings |
//! | `document` | tables between the markers of a document |
//! | `markdown` | rows of tables |
//! | `plan` | what a paper is: cases by parts and seeds |

mod document;
mod job;
mod kasper2021;
mod kasper_readings;
mod kept_file;
mod kept_line;
mod man2023;
mod man_readings;
mod markdown;
mod plan;
mod readings;
mod registry;

pub use document::{DocumentError, marked, replace};
pub use job::{Listed, PaperJob, Papered, list, run, set_beside};
pub use plan::{Batch, Paper, PaperTable, Reading, Selection};
pub use registry::{PAPERS, paper};
